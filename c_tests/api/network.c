/* lap_network_* and lap_surface_*: options, bad input, known networks in two and three dimensions, and every view with NULL. */
#include "api.h"

#include <math.h>
#include <string.h>

/* One cube: nodes at the corners of [0, 1]^3. Function 0 is x - 1/2, function 1 is y - 1/2. */
static const double planes[16] = {-0.5, 0.5, -0.5, 0.5, -0.5, 0.5, -0.5, 0.5, -0.5, -0.5, 0.5, 0.5, -0.5, -0.5, 0.5, 0.5};
static const int32_t cube[3] = {1, 1, 1};

/* A tetrahedron with three materials, and a second one behind a face. */
static const double tet_xyz[15] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
static const int32_t tets[8] = {0, 1, 2, 3, 1, 2, 3, 4};

static int is_csr(const int32_t *offsets, int64_t rows, int64_t items)
{
    int64_t i;
    if (offsets == NULL || offsets[0] != 0 || offsets[rows] != items) return 0;
    for (i = 0; i < rows; ++i)
        if (offsets[i] > offsets[i + 1]) return 0;
    return 1;
}

static int in_range(const int32_t *items, int64_t count, int64_t low, int64_t high)
{
    int64_t i;
    for (i = 0; i < count; ++i)
        if (items[i] < low || items[i] >= high) return 0;
    return 1;
}

static lap_network *make(lap_context *context, int32_t kind, int32_t keep)
{
    lap_network_options o;
    lap_network *network = NULL;
    STATUS(LAP_OK, lap_network_options_init(&o, (int32_t)sizeof o));
    o.kind = kind;
    o.keep_values = keep;
    STATUS_IN(context, LAP_OK, lap_network_new_box(context, cube, NULL, 2, planes, 8, 1, &o, &network));
    CHECK(network != NULL);
    return network;
}

static void options(lap_context *context)
{
    lap_network_options o;
    lap_network *network = (lap_network *)&network;
    int i;

    STATUS(LAP_ERR_NULL_POINTER, lap_network_options_init(NULL, (int32_t)sizeof o));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_options_init(&o, 3));
    STATUS(LAP_OK, lap_network_options_init(&o, (int32_t)sizeof o));
    CHECK(o.struct_size == (int32_t)sizeof o && o.kind == LAP_NETWORK_ARRANGEMENT && o.regions == LAP_REGIONS_AUTOMATIC);
    CHECK(o.keep_values == 0);
    for (i = 0; i < 3; ++i) {
        STATUS(LAP_OK, lap_network_options_init(&o, (int32_t)sizeof o));
        if (i == 0) o.kind = 2;
        if (i == 1) o.regions = -1;
        if (i == 2) o.struct_size = 1 << 20;
        STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_new_box(context, cube, NULL, 2, planes, 8, 1, &o, &network));
        CHECK(network == NULL && has_message(context));
    }
}

