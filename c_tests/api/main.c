/* Every function of lapidary.h, with good and with bad input. */
#include "api.h"

#include <string.h>

int check_failures = 0;
long check_count = 0;

const double cube_xyz[24] = {0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0, 0, 0, 2, 2, 0, 2, 2, 2, 2, 0, 2, 2};
const int32_t cube_indices[36] = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                  1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
const int32_t cube_tags[12] = {10, 10, 11, 11, 12, 12, 13, 13, 14, 14, 15, 15};

const double hollow_xyz[48] = {0, 0, 0, 4, 0, 0, 4, 4, 0, 0, 4, 0, 0, 0, 4, 4, 0, 4, 4, 4, 4, 0, 4, 4,
                               1, 1, 1, 3, 1, 1, 3, 3, 1, 1, 3, 1, 1, 1, 3, 3, 1, 3, 3, 3, 3, 1, 3, 3};
const int32_t hollow_indices[72] = {0,  2,  1,  0,  3,  2,  4,  5,  6,  4,  6,  7,  0,  1,  5,  0,  5,  4,
                                    1,  2,  6,  1,  6,  5,  2,  3,  7,  2,  7,  6,  3,  0,  4,  3,  4,  7,
                                    /* the wall of the void, clockwise */
                                    8,  9,  10, 8,  10, 11, 12, 14, 13, 12, 15, 14, 8,  13, 9,  8,  12, 13,
                                    9,  14, 10, 9,  13, 14, 10, 15, 11, 10, 14, 15, 11, 12, 8,  11, 15, 12};

lap_mesh *good_mesh(lap_context *context, int64_t n_vertices, const double *xyz, int64_t n_triangles,
                    const int32_t *indices, const int32_t *tags)
{
    lap_mesh *mesh = NULL;
    STATUS_IN(context, LAP_OK, lap_mesh_new(context, n_vertices, xyz, n_triangles, indices, tags, NULL, &mesh));
    CHECK(mesh != NULL);
    return mesh;
}

int has_defect(lap_context *context, int32_t kind, int64_t a, int64_t b, int64_t c)
{
    int64_t count = 0, i;
    const int32_t *kinds = NULL;
    const int64_t *ids = NULL;
    STATUS(LAP_OK, lap_context_last_defects(context, &count, &kinds, &ids));
    for (i = 0; i < count; ++i) {
        const int64_t *d = ids + 3 * i;
        if (kinds[i] == kind && (a == -2 || a == d[0]) && (b == -2 || b == d[1]) && (c == -2 || c == d[2])) return 1;
    }
    return 0;
}

int has_message(lap_context *context)
{
    const char *message = NULL;
    STATUS(LAP_OK, lap_context_last_error(context, NULL, &message));
    return message != NULL && message[0] != 0;
}

/* Cancels at the n-th call, and remembers how many there were. */
typedef struct stopper {
    int calls, at;
    double fraction;
} stopper;

static int32_t stop_at(void *user, const char *stage, double fraction)
{
    stopper *s = (stopper *)user;
    CHECK(stage[0] != 0 && fraction >= s->fraction && fraction <= 1);
    s->fraction = fraction;
    return s->calls++ == s->at;
}

void cancel_everywhere(lap_context *context, maker m)
{
    stopper s = {0, -1, 0};
    void *made = NULL;
    int all, i;
    STATUS_IN(context, LAP_OK, lap_context_set_progress(context, stop_at, &s));
    STATUS_IN(context, LAP_OK, m.make(context, m.input, &made));
    STATUS(LAP_OK, m.release(made));
    all = s.calls;
    CHECK(all > 5);
    for (i = 0; i < all; ++i) {
        int32_t status;
        s.calls = 0;
        s.at = i;
        s.fraction = 0;
        status = m.make(context, m.input, &made);
        if (s.calls <= i) {
            /* On a machine that stalls for long it is asked more often: not so this time. */
            CHECK(status == LAP_OK && i > 5);
            STATUS(LAP_OK, m.release(made));
            continue;
        }
        CHECK(status == LAP_ERR_CANCELLED && made == NULL && s.calls == i + 1);
    }
    STATUS_IN(context, LAP_OK, lap_context_set_progress(context, NULL, NULL));
}

void test_status(void)
{
    int32_t major = -1, minor = -1, patch = -1, i;
    const char *text = NULL, *name = NULL;
    char joined[64];

    STATUS(LAP_OK, lap_version(&major, &minor, &patch, &text));
    CHECK(major >= 0 && minor >= 0 && patch >= 0);
    snprintf(joined, sizeof joined, "%d.%d.%d", (int)major, (int)minor, (int)patch);
    CHECK(text != NULL && strcmp(text, joined) == 0);
    STATUS(LAP_OK, lap_version(NULL, NULL, NULL, NULL));

    STATUS(LAP_OK, lap_status_name(LAP_OK, &name));
    CHECK(strcmp(name, "LAP_OK") == 0);
    STATUS(LAP_OK, lap_status_name(LAP_ERR_BUSY, &name));
    CHECK(strcmp(name, "LAP_ERR_BUSY") == 0);
    for (i = LAP_OK; i <= LAP_ERR_BUSY; ++i) {
        STATUS(LAP_OK, lap_status_name(i, &name));
        CHECK(strchr(name, '?') == NULL);
    }
    STATUS(LAP_OK, lap_status_name(LAP_ERR_BUSY + 1, &name));
    CHECK(strcmp(name, "LAP_ERR_?") == 0);
    STATUS(LAP_OK, lap_status_name(-1, &name));
    CHECK(strcmp(name, "LAP_ERR_?") == 0);
    STATUS(LAP_ERR_NULL_POINTER, lap_status_name(LAP_OK, NULL));

    STATUS(LAP_OK, lap_defect_name(LAP_DEFECT_OPEN_EDGE, &name));
    CHECK(strcmp(name, "LAP_DEFECT_OPEN_EDGE") == 0);
    for (i = LAP_DEFECT_NON_FINITE_COORDINATE; i <= LAP_DEFECT_UNBALANCED_EDGE; ++i) {
        STATUS(LAP_OK, lap_defect_name(i, &name));
        CHECK(strchr(name, '?') == NULL);
    }
    STATUS(LAP_OK, lap_defect_name(0, &name));
    CHECK(strcmp(name, "LAP_DEFECT_?") == 0);
    STATUS(LAP_ERR_NULL_POINTER, lap_defect_name(LAP_DEFECT_OPEN_EDGE, NULL));
}

int main(void)
{
    test_status();
    test_context();
    test_mesh();
    test_cut();
    test_complex();
    test_certify();
    test_keys();
    test_grid();
    test_simplex();
    test_network();
    test_arrangement();
    test_surface_certify();
    return check_result();
}
