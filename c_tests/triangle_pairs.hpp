/* Whether two triangles, or a triangle and a segment, certainly have nothing in common but the vertices that they share.
 *
 * A filter before CGAL's own tests, which go to rationals as soon as something is coplanar or shared: true is a proof, false
 * decides nothing. Proofs are signs of determinants: of doubles where a bound allows it, otherwise CGAL's exact ones. Two
 * passes, since nearly always some separation needs no exact sign; the first asks for none.
 *
 * The separations, in a projection along an axis and in space:
 *  - a line through an edge of one, with its third corner strictly on one side and all that is not shared of the other strictly on
 *    the other side. What lies above the line is then the edge, and of the other the hull of what is shared: nothing else is
 *    common, whatever the projection does to the rest. With one shared corner, the other may also lie on the line, beyond that
 *    corner as seen from the edge.
 *  - the plane of a triangle, with all that is not shared of the other on one side. What lies in the plane (shared, or with sign
 *    zero) is compared with the triangle in a projection.
 *  - a line in space that passes a triangle: two of its three edges see it turn opposite ways.
 * Triangles that meet elsewhere than in one shared corner do so at the edge opposite to it in one of them; those without shared
 * corners, at an edge of one of them.
 */
#ifndef LAPIDARY_TRIANGLE_PAIRS_HPP
#define LAPIDARY_TRIANGLE_PAIRS_HPP

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <array>
#include <cmath>

namespace pairs {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using At = const double *; /* three coordinates */
enum class Pass { doubles, exact };

/* The sign of the area that p, q, r span in the projection to the coordinates x and y; in the first pass, zero means unknown.
   The error is below 4 u (|left| + |right|) and the bound 90 times that; it is refused where products may underflow, and a
   comparison with what overflowed is false. */
inline int turn(At p, At q, At r, int x, int y, Pass pass)
{
    const double left = (q[x] - p[x]) * (r[y] - p[y]), right = (q[y] - p[y]) * (r[x] - p[x]);
    const double area = left - right, bound = 1e-14 * (std::abs(left) + std::abs(right));
    if (bound > 1e-280 && std::abs(area) > bound) return area > 0 ? 1 : -1;
    if (pass == Pass::doubles) return 0;
    const auto point = [&](At v) { return Kernel::Point_2(v[x], v[y]); };
    return static_cast<int>(CGAL::orientation(point(p), point(q), point(r)));
}

/* The sign of the volume that p, q, r, s span; otherwise as above (error below 8 u times the sum). */
inline int volume(At p, At q, At r, At s, Pass pass)
{
    double a[3], b[3], c[3];
    for (int k = 0; k < 3; ++k) {
        a[k] = q[k] - p[k];
        b[k] = r[k] - p[k];
        c[k] = s[k] - p[k];
    }
    double sum = 0, size = 0;
    for (int k = 0; k < 3; ++k) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        const double left = b[l] * c[m], right = b[m] * c[l];
        sum += a[k] * (left - right);
        size += std::abs(a[k]) * (std::abs(left) + std::abs(right));
    }
    const double bound = 1e-14 * size;
    if (bound > 1e-280 && std::abs(sum) > bound) return sum > 0 ? 1 : -1;
    if (pass == Pass::doubles) return 0;
    const auto point = [](At v) { return Kernel::Point_3(v[0], v[1], v[2]); };
    return static_cast<int>(CGAL::orientation(point(p), point(q), point(r), point(s)));
}

/* Corners, those shared with the other piece first, in the same order in both. */
struct Piece {
    std::array<At, 3> at{};
    int size = 0;
};

/* Whether m lies strictly between a and b, which are on one line in the projection. */
inline bool between(At a, At m, At b, int x, int y)
{
    const auto before = [&](At p, At q) { return p[x] < q[x] || (p[x] == q[x] && p[y] < q[y]); };
    return (before(a, m) && before(m, b)) || (before(b, m) && before(m, a));
}

/* By a line through an edge of the triangle `a`. */
inline bool apart_at_edge(const Piece &a, const Piece &b, int shared, int x, int y, Pass pass)
{
    for (int k = 0; k < 3; ++k) {
        /* The edge has to hold what is shared. */
        if (k < shared) continue;
        const int i = k == 0 ? 1 : 0, j = 3 - i - k;
        const int inner = turn(a.at[i], a.at[j], a.at[k], x, y, pass);
        if (inner == 0) continue;
        bool apart = true;
        for (int n = shared; n < b.size && apart; ++n) {
            const int side = turn(a.at[i], a.at[j], b.at[n], x, y, pass);
            apart = side == -inner;
            /* i is the shared corner. */
            if (side == 0 && pass == Pass::exact && shared == 1) apart = between(a.at[j], a.at[i], b.at[n], x, y);
        }
        if (apart) return true;
    }
    return false;
}

