/* Cubes in arrangements, and what is to hold of the surfaces made from them. */
#ifndef LAPIDARY_TEST_API_ARRANGEMENT_H
#define LAPIDARY_TEST_API_ARRANGEMENT_H

#include "api.h"

/* A cube of size 2 with its lowest corner somewhere, perhaps inside out. */
typedef struct box {
    double xyz[24];
    int32_t indices[36];
} box;

/* Fills a box; the operand borrows it. */
lap_operand boxed(box *b, double x, double y, double z, int reversed);

lap_arrangement *arranged(lap_context *context, int64_t n, const lap_operand *operands);

/* Whether a surface is closed and has that volume and Euler characteristic; frees it. */
void is_solid(lap_context *context, lap_surface *surface, const char *volume, int64_t euler);

/* The same of the surface of an operation (of at least two). */
void operation_is(lap_context *context, const lap_arrangement *a, int32_t operation, const char *volume, int64_t euler);

void test_arrangement_callbacks(void);

#endif
