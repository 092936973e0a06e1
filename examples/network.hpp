// Networks of functions for extract_network: a reader of tetrahedra with values, counts as a table and as JSON, and files for VTK.
#ifndef LAPIDARY_EXAMPLES_NETWORK_HPP
#define LAPIDARY_EXAMPLES_NETWORK_HPP

#include "picture.hpp"
#include "program.hpp"
#include "report.hpp"
#include "vtk.hpp"

#include <lapidary.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace examples {

// Tetrahedra, and functions with values at their nodes, one array per function behind the other.
struct TetMesh {
    std::vector<double> xyz;
    std::vector<std::int32_t> tets;
    std::int64_t functions = 0;
    std::vector<double> values;

    std::int64_t node_count() const { return static_cast<std::int64_t>(xyz.size() / 3); }
    std::int64_t tet_count() const { return static_cast<std::int64_t>(tets.size() / 4); }
};

// The words of a text file, without comments from `#` on, each with its line.
class Words {
public:
    explicit Words(const std::string &name) : path(name), in(name)
    {
        if (!in) throw std::runtime_error(path + ": cannot be read");
    }
    // The next word; empty at the end.
    std::string next()
    {
        std::string word, line;
        while (!(rest >> word)) {
            if (!std::getline(in, line)) return {};
            ++number;
            rest.clear();
            rest.str(line.substr(0, line.find('#')));
        }
        return word;
    }
    // The next word as a number that `convert` makes of it.
    template <typename Convert>
    auto value(const char *what, Convert convert)
    {
        const std::string word = next();
        std::size_t used = 0;
        decltype(convert(word, &used)) result{};
        try {
            result = convert(word, &used);
        } catch (const std::exception &) {
            used = 0;
        }
        if (used == 0 || used != word.size()) fail("'" + word + "' is not " + what);
        return result;
    }
    double real()
    {
        return value("a double", [](const std::string &word, std::size_t *used) { return std::stod(word, used); });
    }
    std::int32_t integer()
    {
        const long long n =
            value("an integer", [](const std::string &word, std::size_t *used) { return std::stoll(word, used); });
        if (n < INT32_MIN || n > INT32_MAX) fail("'" + std::to_string(n) + "' is too large");
        return static_cast<std::int32_t>(n);
    }
    std::int32_t count()
    {
        const std::int32_t n = integer();
        if (n < 0) fail("'" + std::to_string(n) + "' is not a count");
        return n;
    }
    [[noreturn]] void fail(const std::string &what) const
    {
        throw std::runtime_error(path + ", line " + std::to_string(number) + ": " + what);
    }

private:
    std::string path;
    std::ifstream in;
    std::istringstream rest;
    long number = 0;
};

// See `extract_network --help`. Throws std::runtime_error naming the line. Whether nodes exist is the library's to say.
inline TetMesh read_tets(const std::string &path)
{
    Words words(path);
    TetMesh mesh;
    const std::int32_t nodes = words.count(), tets = words.count();
    mesh.functions = words.count();
    std::vector<std::vector<double>> values(static_cast<std::size_t>(mesh.functions));
    for (std::int32_t i = 0; i < nodes; ++i) {
        for (int k = 0; k < 3; ++k) mesh.xyz.push_back(words.real());
        for (auto &of_function : values) of_function.push_back(words.real());
    }
    for (std::int32_t t = 0; t < tets; ++t)
        for (int k = 0; k < 4; ++k) mesh.tets.push_back(words.integer());
    if (!words.next().empty()) words.fail("more than the first line says");
    for (const auto &of_function : values) mesh.values.insert(mesh.values.end(), of_function.begin(), of_function.end());
    return mesh;
}

struct NetworkReport {
    std::string source;
    bool interface = false;
    long threads = 1, repeat = 1;
    std::int64_t functions = 0, nodes = 0, tets = 0;
    std::int64_t vertices = 0, edges = 0, faces = 0, patches = 0, chains = 0, corners = 0, components = 0, shells = 0,
                 regions = 0;
    std::vector<std::int64_t> active;
    // Of each region: the sign of every function, or the material alone.
    std::vector<std::vector<std::int32_t>> labels;
    Times times;
    Counters counters;
    std::int64_t peak_bytes = 0;
};

