// The library, as a host calls it.
#include "booleans.hpp"
#include "contestants.hpp"

#include <lapidary.hpp>

#include <map>
#include <memory>

namespace benches {

UnionOutcome lapidary_union(const std::vector<examples::Mesh>& meshes, std::int32_t threads) {
  // A host has one context for its lifetime; the pool's threads start in the first run.
  static std::map<std::int32_t, std::unique_ptr<lapidary::context>> contexts;
  auto& context = contexts[threads];
  if (!context) context = std::make_unique<lapidary::context>(threads);
  std::vector<lap_operand> operands;
  for (const examples::Mesh& mesh : meshes)
    operands.push_back({mesh.vertex_count(), mesh.coordinates.data(), mesh.triangle_count(), mesh.triangles.data()});

  UnionOutcome outcome;
  const auto start = std::chrono::steady_clock::now();
  const lapidary::arrangement arrangement(*context, operands);
  const lapidary::surface surface = arrangement.extract(*context, LAP_EXTRACT_UNION);
  outcome.triangles = surface.triangles().vertices.size();
  outcome.seconds = outcome.seconds_with_meshes = seconds_since(start);
  const auto xyz = surface.vertices().xyz;
  const auto corners = surface.triangles().vertices;
  outcome.volume = volume_of(corners.size(), [&](std::int64_t t, int k) { return xyz[corners[t][k]]; });
  return outcome;
}

} // namespace benches
