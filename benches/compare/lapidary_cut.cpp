// The library, as a host calls it.
#include "contestants.hpp"

#include <lapidary.hpp>

#include <map>
#include <memory>

namespace benches {

Outcome lapidary_cut(const examples::Mesh& input, const Planes& planes, std::int32_t threads) {
  // A host has one context for its lifetime; the pool's threads start in the first run.
  static std::map<std::int32_t, std::unique_ptr<lapidary::context>> contexts;
  auto& context = contexts[threads];
  if (!context) context = std::make_unique<lapidary::context>(threads);

  Outcome outcome;
  const auto start = std::chrono::steady_clock::now();
  const lapidary::mesh mesh(*context, input.coordinates, input.triangles);
  const lapidary::cut cut(*context, mesh, planes);
  outcome.seconds = seconds_since(start);
  const auto moments = cut.complex().cell_moments();
  outcome.seconds_with_moments = seconds_since(start);
  outcome.cells = cut.complex().counts().cells;
  long double volume = 0; // many cells: their sum in double would show its own rounding
  for (double one : moments.volumes) volume += one;
  outcome.volume = static_cast<double>(volume);
  return outcome;
}

} // namespace benches
