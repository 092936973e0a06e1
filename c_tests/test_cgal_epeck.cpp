/* Larger cuts against CGAL's Polygon Mesh Processing over exact constructions: each plane clips every piece from both
 * sides, closed again, and the volume components of a piece are its cells. Compared, for each choice of sides of the planes:
 * the volumes as equal rationals, and so the number of cells.
 *
 * Planes are in general position here: degenerate ones are test_cgal_nef's.
 */
#include "check.h"
#include "fixture.hpp"
#include "rational.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/clip.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <sstream>

namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Point = Kernel::Point_3;
using Plane = Kernel::Plane_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Rational = rational::number;
using Volumes = std::map<std::string, std::vector<Rational>>;

/* CGAL's exact number type differs from build to build. */
Rational exact(const Kernel::FT &x)
{
    std::ostringstream text;
    text << CGAL::exact(x);
    return rational::parse(text.str());
}

Mesh mesh_of(const fixture::solid &s)
{
    Mesh mesh;
    for (std::size_t i = 0; i < s.xyz.size(); i += 3) mesh.add_vertex(Point(s.xyz[i], s.xyz[i + 1], s.xyz[i + 2]));
    for (std::size_t t = 0; t < s.indices.size(); t += 3) {
        const auto vertex = [&](int k) { return Mesh::Vertex_index(static_cast<std::uint32_t>(s.indices[t + k])); };
        CHECK(mesh.add_face(vertex(0), vertex(1), vertex(2)) != Mesh::null_face());
    }
    return mesh;
}

/* The volumes of the components of a closed mesh, voids taken off. */
std::vector<Rational> components(Mesh mesh)
{
    std::map<std::size_t, Kernel::FT> six;
    auto component = mesh.add_property_map<Mesh::Face_index, std::size_t>("f:component", 0).first;
    PMP::volume_connected_components(mesh, component, CGAL::parameters::do_orientation_tests(false));
    for (const auto f : faces(mesh)) {
        const auto h = halfedge(f, mesh);
        const Point &a = mesh.point(source(h, mesh)), &b = mesh.point(target(h, mesh)), &c = mesh.point(target(next(h, mesh), mesh));
        six[component[f]] += CGAL::determinant(a - CGAL::ORIGIN, b - CGAL::ORIGIN, c - CGAL::ORIGIN);
    }
    std::vector<Rational> volumes;
    for (const auto &one : six) volumes.push_back(exact(one.second) / 6);
    std::sort(volumes.begin(), volumes.end());
    return volumes;
}

Volumes by_clipping(const std::vector<double> &planes, const fixture::solid &s)
{
    std::map<std::string, Mesh> pieces{{"", mesh_of(s)}};
    for (std::size_t i = 0; i < planes.size(); i += 4) {
        const Plane plane(planes[i], planes[i + 1], planes[i + 2], planes[i + 3]);
        std::map<std::string, Mesh> next;
        for (const auto &[signs, piece] : pieces) {
            for (const bool positive : {false, true}) {
                /* What is on the negative side of a plane stays. */
                Mesh part = piece;
                PMP::clip(part, positive ? plane.opposite() : plane, CGAL::parameters::clip_volume(true));
                part.collect_garbage();
                if (num_faces(part) > 0) next.emplace(signs + (positive ? '+' : '-'), std::move(part));
            }
        }
        pieces.swap(next);
    }
    Volumes all;
    for (const auto &[signs, piece] : pieces) all[signs] = components(piece);
    return all;
}

