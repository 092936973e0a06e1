/* lap_grid_*: options, bad nodes, bad blocks, and every view. */
#include "api.h"

#include <math.h>
#include <stdlib.h>
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

static int is_csr(const int32_t *offsets, int64_t rows, int64_t items)
{
    int64_t i;
    if (offsets == NULL || offsets[0] != 0 || offsets[rows] != items) return 0;
    for (i = 0; i < rows; ++i) {
        if (offsets[i] > offsets[i + 1]) return 0;
    }
    return 1;
}

static int in_range(const int32_t *ids, int64_t count, int64_t low, int64_t high)
{
    int64_t i;
    for (i = 0; i < count; ++i) {
        if (ids[i] < low || ids[i] >= high) return 0;
    }
    return 1;
}

/* Boxes: flags, counts and the three ways to the cells of a box agree. */
static void boxes_and_cells(const lap_grid *grid, int64_t nx, int64_t ny, int64_t nz)
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
static void structure(const lap_grid *grid, int64_t n_triangles, const int32_t *triangle_tags)
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

/* The arrays of embedded-boundary solvers: for solids and grids of small integers over powers of two all sums are exact in
   double, up to the thirds of centroids. `volume`: what cut cells and full boxes must add up to. */
static void moments(const lap_grid *grid, double volume)
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

/* The cut cells as an ordinary complex: the same elements, coordinates, volumes and keys. */
static void as_complex(lap_context *context, const lap_grid *grid)
{
    const lap_complex *complex = NULL, *again = NULL;
    const double *a = NULL, *b = NULL;
    const int32_t *x = NULL, *y = NULL, *z = NULL, *u = NULL, *v = NULL, *w = NULL;
    const int64_t *ka = NULL, *kb = NULL;
    int64_t n[3], count = -1, n_faces, n_vertices, n_cells, i;

    STATUS(LAP_OK, lap_grid_counts(grid, NULL, NULL, NULL, &n_cells, &n_faces, NULL, &n_vertices));
    STATUS(LAP_OK, lap_grid_complex(grid, &complex));
    STATUS(LAP_OK, lap_grid_complex(grid, &again));
    CHECK(complex != NULL && complex == again);
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_complex(grid, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_complex(NULL, &complex));
    STATUS_IN(context, LAP_OK, lap_complex_check(context, complex));
    STATUS(LAP_OK, lap_complex_counts(complex, &n[0], NULL, &n[1], &n[2], NULL, NULL, NULL));
    CHECK(n[0] == n_vertices && n[1] == n_faces && n[2] == n_cells);
    STATUS(LAP_OK, lap_complex_vertices(complex, &count, &a));
    STATUS(LAP_OK, lap_grid_vertices(grid, NULL, &b, NULL));
    CHECK(memcmp(a, b, 3 * (size_t)count * sizeof *a) == 0);
    STATUS(LAP_OK, lap_complex_cells(complex, &count, &x, &y, &z));
    STATUS(LAP_OK, lap_grid_cells(grid, NULL, NULL, &u, &v, &w));
    CHECK(memcmp(x, u, ((size_t)count + 1) * sizeof *x) == 0 && memcmp(z, w, (size_t)v[u[count]] * sizeof *z) == 0);
    STATUS(LAP_OK, lap_complex_cell_moments(complex, &count, &a, NULL, NULL));
    STATUS(LAP_OK, lap_grid_cell_moments(grid, NULL, &b, NULL, NULL, NULL));
    for (i = 0; i < count; ++i) CHECK(a[i] == b[i]);
    STATUS(LAP_OK, lap_complex_vertex_keys(complex, &count, &ka));
    STATUS(LAP_OK, lap_grid_vertex_keys(grid, NULL, &kb));
    CHECK(memcmp(ka, kb, 2 * (size_t)count * sizeof *ka) == 0);
    STATUS(LAP_OK, lap_complex_face_keys(complex, &count, &ka));
    STATUS(LAP_OK, lap_grid_face_keys(grid, NULL, &kb));
    CHECK(memcmp(ka, kb, 2 * (size_t)count * sizeof *ka) == 0);
}

