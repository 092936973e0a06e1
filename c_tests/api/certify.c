/* lap_certif*: options, fixed vertices, a result that needs no repair, one that does, one that may not be repaired. */
#include "api.h"

#include <string.h>

static const double tetrahedron_xyz[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
static const int32_t tetrahedron_indices[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};

static lap_certify_report report_of(const lap_certified *certified)
{
    lap_certify_report report;
    STATUS(LAP_OK, lap_certified_report(certified, &report, (int32_t)sizeof report));
    CHECK(report.struct_size == (int32_t)sizeof report);
    return report;
}

/* Nothing to repair: maps are identities, coordinates are the complex's. */
static void clean(lap_context *context)
{
    const double planes[12] = {1, 0, 0, -1, 0, 1, 0, -1, 1, 1, 1, -2.5};
    const int32_t plane = 2, bad = 3, vertex = 0;
    lap_mesh *mesh = good_mesh(context, 8, cube_xyz, 12, cube_indices, NULL);
    lap_cut *cut = NULL;
    const lap_complex *complex = NULL;
    lap_certified *certified = (lap_certified *)&certified;
    lap_certify_options options;
    lap_certify_report report;
    int64_t vertices = -1, triangles = -1, faces = -1, cells = -1, count = -1, count_f = -1, count_c = -1, of_complex = -1, i;
    const double *xyz = NULL, *exact = NULL;
    const int32_t *corners = NULL, *sides = NULL, *rows = NULL, *map_v = NULL, *map_f = NULL, *map_c = NULL;
    double sum = 0;

    STATUS_IN(context, LAP_OK, lap_cut_new(context, mesh, 3, planes, NULL, &cut));
    STATUS(LAP_OK, lap_cut_complex(cut, &complex));

    STATUS(LAP_ERR_NULL_POINTER, lap_certify_options_init(NULL, (int32_t)sizeof options));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_certify_options_init(&options, 3));
    STATUS(LAP_OK, lap_certify_options_init(&options, (int32_t)sizeof options));
    CHECK(options.struct_size == (int32_t)sizeof options && options.check_only == 0 && options.check_input == 0);

    STATUS(LAP_ERR_NULL_POINTER, lap_certified_new(NULL, complex, 0, NULL, 0, NULL, NULL, &certified));
    STATUS(LAP_ERR_NULL_POINTER, lap_certified_new(context, NULL, 0, NULL, 0, NULL, NULL, &certified));
    CHECK(certified == NULL && has_message(context));
    STATUS(LAP_ERR_NULL_POINTER, lap_certified_new(context, complex, 0, NULL, 0, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_certified_new(context, complex, 1, NULL, 0, NULL, NULL, &certified));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_certified_new(context, complex, 1, &bad, 0, NULL, NULL, &certified));
    CHECK(certified == NULL && has_message(context));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_certified_new(context, complex, 0, NULL, -1, &vertex, NULL, &certified));
    options.struct_size = 2;
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_certified_new(context, complex, 0, NULL, 0, NULL, &options, &certified));
    options.struct_size = (int32_t)sizeof options;
    options.check_input = 1;
    STATUS_IN(context, LAP_OK, lap_certified_new(context, complex, 1, &plane, 1, &vertex, &options, &certified));

    report = report_of(certified);
    CHECK(report.certified == 1 && report.open_pairs == 0 && report.open_cells == 0);
    CHECK(report.flat_before == 0 && report.contacts_before == 0 && report.volumes_before == 0);
    CHECK(report.moved_vertices == 0 && report.merged_vertices == 0 && report.removed_faces == 0 && report.removed_cells == 0);
    CHECK(report.largest_move == 0 && report.move_unit > 0 && report.move_unit < 1e-15);
    STATUS(LAP_ERR_NULL_POINTER, lap_certified_report(NULL, &report, (int32_t)sizeof report));
    STATUS(LAP_ERR_NULL_POINTER, lap_certified_report(certified, NULL, (int32_t)sizeof report));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_certified_report(certified, &report, 0));

    STATUS(LAP_OK, lap_certified_counts(certified, &vertices, &triangles, &faces, &cells));
    STATUS(LAP_OK, lap_certified_counts(certified, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_certified_counts(NULL, &vertices, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_complex_counts(complex, &of_complex, NULL, &count_f, &count_c, NULL, NULL, NULL));
    CHECK(vertices == of_complex && faces == count_f && cells == count_c && triangles > faces);

    STATUS(LAP_OK, lap_certified_vertices(certified, &count, &xyz));
    STATUS(LAP_OK, lap_complex_vertices(complex, NULL, &exact));
    CHECK(count == vertices && memcmp(xyz, exact, (size_t)(3 * count) * sizeof *xyz) == 0);
    STATUS(LAP_ERR_NULL_POINTER, lap_certified_vertices(NULL, &count, &xyz));

    STATUS(LAP_OK, lap_certified_triangles(certified, &count, &corners, &sides, &count_f, &rows));
    CHECK(count == triangles && count_f == faces && rows[0] == 0 && rows[faces] == triangles);
    for (i = 0; i < count; ++i) {
        CHECK(sides[2 * i] >= 0 && sides[2 * i] < cells && sides[2 * i + 1] >= -1 && sides[2 * i + 1] < cells);
        if (sides[2 * i + 1] < 0) {
            /* Six times the solid's volume, from its surface. */
            const double *a = xyz + 3 * corners[3 * i], *b = xyz + 3 * corners[3 * i + 1], *c = xyz + 3 * corners[3 * i + 2];
            sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
        }
    }
    CHECK(sum > 47.999 && sum < 48.001);
    STATUS(LAP_ERR_NULL_POINTER, lap_certified_triangles(NULL, &count, NULL, NULL, NULL, NULL));

    STATUS(LAP_OK, lap_certified_maps(certified, &count, &map_v, &count_f, &map_f, &count_c, &map_c));
    CHECK(count == vertices && count_f == faces && count_c == cells);
    for (i = 0; i < count; ++i) CHECK(map_v[i] == i);
    for (i = 0; i < count_f; ++i) CHECK(map_f[i] == i);
    for (i = 0; i < count_c; ++i) CHECK(map_c[i] == i);
    STATUS(LAP_ERR_NULL_POINTER, lap_certified_maps(NULL, &count, NULL, NULL, NULL, NULL, NULL));

    STATUS(LAP_OK, lap_certified_open(certified, &count, NULL, &count_c, NULL));
    CHECK(count == 0 && count_c == 0);
    STATUS(LAP_ERR_NULL_POINTER, lap_certified_open(NULL, &count, NULL, NULL, NULL));

    /* What was certified lives without the complex. */
    STATUS(LAP_OK, lap_cut_free(cut));
    STATUS(LAP_OK, lap_mesh_free(mesh));
    STATUS(LAP_OK, lap_certified_vertices(certified, NULL, &xyz));
    CHECK(xyz[0] == 0);
    STATUS(LAP_OK, lap_certified_free(certified));
    STATUS(LAP_OK, lap_certified_free(NULL));
}

/* A tetrahedron's slanted face and three planes nearly meet in a point at many places: cells less than an ulp wide. */
static void repaired(lap_context *context)
{
    double planes[4 * 30];
    int32_t all[1024];
    lap_mesh *mesh = good_mesh(context, 4, tetrahedron_xyz, 4, tetrahedron_indices, NULL);
    lap_cut *cut = NULL;
    const lap_complex *complex = NULL;
    lap_certified *certified = NULL;
    lap_certify_options options;
    lap_certify_report report;
    const int32_t *pairs = NULL, *map_c = NULL, *map_v = NULL;
    int64_t vertices = 0, faces = 0, cells = 0, n = 0, gone = 0, i;
    const double *xyz = NULL, *exact = NULL;

    memset(planes, 0, sizeof planes);
    for (i = 0; i < 30; ++i) {
        planes[4 * i + i / 10] = 1;
        planes[4 * i + 3] = -(double)(i % 10) / 9;
    }
    STATUS_IN(context, LAP_OK, lap_cut_new(context, mesh, 30, planes, NULL, &cut));
    STATUS(LAP_OK, lap_cut_complex(cut, &complex));
    STATUS(LAP_OK, lap_complex_counts(complex, &vertices, NULL, &faces, &cells, NULL, NULL, NULL));

    STATUS(LAP_OK, lap_certify_options_init(&options, (int32_t)sizeof options));
    options.check_only = 1;
    STATUS_IN(context, LAP_OK, lap_certified_new(context, complex, 0, NULL, 0, NULL, &options, &certified));
    report = report_of(certified);
    CHECK(report.certified == 0 && report.open_pairs > 0 && report.flat_before > 0 && report.contacts_before > 0);
    CHECK(report.moved_vertices == 0 && report.removed_cells == 0);
    STATUS(LAP_OK, lap_certified_open(certified, &n, &pairs, NULL, NULL));
    CHECK(n == report.open_pairs);
    for (i = 0; i < n; ++i) CHECK(pairs[2 * i] >= 0 && pairs[2 * i] <= pairs[2 * i + 1] && pairs[2 * i + 1] < faces);
    STATUS(LAP_OK, lap_certified_free(certified));

    STATUS_IN(context, LAP_OK, lap_certified_new(context, complex, 0, NULL, 0, NULL, NULL, &certified));
    report = report_of(certified);
    CHECK(report.certified == 1 && report.open_pairs == 0 && report.removed_cells > 0 && report.merged_vertices > 0);
    CHECK(report.largest_move < 16 * report.move_unit && report.moved_mesh_vertices == 0);
    STATUS(LAP_OK, lap_certified_maps(certified, NULL, NULL, NULL, NULL, &n, &map_c));
    CHECK(n == cells);
    for (i = 0; i < n; ++i) gone += map_c[i] < 0;
    CHECK(gone == report.removed_cells);
    STATUS(LAP_OK, lap_certified_free(certified));

    /* With all vertices fixed nothing can be mended that needs more than another diagonal, and nothing moves. */
    CHECK(vertices <= 1024);
    for (i = 0; i < vertices; ++i) all[i] = (int32_t)i;
    STATUS_IN(context, LAP_OK, lap_certified_new(context, complex, 0, NULL, vertices, all, NULL, &certified));
    report = report_of(certified);
    CHECK(report.certified == 0 && report.open_pairs > 0 && report.moved_vertices == 0 && report.removed_cells == 0);
    STATUS(LAP_OK, lap_certified_vertices(certified, &n, &xyz));
    STATUS(LAP_OK, lap_complex_vertices(complex, NULL, &exact));
    STATUS(LAP_OK, lap_certified_maps(certified, NULL, &map_v, NULL, NULL, NULL, NULL));
    CHECK(n == vertices && memcmp(xyz, exact, (size_t)(3 * n) * sizeof *xyz) == 0 && map_v[n - 1] == n - 1);
    STATUS(LAP_OK, lap_certified_free(certified));
    STATUS(LAP_OK, lap_cut_free(cut));
    STATUS(LAP_OK, lap_mesh_free(mesh));
}

void test_certify(void)
{
    lap_context *context = NULL;
    STATUS(LAP_OK, lap_context_new(&context));
    clean(context);
    repaired(context);
    STATUS(LAP_OK, lap_context_free(context));
}
