/* Certified doubles against CGAL: nothing of the library's own geometry is asked here.
 *
 * 1. Every cell as a surface mesh of doubles, its vertices split by umbrellas: CGAL finds no self-intersection. Where splitting put
 *    several vertices at one place, pairs that touch there and nowhere else are not counted: CGAL cannot know that they are one
 *    vertex.
 * 2. All triangles of all faces: no two whose boxes meet have more in common than the vertices that they share by index, by
 *    CGAL's exact tests of triangles, and of triangles and segments.
 * 3. Every cell has a positive volume, exactly.
 *
 * All predicates are CGAL's, exact, and asked about every pair of boxes that meet.
 *
 * Over models of CGAL's data set (few and small ones; all, and more plane sets, with LAPIDARY_LONG), and made-up solids.
 * LAPIDARY_PART=i/n, i from 0, takes every n-th model only, for several processes at once.
 */
#include "check.h"
#include "fixture.hpp"
#include "../examples/reader.hpp"
#include "soup.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <numeric>
#include <random>

namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using soup::Corners;

struct Triangles {
    lapidary::groups<double, 3> xyz;
    lapidary::groups<std::int32_t, 3> corners;
    lapidary::groups<std::int32_t, 2> cells;

    Corners at(std::int64_t t) const { return {corners[t][0], corners[t][1], corners[t][2]}; }
    template <class K> typename K::Point_3 point(std::int32_t v) const { return {xyz[v][0], xyz[v][1], xyz[v][2]}; }
    template <class K> typename K::Triangle_3 triangle(const Corners &t) const
    {
        return {point<K>(t[0]), point<K>(t[1]), point<K>(t[2])};
    }
};

bool only_shared(const Triangles &all, const Corners &a, const Corners &b)
{
    return soup::only_shared<Exact>([&](std::int32_t v) { return all.point<Exact>(v); }, a, b);
}

/* Pairs that CGAL's tests were asked about. */
std::int64_t asked = 0;

bool meet_wrongly(const Triangles &all, const Corners &a, const Corners &b)
{
    ++asked;
    return soup::meet_wrongly<Kernel>([&](std::int32_t v) { return all.point<Kernel>(v); }, a, b);
}

/* All distinct triangles, by boxes: how many are degenerate, and how many pairs meet wrongly. */
std::int64_t check_boxes(const Triangles &all)
{
    using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::int64_t>;
    std::vector<Box> boxes;
    std::int64_t wrong = 0;
    for (std::int64_t t = 0; t < all.corners.count; ++t) {
        const auto triangle = all.triangle<Kernel>(all.at(t));
        /* Without area: wrong, and nothing to ask CGAL's triangle test about. */
        if (triangle.is_degenerate()) ++wrong;
        else boxes.emplace_back(triangle.bbox(), t);
    }
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box &a, const Box &b) {
        wrong += meet_wrongly(all, all.at(a.info()), all.at(b.info()));
    });
    return wrong;
}

/* Triangles of one cell, facing outward, as a surface mesh: corners at a vertex are one vertex of the mesh if triangles lead from
   one to the other across edges that only two of the cell's triangles have. Elsewhere (where the cell meets itself along an
   edge) triangles stay apart, so the mesh has a border there. */
