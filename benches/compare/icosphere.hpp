// A sphere of 20 * 4^level triangles, for tables of growth: an icosahedron whose triangles are divided in four, `level`
// times, with all vertices moved to the unit sphere (rounded; the mesh, not the sphere, is what is cut).
#ifndef LAPIDARY_BENCHES_ICOSPHERE_HPP
#define LAPIDARY_BENCHES_ICOSPHERE_HPP

#include "reader.hpp"

#include <cmath>
#include <map>
#include <utility>

namespace benches {

inline examples::Mesh icosphere(int level) {
  examples::Mesh mesh;
  const auto add = [&](double x, double y, double z) {
    const double length = std::sqrt(x * x + y * y + z * z);
    mesh.coordinates.insert(mesh.coordinates.end(), {x / length, y / length, z / length});
    return static_cast<std::int32_t>(mesh.coordinates.size() / 3 - 1);
  };
  const double g = (1 + std::sqrt(5.0)) / 2;
  for (double s : {-1.0, 1.0})
    for (double t : {-g, g}) add(s, t, 0), add(0, s, t), add(t, 0, s);
  // All triples of vertices at distance 2 are the faces; anticlockwise from outside.
  const auto at = [&](int v) { return &mesh.coordinates[3 * static_cast<std::size_t>(v)]; };
  const auto dot = [](const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  const auto near = [&](int a, int b) { return dot(at(a), at(b)) > 0.4; }; // 1/sqrt(5), and otherwise negative
  for (int a = 0; a < 12; ++a)
    for (int b = a + 1; b < 12; ++b)
      for (int c = b + 1; c < 12; ++c) {
        if (!near(a, b) || !near(b, c) || !near(a, c)) continue;
        const double *p = at(a), *q = at(b), *r = at(c);
        const double cross[3] = {q[1] * r[2] - q[2] * r[1], q[2] * r[0] - q[0] * r[2], q[0] * r[1] - q[1] * r[0]};
        if (dot(p, cross) > 0) mesh.triangles.insert(mesh.triangles.end(), {a, b, c});
        else mesh.triangles.insert(mesh.triangles.end(), {a, c, b});
      }
  for (int i = 0; i < level; ++i) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
    const auto middle = [&](std::int32_t a, std::int32_t b) {
      const auto [place, fresh] = middles.try_emplace(std::minmax(a, b), 0);
      if (fresh) place->second = add(at(a)[0] + at(b)[0], at(a)[1] + at(b)[1], at(a)[2] + at(b)[2]);
      return place->second;
    };
    std::vector<std::int32_t> finer;
    for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
      const std::int32_t a = mesh.triangles[t], b = mesh.triangles[t + 1], c = mesh.triangles[t + 2];
      const std::int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
    }
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

} // namespace benches

#endif
