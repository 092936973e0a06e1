/* lap_mesh_*: options, every kind of defect, views. */
#include "api.h"

#include <math.h>
#include <string.h>

/* A mesh that must be refused with this defect. */
static void refused(lap_context *context, int64_t n_vertices, const double *xyz, int64_t n_triangles,
                    const int32_t *indices, int32_t kind, int64_t a, int64_t b, int64_t c)
{
    lap_mesh *mesh = (lap_mesh *)&mesh;
    lap_mesh_options options;
    int64_t count = -1;
    STATUS(LAP_OK, lap_mesh_options_init(&options, (int32_t)sizeof options));
    options.check_self_intersection = 1;
    STATUS_IN(context, LAP_ERR_BAD_MESH,
              lap_mesh_new(context, n_vertices, xyz, n_triangles, indices, NULL, &options, &mesh));
    CHECK(mesh == NULL);
    CHECK(has_message(context));
    CHECK(has_defect(context, kind, a, b, c));
    STATUS_IN(context, LAP_ERR_BAD_MESH,
              lap_mesh_validate(context, n_vertices, xyz, n_triangles, indices, NULL, &count));
    CHECK(count > 0);
    CHECK(has_message(context));
    CHECK(has_defect(context, kind, a, b, c));
}

static void options(lap_context *context)
{
    /* As an older or newer program would have it. */
    struct {
        lap_mesh_options known;
        int32_t unknown;
    } newer;
    lap_mesh_options options;
    lap_mesh *mesh = NULL;

    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_options_init(NULL, (int32_t)sizeof options));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_mesh_options_init(&options, 0));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_mesh_options_init(&options, -4));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_mesh_options_init(&options, 7));
    STATUS(LAP_OK, lap_mesh_options_init(&options, (int32_t)sizeof options));
    CHECK(options.struct_size == (int32_t)sizeof options);
    CHECK(options.check_self_intersection == 0 && options.merge_duplicate_vertices == 0);

    /* An older program's shorter struct: nothing is written or read past its end. */
    options.check_self_intersection = 12345;
    STATUS(LAP_OK, lap_mesh_options_init(&options, 8));
    CHECK(options.struct_size == 8 && options.check_self_intersection == 12345);
    STATUS_IN(context, LAP_OK, lap_mesh_new(context, 8, cube_xyz, 12, cube_indices, NULL, &options, &mesh));
    STATUS(LAP_OK, lap_mesh_free(mesh));

    /* A newer program's longer struct: fine as long as what we do not know is not set. */
    STATUS(LAP_OK, lap_mesh_options_init(&newer.known, (int32_t)sizeof newer));
    CHECK(newer.unknown == 0);
    STATUS_IN(context, LAP_OK, lap_mesh_new(context, 8, cube_xyz, 12, cube_indices, NULL, &newer.known, &mesh));
    STATUS(LAP_OK, lap_mesh_free(mesh));
    newer.unknown = 1;
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_mesh_new(context, 8, cube_xyz, 12, cube_indices, NULL, &newer.known, &mesh));
    CHECK(mesh == NULL && has_message(context));

    options.struct_size = 3;
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_mesh_new(context, 8, cube_xyz, 12, cube_indices, NULL, &options, &mesh));
    options.struct_size = -8;
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_mesh_new(context, 8, cube_xyz, 12, cube_indices, NULL, &options, &mesh));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_mesh_validate(context, 8, cube_xyz, 12, cube_indices, &options, NULL));
}