/* Keys are distinct. */
static void distinct_keys(const lap_grid *grid)
{
    const int64_t *keys[2];
    int64_t count[2], n_faces, n_vertices, of, i, k;
    STATUS(LAP_OK, lap_grid_counts(grid, NULL, NULL, NULL, NULL, &n_faces, NULL, &n_vertices));
    STATUS(LAP_OK, lap_grid_vertex_keys(grid, &count[0], &keys[0]));
    STATUS(LAP_OK, lap_grid_face_keys(grid, &count[1], &keys[1]));
    CHECK(count[0] == n_vertices && count[1] == n_faces);
    for (of = 0; of < 2; ++of) {
        for (i = 0; i < count[of]; ++i) {
            CHECK(keys[of][2 * i] >= 0);
            for (k = 0; k < i; ++k) {
                CHECK(keys[of][2 * i] != keys[of][2 * k] || keys[of][2 * i + 1] != keys[of][2 * k + 1]);
            }
        }
    }
}

/* Every wall and every cell of a block occurs in the whole grid under the same keys and coordinates: the block's boxes are cut
   as those of the whole are. Returns how many faces were found. */
static int64_t faces_of_block(const lap_grid *whole, const lap_grid *block)
{
    const int64_t *a = NULL, *b = NULL, *va = NULL, *vb = NULL;
    const double *xa = NULL, *xb = NULL;
    const int32_t *la = NULL, *ca = NULL, *ia = NULL, *lb = NULL, *cb = NULL, *ib = NULL;
    int64_t na = 0, nb = 0, f, g, k, turn, size, found = 0;
    STATUS(LAP_OK, lap_grid_face_keys(whole, &na, &a));
    STATUS(LAP_OK, lap_grid_face_keys(block, &nb, &b));
    STATUS(LAP_OK, lap_grid_vertex_keys(whole, NULL, &va));
    STATUS(LAP_OK, lap_grid_vertex_keys(block, NULL, &vb));
    STATUS(LAP_OK, lap_grid_vertices(whole, NULL, &xa, NULL));
    STATUS(LAP_OK, lap_grid_vertices(block, NULL, &xb, NULL));
    STATUS(LAP_OK, lap_grid_faces(whole, NULL, &la, &ca, &ia));
    STATUS(LAP_OK, lap_grid_faces(block, NULL, &lb, &cb, &ib));
    for (g = 0; g < nb; ++g) {
        for (f = 0; f < na && (a[2 * f] != b[2 * g] || a[2 * f + 1] != b[2 * g + 1]); ++f) {
        }
        CHECK(f < na);
        if (f == na) continue;
        ++found;
        /* One loop each, which may start anywhere. */
        CHECK(la[f + 1] - la[f] == 1 && lb[g + 1] - lb[g] == 1);
        size = ca[la[f + 1]] - ca[la[f]];
        CHECK(size == cb[lb[g + 1]] - cb[lb[g]]);
        for (turn = 0; turn < size; ++turn) {
            if (memcmp(va + 2 * ia[ca[la[f]] + turn], vb + 2 * ib[cb[lb[g]]], 2 * sizeof *va) == 0) break;
        }
        CHECK(turn < size);
        for (k = 0; k < size; ++k) {
            const int32_t v = ia[ca[la[f]] + (turn + k) % size], w = ib[cb[lb[g]] + k];
            CHECK(memcmp(va + 2 * v, vb + 2 * w, 2 * sizeof *va) == 0);
            CHECK(memcmp(xa + 3 * v, xb + 3 * w, 3 * sizeof *xa) == 0);
        }
    }
    return found;
}

/* Small cells of the cube: what stands together suffices, or is said not to. */
static void aggregates(lap_context *context, const lap_grid *grid)
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

