// cut_grid: cuts the boxes of a rectilinear grid along a closed triangle mesh and reports what comes out.
//
// What a flow solver does with the library, in the order in which it does it: read flat arrays, make a context and a mesh,
// cut a block of a grid, borrow the flags of the boxes and the arrays of the cut cells, free. `cut_grid --help` says how to use
// it.
#include "grid.hpp"
#include "planes.hpp"
#include "program.hpp"
#include "session.hpp"

#include <lapidary.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace examples;

constexpr const char *usage =
    R"(usage: cut_grid MESH --grid-nodes (NX NY NZ | FILE) [options]
Cuts the boxes of a rectilinear grid along a closed triangle mesh (OFF, OBJ, STL, PLY), exactly.

grid
  --grid-nodes NX NY NZ   so many nodes along x, y and z, evenly over the bounding box grown by 1/20 on every side
  --grid-nodes FILE       three lines of rising coordinates, the nodes along x, along y and along z
  --block I0 I1 J0 J1 K0 K1
                          only boxes I0 <= i < I1, J0 <= j < J1, K0 <= k < K1
  --outside               the fluid is outside the mesh, not inside
options
  --flip                  reverse all triangles first, for a mesh that faces inward
  --threads N             worker threads (default 1); the result does not depend on it
  --check                 also test the input for self-intersections and the result for consistency (not in the times)
  --repeat N              run N times, report the fastest (default 1)
  --vtu FILE              the cut cells as VTK polyhedra, with their arrays (--vtk does the same)
  --full                  with --vtu: the full boxes as well, as hexahedra
  --json FILE             counts, volumes, times, predicate counters, peak memory
exit status: 0 done, 1 the library refused the input, 2 wrong usage, 3 a file cannot be read or written
)";

struct Options : OneMesh {
    std::string nodes;
    std::array<long, 3> count{0, 0, 0};
    std::array<long, 6> block{0, -1, 0, -1, 0, -1};
    bool outside = false, full = false;
};

Options parse(const std::vector<std::string> &given)
{
    Options options;
    Arguments arguments;
    options.declare(arguments);
    arguments.on("--grid-nodes", [&] {
        const std::string &first = arguments.next();
        // A file whose name is a number can be given as ./NUMBER.
        if (first.find_first_not_of("0123456789") != std::string::npos) {
            options.nodes = first;
            return;
        }
        options.count[0] = to_count("--grid-nodes", first, 2, many_counts);
        for (int k = 1; k < 3; ++k) options.count[k] = to_count("--grid-nodes", arguments.next(), 2, many_counts);
    });
    arguments.counts("--block", options.block, 0);
    arguments.flag("--outside", options.outside);
    arguments.flag("--full", options.full);
    arguments.text("--vtk", options.vtu);
    options.read(arguments, given);
    if (options.help) return options;
    if (options.nodes.empty() == (options.count[0] == 0)) throw UsageError("--grid-nodes is needed, once");
    if (options.full && options.vtu.empty()) throw UsageError("--full is of no use without --vtu");
    return options;
}

// One run: flat arrays in, mesh and grid out, and what it took. `progress` may be null.
struct Run {
    Handle<lap_mesh> mesh;
    Handle<lap_grid> grid;
    Times times;
};

Run run(lap_context *context, const Mesh &input, const Nodes &nodes, const lap_grid_options &options,
        Progress *progress)
{
    Run result;
    lap_mesh *mesh = nullptr;
    lap_grid *grid = nullptr;
    if (progress) start_progress(*progress, "mesh");
    const auto start = std::chrono::steady_clock::now();
    must(context, lap_mesh_new(context, input.vertex_count(), input.coordinates.data(), input.triangle_count(),
                               input.triangles.data(), nullptr, nullptr, &mesh));
    result.mesh.reset(mesh);
    result.times.stages.emplace_back("mesh", seconds_since(start));
    if (progress) end_progress(*progress);
    if (progress) start_progress(*progress, "grid");
    must(context, lap_grid_new(context, mesh, nodes.count(0), nodes.at(0), nodes.count(1), nodes.at(1), nodes.count(2),
                               nodes.at(2), &options, &grid));
    result.grid.reset(grid);
    if (progress) end_progress(*progress);
    add_stages<lap_grid>(result.times, context, grid, lap_grid_stage_count, lap_grid_stage);
    // Volumes, areas and centroids are made when they are first asked for.
    const auto moments = std::chrono::steady_clock::now();
    must(context, lap_grid_cell_moments(grid, nullptr, nullptr, nullptr, nullptr, nullptr));
    result.times.stages.emplace_back("moments", seconds_since(moments));
    result.times.total = seconds_since(start);
    return result;
}

int cut_grid(const Options &options)
{
    Session session(options.threads);
    lap_context *context = session.context();
    const Mesh input = session.mesh(options);
    const Box box = bounding_box(input);
    const Nodes nodes = options.nodes.empty() ? even_nodes(box, options.count) : read_nodes(options.nodes);

    lap_grid_options grid_options;
    must(context, lap_grid_options_init(&grid_options, static_cast<std::int32_t>(sizeof grid_options)));
    grid_options.outside = options.outside;
    for (int axis = 0; axis < 3; ++axis) {
        grid_options.block_low[axis] = static_cast<std::int32_t>(options.block[2 * axis]);
        grid_options.block_high[axis] = static_cast<std::int32_t>(options.block[2 * axis + 1]);
    }

    GridReport report;
    const Run best = session.fastest(
        options.repeat, [&](Progress *progress) { return run(context, input, nodes, grid_options, progress); },
        [&](const Run &) { report.counters = counters_of(context); });
    report.mesh = options.mesh;
    report.outside = options.outside;
    fill_run(report, options, best);
    if (options.check) must(context, lap_grid_check(context, best.grid.get()));

    fill_grid_report(report, context, best.mesh.get(), best.grid.get(), box);
    print_grid_table(report);
    Hexahedra hexahedra;
    std::vector<std::int64_t> full_boxes;
    if (options.full) hexahedra = full_hexahedra(block_of(context, best.grid.get()), full_boxes);
    if (!options.json.empty()) write_grid_json(options.json, report, !options.vtu.empty(), hexahedra);
    if (!options.vtu.empty()) write_grid_vtu(options.vtu, context, best.grid.get(), hexahedra, full_boxes);
    return 0;
}

} // namespace

int main(int argc, char **argv)
{
    return run_program("cut_grid", usage, [&] {
        const Options options = parse(std::vector<std::string>(argv + 1, argv + argc));
        if (!options.help) return cut_grid(options);
        std::cout << usage;
        return 0;
    });
}
