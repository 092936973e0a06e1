/* Exact rationals for the tests against CGAL, and what it means for a double to be close to one. */
#ifndef LAPIDARY_TEST_RATIONAL_HPP
#define LAPIDARY_TEST_RATIONAL_HPP

#include <CGAL/Gmpq.h>

#include <cmath>
#include <limits>
#include <string>

namespace rational {

using number = CGAL::Gmpq;

/* "num/den", or "num". */
inline number parse(const std::string &text)
{
    return number(text);
}

/* Whether x is the double nearest to an exact value, ties to even. */
inline bool is_nearest(double x, const number &exact)
{
    if (exact == number(x)) return !(x == 0 && std::signbit(x));
    const double infinity = std::numeric_limits<double>::infinity();
    const number error = CGAL::abs(number(x) - exact);
    for (const double next : {std::nextafter(x, infinity), std::nextafter(x, -infinity)}) {
        const number other = CGAL::abs(number(next) - exact);
        if (other < error) return false;
        if (other == error) {
            /* A tie: of two neighbours, the one with an even significand. */
            int exponent = 0;
            const double significand = std::ldexp(std::frexp(x, &exponent), 53);
            return std::fmod(significand, 2) == 0;
        }
    }
    return true;
}

/* Whether x is within some units in the last place of an exact value. */
inline bool within_ulps(double x, const number &exact, int ulps)
{
    const double size = std::fabs(x);
    const double unit = std::nextafter(size, std::numeric_limits<double>::infinity()) - size;
    return CGAL::abs(number(x) - exact) <= number(unit) * number(ulps);
}

} // namespace rational

#endif
