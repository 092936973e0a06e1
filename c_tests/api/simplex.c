/* Functions in single simplices: every function, the arrays of small cases in full, and bad input. */
#include "api.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* f = x0 - x1 divides the tetrahedron through the edge 2 3 and the middle of the edge 0 1. */
static const double halves[4] = {1, -1, 0, 0};

static lap_simplex *filled(lap_context *context, int32_t kind, int32_t dim, int64_t n_simplices, int64_t n_functions,
                           const double *values)
{
    lap_simplex *simplex = NULL;
    STATUS(LAP_OK, lap_simplex_new(&simplex));
    STATUS_IN(context, LAP_OK, lap_simplex_compute(context, simplex, kind, dim, n_simplices, n_functions, values));
    STATUS_IN(context, LAP_OK, lap_simplex_check(context, simplex));
    return simplex;
}

static void counts_are(const lap_simplex *simplex, int64_t simplices, int64_t vertices, int64_t edges, int64_t faces, int64_t cells)
{
    int64_t n[5] = {-1, -1, -1, -1, -1};
    STATUS(LAP_OK, lap_simplex_counts(simplex, &n[0], &n[1], &n[2], &n[3], &n[4]));
    CHECK(n[0] == simplices);
    CHECK(n[1] == vertices);
    CHECK(n[2] == edges);
    CHECK(n[3] == faces);
    CHECK(n[4] == cells);
}

/* The exact coordinates of a vertex are these. */
static void exactly(lap_context *context, const lap_simplex *simplex, int32_t vertex, const char *a, const char *b, const char *c,
                    const char *d)
{
    const char *x[4] = {NULL, NULL, NULL, NULL};
    STATUS_IN(context, LAP_OK, lap_simplex_vertex_exact(context, simplex, vertex, &x[0], &x[1], &x[2], &x[3]));
    CHECK(strcmp(x[0], a) == 0);
    CHECK(strcmp(x[1], b) == 0);
    CHECK(strcmp(x[2], c) == 0);
    CHECK(strcmp(x[3], d) == 0);
}