static void bad_input(lap_context *context)
{
    const double bounds[3][6] = {{0, 0, 0, 1, 0, 1}, {0, 0, NAN, 1, 1, 1}, {0, 0, 0, 1, INFINITY, 1}};
    const int32_t none[3] = {1, 0, 1}, negative[3] = {1, 1, -1}, many[3] = {2000, 2000, 2000};
    double values[16];
    lap_network *network = (lap_network *)&network;
    lap_network_options o;
    const char *message = NULL;
    int i;

    for (i = 0; i < 3; ++i) {
        STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_new_box(context, cube, bounds[i], 2, planes, 8, 1, NULL, &network));
        CHECK(network == NULL && has_message(context));
    }
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_new_box(context, none, NULL, 2, planes, 8, 1, NULL, &network));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_new_box(context, negative, NULL, 2, planes, 8, 1, NULL, &network));
    STATUS(LAP_ERR_TOO_LARGE, lap_network_new_box(context, many, NULL, 2, planes, 8, 1, NULL, &network));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_new_box(context, cube, NULL, -1, planes, 8, 1, NULL, &network));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_new_box(context, cube, NULL, 2, planes, 0, 1, NULL, &network));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_new_box(context, cube, NULL, 2, planes, 8, -1, NULL, &network));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_new_box(context, cube, NULL, 2, planes, 8, INT64_MAX / 2, NULL, &network));
    CHECK(has_message(context));
    STATUS(LAP_ERR_TOO_LARGE, lap_network_new_box(context, cube, NULL, (int64_t)1 << 40, planes, 8, 1, NULL, &network));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_new_box(context, NULL, NULL, 2, planes, 8, 1, NULL, &network));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_new_box(context, cube, NULL, 2, NULL, 8, 1, NULL, &network));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_new_box(context, cube, NULL, 2, planes, 8, 1, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_new_box(NULL, cube, NULL, 2, planes, 8, 1, NULL, &network));
    /* A value that is not finite has its function and node. */
    memcpy(values, planes, sizeof values);
    values[8 + 5] = NAN;
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_new_box(context, cube, NULL, 2, values, 8, 1, NULL, &network));
    STATUS(LAP_OK, lap_context_last_error(context, NULL, &message));
    CHECK(network == NULL && strstr(message, "function 1") != NULL && strstr(message, "node 5") != NULL);
    /* An interface of no materials; an arrangement of no functions is one region. */
    STATUS(LAP_OK, lap_network_options_init(&o, (int32_t)sizeof o));
    o.kind = LAP_NETWORK_INTERFACE;
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_new_box(context, cube, NULL, 0, NULL, 1, 1, &o, &network));
    STATUS_IN(context, LAP_OK, lap_network_new_box(context, cube, NULL, 0, NULL, 1, 1, NULL, &network));
    {
        int64_t vertices = -1, regions = -1;
        STATUS(LAP_OK, lap_network_counts(network, &vertices, NULL, NULL, NULL, NULL, NULL, NULL, NULL, &regions));
        CHECK(vertices == 0 && regions == 1);
    }
    STATUS(LAP_OK, lap_network_free(network));
}

static void bad_meshes(lap_context *context)
{
    const double values[5] = {1, -1, 1, -1, 1};
    const int32_t far[4] = {0, 1, 2, 5}, flat[4] = {0, 1, 2, 2}, overlap[8] = {0, 1, 2, 3, 0, 1, 2, 4};
    const double xy[8] = {0, 0, 1, 0, 0, 1, 1, 1};
    const int32_t triangles[6] = {0, 1, 2, 1, 2, 3}, straight[3] = {0, 1, 1};
    double xyz[15];
    lap_network *network = (lap_network *)&network;

    STATUS(LAP_ERR_BAD_MESH, lap_network_new_tets(context, 5, tet_xyz, 1, far, 1, values, 5, 1, NULL, &network));
    CHECK(network == NULL && has_defect(context, LAP_DEFECT_INDEX_OUT_OF_RANGE, 0, 3, 5));
    STATUS(LAP_ERR_BAD_MESH, lap_network_new_tets(context, 5, tet_xyz, 1, flat, 1, values, 5, 1, NULL, &network));
    CHECK(has_defect(context, LAP_DEFECT_DEGENERATE_SIMPLEX, 0, -1, -1));
    STATUS(LAP_ERR_BAD_MESH, lap_network_new_tets(context, 5, tet_xyz, 2, overlap, 1, values, 5, 1, NULL, &network));
    CHECK(has_defect(context, LAP_DEFECT_OVERLAPPING_SIMPLICES, 0, 1, -1) && has_message(context));
    memcpy(xyz, tet_xyz, sizeof xyz);
    xyz[7] = INFINITY;
    STATUS(LAP_ERR_BAD_MESH, lap_network_new_tets(context, 5, xyz, 2, tets, 1, values, 5, 1, NULL, &network));
    CHECK(has_defect(context, LAP_DEFECT_NON_FINITE_COORDINATE, 2, -1, -1));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_new_tets(context, -1, xyz, 2, tets, 1, values, 5, 1, NULL, &network));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_new_tets(context, 5, NULL, 2, tets, 1, values, 5, 1, NULL, &network));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_new_tets(context, 5, tet_xyz, 2, NULL, 1, values, 5, 1, NULL, &network));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_new_tets(context, 5, tet_xyz, 2, tets, 1, values, 5, 1, NULL, NULL));
    STATUS(LAP_ERR_BAD_MESH, lap_network_new_triangles(context, 4, xy, 1, straight, 1, values, 4, 1, NULL, &network));
    CHECK(has_defect(context, LAP_DEFECT_DEGENERATE_SIMPLEX, 0, -1, -1));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_new_triangles(context, 4, xy, 2, triangles, 1, values, 4, 1, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_new_triangles(context, 4, NULL, 2, triangles, 1, values, 4, 1, NULL, &network));
    CHECK(network == NULL);
}

