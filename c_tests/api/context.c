/* lap_context_*: settings, callbacks, cancelling, the last error, counters. */
#include "api.h"

#include <math.h>
#include <string.h>

typedef struct {
    lap_context *context;
    int calls;
    int cancel_at; /* -1: never */
    double last;
    int32_t inside; /* status of using the context from its callback */
    int32_t freed;
    int logs;
} watch;

static int32_t on_progress(void *user, const char *stage, double fraction)
{
    watch *w = (watch *)user;
    int32_t status = 0;
    CHECK(stage != NULL && stage[0] != 0);
    CHECK(fraction >= w->last && fraction <= 1.0);
    w->last = fraction;
    w->inside = lap_context_last_error(w->context, &status, NULL);
    w->freed = lap_context_free(w->context);
    return w->calls++ == w->cancel_at ? 1 : 0;
}

static void on_log(void *user, int32_t level, const char *message)
{
    watch *w = (watch *)user;
    CHECK(level == LAP_LOG_INFO);
    CHECK(message != NULL);
    w->logs++;
}

static int32_t cut_watched(watch *w, int cancel_at, const lap_mesh *mesh, lap_cut **cut)
{
    static const double planes[8] = {1, 0, 0, -1, 0, 1, 0, -1};
    w->calls = 0;
    w->last = 0;
    w->cancel_at = cancel_at;
    return lap_cut_new(w->context, mesh, 2, planes, NULL, cut);
}

