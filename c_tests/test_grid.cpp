/* The C++ wrapper of grids: a cube in a grid of small numbers, whole and as a patch. */
#include "check.h"
#include "lapidary.hpp"

#include <numeric>

namespace {

const std::vector<double> xyz = {0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0, 0, 0, 2, 2, 0, 2, 2, 2, 2, 0, 2, 2};
const std::vector<std::int32_t> indices = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                           1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
const std::vector<std::int32_t> tags = {10, 10, 11, 11, 12, 12, 13, 13, 14, 14, 15, 15};
/* The boxes in the middle are full. */
const std::vector<double> x = {-1, 0.5, 1, 1.5, 3}, y = x, z = {-1, 0.5, 1.5, 3};

template <class View>
double sum(const View &values)
{
    return std::accumulate(values.begin(), values.end(), 0.0);
}

void whole(lapidary::context &context, const lapidary::mesh &mesh)
{
    const lapidary::grid grid(context, mesh, x, y, z);
    const auto block = grid.block();
    CHECK(block.boxes[0] == 4 && block.boxes[2] == 3 && block.x.size() == 5 && block.z[3] == 3);
    const auto n = grid.counts();
    CHECK(n.full == 4 && n.cut == 44 && n.empty == 0 && n.cells == 44);
    CHECK(grid.flags().size() == 48 && grid.box(1, 1, 1).flag == LAP_BOX_FULL && grid.box(0, 0, 0).count == 1);
    CHECK(grid.cut_boxes().boxes.size() == 44 && grid.box_cells().size() == 49);
    CHECK(grid.vertices().xyz.size() == n.vertices && grid.walls().triangles.size() == n.walls);
    CHECK(grid.walls().tags[0] >= 10 && grid.faces().face_loops.size() == n.faces + 1);
    CHECK(grid.plane_faces().nodes.size() == n.faces - n.walls && grid.cells().of(0).size() > 3);
    CHECK(grid.complex().counts().cells == n.cells);
    CHECK(grid.vertex_keys().size() == n.vertices && grid.face_keys().size() == n.faces);
    /* Four full boxes of 1/2 x 1/2 x 1. */
    CHECK(sum(grid.cell_moments().volumes) == 8 - 1);
    CHECK(grid.cell_boundaries().area_vectors.size() == n.cells && grid.wall_moments().centroids.size() == n.walls);
    CHECK(grid.plane_face_moments().fractions.size() == n.faces - n.walls);
    CHECK(grid.cell_walls().size() == n.cells && grid.cell_tags().tags[0].size() == 3);
    CHECK(grid.full_links().cells.size() == 16 && grid.regions().count == 1 && grid.region_runs().regions.size() == 2);
    CHECK(grid.full_faces(context, 0, 2).boxes.size() == 2 && grid.box_region(1, 1, 1) == 0 && grid.box_region(0, 0, 0) == -1);
    CHECK(grid.region_at(context, 1, 1, 1) == 0 && grid.region_at(context, 2.5, 1, 1) == LAP_REGION_SOLID);
    const auto mask = grid.region_mask(context, 0);
    CHECK(sum(mask.cells) == 44 && sum(mask.boxes) == 4);
    const auto aggregates = grid.aggregate(context, 0.4);
    CHECK(aggregates.cells.size() == 44 && aggregates.small.empty());
    CHECK(grid.aggregate(context, 0.4, std::vector<std::uint8_t>(n.faces - n.walls, 1)).small.size() > 0);
    CHECK(!grid.stages().empty());
    grid.check_consistency(context);
    try {
        grid.aggregate(context, -1);
        CHECK(false);
    } catch (const lapidary::error &e) {
        CHECK(e.status() == LAP_ERR_BAD_ARGUMENT);
    }
    try {
        const lapidary::grid bad(context, mesh, {0, 0}, y, z);
        CHECK(false);
    } catch (const lapidary::error &e) {
        CHECK(e.status() == LAP_ERR_BAD_ARGUMENT && std::string(e.what()).find("along x") != std::string::npos);
    }
}

void patch(lapidary::context &context, lapidary::mesh &mesh)
{
    std::vector<std::int64_t> ids(12);
    std::iota(ids.begin(), ids.end(), 100);
    mesh.set_triangle_ids(context, ids);
    lapidary::mesh moved = std::move(mesh);
    auto options = lapidary::grid_options();
    options.block_low[0] = 2;
    const lapidary::grid of_mesh(context, moved, x, y, z, options);
    const double corner[3] = {x[2], y[1], z[1]};
    CHECK(moved.locate(context, {corner, corner + 3})[0] == LAP_PLACE_INSIDE);
    options.known = LAP_NODE_FLUID;
    options.known_node[0] = 2;
    options.known_node[1] = options.known_node[2] = 1;
    const lapidary::grid of_patch(context, xyz, indices, tags, ids, x, y, z, options);
    const auto a = of_mesh.face_keys().flat(), b = of_patch.face_keys().flat();
    CHECK(a.size() > 0 && std::vector<std::int64_t>(a.begin(), a.end()) == std::vector<std::int64_t>(b.begin(), b.end()));
    CHECK(of_patch.walls().triangles[0] >= 100);
}

} // namespace

int main()
{
    lapidary::context context;
    lapidary::mesh mesh(context, xyz, indices, tags);
    whole(context, mesh);
    patch(context, mesh);
    return check_result();
}
