/* Small and nasty cuts against CGAL's Nef polyhedra over exact rationals.
 *
 * The solid is built from its shells (largest first: solids are added, voids taken away), each plane splits every
 * piece, and the open components of a piece are its cells. Compared, for each choice of sides of the planes: number of cells,
 * volumes as equal rationals, and vertices. Nef polyhedra merge coplanar facets, so their vertices are a subset of ours; each
 * further one of ours must have all its faces in that cell on at most two planes, and with two of them, edges of the
 * cell must leave it in opposite directions along the line where they meet.
 */
#include "check.h"
#include "fixture.hpp"
#include "nef.hpp"
#include "rational.hpp"

#include <algorithm>
#include <functional>
#include <set>

namespace {

using nef::Kernel;
using nef::Nef;
using nef::Point;
using nef::Rational;
using nef::Vector;
using Plane = Kernel::Plane_3;

struct Side {
    std::vector<Rational> volumes;
    std::set<Point> vertices;
};

/* The open components of a piece: all shells of each marked volume. */
Side side_of(const Nef &piece)
{
    Side side;
    side.volumes = nef::volumes(piece);
    std::sort(side.volumes.begin(), side.volumes.end());
    for (auto v = piece.vertices_begin(); v != piece.vertices_end(); ++v) side.vertices.insert(v->point());
    return side;
}

std::map<std::string, Side> by_nef(const fixture::cutting &c, const fixture::solid &s)
{
    std::map<std::string, Nef> pieces{{"", nef::solid_of(s)}};
    for (std::size_t i = 0; i < c.planes.size(); i += 4) {
        const Plane plane(Rational(c.planes[i]), Rational(c.planes[i + 1]), Rational(c.planes[i + 2]), Rational(c.planes[i + 3]));
        std::map<std::string, Nef> next;
        for (const auto &[signs, piece] : pieces) {
            const Nef halves[2] = {piece.intersection(plane, Nef::CLOSED_HALFSPACE).regularization(),
                                   piece.intersection(plane.opposite(), Nef::CLOSED_HALFSPACE).regularization()};
            for (const Nef &half : halves) {
                if (half.is_empty()) continue;
                /* Which half is which: any vertex off the plane tells. */
                char sign = 0;
                for (auto v = half.vertices_begin(); v != half.vertices_end() && sign == 0; ++v) {
                    const auto where = plane.oriented_side(v->point());
                    if (where != CGAL::ON_ORIENTED_BOUNDARY) sign = where == CGAL::ON_POSITIVE_SIDE ? '+' : '-';
                }
                CHECK(sign != 0 && next.count(signs + sign) == 0);
                next.emplace(signs + sign, half);
            }
        }
        pieces.swap(next);
    }
    std::map<std::string, Side> sides;
    for (const auto &[signs, piece] : pieces) sides.emplace(signs, side_of(piece));
    return sides;
}

/* Ours, exactly. */
struct Ours {
    lapidary::complex complex;
    std::vector<Point> points;
    std::vector<Plane> face_planes;

    Ours(lapidary::context &context, const lapidary::complex &c, const fixture::cutting &cutting, const fixture::solid &s)
        : complex(c)
    {
        for (std::int32_t v = 0; v < c.counts().vertices; ++v) {
            const auto xyz = c.exact_vertex(context, v);
            points.emplace_back(rational::parse(xyz[0]), rational::parse(xyz[1]), rational::parse(xyz[2]));
            /* Rounding, on the way. */
            for (int axis = 0; axis < 3; ++axis) {
                CHECK(rational::is_nearest(c.vertices()[v][axis], points.back()[axis]));
            }
        }
        const auto supports = c.face_supports();
        const auto point = [&](std::int32_t v) {
            return Point(Rational(s.xyz[3 * v]), Rational(s.xyz[3 * v + 1]), Rational(s.xyz[3 * v + 2]));
        };
        for (std::int64_t f = 0; f < c.counts().faces; ++f) {
            const std::int32_t id = supports.ids[f];
            if (supports.kinds[f] == LAP_SUPPORT_TRIANGLE) {
                const std::int32_t *t = &s.indices[3 * id];
                face_planes.emplace_back(point(t[0]), point(t[1]), point(t[2]));
            } else {
                const double *p = &cutting.planes[4 * id];
                face_planes.emplace_back(Rational(p[0]), Rational(p[1]), Rational(p[2]), Rational(p[3]));
            }
        }
    }

