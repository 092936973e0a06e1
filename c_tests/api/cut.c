/* lap_cut_*: options, bad planes, what a cut knows besides its complex. */
#include "api.h"

#include <math.h>
#include <string.h>

static void bad_planes(lap_context *context, const lap_mesh *mesh)
{
    const double planes[16] = {1, 0, 0, -1, 0, NAN, 0, -1, 0, 0, 0, 1, 0, 0, 1, INFINITY};
    const double huge[4] = {1e308, 1e308, 1e308, -1.5e308};
    lap_cut *cut = (lap_cut *)&cut;
    int64_t count = 0;

    STATUS(LAP_ERR_BAD_PLANE, lap_cut_new(context, mesh, 4, planes, NULL, &cut));
    CHECK(cut == NULL && has_message(context));
    CHECK(has_defect(context, LAP_DEFECT_NON_FINITE_PLANE, 1, -1, -1));
    CHECK(has_defect(context, LAP_DEFECT_ZERO_NORMAL, 2, -1, -1));
    CHECK(has_defect(context, LAP_DEFECT_NON_FINITE_PLANE, 3, -1, -1));
    STATUS(LAP_OK, lap_context_last_defects(context, &count, NULL, NULL));
    CHECK(count == 3);

    STATUS(LAP_ERR_NULL_POINTER, lap_cut_new(NULL, mesh, 1, planes, NULL, &cut));
    STATUS(LAP_ERR_NULL_POINTER, lap_cut_new(context, NULL, 1, planes, NULL, &cut));
    CHECK(has_message(context));
    STATUS(LAP_ERR_NULL_POINTER, lap_cut_new(context, mesh, 1, NULL, NULL, &cut));
    CHECK(has_message(context));
    STATUS(LAP_ERR_NULL_POINTER, lap_cut_new(context, mesh, 1, planes, NULL, NULL));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_cut_new(context, mesh, -1, planes, NULL, &cut));
    CHECK(has_message(context));
    STATUS(LAP_ERR_TOO_LARGE, lap_cut_new(context, mesh, INT64_C(1) << 40, planes, NULL, &cut));
    CHECK(cut == NULL && has_message(context));

    /* Coefficients at the end of the range of double are fine. */
    STATUS_IN(context, LAP_OK, lap_cut_new(context, mesh, 1, huge, NULL, &cut));
    STATUS(LAP_OK, lap_cut_free(cut));
}

static void options(lap_context *context, const lap_mesh *mesh)
{
    const double plane[4] = {1, 1, 1, -2};
    lap_cut_options options;
    lap_cut *cut = NULL;

    STATUS(LAP_ERR_NULL_POINTER, lap_cut_options_init(NULL, (int32_t)sizeof options));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_cut_options_init(&options, 2));
    STATUS(LAP_OK, lap_cut_options_init(&options, (int32_t)sizeof options));
    CHECK(options.struct_size == (int32_t)sizeof options);
    options.check = 1;
    STATUS_IN(context, LAP_OK, lap_cut_new(context, mesh, 1, plane, &options, &cut));
    STATUS(LAP_OK, lap_cut_free(cut));
    options.struct_size = 1 << 20;
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_cut_new(context, mesh, 1, plane, &options, &cut));
    CHECK(cut == NULL && has_message(context));
}