static void arrangement(lap_context *context)
{
    lap_simplex *simplex = filled(context, LAP_SIMPLEX_ARRANGEMENT, 3, 1, 1, halves);
    int64_t count = -1, functions = -1;
    const int32_t *codes = NULL, *offsets = NULL, *items = NULL, *edges = NULL, *kinds = NULL, *ids = NULL, *planes = NULL,
                  *cells = NULL, *signs = NULL;
    const uint8_t *carriers = NULL, *opposite = NULL;
    const char *volume = NULL;
    int32_t i, inside = -1, facets = 0;

    counts_are(simplex, 1, 5, 9, 7, 2);

    STATUS(LAP_OK, lap_simplex_vertices(simplex, &count, &carriers, &codes));
    CHECK(count == 5);
    for (i = 0; i < 4; ++i) CHECK(carriers[i] == 1 << i && codes[4 * i] == -1);
    CHECK(carriers[4] == 3 && codes[16] == 0 && codes[17] == -1 && codes[18] == -1 && codes[19] == -1);
    STATUS(LAP_OK, lap_simplex_vertex_functions(simplex, &count, &offsets, &items));
    CHECK(count == 5 && offsets[0] == 0 && offsets[2] == 0 && offsets[5] == 3);
    for (i = 0; i < 3; ++i) CHECK(items[i] == 0);
    exactly(context, simplex, 4, "1/2", "1/2", "0", "0");
    exactly(context, simplex, 2, "0", "0", "1", "0");

    STATUS(LAP_OK, lap_simplex_edges(simplex, &count, &edges));
    CHECK(count == 9);
    for (i = 0; i < 18; ++i) CHECK(edges[i] >= 0 && edges[i] < 5);

    STATUS(LAP_OK, lap_simplex_face_supports(simplex, &count, &kinds, &ids, &planes, &cells));
    CHECK(count == 7);
    for (i = 0; i < 7; ++i) {
        CHECK(ids[2 * i + 1] == -1 && cells[2 * i] >= 0);
        if (kinds[i] == LAP_SIMPLEX_FUNCTION) {
            inside = i;
            CHECK(ids[2 * i] == 0 && cells[2 * i + 1] >= 0 && planes[i] == 4);
        } else {
            ++facets;
            CHECK(kinds[i] == LAP_SIMPLEX_FACET && planes[i] == ids[2 * i] && cells[2 * i + 1] == -1);
        }
    }
    CHECK(facets == 6 && inside >= 0);
    STATUS(LAP_OK, lap_simplex_planes(simplex, &count, &offsets, &items, &opposite));
    CHECK(count == 5 && offsets[4] == 0 && offsets[5] == 1 && items[0] == 0 && opposite[0] == 0);

    /* The face in the plane: anticlockwise as seen from corner 0 is 2, the middle, 3. */
    STATUS(LAP_OK, lap_simplex_faces(simplex, &count, &offsets, &items, &edges));
    CHECK(count == 7);
    if (inside >= 0) {
        const int32_t at = offsets[inside];
        CHECK(offsets[inside + 1] - at == 3);
        for (i = 0; i < 3 && items[at + i] != 2; ++i) {
        }
        CHECK(i < 3 && items[at + (i + 1) % 3] == 4 && items[at + (i + 2) % 3] == 3);
        for (i = 0; i < 3; ++i) CHECK(edges[at + i] >= 0 && edges[at + i] < 9);
    }

    STATUS(LAP_OK, lap_simplex_cells(simplex, &count, &offsets, &items));
    CHECK(count == 2 && offsets[1] == 4 && offsets[2] == 8);
    STATUS(LAP_OK, lap_simplex_cell_signs(simplex, &count, &functions, &signs));
    CHECK(count == 2 && functions == 1 && signs[0] == -signs[1] && signs[0] != 0);
    if (inside >= 0) CHECK(signs[cells[2 * inside]] == 1 && signs[cells[2 * inside + 1]] == -1);
    for (i = 0; i < 2; ++i) {
        STATUS_IN(context, LAP_OK, lap_simplex_cell_volume_exact(context, simplex, i, &volume));
        CHECK(strcmp(volume, "1/2") == 0);
    }
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_simplex_cell_materials(simplex, &count, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_simplex_free(simplex));
}

