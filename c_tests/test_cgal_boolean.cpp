/* Booleans of pairs of CGAL's meshes against CGAL: each mesh with itself rotated, with its neighbour in the list scaled to fit, and with
 * itself shifted by exactly one of its edges, which makes much of both coincide.
 *
 * For each pair, in exact rationals: vol(A | B) + vol(A & B) = vol(A) + vol(B), vol(A) - vol(A & B) = vol(A - B), vol(A) that of the mesh. Every output is
 * closed and bounds its volume, and at the library's exact coordinates no two triangles of any outputs meet but in what they share: pair by pair, by
 * CGAL's predicates; where few triangles meet, outputs that are manifolds go to PMP::does_self_intersect as well. Corefinement over exact constructions
 * gives the same volumes where it can (its input and output have to be manifolds), and so do Nef polyhedra for small ones.
 *
 * A few meshes; with LAPIDARY_LONG every closed mesh that does not intersect itself. LAPIDARY_PART=i/n, i from 0, takes every n-th
 * mesh only.
 */
#include "check.h"
#include "exact_points.hpp"
#include "fixture.hpp"
#include "models.hpp"
#include "nef.hpp"
#include "rational.hpp"
#include "soup.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <set>
#include <sstream>

#include <csignal>
#include <sys/wait.h>
#include <unistd.h>

namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Rational = rational::number;
using soup::Corners;

/* Triangles of both together beyond which a peer is left out. */
std::size_t most_for_corefinement = 4000, most_for_nef = 80;
unsigned seconds_for_corefinement = 20;
/* Pairs of triangles that meet beyond which outputs are not given to PMP as well: it takes a hundred times as long. */
std::int64_t most_for_meshes = 1000;
int pairs = 0, corefined = 0, by_nef = 0, manifolds = 0, others = 0, as_meshes = 0;