static int32_t choose_first(void *user, int32_t region)
{
    ++*(int *)user;
    return region == 0;
}

/* Two planes that cross in a cube: four regions, four patches, one chain. */
static void crossing_planes(lap_context *context)
{
    lap_network *network = make(context, LAP_NETWORK_ARRANGEMENT, 1);
    int64_t vertices = 0, edges = 0, polygons = 0, patches = 0, chains = 0, corners = 0, components = 0, shells = 0, regions = 0;
    int64_t count = 0, functions = 0, i, n;
    const double *xyz = NULL;
    const int64_t *active = NULL;
    const int32_t *a = NULL, *b = NULL, *c = NULL, *d = NULL;
    const uint8_t *bytes = NULL;
    const char *x = NULL, *y = NULL, *z = NULL;
    int32_t kind = -1, dim = 0, stages = 0;
    double seconds = -1;
    lap_surface *surface = NULL;
    int asked = 0;

    STATUS(LAP_OK, lap_network_counts(network, &vertices, &edges, &polygons, &patches, &chains, &corners, &components, &shells,
                                      &regions));
    CHECK(patches == 4 && chains == 1 && corners == 2 && components == 1 && shells == 4 && regions == 4);
    STATUS(LAP_OK, lap_network_counts(network, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_network_input(network, &kind, &dim, &functions));
    CHECK(kind == LAP_NETWORK_ARRANGEMENT && dim == 3 && functions == 2);
    STATUS(LAP_OK, lap_network_input(network, NULL, NULL, NULL));
    /* Each plane crosses all five tetrahedra, or not. */
    STATUS(LAP_OK, lap_network_active(network, &count, &active));
    for (n = 0, i = 1; i < count; ++i) n += active[i];
    CHECK(count == 3 && n == 5);

    STATUS(LAP_OK, lap_network_vertices(network, &count, &xyz, &a));
    CHECK(count == vertices && in_range(a, 4 * count, -1, 8));
    for (i = 0; i < count; ++i) CHECK(xyz[3 * i] == 0.5 || xyz[3 * i + 1] == 0.5);
    STATUS(LAP_OK, lap_network_vertex_functions(network, &count, &a, &b));
    CHECK(count == vertices && is_csr(a, count, a[count]) && in_range(b, a[count], 0, 2));
    for (i = 0; i < count; ++i) CHECK(xyz[3 * i + b[a[i]]] == 0.5);

    STATUS(LAP_OK, lap_network_polygons(network, &count, &a, &b, &c, &d));
    CHECK(count == polygons && is_csr(a, count, a[count]) && in_range(b, a[count], 0, vertices));
    CHECK(in_range(c, count, 0, 2) && in_range(d, 2 * count, 0, 5));
    STATUS(LAP_OK, lap_network_sets(network, &count, &a, &b, &c));
    CHECK(count == 2 && is_csr(a, 2, 2) && b[0] == 0 && b[1] == 1 && c[0] == 1 && c[1] == 1);
    STATUS(LAP_OK, lap_network_edges(network, &count, &a, &b, &c));
    CHECK(count == edges && in_range(a, 2 * count, 0, vertices) && is_csr(b, count, b[count]) && in_range(c, b[count], 0, polygons));
    CHECK(vertices - edges + polygons == 1);
    STATUS(LAP_OK, lap_network_polygon_patches(network, &count, &a, &bytes));
    CHECK(count == polygons && in_range(a, count, 0, 4));
    for (i = 0; i < count; ++i) CHECK(bytes[i] == 0);
    STATUS(LAP_OK, lap_network_patches(network, &count, &b, &c, &d));
    CHECK(count == 4 && is_csr(b, 4, polygons) && in_range(d, 4, 0, 1));
    for (n = 0; n < 4; ++n)
        for (i = b[n]; i < b[n + 1]; ++i) CHECK(a[c[i]] == n);
    STATUS(LAP_OK, lap_network_chains(network, &count, &a, &b, &c, &d, &bytes));
    CHECK(count == 1 && a[1] >= 1 && c[1] == a[1] + 1 && bytes[0] == 0 && in_range(b, a[1], 0, edges));
    for (i = 0; i < c[1]; ++i) CHECK(xyz[3 * d[i]] == 0.5 && xyz[3 * d[i] + 1] == 0.5);
    STATUS(LAP_OK, lap_network_corners(network, &count, &a));
    CHECK(count == 2 && ((a[0] == d[0] && a[1] == d[c[1] - 1]) || (a[1] == d[0] && a[0] == d[c[1] - 1])));
    STATUS(LAP_OK, lap_network_chain_patches(network, &count, &a, &b, &bytes));
    CHECK(count == 1 && a[1] == 4);
    for (n = 0, i = 0; i < 4; ++i) {
        n |= 1 << b[i] / 2;
        CHECK(bytes[i] == 0);
    }
    CHECK(n == 15);
    STATUS(LAP_OK, lap_network_shells(network, &count, &a, &b, &c));
    CHECK(count == 4 && is_csr(a, 4, 8) && in_range(b, 8, 0, 8) && in_range(c, 4, 0, 4));
    STATUS(LAP_OK, lap_network_regions(network, &count, &a, &b, &c));
    CHECK(count == 4 && is_csr(a, 4, 4) && in_range(b, 4, 0, 4) && in_range(c, 4, 0, 5));
    STATUS(LAP_OK, lap_network_region_signs(network, &count, &functions, &a));
    CHECK(count == 4 && functions == 2);
    for (n = 0, i = 0; i < 4; ++i) {
        CHECK(a[2 * i] * a[2 * i] == 1 && a[2 * i + 1] * a[2 * i + 1] == 1);
        n |= 1 << (2 * (a[2 * i] > 0) + (a[2 * i + 1] > 0));
    }
    CHECK(n == 15);
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_region_materials(network, &count, &a));
    STATUS(LAP_OK, lap_network_triangles(network, &count, &a, &b));
    CHECK(count >= polygons && in_range(a, 3 * count, 0, vertices) && in_range(b, count, 0, polygons));

    for (i = 0; i < vertices; ++i) {
        STATUS_IN(context, LAP_OK, lap_network_vertex_exact(context, network, (int32_t)i, &x, &y, &z));
        CHECK((xyz[3 * i] == 0.5) == (strcmp(x, "1/2") == 0) && (xyz[3 * i + 1] == 0.5) == (strcmp(y, "1/2") == 0));
        CHECK(z[0] != 0);
    }
    STATUS(LAP_OK, lap_network_vertex_exact(context, network, 0, NULL, NULL, NULL));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_vertex_exact(context, network, (int32_t)vertices, &x, &y, &z));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_vertex_exact(context, network, -1, &x, &y, &z));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_vertex_exact(context, NULL, 0, &x, &y, &z));
    STATUS_IN(context, LAP_OK, lap_network_check(context, network));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_check(context, NULL));
    STATUS(LAP_OK, lap_network_stage_count(network, &stages));
    CHECK(stages > 0);
    STATUS(LAP_OK, lap_network_stage(network, 0, &x, &seconds));
    CHECK(x[0] != 0 && seconds >= 0);
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_stage(network, stages, &x, &seconds));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_stage_count(network, NULL));

    /* A quarter of the cube: two half planes; the union of two quarters side by side: one plane. */
    STATUS_IN(context, LAP_OK, lap_network_csg(context, network, "0 & 1", 0, &surface));
    STATUS(LAP_OK, lap_surface_vertices(surface, &count, &xyz, &a));
    CHECK(count > 0 && in_range(a, count, 0, vertices));
    for (i = 0; i < count; ++i) CHECK(xyz[3 * i] >= 0.5 && xyz[3 * i + 1] >= 0.5);
    n = count;
    STATUS(LAP_OK, lap_surface_polygons(surface, &count, &a, &b, &c, &bytes));
    CHECK(count > 0 && is_csr(a, count, a[count]) && in_range(b, a[count], 0, n) && in_range(c, count, 0, polygons));
    /* Normals of functions point into the solid, so all are flipped. */
    for (i = 0; i < count; ++i) CHECK(bytes[i] == 1);
    STATUS(LAP_OK, lap_surface_free(surface));
    STATUS_IN(context, LAP_OK, lap_network_csg(context, network, "-0", 1, &surface));
    STATUS(LAP_OK, lap_surface_vertices(surface, &count, &xyz, NULL));
    for (i = 0; i < count; ++i) CHECK(xyz[3 * i] == 0.5);
    STATUS(LAP_OK, lap_surface_polygons(surface, &count, &a, NULL, NULL, &bytes));
    for (i = 0; i < count; ++i) CHECK(a[i + 1] - a[i] == 3 && bytes[i] == 0);
    STATUS(LAP_OK, lap_surface_free(surface));
    STATUS_IN(context, LAP_OK, lap_network_csg(context, network, "true", 0, &surface));
    STATUS(LAP_OK, lap_surface_polygons(surface, &count, NULL, NULL, NULL, NULL));
    CHECK(count == 0);
    STATUS(LAP_OK, lap_surface_free(surface));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_csg(context, network, "0 & 2", 0, &surface));
    CHECK(surface == NULL && has_message(context));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_csg(context, network, NULL, 0, &surface));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_csg(context, NULL, "0", 0, &surface));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_csg(context, network, "0", 0, NULL));
    {
        const uint8_t table[4] = {1, 0, 0, 0};
        const int32_t *other = NULL;
        int64_t same = 0;
        lap_surface *second = NULL;
        STATUS_IN(context, LAP_OK, lap_network_csg_table(context, network, 4, table, 0, &surface));
        STATUS_IN(context, LAP_OK, lap_network_csg_callback(context, network, choose_first, &asked, 0, &second));
        STATUS(LAP_OK, lap_surface_polygons(surface, &count, NULL, NULL, &a, NULL));
        STATUS(LAP_OK, lap_surface_polygons(second, &same, NULL, NULL, &other, NULL));
        CHECK(asked == 4 && count == same && count > 0 && memcmp(a, other, sizeof *a * (size_t)count) == 0);
        STATUS(LAP_OK, lap_surface_free(surface));
        STATUS(LAP_OK, lap_surface_free(second));
        STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_csg_table(context, network, 3, table, 0, &surface));
        STATUS(LAP_ERR_NULL_POINTER, lap_network_csg_table(context, network, 4, NULL, 0, &surface));
        STATUS(LAP_ERR_NULL_POINTER, lap_network_csg_callback(context, network, NULL, NULL, 0, &surface));
        CHECK(surface == NULL && has_message(context));
    }
    STATUS(LAP_ERR_NULL_POINTER, lap_surface_vertices(NULL, &count, &xyz, &a));
    STATUS(LAP_ERR_NULL_POINTER, lap_surface_polygons(NULL, &count, &a, &b, &c, &bytes));
    STATUS(LAP_OK, lap_surface_free(NULL));
    STATUS(LAP_OK, lap_network_free(network));
}

