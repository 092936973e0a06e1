/* Booleans of pairs of CGAL's meshes against CGAL: each mesh with itself rotated, with its neighbour in the list scaled to fit, and with
 * itself shifted by exactly one of its edges, which makes much of both coincide.
 *
 * For each pair, in exact rationals: vol(A | B) + vol(A & B) = vol(A) + vol(B), vol(A) - vol(A & B) = vol(A - B), vol(A) that of the mesh. Every output is
 * closed, and at the library's exact coordinates no two of its triangles meet but in what they share: by PMP::does_self_intersect where it is a
 * manifold, else pair by pair. Corefinement over exact constructions gives the same volumes where it can (its input and output have to
 * be manifolds), and so do Nef polyhedra for small ones.
 *
 * A few meshes; with LAPIDARY_LONG every closed mesh that does not intersect itself. LAPIDARY_PART=i/n, i from 0, takes every n-th
 * mesh only.
 */
#include "../examples/reader.hpp"
#include "check.h"
#include "fixture.hpp"
#include "nef.hpp"
#include "rational.hpp"
#include "soup.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
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
int corefined = 0, by_nef = 0, manifolds = 0, others = 0;

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

/* An output: its exact points, and its triangles. */
struct Output {
    std::vector<Point> points;
    std::vector<Corners> triangles;
    Rational volume;
};

Kernel::FT number(const std::string &text)
{
    using Exact = std::decay_t<decltype(CGAL::exact(std::declval<Kernel::FT>()))>;
    return Kernel::FT(Exact(text));
}

Output output_of(lapidary::context &context, const lapidary::arrangement &a, const std::string &expression)
{
    const lapidary::surface surface = a.extract(context, expression);
    Output out;
    out.volume = rational::parse(surface.exact_volume(context));
    const auto vertices = surface.vertices();
    const auto kinds = a.vertex_origins().kinds;
    for (std::int64_t v = 0; v < vertices.xyz.size(); ++v) {
        const double *x = vertices.xyz[v];
        if (kinds[vertices.sources[v]] == LAP_VERTEX_MESH) {
            out.points.emplace_back(x[0], x[1], x[2]);
            continue;
        }
        const auto text = a.exact_vertex(context, vertices.sources[v]);
        out.points.emplace_back(number(text[0]), number(text[1]), number(text[2]));
    }
    const auto triangles = surface.triangles();
    for (std::int64_t t = 0; t < triangles.vertices.size(); ++t) {
        const std::int32_t *c = triangles.vertices[t];
        out.triangles.push_back({c[0], c[1], c[2]});
    }
    return out;
}

/* Every directed edge as often as its reverse, no triangle twice, none of no area, and no two that meet but in what they share. */
bool is_solid(const Output &out)
{
    std::map<std::pair<std::int32_t, std::int32_t>, int> edges;
    std::set<Corners> different;
    for (Corners t : out.triangles) {
        for (int k = 0; k < 3; ++k) {
            const std::int32_t a = t[k], b = t[(k + 1) % 3];
            edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
        }
        if (CGAL::collinear(out.points[t[0]], out.points[t[1]], out.points[t[2]])) return false;
        std::sort(t.begin(), t.end());
        if (!different.insert(t).second) return false;
    }
    for (const auto &edge : edges) {
        if (edge.second != 0) return false;
    }
    if (out.triangles.empty()) return true;
    if (PMP::is_polygon_soup_a_polygon_mesh(out.triangles)) {
        ++manifolds;
        Mesh mesh;
        PMP::polygon_soup_to_polygon_mesh(out.points, out.triangles, mesh);
        return CGAL::is_closed(mesh) && !PMP::does_self_intersect(mesh) && has_volume(mesh, out.volume);
    }
    ++others;
    using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::size_t>;
    std::vector<Box> boxes;
    for (std::size_t t = 0; t < out.triangles.size(); ++t) {
        CGAL::Bbox_3 box;
        for (const std::int32_t v : out.triangles[t]) box += out.points[static_cast<std::size_t>(v)].bbox();
        boxes.emplace_back(box, t);
    }
    bool good = true;
    const auto point = [&](std::int32_t v) -> const Point & { return out.points[static_cast<std::size_t>(v)]; };
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box &a, const Box &b) {
        good = good && !soup::meet_wrongly<Kernel>(point, out.triangles[a.info()], out.triangles[b.info()]);
    });
    return good;
}

