// Polygon Mesh Processing with exact predicates on rounded constructions.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "pmp.hpp"

namespace benches {

Outcome pmp_epick(const examples::Mesh& mesh, const Planes& planes) {
  return PmpCutter<CGAL::Exact_predicates_inexact_constructions_kernel>::cut(mesh, planes);
}

} // namespace benches
