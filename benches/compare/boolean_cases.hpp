// Operands for bench_boolean, the same as those of benches/arrangement.rs (tests/common/shapes.rs, random.rs): bunnies, rocker-arms, cubes
// of squares, cubes in random rotation, spheres.
#ifndef LAPIDARY_BENCHES_BOOLEAN_CASES_HPP
#define LAPIDARY_BENCHES_BOOLEAN_CASES_HPP

#include "icosphere.hpp"
#include "planes.hpp"
#include "reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace benches {

using Vector = std::array<double, 3>;
using Matrix = std::array<Vector, 3>; // rows

// SplitMix64.
struct Random {
  std::uint64_t state;

  std::uint64_t bits() {
    state += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  // In [0, 1) and in [-1, 1).
  double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double sign() { return static_cast<double>(bits() >> 11) * 0x1p-52 - 1; }
};

// A rotation, uniform among all, rounded: a point of the unit ball in four dimensions, as a quaternion.
inline Matrix rotation(Random& random) {
  double q[4], square;
  do {
    square = 0;
    for (double& c : q) {
      c = random.sign();
      square += c * c;
    }
  } while (square < 0.01 || square >= 1);
  for (double& c : q) c /= std::sqrt(square);
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
           {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
           {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

inline examples::Mesh moved(const examples::Mesh& mesh, const Matrix& matrix, const Vector& shift) {
  examples::Mesh out = mesh;
  for (std::size_t v = 0; v < mesh.coordinates.size(); v += 3)
    for (std::size_t i = 0; i < 3; ++i) {
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k) sum += matrix[i][k] * mesh.coordinates[v + k];
      out.coordinates[v + i] = sum + shift[i];
    }
  return out;
}

inline examples::Mesh shifted(const examples::Mesh& mesh, const Vector& shift) {
  return moved(mesh, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, shift);
}

inline double diagonal(const examples::Mesh& mesh) {
  const examples::Box box = examples::bounding_box(mesh);
  double square = 0;
  for (std::size_t i = 0; i < 3; ++i) square += (box.max[i] - box.min[i]) * (box.max[i] - box.min[i]);
  return std::sqrt(square);
}

// The cube from `low` to `low + n` with n * n squares a side, each of two triangles.
inline examples::Mesh grid_cube(int n, const Vector& low) {
  examples::Mesh mesh;
  std::map<std::array<int, 3>, std::int32_t> numbers;
  const auto number = [&](const std::array<int, 3>& p) {
    const auto [place, fresh] = numbers.try_emplace(p, static_cast<std::int32_t>(numbers.size()));
    if (fresh)
      for (std::size_t i = 0; i < 3; ++i) mesh.coordinates.push_back(low[i] + p[i]);
    return place->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const bool outward : {false, true})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int a, int b) {
            std::array<int, 3> p{};
            p[axis] = outward ? n : 0, p[(axis + 1) % 3] = i + a, p[(axis + 2) % 3] = j + b;
            return number(p);
          };
          const std::int32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          if (outward) mesh.triangles.insert(mesh.triangles.end(), {a, b, c, a, c, d});
          else mesh.triangles.insert(mesh.triangles.end(), {a, c, b, a, d, c});
        }
  return mesh;
}

// An icosahedron with n * n triangles for each face, on the unit sphere.
inline examples::Mesh geodesic(int n) {
  const examples::Mesh coarse = icosphere(0);
  examples::Mesh mesh;
  // A point by the corners that count and their weights, rising by corner, so that faces agree on what they share.
  std::map<std::array<std::int32_t, 6>, std::int32_t> shared;
  const auto add = [&](const std::array<std::int32_t, 6>& name) {
    double x[3] = {0, 0, 0}, square = 0;
    for (std::size_t k = 0; k < 6; k += 2)
      for (int i = 0; i < 3 && name[k] >= 0; ++i)
        x[i] += name[k + 1] * coarse.coordinates[3 * static_cast<std::size_t>(name[k]) + static_cast<std::size_t>(i)];
    for (double c : x) square += c * c;
    for (double c : x) mesh.coordinates.push_back(c / std::sqrt(square));
    return static_cast<std::int32_t>(mesh.coordinates.size() / 3 - 1);
  };
  const auto width = static_cast<std::size_t>(n + 1);
  std::vector<std::int32_t> numbers(width * width);
  for (std::size_t f = 0; f < coarse.triangles.size(); f += 3) {
    const auto number = [&](int i, int j) -> std::int32_t& {
      return numbers[static_cast<std::size_t>(i) * width + static_cast<std::size_t>(j)];
    };
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n - i; ++j) {
        std::array<std::pair<std::int32_t, std::int32_t>, 3> weights{
            {{coarse.triangles[f], n - i - j}, {coarse.triangles[f + 1], i}, {coarse.triangles[f + 2], j}}};
        std::sort(weights.begin(), weights.end());
        std::array<std::int32_t, 6> name{-1, -1, -1, -1, -1, -1};
        std::size_t used = 0;
        for (const auto& [corner, weight] : weights)
          if (weight > 0) name[used++] = corner, name[used++] = weight;
        if (used == 6) {
          number(i, j) = add(name); // within the face
          continue;
        }
        const auto [place, fresh] = shared.try_emplace(name, 0);
        if (fresh) place->second = add(name);
        number(i, j) = place->second;
      }
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n - i; ++j) {
        const std::int32_t a = number(i, j), b = number(i + 1, j), c = number(i, j + 1);
        mesh.triangles.insert(mesh.triangles.end(), {a, b, c});
        if (i + j + 2 <= n) mesh.triangles.insert(mesh.triangles.end(), {b, number(i + 1, j + 1), c});
      }
  }
  return mesh;
}

// A mesh and itself, rotated and shifted by a fifth of its size.
inline std::vector<examples::Mesh> turned_pair(const examples::Mesh& mesh) {
  Random random{1};
  return {mesh, moved(mesh, rotation(random), {0.2 * diagonal(mesh), 0, 0})};
}

// A mesh and itself, shifted by a twentieth of its size.
inline std::vector<examples::Mesh> shifted_pair(const examples::Mesh& mesh) {
  const double d = diagonal(mesh) / 20;
  return {mesh, shifted(mesh, {d * 0.6, d * 0.48, d * 0.64})};
}

// Two cubes of n * n squares a side, half a square apart.
inline std::vector<examples::Mesh> squares(int n) { return {grid_cube(n, {0, 0, 0}), grid_cube(n, {0.5, 0.25, 0})}; }

// Unit cubes in random rotation, centres uniform in [0, 2]^3.
inline std::vector<examples::Mesh> random_cubes(long count) {
  Random random{1};
  const examples::Mesh cube = grid_cube(1, {-0.5, -0.5, -0.5});
  std::vector<examples::Mesh> cubes;
  for (long i = 0; i < count; ++i) {
    const Matrix matrix = rotation(random);
    Vector centre;
    for (double& c : centre) c = 2 * random.unit();
    cubes.push_back(moved(cube, matrix, centre));
  }
  return cubes;
}

// Two unit spheres of 20 n * n triangles each, centres 0.8 apart in a general direction.
inline std::vector<examples::Mesh> spheres(int n) {
  const examples::Mesh sphere = geodesic(n);
  return {sphere, shifted(sphere, {0.8 * 0.36, 0.8 * 0.48, 0.8 * 0.8})};
}

} // namespace benches

#endif
