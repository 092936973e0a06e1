/* The parts of the test of every function of the C interface, and the shapes that they use. */
#ifndef LAPIDARY_TEST_API_H
#define LAPIDARY_TEST_API_H

#include "../check.h"

#include <stddef.h>

/* A cube [0, 2]^3: 8 vertices, 12 triangles, anticlockwise from outside; tag of a triangle: its face, 10 to 15. */
extern const double cube_xyz[24];
extern const int32_t cube_indices[36];
extern const int32_t cube_tags[12];

/* A cube [0, 4]^3 with a void [1, 3]^3: 16 vertices, 24 triangles. */
extern const double hollow_xyz[48];
extern const int32_t hollow_indices[72];

/* Makes a mesh that is known to be good. */
lap_mesh *good_mesh(lap_context *context, int64_t n_vertices, const double *xyz, int64_t n_triangles,
                    const int32_t *indices, const int32_t *tags);

/* Whether the context's last defects have this kind with these ids (an id of -2: any). */
int has_defect(lap_context *context, int32_t kind, int64_t a, int64_t b, int64_t c);

/* The message of the context's last error is not empty. */
int has_message(lap_context *context);

/* Makes a handle from some input, and frees it. */
typedef struct maker {
    int32_t (*make)(lap_context *context, const void *input, void **made);
    int32_t (*release)(void *made);
    const void *input;
} maker;

/* Makes it once, then cancels at every call of progress that there was: nothing is left behind, and the fraction never falls. */
void cancel_everywhere(lap_context *context, maker m);

void test_status(void);
void test_context(void);
void test_mesh(void);
void test_cut(void);
void test_complex(void);
void test_certify(void);
void test_keys(void);
void test_grid(void);
void test_simplex(void);
void test_network(void);
void test_arrangement(void);
void test_surface_certify(void);

#endif
