// extract_network: the implicit arrangement of functions, or the interface of materials, on a grid or a mesh of tetrahedra, and what
// comes out.
//
// What a host does with the library, in the order in which it does it: evaluate functions at the nodes, make a context and a
// network, borrow its arrays, free. `extract_network --help` says how to use it.
#include "functions.hpp"
#include "network.hpp"
#include "program.hpp"
#include "session.hpp"
#include "simplex_cases.hpp"

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
    R"(usage: extract_network (--ia | --mi) (--functions FILE.json --grid N | --tets FILE) [options]
       extract_network --simplex CASES.json --json FILE
Extracts the network of piecewise linear functions, exactly: vertices, polygons, patches, chains, shells, regions.

what
  --ia                    implicit arrangement: surfaces are where functions are zero
  --mi                    material interface: surfaces are where the largest function changes
  --functions FILE.json   a list of functions: sphere, plane, cylinder, cone, torus, constant
  --simplex CASES.json    single simplices with values at their corners; writes the counts of their elements
where
  --grid N                N cubes along each axis, five tetrahedra each
  --bbox X0 Y0 Z0 X1 Y1 Z1
                          the grid's box (default -1 -1 -1 1 1 1)
  --tets FILE             text: a line with the numbers of nodes, tetrahedra and functions; a line for each node, x y z and the
                          values of the functions; a line for each tetrahedron, its four nodes from 0. # begins a comment.
                          --functions, if given, are evaluated at the nodes and follow those of the file.
options
  --threads N             worker threads (default 1); the result does not depend on it
  --repeat N              run N times, report the fastest (default 1)
  --vtu FILE              the polygons, with patch, regions and functions of each, and the chains as polylines
  --patches FILE          a picture for scripts/render_exploded.py: the network by patches, its chains as lines (.vtp)
  --exploded FILE         the same: bounded regions moved apart (.vtp)
  --json FILE             counts, labels, times, predicate counters, peak memory
exit status: 0 done, 1 the library refused the input, 2 wrong usage, 3 a file cannot be read or written
)";

struct Options : Common {
    std::string functions, tets, simplex, vtu, patches, exploded;
    bool ia = false, mi = false;
    long grid = 0;
    std::array<double, 6> box{-1, -1, -1, 1, 1, 1};
};

// The largest number of cubes that the library takes along three axes alike.
constexpr long most_cubes = 598;

Options parse(const std::vector<std::string> &given)
{
    Options options;
    Arguments arguments;
    options.declare(arguments);
    arguments.flag("--ia", options.ia);
    arguments.flag("--mi", options.mi);
    arguments.text("--functions", options.functions);
    arguments.text("--tets", options.tets);
    arguments.text("--simplex", options.simplex);
    arguments.text("--vtu", options.vtu);
    arguments.text("--patches", options.patches);
    arguments.text("--exploded", options.exploded);
    arguments.count("--grid", options.grid, 1, most_cubes);
    arguments.numbers("--bbox", options.box);
    arguments.read(given, [](const std::string &other) { throw UsageError("what is '" + other + "'?"); });
    if (options.help) return options;
    if (!options.simplex.empty()) {
        if (options.json.empty()) throw UsageError("--simplex needs --json");
        return options;
    }
    if (options.ia == options.mi) throw UsageError("one of --ia and --mi is needed");
    if ((options.grid == 0) == options.tets.empty()) throw UsageError("one of --grid and --tets is needed");
    if (options.grid != 0 && options.functions.empty()) throw UsageError("--grid needs --functions");
    return options;
}

// Where functions are given, and their values: one array per function behind the other.
struct Input {
    long cubes = 0;
    std::array<double, 6> box{};
    TetMesh mesh;
    std::int64_t functions = 0;
    std::vector<double> values;

    std::int64_t node_count() const { return cubes > 0 ? (cubes + 1) * (cubes + 1) * (cubes + 1) : mesh.node_count(); }
    std::int64_t tet_count() const { return cubes > 0 ? 5 * cubes * cubes * cubes : mesh.tet_count(); }
};

