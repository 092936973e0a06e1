/* lap_arrangement_* and the surfaces made from them: options, bad input, cubes in every position, every view with NULL. */
#include "arrangement.h"

#include <math.h>
#include <string.h>

lap_operand boxed(box *b, double x, double y, double z, int reversed)
{
    const double low[3] = {x, y, z};
    lap_operand o;
    int i;
    for (i = 0; i < 24; ++i) b->xyz[i] = cube_xyz[i] + low[i % 3];
    for (i = 0; i < 12; ++i) {
        b->indices[3 * i] = cube_indices[3 * i];
        b->indices[3 * i + 1] = cube_indices[3 * i + (reversed ? 2 : 1)];
        b->indices[3 * i + 2] = cube_indices[3 * i + (reversed ? 1 : 2)];
    }
    o.n_vertices = 8;
    o.xyz = b->xyz;
    o.n_triangles = 12;
    o.indices = b->indices;
    return o;
}

lap_arrangement *arranged(lap_context *context, int64_t n, const lap_operand *operands)
{
    lap_arrangement *a = NULL;
    STATUS_IN(context, LAP_OK, lap_arrangement_new(context, n, operands, NULL, &a));
    CHECK(a != NULL);
    return a;
}

static int csr_in_range(const int32_t *offsets, int64_t rows, const int32_t *items, int64_t low, int64_t high)
{
    int64_t i;
    if (offsets == NULL || offsets[0] != 0) return 0;
    for (i = 0; i < rows; ++i)
        if (offsets[i] > offsets[i + 1]) return 0;
    for (i = 0; i < offsets[rows]; ++i)
        if (items[i] < low || items[i] >= high) return 0;
    return 1;
}

/* Every directed edge of a surface's triangles as often as its reverse. */
static int is_closed(const lap_surface *surface)
{
    const int32_t *v = NULL;
    int64_t count = 0, i, j;
    STATUS(LAP_OK, lap_surface_triangles(surface, &count, &v, NULL, NULL, NULL));
    for (i = 0; i < 3 * count; ++i) {
        const int32_t from = v[i], to = v[i / 3 * 3 + (i + 1) % 3];
        int net = 0;
        for (j = 0; j < 3 * count; ++j) {
            const int32_t a = v[j], b = v[j / 3 * 3 + (j + 1) % 3];
            net += (a == from && b == to) - (a == to && b == from);
        }
        if (net != 0) return 0;
    }
    return 1;
}

void is_solid(lap_context *context, lap_surface *surface, const char *volume, int64_t euler)
{
    const char *text = NULL;
    int64_t chi = -100;
    STATUS_IN(context, LAP_OK, lap_surface_volume_exact(context, surface, &text));
    if (text == NULL || strcmp(text, volume) != 0) fprintf(stderr, "volume %s, not %s\n", text == NULL ? "" : text, volume);
    CHECK(text != NULL && strcmp(text, volume) == 0);
    STATUS(LAP_OK, lap_surface_euler(surface, &chi));
    if (chi != euler) fprintf(stderr, "Euler characteristic %d, not %d\n", (int)chi, (int)euler);
    CHECK(chi == euler);
    CHECK(is_closed(surface));
    STATUS(LAP_OK, lap_surface_free(surface));
}

void operation_is(lap_context *context, const lap_arrangement *a, int32_t operation, const char *volume, int64_t euler)
{
    lap_surface *surface = NULL;
    STATUS_IN(context, LAP_OK, lap_arrangement_extract(context, a, operation, 2, &surface));
    is_solid(context, surface, volume, euler);
}

static void takes(lap_context *context, const lap_arrangement *a, const char *expression, const char *volume, int64_t euler)
{
    lap_surface *surface = NULL;
    STATUS_IN(context, LAP_OK, lap_arrangement_extract_expression(context, a, expression, &surface));
    is_solid(context, surface, volume, euler);
}

static void options(lap_context *context)
{
    struct {
        lap_arrangement_options known;
        int32_t newer[2];
    } o;
    box b;
    const lap_operand one = boxed(&b, 0, 0, 0, 0);
    lap_arrangement *a = (lap_arrangement *)&a;

    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_options_init(NULL, (int32_t)sizeof o.known));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_options_init(&o.known, 3));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_options_init(&o.known, 0));
    memset(&o, 1, sizeof o);
    STATUS(LAP_OK, lap_arrangement_options_init(&o.known, (int32_t)sizeof o));
    CHECK(o.known.struct_size == (int32_t)sizeof o && o.newer[1] == 0);
    /* Of a newer header: taken as long as nothing is set that this version does not know. */
    STATUS_IN(context, LAP_OK, lap_arrangement_new(context, 1, &one, &o.known, &a));
    STATUS(LAP_OK, lap_arrangement_free(a));
    o.newer[1] = 1;
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_new(context, 1, &one, &o.known, &a));
    CHECK(a == NULL && has_message(context));
    /* Too short for its own size. */
    o.known.struct_size = 2;
    a = (lap_arrangement *)&a;
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_new(context, 1, &one, &o.known, &a));
    CHECK(a == NULL && has_message(context));
}

