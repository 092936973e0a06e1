/* The arrangement of functions in one tetrahedron against CGAL's clipping over exact constructions: each plane clips every
 * piece from both sides. Compared, for each choice of signs of the functions: that there is a cell, and its volume, as equal
 * rationals. Random values with all bits, small integers (planes through corners, edges and faces, coincident planes), and
 * values near a common point. The volumes of an interface's cells are those of the pieces on which a material is maximal.
 */
#include "check.h"
#include "lapidary.hpp"
#include "rational.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/clip.h>
#include <CGAL/Surface_mesh.h>

#include <chrono>
#include <iostream>
#include <map>
#include <random>
#include <sstream>

namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Point = Kernel::Point_3;
using Plane = Kernel::Plane_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Number = Kernel::FT;
using Rational = rational::number;
using Values = std::vector<double>;
/* Volumes, as parts of the tetrahedron, by label. */
using Volumes = std::map<std::vector<int>, Rational>;

Rational exact(const Number &x)
{
    std::ostringstream text;
    text << CGAL::exact(x);
    return rational::parse(text.str());
}

/* The tetrahedron 0, x, y, z: there barycentric coordinates of corners 1 to 3 are coordinates. */
Mesh tetrahedron()
{
    Mesh mesh;
    const auto o = mesh.add_vertex(Point(0, 0, 0)), x = mesh.add_vertex(Point(1, 0, 0)), y = mesh.add_vertex(Point(0, 1, 0)),
               z = mesh.add_vertex(Point(0, 0, 1));
    CHECK(mesh.add_face(o, y, x) != Mesh::null_face());
    CHECK(mesh.add_face(o, x, z) != Mesh::null_face());
    CHECK(mesh.add_face(o, z, y) != Mesh::null_face());
    CHECK(mesh.add_face(x, y, z) != Mesh::null_face());
    return mesh;
}

/* A linear function by its values at the corners. */
using Form = std::array<Number, 4>;

Number at(const Form &f, const Point &p)
{
    return f[0] + (f[1] - f[0]) * p.x() + (f[2] - f[0]) * p.y() + (f[3] - f[0]) * p.z();
}

/* The part of a piece where a function has a sign; empty if that has no volume. */
Mesh side(const Mesh &piece, const Form &f, bool positive)
{
    bool wanted = false, other = false;
    for (const auto v : vertices(piece)) {
        const auto sign = CGAL::sign(at(f, piece.point(v)));
        if (sign == CGAL::ZERO) continue;
        ((sign == CGAL::POSITIVE) == positive ? wanted : other) = true;
    }
    if (!wanted) return {};
    Mesh part = piece;
    if (!other) return part;
    const Plane plane(f[1] - f[0], f[2] - f[0], f[3] - f[0], f[0]);
    PMP::clip(part, positive ? plane.opposite() : plane, CGAL::parameters::clip_volume(true));
    part.collect_garbage();
    return part;
}

/* As a part of the tetrahedron, whose volume is 1/6. */
Rational volume(const Mesh &mesh)
{
    Number six = 0;
    for (const auto f : faces(mesh)) {
        const auto h = halfedge(f, mesh);
        const Point &a = mesh.point(source(h, mesh)), &b = mesh.point(target(h, mesh)), &c = mesh.point(target(next(h, mesh), mesh));
        six += CGAL::determinant(a - CGAL::ORIGIN, b - CGAL::ORIGIN, c - CGAL::ORIGIN);
    }
    return exact(six);
}

Form form(const Values &values, std::size_t function)
{
    const double *v = values.data() + 4 * function;
    return {Number(v[0]), Number(v[1]), Number(v[2]), Number(v[3])};
}

bool vanishes(const Form &f)
{
    return f[0] == 0 && f[1] == 0 && f[2] == 0 && f[3] == 0;
}

Volumes arrangement_by_clipping(const Values &values)
{
    std::map<std::vector<int>, Mesh> pieces{{{}, tetrahedron()}};
    for (std::size_t i = 0; i < values.size() / 4; ++i) {
        const Form f = form(values, i);
        std::map<std::vector<int>, Mesh> next;
        for (const auto &[label, piece] : pieces) {
            for (const int sign : {-1, 1}) {
                auto longer = label;
                longer.push_back(vanishes(f) ? 0 : sign);
                Mesh part = vanishes(f) ? piece : side(piece, f, sign > 0);
                if (num_faces(part) > 0) next.emplace(std::move(longer), std::move(part));
            }
        }
        pieces.swap(next);
    }
    Volumes all;
    for (const auto &[label, piece] : pieces) all[label] = volume(piece);
    return all;
}

