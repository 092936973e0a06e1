// Real meshes cut by the planes of an independent program, whose numbers of cells, and where no face has a hole of
// edges and faces, have to come out; and the invariants of every cut: Euler characteristic, check, volume.
#include "expect.hpp"
#include "reader.hpp"
#include "report.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>

namespace {

using nlohmann::json;

void cut_one(const json &expected, const examples::Mesh &input, const std::string &name)
{
    std::vector<double> planes;
    for (const json &plane : expected["planes"])
        for (const json &c : plane) planes.push_back(c.get<double>());
    lap_context *context = nullptr;
    lap_mesh *mesh = nullptr;
    lap_cut *cut = nullptr;
    const lap_complex *complex = nullptr;
    lap_cut_options options;
    examples::must(nullptr, lap_context_new(&context));
    examples::must(context, lap_cut_options_init(&options, sizeof options));
    options.check = 1;
    examples::must(context, lap_mesh_new(context, input.vertex_count(), input.coordinates.data(),
                                         input.triangle_count(), input.triangles.data(), nullptr, nullptr, &mesh));
    examples::must(context, lap_cut_new(context, mesh, static_cast<std::int64_t>(planes.size() / 4), planes.data(),
                                        &options, &cut));
    examples::must(context, lap_cut_complex(cut, &complex));

    std::int64_t edges = 0, faces = 0, cells = 0, loops = 0, euler = 0, solid = 0;
    examples::must(context, lap_complex_counts(complex, nullptr, &edges, &faces, &cells, &loops, nullptr, nullptr));
    examples::must(context, lap_complex_euler(complex, &euler, &solid));
    EXPECT(cells == expected["cells"].get<std::int64_t>(), "%s: %lld cells", name.c_str(),
           static_cast<long long>(cells));
    EXPECT(euler == solid, "%s: Euler characteristic %lld, the solid's is %lld", name.c_str(),
           static_cast<long long>(euler), static_cast<long long>(solid));
    if (loops == faces) { // no holes: the other program bridges them
        EXPECT(edges == expected["edges"].get<std::int64_t>(), "%s: %lld edges", name.c_str(),
               static_cast<long long>(edges));
        EXPECT(faces == expected["faces"].get<std::int64_t>(), "%s: %lld faces", name.c_str(),
               static_cast<long long>(faces));
    }
    lap_cut_free(cut);
    lap_mesh_free(mesh);
    lap_context_free(context);
}

} // namespace

int main(int, char **argv)
{
    const std::string oracle = argv[1], meshes = argv[2], more = argv[3];
    if (!std::filesystem::exists(oracle) || !std::filesystem::exists(meshes + "/elephant.off")) {
        std::printf("skipped: needs %s and CGAL's meshes in '%s' (set LAPIDARY_SHARED, LAPIDARY_CGAL_MESHES)\n",
                    oracle.c_str(), meshes.c_str());
        return 77;
    }
    std::ifstream in(oracle);
    int run = 0;
    const json oracles = json::parse(in);
    for (const json &expected : oracles["cases"]) {
        const std::string mesh = expected["mesh"], name = mesh + " " + expected["set"].get<std::string>();
        // One model is not of CGAL's set: it lies with the oracles under a shorter name.
        const std::string path =
            mesh == "x_rocker-arm" || mesh == "x_rocker-arm.off" ? more + "/rocker-arm.obj" : meshes + "/" + mesh;
        try {
            cut_one(expected, examples::read_mesh(path), name);
            ++run;
        } catch (const std::exception &error) {
            EXPECT(false, "%s: %s", name.c_str(), error.what());
        }
    }
    std::printf("%d cuts\n", run);
    EXPECT(run > 0, "no cases in %s", oracle.c_str());
    return expect_failures == 0 ? 0 : 1;
}
