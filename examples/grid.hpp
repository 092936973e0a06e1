// What the examples with grids share: node coordinates, what a cut grid holds as a table and as JSON, and its cells for VTK.
#ifndef LAPIDARY_EXAMPLES_GRID_HPP
#define LAPIDARY_EXAMPLES_GRID_HPP

#include "numbers.hpp"
#include "planes.hpp"
#include "program.hpp"
#include "report.hpp"
#include "vtk.hpp"

#include <lapidary.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace examples {

// Coordinates of a grid's nodes along x, y and z, as the C API takes them.
struct Nodes {
    std::array<std::vector<double>, 3> along;

    std::int64_t count(int axis) const { return static_cast<std::int64_t>(along[axis].size()); }
    const double *at(int axis) const { return along[axis].data(); }
};

// count[axis] nodes along each axis, evenly over the box grown by 1/20 of its extent on either side.
inline Nodes even_nodes(const Box &box, const std::array<long, 3> &count)
{
    Nodes nodes;
    for (int axis = 0; axis < 3; ++axis) {
        const double margin = (box.max[axis] - box.min[axis]) / 20;
        const double low = box.min[axis] - margin, extent = box.max[axis] + margin - low;
        for (long i = 0; i < count[axis]; ++i)
            nodes.along[axis].push_back(low + extent * (static_cast<double>(i) / static_cast<double>(count[axis] - 1)));
    }
    return nodes;
}

// Three lines of numbers: the nodes along x, y and z. Empty lines and comments from `#` on are allowed. Throws
// std::runtime_error naming the line. Whether they rise is the library's to say.
inline Nodes read_nodes(const std::string &path)
{
    Nodes nodes;
    int axis = 0;
    read_numbers(path, [&](std::vector<double> values, const std::string &where) {
        if (axis == 3) throw std::runtime_error(where + ": a fourth line of nodes");
        nodes.along[axis++] = std::move(values);
    });
    if (axis < 3) throw std::runtime_error(path + ": three lines of nodes are needed, along x, y and z");
    return nodes;
}

// A block of a grid and its boxes: borrowed arrays, as the C API gives them.
struct Block {
    const std::int64_t *boxes, *first, *total; // three numbers each
    const double *nodes[3];
    const std::uint8_t *flags;

    std::int64_t box_count() const { return boxes[0] * boxes[1] * boxes[2]; }
    std::array<std::int64_t, 3> box_at(std::int64_t b) const
    {
        return {b % boxes[0], b / boxes[0] % boxes[1], b / (boxes[0] * boxes[1])};
    }
    double width(int axis, std::int64_t i) const { return nodes[axis][i + 1] - nodes[axis][i]; }
    double box_volume(std::int64_t b) const
    {
        const auto at = box_at(b);
        return width(0, at[0]) * width(1, at[1]) * width(2, at[2]);
    }
};

inline Block block_of(lap_context *context, const lap_grid *grid)
{
    Block block{};
    must(context, lap_grid_block(grid, &block.boxes, &block.first, &block.total, &block.nodes[0], &block.nodes[1],
                                 &block.nodes[2]));
    must(context, lap_grid_flags(grid, nullptr, &block.flags));
    return block;
}

// The volume of all full boxes: row by row, since in a row only the width changes.
inline double full_volume(const Block &block)
{
    Sum sum;
    std::int64_t b = 0;
    for (std::int64_t k = 0; k < block.boxes[2]; ++k)
        for (std::int64_t j = 0; j < block.boxes[1]; ++j) {
            Sum row;
            for (std::int64_t i = 0; i < block.boxes[0]; ++i, ++b)
                if (block.flags[b] == LAP_BOX_FULL) add(row, block.width(0, i));
            add(sum, value(row) * block.width(1, j) * block.width(2, k));
        }
    return value(sum);
}

struct GridReport {
    std::string mesh;
    bool outside = false;
    long threads = 1, repeat = 1;
    std::int64_t input_vertices = 0, input_triangles = 0, input_components = 0;
    std::array<std::int64_t, 3> boxes{}, first{}, total{};
    std::int64_t empty = 0, full = 0, cut = 0, multi_part = 0;
    std::int64_t vertices = 0, faces = 0, walls = 0, cells = 0, regions = 0;
    double cut_volume = 0, full_volume = 0, fluid_volume = 0, smallest_fraction = 0;
    // Known if the block covers the mesh: the volume that must come out.
    bool covered = false;
    double expected_volume = 0;
    std::vector<double> cell_volumes;
    Times times;
    Counters counters;
    std::int64_t peak_bytes = 0;

