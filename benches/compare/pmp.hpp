// Cutting by CGAL's Polygon Mesh Processing, for any kernel: every plane in turn halves every piece that it divides.
//
// Both halves of a piece come from one corefinement with a box that ends at the plane
// (corefine_and_compute_boolean_operations): PMP::clip with clip_volume, once per side, corefines twice and took 1.2 to
// 1.8 times as long where we tried it. A piece without vertices strictly on both sides is left alone, which spares CGAL the planes that only
// touch. At the end, PMP::volume_connected_components tells the cells of each piece apart.
//
// With rounded constructions (EPICK) a piece can come to intersect itself, which is not looked for: cells and volumes tell.
#ifndef LAPIDARY_BENCHES_PMP_HPP
#define LAPIDARY_BENCHES_PMP_HPP

#include "contestants.hpp"

#include <CGAL/Polygon_mesh_processing/bbox.h>
#include <CGAL/Polygon_mesh_processing/clip.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/generators.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <utility>

namespace benches {

template <class Kernel>
struct PmpCutter {
  using Point = typename Kernel::Point_3;
  using Plane = typename Kernel::Plane_3;
  using Surface = CGAL::Surface_mesh<Point>;

  static Surface surface_of(const examples::Mesh& mesh) {
    Surface surface;
    const std::vector<double>& x = mesh.coordinates;
    for (std::size_t i = 0; i < x.size(); i += 3) surface.add_vertex(Point(x[i], x[i + 1], x[i + 2]));
    for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
      const auto vertex = [&](std::size_t k) {
        return typename Surface::Vertex_index(static_cast<std::uint32_t>(mesh.triangles[t + k]));
      };
      if (surface.add_face(vertex(0), vertex(1), vertex(2)) == Surface::null_face())
        throw std::runtime_error("the mesh is not manifold");
    }
    return surface;
  }

  static bool divides(const Plane& plane, const Surface& piece) {
    bool positive = false, negative = false;
    for (const auto v : vertices(piece)) {
      const CGAL::Oriented_side side = plane.oriented_side(piece.point(v));
      positive |= side == CGAL::ON_POSITIVE_SIDE;
      negative |= side == CGAL::ON_NEGATIVE_SIDE;
      if (positive && negative) return true;
    }
    return false;
  }

  // What lies behind the plane of a box around the piece, which stands clear of it.
  static Surface half_box(const Plane& plane, const Surface& piece) {
    namespace PMP = CGAL::Polygon_mesh_processing;
    const CGAL::Bbox_3 b = PMP::bbox(piece);
    const double margin = (b.xmax() - b.xmin()) + (b.ymax() - b.ymin()) + (b.zmax() - b.zmin());
    const double x0 = b.xmin() - margin, y0 = b.ymin() - margin, z0 = b.zmin() - margin;
    const double x1 = b.xmax() + margin, y1 = b.ymax() + margin, z1 = b.zmax() + margin;
    Surface box;
    CGAL::make_hexahedron(Point(x0, y0, z0), Point(x1, y0, z0), Point(x1, y1, z0), Point(x0, y1, z0), Point(x0, y1, z1),
                          Point(x0, y0, z1), Point(x1, y0, z1), Point(x1, y1, z1), box);
    PMP::triangulate_faces(box);
    if (!PMP::clip(box, plane, CGAL::parameters::clip_volume(true))) throw std::runtime_error("a box could not be clipped");
    return box;
  }

  // The part of the piece behind the plane and the part before it.
  static std::pair<Surface, Surface> halves(const Plane& plane, Surface& piece) {
    namespace PMP = CGAL::Polygon_mesh_processing;
    std::pair<Surface, Surface> out;
    Surface box = half_box(plane, piece);
    std::array<boost::optional<Surface*>, 4> wanted;
    wanted[PMP::Corefinement::INTERSECTION] = &out.first;
    wanted[PMP::Corefinement::TM1_MINUS_TM2] = &out.second;
    const std::array<bool, 4> made = PMP::corefine_and_compute_boolean_operations(piece, box, wanted);
    if (!made[PMP::Corefinement::INTERSECTION] || !made[PMP::Corefinement::TM1_MINUS_TM2])
      throw std::runtime_error("a part would not be manifold");
    return out;
  }

  static std::size_t cells_of(Surface& piece) {
    namespace PMP = CGAL::Polygon_mesh_processing;
    auto component = piece.template add_property_map<typename Surface::Face_index, std::size_t>("f:cell", 0).first;
    return PMP::volume_connected_components(piece, component, CGAL::parameters::do_orientation_tests(false));
  }

  // In double: exact sums of lazy numbers take longer than the cutting, and here a number to compare is all that is wanted.
  static double volume_of(const Surface& piece) {
    long double six = 0;
    for (const auto f : faces(piece)) {
      const auto h = halfedge(f, piece);
      double p[3][3];
      const typename Surface::Vertex_index corners[3] = {source(h, piece), target(h, piece), target(next(h, piece), piece)};
      for (int k = 0; k < 3; ++k)
        for (int axis = 0; axis < 3; ++axis) p[k][axis] = CGAL::to_double(piece.point(corners[k])[axis]);
      six += p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) - p[0][1] * (p[1][0] * p[2][2] - p[1][2] * p[2][0]) +
             p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
    }
    return static_cast<double>(six / 6);
  }

  static Outcome cut(const examples::Mesh& mesh, const Planes& planes) {
    Outcome outcome;
    const auto start = std::chrono::steady_clock::now();
    std::vector<Surface> pieces;
    pieces.push_back(surface_of(mesh));
    for (std::size_t i = 0; i < planes.size(); i += 4) {
      const Plane plane(planes[i], planes[i + 1], planes[i + 2], planes[i + 3]);
      std::vector<Surface> next;
      for (Surface& piece : pieces) {
        if (!divides(plane, piece)) {
          next.push_back(std::move(piece));
          continue;
        }
        std::pair<Surface, Surface> parts = halves(plane, piece);
        if (num_faces(parts.first) > 0) next.push_back(std::move(parts.first));
        if (num_faces(parts.second) > 0) next.push_back(std::move(parts.second));
      }
      pieces.swap(next);
    }
    for (Surface& piece : pieces) outcome.cells += static_cast<std::int64_t>(cells_of(piece));
    outcome.seconds = seconds_since(start);
    long double volume = 0;
    for (const Surface& piece : pieces) volume += volume_of(piece);
    outcome.volume = static_cast<double>(volume);
    return outcome;
  }
};

} // namespace benches

#endif
