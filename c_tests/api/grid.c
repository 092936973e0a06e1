/* lap_grid_*: options, bad nodes, bad blocks, and every view. */
#include "api.h"

#include <math.h>
#include <string.h>

/* Uneven nodes around the cube [0, 2]^3; some of its sides lie in grid planes. */
static const double xs[4] = {-1, 0, 0.75, 3}, ys[4] = {-0.5, 0.5, 2, 2.5}, zs[3] = {0, 1, 4};

static int32_t make(lap_context *context, const lap_mesh *mesh, const lap_grid_options *options, lap_grid **grid)
{
    return lap_grid_new(context, mesh, 4, xs, 4, ys, 3, zs, options, grid);
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
    STATUS(LAP_ERR_BAD_ARGUMENT, make(context, mesh, &o, &grid));
    CHECK(grid == NULL && has_message(context));

    /* Blocks that are empty or outside. */
    for (i = 0; i < 3; ++i) {
        STATUS(LAP_OK, lap_grid_options_init(&o, (int32_t)sizeof o));
        o.block_low[i] = -1;
        STATUS(LAP_ERR_BAD_ARGUMENT, make(context, mesh, &o, &grid));
        CHECK(grid == NULL && has_message(context));
        o.block_low[i] = 0;
        o.block_high[i] = 4;
        STATUS(LAP_ERR_BAD_ARGUMENT, make(context, mesh, &o, &grid));
        CHECK(grid == NULL && has_message(context));
        o.block_low[i] = 1;
        o.block_high[i] = 1;
        STATUS(LAP_ERR_BAD_ARGUMENT, make(context, mesh, &o, &grid));
        CHECK(grid == NULL && has_message(context));
        o.block_high[i] = -2;
        STATUS(LAP_ERR_BAD_ARGUMENT, make(context, mesh, &o, &grid));
        CHECK(grid == NULL && has_message(context));
    }

    /* Known nodes that are none, outside the grid, outside the block. */
    STATUS(LAP_OK, lap_grid_options_init(&o, (int32_t)sizeof o));
    o.known = 3;
    STATUS(LAP_ERR_BAD_ARGUMENT, make(context, mesh, &o, &grid));
    CHECK(grid == NULL && has_message(context));
    o.known = LAP_NODE_SOLID;
    o.known_node[2] = 3;
    STATUS(LAP_ERR_BAD_ARGUMENT, make(context, mesh, &o, &grid));
    CHECK(grid == NULL && has_message(context));
    o.known_node[2] = -1;
    STATUS(LAP_ERR_BAD_ARGUMENT, make(context, mesh, &o, &grid));
    o.known_node[2] = 0;
    o.block_low[0] = 1;
    STATUS(LAP_ERR_BAD_ARGUMENT, make(context, mesh, &o, &grid));
    CHECK(grid == NULL && has_message(context));
}

static void bad_nodes(lap_context *context, const lap_mesh *mesh)
{
    const double bad[3][3] = {{0, NAN, 2}, {0, 1, INFINITY}, {0, 1, 1}};
    const char *message = NULL;
    lap_grid *grid = (lap_grid *)&grid;
    int i;

    for (i = 0; i < 3; ++i) {
        STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_new(context, mesh, 3, bad[i], 4, ys, 3, zs, NULL, &grid));
        CHECK(grid == NULL);
        STATUS(LAP_OK, lap_context_last_error(context, NULL, &message));
        CHECK(strstr(message, i == 1 ? "2 along x" : "1") != NULL);
        STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_new(context, mesh, 4, xs, 3, bad[i], 3, zs, NULL, &grid));
        STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_new(context, mesh, 4, xs, 4, ys, 3, bad[i], NULL, &grid));
        CHECK(grid == NULL);
    }
    /* -0 and 0 are one coordinate. */
    {
        const double zeros[3] = {-0.0, 0.0, 1};
        STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_new(context, mesh, 3, zeros, 4, ys, 3, zs, NULL, &grid));
    }
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_new(context, mesh, 1, xs, 4, ys, 3, zs, NULL, &grid));
    CHECK(grid == NULL && has_message(context));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_new(context, mesh, 0, NULL, 4, ys, 3, zs, NULL, &grid));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_grid_new(context, mesh, 4, xs, -4, ys, 3, zs, NULL, &grid));
    CHECK(grid == NULL && has_message(context));
    STATUS(LAP_ERR_TOO_LARGE, lap_grid_new(context, mesh, 4, xs, INT64_C(1) << 31, ys, 3, zs, NULL, &grid));
    CHECK(grid == NULL && has_message(context));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_new(context, mesh, 4, xs, 4, NULL, 3, zs, NULL, &grid));
    CHECK(grid == NULL && has_message(context));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_new(context, mesh, 4, xs, 4, ys, 3, NULL, NULL, &grid));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_new(context, NULL, 4, xs, 4, ys, 3, zs, NULL, &grid));
    CHECK(grid == NULL && has_message(context));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_new(NULL, mesh, 4, xs, 4, ys, 3, zs, NULL, &grid));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_new(context, mesh, 4, xs, 4, ys, 3, zs, NULL, NULL));
    CHECK(has_message(context));
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
    CHECK(memcmp(x, xs + 1, 3 * sizeof *x) == 0 && memcmp(y, ys, sizeof ys) == 0 && memcmp(z, zs, sizeof zs) == 0);
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
    STATUS(LAP_OK, lap_grid_options_init(&o, (int32_t)sizeof o));
    o.block_low[0] = 1;
    STATUS_IN(context, LAP_OK, make(context, mesh, &o, &grid));
    CHECK(grid != NULL);
    /* A grid lives without its mesh and its context. */
    STATUS(LAP_OK, lap_mesh_free(mesh));
    STATUS(LAP_OK, lap_context_free(context));
    if (grid != NULL) views(grid);
    STATUS(LAP_OK, lap_grid_free(grid));
    STATUS(LAP_OK, lap_grid_free(NULL));
}