/* A triangle of two equal materials and a third, which meet across the middle of its side 0 1 and corner 2. */
static void material_interface(lap_context *context)
{
    static const double values[9] = {1, -1, 0, -1, 1, 0, 1, -1, 0};
    lap_simplex *simplex = filled(context, LAP_SIMPLEX_INTERFACE, 2, 1, 3, values);
    int64_t count = -1;
    const int32_t *owners = NULL, *offsets = NULL, *materials = NULL, *kinds = NULL, *ids = NULL, *cells = NULL, *edges = NULL,
                  *codes = NULL, *items = NULL;
    const uint8_t *opposite = NULL;
    const char *volume = NULL;
    int32_t i, c, pairs = 0;

    counts_are(simplex, 1, 4, 0, 5, 2);
    STATUS(LAP_OK, lap_simplex_cell_materials(simplex, &count, &owners, &offsets, &materials));
    CHECK(count == 2 && owners[0] + owners[1] == 1);
    for (c = 0; c < 2; ++c) {
        CHECK(offsets[c + 1] - offsets[c] == (owners[c] == 0 ? 2 : 1) && materials[offsets[c]] == owners[c]);
        if (owners[c] == 0) CHECK(materials[offsets[c] + 1] == 2);
        STATUS_IN(context, LAP_OK, lap_simplex_cell_volume_exact(context, simplex, c, &volume));
        CHECK(strcmp(volume, "1/2") == 0);
    }
    STATUS(LAP_OK, lap_simplex_face_supports(simplex, &count, &kinds, &ids, NULL, &cells));
    for (i = 0; i < 5; ++i) {
        if (kinds[i] != LAP_SIMPLEX_PAIR) continue;
        ++pairs;
        CHECK(ids[2 * i] == 0 && ids[2 * i + 1] == 1);
        CHECK(owners[cells[2 * i]] == 0 && owners[cells[2 * i + 1]] == 1);
    }
    CHECK(pairs == 1);
    STATUS(LAP_OK, lap_simplex_planes(simplex, &count, NULL, NULL, &opposite));
    CHECK(count == 5 && opposite == NULL);
    STATUS(LAP_OK, lap_simplex_faces(simplex, &count, NULL, NULL, &edges));
    CHECK(count == 5 && edges == NULL);
    STATUS(LAP_OK, lap_simplex_vertices(simplex, NULL, NULL, &codes));
    CHECK(codes[12] >= 0 && codes[13] >= 0 && codes[14] == -1);
    STATUS(LAP_OK, lap_simplex_vertex_functions(simplex, NULL, &offsets, &items));
    CHECK(offsets[4] - offsets[3] == 3 && items[offsets[3]] == 0 && items[offsets[3] + 1] == 1 && items[offsets[3] + 2] == 2);
    exactly(context, simplex, 3, "1/2", "1/2", "0", "0");
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_simplex_cell_signs(simplex, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_simplex_free(simplex));
}

/* Rows of CSR of a batch from `first` are those of one simplex, items `shift` higher. */
static void rows_are(int64_t rows, int64_t first, const int32_t *offsets, const int32_t *items, const int32_t *one_offsets,
                     const int32_t *one_items, int32_t shift)
{
    int64_t r, k;
    for (r = 0; r < rows; ++r) {
        const int32_t length = one_offsets[r + 1] - one_offsets[r];
        CHECK(offsets[first + r + 1] - offsets[first + r] == length);
        for (k = 0; k < length; ++k) CHECK(items[offsets[first + r] + k] == one_items[one_offsets[r] + k] + shift);
    }
}