static void bad_input(lap_context *context)
{
    box b[2];
    lap_operand two[2];
    lap_arrangement *a = (lap_arrangement *)&a;
    const char *message = NULL;

    two[0] = boxed(&b[0], 0, 0, 0, 0);
    two[1] = boxed(&b[1], 1, 1, 1, 0);
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_new(NULL, 2, two, NULL, &a));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_new(context, 2, two, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_new(context, 2, NULL, NULL, &a));
    CHECK(a == NULL && has_message(context));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_new(context, -1, two, NULL, &a));
    STATUS(LAP_ERR_TOO_LARGE, lap_arrangement_new(context, (int64_t)1 << 40, two, NULL, &a));
    two[1].xyz = NULL;
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_new(context, 2, two, NULL, &a));
    STATUS(LAP_OK, lap_context_last_error(context, NULL, &message));
    CHECK(strstr(message, "operand 1: xyz") != NULL);
    two[1] = boxed(&b[1], 1, 1, 1, 0);
    two[1].indices = NULL;
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_new(context, 2, two, NULL, &a));
    two[1] = boxed(&b[1], 1, 1, 1, 0);
    two[1].n_triangles = -1;
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_new(context, 2, two, NULL, &a));
    two[1].n_triangles = (int64_t)1 << 40;
    STATUS(LAP_ERR_TOO_LARGE, lap_arrangement_new(context, 2, two, NULL, &a));
    two[1] = boxed(&b[1], 1, 1, 1, 0);
    two[1].n_vertices = (int64_t)1 << 31;
    STATUS(LAP_ERR_TOO_LARGE, lap_arrangement_new(context, 2, two, NULL, &a));

    two[1] = boxed(&b[1], 1, 1, 1, 0);
    b[1].xyz[3 * 5 + 1] = NAN;
    STATUS(LAP_ERR_BAD_MESH, lap_arrangement_new(context, 2, two, NULL, &a));
    CHECK(a == NULL && has_defect(context, LAP_DEFECT_NON_FINITE_COORDINATE, 8 + 5, -1, -1));
    two[1] = boxed(&b[1], 1, 1, 1, 0);
    b[1].indices[3 * 7 + 2] = 8;
    STATUS(LAP_ERR_BAD_MESH, lap_arrangement_new(context, 2, two, NULL, &a));
    CHECK(has_defect(context, LAP_DEFECT_INDEX_OUT_OF_RANGE, 12 + 7, 2, 8));
    /* Without its last triangle, (3, 4, 7), the second is open there. */
    two[1] = boxed(&b[1], 1, 1, 1, 0);
    two[1].n_triangles = 11;
    STATUS(LAP_ERR_BAD_MESH, lap_arrangement_new(context, 2, two, NULL, &a));
    STATUS(LAP_OK, lap_context_last_error(context, NULL, &message));
    CHECK(a == NULL && strstr(message, "operand 1") != NULL);
    CHECK(has_defect(context, LAP_DEFECT_UNBALANCED_EDGE, 1, 3, 7) && has_defect(context, LAP_DEFECT_UNBALANCED_EDGE, 1, 4, 7));
    /* The third edge goes through an edge of the first one, at (1, 2, 2). */
    CHECK(has_defect(context, LAP_DEFECT_UNBALANCED_EDGE, 1, 3, -1) && has_defect(context, LAP_DEFECT_UNBALANCED_EDGE, 1, 4, -1));
    CHECK(!has_defect(context, LAP_DEFECT_UNBALANCED_EDGE, 0, -2, -2));
    /* One triangle turned around. */
    two[1] = boxed(&b[1], 1, 1, 1, 0);
    b[1].indices[0] = cube_indices[1];
    b[1].indices[1] = cube_indices[0];
    STATUS(LAP_ERR_BAD_MESH, lap_arrangement_new(context, 2, two, NULL, &a));
    CHECK(has_defect(context, LAP_DEFECT_UNBALANCED_EDGE, 1, -2, -2));
}

