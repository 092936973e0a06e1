/* lap_grid_*: options, bad nodes, bad blocks, known solids, and every view with NULL. The parts are in grid_*.c. */
#include "grid.h"

#include <math.h>
#include <string.h>

/* Uneven nodes around the cube [0, 2]^3; some of its sides lie in grid planes. */
const double grid_x[4] = {-1, 0, 0.75, 3}, grid_y[4] = {-0.5, 0.5, 2, 2.5}, grid_z[3] = {0, 1, 4};

int32_t make_grid(lap_context *context, const lap_mesh *mesh, const lap_grid_options *options, lap_grid **grid)
{
    return lap_grid_new(context, mesh, 4, grid_x, 4, grid_y, 3, grid_z, options, grid);
}

static void options(lap_context *context, const lap_mesh *mesh)
{
    lap_grid_options o;
    lap_grid *grid = (lap_grid *)&grid;
    int i;

    STATUS(LAP_ERR_NULL_POINTER, lap_grid_options_init(NULL, (int32_t)sizeof o));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_options_init(&o, 2));
    STATUS(LAP_OK, lap_grid_options_init(&o, (int32_t)sizeof o));
    CHECK(o.struct_size == (int32_t)sizeof o && o.outside == 0 && o.known == LAP_NODE_UNKNOWN);
    for (i = 0; i < 3; ++i) CHECK(o.block_low[i] == 0 && o.block_high[i] == -1);
    o.struct_size = 1 << 20;
    STATUS(LAP_ERR_BAD_ARGUMENT, make_grid(context, mesh, &o, &grid));
    CHECK(grid == NULL && has_message(context));

    /* Blocks that are empty or outside. */
    for (i = 0; i < 3; ++i) {
        STATUS(LAP_OK, lap_grid_options_init(&o, (int32_t)sizeof o));
        o.block_low[i] = -1;
        STATUS(LAP_ERR_BAD_ARGUMENT, make_grid(context, mesh, &o, &grid));
        CHECK(grid == NULL && has_message(context));
        o.block_low[i] = 0;
        o.block_high[i] = 4;
        STATUS(LAP_ERR_BAD_ARGUMENT, make_grid(context, mesh, &o, &grid));
        CHECK(grid == NULL && has_message(context));
        o.block_low[i] = 1;
        o.block_high[i] = 1;
        STATUS(LAP_ERR_BAD_ARGUMENT, make_grid(context, mesh, &o, &grid));
        CHECK(grid == NULL && has_message(context));
        o.block_high[i] = -2;
        STATUS(LAP_ERR_BAD_ARGUMENT, make_grid(context, mesh, &o, &grid));
        CHECK(grid == NULL && has_message(context));
    }

    /* Known nodes that are none, outside the grid, outside the block. */
    STATUS(LAP_OK, lap_grid_options_init(&o, (int32_t)sizeof o));
    o.known = 3;
    STATUS(LAP_ERR_BAD_ARGUMENT, make_grid(context, mesh, &o, &grid));
    CHECK(grid == NULL && has_message(context));
    o.known = LAP_NODE_SOLID;
    o.known_node[2] = 3;
    STATUS(LAP_ERR_BAD_ARGUMENT, make_grid(context, mesh, &o, &grid));
    CHECK(grid == NULL && has_message(context));
    o.known_node[2] = -1;
    STATUS(LAP_ERR_BAD_ARGUMENT, make_grid(context, mesh, &o, &grid));
    o.known_node[2] = 0;
    o.block_low[0] = 1;
    STATUS(LAP_ERR_BAD_ARGUMENT, make_grid(context, mesh, &o, &grid));
    CHECK(grid == NULL && has_message(context));
}

