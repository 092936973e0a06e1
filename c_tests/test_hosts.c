/* Hosts with floating-point environments of their own: results must have the same bits as in a plain host, callbacks must run
   under the host's environment, and that must be untouched afterwards.

   The same program is built four times: plain; -ffast-math (its start-up code flushes subnormals in every thread); with
   HOST_UPWARD (rounding upward); with HOST_TRAPS (invalid, overflow and division by zero kill the process).
   With --write FILE it stores its results, with --compare FILE it compares them with stored ones. */
#define _GNU_SOURCE
#include "check.h"

#include <fenv.h>
#include <stdlib.h>
#include <string.h>

int check_failures = 0;
long check_count = 0;

/* The host's environment, as far as it can be asked for. */
typedef struct {
    int rounding, sticky;
    unsigned control;
} environment;

static environment now(void)
{
    environment e;
    e.rounding = fegetround();
    e.sticky = fetestexcept(FE_ALL_EXCEPT);
    e.control = 0;
#if defined(__x86_64__)
    e.control = __builtin_ia32_stmxcsr();
#elif defined(__aarch64__)
    __asm__ volatile("mrs %x0, fpcr" : "=r"(e.control));
#endif
    return e;
}

static int same(environment a, environment b)
{
    return a.rounding == b.rounding && a.sticky == b.sticky && a.control == b.control;
}

static environment host;
static int callbacks;

static int32_t on_progress(void *user, const char *stage, double fraction)
{
    (void)user;
    (void)stage;
    (void)fraction;
    ++callbacks;
    CHECK(same(now(), host));
    return 0;
}

/* Every call goes through here. */
#define CALL(call)                       \
    do {                                 \
        host = now();                    \
        int32_t status_ = (call);        \
        environment after_ = now();      \
        CHECK(same(host, after_));       \
        STATUS(LAP_OK, status_);         \
    } while (0)

static unsigned char *results;
static size_t result_size;

static void keep(const void *bytes, size_t size)
{
    results = (unsigned char *)realloc(results, result_size + size);
    if (results == NULL) exit(2);
    if (size > 0) memcpy(results + result_size, bytes, size);
    result_size += size;
}

/* The boxes of a grid with the same five nodes along each axis; fluid inside or outside. */
static void grid_and_keep(lap_context *context, const lap_mesh *mesh, const double *nodes, int32_t outside)
{
    lap_grid *grid = NULL;
    lap_grid_options options;
    int64_t count = 0;
    const double *a = NULL, *b = NULL, *c = NULL;
    const int64_t *keys = NULL;
    const uint8_t *flags = NULL;
    const int32_t *cells = NULL;

    CALL(lap_grid_options_init(&options, (int32_t)sizeof options));
    options.outside = outside;
    options.check = 1;
    CALL(lap_grid_new(context, mesh, 5, nodes, 5, nodes, 5, nodes, &options, &grid));
    CALL(lap_grid_flags(grid, &count, &flags));
    keep(flags, (size_t)count);
    CALL(lap_grid_vertices(grid, &count, &a, NULL));
    keep(a, (size_t)count * 3 * sizeof *a);
    CALL(lap_grid_cell_moments(grid, &count, &a, &b, &c, NULL));
    keep(a, (size_t)count * sizeof *a);
    keep(b, (size_t)count * sizeof *b);
    keep(c, (size_t)count * 3 * sizeof *c);
    CALL(lap_grid_cell_boundaries(grid, &count, &a, &b));
    keep(a, (size_t)count * 3 * sizeof *a);
    keep(b, (size_t)count * 3 * sizeof *b);
    CALL(lap_grid_plane_face_moments(grid, &count, &a, &b, &c, NULL));
    keep(a, (size_t)count * sizeof *a);
    keep(b, (size_t)count * sizeof *b);
    keep(c, (size_t)count * 3 * sizeof *c);
    CALL(lap_grid_face_keys(grid, &count, &keys));
    keep(keys, (size_t)count * 2 * sizeof *keys);
    CALL(lap_grid_aggregate(context, grid, 0.3, NULL, NULL, &count, &cells, NULL, NULL, NULL));
    keep(cells, (size_t)count * sizeof *cells);
    CALL(lap_grid_free(grid));
}