/* By the line through a segment that shares nothing. */
inline bool apart_at_segment(const Piece &segment, const Piece &a, int x, int y, Pass pass)
{
    const int first = turn(segment.at[0], segment.at[1], a.at[0], x, y, pass);
    if (first == 0) return false;
    for (int n = 1; n < a.size; ++n) {
        if (turn(segment.at[0], segment.at[1], a.at[n], x, y, pass) != first) return false;
    }
    return true;
}

/* The axis along which the triangle looks largest: any choice is sound. */
inline int widest(const Piece &a)
{
    const At p = a.at[0], q = a.at[1], r = a.at[2];
    double n[3];
    for (int k = 0; k < 3; ++k) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        n[k] = std::abs((q[l] - p[l]) * (r[m] - p[m]) - (q[m] - p[m]) * (r[l] - p[l]));
    }
    return n[0] >= n[1] && n[0] >= n[2] ? 0 : n[1] >= n[2] ? 1 : 2;
}

/* In the projection along an axis; `a` is a triangle. */
inline bool apart_along(int axis, const Piece &a, const Piece &b, int shared, Pass pass)
{
    const int x = (axis + 1) % 3, y = (axis + 2) % 3;
    if (apart_at_edge(a, b, shared, x, y, pass)) return true;
    if (b.size == 3) return apart_at_edge(b, a, shared, x, y, pass);
    return b.size == 2 && shared == 0 && apart_at_segment(b, a, x, y, pass);
}

/* By the plane of the triangle `a`. */
inline bool apart_at_plane(const Piece &a, const Piece &b, int shared, int axis, Pass pass)
{
    Piece inside;
    for (int n = 0; n < shared; ++n) inside.at[inside.size++] = b.at[n];
    int seen = 0;
    for (int n = shared; n < b.size; ++n) {
        const int side = volume(a.at[0], a.at[1], a.at[2], b.at[n], pass);
        if (side == 0 && pass == Pass::doubles) return false;
        if (side == 0) inside.at[inside.size++] = b.at[n];
        else if (seen == 0) seen = side;
        else if (seen != side) return false;
    }
    if (inside.size == shared) return true;
    /* `a` has no plane, or the other is in it: left to projections. */
    if (seen == 0) return false;
    return apart_along(axis, a, inside, shared, pass);
}

/* A segment and a triangle that share nothing. */
inline bool segment_apart(const Piece &a, At p, At q, int axis, Pass pass)
{
    const Piece segment{{p, q, nullptr}, 2};
    if (apart_at_plane(a, segment, 0, axis, pass) || apart_along(axis, a, segment, 0, pass)) return true;
    /* The line pierces the plane in one point, with these as its barycentric coordinates, if the ends are on different sides. */
    const int over = volume(a.at[0], a.at[1], a.at[2], p, pass), under = volume(a.at[0], a.at[1], a.at[2], q, pass);
    if (over * under >= 0) return false;
    int seen = 0;
    for (int k = 0; k < 3; ++k) {
        const int side = volume(p, q, a.at[k], a.at[(k + 1) % 3], pass);
        if (side * seen < 0) return true;
        if (side != 0) seen = side;
    }
    return false;
}

/* Two triangles with `shared` corners, fewer than three, in common. */
inline bool apart(const Piece &a, const Piece &b, int shared)
{
    const int over_a = widest(a), over_b = widest(b);
    for (const Pass pass : {Pass::doubles, Pass::exact}) {
        if (apart_along(over_a, a, b, shared, pass)) return true;
        if (over_b != over_a && apart_along(over_b, b, a, shared, pass)) return true;
        if (apart_at_plane(a, b, shared, over_a, pass) || apart_at_plane(b, a, shared, over_b, pass)) return true;
        if (shared == 2) continue;
        bool all = true;
        for (int k = 0; k < 3 && all; ++k) {
            /* Of edges, those opposite to the shared corner, or all. */
            if (shared == 1 && k != 1) continue;
            const int l = (k + 1) % 3;
            all = segment_apart(a, b.at[k], b.at[l], over_a, pass) && segment_apart(b, a.at[k], a.at[l], over_b, pass);
        }
        if (all) return true;
    }
    return false;
}

/* A triangle and a segment, whose ends may be corners of it: then they do meet. */
inline bool apart(const Piece &a, At p, At q)
{
    const int axis = widest(a);
    return segment_apart(a, p, q, axis, Pass::doubles) || segment_apart(a, p, q, axis, Pass::exact);
}

} // namespace pairs

#endif
