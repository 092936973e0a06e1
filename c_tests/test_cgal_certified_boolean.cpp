/* Certified booleans against CGAL: of cubes of grids that are turned by an irrational angle and rounded, both apart, so that planes which were the
 * same become nearly the same, and of pairs of CGAL's meshes.
 *
 * What is asked of the doubles as they are, by CGAL's predicates: each place is one vertex; every edge is walked as often either way, and every
 * triangle has an area; no two triangles meet but in what they share (by PMP::does_self_intersect where the surface is a manifold, and pair by pair
 * always); points near every triangle of the operands and all over the place are wound around once where they are in the solid, and not at all where they
 * are not. Volumes are as exact ones but for what the reported movement explains.
 *
 * A few meshes; with LAPIDARY_LONG every closed mesh that does not intersect itself, and larger grids. LAPIDARY_PART=i/n as for the
 * others.
 */
#include "check.h"
#include "fixture.hpp"
#include "models.hpp"
#include "rational.hpp"
#include "soup.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <vector>

namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Rational = rational::number;
using soup::Corners;

int results = 0, manifolds = 0, others = 0;
std::int64_t repaired = 0, located = 0, all_triangles = 0;

double seconds_since(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/* Triangles over doubles. */
struct Surface {
    std::vector<Point> points;
    std::vector<Corners> triangles;
    const Point &point(std::int32_t v) const { return points[static_cast<std::size_t>(v)]; }
    std::array<Point, 3> corners(const Corners &t) const { return {point(t[0]), point(t[1]), point(t[2])}; }
};

Surface surface_of(const lapidary::surface &s)
{
    Surface out;
    const auto vertices = s.vertices().xyz;
    for (std::int64_t v = 0; v < vertices.size(); ++v) out.points.emplace_back(vertices[v][0], vertices[v][1], vertices[v][2]);
    const auto triangles = s.triangles().vertices;
    for (std::int64_t t = 0; t < triangles.size(); ++t) out.triangles.push_back({triangles[t][0], triangles[t][1], triangles[t][2]});
    return out;
}

Surface surface_of(const fixture::solid &s)
{
    Surface out;
    for (std::size_t i = 0; i < s.xyz.size(); i += 3) out.points.emplace_back(s.xyz[i], s.xyz[i + 1], s.xyz[i + 2]);
    for (std::size_t i = 0; i < s.indices.size(); i += 3) out.triangles.push_back({s.indices[i], s.indices[i + 1], s.indices[i + 2]});
    return out;
}

/* Every directed edge as often as its reverse, every place one vertex, no triangle twice or without area. */
bool is_closed(const Surface &s)
{
    std::map<std::pair<std::int32_t, std::int32_t>, int> edges;
    std::set<Corners> different;
    if (std::set<Point>(s.points.begin(), s.points.end()).size() != s.points.size()) return false;
    for (Corners t : s.triangles) {
        for (int k = 0; k < 3; ++k) {
            const std::int32_t a = t[k], b = t[(k + 1) % 3];
            edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
        }
        if (CGAL::collinear(s.point(t[0]), s.point(t[1]), s.point(t[2]))) return false;
        std::sort(t.begin(), t.end());
        if (!different.insert(t).second) return false;
    }
    return std::all_of(edges.begin(), edges.end(), [](const auto &edge) { return edge.second == 0; });
}

/* Of a closed surface. */
bool is_embedded(const Surface &s)
{
    if (s.triangles.empty()) return true;
    if (PMP::is_polygon_soup_a_polygon_mesh(s.triangles)) {
        ++manifolds;
        Mesh mesh;
        PMP::polygon_soup_to_polygon_mesh(s.points, s.triangles, mesh);
        if (!CGAL::is_closed(mesh) || PMP::does_self_intersect(mesh)) return false;
    } else {
        ++others;
    }
    using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::size_t>;
    std::vector<Box> boxes;
    for (std::size_t t = 0; t < s.triangles.size(); ++t) {
        const auto c = s.corners(s.triangles[t]);
        boxes.emplace_back(c[0].bbox() + c[1].bbox() + c[2].bbox(), t);
    }
    bool good = true;
    const auto point = [&](std::int32_t v) -> const Point & { return s.point(v); };
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box &a, const Box &b) {
        good = good && !soup::meet_wrongly<Kernel>(point, s.triangles[a.info()], s.triangles[b.info()]);
    });
    return good;
}

