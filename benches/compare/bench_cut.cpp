// bench_cut: the library and what a C++ user would otherwise take, side by side. `bench_cut --help` says how to use it.
//
// Every contestant runs in a process of its own on the same arrays (contest.hpp). What counts are the ratios of one run.
#include "arguments.hpp"
#include "contest.hpp"
#include "contestants.hpp"
#include "icosphere.hpp"
#include "planes.hpp"

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
    R"(usage: bench_cut MESH PLANES [options]
Cuts the solid inside a closed triangle mesh along planes with the library (1 and 2 threads) and with others, and compares.

MESH               an OFF, OBJ, STL or PLY file, or icosphere:LEVEL, a sphere of 20 * 4^LEVEL triangles
planes (one of these)
  --grid NX NY NZ  so many planes across x, y and z, evenly over the bounding box, its sides included
  --random N       directions uniform on the sphere, through points uniform in the bounding box
  --seed S         seed of --random (default 1)
options
  --peers LIST     others, separated by commas: pmp-epick, pmp-epeck (CGAL's Polygon Mesh Processing, with rounded and with
                   exact constructions), nef (CGAL's Nef polyhedra); default pmp-epick,pmp-epeck; `none` for none
  --repeat N       twice, run each up to N times; report the fastest (default 3); no further run after 10 seconds
  --limit SECONDS  end a contestant that takes longer (default 120)
  --json FILE      write the results
exit status: 0 done (a peer that fails is a result), 1 the library failed, 2 wrong usage, 3 a file cannot be read or written
)";

using examples::Arguments;
using examples::UsageError;
using examples::to_count;

struct Options {
  std::string mesh, json, planes;
  std::array<long, 3> grid{0, 0, 0};
  long random = 0, repeat = 3, limit = 120, seed = 1;
  std::vector<std::string> peers{"pmp-epick", "pmp-epeck"};
  bool help = false;
};

struct Contestant {
  std::string name;
  std::function<Outcome(const examples::Mesh&, const Planes&)> run;
};

const std::vector<Contestant>& all_peers() {
  static const std::vector<Contestant> peers{{"pmp-epick", pmp_epick}, {"pmp-epeck", pmp_epeck}, {"nef", nef}};
  return peers;
}

std::vector<std::string> to_peers(const std::string& list) {
  std::vector<std::string> peers;
  if (list == "none") return peers;
  for (std::size_t at = 0; at <= list.size();) {
    const std::size_t end = std::min(list.find(',', at), list.size());
    peers.push_back(list.substr(at, end - at));
    const auto known = [&](const Contestant& c) { return c.name == peers.back(); };
    if (std::none_of(all_peers().begin(), all_peers().end(), known))
      throw UsageError("--peers: '" + peers.back() + "' is unknown");
    at = end + 1;
  }
  return peers;
}

Options parse(const std::vector<std::string>& given) {
  Options options;
  Arguments arguments;
  arguments.flag("--help", options.help);
  arguments.flag("-h", options.help);
  arguments.on("--grid", [&] {
    options.planes = "grid";
    for (long& n : options.grid) {
      n = to_count("--grid", arguments.next(), 0, examples::many_counts);
      options.planes += " " + std::to_string(n);
    }
  });
  arguments.on("--random", [&] {
    options.random = to_count("--random", arguments.next(), 0, examples::many_counts);
    options.planes = "random " + std::to_string(options.random);
  });
  arguments.count("--seed", options.seed, 0);
  arguments.count("--repeat", options.repeat, 1);
  arguments.count("--limit", options.limit, 1);
  arguments.on("--peers", [&] { options.peers = to_peers(arguments.next()); });
  arguments.text("--json", options.json);
  arguments.read(given, [&](const std::string& a) {
    if (!options.mesh.empty()) throw UsageError("more than one mesh: " + options.mesh + " and " + a);
    options.mesh = a;
  });
  if (!options.help && options.mesh.empty()) throw UsageError("no mesh given");
  if (!options.help && options.planes.empty()) throw UsageError("no planes given");
  return options;
}

struct Input {
  examples::Mesh mesh;
  Planes planes;
};

Input input_of(const Options& options) {
  Input input;
  const std::string sphere = "icosphere:";
  if (options.mesh.compare(0, sphere.size(), sphere) == 0) {
    const long level = to_count("icosphere", options.mesh.substr(sphere.size()), 0, 20);
    if (level > 11) throw UsageError("icosphere: more triangles than 32-bit indices can name");
    input.mesh = icosphere(static_cast<int>(level));
  } else {
    input.mesh = examples::read_mesh(options.mesh);
  }
  const examples::Box box = examples::bounding_box(input.mesh);
  input.planes = examples::grid_planes(box, options.grid);
  const Planes random = examples::random_planes(box, options.random, options.seed);
  input.planes.insert(input.planes.end(), random.begin(), random.end());
  return input;
}