std::int64_t check_cell(const Triangles &all, const std::vector<Corners> &walls)
{
    struct Side {
        std::int32_t low, high;
        std::size_t corner;
    };
    std::vector<Side> sides;
    for (std::size_t t = 0; t < walls.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int32_t a = walls[t][k], b = walls[t][(k + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), 3 * t + k});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side &a, const Side &b) {
        return std::tie(a.low, a.high, a.corner) < std::tie(b.low, b.high, b.corner);
    });
    std::vector<std::size_t> parent(3 * walls.size());
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto find = [&](std::size_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    const auto next = [](std::size_t corner) { return corner / 3 * 3 + (corner + 1) % 3; };
    for (std::size_t i = 0, j; i < sides.size(); i = j) {
        for (j = i; j < sides.size() && sides[j].low == sides[i].low && sides[j].high == sides[i].high; ++j) {}
        CHECK((j - i) % 2 == 0);
        if (j - i != 2) continue;
        const std::size_t a = sides[i].corner, b = sides[i + 1].corner;
        parent[find(a)] = find(next(b));
        parent[find(next(a))] = find(b);
    }
    Mesh mesh;
    std::vector<Mesh::Vertex_index> made(parent.size());
    std::vector<std::int32_t> source;
    for (std::size_t i = 0; i < parent.size(); ++i) {
        if (find(i) != i) continue;
        made[i] = mesh.add_vertex(all.point<Kernel>(walls[i / 3][i % 3]));
        source.push_back(walls[i / 3][i % 3]);
    }
    for (std::size_t t = 0; t < walls.size(); ++t) {
        CHECK(mesh.add_face(made[find(3 * t)], made[find(3 * t + 1)], made[find(3 * t + 2)]) != Mesh::null_face());
    }
    std::vector<std::int32_t> unique = source;
    std::sort(unique.begin(), unique.end());
    if (std::unique(unique.begin(), unique.end()) == unique.end()) {
        return PMP::does_self_intersect(mesh) ? 1 : 0;
    }
    std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> found;
    PMP::self_intersections(mesh, std::back_inserter(found));
    return std::count_if(found.begin(), found.end(), [&](const auto &p) {
        return meet_wrongly(all, walls[static_cast<std::size_t>(p.first)], walls[static_cast<std::size_t>(p.second)]);
    });
}

CGAL::Sign volume_sign(const Triangles &all, const std::vector<Corners> &walls)
{
    /* Certainly positive in doubles, or exactly. */
    const auto o = all.xyz[walls[0][0]];
    double sum = 0, size = 0;
    for (const Corners &t : walls) {
        double m[3][3];
        for (int k = 0; k < 3; ++k) {
            for (int i = 0; i < 3; ++i) m[k][i] = all.xyz[t[k]][i] - o[i];
        }
        for (int i = 0; i < 3; ++i) {
            const double x = m[1][(i + 1) % 3] * m[2][(i + 2) % 3], y = m[1][(i + 2) % 3] * m[2][(i + 1) % 3];
            sum += m[0][i] * (x - y);
            size += std::abs(m[0][i]) * (std::abs(x) + std::abs(y));
        }
    }
    if (sum > 1e-9 * size) return CGAL::POSITIVE;
    Exact::FT six(0);
    for (const Corners &t : walls) {
        six += CGAL::determinant(all.point<Exact>(t[0]) - CGAL::ORIGIN, all.point<Exact>(t[1]) - CGAL::ORIGIN,
                                 all.point<Exact>(t[2]) - CGAL::ORIGIN);
    }
    return CGAL::sign(six);
}

/* The triangles around each cell, facing outward. */
std::vector<std::vector<Corners>> walls_of(const Triangles &all, std::int64_t cells)
{
    std::vector<std::vector<Corners>> walls(static_cast<std::size_t>(cells));
    for (std::int64_t i = 0; i < all.corners.count; ++i) {
        const Corners c = all.at(i);
        if (all.cells[i][0] >= 0) walls[static_cast<std::size_t>(all.cells[i][0])].push_back(c);
        if (all.cells[i][1] >= 0) walls[static_cast<std::size_t>(all.cells[i][1])].push_back({c[0], c[2], c[1]});
    }
    return walls;
}

void run(const std::string &name, const std::string &kind, lapidary::context &context, const lapidary::mesh &mesh,
         const std::vector<double> &planes)
{
    const int before = check_failures;
    /* Of the processor. */
    const auto seconds = [start = std::clock()] { return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC; };
    const lapidary::cut cut(context, mesh, planes);
    const lapidary::certified certified(context, cut.complex());
    const lap_certify_report report = certified.report();
    CHECK(report.certified == 1);
    const auto t = certified.triangles();
    const Triangles all{certified.vertices(), t.vertices, t.cells};
    const double made = seconds();
    asked = 0;
    const std::vector<std::vector<Corners>> walls = walls_of(all, certified.counts().cells);
    std::int64_t wrong_cells = 0, wrong_volumes = 0;
    for (const auto &cell : walls) {
        wrong_cells += check_cell(all, cell) > 0;
        wrong_volumes += volume_sign(all, cell) != CGAL::POSITIVE;
    }
    const double by_cells = seconds();
    const std::int64_t wrong_pairs = check_boxes(all);
    CHECK(wrong_cells == 0);
    CHECK(wrong_volumes == 0);
    CHECK(wrong_pairs == 0);
    std::cout << name << ' ' << kind << ": " << all.corners.count << " triangles, " << walls.size() << " cells, "
              << report.flat_before + report.contacts_before << " defects before, " << report.moved_vertices << " moved, "
              << report.merged_vertices << " merged, " << report.removed_cells << " cells removed; " << asked << " pairs; " << made
              << " s made, " << by_cells - made << " s cells, " << seconds() - by_cells << " s pairs"
              << (check_failures == before ? "" : ": FAILED") << std::endl;
}