/* Winding numbers of points, by the triangles above them; `nowhere` for a point on a triangle. Triangles are looked up in columns. */
class Windings {
public:
    static constexpr int nowhere = 1 << 20;
    explicit Windings(const Surface &s) : s_(s)
    {
        for (const Point &p : s.points) box_ += p.bbox();
        side_ = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(s.triangles.size()))));
        columns_.resize(static_cast<std::size_t>(side_ * side_));
        for (std::size_t t = 0; t < s.triangles.size(); ++t) {
            CGAL::Bbox_3 b;
            for (const Point &p : s.corners(s.triangles[t])) b += p.bbox();
            for (int i = place(b.xmin(), 0); i <= place(b.xmax(), 0); ++i) {
                for (int j = place(b.ymin(), 1); j <= place(b.ymax(), 1); ++j) columns_[static_cast<std::size_t>(i * side_ + j)].push_back(t);
            }
        }
    }
    int of(const Point &p) const
    {
        int sum = 0;
        for (const std::size_t t : columns_[static_cast<std::size_t>(place(p.x(), 0) * side_ + place(p.y(), 1))]) {
            const auto c = s_.corners(s_.triangles[t]);
            /* Seen from above, the point a little to the right of where it is, and by less upward: how often a triangle turns around it. */
            int turns = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                const Point &a = c[k], &b = c[(k + 1) % 3];
                const bool up = a.y() <= p.y() && p.y() < b.y(), down = b.y() <= p.y() && p.y() < a.y();
                if (!up && !down) continue;
                const Point &low = up ? a : b, &high = up ? b : a;
                const auto side = CGAL::orientation(flat(low), flat(high), flat(p));
                if (side == CGAL::RIGHT_TURN || side == CGAL::COLLINEAR) continue;
                turns += up ? 1 : -1;
            }
            if (turns == 0) continue;
            const auto side = CGAL::orientation(c[0], c[1], c[2], p);
            if (side == CGAL::COPLANAR) return nowhere;
            /* A triangle that turns to the left has its positive side above it. */
            if ((side == CGAL::NEGATIVE) == (turns > 0)) sum += turns;
        }
        return sum;
    }

private:
    const Surface &s_;
    CGAL::Bbox_3 box_;
    int side_ = 1;
    std::vector<std::vector<std::size_t>> columns_;

    static Kernel::Point_2 flat(const Point &p) { return {p.x(), p.y()}; }
    /* Rises with x, so that no triangle around a point is missed. */
    int place(double x, int axis) const
    {
        const double low = box_.min(axis), high = box_.max(axis);
        const double at = high > low ? (x - low) / (high - low) * side_ : 0;
        return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(side_ - 1)));
    }
};

/* The distance of a point from a surface is more than this, as far as doubles tell: of all triangles whose boxes are near. */
class Distances {
public:
    explicit Distances(const Surface &s) : s_(s)
    {
        for (std::size_t t = 0; t < s.triangles.size(); ++t) {
            CGAL::Bbox_3 b;
            for (const Point &p : s.corners(s.triangles[t])) b += p.bbox();
            boxes_.emplace_back(b, t);
        }
    }
    /* For each point whether it is nearer than `least` to the surface. */
    std::vector<bool> near(const std::vector<Point> &points, double least) const
    {
        std::vector<Box> around;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Point &p = points[i];
            around.emplace_back(CGAL::Bbox_3(p.x() - least, p.y() - least, p.z() - least, p.x() + least, p.y() + least, p.z() + least), i);
        }
        std::vector<Box> boxes = boxes_;
        std::vector<bool> is_near(points.size());
        CGAL::box_intersection_d(around.begin(), around.end(), boxes.begin(), boxes.end(), [&](const Box &a, const Box &b) {
            const auto c = s_.corners(s_.triangles[b.info()]);
            const double square = CGAL::to_double(CGAL::squared_distance(points[a.info()], Kernel::Triangle_3(c[0], c[1], c[2])));
            if (!(square > least * least)) is_near[a.info()] = true;
        });
        return is_near;
    }

private:
    using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::size_t>;
    const Surface &s_;
    std::vector<Box> boxes_;
};

