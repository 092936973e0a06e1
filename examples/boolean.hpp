// Arrangements of meshes for mesh_boolean: what comes out as a table and as JSON, surfaces as mesh files, and a picture of the cells.
#ifndef LAPIDARY_EXAMPLES_BOOLEAN_HPP
#define LAPIDARY_EXAMPLES_BOOLEAN_HPP

#include "picture.hpp"
#include "program.hpp"
#include "report.hpp"

#include <lapidary.h>

#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace examples {

struct InputReport {
    std::string mesh;
    std::int64_t vertices = 0, triangles = 0, dropped = 0;
};

struct CellReport {
    std::vector<std::int32_t> winding; // for every operand
    double volume = 0;
    std::string exact;
};

struct BooleanReport {
    std::string operation;
    long threads = 1, repeat = 1;
    std::vector<InputReport> input;
    std::int64_t vertices = 0, faces = 0, patches = 0, cells = 0, pairs = 0;
    std::vector<CellReport> winding;
    std::int64_t out_vertices = 0, out_faces = 0, euler = 0;
    double volume = 0;
    std::string exact_volume;
    // What is wrong with the output once its coordinates are rounded, by kind.
    std::map<std::string, std::int64_t> defects;
    // Where it was asked for.
    bool certify = false;
    lap_surface_certify_report certified = {};
    Times times;
    Counters counters;
    std::int64_t peak_bytes = 0;

    std::int64_t self_intersections() const
    {
        const auto found = defects.find("LAP_DEFECT_SELF_INTERSECTION");
        return found == defects.end() ? 0 : found->second;
    }
};

// The cells with their winding numbers and volumes. Exact volumes of many cut triangles are long, and take longer than all else.
inline void fill_arrangement(BooleanReport &r, lap_context *context, const lap_arrangement *arrangement)
{
    must(context, lap_arrangement_counts(arrangement, &r.vertices, &r.faces, &r.patches, &r.cells, &r.pairs, nullptr));
    const std::int64_t *dropped = nullptr;
    must(context, lap_arrangement_operands(arrangement, nullptr, nullptr, nullptr, &dropped));
    for (std::size_t i = 0; i < r.input.size(); ++i) r.input[i].dropped = dropped[i];
    const std::int32_t *offsets = nullptr, *operands = nullptr, *windings = nullptr;
    const double *volumes = nullptr;
    must(context, lap_arrangement_cells(arrangement, nullptr, &offsets, &operands, &windings));
    must(context, lap_arrangement_cell_volumes(arrangement, nullptr, &volumes));
    for (std::int64_t c = 0; c < r.cells; ++c) {
        CellReport cell;
        cell.winding.resize(r.input.size());
        for (std::int32_t k = offsets[c]; k < offsets[c + 1]; ++k)
            cell.winding[static_cast<std::size_t>(operands[k])] = windings[k];
        cell.volume = volumes[c];
        const char *exact = nullptr;
        must(context, lap_arrangement_cell_volume_exact(context, arrangement, static_cast<std::int32_t>(c), &exact));
        cell.exact = exact;
        r.winding.push_back(std::move(cell));
    }
}

// A surface's arrays, borrowed.
struct SurfaceArrays {
    std::int64_t vertices = 0, triangles = 0;
    const double *xyz = nullptr;
    const std::int32_t *corners = nullptr;
};

inline SurfaceArrays arrays_of(lap_context *context, const lap_surface *surface)
{
    SurfaceArrays a;
    must(context, lap_surface_vertices(surface, &a.vertices, &a.xyz, nullptr));
    must(context, lap_surface_triangles(surface, &a.triangles, &a.corners, nullptr, nullptr, nullptr));
    return a;
}

// Sizes and volume, and every check that there is of what was rounded.
inline void fill_output(BooleanReport &r, lap_context *context, const lap_surface *surface)
{
    const SurfaceArrays a = arrays_of(context, surface);
    r.out_vertices = a.vertices;
    r.out_faces = a.triangles;
    must(context, lap_surface_euler(surface, &r.euler));
    must(context, lap_surface_volume(surface, &r.volume));
    const char *exact = nullptr;
    must(context, lap_surface_volume_exact(context, surface, &exact));
    r.exact_volume = exact;
    if (r.certify) must(context, lap_surface_certified_report(surface, &r.certified, static_cast<std::int32_t>(sizeof r.certified)));
    if (a.triangles == 0) return;
    const std::int32_t status =
        lap_mesh_validate(context, a.vertices, a.xyz, a.triangles, a.corners, nullptr, nullptr);
    if (status == LAP_ERR_BAD_MESH) {
        std::int64_t count = 0;
        const std::int32_t *kinds = nullptr;
        must(context, lap_context_last_defects(context, &count, &kinds, nullptr));
        for (std::int64_t i = 0; i < count; ++i) {
            const char *name = "";
            lap_defect_name(kinds[i], &name);
            ++r.defects[name];
        }
    } else {
        must(context, status);
    }
}