inline void fill_network_report(NetworkReport &r, lap_context *context, const lap_network *network)
{
    must(context, lap_network_counts(network, &r.vertices, &r.edges, &r.faces, &r.patches, &r.chains, &r.corners,
                                     &r.components, &r.shells, &r.regions));
    std::int64_t count = 0, functions = 0;
    const std::int64_t *active = nullptr;
    must(context, lap_network_active(network, &count, &active));
    r.active.assign(active, active + count);
    const std::int32_t *labels = nullptr;
    if (r.interface) {
        must(context, lap_network_region_materials(network, &count, &labels));
        functions = 1;
    } else {
        must(context, lap_network_region_signs(network, &count, &functions, &labels));
    }
    for (std::int64_t i = 0; i < count; ++i) r.labels.emplace_back(labels + i * functions, labels + (i + 1) * functions);
}

inline void print_network_table(const NetworkReport &r)
{
    std::printf("%s, %s\n", r.source.c_str(), r.interface ? "material interface" : "implicit arrangement");
    print_count(r.interface ? "materials" : "functions", r.functions);
    print_count("nodes", r.nodes);
    print_count("tetrahedra", r.tets);
    for (std::size_t k = 1; k < r.active.size(); ++k)
        if (r.active[k] > 0) print_count(("  with " + std::to_string(k) + " active").c_str(), r.active[k]);
    std::printf("network\n");
    print_count("vertices", r.vertices);
    print_count("edges", r.edges);
    print_count("faces", r.faces);
    print_count("patches", r.patches);
    print_count("chains", r.chains);
    print_count("corners", r.corners);
    print_count("components", r.components);
    print_count("shells", r.shells);
    print_count("regions", r.regions);
    print_times(r.times, r.repeat, r.threads);
    if (!r.counters.empty()) print_decisions(r.counters);
    std::printf("peak memory %27.1f MB\n", static_cast<double>(r.peak_bytes) / 1e6);
    std::fflush(stdout);
}

inline void write_network_json(const std::string &path, const NetworkReport &r)
{
    using nlohmann::ordered_json;
    ordered_json json, active = ordered_json::object(), labels = ordered_json::array();
    for (std::size_t k = 1; k < r.active.size(); ++k)
        if (r.active[k] > 0) active[std::to_string(k)] = r.active[k];
    for (const auto &label : r.labels) labels.push_back(r.interface ? ordered_json(label[0]) : ordered_json(label));
    json["input"] = r.source;
    json["kind"] = r.interface ? "material_interface" : "arrangement";
    json["functions"] = r.functions;
    json["nodes"] = r.nodes;
    json["tets"] = r.tets;
    json["active_tets"] = active;
    json["threads"] = r.threads;
    json["repeat"] = r.repeat;
    json["output"] = {{"vertices", r.vertices}, {"edges", r.edges},           {"faces", r.faces},
                      {"patches", r.patches},   {"chains", r.chains},         {"corners", r.corners},
                      {"components", r.components}, {"shells", r.shells},     {"regions", r.regions}};
    json["labels"] = labels;
    json["seconds"] = times_json(r.times);
    json["predicates"] = counters_json(r.counters);
    json["peak_bytes"] = r.peak_bytes;
    write_file(path, json.dump(1) + '\n');
}

// A network's arrays, borrowed, as the C API gives them; CSR where there are offsets.
struct NetworkArrays {
    std::int64_t vertices = 0, polygons = 0, patches = 0, chains = 0, shells = 0, regions = 0;
    const double *xyz = nullptr;
    const std::int32_t *polygon_offsets = nullptr, *polygon_vertices = nullptr, *polygon_sets = nullptr;
    const std::int32_t *set_offsets = nullptr, *set_functions = nullptr;
    const std::int32_t *polygon_patches = nullptr, *patch_offsets = nullptr, *patch_polygons = nullptr;
    const std::uint8_t *turned = nullptr;
    const std::int32_t *chain_offsets = nullptr, *chain_vertices = nullptr;
    const std::int32_t *around_offsets = nullptr, *around_sides = nullptr;
    const std::int32_t *shell_offsets = nullptr, *shell_sides = nullptr, *shell_regions = nullptr;
    // The region of each side of a patch.
    std::vector<std::int32_t> side_regions;

