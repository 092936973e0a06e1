// cut_mesh: cuts the solid inside a closed triangle mesh along planes and reports what comes out.
//
// Everything that a host does with the library is here in the order in which a host does it: read flat arrays, make a
// context and a mesh, cut, borrow the arrays of the complex, free. `cut_mesh --help` says how to use it.
#include "planes.hpp"
#include "reader.hpp"
#include "report.hpp"
#include "vtk.hpp"

#include <lapidary.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <iostream>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <sys/resource.h>
#include <unistd.h>

namespace {

using namespace examples;

// Exit codes. The library refused: 1. Wrong usage: 2. A file cannot be read or written: 3.
constexpr int exit_refused = 1, exit_usage = 2, exit_file = 3;

constexpr const char *usage =
    R"(usage: cut_mesh MESH PLANES... [options]
Cuts the solid inside a closed triangle mesh (OFF, OBJ, STL, PLY) along planes, exactly.

planes (any of these, together if you like)
  --grid NX NY NZ    so many planes across x, y and z, evenly over the bounding box, its sides included
  --planes FILE      lines `nx ny nz d` for n.x + d = 0; a first line `N 4` is allowed
  --random N         directions uniform on the sphere, through points uniform in the bounding box
  --seed S           seed of --random (default 1); the same planes on every machine
options
  --flip             reverse all triangles first, for a mesh that faces inward
  --threads N        worker threads (default 1); the result does not depend on it
  --faces STYLE      faces in --vtu: bridged (default; holes are joined to the outer loop by an edge walked twice) or
                     triangles; with `holes` only their number is reported, since VTK has no faces with holes
  --check            also test the input for self-intersections and the result for consistency (not in the times)
  --repeat N         run N times, report the fastest (default 1)
  --vtu FILE         the cells as VTK polyhedra
  --exploded FILE    the cells moved apart, and the lines where planes meet the mesh, as a VTK surface (.vtp)
  --explode FACTOR   how far apart (default 0.25)
  --json FILE        counts, volumes, times, predicate counters, peak memory
exit status: 0 done, 1 the library refused the input, 2 wrong usage, 3 a file cannot be read or written
)";

struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct Options {
    std::string mesh, planes, vtu, exploded, json;
    std::array<long, 3> grid{0, 0, 0};
    long random = 0, threads = 1, repeat = 1;
    std::uint64_t seed = 1;
    std::int32_t style = LAP_FACES_BRIDGED;
    double explode = 0.25;
    bool check = false, flip = false, help = false;
};

long to_count(const std::string &option, const std::string &text, long least, long most)
{
    std::size_t used = 0;
    long value = 0;
    try {
        value = std::stol(text, &used);
    } catch (const std::exception &) {
        used = 0;
    }
    if (used == 0 || used != text.size() || value < least || value > most)
        throw UsageError(option + ": '" + text + "' is not a number from " + std::to_string(least) + " to " +
                         std::to_string(most));
    return value;
}

double to_factor(const std::string &option, const std::string &text)
{
    std::size_t used = 0;
    double value = -1;
    try {
        value = std::stod(text, &used);
    } catch (const std::exception &) {
        used = 0;
    }
    if (used == 0 || used != text.size() || !(value >= 0 && value <= 1000))
        throw UsageError(option + ": '" + text + "' is not a number from 0 to 1000");
    return value;
}

Options parse(const std::vector<std::string> &arguments)
{
    Options options;
    std::size_t at = 0;
    auto next = [&](const std::string &option) -> const std::string & {
        if (at == arguments.size()) throw UsageError(option + " needs another argument");
        return arguments[at++];
    };
    constexpr long many = 1000000000;
    while (at < arguments.size()) {
        const std::string &a = arguments[at++];
        if (a == "--help" || a == "-h") options.help = true;
        else if (a == "--grid")
            for (long &n : options.grid) n = to_count(a, next(a), 0, many);
        else if (a == "--planes") options.planes = next(a);
        else if (a == "--random") options.random = to_count(a, next(a), 0, many);
        else if (a == "--seed")
            options.seed = static_cast<std::uint64_t>(to_count(a, next(a), 0, std::numeric_limits<long>::max()));
        else if (a == "--threads") options.threads = to_count(a, next(a), 1, LAP_MAX_THREADS);
        else if (a == "--repeat") options.repeat = to_count(a, next(a), 1, many);
        else if (a == "--check") options.check = true;
        else if (a == "--flip") options.flip = true;
        else if (a == "--vtu") options.vtu = next(a);
        else if (a == "--exploded") options.exploded = next(a);
        else if (a == "--explode") options.explode = to_factor(a, next(a));
        else if (a == "--json") options.json = next(a);
        else if (a == "--faces") {
            const std::string &style = next(a);
            if (style == "holes") options.style = LAP_FACES_HOLES;
            else if (style == "bridged") options.style = LAP_FACES_BRIDGED;
            else if (style == "triangles") options.style = LAP_FACES_TRIANGLES;
            else throw UsageError("--faces: '" + style + "' is none of holes, bridged, triangles");
        } else if (!a.empty() && a[0] == '-') throw UsageError("unknown option " + a);
        else if (options.mesh.empty()) options.mesh = a;
        else throw UsageError("more than one mesh: " + options.mesh + " and " + a);
    }
    if (!options.help && options.mesh.empty()) throw UsageError("no mesh given");
    if (!options.vtu.empty() && options.style == LAP_FACES_HOLES)
        throw UsageError("--vtu cannot write --faces holes: VTK has no faces with holes");
    return options;
}