/* Points on both sides of the middle of every triangle of the operands, some units away, and all over the place. */
std::vector<Point> probes(const std::vector<Surface> &operands, double away)
{
    std::vector<Point> all;
    CGAL::Bbox_3 box;
    for (const Surface &s : operands) {
        for (const Corners &t : s.triangles) {
            const auto c = s.corners(t);
            box += c[0].bbox() + c[1].bbox() + c[2].bbox();
            const auto normal = CGAL::cross_product(c[1] - c[0], c[2] - c[0]);
            const double length = std::sqrt(normal.squared_length());
            const Point middle = CGAL::centroid(c[0], c[1], c[2]);
            if (!(length > 0)) continue;
            for (const double sign : {-1.0, 1.0}) all.push_back(middle + normal * (sign * away / length));
        }
    }
    std::mt19937_64 random(all.size());
    const auto between = [&](double low, double high) { return low + (high - low) * (static_cast<double>(random() >> 11) / 9007199254740992.0); };
    for (int i = 0; i < 1000; ++i) {
        const double x = between(box.xmin(), box.xmax()), y = between(box.ymin(), box.ymax());
        all.emplace_back(x, y, between(box.zmin(), box.zmax()));
    }
    return all;
}

/* Exact, of doubles. */
Rational volume_of(const Surface &s)
{
    Rational six = 0;
    for (const Corners &t : s.triangles) {
        const auto c = s.corners(t);
        Rational x[3][3];
        for (int k = 0; k < 3; ++k) {
            for (int i = 0; i < 3; ++i) x[k][i] = Rational(c[static_cast<std::size_t>(k)][i]);
        }
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            six += x[0][i] * (x[1][j] * x[2][k] - x[1][k] * x[2][j]);
        }
    }
    return six / 6;
}

double area_of(const Surface &s)
{
    double area = 0;
    for (const Corners &t : s.triangles) {
        const auto c = s.corners(t);
        area += 0.5 * std::sqrt(CGAL::cross_product(c[1] - c[0], c[2] - c[0]).squared_length());
    }
    return area;
}

using Inside = std::function<bool(bool, bool)>;
const std::vector<std::pair<std::string, Inside>> operations{{"0 | 1", [](bool a, bool b) { return a || b; }},
                                                             {"0 & 1", [](bool a, bool b) { return a && b; }},
                                                             {"0 - 1", [](bool a, bool b) { return a && !b; }},
                                                             {"1 - 0", [](bool a, bool b) { return b && !a; }},
                                                             {"0 ^ 1", [](bool a, bool b) { return a != b; }}};

void compare(const std::string &name, const fixture::solid &first, const fixture::solid &second)
{
    const int before = check_failures;
    lapidary::context context;
    const lapidary::arrangement a(context, {lapidary::operand(first.xyz, first.indices), lapidary::operand(second.xyz, second.indices)});
    const std::vector<Surface> operands{surface_of(first), surface_of(second)};
    double most = 0;
    for (const fixture::solid *s : {&first, &second}) {
        for (const double x : s->xyz) most = std::max(most, std::fabs(x));
    }
    /* Far from the surfaces, in units in the last place; within that of them, either answer is one of rounding. */
    const double unit = std::ldexp(1, std::ilogb(most) - 52), away = 4096 * unit;
    std::vector<Point> points = probes(operands, away);
    std::vector<bool> near(points.size());
    std::vector<std::array<bool, 2>> inside(points.size());
    for (std::size_t k = 0; k < 2; ++k) {
        const std::vector<bool> too_near = Distances(operands[k]).near(points, away / 4);
        const Windings windings(operands[k]);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const int w = windings.of(points[i]);
            near[i] = near[i] || too_near[i] || w == Windings::nowhere;
            inside[i][k] = w > 0;
        }
    }
    for (const auto &[expression, decide] : operations) {
        const auto start = std::chrono::steady_clock::now();
        const lapidary::surface exact = a.extract(context, expression), made = exact.certify(context);
        const double seconds = seconds_since(start);
        const lap_surface_certify_report report = made.certified_report();
        const Surface s = surface_of(made);
        ++results;
        repaired += report.flat_before + report.contacts_before > 0;
        all_triangles += static_cast<std::int64_t>(s.triangles.size());
        CHECK(report.certified == 1 && report.move_unit <= unit && report.largest_move <= away / 16);
        CHECK(is_closed(s));
        CHECK(is_embedded(s));
        const Windings windings(s);
        std::int64_t wrong = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (near[i]) continue;
            ++located;
            wrong += windings.of(points[i]) != (decide(inside[i][0], inside[i][1]) ? 1 : 0);
        }
        CHECK(wrong == 0);
        const Rational volume = volume_of(s), off = CGAL::abs(volume - rational::parse(exact.exact_volume(context)));
        /* Of the rounding before it and of repair, along each of three axes, on both sides of a thin cell. */
        const double explained = 6 * (report.largest_move + unit) * area_of(surface_of(exact));
        CHECK(off <= Rational(explained));
        CHECK(volume == rational::parse(made.exact_volume(context)));
        std::cout << name << ", " << expression << ": " << report.flat_before + report.contacts_before << " defects before, " << s.triangles.size()
                  << " triangles, moved by " << report.largest_move / unit << " units, " << report.thin_cells << " thin cells, " << seconds << " s, checked in "
                  << seconds_since(start) - seconds << " s" << (check_failures == before ? "" : ": FAILED") << std::endl;
    }
}