inline void print_boolean_table(const BooleanReport &r)
{
    for (const InputReport &input : r.input) {
        std::printf("%s\n", input.mesh.c_str());
        print_count("vertices", input.vertices);
        print_count("triangles", input.triangles);
        if (input.dropped > 0) print_count("  without area", input.dropped);
    }
    std::printf("arrangement\n");
    print_count("vertices", r.vertices);
    print_count("faces", r.faces);
    print_count("patches", r.patches);
    print_count("cells", r.cells);
    print_count("intersecting pairs", r.pairs);
    constexpr std::size_t shown = 20;
    for (std::size_t c = 1; c < std::min(r.winding.size(), shown + 1); ++c) {
        std::string name = "cell";
        for (std::size_t i = 0; i < std::min<std::size_t>(r.winding[c].winding.size(), 8); ++i)
            name += " " + std::to_string(r.winding[c].winding[i]);
        print_number(name.c_str(), r.winding[c].volume);
    }
    if (r.winding.size() > shown + 1) std::printf("  and %zu more cells\n", r.winding.size() - shown - 1);
    std::printf("%s\n", r.operation.c_str());
    print_count("vertices", r.out_vertices);
    print_count("faces", r.out_faces);
    print_count("Euler characteristic", r.euler);
    print_number("volume", r.volume);
    for (const auto &[kind, count] : r.defects) std::printf("  after rounding: %s %lld\n", kind.c_str(), static_cast<long long>(count));
    if (r.certify) {
        std::printf(r.certified.certified ? "certified\n" : "NOT certified\n");
        print_count("in contact, before", r.certified.contacts_before);
        print_count("rounds", r.certified.rounds);
        print_count("moved vertices", r.certified.moved_vertices);
        print_count("gone vertices", r.certified.gone_vertices);
        print_number("largest move", r.certified.largest_move);
        if (!r.certified.certified) print_count("pairs that remain", r.certified.open_pairs);
    }
    print_times(r.times, r.repeat, r.threads);
    if (!r.counters.empty()) print_decisions(r.counters);
    std::printf("peak memory %27.1f MB\n", static_cast<double>(r.peak_bytes) / 1e6);
    std::fflush(stdout);
}

inline void write_boolean_json(const std::string &path, const BooleanReport &r)
{
    using nlohmann::ordered_json;
    ordered_json json, input = ordered_json::array(), winding = ordered_json::array(), defects = ordered_json::object();
    for (const InputReport &i : r.input)
        input.push_back({{"mesh", i.mesh}, {"vertices", i.vertices}, {"triangles", i.triangles}, {"without_area", i.dropped}});
    for (const CellReport &c : r.winding) winding.push_back({{"vector", c.winding}, {"volume", c.volume}, {"exact", c.exact}});
    for (const auto &[kind, count] : r.defects) defects[kind] = count;
    json["input"] = input;
    json["operation"] = r.operation;
    json["threads"] = r.threads;
    json["repeat"] = r.repeat;
    json["arrangement"] = {{"vertices", r.vertices},
                           {"faces", r.faces},
                           {"patches", r.patches},
                           {"cells", r.cells},
                           {"intersecting_pairs", r.pairs}};
    json["winding"] = winding;
    json["output"] = {{"vertices", r.out_vertices}, {"faces", r.out_faces},
                      {"volume", r.volume},         {"exact_volume", r.exact_volume},
                      {"euler", r.euler},           {"self_intersections", r.self_intersections()},
                      {"defects", defects}};
    json["seconds"] = times_json(r.times);
    json["predicates"] = counters_json(r.counters);
    json["certified"] = ordered_json::object();
    if (r.certify) {
        const lap_surface_certify_report &c = r.certified;
        json["certified"] = {{"certified", c.certified != 0},
                             {"flat_before", c.flat_before},
                             {"contacts_before", c.contacts_before},
                             {"rounds", c.rounds},
                             {"triangles_before", c.triangles_before},
                             {"triangles_after", c.triangles_after},
                             {"removed_triangles", c.removed_triangles},
                             {"moved_vertices", c.moved_vertices},
                             {"gone_vertices", c.gone_vertices},
                             {"snapped", c.snapped},
                             {"thin_cells", c.thin_cells},
                             {"open_pairs", c.open_pairs},
                             {"largest_move", c.largest_move},
                             {"move_unit", c.move_unit}};
    }
    json["peak_bytes"] = r.peak_bytes;
    write_file(path, json.dump(1) + '\n');
}

