// cut_mesh: cuts the solid inside a closed triangle mesh along planes and reports what comes out.
//
// Everything that a host does with the library is here in the order in which a host does it: read flat arrays, make a
// context and a mesh, cut, borrow the arrays of the complex, free. `cut_mesh --help` says how to use it.
#include "planes.hpp"
#include "program.hpp"
#include "session.hpp"

#include <lapidary.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <iostream>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace examples;

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

struct Options : OneMesh {
    std::string planes, exploded;
    std::array<long, 3> grid{0, 0, 0};
    long random = 0, seed = 1;
    std::int32_t style = LAP_FACES_BRIDGED;
    double explode = 0.25;
};

Options parse(const std::vector<std::string> &given)
{
    Options options;
    Arguments arguments;
    options.declare(arguments);
    arguments.counts("--grid", options.grid, 0);
    arguments.text("--planes", options.planes);
    arguments.count("--random", options.random, 0);
    arguments.count("--seed", options.seed, 0, std::numeric_limits<long>::max());
    arguments.text("--exploded", options.exploded);
    arguments.factor("--explode", options.explode);
    arguments.on("--faces", [&] {
        const std::string &style = arguments.next();
        if (style == "holes") options.style = LAP_FACES_HOLES;
        else if (style == "bridged") options.style = LAP_FACES_BRIDGED;
        else if (style == "triangles") options.style = LAP_FACES_TRIANGLES;
        else throw UsageError("--faces: '" + style + "' is none of holes, bridged, triangles");
    });
    options.read(arguments, given);
    if (!options.vtu.empty() && options.style == LAP_FACES_HOLES)
        throw UsageError("--vtu cannot write --faces holes: VTK has no faces with holes");
    return options;
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
    add_stages<lap_cut>(result.times, context, cut, lap_cut_stage_count, lap_cut_stage);
    return result;
}

int cut_mesh(const Options &options)
{
    Session session(options.threads);
    lap_context *context = session.context();
    const Mesh input = session.mesh(options);
    const Box box = bounding_box(input);
    std::vector<double> planes = grid_planes(box, options.grid);
    auto append = [&](const std::vector<double> &more) { planes.insert(planes.end(), more.begin(), more.end()); };
    if (!options.planes.empty()) append(read_planes(options.planes));
    append(random_planes(box, options.random, options.seed));

    Report report;
    report.mesh = options.mesh;
    report.planes = static_cast<std::int64_t>(planes.size() / 4);
    const Run best = session.fastest(
        options.repeat, [&](Progress *progress) { return run(context, input, planes, progress); },
        [&](const Run &counted) {
            report.counters = counters_of(context);
            report.statistics = statistics_of(context, counted.cut.get());
            report.counted_seconds = counted.times.total;
        });
    fill_run(report, options, best);

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
    if (!options.vtu.empty()) {
        std::vector<std::int64_t> ids(static_cast<std::size_t>(cells.cell_count));
        std::iota(ids.begin(), ids.end(), 0);
        write_vtu(options.vtu, cells, polygons, {}, [&](VtkFile &file) {
            add_array(file, "cell", ids);
            add_array(file, "component", cells.components, ids.size());
            add_array(file, "volume", cells.volumes, ids.size());
        });
    }
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
    return run_program("cut_mesh", usage, [&] {
        const Options options = parse(std::vector<std::string>(argv + 1, argv + argc));
        if (!options.help) return cut_mesh(options);
        std::cout << usage;
        return 0;
    });
}
