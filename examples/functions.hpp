// Functions from a JSON file, and their values at the nodes of a grid.
//
// The file is a list of objects with a "type":
//   sphere    center, radius                                     radius - |x - center|
//   plane     normal, and point or offset                        normal . (x - point), or normal . x + offset
//   cylinder  axis_point, axis_vector, radius                    radius - distance to the axis
//   cone      apex, axis_vector, apex_angle (degrees, from       distance to the side, positive inside the cone
//             the axis to the side)                              that opens along the axis
//   torus     center, axis_vector, major_radius, minor_radius    minor_radius - distance to the circle
//   constant  value                                              value
// All are positive inside. Axis vectors and normals need not have length 1; only the plane's value depends on its normal's.
#ifndef LAPIDARY_EXAMPLES_FUNCTIONS_HPP
#define LAPIDARY_EXAMPLES_FUNCTIONS_HPP

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace examples {

using Vector = std::array<double, 3>;

inline double dot(const Vector &a, const Vector &b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vector minus(const Vector &a, const Vector &b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline double length(const Vector &a)
{
    return std::sqrt(dot(a, a));
}

struct Function {
    enum Type { sphere, plane, cylinder, cone, torus, constant } type = constant;
    Vector point{0, 0, 0}, axis{0, 0, 1}; // centre, apex or point on the axis; direction or normal
    double a = 0, b = 0;                  // radius, offset, value or half angle; minor radius
};

// Where x lies with respect to the axis: how far along it, how far from it.
inline std::array<double, 2> about_axis(const Function &f, const Vector &x)
{
    const Vector d = minus(x, f.point);
    const double along = dot(d, f.axis);
    const Vector off{d[0] - along * f.axis[0], d[1] - along * f.axis[1], d[2] - along * f.axis[2]};
    return {along, length(off)};
}

inline double evaluate(const Function &f, const Vector &x)
{
    switch (f.type) {
    case Function::sphere: return f.a - length(minus(x, f.point));
    case Function::plane: return dot(f.axis, minus(x, f.point)) + f.a;
    case Function::cylinder: return f.a - about_axis(f, x)[1];
    case Function::cone: {
        // In the plane of x and the axis the side is a line through the apex: the signed distance from it.
        const auto [along, off] = about_axis(f, x);
        return along * std::sin(f.a) - off * std::cos(f.a);
    }
    case Function::torus: {
        const auto [along, off] = about_axis(f, x);
        return f.b - std::sqrt((off - f.a) * (off - f.a) + along * along);
    }
    case Function::constant: break;
    }
    return f.a;
}

inline std::vector<Function> read_functions(const std::string &path)
{
    std::ifstream in(path);
    if (!in) throw std::runtime_error(path + ": cannot be read");
    std::vector<Function> functions;
    try {
        const auto list = nlohmann::json::parse(in);
        if (!list.is_array()) throw std::runtime_error("not a list");
        for (const auto &item : list) {
            Function f;
            const std::string type = item.at("type");
            const auto vector = [&](const char *key) { return item.at(key).get<Vector>(); };
            const auto unit = [&](const char *key) {
                Vector v = vector(key);
                const double size = length(v);
                if (!(size > 0)) throw std::runtime_error(std::string(key) + " is zero");
                // Axis-aligned vectors stay what they are, bit by bit.
                if (size != 1)
                    for (double &c : v) c /= size;
                return v;
            };
            if (type == "sphere") {
                f.type = Function::sphere;
                f.point = vector("center");
                f.a = item.at("radius");
            } else if (type == "plane") {
                f.type = Function::plane;
                f.axis = vector("normal");
                if (item.contains("point")) f.point = vector("point");
                if (item.contains("offset")) f.a = item.at("offset");
            } else if (type == "cylinder") {
                f.type = Function::cylinder;
                f.point = vector("axis_point");
                f.axis = unit("axis_vector");
                f.a = item.at("radius");
            } else if (type == "cone") {
                f.type = Function::cone;
                f.point = vector("apex");
                f.axis = unit("axis_vector");
                f.a = item.at("apex_angle").get<double>() * (3.14159265358979323846 / 180);
            } else if (type == "torus") {
                f.type = Function::torus;
                f.point = vector("center");
                f.axis = unit("axis_vector");
                f.a = item.at("major_radius");
                f.b = item.at("minor_radius");
            } else if (type == "constant") {
                f.type = Function::constant;
                f.a = item.at("value");
            } else {
                throw std::runtime_error("unknown type '" + type + "'");
            }
            functions.push_back(f);
        }
    } catch (const std::exception &error) {
        throw std::runtime_error(path + ": function " + std::to_string(functions.size()) + ": " + error.what());
    }
    return functions;
}

// Node i of n + 1 along an axis.
inline double node_at(std::int64_t i, std::int64_t n, double low, double high)
{
    return static_cast<double>(i) / static_cast<double>(n) * (high - low) + low;
}

// The values at all nodes of a grid of n cubes along each axis over a box (lowest x y z, highest x y z), one array per function
// behind the other.
inline std::vector<double> values_on_grid(const std::vector<Function> &functions, std::int64_t n,
                                          const std::array<double, 6> &box)
{
    std::vector<double> values;
    values.reserve(functions.size() * static_cast<std::size_t>((n + 1) * (n + 1) * (n + 1)));
    for (const Function &f : functions)
        for (std::int64_t k = 0; k <= n; ++k)
            for (std::int64_t j = 0; j <= n; ++j)
                for (std::int64_t i = 0; i <= n; ++i)
                    values.push_back(evaluate(f, {node_at(i, n, box[0], box[3]), node_at(j, n, box[1], box[4]),
                                                  node_at(k, n, box[2], box[5])}));
    return values;
}

} // namespace examples

#endif