static void bad_nodes(lap_context *context, const lap_mesh *mesh)
{
    const double bad[3][3] = {{0, NAN, 2}, {0, 1, INFINITY}, {0, 1, 1}};
    const char *message = NULL;
    lap_grid *grid = (lap_grid *)&grid;
    int i;

    for (i = 0; i < 3; ++i) {
        STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_new(context, mesh, 3, bad[i], 4, grid_y, 3, grid_z, NULL, &grid));
        CHECK(grid == NULL);
        STATUS(LAP_OK, lap_context_last_error(context, NULL, &message));
        CHECK(strstr(message, i == 1 ? "2 along x" : "1") != NULL);
        STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_new(context, mesh, 4, grid_x, 3, bad[i], 3, grid_z, NULL, &grid));
        STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_new(context, mesh, 4, grid_x, 4, grid_y, 3, bad[i], NULL, &grid));
        CHECK(grid == NULL);
    }
    /* -0 and 0 are one coordinate. */
    {
        const double zeros[3] = {-0.0, 0.0, 1};
        STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_new(context, mesh, 3, zeros, 4, grid_y, 3, grid_z, NULL, &grid));
    }
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_new(context, mesh, 1, grid_x, 4, grid_y, 3, grid_z, NULL, &grid));
    CHECK(grid == NULL && has_message(context));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_new(context, mesh, 0, NULL, 4, grid_y, 3, grid_z, NULL, &grid));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_new(context, mesh, 4, grid_x, -4, grid_y, 3, grid_z, NULL, &grid));
    CHECK(grid == NULL && has_message(context));
    STATUS(LAP_ERR_TOO_LARGE, lap_grid_new(context, mesh, 4, grid_x, INT64_C(1) << 31, grid_y, 3, grid_z, NULL, &grid));
    CHECK(grid == NULL && has_message(context));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_new(context, mesh, 4, grid_x, 4, NULL, 3, grid_z, NULL, &grid));
    CHECK(grid == NULL && has_message(context));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_new(context, mesh, 4, grid_x, 4, grid_y, 3, NULL, NULL, &grid));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_new(context, NULL, 4, grid_x, 4, grid_y, 3, grid_z, NULL, &grid));
    CHECK(grid == NULL && has_message(context));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_new(NULL, mesh, 4, grid_x, 4, grid_y, 3, grid_z, NULL, &grid));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_new(context, mesh, 4, grid_x, 4, grid_y, 3, grid_z, NULL, NULL));
    CHECK(has_message(context));
}

/* The cube inside and outside, in known numbers; and in blocks. */
static void known_solid(lap_context *context, const lap_mesh *mesh, const int32_t *tags)
{
    lap_grid_options o;
    lap_grid *grid = NULL, *block = NULL;
    const int64_t *first = NULL;
    int64_t n[7], found, low;

    STATUS_IN(context, LAP_OK, make_grid(context, mesh, NULL, &grid));
    if (grid == NULL) return;
    STATUS(LAP_OK, lap_grid_counts(grid, &n[0], &n[1], &n[2], &n[3], &n[4], &n[5], &n[6]));
    /* x across [0, 0.75] and [0.75, 2], y across [0, 0.5] and [0.5, 2], z across [0, 1] and [1, 2]: all eight are cut. */
    CHECK(n[0] == 10 && n[1] == 0 && n[2] == 8 && n[3] == 8 && n[4] - n[5] == 12);
    boxes_and_cells(grid, 3, 3, 2);
    grid_structure(grid, 12, tags);
    grid_moments(grid, 8);
    distinct_keys(grid);
    grid_as_complex(context, grid);
    grid_aggregates(context, grid);
    STATUS_IN(context, LAP_OK, lap_grid_check(context, grid));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_check(context, NULL));
    CHECK(has_message(context));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_check(NULL, grid));
    for (low = found = 0; low < 3; ++low) {
        STATUS(LAP_OK, lap_grid_options_init(&o, (int32_t)sizeof o));
        o.block_low[0] = (int32_t)low;
        o.block_high[0] = (int32_t)low + 1;
        STATUS_IN(context, LAP_OK, make_grid(context, mesh, &o, &block));
        if (block == NULL) return;
        STATUS(LAP_OK, lap_grid_block(block, NULL, &first, NULL, NULL, NULL, NULL));
        CHECK(first[0] == low);
        boxes_and_cells(block, 1, 3, 2);
        grid_structure(block, 12, tags);
        grid_moments(block, low == 0 ? 0 : low == 1 ? 3 : 5);
        found += faces_of_block(grid, block);
        STATUS(LAP_OK, lap_grid_free(block));
    }
    /* The four faces across x = 0.75 are in two blocks. */
    CHECK(found == n[4] + 4);
    STATUS(LAP_OK, lap_grid_free(grid));

    STATUS(LAP_OK, lap_grid_options_init(&o, (int32_t)sizeof o));
    o.outside = 1;
    o.check = 1;
    STATUS_IN(context, LAP_OK, make_grid(context, mesh, &o, &grid));
    if (grid == NULL) return;
    STATUS(LAP_OK, lap_grid_counts(grid, &n[0], &n[1], &n[2], &n[3], NULL, NULL, NULL));
    /* One box has no fluid; the box with i = 1 and j = 1 above it has some, beyond z = 2. */
    CHECK(n[0] == 1 && n[1] == 0 && n[2] == 17 && n[3] == 17);
    boxes_and_cells(grid, 3, 3, 2);
    grid_structure(grid, 12, tags);
    grid_moments(grid, 48 - 8);
    grid_as_complex(context, grid);
    distinct_keys(grid);
    STATUS(LAP_OK, lap_grid_free(grid));
}

