// What is compared: functions that unite meshes, each in a time that it takes itself: without freeing, without summing up volumes.
#ifndef LAPIDARY_BENCHES_BOOLEANS_HPP
#define LAPIDARY_BENCHES_BOOLEANS_HPP

#include "reader.hpp"

#include <cstdint>
#include <vector>

namespace benches {

struct UnionOutcome {
  double seconds = 0;             // the boolean; of the library: from flat arrays to flat arrays
  double seconds_with_meshes = 0; // the same and the peer's own meshes from flat arrays
  std::int64_t triangles = 0;     // of the result
  double volume = 0;
};

// The library, through its C interface: an arrangement of all meshes, and the surface of their union.
UnionOutcome lapidary_union(const std::vector<examples::Mesh>& meshes, std::int32_t threads);
// CGAL's corefinement with rounded constructions: the second mesh to the first, then the third, and so on.
UnionOutcome corefined_union(const std::vector<examples::Mesh>& meshes);

// What a closed surface bounds, as a sum of cones to its first corner: `corner(t, k)` is where the coordinates of corner k of triangle t
// begin. A sum in doubles would show its own rounding.
template <class Corner>
double volume_of(std::int64_t triangles, const Corner& corner) {
  long double six = 0;
  const double* apex = triangles > 0 ? corner(0, 0) : nullptr;
  for (std::int64_t t = 0; t < triangles; ++t) {
    long double d[3][3];
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 3; ++c) d[k][c] = static_cast<long double>(corner(t, k)[c]) - apex[c];
    six += d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) + d[0][1] * (d[1][2] * d[2][0] - d[1][0] * d[2][2]) +
           d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]);
  }
  return static_cast<double>(six / 6);
}

} // namespace benches

#endif
