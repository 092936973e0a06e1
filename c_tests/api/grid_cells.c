/* lap_grid_*: boxes, cells, faces and vertices hang together. */
#include "grid.h"

#include <math.h>

#include <stdlib.h>

int is_csr(const int32_t *offsets, int64_t rows, int64_t items)
{
    int64_t i;
    if (offsets == NULL || offsets[0] != 0 || offsets[rows] != items) return 0;
    for (i = 0; i < rows; ++i) {
        if (offsets[i] > offsets[i + 1]) return 0;
    }
    return 1;
}

int in_range(const int32_t *ids, int64_t count, int64_t low, int64_t high)
{
    int64_t i;
    for (i = 0; i < count; ++i) {
        if (ids[i] < low || ids[i] >= high) return 0;
    }
    return 1;
}

/* Boxes: flags, counts and the three ways to the cells of a box agree. */
void boxes_and_cells(const lap_grid *grid, int64_t nx, int64_t ny, int64_t nz)
{
    const uint8_t *flags = NULL;
    const int32_t *boxes = NULL, *box_cells = NULL, *offsets = NULL, *cell_boxes = NULL;
    int64_t n[7], count = -1, cut = -1, tally[3] = {0, 0, 0}, b, at = 0, c;
    int32_t flag = -1, first = -1, parts = -1;

    STATUS(LAP_OK, lap_grid_counts(grid, &n[0], &n[1], &n[2], &n[3], &n[4], &n[5], &n[6]));
    STATUS(LAP_OK, lap_grid_flags(grid, &count, &flags));
    CHECK(count == nx * ny * nz);
    STATUS(LAP_OK, lap_grid_cut_boxes(grid, &cut, &boxes, &box_cells));
    CHECK(cut == n[2] && is_csr(box_cells, cut, n[3]));
    STATUS(LAP_OK, lap_grid_box_cells(grid, &count, &offsets));
    CHECK(count == nx * ny * nz && is_csr(offsets, count, n[3]));
    STATUS(LAP_OK, lap_grid_cells(grid, &count, &cell_boxes, NULL, NULL, NULL));
    CHECK(count == n[3]);
    for (b = 0; b < nx * ny * nz; ++b) {
        CHECK(flags[b] <= LAP_BOX_CUT);
        ++tally[flags[b]];
        STATUS(LAP_OK, lap_grid_box(grid, (int32_t)(b % nx), (int32_t)(b / nx % ny), (int32_t)(b / (nx * ny)), &flag,
                                    &first, &parts));
        CHECK(flag == flags[b] && parts == offsets[b + 1] - offsets[b]);
        if (flag != LAP_BOX_CUT) {
            CHECK(parts == 0 && first == 0);
            continue;
        }
        CHECK(boxes[at] == b && box_cells[at] == first && offsets[b] == first && parts > 0);
        for (c = first; c < first + parts; ++c) CHECK(cell_boxes[c] == b);
        ++at;
    }
    CHECK(at == cut && tally[0] == n[0] && tally[1] == n[1] && tally[2] == n[2]);
}