// In the child. The memory is what the first run needed on top of the arrays that it is given.
nlohmann::json measure(const Options& options, const Contestant& contestant) {
  const Input input = input_of(options);
  forget_peak();
  const long long before = resident_bytes();
  const auto start = std::chrono::steady_clock::now();
  Outcome best = contestant.run(input.mesh, input.planes);
  const long long memory = peak_bytes() - before;
  long runs = 1;
  for (; runs < options.repeat && seconds_since(start) < 10; ++runs) {
    const Outcome next = contestant.run(input.mesh, input.planes);
    best.seconds = std::min(best.seconds, next.seconds);
    best.seconds_with_moments = std::min(best.seconds_with_moments, next.seconds_with_moments);
    best.seconds_prepared = std::min(best.seconds_prepared, next.seconds_prepared);
    best.seconds_moved = std::min(best.seconds_moved, next.seconds_moved);
  }
  nlohmann::json result{{"seconds", best.seconds}, {"cells", best.cells}, {"volume", best.volume}, {"memory_bytes", memory},
                        {"runs", runs}};
  if (best.seconds_with_moments > 0) result["seconds_with_moments"] = best.seconds_with_moments;
  if (best.seconds_prepared > 0) result["seconds_prepared"] = best.seconds_prepared;
  if (best.seconds_moved > 0) result["seconds_moved"] = best.seconds_moved;
  if (best.faces > 0) result["faces"] = best.faces;
  return result;
}

void print(const nlohmann::json& report) {
  std::printf("%s (%lld triangles), %s (%lld planes)\n", report["mesh"].get<std::string>().c_str(),
              report["triangles"].get<long long>(), report["plane_set"].get<std::string>().c_str(),
              report["planes"].get<long long>());
  std::printf("%-12s %12s %14s %9s %8s %22s %10s\n", "", "ms", "with moments", "ratio", "cells", "volume", "MiB");
  const nlohmann::json& ours = report["results"].front();
  for (const nlohmann::json& one : report["results"]) {
    std::printf("%-12s ", one["name"].get<std::string>().c_str());
    if (one.contains("error")) {
      std::printf("failed: %s\n", one["error"].get<std::string>().c_str());
      continue;
    }
    const double seconds = one["seconds"];
    std::printf("%12.3f ", seconds * 1e3);
    if (one.contains("seconds_with_moments")) std::printf("%14.3f ", one["seconds_with_moments"].get<double>() * 1e3);
    else std::printf("%14s ", "");
    if (ours.contains("seconds")) std::printf("%9.2f ", seconds / ours["seconds"].get<double>());
    else std::printf("%9s ", "");
    std::printf("%8lld %22.15g %10.1f\n", one["cells"].get<long long>(), one["volume"].get<double>(),
                one["memory_bytes"].get<double>() / 1048576);
  }
  std::fflush(stdout);
}

int bench(const Options& options) {
  nlohmann::json report{{"mesh", options.mesh.substr(options.mesh.find_last_of('/') + 1)}, {"plane_set", options.planes},
                        {"results", nlohmann::json::array()}};
  const double limit = static_cast<double>(options.limit);
  // Read in a child as well: this process stays small, and so does what its children inherit.
  const nlohmann::json sizes = isolated(limit, [&] {
    const Input input = input_of(options);
    return nlohmann::json{{"triangles", input.mesh.triangle_count()}, {"planes", input.planes.size() / 4}};
  });
  if (sizes.contains("error")) throw std::runtime_error(sizes["error"].get<std::string>());
  report.update(sizes);

  std::vector<Contestant> contestants;
  for (const std::int32_t threads : {1, 2}) {
    const auto run = [threads](const auto& mesh, const auto& planes) { return lapidary_cut(mesh, planes, threads); };
    contestants.push_back({"lapidary-" + std::to_string(threads), run});
  }
  for (const std::string& name : options.peers)
    for (const Contestant& peer : all_peers())
      if (peer.name == name) contestants.push_back(peer);

  std::vector<Work> works;
  for (const Contestant& contestant : contestants) works.push_back([&] { return measure(options, contestant); });
  std::vector<nlohmann::json> results = contest(limit, works);
  bool ours_failed = false;
  for (std::size_t i = 0; i < contestants.size(); ++i) {
    results[i]["name"] = contestants[i].name;
    ours_failed = ours_failed || (results[i].contains("error") && contestants[i].name.rfind("lapidary", 0) == 0);
    report["results"].push_back(std::move(results[i]));
  }
  print(report);
  if (!options.json.empty()) write_report(options.json, report);
  return ours_failed ? 1 : 0;
}

} // namespace

int main(int argc, char** argv) { return run_bench("bench_cut", usage, argc, argv, parse, bench); }
