// What the examples tell: errors with the names of the culprits, progress, a table, a JSON file.
#ifndef LAPIDARY_EXAMPLES_REPORT_HPP
#define LAPIDARY_EXAMPLES_REPORT_HPP

#include <lapidary.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace examples {

// The library refused: its status, its message, and the first defects by name.
struct Refusal : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Throws Refusal unless a call of the library succeeded. `context` may be null: then the status is all there is to
// tell.
inline void must(lap_context *context, std::int32_t status)
{
    if (status == LAP_OK) return;
    const char *name = "", *message = "";
    lap_status_name(status, &name);
    std::string text = name;
    std::int64_t count = 0;
    const std::int32_t *kinds = nullptr;
    const std::int64_t *ids = nullptr;
    std::int32_t last = LAP_OK;
    // Functions without a context leave no message, so the last one may belong to another call.
    if (context && lap_context_last_error(context, &last, &message) == LAP_OK && last == status) {
        text += std::string(": ") + message;
        lap_context_last_defects(context, &count, &kinds, &ids);
    }
    constexpr std::int64_t shown = 10;
    for (std::int64_t i = 0; i < std::min(count, shown); ++i) {
        const char *kind = "";
        lap_defect_name(kinds[i], &kind);
        text += std::string("\n  ") + kind;
        for (int k = 0; k < 3 && ids[3 * i + k] >= 0; ++k) text += " " + std::to_string(ids[3 * i + k]);
    }
    if (count > shown) text += "\n  and " + std::to_string(count - shown) + " more";
    throw Refusal(text);
}

// Progress on the standard error: a bar that redraws itself on a terminal, a line per stage elsewhere.
struct Progress {
    bool terminal = false;
    std::string title, stage;
    int drawn = -1;
};

inline void start_progress(Progress &progress, std::string title)
{
    progress.title = std::move(title);
    progress.stage.clear();
    progress.drawn = -1;
}

inline std::int32_t show_progress(void *user, const char *stage, double fraction)
{
    Progress &progress = *static_cast<Progress *>(user);
    const int percent = static_cast<int>(100 * fraction);
    if (progress.terminal && (percent != progress.drawn || progress.stage != stage)) {
        const std::string done(static_cast<std::size_t>(percent) * 3 / 10, '#');
        std::fprintf(stderr, "\r%-8s [%-30s] %3d %% %-28.28s", progress.title.c_str(), done.c_str(), percent, stage);
    } else if (!progress.terminal && progress.stage != stage) {
        std::fprintf(stderr, "%-8s %3d %% %s\n", progress.title.c_str(), percent, stage);
    }
    progress.drawn = percent;
    progress.stage = stage;
    return 0; // go on
}

inline void end_progress(Progress &progress)
{
    if (progress.terminal && progress.drawn >= 0)
        std::fprintf(stderr, "\r%-8s [%-30s] 100 %% %-28s\n", progress.title.c_str(), std::string(30, '#').c_str(),
                     "done");
}

struct Times {
    double total = 0;
    std::vector<std::pair<std::string, double>> stages;
};

// What the total holds beyond its stages: checks of the arguments, handing the result over.
inline double outside_stages(const Times &times)
{
    double rest = times.total;
    for (const auto &stage : times.stages) rest -= stage.second;
    return rest;
}

using Counters = std::vector<std::pair<std::string, std::int64_t>>;

struct Report {
    std::string mesh;
    long threads = 1, repeat = 1;
    std::int64_t input_vertices = 0, input_triangles = 0, input_components = 0, planes = 0, distinct_planes = 0;
    std::int64_t vertices = 0, edges = 0, faces = 0, cells = 0, euler = 0, solid_euler = 0, polygons = 0;
    std::int32_t style = LAP_FACES_BRIDGED;
    double volume = 0, volume_sum = 0, volume_min = 0, volume_max = 0;
    std::vector<double> volumes;
    Times times;
    double counted_seconds = 0;
    Counters counters, statistics;
    std::int64_t peak_bytes = 0;
};

inline Counters counters_of(lap_context *context)
{
    Counters counters;
    std::int32_t count = 0;
    must(context, lap_context_counters_count(context, &count));
    for (std::int32_t i = 0; i < count; ++i) {
        const char *name = nullptr;
        std::int64_t value = 0;
        must(context, lap_context_counter(context, i, &name, &value));
        counters.emplace_back(name, value);
    }
    return counters;
}