/* Many in one call are what each is alone, on any number of threads. */
static void batch(int32_t kind, int32_t threads)
{
    enum { SIMPLICES = 3000, FUNCTIONS = 3 };
    lap_context *context = NULL;
    double *values = (double *)malloc(sizeof(double) * SIMPLICES * FUNCTIONS * 4);
    lap_simplex *all, *one = NULL;
    const int32_t *vertices = NULL, *edges = NULL, *faces = NULL, *cells = NULL, *planes = NULL;
    int64_t count = -1, s, i;
    uint32_t state = 1;

    STATUS(LAP_OK, lap_context_new(&context));
    STATUS(LAP_OK, lap_context_set_threads(context, threads));
    for (i = 0; i < SIMPLICES * FUNCTIONS * 4; ++i) {
        state = state * 1664525u + 1013904223u;
        values[i] = (double)(state >> 28) - 7;
    }
    all = filled(context, kind, 3, SIMPLICES, FUNCTIONS, values);
    STATUS(LAP_OK, lap_simplex_new(&one));
    STATUS(LAP_OK, lap_simplex_offsets(all, &count, &vertices, &edges, &faces, &cells, &planes));
    CHECK(count == SIMPLICES);
    for (s = 0; s < SIMPLICES; s += 7) {
        const int32_t *offsets = NULL, *items = NULL, *one_offsets = NULL, *one_items = NULL, *ends = NULL, *one_ends = NULL;
        int64_t n = -1, all_n = -1;
        const char *volume = NULL;
        char kept[256];
        STATUS_IN(context, LAP_OK, lap_simplex_compute(context, one, kind, 3, 1, FUNCTIONS, values + 4 * FUNCTIONS * s));
        counts_are(one, 1, vertices[s + 1] - vertices[s], edges[s + 1] - edges[s], faces[s + 1] - faces[s], cells[s + 1] - cells[s]);
        STATUS(LAP_OK, lap_simplex_faces(all, NULL, &offsets, &items, NULL));
        STATUS(LAP_OK, lap_simplex_faces(one, &n, &one_offsets, &one_items, NULL));
        rows_are(n, faces[s], offsets, items, one_offsets, one_items, vertices[s]);
        STATUS(LAP_OK, lap_simplex_cells(all, NULL, &offsets, &items));
        STATUS(LAP_OK, lap_simplex_cells(one, &n, &one_offsets, &one_items));
        rows_are(n, cells[s], offsets, items, one_offsets, one_items, 2 * faces[s]);
        STATUS(LAP_OK, lap_simplex_vertex_functions(all, NULL, &offsets, &items));
        STATUS(LAP_OK, lap_simplex_vertex_functions(one, &n, &one_offsets, &one_items));
        rows_are(n, vertices[s], offsets, items, one_offsets, one_items, 0);
        STATUS(LAP_OK, lap_simplex_planes(all, &all_n, &offsets, &items, NULL));
        STATUS(LAP_OK, lap_simplex_planes(one, &n, &one_offsets, &one_items, NULL));
        CHECK(planes[s + 1] - planes[s] == n && all_n == planes[SIMPLICES]);
        rows_are(n, planes[s], offsets, items, one_offsets, one_items, 0);
        STATUS(LAP_OK, lap_simplex_edges(all, NULL, &ends));
        STATUS(LAP_OK, lap_simplex_edges(one, &n, &one_ends));
        for (i = 0; i < 2 * n; ++i) CHECK(ends[2 * edges[s] + i] == one_ends[i] + vertices[s]);
        STATUS(LAP_OK, lap_simplex_face_supports(all, NULL, NULL, NULL, NULL, &ends));
        STATUS(LAP_OK, lap_simplex_face_supports(one, &n, NULL, NULL, NULL, &one_ends));
        for (i = 0; i < 2 * n; ++i) CHECK(ends[2 * faces[s] + i] == (one_ends[i] < 0 ? -1 : one_ends[i] + cells[s]));
        if (kind == LAP_SIMPLEX_ARRANGEMENT) {
            STATUS(LAP_OK, lap_simplex_cell_signs(all, NULL, NULL, &ends));
            STATUS(LAP_OK, lap_simplex_cell_signs(one, &n, NULL, &one_ends));
            CHECK(memcmp(ends + FUNCTIONS * cells[s], one_ends, (size_t)n * FUNCTIONS * sizeof *ends) == 0);
        } else {
            STATUS(LAP_OK, lap_simplex_cell_materials(all, NULL, &ends, &offsets, &items));
            STATUS(LAP_OK, lap_simplex_cell_materials(one, &n, &one_ends, &one_offsets, &one_items));
            CHECK(memcmp(ends + cells[s], one_ends, (size_t)n * sizeof *ends) == 0);
            rows_are(n, cells[s], offsets, items, one_offsets, one_items, 0);
        }
        STATUS_IN(context, LAP_OK, lap_simplex_cell_volume_exact(context, one, 0, &volume));
        snprintf(kept, sizeof kept, "%s", volume);
        STATUS_IN(context, LAP_OK, lap_simplex_cell_volume_exact(context, all, cells[s], &volume));
        CHECK(strcmp(kept, volume) == 0);
    }
    STATUS(LAP_OK, lap_simplex_free(one));
    STATUS(LAP_OK, lap_simplex_free(all));
    STATUS(LAP_OK, lap_context_free(context));
    free(values);
}

