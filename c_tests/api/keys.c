/* Keys, and the global ids that they are made of. */
#include "api.h"

#include <stdlib.h>
#include <string.h>

enum { TRIANGLES = 12, PLANES = 3 };

static int compare(const void *a, const void *b)
{
    const int64_t *x = (const int64_t *)a, *y = (const int64_t *)b;
    if (x[0] != y[0]) return x[0] < y[0] ? -1 : 1;
    return x[1] < y[1] ? -1 : x[1] > y[1];
}

/* A sorted copy; checks that no key comes twice and none starts with a negative number. */
static int64_t *sorted(int64_t count, const int64_t *keys)
{
    int64_t *copy = (int64_t *)malloc((size_t)count * 2 * sizeof *copy), i;
    memcpy(copy, keys, (size_t)count * 2 * sizeof *copy);
    qsort(copy, (size_t)count, 2 * sizeof *copy, compare);
    for (i = 0; i < count; ++i) CHECK(copy[2 * i] >= 0);
    for (i = 1; i < count; ++i) CHECK(compare(copy + 2 * i - 2, copy + 2 * i) < 0);
    return copy;
}

typedef struct view {
    lap_cut *cut;
    const lap_complex *complex;
    int64_t vertices, faces;
    const int64_t *vertex_keys, *face_keys;
} view;

/* Cuts the cube with its triangles and the planes x = 1, y = 1, z = 1 in this order or in the opposite one. */
static view rank(lap_context *context, int backwards, int with_ids)
{
    view made = {NULL, NULL, -1, -1, NULL, NULL};
    int32_t indices[3 * TRIANGLES];
    double planes[4 * PLANES] = {0};
    int64_t triangle_ids[TRIANGLES], plane_ids[PLANES];
    lap_mesh *mesh;
    int i, k;

    for (i = 0; i < TRIANGLES; ++i) {
        const int from = backwards ? TRIANGLES - 1 - i : i;
        for (k = 0; k < 3; ++k) indices[3 * i + k] = cube_indices[3 * from + k];
        triangle_ids[i] = INT64_C(1000000000000) + from;
    }
    for (i = 0; i < PLANES; ++i) {
        const int from = backwards ? PLANES - 1 - i : i;
        planes[4 * i + from] = 1;
        planes[4 * i + 3] = -1;
        plane_ids[i] = 7 * from;
    }
    mesh = good_mesh(context, 8, cube_xyz, TRIANGLES, indices, NULL);
    if (with_ids) STATUS_IN(context, LAP_OK, lap_mesh_set_triangle_ids(context, mesh, TRIANGLES, triangle_ids));
    STATUS_IN(context, LAP_OK, lap_cut_new(context, mesh, PLANES, planes, NULL, &made.cut));
    STATUS(LAP_OK, lap_mesh_free(mesh));
    if (with_ids) STATUS_IN(context, LAP_OK, lap_cut_set_plane_ids(context, made.cut, PLANES, plane_ids));
    STATUS(LAP_OK, lap_cut_complex(made.cut, &made.complex));
    STATUS(LAP_OK, lap_complex_vertex_keys(made.complex, &made.vertices, &made.vertex_keys));
    STATUS(LAP_OK, lap_complex_face_keys(made.complex, &made.faces, &made.face_keys));
    return made;
}

static void two_ranks(lap_context *context, int with_ids, int expected)
{
    view a = rank(context, 0, with_ids), b = rank(context, 1, with_ids);
    int64_t *va, *vb, *fa, *fb;
    int64_t vertices = -1, faces = -1;

    STATUS(LAP_OK, lap_complex_counts(a.complex, &vertices, NULL, &faces, NULL, NULL, NULL, NULL));
    CHECK(a.vertices == vertices && b.vertices == vertices);
    CHECK(a.faces == faces && b.faces == faces);
    va = sorted(vertices, a.vertex_keys);
    vb = sorted(vertices, b.vertex_keys);
    fa = sorted(faces, a.face_keys);
    fb = sorted(faces, b.face_keys);
    CHECK((memcmp(va, vb, (size_t)vertices * 16) == 0) == expected);
    CHECK((memcmp(fa, fb, (size_t)faces * 16) == 0) == expected);
    free(va);
    free(vb);
    free(fa);
    free(fb);
    STATUS(LAP_OK, lap_cut_free(a.cut));
    STATUS(LAP_OK, lap_cut_free(b.cut));
}

