// mesh_boolean: the cells into which meshes divide space, with their winding numbers, and a boolean of the meshes.
//
// What a host does with the library, in the order in which it does it: read flat arrays, make a context and an arrangement, take
// a surface from it, borrow its arrays, free. `mesh_boolean --help` says how to use it.
#include "boolean.hpp"
#include "program.hpp"
#include "session.hpp"

#include <lapidary.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace examples;

constexpr const char *usage =
    R"(usage: mesh_boolean MESH... --op OPERATION [options]
Finds the cells into which triangle meshes (OFF, OBJ, STL, PLY) divide space, exactly, and writes a boolean of them. Meshes may intersect
themselves, touch, overlap, and have several components; at every edge their triangles have to balance.

operations (a point is inside a mesh where that winds around it, in the positive sense)
  union                 inside any mesh
  intersection          inside all
  difference            inside the first and no other one
  xor                   inside an odd number of them
  resolve               where the winding numbers of all have a positive sum: inside, were they one mesh
  at-least:K            inside at least K of them
  expr:"EXPRESSION"     such as "(0 | 1) & !2": numbers are operands, from 0; ! not, & and, - and not, ^ one but not both, | or
options
  --plane NX,NY,NZ,D    the half-space n.x + D < 0 as a further operand; any number of them, numbered behind the meshes
  --bounds X,Y,Z,X,Y,Z  the box in which half-spaces are (default: one around all meshes, with room)
  --certify             round so that the output does not intersect itself, checked exactly; volume and all else are then of the rounded solid
  --threads N           worker threads (default 1); the result does not depend on it
  --repeat N            run N times, report the fastest (default 1)
  --out FILE            the surface, as OFF, OBJ, STL or PLY; coordinates are the exact ones, rounded
  --exploded FILE       a picture for scripts/render_exploded.py: the cells moved apart, coloured by winding numbers (.vtp)
  --explode FACTOR      how far apart (default 0.6)
  --json FILE           counts, winding numbers, volumes, times, predicate counters, peak memory
exit status: 0 done, 1 the library refused the input, 2 wrong usage, 3 a file cannot be read or written
)";

struct Options : Common {
    std::vector<std::string> meshes;
    std::vector<double> planes, bounds; // four numbers each; six or none
    std::string op, out, exploded, expression;
    std::int32_t operation = LAP_EXTRACT_UNION, at_least = 1;
    bool certify = false;
    double explode = 0.6;
};

// So many numbers between commas.
std::vector<double> to_numbers(const std::string &option, const std::string &text, std::size_t count)
{
    std::vector<double> numbers;
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t end = std::min(text.find(',', start), text.size());
        numbers.push_back(to_number(option, text.substr(start, end - start)));
        start = end + 1;
    }
    if (numbers.size() != count) throw UsageError(option + ": '" + text + "' is not " + std::to_string(count) + " numbers");
    return numbers;
}

void read_operation(Options &options)
{
    const std::vector<std::pair<std::string, std::int32_t>> named = {{"union", LAP_EXTRACT_UNION},
                                                                    {"intersection", LAP_EXTRACT_INTERSECTION},
                                                                    {"difference", LAP_EXTRACT_DIFFERENCE},
                                                                    {"xor", LAP_EXTRACT_SYMMETRIC_DIFFERENCE},
                                                                    {"resolve", LAP_EXTRACT_RESOLVE}};
    const std::string counted = "at-least:", written = "expr:";
    for (const auto &[name, operation] : named)
        if (options.op == name) {
            options.operation = operation;
            return;
        }
    if (options.op.compare(0, counted.size(), counted) == 0) {
        options.operation = LAP_EXTRACT_AT_LEAST;
        options.at_least = static_cast<std::int32_t>(to_count("--op at-least", options.op.substr(counted.size()), 1, many_counts));
    } else if (options.op.compare(0, written.size(), written) == 0) {
        options.expression = options.op.substr(written.size());
        if (options.expression.empty()) throw UsageError("--op expr: needs an expression");
    } else {
        throw UsageError("--op: '" + options.op + "' is not an operation");
    }
}

