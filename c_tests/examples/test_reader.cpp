// The shared reader, on small files of every format: exact coordinates, fans, merging, and nothing dropped.
#include "expect.hpp"
#include "reader.hpp"

#include <cmath>
#include <cstring>

namespace {

std::string scratch;

std::string file(const std::string &name, const std::string &text)
{
    const std::string path = scratch + "/" + name;
    std::ofstream(path, std::ios::binary) << text;
    return path;
}

bool equal_bits(double a, double b)
{
    return std::memcmp(&a, &b, sizeof a) == 0;
}

void expect_triangles(const char *what, const examples::Mesh &mesh, const std::vector<std::int32_t> &triangles)
{
    EXPECT(mesh.triangles == triangles, "%s: other triangles", what);
}

// What the reader says about a file that it cannot read.
std::string complaint(const std::string &path)
{
    try {
        examples::read_mesh(path);
    } catch (const std::runtime_error &error) {
        return error.what();
    }
    return "";
}

// Decimals that a detour through float, or one wrong rounding, would change.
void coordinates_are_correctly_rounded()
{
    const char *decimals[] = {"0.1",    "-0.30000000000000004",           "9007199254740993", "2.2250738585072011e-308",
                              "1e-320", "123456.789012345678901234567890"};
    std::string vertices;
    for (const char *d : decimals) vertices += std::string(d) + " 1 0\n";
    const examples::Mesh off = examples::read_mesh(file("round.off", "OFF\n6 2 0\n" + vertices + "3 0 1 2\n3 3 4 5\n"));
    for (int i = 0; i < 6; ++i) {
        const double exact = std::strtod(decimals[i], nullptr);
        EXPECT(equal_bits(off.coordinates[3 * i], exact), "%s read as %.17g", decimals[i], off.coordinates[3 * i]);
    }
    std::string lines;
    for (const char *d : decimals) lines += "v " + std::string(d) + " 1 0\n";
    const examples::Mesh obj = examples::read_mesh(file("round.obj", lines + "f 1 2 3\nf 4 5 6\n"));
    EXPECT(obj.coordinates == off.coordinates, "OBJ and OFF differ");
    const std::string header =
        "ply\nformat ascii 1.0\nelement vertex 6\nproperty double x\nproperty double y\nproperty double z\n"
        "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
    const examples::Mesh ply = examples::read_mesh(file("round.ply", header + vertices + "3 0 1 2\n3 3 4 5\n"));
    EXPECT(ply.coordinates == off.coordinates, "PLY and OFF differ");
}

void polygons_are_fanned_from_their_first_vertex()
{
    const std::string vertices = "0 0 0\n1 0 0\n2 1 0\n1 2 0\n0 1 0\n";
    const examples::Mesh mesh =
        examples::read_mesh(file("fan.off", "OFF\n5 2 0\n" + vertices + "5 3 4 0 1 2\n4 0 1 2 3\n"));
    expect_triangles("fan", mesh, {3, 4, 0, 3, 0, 1, 3, 1, 2, 0, 1, 2, 0, 2, 3});
}

// Equal coordinates are one vertex, the first; -0 is 0; triangles that become degenerate stay.
void vertices_are_merged_and_faces_kept()
{
    const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n-0.0 0 -0.0\n1 0 0\n7 7 7\n";
    const examples::Mesh mesh =
        examples::read_mesh(file("merge.off", "OFF\n6 3 0\n" + vertices + "3 0 1 2\n3 3 2 4\n3 0 3 5\n"));
    EXPECT(mesh.vertex_count() == 4, "%lld vertices", static_cast<long long>(mesh.vertex_count()));
    EXPECT(equal_bits(mesh.coordinates[0], 0.0), "-0 was kept");
    expect_triangles("merge", mesh, {0, 1, 2, 0, 2, 1, 0, 0, 3});
}

// An edge of four triangles: readers that build a halfedge structure drop faces here.
void faces_on_complex_edges_are_kept()
{
    const std::string vertices = "0 0 0\n0 0 1\n1 0 0\n0 1 0\n-1 0 0\n0 -1 0\n";
    const examples::Mesh mesh =
        examples::read_mesh(file("complex.off", "OFF\n6 4 0\n" + vertices + "3 0 1 2\n3 0 1 3\n3 0 1 4\n3 0 1 5\n"));
    EXPECT(mesh.triangle_count() == 4, "%lld triangles", static_cast<long long>(mesh.triangle_count()));
}

void stl_is_read_and_stitched()
{
    auto facet = [](const std::string &a, const std::string &b, const std::string &c) {
        return "facet normal 0 0 0\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c +
               "\nendloop\nendfacet\n";
    };
    const std::string o = "0 0 0", x = "0.1 0 0", y = "0 0.1 0", z = "0 0 0.1";
    const std::string text =
        "solid t\n" + facet(o, y, x) + facet(o, x, z) + facet(x, y, z) + facet(y, o, z) + "endsolid t\n";
    const examples::Mesh mesh = examples::read_mesh(file("ascii.stl", text));
    EXPECT(mesh.vertex_count() == 4, "%lld vertices", static_cast<long long>(mesh.vertex_count()));
    EXPECT(mesh.triangle_count() == 4, "%lld triangles", static_cast<long long>(mesh.triangle_count()));
    double largest = 0;
    for (double c : mesh.coordinates) largest = std::max(largest, c);
    EXPECT(equal_bits(largest, 0.1), "0.1 read as %.17g", largest);
}

void files_that_cannot_be_read_are_named()
{
    EXPECT(complaint(scratch + "/none.off").find("none.off: cannot be opened") != std::string::npos, "no complaint");
    EXPECT(complaint(file("words.off", "OFF\nthree vertices\n")).find("words.off") != std::string::npos,
           "no complaint");
    EXPECT(complaint(file("mesh.xyz", "0 0 0\n")).find("mesh.xyz") != std::string::npos, "no complaint");
    EXPECT(!complaint(file("range.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n")).empty(),
           "an index out of range was read");
}

} // namespace

int main(int, char **argv)
{
    scratch = argv[1];
    coordinates_are_correctly_rounded();
    polygons_are_fanned_from_their_first_vertex();
    vertices_are_merged_and_faces_kept();
    faces_on_complex_edges_are_kept();
    stl_is_read_and_stitched();
    files_that_cannot_be_read_are_named();
    return expect_failures == 0 ? 0 : 1;
}
