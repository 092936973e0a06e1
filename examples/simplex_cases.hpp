// Single simplices from a JSON file, {"arrangement": [case, ...], "material_interface": [case, ...]}, each case {"dim": 2 or 3, "input":
// [[a value for each corner], ...], "expect": {...}}; and the counts of what functions divide them into.
#ifndef LAPIDARY_EXAMPLES_SIMPLEX_CASES_HPP
#define LAPIDARY_EXAMPLES_SIMPLEX_CASES_HPP

#include "program.hpp"
#include "report.hpp"

#include <lapidary.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace examples {

// Exactly a b = c d, for any finite doubles: products of mantissas, 53 bits each, and sums of exponents.
inline bool equal_products(double a, double b, double c, double d)
{
    struct Product {
        bool negative;
        unsigned __int128 mantissa;
        int exponent;
    };
    const auto product = [](double x, double y) {
        int i = 0, k = 0;
        const auto m = static_cast<std::uint64_t>(std::ldexp(std::abs(std::frexp(x, &i)), 53));
        const auto n = static_cast<std::uint64_t>(std::ldexp(std::abs(std::frexp(y, &k)), 53));
        Product p{std::signbit(x) != std::signbit(y), static_cast<unsigned __int128>(m) * n, i + k};
        if (p.mantissa == 0) return Product{false, 0, 0};
        for (; p.mantissa % 2 == 0; p.mantissa /= 2) ++p.exponent;
        return p;
    };
    const Product p = product(a, b), q = product(c, d);
    return p.negative == q.negative && p.mantissa == q.mantissa && p.exponent == q.exponent;
}

// Different planes among those of the simplex's facets and those where a function is zero (that is not zero everywhere).
inline std::int64_t distinct_planes(int dim, const std::vector<std::vector<double>> &functions)
{
    std::vector<std::vector<double>> planes;
    for (int c = 0; c <= dim; ++c) {
        planes.emplace_back(static_cast<std::size_t>(dim) + 1, 0.0);
        planes.back()[static_cast<std::size_t>(c)] = 1;
    }
    for (const auto &f : functions) {
        bool known = std::all_of(f.begin(), f.end(), [](double x) { return x == 0; });
        for (std::size_t p = 0; p < planes.size() && !known; ++p) {
            known = true;
            for (std::size_t i = 0; i < f.size(); ++i)
                for (std::size_t k = 0; k < i; ++k)
                    known = known && equal_products(f[i], planes[p][k], f[k], planes[p][i]);
        }
        if (!known) planes.push_back(f);
    }
    return static_cast<std::int64_t>(planes.size());
}

// Counts of one case, by the names that its `expect` has (all, if it has none).
inline nlohmann::ordered_json simplex_counts(lap_context *context, lap_simplex *simplex, std::int32_t kind,
                                             const nlohmann::json &given)
{
    const int dim = given.at("dim");
    const auto functions = given.at("input").get<std::vector<std::vector<double>>>();
    std::vector<double> values;
    for (const auto &f : functions) {
        if (f.size() != static_cast<std::size_t>(dim) + 1) throw std::runtime_error("dim + 1 values are needed per function");
        values.insert(values.end(), f.begin(), f.end());
    }
    must(context, lap_simplex_compute(context, simplex, kind, dim, 1, static_cast<std::int64_t>(functions.size()),
                                      values.data()));
    std::int64_t vertices = 0, faces = 0, cells = 0;
    must(context, lap_simplex_counts(simplex, nullptr, &vertices, nullptr, &faces, &cells));
    const std::int32_t *cell_offsets = nullptr, *half_faces = nullptr, *face_offsets = nullptr;
    must(context, lap_simplex_cells(simplex, nullptr, &cell_offsets, &half_faces));
    must(context, lap_simplex_faces(simplex, nullptr, &face_offsets, nullptr, nullptr));
    // Sides of cells: each face once per cell that it bounds; in a triangle faces are segments, in a tetrahedron they have sides themselves.
    const std::int64_t sides = cell_offsets[cells];
    std::int64_t corners = 0;
    for (std::int64_t i = 0; i < sides; ++i) {
        const std::int32_t f = half_faces[i] / 2;
        corners += face_offsets[f + 1] - face_offsets[f];
    }
    nlohmann::ordered_json all = {{"cells", cells}, {"vertices", vertices}};
    if (kind == LAP_SIMPLEX_INTERFACE) all["faces"] = faces;
    else {
        if (dim == 3) all["half_faces"] = sides;
        all["half_edges"] = dim == 3 ? corners : sides;
        all["unique_planes"] = distinct_planes(dim, functions);
    }
    if (!given.contains("expect")) return all;
    nlohmann::ordered_json asked = nlohmann::ordered_json::object();
    for (const auto &[name, value] : given.at("expect").items()) {
        if (!all.contains(name)) throw std::runtime_error("unknown count '" + name + "'");
        asked[name] = all[name];
    }
    return asked;
}

inline void write_simplex_counts(lap_context *context, const std::string &from, const std::string &to)
{
    std::ifstream in(from);
    if (!in) throw std::runtime_error(from + ": cannot be read");
    nlohmann::ordered_json result = nlohmann::ordered_json::object();
    lap_simplex *made = nullptr;
    must(context, lap_simplex_new(&made));
    const Handle<lap_simplex> simplex(made);
    std::string where;
    try {
        const auto cases = nlohmann::json::parse(in);
        for (const auto &[name, kind] : {std::pair<const char *, std::int32_t>("arrangement", LAP_SIMPLEX_ARRANGEMENT),
                                         {"material_interface", LAP_SIMPLEX_INTERFACE}}) {
            result[name] = nlohmann::ordered_json::array();
            if (!cases.contains(name)) continue;
            for (const auto &one : cases.at(name)) {
                where = std::string(name) + " " + std::to_string(result[name].size()) + ": ";
                result[name].push_back(simplex_counts(context, simplex.get(), kind, one));
            }
        }
    } catch (const Refusal &error) {
        throw Refusal(from + ": " + where + error.what());
    } catch (const std::exception &error) {
        throw std::runtime_error(from + ": " + where + error.what());
    }
    write_file(to, result.dump(1) + '\n');
}

} // namespace examples

#endif