/* No operands; operands of nothing, or of triangles without area. */
static void nothing(lap_context *context)
{
    const double xyz[9] = {0, 0, 0, 1, 0, 0, 2, 0, 0};
    const int32_t line[3] = {0, 1, 2};
    lap_operand operands[3] = {{0, NULL, 0, NULL}, {3, xyz, 1, line}, {3, xyz, 0, NULL}};
    int64_t vertices = -1, faces = -1, patches = -1, cells = -1, pairs = -1, dropped = -1, count = -1, i;
    const int64_t *first = NULL, *triangles = NULL, *gone = NULL;
    const double *volumes = NULL;
    lap_arrangement *a = NULL;

    for (i = 0; i < 2; ++i) {
        a = arranged(context, 3 * i, i == 0 ? NULL : operands);
        STATUS(LAP_OK, lap_arrangement_counts(a, &vertices, &faces, &patches, &cells, &pairs, &dropped));
        CHECK(vertices == 0 && faces == 0 && patches == 0 && cells == 1 && pairs == 0 && dropped == i);
        STATUS(LAP_OK, lap_arrangement_operands(a, &count, &first, &triangles, &gone));
        CHECK(count == 3 * i && first[0] == 0 && triangles[0] == 0);
        if (i == 1) CHECK(first[1] == 0 && first[2] == 3 && first[3] == 6 && triangles[3] == 1 && gone[1] == 1 && gone[0] == 0);
        STATUS(LAP_OK, lap_arrangement_cell_volumes(a, &count, &volumes));
        CHECK(count == 1 && volumes[0] == 0);
        operation_is(context, a, LAP_EXTRACT_UNION, "0", 0);
        operation_is(context, a, LAP_EXTRACT_INTERSECTION, "0", 0);
        operation_is(context, a, LAP_EXTRACT_DIFFERENCE, "0", 0);
        operation_is(context, a, LAP_EXTRACT_RESOLVE, "0", 0);
        STATUS(LAP_OK, lap_arrangement_free(a));
    }
}