/* The larger of x - 1/2 and y - 1/2: one polygon on the diagonal of each tetrahedron that it crosses. Without kept values. */
static void interface(lap_context *context)
{
    lap_network *network = make(context, LAP_NETWORK_INTERFACE, 0);
    int64_t patches = 0, regions = 0, count = 0, functions = 0;
    const int32_t *a = NULL, *b = NULL, *c = NULL;
    const char *x = NULL;

    STATUS(LAP_OK, lap_network_counts(network, NULL, NULL, NULL, &patches, NULL, NULL, NULL, NULL, &regions));
    CHECK(patches == 1 && regions == 2);
    STATUS(LAP_OK, lap_network_region_materials(network, &count, &a));
    CHECK(count == 2 && a[0] + a[1] == 1);
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_region_signs(network, &count, &functions, &a));
    STATUS(LAP_OK, lap_network_sets(network, &count, &a, &b, &c));
    CHECK(count == 1 && b[0] == 0 && b[1] == 1 && c[0] == 1 && c[1] == -1);
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_vertex_exact(context, network, 0, &x, NULL, NULL));
    CHECK(has_message(context));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_check(context, network));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_region_ties(context, network, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_network_free(network));
}

/* Four materials in a cube: the first two and the last are equal; the third is larger where x > 1/2. */
static void ties(lap_context *context)
{
    double values[32];
    lap_network *network = NULL;
    lap_network_options o;
    int64_t count = 0, i;
    const int32_t *offsets = NULL, *materials = NULL, *owners = NULL;

    for (i = 0; i < 32; ++i) values[i] = i / 8 == 2 ? (double)(i % 2) : 0.5;
    STATUS(LAP_OK, lap_network_options_init(&o, (int32_t)sizeof o));
    o.kind = LAP_NETWORK_INTERFACE;
    o.keep_values = 1;
    STATUS_IN(context, LAP_OK, lap_network_new_box(context, cube, NULL, 4, values, 8, 1, &o, &network));
    STATUS_IN(context, LAP_OK, lap_network_region_ties(context, network, NULL, NULL, NULL));
    STATUS_IN(context, LAP_OK, lap_network_region_ties(context, network, &count, &offsets, &materials));
    STATUS(LAP_OK, lap_network_region_materials(network, NULL, &owners));
    CHECK(count == 2 && is_csr(offsets, 2, 4) && owners[0] + owners[1] == 2);
    for (i = 0; i < 2; ++i) {
        const int32_t *row = materials + offsets[i];
        if (owners[i] == 2) CHECK(offsets[i + 1] - offsets[i] == 1 && row[0] == 2);
        if (owners[i] == 0) CHECK(offsets[i + 1] - offsets[i] == 3 && row[0] == 0 && row[1] == 1 && row[2] == 3);
    }
    STATUS(LAP_ERR_NULL_POINTER, lap_network_region_ties(context, NULL, &count, &offsets, &materials));
    STATUS(LAP_OK, lap_network_free(network));
    network = make(context, LAP_NETWORK_ARRANGEMENT, 1);
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_region_ties(context, network, NULL, NULL, NULL));
    CHECK(has_message(context));
    STATUS(LAP_OK, lap_network_free(network));
}