/* Full boxes, and a box in two parts: a cube with a void, in a grid of 4 across each axis that a plate of fluid crosses. */
static void hollow(lap_context *context)
{
    const double even[6] = {-0.5, 0.5, 1.5, 2.5, 3.5, 4.5}, coarse[3] = {0.25, 0.75, 3.75}, wide[2] = {0.25, 3.75};
    lap_mesh *mesh = good_mesh(context, 16, hollow_xyz, 24, hollow_indices, NULL);
    lap_grid_options o;
    lap_grid *grid = NULL;
    int64_t n[7];

    /* The middle box is in the void; those around it are cut by its walls, the outer ones by the outer walls. */
    STATUS_IN(context, LAP_OK, lap_grid_new(context, mesh, 6, even, 6, even, 6, even, NULL, &grid));
    if (grid == NULL) return;
    STATUS(LAP_OK, lap_grid_counts(grid, &n[0], &n[1], &n[2], &n[3], &n[4], &n[5], &n[6]));
    CHECK(n[0] == 1 && n[1] == 0 && n[2] == 124 && n[3] == 124);
    boxes_and_cells(grid, 5, 5, 5);
    grid_structure(grid, 24, NULL);
    grid_moments(grid, 56);
    STATUS(LAP_OK, lap_grid_free(grid));

    /* One row of boxes through wall, void and wall; the last box holds void, and the wall beyond and around it. Outside, the
       void is the fluid: one cell; the first box is in the wall. */
    STATUS_IN(context, LAP_OK, lap_grid_new(context, mesh, 3, coarse, 2, wide, 2, wide, NULL, &grid));
    if (grid == NULL) return;
    STATUS(LAP_OK, lap_grid_counts(grid, &n[0], &n[1], &n[2], &n[3], NULL, NULL, NULL));
    CHECK(n[0] == 0 && n[1] == 1 && n[2] == 1 && n[3] == 1);
    grid_structure(grid, 24, NULL);
    grid_moments(grid, 3.5 * 3.5 * 3.5 - 8);
    STATUS(LAP_OK, lap_grid_free(grid));
    STATUS(LAP_OK, lap_grid_options_init(&o, (int32_t)sizeof o));
    o.outside = 1;
    STATUS_IN(context, LAP_OK, lap_grid_new(context, mesh, 3, coarse, 2, wide, 2, wide, &o, &grid));
    if (grid == NULL) return;
    STATUS(LAP_OK, lap_grid_counts(grid, &n[0], &n[1], &n[2], &n[3], NULL, NULL, NULL));
    CHECK(n[0] == 1 && n[1] == 0 && n[2] == 1 && n[3] == 1);
    grid_structure(grid, 24, NULL);
    grid_moments(grid, 8);
    STATUS(LAP_OK, lap_grid_free(grid));

    /* A box that crosses the cube's upper wall and reaches into the void and out of the cube: two parts of fluid outside. */
    {
        const double across[2] = {1.5, 2.5}, up[2] = {2.5, 4.5};
        int32_t flag = -1, first = -1, parts = -1;
        STATUS_IN(context, LAP_OK, lap_grid_new(context, mesh, 2, across, 2, across, 2, up, &o, &grid));
        if (grid == NULL) return;
        STATUS(LAP_OK, lap_grid_box(grid, 0, 0, 0, &flag, &first, &parts));
        CHECK(flag == LAP_BOX_CUT && first == 0 && parts == 2);
        grid_structure(grid, 24, NULL);
        grid_moments(grid, 1);
        STATUS(LAP_OK, lap_grid_free(grid));
    }
    STATUS(LAP_OK, lap_mesh_free(mesh));
}