/* [0, 2]^3 and [1, 3]^3: every view. */
static void crossing(lap_context *context)
{
    box b[2];
    lap_operand two[2];
    lap_arrangement *a = NULL;
    lap_surface *surface = NULL;
    int64_t vertices = 0, faces = 0, patches = 0, cells = 0, pairs = 0, dropped = -1, count = 0, n = 0, i, k;
    const double *xyz = NULL, *volumes = NULL;
    const int32_t *p = NULL, *q = NULL, *r = NULL, *s = NULL, *t = NULL;
    const uint8_t *bytes = NULL;
    const char *x = NULL, *y = NULL, *z = NULL;
    double volume = 0, seconds = -1;
    int32_t stages = 0;

    two[0] = boxed(&b[0], 0, 0, 0, 0);
    two[1] = boxed(&b[1], 1, 1, 1, 0);
    a = arranged(context, 2, two);
    /* Nothing of the operands is needed any more. */
    memset(b, 0, sizeof b);
    memset(two, 0, sizeof two);
    STATUS(LAP_OK, lap_arrangement_counts(a, &vertices, &faces, &patches, &cells, &pairs, &dropped));
    CHECK(vertices > 16 && faces > 24 && patches == 4 && cells == 4 && pairs > 0 && dropped == 0);
    STATUS(LAP_OK, lap_arrangement_counts(a, NULL, NULL, NULL, NULL, NULL, NULL));

    STATUS(LAP_OK, lap_arrangement_vertices(a, &count, &xyz));
    CHECK(count == vertices);
    for (i = 0; i < 3 * count; ++i) CHECK(xyz[i] >= 0 && xyz[i] <= 3);
    STATUS(LAP_OK, lap_arrangement_vertices(a, &count, NULL));
    STATUS(LAP_OK, lap_arrangement_vertex_origins(a, &count, &p, &q));
    CHECK(count == vertices);
    for (i = 0; i < count; ++i) {
        CHECK(p[i] == (i < 16 ? LAP_VERTEX_MESH : LAP_VERTEX_TRIANGLES));
        /* All corners of both are used, and no two the same. */
        if (i < 16) CHECK(q[3 * i] == i && q[3 * i + 1] == -1);
        else CHECK(q[3 * i] >= 0 && q[3 * i] < 24 && q[3 * i + 1] >= 0 && q[3 * i + 1] < 24 && q[3 * i + 2] < 24);
        STATUS_IN(context, LAP_OK, lap_arrangement_vertex_exact(context, a, (int32_t)i, &x, &y, &z));
        CHECK(strlen(x) == 1 && x[0] - '0' == xyz[3 * i] && y[0] - '0' == xyz[3 * i + 1] && z[0] - '0' == xyz[3 * i + 2]);
    }
    STATUS(LAP_OK, lap_arrangement_vertex_exact(context, a, 0, NULL, NULL, NULL));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_vertex_exact(context, a, (int32_t)vertices, &x, &y, &z));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_vertex_exact(context, a, -1, &x, &y, &z));
    CHECK(has_message(context));

    STATUS(LAP_OK, lap_arrangement_faces(a, &count, &p, &q, &r));
    CHECK(count == faces);
    for (i = 0; i < faces; ++i) {
        CHECK(q[i] >= 0 && q[i] < patches && r[2 * i] != r[2 * i + 1]);
        for (k = 0; k < 3; ++k) CHECK(p[3 * i + k] >= 0 && p[3 * i + k] < vertices);
        for (k = 0; k < 2; ++k) CHECK(r[2 * i + k] >= 0 && r[2 * i + k] < cells);
    }
    STATUS(LAP_OK, lap_arrangement_face_births(a, &count, &p, &q, &r, &bytes));
    CHECK(count == faces && p[faces] == faces && csr_in_range(p, faces, q, 0, 2) && csr_in_range(p, faces, r, 0, 12));
    for (i = 0; i < faces; ++i) CHECK(bytes[i] == 0);
    STATUS(LAP_OK, lap_arrangement_patches(a, &count, &p, &q, &r, &s, &t));
    CHECK(count == patches && r[patches] == patches && csr_in_range(r, patches, s, 0, 2));
    for (i = 0; i < patches; ++i) CHECK(p[i] >= 0 && p[i] < faces && q[2 * i] != q[2 * i + 1] && t[i] == 1);

    STATUS(LAP_OK, lap_arrangement_cells(a, &count, &p, &q, &r));
    CHECK(count == 4 && p[1] == 0 && csr_in_range(p, 4, q, 0, 2));
    STATUS(LAP_OK, lap_arrangement_cell_volumes(a, &count, &volumes));
    CHECK(count == 4 && volumes[0] == 0);
    for (i = 1; i < 4; ++i) {
        const int both = p[i + 1] - p[i] == 2;
        CHECK(volumes[i] == (both ? 1 : 7) && r[p[i]] == 1);
        STATUS_IN(context, LAP_OK, lap_arrangement_cell_volume_exact(context, a, (int32_t)i, &x));
        CHECK(strcmp(x, both ? "1" : "7") == 0);
        n += both;
    }
    CHECK(n == 1);
    STATUS_IN(context, LAP_OK, lap_arrangement_cell_volume_exact(context, a, 0, &x));
    CHECK(strcmp(x, "0") == 0);
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_cell_volume_exact(context, a, 4, &x));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_cell_volume_exact(context, a, -1, &x));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_cell_volume_exact(context, a, 0, NULL));

    STATUS(LAP_OK, lap_arrangement_stage_count(a, &stages));
    CHECK(stages > 3);
    STATUS(LAP_OK, lap_arrangement_stage(a, 0, &x, &seconds));
    CHECK(strcmp(x, "soup") == 0 && seconds >= 0);
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_stage(a, stages, &x, &seconds));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_stage(a, -1, &x, &seconds));

    operation_is(context, a, LAP_EXTRACT_UNION, "15", 2);
    operation_is(context, a, LAP_EXTRACT_INTERSECTION, "1", 2);
    operation_is(context, a, LAP_EXTRACT_DIFFERENCE, "7", 2);
    /* Two balls that touch along a ring of six edges: 2 + 2 - 0. */
    operation_is(context, a, LAP_EXTRACT_SYMMETRIC_DIFFERENCE, "14", 4);
    operation_is(context, a, LAP_EXTRACT_AT_LEAST, "1", 2);
    operation_is(context, a, LAP_EXTRACT_RESOLVE, "15", 2);
    takes(context, a, "0 | 1", "15", 2);
    takes(context, a, " (1 - 0) ", "7", 2);
    takes(context, a, "0 ^ 1", "14", 4);
    takes(context, a, "false", "0", 0);

    /* The surface outlives the arrangement. */
    STATUS_IN(context, LAP_OK, lap_arrangement_extract(context, a, LAP_EXTRACT_DIFFERENCE, 0, &surface));
    STATUS(LAP_OK, lap_arrangement_free(a));
    STATUS(LAP_OK, lap_surface_volume(surface, &volume));
    CHECK(volume == 7);
    STATUS(LAP_OK, lap_surface_vertices(surface, &n, &xyz, &p));
    for (i = 0; i < n; ++i) CHECK(p[i] >= 0 && p[i] < vertices && (i == 0 || p[i] > p[i - 1]));
    STATUS(LAP_OK, lap_surface_triangles(surface, &count, &p, &q, &r, &bytes));
    for (k = 0, i = 0; i < count; ++i) {
        CHECK(q[i] >= 0 && q[i] < 2 && r[i] >= 0 && r[i] < 12);
        /* What comes from the second bounds the difference from the other side. */
        CHECK(bytes[i] == q[i]);
        k += bytes[i];
    }
    CHECK(k > 0 && k < count);
    STATUS(LAP_OK, lap_surface_polygons(surface, &i, &s, &t, &r, &bytes));
    CHECK(i == count && csr_in_range(s, count, t, 0, n) && s[count] == 3 * count && t == p);
    for (i = 0; i < count; ++i) CHECK(s[i] == 3 * i && bytes[i] == q[i] && r[i] >= 0 && r[i] < faces && (i == 0 || r[i] > r[i - 1]));
    STATUS(LAP_OK, lap_surface_free(surface));
}

