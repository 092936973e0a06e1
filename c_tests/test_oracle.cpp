/* Small and nasty cuts against results that were computed by other means: number of cells, exact volumes, number of
   vertices, Euler characteristic; for one and for several threads, bit for bit. */
#include "check.h"
#include "fixture.hpp"

#include <algorithm>
#include <cstring>

namespace {

template <class T>
bool same_bits(const T &a, const T &b)
{
    return a.size() == b.size() && (a.size() == 0 || std::memcmp(a.begin(), b.begin(), sizeof *a.begin() * a.size()) == 0);
}

void run(const fixture::cutting &c, const fixture::solid &s)
{
    const int before = check_failures;
    lapidary::context context, wide(4);
    lap_mesh_options options = lapidary::mesh_options();
    options.check_self_intersection = 1;
    const lapidary::mesh mesh(context, s.xyz, s.indices, {}, options);
    CHECK(mesh.exact_volume(context) == c.total);

    const lapidary::cut cut(context, mesh, c.planes);
    const lapidary::complex complex = cut.complex();
    const auto n = complex.counts();
    CHECK(n.cells == c.cells);
    CHECK(n.vertices == mesh.counts().vertices + c.new_vertices);
    CHECK(complex.euler().output == complex.euler().input);
    CHECK(complex.euler().input == mesh.euler());
    complex.check_consistency(context);

    std::vector<std::string> volumes;
    for (std::int32_t cell = 0; cell < n.cells; ++cell) volumes.push_back(complex.exact_cell_volume(context, cell));
    std::sort(volumes.begin(), volumes.end());
    if (!c.volumes.empty()) CHECK(volumes == c.volumes);

    /* Each style has what it promises. */
    const auto holes = complex.polygons(LAP_FACES_HOLES), bridged = complex.polygons(LAP_FACES_BRIDGED),
               triangles = complex.polygons(LAP_FACES_TRIANGLES);
    CHECK(holes.vertices.size() == n.loops);
    CHECK(bridged.vertices.size() == n.faces);
    CHECK(triangles.vertices.size() >= n.faces);

    const lapidary::cut again(wide, mesh, c.planes);
    const lapidary::complex other = again.complex();
    CHECK(same_bits(complex.vertices().flat(), other.vertices().flat()));
    CHECK(same_bits(complex.faces().corner_vertices, other.faces().corner_vertices));
    CHECK(same_bits(complex.faces().loop_corners, other.faces().loop_corners));
    CHECK(same_bits(complex.cells().half_faces, other.cells().half_faces));
    CHECK(same_bits(complex.cell_moments().volumes, other.cell_moments().volumes));
    CHECK(same_bits(complex.cell_moments().centroids.flat(), other.cell_moments().centroids.flat()));
    CHECK(same_bits(complex.face_moments().area_vectors.flat(), other.face_moments().area_vectors.flat()));
    CHECK(same_bits(triangles.faces, other.polygons(LAP_FACES_TRIANGLES).faces));
    if (check_failures != before) std::cerr << "in case " << c.name << '\n';
}

} // namespace

int main(int argc, char **argv)
{
    const fixture::all data = fixture::read(argc > 1 ? argv[1] : LAPIDARY_TEST_DATA "/cut_small.txt");
    for (const fixture::cutting &c : data.cuttings) {
        try {
            run(c, data.meshes.at(c.mesh));
        } catch (const std::exception &e) {
            std::cerr << c.name << ": " << e.what() << '\n';
            check_that(0, "no exception", __FILE__, __LINE__);
        }
    }
    return check_result();
}
