// Writes the cells of a complex for VTK and ParaView: as polyhedra (.vtu), and moved apart for a picture (.vtp).
//
// Both are XML files with raw appended data: a header that names the arrays, then the arrays as they lie in memory,
// each after its length in bytes as a 64-bit integer.
#ifndef LAPIDARY_EXAMPLES_VTK_HPP
#define LAPIDARY_EXAMPLES_VTK_HPP

#include <lapidary.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace examples {

// VTK's names for the types that occur here.
inline const char *vtk_type(const double *)
{
    return "Float64";
}
inline const char *vtk_type(const std::int64_t *)
{
    return "Int64";
}
inline const char *vtk_type(const std::int32_t *)
{
    return "Int32";
}
inline const char *vtk_type(const std::uint8_t *)
{
    return "UInt8";
}

// A file in the making: the XML so far and the appended bytes so far.
struct VtkFile {
    std::ostringstream xml;
    std::vector<char> data;
};

inline void begin_file(VtkFile &file, const char *type)
{
    // The arrays are written as they lie in memory, so the file has to say how that is.
    const std::uint16_t probe = 1;
    std::uint8_t low;
    std::memcpy(&low, &probe, 1);
    file.xml << "<?xml version=\"1.0\"?>\n<VTKFile type=\"" << type << "\" version=\"1.0\" byte_order=\""
             << (low == 1 ? "LittleEndian" : "BigEndian") << "\" header_type=\"UInt64\">\n<" << type << ">\n";
}

template <typename T>
void add_array(VtkFile &file, const char *name, const T *values, std::size_t count, int components = 1)
{
    file.xml << "<DataArray type=\"" << vtk_type(values) << "\" Name=\"" << name << "\" NumberOfComponents=\""
             << components << "\" format=\"appended\" offset=\"" << file.data.size() << "\"/>\n";
    const std::uint64_t bytes = count * sizeof(T);
    const std::size_t at = file.data.size();
    file.data.resize(at + sizeof bytes + bytes);
    std::memcpy(file.data.data() + at, &bytes, sizeof bytes);
    if (bytes > 0) std::memcpy(file.data.data() + at + sizeof bytes, values, bytes);
}

template <typename T>
void add_array(VtkFile &file, const char *name, const std::vector<T> &values, int components = 1)
{
    add_array(file, name, values.data(), values.size(), components);
}

inline void end_file(const VtkFile &file, const char *type, const std::string &path)
{
    std::ofstream out(path, std::ios::binary);
    out << file.xml.str() << "</" << type << ">\n<AppendedData encoding=\"raw\">\n_";
    out.write(file.data.data(), static_cast<std::streamsize>(file.data.size()));
    out << "\n</AppendedData>\n</VTKFile>\n";
    out.close();
    if (!out) throw std::runtime_error(path + ": cannot be written");
}

// Polygons of the faces of a complex in one of its styles: face f has the polygons [face_polygons[f],
// face_polygons[f + 1]), polygon p the vertices vertices[offsets[p] .. offsets[p + 1]), anticlockwise when seen from
// the tip of the face's normal.
struct Polygons {
    std::int64_t count;
    const std::int32_t *offsets;
    const std::int32_t *vertices;
    std::vector<std::int32_t> face_polygons;
};

// What the writers need of a complex: borrowed arrays, as the C API gives them.
struct Cells {
    std::int64_t vertex_count, edge_count, cell_count;
    const double *coordinates;       // x y z per vertex
    const std::int32_t *cell_shells; // cell c has the shells [cell_shells[c], cell_shells[c + 1])
    const std::int32_t *shell_faces; // shell s has the half-faces half_faces[shell_faces[s] .. shell_faces[s + 1]]
    const std::int32_t *half_faces;  // 2 f where the normal of face f leaves the cell, 2 f + 1 where it enters
    const std::int32_t *components;  // per cell
    const double *volumes;           // per cell
    const double *centroids;         // x y z per cell
};

// Half-faces of all shells of a cell lie together, from here to the next cell's.
inline std::int32_t first_half_face(const Cells &cells, std::int64_t c)
{
    return cells.shell_faces[cells.cell_shells[c]];
}

// Which vertices a cell has used so far, and their numbers within the cell: cleared by moving on to the next cell.
struct Numbering {
    std::vector<std::int64_t> cell, number;
    explicit Numbering(std::int64_t vertex_count) : cell(vertex_count, -1), number(vertex_count, 0) {}
};