/* Cubes that share a face, an edge, a corner, everything, and everything inside out. */
static void touching(lap_context *context)
{
    static const struct {
        double x, y, z;
        int reversed;
        const char *either, *both, *first, *one, *sum;
        int64_t chi_either, chi_both, chi_first, chi_one, chi_sum;
    } cases[] = {
        {2, 0, 0, 0, "16", "0", "8", "16", "16", 2, 0, 2, 2, 2},
        {2, 2, 0, 0, "16", "0", "8", "16", "16", 3, 0, 2, 3, 3},
        {2, 2, 2, 0, "16", "0", "8", "16", "16", 3, 0, 2, 3, 3},
        {5, 0, 0, 0, "16", "0", "8", "16", "16", 4, 0, 2, 4, 4},
        {1, 0, 0, 0, "12", "4", "4", "8", "12", 2, 2, 2, 4, 2},
        {0, 0, 0, 0, "8", "8", "0", "0", "8", 2, 2, 0, 0, 2},
        {0, 0, 0, 1, "8", "0", "8", "8", "0", 2, 0, 2, 2, 0},
        {1, 0, 0, 1, "8", "0", "8", "8", "4", 2, 0, 2, 2, 2},
    };
    size_t i;
    for (i = 0; i < sizeof cases / sizeof *cases; ++i) {
        box b[2];
        lap_operand two[2];
        lap_arrangement *a = NULL;
        two[0] = boxed(&b[0], 0, 0, 0, 0);
        two[1] = boxed(&b[1], cases[i].x, cases[i].y, cases[i].z, cases[i].reversed);
        a = arranged(context, 2, two);
        operation_is(context, a, LAP_EXTRACT_UNION, cases[i].either, cases[i].chi_either);
        operation_is(context, a, LAP_EXTRACT_INTERSECTION, cases[i].both, cases[i].chi_both);
        operation_is(context, a, LAP_EXTRACT_DIFFERENCE, cases[i].first, cases[i].chi_first);
        operation_is(context, a, LAP_EXTRACT_SYMMETRIC_DIFFERENCE, cases[i].one, cases[i].chi_one);
        operation_is(context, a, LAP_EXTRACT_AT_LEAST, cases[i].both, cases[i].chi_both);
        operation_is(context, a, LAP_EXTRACT_RESOLVE, cases[i].sum, cases[i].chi_sum);
        STATUS(LAP_OK, lap_arrangement_free(a));
    }
    {
        /* Inside out upon itself: nothing is divided, and births are kept. */
        lap_operand one[2];
        box twice[2];
        lap_operand both;
        double xyz[48];
        int32_t indices[72];
        lap_arrangement *a = NULL;
        int64_t cells = 0, faces = 0, patches = -1, k;
        const int32_t *of_patch = NULL, *of_cell = NULL, *offsets = NULL, *operands = NULL;
        const uint8_t *reversed = NULL;
        one[0] = boxed(&twice[0], 0, 0, 0, 0);
        one[1] = boxed(&twice[1], 0, 0, 0, 1);
        memcpy(xyz, twice[0].xyz, sizeof twice[0].xyz);
        memcpy(xyz + 24, twice[1].xyz, sizeof twice[1].xyz);
        memcpy(indices, one[0].indices, sizeof twice[0].indices);
        for (k = 0; k < 36; ++k) indices[36 + k] = one[1].indices[k] + 8;
        both.n_vertices = 16;
        both.xyz = xyz;
        both.n_triangles = 24;
        both.indices = indices;
        a = arranged(context, 1, &both);
        STATUS(LAP_OK, lap_arrangement_counts(a, NULL, &faces, &patches, &cells, NULL, NULL));
        CHECK(faces == 12 && patches == 0 && cells == 1);
        STATUS(LAP_OK, lap_arrangement_faces(a, NULL, NULL, &of_patch, &of_cell));
        STATUS(LAP_OK, lap_arrangement_face_births(a, NULL, &offsets, &operands, NULL, &reversed));
        for (k = 0; k < 12; ++k) {
            CHECK(of_patch[k] == -1 && of_cell[2 * k] == -1 && of_cell[2 * k + 1] == -1);
            CHECK(offsets[k + 1] == 2 * (k + 1) && reversed[2 * k] == 0 && reversed[2 * k + 1] == 1 && operands[2 * k + 1] == 0);
        }
        operation_is(context, a, LAP_EXTRACT_UNION, "0", 0);
        STATUS(LAP_OK, lap_arrangement_free(a));
    }
}