/* The four quarters of a cube as volumes. */
static void volumes(lap_context *context)
{
    const double twice_xyz[18] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1, 0, 1, 0};
    const int32_t twice[8] = {0, 1, 2, 3, 0, 1, 5, 4};
    const double ones[6] = {1, 1, 1, 1, 1, 1};
    const double xy[6] = {0, 0, 1, 0, 0, 1};
    const int32_t triangle[3] = {0, 1, 2};
    lap_network *network = make(context, LAP_NETWORK_ARRANGEMENT, 1);
    lap_network_options o;
    const lap_complex *complex = NULL, *again = NULL;
    int64_t polygons = 0, vertices = 0, count = 0, faces = 0, cells = 0, i, f, n = 0;
    const int32_t *kinds = NULL, *ids = NULL, *shells = NULL, *face_cells = NULL;
    const double *volumes_of = NULL, *centroids = NULL;
    int64_t euler[2] = {0, 0};
    const char *text = NULL;

    STATUS_IN(context, LAP_OK, lap_network_complex(context, network, &complex));
    STATUS_IN(context, LAP_OK, lap_network_complex(context, network, &again));
    CHECK(complex != NULL && complex == again);
    STATUS_IN(context, LAP_OK, lap_complex_check(context, complex));
    STATUS(LAP_OK, lap_network_counts(network, &vertices, NULL, &polygons, NULL, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_complex_counts(complex, &count, NULL, &faces, &cells, NULL, NULL, NULL));
    CHECK(cells == 4 && count == 8 + vertices);
    STATUS(LAP_OK, lap_complex_vertex_origins(complex, &count, &kinds, &ids));
    for (i = 0; i < count; ++i) {
        CHECK(kinds[i] == (i < 8 ? LAP_VERTEX_MESH : LAP_VERTEX_LEVEL));
        CHECK(ids[3 * i] == (i < 8 ? i : i - 8) && ids[3 * i + 1] == -1);
    }
    STATUS(LAP_OK, lap_complex_face_supports(complex, &count, &kinds, &ids, NULL, NULL));
    STATUS(LAP_OK, lap_complex_face_cells(complex, NULL, &face_cells));
    for (f = 0; f < faces; ++f) {
        const int64_t p = f - (faces - polygons);
        CHECK(kinds[f] == (p < 0 ? LAP_SUPPORT_TRIANGLE : LAP_SUPPORT_LEVEL) && (p < 0 ? ids[f] < 12 : ids[f] == p));
        CHECK((face_cells[2 * f + 1] == -1) == (p < 0));
    }
    STATUS(LAP_OK, lap_complex_cells(complex, &count, &shells, NULL, NULL));
    CHECK(count == 4 && shells[4] == 4);
    STATUS(LAP_OK, lap_complex_cell_moments(complex, &count, &volumes_of, &centroids, NULL));
    for (i = 0; i < 4; ++i) {
        CHECK(volumes_of[i] == 0.25 && centroids[3 * i + 2] == 0.5);
        for (f = 0; f < 2; ++f) n += centroids[3 * i + f] == 0.25 || centroids[3 * i + f] == 0.75;
        STATUS_IN(context, LAP_OK, lap_complex_cell_volume_exact(context, complex, (int32_t)i, &text));
        CHECK(strcmp(text, "1/4") == 0);
    }
    CHECK(n == 8);
    STATUS(LAP_OK, lap_complex_euler(complex, &euler[0], &euler[1]));
    CHECK(euler[0] == 1 && euler[1] == 1);
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_complex_vertex_keys(complex, NULL, NULL));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_complex_face_keys(complex, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_complex(context, network, NULL));
    STATUS(LAP_OK, lap_network_free(network));

    STATUS(LAP_ERR_NULL_POINTER, lap_network_complex(context, NULL, &complex));
    CHECK(complex == NULL);
    network = make(context, LAP_NETWORK_ARRANGEMENT, 0);
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_complex(context, network, &complex));
    CHECK(complex == NULL && has_message(context));
    STATUS(LAP_OK, lap_network_free(network));
    STATUS(LAP_OK, lap_network_options_init(&o, (int32_t)sizeof o));
    o.keep_values = 1;
    STATUS_IN(context, LAP_OK, lap_network_new_triangles(context, 3, xy, 1, triangle, 1, ones, 3, 1, &o, &network));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_network_complex(context, network, &complex));
    CHECK(complex == NULL && has_message(context));
    STATUS(LAP_OK, lap_network_free(network));
    /* Nodes 2 and 5 are in one place. */
    STATUS_IN(context, LAP_OK, lap_network_new_tets(context, 6, twice_xyz, 2, twice, 1, ones, 6, 1, &o, &network));
    STATUS(LAP_ERR_BAD_MESH, lap_network_complex(context, network, &complex));
    CHECK(complex == NULL && has_message(context));
    STATUS(LAP_OK, lap_network_free(network));
}

