/* Shells of cells in OpenMesh: triangulated, a vertex split into one for each of its umbrellas, every shell must be accepted as a
   closed orientable manifold, and the Euler characteristics that OpenMesh finds must add up to the one that is reported.
   Coordinates are handed over as doubles (OpenMesh's readers go through float).

   Where the tip of a void or of a dent touches a plane, a cell has an umbrella of plane faces alone and u others at
   that vertex, and is connected between them: pulled apart, its surface has a tube there instead of discs. OpenMesh sees
   the discs, so 2u is taken off for each such umbrella. */
#ifndef LAPIDARY_OPENMESH_SHELLS_HPP
#define LAPIDARY_OPENMESH_SHELLS_HPP

#include "check.h"
#include "lapidary.hpp"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <numeric>
#include <tuple>
#include <vector>

namespace openmesh_shells {

struct Traits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;

/* Sets that are joined. */
struct Sets {
    std::vector<std::int32_t> parent;
    explicit Sets(std::size_t n) : parent(n) { std::iota(parent.begin(), parent.end(), 0); }
    std::int32_t find(std::int32_t i)
    {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    }
    void join(std::int32_t a, std::int32_t b) { parent[find(a)] = find(b); }
};

/* A triangle of a shell, oriented outward, and the half-face that it is a part of. */
struct Wall {
    std::array<std::int32_t, 3> vertices;
    std::int32_t half_face;
};

/* One use of an edge: 3 * triangle + side, and the edge as low and high vertex. */
struct Use {
    std::int32_t low, high, half_face, at;
    bool forward;
    bool operator<(const Use &o) const
    {
        return std::tie(low, high, half_face, at) < std::tie(o.low, o.high, o.half_face, o.at);
    }
};

/* The umbrellas of a cell at each vertex, and how many of them consist of plane faces alone. */
struct Umbrellas {
    std::int64_t all = 0, flat = 0;
};

/* Makes OpenMesh's mesh of a shell. `across` tells which half-face follows a half-face at an edge that it shares with more
   than one; `on_triangle` whether a face lies on a triangle of the input (empty: all do). Returns the Euler characteristic
   and adds to the umbrellas at each vertex. */
inline std::int64_t shell_euler(const std::vector<Wall> &walls, const lapidary::groups<double, 3> &xyz,
                         const std::map<std::array<std::int32_t, 3>, std::int32_t> &across, const std::vector<char> &on_triangle,
                         std::map<std::int32_t, Umbrellas> &umbrellas)
{
    std::vector<Use> uses;
    for (std::size_t t = 0; t < walls.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            const std::int32_t a = walls[t].vertices[k], b = walls[t].vertices[(k + 1) % 3];
            uses.push_back({std::min(a, b), std::max(a, b), walls[t].half_face, static_cast<std::int32_t>(3 * t + k), a < b});
        }
    }
    std::sort(uses.begin(), uses.end());
    Sets corners(3 * walls.size());
    const auto join = [&](const Use &u, const Use &v) {
        CHECK(u.forward != v.forward);
        const auto end = [](const Use &w, int e) { return w.at / 3 * 3 + (w.at % 3 + e) % 3; };
        corners.join(end(u, 0), end(v, 1));
        corners.join(end(u, 1), end(v, 0));
    };
    for (std::size_t i = 0, j; i < uses.size(); i = j) {
        for (j = i; j < uses.size() && uses[j].low == uses[i].low && uses[j].high == uses[i].high; ++j) {}
        CHECK((j - i) % 2 == 0);
        if (j - i == 2) {
            join(uses[i], uses[i + 1]);
            continue;
        }
        /* Several wedges of the cell at one edge. */
        for (std::size_t a = i; a < j; ++a) {
            const auto mate = across.find({uses[a].half_face, uses[a].low, uses[a].high});
            CHECK(mate != across.end());
            for (std::size_t b = a + 1; mate != across.end() && b < j; ++b) {
                if (uses[b].half_face == mate->second) join(uses[a], uses[b]);
            }
        }
    }
    Mesh mesh;
    std::map<std::int32_t, Mesh::VertexHandle> made;
    for (const Wall &wall : walls) {
        std::array<Mesh::VertexHandle, 3> handles;
        for (int k = 0; k < 3; ++k) {
            const std::int32_t umbrella = corners.find(static_cast<std::int32_t>(3 * (&wall - walls.data()) + k));
            const auto place = made.emplace(umbrella, Mesh::VertexHandle());
            if (place.second) {
                const double *p = xyz[wall.vertices[k]];
                place.first->second = mesh.add_vertex(OpenMesh::Vec3d(p[0], p[1], p[2]));
            }
            handles[k] = place.first->second;
        }
        /* Invalid where the edge is taken already: not a manifold, or not oriented. */
        CHECK(mesh.add_face(handles[0], handles[1], handles[2]).is_valid());
    }
    CHECK(mesh.n_faces() == walls.size());
    std::map<std::int32_t, bool> flat;
    for (std::size_t i = 0; i < 3 * walls.size(); ++i) {
        const bool plane = !on_triangle.empty() && on_triangle[walls[i / 3].half_face / 2] == 0;
        const auto place = flat.emplace(corners.find(static_cast<std::int32_t>(i)), plane);
        place.first->second = place.first->second && plane;
        if (place.second) ++umbrellas[walls[i / 3].vertices[i % 3]].all;
    }
    for (const auto &[umbrella, plane] : flat) {
        if (plane) ++umbrellas[walls[umbrella / 3].vertices[umbrella % 3]].flat;
    }
    for (const auto e : mesh.edges()) CHECK(!mesh.is_boundary(e));
    for (const auto v : mesh.vertices()) CHECK(mesh.is_manifold(v) && !mesh.is_isolated(v));
    return static_cast<std::int64_t>(mesh.n_vertices()) - static_cast<std::int64_t>(mesh.n_edges()) +
           static_cast<std::int64_t>(mesh.n_faces());
}