static void expressions(lap_context *context)
{
    static const char *const bad[] = {"", "0 &", "(0", "0)", "0 1", "3", "0 | x", "-0", "99999999999999999999"};
    box b[3];
    lap_operand three[3];
    lap_arrangement *a = NULL;
    lap_surface *surface = NULL;
    const char *message = NULL;
    size_t i;

    three[0] = boxed(&b[0], 0, 0, 0, 0);
    three[1] = boxed(&b[1], 1, 0, 0, 0);
    three[2] = boxed(&b[2], 1, 1, 0, 0);
    a = arranged(context, 3, three);
    takes(context, a, "(0 | 1) & !2", "8", 2);
    takes(context, a, "0 & 1 & 2", "2", 2);
    operation_is(context, a, LAP_EXTRACT_INTERSECTION, "2", 2);
    operation_is(context, a, LAP_EXTRACT_AT_LEAST, "6", 2);
    for (i = 0; i < sizeof bad / sizeof *bad; ++i) {
        surface = (lap_surface *)&surface;
        STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_extract_expression(context, a, bad[i], &surface));
        CHECK(surface == NULL && has_message(context));
    }
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_extract_expression(context, a, "\xff", &surface));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_extract_expression(context, a, "!0", &surface));
    STATUS(LAP_OK, lap_context_last_error(context, NULL, &message));
    CHECK(surface == NULL && strstr(message, "unbounded") != NULL);
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_extract_expression(context, a, NULL, &surface));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_extract_expression(context, a, "0", NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_extract_expression(context, NULL, "0", &surface));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_extract_expression(NULL, a, "0", &surface));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_extract(context, a, 6, 1, &surface));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_extract(context, a, -1, 1, &surface));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_extract(context, a, LAP_EXTRACT_AT_LEAST, 0, &surface));
    CHECK(surface == NULL && has_message(context));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_extract(context, a, LAP_EXTRACT_UNION, 1, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_extract(context, NULL, LAP_EXTRACT_UNION, 1, &surface));
    STATUS_IN(context, LAP_OK, lap_arrangement_extract(context, a, LAP_EXTRACT_AT_LEAST, 1000, &surface));
    is_solid(context, surface, "0", 0);
    STATUS(LAP_OK, lap_arrangement_free(a));
}

/* The cells as a complex: two cubes that overlap in half a cube, and a solid of both. */
static void complexes(lap_context *context)
{
    box one, two;
    lap_operand operands[2];
    lap_arrangement *a;
    lap_surface *surface = NULL;
    const lap_complex *complex = NULL, *again = NULL;
    const double *volumes = NULL, *of_cells = NULL;
    const int32_t *cells = NULL, *kinds = NULL, *ids = NULL, *vertices = NULL, *offsets = NULL, *faces = NULL;
    const int64_t *keys = NULL;
    const char *text = NULL;
    int64_t n_cells = 0, count = 0, n_vertices = 0, n_faces = 0, i, k;
    int32_t side = 0;
    operands[0] = boxed(&one, 0, 0, 0, 0);
    operands[1] = boxed(&two, 1, 0, 0, 1);
    a = arranged(context, 2, operands);
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_complex_places(a, NULL, NULL, NULL, NULL, NULL));
    STATUS_IN(context, LAP_OK, lap_arrangement_complex(context, a, &complex));
    STATUS_IN(context, LAP_OK, lap_arrangement_complex(context, a, &again));
    CHECK(complex != NULL && complex == again);
    STATUS_IN(context, LAP_OK, lap_complex_check(context, complex));
    STATUS(LAP_OK, lap_complex_counts(complex, &n_vertices, NULL, &n_faces, &n_cells, NULL, NULL, NULL));
    CHECK(n_cells == 3);
    STATUS(LAP_OK, lap_arrangement_cell_volumes(a, &count, &of_cells));
    STATUS(LAP_OK, lap_complex_cell_moments(complex, &n_cells, &volumes, NULL, NULL));
    for (i = 0; i < n_cells; ++i) CHECK(volumes[i] == 4 && of_cells[i + 1] == 4);
    STATUS_IN(context, LAP_OK, lap_complex_cell_volume_exact(context, complex, 1, &text));
    CHECK(text != NULL && strcmp(text, "4") == 0);

    /* The cells beside each face are those beside the faces that it consists of. */
    STATUS(LAP_OK, lap_arrangement_complex_places(a, &count, &vertices, &n_faces, &offsets, &faces));
    CHECK(count == n_vertices && csr_in_range(offsets, n_faces, faces, 0, 1000));
    STATUS(LAP_OK, lap_complex_face_cells(complex, &count, &cells));
    CHECK(count == n_faces);
    STATUS(LAP_OK, lap_arrangement_faces(a, NULL, NULL, NULL, &ids));
    for (i = 0; i < n_faces; ++i)
        for (k = offsets[i]; k < offsets[i + 1]; ++k)
            CHECK(cells[2 * i] == ids[2 * faces[k]] - 1 && cells[2 * i + 1] == ids[2 * faces[k] + 1] - 1);
    STATUS(LAP_OK, lap_complex_face_supports(complex, &count, &kinds, &ids, NULL, NULL));
    for (i = 0; i < count; ++i) CHECK(kinds[i] == LAP_SUPPORT_TRIANGLE && ids[i] >= 0 && ids[i] < 24);
    STATUS(LAP_OK, lap_complex_vertex_origins(complex, &count, &kinds, &ids));
    for (i = 0; i < count; ++i) CHECK(kinds[i] == LAP_VERTEX_MESH || kinds[i] == LAP_VERTEX_TRIANGLES);
    STATUS(LAP_OK, lap_complex_vertex_keys(complex, &count, &keys));
    CHECK(count == n_vertices && keys != NULL);
    STATUS(LAP_OK, lap_complex_face_keys(complex, &count, &keys));
    CHECK(count == n_faces && keys != NULL);
    for (i = 0; i < n_faces; ++i) {
        CHECK(keys[2 * i] >= 0);
        for (k = 0; k < i; ++k) CHECK(keys[2 * i] != keys[2 * k] || keys[2 * i + 1] != keys[2 * k + 1]);
    }
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_complex_cell_side(complex, 0, 0, &side));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_complex(context, a, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_complex(context, NULL, &complex));
    CHECK(complex == NULL);
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_complex_places(NULL, NULL, NULL, NULL, NULL, NULL));

    /* Inside the first, not the second (which is inside out, so inside of nothing): one cell, or what is not in both. */
    STATUS_IN(context, LAP_OK, lap_arrangement_extract(context, a, LAP_EXTRACT_UNION, 1, &surface));
    STATUS_IN(context, LAP_OK, lap_surface_complex(context, surface, &complex));
    STATUS(LAP_OK, lap_arrangement_free(a));
    STATUS_IN(context, LAP_OK, lap_complex_check(context, complex));
    STATUS(LAP_OK, lap_complex_cell_moments(complex, &n_cells, &volumes, NULL, NULL));
    CHECK(n_cells == 1 && volumes[0] == 8);
    STATUS(LAP_ERR_NULL_POINTER, lap_surface_complex(context, surface, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_surface_complex(context, NULL, &complex));
    STATUS(LAP_OK, lap_surface_free(surface));
}

