/* Reads data/cut_small.txt (its README says what is in it), and runs a case through the library. */
#ifndef LAPIDARY_TEST_FIXTURE_HPP
#define LAPIDARY_TEST_FIXTURE_HPP

#include "lapidary.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <string>
#include <vector>

namespace fixture {

struct solid {
    std::vector<double> xyz;
    std::vector<std::int32_t> indices;
};

struct cutting {
    std::string name, mesh;
    std::vector<double> planes;
    std::int64_t cells = 0, new_vertices = 0;
    std::string total;                /* exact volume of the solid */
    std::vector<std::string> volumes; /* exact volumes of the cells, sorted as strings; may be empty */
};

struct all {
    std::map<std::string, solid> meshes;
    std::vector<cutting> cuttings;
};

/* A file that cannot be read, or that ends early, ends the program: a test without its data has failed. */
inline all read(const std::string &path)
{
    std::ifstream in(path);
    all result;
    const auto demand = [&](bool holds) {
        if (!holds) {
            std::cerr << path << ": cannot be read\n";
            std::exit(2);
        }
    };
    const auto number = [&] {
        std::string text;
        demand(static_cast<bool>(in >> text));
        return std::strtod(text.c_str(), nullptr);
    };
    for (std::string word; in >> word && word != "end";) {
        std::string name;
        std::size_t n = 0, m = 0;
        if (word == "mesh") {
            demand(static_cast<bool>(in >> name >> n >> m));
            solid &s = result.meshes[name];
            for (std::size_t i = 0; i < 3 * n; ++i) s.xyz.push_back(number());
            for (std::size_t i = 0; i < 3 * m; ++i) s.indices.push_back(static_cast<std::int32_t>(number()));
        } else {
            cutting c;
            demand(word == "case" && (in >> c.name >> c.mesh >> n >> c.cells >> c.new_vertices >> c.total >> m));
            for (std::size_t i = 0; i < 4 * n; ++i) c.planes.push_back(number());
            for (std::size_t i = 0; i < m; ++i) {
                demand(static_cast<bool>(in >> name));
                c.volumes.push_back(name);
            }
            demand(result.meshes.count(c.mesh) == 1);
            result.cuttings.push_back(c);
        }
    }
    demand(!result.cuttings.empty() && !in.fail());
    return result;
}

/* The side of every plane that a cell is on, as a string of + and -. */
inline std::string signs(const lapidary::complex &complex, std::int32_t cell, std::int32_t plane_count)
{
    std::string text;
    for (std::int32_t plane = 0; plane < plane_count; ++plane) text += complex.cell_side(cell, plane) > 0 ? '+' : '-';
    return text;
}

/* The folder of CGAL's meshes: LAPIDARY_CGAL_MESHES, or where the build found them; empty, and said so, where they are not. */
inline std::string cgal_meshes()
{
    const char *from_environment = std::getenv("LAPIDARY_CGAL_MESHES");
    std::string folder = from_environment != nullptr ? from_environment : "";
#ifdef LAPIDARY_TEST_MESHES
    if (folder.empty()) folder = LAPIDARY_TEST_MESHES;
#endif
    if (!folder.empty() && std::filesystem::exists(folder)) return folder;
    std::cout << "CGAL's meshes: skipped, they were not given (LAPIDARY_CGAL_MESHES)" << std::endl;
    return {};
}

/* The meshes in a folder that are wanted by name, or all of them; sorted. */
inline std::vector<std::string> mesh_files(const std::string &folder, const std::vector<std::string> &wanted, bool everything)
{
    std::vector<std::string> files;
    for (const auto &entry : std::filesystem::directory_iterator(folder)) {
        const std::string file = entry.path().filename().string(), extension = entry.path().extension().string();
        const bool listed = std::find(wanted.begin(), wanted.end(), file) != wanted.end();
        if (listed || (everything && (extension == ".off" || extension == ".obj" || extension == ".stl"))) files.push_back(file);
    }
    std::sort(files.begin(), files.end());
    return files;
}

/* LAPIDARY_PART=i/n: the part i of n that a process is to do; 0 of 1 where it is not set. Text that says something else ends the program. */
struct part {
    std::size_t i = 0, n = 1;
};
inline part own_part()
{
    part p;
    const char *asked_for = std::getenv("LAPIDARY_PART");
    if (asked_for != nullptr && (std::sscanf(asked_for, "%zu/%zu", &p.i, &p.n) != 2 || p.i >= p.n)) {
        std::cerr << "LAPIDARY_PART=" << asked_for << ": it is to be i/n, i from 0\n";
        std::exit(2);
    }
    return p;
}

} // namespace fixture

#endif