/* A closed mesh that does not intersect itself; one that faces inward is turned. */
bool make_clean(lapidary::context &context, fixture::solid &s, Rational *volume)
{
    lap_mesh_options options = lapidary::mesh_options();
    options.check_self_intersection = 1;
    for (int attempt = 0; attempt < 2; ++attempt) {
        try {
            const lapidary::mesh mesh(context, s.xyz, s.indices, {}, options);
            if (volume != nullptr) *volume = rational::parse(mesh.exact_volume(context));
            return true;
        } catch (const lapidary::error &e) {
            for (const lapidary::defect &d : e.defects()) {
                if (d.kind != LAP_DEFECT_WRONG_NESTING) return false;
            }
            for (std::size_t t = 0; t < s.indices.size(); t += 3) std::swap(s.indices[t + 1], s.indices[t + 2]);
        }
    }
    return false;
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
    Rational volumes[2];
    fixture::solid copy = first;
    const bool clean = make_clean(context, copy, &volumes[0]) && make_clean(context, second, &volumes[1]);
    std::map<std::string, Output> out;
    for (const char *expression : {"0", "1", "0 | 1", "0 & 1", "0 - 1", "0 ^ 1"}) {
        out[expression] = output_of(context, a, expression);
        const bool solid = is_solid(out[expression]);
        if (!solid) std::cerr << name << ": " << expression << " is not solid\n";
        CHECK(solid);
    }
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
    std::string peers = clean ? "" : ", rounding made the second meet itself";
    if (clean) {
        CHECK(volume("0") == volumes[0] && volume("1") == volumes[1]);
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
              << " cells, " << arranged << " s" << peers << (check_failures == before ? "" : ": FAILED") << std::endl;
}

struct Bounds {
    std::array<double, 3> low, high;
    double size() const { return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]}); }
};

Bounds bounds_of(const fixture::solid &s)
{
    Bounds b{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
    for (std::size_t i = 0; i < s.xyz.size(); ++i) {
        b.low[i % 3] = std::min(b.low[i % 3], s.xyz[i]);
        b.high[i % 3] = std::max(b.high[i % 3], s.xyz[i]);
    }
    return b;
}

/* By an angle about an axis in general position through the middle. */
fixture::solid rotated(const fixture::solid &s)
{
    const double axis[3] = {1 / std::sqrt(14.0), 2 / std::sqrt(14.0), 3 / std::sqrt(14.0)}, sine = std::sin(0.7), cosine = std::cos(0.7);
    const Bounds b = bounds_of(s);
    fixture::solid out = s;
    for (std::size_t i = 0; i < s.xyz.size(); i += 3) {
        double x[3], along = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            x[k] = s.xyz[i + k] - (b.low[k] + b.high[k]) / 2;
            along += x[k] * axis[k];
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t j = (k + 1) % 3, l = (k + 2) % 3;
            const double across = axis[j] * x[l] - axis[l] * x[j];
            out.xyz[i + k] = (b.low[k] + b.high[k]) / 2 + cosine * x[k] + sine * across + (1 - cosine) * along * axis[k];
        }
    }
    return out;
}

/* Of the other's size, at its place, a little off. */
fixture::solid fitted(const fixture::solid &s, const fixture::solid &to)
{
    const Bounds from = bounds_of(s), place = bounds_of(to);
    const double scale = place.size() / from.size();
    fixture::solid out = s;
    for (std::size_t i = 0; i < s.xyz.size(); ++i) {
        const std::size_t k = i % 3;
        out.xyz[i] = place.low[k] + scale * (s.xyz[i] - from.low[k] + 0.013 * static_cast<double>(k + 1) * from.size());
    }
    return out;
}

/* Coordinates as multiples of a power of two so coarse that sums and differences of them are exact. */
fixture::solid on_grid(const fixture::solid &s)
{
    double most = 0;
    for (const double x : s.xyz) most = std::max(most, std::fabs(x));
    const double step = std::ldexp(1, std::ilogb(most) - 44);
    fixture::solid out = s;
    for (double &x : out.xyz) x = std::nearbyint(x / step) * step;
    return out;
}

/* By the vector of an edge in the middle of the list. */
fixture::solid shifted(const fixture::solid &s)
{
    const std::size_t t = s.indices.size() / 6 * 3;
    const auto a = static_cast<std::size_t>(s.indices[t]), b = static_cast<std::size_t>(s.indices[t + 1]);
    fixture::solid out = s;
    for (std::size_t i = 0; i < s.xyz.size(); ++i) {
        const double edge = s.xyz[3 * b + i % 3] - s.xyz[3 * a + i % 3];
        out.xyz[i] += edge;
        CHECK(out.xyz[i] - edge == s.xyz[i] && out.xyz[i] - s.xyz[i] == edge);
    }
    return out;
}