static void surface_is(lap_context *context, const lap_arrangement *a, const char *expression, const char *volume)
{
    lap_surface *surface = NULL;
    const char *text = NULL;
    STATUS_IN(context, LAP_OK, lap_arrangement_extract_expression(context, a, expression, &surface));
    STATUS_IN(context, LAP_OK, lap_surface_volume_exact(context, surface, &text));
    CHECK(text != NULL && strcmp(text, volume) == 0);
    CHECK(is_closed(surface));
    STATUS(LAP_OK, lap_surface_free(surface));
}

/* A cube of edge 2 and half-spaces: x < 1/3, which no double is; a corner cut off; one whose plane is on a side. */
static void half_spaces(lap_context *context)
{
    const double planes[12] = {3, 0, 0, -1, 0.5, 0.5, 0.5, -0.5, 0, 0, 1, -2};
    double bounds[6] = {-1, -1, -1, 5, 5, 5}, bad[8] = {1, 0, 0, 0, 0, 0, 0, 1};
    box b;
    const lap_operand cube = boxed(&b, 0, 0, 0, 0);
    lap_arrangement *a = NULL;
    const lap_complex *complex = NULL;
    const int64_t *first = NULL;
    const int32_t *kinds = NULL, *ids = NULL, *operands = NULL, *triangles = NULL;
    int64_t count = 0, i, on_planes = 0;
    STATUS_IN(context, LAP_OK, lap_arrangement_new_half_spaces(context, 1, &cube, 3, planes, NULL, NULL, &a));
    surface_is(context, a, "0 & 1", "4/3");
    surface_is(context, a, "0 - 1", "20/3");
    surface_is(context, a, "0 & 2", "1/6");
    surface_is(context, a, "0 & 3", "8");
    surface_is(context, a, "0 - 3", "0");
    surface_is(context, a, "0 & 1 & 2", "19/162");
    STATUS(LAP_OK, lap_arrangement_operands(a, &count, NULL, &first, NULL));
    CHECK(count == 4 && first[1] == 12 && first[2] == 25 && first[4] == 51);
    STATUS(LAP_OK, lap_arrangement_face_births(a, &count, NULL, &operands, &triangles, NULL));
    STATUS(LAP_OK, lap_arrangement_vertex_origins(a, &count, &kinds, &ids));
    for (i = 0; i < count; ++i) CHECK(kinds[i] >= LAP_VERTEX_MESH && kinds[i] <= LAP_VERTEX_TRIANGLES_PLANE);
    STATUS_IN(context, LAP_OK, lap_arrangement_complex(context, a, &complex));
    STATUS_IN(context, LAP_OK, lap_complex_check(context, complex));
    STATUS(LAP_OK, lap_complex_face_supports(complex, &count, &kinds, &ids, NULL, NULL));
    for (i = 0; i < count; ++i) {
        on_planes += kinds[i] == LAP_SUPPORT_PLANE;
        CHECK(kinds[i] == LAP_SUPPORT_PLANE ? ids[i] >= 0 && ids[i] < 3 : ids[i] >= 0 && ids[i] < 51);
    }
    CHECK(on_planes > 3);
    STATUS(LAP_OK, lap_arrangement_free(a));

    /* Within bounds alone. */
    STATUS_IN(context, LAP_OK, lap_arrangement_new_half_spaces(context, 0, NULL, 3, planes, bounds, NULL, &a));
    surface_is(context, a, "0", "48");
    surface_is(context, a, "2", "108");
    STATUS(LAP_OK, lap_arrangement_free(a));

    a = (lap_arrangement *)&a;
    STATUS(LAP_ERR_BAD_PLANE, lap_arrangement_new_half_spaces(context, 1, &cube, 2, bad, NULL, NULL, &a));
    CHECK(a == NULL && has_message(context));
    STATUS(LAP_OK, lap_context_last_defects(context, &count, &kinds, NULL));
    CHECK(count == 1 && kinds[0] == LAP_DEFECT_ZERO_NORMAL);
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_new_half_spaces(context, 0, NULL, 3, planes, NULL, NULL, &a));
    bounds[3] = -1;
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_new_half_spaces(context, 1, &cube, 3, planes, bounds, NULL, &a));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_new_half_spaces(context, 1, &cube, -1, planes, NULL, NULL, &a));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_new_half_spaces(context, 1, &cube, 1, NULL, NULL, NULL, &a));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_new_half_spaces(context, 1, &cube, 3, planes, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_new_half_spaces(NULL, 1, &cube, 3, planes, NULL, NULL, &a));
    CHECK(has_message(context));
}

