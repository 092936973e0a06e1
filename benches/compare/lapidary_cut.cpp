// The library, as a host calls it.
#include "contestants.hpp"

#include <lapidary.hpp>

#include <map>
#include <memory>
#include <vector>

namespace benches {

Outcome lapidary_cut(const examples::Mesh& input, const Planes& planes, std::int32_t threads) {
  // A host has one context for its lifetime; the pool's threads start in the first run.
  static std::map<std::int32_t, std::unique_ptr<lapidary::context>> contexts;
  auto& context = contexts[threads];
  if (!context) context = std::make_unique<lapidary::context>(threads);

  Outcome outcome;
  const auto start = std::chrono::steady_clock::now();
  lapidary::mesh mesh(*context, input.coordinates, input.triangles);
  {
    const lapidary::cut cut(*context, mesh, planes);
    outcome.seconds = seconds_since(start);
    const auto moments = cut.complex().cell_moments();
    outcome.seconds_with_moments = seconds_since(start);
    outcome.cells = cut.complex().counts().cells;
    outcome.faces = cut.complex().counts().faces;
    long double volume = 0; // many cells: their sum in double would show its own rounding
    for (double one : moments.volumes) volume += one;
    outcome.volume = static_cast<double>(volume);
  }
  {
    const auto again = std::chrono::steady_clock::now();
    const lapidary::cut cut(*context, mesh, planes);
    outcome.seconds_prepared = seconds_since(again);
  }
  const auto held = mesh.vertices().xyz;
  const std::vector<double> coordinates(held.data, held.data + 3 * held.count);
  const auto moved = std::chrono::steady_clock::now();
  mesh.update_coordinates(*context, coordinates);
  outcome.seconds_moved = seconds_since(moved);
  return outcome;
}

} // namespace benches
