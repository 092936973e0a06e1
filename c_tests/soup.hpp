/* Triangles that share vertices by index, for the tests against CGAL. */
#ifndef LAPIDARY_TEST_SOUP_HPP
#define LAPIDARY_TEST_SOUP_HPP

#include <CGAL/Simple_cartesian.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace soup {

using Corners = std::array<std::int32_t, 3>;

/* Whether two triangles that share vertices by index have nothing else in common. `point` gives a vertex's exact point. */
template <class Kernel, class PointOf>
bool only_shared(const PointOf &point, const Corners &a, const Corners &b)
{
    std::vector<typename Kernel::Point_3> shared;
    for (const std::int32_t v : a) {
        if (std::find(b.begin(), b.end(), v) != b.end()) shared.push_back(point(v));
    }
    if (shared.size() == 3) return false;
    const auto triangle = [&](const Corners &t) { return typename Kernel::Triangle_3(point(t[0]), point(t[1]), point(t[2])); };
    const auto common = CGAL::intersection(triangle(a), triangle(b));
    if (!common) return shared.empty();
    if (const auto *p = boost::get<typename Kernel::Point_3>(&*common)) return shared.size() == 1 && *p == shared[0];
    if (const auto *s = boost::get<typename Kernel::Segment_3>(&*common)) {
        return shared.size() == 2 && ((s->source() == shared[0] && s->target() == shared[1]) ||
                                      (s->source() == shared[1] && s->target() == shared[0]));
    }
    return false;
}

/* Whether two triangles have more in common than the vertices that they share by index, by CGAL's predicates alone. Sharing a corner, they
   meet elsewhere only if the edge opposite to it in one of them meets the other; sharing an edge, only if they are in one plane,
   folded onto each other. */
template <class Kernel, class PointOf>
bool meet_wrongly(const PointOf &point, const Corners &a, const Corners &b)
{
    const auto triangle = [&](const Corners &t) { return typename Kernel::Triangle_3(point(t[0]), point(t[1]), point(t[2])); };
    const auto is_in = [](const Corners &t, std::int32_t v) { return std::find(t.begin(), t.end(), v) != t.end(); };
    const auto shared = std::count_if(a.begin(), a.end(), [&](std::int32_t v) { return is_in(b, v); });
    if (shared == 0) return CGAL::do_intersect(triangle(a), triangle(b));
    if (shared == 3) return true;
    /* Corners of `t`, those shared with `other` (or those that are not) first, in the order of their ids. */
    const auto sorted = [&](Corners t, const Corners &other, bool shared_first) {
        std::sort(t.begin(), t.end(), [&](std::int32_t v, std::int32_t w) {
            return std::make_pair(is_in(other, v) != shared_first, v) < std::make_pair(is_in(other, w) != shared_first, w);
        });
        return t;
    };
    if (shared == 1) {
        const auto opposite = [&](const Corners &t, const Corners &other) {
            const Corners s = sorted(t, other, false);
            return typename Kernel::Segment_3(point(s[0]), point(s[1]));
        };
        return CGAL::do_intersect(triangle(a), opposite(b, a)) || CGAL::do_intersect(triangle(b), opposite(a, b));
    }
    const Corners s = sorted(a, b, true), t = sorted(b, a, true);
    const auto p = point(s[0]), q = point(s[1]), r = point(s[2]), o = point(t[2]);
    return CGAL::orientation(p, q, r, o) == CGAL::COPLANAR && CGAL::coplanar_orientation(p, q, r, o) == CGAL::POSITIVE;
}

} // namespace soup

#endif