/* The cube inside and outside, in known numbers; and in blocks. */
static void known_solid(lap_context *context, const lap_mesh *mesh, const int32_t *tags)
{
    lap_grid_options o;
    lap_grid *grid = NULL, *block = NULL;
    const int64_t *first = NULL;
    int64_t n[7], found, low;

    STATUS_IN(context, LAP_OK, make(context, mesh, NULL, &grid));
    if (grid == NULL) return;
    STATUS(LAP_OK, lap_grid_counts(grid, &n[0], &n[1], &n[2], &n[3], &n[4], &n[5], &n[6]));
    /* x across [0, 0.75] and [0.75, 2], y across [0, 0.5] and [0.5, 2], z across [0, 1] and [1, 2]: all eight are cut. */
    CHECK(n[0] == 10 && n[1] == 0 && n[2] == 8 && n[3] == 8 && n[4] - n[5] == 12);
    boxes_and_cells(grid, 3, 3, 2);
    structure(grid, 12, tags);
    moments(grid, 8);
    distinct_keys(grid);
    as_complex(context, grid);
    aggregates(context, grid);
    STATUS_IN(context, LAP_OK, lap_grid_check(context, grid));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_check(context, NULL));
    CHECK(has_message(context));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_check(NULL, grid));
    for (low = found = 0; low < 3; ++low) {
        STATUS(LAP_OK, lap_grid_options_init(&o, (int32_t)sizeof o));
        o.block_low[0] = (int32_t)low;
        o.block_high[0] = (int32_t)low + 1;
        STATUS_IN(context, LAP_OK, make(context, mesh, &o, &block));
        if (block == NULL) return;
        STATUS(LAP_OK, lap_grid_block(block, NULL, &first, NULL, NULL, NULL, NULL));
        CHECK(first[0] == low);
        boxes_and_cells(block, 1, 3, 2);
        structure(block, 12, tags);
        moments(block, low == 0 ? 0 : low == 1 ? 3 : 5);
        found += faces_of_block(grid, block);
        STATUS(LAP_OK, lap_grid_free(block));
    }
    /* The four faces across x = 0.75 are in two blocks. */
    CHECK(found == n[4] + 4);
    STATUS(LAP_OK, lap_grid_free(grid));

    STATUS(LAP_OK, lap_grid_options_init(&o, (int32_t)sizeof o));
    o.outside = 1;
    o.check = 1;
    STATUS_IN(context, LAP_OK, make(context, mesh, &o, &grid));
    if (grid == NULL) return;
    STATUS(LAP_OK, lap_grid_counts(grid, &n[0], &n[1], &n[2], &n[3], NULL, NULL, NULL));
    /* One box has no fluid; the box with i = 1 and j = 1 above it has some, beyond z = 2. */
    CHECK(n[0] == 1 && n[1] == 0 && n[2] == 17 && n[3] == 17);
    boxes_and_cells(grid, 3, 3, 2);
    structure(grid, 12, tags);
    moments(grid, 48 - 8);
    as_complex(context, grid);
    distinct_keys(grid);
    STATUS(LAP_OK, lap_grid_free(grid));
}

/* What connects: two regions of fluid, one of them around a full box. */
static void fluid(lap_context *context)
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
static void full_block(lap_context *context, const lap_grid *grid)
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