template <class Make>
void guarded(const std::string &name, Make make)
{
    try {
        make();
    } catch (const std::exception &e) {
        std::cerr << name << ": " << e.what() << '\n';
        check_that(0, "no exception", __FILE__, __LINE__);
    }
}

/* The check of solids finds what is wrong. */
void finds_defects()
{
    lapidary::context context;
    const std::vector<double> xyz = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const std::vector<std::int32_t> indices = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    const lapidary::arrangement a(context, {lapidary::operand(xyz, indices)});
    Output good = output_of(context, a, "0");
    CHECK(is_solid(good));
    Output open = good, folded = good, twice = good;
    open.triangles.pop_back();
    CHECK(!is_solid(open));
    folded.points.push_back(Point(0.1, 0.1, -1));
    folded.triangles.insert(folded.triangles.end(), {{0, 2, 4}, {4, 2, 1}, {0, 4, 1}});
    folded.triangles.insert(folded.triangles.end(), {{0, 1, 2}});
    CHECK(!is_solid(folded)); /* a triangle there twice */
    folded.triangles.pop_back();
    CHECK(!is_solid(folded)); /* an edge that does not balance */
    /* A second tetrahedron that reaches into the first one from a vertex that they share. */
    for (const Point &p : {Point(0.25, 0.25, -1), Point(0.25, 0.5, 0.25), Point(0.5, 0.25, 0.25)}) twice.points.push_back(p);
    twice.triangles.insert(twice.triangles.end(), {{0, 5, 4}, {0, 4, 6}, {4, 5, 6}, {5, 0, 6}});
    CHECK(!is_solid(twice));
}

} // namespace

int main()
{
    const bool everything = std::getenv("LAPIDARY_LONG") != nullptr;
    if (everything) {
        most_for_corefinement = 40000;
        seconds_for_corefinement = 300;
    }
    finds_defects();
    const std::string folder = fixture::cgal_meshes();
    if (folder.empty()) return check_result();
    const auto [part, parts] = fixture::own_part();
    const std::vector<std::string> few{"tetrahedron.off", "pyramid.off", "star.off",  "hole.off",  "3torus.off",
                                       "cross.off",       "u.off",       "joint.off", "eight.off"};
    const std::vector<std::string> files = fixture::mesh_files(folder, few, everything);
    /* Read when they are needed; nothing where a file is no clean mesh. */
    std::map<std::size_t, std::optional<fixture::solid>> read;
    const auto solid = [&](std::size_t i) -> const std::optional<fixture::solid> & {
        const auto [place, fresh] = read.emplace(i, std::nullopt);
        if (!fresh) return place->second;
        try {
            const examples::Mesh mesh = examples::read_mesh(folder + "/" + files[i]);
            fixture::solid s{mesh.coordinates, mesh.triangles};
            lapidary::context context;
            if (make_clean(context, s, nullptr)) place->second = std::move(s);
        } catch (const std::runtime_error &) {
            /* not a mesh of polygons */
        }
        return place->second;
    };
    std::size_t meshes = 0;
    for (std::size_t i = part; i < files.size(); i += parts) {
        if (!solid(i)) continue;
        const fixture::solid &s = *solid(i);
        ++meshes;
        std::size_t next = (i + 1) % files.size();
        while (!solid(next)) next = (next + 1) % files.size();
        guarded(files[i], [&] { compare(files[i] + ", rotated", s, rotated(s)); });
        guarded(files[i], [&] { compare(files[i] + ", " + files[next], s, fitted(*solid(next), s)); });
        guarded(files[i], [&] {
            const fixture::solid rounded = on_grid(s);
            compare(files[i] + ", shifted by an edge", rounded, shifted(rounded));
        });
    }
    std::cout << meshes << " meshes; " << manifolds << " outputs are manifolds, " << others << " are not; " << corefined
              << " by corefinement, " << by_nef << " by Nef polyhedra" << std::endl;
    if (parts == 1) {
        CHECK(meshes >= few.size());
        CHECK(manifolds > 0 && corefined > 0 && by_nef > 0 && others > 0);
    }
    return check_result();
}