double seconds_since(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/* CGAL's exact number type differs from build to build. */
Rational exact(const Kernel::FT &x)
{
    std::ostringstream text;
    text << CGAL::exact(x);
    return rational::parse(text.str());
}

/* Whether numbers add up to another one. Sums of many denominators are long: they are added up over a balanced tree, and not reduced. */
bool adds_up(const std::vector<Rational> &terms, const Rational &sum)
{
    struct Fraction {
        CGAL::Gmpz above, below;
    };
    /* Equal denominators first. */
    std::map<CGAL::Gmpz, CGAL::Gmpz> by_denominator;
    for (const Rational &x : terms) by_denominator.emplace(x.denominator(), 0).first->second += x.numerator();
    std::vector<Fraction> tree{{0, 1}};
    for (const auto &[below, above] : by_denominator) tree.push_back({above, below});
    for (std::size_t n = tree.size(); n > 1; n = (n + 1) / 2) {
        for (std::size_t i = 0; i < n / 2; ++i) {
            const Fraction &x = tree[2 * i], &y = tree[2 * i + 1];
            tree[i] = Fraction{x.above * y.below + y.above * x.below, x.below * y.below};
        }
        if (n % 2 == 1) tree[n / 2] = tree[n - 1];
    }
    return tree[0].above * sum.denominator() == sum.numerator() * tree[0].below;
}

bool has_volume(const Mesh &mesh, const Rational &volume)
{
    std::vector<Rational> six;
    for (const auto f : faces(mesh)) {
        const auto h = halfedge(f, mesh);
        const Point &a = mesh.point(source(h, mesh)), &b = mesh.point(target(h, mesh)), &c = mesh.point(target(next(h, mesh), mesh));
        six.push_back(exact(CGAL::determinant(a - CGAL::ORIGIN, b - CGAL::ORIGIN, c - CGAL::ORIGIN)));
    }
    return adds_up(six, volume * 6);
}

/* A mesh as CGAL takes it; nothing if it is not a manifold. */
bool mesh_of(const fixture::solid &s, Mesh &mesh)
{
    for (std::size_t i = 0; i < s.xyz.size(); i += 3) mesh.add_vertex(Point(s.xyz[i], s.xyz[i + 1], s.xyz[i + 2]));
    for (std::size_t t = 0; t < s.indices.size(); t += 3) {
        const auto vertex = [&](int k) { return Mesh::Vertex_index(static_cast<std::uint32_t>(s.indices[t + k])); };
        if (mesh.add_face(vertex(0), vertex(1), vertex(2)) == Mesh::null_face()) return false;
    }
    return true;
}

/* Points of an arrangement that outputs have, each once. */
struct Vertices {
    exact_points::Points points;
    std::map<std::int32_t, std::int32_t> number; /* by vertex of the arrangement */
};

/* An output: triangles of such points. */
struct Output {
    std::vector<Corners> triangles;
    Rational volume;
};

Kernel::FT number_of(const Rational &x)
{
    using Exact = std::decay_t<decltype(CGAL::exact(std::declval<Kernel::FT>()))>;
    std::ostringstream text;
    text << x.numerator() << '/' << x.denominator();
    return Kernel::FT(Exact(text.str()));
}

Output output_of(lapidary::context &context, const lapidary::arrangement &a, const std::string &expression, Vertices &all)
{
    const lapidary::surface surface = a.extract(context, expression);
    Output out;
    out.volume = rational::parse(surface.exact_volume(context));
    const auto vertices = surface.vertices();
    const auto kinds = a.vertex_origins().kinds;
    std::vector<std::int32_t> numbers;
    for (std::int64_t v = 0; v < vertices.xyz.size(); ++v) {
        const auto [place, fresh] = all.number.emplace(vertices.sources[v], 0);
        if (fresh) {
            const double *x = vertices.xyz[v];
            std::array<Rational, 3> exact{Rational(x[0]), Rational(x[1]), Rational(x[2])};
            if (kinds[vertices.sources[v]] != LAP_VERTEX_MESH) {
                const auto text = a.exact_vertex(context, vertices.sources[v]);
                for (std::size_t i = 0; i < 3; ++i) exact[i] = rational::parse(text[i]);
            }
            place->second = all.points.add(exact);
        }
        numbers.push_back(place->second);
    }
    const auto triangles = surface.triangles();
    for (std::int64_t t = 0; t < triangles.vertices.size(); ++t) {
        const std::int32_t *c = triangles.vertices[t];
        const auto corner = [&](int k) { return numbers[static_cast<std::size_t>(c[k])]; };
        out.triangles.push_back({corner(0), corner(1), corner(2)});
    }
    return out;
}

Corners sorted(Corners t)
{
    std::sort(t.begin(), t.end());
    return t;
}

/* Every directed edge as often as its reverse, no triangle twice. */
bool is_closed(const std::vector<Corners> &triangles)
{
    std::map<std::pair<std::int32_t, std::int32_t>, int> edges;
    std::set<Corners> different;
    for (const Corners &t : triangles) {
        for (int k = 0; k < 3; ++k) {
            const std::int32_t a = t[k], b = t[(k + 1) % 3];
            edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
        }
        if (!different.insert(sorted(t)).second) return false;
    }
    return std::all_of(edges.begin(), edges.end(), [](const auto &edge) { return edge.second == 0; });
}

/* As PMP sees it, with its volume, by exact constructions; true of what is no manifold. */
bool is_good_mesh(const exact_points::Points &points, const Output &out, bool judge)
{
    std::vector<Corners> triangles = out.triangles;
    std::map<std::int32_t, std::int32_t> number;
    for (Corners &t : triangles) {
        for (std::int32_t &v : t) v = number.emplace(v, static_cast<std::int32_t>(number.size())).first->second;
    }
    if (!PMP::is_polygon_soup_a_polygon_mesh(triangles)) {
        ++others;
        return true;
    }
    ++manifolds;
    if (!judge) return true;
    ++as_meshes;
    std::vector<Point> places(number.size());
    for (const auto &[v, n] : number) {
        const auto &x = points.rational(v);
        places[static_cast<std::size_t>(n)] = Point(number_of(x[0]), number_of(x[1]), number_of(x[2]));
    }
    Mesh mesh;
    PMP::polygon_soup_to_polygon_mesh(places, triangles, mesh);
    return CGAL::is_closed(mesh) && !PMP::does_self_intersect(mesh) && has_volume(mesh, out.volume);
}

constexpr int wrong = 64, gives_up = -1, no_end = -2;

/* Compares the volumes of union, intersection and difference by corefinement; returns bits for those that it could do, `wrong`, or why there is no
   result. On meshes that coincide in part it may fail, and even run on for ever (P.off, shifted by an edge, in CGAL 5.5): so it has a process of its
   own. */
int corefinement(const fixture::solid &first, const fixture::solid &second, const std::array<Rational, 3> &volumes)
{
    std::cout.flush();
    const pid_t child = fork();
    if (child < 0) return gives_up;
    if (child > 0) {
        int status = 0;
        if (waitpid(child, &status, 0) != child) return gives_up;
        if (WIFSIGNALED(status)) return WTERMSIG(status) == SIGALRM ? no_end : gives_up;
        return WEXITSTATUS(status) == 255 ? gives_up : WEXITSTATUS(status);
    }
    alarm(seconds_for_corefinement);
    int result = 0;
    try {
        Mesh m[2], made[4];
        if (!mesh_of(first, m[0]) || !mesh_of(second, m[1])) _exit(255);
        std::array<boost::optional<Mesh *>, 4> to;
        for (std::size_t i = 0; i < 4; ++i) to[i] = &made[i];
        const auto done = PMP::corefine_and_compute_boolean_operations(m[0], m[1], to);
        const std::size_t operations[3] = {PMP::Corefinement::UNION, PMP::Corefinement::INTERSECTION,
                                           PMP::Corefinement::TM1_MINUS_TM2};
        for (std::size_t i = 0; i < 3; ++i) {
            if (!done[operations[i]]) continue;
            result |= 1 << i;
            if (!has_volume(made[operations[i]], volumes[i])) _exit(wrong);
        }
    } catch (const std::exception &) {
        _exit(255);
    }
    _exit(result);
}

void compare(const std::string &name, const fixture::solid &first, fixture::solid second)
{
    const int before = check_failures;
    lapidary::context context;
    const auto start = std::chrono::steady_clock::now();
    const lapidary::arrangement a(context, {lapidary::operand(first.xyz, first.indices), lapidary::operand(second.xyz, second.indices)});
    const double arranged = seconds_since(start);
    ++pairs;
    std::string exact_volumes[2];
    fixture::solid copy = first;
    const bool clean = models::make_clean(context, copy, &exact_volumes[0]) && models::make_clean(context, second, &exact_volumes[1]);
    Vertices all;
    std::map<std::string, Output> out;
    std::vector<Corners> together;
    for (const char *expression : {"0", "1", "0 | 1", "0 & 1", "0 - 1", "0 ^ 1"}) {
        const Output &one = out[expression] = output_of(context, a, expression, all);
        const bool solid = is_closed(one.triangles) && all.points.bound(one.triangles, one.volume) &&
                           is_good_mesh(all.points, one, a.counts().intersecting_pairs <= most_for_meshes);
        if (!solid) std::cerr << name << ": " << expression << " is not solid\n";
        CHECK(solid);
        for (const Corners &t : one.triangles) together.push_back(sorted(t));
    }
    /* No two triangles of any outputs meet wrongly: so those of one output do not. */
    std::sort(together.begin(), together.end());
    together.erase(std::unique(together.begin(), together.end()), together.end());
    CHECK(all.points.are_embedded(together));
    const auto volume = [&](const char *expression) -> const Rational & { return out[expression].volume; };
    CHECK(volume("0 | 1") + volume("0 & 1") == volume("0") + volume("1"));
    CHECK(volume("0") - volume("0 & 1") == volume("0 - 1"));
    CHECK(volume("0 ^ 1") == volume("0 | 1") - volume("0 & 1"));
    /* Cells inside both, and those inside either. */
    const auto windings = a.cells().windings;
    std::vector<Rational> both, either;
    for (std::int32_t c = 1; c < a.counts().cells; ++c) {
        const Rational cell = rational::parse(a.exact_cell_volume(context, c));
        CHECK(cell > 0 && rational::is_nearest(a.cell_volumes()[c], cell));
        if (windings[c].size() == 2) both.push_back(cell);
        if (windings[c].size() > 0) either.push_back(cell);
    }
    const std::size_t triangles = (first.indices.size() + second.indices.size()) / 3;
    const double checked = seconds_since(start) - arranged;
    std::string peers = clean ? "" : ", rounding made the second meet itself";
    if (clean) {
        CHECK(volume("0") == rational::parse(exact_volumes[0]) && volume("1") == rational::parse(exact_volumes[1]));
        CHECK(adds_up(both, volume("0 & 1")) && adds_up(either, volume("0 | 1")));
    }
    if (clean && triangles <= most_for_corefinement) {
        const int result = corefinement(first, second, {volume("0 | 1"), volume("0 & 1"), volume("0 - 1")});
        CHECK(result != wrong);
        if (result < 0) peers += result == no_end ? ", corefinement does not end" : ", corefinement gives up";
        for (int i = 0; result > 0 && i < 3; ++i) {
            if ((result >> i & 1) == 0) continue;
            ++corefined;
            peers += i == 0 ? ", corefined |" : i == 1 ? " &" : " -";
        }
    }
    if (clean && triangles <= most_for_nef) {
        const nef::Nef x = nef::solid_of(first), y = nef::solid_of(second);
        const std::pair<nef::Nef, const char *> operations[3] = {
            {(x + y).regularization(), "0 | 1"}, {(x * y).regularization(), "0 & 1"}, {(x - y).regularization(), "0 - 1"}};
        for (const auto &[result, expression] : operations) {
            ++by_nef;
            CHECK(adds_up(nef::volumes(result), volume(expression)));
        }
        peers += ", Nef";
    }
    std::cout << name << ": " << triangles << " triangles, " << a.counts().intersecting_pairs << " pairs meet, " << a.counts().cells
              << " cells, " << arranged << " s, checked in " << checked << " s, compared in " << seconds_since(start) - arranged - checked << " s"
              << peers << (check_failures == before ? "" : ": FAILED") << std::endl;
}

/* The check of solids finds what is wrong. */
void finds_defects()
{
    lapidary::context context;
    const std::vector<double> xyz = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const std::vector<std::int32_t> indices = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    const lapidary::arrangement a(context, {lapidary::operand(xyz, indices)});
    Vertices all;
    const Output good = output_of(context, a, "0", all);
    exact_points::Points &points = all.points;
    const auto add = [&](double x, double y, double z) { return points.add({Rational(x), Rational(y), Rational(z)}); };
    const auto is_solid = [&](const Output &out) {
        return is_closed(out.triangles) && points.are_embedded(out.triangles) && points.bound(out.triangles, out.volume);
    };
    const std::vector<Corners> &t = good.triangles;
    CHECK(is_solid(good) && is_good_mesh(points, good, true));
    Output open = good, folded = good, twice = good, larger = good;
    open.triangles.pop_back();
    CHECK(!is_closed(open.triangles) && !is_good_mesh(points, open, true));
    larger.volume = good.volume * Rational(1000001, 1000000);
    CHECK(!points.bound(t, larger.volume) && !is_good_mesh(points, larger, true));
    /* A tetrahedron on the other side of a triangle: that one is there twice, then not at all. */
    const std::int32_t below = add(-1, -1.5, -1.25);
    const Corners floor = t[0];
    for (std::size_t k = 0; k < 3; ++k) folded.triangles.push_back({floor[(k + 1) % 3], floor[k], below});
    folded.triangles.push_back(floor);
    CHECK(!is_closed(folded.triangles));
    folded.triangles.pop_back();
    CHECK(!is_closed(folded.triangles));
    /* A second tetrahedron that reaches into the first one from a vertex that they share. */
    const std::int32_t origin = points.rational(t[0][0]) == std::array<Rational, 3>{0, 0, 0}   ? t[0][0]
                               : points.rational(t[0][1]) == std::array<Rational, 3>{0, 0, 0} ? t[0][1]
                                                                                              : t[0][2];
    CHECK((points.rational(origin) == std::array<Rational, 3>{0, 0, 0}));
    const std::int32_t b = add(0.25, 0.25, -1), c = add(0.25, 0.5, 0.25), d = add(0.5, 0.25, 0.25);
    twice.triangles.insert(twice.triangles.end(), {{origin, c, b}, {origin, b, d}, {b, c, d}, {c, origin, d}});
    CHECK(is_closed(twice.triangles) && !points.are_embedded(twice.triangles));
    /* A triangle without area, by less than intervals tell. */
    const Rational third(1, 3);
    const std::int32_t e = points.add({third, third, third}), f = points.add({2 * third, 2 * third, 2 * third});
    CHECK(points.is_flat({origin, e, f}) && !points.is_flat({origin, e, d}));
    CHECK(!points.are_embedded({{origin, e, f}}) && points.are_embedded({{origin, e, d}}));
}

} // namespace

