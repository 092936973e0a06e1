// mpi_blocks: every rank cuts its block of one grid, from the part of the mesh that meets it, and ranks that share a side of their
// blocks compare what they have there bit by bit. `mpi_blocks` without arguments says how to use it.
//
// Rank 0 reads the mesh and deals it out: to each rank the triangles whose bounding boxes meet its block, with their places
// in the whole mesh as ids, and one node of the block that is known to be in the solid or not. From then on no rank needs
// another one to cut its block: keys of vertices and faces are made of ids of triangles and planes alone, and coordinates are the
// doubles nearest to exact points, so both sides of a shared face come out the same.
#include "grid.hpp"

// The C interface alone.
#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include <lapidary.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace examples;

constexpr const char *usage = R"(usage: mpiexec -n RANKS mpi_blocks MESH NX NY NZ [--outside] [--vtu NAME]
Cuts the boxes of a grid of NX x NY x NZ nodes, evenly over the bounding box of the mesh grown by 1/20, a block on each rank.
  --outside     the fluid is outside the mesh, not inside
  --vtu NAME    NAME_RANK.vtu from each rank, and NAME.pvtu over all
exit status: 0 shared faces and the serial result are matched bit by bit, 1 they are not or the library refused, 2 wrong usage, 3 a file
cannot be read or written
)";

struct Options {
    std::string mesh, vtu;
    std::array<long, 3> nodes{};
    bool outside = false;
};

Options parse(const std::vector<std::string> &given)
{
    Options options;
    Arguments arguments;
    arguments.flag("--outside", options.outside);
    arguments.text("--vtu", options.vtu);
    std::vector<std::string> plain;
    arguments.read(given, [&](const std::string &a) { plain.push_back(a); });
    if (plain.size() != 4) throw UsageError("a mesh and three numbers of nodes are needed");
    options.mesh = plain[0];
    for (int axis = 0; axis < 3; ++axis) options.nodes[axis] = to_count("nodes", plain[axis + 1], 2, 100000);
    return options;
}

// How the grid is split: so many blocks along each axis, each of so many boxes; and where a rank is.
struct Layout {
    std::array<int, 3> blocks{};
    std::array<std::int64_t, 3> boxes{};

    std::array<int, 3> place(int rank) const
    {
        return {rank % blocks[0], rank / blocks[0] % blocks[1], rank / (blocks[0] * blocks[1])};
    }
    int rank(const std::array<int, 3> &at) const { return at[0] + blocks[0] * (at[1] + blocks[1] * at[2]); }
    std::int64_t low(int axis, int block) const { return boxes[axis] * block / blocks[axis]; }
};

// The part of a mesh that a block needs, and what is known about it.
struct Patch {
    std::vector<double> xyz;
    std::vector<std::int32_t> triangles;
    std::vector<std::int64_t> ids;
    std::vector<std::int32_t> known; // LAP_NODE_*, then the node
};

template <typename T>
MPI_Datatype mpi_type();
template <>
MPI_Datatype mpi_type<double>()
{
    return MPI_DOUBLE;
}
template <>
MPI_Datatype mpi_type<std::int32_t>()
{
    return MPI_INT32_T;
}
template <>
MPI_Datatype mpi_type<std::int64_t>()
{
    return MPI_INT64_T;
}
template <>
MPI_Datatype mpi_type<std::uint8_t>()
{
    return MPI_UINT8_T;
}

template <typename T>
void send(const std::vector<T> &values, int to)
{
    MPI_Send(values.data(), static_cast<int>(values.size()), mpi_type<T>(), to, 0, MPI_COMM_WORLD);
}