static void views(lap_context *context)
{
    /* x = 1; y = 1; x = 1 again, reversed and scaled; a plane on the top face; a plane that misses. */
    const double planes[20] = {1, 0, 0, -1, 0, 1, 0, -1, -3, 0, 0, 3, 0, 0, 1, -2, 0, 0, 1, -5};
    lap_mesh *mesh = good_mesh(context, 8, cube_xyz, 12, cube_indices, cube_tags);
    lap_cut *cut = NULL;
    const lap_complex *complex = NULL;
    const int32_t *map = NULL;
    int64_t count = -1, cells = -1, faces = -1, value = -1;
    int32_t number = -1, i;
    const char *name = NULL;
    double seconds = -1;

    STATUS_IN(context, LAP_OK, lap_cut_new(context, mesh, 5, planes, NULL, &cut));
    /* A cut lives without its mesh. */
    STATUS(LAP_OK, lap_mesh_free(mesh));
    STATUS(LAP_OK, lap_cut_complex(cut, &complex));
    CHECK(complex != NULL);
    STATUS(LAP_OK, lap_complex_counts(complex, NULL, NULL, NULL, &cells, NULL, NULL, NULL));
    CHECK(cells == 4);
    STATUS(LAP_ERR_NULL_POINTER, lap_cut_complex(cut, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_cut_complex(NULL, &complex));

    STATUS(LAP_OK, lap_cut_plane_map(cut, &count, &map));
    CHECK(count == 5 && map[0] == 0 && map[1] == 1 && map[2] == 0 && map[3] == 3 && map[4] == 4);
    STATUS(LAP_OK, lap_cut_plane_map(cut, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_cut_plane_map(NULL, &count, &map));

    STATUS(LAP_OK, lap_cut_stage_count(cut, &number));
    CHECK(number > 0);
    for (i = 0; i < number; ++i) {
        STATUS(LAP_OK, lap_cut_stage(cut, i, &name, &seconds));
        CHECK(name != NULL && name[0] != 0 && seconds >= 0);
    }
    STATUS(LAP_OK, lap_cut_stage(cut, 0, NULL, NULL));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_cut_stage(cut, number, &name, &seconds));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_cut_stage(cut, -1, &name, &seconds));
    STATUS(LAP_ERR_NULL_POINTER, lap_cut_stage(NULL, 0, &name, &seconds));
    STATUS(LAP_ERR_NULL_POINTER, lap_cut_stage_count(cut, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_cut_stage_count(NULL, &number));

    STATUS(LAP_OK, lap_cut_statistic_count(cut, &number));
    CHECK(number > 0);
    for (i = 0; i < number; ++i) {
        STATUS(LAP_OK, lap_cut_statistic(cut, i, &name, &value));
        CHECK(name != NULL && name[0] != 0 && value >= 0);
    }
    STATUS(LAP_OK, lap_cut_statistic(cut, 0, NULL, NULL));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_cut_statistic(cut, number, &name, &value));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_cut_statistic(cut, INT32_MIN, &name, &value));
    STATUS(LAP_ERR_NULL_POINTER, lap_cut_statistic(NULL, 0, &name, &value));
    STATUS(LAP_ERR_NULL_POINTER, lap_cut_statistic_count(cut, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_cut_statistic_count(NULL, &number));
    STATUS(LAP_OK, lap_cut_free(cut));
    STATUS(LAP_OK, lap_cut_free(NULL));

    /* No planes: the solid itself, a face for each triangle. */
    mesh = good_mesh(context, 8, cube_xyz, 12, cube_indices, NULL);
    STATUS_IN(context, LAP_OK, lap_cut_new(context, mesh, 0, NULL, NULL, &cut));
    STATUS(LAP_OK, lap_cut_complex(cut, &complex));
    STATUS(LAP_OK, lap_complex_counts(complex, NULL, NULL, &faces, &cells, NULL, NULL, NULL));
    CHECK(cells == 1 && faces == 12);
    STATUS(LAP_OK, lap_cut_plane_map(cut, &count, &map));
    CHECK(count == 0);
    STATUS(LAP_OK, lap_cut_free(cut));
    STATUS(LAP_OK, lap_mesh_free(mesh));
}

void test_cut(void)
{
    lap_context *context = NULL;
    lap_mesh *mesh;
    STATUS(LAP_OK, lap_context_new(&context));
    mesh = good_mesh(context, 8, cube_xyz, 12, cube_indices, NULL);
    bad_planes(context, mesh);
    options(context, mesh);
    STATUS(LAP_OK, lap_mesh_free(mesh));
    views(context);
    STATUS(LAP_OK, lap_context_free(context));
}