/* A block cut from the part of the cube that meets its box is that block cut from the whole cube. */
static void patches(lap_context *context, const lap_mesh *mesh)
{
    int64_t ids[12], wild[12];
    int32_t few[36];
    const int64_t *a = NULL, *b = NULL;
    const double *va = NULL, *vb = NULL;
    const int32_t *ta = NULL, *tb = NULL;
    int64_t n = 0, m = 0, i;
    lap_grid_options o;
    lap_grid *whole = NULL, *patch = (lap_grid *)&patch;

    STATUS(LAP_OK, lap_grid_options_init(&o, (int32_t)sizeof o));
    o.block_low[0] = 2;
    STATUS_IN(context, LAP_OK, make(context, mesh, &o, &whole));
    /* Without the two triangles on x = 0, which the block's boxes do not meet; in another order. */
    for (i = 0; i < 10; ++i) {
        memcpy(few + 3 * i, cube_indices + 3 * (9 - i), 3 * sizeof *few);
        ids[i] = 9 - i;
    }
#define PATCH(count, of_ids, options) \
    lap_grid_new_patch(context, 8, cube_xyz, (count), few, NULL, (of_ids), 4, xs, 4, ys, 3, zs, (options), &patch)
    STATUS(LAP_ERR_BAD_ARGUMENT, PATCH(10, ids, &o));
    CHECK(patch == NULL && has_message(context));
    STATUS(LAP_ERR_BAD_ARGUMENT, PATCH(10, ids, NULL));
    o.known = LAP_NODE_SOLID;
    o.known_node[0] = 3;
    STATUS_IN(context, LAP_OK, PATCH(10, ids, &o));
    if (patch == NULL) return;
    structure(patch, 12, NULL);
    moments(patch, 5);
    STATUS(LAP_OK, lap_grid_cell_moments(whole, &n, &va, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_grid_cell_moments(patch, &m, &vb, NULL, NULL, NULL));
    CHECK(n == m && memcmp(va, vb, (size_t)n * sizeof *va) == 0);
    STATUS(LAP_OK, lap_grid_face_keys(whole, &n, NULL));
    STATUS(LAP_OK, lap_grid_face_keys(patch, &m, NULL));
    CHECK(n == m && faces_of_block(whole, patch) == n);
    /* Walls by their ids in the whole mesh. */
    STATUS(LAP_OK, lap_grid_walls(whole, &n, &a, &ta, NULL));
    STATUS(LAP_OK, lap_grid_walls(patch, &m, &b, &tb, NULL));
    CHECK(n == m && ta != NULL && tb == NULL);
    for (i = m = 0; i < n; ++i) m += a[i] - b[i];
    CHECK(m == 0);
    STATUS(LAP_OK, lap_grid_free(patch));

    /* Without ids: places in the arrays. */
    STATUS_IN(context, LAP_OK, PATCH(10, NULL, &o));
    STATUS(LAP_OK, lap_grid_walls(patch, &m, &b, NULL, NULL));
    for (i = 0; i < m; ++i) CHECK(b[i] >= 0 && b[i] < 10 && (i == 0 || b[i - 1] <= b[i]));
    STATUS(LAP_OK, lap_grid_free(patch));

    /* Ids that are not; a triangle on x = 2 that is missing; arrays that are. */
    memcpy(wild, ids, sizeof wild);
    wild[3] = wild[5];
    STATUS(LAP_ERR_BAD_ARGUMENT, PATCH(10, wild, &o));
    CHECK(patch == NULL && has_message(context));
    wild[3] = INT64_C(1) << 40;
    STATUS(LAP_ERR_BAD_ARGUMENT, PATCH(10, wild, &o));
    wild[3] = -1;
    STATUS(LAP_ERR_BAD_ARGUMENT, PATCH(10, wild, &o));
    for (i = 0; i < 10 && few[3 * i] + few[3 * i + 1] + few[3 * i + 2] != 9; ++i) {
    }
    CHECK(i < 10); /* 1, 2, 6 lies on x = 2 */
    memcpy(few + 3 * i, few + 3 * 9, 3 * sizeof *few);
    STATUS(LAP_ERR_BAD_MESH, PATCH(9, NULL, &o));
    CHECK(patch == NULL && has_defect(context, LAP_DEFECT_OPEN_EDGE, -2, -2, -2));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_new_patch(context, 8, NULL, 9, few, NULL, NULL, 4, xs, 4, ys, 3, zs, &o, &patch));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_new_patch(context, 8, cube_xyz, 9, NULL, NULL, NULL, 4, xs, 4, ys, 3, zs, &o, &patch));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_new_patch(context, 8, cube_xyz, 9, few, NULL, NULL, 4, NULL, 4, ys, 3, zs, &o, &patch));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_new_patch(context, 8, cube_xyz, 9, few, NULL, NULL, 4, xs, 4, ys, 3, zs, &o, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_new_patch(NULL, 8, cube_xyz, 9, few, NULL, NULL, 4, xs, 4, ys, 3, zs, &o, &patch));

    /* No triangles at all: what is known of one node holds for all boxes. */
    o.block_low[0] = o.known_node[0] = 0;
    o.block_high[0] = 1;
    STATUS_IN(context, LAP_OK, PATCH(0, NULL, &o));
    STATUS(LAP_OK, lap_grid_counts(patch, &n, &m, NULL, NULL, NULL, NULL, NULL));
    CHECK(n == 6 && m == 0);
    STATUS(LAP_OK, lap_grid_free(patch));
    o.known = LAP_NODE_FLUID;
    STATUS_IN(context, LAP_OK, PATCH(0, NULL, &o));
    STATUS(LAP_OK, lap_grid_counts(patch, &n, &m, NULL, NULL, NULL, NULL, NULL));
    CHECK(n == 0 && m == 6);
    full_block(context, patch);
    STATUS(LAP_OK, lap_grid_free(patch));
    STATUS(LAP_OK, lap_grid_free(whole));
