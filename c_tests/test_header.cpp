/* Both headers, as C++17, with warnings as errors; and what the C++ header adds: exceptions, in both directions. */
#include "lapidary.hpp"

#include "lapidary.h"

#include <limits>

int main()
{
    const std::vector<double> xyz = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const std::vector<std::int32_t> indices = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    int failures = 0;
    const auto check = [&](bool holds) { failures += holds ? 0 : 1; };

    lapidary::context context(2);
    check(context.threads() == 2);
    const lapidary::mesh mesh(context, xyz, indices);
    check(mesh.counts().edges == 6 && mesh.bounds()[5] == 1);

    /* A status becomes an exception that names the defects. */
    try {
        std::vector<double> bad = xyz;
        bad[4] = std::numeric_limits<double>::infinity();
        lapidary::mesh none(context, bad, indices);
        check(false);
    } catch (const lapidary::error &e) {
        check(e.status() == LAP_ERR_BAD_MESH && e.defects().size() == 1 && e.defects()[0].ids[0] == 1);
        check(lapidary::defect_name(e.defects()[0].kind) == "LAP_DEFECT_NON_FINITE_COORDINATE");
    }

    /* An exception of a callback cancels the call and comes out of it; a false cancels. */
    struct stop {};
    context.set_progress([](const char *, double) -> bool { throw stop(); });
    try {
        lapidary::cut none(context, mesh, {1, 0, 0, -0.5});
        check(false);
    } catch (const stop &) {
    }
    context.set_progress([](const char *, double) { return false; });
    try {
        lapidary::cut none(context, mesh, {1, 0, 0, -0.5});
        check(false);
    } catch (const lapidary::error &e) {
        check(e.status() == LAP_ERR_CANCELLED);
    }
    int calls = 0;
    context.set_progress([&](const char *, double) { return ++calls > 0; });
    lapidary::context moved = std::move(context);
    lapidary::cut cut(moved, mesh, {1, 0, 0, -0.5});
    check(calls > 0 && cut.complex().counts().cells == 2 && cut.plane_map().size() == 1 && !cut.stages().empty());

    /* Another plane in the same place has another name, so what lies on it has other keys, and nothing else has. */
    lapidary::cut named(moved, mesh, {1, 0, 0, -0.5});
    named.set_plane_ids(moved, {7});
    const lapidary::groups<std::int64_t, 2> keys[2] = {cut.complex().vertex_keys(), named.complex().vertex_keys()};
    const lapidary::rows<std::int32_t> on = cut.complex().vertex_planes();
    check(keys[0].count == cut.complex().counts().vertices && keys[1].count == keys[0].count);
    for (std::int64_t v = 0; v < keys[0].count; ++v) {
        const bool same = keys[0][v][0] == keys[1][v][0] && keys[0][v][1] == keys[1][v][1];
        check(same == (on[v].size() == 0));
    }
    check(cut.complex().face_keys().count == cut.complex().counts().faces);

    /* Without its last triangle it is open: defects, and no exception. */
    check(lapidary::mesh::validate(moved, xyz, indices).empty());
    check(!lapidary::mesh::validate(moved, xyz, {0, 2, 1, 0, 1, 3, 1, 2, 3}).empty());

    /* Two planes that cross in a cube. */
    const std::vector<double> values = {-1, 1, -1, 1, -1, 1, -1, 1, -1, -1, 1, 1, -1, -1, 1, 1};
    lapidary::network::values_t planes;
    planes.data = values.data();
    planes.functions = 2;
    planes.function_stride = 8;
    lapidary::network network = lapidary::network::box(moved, {1, 1, 1}, nullptr, planes);
    check(network.counts().patches == 4 && network.counts().regions == 4 && network.chains().edges.size() == 1);
    check(network.chain_patches().sides[0].size() == 4 && network.chain_patches().gaps[0][3] == 0);
    check(network.sets().functions[1][0] == 1 && network.sets().orientations[1][0] == 1);
    check(network.region_signs(3).size() == 2 && !network.stages().empty());
    const lapidary::surface quarter = network.csg(moved, "0 & 1");
    check(!quarter.polygons().births.empty() && quarter.vertices().xyz.size() == quarter.vertices().sources.size());
    const std::function<bool(std::int32_t)> none = [](std::int32_t) { return false; };
    check(network.csg(moved, none).polygons().vertices.size() == 0);
    try {
        network.csg(moved, "0 &");
        check(false);
    } catch (const lapidary::error &e) {
        check(e.status() == LAP_ERR_BAD_ARGUMENT);
    }

    /* A tetrahedron, and the same half as large again along x: what one has and not the other. */
    std::vector<double> longer = xyz;
    longer[3] = 1.5;
    const lapidary::arrangement both(moved, {lapidary::operand(xyz, indices), lapidary::operand(longer, indices)});
    check(both.counts().cells == 3 && both.cells().windings[0].empty() && both.operands().first_vertices[2] == 8);
    check(both.faces().cells.size() == both.counts().faces && both.patches().multiplicities.size() == both.counts().patches);
    check(both.extract(moved, LAP_EXTRACT_UNION).exact_volume(moved) == "1/4" && both.cell_volumes().size() == 3);
    check(both.extract(moved, "1 - 0").exact_volume(moved) == "1/12" && both.extract(moved, "0").euler() == 2);
    check(both.extract(moved, std::vector<std::uint8_t>{0, 1, 1}).volume() == 0.25 && !both.stages().empty());
    const auto second_alone = [](std::int32_t, const std::vector<std::int32_t> &w) { return w[0] == 0 && w[1] == 1; };
    const lapidary::surface rest = both.extract(moved, second_alone);
    check(rest.exact_volume(moved) == "1/12" && rest.triangles().flipped.size() == rest.polygons().births.size());
    const lapidary::surface certified = rest.certify(moved);
    check(certified.certified_report().certified == 1 && certified.certified_open().size() == 0);
    check(certified.exact_volume(moved) == "1/12" && certified.vertices().sources[0] == rest.vertices().sources[0]);
    check(both.exact_vertex(moved, rest.vertices().sources[0]).size() == 3 && both.vertex_origins().kinds.size() == both.vertices().size());
    check(both.face_births().reversed.size() == both.counts().faces && both.exact_cell_volume(moved, 0) == "0");
    try {
        both.extract(moved, [](std::int32_t, const std::vector<std::int32_t> &) -> bool { throw stop(); });
        check(false);
    } catch (const stop &) {
    }
    return failures;
}
