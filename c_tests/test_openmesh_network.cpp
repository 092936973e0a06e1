/* Networks against OpenMesh. Patches: polygons joined across the edges that are not on chains must be accepted as an oriented
   manifold whose boundary is the chain edges and the borders, nothing else. Regions: with the walls of the domain, every shell is closed
   (openmesh_shells.hpp), and volumes add up to that of the domain. Boundaries of solids of regions: closed where they do not
   reach the domain's boundary. */
#include "check.h"
#include "openmesh_shells.hpp"

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>

#include <cmath>
#include <iostream>
#include <string>

namespace {

using openmesh_shells::Sets;
using PolyMesh = OpenMesh::PolyMesh_ArrayKernelT<openmesh_shells::Traits>;
using sphere = std::array<double, 4>;

constexpr int cubes = 20;

/* Four spheres of radius nearly 1/2 about the origin and nearly 1/2 from it along each axis; nested ones; and four apart, whose distances
   make materials. */
const std::vector<sphere> four = {{3.5e-4, -1.1e-4, 4.9e-4, 0.4993},
                                  {0.4994, 5.0e-4, 8.7e-4, 0.5009},
                                  {4.3e-4, 0.4994, -3.2e-5, 0.5007},
                                  {7.8e-4, 2.6e-4, 0.5003, 0.4998}};
const std::vector<sphere> nested = {{2.5e-4, 4.8e-4, 5.9e-4, 0.251}, {4.8e-4, 8.4e-4, -9.4e-4, 0.399}, {8.9e-4, 3.0e-4, 8.0e-4, 0.551},
                                    {-6.2e-5, -5.1e-4, 8.8e-5, 0.7}, {-9.7e-4, -5.7e-4, -4.4e-4, 0.952}};
const std::vector<sphere> materials = {{0.0027, 0.2767, 0.6209, 0.0867},
                                       {-0.1768, 0.0084, 0.2971, 0.0458},
                                       {-0.3321, -0.4215, -0.3892, 0.0951},
                                       {0.1790, -0.6217, 0.6346, 0.0823}};

std::vector<double> evaluate(const std::vector<sphere> &spheres)
{
    std::vector<double> values;
    for (const sphere &s : spheres) {
        for (int k = 0; k <= cubes; ++k) {
            for (int j = 0; j <= cubes; ++j) {
                for (int i = 0; i <= cubes; ++i) {
                    const double x = 2.0 * i / cubes - 1 - s[0], y = 2.0 * j / cubes - 1 - s[1], z = 2.0 * k / cubes - 1 - s[2];
                    values.push_back(s[3] - std::sqrt(x * x + y * y + z * z));
                }
            }
        }
    }
    return values;
}

/* An edge of a network by its ends, and what OpenMesh is to find there. */
using ends = std::array<std::int32_t, 2>;

struct Polygon {
    std::vector<std::int32_t> vertices;
};

/* Makes OpenMesh's mesh of oriented polygons, joined across edges that two of them share unless `apart` holds, and checks that exactly
   the others are its boundary; how many those are. */
std::int64_t check_surface(const std::vector<Polygon> &polygons, const lapidary::groups<double, 3> &xyz,
                           const std::map<ends, bool> &apart)
{
    std::vector<std::int32_t> first(1, 0);
    for (const Polygon &p : polygons) first.push_back(first.back() + static_cast<std::int32_t>(p.vertices.size()));
    Sets corners(first.back());
    const auto next = [&](std::size_t p, std::size_t k) { return k + 1 == polygons[p].vertices.size() ? 0 : k + 1; };
    struct Side {
        std::size_t polygon, at;
        bool forward;
    };
    std::map<ends, std::vector<Side>> sides;
    for (std::size_t p = 0; p < polygons.size(); ++p) {
        for (std::size_t k = 0; k < polygons[p].vertices.size(); ++k) {
            const std::int32_t a = polygons[p].vertices[k], b = polygons[p].vertices[next(p, k)];
            sides[{std::min(a, b), std::max(a, b)}].push_back({p, k, a < b});
        }
    }
    std::int64_t open = 0;
    for (const auto &[edge, uses] : sides) {
        const auto known = apart.find(edge);
        if (known != apart.end() && known->second) {
            open += static_cast<std::int64_t>(uses.size());
            continue;
        }
        CHECK(uses.size() == 2);
        if (uses.size() != 2) continue;
        CHECK(uses[0].forward != uses[1].forward);
        const auto end = [&](const Side &s, bool far) {
            return first[s.polygon] + static_cast<std::int32_t>(far ? next(s.polygon, s.at) : s.at);
        };
        corners.join(end(uses[0], false), end(uses[1], true));
        corners.join(end(uses[0], true), end(uses[1], false));
    }
    PolyMesh mesh;
    std::map<std::int32_t, PolyMesh::VertexHandle> made;
    for (std::size_t p = 0; p < polygons.size(); ++p) {
        std::vector<PolyMesh::VertexHandle> handles;
        for (std::size_t k = 0; k < polygons[p].vertices.size(); ++k) {
            const auto place = made.emplace(corners.find(first[p] + static_cast<std::int32_t>(k)), PolyMesh::VertexHandle());
            if (place.second) {
                const double *x = xyz[polygons[p].vertices[k]];
                place.first->second = mesh.add_vertex(OpenMesh::Vec3d(x[0], x[1], x[2]));
            }
            handles.push_back(place.first->second);
        }
        CHECK(mesh.add_face(handles).is_valid());
    }
    CHECK(mesh.n_faces() == polygons.size());
    std::int64_t boundary = 0;
    for (const auto e : mesh.edges()) boundary += mesh.is_boundary(e);
    for (const auto v : mesh.vertices()) CHECK(mesh.is_manifold(v) && !mesh.is_isolated(v));
    CHECK(boundary == open);
    return boundary;
}

void run(const std::string &name, const std::vector<sphere> &spheres, std::int32_t kind)
{
    const int before = check_failures;
    lapidary::context context;
    lapidary::network::values_t values;
    const std::vector<double> data = evaluate(spheres);
    values.data = data.data();
    values.functions = static_cast<std::int64_t>(spheres.size());
    values.function_stride = (cubes + 1) * (cubes + 1) * (cubes + 1);
    auto options = lapidary::network_options();
    options.kind = kind;
    options.keep_values = 1;
    const double bounds[6] = {-1, -1, -1, 1, 1, 1};
    const auto network = lapidary::network::box(context, {cubes, cubes, cubes}, bounds, values, options);
    const auto n = network.counts();
    const auto xyz = network.vertices().xyz;
    const auto rows = network.polygons().vertices;

    /* Edges where patches end: chains, and those with one polygon. */
    const auto edges = network.edges();
    const auto chains = network.chains();
    std::map<ends, bool> apart;
    const auto part = [&](std::int32_t e) { apart[{edges.vertices[e][0], edges.vertices[e][1]}] = true; };
    for (std::int32_t e = 0; e < n.edges; ++e) {
        if (edges.polygons[e].size() == 1) part(e);
    }
    std::int64_t chain_polygons = 0, borders = static_cast<std::int64_t>(apart.size());
    for (std::int64_t c = 0; c < n.chains; ++c) {
        for (const std::int32_t e : chains.edges[c]) {
            part(e);
            chain_polygons += edges.polygons[e].size();
        }
    }
    const auto of = network.polygon_patches();
    std::vector<std::vector<Polygon>> patches(n.patches);
    for (std::int64_t p = 0; p < n.polygons; ++p) {
        const auto row = rows[p];
        std::vector<std::int32_t> loop(row.begin(), row.end());
        if (of.turned[p] != 0) std::reverse(loop.begin(), loop.end());
        patches[of.patches[p]].push_back({loop});
    }
    std::int64_t ends_of_patches = 0;
    for (const auto &patch : patches) ends_of_patches += check_surface(patch, xyz, apart);
    CHECK(ends_of_patches == chain_polygons + borders);

    /* Regions with the walls. */
    const lapidary::complex complex = network.complex(context);
    const openmesh_shells::Found found = openmesh_shells::check_shells(complex);
    CHECK(complex.counts().cells == n.regions && found.euler == 1);
    double volume = 0;
    for (const double v : complex.cell_moments().volumes) volume += v;
    CHECK(std::fabs(volume - 8) < 1e-12);

    /* Solids: one function positive, where that does not reach the boundary of the domain. */
    std::int64_t solids = 0;
    for (std::size_t f = 0; f < spheres.size(); ++f) {
        double reach = 0;
        for (int k = 0; k < 3; ++k) reach = std::max(reach, std::fabs(spheres[f][k]) + spheres[f][3]);
        if (kind == LAP_NETWORK_INTERFACE || reach > 1) continue;
        const auto surface = network.csg(context, std::to_string(f));
        const auto loops = surface.polygons().vertices;
        std::vector<Polygon> polygons;
        for (std::int64_t p = 0; p < loops.size(); ++p) polygons.push_back({{loops[p].begin(), loops[p].end()}});
        CHECK(check_surface(polygons, surface.vertices().xyz, {}) == 0);
        ++solids;
    }
    std::cout << name << ": " << n.patches << " patches with " << ends_of_patches << " sides on chains and borders, " << n.regions
              << " regions with " << found.shells << " shells, " << solids << " solids"
              << (check_failures == before ? "" : ": FAILED") << '\n';
}

} // namespace

int main()
{
    const auto attempt = [](const std::string &name, const std::vector<sphere> &spheres, std::int32_t kind) {
        try {
            run(name, spheres, kind);
        } catch (const std::exception &e) {
            std::cerr << name << ": " << e.what() << '\n';
            check_that(0, "no exception", __FILE__, __LINE__);
        }
    };
    attempt("four spheres, arrangement", four, LAP_NETWORK_ARRANGEMENT);
    attempt("four spheres, interface", four, LAP_NETWORK_INTERFACE);
    attempt("nested spheres, arrangement", nested, LAP_NETWORK_ARRANGEMENT);
    attempt("spheres apart, arrangement", materials, LAP_NETWORK_ARRANGEMENT);
    attempt("spheres apart, interface", materials, LAP_NETWORK_INTERFACE);
    return check_result();
}
