/* Exact points for the tests against CGAL, held so that CGAL's predicates are quick on them: by intervals first, and on integers over a common
 * denominator where these cannot tell. Constructed points of many bits that are in one plane are the rule in what is tested, and exact
 * rationals that are reduced at every step are a hundred times slower there.
 */
#ifndef LAPIDARY_TEST_EXACT_POINTS_HPP
#define LAPIDARY_TEST_EXACT_POINTS_HPP

#include "rational.hpp"
#include "soup.hpp"

#include <CGAL/Gmpz.h>
#include <CGAL/Interval_nt.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Simple_homogeneous.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace exact_points {

using Rational = rational::number;
using soup::Corners;
using Intervals = CGAL::Simple_cartesian<CGAL::Interval_nt<false>>;
using Integers = CGAL::Simple_homogeneous<CGAL::Gmpz>;

/* A rational modulo two primes of 61 bits: two sums that differ are taken for equal once in 2^121. A sum of thousands of rationals over different
   denominators is known that way without ever being written down. */
class Residue {
public:
    Residue() = default;
    explicit Residue(const Rational &x)
    {
        for (std::size_t k = 0; k < 2; ++k) {
            r_[k] = times(mpz_fdiv_ui(x.numerator().mpz(), primes[k]), inverse(mpz_fdiv_ui(x.denominator().mpz(), primes[k]), k), k);
        }
    }
    friend Residue operator+(Residue x, const Residue &y)
    {
        for (std::size_t k = 0; k < 2; ++k) x.r_[k] = (x.r_[k] + y.r_[k]) % primes[k];
        return x;
    }
    friend Residue operator-(Residue x, const Residue &y)
    {
        for (std::size_t k = 0; k < 2; ++k) x.r_[k] = (x.r_[k] + primes[k] - y.r_[k]) % primes[k];
        return x;
    }
    friend Residue operator*(Residue x, const Residue &y)
    {
        for (std::size_t k = 0; k < 2; ++k) x.r_[k] = times(x.r_[k], y.r_[k], k);
        return x;
    }
    friend bool operator==(const Residue &x, const Residue &y) { return x.r_ == y.r_; }

private:
    static constexpr std::uint64_t primes[2] = {(std::uint64_t{1} << 61) - 1, (std::uint64_t{1} << 61) - 31};
    static_assert(sizeof(unsigned long) == 8, "mpz_fdiv_ui takes a prime of 61 bits");
    std::array<std::uint64_t, 2> r_{};

    __extension__ using Wide = unsigned __int128;
    static std::uint64_t times(std::uint64_t x, std::uint64_t y, std::size_t k)
    {
        return static_cast<std::uint64_t>(static_cast<Wide>(x) * y % primes[k]);
    }
    /* By Fermat. */
    static std::uint64_t inverse(std::uint64_t x, std::size_t k)
    {
        std::uint64_t power = 1;
        for (std::uint64_t n = primes[k] - 2; n > 0; n /= 2) {
            if (n % 2 == 1) power = times(power, x, k);
            x = times(x, x, k);
        }
        return power;
    }
};

class Points {
public:
    std::int32_t add(const std::array<Rational, 3> &x)
    {
        CGAL::Gmpz all = x[0].denominator();
        for (std::size_t i = 1; i < 3; ++i) all = all / CGAL::gcd(all, x[i].denominator()) * x[i].denominator();
        const auto whole = [&](std::size_t i) { return CGAL::Gmpz(x[i].numerator() * (all / x[i].denominator())); };
        integers_.emplace_back(whole(0), whole(1), whole(2), all);
        const auto interval = [&](std::size_t i) { return CGAL::Interval_nt<false>(CGAL::to_interval(x[i])); };
        intervals_.emplace_back(interval(0), interval(1), interval(2));
        residues_.push_back({Residue(x[0]), Residue(x[1]), Residue(x[2])});
        rationals_.push_back(x);
        return static_cast<std::int32_t>(rationals_.size() - 1);
    }
    const Integers::Point_3 &integer(std::int32_t v) const { return integers_[static_cast<std::size_t>(v)]; }
    const Intervals::Point_3 &interval(std::int32_t v) const { return intervals_[static_cast<std::size_t>(v)]; }
    const std::array<Rational, 3> &rational(std::int32_t v) const { return rationals_[static_cast<std::size_t>(v)]; }

    /* Whether two triangles have more in common than the vertices that they share by index. */
    bool meet_wrongly(const Corners &a, const Corners &b) const
    {
        return filtered([&](auto kernel, const auto &point) { return soup::meet_wrongly<decltype(kernel)>(point, a, b); });
    }
    bool is_flat(const Corners &t) const
    {
        return filtered([&](auto, const auto &point) -> bool { return CGAL::collinear(point(t[0]), point(t[1]), point(t[2])); });
    }

    /* None without area, and no two that meet wrongly. */
    bool are_embedded(const std::vector<Corners> &triangles) const
    {
        using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::size_t>;
        std::vector<Box> boxes;
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            if (is_flat(triangles[t])) return false;
            CGAL::Bbox_3 box;
            for (const std::int32_t v : triangles[t]) {
                const Intervals::Point_3 &p = interval(v);
                box += CGAL::Bbox_3(p.x().inf(), p.y().inf(), p.z().inf(), p.x().sup(), p.y().sup(), p.z().sup());
            }
            boxes.emplace_back(box, t);
        }
        bool good = true;
        CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box &a, const Box &b) {
            good = good && !meet_wrongly(triangles[a.info()], triangles[b.info()]);
        });
        return good;
    }

    /* Whether triangles that face outward bound this volume. */
    bool bound(const std::vector<Corners> &triangles, const Rational &volume) const
    {
        Residue six;
        for (const Corners &t : triangles) {
            const auto &a = residue(t[0]), &b = residue(t[1]), &c = residue(t[2]);
            for (std::size_t i = 0; i < 3; ++i) {
                const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
                six = six + a[i] * (b[j] * c[k] - b[k] * c[j]);
            }
        }
        return six == Residue(volume) * Residue(Rational(6));
    }

private:
    std::vector<Integers::Point_3> integers_;
    std::vector<Intervals::Point_3> intervals_;
    std::vector<std::array<Residue, 3>> residues_;
    std::vector<std::array<Rational, 3>> rationals_;

    const std::array<Residue, 3> &residue(std::int32_t v) const { return residues_[static_cast<std::size_t>(v)]; }

    /* What a question to CGAL gives on intervals if they are sure, else on integers. */
    template <class Ask>
    bool filtered(Ask ask) const
    {
        try {
            CGAL::Protect_FPU_rounding<true> upward;
            return ask(Intervals(), [&](std::int32_t v) -> const Intervals::Point_3 & { return interval(v); });
        } catch (const CGAL::Uncertain_conversion_exception &) {
        }
        return ask(Integers(), [&](std::int32_t v) -> const Integers::Point_3 & { return integer(v); });
    }
};

} // namespace exact_points

#endif
