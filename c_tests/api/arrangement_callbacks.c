/* Surfaces of cells that a callback or a table chooses, also where the callback itself calls the library; cancelling. */
#include "arrangement.h"

#include <string.h>

/* What a callback does meanwhile. */
typedef struct caller {
    lap_context *context, *other;
    const lap_arrangement *arrangement;
    int64_t operands;
    int asked, take_unbounded;
} caller;

/* Inside exactly one; and calls back: with the context that is in use, with the handle alone, and with another context. */
static int32_t inside_one(void *user, int32_t cell, int64_t n, const int32_t *winding)
{
    caller *c = (caller *)user;
    int64_t i, inside = 0, cells = 0;
    const double *volumes = NULL;
    const char *text = NULL;
    lap_surface *surface = NULL;

    CHECK(cell == c->asked && n == c->operands);
    ++c->asked;
    for (i = 0; i < n; ++i) inside += winding[i] > 0;
    if (c->context != NULL) {
        box b;
        const lap_operand one = boxed(&b, 0, 0, 0, 0);
        lap_arrangement *a = NULL;
        STATUS(LAP_ERR_BUSY, lap_arrangement_extract(c->context, c->arrangement, LAP_EXTRACT_UNION, 0, &surface));
        STATUS(LAP_ERR_BUSY, lap_arrangement_new(c->context, 1, &one, NULL, &a));
        STATUS(LAP_ERR_BUSY, lap_arrangement_cell_volume_exact(c->context, c->arrangement, cell, &text));
        STATUS(LAP_ERR_BUSY, lap_context_free(c->context));
        /* These start threads of their own. */
        STATUS(LAP_OK, lap_arrangement_cell_volumes(c->arrangement, &cells, &volumes));
        CHECK(cell < cells && (cell == 0) == (volumes[cell] == 0));
        STATUS_IN(c->other, LAP_OK, lap_arrangement_extract(c->other, c->arrangement, LAP_EXTRACT_UNION, 0, &surface));
        is_solid(c->other, surface, "15", 2);
        STATUS_IN(c->other, LAP_OK, lap_arrangement_new(c->other, 1, &one, NULL, &a));
        operation_is(c->other, a, LAP_EXTRACT_UNION, "8", 2);
        STATUS(LAP_OK, lap_arrangement_free(a));
    }
    return inside == 1 || (cell == 0 && c->take_unbounded);
}

static int32_t go_on(void *user, const char *stage, double fraction)
{
    (void)stage;
    (void)fraction;
    ++*(int *)user;
    return 0;
}

static void callbacks(lap_context *context)
{
    box b[2];
    lap_operand two[2];
    caller c;
    lap_surface *surface = NULL;
    uint8_t table[4] = {0, 0, 0, 0};
    const int32_t *offsets = NULL;
    lap_arrangement *a = NULL;
    int threads, watched = 0, i;

    two[0] = boxed(&b[0], 0, 0, 0, 0);
    two[1] = boxed(&b[1], 1, 1, 1, 0);
    memset(&c, 0, sizeof c);
    c.operands = 2;
    STATUS(LAP_OK, lap_context_new(&c.other));
    for (threads = 1; threads <= 3; ++threads) {
        STATUS_IN(context, LAP_OK, lap_context_set_threads(context, threads));
        STATUS_IN(context, LAP_OK, lap_context_set_progress(context, threads == 2 ? go_on : NULL, &watched));
        a = arranged(context, 2, two);
        c.arrangement = a;
        c.context = context;
        c.asked = 0;
        STATUS_IN(context, LAP_OK, lap_arrangement_extract_callback(context, a, inside_one, &c, &surface));
        CHECK(c.asked == 4);
        is_solid(context, surface, "14", 4);
        if (threads < 3) STATUS(LAP_OK, lap_arrangement_free(a));
    }
    CHECK(watched > 0);
    STATUS_IN(context, LAP_OK, lap_context_set_threads(context, 1));
    c.context = NULL;
    c.asked = 0;
    c.take_unbounded = 1;
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_extract_callback(context, a, inside_one, &c, &surface));
    CHECK(surface == NULL && has_message(context));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_extract_callback(context, a, NULL, NULL, &surface));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_extract_callback(context, a, inside_one, &c, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_extract_callback(context, NULL, inside_one, &c, &surface));

    STATUS(LAP_OK, lap_arrangement_cells(a, NULL, &offsets, NULL, NULL));
    for (i = 0; i < 4; ++i) table[i] = offsets[i + 1] - offsets[i] == 2 ? 255 : 0;
    STATUS_IN(context, LAP_OK, lap_arrangement_extract_table(context, a, 4, table, &surface));
    is_solid(context, surface, "1", 2);
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_extract_table(context, a, 3, table, &surface));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_extract_table(context, a, -4, table, &surface));
    table[0] = 1;
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_arrangement_extract_table(context, a, 4, table, &surface));
    CHECK(surface == NULL && has_message(context));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_extract_table(context, a, 4, NULL, &surface));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_extract_table(context, a, 4, table, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_arrangement_extract_table(context, NULL, 4, table, &surface));
    STATUS(LAP_OK, lap_arrangement_free(a));
    STATUS(LAP_OK, lap_context_free(c.other));
}

static int32_t arrange(lap_context *context, const void *input, void **made)
{
    lap_arrangement *a = (lap_arrangement *)&a;
    const int32_t status = lap_arrangement_new(context, 2, (const lap_operand *)input, NULL, &a);
    *made = a;
    return status;
}

static int32_t release(void *made) { return lap_arrangement_free((lap_arrangement *)made); }

static void cancel(lap_context *context)
{
    box b[2];
    lap_operand two[2];
    maker m = {arrange, release, NULL};
    two[0] = boxed(&b[0], 0, 0, 0, 0);
    two[1] = boxed(&b[1], 1, 1, 1, 0);
    m.input = two;
    cancel_everywhere(context, m);
}

void test_arrangement_callbacks(void)
{
    lap_context *context = NULL;
    STATUS(LAP_OK, lap_context_new(&context));
    callbacks(context);
    cancel(context);
    STATUS(LAP_OK, lap_context_free(context));
}