static void arguments(lap_context *context)
{
    lap_mesh *mesh = (lap_mesh *)&mesh;
    int64_t count = -1;

    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_new(NULL, 8, cube_xyz, 12, cube_indices, NULL, NULL, &mesh));
    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_new(context, 8, cube_xyz, 12, cube_indices, NULL, NULL, NULL));
    CHECK(has_message(context));
    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_new(context, 8, NULL, 12, cube_indices, NULL, NULL, &mesh));
    CHECK(mesh == NULL && has_message(context));
    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_new(context, 8, cube_xyz, 12, NULL, NULL, NULL, &mesh));
    CHECK(has_message(context));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_mesh_new(context, -8, cube_xyz, 12, cube_indices, NULL, NULL, &mesh));
    CHECK(has_message(context));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_mesh_new(context, 8, cube_xyz, -12, cube_indices, NULL, NULL, &mesh));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_mesh_new(context, 8, cube_xyz, INT64_MIN, cube_indices, NULL, NULL, &mesh));
    STATUS(LAP_ERR_TOO_LARGE, lap_mesh_new(context, INT64_C(1) << 31, cube_xyz, 12, cube_indices, NULL, NULL, &mesh));
    CHECK(has_message(context));
    STATUS(LAP_ERR_TOO_LARGE, lap_mesh_new(context, 8, cube_xyz, INT64_MAX, cube_indices, NULL, NULL, &mesh));
    CHECK(mesh == NULL);

    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_validate(NULL, 8, cube_xyz, 12, cube_indices, NULL, &count));
    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_validate(context, 8, NULL, 12, cube_indices, NULL, &count));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_mesh_validate(context, 8, cube_xyz, -1, cube_indices, NULL, &count));
    STATUS(LAP_OK, lap_mesh_validate(context, 8, cube_xyz, 12, cube_indices, NULL, &count));
    CHECK(count == 0);
    STATUS(LAP_OK, lap_mesh_validate(context, 8, cube_xyz, 12, cube_indices, NULL, NULL));
    STATUS(LAP_OK, lap_mesh_free(NULL));
}

static void defects(lap_context *context)
{
    double xyz[48];
    int32_t indices[72];
    int i;
    lap_mesh *mesh = NULL;

    /* No triangles. */
    refused(context, 0, NULL, 0, NULL, LAP_DEFECT_EMPTY, -1, -1, -1);
    refused(context, 8, cube_xyz, 0, cube_indices, LAP_DEFECT_EMPTY, -1, -1, -1);

    memcpy(xyz, cube_xyz, sizeof cube_xyz);
    xyz[3 * 6 + 2] = -INFINITY;
    refused(context, 8, xyz, 12, cube_indices, LAP_DEFECT_NON_FINITE_COORDINATE, 6, -1, -1);

    memcpy(indices, cube_indices, sizeof cube_indices);
    indices[3 * 4 + 1] = 8;
    refused(context, 8, cube_xyz, 12, indices, LAP_DEFECT_INDEX_OUT_OF_RANGE, 4, 1, 8);
    indices[3 * 4 + 1] = -1;
    refused(context, 8, cube_xyz, 12, indices, LAP_DEFECT_INDEX_OUT_OF_RANGE, 4, 1, -1);
    indices[3 * 4 + 1] = INT32_MIN;
    refused(context, 8, cube_xyz, 12, indices, LAP_DEFECT_INDEX_OUT_OF_RANGE, 4, 1, INT32_MIN);

    /* Two equal corners; three corners on a line. */
    memcpy(indices, cube_indices, sizeof cube_indices);
    indices[3 * 2 + 1] = indices[3 * 2];
    refused(context, 8, cube_xyz, 12, indices, LAP_DEFECT_DEGENERATE_TRIANGLE, 2, -1, -1);
    memcpy(xyz, cube_xyz, sizeof cube_xyz);
    xyz[0] = xyz[1] = xyz[2] = 1;
    xyz[3 * 4] = xyz[3 * 4 + 1] = xyz[3 * 4 + 2] = 0; /* triangle 10 is 3, 0, 4 */
    xyz[3 * 3] = xyz[3 * 3 + 1] = xyz[3 * 3 + 2] = 3;
    refused(context, 8, xyz, 12, cube_indices, LAP_DEFECT_DEGENERATE_TRIANGLE, 10, -1, -1);

    /* A triangle left out; one turned round; all turned round. */
    refused(context, 8, cube_xyz, 11, cube_indices, LAP_DEFECT_OPEN_EDGE, -2, -2, -2);
    refused(context, 8, cube_xyz, 1, cube_indices, LAP_DEFECT_OPEN_EDGE, -2, -2, 0);
    memcpy(indices, cube_indices, sizeof cube_indices);
    indices[0] = cube_indices[1];
    indices[1] = cube_indices[0];
    refused(context, 8, cube_xyz, 12, indices, LAP_DEFECT_INCONSISTENT_ORIENTATION, -2, -2, -2);
    for (i = 0; i < 36; i += 3) {
        indices[i] = cube_indices[i + 1];
        indices[i + 1] = cube_indices[i];
        indices[i + 2] = cube_indices[i + 2];
    }
    refused(context, 8, cube_xyz, 12, indices, LAP_DEFECT_WRONG_NESTING, -2, -1, -1);

    /* A solid inside a solid: the inner surface ought to be turned inward. */
    memcpy(indices, hollow_indices, sizeof hollow_indices);
    for (i = 36; i < 72; i += 3) {
        indices[i] = hollow_indices[i + 1];
        indices[i + 1] = hollow_indices[i];
    }
    refused(context, 16, hollow_xyz, 24, indices, LAP_DEFECT_WRONG_NESTING, -2, -1, -1);

    /* Two cubes that overlap: found if asked for only, and never a crash. */
    for (i = 0; i < 24; ++i) {
        xyz[i] = cube_xyz[i];
        xyz[24 + i] = cube_xyz[i] + 1;
    }
    for (i = 0; i < 36; ++i) {
        indices[i] = cube_indices[i];
        indices[36 + i] = cube_indices[i] + 8;
    }
    refused(context, 16, xyz, 24, indices, LAP_DEFECT_SELF_INTERSECTION, -2, -2, -1);
    i = lap_mesh_new(context, 16, xyz, 24, indices, NULL, NULL, &mesh);
    CHECK(i == LAP_OK || i == LAP_ERR_BAD_MESH || i == LAP_ERR_INCONSISTENT);
    CHECK((i == LAP_OK) == (mesh != NULL));
    STATUS(LAP_OK, lap_mesh_free(mesh));
}

