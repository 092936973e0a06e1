// The reader that all examples and tests share: any OFF, OBJ, STL or PLY file to flat arrays for the C API.
//
// The library takes every double as the exact number that it is, so reading has to be exact as well:
//   * coordinates are correctly rounded doubles (nothing goes through float);
//   * polygons are fanned from their first listed vertex;
//   * vertices with bit-equal coordinates are one vertex, with the lowest of their places (-0 is read as 0: it is the
//     same point); vertices keep their order otherwise;
//   * no face is dropped: degenerate ones are the library's to report, not the reader's to hide.
// Cost: n log n for n vertices, for the merge.
#ifndef LAPIDARY_EXAMPLES_READER_HPP
#define LAPIDARY_EXAMPLES_READER_HPP

#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

namespace examples {

// A mesh as the C API takes it.
struct Mesh {
    std::vector<double> coordinates;     // x y z per vertex
    std::vector<std::int32_t> triangles; // three vertices per triangle

    std::int64_t vertex_count() const { return static_cast<std::int64_t>(coordinates.size() / 3); }
    std::int64_t triangle_count() const { return static_cast<std::int64_t>(triangles.size() / 3); }
};

// The place of each point's representative: the first point with the same coordinates.
inline std::vector<std::size_t> first_of_equal(const std::vector<std::array<double, 3>> &points)
{
    std::vector<std::size_t> order(points.size()), first(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return points[a] != points[b] ? points[a] < points[b] : a < b; });
    for (std::size_t i = 0; i < order.size(); ++i)
        first[order[i]] = i > 0 && points[order[i]] == points[order[i - 1]] ? first[order[i - 1]] : order[i];
    return first;
}

// Flat arrays from a polygon soup. Throws std::runtime_error naming the polygon that cannot be fanned.
inline Mesh mesh_from_polygons(std::vector<std::array<double, 3>> points,
                               const std::vector<std::vector<std::size_t>> &polygons)
{
    for (std::size_t i = 0; i < points.size(); ++i)
        for (double &c : points[i]) {
            // A NaN would also break the order that the merge sorts by.
            if (!(c - c == 0))
                throw std::runtime_error("vertex " + std::to_string(i) + " has a coordinate that is not finite");
            c += 0.0; // -0 becomes +0
        }
    const std::vector<std::size_t> first = first_of_equal(points);

    Mesh mesh;
    std::vector<std::int32_t> id(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (first[i] != i) {
            id[i] = id[first[i]];
            continue;
        }
        const std::size_t next = mesh.coordinates.size() / 3;
        if (next > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
            throw std::runtime_error("more vertices than 32-bit indices can name");
        id[i] = static_cast<std::int32_t>(next);
        mesh.coordinates.insert(mesh.coordinates.end(), points[i].begin(), points[i].end());
    }
    for (std::size_t p = 0; p < polygons.size(); ++p) {
        const std::vector<std::size_t> &polygon = polygons[p];
        if (polygon.size() < 3)
            throw std::runtime_error("polygon " + std::to_string(p) + " has fewer than three corners");
        for (std::size_t corner : polygon)
            if (corner >= points.size())
                throw std::runtime_error("polygon " + std::to_string(p) + " names vertex " + std::to_string(corner) +
                                         ", there are " + std::to_string(points.size()));
        for (std::size_t k = 2; k < polygon.size(); ++k)
            mesh.triangles.insert(mesh.triangles.end(), {id[polygon[0]], id[polygon[k - 1]], id[polygon[k]]});
    }
    return mesh;
}

// Reads a mesh; the format is told by the file name's extension. Throws std::runtime_error saying what is wrong.
inline Mesh read_mesh(const std::string &path)
{
    using Point = CGAL::Simple_cartesian<double>::Point_3;
    std::vector<Point> soup;
    std::vector<std::vector<std::size_t>> polygons;
    if (!std::ifstream(path)) throw std::runtime_error(path + ": cannot be opened");
    if (!CGAL::IO::read_polygon_soup(path, soup, polygons))
        throw std::runtime_error(path +
                                 ": not a mesh that can be read (OFF, OBJ, STL and PLY are known by their extension)");
    std::vector<std::array<double, 3>> points;
    points.reserve(soup.size());
    for (const Point &p : soup) points.push_back({p.x(), p.y(), p.z()});
    try {
        return mesh_from_polygons(std::move(points), polygons);
    } catch (const std::runtime_error &error) {
        throw std::runtime_error(path + ": " + error.what());
    }
}

} // namespace examples

#endif
