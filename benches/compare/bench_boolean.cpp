// bench_boolean: unions of meshes by the library and by CGAL, side by side. `bench_boolean --help` says how to use it.
//
// Every contestant runs in a process of its own on the same arrays (contest.hpp). What counts are the ratios of one run.
#include "arguments.hpp"
#include "boolean_cases.hpp"
#include "booleans.hpp"
#include "contest.hpp"
#include "contestants.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace benches;

constexpr const char* usage =
    R"(usage: bench_boolean CASE [options]
Unites triangle meshes with the library (1 and 2 threads) and with CGAL's corefinement, and compares.

CASE (one of these)
  turned MESH      a mesh (OFF, OBJ, STL or PLY) and itself, rotated at random and shifted by a fifth of its size
  shifted MESH     a mesh and itself, shifted by a twentieth of its size
  squares N        two cubes of N x N squares a side, shifted by (1/2, 1/4, 0) of a square
  cubes N          N unit cubes in random rotation, centres uniform in [0, 2]^3; CGAL unites them one after the other
  spheres N        two unit spheres of 20 N^2 triangles each, centres 0.8 apart
options
  --name NAME      what the results call the case
  --peers LIST     corefinement (CGAL's Polygon Mesh Processing, rounded constructions), the default, or none
  --repeat N       twice, run each up to N times; report the fastest (default 3); no further run after 10 seconds
  --limit SECONDS  end a contestant that takes longer (default 120)
  --json FILE      write the results
exit status: 0 done (a peer that fails is a result), 1 the library failed, 2 wrong usage, 3 a file cannot be read or written
)";

using examples::Arguments;
using examples::UsageError;
using examples::to_count;

struct Options {
  std::string shape, of, name, json;
  long repeat = 3, limit = 120;
  bool corefinement = true, help = false;
};

Options parse(const std::vector<std::string>& given) {
  Options options;
  Arguments arguments;
  arguments.flag("--help", options.help);
  arguments.flag("-h", options.help);
  arguments.text("--name", options.name);
  arguments.count("--repeat", options.repeat, 1);
  arguments.count("--limit", options.limit, 1);
  arguments.on("--peers", [&] {
    const std::string list = arguments.next();
    if (list != "corefinement" && list != "none") throw UsageError("--peers: '" + list + "' is unknown");
    options.corefinement = list == "corefinement";
  });
  arguments.text("--json", options.json);
  arguments.read(given, [&](const std::string& a) {
    if (options.shape.empty()) options.shape = a;
    else if (options.of.empty()) options.of = a;
    else throw UsageError("more than one case: " + a + " after " + options.shape + " " + options.of);
  });
  if (!options.help && options.shape.empty()) throw UsageError("no case given");
  const std::vector<std::string> shapes{"turned", "shifted", "squares", "cubes", "spheres"};
  if (!options.help && std::find(shapes.begin(), shapes.end(), options.shape) == shapes.end())
    throw UsageError("'" + options.shape + "' is not a case");
  if (!options.help && options.of.empty()) throw UsageError(options.shape + ": of what?");
  if (options.name.empty()) options.name = options.shape + " " + options.of.substr(options.of.find_last_of('/') + 1);
  return options;
}

std::vector<examples::Mesh> operands_of(const Options& options) {
  const auto number = [&](long most) {
    const long n = to_count(options.shape, options.of, 1, examples::many_counts);
    if (n > most) throw UsageError(options.shape + ": at most " + std::to_string(most));
    return static_cast<int>(n);
  };
  if (options.shape == "turned") return turned_pair(examples::read_mesh(options.of));
  if (options.shape == "shifted") return shifted_pair(examples::read_mesh(options.of));
  if (options.shape == "squares") return squares(number(5000));
  if (options.shape == "cubes") return random_cubes(number(100000));
  return spheres(number(5000));
}

using Uniting = std::function<UnionOutcome(const std::vector<examples::Mesh>&)>;

