// What is compared: functions that cut a solid along planes, all from the same flat arrays to a finished result.
//
// Each does one run and times itself, so that what a contestant does not have to do (freeing, summing up volumes) is outside
// its time. A contestant that cannot give the cells throws std::runtime_error saying why.
#ifndef LAPIDARY_BENCHES_CONTESTANTS_HPP
#define LAPIDARY_BENCHES_CONTESTANTS_HPP

#include "reader.hpp"

#include <chrono>
#include <cstdint>
#include <vector>

namespace benches {

struct Outcome {
  double seconds = 0;              // flat arrays to cells
  double seconds_with_moments = 0; // the same and volume and centroid of every cell; 0 where that is not measured
  double seconds_prepared = 0;     // planes to cells on a mesh that is there already; 0 where that is not measured
  double seconds_moved = 0;        // new coordinates on the mesh that is there; 0 where that is not measured
  std::int64_t cells = 0;
  std::int64_t faces = 0;
  double volume = 0; // sum over the cells
};

using Planes = std::vector<double>; // a, b, c, d for a x + b y + c z + d = 0

// The library, through its C interface.
Outcome lapidary_cut(const examples::Mesh& mesh, const Planes& planes, std::int32_t threads);
// CGAL's Polygon Mesh Processing, with rounded and with exact constructions.
Outcome pmp_epick(const examples::Mesh& mesh, const Planes& planes);
Outcome pmp_epeck(const examples::Mesh& mesh, const Planes& planes);
// CGAL's Nef polyhedra, with exact constructions.
Outcome nef(const examples::Mesh& mesh, const Planes& planes);

inline double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

} // namespace benches

#endif