/* A cube with n squares of `step` to a side, each of two triangles, from a corner on. */
fixture::solid grid_cube(int n, const std::array<double, 3> &low, double step)
{
    fixture::solid s;
    std::map<std::array<int, 3>, std::int32_t> numbers;
    const auto number = [&](const std::array<int, 3> &p) {
        const auto [place, fresh] = numbers.emplace(p, static_cast<std::int32_t>(numbers.size()));
        if (fresh) {
            for (std::size_t i = 0; i < 3; ++i) s.xyz.push_back(low[i] + step * p[i]);
        }
        return place->second;
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const int at : {0, n}) {
            for (int i = 0; i < n; ++i) {
                for (int j = 0; j < n; ++j) {
                    const auto corner = [&](int a, int b) {
                        std::array<int, 3> p{};
                        p[axis] = at;
                        p[(axis + 1) % 3] = i + a;
                        p[(axis + 2) % 3] = j + b;
                        return number(p);
                    };
                    const std::int32_t c[4] = {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
                    const auto add = [&](int x, int y, int z) {
                        const std::int32_t out[3] = {c[x], at == 0 ? c[z] : c[y], at == 0 ? c[y] : c[z]};
                        s.indices.insert(s.indices.end(), out, out + 3);
                    };
                    add(0, 1, 2);
                    add(0, 2, 3);
                }
            }
        }
    }
    return s;
}

/* About the origin, by the same rounded matrix for all. */
fixture::solid turned(fixture::solid s, double angle)
{
    const double axis[3] = {2 / std::sqrt(29.0), 3 / std::sqrt(29.0), 4 / std::sqrt(29.0)}, sine = std::sin(angle), cosine = std::cos(angle);
    for (std::size_t v = 0; v < s.xyz.size(); v += 3) {
        double x[3], along = 0;
        for (std::size_t k = 0; k < 3; ++k) along += (x[k] = s.xyz[v + k]) * axis[k];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t j = (k + 1) % 3, l = (k + 2) % 3;
            s.xyz[v + k] = cosine * x[k] + sine * (axis[j] * x[l] - axis[l] * x[j]) + (1 - cosine) * along * axis[k];
        }
    }
    return s;
}

void grids(bool everything)
{
    const std::vector<int> sizes = everything ? std::vector<int>{1, 2, 3, 4, 7, 10, 20, 30} : std::vector<int>{1, 2, 4, 10};
    for (const int n : sizes) {
        const double size = n;
        const std::vector<std::array<double, 3>> shifts{{0.5, 0.25, 0}, {1, 0, 0}, {size, 0, 0}, {size, 0.5, 0}, {size, size, 0.25}};
        for (int k = 0; k < (everything ? 3 : 1); ++k) {
            const double angle = 0.7 + n + 0.3 * k;
            const fixture::solid one = turned(grid_cube(n, {0, 0, 0}, 1), angle);
            const std::string name = std::to_string(n) + " squares a side, angle " + std::to_string(angle);
            for (const auto &shift : shifts) {
                models::guarded(name, [&] {
                    compare(name + ", shifted by " + std::to_string(shift[0]) + ' ' + std::to_string(shift[1]) + ' ' + std::to_string(shift[2]), one,
                            turned(grid_cube(n, shift, 1), angle));
                });
            }
            models::guarded(name, [&] { compare(name + ", finer", one, turned(grid_cube(2 * n + 1, {0, 0, 0}, size / (2 * n + 1)), angle)); });
            models::guarded(name, [&] { compare(name + ", inside", one, turned(grid_cube(n, {0, 0.25 * size, 0}, 0.5), angle)); });
        }
    }
}

