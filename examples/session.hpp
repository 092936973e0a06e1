// A run of an example program: a context with its progress display, one counted run of the job and the timed ones after it.
#ifndef LAPIDARY_EXAMPLES_SESSION_HPP
#define LAPIDARY_EXAMPLES_SESSION_HPP

#include "arguments.hpp"
#include "program.hpp"
#include "reader.hpp"
#include "report.hpp"

#include <lapidary.h>

#include <cstdint>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

namespace examples {

// A context and the display that its calls draw to. It stays where it is: the context knows its address.
class Session {
public:
    explicit Session(long threads)
    {
        lap_context *made = nullptr;
        must(nullptr, lap_context_new(&made));
        context_.reset(made);
        must(made, lap_context_set_threads(made, static_cast<std::int32_t>(threads)));
        progress_.terminal = isatty(STDERR_FILENO) != 0;
    }
    Session(const Session &) = delete;
    Session &operator=(const Session &) = delete;

    lap_context *context() const { return context_.get(); }

    // The mesh of the options, reversed if they say so or if it faces inward; validated if they say so.
    Mesh mesh(const OneMesh &options)
    {
        Mesh input = read_mesh(options.mesh);
        if (options.flip) reverse(input);
        else if (reverse_if_inward(context(), input))
            std::cerr << options.mesh << " faces inward: all its triangles are reversed\n";
        if (options.check) {
            show(true);
            start_progress(progress_, "validate");
            must(context(), lap_mesh_validate(context(), input.vertex_count(), input.coordinates.data(), input.triangle_count(),
                                              input.triangles.data(), nullptr, nullptr));
            end_progress(progress_);
        }
        return input;
    }

    // `make(progress)` makes a result with its `times`. The first run counts decisions and shows its progress, and `counted` sees it;
    // the timed ones that follow do neither (`progress` is null). Returns the last result, with the times of the fastest.
    template <typename Make, typename Counted>
    auto fastest(long repeat, Make make, Counted counted)
    {
        show(true);
        must(context(), lap_context_counters_enable(context(), 1));
        auto best = make(&progress_);
        counted(best);
        must(context(), lap_context_counters_enable(context(), 0));
        show(false);
        for (long i = 0; i < repeat; ++i) {
            Times before = std::move(best.times);
            best = {}; // one result at a time: the peak of memory is that of one run
            best = make(nullptr);
            if (i > 0 && before.total < best.times.total) best.times = std::move(before);
        }
        return best;
    }

private:
    void show(bool on) { must(context(), lap_context_set_progress(context(), on ? show_progress : nullptr, &progress_)); }

    Progress progress_;
    Handle<lap_context> context_;
};

// Appends the stages of a handle, as its two functions tell them.
template <typename T>
void add_stages(Times &times, lap_context *context, const T *of, std::int32_t (*stage_count)(const T *, std::int32_t *),
                std::int32_t (*stage)(const T *, std::int32_t, const char **, double *))
{
    std::int32_t count = 0;
    must(context, stage_count(of, &count));
    for (std::int32_t i = 0; i < count; ++i) {
        const char *name = nullptr;
        double seconds = 0;
        must(context, stage(of, i, &name, &seconds));
        times.stages.emplace_back(name, seconds);
    }
}

// What every report says of its runs.
template <typename Report, typename Run>
void fill_run(Report &report, const Common &options, const Run &best)
{
    report.threads = options.threads;
    report.repeat = options.repeat;
    report.times = best.times;
    report.peak_bytes = peak_bytes();
}

} // namespace examples

#endif