// A mesh file; its format is told by the name's extension (OFF, OBJ, STL, PLY). All digits of the doubles are written.
inline void write_surface(const std::string &path, const SurfaceArrays &a)
{
    using Point = CGAL::Simple_cartesian<double>::Point_3;
    std::vector<Point> points;
    std::vector<std::vector<std::size_t>> triangles;
    for (std::int64_t v = 0; v < a.vertices; ++v) points.emplace_back(a.xyz[3 * v], a.xyz[3 * v + 1], a.xyz[3 * v + 2]);
    for (std::int64_t t = 0; t < a.triangles; ++t) {
        const std::int32_t *c = a.corners + 3 * t;
        triangles.push_back({static_cast<std::size_t>(c[0]), static_cast<std::size_t>(c[1]), static_cast<std::size_t>(c[2])});
    }
    const auto all_digits = CGAL::parameters::stream_precision(17).use_binary_mode(false);
    if (!CGAL::IO::write_polygon_soup(path, points, triangles, all_digits))
        throw std::runtime_error(path + ": cannot be written (OFF, OBJ, STL and PLY are known by their extension)");
}

// Every bounded cell, moved away from the middle of all by `factor` times its distance from it, in a colour for its winding numbers, with the lines where
// patches meet on it.
inline void write_cells_exploded(const std::string &path, lap_context *context, const lap_arrangement *arrangement,
                                 const std::vector<CellReport> &winding, double factor)
{
    std::int64_t vertices = 0, faces = 0;
    const double *xyz = nullptr;
    const std::int32_t *corners = nullptr, *patches = nullptr, *cells = nullptr;
    must(context, lap_arrangement_vertices(arrangement, &vertices, &xyz));
    must(context, lap_arrangement_faces(arrangement, &faces, &corners, &patches, &cells));
    std::vector<Moments> moments(winding.size());
    std::vector<std::vector<std::int64_t>> sides(winding.size()); // 2 f + side
    for (std::int64_t f = 0; f < faces; ++f) {
        if (patches[f] < 0) continue;
        const auto behind = static_cast<std::size_t>(cells[2 * f]), before = static_cast<std::size_t>(cells[2 * f + 1]);
        add_cone(moments[behind], moments[before], xyz, corners + 3 * f, corners + 3 * f + 3);
        sides[behind].push_back(2 * f);
        sides[before].push_back(2 * f + 1);
    }
    // The unbounded cell stays away.
    moments[0] = Moments();
    const std::vector<Shift> shifts = apart(moments, factor);
    std::map<std::vector<std::int32_t>, std::int64_t> colours;
    Picture picture(xyz, vertices);
    for (std::size_t c = 1; c < winding.size(); ++c) {
        const std::int64_t colour = colours.emplace(winding[c].winding, static_cast<std::int64_t>(colours.size())).first->second;
        const auto piece = static_cast<std::int64_t>(c);
        std::vector<std::tuple<std::int32_t, std::int32_t, std::int32_t>> edges; // with the patch
        for (const std::int64_t side : sides[c]) {
            const std::int32_t *t = corners + 3 * (side / 2);
            picture.polygon(piece, colour, t, t + 3, side % 2 != 0, shifts[c]);
            for (int k = 0; k < 3; ++k) {
                const auto ends = std::minmax(t[k], t[(k + 1) % 3]);
                edges.emplace_back(ends.first, ends.second, patches[side / 2]);
            }
        }
        std::sort(edges.begin(), edges.end());
        for (std::size_t i = 0; i < edges.size();) {
            const auto &[a, b, patch] = edges[i];
            const std::int32_t line[2] = {a, b};
            std::size_t next = i;
            while (next < edges.size() && std::get<0>(edges[next]) == a && std::get<1>(edges[next]) == b) ++next;
            if (std::get<2>(edges[next - 1]) != patch) picture.line(piece, colour, line, line + 2, shifts[c]);
            i = next;
        }
    }
    write_picture(path, std::move(picture));
}

} // namespace examples

#endif