/* The checks find what is wrong: rounded booleans as they are, and good ones that were tampered with. */
void finds_defects()
{
    lapidary::context context;
    const fixture::solid x = turned(grid_cube(4, {0, 0, 0}, 1), 0.7), y = turned(grid_cube(4, {0.5, 0.25, 0}, 1), 0.7);
    const lapidary::arrangement a(context, {lapidary::operand(x.xyz, x.indices), lapidary::operand(y.xyz, y.indices)});
    const lapidary::surface exact = a.extract(context, "0 ^ 1");
    const Surface rounded = surface_of(exact);
    CHECK(!is_closed(rounded) || !is_embedded(rounded));
    const Surface good = surface_of(exact.certify(context)), cube = surface_of(x);
    CHECK(is_closed(good) && is_embedded(good) && is_closed(cube) && is_embedded(cube));
    Surface open = cube, twice = cube, folded = cube, split = cube;
    open.triangles.pop_back();
    CHECK(!is_closed(open));
    twice.triangles.push_back(cube.triangles[0]);
    twice.triangles.push_back({cube.triangles[0][0], cube.triangles[0][2], cube.triangles[0][1]});
    CHECK(!is_closed(twice));
    split.points.push_back(split.points[0]);
    CHECK(!is_closed(split));
    folded.points[0] = CGAL::ORIGIN + 3 * (folded.points.back() - CGAL::ORIGIN);
    CHECK(is_closed(folded) && !is_embedded(folded));
    const Windings windings(cube);
    const Point middle = CGAL::midpoint(cube.points.front(), cube.points.back());
    CHECK(windings.of(middle) == 1 && windings.of(CGAL::ORIGIN + 3 * (middle - CGAL::ORIGIN)) == 0);
    CHECK(windings.of(Point(middle.x(), middle.y(), middle.z() + 100)) == 0 && windings.of(Point(middle.x(), middle.y(), middle.z() - 100)) == 0);
    CHECK(windings.of(cube.points[0]) == Windings::nowhere || windings.of(cube.points[0]) <= 1);
    /* As it is inside out. */
    Surface inverted = cube;
    for (Corners &t : inverted.triangles) std::swap(t[0], t[1]);
    CHECK(Windings(inverted).of(middle) == -1);
    const std::vector<bool> near = Distances(cube).near({middle, cube.points[0]}, 1e-3);
    CHECK(!near[0] && near[1]);
    CHECK(volume_of(cube) > Rational(63.999999999) && volume_of(cube) < Rational(64.000000001));
}

} // namespace

int main()
{
    const bool everything = std::getenv("LAPIDARY_LONG") != nullptr;
    finds_defects();
    const std::vector<std::string> few{"tetrahedron.off", "star.off", "3torus.off", "cross.off", "joint.off", "eight.off"};
    models::Models all(few, everything);
    if (all.first()) grids(everything);
    CHECK(!all.first() || (repaired > 0 && manifolds > 0 && others > 0));
    if (all.empty()) return check_result();
    const std::size_t meshes = all.each([&](const std::string &name, const fixture::solid &s, const std::string &next, const fixture::solid &other) {
        models::guarded(name, [&] { compare(name + ", rotated", s, models::rotated(s)); });
        models::guarded(name, [&] { compare(name + ", " + next, s, models::fitted(other, s)); });
        /* Nearly coplanar where they were coplanar. */
        models::guarded(name, [&] {
            const fixture::solid rounded = models::on_grid(s);
            compare(name + ", shifted by an edge, both rotated", models::rotated(rounded), models::rotated(models::shifted(rounded)));
        });
    });
    std::cout << meshes << " meshes, " << results << " results of " << all_triangles << " triangles, " << repaired << " repaired; " << manifolds
              << " are manifolds, " << others << " are not; " << located << " points located" << std::endl;
    if (all.whole()) CHECK(meshes >= few.size());
    return check_result();
}
