// Plane sets: the grid's places, the plane file's grammar, and random planes that must never change.
#include "expect.hpp"
#include "planes.hpp"

#include <cstring>

namespace {

void grid_includes_the_sides_of_the_box()
{
    const examples::Box box{{-1, 0, 2}, {1, 1, 2.5}};
    const std::vector<double> planes = examples::grid_planes(box, {5, 1, 2});
    const std::vector<double> expected = {1, 0, 0, 1,  1, 0, 0, 0.5,  1, 0, 0, 0,  1, 0, 0, -0.5,
                                          1, 0, 0, -1, 0, 1, 0, -0.5, 0, 0, 1, -2, 0, 0, 1, -2.5};
    EXPECT(planes == expected, "%zu numbers", planes.size());
}

// A seed means the same planes for ever: a digest of a thousand, computed from the generator's definition in another
// language.
void random_planes_are_the_same_everywhere()
{
    const examples::Box box{{0, 0, 0}, {1, 2, 3}};
    const std::vector<double> planes = examples::random_planes(box, 1000, 1);
    EXPECT(planes.size() == 4000, "%zu numbers", planes.size());
    std::uint64_t digest = 14695981039346656037u; // FNV-1a over the bits
    for (double v : planes) {
        std::uint64_t bits;
        static_assert(sizeof bits == sizeof v, "doubles of 64 bits");
        std::memcpy(&bits, &v, sizeof bits);
        for (int i = 0; i < 8; ++i) digest = (digest ^ (bits >> (8 * i) & 255)) * 1099511628211u;
    }
    EXPECT(digest == 14401608144171657305u, "digest %llu", static_cast<unsigned long long>(digest));
    EXPECT(planes != examples::random_planes(box, 1000, 2), "the seed does nothing");
}

void plane_files()
{
    auto write = [](const std::string &path, const char *text) { std::ofstream(path) << text; };
    const std::string path = "planes.txt";
    write(path, "2 4\n# a comment\n1 0 0 -0.1\n\n0 1e-3 0 5 # another\n");
    EXPECT((examples::read_planes(path) == std::vector<double>{1, 0, 0, -0.1, 0, 1e-3, 0, 5}), "other planes");
    for (const char *bad : {"1 0 0\n", "1 0 0 0 0\n", "1 0 x 0\n", "1 0 0 0\n2 4\n"}) {
        write(path, bad);
        bool refused = false;
        try {
            examples::read_planes(path);
        } catch (const std::runtime_error &error) {
            refused = std::string(error.what()).find("line ") != std::string::npos;
        }
        EXPECT(refused, "read %s", bad);
    }
}

} // namespace

int main()
{
    grid_includes_the_sides_of_the_box();
    random_planes_are_the_same_everywhere();
    plane_files();
    return expect_failures == 0 ? 0 : 1;
}