// In the child. `memory_bytes` is what the first run needed on top of the arrays that it is given, `peak_bytes` the whole process.
nlohmann::json measure(const Options& options, const Uniting& unite) {
  const std::vector<examples::Mesh> meshes = operands_of(options);
  forget_peak();
  const long long before = resident_bytes();
  const auto start = std::chrono::steady_clock::now();
  UnionOutcome best = unite(meshes);
  const long long peak = peak_bytes();
  long runs = 1;
  for (; runs < options.repeat && seconds_since(start) < 10; ++runs) {
    const UnionOutcome next = unite(meshes);
    best.seconds = std::min(best.seconds, next.seconds);
    best.seconds_with_meshes = std::min(best.seconds_with_meshes, next.seconds_with_meshes);
  }
  return {{"seconds", best.seconds},
          {"seconds_with_meshes", best.seconds_with_meshes},
          {"triangles", best.triangles},
          {"volume", best.volume},
          {"memory_bytes", peak - before},
          {"peak_bytes", peak},
          {"runs", runs}};
}

void print(const nlohmann::json& report) {
  std::printf("%s: %lld meshes, %lld triangles\n", report["case"].get<std::string>().c_str(), report["meshes"].get<long long>(),
              report["triangles"].get<long long>());
  std::printf("%-14s %12s %12s %9s %10s %22s %9s %9s\n", "", "ms", "with meshes", "ratio", "triangles", "volume", "MB", "peak MB");
  const nlohmann::json& ours = report["results"].front();
  for (const nlohmann::json& one : report["results"]) {
    std::printf("%-14s ", one["name"].get<std::string>().c_str());
    if (one.contains("error")) {
      std::printf("failed: %s\n", one["error"].get<std::string>().c_str());
      continue;
    }
    const double seconds = one["seconds"];
    std::printf("%12.3f %12.3f ", seconds * 1e3, one["seconds_with_meshes"].get<double>() * 1e3);
    if (ours.contains("seconds")) std::printf("%9.2f ", ours["seconds"].get<double>() / seconds);
    else std::printf("%9s ", "");
    std::printf("%10lld %22.15g %9.1f %9.1f\n", one["triangles"].get<long long>(), one["volume"].get<double>(),
                one["memory_bytes"].get<double>() / 1e6, one["peak_bytes"].get<double>() / 1e6);
  }
  std::printf("ratio: the time of lapidary-1 divided by that of each\n");
  std::fflush(stdout);
}

int bench(const Options& options) {
  nlohmann::json report{{"case", options.name}, {"results", nlohmann::json::array()}};
  const double limit = static_cast<double>(options.limit);
  // Read in a child as well: this process stays small, and so does what its children inherit.
  const nlohmann::json sizes = isolated(limit, [&] {
    const std::vector<examples::Mesh> meshes = operands_of(options);
    std::int64_t triangles = 0;
    for (const examples::Mesh& mesh : meshes) triangles += mesh.triangle_count();
    return nlohmann::json{{"meshes", meshes.size()}, {"triangles", triangles}};
  });
  if (sizes.contains("error")) throw std::runtime_error(sizes["error"].get<std::string>());
  report.update(sizes);

  std::vector<std::string> names;
  std::vector<Work> works;
  const auto contestant = [&](const std::string& name, const Uniting& unite) {
    names.push_back(name);
    works.push_back([&options, unite] { return measure(options, unite); });
  };
  for (const std::int32_t threads : {1, 2})
    contestant("lapidary-" + std::to_string(threads), [threads](const auto& meshes) { return lapidary_union(meshes, threads); });
  if (options.corefinement) contestant("corefinement", corefined_union);

  std::vector<nlohmann::json> results = contest(limit, works);
  bool ours_failed = false;
  for (std::size_t i = 0; i < names.size(); ++i) {
    results[i]["name"] = names[i];
    ours_failed = ours_failed || (results[i].contains("error") && names[i].rfind("lapidary", 0) == 0);
    report["results"].push_back(std::move(results[i]));
  }
  print(report);
  if (!options.json.empty()) write_report(options.json, report);
  return ours_failed ? 1 : 0;
}

} // namespace

int main(int argc, char** argv) { return run_bench("bench_boolean", usage, argc, argv, parse, bench); }