/* No functions, no simplices, other magnitudes. */
static void ends_of_the_range(lap_context *context)
{
    static const double same[4] = {0, 0, 0, 0};
    double far[8];
    const int32_t *cells = NULL, *signs = NULL;
    int64_t count = -1;
    int i;
    lap_simplex *simplex = NULL;

    STATUS(LAP_OK, lap_simplex_new(&simplex));
    counts_are(simplex, 0, 0, 0, 0, 0);
    STATUS(LAP_OK, lap_simplex_offsets(simplex, &count, NULL, NULL, NULL, &cells, NULL));
    CHECK(count == 0 && cells != NULL && cells[0] == 0);
    STATUS_IN(context, LAP_OK, lap_simplex_check(context, simplex));
    STATUS_IN(context, LAP_OK, lap_simplex_compute(context, simplex, LAP_SIMPLEX_ARRANGEMENT, 3, 2, 0, NULL));
    counts_are(simplex, 2, 8, 12, 8, 2);
    STATUS(LAP_OK, lap_simplex_cell_signs(simplex, &count, NULL, NULL));
    CHECK(count == 2);
    STATUS_IN(context, LAP_OK, lap_simplex_compute(context, simplex, LAP_SIMPLEX_ARRANGEMENT, 3, 1, 1, same));
    counts_are(simplex, 1, 4, 6, 4, 1);
    STATUS(LAP_OK, lap_simplex_cell_signs(simplex, NULL, NULL, &signs));
    CHECK(signs != NULL && signs[0] == 0);
    STATUS_IN(context, LAP_OK, lap_simplex_compute(context, simplex, LAP_SIMPLEX_INTERFACE, 3, 0, 5, NULL));
    counts_are(simplex, 0, 0, 0, 0, 0);
    /* Two planes through the same points, of values at both ends of the range. */
    for (i = 0; i < 4; ++i) far[i] = ldexp(halves[i] * 3, 900);
    for (i = 0; i < 4; ++i) far[4 + i] = ldexp(-halves[i] * 5, -1060);
    STATUS_IN(context, LAP_OK, lap_simplex_compute(context, simplex, LAP_SIMPLEX_ARRANGEMENT, 3, 1, 2, far));
    STATUS_IN(context, LAP_OK, lap_simplex_check(context, simplex));
    counts_are(simplex, 1, 5, 9, 7, 2);
    exactly(context, simplex, 4, "1/2", "1/2", "0", "0");
    STATUS(LAP_OK, lap_simplex_free(simplex));
}

static int says(lap_context *context, const char *part)
{
    const char *message = NULL;
    STATUS(LAP_OK, lap_context_last_error(context, NULL, &message));
    return message != NULL && strstr(message, part) != NULL;
}

