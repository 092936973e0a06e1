// CGAL's Polygon Mesh Processing: corefinement with exact predicates on rounded constructions, as its documentation advises for one
// boolean. Nobody checks there whether the result intersects itself; its volume tells.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "booleans.hpp"
#include "pmp.hpp"

namespace benches {

UnionOutcome corefined_union(const std::vector<examples::Mesh>& meshes) {
  namespace PMP = CGAL::Polygon_mesh_processing;
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Cutter = PmpCutter<Kernel>;
  const auto start = std::chrono::steady_clock::now();
  std::vector<Cutter::Surface> surfaces;
  for (const examples::Mesh& mesh : meshes) surfaces.push_back(Cutter::surface_of(mesh));
  const auto made = std::chrono::steady_clock::now();
  Cutter::Surface joined = std::move(surfaces[0]);
  for (std::size_t i = 1; i < surfaces.size(); ++i) {
    Cutter::Surface next;
    if (!PMP::corefine_and_compute_union(joined, surfaces[i], next))
      throw std::runtime_error("the union of the first " + std::to_string(i + 1) + " would not be manifold");
    joined = std::move(next);
  }
  UnionOutcome outcome;
  outcome.seconds = seconds_since(made);
  outcome.seconds_with_meshes = seconds_since(start);
  outcome.triangles = static_cast<std::int64_t>(faces(joined).size());
  std::vector<std::array<double, 9>> corners;
  for (const auto f : faces(joined)) {
    std::array<double, 9> nine;
    std::size_t k = 0;
    for (const auto v : vertices_around_face(halfedge(f, joined), joined))
      for (int c = 0; c < 3; ++c) nine[k++] = joined.point(v)[c];
    corners.push_back(nine);
  }
  const auto corner = [&](std::int64_t t, int k) { return &corners[static_cast<std::size_t>(t)][3 * static_cast<std::size_t>(k)]; };
  outcome.volume = volume_of(outcome.triangles, corner);
  return outcome;
}

} // namespace benches