Volumes interface_by_clipping(const Values &values)
{
    Volumes all;
    const std::size_t n = values.size() / 4;
    for (std::size_t i = 0; i < n; ++i) {
        Mesh piece = tetrahedron();
        for (std::size_t j = 0; j < n && num_faces(piece) > 0; ++j) {
            Form difference = form(values, i);
            const Form other = form(values, j);
            for (int k = 0; k < 4; ++k) difference[k] -= other[k];
            if (vanishes(difference)) {
                /* Of equal materials the lowest owns. */
                if (j < i) piece = {};
            } else {
                piece = side(piece, difference, true);
            }
        }
        if (num_faces(piece) > 0) all[{static_cast<int>(i)}] = volume(piece);
    }
    return all;
}

struct tally {
    int inputs = 0;
    std::int64_t cells = 0;
    double ours = 0, theirs = 0;
};

double seconds_since(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void compare(lapidary::context &context, lapidary::simplex &simplex, std::int32_t kind, const Values &values, tally &sum)
{
    const auto start = std::chrono::steady_clock::now();
    simplex.compute(context, kind, 3, values);
    Volumes ours;
    const std::int64_t cells = simplex.counts().cells;
    for (std::int32_t cell = 0; cell < cells; ++cell) {
        std::vector<int> label;
        if (kind == LAP_SIMPLEX_ARRANGEMENT) {
            const auto signs = simplex.cell_signs(cell);
            label.assign(signs.begin(), signs.end());
        } else {
            label.push_back(simplex.cell_materials().owners[cell]);
        }
        CHECK(ours.emplace(std::move(label), rational::parse(simplex.exact_cell_volume(context, cell))).second);
    }
    sum.ours += seconds_since(start);
    const auto middle = std::chrono::steady_clock::now();
    const Volumes theirs = kind == LAP_SIMPLEX_ARRANGEMENT ? arrangement_by_clipping(values) : interface_by_clipping(values);
    sum.theirs += seconds_since(middle);
    CHECK(ours == theirs);
    if (ours != theirs) {
        std::cerr << "values";
        for (const double v : values) std::cerr << ' ' << std::hexfloat << v << std::defaultfloat;
        std::cerr << ": " << ours.size() << " cells, by clipping " << theirs.size() << '\n';
    }
    ++sum.inputs;
    sum.cells += static_cast<std::int64_t>(theirs.size());
}

/* Values of n functions: all bits, small integers, or planes that nearly meet in a point. */
Values random_values(std::mt19937_64 &random, int n, int style)
{
    std::uniform_real_distribution<double> real(-1, 1);
    std::uniform_int_distribution<int> small(-1, 1);
    Values values;
    for (int i = 0; i < 4 * n; ++i) values.push_back(style == 1 ? small(random) : real(random));
    if (style == 2) {
        for (int f = 0; f < n; ++f) {
            double *v = values.data() + 4 * f;
            const double middle = 0.1 * v[0] + 0.2 * v[1] + 0.3 * v[2] + 0.4 * v[3];
            for (int k = 0; k < 4; ++k) v[k] -= middle;
        }
    }
    return values;
}

} // namespace

int main()
{
    static const char *const styles[] = {"all bits", "small integers", "nearly through a point"};
    lapidary::context context;
    lapidary::simplex simplex;
    std::mt19937_64 random(7);
    for (const std::int32_t kind : {LAP_SIMPLEX_ARRANGEMENT, LAP_SIMPLEX_INTERFACE}) {
        for (int style = 0; style < 3; ++style) {
            tally sum;
            /* Clipping takes seconds where many planes nearly meet. */
            for (int n = kind == LAP_SIMPLEX_ARRANGEMENT ? 0 : 1; n <= (style == 2 ? 4 : 6); ++n) {
                const int inputs = n <= 3 ? 40 : 10;
                for (int i = 0; i < inputs; ++i) compare(context, simplex, kind, random_values(random, n, style), sum);
            }
            std::cout << (kind == LAP_SIMPLEX_ARRANGEMENT ? "arrangement" : "interface") << ", " << styles[style] << ": "
                      << sum.inputs << " tetrahedra, " << sum.cells << " cells; " << sum.ours << " s, by clipping "
                      << sum.theirs << " s" << std::endl;
        }
    }
    return check_result();
}
