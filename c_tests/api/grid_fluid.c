/* lap_grid_*: regions, implied faces of full boxes, aggregates of small cells. */
#include "grid.h"

#include <math.h>
#include <string.h>

/* Small cells of the cube: what stands together suffices, or is said not to. */
void grid_aggregates(lap_context *context, const lap_grid *grid)
{
    const double minimum = 0.5;
    const double *fractions = NULL;
    const int32_t *cells = NULL, *boxes = NULL, *small = NULL, *cell_boxes = NULL;
    uint8_t closed_cells[8], closed_faces[12];
    double sums[8] = {0, 0, 0, 0, 0, 0, 0, 0};
    int64_t count = -1, n_small = -1, i, below = 0, alone = 0;

    STATUS(LAP_OK, lap_grid_cells(grid, NULL, &cell_boxes, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_grid_cell_moments(grid, NULL, NULL, &fractions, NULL, NULL));
    STATUS_IN(context, LAP_OK, lap_grid_aggregate(context, grid, minimum, NULL, NULL, &count, &cells, &boxes, &n_small, &small));
    CHECK(count == 8 && n_small == 0);
    for (i = 0; i < 8; ++i) {
        below += fractions[i] < minimum;
        CHECK(cells[i] >= 0 && cells[i] < 8 && cells[cells[i]] == cells[i] && boxes[i] == cell_boxes[cells[i]]);
        alone += cells[i] == i;
        sums[cells[i]] += fractions[i];
    }
    CHECK(below > 0 && alone < 8);
    for (i = 0; i < 8; ++i) CHECK(cells[i] != i || sums[i] >= minimum);

    /* Closed: all stand alone, and the small ones are listed. */
    memset(closed_cells, 1, sizeof closed_cells);
    memset(closed_faces, 1, sizeof closed_faces);
    STATUS_IN(context, LAP_OK,
              lap_grid_aggregate(context, grid, minimum, NULL, closed_cells, &count, &cells, &boxes, &n_small, &small));
    CHECK(n_small == below);
    for (i = 0; i < 8; ++i) CHECK(cells[i] == i);
    for (i = 0; i < n_small; ++i) CHECK(fractions[small[i]] < minimum && (i == 0 || small[i - 1] < small[i]));
    STATUS_IN(context, LAP_OK,
              lap_grid_aggregate(context, grid, minimum, closed_faces, NULL, &count, &cells, &boxes, &n_small, &small));
    CHECK(n_small == below);
    STATUS_IN(context, LAP_OK, lap_grid_aggregate(context, grid, 0, NULL, NULL, &count, &cells, &boxes, &n_small, &small));
    CHECK(n_small == 0);
    for (i = 0; i < 8; ++i) CHECK(cells[i] == i);
    STATUS_IN(context, LAP_OK, lap_grid_aggregate(context, grid, 0, NULL, NULL, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_aggregate(context, grid, -0.5, NULL, NULL, &count, &cells, &boxes, &n_small, &small));
    CHECK(has_message(context));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_aggregate(context, grid, NAN, NULL, NULL, &count, &cells, &boxes, &n_small, &small));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_aggregate(context, NULL, 0.5, NULL, NULL, &count, &cells, &boxes, &n_small, &small));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_aggregate(NULL, grid, 0.5, NULL, NULL, &count, &cells, &boxes, &n_small, &small));
}