// Whether this is the cell's first use of the vertex; if so, it is given the number `next`.
inline bool first_use(Numbering &numbering, std::int64_t cell, std::int32_t vertex, std::int64_t next)
{
    if (numbering.cell[vertex] == cell) return false;
    numbering.cell[vertex] = cell;
    numbering.number[vertex] = next;
    return true;
}

// The vertices of polygon p, wound so that its normal leaves the cell.
template <typename Visit>
void walk_outward(const Polygons &polygons, std::int32_t p, bool reversed, Visit visit)
{
    const std::int32_t begin = polygons.offsets[p], end = polygons.offsets[p + 1];
    for (std::int32_t i = begin; i < end; ++i) visit(polygons.vertices[reversed ? end - 1 - (i - begin) : i]);
}

// Axis-parallel boxes beside the polyhedra: points of their own, and eight of them per box in VTK's order.
struct Hexahedra {
    std::vector<double> points;
    std::vector<std::int64_t> corners;

    std::int64_t count() const { return static_cast<std::int64_t>(corners.size() / 8); }
};

// Writes the cells as VTK polyhedra, then the hexahedra, with the cell data that `add_arrays` adds to the file (one entry
// for each polyhedron, then for each hexahedron). The walls of voids are listed with the other faces of a cell: a VTK
// polyhedron knows no shells. Faces come in the style that the caller chose; VTK has no faces with holes, so that is
// bridged (one polygon a face, the bridge walked twice) or triangles.
template <typename AddArrays>
void write_vtu(const std::string &path, const Cells &cells, const Polygons &polygons, const Hexahedra &hexahedra,
               AddArrays add_arrays)
{
    std::vector<std::int64_t> connectivity, offsets, faces, face_offsets;
    Numbering numbering(cells.vertex_count);
    for (std::int64_t c = 0; c < cells.cell_count; ++c) {
        const std::size_t count_at = faces.size();
        std::int64_t count = 0;
        faces.push_back(0);
        for (std::int32_t i = first_half_face(cells, c); i < first_half_face(cells, c + 1); ++i) {
            const std::int32_t f = cells.half_faces[i] >> 1;
            const bool reversed = cells.half_faces[i] & 1;
            for (std::int32_t p = polygons.face_polygons[f]; p < polygons.face_polygons[f + 1]; ++p) {
                ++count;
                faces.push_back(polygons.offsets[p + 1] - polygons.offsets[p]);
                walk_outward(polygons, p, reversed, [&](std::int32_t v) {
                    faces.push_back(v);
                    if (first_use(numbering, c, v, 0)) connectivity.push_back(v);
                });
            }
        }
        faces[count_at] = count;
        face_offsets.push_back(static_cast<std::int64_t>(faces.size()));
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    }
    const std::uint8_t polyhedron = 42, hexahedron = 12; // VTK_POLYHEDRON, VTK_HEXAHEDRON
    std::vector<std::uint8_t> types(static_cast<std::size_t>(cells.cell_count), polyhedron);
    for (std::int64_t h = 0; h < hexahedra.count(); ++h) {
        for (std::int64_t k = 8 * h; k < 8 * (h + 1); ++k) connectivity.push_back(cells.vertex_count + hexahedra.corners[k]);
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
        face_offsets.push_back(-1);
        types.push_back(hexahedron);
    }
    std::vector<double> points(cells.coordinates, cells.coordinates + 3 * cells.vertex_count);
    points.insert(points.end(), hexahedra.points.begin(), hexahedra.points.end());

    VtkFile file;
    begin_file(file, "UnstructuredGrid");
    file.xml << "<Piece NumberOfPoints=\"" << points.size() / 3 << "\" NumberOfCells=\"" << types.size()
             << "\">\n<Points>\n";
    add_array(file, "Points", points, 3);
    file.xml << "</Points>\n<Cells>\n";
    add_array(file, "connectivity", connectivity);
    add_array(file, "offsets", offsets);
    add_array(file, "types", types);
    add_array(file, "faces", faces);
    add_array(file, "faceoffsets", face_offsets);
    file.xml << "</Cells>\n<CellData>\n";
    add_arrays(file);
    file.xml << "</CellData>\n</Piece>\n";
    end_file(file, "UnstructuredGrid", path);
}

// Marks of faces and their edges, for the lines of the exploded view.
struct Outline {
    const std::int32_t *face_loops;   // face f has the loops [face_loops[f], face_loops[f + 1])
    const std::int32_t *loop_corners; // loop l has the corners [loop_corners[l], loop_corners[l + 1])
    const std::int32_t *corner_edges; // -1: the only corner of an isolated vertex
    const std::int32_t *edges;        // two vertices per edge
    const std::int32_t *support_kind; // of each face: LAP_SUPPORT_TRIANGLE or LAP_SUPPORT_PLANE
};