static void arguments(lap_context *context)
{
    int64_t ids[TRIANGLES] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}, count = -1;
    const int64_t *keys = NULL, *again = NULL;
    lap_mesh *mesh = good_mesh(context, 8, cube_xyz, TRIANGLES, cube_indices, NULL);
    view made = rank(context, 0, 0);

    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_set_triangle_ids(NULL, mesh, TRIANGLES, ids));
    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_set_triangle_ids(context, NULL, TRIANGLES, ids));
    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_set_triangle_ids(context, mesh, TRIANGLES, NULL));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_mesh_set_triangle_ids(context, mesh, -1, ids));
    STATUS(LAP_ERR_TOO_LARGE, lap_mesh_set_triangle_ids(context, mesh, INT64_C(1) << 40, ids));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_mesh_set_triangle_ids(context, mesh, TRIANGLES - 1, ids));
    CHECK(has_message(context));
    ids[3] = 4;
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_mesh_set_triangle_ids(context, mesh, TRIANGLES, ids));
    CHECK(has_message(context));
    ids[3] = INT64_C(1) << 40;
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_mesh_set_triangle_ids(context, mesh, TRIANGLES, ids));
    ids[3] = -1;
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_mesh_set_triangle_ids(context, mesh, TRIANGLES, ids));
    ids[3] = 3;
    STATUS_IN(context, LAP_OK, lap_mesh_set_triangle_ids(context, mesh, TRIANGLES, ids));
    STATUS(LAP_OK, lap_mesh_free(mesh));

    STATUS(LAP_ERR_NULL_POINTER, lap_cut_set_plane_ids(NULL, made.cut, PLANES, ids));
    STATUS(LAP_ERR_NULL_POINTER, lap_cut_set_plane_ids(context, NULL, PLANES, ids));
    STATUS(LAP_ERR_NULL_POINTER, lap_cut_set_plane_ids(context, made.cut, PLANES, NULL));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_cut_set_plane_ids(context, made.cut, PLANES + 1, ids));
    CHECK(has_message(context));
    /* Its keys have been read. */
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_cut_set_plane_ids(context, made.cut, PLANES, ids));
    CHECK(has_message(context));

    STATUS(LAP_ERR_NULL_POINTER, lap_complex_vertex_keys(NULL, &count, &keys));
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_face_keys(NULL, &count, &keys));
    STATUS(LAP_OK, lap_complex_vertex_keys(made.complex, NULL, NULL));
    STATUS(LAP_OK, lap_complex_face_keys(made.complex, &count, &again));
    CHECK(again == made.face_keys && count == made.faces);
    STATUS(LAP_OK, lap_cut_free(made.cut));
}

/* The centre is on all three planes. */
static void numbers(lap_context *context)
{
    view made = rank(context, 0, 0);
    const int32_t *kinds = NULL;
    int64_t i, centres = 0;

    STATUS(LAP_OK, lap_complex_vertex_origins(made.complex, NULL, &kinds, NULL));
    for (i = 0; i < made.vertices; ++i) {
        const int64_t *key = made.vertex_keys + 2 * i;
        if (kinds[i] != LAP_VERTEX_PLANES) continue;
        ++centres;
        /* Kind 7, planes 0, 1, 2. */
        CHECK(key[0] == INT64_C(7) << 56 && key[1] == ((INT64_C(1) << 40) | 2));
    }
    CHECK(centres == 1);
    STATUS(LAP_OK, lap_cut_free(made.cut));
}

void test_keys(void)
{
    lap_context *context = NULL;
    STATUS(LAP_OK, lap_context_new(&context));
    two_ranks(context, 1, 1);
    /* Positions are not the same in both orders. */
    two_ranks(context, 0, 0);
    arguments(context);
    numbers(context);
    STATUS(LAP_OK, lap_context_free(context));
}
