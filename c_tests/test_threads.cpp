/* A const handle read by many threads at once, all of which may be the first to ask for what is computed on demand; and
   contexts of their own at work side by side. */
#include "check.h"
#include "fixture.hpp"

#include <atomic>
#include <thread>

namespace {

struct seen {
    const double *volumes = nullptr, *areas = nullptr;
    const std::int32_t *origins = nullptr, *supports = nullptr, *mates = nullptr, *polygons[3] = {};
    std::int64_t euler = 0;
    std::string vertex, volume;
    std::vector<double> own;
};

void look(const lapidary::complex &complex, seen &s, int start)
{
    lapidary::context context;
    for (int i = 0; i < 6; ++i) {
        /* Every thread begins with another one. */
        switch ((start + i) % 6) {
        case 0: s.volumes = complex.cell_moments().volumes.data; break;
        case 1: s.areas = complex.face_moments().area_vectors.data; break;
        case 2: s.mates = complex.adjacency().mates.data; break;
        case 3:
            for (int style = 0; style < 3; ++style) s.polygons[style] = complex.polygons(style).vertices.items;
            break;
        case 4:
            s.origins = complex.vertex_origins().ids.data;
            s.supports = complex.face_supports().ids.data;
            break;
        default: s.euler = complex.euler().output;
        }
    }
    s.vertex = complex.exact_vertex(context, static_cast<std::int32_t>(complex.counts().vertices) - 1)[0];
    s.volume = complex.exact_cell_volume(context, 0);
    complex.check_consistency(context);
}

} // namespace

int main(int argc, char **argv)
{
    const fixture::all data = fixture::read(argc > 1 ? argv[1] : LAPIDARY_TEST_DATA "/cut_small.txt");
    const fixture::cutting *c = nullptr;
    for (const fixture::cutting &one : data.cuttings) {
        if (one.name == "stair_A4") c = &one;
    }
    CHECK(c != nullptr);
    if (c == nullptr) return check_result();
    const fixture::solid &s = data.meshes.at(c->mesh);

    lapidary::context context;
    const lapidary::mesh mesh(context, s.xyz, s.indices);
    const int threads = 8;
    for (int round = 0; round < 4; ++round) {
        const lapidary::cut cut(context, mesh, c->planes);
        const lapidary::complex complex = cut.complex();
        std::vector<seen> all(threads);
        std::vector<std::thread> running;
        std::atomic<int> thrown{0};
        for (int i = 0; i < threads; ++i) {
            running.emplace_back([&, i] {
                try {
                    look(complex, all[i], i);
                    lapidary::context own(1 + i % 2);
                    const lapidary::cut mine(own, mesh, c->planes);
                    const auto xyz = mine.complex().vertices().flat();
                    all[i].own.assign(xyz.begin(), xyz.end());
                } catch (const std::exception &e) {
                    std::cerr << e.what() << '\n';
                    ++thrown;
                }
            });
        }
        for (std::thread &t : running) t.join();
        CHECK(thrown == 0);
        CHECK(all[0].volumes != nullptr && all[0].mates != nullptr && !all[0].own.empty());
        for (const seen &one : all) {
            /* Computed once: all see the same arrays. */
            CHECK(one.volumes == all[0].volumes && one.areas == all[0].areas && one.mates == all[0].mates);
            CHECK(one.origins == all[0].origins && one.supports == all[0].supports);
            for (int style = 0; style < 3; ++style) CHECK(one.polygons[style] == all[0].polygons[style]);
            CHECK(one.euler == all[0].euler && one.vertex == all[0].vertex && one.volume == all[0].volume);
            CHECK(one.own == all[0].own);
        }
    }
    return check_result();
}