void run(const std::string &name, const fixture::solid &s, const std::vector<double> &planes)
{
    const int before = check_failures;
    lapidary::context context;
    const lapidary::mesh mesh(context, s.xyz, s.indices);
    const auto start = std::chrono::steady_clock::now();
    const lapidary::cut cut(context, mesh, planes);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    Volumes ours;
    const lapidary::complex complex = cut.complex();
    complex.check_consistency(context);
    for (std::int32_t cell = 0; cell < complex.counts().cells; ++cell) {
        const Rational volume = rational::parse(complex.exact_cell_volume(context, cell));
        CHECK(rational::within_ulps(complex.cell_moments().volumes[cell], volume, 4));
        ours[fixture::signs(complex, cell, static_cast<std::int32_t>(planes.size() / 4))].push_back(volume);
    }
    for (auto &one : ours) std::sort(one.second.begin(), one.second.end());
    const auto middle = std::chrono::steady_clock::now();
    const Volumes theirs = by_clipping(planes, s);
    CHECK(ours == theirs);
    std::cout << name << ": " << complex.counts().cells << " cells; " << seconds << " s, by clipping "
              << std::chrono::duration<double>(std::chrono::steady_clock::now() - middle).count() << " s"
              << (check_failures == before ? "" : ": FAILED") << std::endl;
}

/* Planes in general position through the middle of a mesh. */
std::vector<double> planes_through(const fixture::solid &s, int count)
{
    static const double normals[5][3] = {{1, 0.1, -0.03}, {-0.07, 1, 0.2}, {0.3, -0.11, 1}, {0.7, 0.5, -0.9}, {-0.6, 0.8, 0.37}};
    double low[3] = {1e300, 1e300, 1e300}, high[3] = {-1e300, -1e300, -1e300};
    for (std::size_t i = 0; i < s.xyz.size(); ++i) {
        low[i % 3] = std::min(low[i % 3], s.xyz[i]);
        high[i % 3] = std::max(high[i % 3], s.xyz[i]);
    }
    std::vector<double> planes;
    for (int i = 0; i < count; ++i) {
        double d = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double at = 0.5 + 0.013 * (i + 1) * (axis - 1);
            planes.push_back(normals[i][axis]);
            d -= normals[i][axis] * (low[axis] + at * (high[axis] - low[axis]));
        }
        planes.push_back(d);
    }
    return planes;
}

/* A closed OFF file; polygons are fanned from their first vertex. */
fixture::solid read_off(const std::string &path)
{
    std::ifstream in(path);
    std::string word;
    std::size_t vertices = 0, faces = 0, edges = 0;
    fixture::solid s;
    in >> word >> vertices >> faces >> edges;
    for (std::size_t i = 0; i < 3 * vertices && in >> word; ++i) s.xyz.push_back(std::strtod(word.c_str(), nullptr));
    for (std::size_t f = 0; f < faces; ++f) {
        std::int32_t corners = 0, first = 0, last = 0, v = 0;
        in >> corners >> first >> last;
        for (int k = 2; k < corners && in >> v; ++k) {
            s.indices.insert(s.indices.end(), {first, last, v});
            last = v;
        }
    }
    CHECK(!in.fail() && !s.indices.empty());
    return s;
}

void guarded(const std::string &name, const fixture::solid &s, int count)
{
    try {
        run(name, s, planes_through(s, count));
    } catch (const std::exception &e) {
        std::cerr << name << ": " << e.what() << '\n';
        check_that(0, "no exception", __FILE__, __LINE__);
    }
}

} // namespace

int main()
{
    const fixture::all data = fixture::read(LAPIDARY_TEST_DATA "/cut_small.txt");
    for (const char *name : {"eight", "torus", "stair"}) {
        guarded(name, data.meshes.at(name), 5);
    }
#ifdef LAPIDARY_TEST_MESHES
    for (const char *name : {"elephant", "3torus", "couplingdown"}) {
        const std::string path = std::string(LAPIDARY_TEST_MESHES "/") + name + ".off";
        if (!std::filesystem::exists(path)) {
            std::cout << name << ": skipped, " << path << " is not there" << std::endl;
            continue;
        }
        const fixture::solid s = read_off(path);
        guarded(name, s, 3);
    }
#else
    std::cout << "elephant, 3torus, couplingdown: skipped, CGAL's meshes were not given (LAPIDARY_MESHES)" << std::endl;
#endif
    return check_result();
}