template <typename T>
std::vector<T> receive(int from)
{
    MPI_Status status;
    int count = 0;
    MPI_Probe(from, 0, MPI_COMM_WORLD, &status);
    MPI_Get_count(&status, mpi_type<T>(), &count);
    std::vector<T> values(static_cast<std::size_t>(count));
    MPI_Recv(values.data(), count, mpi_type<T>(), from, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return values;
}

// Both sides send theirs and receive the other's.
template <typename T>
std::vector<T> swap_with(const std::vector<T> &mine, int other)
{
    const std::int64_t count = static_cast<std::int64_t>(mine.size());
    std::int64_t theirs = 0;
    MPI_Sendrecv(&count, 1, MPI_INT64_T, other, 1, &theirs, 1, MPI_INT64_T, other, 1, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    std::vector<T> values(static_cast<std::size_t>(theirs));
    MPI_Sendrecv(mine.data(), static_cast<int>(count), mpi_type<T>(), other, 2, values.data(), static_cast<int>(theirs),
                 mpi_type<T>(), other, 2, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return values;
}

// The triangles whose bounding boxes meet the closed box of a block, with the vertices they use, in the order of the whole.
Patch patch_of(const Mesh &mesh, const std::array<double, 3> &low, const std::array<double, 3> &high)
{
    Patch patch;
    std::vector<std::int32_t> number(static_cast<std::size_t>(mesh.vertex_count()), -1);
    for (std::int64_t t = 0; t < mesh.triangle_count(); ++t) {
        const std::int32_t *corners = &mesh.triangles[static_cast<std::size_t>(3 * t)];
        bool meets = true;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto [least, most] = std::minmax({mesh.coordinates[3 * static_cast<std::size_t>(corners[0]) + axis],
                                                    mesh.coordinates[3 * static_cast<std::size_t>(corners[1]) + axis],
                                                    mesh.coordinates[3 * static_cast<std::size_t>(corners[2]) + axis]});
            meets = meets && least <= high[axis] && low[axis] <= most;
        }
        if (!meets) continue;
        patch.ids.push_back(t);
        for (int k = 0; k < 3; ++k) {
            std::int32_t &n = number[static_cast<std::size_t>(corners[k])];
            if (n < 0) {
                n = static_cast<std::int32_t>(patch.xyz.size() / 3);
                const double *x = &mesh.coordinates[3 * static_cast<std::size_t>(corners[k])];
                patch.xyz.insert(patch.xyz.end(), x, x + 3);
            }
            patch.triangles.push_back(n);
        }
    }
    return patch;
}

// A node of the block that is not on the surface, and whether it is in the fluid.
std::vector<std::int32_t> known_node(lap_context *context, const lap_mesh *mesh, const Nodes &nodes,
                                     const std::array<std::int64_t, 3> &low, const std::array<std::int64_t, 3> &high,
                                     bool outside)
{
    for (std::int64_t k = low[2]; k <= high[2]; ++k)
        for (std::int64_t j = low[1]; j <= high[1]; ++j)
            for (std::int64_t i = low[0]; i <= high[0]; ++i) {
                const double x[3] = {nodes.at(0)[i], nodes.at(1)[j], nodes.at(2)[k]};
                const std::int32_t *place = nullptr;
                must(context, lap_mesh_locate(context, mesh, 1, x, &place));
                if (*place == LAP_PLACE_SURFACE) continue;
                const bool fluid = (*place == LAP_PLACE_INSIDE) != outside;
                return {fluid ? LAP_NODE_FLUID : LAP_NODE_SOLID, static_cast<std::int32_t>(i),
                        static_cast<std::int32_t>(j), static_cast<std::int32_t>(k)};
            }
    throw std::runtime_error("all nodes of a block lie on the surface: take another grid");
}

// On rank 0: every rank's patch.
Patch deal_out(lap_context *context, const lap_mesh *mesh, const Mesh &input, const Nodes &nodes, const Layout &layout,
               int ranks, bool outside)
{
    Patch own;
    for (int rank = ranks - 1; rank >= 0; --rank) {
        const auto at = layout.place(rank);
        std::array<std::int64_t, 3> low{}, high{};
        std::array<double, 3> least{}, most{};
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = layout.low(axis, at[axis]);
            high[axis] = layout.low(axis, at[axis] + 1);
            least[axis] = nodes.at(axis)[low[axis]];
            most[axis] = nodes.at(axis)[high[axis]];
        }
        own = patch_of(input, least, most);
        own.known = known_node(context, mesh, nodes, low, high, outside);
        if (rank == 0) break;
        send(own.xyz, rank);
        send(own.triangles, rank);
        send(own.ids, rank);
        send(own.known, rank);
    }
    return own;
}

// What a rank compares with its neighbour: numbers and the bits of doubles.
std::int64_t bits(double x)
{
    std::int64_t b;
    std::memcpy(&b, &x, sizeof b);
    return b;
}

// The faces of one side of a block, as records of numbers: key, where its square is on the side, area, fraction and centroid, loops.
// A loop begins at its smallest key, since where it begins in the arrays is nobody's business; holes go by their first
// vertex.
struct Side {
    std::vector<std::vector<std::int64_t>> faces; // sorted, so by key
    std::vector<std::uint8_t> flags;              // of the boxes at this side
};

Side side_of(lap_context *context, const lap_grid *grid, int axis, bool upper)
{
    const Block block = block_of(context, grid);
    const std::int32_t *axes = nullptr, *squares = nullptr, *cells = nullptr, *face_loops = nullptr, *loop_corners = nullptr,
                       *corners = nullptr;
    const std::int64_t *face_keys = nullptr, *vertex_keys = nullptr;
    const double *xyz = nullptr, *areas = nullptr, *fractions = nullptr, *centroids = nullptr;
    std::int64_t first = 0;
    must(context, lap_grid_plane_faces(grid, &first, nullptr, &axes, &squares, &cells));
    must(context, lap_grid_faces(grid, nullptr, &face_loops, &loop_corners, &corners));
    must(context, lap_grid_vertices(grid, nullptr, &xyz, nullptr));
    must(context, lap_grid_vertex_keys(grid, nullptr, &vertex_keys));
    must(context, lap_grid_face_keys(grid, nullptr, &face_keys));
    must(context, lap_grid_plane_face_moments(grid, nullptr, &areas, &fractions, &centroids, nullptr));
    auto vertex_key = [&](std::int32_t corner) {
        const std::int64_t *key = vertex_keys + 2 * static_cast<std::int64_t>(corners[corner]);
        return std::make_pair(key[0], key[1]);
    };

    Side side;
    const int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    const std::int64_t plane = upper ? block.boxes[axis] : 0;
    for (std::int64_t f = axes[axis]; f < axes[axis + 1]; ++f) {
        const std::int64_t i = f - first, node = squares[i], nx = block.boxes[0] + 1, ny = block.boxes[1] + 1;
        const std::int64_t at[3] = {node % nx, node / nx % ny, node / (nx * ny)};
        if (at[axis] != plane) continue;
        std::vector<std::int64_t> record = {face_keys[2 * f], face_keys[2 * f + 1], at[u] + block.boxes[u] * at[v],
                                            bits(areas[i]), bits(fractions[i])};
        for (int k = 0; k < 3; ++k) record.push_back(bits(centroids[3 * i + k]));
        std::vector<std::vector<std::int64_t>> loops;
        for (std::int32_t l = face_loops[f]; l < face_loops[f + 1]; ++l) {
            const std::int32_t begin = loop_corners[l], size = loop_corners[l + 1] - begin;
            std::int32_t start = 0;
            for (std::int32_t k = 1; k < size; ++k)
                if (vertex_key(begin + k) < vertex_key(begin + start)) start = k;
            loops.emplace_back();
            for (std::int32_t k = 0; k < size; ++k) {
                const std::int32_t corner = begin + (start + k) % size;
                const auto key = vertex_key(corner);
                loops.back().insert(loops.back().end(), {key.first, key.second});
                for (int c = 0; c < 3; ++c) loops.back().push_back(bits(xyz[3 * static_cast<std::int64_t>(corners[corner]) + c]));
            }
        }
        std::sort(loops.begin() + 1, loops.end());
        for (const auto &loop : loops) {
            record.push_back(static_cast<std::int64_t>(loop.size()));
            record.insert(record.end(), loop.begin(), loop.end());
        }
        side.faces.push_back(std::move(record));
    }
    std::sort(side.faces.begin(), side.faces.end());
    std::int64_t box[3];
    box[axis] = upper ? block.boxes[axis] - 1 : 0;
    for (box[v] = 0; box[v] < block.boxes[v]; ++box[v])
        for (box[u] = 0; box[u] < block.boxes[u]; ++box[u])
            side.flags.push_back(block.flags[box[0] + block.boxes[0] * (box[1] + block.boxes[1] * box[2])]);
    return side;
}

std::vector<std::int64_t> flat(const std::vector<std::vector<std::int64_t>> &faces)
{
    std::vector<std::int64_t> all;
    for (const auto &face : faces) {
        all.push_back(static_cast<std::int64_t>(face.size()));
        all.insert(all.end(), face.begin(), face.end());
    }
    return all;
}

std::vector<std::vector<std::int64_t>> unflat(const std::vector<std::int64_t> &all)
{
    std::vector<std::vector<std::int64_t>> faces;
    for (std::size_t i = 0; i < all.size();) {
        const auto size = static_cast<std::size_t>(all[i]);
        faces.emplace_back(all.begin() + static_cast<std::ptrdiff_t>(i + 1),
                           all.begin() + static_cast<std::ptrdiff_t>(i + 1 + size));
        i += 1 + size;
    }
    return faces;
}

// Faces towards a full box have no counterpart, for a full box has no faces of its own; they are whole squares. The others are
// left. Returns how many of the squares are not whole.
std::int64_t drop_full(std::vector<std::vector<std::int64_t>> &faces, const std::vector<std::uint8_t> &beyond)
{
    std::int64_t broken = 0;
    auto towards_full = [&](const std::vector<std::int64_t> &face) {
        if (beyond[static_cast<std::size_t>(face[2])] != LAP_BOX_FULL) return false;
        broken += face[4] != bits(1.0);
        return true;
    };
    faces.erase(std::remove_if(faces.begin(), faces.end(), towards_full), faces.end());
    return broken;
}

// Shared faces: how many were compared, and how many mismatched.
struct Compared {
    std::int64_t faces = 0, mismatches = 0;
};

Compared compare_sides(lap_context *context, const lap_grid *grid, const Layout &layout, int rank)
{
    Compared result;
    const auto at = layout.place(rank);
    // Every rank walks the axes in the same order, first even blocks with the next one, then odd blocks: nobody waits in a circle.
    for (int axis = 0; axis < 3; ++axis)
        for (int parity = 0; parity < 2; ++parity) {
            const bool upper = at[axis] % 2 == parity;
            auto beyond = at;
            beyond[axis] += upper ? 1 : -1;
            if (beyond[axis] < 0 || beyond[axis] == layout.blocks[axis]) continue;
            const int other = layout.rank(beyond);
            Side mine = side_of(context, grid, axis, upper), theirs;
            theirs.flags = swap_with(mine.flags, other);
            theirs.faces = unflat(swap_with(flat(mine.faces), other));
            if (mine.flags.size() != theirs.flags.size()) throw std::runtime_error("the sides of two blocks differ in size");
            result.mismatches += drop_full(mine.faces, theirs.flags) + drop_full(theirs.faces, mine.flags);
            std::vector<std::vector<std::int64_t>> different;
            std::set_symmetric_difference(mine.faces.begin(), mine.faces.end(), theirs.faces.begin(), theirs.faces.end(),
                                          std::back_inserter(different));
            result.mismatches += static_cast<std::int64_t>(different.size());
            result.faces += upper ? static_cast<std::int64_t>(mine.faces.size()) : 0;
        }
    return result;
}

// Volumes of cut cells with the box they are in, in the whole grid, as numbers to be compared: two per cell; sorted.
using Volumes = std::vector<std::pair<std::int64_t, std::int64_t>>;

Volumes volumes_of(lap_context *context, const lap_grid *grid)
{
    const Block block = block_of(context, grid);
    const std::int32_t *boxes = nullptr;
    const double *volumes = nullptr;
    std::int64_t count = 0;
    must(context, lap_grid_cells(grid, &count, &boxes, nullptr, nullptr, nullptr));
    must(context, lap_grid_cell_moments(grid, nullptr, &volumes, nullptr, nullptr, nullptr));
    Volumes all;
    for (std::int64_t c = 0; c < count; ++c) {
        const auto at = block.box_at(boxes[c]);
        const std::int64_t box = at[0] + block.first[0] + block.total[0] * (at[1] + block.first[1] + block.total[1] * (at[2] + block.first[2]));
        all.emplace_back(box, bits(volumes[c]));
    }
    std::sort(all.begin(), all.end());
    return all;
}

double sum_of(const Volumes &volumes)
{
    Sum sum;
    for (const auto &v : volumes) {
        double volume;
        std::memcpy(&volume, &v.second, sizeof volume);
        add(sum, volume);
    }
    return value(sum);
}

// All ranks' volumes on rank 0, in the order of the whole grid.
Volumes gather(const Volumes &mine, int rank, int ranks)
{
    std::vector<std::int64_t> numbers;
    for (const auto &v : mine) numbers.insert(numbers.end(), {v.first, v.second});
    if (rank != 0) {
        send(numbers, 0);
        return {};
    }
    Volumes all = mine;
    for (int from = 1; from < ranks; ++from) {
        const auto more = receive<std::int64_t>(from);
        for (std::size_t i = 0; i < more.size(); i += 2) all.emplace_back(more[i], more[i + 1]);
    }
    std::sort(all.begin(), all.end());
    return all;
}

int mpi_blocks(const Options &options, int rank, int ranks)
{
    lap_context *made = nullptr;
    must(nullptr, lap_context_new(&made));
    const Handle<lap_context> handle(made);
    lap_context *context = handle.get();

    // Rank 0 alone knows the mesh.
    Mesh input;
    Nodes nodes;
    Handle<lap_mesh> mesh;
    for (int axis = 0; axis < 3; ++axis) nodes.along[axis].resize(static_cast<std::size_t>(options.nodes[axis]));
    if (rank == 0) {
        input = read_mesh(options.mesh);
        if (reverse_if_inward(context, input)) std::cerr << options.mesh << " faces inward: all its triangles are reversed\n";
        nodes = even_nodes(bounding_box(input), options.nodes);
        lap_mesh *whole = nullptr;
        must(context, lap_mesh_new(context, input.vertex_count(), input.coordinates.data(), input.triangle_count(),
                                   input.triangles.data(), nullptr, nullptr, &whole));
        mesh.reset(whole);
    }
    for (auto &along : nodes.along)
        MPI_Bcast(along.data(), static_cast<int>(along.size()), MPI_DOUBLE, 0, MPI_COMM_WORLD);
    Layout layout;
    MPI_Dims_create(ranks, 3, layout.blocks.data());
    for (int axis = 0; axis < 3; ++axis) {
        layout.boxes[axis] = options.nodes[axis] - 1;
        if (layout.blocks[axis] > layout.boxes[axis]) throw UsageError("more ranks than boxes along an axis");
    }

    Patch patch;
    if (rank == 0) {
        patch = deal_out(context, mesh.get(), input, nodes, layout, ranks, options.outside);
    } else {
        patch.xyz = receive<double>(0);
        patch.triangles = receive<std::int32_t>(0);
        patch.ids = receive<std::int64_t>(0);
        patch.known = receive<std::int32_t>(0);
    }

    // The block, from the patch alone.
    lap_grid_options grid_options;
    must(context, lap_grid_options_init(&grid_options, static_cast<std::int32_t>(sizeof grid_options)));
    grid_options.outside = options.outside;
    grid_options.check = 1;
    grid_options.known = patch.known[0];
    const auto at = layout.place(rank);
    for (int axis = 0; axis < 3; ++axis) {
        grid_options.block_low[axis] = static_cast<std::int32_t>(layout.low(axis, at[axis]));
        grid_options.block_high[axis] = static_cast<std::int32_t>(layout.low(axis, at[axis] + 1));
        grid_options.known_node[axis] = patch.known[static_cast<std::size_t>(axis) + 1];
    }
    lap_grid *cut = nullptr;
    must(context,
         lap_grid_new_patch(context, static_cast<std::int64_t>(patch.xyz.size() / 3), patch.xyz.data(),
                            static_cast<std::int64_t>(patch.ids.size()), patch.triangles.data(), nullptr, patch.ids.data(),
                            nodes.count(0), nodes.at(0), nodes.count(1), nodes.at(1), nodes.count(2), nodes.at(2),
                            &grid_options, &cut));
    const Handle<lap_grid> grid(cut);

    const Compared compared = compare_sides(context, grid.get(), layout, rank);
    std::int64_t mine[6] = {compared.faces, compared.mismatches, static_cast<std::int64_t>(patch.ids.size()), 0, 0, 0};
    must(context, lap_grid_counts(grid.get(), &mine[3], &mine[4], &mine[5], nullptr, nullptr, nullptr, nullptr));
    std::int64_t all[6];
    MPI_Allreduce(mine, all, 6, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
    const Volumes own = volumes_of(context, grid.get());
    const Volumes volumes = gather(own, rank, ranks);
    const double parts[2] = {sum_of(own), full_volume(block_of(context, grid.get()))};
    double sums[2];
    MPI_Reduce(parts, sums, 2, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);

    if (!options.vtu.empty()) {
        std::vector<std::int64_t> full_boxes;
        const Hexahedra hexahedra = full_hexahedra(block_of(context, grid.get()), full_boxes);
        write_grid_vtu(options.vtu + "_" + std::to_string(rank) + ".vtu", context, grid.get(), hexahedra, full_boxes);
        if (rank == 0) write_pvtu(options.vtu, ranks);
    }

    std::int32_t failed = all[1] != 0;
    if (rank == 0) {
        // The same grid, cut by one rank that has the whole mesh.
        lap_grid *one = nullptr;
        must(context, lap_grid_options_init(&grid_options, static_cast<std::int32_t>(sizeof grid_options)));
        grid_options.outside = options.outside;
        must(context, lap_grid_new(context, mesh.get(), nodes.count(0), nodes.at(0), nodes.count(1), nodes.at(1),
                                   nodes.count(2), nodes.at(2), &grid_options, &one));
        const Handle<lap_grid> serial(one);
        const Volumes expected = volumes_of(context, serial.get());
        std::int64_t boxes[3];
        must(context, lap_grid_counts(serial.get(), &boxes[0], &boxes[1], &boxes[2], nullptr, nullptr, nullptr, nullptr));
        const bool same_cells = volumes == expected, same_boxes = std::equal(boxes, boxes + 3, all + 3);
        const double serial_sum = sum_of(expected), sum = sum_of(volumes);
        failed = failed || !same_cells || !same_boxes || bits(sum) != bits(serial_sum);
        std::printf("%s, fluid %s, %d ranks as %d x %d x %d blocks\n", options.mesh.c_str(),
                    options.outside ? "outside" : "inside", ranks, layout.blocks[0], layout.blocks[1], layout.blocks[2]);
        print_count("triangles", input.triangle_count());
        print_count("  held by all ranks", all[2]);
        print_count("boxes empty", all[3]);
        print_count("boxes full", all[4]);
        print_count("boxes cut", all[5]);
        print_count("cut cells", static_cast<std::int64_t>(volumes.size()));
        print_count("shared faces", all[0]);
        print_count("  that differ", all[1]);
        std::printf("  %-24s %23.17g\n", "volume of cut cells", sum);
        std::printf("  %-24s %23.17g\n", "  cut serially", serial_sum);
        std::printf("  %-24s %23.17g\n", "volume of all fluid", sums[0] + sums[1]);
        std::printf("%s\n", failed ? "MISMATCH" : "all shared faces, boxes and volumes match bit by bit");
    }
    MPI_Bcast(&failed, 1, MPI_INT32_T, 0, MPI_COMM_WORLD);
    return failed;
}

} // namespace

int main(int argc, char **argv)
{
    MPI_Init(&argc, &argv);
    int rank = 0, ranks = 1;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    bool finished = false;
    const int status = run_program("mpi_blocks", usage, [&] {
        Options options;
        try {
            options = parse(std::vector<std::string>(argv + 1, argv + argc));
        } catch (const UsageError &) {
            if (rank == 0) throw;
            MPI_Barrier(MPI_COMM_WORLD); // rank 0 says it for all, and ends all
        }
        const int result = mpi_blocks(options, rank, ranks);
        finished = true;
        return result;
    });
    // A rank that failed alone must not leave the others waiting.
    if (!finished) MPI_Abort(MPI_COMM_WORLD, status);
    MPI_Finalize();
    return status;
}