#undef PATCH
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
    structure(grid, 24, NULL);
    moments(grid, 56);
    STATUS(LAP_OK, lap_grid_free(grid));

    /* One row of boxes through wall, void and wall; the last box holds void, and the wall beyond and around it. Outside, the
       void is the fluid: one cell; the first box is in the wall. */
    STATUS_IN(context, LAP_OK, lap_grid_new(context, mesh, 3, coarse, 2, wide, 2, wide, NULL, &grid));
    if (grid == NULL) return;
    STATUS(LAP_OK, lap_grid_counts(grid, &n[0], &n[1], &n[2], &n[3], NULL, NULL, NULL));
    CHECK(n[0] == 0 && n[1] == 1 && n[2] == 1 && n[3] == 1);
    structure(grid, 24, NULL);
    moments(grid, 3.5 * 3.5 * 3.5 - 8);
    STATUS(LAP_OK, lap_grid_free(grid));
    STATUS(LAP_OK, lap_grid_options_init(&o, (int32_t)sizeof o));
    o.outside = 1;
    STATUS_IN(context, LAP_OK, lap_grid_new(context, mesh, 3, coarse, 2, wide, 2, wide, &o, &grid));
    if (grid == NULL) return;
    STATUS(LAP_OK, lap_grid_counts(grid, &n[0], &n[1], &n[2], &n[3], NULL, NULL, NULL));
    CHECK(n[0] == 1 && n[1] == 0 && n[2] == 1 && n[3] == 1);
    structure(grid, 24, NULL);
    moments(grid, 8);
    STATUS(LAP_OK, lap_grid_free(grid));

    /* A box that crosses the cube's upper wall and reaches into the void and out of the cube: two parts of fluid outside. */
    {
        const double across[2] = {1.5, 2.5}, up[2] = {2.5, 4.5};
        int32_t flag = -1, first = -1, parts = -1;
        STATUS_IN(context, LAP_OK, lap_grid_new(context, mesh, 2, across, 2, across, 2, up, &o, &grid));
        if (grid == NULL) return;
        STATUS(LAP_OK, lap_grid_box(grid, 0, 0, 0, &flag, &first, &parts));
        CHECK(flag == LAP_BOX_CUT && first == 0 && parts == 2);
        structure(grid, 24, NULL);
        moments(grid, 1);
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
    patches(context, mesh);
    fluid(context);
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