/* What connects: two regions of fluid, one of them around a full box. */
void grid_fluid(lap_context *context)
{
    const double even[6] = {-0.5, 0.5, 1.5, 2.5, 3.5, 4.5};
    lap_mesh *mesh = good_mesh(context, 16, hollow_xyz, 24, hollow_indices, NULL);
    lap_grid_options o;
    lap_grid *grid = NULL;
    const int32_t *regions = NULL, *row_runs = NULL, *run_boxes = NULL, *run_regions = NULL, *cells = NULL, *faces = NULL;
    const int32_t *boxes = NULL, *nodes = NULL, *sides = NULL, *cell_boxes = NULL;
    const uint8_t *cell_mask = NULL, *box_mask = NULL;
    int64_t n_regions = -1, count = -1, n_boxes = -1, first = -1, i, in_void = 0;
    int32_t region = -7;

    STATUS(LAP_OK, lap_grid_options_init(&o, (int32_t)sizeof o));
    o.outside = 1;
    STATUS_IN(context, LAP_OK, lap_grid_new(context, mesh, 6, even, 6, even, 6, even, &o, &grid));
    STATUS(LAP_OK, lap_mesh_free(mesh));
    if (grid == NULL) return;
    STATUS(LAP_OK, lap_grid_cells(grid, NULL, &cell_boxes, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_grid_regions(grid, &n_regions, &count, &regions));
    CHECK(n_regions == 2 && count == 124);
    /* The void's boxes are those around the middle one, number 62 = 2 + 5 (2 + 5 * 2). */
    for (i = 0; i < count; ++i) {
        const int32_t b = cell_boxes[i], x = b % 5, y = b / 5 % 5, z = b / 25;
        const int inner = x > 0 && x < 4 && y > 0 && y < 4 && z > 0 && z < 4;
        CHECK(regions[i] == inner);
    }
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_regions(NULL, &n_regions, &count, &regions));
    STATUS(LAP_OK, lap_grid_regions(grid, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_grid_region_runs(grid, &count, &row_runs, &run_boxes, &run_regions));
    CHECK(count == 25 && is_csr(row_runs, count, 1) && run_boxes[0] == 62 && run_boxes[1] == 63 && run_regions[0] == 1);
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_region_runs(NULL, &count, &row_runs, &run_boxes, &run_regions));
    STATUS(LAP_OK, lap_grid_box_region(grid, 2, 2, 2, &region));
    CHECK(region == 1);
    STATUS(LAP_OK, lap_grid_box_region(grid, 0, 2, 2, &region));
    CHECK(region == -1);
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_box_region(grid, 5, 2, 2, &region));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_box_region(grid, 2, 2, 2, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_box_region(NULL, 2, 2, 2, &region));

    STATUS_IN(context, LAP_OK, lap_grid_region_at(context, grid, 2, 2, 2, &region));
    CHECK(region == 1);
    STATUS_IN(context, LAP_OK, lap_grid_region_at(context, grid, 1.25, 1.5, 2.9, &region));
    CHECK(region == 1);
    STATUS_IN(context, LAP_OK, lap_grid_region_at(context, grid, -0.25, 0.5, 4.5, &region));
    CHECK(region == 0);
    STATUS_IN(context, LAP_OK, lap_grid_region_at(context, grid, 0.5, 0.75, 2, &region));
    CHECK(region == LAP_REGION_SOLID);
    STATUS_IN(context, LAP_OK, lap_grid_region_at(context, grid, 1, 2, 2, &region));
    CHECK(region == LAP_REGION_SURFACE);
    STATUS_IN(context, LAP_OK, lap_grid_region_at(context, grid, 9, 2, 2, &region));
    CHECK(region == LAP_REGION_BEYOND);
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_region_at(context, grid, NAN, 2, 2, &region));
    CHECK(has_message(context));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_region_at(context, grid, 2, 2, 2, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_region_at(context, NULL, 2, 2, 2, &region));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_region_at(NULL, grid, 2, 2, 2, &region));

    STATUS_IN(context, LAP_OK, lap_grid_region_mask(context, grid, 1, &count, &cell_mask, &n_boxes, &box_mask));
    CHECK(count == 124 && n_boxes == 125);
    for (i = 0; i < count; ++i) {
        CHECK(cell_mask[i] == (regions[i] == 1));
        in_void += cell_mask[i];
    }
    CHECK(in_void == 26);
    for (i = 0; i < n_boxes; ++i) CHECK(box_mask[i] == (i == 62));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_region_mask(context, grid, 2, &count, &cell_mask, &n_boxes, &box_mask));
    CHECK(has_message(context));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_region_mask(context, NULL, 1, &count, &cell_mask, &n_boxes, &box_mask));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_region_mask(NULL, grid, 1, &count, &cell_mask, &n_boxes, &box_mask));

    STATUS(LAP_OK, lap_grid_full_links(grid, &count, &cells, &faces, &boxes));
    CHECK(count == 6);
    STATUS(LAP_OK, lap_grid_plane_faces(grid, &first, NULL, NULL, NULL, &sides));
    for (i = 0; i < count; ++i) {
        const int32_t *pair = sides + 2 * (faces[i] - first);
        CHECK(boxes[i] == 62 && (pair[0] == LAP_CELL_FULL ? pair[1] : pair[0]) == cells[i] && regions[cells[i]] == 1);
        CHECK((pair[0] == LAP_CELL_FULL) != (pair[1] == LAP_CELL_FULL));
    }
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_full_links(NULL, &count, &cells, &faces, &boxes));
    STATUS_IN(context, LAP_OK, lap_grid_full_faces(context, grid, 0, 2, &count, &nodes, &boxes));
    CHECK(count == 0);
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_full_faces(context, grid, 3, 2, &count, &nodes, &boxes));
    CHECK(has_message(context));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_full_faces(context, grid, 0, 6, &count, &nodes, &boxes));
    CHECK(has_message(context));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_full_faces(context, NULL, 0, 2, &count, &nodes, &boxes));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_full_faces(NULL, grid, 0, 2, &count, &nodes, &boxes));
    STATUS(LAP_OK, lap_grid_free(grid));
}

/* A block of full boxes has implied faces only. */
void full_block(lap_context *context, const lap_grid *grid)
{
    const int32_t *nodes = NULL, *boxes = NULL;
    int64_t count = -1, i;
    /* 1 x 3 x 2 boxes, hence 2 x 4 x 3 nodes. */
    STATUS_IN(context, LAP_OK, lap_grid_full_faces(context, grid, 1, 1, &count, &nodes, &boxes));
    CHECK(count == 2 && nodes[0] == 2 && boxes[0] == 0 && boxes[1] == 1 && nodes[1] == 10 && boxes[2] == 3 && boxes[3] == 4);
    STATUS_IN(context, LAP_OK, lap_grid_full_faces(context, grid, 0, 1, &count, &nodes, &boxes));
    CHECK(count == 6);
    for (i = 0; i < count; ++i) CHECK(boxes[2 * i] == i && boxes[2 * i + 1] == -1 && (i == 0 || nodes[i - 1] < nodes[i]));
}