// How decisions were found: by topology alone, or numerically. Only a cut that was made with counters on has them.
inline Counters statistics_of(lap_context *context, const lap_cut *cut)
{
    Counters statistics;
    std::int32_t count = 0;
    must(context, lap_cut_statistic_count(cut, &count));
    for (std::int32_t i = 0; i < count; ++i) {
        const char *name = nullptr;
        std::int64_t value = 0;
        must(context, lap_cut_statistic(cut, i, &name, &value));
        statistics.emplace_back(name, value);
    }
    return statistics;
}

inline void fill_counts(Report &report, lap_context *context, const lap_mesh *mesh, const lap_cut *cut,
                        const lap_complex *complex)
{
    must(context, lap_mesh_counts(mesh, &report.input_vertices, &report.input_triangles, nullptr,
                                  &report.input_components, nullptr));
    must(context, lap_mesh_volume(mesh, &report.volume));
    must(context, lap_complex_counts(complex, &report.vertices, &report.edges, &report.faces, &report.cells, nullptr,
                                     nullptr, nullptr));
    must(context, lap_complex_euler(complex, &report.euler, &report.solid_euler));
    std::int64_t planes = 0;
    const std::int32_t *map = nullptr;
    must(context, lap_cut_plane_map(cut, &planes, &map));
    for (std::int64_t p = 0; p < planes; ++p) report.distinct_planes += map[p] == p;
}

// Neumaier's sum: the error of the additions stays below that of the terms themselves.
struct Sum {
    double sum = 0, lost = 0;
};

inline void add(Sum &to, double v)
{
    const double next = to.sum + v;
    to.lost += std::abs(to.sum) >= std::abs(v) ? (to.sum - next) + v : (v - next) + to.sum;
    to.sum = next;
}

inline double value(const Sum &sum)
{
    return sum.sum + sum.lost;
}

inline void fill_volumes(Report &report, const double *volumes, std::int64_t count)
{
    report.volumes.assign(volumes, volumes + count);
    Sum sum;
    for (double v : report.volumes) add(sum, v);
    report.volume_sum = value(sum);
    if (count == 0) return;
    report.volume_min = *std::min_element(report.volumes.begin(), report.volumes.end());
    report.volume_max = *std::max_element(report.volumes.begin(), report.volumes.end());
}

// Predicate counters are named "predicate.tier": a table of predicates by tiers, and the tiers' shares of all
// decisions.
inline void print_decisions(const Counters &counters)
{
    std::vector<std::string> predicates, tiers;
    auto place = [](std::vector<std::string> &names, const std::string &name) {
        const auto at = std::find(names.begin(), names.end(), name);
        const auto found = static_cast<std::size_t>(at - names.begin());
        if (at == names.end()) names.push_back(name);
        return found;
    };
    std::vector<std::vector<std::int64_t>> table; // by predicate, then tier
    for (const auto &[name, value] : counters) {
        const std::size_t dot = name.rfind('.');
        const std::size_t predicate = place(predicates, name.substr(0, dot)), tier = place(tiers, name.substr(dot + 1));
        table.resize(predicates.size());
        table[predicate].resize(std::max(table[predicate].size(), tier + 1));
        table[predicate][tier] = value;
    }
    std::vector<std::int64_t> sums(tiers.size());
    std::int64_t all = 0;
    std::printf("decisions         ");
    for (const std::string &tier : tiers) std::printf(" %10s", tier.c_str());
    std::printf("\n");
    for (std::size_t i = 0; i < predicates.size(); ++i) {
        table[i].resize(tiers.size());
        if (std::count(table[i].begin(), table[i].end(), 0) == static_cast<std::ptrdiff_t>(tiers.size())) continue;
        std::printf("  %-16s", predicates[i].c_str());
        for (std::size_t k = 0; k < tiers.size(); ++k) {
            std::printf(" %10lld", static_cast<long long>(table[i][k]));
            sums[k] += table[i][k];
            all += table[i][k];
        }
        std::printf("\n");
    }
    std::printf("  %-16s", "all");
    for (std::int64_t sum : sums)
        std::printf(" %8.2f %%", all > 0 ? 100.0 * static_cast<double>(sum) / static_cast<double>(all) : 0.0);
    std::printf("\n");
}