static void views(lap_context *context)
{
    lap_mesh *mesh;
    lap_mesh_options options;
    int64_t n[5] = {-1, -1, -1, -1, -1}, count = -1, euler = -1;
    const double *bounds = NULL, *xyz = NULL;
    const int32_t *sources = NULL, *vertices = NULL, *tags = NULL;
    const char *exact = NULL;
    double volume = -1, loose_xyz[27], split_xyz[27];
    int32_t indices[36];
    int i;

    mesh = good_mesh(context, 8, cube_xyz, 12, cube_indices, cube_tags);
    STATUS(LAP_OK, lap_mesh_counts(mesh, &n[0], &n[1], &n[2], &n[3], &n[4]));
    CHECK(n[0] == 8 && n[1] == 12 && n[2] == 18 && n[3] == 1 && n[4] == 1);
    STATUS(LAP_OK, lap_mesh_counts(mesh, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_counts(NULL, &n[0], NULL, NULL, NULL, NULL));

    STATUS(LAP_OK, lap_mesh_bounds(mesh, &bounds));
    CHECK(bounds[0] == 0 && bounds[1] == 0 && bounds[2] == 0 && bounds[3] == 2 && bounds[4] == 2 && bounds[5] == 2);
    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_bounds(mesh, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_bounds(NULL, &bounds));

    STATUS(LAP_OK, lap_mesh_vertices(mesh, &count, &xyz, &sources));
    CHECK(count == 8 && memcmp(xyz, cube_xyz, sizeof cube_xyz) == 0);
    for (i = 0; i < 8; ++i) CHECK(sources[i] == i);
    STATUS(LAP_OK, lap_mesh_vertices(mesh, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_vertices(NULL, &count, &xyz, &sources));

    STATUS(LAP_OK, lap_mesh_triangles(mesh, &count, &vertices, &tags));
    CHECK(count == 12 && memcmp(vertices, cube_indices, sizeof cube_indices) == 0);
    CHECK(memcmp(tags, cube_tags, sizeof cube_tags) == 0);
    STATUS(LAP_OK, lap_mesh_triangles(mesh, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_triangles(NULL, &count, &vertices, &tags));

    STATUS(LAP_OK, lap_mesh_volume(mesh, &volume));
    CHECK(volume == 8);
    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_volume(mesh, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_volume(NULL, &volume));
    STATUS_IN(context, LAP_OK, lap_mesh_volume_exact(context, mesh, &exact));
    CHECK(exact != NULL && strcmp(exact, "8") == 0);
    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_volume_exact(context, mesh, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_volume_exact(context, NULL, &exact));
    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_volume_exact(NULL, mesh, &exact));
    STATUS(LAP_OK, lap_mesh_euler(mesh, &euler));
    CHECK(euler == 1);
    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_euler(mesh, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_euler(NULL, &euler));
    STATUS(LAP_OK, lap_mesh_free(mesh));

    /* A void; no tags. */
    mesh = good_mesh(context, 16, hollow_xyz, 24, hollow_indices, NULL);
    STATUS(LAP_OK, lap_mesh_counts(mesh, &n[0], &n[1], &n[2], &n[3], &n[4]));
    CHECK(n[0] == 16 && n[1] == 24 && n[2] == 36 && n[3] == 2 && n[4] == 2);
    STATUS(LAP_OK, lap_mesh_euler(mesh, &euler));
    CHECK(euler == 2);
    STATUS(LAP_OK, lap_mesh_volume(mesh, &volume));
    CHECK(volume == 56);
    STATUS(LAP_OK, lap_mesh_triangles(mesh, NULL, NULL, &tags));
    CHECK(tags == NULL);
    STATUS(LAP_OK, lap_mesh_free(mesh));

    /* A vertex in front that no triangle uses is left out, and the sources say which stay. Thirds: an exact volume with a
       denominator. */
    for (i = 0; i < 27; ++i) loose_xyz[i] = i < 3 ? 77 : cube_xyz[i - 3] / 4;
    for (i = 0; i < 36; ++i) indices[i] = cube_indices[i] + 1;
    mesh = good_mesh(context, 9, loose_xyz, 12, indices, NULL);
    STATUS(LAP_OK, lap_mesh_vertices(mesh, &count, &xyz, &sources));
    CHECK(count == 8 && sources[0] == 1 && sources[7] == 8);
    STATUS_IN(context, LAP_OK, lap_mesh_volume_exact(context, mesh, &exact));
    CHECK(strcmp(exact, "1/8") == 0);
    STATUS(LAP_OK, lap_mesh_free(mesh));

    /* A vertex given twice is a defect, unless duplicates are merged. */
    memcpy(split_xyz, cube_xyz, sizeof cube_xyz);
    memcpy(split_xyz + 24, cube_xyz, 3 * sizeof(double));
    memcpy(indices, cube_indices, sizeof cube_indices);
    indices[0] = 8;
    STATUS(LAP_ERR_BAD_MESH, lap_mesh_new(context, 9, split_xyz, 12, indices, NULL, NULL, &mesh));
    CHECK(has_defect(context, LAP_DEFECT_DUPLICATE_VERTEX, 0, 8, -1));
    STATUS(LAP_OK, lap_mesh_options_init(&options, (int32_t)sizeof options));
    options.merge_duplicate_vertices = 1;
    STATUS_IN(context, LAP_OK, lap_mesh_new(context, 9, split_xyz, 12, indices, NULL, &options, &mesh));
    STATUS(LAP_OK, lap_mesh_counts(mesh, &n[0], NULL, NULL, NULL, NULL));
    CHECK(n[0] == 8);
    STATUS(LAP_OK, lap_mesh_free(mesh));
}

static void moved_coordinates(lap_context *context)
{
    const double planes[4] = {1, 0, 0, -2};
    double xyz[48], bad[48];
    const double *held = NULL, *bounds = NULL;
    const char *exact = NULL;
    const lap_complex *complex = NULL;
    double volume = 0;
    int64_t cells = 0;
    lap_cut *cut = NULL;
    lap_mesh *mesh = good_mesh(context, 16, hollow_xyz, 24, hollow_indices, NULL);
    int i;
    for (i = 0; i < 48; ++i) bad[i] = xyz[i] = 2 * hollow_xyz[i];
    STATUS(LAP_OK, lap_mesh_volume(mesh, &volume));
    CHECK(volume == 56);

    /* A cut keeps the mesh that it was made from. */
    STATUS_IN(context, LAP_OK, lap_cut_new(context, mesh, 1, planes, NULL, &cut));
    STATUS_IN(context, LAP_OK, lap_mesh_update_coordinates(context, mesh, 16, xyz, NULL));
    STATUS(LAP_OK, lap_mesh_volume(mesh, &volume));
    CHECK(volume == 448);
    STATUS_IN(context, LAP_OK, lap_mesh_volume_exact(context, mesh, &exact));
    CHECK(strcmp(exact, "448") == 0);
    STATUS(LAP_OK, lap_mesh_bounds(mesh, &bounds));
    CHECK(bounds[0] == 0 && bounds[5] == 8);
    STATUS(LAP_OK, lap_cut_complex(cut, &complex));
    STATUS(LAP_OK, lap_complex_counts(complex, NULL, NULL, NULL, &cells, NULL, NULL, NULL));
    CHECK(cells == 2);
    STATUS(LAP_OK, lap_complex_check(context, complex));
    STATUS(LAP_OK, lap_cut_free(cut));

    /* The mesh is as good as a new one. */
    STATUS_IN(context, LAP_OK, lap_cut_new(context, mesh, 1, planes, NULL, &cut));
    STATUS(LAP_OK, lap_cut_free(cut));

    /* After an error it is as it was. */
    bad[4] = NAN;
    STATUS_IN(context, LAP_ERR_BAD_MESH, lap_mesh_update_coordinates(context, mesh, 16, bad, NULL));
    CHECK(has_defect(context, LAP_DEFECT_NON_FINITE_COORDINATE, 1, -1, -1));
    STATUS_IN(context, LAP_ERR_BAD_ARGUMENT, lap_mesh_update_coordinates(context, mesh, 15, xyz, NULL));
    STATUS_IN(context, LAP_ERR_NULL_POINTER, lap_mesh_update_coordinates(context, mesh, 16, NULL, NULL));
    STATUS_IN(context, LAP_ERR_NULL_POINTER, lap_mesh_update_coordinates(context, NULL, 16, xyz, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_update_coordinates(NULL, mesh, 16, xyz, NULL));
    STATUS(LAP_OK, lap_mesh_vertices(mesh, NULL, &held, NULL));
    CHECK(memcmp(held, xyz, sizeof xyz) == 0);
    STATUS(LAP_OK, lap_mesh_free(mesh));
}

static void places(lap_context *context)
{
    /* A cube [0, 4]^3 with a void [1, 3]^3: in the wall, in the void, on both surfaces, on a line with edges, far away. */
    const double points[24] = {0.5, 1, 1, 2, 2, 2, 4, 4, 4, 1, 2, 2, -1, 0, 0, -1, 1, 1, 3.5, 3, 3, 1e300, -1e300, 0};
    const int32_t expected[8] = {LAP_PLACE_INSIDE,  LAP_PLACE_OUTSIDE, LAP_PLACE_SURFACE, LAP_PLACE_SURFACE,
                                 LAP_PLACE_OUTSIDE, LAP_PLACE_OUTSIDE, LAP_PLACE_INSIDE,  LAP_PLACE_OUTSIDE};
    const double bad[6] = {0, 0, 0, 1, -INFINITY, 1};
    const int32_t *found = NULL;
    const char *message = NULL;
    lap_mesh *mesh = good_mesh(context, 16, hollow_xyz, 24, hollow_indices, NULL);

    STATUS_IN(context, LAP_OK, lap_mesh_locate(context, mesh, 8, points, &found));
    CHECK(found != NULL && memcmp(found, expected, sizeof expected) == 0);
    STATUS(LAP_OK, lap_mesh_locate(context, mesh, 0, NULL, &found));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_mesh_locate(context, mesh, 2, bad, &found));
    STATUS(LAP_OK, lap_context_last_error(context, NULL, &message));
    CHECK(strstr(message, "point 1") != NULL);
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_mesh_locate(context, mesh, -1, points, &found));
    STATUS(LAP_ERR_TOO_LARGE, lap_mesh_locate(context, mesh, INT64_C(1) << 31, points, &found));
    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_locate(context, mesh, 1, NULL, &found));
    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_locate(context, mesh, 1, points, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_locate(context, NULL, 1, points, &found));
    STATUS(LAP_ERR_NULL_POINTER, lap_mesh_locate(NULL, mesh, 1, points, &found));
    STATUS(LAP_OK, lap_mesh_free(mesh));
}

void test_mesh(void)
{
    lap_context *context = NULL;
    STATUS(LAP_OK, lap_context_new(&context));
    options(context);
    arguments(context);
    defects(context);
    views(context);
    moved_coordinates(context);
    places(context);
    STATUS(LAP_OK, lap_context_free(context));
}