std::vector<double> grid(const lapidary::mesh &mesh, int count)
{
    const auto bounds = mesh.bounds();
    std::vector<double> planes;
    for (int axis = 0; axis < 3; ++axis) {
        for (int i = 0; i < count; ++i) {
            for (int k = 0; k < 3; ++k) planes.push_back(k == axis ? 1 : 0);
            planes.push_back(-(bounds[axis] + (bounds[3 + axis] - bounds[axis]) * i / (count - 1)));
        }
    }
    return planes;
}

std::vector<double> arbitrary(const lapidary::mesh &mesh, int count)
{
    const auto bounds = mesh.bounds();
    std::mt19937_64 random(static_cast<std::uint64_t>(count));
    const auto unit = [&] { return static_cast<double>(random() >> 11) / 9007199254740992.0; };
    std::vector<double> planes;
    for (int i = 0; i < count; ++i) {
        double d = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double n = 2 * unit() - 1, x = bounds[axis] + (bounds[3 + axis] - bounds[axis]) * unit();
            planes.push_back(n);
            d -= n * x;
        }
        planes.push_back(d);
    }
    return planes;
}

void all_sets(const std::string &name, const std::vector<double> &xyz, std::vector<std::int32_t> indices, bool everything)
{
    try {
        lapidary::context context;
        const auto make = [&] {
            try {
                return lapidary::mesh(context, xyz, indices);
            } catch (const lapidary::error &) {
                /* A few files are inside out as a whole. */
                for (std::size_t t = 0; t < indices.size(); t += 3) std::swap(indices[t + 1], indices[t + 2]);
                return lapidary::mesh(context, xyz, indices);
            }
        };
        const lapidary::mesh mesh = make();
        run(name, "A5", context, mesh, grid(mesh, 5));
        run(name, "A10", context, mesh, grid(mesh, 10));
        run(name, "R10", context, mesh, arbitrary(mesh, 10));
        run(name, "R30", context, mesh, arbitrary(mesh, 30));
        if (everything) {
            run(name, "A20", context, mesh, grid(mesh, 20));
            run(name, "R100", context, mesh, arbitrary(mesh, 100));
        }
    } catch (const std::exception &e) {
        std::cerr << name << ": " << e.what() << '\n';
        check_that(0, "no exception", __FILE__, __LINE__);
    }
}