Input read_input(const Options &options)
{
    Input input;
    input.cubes = options.grid;
    input.box = options.box;
    std::vector<Function> functions;
    if (!options.functions.empty()) functions = read_functions(options.functions);
    if (!options.tets.empty()) {
        input.mesh = read_tets(options.tets);
        input.values = std::move(input.mesh.values);
        input.functions = input.mesh.functions;
        for (const Function &f : functions)
            for (std::int64_t i = 0; i < input.mesh.node_count(); ++i) {
                const double *x = &input.mesh.xyz[3 * static_cast<std::size_t>(i)];
                input.values.push_back(evaluate(f, {x[0], x[1], x[2]}));
            }
    } else {
        input.values = values_on_grid(functions, options.grid, options.box);
    }
    input.functions += static_cast<std::int64_t>(functions.size());
    return input;
}

// One run: values in, network out, and what it took. `progress` may be null.
struct Run {
    Handle<lap_network> network;
    Times times;
};

Run run(lap_context *context, const Input &input, const lap_network_options &options, Progress *progress)
{
    Run result;
    lap_network *network = nullptr;
    if (progress) start_progress(*progress, "network");
    const auto start = std::chrono::steady_clock::now();
    const std::int64_t stride = std::max<std::int64_t>(input.node_count(), 1);
    if (input.cubes > 0) {
        const auto n = static_cast<std::int32_t>(input.cubes);
        const std::int32_t cells[3] = {n, n, n};
        must(context, lap_network_new_box(context, cells, input.box.data(), input.functions, input.values.data(), stride, 1,
                                          &options, &network));
    } else {
        must(context, lap_network_new_tets(context, input.node_count(), input.mesh.xyz.data(), input.tet_count(),
                                           input.mesh.tets.data(), input.functions, input.values.data(), stride, 1, &options,
                                           &network));
    }
    result.times.total = seconds_since(start);
    result.network.reset(network);
    if (progress) end_progress(*progress);
    add_stages<lap_network>(result.times, context, network, lap_network_stage_count, lap_network_stage);
    return result;
}

int extract_network(const Options &options)
{
    Session session(options.threads);
    lap_context *context = session.context();
    if (!options.simplex.empty()) {
        write_simplex_counts(context, options.simplex, options.json);
        return 0;
    }
    const Input input = read_input(options);

    lap_network_options network_options;
    must(context, lap_network_options_init(&network_options, static_cast<std::int32_t>(sizeof network_options)));
    network_options.kind = options.ia ? LAP_NETWORK_ARRANGEMENT : LAP_NETWORK_INTERFACE;

    NetworkReport report;
    const Run best = session.fastest(
        options.repeat, [&](Progress *progress) { return run(context, input, network_options, progress); },
        [&](const Run &) { report.counters = counters_of(context); });
    report.interface = options.mi;
    report.source = options.tets.empty() ? options.functions : options.tets;
    report.functions = input.functions;
    report.nodes = input.node_count();
    report.tets = input.tet_count();
    fill_run(report, options, best);

    fill_network_report(report, context, best.network.get());
    print_network_table(report);
    if (!options.json.empty()) write_network_json(options.json, report);
    if (options.vtu.empty() && options.patches.empty() && options.exploded.empty()) return 0;
    const NetworkArrays arrays = arrays_of(context, best.network.get());
    if (!options.vtu.empty()) write_network_vtu(options.vtu, arrays);
    if (!options.patches.empty()) write_patches(options.patches, arrays);
    if (!options.exploded.empty()) write_regions_exploded(options.exploded, arrays, 0.6);
    return 0;
}

} // namespace

int main(int argc, char **argv)
{
    return run_program("extract_network", usage, [&] {
        const Options options = parse(std::vector<std::string>(argv + 1, argv + argc));
        if (!options.help) return extract_network(options);
        std::cout << usage;
        return 0;
    });
}