/* Faces, vertices and cells hang together. */
void grid_structure(const lap_grid *grid, int64_t n_triangles, const int32_t *triangle_tags)
{
    const double *xyz = NULL, *nodes[3];
    const int64_t *boxes = NULL, *triangles = NULL;
    const uint8_t *on_planes = NULL, *flags = NULL;
    const int32_t *face_loops = NULL, *loop_corners = NULL, *corners = NULL, *tags = NULL, *wall_cells = NULL;
    const int32_t *axes = NULL, *square = NULL, *sides = NULL, *cell_shells = NULL, *shell_faces = NULL, *half_faces = NULL;
    int64_t n_cells, n_faces, n_walls, n_vertices, count = -1, first = -1, i, c, f, k, axis, half_count;
    int32_t *owner;

    STATUS(LAP_OK, lap_grid_counts(grid, NULL, NULL, NULL, &n_cells, &n_faces, &n_walls, &n_vertices));
    STATUS(LAP_OK, lap_grid_block(grid, &boxes, NULL, NULL, &nodes[0], &nodes[1], &nodes[2]));
    STATUS(LAP_OK, lap_grid_flags(grid, NULL, &flags));
    STATUS(LAP_OK, lap_grid_vertices(grid, &count, &xyz, &on_planes));
    CHECK(count == n_vertices);
    for (i = 0; i < 3 * count; ++i) {
        int on = 0;
        CHECK(!(xyz[i] == 0 && signbit(xyz[i])));
        for (k = 0; k <= boxes[i % 3]; ++k) on |= nodes[i % 3][k] == xyz[i];
        if (on_planes[i / 3] >> i % 3 & 1) CHECK(on);
    }

    STATUS(LAP_OK, lap_grid_faces(grid, &count, &face_loops, &loop_corners, &corners));
    CHECK(count == n_faces && is_csr(face_loops, count, face_loops[count]));
    CHECK(is_csr(loop_corners, face_loops[count], loop_corners[face_loops[count]]));
    CHECK(in_range(corners, loop_corners[face_loops[count]], 0, n_vertices));
    STATUS(LAP_OK, lap_grid_walls(grid, &count, &triangles, &tags, &wall_cells));
    CHECK(count == n_walls && in_range(wall_cells, count, 0, n_cells));
    CHECK(count == 0 || (tags != NULL) == (triangle_tags != NULL));
    for (i = 0; i < count; ++i) {
        CHECK(triangles[i] >= 0 && triangles[i] < n_triangles);
        if (tags != NULL) CHECK(tags[i] == triangle_tags[triangles[i]]);
    }
    STATUS(LAP_OK, lap_grid_plane_faces(grid, &first, &count, &axes, &square, &sides));
    CHECK(first == n_walls && first + count == n_faces && axes[0] == first && axes[3] == n_faces);
    CHECK(in_range(sides, 2 * count, LAP_CELL_FULL, n_cells));

    /* Each cell uses the half-faces that name it, once; no other half-face is used. */
    STATUS(LAP_OK, lap_grid_cells(grid, &count, NULL, &cell_shells, &shell_faces, &half_faces));
    half_count = shell_faces[cell_shells[count]];
    CHECK(count == n_cells && is_csr(cell_shells, count, cell_shells[count]));
    CHECK(is_csr(shell_faces, cell_shells[count], half_count) && in_range(half_faces, half_count, 0, 2 * n_faces));
    owner = (int32_t *)malloc(2 * (size_t)n_faces * sizeof *owner + 1);
    for (i = 0; i < 2 * n_faces; ++i) owner[i] = LAP_CELL_NONE;
    for (c = 0; c < count; ++c) {
        CHECK(cell_shells[c] < cell_shells[c + 1]);
        for (i = shell_faces[cell_shells[c]]; i < shell_faces[cell_shells[c + 1]]; ++i) {
            CHECK(owner[half_faces[i]] == LAP_CELL_NONE);
            owner[half_faces[i]] = (int32_t)c;
        }
    }
    for (f = 0; f < n_walls; ++f) CHECK(owner[2 * f] == wall_cells[f] && owner[2 * f + 1] == LAP_CELL_NONE);
    for (axis = 0; axis < 3; ++axis) {
        for (f = axes[axis]; f < axes[axis + 1]; ++f) {
            /* The square's corner lies on the face's plane, and so do all its corners. */
            const int64_t node = square[f - first], nx = boxes[0] + 1, ny = boxes[1] + 1;
            const int64_t at[3] = {node % nx, node / nx % ny, node / (nx * ny)};
            CHECK(at[0] <= boxes[0] && at[1] <= boxes[1] && at[2] <= boxes[2]);
            for (i = loop_corners[face_loops[f]]; i < loop_corners[face_loops[f + 1]]; ++i) {
                CHECK(xyz[3 * corners[i] + axis] == nodes[axis][at[axis]] && (on_planes[corners[i]] >> axis & 1));
            }
            for (i = 0; i < 2; ++i) {
                const int32_t side = sides[2 * (f - first) + i];
                int64_t low[3] = {at[0], at[1], at[2]};
                CHECK(owner[2 * f + i] == (side < 0 ? LAP_CELL_NONE : side));
                if (side != LAP_CELL_FULL) continue;
                low[axis] -= i == 0;
                CHECK(low[axis] >= 0 && flags[low[0] + boxes[0] * (low[1] + boxes[1] * low[2])] == LAP_BOX_FULL);
            }
            CHECK(sides[2 * (f - first)] >= 0 || sides[2 * (f - first) + 1] >= 0);
        }
    }
    free(owner);
}
