/* lap_surface_certif*: options, a surface that needs no repair, a chain of booleans that do, cancelling. */
#include "arrangement.h"

#include <string.h>

static lap_surface *extracted(lap_context *context, const lap_arrangement *a, int32_t operation)
{
    lap_surface *surface = NULL;
    STATUS_IN(context, LAP_OK, lap_arrangement_extract(context, a, operation, 1, &surface));
    return surface;
}

static lap_surface_certify_report report_of(const lap_surface *certified)
{
    lap_surface_certify_report report;
    int64_t open = -1;
    STATUS(LAP_OK, lap_surface_certified_report(certified, &report, (int32_t)sizeof report));
    CHECK(report.struct_size == (int32_t)sizeof report);
    STATUS(LAP_OK, lap_surface_certified_open(certified, &open, NULL));
    CHECK(open == report.open_pairs);
    return report;
}

/* A box seen from somewhere: its sides are parallel to nothing, and its corners are rounded. */
static lap_operand turned(box *b, double x, double y, double z)
{
    static const double m[9] = {2, -1, 2, 2, 2, -1, -1, 2, 2};
    const lap_operand o = boxed(b, x, y, z, 0);
    int v, i;
    for (v = 0; v < 8; ++v) {
        double p[3];
        for (i = 0; i < 3; ++i)
            p[i] = (m[3 * i] * b->xyz[3 * v] + m[3 * i + 1] * b->xyz[3 * v + 1] + m[3 * i + 2] * b->xyz[3 * v + 2]) / 3;
        memcpy(b->xyz + 3 * v, p, sizeof p);
    }
    return o;
}

static lap_operand operand_of(const lap_surface *surface)
{
    lap_operand o;
    memset(&o, 0, sizeof o);
    STATUS(LAP_OK, lap_surface_vertices(surface, &o.n_vertices, &o.xyz, NULL));
    STATUS(LAP_OK, lap_surface_triangles(surface, &o.n_triangles, &o.indices, NULL, NULL, NULL));
    return o;
}

/* Solid by the check of meshes, which knows nothing of arrangements; arranged again nothing meets, and it is what is inside. */
static void is_certified(lap_context *context, const lap_surface *certified)
{
    const lap_surface_certify_report r = report_of(certified);
    const lap_operand o = operand_of(certified);
    lap_arrangement *again = NULL;
    lap_surface *inside = NULL;
    int64_t pairs = -1, cells = 0, vertices = 0, triangles = 0, i;
    const int32_t *offsets = NULL, *windings = NULL;
    const char *volume = NULL;
    char kept[1 << 14];

    CHECK(r.certified == 1 && r.open_pairs == 0 && r.triangles_after == o.n_triangles && r.rounds > 0);
    CHECK((r.moved_vertices == 0 || r.largest_move > 0) && r.largest_move <= 64 * r.move_unit && r.move_unit > 0);
    STATUS_IN(context, LAP_OK, lap_mesh_validate(context, o.n_vertices, o.xyz, o.n_triangles, o.indices, NULL, NULL));
    again = arranged(context, 1, &o);
    STATUS(LAP_OK, lap_arrangement_counts(again, &vertices, NULL, NULL, &cells, &pairs, NULL));
    CHECK(pairs == 0 && vertices == o.n_vertices);
    STATUS(LAP_OK, lap_arrangement_cells(again, NULL, &offsets, NULL, &windings));
    for (i = 0; i < offsets[cells]; ++i) CHECK(windings[i] == 1);
    inside = extracted(context, again, LAP_EXTRACT_RESOLVE);
    STATUS(LAP_OK, lap_surface_triangles(inside, &triangles, NULL, NULL, NULL, NULL));
    CHECK(triangles == o.n_triangles);
    STATUS_IN(context, LAP_OK, lap_surface_volume_exact(context, inside, &volume));
    CHECK(strlen(volume) < sizeof kept);
    strncpy(kept, volume, sizeof kept - 1);
    kept[sizeof kept - 1] = 0;
    STATUS_IN(context, LAP_OK, lap_surface_volume_exact(context, certified, &volume));
    CHECK(strcmp(volume, kept) == 0);
    STATUS(LAP_OK, lap_surface_free(inside));
    STATUS(LAP_OK, lap_arrangement_free(again));
}