/* Interleaved values; tetrahedra given; segments in the plane. */
static void meshes(lap_context *context)
{
    const double interleaved[10] = {-1, 2, 1, 2, 1, 2, 1, 2, 3, -2};
    const double xy[8] = {0, 0, 1, 0, 0, 1, 1, 1};
    const int32_t triangles[6] = {0, 1, 2, 1, 2, 3};
    const double line[4] = {-1, 1, -1, 1};
    lap_network *network = NULL;
    lap_network_options o;
    int64_t vertices = 0, polygons = 0, patches = 0, regions = 0, count = 0;
    const double *xyz = NULL;
    const int32_t *a = NULL, *b = NULL;
    int32_t dim = 0;
    const char *x = NULL, *y = NULL, *z = NULL;

    STATUS(LAP_OK, lap_network_options_init(&o, (int32_t)sizeof o));
    o.keep_values = 1;
    o.regions = LAP_REGIONS_CLASSES;
    STATUS_IN(context, LAP_OK, lap_network_new_tets(context, 5, tet_xyz, 2, tets, 2, interleaved, 1, 2, &o, &network));
    STATUS(LAP_OK, lap_network_counts(network, &vertices, NULL, &polygons, &patches, NULL, NULL, NULL, NULL, &regions));
    CHECK(vertices == 6 && polygons == 2 && patches == 2 && regions == 3);
    STATUS_IN(context, LAP_OK, lap_network_check(context, network));
    STATUS(LAP_OK, lap_network_free(network));

    /* Two triangles of a square: x = 1/2 crosses both. */
    STATUS_IN(context, LAP_OK, lap_network_new_triangles(context, 4, xy, 2, triangles, 1, line, 4, 1, &o, &network));
    STATUS(LAP_OK, lap_network_counts(network, &vertices, NULL, &polygons, &patches, NULL, NULL, NULL, NULL, &regions));
    CHECK(vertices == 3 && polygons == 2 && patches == 1 && regions == 2);
    STATUS(LAP_OK, lap_network_input(network, NULL, &dim, NULL));
    CHECK(dim == 2);
    STATUS(LAP_OK, lap_network_vertices(network, &count, &xyz, NULL));
    CHECK(xyz[0] == 0.5 && xyz[3] == 0.5 && xyz[6] == 0.5 && xyz[2] == 0);
    STATUS(LAP_OK, lap_network_polygons(network, NULL, &a, &b, NULL, NULL));
    CHECK(a[1] == 2 && a[2] == 4);
    /* The positive side, x > 1/2, is on the left. */
    CHECK(xyz[3 * b[0] + 1] > xyz[3 * b[1] + 1]);
    STATUS(LAP_OK, lap_network_triangles(network, &count, NULL, NULL));
    CHECK(count == 0);
    STATUS_IN(context, LAP_OK, lap_network_vertex_exact(context, network, 0, &x, &y, &z));
    CHECK(strcmp(x, "1/2") == 0 && strcmp(z, "0") == 0);
    STATUS_IN(context, LAP_OK, lap_network_check(context, network));
    STATUS(LAP_OK, lap_network_free(network));
}

static void null_pointers(void)
{
    STATUS(LAP_ERR_NULL_POINTER, lap_network_counts(NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_input(NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_active(NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_vertices(NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_vertex_functions(NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_polygons(NULL, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_sets(NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_edges(NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_polygon_patches(NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_patches(NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_chains(NULL, NULL, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_chain_patches(NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_corners(NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_shells(NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_regions(NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_region_signs(NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_region_materials(NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_triangles(NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_stage_count(NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_network_stage(NULL, 0, NULL, NULL));
    STATUS(LAP_OK, lap_network_free(NULL));
}

void test_network(void)
{
    lap_context *context = NULL;
    STATUS(LAP_OK, lap_context_new(&context));
    options(context);
    bad_input(context);
    bad_meshes(context);
    crossing_planes(context);
    interface(context);
    ties(context);
    volumes(context);
    meshes(context);
    null_pointers();
    STATUS(LAP_OK, lap_context_free(context));
}
