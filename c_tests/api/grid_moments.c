/* lap_grid_*: the arrays of embedded-boundary solvers. */
#include "grid.h"

#include <math.h>
#include <stdlib.h>

/* The arrays of embedded-boundary solvers: for solids and grids of small integers over powers of two all sums are exact in
   double, up to the thirds of centroids. `volume`: what cut cells and full boxes must add up to. */
void grid_moments(const lap_grid *grid, double volume)
{
    const double *nodes[3], *volumes = NULL, *fractions = NULL, *centroids = NULL, *walls = NULL, *wall_centroids = NULL;
    const double *first = NULL, *second = NULL;
    const double *areas = NULL, *area_fractions = NULL, *area_centroids = NULL, *one_by_one = NULL, *middles = NULL;
    const double *by_tag = NULL, *tag_centroids = NULL;
    const int64_t *boxes = NULL;
    const uint8_t *box_flags = NULL, *flags = NULL, *face_flags = NULL;
    const int32_t *axes = NULL, *square = NULL, *sides = NULL, *cell_boxes = NULL, *wall_cells = NULL, *wall_tags = NULL;
    const int32_t *offsets = NULL, *tags = NULL, *wall_offsets = NULL, *cell_walls = NULL;
    int64_t n_cells, n_faces, n_walls, count = -1, b, c, f, i, k, axis;
    double *sums, total = 0;

    STATUS(LAP_OK, lap_grid_counts(grid, NULL, NULL, NULL, &n_cells, &n_faces, &n_walls, NULL));
    STATUS(LAP_OK, lap_grid_block(grid, &boxes, NULL, NULL, &nodes[0], &nodes[1], &nodes[2]));
    STATUS(LAP_OK, lap_grid_flags(grid, NULL, &box_flags));
    STATUS(LAP_OK, lap_grid_cells(grid, NULL, &cell_boxes, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_grid_plane_faces(grid, NULL, NULL, &axes, &square, &sides));
    STATUS(LAP_OK, lap_grid_walls(grid, NULL, NULL, &wall_tags, &wall_cells));
    STATUS(LAP_OK, lap_grid_cell_moments(grid, &count, &volumes, &fractions, &centroids, &flags));
    CHECK(count == n_cells);
    STATUS(LAP_OK, lap_grid_cell_second_moments(grid, &count, &first, &second));
    CHECK(count == n_cells);
    STATUS(LAP_OK, lap_grid_cell_boundaries(grid, &count, &walls, &wall_centroids));
    CHECK(count == n_cells);
    STATUS(LAP_OK, lap_grid_plane_face_moments(grid, &count, &areas, &area_fractions, &area_centroids, &face_flags));
    CHECK(count == n_faces - n_walls);
    STATUS(LAP_OK, lap_grid_wall_moments(grid, &count, &one_by_one, &middles));
    CHECK(count == n_walls);
    STATUS(LAP_OK, lap_grid_cell_walls(grid, &count, &wall_offsets, &cell_walls));
    CHECK(count == n_cells && is_csr(wall_offsets, count, n_walls) && in_range(cell_walls, n_walls, 0, n_walls));
    STATUS(LAP_OK, lap_grid_cell_tags(grid, &count, &offsets, &tags, &by_tag, &tag_centroids));
    CHECK(count == n_cells && is_csr(offsets, count, offsets[count]));

    sums = (double *)calloc(3 * (size_t)n_cells + 1, sizeof *sums);
    for (c = 0; c < n_cells; ++c) {
        const int64_t at[3] = {cell_boxes[c] % boxes[0], cell_boxes[c] / boxes[0] % boxes[1], cell_boxes[c] / (boxes[0] * boxes[1])};
        double box = 1, wall[3] = {0, 0, 0}, tagged[3] = {0, 0, 0};
        for (axis = 0; axis < 3; ++axis) {
            box *= nodes[axis][at[axis] + 1] - nodes[axis][at[axis]];
            CHECK(nodes[axis][at[axis]] < centroids[3 * c + axis] && centroids[3 * c + axis] < nodes[axis][at[axis] + 1]);
        }
        for (axis = 0; axis < 3; ++axis) {
            /* The library's own sums are tested exactly elsewhere; here: which numbers are where, in which units. */
            const double low = nodes[axis][at[axis]], high = nodes[axis][at[axis] + 1], size = high - low;
            const double arm = centroids[3 * c + axis] - (low + size / 2), scale = fabs(low) + fabs(high);
            CHECK(fabs(first[3 * c + axis] - volumes[c] * arm) <= 1e-15 * volumes[c] * scale);
            CHECK(second[6 * c + axis] > volumes[c] * arm * arm - 1e-15 * volumes[c] * scale * size);
            CHECK(second[6 * c + axis] <= volumes[c] * size * size / 4);
            CHECK(fabs(second[6 * c + 3 + axis]) <= volumes[c] * size * (nodes[(axis + 1) % 3][at[(axis + 1) % 3] + 1] - nodes[(axis + 1) % 3][at[(axis + 1) % 3]]) / 4);
        }
        CHECK(volumes[c] > 0 && fractions[c] > 0 && fractions[c] <= 1 && flags[c] == 0);
        CHECK(fabs(fractions[c] * box - volumes[c]) <= 4e-16 * box);
        total += volumes[c];
        for (i = wall_offsets[c]; i < wall_offsets[c + 1]; ++i) {
            CHECK(wall_cells[cell_walls[i]] == c && (i == wall_offsets[c] || cell_walls[i - 1] < cell_walls[i]));
            for (axis = 0; axis < 3; ++axis) wall[axis] += one_by_one[3 * cell_walls[i] + axis];
        }
        for (i = offsets[c]; i < offsets[c + 1]; ++i) {
            CHECK(i == offsets[c] || tags[i - 1] < tags[i]);
            for (axis = 0; axis < 3; ++axis) tagged[axis] += by_tag[3 * i + axis];
            for (k = wall_offsets[c]; k < wall_offsets[c + 1]; ++k) {
                if ((wall_tags == NULL ? 0 : wall_tags[cell_walls[k]]) == tags[i]) break;
            }
            CHECK(k < wall_offsets[c + 1]);
        }
        for (axis = 0; axis < 3; ++axis) {
            CHECK(wall[axis] == walls[3 * c + axis] && tagged[axis] == walls[3 * c + axis]);
            sums[3 * c + axis] = walls[3 * c + axis];
        }
    }
    for (axis = 0; axis < 3; ++axis) {
        for (f = axes[axis] - axes[0]; f < axes[axis + 1] - axes[0]; ++f) {
            CHECK(areas[f] > 0 && area_fractions[f] > 0 && area_fractions[f] <= 1 && face_flags[f] == 0);
            for (i = 0; i < 2; ++i) {
                if (sides[2 * f + i] >= 0) sums[3 * sides[2 * f + i] + axis] += i == 0 ? areas[f] : -areas[f];
            }
        }
    }
    /* Every cell is closed. */
    for (i = 0; i < 3 * n_cells; ++i) CHECK(sums[i] == 0);
    for (b = 0; b < boxes[0] * boxes[1] * boxes[2]; ++b) {
        const int64_t at[3] = {b % boxes[0], b / boxes[0] % boxes[1], b / (boxes[0] * boxes[1])};
        double box = 1;
        for (axis = 0; axis < 3; ++axis) box *= nodes[axis][at[axis] + 1] - nodes[axis][at[axis]];
        if (box_flags[b] == LAP_BOX_FULL) total += box;
    }
    CHECK(total == volume);
    free(sums);
}