static void options_and_errors(lap_context *context)
{
    lap_surface_certify_options options;
    lap_surface_certify_report report;
    box b[2];
    lap_operand two[2];
    lap_arrangement *a = NULL;
    lap_surface *surface = NULL, *certified = (lap_surface *)&certified;
    const lap_complex *complex = (const lap_complex *)&complex;
    int64_t count = 0;

    STATUS(LAP_ERR_NULL_POINTER, lap_surface_certify_options_init(NULL, (int32_t)sizeof options));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_surface_certify_options_init(&options, 5));
    STATUS(LAP_OK, lap_surface_certify_options_init(&options, (int32_t)sizeof options));
    CHECK(options.struct_size == (int32_t)sizeof options && options.check_only == 0 && options.max_rounds == 0);

    two[0] = boxed(&b[0], 0, 0, 0, 0);
    two[1] = boxed(&b[1], 1, 1, 1, 0);
    a = arranged(context, 2, two);
    surface = extracted(context, a, LAP_EXTRACT_UNION);
    STATUS(LAP_ERR_NULL_POINTER, lap_surface_certify(NULL, surface, NULL, &certified));
    STATUS(LAP_ERR_NULL_POINTER, lap_surface_certify(context, NULL, NULL, &certified));
    CHECK(certified == NULL && has_message(context));
    STATUS(LAP_ERR_NULL_POINTER, lap_surface_certify(context, surface, NULL, NULL));
    options.max_rounds = -1;
    certified = (lap_surface *)&certified;
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_surface_certify(context, surface, &options, &certified));
    CHECK(certified == NULL && has_message(context));
    options.struct_size = 1;
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_surface_certify(context, surface, &options, &certified));
    /* What was not certified has no report. */
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_surface_certified_report(surface, &report, (int32_t)sizeof report));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_surface_certified_open(surface, &count, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_surface_certified_report(NULL, &report, (int32_t)sizeof report));
    STATUS(LAP_ERR_NULL_POINTER, lap_surface_certified_open(NULL, &count, NULL));
    STATUS_IN(context, LAP_OK, lap_surface_certify(context, surface, NULL, &certified));
    STATUS(LAP_ERR_NULL_POINTER, lap_surface_certified_report(certified, NULL, (int32_t)sizeof report));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_surface_certified_report(certified, &report, 0));
    STATUS(LAP_OK, lap_surface_certified_open(certified, NULL, NULL));
    /* Nor has what was certified a complex, or the surface of a network. */
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_surface_complex(context, certified, &complex));
    CHECK(complex == NULL && has_message(context));
    STATUS(LAP_OK, lap_surface_free(certified));
    STATUS(LAP_OK, lap_surface_free(surface));
    STATUS(LAP_OK, lap_arrangement_free(a));
    {
        /* A corner of a tetrahedron cut off by a network. */
        const double xyz[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, values[4] = {-1, 1, 1, 1};
        const int32_t tet[4] = {0, 1, 2, 3};
        lap_network *network = NULL;
        STATUS_IN(context, LAP_OK, lap_network_new_tets(context, 4, xyz, 1, tet, 1, values, 4, 1, NULL, &network));
        STATUS_IN(context, LAP_OK, lap_network_csg(context, network, "0", 0, &surface));
        STATUS(LAP_ERR_BAD_ARGUMENT, lap_surface_certify(context, surface, NULL, &certified));
        CHECK(certified == NULL && has_message(context));
        STATUS(LAP_ERR_BAD_ARGUMENT, lap_surface_complex(context, surface, &complex));
        CHECK(complex == NULL && has_message(context));
        STATUS(LAP_ERR_BAD_ARGUMENT, lap_surface_certified_open(surface, &count, NULL));
        STATUS(LAP_OK, lap_surface_free(surface));
        STATUS(LAP_OK, lap_network_free(network));
    }
}