    const std::int32_t *polygon_begin(std::int64_t p) const { return polygon_vertices + polygon_offsets[p]; }
    const std::int32_t *chain_begin(std::int64_t c) const { return chain_vertices + chain_offsets[c]; }
    // The region before (1) or behind (0) a polygon.
    std::int32_t region(std::int64_t polygon, int side) const
    {
        return side_regions[2 * static_cast<std::size_t>(polygon_patches[polygon]) + (side ^ turned[polygon])];
    }
};

inline NetworkArrays arrays_of(lap_context *context, const lap_network *network)
{
    NetworkArrays a;
    must(context, lap_network_vertices(network, &a.vertices, &a.xyz, nullptr));
    must(context, lap_network_polygons(network, &a.polygons, &a.polygon_offsets, &a.polygon_vertices, &a.polygon_sets,
                                       nullptr));
    must(context, lap_network_sets(network, nullptr, &a.set_offsets, &a.set_functions, nullptr));
    must(context, lap_network_polygon_patches(network, nullptr, &a.polygon_patches, &a.turned));
    must(context, lap_network_patches(network, &a.patches, &a.patch_offsets, &a.patch_polygons, nullptr));
    must(context, lap_network_chains(network, &a.chains, nullptr, nullptr, &a.chain_offsets, &a.chain_vertices, nullptr));
    must(context, lap_network_chain_patches(network, nullptr, &a.around_offsets, &a.around_sides, nullptr));
    must(context, lap_network_shells(network, &a.shells, &a.shell_offsets, &a.shell_sides, &a.shell_regions));
    must(context, lap_network_regions(network, &a.regions, nullptr, nullptr, nullptr));
    a.side_regions.resize(2 * static_cast<std::size_t>(a.patches));
    for (std::int64_t s = 0; s < a.shells; ++s)
        for (std::int32_t k = a.shell_offsets[s]; k < a.shell_offsets[s + 1]; ++k)
            a.side_regions[static_cast<std::size_t>(a.shell_sides[k])] = a.shell_regions[s];
    return a;
}

// The polygons as VTK polygons, then the chains as polylines. Cell data: patch, function (the lowest of the set), region before and
// behind of polygons, chain of polylines; -1 where there is none.
inline void write_network_vtu(const std::string &path, const NetworkArrays &a)
{
    const std::uint8_t polygon = 7, polyline = 4; // VTK_POLYGON, VTK_POLY_LINE
    std::vector<std::int64_t> connectivity, offsets;
    std::vector<std::uint8_t> types;
    std::vector<std::int32_t> patch, function, before, behind, chain;
    for (std::int64_t p = 0; p < a.polygons; ++p) {
        connectivity.insert(connectivity.end(), a.polygon_vertices + a.polygon_offsets[p],
                            a.polygon_vertices + a.polygon_offsets[p + 1]);
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
        types.push_back(polygon);
        patch.push_back(a.polygon_patches[p]);
        function.push_back(a.set_functions[a.set_offsets[a.polygon_sets[p]]]);
        before.push_back(a.region(p, 1));
        behind.push_back(a.region(p, 0));
        chain.push_back(-1);
    }
    for (std::int64_t c = 0; c < a.chains; ++c) {
        connectivity.insert(connectivity.end(), a.chain_vertices + a.chain_offsets[c], a.chain_vertices + a.chain_offsets[c + 1]);
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
        types.push_back(polyline);
        for (auto *none : {&patch, &function, &before, &behind}) none->push_back(-1);
        chain.push_back(static_cast<std::int32_t>(c));
    }
    VtkFile file;
    begin_file(file, "UnstructuredGrid");
    file.xml << "<Piece NumberOfPoints=\"" << a.vertices << "\" NumberOfCells=\"" << types.size() << "\">\n<Points>\n";
    add_array(file, "Points", a.xyz, 3 * static_cast<std::size_t>(a.vertices), 3);
    file.xml << "</Points>\n<Cells>\n";
    add_array(file, "connectivity", connectivity);
    add_array(file, "offsets", offsets);
    add_array(file, "types", types);
    file.xml << "</Cells>\n<CellData>\n";
    add_array(file, "patch", patch);
    add_array(file, "function", function);
    add_array(file, "region_before", before);
    add_array(file, "region_behind", behind);
    add_array(file, "chain", chain);
    file.xml << "</CellData>\n</Piece>\n";
    end_file(file, "UnstructuredGrid", path);
}