static void null_pointers(lap_context *context)
{
    const double xyz[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const double values[4] = {-1, 1, 1, 1};
    const int32_t tet[4] = {0, 1, 2, 3};
    const lap_complex *complex = NULL;
    lap_network *network = NULL;
    lap_surface *surface = NULL;
    const char *text = NULL;
    double volume = 0;
    int64_t count = 0, euler = 0;

    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_counts(NULL, NULL, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_operands(NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_vertices(NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_vertex_origins(NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_vertex_exact(context, NULL, 0, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_faces(NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_face_births(NULL, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_patches(NULL, NULL, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_cells(NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_cell_volumes(NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_cell_volume_exact(context, NULL, 0, &text));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_stage_count(NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_stage(NULL, 0, NULL, NULL));
    STATUS(LAP_OK, lap_arrangement_free(NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_surface_triangles(NULL, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_surface_euler(NULL, &euler));
    STATUS(LAP_ERR_NULL_POINTER, lap_surface_volume(NULL, &volume));
    STATUS(LAP_ERR_NULL_POINTER, lap_surface_volume_exact(context, NULL, &text));

    /* The surface of a network has no operands, and no exact volume. A corner of a tetrahedron cut off: a triangle. */
    STATUS_IN(context, LAP_OK, lap_network_new_tets(context, 4, xyz, 1, tet, 1, values, 4, 1, NULL, &network));
    STATUS_IN(context, LAP_OK, lap_network_csg(context, network, "0", 0, &surface));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_surface_triangles(surface, &count, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_surface_volume(surface, &volume));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_surface_volume_exact(context, surface, &text));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_surface_complex(context, surface, &complex));
    CHECK(has_message(context));
    STATUS(LAP_OK, lap_surface_euler(surface, &euler));
    CHECK(euler == 1);
    STATUS(LAP_ERR_NULL_POINTER, lap_surface_euler(surface, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_surface_volume(surface, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_surface_volume_exact(context, surface, NULL));
    STATUS(LAP_OK, lap_surface_free(surface));
    STATUS(LAP_OK, lap_network_free(network));
}

void test_arrangement(void)
{
    lap_context *context = NULL;
    STATUS(LAP_OK, lap_context_new(&context));
    options(context);
    bad_input(context);
    nothing(context);
    crossing(context);
    touching(context);
    expressions(context);
    complexes(context);
    half_spaces(context);
    null_pointers(context);
    STATUS(LAP_OK, lap_context_free(context));
    test_arrangement_callbacks();
}