// Handles that free themselves.
struct Free {
    void operator()(lap_context *p) const { lap_context_free(p); }
    void operator()(lap_mesh *p) const { lap_mesh_free(p); }
    void operator()(lap_cut *p) const { lap_cut_free(p); }
};
template <typename T>
using Handle = std::unique_ptr<T, Free>;

double seconds_since(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::int64_t peak_bytes()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::int64_t>(usage.ru_maxrss) * 1024; // Linux counts in KiB
}

// One run: flat arrays in, mesh and cut out, and what it took. `progress` may be null.
struct Run {
    Handle<lap_mesh> mesh;
    Handle<lap_cut> cut;
    Times times;
};

Run run(lap_context *context, const Mesh &input, const std::vector<double> &planes, Progress *progress)
{
    Run result;
    lap_mesh *mesh = nullptr;
    lap_cut *cut = nullptr;
    if (progress) start_progress(*progress, "mesh");
    const auto start = std::chrono::steady_clock::now();
    must(context, lap_mesh_new(context, input.vertex_count(), input.coordinates.data(), input.triangle_count(),
                               input.triangles.data(), nullptr, nullptr, &mesh));
    result.mesh.reset(mesh);
    result.times.stages.emplace_back("mesh", seconds_since(start));
    if (progress) end_progress(*progress);
    if (progress) start_progress(*progress, "cut");
    must(context,
         lap_cut_new(context, mesh, static_cast<std::int64_t>(planes.size() / 4), planes.data(), nullptr, &cut));
    result.cut.reset(cut);
    result.times.total = seconds_since(start);
    if (progress) end_progress(*progress);
    std::int32_t count = 0;
    must(context, lap_cut_stage_count(cut, &count));
    for (std::int32_t i = 0; i < count; ++i) {
        const char *name = nullptr;
        double seconds = 0;
        must(context, lap_cut_stage(cut, i, &name, &seconds));
        result.times.stages.emplace_back(name, seconds);
    }
    return result;
}

Polygons polygons_of(lap_context *context, const lap_complex *complex, std::int32_t style, std::int64_t face_count)
{
    Polygons polygons{};
    const std::int32_t *faces = nullptr;
    must(context, lap_complex_polygons(complex, style, &polygons.count, &polygons.offsets, &polygons.vertices, &faces));
    // The polygons of a face lie together: count, then sum up.
    polygons.face_polygons.assign(static_cast<std::size_t>(face_count) + 1, 0);
    for (std::int64_t p = 0; p < polygons.count; ++p) ++polygons.face_polygons[static_cast<std::size_t>(faces[p]) + 1];
    for (std::int64_t f = 0; f < face_count; ++f) polygons.face_polygons[f + 1] += polygons.face_polygons[f];
    return polygons;
}

Cells cells_of(lap_context *context, const lap_complex *complex)
{
    Cells cells{};
    must(context, lap_complex_vertices(complex, &cells.vertex_count, &cells.coordinates));
    must(context, lap_complex_edges(complex, &cells.edge_count, nullptr));
    must(context,
         lap_complex_cells(complex, &cells.cell_count, &cells.cell_shells, &cells.shell_faces, &cells.half_faces));
    must(context, lap_complex_cell_components(complex, nullptr, &cells.components));
    must(context, lap_complex_cell_moments(complex, nullptr, &cells.volumes, &cells.centroids, nullptr));
    return cells;
}

void reverse(Mesh &mesh)
{
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) std::swap(mesh.triangles[i + 1], mesh.triangles[i + 2]);
}

/// Some files face inward as a whole. If that is all that is wrong with a mesh, it is reversed; anything else is left for
/// the library to refuse.
bool reverse_if_inward(lap_context *context, Mesh &mesh)
{
    auto status = [&] {
        lap_mesh *made = nullptr;
        const std::int32_t result =
            lap_mesh_new(context, mesh.vertex_count(), mesh.coordinates.data(), mesh.triangle_count(),
                         mesh.triangles.data(), nullptr, nullptr, &made);
        lap_mesh_free(made);
        return result;
    };
    std::int64_t count = 0;
    const std::int32_t *kinds = nullptr;
    if (status() != LAP_ERR_BAD_MESH) return false;
    must(context, lap_context_last_defects(context, &count, &kinds, nullptr));
    if (!std::all_of(kinds, kinds + count, [](std::int32_t kind) { return kind == LAP_DEFECT_WRONG_NESTING; })) return false;
    reverse(mesh);
    if (status() == LAP_OK) return true;
    reverse(mesh);
    return false;
}