    bool same_plane(std::int32_t f, std::int32_t g) const
    {
        return face_planes[f] == face_planes[g] || face_planes[f] == face_planes[g].opposite();
    }

    /* The vertices of a cell, and those of them that Nef polyhedra may leave out: on at most two planes of the cell, and
       with a straight angle where there are two. */
    void add_vertices(std::int32_t cell, std::set<Point> &all, std::set<Point> &needed) const
    {
        const auto faces = complex.faces();
        const auto edges = complex.edges();
        std::map<std::int32_t, std::set<std::int32_t>> at, along;
        for (const std::int32_t half_face : complex.cells().of(cell)) {
            const std::int32_t f = half_face / 2;
            for (auto k = faces.loop_corners[faces.face_loops[f]]; k < faces.loop_corners[faces.face_loops[f + 1]]; ++k) {
                at[faces.corner_vertices[k]].insert(f);
                if (faces.corner_edges[k] < 0) continue;
                for (int end = 0; end < 2; ++end) along[edges[faces.corner_edges[k]][end]].insert(faces.corner_edges[k]);
            }
        }
        for (const auto &[v, incident] : at) {
            all.insert(points[v]);
            std::vector<std::int32_t> planes;
            for (const std::int32_t f : incident) {
                if (std::none_of(planes.begin(), planes.end(), [&](std::int32_t g) { return same_plane(f, g); })) planes.push_back(f);
            }
            bool flat = planes.size() == 1;
            if (planes.size() == 2) {
                std::vector<Vector> on_both;
                for (const std::int32_t e : along[v]) {
                    const Point &other = points[edges[e][0] == v ? edges[e][1] : edges[e][0]];
                    if (face_planes[planes[0]].has_on(other) && face_planes[planes[1]].has_on(other)) on_both.push_back(other - points[v]);
                }
                for (const Vector &a : on_both) {
                    for (const Vector &b : on_both) flat = flat || a * b < 0;
                }
            }
            if (!flat) needed.insert(points[v]);
        }
    }
};

void run(const fixture::cutting &c, const fixture::solid &s)
{
    const int before = check_failures;
    lapidary::context context;
    const lapidary::mesh mesh(context, s.xyz, s.indices);
    const lapidary::cut cut(context, mesh, c.planes);
    const Ours ours(context, cut.complex(), c, s);
    const std::int32_t n_planes = static_cast<std::int32_t>(c.planes.size() / 4);

    std::map<std::string, std::vector<std::int32_t>> cells;
    for (std::int32_t cell = 0; cell < cut.complex().counts().cells; ++cell) {
        cells[fixture::signs(cut.complex(), cell, n_planes)].push_back(cell);
    }
    const std::map<std::string, Side> theirs = by_nef(c, s);
    CHECK(theirs.size() == cells.size());
    std::int64_t count = 0;
    for (const auto &[signs, side] : theirs) {
        count += static_cast<std::int64_t>(side.volumes.size());
        CHECK(cells.count(signs) == 1);
        std::vector<Rational> volumes;
        std::set<Point> all, needed;
        for (const std::int32_t cell : cells[signs]) {
            volumes.push_back(rational::parse(cut.complex().exact_cell_volume(context, cell)));
            CHECK(rational::within_ulps(cut.complex().cell_moments().volumes[cell], volumes.back(), 4));
            ours.add_vertices(cell, all, needed);
        }
        std::sort(volumes.begin(), volumes.end());
        CHECK(volumes == side.volumes);
        CHECK(std::includes(all.begin(), all.end(), side.vertices.begin(), side.vertices.end()));
        CHECK(std::includes(side.vertices.begin(), side.vertices.end(), needed.begin(), needed.end()));
    }
    CHECK(count == c.cells);
    std::cout << c.name << ": " << count << " cells" << (check_failures == before ? "" : ": FAILED") << std::endl;
}

} // namespace

int main(int argc, char **argv)
{
    const fixture::all data = fixture::read(LAPIDARY_TEST_DATA "/cut_small.txt");
    for (const fixture::cutting &c : data.cuttings) {
        const fixture::solid &s = data.meshes.at(c.mesh);
        if (argc > 1 ? c.name != argv[1] : s.indices.size() / 3 > 200) continue; /* Nef polyhedra are slow */
        try {
            run(c, s);
        } catch (const std::exception &e) {
            std::cerr << c.name << ": " << e.what() << '\n';
            check_that(0, "no exception", __FILE__, __LINE__);
        }
    }
    return check_result();
}
