/* lap_grid_*: blocks against the whole: keys, patches, the cut cells as a complex. */
#include "grid.h"

#include <string.h>

/* The cut cells as an ordinary complex: the same elements, coordinates, volumes and keys. */
void grid_as_complex(lap_context *context, const lap_grid *grid)
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
void distinct_keys(const lap_grid *grid)
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
int64_t faces_of_block(const lap_grid *whole, const lap_grid *block)
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

/* A block cut from the part of the cube that meets its box is that block cut from the whole cube. */
void grid_patches(lap_context *context, const lap_mesh *mesh)
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
    STATUS_IN(context, LAP_OK, make_grid(context, mesh, &o, &whole));
    /* Without the two triangles on x = 0, which the block's boxes do not meet; in another order. */
    for (i = 0; i < 10; ++i) {
        memcpy(few + 3 * i, cube_indices + 3 * (9 - i), 3 * sizeof *few);
        ids[i] = 9 - i;
    }
#define PATCH(count, of_ids, options) \
    lap_grid_new_patch(context, 8, cube_xyz, (count), few, NULL, (of_ids), 4, grid_x, 4, grid_y, 3, grid_z, (options), &patch)
    STATUS(LAP_ERR_BAD_ARGUMENT, PATCH(10, ids, &o));
    CHECK(patch == NULL && has_message(context));
    STATUS(LAP_ERR_BAD_ARGUMENT, PATCH(10, ids, NULL));
    o.known = LAP_NODE_SOLID;
    o.known_node[0] = 3;
    STATUS_IN(context, LAP_OK, PATCH(10, ids, &o));
    if (patch == NULL) return;
    grid_structure(patch, 12, NULL);
    grid_moments(patch, 5);
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
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_new_patch(context, 8, NULL, 9, few, NULL, NULL, 4, grid_x, 4, grid_y, 3, grid_z, &o, &patch));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_new_patch(context, 8, cube_xyz, 9, NULL, NULL, NULL, 4, grid_x, 4, grid_y, 3, grid_z, &o, &patch));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_new_patch(context, 8, cube_xyz, 9, few, NULL, NULL, 4, NULL, 4, grid_y, 3, grid_z, &o, &patch));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_new_patch(context, 8, cube_xyz, 9, few, NULL, NULL, 4, grid_x, 4, grid_y, 3, grid_z, &o, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_grid_new_patch(NULL, 8, cube_xyz, 9, few, NULL, NULL, 4, grid_x, 4, grid_y, 3, grid_z, &o, &patch));

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