// Writes every cell's faces moved away from `centre` by `factor` times the distance of the cell's centroid from it, and
// the lines where a plane meets the input's surface, once per cell. Cell data: the cell, and whether a polygon is on
// the input's surface (lines come first in VTK's cell data).
inline void write_exploded(const std::string &path, const Cells &cells, const Polygons &polygons,
                           const Outline &outline, const std::array<double, 3> &centre, double factor)
{
    std::vector<double> points;
    std::vector<std::int64_t> lines, line_offsets, corners, corner_offsets;
    std::vector<std::int32_t> line_cell, polygon_cell, line_on_mesh, polygon_on_mesh;
    Numbering numbering(cells.vertex_count);
    std::vector<std::int64_t> seen_on_mesh(cells.edge_count, -1), seen_on_plane(cells.edge_count, -1);
    for (std::int64_t c = 0; c < cells.cell_count; ++c) {
        double shift[3];
        for (int k = 0; k < 3; ++k) shift[k] = factor * (cells.centroids[3 * c + k] - centre[k]);
        auto local = [&](std::int32_t v) {
            if (first_use(numbering, c, v, static_cast<std::int64_t>(points.size() / 3)))
                for (int k = 0; k < 3; ++k)
                    points.push_back(cells.coordinates[3 * static_cast<std::int64_t>(v) + k] + shift[k]);
            return numbering.number[v];
        };
        for (std::int32_t i = first_half_face(cells, c); i < first_half_face(cells, c + 1); ++i) {
            const std::int32_t f = cells.half_faces[i] >> 1;
            const bool on_mesh = outline.support_kind[f] == LAP_SUPPORT_TRIANGLE;
            for (std::int32_t p = polygons.face_polygons[f]; p < polygons.face_polygons[f + 1]; ++p) {
                walk_outward(polygons, p, cells.half_faces[i] & 1,
                             [&](std::int32_t v) { corners.push_back(local(v)); });
                corner_offsets.push_back(static_cast<std::int64_t>(corners.size()));
                polygon_cell.push_back(static_cast<std::int32_t>(c));
                polygon_on_mesh.push_back(on_mesh);
            }
            auto &mine = on_mesh ? seen_on_mesh : seen_on_plane;
            const auto &other = on_mesh ? seen_on_plane : seen_on_mesh;
            const std::int32_t begin = outline.loop_corners[outline.face_loops[f]];
            const std::int32_t end = outline.loop_corners[outline.face_loops[f + 1]];
            for (std::int32_t k = begin; k < end; ++k) {
                const std::int32_t e = outline.corner_edges[k];
                if (e < 0 || mine[e] == c) continue;
                mine[e] = c;
                if (other[e] != c) continue;
                lines.push_back(local(outline.edges[2 * static_cast<std::int64_t>(e)]));
                lines.push_back(local(outline.edges[2 * static_cast<std::int64_t>(e) + 1]));
                line_offsets.push_back(static_cast<std::int64_t>(lines.size()));
                line_cell.push_back(static_cast<std::int32_t>(c));
                line_on_mesh.push_back(1);
            }
        }
    }
    line_cell.insert(line_cell.end(), polygon_cell.begin(), polygon_cell.end());
    line_on_mesh.insert(line_on_mesh.end(), polygon_on_mesh.begin(), polygon_on_mesh.end());

    VtkFile file;
    begin_file(file, "PolyData");
    file.xml << "<Piece NumberOfPoints=\"" << points.size() / 3 << "\" NumberOfLines=\"" << line_offsets.size()
             << "\" NumberOfPolys=\"" << corner_offsets.size() << "\">\n<Points>\n";
    add_array(file, "Points", points, 3);
    file.xml << "</Points>\n<Lines>\n";
    add_array(file, "connectivity", lines);
    add_array(file, "offsets", line_offsets);
    file.xml << "</Lines>\n<Polys>\n";
    add_array(file, "connectivity", corners);
    add_array(file, "offsets", corner_offsets);
    file.xml << "</Polys>\n<CellData Scalars=\"cell\">\n";
    add_array(file, "cell", line_cell);
    add_array(file, "on_mesh", line_on_mesh);
    file.xml << "</CellData>\n</Piece>\n";
    end_file(file, "PolyData", path);
}

} // namespace examples

#endif