struct Found {
    std::int64_t shells = 0, euler = 0, tubes = 0;
};

/* Checks all shells of a complex. */
inline Found check_shells(const lapidary::complex &complex)
{
    const auto n = complex.counts();
    const auto xyz = complex.vertices();
    const auto faces = complex.faces();
    const auto edges = complex.edges();
    const auto cells = complex.cells();
    const auto adjacency = complex.adjacency();
    const auto triangles = complex.polygons(LAP_FACES_TRIANGLES);

    /* Polygons are in order of faces. */
    std::vector<std::int64_t> first(n.faces + 1, 0);
    for (const std::int32_t f : triangles.faces) ++first[f + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());

    std::map<std::array<std::int32_t, 3>, std::int32_t> across;
    for (std::int64_t h = 0; h < 2 * n.corners; ++h) {
        const std::int32_t mate = adjacency.across(h);
        if (mate < 0) continue;
        const std::int32_t *e = edges[faces.corner_edges[h / 2]];
        across[{static_cast<std::int32_t>(2 * adjacency.faces[h / 2] + h % 2), std::min(e[0], e[1]), std::max(e[0], e[1])}] = mate;
    }

    std::vector<char> on_triangle;
    for (const std::int32_t kind : complex.face_supports().kinds) on_triangle.push_back(kind == LAP_SUPPORT_TRIANGLE);

    std::int64_t doubled = 0, tubes = 0;
    std::map<std::int32_t, Umbrellas> umbrellas;
    for (std::int64_t shell = 0, cell = 0; shell < n.shells; ++shell) {
        if (shell == cells.cell_shells[cell + 1]) {
            ++cell;
            umbrellas.clear();
        }
        std::vector<Wall> walls;
        for (auto k = cells.shell_faces[shell]; k < cells.shell_faces[shell + 1]; ++k) {
            const std::int32_t half_face = cells.half_faces[k], f = half_face / 2;
            for (std::int64_t t = first[f]; t < first[f + 1]; ++t) {
                const auto row = triangles.vertices[t];
                CHECK(row.size() == 3);
                /* The front of a face looks into the cell: outward is the other way round. */
                if (half_face % 2 == 0) walls.push_back({{row[0], row[1], row[2]}, half_face});
                else walls.push_back({{row[0], row[2], row[1]}, half_face});
            }
        }
        doubled += shell_euler(walls, xyz, across, on_triangle, umbrellas);
        if (shell + 1 < cells.cell_shells[cell + 1]) continue;
        for (const auto &[vertex, at] : umbrellas) {
            if (at.flat > 0 && at.all > 1) {
                CHECK(at.flat == 1);
                doubled -= 2 * (at.all - 1);
                ++tubes;
            }
        }
    }
    CHECK(doubled % 2 == 0);
    const std::int64_t euler = n.vertices - n.edges + n.faces - (n.loops - n.faces) - doubled / 2;
    CHECK(euler == complex.euler().output);
    return {n.shells, euler, tubes};
}

} // namespace openmesh_shells

#endif