/* Cubes on the axes: the doubles are exact. Certified twice, checked only, and nothing at all. */
static void exact(lap_context *context)
{
    box b[2];
    lap_operand two[2];
    lap_arrangement *a = NULL;
    lap_surface *surface = NULL, *once = NULL, *twice = NULL;
    lap_surface_certify_options options;
    lap_surface_certify_report r;
    int64_t n = 0, m = 0, count = 0, k = 0, i;
    const double *x = NULL, *y = NULL;
    const int32_t *p = NULL, *q = NULL, *s = NULL, *t = NULL, *u = NULL, *v = NULL, *w = NULL, *z = NULL;
    const uint8_t *f = NULL, *g = NULL;

    two[0] = boxed(&b[0], 0, 0, 0, 0);
    two[1] = boxed(&b[1], 1, 1, 1, 0);
    a = arranged(context, 2, two);
    surface = extracted(context, a, LAP_EXTRACT_DIFFERENCE);
    STATUS(LAP_OK, lap_surface_certify_options_init(&options, (int32_t)sizeof options));
    STATUS_IN(context, LAP_OK, lap_surface_certify(context, surface, NULL, &once));
    options.check_only = 1;
    STATUS_IN(context, LAP_OK, lap_surface_certify(context, once, &options, &twice));
    STATUS(LAP_OK, lap_arrangement_free(a));
    r = report_of(once);
    CHECK(r.certified && r.rounds == 1 && r.flat_before == 0 && r.contacts_before == 0 && r.moved_vertices == 0 && r.gone_vertices == 0);
    CHECK(r.removed_triangles == 0 && r.snapped == 0 && r.thin_cells == 0 && r.largest_move == 0 && r.triangles_before == r.triangles_after);
    STATUS(LAP_OK, lap_surface_vertices(surface, &n, &x, &p));
    STATUS(LAP_OK, lap_surface_vertices(twice, &m, &y, &q));
    CHECK(n == m && memcmp(x, y, (size_t)(3 * n) * sizeof *x) == 0 && memcmp(p, q, (size_t)n * sizeof *p) == 0);
    STATUS(LAP_OK, lap_surface_triangles(surface, &count, &s, &t, &u, &f));
    STATUS(LAP_OK, lap_surface_triangles(twice, &k, &v, &w, &z, &g));
    CHECK(count == k && memcmp(s, v, (size_t)(3 * count) * sizeof *s) == 0);
    for (i = 0; i < count; ++i) CHECK(t[i] == w[i] && u[i] == z[i] && f[i] == g[i]);
    STATUS(LAP_OK, lap_surface_polygons(surface, NULL, NULL, NULL, &s, &f));
    STATUS(LAP_OK, lap_surface_polygons(twice, &k, &t, NULL, &v, &g));
    CHECK(k == count && t[k] == 3 * k);
    for (i = 0; i < count; ++i) CHECK(s[i] == v[i] && f[i] == g[i]);
    is_certified(context, once);
    is_certified(context, twice);
    is_solid(context, twice, "7", 2);
    STATUS(LAP_OK, lap_surface_free(once));
    STATUS(LAP_OK, lap_surface_free(surface));

    two[1] = two[0];
    a = arranged(context, 2, two);
    surface = extracted(context, a, LAP_EXTRACT_DIFFERENCE);
    for (i = 0; i < 2; ++i) {
        options.check_only = (int32_t)i;
        STATUS_IN(context, LAP_OK, lap_surface_certify(context, surface, &options, &once));
        r = report_of(once);
        CHECK(r.certified == 1 && r.triangles_after == 0);
        is_solid(context, once, "0", 0);
    }
    STATUS(LAP_OK, lap_surface_free(surface));
    STATUS(LAP_OK, lap_arrangement_free(a));
}