    double relative_error() const { return std::abs(fluid_volume - expected_volume) / expected_volume; }
};

// `box`: that of the mesh.
inline void fill_grid_report(GridReport &r, lap_context *context, const lap_mesh *mesh, const lap_grid *grid,
                             const Box &box)
{
    must(context, lap_mesh_counts(mesh, &r.input_vertices, &r.input_triangles, nullptr, &r.input_components, nullptr));
    must(context, lap_grid_counts(grid, &r.empty, &r.full, &r.cut, &r.cells, &r.faces, &r.walls, &r.vertices));
    const Block block = block_of(context, grid);
    double block_volume = 1;
    r.covered = true;
    for (int axis = 0; axis < 3; ++axis) {
        r.boxes[axis] = block.boxes[axis];
        r.first[axis] = block.first[axis];
        r.total[axis] = block.total[axis];
        const double low = block.nodes[axis][0], high = block.nodes[axis][block.boxes[axis]];
        r.covered = r.covered && low <= box.min[axis] && box.max[axis] <= high;
        block_volume *= high - low;
    }
    std::int64_t cut = 0;
    const std::int32_t *box_cells = nullptr;
    must(context, lap_grid_cut_boxes(grid, &cut, nullptr, &box_cells));
    for (std::int64_t i = 0; i < cut; ++i) r.multi_part += box_cells[i + 1] - box_cells[i] > 1;

    const double *volumes = nullptr, *fractions = nullptr;
    must(context, lap_grid_cell_moments(grid, nullptr, &volumes, &fractions, nullptr, nullptr));
    Sum sum;
    r.smallest_fraction = r.cells > 0 ? fractions[0] : 0;
    for (std::int64_t c = 0; c < r.cells; ++c) {
        add(sum, volumes[c]);
        r.smallest_fraction = std::min(r.smallest_fraction, fractions[c]);
    }
    r.cell_volumes.assign(volumes, volumes + r.cells);
    r.cut_volume = value(sum);
    r.full_volume = full_volume(block);
    add(sum, r.full_volume);
    r.fluid_volume = value(sum);
    must(context, lap_mesh_volume(mesh, &r.expected_volume));
    if (r.outside) r.expected_volume = block_volume - r.expected_volume;
    must(context, lap_grid_regions(grid, &r.regions, nullptr, nullptr));
}

inline void print_grid_table(const GridReport &r)
{
    auto three = [](const char *name, const std::array<std::int64_t, 3> &n) {
        std::printf("  %-24s %6lld %6lld %6lld\n", name, static_cast<long long>(n[0]), static_cast<long long>(n[1]),
                    static_cast<long long>(n[2]));
    };
    std::printf("%s, fluid %s\n", r.mesh.c_str(), r.outside ? "outside" : "inside");
    print_count("vertices", r.input_vertices);
    print_count("triangles", r.input_triangles);
    print_count("components", r.input_components);
    std::printf("boxes\n");
    three("of the grid", r.total);
    three("of the block", r.boxes);
    three("its first", r.first);
    print_count("empty", r.empty);
    print_count("full", r.full);
    print_count("cut", r.cut);
    print_count("  in several parts", r.multi_part);
    std::printf("cut cells and what bounds them\n");
    print_count("vertices", r.vertices);
    print_count("faces", r.faces);
    print_count("  walls", r.walls);
    print_count("cells", r.cells);
    print_number("smallest fraction", r.smallest_fraction);
    print_count("fluid regions", r.regions);
    std::printf("volume\n");
    print_number("of full boxes", r.full_volume);
    print_number("of cut cells", r.cut_volume);
    std::printf("  %-24s %23.16g\n", "fluid", r.fluid_volume);
    if (r.covered) {
        std::printf("  %-24s %23.16g\n", "exact", r.expected_volume);
        print_number("relative difference", r.relative_error());
    }
    print_times(r.times, r.repeat, r.threads);
    if (!r.counters.empty()) print_decisions(r.counters);
    std::printf("peak memory %27.1f MB\n", static_cast<double>(r.peak_bytes) / 1e6);
    std::fflush(stdout);
}