static void settings(void)
{
    lap_context *context = NULL;
    int32_t threads = 0;
    STATUS(LAP_ERR_NULL_POINTER, lap_context_new(NULL));
    STATUS(LAP_OK, lap_context_free(NULL));
    STATUS(LAP_OK, lap_context_new(&context));
    CHECK(context != NULL);

    STATUS(LAP_OK, lap_context_threads(context, &threads));
    CHECK(threads == 1);
    STATUS(LAP_OK, lap_context_set_threads(context, 2));
    STATUS(LAP_OK, lap_context_threads(context, &threads));
    CHECK(threads == 2);
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_context_set_threads(context, 0));
    CHECK(has_message(context));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_context_set_threads(context, -1));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_context_set_threads(context, LAP_MAX_THREADS + 1));
    STATUS(LAP_OK, lap_context_threads(context, &threads));
    CHECK(threads == 2);
    STATUS(LAP_ERR_NULL_POINTER, lap_context_threads(context, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_context_threads(NULL, &threads));
    STATUS(LAP_ERR_NULL_POINTER, lap_context_set_threads(NULL, 1));
    STATUS(LAP_ERR_NULL_POINTER, lap_context_set_progress(NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_context_set_log(NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_context_last_error(NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_context_last_defects(NULL, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_context_free(context));
}

static void errors(void)
{
    lap_context *context = NULL;
    lap_mesh *mesh = NULL;
    int32_t status = -1;
    const char *message = NULL;
    int64_t count = -1;
    const int32_t *kinds = NULL;
    const int64_t *ids = NULL;
    double xyz[24];

    STATUS(LAP_OK, lap_context_new(&context));
    STATUS(LAP_OK, lap_context_last_error(context, &status, &message));
    CHECK(status == LAP_OK && message != NULL && message[0] == 0);
    STATUS(LAP_OK, lap_context_last_defects(context, &count, &kinds, &ids));
    CHECK(count == 0);

    memcpy(xyz, cube_xyz, sizeof xyz);
    xyz[3 * 5 + 1] = NAN;
    xyz[3 * 2] = INFINITY;
    STATUS(LAP_ERR_BAD_MESH, lap_mesh_new(context, 8, xyz, 12, cube_indices, NULL, NULL, &mesh));
    CHECK(mesh == NULL);
    STATUS(LAP_OK, lap_context_last_error(context, &status, &message));
    CHECK(status == LAP_ERR_BAD_MESH && message[0] != 0);
    STATUS(LAP_OK, lap_context_last_error(context, NULL, NULL));
    STATUS(LAP_OK, lap_context_last_defects(context, &count, &kinds, &ids));
    CHECK(count == 2);
    CHECK(has_defect(context, LAP_DEFECT_NON_FINITE_COORDINATE, 2, -1, -1));
    CHECK(has_defect(context, LAP_DEFECT_NON_FINITE_COORDINATE, 5, -1, -1));
    STATUS(LAP_OK, lap_context_last_defects(context, NULL, NULL, NULL));

    /* A success wipes the error. */
    mesh = good_mesh(context, 8, cube_xyz, 12, cube_indices, NULL);
    STATUS(LAP_OK, lap_context_last_error(context, &status, &message));
    CHECK(status == LAP_OK && message[0] == 0);
    STATUS(LAP_OK, lap_context_last_defects(context, &count, NULL, NULL));
    CHECK(count == 0);
    STATUS(LAP_OK, lap_mesh_free(mesh));
    STATUS(LAP_OK, lap_context_free(context));
}

static void callbacks(int32_t threads)
{
    watch w = {0};
    lap_mesh *mesh;
    lap_cut *cut = NULL;
    int i, all;

    STATUS(LAP_OK, lap_context_new(&w.context));
    STATUS(LAP_OK, lap_context_set_threads(w.context, threads));
    mesh = good_mesh(w.context, 8, cube_xyz, 12, cube_indices, cube_tags);
    STATUS(LAP_OK, lap_context_set_progress(w.context, on_progress, &w));
    STATUS(LAP_OK, lap_context_set_log(w.context, on_log, &w));

    STATUS_IN(w.context, LAP_OK, cut_watched(&w, -1, mesh, &cut));
    CHECK(cut != NULL);
    STATUS(LAP_OK, lap_cut_free(cut));
    all = w.calls;
    CHECK(all > 0);
    CHECK(w.inside == LAP_ERR_BUSY);
    CHECK(w.freed == LAP_ERR_BUSY);

    /* Cancelled at each point where that is possible: nothing is left behind, and the context works on. */
    for (i = 0; i < all; ++i) {
        int32_t status = 0;
        cut = (lap_cut *)&w;
        STATUS_IN(w.context, LAP_ERR_CANCELLED, cut_watched(&w, i, mesh, &cut));
        CHECK(cut == NULL);
        STATUS(LAP_OK, lap_context_last_error(w.context, &status, NULL));
        CHECK(status == LAP_ERR_CANCELLED);
        CHECK(has_message(w.context));
    }
    STATUS_IN(w.context, LAP_OK, cut_watched(&w, -1, mesh, &cut));
    CHECK(w.calls == all);
    STATUS(LAP_OK, lap_cut_free(cut));

    /* Meshes can be cancelled too. */
    STATUS(LAP_OK, lap_mesh_free(mesh));
    w.calls = 0;
    w.last = 0;
    w.cancel_at = 0;
    mesh = (lap_mesh *)&w;
    STATUS_IN(w.context, LAP_ERR_CANCELLED, lap_mesh_new(w.context, 8, cube_xyz, 12, cube_indices, NULL, NULL, &mesh));
    CHECK(mesh == NULL);

    /* Callbacks can be taken away. */
    STATUS(LAP_OK, lap_context_set_progress(w.context, NULL, NULL));
    STATUS(LAP_OK, lap_context_set_log(w.context, NULL, NULL));
    w.calls = 0;
    mesh = good_mesh(w.context, 8, cube_xyz, 12, cube_indices, NULL);
    CHECK(w.calls == 0);
    STATUS(LAP_OK, lap_mesh_free(mesh));
    STATUS(LAP_OK, lap_context_free(w.context));
}

static void counters(void)
{
    lap_context *context = NULL;
    lap_mesh *mesh;
    lap_cut *cut = NULL;
    const double planes[12] = {1, 0, 0, -1, 1, 2, 3, -4, 3, -1, 1, -2};
    int32_t count = -1, i;
    int64_t value = 0, sum = 0;
    const char *name = NULL;

    STATUS(LAP_OK, lap_context_new(&context));
    STATUS(LAP_OK, lap_context_counters_enable(context, 1));
    mesh = good_mesh(context, 8, cube_xyz, 12, cube_indices, NULL);
    STATUS_IN(context, LAP_OK, lap_cut_new(context, mesh, 3, planes, NULL, &cut));
    STATUS(LAP_OK, lap_cut_free(cut));
    STATUS(LAP_OK, lap_context_counters_count(context, &count));
    CHECK(count > 0);
    for (i = 0; i < count; ++i) {
        STATUS(LAP_OK, lap_context_counter(context, i, &name, &value));
        CHECK(name != NULL && name[0] != 0 && value >= 0);
        sum += value;
    }
    CHECK(sum > 0);
    STATUS(LAP_OK, lap_context_counter(context, 0, NULL, NULL));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_context_counter(context, count, &name, &value));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_context_counter(context, -1, &name, &value));

    STATUS(LAP_OK, lap_context_counters_reset(context));
    STATUS(LAP_OK, lap_context_counters_count(context, &count));
    for (i = 0; i < count; ++i) {
        STATUS(LAP_OK, lap_context_counter(context, i, NULL, &value));
        CHECK(value == 0);
    }

    /* Switched off, nothing is counted. */
    STATUS(LAP_OK, lap_context_counters_enable(context, 0));
    STATUS_IN(context, LAP_OK, lap_cut_new(context, mesh, 3, planes, NULL, &cut));
    STATUS(LAP_OK, lap_cut_free(cut));
    STATUS(LAP_OK, lap_context_counters_count(context, &count));
    for (i = 0; i < count; ++i) {
        STATUS(LAP_OK, lap_context_counter(context, i, NULL, &value));
        CHECK(value == 0);
    }

    STATUS(LAP_ERR_NULL_POINTER, lap_context_counters_enable(NULL, 1));
    STATUS(LAP_ERR_NULL_POINTER, lap_context_counters_reset(NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_context_counters_count(NULL, &count));
    STATUS(LAP_ERR_NULL_POINTER, lap_context_counters_count(context, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_context_counter(NULL, 0, &name, &value));
    STATUS(LAP_OK, lap_mesh_free(mesh));
    STATUS(LAP_OK, lap_context_free(context));
}

void test_context(void)
{
    settings();
    errors();
    callbacks(1);
    callbacks(3);
    counters();
}
