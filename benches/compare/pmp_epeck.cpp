// Polygon Mesh Processing with exact constructions.
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

#include "pmp.hpp"

namespace benches {

Outcome pmp_epeck(const examples::Mesh& mesh, const Planes& planes) {
  return PmpCutter<CGAL::Exact_predicates_exact_constructions_kernel>::cut(mesh, planes);
}

} // namespace benches