Options parse(const std::vector<std::string> &given)
{
    Options options;
    Arguments arguments;
    options.declare(arguments);
    arguments.text("--op", options.op);
    arguments.text("--out", options.out);
    arguments.text("--exploded", options.exploded);
    arguments.factor("--explode", options.explode);
    arguments.flag("--certify", options.certify);
    arguments.on("--plane", [&] {
        const std::vector<double> plane = to_numbers("--plane", arguments.next(), 4);
        options.planes.insert(options.planes.end(), plane.begin(), plane.end());
    });
    arguments.on("--bounds", [&] { options.bounds = to_numbers("--bounds", arguments.next(), 6); });
    arguments.read(given, [&](const std::string &mesh) { options.meshes.push_back(mesh); });
    if (options.help) return options;
    if (options.meshes.empty() && (options.planes.empty() || options.bounds.empty())) throw UsageError("no mesh given");
    if (options.op.empty()) throw UsageError("--op is needed");
    read_operation(options);
    return options;
}

// One run: meshes in, arrangement and surface out, and what it took. `progress` may be null.
struct Run {
    Handle<lap_arrangement> arrangement;
    Handle<lap_surface> surface;
    Times times;
};

Run run(lap_context *context, const std::vector<lap_operand> &operands, const Options &options, Progress *progress)
{
    Run result;
    lap_arrangement *arrangement = nullptr;
    lap_surface *surface = nullptr;
    if (progress) start_progress(*progress, "boolean");
    const auto start = std::chrono::steady_clock::now();
    must(context, lap_arrangement_new_half_spaces(context, static_cast<std::int64_t>(operands.size()), operands.data(),
                                                  static_cast<std::int64_t>(options.planes.size() / 4), options.planes.data(),
                                                  options.bounds.empty() ? nullptr : options.bounds.data(), nullptr, &arrangement));
    result.arrangement.reset(arrangement);
    const auto arranged = std::chrono::steady_clock::now();
    if (options.expression.empty())
        must(context, lap_arrangement_extract(context, arrangement, options.operation, options.at_least, &surface));
    else
        must(context, lap_arrangement_extract_expression(context, arrangement, options.expression.c_str(), &surface));
    result.surface.reset(surface);
    const double extract = seconds_since(arranged);
    double certify = 0;
    if (options.certify) {
        if (progress) start_progress(*progress, "certify");
        const auto begun = std::chrono::steady_clock::now();
        must(context, lap_surface_certify(context, result.surface.get(), nullptr, &surface));
        result.surface.reset(surface);
        certify = seconds_since(begun);
    }
    result.times.total = seconds_since(start);
    if (progress) end_progress(*progress);
    add_stages<lap_arrangement>(result.times, context, arrangement, lap_arrangement_stage_count, lap_arrangement_stage);
    result.times.stages.emplace_back("extract", extract);
    if (options.certify) result.times.stages.emplace_back("certify", certify);
    return result;
}

int mesh_boolean(const Options &options)
{
    Session session(options.threads);
    lap_context *context = session.context();

    BooleanReport report;
    std::vector<Mesh> meshes;
    std::vector<lap_operand> operands;
    for (const std::string &path : options.meshes) meshes.push_back(read_mesh(path));
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const Mesh &mesh = meshes[i];
        operands.push_back({mesh.vertex_count(), mesh.coordinates.data(), mesh.triangle_count(), mesh.triangles.data()});
        report.input.push_back({options.meshes[i], mesh.vertex_count(), mesh.triangle_count(), 0});
    }
    for (std::size_t i = 0; i < options.planes.size(); i += 4) {
        std::ostringstream name;
        name << std::setprecision(17) << "plane " << options.planes[i] << ',' << options.planes[i + 1] << ',' << options.planes[i + 2] << ','
             << options.planes[i + 3];
        report.input.push_back({name.str(), 0, 0, 0});
    }

    const Run best = session.fastest(
        options.repeat, [&](Progress *progress) { return run(context, operands, options, progress); },
        [&](const Run &) { report.counters = counters_of(context); });
    report.operation = options.op;
    report.certify = options.certify;
    fill_run(report, options, best);

    fill_arrangement(report, context, best.arrangement.get());
    fill_output(report, context, best.surface.get());
    print_boolean_table(report);
    if (!options.json.empty()) write_boolean_json(options.json, report);
    if (!options.out.empty()) write_surface(options.out, arrays_of(context, best.surface.get()));
    if (!options.exploded.empty())
        write_cells_exploded(options.exploded, context, best.arrangement.get(), report.winding, options.explode);
    return 0;
}

} // namespace

int main(int argc, char **argv)
{
    return run_program("mesh_boolean", usage, [&] {
        const Options options = parse(std::vector<std::string>(argv + 1, argv + argc));
        if (!options.help) return mesh_boolean(options);
        std::cout << usage;
        return 0;
    });
}
