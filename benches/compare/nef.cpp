// Cutting by CGAL's Nef polyhedra over exact constructions: every plane in turn halves every piece that it divides; the
// marked volumes of a piece are its cells.
//
// Halves are closed and regularized, so that no faces without volume are left of planes that touch. A piece without
// vertices strictly on both sides of a plane is left alone, as for Polygon Mesh Processing. For a mesh of one component.
#include "contestants.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Nef_polyhedron_3.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/convert_nef_polyhedron_to_polygon_mesh.h>

#include <stdexcept>
#include <utility>

namespace benches {

namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Nef = CGAL::Nef_polyhedron_3<Kernel>;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

Nef solid_of(const examples::Mesh& mesh) {
  Surface surface;
  const std::vector<double>& x = mesh.coordinates;
  for (std::size_t i = 0; i < x.size(); i += 3) surface.add_vertex(Kernel::Point_3(x[i], x[i + 1], x[i + 2]));
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const auto vertex = [&](std::size_t k) {
      return Surface::Vertex_index(static_cast<std::uint32_t>(mesh.triangles[t + k]));
    };
    if (surface.add_face(vertex(0), vertex(1), vertex(2)) == Surface::null_face())
      throw std::runtime_error("the mesh is not manifold");
  }
  return Nef(surface);
}

bool divides(const Kernel::Plane_3& plane, const Nef& piece) {
  bool positive = false, negative = false;
  for (auto v = piece.vertices_begin(); v != piece.vertices_end(); ++v) {
    const CGAL::Oriented_side side = plane.oriented_side(v->point());
    positive |= side == CGAL::ON_POSITIVE_SIDE;
    negative |= side == CGAL::ON_NEGATIVE_SIDE;
    if (positive && negative) return true;
  }
  return false;
}

// Through a surface mesh of the marked volumes: their boundaries, outer and inner.
double volume_of(const Nef& piece) {
  Surface surface;
  CGAL::convert_nef_polyhedron_to_polygon_mesh(piece, surface, true);
  return CGAL::to_double(CGAL::Polygon_mesh_processing::volume(surface));
}

} // namespace

Outcome nef(const examples::Mesh& mesh, const Planes& planes) {
  Outcome outcome;
  const auto start = std::chrono::steady_clock::now();
  std::vector<Nef> pieces{solid_of(mesh)};
  for (std::size_t i = 0; i < planes.size(); i += 4) {
    const Kernel::Plane_3 plane(planes[i], planes[i + 1], planes[i + 2], planes[i + 3]);
    std::vector<Nef> next;
    for (const Nef& piece : pieces) {
      if (!divides(plane, piece)) {
        next.push_back(piece);
        continue;
      }
      for (const Kernel::Plane_3& side : {plane, plane.opposite()}) {
        Nef half = piece.intersection(side, Nef::CLOSED_HALFSPACE).regularization();
        if (!half.is_empty()) next.push_back(std::move(half));
      }
    }
    pieces.swap(next);
  }
  for (const Nef& piece : pieces)
    for (auto volume = piece.volumes_begin(); volume != piece.volumes_end(); ++volume)
      outcome.cells += volume->mark() ? 1 : 0;
  outcome.seconds = seconds_since(start);
  for (const Nef& piece : pieces) outcome.volume += volume_of(piece);
  return outcome;
}

} // namespace benches