int cut_mesh(const Options &options)
{
    Mesh input = read_mesh(options.mesh);
    if (options.flip) reverse(input);
    const Box box = bounding_box(input);
    std::vector<double> planes = grid_planes(box, options.grid);
    auto append = [&](const std::vector<double> &more) { planes.insert(planes.end(), more.begin(), more.end()); };
    if (!options.planes.empty()) append(read_planes(options.planes));
    append(random_planes(box, options.random, options.seed));

    lap_context *made = nullptr;
    must(nullptr, lap_context_new(&made));
    const Handle<lap_context> handle(made);
    lap_context *context = handle.get();
    must(context, lap_context_set_threads(context, static_cast<std::int32_t>(options.threads)));
    if (!options.flip && reverse_if_inward(context, input))
        std::cerr << options.mesh << " faces inward: all its triangles are reversed\n";

    Report report;
    report.mesh = options.mesh;
    report.threads = options.threads;
    report.repeat = options.repeat;
    report.planes = static_cast<std::int64_t>(planes.size() / 4);
    Progress progress;
    progress.terminal = isatty(STDERR_FILENO) != 0;
    must(context, lap_context_set_progress(context, show_progress, &progress));
    if (options.check) {
        start_progress(progress, "validate");
        must(context, lap_mesh_validate(context, input.vertex_count(), input.coordinates.data(), input.triangle_count(),
                                        input.triangles.data(), nullptr, nullptr));
        end_progress(progress);
    }

    // The first run counts decisions and shows progress; the timed runs that follow do neither.
    must(context, lap_context_counters_enable(context, 1));
    Run best = run(context, input, planes, &progress);
    report.counters = counters_of(context);
    report.statistics = statistics_of(context, best.cut.get());
    must(context, lap_context_counters_enable(context, 0));
    must(context, lap_context_set_progress(context, nullptr, nullptr));
    const double counted = best.times.total;
    for (long i = 0; i < options.repeat; ++i) {
        best.mesh.reset(); // one result at a time: the peak of memory is that of one run
        best.cut.reset();
        Run next = run(context, input, planes, nullptr);
        if (i > 0 && best.times.total < next.times.total) next.times = std::move(best.times);
        best = std::move(next);
    }
    report.counted_seconds = counted;
    report.times = best.times;
    report.peak_bytes = peak_bytes();

    const lap_complex *complex = nullptr;
    must(context, lap_cut_complex(best.cut.get(), &complex));
    if (options.check) must(context, lap_complex_check(context, complex));
    fill_counts(report, context, best.mesh.get(), best.cut.get(), complex);

    const Cells cells = cells_of(context, complex);
    fill_volumes(report, cells.volumes, cells.cell_count);
    const Polygons polygons = polygons_of(context, complex, options.style, report.faces);
    report.style = options.style;
    report.polygons = polygons.count;

    print_table(report);
    if (!options.json.empty()) write_json(options.json, report);
    if (!options.vtu.empty()) write_vtu(options.vtu, cells, polygons);
    if (!options.exploded.empty()) {
        Outline outline{};
        must(context, lap_complex_faces(complex, nullptr, &outline.face_loops, &outline.loop_corners, nullptr,
                                        &outline.corner_edges));
        must(context, lap_complex_edges(complex, nullptr, &outline.edges));
        must(context, lap_complex_face_supports(complex, nullptr, &outline.support_kind, nullptr, nullptr, nullptr));
        std::array<double, 3> centre;
        for (int k = 0; k < 3; ++k) centre[k] = box.min[k] / 2 + box.max[k] / 2;
        const Polygons triangles = polygons_of(context, complex, LAP_FACES_TRIANGLES, report.faces);
        write_exploded(options.exploded, cells, triangles, outline, centre, options.explode);
    }
    return 0;
}

} // namespace

int main(int argc, char **argv)
{
    try {
        const Options options = parse(std::vector<std::string>(argv + 1, argv + argc));
        if (options.help) {
            std::cout << usage;
            return 0;
        }
        return cut_mesh(options);
    } catch (const UsageError &error) {
        std::cerr << "cut_mesh: " << error.what() << "\n\n" << usage;
        return exit_usage;
    } catch (const Refusal &error) {
        std::cerr << "cut_mesh: " << error.what() << '\n';
        return exit_refused;
    } catch (const std::exception &error) {
        std::cerr << "cut_mesh: " << error.what() << '\n';
        return exit_file;
    }
}