static void views(const lap_grid *grid)
{
    const int64_t *boxes = NULL, *first = NULL, *total = NULL, *triangles = NULL, *keys = NULL;
    const double *x = NULL, *y = NULL, *z = NULL, *xyz = NULL;
    const uint8_t *flags = NULL, *on_planes = NULL;
    const int32_t *a = NULL, *b = NULL, *c = NULL, *d = NULL;
    int64_t n = -1, m = -1;
    int32_t flag, start, count;
    const char *name = NULL;
    double seconds;

    STATUS(LAP_OK, lap_grid_block(grid, &boxes, &first, &total, &x, &y, &z));
    CHECK(boxes[0] == 2 && boxes[1] == 3 && boxes[2] == 2);
    CHECK(first[0] == 1 && first[1] == 0 && first[2] == 0);
    CHECK(total[0] == 3 && total[1] == 3 && total[2] == 2);
    CHECK(memcmp(x, grid_x + 1, 3 * sizeof *x) == 0 && memcmp(y, grid_y, sizeof grid_y) == 0 && memcmp(z, grid_z, sizeof grid_z) == 0);
    STATUS(LAP_OK, lap_grid_block(grid, NULL, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_block(NULL, &boxes, NULL, NULL, NULL, NULL, NULL));

    STATUS(LAP_OK, lap_grid_counts(grid, NULL, NULL, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_counts(NULL, &n, NULL, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_grid_flags(grid, &n, &flags));
    STATUS(LAP_OK, lap_grid_flags(grid, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_flags(NULL, &n, &flags));
    STATUS(LAP_OK, lap_grid_cut_boxes(grid, &n, &a, &b));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_cut_boxes(NULL, &n, &a, &b));
    STATUS(LAP_OK, lap_grid_box_cells(grid, &n, &a));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_box_cells(NULL, &n, &a));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_box(grid, 2, 0, 0, &flag, &start, &count));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_box(grid, 0, -1, 0, &flag, &start, &count));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_box(grid, 0, 0, INT32_MAX, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_box(NULL, 0, 0, 0, &flag, &start, &count));

    STATUS(LAP_OK, lap_grid_vertices(grid, &n, &xyz, &on_planes));
    STATUS(LAP_OK, lap_grid_vertices(grid, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_vertices(NULL, &n, &xyz, &on_planes));
    STATUS(LAP_OK, lap_grid_faces(grid, &n, &a, &b, &c));
    STATUS(LAP_OK, lap_grid_faces(grid, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_faces(NULL, &n, &a, &b, &c));
    STATUS(LAP_OK, lap_grid_walls(grid, &n, &triangles, &a, &b));
    STATUS(LAP_OK, lap_grid_walls(grid, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_walls(NULL, &n, &triangles, &a, &b));
    STATUS(LAP_OK, lap_grid_plane_faces(grid, &n, &m, &a, &b, &c));
    STATUS(LAP_OK, lap_grid_plane_faces(grid, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_plane_faces(NULL, &n, &m, &a, &b, &c));
    STATUS(LAP_OK, lap_grid_cells(grid, NULL, NULL, &b, &c, &d));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_cells(NULL, &n, &a, &b, &c, &d));

    STATUS(LAP_OK, lap_grid_cell_moments(grid, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_cell_moments(NULL, &n, &xyz, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_grid_cell_second_moments(grid, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_cell_second_moments(NULL, &n, &xyz, NULL));
    STATUS(LAP_OK, lap_grid_cell_boundaries(grid, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_cell_boundaries(NULL, &n, &xyz, NULL));
    STATUS(LAP_OK, lap_grid_plane_face_moments(grid, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_plane_face_moments(NULL, &n, &xyz, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_grid_wall_moments(grid, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_wall_moments(NULL, &n, &xyz, NULL));
    STATUS(LAP_OK, lap_grid_cell_walls(grid, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_cell_walls(NULL, &n, &a, &b));
    STATUS(LAP_OK, lap_grid_cell_tags(grid, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_cell_tags(NULL, &n, &a, &b, &xyz, NULL));

    STATUS(LAP_OK, lap_grid_vertex_keys(grid, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_vertex_keys(NULL, &n, &keys));
    STATUS(LAP_OK, lap_grid_face_keys(grid, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_face_keys(NULL, &n, &keys));

    STATUS(LAP_OK, lap_grid_stage_count(grid, &count));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_stage(grid, count, &name, &seconds));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_stage(grid, -1, &name, &seconds));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_stage(NULL, 0, &name, &seconds));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_stage_count(grid, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_stage_count(NULL, &count));
}

void test_grid(void)
{
    lap_context *context = NULL;
    lap_mesh *mesh;
    lap_grid *grid = NULL;
    lap_grid_options o;

    STATUS(LAP_OK, lap_context_new(&context));
    mesh = good_mesh(context, 8, cube_xyz, 12, cube_indices, cube_tags);
    options(context, mesh);
    bad_nodes(context, mesh);
    known_solid(context, mesh, cube_tags);
    hollow(context);
    grid_patches(context, mesh);
    grid_fluid(context);
    STATUS(LAP_OK, lap_grid_options_init(&o, (int32_t)sizeof o));
    o.block_low[0] = 1;
    STATUS_IN(context, LAP_OK, make_grid(context, mesh, &o, &grid));
    CHECK(grid != NULL);
    /* A grid lives without its mesh and its context. */
    STATUS(LAP_OK, lap_mesh_free(mesh));
    STATUS(LAP_OK, lap_context_free(context));
    if (grid != NULL) views(grid);
    STATUS(LAP_OK, lap_grid_free(grid));
    STATUS(LAP_OK, lap_grid_free(NULL));
}