inline void print_count(const char *name, std::int64_t value)
{
    std::printf("  %-24s %14lld\n", name, static_cast<long long>(value));
}

inline void print_number(const char *name, double value)
{
    std::printf("  %-24s %14.8g\n", name, value);
}

inline void print_times(const Times &times, long repeat, long threads)
{
    std::printf("time, ms (fastest of %ld, %ld thread%s)\n", repeat, threads, threads == 1 ? "" : "s");
    for (const auto &[name, seconds] : times.stages) std::printf("  %-24s %14.3f\n", name.c_str(), 1000 * seconds);
    std::printf("  %-24s %14.3f\n", "outside the stages", 1000 * outside_stages(times));
    std::printf("  %-24s %14.3f\n", "total", 1000 * times.total);
}

inline void print_table(const Report &r)
{
    const auto count = print_count;
    const auto number = print_number;
    std::printf("%s\n", r.mesh.c_str());
    count("vertices", r.input_vertices);
    count("triangles", r.input_triangles);
    count("components", r.input_components);
    count("planes", r.planes);
    if (r.distinct_planes != r.planes) count("distinct planes", r.distinct_planes);
    std::printf("cells and what bounds them\n");
    count("vertices", r.vertices);
    count("edges", r.edges);
    count("faces", r.faces);
    count("cells", r.cells);
    count("Euler characteristic", r.euler);
    count("  of the input solid", r.solid_euler);
    std::printf("volume\n");
    number("input", r.volume);
    number("sum over cells", r.volume_sum);
    number("smallest cell", r.volume_min);
    number("largest cell", r.volume_max);
    print_times(r.times, r.repeat, r.threads);
    if (!r.counters.empty()) print_decisions(r.counters);
    std::printf("peak memory %27.1f MB\n", static_cast<double>(r.peak_bytes) / 1e6);
    std::fflush(stdout);
}

inline nlohmann::ordered_json counters_json(const Counters &counters)
{
    nlohmann::ordered_json all = nlohmann::ordered_json::object();
    for (const auto &[name, value] : counters) all[name] = value;
    return all;
}

inline nlohmann::ordered_json times_json(const Times &times)
{
    // A stage may run more than once; its times add up.
    nlohmann::ordered_json stages = nlohmann::ordered_json::object();
    for (const auto &[name, seconds] : times.stages)
        stages[name] = seconds + (stages.contains(name) ? stages[name].get<double>() : 0.0);
    return {{"total", times.total}, {"stages", stages}, {"outside_stages", outside_stages(times)}};
}

inline void write_file(const std::string &path, const std::string &text)
{
    std::ofstream out(path);
    out << text;
    out.close();
    if (!out) throw std::runtime_error(path + ": cannot be written");
}

inline void write_json(const std::string &path, const Report &r)
{
    using nlohmann::ordered_json;
    const char *styles[] = {"holes", "bridged", "triangles"};
    ordered_json json;
    json["mesh"] = r.mesh;
    json["input"] = {{"vertices", r.input_vertices},
                     {"triangles", r.input_triangles},
                     {"components", r.input_components},
                     {"euler", r.solid_euler}};
    json["planes"] = r.planes;
    json["distinct_planes"] = r.distinct_planes;
    json["threads"] = r.threads;
    json["repeat"] = r.repeat;
    json["output"] = {
        {"vertices", r.vertices}, {"edges", r.edges}, {"faces", r.faces}, {"cells", r.cells}, {"euler", r.euler}};
    json["polygons"] = {{"style", styles[r.style]}, {"count", r.polygons}};
    json["volume"] = {{"input", r.volume}, {"sum", r.volume_sum}, {"min", r.volume_min}, {"max", r.volume_max}};
    json["cell_volumes"] = r.volumes;
    json["seconds"] = times_json(r.times);
    json["seconds"]["with_counters"] = r.counted_seconds;
    json["statistics"] = counters_json(r.statistics);
    json["predicates"] = counters_json(r.counters);
    json["peak_bytes"] = r.peak_bytes;
    write_file(path, json.dump(1) + '\n');
}

} // namespace examples

#endif
