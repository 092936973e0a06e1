// Pictures for scripts/render_exploded.py: pieces with points of their own, each in one colour, and lines; and where pieces go when they are moved apart.
#ifndef LAPIDARY_EXAMPLES_PICTURE_HPP
#define LAPIDARY_EXAMPLES_PICTURE_HPP

#include "vtk.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace examples {

using Shift = std::array<double, 3>;

// A picture in the making, of points that are borrowed.
struct Picture {
    const double *xyz;
    std::vector<double> points;
    std::vector<std::int64_t> lines, line_offsets, corners, corner_offsets;
    std::vector<std::int32_t> line_colour, polygon_colour;
    Numbering numbering;

    Picture(const double *all, std::int64_t vertices) : xyz(all), numbering(vertices) {}

    // The number of a vertex within a piece that is moved by `shift`.
    std::int64_t local(std::int64_t piece, std::int32_t v, const Shift &shift)
    {
        if (first_use(numbering, piece, v, static_cast<std::int64_t>(points.size() / 3)))
            for (int k = 0; k < 3; ++k) points.push_back(xyz[3 * static_cast<std::int64_t>(v) + k] + shift[k]);
        return numbering.number[v];
    }
    // The vertices from `begin` to `end`, perhaps the other way round.
    void polygon(std::int64_t piece, std::int64_t colour, const std::int32_t *begin, const std::int32_t *end, bool reversed,
                 const Shift &shift)
    {
        for (const std::int32_t *v = begin; v != end; ++v)
            corners.push_back(local(piece, reversed ? *(end - 1 - (v - begin)) : *v, shift));
        corner_offsets.push_back(static_cast<std::int64_t>(corners.size()));
        polygon_colour.push_back(static_cast<std::int32_t>(colour));
    }
    void line(std::int64_t piece, std::int64_t colour, const std::int32_t *begin, const std::int32_t *end, const Shift &shift)
    {
        for (const std::int32_t *v = begin; v != end; ++v) lines.push_back(local(piece, *v, shift));
        line_offsets.push_back(static_cast<std::int64_t>(lines.size()));
        line_colour.push_back(static_cast<std::int32_t>(colour));
    }
};

// For scripts/render_exploded.py, which colours by "cell". (Lines come first in VTK's cell data.)
inline void write_picture(const std::string &path, Picture picture)
{
    picture.line_colour.insert(picture.line_colour.end(), picture.polygon_colour.begin(), picture.polygon_colour.end());
    VtkFile file;
    begin_file(file, "PolyData");
    file.xml << "<Piece NumberOfPoints=\"" << picture.points.size() / 3 << "\" NumberOfLines=\""
             << picture.line_offsets.size() << "\" NumberOfPolys=\"" << picture.corner_offsets.size() << "\">\n<Points>\n";
    add_array(file, "Points", picture.points, 3);
    file.xml << "</Points>\n<Lines>\n";
    add_array(file, "connectivity", picture.lines);
    add_array(file, "offsets", picture.line_offsets);
    file.xml << "</Lines>\n<Polys>\n";
    add_array(file, "connectivity", picture.corners);
    add_array(file, "offsets", picture.corner_offsets);
    file.xml << "</Polys>\n<CellData Scalars=\"cell\">\n";
    add_array(file, "cell", picture.line_colour);
    file.xml << "</CellData>\n</Piece>\n";
    end_file(file, "PolyData", path);
}

// Volume and first moments of a piece, as a sum of cones to the origin.
struct Moments {
    double volume = 0;
    Shift first{0, 0, 0};
};

// Adds the cone over a convex polygon whose normal points out of the piece behind it, into the one before it.
inline void add_cone(Moments &behind, Moments &before, const double *xyz, const std::int32_t *begin, const std::int32_t *end)
{
    for (const std::int32_t *v = begin + 2; v < end; ++v) {
        const double *x = xyz + 3 * static_cast<std::int64_t>(*begin), *y = xyz + 3 * static_cast<std::int64_t>(v[-1]),
                     *z = xyz + 3 * static_cast<std::int64_t>(*v);
        const double volume = (x[0] * (y[1] * z[2] - y[2] * z[1]) + x[1] * (y[2] * z[0] - y[0] * z[2]) +
                               x[2] * (y[0] * z[1] - y[1] * z[0])) / 6;
        behind.volume += volume;
        before.volume -= volume;
        for (int c = 0; c < 3; ++c) {
            const double first = volume * (x[c] + y[c] + z[c]) / 4;
            behind.first[c] += first;
            before.first[c] -= first;
        }
    }
}

// How far each piece moves away from the middle of all: `factor` times its distance from it. Pieces without positive volume stay.
inline std::vector<Shift> apart(const std::vector<Moments> &moments, double factor)
{
    Moments all;
    for (const Moments &m : moments) {
        if (!(m.volume > 0)) continue;
        all.volume += m.volume;
        for (int c = 0; c < 3; ++c) all.first[c] += m.first[c];
    }
    std::vector<Shift> shifts(moments.size(), Shift{0, 0, 0});
    for (std::size_t i = 0; i < moments.size(); ++i) {
        const Moments &m = moments[i];
        if (!(m.volume > 0)) continue;
        for (int c = 0; c < 3; ++c) shifts[i][c] = factor * (m.first[c] / m.volume - all.first[c] / all.volume);
    }
    return shifts;
}

} // namespace examples

#endif
