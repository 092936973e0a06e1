// Sets of planes n.x + d = 0, four doubles each: read from a file, as a grid, or random but the same everywhere.
#ifndef LAPIDARY_EXAMPLES_PLANES_HPP
#define LAPIDARY_EXAMPLES_PLANES_HPP

#include "numbers.hpp"
#include "reader.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace examples {

// The bounding box of the vertices that triangles use.
struct Box {
    std::array<double, 3> min, max;
};

inline Box bounding_box(const Mesh &mesh)
{
    const double inf = std::numeric_limits<double>::infinity();
    Box box{{inf, inf, inf}, {-inf, -inf, -inf}};
    for (std::int32_t v : mesh.triangles)
        for (int axis = 0; axis < 3; ++axis) {
            const double c = mesh.coordinates[3 * static_cast<std::size_t>(v) + axis];
            box.min[axis] = std::min(box.min[axis], c);
            box.max[axis] = std::max(box.max[axis], c);
        }
    return box;
}

// count[axis] planes across each axis, evenly from the box's lowest coordinate to its highest, both included; a single
// plane goes through the middle. x first, then y, then z; rising.
inline std::vector<double> grid_planes(const Box &box, const std::array<long, 3> &count)
{
    std::vector<double> planes;
    for (int axis = 0; axis < 3; ++axis)
        for (long i = 0; i < count[axis]; ++i) {
            const double extent = box.max[axis] - box.min[axis];
            const double at = count[axis] == 1 ? box.min[axis] + extent / 2
                                               : box.min[axis] + extent * static_cast<double>(i) /
                                                                     static_cast<double>(count[axis] - 1);
            double plane[4] = {0, 0, 0, -at};
            plane[axis] = 1;
            planes.insert(planes.end(), plane, plane + 4);
        }
    return planes;
}

// Planes with directions uniform on the sphere, through points uniform in the box. The same planes on every platform
// for the same seed and box: std::mt19937_64 is fixed by the standard, its words become doubles in [0, 1) by their
// upper 53 bits, and a direction is a point of the cube [-1, 1)^3 drawn again until it lies in the unit ball (not
// normalised: a plane's normal may have any length). There are only additions, multiplications and comparisons, and
// examples are compiled without contraction to FMA. Order of draws: direction x y z (again until accepted), then point
// x y z.
inline std::vector<double> random_planes(const Box &box, long count, std::uint64_t seed)
{
    std::mt19937_64 generator(seed);
    auto uniform = [&] { return static_cast<double>(generator() >> 11) * 0x1p-53; };
    std::vector<double> planes;
    for (long i = 0; i < count; ++i) {
        double n[3], square;
        do {
            for (double &c : n) c = 2 * uniform() - 1;
            square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
        } while (square > 1 || square < 0x1p-20); // too near the centre, few bits are left of the direction
        double dot = 0;
        for (int axis = 0; axis < 3; ++axis)
            dot += n[axis] * (box.min[axis] + (box.max[axis] - box.min[axis]) * uniform());
        planes.insert(planes.end(), {n[0], n[1], n[2], -dot});
    }
    return planes;
}

// Lines `nx ny nz d`; a first line `N 4` is allowed, and so are empty lines and comments from `#` on. Throws
// std::runtime_error naming the line. Whether a plane is valid (finite, normal not zero) is the library's to say.
inline std::vector<double> read_planes(const std::string &path)
{
    std::vector<double> planes;
    bool first = true;
    read_numbers(path, [&](const std::vector<double> &values, const std::string &where) {
        const bool header = first && values.size() == 2 && values[1] == 4;
        first = false;
        if (header) return;
        if (values.size() != 4) throw std::runtime_error(where + ": expected `nx ny nz d`");
        planes.insert(planes.end(), values.begin(), values.end());
    });
    return planes;
}

} // namespace examples

#endif