/* The programs above find what is wrong: rounded coordinates of a cut that is known to need repair. */
void finds_defects()
{
    const std::vector<double> xyz{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    lapidary::context context;
    const lapidary::mesh mesh(context, xyz, {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3});
    const lapidary::cut cut(context, mesh, grid(mesh, 10));
    lap_certify_options options = lapidary::certify_options();
    options.check_only = 1;
    const lapidary::certified certified(context, cut.complex(), {}, {}, options);
    const auto t = certified.triangles();
    const Triangles all{certified.vertices(), t.vertices, t.cells};
    CHECK(certified.report().certified == 0);
    CHECK(check_boxes(all) > 0);
    std::int64_t wrong_cells = 0, wrong_volumes = 0;
    for (const auto &cell : walls_of(all, certified.counts().cells)) {
        wrong_cells += check_cell(all, cell) > 0;
        wrong_volumes += volume_sign(all, cell) != CGAL::POSITIVE;
    }
    CHECK(wrong_cells > 0 && wrong_volumes > 0);
}

/* The predicates against exact intersections, on lattices so small that nearly everything is coplanar, collinear or touching somewhere;
   a lattice of tenths is one of doubles that are nearly so. */
void predicates_are_right()
{
    std::mt19937_64 random(5);
    std::array<double, 18> xyz;
    std::array<std::int64_t, 3> apart{}, meeting{};
    for (int round = 0; round < 90000; ++round) {
        const std::int32_t shared = round % 3;
        for (double &x : xyz) x = static_cast<double>(random() % 4) * (round % 2 == 0 ? 1 : 0.1);
        /* Planar ones as well, in a plane that is tilted. */
        if (round % 4 < 2) {
            for (std::size_t v = 0; v < 6; ++v) xyz[3 * v + 2] = xyz[3 * v] + xyz[3 * v + 1];
        }
        const Corners a{0, 1, 2}, b{shared > 0 ? 0 : 3, shared > 1 ? 1 : 4, 5};
        const Triangles all{{xyz.data(), 6}, {}, {}};
        if (all.triangle<Kernel>(a).is_degenerate() || all.triangle<Kernel>(b).is_degenerate()) continue;
        const bool meet = !only_shared(all, a, b);
        CHECK(meet_wrongly(all, a, b) == meet && meet_wrongly(all, b, a) == meet);
        ++(meet ? meeting : apart)[static_cast<std::size_t>(shared)];
    }
    for (std::size_t k = 0; k < 3; ++k) {
        CHECK(apart[k] > 1000 && meeting[k] > 1000);
        std::cout << "predicates, " << k << " shared: " << apart[k] << " apart, " << meeting[k] << " meeting\n";
    }
}

} // namespace

int main()
{
    const bool everything = std::getenv("LAPIDARY_LONG") != nullptr;
    finds_defects();
    predicates_are_right();
    const auto [part, parts] = fixture::own_part();
    const fixture::all data = fixture::read(LAPIDARY_TEST_DATA "/cut_small.txt");
    if (part == 0) {
        for (const auto &[name, s] : data.meshes) all_sets(name, s.xyz, s.indices, everything);
    }
    const std::string folder = fixture::cgal_meshes();
    if (folder.empty()) return check_result();
    /* Models that need repair; with LAPIDARY_LONG every closed mesh that does not intersect itself. */
    const std::vector<std::string> few{"tetrahedron.off", "beam.off",   "cross.off",     "anchor.off",
                                       "pinion.off",      "fandisk.off", "triceratops.off", "larger_sphere.off"};
    const std::vector<std::string> files = fixture::mesh_files(folder, few, everything);
    std::size_t models = 0;
    for (std::size_t i = part; i < files.size(); i += parts) {
        const std::string &file = files[i];
        examples::Mesh soup;
        try {
            soup = examples::read_mesh(folder + "/" + file);
            std::vector<Kernel::Point_3> points;
            std::vector<std::array<std::size_t, 3>> polygons;
            for (std::size_t i = 0; i < soup.coordinates.size(); i += 3) {
                points.emplace_back(soup.coordinates[i], soup.coordinates[i + 1], soup.coordinates[i + 2]);
            }
            lapidary::context context;
            lap_mesh_options options = lapidary::mesh_options();
            options.check_self_intersection = 1;
            try {
                lapidary::mesh(context, soup.coordinates, soup.triangles, {}, options);
            } catch (const lapidary::error &e) {
                const bool inside_out = std::all_of(e.defects().begin(), e.defects().end(), [](const lapidary::defect &d) {
                    return d.kind == LAP_DEFECT_WRONG_NESTING;
                });
                if (!inside_out || e.defects().empty()) continue; /* open, or meeting itself: not a solid */
            }
        } catch (const std::exception &e) {
            if (std::find(few.begin(), few.end(), file) != few.end()) {
                std::cerr << file << ": " << e.what() << '\n';
                check_that(0, "the mesh can be read", __FILE__, __LINE__);
            }
            continue;
        }
        ++models;
        all_sets(file, soup.coordinates, soup.triangles, everything);
    }
    CHECK(models > 0 || part > 0);
    std::cout << models << " of CGAL's meshes" << std::endl;
    return check_result();
}
