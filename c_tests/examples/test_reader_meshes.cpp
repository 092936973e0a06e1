// The shared reader on every mesh of CGAL's data set: all of them can be read, and the closed ones have the numbers of
// vertices and triangles that were counted by other means.
#include "expect.hpp"
#include "reader.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>

int main(int, char **argv)
{
    const std::string oracle = argv[1], meshes = argv[2];
    if (!std::filesystem::exists(meshes + "/elephant.off")) {
        std::printf("skipped: no meshes in '%s' (set LAPIDARY_CGAL_MESHES)\n", meshes.c_str());
        return 77;
    }
    int read = 0;
    for (const auto &entry : std::filesystem::directory_iterator(meshes)) {
        const std::string path = entry.path().string(), extension = entry.path().extension().string();
        if (extension != ".off" && extension != ".obj" && extension != ".stl" && extension != ".ply") continue;
        try {
            examples::read_mesh(path);
            ++read;
        } catch (const std::runtime_error &error) {
            EXPECT(false, "%s", error.what());
        }
    }
    EXPECT(read > 100, "only %d meshes there", read);

    if (!std::filesystem::exists(oracle)) {
        std::printf("no counts to compare with: %s is not there\n", oracle.c_str());
        return expect_failures == 0 ? 77 : 1;
    }
    std::ifstream in(oracle);
    const nlohmann::json oracles = nlohmann::json::parse(in);
    EXPECT(oracles["meshes"].size() > 70, "only %zu meshes in %s", oracles["meshes"].size(), oracle.c_str());
    for (const auto &expected : oracles["meshes"]) {
        const std::string name = expected["file"];
        const examples::Mesh mesh = examples::read_mesh(meshes + "/" + name);
        EXPECT(mesh.vertex_count() == expected["vertices"].get<std::int64_t>(), "%s: %lld vertices", name.c_str(),
               static_cast<long long>(mesh.vertex_count()));
        EXPECT(mesh.triangle_count() == expected["triangles"].get<std::int64_t>(), "%s: %lld triangles", name.c_str(),
               static_cast<long long>(mesh.triangle_count()));
    }
    return expect_failures == 0 ? 0 : 1;
}