// `hexahedra`, `hexahedra_points`: how many of them the .vtu has besides the polyhedra; `with_volumes`: list the cells' volumes.
inline void write_grid_json(const std::string &path, const GridReport &r, bool with_volumes, const Hexahedra &hexahedra)
{
    using nlohmann::ordered_json;
    ordered_json json;
    json["mesh"] = r.mesh;
    json["fluid"] = r.outside ? "outside" : "inside";
    json["input"] = {
        {"vertices", r.input_vertices}, {"triangles", r.input_triangles}, {"components", r.input_components}};
    json["grid"] = {{"boxes", r.total}, {"block", r.boxes}, {"first", r.first}};
    json["threads"] = r.threads;
    json["repeat"] = r.repeat;
    json["boxes"] = {{"empty", r.empty}, {"full", r.full}, {"cut", r.cut}, {"multi_part", r.multi_part}};
    json["output"] = {{"vertices", r.vertices},
                      {"faces", r.faces},
                      {"walls", r.walls},
                      {"cells", r.cells},
                      {"regions", r.regions},
                      {"hexahedra", hexahedra.count()},
                      {"hexahedra_points", hexahedra.points.size() / 3}};
    json["smallest_fraction"] = r.smallest_fraction;
    json["volume"] = {{"cut", r.cut_volume}, {"full", r.full_volume}, {"fluid", r.fluid_volume}};
    if (r.covered) {
        json["volume"]["expected"] = r.expected_volume;
        json["volume"]["relative_error"] = r.relative_error();
    }
    if (with_volumes) json["cell_volumes"] = r.cell_volumes;
    json["seconds"] = times_json(r.times);
    json["predicates"] = counters_json(r.counters);
    json["peak_bytes"] = r.peak_bytes;
    write_file(path, json.dump(1) + '\n');
}