/* Boxes whose sides are nearly in common planes, one after the other; what comes out is the operand of the next. */
static void chain(lap_context *context)
{
    static const int32_t operations[4] = {LAP_EXTRACT_UNION, LAP_EXTRACT_DIFFERENCE, LAP_EXTRACT_SYMMETRIC_DIFFERENCE,
                                          LAP_EXTRACT_INTERSECTION};
    lap_surface *now = NULL;
    int64_t repaired = 0, refused = 0;
    int step;
    for (step = 0; step < 8; ++step) {
        box b[2];
        lap_operand two[2];
        lap_arrangement *a = NULL;
        lap_surface *surface = NULL, *next = NULL, *checked = NULL;
        lap_surface_certify_options options;
        lap_surface_certify_report r;
        int64_t n = 0, i;
        const int32_t *sources = NULL, *pairs = NULL;

        two[0] = turned(&b[0], 0, 0, 0);
        if (now != NULL && step % 4 != 0) two[0] = operand_of(now);
        two[1] = turned(&b[1], 0.75 / (step + 1), 0.25 * (step % 3), step % 2 ? 0.5 : 0);
        a = arranged(context, 2, two);
        surface = extracted(context, a, operations[step % 4]);

        STATUS(LAP_OK, lap_surface_certify_options_init(&options, (int32_t)sizeof options));
        options.check_only = 1;
        STATUS_IN(context, LAP_OK, lap_surface_certify(context, surface, &options, &checked));
        r = report_of(checked);
        CHECK(r.certified == (r.flat_before == 0 && r.contacts_before == 0));
        CHECK(r.open_pairs == r.flat_before + r.contacts_before && r.moved_vertices == 0 && r.triangles_after == r.triangles_before);
        refused += !r.certified;
        STATUS(LAP_OK, lap_surface_certified_open(checked, &n, &pairs));
        for (i = 0; i < n; ++i) CHECK(pairs[2 * i] >= 0 && pairs[2 * i] <= pairs[2 * i + 1] && pairs[2 * i + 1] < r.triangles_after);
        STATUS(LAP_OK, lap_surface_free(checked));

        STATUS_IN(context, LAP_OK, lap_surface_certify(context, surface, NULL, &next));
        r = report_of(next);
        repaired += r.contacts_before > 0;
        is_certified(context, next);
        STATUS(LAP_OK, lap_surface_vertices(next, &n, NULL, &sources));
        for (i = 0; i < n; ++i) r.moved_vertices -= sources[i] < 0;
        CHECK(r.moved_vertices == 0);
        STATUS(LAP_OK, lap_surface_free(surface));
        STATUS(LAP_OK, lap_arrangement_free(a));
        STATUS(LAP_OK, lap_surface_free(now));
        now = next;
    }
    CHECK(repaired > 0 && refused >= repaired);
    STATUS(LAP_OK, lap_surface_free(now));
}

static int32_t certify(lap_context *context, const void *input, void **made)
{
    lap_surface *certified = (lap_surface *)&certified;
    const int32_t status = lap_surface_certify(context, (const lap_surface *)input, NULL, &certified);
    *made = certified;
    return status;
}

static int32_t release(void *made) { return lap_surface_free((lap_surface *)made); }

static void cancel(lap_context *context)
{
    box b[2];
    lap_operand two[2];
    maker m = {certify, release, NULL};
    lap_arrangement *a = NULL;
    lap_surface *surface = NULL;

    two[0] = turned(&b[0], 0, 0, 0);
    two[1] = turned(&b[1], 0.5, 0.25, 0);
    a = arranged(context, 2, two);
    surface = extracted(context, a, LAP_EXTRACT_DIFFERENCE);
    m.input = surface;
    cancel_everywhere(context, m);
    STATUS(LAP_OK, lap_surface_free(surface));
    STATUS(LAP_OK, lap_arrangement_free(a));
}

void test_surface_certify(void)
{
    lap_context *context = NULL;
    STATUS(LAP_OK, lap_context_new(&context));
    options_and_errors(context);
    exact(context);
    chain(context);
    cancel(context);
    STATUS(LAP_OK, lap_context_free(context));
}