// The network, a colour for each patch, its chains as lines.
inline void write_patches(const std::string &path, const NetworkArrays &a)
{
    Picture picture(a.xyz, a.vertices);
    const Shift stay{0, 0, 0};
    for (std::int64_t patch = 0; patch < a.patches; ++patch)
        for (std::int32_t k = a.patch_offsets[patch]; k < a.patch_offsets[patch + 1]; ++k) {
            const std::int32_t p = a.patch_polygons[k];
            picture.polygon(patch, patch, a.polygon_begin(p), a.polygon_begin(p + 1), a.turned[p] != 0, stay);
        }
    for (std::int64_t c = 0; c < a.chains; ++c) picture.line(a.patches, a.patches, a.chain_begin(c), a.chain_begin(c + 1), stay);
    write_picture(path, std::move(picture));
}

// Every region's boundary, moved away from the middle of all by `factor` times its distance from it, with the chains on it. The outermost regions,
// which surround others and reach the boundary of the domain, have no positive volume within their shells and are left out.
inline void write_regions_exploded(const std::string &path, const NetworkArrays &a, double factor)
{
    std::vector<Moments> moments(static_cast<std::size_t>(a.regions));
    for (std::int64_t p = 0; p < a.polygons; ++p)
        add_cone(moments[static_cast<std::size_t>(a.region(p, 0))], moments[static_cast<std::size_t>(a.region(p, 1))], a.xyz,
                 a.polygon_begin(p), a.polygon_begin(p + 1));
    const std::vector<Shift> shifts = apart(moments, factor);
    // The polygons of each region, by one pass over all: count, sum up, fill.
    std::vector<std::int64_t> first(static_cast<std::size_t>(a.regions) + 1, 0);
    for (std::int64_t p = 0; p < a.polygons; ++p)
        for (int side = 0; side < 2; ++side) ++first[static_cast<std::size_t>(a.region(p, side)) + 1];
    for (std::int64_t r = 0; r < a.regions; ++r) first[r + 1] += first[r];
    std::vector<std::int64_t> sides(static_cast<std::size_t>(2 * a.polygons)), next(first.begin(), first.end() - 1);
    for (std::int64_t p = 0; p < a.polygons; ++p)
        for (int side = 0; side < 2; ++side) sides[static_cast<std::size_t>(next[a.region(p, side)]++)] = 2 * p + side;
    // Chains beside each region, once each.
    std::vector<std::vector<std::int64_t>> chains(static_cast<std::size_t>(a.regions));
    for (std::int64_t c = 0; c < a.chains; ++c)
        for (std::int32_t k = a.around_offsets[c]; k < a.around_offsets[c + 1]; ++k)
            for (int other = 0; other < 2; ++other) {
                auto &beside = chains[static_cast<std::size_t>(a.side_regions[static_cast<std::size_t>(a.around_sides[k] ^ other)])];
                if (beside.empty() || beside.back() != c) beside.push_back(c);
            }

    Picture picture(a.xyz, a.vertices);
    std::int64_t piece = 0;
    for (std::int64_t r = 0; r < a.regions; ++r) {
        if (!(moments[static_cast<std::size_t>(r)].volume > 0)) continue;
        const Shift &shift = shifts[static_cast<std::size_t>(r)];
        for (std::int64_t k = first[r]; k < first[r + 1]; ++k) {
            const std::int64_t p = sides[k] / 2;
            picture.polygon(piece, piece, a.polygon_begin(p), a.polygon_begin(p + 1), sides[k] % 2 != 0, shift);
        }
        for (const std::int64_t c : chains[static_cast<std::size_t>(r)])
            picture.line(piece, piece, a.chain_begin(c), a.chain_begin(c + 1), shift);
        ++piece;
    }
    write_picture(path, std::move(picture));
}

} // namespace examples

#endif