// The full boxes as hexahedra, with points of their own; `boxes` receives their numbers.
inline Hexahedra full_hexahedra(const Block &block, std::vector<std::int64_t> &boxes)
{
    Hexahedra all;
    const std::int64_t nx = block.boxes[0] + 1, ny = block.boxes[1] + 1, nz = block.boxes[2] + 1;
    std::vector<std::int64_t> number(static_cast<std::size_t>(nx * ny * nz), -1);
    for (std::int64_t b = 0; b < block.box_count(); ++b) {
        if (block.flags[b] != LAP_BOX_FULL) continue;
        boxes.push_back(b);
        const auto [i, j, k] = block.box_at(b);
        constexpr int around[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                      {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
        for (const auto &d : around) {
            std::int64_t &n = number[static_cast<std::size_t>(i + d[0] + nx * (j + d[1] + ny * (k + d[2])))];
            if (n < 0) {
                n = static_cast<std::int64_t>(all.points.size() / 3);
                all.points.insert(all.points.end(),
                                  {block.nodes[0][i + d[0]], block.nodes[1][j + d[1]], block.nodes[2][k + d[2]]});
            }
            all.corners.push_back(n);
        }
    }
    return all;
}

// The cut cells as polyhedra with their arrays, and the given full boxes as hexahedra.
inline void write_grid_vtu(const std::string &path, lap_context *context, const lap_grid *grid,
                           const Hexahedra &hexahedra, const std::vector<std::int64_t> &full_boxes)
{
    const lap_complex *complex = nullptr;
    must(context, lap_grid_complex(grid, &complex));
    std::int64_t faces = 0, cell_count = 0, region_count = 0;
    must(context, lap_complex_counts(complex, nullptr, nullptr, &faces, nullptr, nullptr, nullptr, nullptr));
    const Polygons polygons = polygons_of(context, complex, LAP_FACES_BRIDGED, faces);
    Cells cells{};
    const std::int32_t *boxes = nullptr, *regions = nullptr;
    const double *volumes = nullptr, *fractions = nullptr, *centroids = nullptr, *wall_areas = nullptr,
                 *wall_centroids = nullptr;
    must(context, lap_complex_vertices(complex, &cells.vertex_count, &cells.coordinates));
    must(context, lap_grid_cells(grid, &cells.cell_count, &boxes, &cells.cell_shells, &cells.shell_faces,
                                 &cells.half_faces));
    must(context, lap_grid_cell_moments(grid, &cell_count, &volumes, &fractions, &centroids, nullptr));
    must(context, lap_grid_cell_boundaries(grid, nullptr, &wall_areas, &wall_centroids));
    must(context, lap_grid_regions(grid, &region_count, nullptr, &regions));

    const Block block = block_of(context, grid);
    const std::size_t total = static_cast<std::size_t>(cell_count) + full_boxes.size();
    // Arrays over cut cells, then filled up for full boxes.
    auto extended = [&](const double *values, std::size_t components) {
        std::vector<double> all(values, values + static_cast<std::size_t>(cell_count) * components);
        all.reserve(total * components);
        return all;
    };
    std::vector<double> volume = extended(volumes, 1), fraction = extended(fractions, 1),
                        centroid = extended(centroids, 3), wall_area = extended(wall_areas, 3),
                        wall_centroid = extended(wall_centroids, 3);
    std::vector<std::int32_t> region(regions, regions + cell_count), part;
    std::vector<std::int64_t> ijk, cell;
    auto add_box = [&](std::int64_t b) {
        const auto at = block.box_at(b);
        for (int axis = 0; axis < 3; ++axis) ijk.push_back(block.first[axis] + at[axis]);
    };
    for (std::int64_t c = 0; c < cell_count; ++c) {
        add_box(boxes[c]);
        part.push_back(c > 0 && boxes[c] == boxes[c - 1] ? part.back() + 1 : 0);
        cell.push_back(c);
    }
    for (std::int64_t b : full_boxes) {
        const auto at = block.box_at(b);
        std::int32_t of_box = -1;
        must(context, lap_grid_box_region(grid, static_cast<std::int32_t>(at[0]), static_cast<std::int32_t>(at[1]),
                                          static_cast<std::int32_t>(at[2]), &of_box));
        region.push_back(of_box);
        part.push_back(0);
        cell.push_back(LAP_CELL_FULL);
        add_box(b);
        volume.push_back(block.box_volume(b));
        fraction.push_back(1);
        for (int axis = 0; axis < 3; ++axis) {
            centroid.push_back(block.nodes[axis][at[axis]] / 2 + block.nodes[axis][at[axis] + 1] / 2);
            wall_area.push_back(0);
            wall_centroid.push_back(centroid.back());
        }
    }
    write_vtu(path, cells, polygons, hexahedra, [&](VtkFile &file) {
        add_array(file, "volume_fraction", fraction);
        add_array(file, "volume", volume);
        add_array(file, "centroid", centroid, 3);
        add_array(file, "wall_area", wall_area, 3);
        add_array(file, "wall_centroid", wall_centroid, 3);
        add_array(file, "region", region);
        add_array(file, "box", ijk, 3);
        add_array(file, "part", part);
        add_array(file, "cell", cell);
    });
}

// One file over the pieces NAME_0.vtu, NAME_1.vtu, ... that write_grid_vtu wrote. Without regions, which each block counts for
// itself.
inline void write_pvtu(const std::string &name, int pieces)
{
    const std::string folder_free = name.substr(name.rfind('/') + 1);
    std::ostringstream xml;
    xml << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\">\n<PUnstructuredGrid "
           "GhostLevel=\"0\">\n<PPoints>\n<PDataArray type=\"Float64\" Name=\"Points\" "
           "NumberOfComponents=\"3\"/>\n</PPoints>\n<PCellData>\n";
    constexpr struct {
        const char *type, *name;
        int components;
    } arrays[] = {{"Float64", "volume_fraction", 1}, {"Float64", "volume", 1},        {"Float64", "centroid", 3},
                  {"Float64", "wall_area", 3},       {"Float64", "wall_centroid", 3}, {"Int64", "box", 3},
                  {"Int32", "part", 1},              {"Int64", "cell", 1}};
    for (const auto &array : arrays)
        xml << "<PDataArray type=\"" << array.type << "\" Name=\"" << array.name << "\" NumberOfComponents=\""
            << array.components << "\"/>\n";
    xml << "</PCellData>\n";
    for (int i = 0; i < pieces; ++i) xml << "<Piece Source=\"" << folder_free << '_' << i << ".vtu\"/>\n";
    xml << "</PUnstructuredGrid>\n</VTKFile>\n";
    write_file(name + ".pvtu", xml.str());
}

} // namespace examples

#endif
