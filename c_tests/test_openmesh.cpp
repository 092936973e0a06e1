/* The shells of the cells that planes cut, and the surfaces of the meshes themselves, against OpenMesh. */
#include "check.h"
#include "fixture.hpp"
#include "openmesh_shells.hpp"

namespace {

using namespace openmesh_shells;

void run(const fixture::cutting &c, const fixture::solid &s)
{
    const int before = check_failures;
    lapidary::context context;
    const lapidary::mesh mesh(context, s.xyz, s.indices);
    const lapidary::cut cut(context, mesh, c.planes);
    const openmesh_shells::Found found = openmesh_shells::check_shells(cut.complex());
    std::cout << c.name << ": " << found.shells << " shells, Euler characteristic " << found.euler << ", " << found.tubes << " tubes"
              << (check_failures == before ? "" : ": FAILED") << '\n';
}

} // namespace

int main()
{
    const fixture::all data = fixture::read(LAPIDARY_TEST_DATA "/cut_small.txt");
    for (const auto &[name, s] : data.meshes) {
        /* The mesh itself: all its shells together. */
        std::vector<Wall> walls;
        for (std::size_t t = 0; t < s.indices.size(); t += 3) {
            walls.push_back({{s.indices[t], s.indices[t + 1], s.indices[t + 2]}, -1});
        }
        lapidary::context context;
        const lapidary::mesh mesh(context, s.xyz, s.indices);
        const auto counts = mesh.counts();
        std::map<std::int32_t, Umbrellas> umbrellas;
        const std::int64_t euler =
            shell_euler(walls, {s.xyz.data(), static_cast<std::int64_t>(s.xyz.size() / 3)}, {}, {}, umbrellas);
        CHECK(euler == counts.vertices - counts.edges + counts.triangles);
        /* Every vertex here has one umbrella, so the solid has half the characteristic of its surface. */
        CHECK(euler == 2 * mesh.euler());
    }
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
