/* Closed meshes from files, and what tests of booleans make of them: copies that are rotated, fitted to one another, or shifted by an edge. */
#ifndef LAPIDARY_TEST_MODELS_HPP
#define LAPIDARY_TEST_MODELS_HPP

#include "../examples/reader.hpp"
#include "check.h"
#include "fixture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace models {

/* A closed mesh that does not intersect itself; one that faces inward is turned. */
inline bool make_clean(lapidary::context &context, fixture::solid &s, std::string *exact_volume)
{
    lap_mesh_options options = lapidary::mesh_options();
    options.check_self_intersection = 1;
    for (int attempt = 0; attempt < 2; ++attempt) {
        try {
            const lapidary::mesh mesh(context, s.xyz, s.indices, {}, options);
            if (exact_volume != nullptr) *exact_volume = mesh.exact_volume(context);
            return true;
        } catch (const lapidary::error &e) {
            for (const lapidary::defect &d : e.defects()) {
                if (d.kind != LAP_DEFECT_WRONG_NESTING) return false;
            }
            for (std::size_t t = 0; t < s.indices.size(); t += 3) std::swap(s.indices[t + 1], s.indices[t + 2]);
        }
    }
    return false;
}

struct Bounds {
    std::array<double, 3> low, high;
    double size() const { return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]}); }
};

inline Bounds bounds_of(const fixture::solid &s)
{
    Bounds b{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
    for (std::size_t i = 0; i < s.xyz.size(); ++i) {
        b.low[i % 3] = std::min(b.low[i % 3], s.xyz[i]);
        b.high[i % 3] = std::max(b.high[i % 3], s.xyz[i]);
    }
    return b;
}

/* By an angle about an axis in general position through the middle. */
inline fixture::solid rotated(const fixture::solid &s)
{
    const double axis[3] = {1 / std::sqrt(14.0), 2 / std::sqrt(14.0), 3 / std::sqrt(14.0)}, sine = std::sin(0.7), cosine = std::cos(0.7);
    const Bounds b = bounds_of(s);
    fixture::solid out = s;
    for (std::size_t i = 0; i < s.xyz.size(); i += 3) {
        double x[3], along = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            x[k] = s.xyz[i + k] - (b.low[k] + b.high[k]) / 2;
            along += x[k] * axis[k];
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t j = (k + 1) % 3, l = (k + 2) % 3;
            const double across = axis[j] * x[l] - axis[l] * x[j];
            out.xyz[i + k] = (b.low[k] + b.high[k]) / 2 + cosine * x[k] + sine * across + (1 - cosine) * along * axis[k];
        }
    }
    return out;
}

/* Of the other's size, at its place, a little off. */
inline fixture::solid fitted(const fixture::solid &s, const fixture::solid &to)
{
    const Bounds from = bounds_of(s), place = bounds_of(to);
    const double scale = place.size() / from.size();
    fixture::solid out = s;
    for (std::size_t i = 0; i < s.xyz.size(); ++i) {
        const std::size_t k = i % 3;
        out.xyz[i] = place.low[k] + scale * (s.xyz[i] - from.low[k] + 0.013 * static_cast<double>(k + 1) * from.size());
    }
    return out;
}

/* Coordinates as multiples of a power of two so coarse that sums and differences of them are exact. */
inline fixture::solid on_grid(const fixture::solid &s)
{
    double most = 0;
    for (const double x : s.xyz) most = std::max(most, std::fabs(x));
    const double step = std::ldexp(1, std::ilogb(most) - 44);
    fixture::solid out = s;
    for (double &x : out.xyz) x = std::nearbyint(x / step) * step;
    return out;
}

/* By the vector of an edge in the middle of the list. */
inline fixture::solid shifted(const fixture::solid &s)
{
    const std::size_t t = s.indices.size() / 6 * 3;
    const auto a = static_cast<std::size_t>(s.indices[t]), b = static_cast<std::size_t>(s.indices[t + 1]);
    fixture::solid out = s;
    for (std::size_t i = 0; i < s.xyz.size(); ++i) {
        const double edge = s.xyz[3 * b + i % 3] - s.xyz[3 * a + i % 3];
        out.xyz[i] += edge;
        CHECK(out.xyz[i] - edge == s.xyz[i] && out.xyz[i] - s.xyz[i] == edge);
    }
    return out;
}

template <class Make>
void guarded(const std::string &name, Make make)
{
    try {
        make();
    } catch (const std::exception &e) {
        std::cerr << name << ": " << e.what() << '\n';
        check_that(0, "no exception", __FILE__, __LINE__);
    }
}

/* CGAL's meshes, read when they are needed; with LAPIDARY_PART=i/n, i from 0, every n-th of them. */
class Models {
public:
    /* A few by name, or all there are. */
    Models(const std::vector<std::string> &few, bool all) : folder_(fixture::cgal_meshes()), part_(fixture::own_part())
    {
        if (!folder_.empty()) files_ = fixture::mesh_files(folder_, few, all);
    }
    bool empty() const { return files_.empty(); }
    bool whole() const { return part_.n == 1; }
    /* The part that does what is done once. */
    bool first() const { return part_.i == 0; }

    /* Calls `use` for each closed mesh of this part with its name, and with that of the next closed one of all. */
    template <class Use>
    std::size_t each(Use use)
    {
        std::size_t count = 0;
        for (std::size_t i = part_.i; i < files_.size(); i += part_.n) {
            if (!solid(i)) continue;
            ++count;
            std::size_t next = (i + 1) % files_.size();
            while (!solid(next)) next = (next + 1) % files_.size();
            use(files_[i], *solid(i), files_[next], *solid(next));
        }
        return count;
    }

private:
    std::string folder_;
    std::vector<std::string> files_;
    std::map<std::size_t, std::optional<fixture::solid>> read_;
    fixture::part part_;

    /* Nothing where a file is no clean mesh. */
    const std::optional<fixture::solid> &solid(std::size_t i)
    {
        const auto [place, fresh] = read_.emplace(i, std::nullopt);
        if (!fresh) return place->second;
        try {
            const examples::Mesh mesh = examples::read_mesh(folder_ + "/" + files_[i]);
            fixture::solid s{mesh.coordinates, mesh.triangles};
            lapidary::context context;
            if (make_clean(context, s, nullptr)) place->second = std::move(s);
        } catch (const std::runtime_error &) {
            /* not a mesh of polygons */
        }
        return place->second;
    }
};

} // namespace models

#endif
