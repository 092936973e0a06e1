/* Solids as CGAL's Nef polyhedra over exact rationals, and their volumes. */
#ifndef LAPIDARY_TEST_NEF_HPP
#define LAPIDARY_TEST_NEF_HPP

#include "fixture.hpp"
#include "rational.hpp"

#include <CGAL/Cartesian.h>
#include <CGAL/Nef_polyhedron_3.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/Polyhedron_incremental_builder_3.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <vector>

namespace nef {

using Rational = rational::number;
using Kernel = CGAL::Cartesian<Rational>;
using Polyhedron = CGAL::Polyhedron_3<Kernel>;
using Nef = CGAL::Nef_polyhedron_3<Kernel>;
using Point = Kernel::Point_3;
using Vector = Kernel::Vector_3;

using Triangle = std::array<std::int32_t, 3>;

struct Builder : CGAL::Modifier_base<Polyhedron::HalfedgeDS> {
    const std::vector<Point> &points;
    const std::vector<Triangle> &triangles;
    Builder(const std::vector<Point> &p, const std::vector<Triangle> &t) : points(p), triangles(t) {}
    void operator()(Polyhedron::HalfedgeDS &to) override
    {
        CGAL::Polyhedron_incremental_builder_3<Polyhedron::HalfedgeDS> b(to, true);
        std::map<std::int32_t, int> number;
        b.begin_surface(points.size(), triangles.size());
        for (const Triangle &t : triangles) {
            for (const std::int32_t v : t) {
                if (number.emplace(v, static_cast<int>(number.size())).second) b.add_vertex(points[v]);
            }
        }
        for (const Triangle &t : triangles) {
            b.begin_facet();
            for (const std::int32_t v : t) b.add_vertex_to_facet(number[v]);
            b.end_facet();
        }
        b.end_surface();
    }
};

/* The shells of a mesh, by edges. */
inline std::vector<std::vector<Triangle>> components(const fixture::solid &s)
{
    const std::size_t n = s.indices.size() / 3;
    std::vector<std::size_t> parent(n);
    std::iota(parent.begin(), parent.end(), 0);
    const auto find = [&](std::size_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    std::map<std::pair<std::int32_t, std::int32_t>, std::size_t> at;
    for (std::size_t t = 0; t < n; ++t) {
        for (int k = 0; k < 3; ++k) {
            const auto edge = std::minmax(s.indices[3 * t + k], s.indices[3 * t + (k + 1) % 3]);
            const auto [place, fresh] = at.emplace(edge, t);
            if (!fresh) parent[find(t)] = find(place->second);
        }
    }
    std::map<std::size_t, std::vector<Triangle>> found;
    for (std::size_t t = 0; t < n; ++t) {
        found[find(t)].push_back({s.indices[3 * t], s.indices[3 * t + 1], s.indices[3 * t + 2]});
    }
    std::vector<std::vector<Triangle>> all;
    for (auto &one : found) all.push_back(std::move(one.second));
    return all;
}

inline Rational cone(const Point &a, const Point &b, const Point &c)
{
    return CGAL::determinant(a - CGAL::ORIGIN, b - CGAL::ORIGIN, c - CGAL::ORIGIN);
}

inline Nef solid_of(const fixture::solid &s)
{
    std::vector<Point> points;
    for (std::size_t i = 0; i < s.xyz.size(); i += 3) {
        points.emplace_back(Rational(s.xyz[i]), Rational(s.xyz[i + 1]), Rational(s.xyz[i + 2]));
    }
    std::vector<std::pair<Rational, std::vector<Triangle>>> shells;
    for (auto &triangles : components(s)) {
        Rational volume = 0;
        for (const Triangle &t : triangles) volume += cone(points[t[0]], points[t[1]], points[t[2]]);
        shells.emplace_back(volume, std::move(triangles));
    }
    std::sort(shells.begin(), shells.end(), [](const auto &a, const auto &b) { return CGAL::abs(a.first) > CGAL::abs(b.first); });
    Nef result(Nef::EMPTY);
    for (auto &[volume, triangles] : shells) {
        if (volume < 0) {
            for (Triangle &t : triangles) std::swap(t[0], t[1]);
        }
        Polyhedron p;
        Builder builder(points, triangles);
        p.delegate(builder);
        const Nef shell(p);
        result = volume > 0 ? result + shell : result - shell;
    }
    return result;
}

/* Six times the signed volume inside a shell, from its facets: area vectors of all their cycles times a point. */
struct ShellVolume {
    Rational six = 0;
    void visit(Nef::Halffacet_const_handle f)
    {
        Vector doubled(0, 0, 0);
        Point on = CGAL::ORIGIN;
        for (auto cycle = f->facet_cycles_begin(); cycle != f->facet_cycles_end(); ++cycle) {
            if (!cycle.is_shalfedge()) continue; /* an isolated vertex in a facet */
            const Nef::SHalfedge_const_handle first(cycle);
            Nef::SHalfedge_around_facet_const_circulator e(first), end(e);
            CGAL_For_all(e, end)
            {
                const Point &a = e->source()->center_vertex()->point(), &b = e->next()->source()->center_vertex()->point();
                doubled = doubled + CGAL::cross_product(a - CGAL::ORIGIN, b - CGAL::ORIGIN);
                on = a;
            }
        }
        six += doubled * (on - CGAL::ORIGIN);
    }
    void visit(Nef::SFace_const_handle) {}
    void visit(Nef::Halfedge_const_handle) {}
    void visit(Nef::Vertex_const_handle) {}
    void visit(Nef::SHalfedge_const_handle) {}
    void visit(Nef::SHalfloop_const_handle) {}
};

/* The volumes of the marked, open components, in no order. */
inline std::vector<Rational> volumes(const Nef &piece)
{
    std::vector<Rational> all;
    for (auto c = piece.volumes_begin(); c != piece.volumes_end(); ++c) {
        if (!c->mark()) continue;
        Rational six = 0;
        for (auto shell = c->shells_begin(); shell != c->shells_end(); ++shell) {
            ShellVolume v;
            piece.visit_shell_objects(Nef::SFace_const_handle(shell), v);
            six += v.six;
        }
        all.push_back(CGAL::abs(six) / 6);
    }
    return all;
}

} // namespace nef

#endif
