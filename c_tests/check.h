/* Checks that count failures and go on, for the C and C++ tests. A test's main ends with `return check_result();`. */
#ifndef LAPIDARY_CHECK_H
#define LAPIDARY_CHECK_H

#include "lapidary.h"

#include <stdio.h>

#ifdef __cplusplus
inline int check_failures = 0;
inline long check_count = 0;
#else
extern int check_failures;
extern long check_count;
#endif

static inline void check_that(int holds, const char *what, const char *file, int line)
{
    ++check_count;
    if (!holds) {
        ++check_failures;
        fprintf(stderr, "%s:%d: does not hold: %s\n", file, line, what);
    }
}

static inline void check_status(int32_t got, int32_t expected, lap_context *context, const char *what, const char *file,
                                int line)
{
    const char *got_name = "", *expected_name = "", *message = "";
    ++check_count;
    if (got == expected) return;
    ++check_failures;
    lap_status_name(got, &got_name);
    lap_status_name(expected, &expected_name);
    if (context != NULL) lap_context_last_error(context, NULL, &message);
    fprintf(stderr, "%s:%d: %s gives %s, not %s (%s)\n", file, line, what, got_name, expected_name, message);
}

static inline int check_result(void)
{
    printf("%ld checks, %d failures\n", check_count, check_failures);
    /* A program that checked nothing has failed. */
    return check_failures == 0 && check_count > 0 ? 0 : 1;
}

#define CHECK(condition) check_that((condition) ? 1 : 0, #condition, __FILE__, __LINE__)
/* The status of a call without a context, and with one. */
#define STATUS(expected, call) check_status((call), (expected), NULL, #call, __FILE__, __LINE__)
#define STATUS_IN(context, expected, call) check_status((call), (expected), (context), #call, __FILE__, __LINE__)

#endif
