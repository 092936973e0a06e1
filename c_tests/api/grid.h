/* The parts of the test of lap_grid_*. */
#ifndef LAPIDARY_TEST_API_GRID_H
#define LAPIDARY_TEST_API_GRID_H

#include "api.h"

/* Uneven nodes around the cube [0, 2]^3; some of its sides lie in grid planes. */
extern const double grid_x[4], grid_y[4], grid_z[3];

int32_t make_grid(lap_context *context, const lap_mesh *mesh, const lap_grid_options *options, lap_grid **grid);

/* grid_cells.c */
int is_csr(const int32_t *offsets, int64_t rows, int64_t items);
int in_range(const int32_t *ids, int64_t count, int64_t low, int64_t high);
void boxes_and_cells(const lap_grid *grid, int64_t nx, int64_t ny, int64_t nz);
void grid_structure(const lap_grid *grid, int64_t n_triangles, const int32_t *triangle_tags);

/* grid_moments.c */
void grid_moments(const lap_grid *grid, double volume);

/* grid_fluid.c */
void grid_aggregates(lap_context *context, const lap_grid *grid);
void grid_fluid(lap_context *context);
void full_block(lap_context *context, const lap_grid *grid);

/* grid_blocks.c */
void grid_as_complex(lap_context *context, const lap_grid *grid);
void distinct_keys(const lap_grid *grid);
int64_t faces_of_block(const lap_grid *whole, const lap_grid *block);
void grid_patches(lap_context *context, const lap_mesh *mesh);

#endif