int main()
{
    const bool everything = std::getenv("LAPIDARY_LONG") != nullptr;
    if (everything) {
        most_for_corefinement = 40000;
        seconds_for_corefinement = 300;
        most_for_meshes = 200;
    }
    finds_defects();
    const std::vector<std::string> few{"tetrahedron.off", "pyramid.off", "star.off",  "hole.off",  "3torus.off",
                                       "cross.off",       "u.off",       "joint.off", "eight.off"};
    models::Models all(few, everything);
    if (all.empty()) return check_result();
    using models::guarded;
    const std::size_t meshes = all.each([&](const std::string &name, const fixture::solid &s, const std::string &next, const fixture::solid &other) {
        guarded(name, [&] { compare(name + ", rotated", s, models::rotated(s)); });
        guarded(name, [&] { compare(name + ", " + next, s, models::fitted(other, s)); });
        guarded(name, [&] {
            const fixture::solid rounded = models::on_grid(s);
            compare(name + ", shifted by an edge", rounded, models::shifted(rounded));
        });
    });
    std::cout << meshes << " meshes, " << pairs << " pairs; " << manifolds << " outputs are manifolds, " << others << " are not; " << as_meshes
              << " judged as meshes, " << corefined << " by corefinement, " << by_nef << " by Nef polyhedra" << std::endl;
    if (all.whole()) {
        CHECK(meshes >= few.size());
        CHECK(manifolds > 0 && as_meshes > 0 && corefined > 0 && by_nef > 0 && others > 0);
    }
    return check_result();
}