static void cut_and_keep(int32_t threads, const double *nodes, const double *xyz, const int32_t *indices,
                         int64_t triangles, int64_t vertices, const double *planes, int64_t n_planes)
{
    lap_context *context = NULL;
    lap_mesh *mesh = NULL;
    lap_cut *cut = NULL;
    const lap_complex *c = NULL;
    lap_mesh_options options;
    int64_t count = 0, cells = 0, i;
    const double *d = NULL, *e = NULL;
    const int32_t *a = NULL, *b = NULL;
    const char *x = NULL, *y = NULL, *z = NULL;

    CALL(lap_context_new(&context));
    CALL(lap_context_set_threads(context, threads));
    CALL(lap_context_set_progress(context, on_progress, NULL));
    CALL(lap_mesh_options_init(&options, (int32_t)sizeof options));
    options.check_self_intersection = 1;
    CALL(lap_mesh_new(context, vertices, xyz, triangles, indices, NULL, &options, &mesh));
    CALL(lap_mesh_volume_exact(context, mesh, &x));
    keep(x, strlen(x));
    CALL(lap_cut_new(context, mesh, n_planes, planes, NULL, &cut));
    CALL(lap_cut_complex(cut, &c));
    CALL(lap_complex_vertices(c, &count, &d));
    keep(d, (size_t)count * 3 * sizeof *d);
    for (i = 0; i < count; ++i) {
        CALL(lap_complex_vertex_exact(context, c, (int32_t)i, &x, &y, &z));
        keep(x, strlen(x));
        keep(y, strlen(y));
        keep(z, strlen(z));
    }
    CALL(lap_complex_cell_moments(c, &cells, &d, &e, NULL));
    keep(d, (size_t)cells * sizeof *d);
    keep(e, (size_t)cells * 3 * sizeof *e);
    for (i = 0; i < cells; ++i) {
        CALL(lap_complex_cell_volume_exact(context, c, (int32_t)i, &x));
        keep(x, strlen(x));
    }
    CALL(lap_complex_face_moments(c, &count, &d, &e, NULL));
    keep(d, (size_t)count * 3 * sizeof *d);
    keep(e, (size_t)count * 3 * sizeof *e);
    CALL(lap_complex_face_cells(c, &count, &a));
    keep(a, (size_t)count * 2 * sizeof *a);
    CALL(lap_complex_polygons(c, LAP_FACES_TRIANGLES, &count, &a, &b, NULL));
    keep(b, (size_t)a[count] * sizeof *b);
    CALL(lap_complex_check(context, c));
    CALL(lap_cut_free(cut));
    for (i = 0; i < 2; ++i) grid_and_keep(context, mesh, nodes, (int32_t)i);
    CALL(lap_mesh_free(mesh));
    CALL(lap_context_free(context));
}

static const int32_t cube[36] = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                 1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
#define CUBE(s) {-(s), -(s), -(s), (s), -(s), -(s), (s), (s), -(s), -(s), (s), -(s), \
                 -(s), -(s), (s),  (s), -(s), (s),  (s), (s), (s),  -(s), (s), (s)}

/* Ordinary, subnormal (flushed to zero by a careless library), and at the end of the range (where products overflow). */
static const double ordinary[24] = CUBE(1.1), tiny[24] = CUBE(0x1.8p-1060), huge[24] = CUBE(0x1.fp1000);
/* Grids around the cube, through its sides, and inside. Constants: no host computes them. */
#define NODES(s) {-1.5 * (s), -0.375 * (s), 0.125 * (s), 0.75 * (s), 1.75 * (s)}
static const double ordinary_nodes[5] = NODES(1), tiny_nodes[5] = NODES(0x1p-1060), huge_nodes[5] = NODES(0x1p1000);
static const double planes[20] = {0.3, 0.2, 0.1, 0,    0.1, -0.7, 0.3, 0, /* three through a point */
                                  1,   1,   1,   0,    0,   0,    1,   0, -0.9, 0.4, 0.1, 0};
static const double ordinary_planes[12] = {0.3, 0.2, 0.1, -0.05, 0.7, -0.1, 0.2, 1e-17, 1e-200, 1e-250, 3e-200, 1e-201};
static const double tiny_planes[8] = {1, 0, 0, -0x1p-1061, 1, 1, 1, 0x1p-1074};
static const double huge_planes[8] = {1e308, 1e307, -1e308, 0, 3, 1, 1, -0x1p1000};

static int store(const char *path)
{
    FILE *file = fopen(path, "wb");
    if (file == NULL || fwrite(results, 1, result_size, file) != result_size || fclose(file) != 0) return 0;
    return 1;
}

static int matches(const char *path)
{
    FILE *file = fopen(path, "rb");
    unsigned char *stored = (unsigned char *)malloc(result_size + 1);
    size_t size;
    int equal;
    if (file == NULL || stored == NULL) return 0;
    size = fread(stored, 1, result_size + 1, file);
    fclose(file);
    equal = size == result_size && memcmp(stored, results, size) == 0;
    free(stored);
    return equal;
}

int main(int argc, char **argv)
{
    int32_t threads;
    if (argc != 3) return 2;
    feclearexcept(FE_ALL_EXCEPT);
#if defined(HOST_UPWARD)
    CHECK(fesetround(FE_UPWARD) == 0);
#elif defined(HOST_TRAPS)
    CHECK(feenableexcept(FE_INVALID | FE_OVERFLOW | FE_DIVBYZERO) == 0);
#elif defined(__FAST_MATH__) && defined(__x86_64__)
    /* Flush to zero, denormals are zero: otherwise this host would prove nothing. */
    CHECK((__builtin_ia32_stmxcsr() & 0x8040) == 0x8040);
#endif
    for (threads = 1; threads <= 2; ++threads) {
        cut_and_keep(threads, ordinary_nodes, ordinary, cube, 12, 8, planes, 5);
        cut_and_keep(threads, ordinary_nodes, ordinary, cube, 12, 8, ordinary_planes, 3);
        cut_and_keep(threads, tiny_nodes, tiny, cube, 12, 8, planes, 5);
        cut_and_keep(threads, tiny_nodes, tiny, cube, 12, 8, tiny_planes, 2);
        cut_and_keep(threads, huge_nodes, huge, cube, 12, 8, planes, 5);
        cut_and_keep(threads, huge_nodes, huge, cube, 12, 8, huge_planes, 2);
    }
    CHECK(callbacks > 0);
    CHECK(result_size > 0);
    if (strcmp(argv[1], "--write") == 0) {
        CHECK(store(argv[2]));
    } else {
        CHECK(matches(argv[2]));
    }
    free(results);
    return check_result();
}
