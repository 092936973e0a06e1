// One macro for the tests of the examples: says what did not hold and goes on; main returns `expect_failures`.
#ifndef LAPIDARY_TESTS_EXPECT_HPP
#define LAPIDARY_TESTS_EXPECT_HPP

#include <cstdio>

inline int expect_failures = 0;

#define EXPECT(condition, ...)                                                                                         \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            std::printf("%s:%d: %s: ", __FILE__, __LINE__, #condition);                                                \
            std::printf(__VA_ARGS__);                                                                                  \
            std::printf("\n");                                                                                         \
            ++expect_failures;                                                                                         \
        }                                                                                                              \
    } while (false)

#endif
