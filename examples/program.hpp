// What the example programs share besides reading and reporting: exit codes, arguments, handles that free themselves, a
// mesh that may face inward, the arrays of a complex.
#ifndef LAPIDARY_EXAMPLES_PROGRAM_HPP
#define LAPIDARY_EXAMPLES_PROGRAM_HPP

#include "arguments.hpp"
#include "reader.hpp"
#include "report.hpp"
#include "vtk.hpp"

#include <lapidary.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <sys/resource.h>

namespace examples {

// Exit codes. The library refused: 1. Wrong usage: 2. A file cannot be read or written: 3.
constexpr int exit_refused = 1, exit_usage = 2, exit_file = 3;

// Handles that free themselves.
struct Free {
    void operator()(lap_context *p) const { lap_context_free(p); }
    void operator()(lap_mesh *p) const { lap_mesh_free(p); }
    void operator()(lap_cut *p) const { lap_cut_free(p); }
    void operator()(lap_grid *p) const { lap_grid_free(p); }
    void operator()(lap_network *p) const { lap_network_free(p); }
    void operator()(lap_simplex *p) const { lap_simplex_free(p); }
    void operator()(lap_arrangement *p) const { lap_arrangement_free(p); }
    void operator()(lap_surface *p) const { lap_surface_free(p); }
};
template <typename T>
using Handle = std::unique_ptr<T, Free>;

inline double seconds_since(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

inline std::int64_t peak_bytes()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::int64_t>(usage.ru_maxrss) * 1024; // Linux counts in KiB
}

inline void reverse(Mesh &mesh)
{
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) std::swap(mesh.triangles[i + 1], mesh.triangles[i + 2]);
}

// Some files face inward as a whole. If that is all that is wrong with a mesh, it is reversed; anything else is left for
// the library to refuse.
inline bool reverse_if_inward(lap_context *context, Mesh &mesh)
{
    auto status = [&] {
        lap_mesh *made = nullptr;
        const std::int32_t result =
            lap_mesh_new(context, mesh.vertex_count(), mesh.coordinates.data(), mesh.triangle_count(),
                         mesh.triangles.data(), nullptr, nullptr, &made);
        lap_mesh_free(made);
        return result;
    };
    std::int64_t count = 0;
    const std::int32_t *kinds = nullptr;
    if (status() != LAP_ERR_BAD_MESH) return false;
    must(context, lap_context_last_defects(context, &count, &kinds, nullptr));
    if (!std::all_of(kinds, kinds + count, [](std::int32_t kind) { return kind == LAP_DEFECT_WRONG_NESTING; })) return false;
    reverse(mesh);
    if (status() == LAP_OK) return true;
    reverse(mesh);
    return false;
}

inline Polygons polygons_of(lap_context *context, const lap_complex *complex, std::int32_t style, std::int64_t face_count)
{
    Polygons polygons{};
    const std::int32_t *faces = nullptr;
    must(context, lap_complex_polygons(complex, style, &polygons.count, &polygons.offsets, &polygons.vertices, &faces));
    // The polygons of a face lie together: count, then sum up.
    polygons.face_polygons.assign(static_cast<std::size_t>(face_count) + 1, 0);
    for (std::int64_t p = 0; p < polygons.count; ++p) ++polygons.face_polygons[static_cast<std::size_t>(faces[p]) + 1];
    for (std::int64_t f = 0; f < face_count; ++f) polygons.face_polygons[f + 1] += polygons.face_polygons[f];
    return polygons;
}

inline Cells cells_of(lap_context *context, const lap_complex *complex)
{
    Cells cells{};
    must(context, lap_complex_vertices(complex, &cells.vertex_count, &cells.coordinates));
    must(context, lap_complex_edges(complex, &cells.edge_count, nullptr));
    must(context,
         lap_complex_cells(complex, &cells.cell_count, &cells.cell_shells, &cells.shell_faces, &cells.half_faces));
    must(context, lap_complex_cell_components(complex, nullptr, &cells.components));
    must(context, lap_complex_cell_moments(complex, nullptr, &cells.volumes, &cells.centroids, nullptr));
    return cells;
}

// Runs a program and turns what it throws into exit codes.
template <typename Run>
int run_program(const char *name, const char *usage, Run run)
{
    try {
        return run();
    } catch (const UsageError &error) {
        std::cerr << name << ": " << error.what() << "\n\n" << usage;
        return exit_usage;
    } catch (const Refusal &error) {
        std::cerr << name << ": " << error.what() << '\n';
        return exit_refused;
    } catch (const std::exception &error) {
        std::cerr << name << ": " << error.what() << '\n';
        return exit_file;
    }
}

} // namespace examples

#endif