/* The same complex in other orders of corners and functions, and with other signs: one entry. Four functions are constructed. */
static void table_entries(lap_context *context)
{
    /* Function 0 cuts off corner 0, function 1 corner 1; then corners 2 and 3, exchanged and with signs changed; then another one. */
    const double two[24] = {-1, 1, 1, 1, 2, -1, 2, 2, 3, 3, 3, -1, -1, -1, 1, -1, -1, 1, -1, 1, 1, 1, 1, 1};
    const double triangle[6] = {2, 1, 0, 0, 1, 2};
    const double four[16] = {1, -1, 1, 1, 1, 1, -1, 1, 1, 1, 1, -1, -1, 1, 1, 1};
    lap_simplex *simplex = filled(context, LAP_SIMPLEX_ARRANGEMENT, 3, 3, 2, two);
    int64_t count = -1, n_entries = 0;
    const int32_t *entries = NULL, *corners = NULL, *functions = NULL, *cells = NULL;
    const uint8_t *flips = NULL;
    int32_t i, k, s;

    STATUS(LAP_OK, lap_simplex_tables(simplex, NULL, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_simplex_tables(simplex, &count, &n_entries, &entries, &corners, &functions, &flips));
    STATUS(LAP_OK, lap_simplex_offsets(simplex, NULL, NULL, NULL, NULL, &cells, NULL));
    CHECK(count == 3 && n_entries > 100 && cells[1] == 3 && cells[2] == 6 && cells[3] == 8);
    CHECK(entries[0] >= 0 && entries[0] < n_entries && entries[0] == entries[1] && entries[2] != entries[0]);
    for (s = 0; s < 3; ++s) {
        for (i = k = 0; i < 4; ++i) k |= 1 << corners[4 * s + i];
        CHECK(k == 15 && functions[3 * s] + functions[3 * s + 1] == 1 && functions[3 * s + 2] == -1 && flips[s] < 4);
    }
    /* Carried back to the entry's corners and functions, values of both have the same signs. */
    for (k = 0; k < 2; ++k) {
        for (i = 0; i < 4; ++i) {
            double x[2];
            for (s = 0; s < 2; ++s) {
                x[s] = two[8 * s + 4 * functions[3 * s + k] + corners[4 * s + i]];
                if (flips[s] >> k & 1) x[s] = -x[s];
            }
            CHECK((x[0] > 0) == (x[1] > 0));
        }
    }
    STATUS_IN(context, LAP_OK, lap_simplex_compute(context, simplex, LAP_SIMPLEX_INTERFACE, 2, 1, 2, triangle));
    STATUS(LAP_OK, lap_simplex_tables(simplex, &count, NULL, &entries, &corners, &functions, &flips));
    CHECK(count == 1 && entries[0] >= 0 && corners[0] + corners[1] + corners[2] == 3 && corners[3] == -1 && flips[0] == 0);
    STATUS_IN(context, LAP_OK, lap_simplex_compute(context, simplex, LAP_SIMPLEX_ARRANGEMENT, 3, 1, 4, four));
    STATUS(LAP_OK, lap_simplex_tables(simplex, &count, NULL, &entries, &corners, &functions, &flips));
    CHECK(count == 1 && entries[0] == -1 && corners[0] == -1 && functions[0] == -1 && flips[0] == 0);
    STATUS(LAP_ERR_NULL_POINTER, lap_simplex_tables(NULL, &count, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_simplex_free(simplex));
}

static void arguments(lap_context *context)
{
    enum { IA = LAP_SIMPLEX_ARRANGEMENT, MI = LAP_SIMPLEX_INTERFACE };
    double values[16] = {1, -1, 0, 0, 1, 2, 3, -4, 1, -1, 0, 0, 1, 2, 3, -4};
    lap_simplex *simplex = NULL;
    const int64_t large = INT64_C(1) << 40;
    const char *text = NULL;

    STATUS(LAP_ERR_NULL_POINTER, lap_simplex_new(NULL));
    STATUS(LAP_OK, lap_simplex_free(NULL));
    STATUS(LAP_OK, lap_simplex_new(&simplex));
    STATUS(LAP_ERR_NULL_POINTER, lap_simplex_compute(NULL, simplex, IA, 3, 1, 1, values));
    STATUS(LAP_ERR_NULL_POINTER, lap_simplex_compute(context, NULL, IA, 3, 1, 1, values));
    CHECK(has_message(context));
    STATUS(LAP_ERR_NULL_POINTER, lap_simplex_compute(context, simplex, IA, 3, 1, 1, NULL));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_simplex_compute(context, simplex, 2, 3, 1, 1, values));
    CHECK(has_message(context));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_simplex_compute(context, simplex, -1, 3, 1, 1, values));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_simplex_compute(context, simplex, IA, 1, 1, 1, values));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_simplex_compute(context, simplex, IA, 4, 1, 1, values));
    CHECK(has_message(context));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_simplex_compute(context, simplex, IA, 3, -1, 1, values));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_simplex_compute(context, simplex, IA, 3, 1, -1, values));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_simplex_compute(context, simplex, MI, 3, 1, 0, NULL));
    CHECK(has_message(context));
    STATUS(LAP_ERR_TOO_LARGE, lap_simplex_compute(context, simplex, IA, 3, 1, large, values));
    STATUS(LAP_ERR_TOO_LARGE, lap_simplex_compute(context, simplex, IA, 3, large, 1, values));
    STATUS(LAP_ERR_TOO_LARGE, lap_simplex_compute(context, simplex, IA, 3, large, 0, NULL));
    STATUS(LAP_ERR_TOO_LARGE, lap_simplex_compute(context, simplex, IA, 3, large, large, values));

    /* The value of function 1 at corner 2 of simplex 1; in triangles with one function each, at corner 2 of simplex 4. */
    STATUS_IN(context, LAP_OK, lap_simplex_compute(context, simplex, IA, 3, 2, 2, values));
    values[14] = NAN;
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_simplex_compute(context, simplex, IA, 3, 2, 2, values));
    CHECK(says(context, "function 1 at corner 2 of simplex 1"));
    counts_are(simplex, 0, 0, 0, 0, 0);
    values[14] = -INFINITY;
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_simplex_compute(context, simplex, MI, 2, 5, 1, values));
    CHECK(says(context, "function 0 at corner 2 of simplex 4"));

    counts_are(simplex, 0, 0, 0, 0, 0);
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_simplex_vertex_exact(context, simplex, 0, &text, NULL, NULL, NULL));
    CHECK(has_message(context));
    STATUS_IN(context, LAP_OK, lap_simplex_compute(context, simplex, IA, 3, 1, 2, values));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_simplex_vertex_exact(context, simplex, -1, &text, NULL, NULL, NULL));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_simplex_vertex_exact(context, simplex, 1000, &text, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_simplex_vertex_exact(context, NULL, 0, &text, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_simplex_vertex_exact(NULL, simplex, 0, &text, NULL, NULL, NULL));
    STATUS_IN(context, LAP_OK, lap_simplex_vertex_exact(context, simplex, 0, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_simplex_cell_volume_exact(context, simplex, 1000, &text));
    CHECK(has_message(context));
    STATUS(LAP_ERR_NULL_POINTER, lap_simplex_cell_volume_exact(context, simplex, 0, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_simplex_cell_volume_exact(context, NULL, 0, &text));
    STATUS(LAP_ERR_NULL_POINTER, lap_simplex_cell_volume_exact(NULL, simplex, 0, &text));
    STATUS(LAP_ERR_NULL_POINTER, lap_simplex_check(context, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_simplex_check(NULL, simplex));

    STATUS(LAP_ERR_NULL_POINTER, lap_simplex_counts(NULL, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_simplex_counts(simplex, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_simplex_offsets(NULL, NULL, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_simplex_offsets(simplex, NULL, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_simplex_vertices(NULL, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_simplex_vertices(simplex, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_simplex_vertex_functions(NULL, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_simplex_vertex_functions(simplex, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_simplex_edges(NULL, NULL, NULL));
    STATUS(LAP_OK, lap_simplex_edges(simplex, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_simplex_faces(NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_simplex_faces(simplex, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_simplex_face_supports(NULL, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_simplex_face_supports(simplex, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_simplex_planes(NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_simplex_planes(simplex, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_simplex_cells(NULL, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_simplex_cells(simplex, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_simplex_cell_signs(NULL, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_simplex_cell_signs(simplex, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_simplex_cell_materials(NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_simplex_free(simplex));
}

void test_simplex(void)
{
    lap_context *context = NULL;
    STATUS(LAP_OK, lap_context_new(&context));
    arrangement(context);
    material_interface(context);
    batch(LAP_SIMPLEX_ARRANGEMENT, 1);
    batch(LAP_SIMPLEX_ARRANGEMENT, 3);
    batch(LAP_SIMPLEX_INTERFACE, 1);
    batch(LAP_SIMPLEX_INTERFACE, 3);
    ends_of_the_range(context);
    table_entries(context);
    arguments(context);
    STATUS(LAP_OK, lap_context_free(context));
}
