/*
 * Lapidary for C++17: thin RAII over lapidary.h, which is the manual. Handles free themselves, statuses become exceptions,
 * arrays become views. Nothing is copied: a view is valid as long as the handle that it came from (strings are copied).
 *
 *   lapidary::context context;
 *   lapidary::mesh mesh(context, xyz, indices);
 *   lapidary::cut cut(context, mesh, planes);
 *   for (double volume : cut.complex().cell_moments().volumes) ...
 */
#ifndef LAPIDARY_HPP
#define LAPIDARY_HPP

#include "lapidary.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lapidary {

/* A borrowed array. */
template <class T>
struct view {
    const T *data = nullptr;
    std::int64_t count = 0;

    const T *begin() const { return data; }
    const T *end() const { return count == 0 ? data : data + count; }
    std::int64_t size() const { return count; }
    bool empty() const { return count == 0; }
    const T &operator[](std::int64_t i) const { return data[i]; }
};

/* A borrowed array of groups of N numbers. */
template <class T, int N>
struct groups {
    const T *data = nullptr;
    std::int64_t count = 0;

    std::int64_t size() const { return count; }
    const T *operator[](std::int64_t i) const { return data + N * i; }
    view<T> flat() const { return {data, N * count}; }
};

/* Borrowed rows of varying length: row i is items[offsets[i]] up to, not including, items[offsets[i + 1]]. */
template <class T>
struct rows {
    const std::int32_t *offsets = nullptr;
    const T *items = nullptr;
    std::int64_t count = 0;

    std::int64_t size() const { return count; }
    view<T> operator[](std::int64_t i) const
    {
        return {items == nullptr ? nullptr : items + offsets[i], offsets[i + 1] - offsets[i]};
    }
};

/* What is wrong with an input element: LAP_DEFECT_*, and the elements as it says (-1 where unused). */
struct defect {
    std::int32_t kind;
    std::array<std::int64_t, 3> ids;
};

inline std::string status_name(std::int32_t status)
{
    const char *name = "";
    lap_status_name(status, &name);
    return name;
}

inline std::string defect_name(std::int32_t kind)
{
    const char *name = "";
    lap_defect_name(kind, &name);
    return name;
}

inline std::string version()
{
    const char *text = "";
    lap_version(nullptr, nullptr, nullptr, &text);
    return text;
}

/* A status that is not LAP_OK, with its message and all defects. */
class error : public std::runtime_error {
public:
    error(std::int32_t status, const std::string &message, std::vector<defect> defects = {})
        : std::runtime_error(status_name(status) + (message.empty() ? "" : ": " + message)), status_(status),
          defects_(std::move(defects))
    {
    }
    std::int32_t status() const { return status_; }
    const std::vector<defect> &defects() const { return defects_; }

private:
    std::int32_t status_;
    std::vector<defect> defects_;
};

/* For calls without a context. */
inline void check(std::int32_t status)
{
    if (status != LAP_OK) throw error(status, "");
}

/* Threads, callbacks, the last error, predicate counters. One thread uses a context at a time. */
class context {
public:
    /* Return false to cancel. */
    using progress = std::function<bool(const char *stage, double fraction)>;
    using log = std::function<void(std::int32_t level, const char *message)>;

    struct counter {
        std::string name;
        std::int64_t value;
    };

    explicit context(std::int32_t threads = 1)
    {
        lap_context *made = nullptr;
        check(lap_context_new(&made));
        handle_.reset(made);
        set_threads(threads);
    }

    void set_threads(std::int32_t threads) { run(lap_context_set_threads(get(), threads)); }
    std::int32_t threads() const
    {
        std::int32_t threads = 0;
        check(lap_context_threads(get(), &threads));
        return threads;
    }

    /* An exception that a callback throws cancels the call (a log callback's: is kept until then) and leaves it. */
    void set_progress(progress callback)
    {
        calls_->on_progress = std::move(callback);
        set_callbacks();
    }
    void set_log(log callback)
    {
        calls_->on_log = std::move(callback);
        set_callbacks();
    }

    void enable_counters(bool on = true) { check(lap_context_counters_enable(get(), on ? 1 : 0)); }
    void reset_counters() { check(lap_context_counters_reset(get())); }
    std::vector<counter> counters() const
    {
        std::int32_t count = 0;
        check(lap_context_counters_count(get(), &count));
        std::vector<counter> all;
        for (std::int32_t i = 0; i < count; ++i) {
            const char *name = "";
            std::int64_t value = 0;
            check(lap_context_counter(get(), i, &name, &value));
            all.push_back({name, value});
        }
        return all;
    }

    /* Throws what the context says about the call that ended with this status. */
    void run(std::int32_t status) const
    {
        if (std::exception_ptr thrown = std::exchange(calls_->thrown, nullptr)) std::rethrow_exception(thrown);
        if (status == LAP_OK) return;
        const char *message = "";
        std::int64_t count = 0;
        const std::int32_t *kinds = nullptr;
        const std::int64_t *ids = nullptr;
        std::vector<defect> defects;
        if (status != LAP_ERR_BUSY) {
            lap_context_last_error(get(), nullptr, &message);
            lap_context_last_defects(get(), &count, &kinds, &ids);
        }
        for (std::int64_t i = 0; i < count; ++i) {
            defects.push_back({kinds[i], {ids[3 * i], ids[3 * i + 1], ids[3 * i + 2]}});
        }
        throw error(status, message, std::move(defects));
    }

    lap_context *get() const { return handle_.get(); }

private:
    struct free_it {
        void operator()(lap_context *handle) const { lap_context_free(handle); }
    };
    /* At an address of its own, so that a context can be moved. */
    struct calls {
        progress on_progress;
        log on_log;
        std::exception_ptr thrown;
    };

    void set_callbacks()
    {
        run(lap_context_set_progress(get(), calls_->on_progress || calls_->on_log ? &call_progress : nullptr, calls_.get()));
        run(lap_context_set_log(get(), calls_->on_log ? &call_log : nullptr, calls_.get()));
    }
    static std::int32_t call_progress(void *user, const char *stage, double fraction)
    {
        calls *to = static_cast<calls *>(user);
        if (to->thrown) return 1;
        try {
            return !to->on_progress || to->on_progress(stage, fraction) ? 0 : 1;
        } catch (...) {
            to->thrown = std::current_exception();
            return 1;
        }
    }
    static void call_log(void *user, std::int32_t level, const char *message)
    {
        calls *to = static_cast<calls *>(user);
        if (to->thrown) return;
        try {
            to->on_log(level, message);
        } catch (...) {
            to->thrown = std::current_exception();
        }
    }

    std::unique_ptr<calls> calls_ = std::make_unique<calls>();
    std::unique_ptr<lap_context, free_it> handle_;
};

inline lap_mesh_options mesh_options()
{
    lap_mesh_options options;
    check(lap_mesh_options_init(&options, static_cast<std::int32_t>(sizeof options)));
    return options;
}

inline lap_cut_options cut_options()
{
    lap_cut_options options;
    check(lap_cut_options_init(&options, static_cast<std::int32_t>(sizeof options)));
    return options;
}

/* A closed triangle mesh that bounds a solid. */
class mesh {
public:
    struct counts_t {
        std::int64_t vertices, triangles, edges, components, shells;
    };
    struct vertices_t {
        groups<double, 3> xyz;
        view<std::int32_t> sources;
    };
    struct triangles_t {
        groups<std::int32_t, 3> vertices;
        view<std::int32_t> tags;
    };

    /* xyz: three per vertex; indices: three per triangle; tags: one per triangle, or none. */
    mesh(context &with, const std::vector<double> &xyz, const std::vector<std::int32_t> &indices,
         const std::vector<std::int32_t> &tags = {}, const lap_mesh_options &options = mesh_options())
    {
        if (xyz.size() % 3 != 0) throw error(LAP_ERR_BAD_ARGUMENT, "xyz does not hold three numbers per vertex");
        if (indices.size() % 3 != 0) throw error(LAP_ERR_BAD_ARGUMENT, "indices does not hold three numbers per triangle");
        if (!tags.empty() && tags.size() != indices.size() / 3) {
            throw error(LAP_ERR_BAD_ARGUMENT, "tags does not hold one number per triangle");
        }
        lap_mesh *made = nullptr;
        const std::int32_t status = lap_mesh_new(
            with.get(), static_cast<std::int64_t>(xyz.size() / 3), xyz.data(), static_cast<std::int64_t>(indices.size() / 3),
            indices.data(), tags.empty() ? nullptr : tags.data(), &options, &made);
        handle_.reset(made);
        with.run(status);
    }

    /* Every check there is, the one for self-intersections included: all defects, none of a mesh that is valid. */
    static std::vector<defect> validate(context &with, const std::vector<double> &xyz,
                                        const std::vector<std::int32_t> &indices,
                                        const lap_mesh_options &options = mesh_options())
    {
        if (xyz.size() % 3 != 0) throw error(LAP_ERR_BAD_ARGUMENT, "xyz does not hold three numbers per vertex");
        if (indices.size() % 3 != 0) throw error(LAP_ERR_BAD_ARGUMENT, "indices does not hold three numbers per triangle");
        try {
            with.run(lap_mesh_validate(with.get(), static_cast<std::int64_t>(xyz.size() / 3), xyz.data(),
                                       static_cast<std::int64_t>(indices.size() / 3), indices.data(), &options, nullptr));
        } catch (const error &e) {
            if (e.status() != LAP_ERR_BAD_MESH) throw;
            return e.defects();
        }
        return {};
    }

    /* New coordinates on the same connectivity, three per vertex in the order of vertices(). What was borrowed before is
       no longer valid; cuts and grids made before are not touched. After an error the mesh is unchanged. */
    void update_coordinates(context &with, const std::vector<double> &xyz, const lap_mesh_options &options = mesh_options())
    {
        if (xyz.size() % 3 != 0) throw error(LAP_ERR_BAD_ARGUMENT, "xyz does not hold three numbers per vertex");
        with.run(lap_mesh_update_coordinates(with.get(), handle_.get(), static_cast<std::int64_t>(xyz.size() / 3), xyz.data(),
                                             &options));
    }

    counts_t counts() const
    {
        counts_t n{};
        check(lap_mesh_counts(get(), &n.vertices, &n.triangles, &n.edges, &n.components, &n.shells));
        return n;
    }
    vertices_t vertices() const
    {
        vertices_t v;
        check(lap_mesh_vertices(get(), &v.xyz.count, &v.xyz.data, &v.sources.data));
        v.sources.count = v.xyz.count;
        return v;
    }
    triangles_t triangles() const
    {
        triangles_t t;
        check(lap_mesh_triangles(get(), &t.vertices.count, &t.vertices.data, &t.tags.data));
        t.tags.count = t.tags.data == nullptr ? 0 : t.vertices.count;
        return t;
    }
    /* Lowest x, y, z and highest x, y, z. */
    view<double> bounds() const
    {
        view<double> bounds{nullptr, 6};
        check(lap_mesh_bounds(get(), &bounds.data));
        return bounds;
    }
    double volume() const
    {
        double volume = 0;
        check(lap_mesh_volume(get(), &volume));
        return volume;
    }
    std::string exact_volume(context &with) const
    {
        const char *volume = "";
        with.run(lap_mesh_volume_exact(with.get(), get(), &volume));
        return volume;
    }
    std::int64_t euler() const
    {
        std::int64_t euler = 0;
        check(lap_mesh_euler(get(), &euler));
        return euler;
    }
    /* LAP_PLACE_* for each point, three coordinates each. */
    std::vector<std::int32_t> locate(context &with, const std::vector<double> &points) const
    {
        if (points.size() % 3 != 0) throw error(LAP_ERR_BAD_ARGUMENT, "points does not hold three numbers per point");
        const std::int64_t count = static_cast<std::int64_t>(points.size() / 3);
        const std::int32_t *places = nullptr;
        with.run(lap_mesh_locate(with.get(), get(), count, points.data(), &places));
        return {places, places + count};
    }
    /* One id per triangle, for keys of what is made from the mesh afterwards. */
    void set_triangle_ids(context &with, const std::vector<std::int64_t> &ids)
    {
        with.run(lap_mesh_set_triangle_ids(with.get(), handle_.get(), static_cast<std::int64_t>(ids.size()), ids.data()));
    }

    const lap_mesh *get() const { return handle_.get(); }

private:
    struct free_it {
        void operator()(lap_mesh *handle) const { lap_mesh_free(handle); }
    };
    std::unique_ptr<lap_mesh, free_it> handle_;
};

/* Vertices, edges, faces and cells; borrowed from the handle that has it. */
class complex {
public:
    struct counts_t {
        std::int64_t vertices, edges, faces, cells, loops, corners, shells;
    };
    struct origins_t {
        view<std::int32_t> kinds;
        groups<std::int32_t, 3> ids;
    };
    struct faces_t {
        view<std::int32_t> face_loops, loop_corners, corner_vertices, corner_edges;
    };
    struct supports_t {
        view<std::int32_t> kinds, ids, planes, tags;
    };
    struct cells_t {
        view<std::int32_t> cell_shells, shell_faces, half_faces;

        /* The half-faces of all the shells of a cell. */
        view<std::int32_t> of(std::int64_t cell) const
        {
            const std::int32_t from = shell_faces[cell_shells[cell]];
            return {half_faces.data + from, shell_faces[cell_shells[cell + 1]] - from};
        }
    };
    struct cell_moments_t {
        view<double> volumes;
        groups<double, 3> centroids;
        view<std::uint8_t> flags;
    };
    struct face_moments_t {
        groups<double, 3> area_vectors, centroids;
        view<std::uint8_t> flags;
    };
    struct polygons_t {
        rows<std::int32_t> vertices;
        view<std::int32_t> faces;
    };
    struct adjacency_t {
        view<std::int32_t> mates, faces;

        /* The half-face across the edge of a half-corner (2 * corner + side), -1 if none. */
        std::int32_t across(std::int64_t half_corner) const
        {
            const std::int32_t mate = mates[half_corner];
            return mate < 0 ? -1 : 2 * faces[mate / 2] + mate % 2;
        }
    };
    struct euler_t {
        std::int64_t output, input;
    };

    explicit complex(const lap_complex *borrowed) : handle_(borrowed) {}

    counts_t counts() const
    {
        counts_t n{};
        check(lap_complex_counts(get(), &n.vertices, &n.edges, &n.faces, &n.cells, &n.loops, &n.corners, &n.shells));
        return n;
    }
    groups<double, 3> vertices() const
    {
        groups<double, 3> v;
        check(lap_complex_vertices(get(), &v.count, &v.data));
        return v;
    }
    origins_t vertex_origins() const
    {
        origins_t o;
        check(lap_complex_vertex_origins(get(), &o.kinds.count, &o.kinds.data, &o.ids.data));
        o.ids.count = o.kinds.count;
        return o;
    }
    rows<std::int32_t> vertex_planes() const
    {
        rows<std::int32_t> r;
        check(lap_complex_vertex_planes(get(), &r.count, &r.offsets, &r.items));
        return r;
    }
    groups<std::int32_t, 2> edges() const
    {
        groups<std::int32_t, 2> e;
        check(lap_complex_edges(get(), &e.count, &e.data));
        return e;
    }
    faces_t faces() const
    {
        const counts_t n = counts();
        faces_t f;
        check(lap_complex_faces(get(), nullptr, &f.face_loops.data, &f.loop_corners.data, &f.corner_vertices.data,
                                &f.corner_edges.data));
        f.face_loops.count = n.faces + 1;
        f.loop_corners.count = n.loops + 1;
        f.corner_vertices.count = f.corner_edges.count = n.corners;
        return f;
    }
    supports_t face_supports() const
    {
        supports_t s;
        check(lap_complex_face_supports(get(), &s.kinds.count, &s.kinds.data, &s.ids.data, &s.planes.data, &s.tags.data));
        s.ids.count = s.planes.count = s.tags.count = s.kinds.count;
        return s;
    }
    /* Owner and neighbour of each face. */
    groups<std::int32_t, 2> face_cells() const
    {
        groups<std::int32_t, 2> c;
        check(lap_complex_face_cells(get(), &c.count, &c.data));
        return c;
    }
    cells_t cells() const
    {
        const counts_t n = counts();
        cells_t c;
        check(lap_complex_cells(get(), nullptr, &c.cell_shells.data, &c.shell_faces.data, &c.half_faces.data));
        c.cell_shells.count = n.cells + 1;
        c.shell_faces.count = n.shells + 1;
        c.half_faces.count = c.shell_faces[n.shells];
        return c;
    }
    view<std::int32_t> cell_components() const
    {
        view<std::int32_t> c;
        check(lap_complex_cell_components(get(), &c.count, &c.data));
        return c;
    }
    /* 1 or -1. */
    std::int32_t cell_side(std::int32_t cell, std::int32_t plane) const
    {
        std::int32_t side = 0;
        check(lap_complex_cell_side(get(), cell, plane, &side));
        return side;
    }

    cell_moments_t cell_moments() const
    {
        cell_moments_t m;
        check(lap_complex_cell_moments(get(), &m.volumes.count, &m.volumes.data, &m.centroids.data, &m.flags.data));
        m.centroids.count = m.flags.count = m.volumes.count;
        return m;
    }
    face_moments_t face_moments() const
    {
        face_moments_t m;
        check(lap_complex_face_moments(get(), &m.flags.count, &m.area_vectors.data, &m.centroids.data, &m.flags.data));
        m.area_vectors.count = m.centroids.count = m.flags.count;
        return m;
    }
    /* style: LAP_FACES_* */
    polygons_t polygons(std::int32_t style) const
    {
        polygons_t p;
        check(lap_complex_polygons(get(), style, &p.vertices.count, &p.vertices.offsets, &p.vertices.items, &p.faces.data));
        p.faces.count = p.vertices.count;
        return p;
    }
    adjacency_t adjacency() const
    {
        adjacency_t a;
        check(lap_complex_adjacency(get(), &a.faces.count, &a.mates.data, &a.faces.data));
        a.mates.count = 2 * a.faces.count;
        return a;
    }
    euler_t euler() const
    {
        euler_t e{};
        check(lap_complex_euler(get(), &e.output, &e.input));
        return e;
    }
    groups<std::int64_t, 2> vertex_keys() const
    {
        groups<std::int64_t, 2> k;
        check(lap_complex_vertex_keys(get(), &k.count, &k.data));
        return k;
    }
    groups<std::int64_t, 2> face_keys() const
    {
        groups<std::int64_t, 2> k;
        check(lap_complex_face_keys(get(), &k.count, &k.data));
        return k;
    }
    void check_consistency(context &with) const { with.run(lap_complex_check(with.get(), get())); }
    std::array<std::string, 3> exact_vertex(context &with, std::int32_t vertex) const
    {
        const char *x = "", *y = "", *z = "";
        with.run(lap_complex_vertex_exact(with.get(), get(), vertex, &x, &y, &z));
        return {x, y, z};
    }
    std::string exact_cell_volume(context &with, std::int32_t cell) const
    {
        const char *volume = "";
        with.run(lap_complex_cell_volume_exact(with.get(), get(), cell, &volume));
        return volume;
    }

    const lap_complex *get() const { return handle_; }

private:
    const lap_complex *handle_;
};

/* The cells into which planes divide a solid. */
class cut {
public:
    struct stage {
        std::string name;
        double seconds;
    };
    struct statistic {
        std::string name;
        std::int64_t value;
    };

    /* planes: four per plane, a, b, c, d for a x + b y + c z + d = 0. */
    cut(context &with, const mesh &solid, const std::vector<double> &planes,
        const lap_cut_options &options = cut_options())
    {
        if (planes.size() % 4 != 0) throw error(LAP_ERR_BAD_ARGUMENT, "planes does not hold four numbers per plane");
        lap_cut *made = nullptr;
        const std::int32_t status = lap_cut_new(with.get(), solid.get(), static_cast<std::int64_t>(planes.size() / 4),
                                                planes.data(), &options, &made);
        handle_.reset(made);
        with.run(status);
    }

    /* Borrowed from this cut. */
    class complex complex() const
    {
        const lap_complex *borrowed = nullptr;
        check(lap_cut_complex(get(), &borrowed));
        return lapidary::complex(borrowed);
    }
    view<std::int32_t> plane_map() const
    {
        view<std::int32_t> m;
        check(lap_cut_plane_map(get(), &m.count, &m.data));
        return m;
    }
    /* One id per plane as given, for keys: call it before they are asked for. */
    void set_plane_ids(context &with, const std::vector<std::int64_t> &ids)
    {
        with.run(lap_cut_set_plane_ids(with.get(), handle_.get(), static_cast<std::int64_t>(ids.size()), ids.data()));
    }
    std::vector<stage> stages() const
    {
        std::int32_t count = 0;
        check(lap_cut_stage_count(get(), &count));
        std::vector<stage> all;
        for (std::int32_t i = 0; i < count; ++i) {
            const char *name = "";
            double seconds = 0;
            check(lap_cut_stage(get(), i, &name, &seconds));
            all.push_back({name, seconds});
        }
        return all;
    }
    std::vector<statistic> statistics() const
    {
        std::int32_t count = 0;
        check(lap_cut_statistic_count(get(), &count));
        std::vector<statistic> all;
        for (std::int32_t i = 0; i < count; ++i) {
            const char *name = "";
            std::int64_t value = 0;
            check(lap_cut_statistic(get(), i, &name, &value));
            all.push_back({name, value});
        }
        return all;
    }

    const lap_cut *get() const { return handle_.get(); }

private:
    struct free_it {
        void operator()(lap_cut *handle) const { lap_cut_free(handle); }
    };
    std::unique_ptr<lap_cut, free_it> handle_;
};

inline lap_certify_options certify_options()
{
    lap_certify_options options;
    check(lap_certify_options_init(&options, static_cast<std::int32_t>(sizeof options)));
    return options;
}

/* A complex as triangles over doubles that were checked exactly; report().certified tells whether nothing remains. */
class certified {
public:
    struct counts_t {
        std::int64_t vertices, triangles, faces, cells;
    };
    struct triangles_t {
        groups<std::int32_t, 3> vertices;
        groups<std::int32_t, 2> cells;
        /* face_triangles[f] up to face_triangles[f + 1] */
        view<std::int32_t> face_triangles;
    };
    struct maps_t {
        view<std::int32_t> vertices, faces, cells;
    };
    struct open_t {
        groups<std::int32_t, 2> faces;
        view<std::int32_t> cells;
    };

    certified(context &with, const complex &of, const std::vector<std::int32_t> &fixed_planes = {},
              const std::vector<std::int32_t> &fixed_vertices = {}, const lap_certify_options &options = certify_options())
    {
        lap_certified *made = nullptr;
        const std::int32_t status = lap_certified_new(
            with.get(), of.get(), static_cast<std::int64_t>(fixed_planes.size()), fixed_planes.data(),
            static_cast<std::int64_t>(fixed_vertices.size()), fixed_vertices.data(), &options, &made);
        handle_.reset(made);
        with.run(status);
    }

    lap_certify_report report() const
    {
        lap_certify_report report;
        check(lap_certified_report(get(), &report, static_cast<std::int32_t>(sizeof report)));
        return report;
    }
    counts_t counts() const
    {
        counts_t n{};
        check(lap_certified_counts(get(), &n.vertices, &n.triangles, &n.faces, &n.cells));
        return n;
    }
    groups<double, 3> vertices() const
    {
        groups<double, 3> v;
        check(lap_certified_vertices(get(), &v.count, &v.data));
        return v;
    }
    triangles_t triangles() const
    {
        triangles_t t;
        check(lap_certified_triangles(get(), &t.vertices.count, &t.vertices.data, &t.cells.data, &t.face_triangles.count,
                                      &t.face_triangles.data));
        t.cells.count = t.vertices.count;
        ++t.face_triangles.count;
        return t;
    }
    /* From the complex's numbers to those here; -1 for what is gone. */
    maps_t maps() const
    {
        maps_t m;
        check(lap_certified_maps(get(), &m.vertices.count, &m.vertices.data, &m.faces.count, &m.faces.data, &m.cells.count,
                                 &m.cells.data));
        return m;
    }
    /* In the complex's numbers. */
    open_t open() const
    {
        open_t o;
        check(lap_certified_open(get(), &o.faces.count, &o.faces.data, &o.cells.count, &o.cells.data));
        return o;
    }

    const lap_certified *get() const { return handle_.get(); }

private:
    struct free_it {
        void operator()(lap_certified *handle) const { lap_certified_free(handle); }
    };
    std::unique_ptr<lap_certified, free_it> handle_;
};

inline lap_grid_options grid_options()
{
    lap_grid_options options;
    check(lap_grid_options_init(&options, static_cast<std::int32_t>(sizeof options)));
    return options;
}

/* A block of a rectilinear grid, cut by a surface. */
class grid {
public:
    struct block_t {
        view<std::int64_t> boxes, first, total;
        view<double> x, y, z;
    };
    struct counts_t {
        std::int64_t empty, full, cut, cells, faces, walls, vertices;
    };
    struct cut_boxes_t {
        view<std::int32_t> boxes, box_cells;
    };
    struct box_t {
        std::int32_t flag, first, count;
    };
    struct vertices_t {
        groups<double, 3> xyz;
        view<std::uint8_t> on_planes;
    };
    struct faces_t {
        view<std::int32_t> face_loops, loop_corners, corner_vertices;
    };
    struct walls_t {
        view<std::int64_t> triangles;
        view<std::int32_t> tags, cells;
    };
    struct plane_faces_t {
        std::int64_t first;
        view<std::int32_t> axes, nodes;
        groups<std::int32_t, 2> cells;
    };
    struct cells_t {
        view<std::int32_t> boxes, cell_shells, shell_faces, half_faces;

        /* The half-faces of all the shells of a cell. */
        view<std::int32_t> of(std::int64_t cell) const
        {
            const std::int32_t from = shell_faces[cell_shells[cell]];
            return {half_faces.data + from, shell_faces[cell_shells[cell + 1]] - from};
        }
    };
    struct cell_moments_t {
        view<double> volumes, fractions;
        groups<double, 3> centroids;
        view<std::uint8_t> flags;
    };
    struct second_moments_t {
        groups<double, 3> first;
        groups<double, 6> second;
    };
    struct walls_moments_t {
        groups<double, 3> area_vectors, centroids;
    };
    struct plane_face_moments_t {
        view<double> areas, fractions;
        groups<double, 3> centroids;
        view<std::uint8_t> flags;
    };
    struct cell_tags_t {
        rows<std::int32_t> tags;
        /* By position in tags.items. */
        groups<double, 3> area_vectors, centroids;
    };
    struct full_faces_t {
        std::vector<std::int32_t> nodes;
        std::vector<std::array<std::int32_t, 2>> boxes;
    };
    struct full_links_t {
        view<std::int32_t> cells, faces, boxes;
    };
    struct regions_t {
        std::int64_t count;
        view<std::int32_t> cells;
    };
    struct region_runs_t {
        view<std::int32_t> row_runs;
        groups<std::int32_t, 2> boxes;
        view<std::int32_t> regions;
    };
    struct mask_t {
        std::vector<std::uint8_t> cells, boxes;
    };
    struct aggregates_t {
        std::vector<std::int32_t> cells, boxes, small;
    };
    struct stage {
        std::string name;
        double seconds;
    };

    /* x, y, z: the coordinates of the whole grid's nodes; options: block, side of the fluid. */
    grid(context &with, const mesh &solid, const std::vector<double> &x, const std::vector<double> &y,
         const std::vector<double> &z, const lap_grid_options &options = grid_options())
    {
        lap_grid *made = nullptr;
        const std::int32_t status = lap_grid_new(with.get(), solid.get(), size(x), x.data(), size(y), y.data(), size(z),
                                                 z.data(), &options, &made);
        handle_.reset(made);
        with.run(status);
    }

    /* From the triangles that meet the block alone: lap_grid_new_patch. tags and ids: one per triangle, or none. */
    grid(context &with, const std::vector<double> &xyz, const std::vector<std::int32_t> &indices,
         const std::vector<std::int32_t> &tags, const std::vector<std::int64_t> &ids, const std::vector<double> &x,
         const std::vector<double> &y, const std::vector<double> &z, const lap_grid_options &options)
    {
        if (xyz.size() % 3 != 0) throw error(LAP_ERR_BAD_ARGUMENT, "xyz does not hold three numbers per vertex");
        if (indices.size() % 3 != 0) throw error(LAP_ERR_BAD_ARGUMENT, "indices does not hold three numbers per triangle");
        const std::size_t triangles = indices.size() / 3;
        if ((!tags.empty() && tags.size() != triangles) || (!ids.empty() && ids.size() != triangles)) {
            throw error(LAP_ERR_BAD_ARGUMENT, "tags and ids do not hold one number per triangle");
        }
        lap_grid *made = nullptr;
        const std::int32_t status = lap_grid_new_patch(
            with.get(), size(xyz) / 3, xyz.data(), static_cast<std::int64_t>(triangles), indices.data(),
            tags.empty() ? nullptr : tags.data(), ids.empty() ? nullptr : ids.data(), size(x), x.data(), size(y), y.data(),
            size(z), z.data(), &options, &made);
        handle_.reset(made);
        with.run(status);
    }

    block_t block() const
    {
        block_t b{{nullptr, 3}, {nullptr, 3}, {nullptr, 3}, {}, {}, {}};
        check(lap_grid_block(get(), &b.boxes.data, &b.first.data, &b.total.data, &b.x.data, &b.y.data, &b.z.data));
        b.x.count = b.boxes[0] + 1;
        b.y.count = b.boxes[1] + 1;
        b.z.count = b.boxes[2] + 1;
        return b;
    }
    counts_t counts() const
    {
        counts_t n{};
        check(lap_grid_counts(get(), &n.empty, &n.full, &n.cut, &n.cells, &n.faces, &n.walls, &n.vertices));
        return n;
    }
    /* LAP_BOX_* per box. */
    view<std::uint8_t> flags() const
    {
        view<std::uint8_t> f;
        check(lap_grid_flags(get(), &f.count, &f.data));
        return f;
    }
    cut_boxes_t cut_boxes() const
    {
        cut_boxes_t b;
        check(lap_grid_cut_boxes(get(), &b.boxes.count, &b.boxes.data, &b.box_cells.data));
        b.box_cells.count = b.boxes.count + 1;
        return b;
    }
    /* offsets[b] up to offsets[b + 1] are the cells of box b. */
    view<std::int32_t> box_cells() const
    {
        view<std::int32_t> offsets;
        check(lap_grid_box_cells(get(), &offsets.count, &offsets.data));
        ++offsets.count;
        return offsets;
    }
    box_t box(std::int32_t i, std::int32_t j, std::int32_t k) const
    {
        box_t b{};
        check(lap_grid_box(get(), i, j, k, &b.flag, &b.first, &b.count));
        return b;
    }

    vertices_t vertices() const
    {
        vertices_t v;
        check(lap_grid_vertices(get(), &v.xyz.count, &v.xyz.data, &v.on_planes.data));
        v.on_planes.count = v.xyz.count;
        return v;
    }
    faces_t faces() const
    {
        faces_t f;
        std::int64_t count = 0;
        check(lap_grid_faces(get(), &count, &f.face_loops.data, &f.loop_corners.data, &f.corner_vertices.data));
        f.face_loops.count = count + 1;
        f.loop_corners.count = f.face_loops[count] + 1;
        f.corner_vertices.count = f.loop_corners[f.face_loops[count]];
        return f;
    }
    walls_t walls() const
    {
        walls_t w;
        check(lap_grid_walls(get(), &w.cells.count, &w.triangles.data, &w.tags.data, &w.cells.data));
        w.triangles.count = w.cells.count;
        w.tags.count = w.tags.data == nullptr ? 0 : w.cells.count;
        return w;
    }
    plane_faces_t plane_faces() const
    {
        plane_faces_t f{0, {nullptr, 4}, {}, {}};
        check(lap_grid_plane_faces(get(), &f.first, &f.nodes.count, &f.axes.data, &f.nodes.data, &f.cells.data));
        f.cells.count = f.nodes.count;
        return f;
    }
    cells_t cells() const
    {
        cells_t c;
        check(lap_grid_cells(get(), &c.boxes.count, &c.boxes.data, &c.cell_shells.data, &c.shell_faces.data,
                             &c.half_faces.data));
        c.cell_shells.count = c.boxes.count + 1;
        c.shell_faces.count = c.cell_shells[c.boxes.count] + 1;
        c.half_faces.count = c.shell_faces[c.cell_shells[c.boxes.count]];
        return c;
    }
    /* The cut cells as an ordinary complex, borrowed from this grid. */
    class complex complex() const
    {
        const lap_complex *borrowed = nullptr;
        check(lap_grid_complex(get(), &borrowed));
        return lapidary::complex(borrowed);
    }
    groups<std::int64_t, 2> vertex_keys() const
    {
        groups<std::int64_t, 2> k;
        check(lap_grid_vertex_keys(get(), &k.count, &k.data));
        return k;
    }
    groups<std::int64_t, 2> face_keys() const
    {
        groups<std::int64_t, 2> k;
        check(lap_grid_face_keys(get(), &k.count, &k.data));
        return k;
    }

    // Flags look at boundaries, too, and cost what cell_boundaries() does; without them their view is empty.
    cell_moments_t cell_moments(bool with_flags = true) const
    {
        cell_moments_t m;
        check(lap_grid_cell_moments(get(), &m.volumes.count, &m.volumes.data, &m.fractions.data, &m.centroids.data,
                                    with_flags ? &m.flags.data : nullptr));
        m.fractions.count = m.centroids.count = m.volumes.count;
        m.flags.count = with_flags ? m.volumes.count : 0;
        return m;
    }
    second_moments_t cell_second_moments() const
    {
        second_moments_t m;
        check(lap_grid_cell_second_moments(get(), &m.first.count, &m.first.data, &m.second.data));
        m.second.count = m.first.count;
        return m;
    }
    walls_moments_t cell_boundaries() const
    {
        walls_moments_t m;
        check(lap_grid_cell_boundaries(get(), &m.centroids.count, &m.area_vectors.data, &m.centroids.data));
        m.area_vectors.count = m.centroids.count;
        return m;
    }
    plane_face_moments_t plane_face_moments() const
    {
        plane_face_moments_t m;
        check(lap_grid_plane_face_moments(get(), &m.areas.count, &m.areas.data, &m.fractions.data, &m.centroids.data,
                                          &m.flags.data));
        m.fractions.count = m.centroids.count = m.flags.count = m.areas.count;
        return m;
    }
    walls_moments_t wall_moments() const
    {
        walls_moments_t m;
        check(lap_grid_wall_moments(get(), &m.centroids.count, &m.area_vectors.data, &m.centroids.data));
        m.area_vectors.count = m.centroids.count;
        return m;
    }
    rows<std::int32_t> cell_walls() const
    {
        rows<std::int32_t> r;
        check(lap_grid_cell_walls(get(), &r.count, &r.offsets, &r.items));
        return r;
    }
    cell_tags_t cell_tags() const
    {
        cell_tags_t t;
        check(lap_grid_cell_tags(get(), &t.tags.count, &t.tags.offsets, &t.tags.items, &t.area_vectors.data,
                                 &t.centroids.data));
        t.area_vectors.count = t.centroids.count = t.tags.offsets[t.tags.count];
        return t;
    }

    full_links_t full_links() const
    {
        full_links_t l;
        check(lap_grid_full_links(get(), &l.cells.count, &l.cells.data, &l.faces.data, &l.boxes.data));
        l.faces.count = l.boxes.count = l.cells.count;
        return l;
    }
    /* Copied, since the context keeps them for one call only. */
    full_faces_t full_faces(context &with, std::int32_t axis, std::int32_t node) const
    {
        std::int64_t count = 0;
        const std::int32_t *nodes = nullptr, *boxes = nullptr;
        with.run(lap_grid_full_faces(with.get(), get(), axis, node, &count, &nodes, &boxes));
        full_faces_t f;
        f.nodes.assign(nodes, nodes + count);
        for (std::int64_t i = 0; i < count; ++i) f.boxes.push_back({boxes[2 * i], boxes[2 * i + 1]});
        return f;
    }
    regions_t regions() const
    {
        regions_t r{};
        check(lap_grid_regions(get(), &r.count, &r.cells.count, &r.cells.data));
        return r;
    }
    region_runs_t region_runs() const
    {
        region_runs_t r;
        std::int64_t count = 0;
        check(lap_grid_region_runs(get(), &count, &r.row_runs.data, &r.boxes.data, &r.regions.data));
        r.row_runs.count = count + 1;
        r.boxes.count = r.regions.count = r.row_runs[count];
        return r;
    }
    /* Of a full box; -1 for others. */
    std::int32_t box_region(std::int32_t i, std::int32_t j, std::int32_t k) const
    {
        std::int32_t region = -1;
        check(lap_grid_box_region(get(), i, j, k, &region));
        return region;
    }
    /* A region, or LAP_REGION_*. */
    std::int32_t region_at(context &with, double x, double y, double z) const
    {
        std::int32_t region = -1;
        with.run(lap_grid_region_at(with.get(), get(), x, y, z, &region));
        return region;
    }
    mask_t region_mask(context &with, std::int32_t region) const
    {
        std::int64_t n_cells = 0, n_boxes = 0;
        const std::uint8_t *cells = nullptr, *boxes = nullptr;
        with.run(lap_grid_region_mask(with.get(), get(), region, &n_cells, &cells, &n_boxes, &boxes));
        return {{cells, cells + n_cells}, {boxes, boxes + n_boxes}};
    }
    /* Marks: one per face in a grid plane, and one per cut cell, or none. */
    aggregates_t aggregate(context &with, double minimum, const std::vector<std::uint8_t> &closed_faces = {},
                           const std::vector<std::uint8_t> &closed_cells = {}) const
    {
        const counts_t n = counts();
        if (!closed_faces.empty() && size(closed_faces) != n.faces - n.walls) {
            throw error(LAP_ERR_BAD_ARGUMENT, "closed_faces does not hold one number per face in a grid plane");
        }
        if (!closed_cells.empty() && size(closed_cells) != n.cells) {
            throw error(LAP_ERR_BAD_ARGUMENT, "closed_cells does not hold one number per cell");
        }
        std::int64_t count = 0, n_small = 0;
        const std::int32_t *cells = nullptr, *boxes = nullptr, *small = nullptr;
        with.run(lap_grid_aggregate(with.get(), get(), minimum, closed_faces.empty() ? nullptr : closed_faces.data(),
                                    closed_cells.empty() ? nullptr : closed_cells.data(), &count, &cells, &boxes,
                                    &n_small, &small));
        return {{cells, cells + count}, {boxes, boxes + count}, {small, small + n_small}};
    }
    void check_consistency(context &with) const { with.run(lap_grid_check(with.get(), get())); }

    std::vector<stage> stages() const
    {
        std::int32_t count = 0;
        check(lap_grid_stage_count(get(), &count));
        std::vector<stage> all;
        for (std::int32_t i = 0; i < count; ++i) {
            const char *name = "";
            double seconds = 0;
            check(lap_grid_stage(get(), i, &name, &seconds));
            all.push_back({name, seconds});
        }
        return all;
    }

    const lap_grid *get() const { return handle_.get(); }

private:
    template <class T>
    static std::int64_t size(const std::vector<T> &v)
    {
        return static_cast<std::int64_t>(v.size());
    }
    struct free_it {
        void operator()(lap_grid *handle) const { lap_grid_free(handle); }
    };
    std::unique_ptr<lap_grid, free_it> handle_;
};

/* Linear functions, or materials, in single simplices: many in one call, into one handle that is filled again and again. */
class simplex {
public:
    struct counts_t {
        std::int64_t simplices, vertices, edges, faces, cells;
    };
    /* One more than there are simplices. */
    struct offsets_t {
        view<std::int32_t> vertices, edges, faces, cells, planes;
    };
    struct vertices_t {
        view<std::uint8_t> carriers;
        groups<std::int32_t, 4> codes;
    };
    struct faces_t {
        rows<std::int32_t> vertices;
        view<std::int32_t> edges;
    };
    struct supports_t {
        view<std::int32_t> kinds;
        groups<std::int32_t, 2> ids;
        view<std::int32_t> planes;
        groups<std::int32_t, 2> cells;
    };
    struct planes_t {
        rows<std::int32_t> functions;
        view<std::uint8_t> opposite;
    };
    struct materials_t {
        view<std::int32_t> owners;
        rows<std::int32_t> all;
    };

    simplex()
    {
        lap_simplex *made = nullptr;
        check(lap_simplex_new(&made));
        handle_.reset(made);
    }

    /* kind: LAP_SIMPLEX_*; values of n_simplices simplices, as for lap_simplex_compute. What was borrowed before is no longer valid. */
    void compute(context &with, std::int32_t kind, std::int32_t dim, const std::vector<double> &values, std::int64_t n_simplices = 1)
    {
        const std::int64_t each = n_simplices * (dim + 1);
        if (each <= 0 ? !values.empty() : size(values) % each != 0) {
            throw error(LAP_ERR_BAD_ARGUMENT, "values does not hold dim + 1 numbers per function and simplex");
        }
        with.run(lap_simplex_compute(with.get(), handle_.get(), kind, dim, n_simplices, each <= 0 ? 0 : size(values) / each,
                                     values.data()));
    }

    counts_t counts() const
    {
        counts_t n{};
        check(lap_simplex_counts(get(), &n.simplices, &n.vertices, &n.edges, &n.faces, &n.cells));
        return n;
    }
    /* Entries of look-up tables: the corner and the function (with signs changed by bits of flips) for each of the entry's; -1: none. */
    struct tables_t {
        std::int64_t entries_in_all = 0;
        view<std::int32_t> entries;
        groups<std::int32_t, 4> corners;
        groups<std::int32_t, 3> functions;
        view<std::uint8_t> flips;
    };
    tables_t tables() const
    {
        tables_t t;
        check(lap_simplex_tables(get(), &t.entries.count, &t.entries_in_all, &t.entries.data, &t.corners.data, &t.functions.data,
                                 &t.flips.data));
        t.corners.count = t.functions.count = t.flips.count = t.entries.count;
        return t;
    }
    offsets_t offsets() const
    {
        offsets_t o;
        std::int64_t count = 0;
        check(lap_simplex_offsets(get(), &count, &o.vertices.data, &o.edges.data, &o.faces.data, &o.cells.data, &o.planes.data));
        for (view<std::int32_t> *one : {&o.vertices, &o.edges, &o.faces, &o.cells, &o.planes}) one->count = count + 1;
        return o;
    }
    vertices_t vertices() const
    {
        vertices_t v;
        check(lap_simplex_vertices(get(), &v.carriers.count, &v.carriers.data, &v.codes.data));
        v.codes.count = v.carriers.count;
        return v;
    }
    rows<std::int32_t> vertex_functions() const
    {
        rows<std::int32_t> f;
        check(lap_simplex_vertex_functions(get(), &f.count, &f.offsets, &f.items));
        return f;
    }
    groups<std::int32_t, 2> edges() const
    {
        groups<std::int32_t, 2> e;
        check(lap_simplex_edges(get(), &e.count, &e.data));
        return e;
    }
    faces_t faces() const
    {
        faces_t f;
        check(lap_simplex_faces(get(), &f.vertices.count, &f.vertices.offsets, &f.vertices.items, &f.edges.data));
        f.edges.count = f.edges.data == nullptr ? 0 : f.vertices.offsets[f.vertices.count];
        return f;
    }
    supports_t face_supports() const
    {
        supports_t s;
        check(lap_simplex_face_supports(get(), &s.kinds.count, &s.kinds.data, &s.ids.data, &s.planes.data, &s.cells.data));
        s.ids.count = s.planes.count = s.cells.count = s.kinds.count;
        return s;
    }
    planes_t planes() const
    {
        planes_t p;
        check(lap_simplex_planes(get(), &p.functions.count, &p.functions.offsets, &p.functions.items, &p.opposite.data));
        p.opposite.count = p.opposite.data == nullptr ? 0 : p.functions.offsets[p.functions.count];
        return p;
    }
    /* The half-faces of each cell. */
    rows<std::int32_t> cells() const
    {
        rows<std::int32_t> c;
        check(lap_simplex_cells(get(), &c.count, &c.offsets, &c.items));
        return c;
    }
    /* The signs of all functions in a cell of an arrangement. */
    view<std::int32_t> cell_signs(std::int64_t cell) const
    {
        view<std::int32_t> s;
        check(lap_simplex_cell_signs(get(), nullptr, &s.count, &s.data));
        s.data = s.data == nullptr ? nullptr : s.data + cell * s.count;
        return s;
    }
    /* Of an interface. */
    materials_t cell_materials() const
    {
        materials_t m;
        check(lap_simplex_cell_materials(get(), &m.owners.count, &m.owners.data, &m.all.offsets, &m.all.items));
        m.all.count = m.owners.count;
        return m;
    }
    std::array<std::string, 4> exact_vertex(context &with, std::int32_t vertex) const
    {
        const char *x[4] = {"", "", "", ""};
        with.run(lap_simplex_vertex_exact(with.get(), get(), vertex, &x[0], &x[1], &x[2], &x[3]));
        return {x[0], x[1], x[2], x[3]};
    }
    /* As a part of its simplex. */
    std::string exact_cell_volume(context &with, std::int32_t cell) const
    {
        const char *volume = "";
        with.run(lap_simplex_cell_volume_exact(with.get(), get(), cell, &volume));
        return volume;
    }
    void check_consistency(context &with) const { with.run(lap_simplex_check(with.get(), get())); }

    const lap_simplex *get() const { return handle_.get(); }

private:
    static std::int64_t size(const std::vector<double> &v) { return static_cast<std::int64_t>(v.size()); }

    struct free_it {
        void operator()(lap_simplex *handle) const { lap_simplex_free(handle); }
    };
    std::unique_ptr<lap_simplex, free_it> handle_;
};

inline lap_network_options network_options()
{
    lap_network_options options;
    check(lap_network_options_init(&options, static_cast<std::int32_t>(sizeof options)));
    return options;
}

inline lap_surface_certify_options surface_certify_options()
{
    lap_surface_certify_options options;
    check(lap_surface_certify_options_init(&options, static_cast<std::int32_t>(sizeof options)));
    return options;
}

/* The boundary of a solid made of regions of a network or of cells of an arrangement. */
class surface {
public:
    struct vertices_t {
        groups<double, 3> xyz;
        view<std::int32_t> sources;
    };
    struct polygons_t {
        rows<std::int32_t> vertices;
        view<std::int32_t> births;
        view<std::uint8_t> flipped;
    };
    struct triangles_t {
        groups<std::int32_t, 3> vertices;
        view<std::int32_t> operands, triangles;
        view<std::uint8_t> flipped;
    };

    explicit surface(lap_surface *made) : handle_(made) {}

    vertices_t vertices() const
    {
        vertices_t v;
        check(lap_surface_vertices(get(), &v.xyz.count, &v.xyz.data, &v.sources.data));
        v.sources.count = v.xyz.count;
        return v;
    }
    polygons_t polygons() const
    {
        polygons_t p;
        check(lap_surface_polygons(get(), &p.vertices.count, &p.vertices.offsets, &p.vertices.items, &p.births.data,
                                   &p.flipped.data));
        p.births.count = p.flipped.count = p.vertices.count;
        return p;
    }
    std::int64_t euler() const
    {
        std::int64_t euler = 0;
        check(lap_surface_euler(get(), &euler));
        return euler;
    }
    /* These three are for surfaces of arrangements. */
    triangles_t triangles() const
    {
        triangles_t t;
        check(lap_surface_triangles(get(), &t.vertices.count, &t.vertices.data, &t.operands.data, &t.triangles.data,
                                    &t.flipped.data));
        t.operands.count = t.triangles.count = t.flipped.count = t.vertices.count;
        return t;
    }
    double volume() const
    {
        double volume = 0;
        check(lap_surface_volume(get(), &volume));
        return volume;
    }
    std::string exact_volume(context &with) const
    {
        const char *volume = "";
        with.run(lap_surface_volume_exact(with.get(), get(), &volume));
        return volume;
    }
    /* Solid on its doubles, checked exactly; certified_report().certified tells whether nothing remains. */
    surface certify(context &with, const lap_surface_certify_options &options = surface_certify_options()) const
    {
        lap_surface *made = nullptr;
        const std::int32_t status = lap_surface_certify(with.get(), get(), &options, &made);
        surface result(made);
        with.run(status);
        return result;
    }
    /* These two are for surfaces that certify made. */
    lap_surface_certify_report certified_report() const
    {
        lap_surface_certify_report report;
        check(lap_surface_certified_report(get(), &report, static_cast<std::int32_t>(sizeof report)));
        return report;
    }
    groups<std::int32_t, 2> certified_open() const
    {
        groups<std::int32_t, 2> pairs;
        check(lap_surface_certified_open(get(), &pairs.count, &pairs.data));
        return pairs;
    }

    /* What the surface of an arrangement's solid bounds, borrowed from this surface. */
    class complex complex(context &with) const
    {
        const lap_complex *borrowed = nullptr;
        with.run(lap_surface_complex(with.get(), get(), &borrowed));
        return lapidary::complex(borrowed);
    }

    const lap_surface *get() const { return handle_.get(); }

private:
    struct free_it {
        void operator()(lap_surface *handle) const { lap_surface_free(handle); }
    };
    std::unique_ptr<lap_surface, free_it> handle_;
};

/* The network of functions, or of materials, that are linear on tetrahedra or triangles. */
class network {
public:
    struct counts_t {
        std::int64_t vertices, edges, polygons, patches, chains, corners, components, shells, regions;
    };
    struct input_t {
        std::int32_t kind, dim;
        std::int64_t functions;
    };
    struct vertices_t {
        groups<double, 3> xyz;
        groups<std::int32_t, 4> nodes;
    };
    struct polygons_t {
        rows<std::int32_t> vertices;
        view<std::int32_t> sets;
        groups<std::int32_t, 2> simplices;
    };
    struct sets_t {
        rows<std::int32_t> functions, orientations;
    };
    struct edges_t {
        groups<std::int32_t, 2> vertices;
        rows<std::int32_t> polygons;
    };
    struct patches_t {
        rows<std::int32_t> polygons;
        view<std::int32_t> components;
    };
    struct polygon_patches_t {
        view<std::int32_t> patches;
        view<std::uint8_t> turned;
    };
    struct chains_t {
        rows<std::int32_t> edges, vertices;
        view<std::uint8_t> loops;
    };
    struct chain_patches_t {
        rows<std::int32_t> sides;
        rows<std::uint8_t> gaps;
    };
    struct shells_t {
        rows<std::int32_t> sides;
        view<std::int32_t> regions;
    };
    struct regions_t {
        rows<std::int32_t> shells;
        view<std::int32_t> simplices;
    };
    struct triangles_t {
        groups<std::int32_t, 3> vertices;
        view<std::int32_t> polygons;
    };
    struct stage {
        std::string name;
        double seconds;
    };
    /* The value of function f at node i is data[f * function_stride + i * node_stride]. */
    struct values_t {
        const double *data = nullptr;
        std::int64_t functions = 0, function_stride = 1, node_stride = 1;
    };

    /* bounds: lowest x, y, z, highest x, y, z, or NULL. */
    static network box(context &with, const std::array<std::int32_t, 3> &cells, const double *bounds, const values_t &values,
                       const lap_network_options &options = network_options())
    {
        return make(with, [&](lap_network **made) {
            return lap_network_new_box(with.get(), cells.data(), bounds, values.functions, values.data,
                                       values.function_stride, values.node_stride, &options, made);
        });
    }
    /* xyz: three per node; tets: four nodes each. */
    static network tets(context &with, const std::vector<double> &xyz, const std::vector<std::int32_t> &tets,
                        const values_t &values, const lap_network_options &options = network_options())
    {
        if (xyz.size() % 3 != 0) throw error(LAP_ERR_BAD_ARGUMENT, "xyz does not hold three numbers per node");
        if (tets.size() % 4 != 0) throw error(LAP_ERR_BAD_ARGUMENT, "tets does not hold four numbers per tetrahedron");
        return make(with, [&](lap_network **made) {
            return lap_network_new_tets(with.get(), size(xyz) / 3, xyz.data(), size(tets) / 4, tets.data(), values.functions,
                                        values.data, values.function_stride, values.node_stride, &options, made);
        });
    }
    /* xy: two per node; triangles: three nodes each. */
    static network triangles(context &with, const std::vector<double> &xy, const std::vector<std::int32_t> &triangles,
                             const values_t &values, const lap_network_options &options = network_options())
    {
        if (xy.size() % 2 != 0) throw error(LAP_ERR_BAD_ARGUMENT, "xy does not hold two numbers per node");
        if (triangles.size() % 3 != 0) throw error(LAP_ERR_BAD_ARGUMENT, "triangles does not hold three numbers per triangle");
        return make(with, [&](lap_network **made) {
            return lap_network_new_triangles(with.get(), size(xy) / 2, xy.data(), size(triangles) / 3, triangles.data(),
                                             values.functions, values.data, values.function_stride, values.node_stride,
                                             &options, made);
        });
    }

    counts_t counts() const
    {
        counts_t n{};
        check(lap_network_counts(get(), &n.vertices, &n.edges, &n.polygons, &n.patches, &n.chains, &n.corners, &n.components,
                                 &n.shells, &n.regions));
        return n;
    }
    input_t input() const
    {
        input_t i{};
        check(lap_network_input(get(), &i.kind, &i.dim, &i.functions));
        return i;
    }
    /* Simplices by the number of functions that are active in them. */
    view<std::int64_t> active() const
    {
        view<std::int64_t> a;
        check(lap_network_active(get(), &a.count, &a.data));
        return a;
    }
    vertices_t vertices() const
    {
        vertices_t v;
        check(lap_network_vertices(get(), &v.xyz.count, &v.xyz.data, &v.nodes.data));
        v.nodes.count = v.xyz.count;
        return v;
    }
    rows<std::int32_t> vertex_functions() const
    {
        rows<std::int32_t> f;
        check(lap_network_vertex_functions(get(), &f.count, &f.offsets, &f.items));
        return f;
    }
    polygons_t polygons() const
    {
        polygons_t p;
        check(lap_network_polygons(get(), &p.vertices.count, &p.vertices.offsets, &p.vertices.items, &p.sets.data,
                                   &p.simplices.data));
        p.sets.count = p.simplices.count = p.vertices.count;
        return p;
    }
    sets_t sets() const
    {
        sets_t s;
        check(lap_network_sets(get(), &s.functions.count, &s.functions.offsets, &s.functions.items, &s.orientations.items));
        s.orientations.count = s.functions.count;
        s.orientations.offsets = s.functions.offsets;
        return s;
    }
    edges_t edges() const
    {
        edges_t e;
        check(lap_network_edges(get(), &e.vertices.count, &e.vertices.data, &e.polygons.offsets, &e.polygons.items));
        e.polygons.count = e.vertices.count;
        return e;
    }
    patches_t patches() const
    {
        patches_t p;
        check(lap_network_patches(get(), &p.polygons.count, &p.polygons.offsets, &p.polygons.items, &p.components.data));
        p.components.count = p.polygons.count;
        return p;
    }
    polygon_patches_t polygon_patches() const
    {
        polygon_patches_t p;
        check(lap_network_polygon_patches(get(), &p.patches.count, &p.patches.data, &p.turned.data));
        p.turned.count = p.patches.count;
        return p;
    }
    chains_t chains() const
    {
        chains_t c;
        check(lap_network_chains(get(), &c.edges.count, &c.edges.offsets, &c.edges.items, &c.vertices.offsets,
                                 &c.vertices.items, &c.loops.data));
        c.vertices.count = c.loops.count = c.edges.count;
        return c;
    }
    chain_patches_t chain_patches() const
    {
        chain_patches_t c;
        check(lap_network_chain_patches(get(), &c.sides.count, &c.sides.offsets, &c.sides.items, &c.gaps.items));
        c.gaps.count = c.sides.count;
        c.gaps.offsets = c.sides.offsets;
        return c;
    }
    view<std::int32_t> corners() const
    {
        view<std::int32_t> c;
        check(lap_network_corners(get(), &c.count, &c.data));
        return c;
    }
    shells_t shells() const
    {
        shells_t s;
        check(lap_network_shells(get(), &s.sides.count, &s.sides.offsets, &s.sides.items, &s.regions.data));
        s.regions.count = s.sides.count;
        return s;
    }
    regions_t regions() const
    {
        regions_t r;
        check(lap_network_regions(get(), &r.shells.count, &r.shells.offsets, &r.shells.items, &r.simplices.data));
        r.simplices.count = r.shells.count;
        return r;
    }
    /* The signs of all functions in a region of an arrangement. */
    view<std::int32_t> region_signs(std::int64_t region) const
    {
        view<std::int32_t> s;
        check(lap_network_region_signs(get(), nullptr, &s.count, &s.data));
        s.data = s.data == nullptr ? nullptr : s.data + region * s.count;
        return s;
    }
    /* Of an interface. */
    view<std::int32_t> region_materials() const
    {
        view<std::int32_t> m;
        check(lap_network_region_materials(get(), &m.count, &m.data));
        return m;
    }
    triangles_t triangles() const
    {
        triangles_t t;
        check(lap_network_triangles(get(), &t.vertices.count, &t.vertices.data, &t.polygons.data));
        t.polygons.count = t.vertices.count;
        return t;
    }
    /* These need options with keep_values. */
    rows<std::int32_t> region_ties(context &with) const
    {
        rows<std::int32_t> t;
        with.run(lap_network_region_ties(with.get(), get(), &t.count, &t.offsets, &t.items));
        return t;
    }
    /* The regions as volumes, borrowed from this network. */
    class complex complex(context &with) const
    {
        const lap_complex *borrowed = nullptr;
        with.run(lap_network_complex(with.get(), get(), &borrowed));
        return lapidary::complex(borrowed);
    }
    std::array<std::string, 3> exact_vertex(context &with, std::int32_t vertex) const
    {
        const char *x = "", *y = "", *z = "";
        with.run(lap_network_vertex_exact(with.get(), get(), vertex, &x, &y, &z));
        return {x, y, z};
    }
    void check_consistency(context &with) const { with.run(lap_network_check(with.get(), get())); }

    /* The boundary of the regions that an expression, a table with a byte for each, or a function chooses. */
    surface csg(context &with, const std::string &expression, bool triangulated = false) const
    {
        lap_surface *made = nullptr;
        const std::int32_t status = lap_network_csg(with.get(), get(), expression.c_str(), triangulated, &made);
        surface result(made);
        with.run(status);
        return result;
    }
    surface csg(context &with, const std::vector<std::uint8_t> &table, bool triangulated = false) const
    {
        lap_surface *made = nullptr;
        const std::int32_t status =
            lap_network_csg_table(with.get(), get(), size(table), table.data(), triangulated, &made);
        surface result(made);
        with.run(status);
        return result;
    }
    /* An exception of the function leaves the call. */
    surface csg(context &with, const std::function<bool(std::int32_t region)> &chosen, bool triangulated = false) const
    {
        std::vector<std::uint8_t> table(static_cast<std::size_t>(counts().regions));
        for (std::size_t r = 0; r < table.size(); ++r) table[r] = chosen(static_cast<std::int32_t>(r)) ? 1 : 0;
        return csg(with, table, triangulated);
    }

    std::vector<stage> stages() const
    {
        std::int32_t count = 0;
        check(lap_network_stage_count(get(), &count));
        std::vector<stage> all;
        for (std::int32_t i = 0; i < count; ++i) {
            const char *name = "";
            double seconds = 0;
            check(lap_network_stage(get(), i, &name, &seconds));
            all.push_back({name, seconds});
        }
        return all;
    }

    const lap_network *get() const { return handle_.get(); }

private:
    explicit network(lap_network *made) : handle_(made) {}

    template <class Make>
    static network make(context &with, Make call)
    {
        lap_network *made = nullptr;
        const std::int32_t status = call(&made);
        network result(made);
        with.run(status);
        return result;
    }
    template <class T>
    static std::int64_t size(const std::vector<T> &v)
    {
        return static_cast<std::int64_t>(v.size());
    }
    struct free_it {
        void operator()(lap_network *handle) const { lap_network_free(handle); }
    };
    std::unique_ptr<lap_network, free_it> handle_;
};

inline lap_arrangement_options arrangement_options()
{
    lap_arrangement_options options;
    check(lap_arrangement_options_init(&options, static_cast<std::int32_t>(sizeof options)));
    return options;
}

/* An operand that borrows its arrays: three numbers per vertex, three indices per triangle. */
inline lap_operand operand(const std::vector<double> &xyz, const std::vector<std::int32_t> &indices)
{
    if (xyz.size() % 3 != 0) throw error(LAP_ERR_BAD_ARGUMENT, "xyz does not hold three numbers per vertex");
    if (indices.size() % 3 != 0) throw error(LAP_ERR_BAD_ARGUMENT, "indices does not hold three numbers per triangle");
    return {static_cast<std::int64_t>(xyz.size() / 3), xyz.data(), static_cast<std::int64_t>(indices.size() / 3),
            indices.data()};
}

/* The cells into which triangle meshes divide space. */
class arrangement {
public:
    struct counts_t {
        std::int64_t vertices, faces, patches, cells, intersecting_pairs, dropped;
    };
    /* The two first have one more than there are operands. */
    struct operands_t {
        view<std::int64_t> first_vertices, first_triangles, dropped;
    };
    struct origins_t {
        view<std::int32_t> kinds;
        groups<std::int32_t, 3> ids;
    };
    struct faces_t {
        groups<std::int32_t, 3> vertices;
        view<std::int32_t> patches;
        groups<std::int32_t, 2> cells;
    };
    struct births_t {
        rows<std::int32_t> operands, triangles;
        rows<std::uint8_t> reversed;
    };
    struct patches_t {
        view<std::int32_t> faces;
        groups<std::int32_t, 2> cells;
        rows<std::int32_t> operands, multiplicities;
    };
    struct cells_t {
        rows<std::int32_t> operands, windings;
    };
    struct stage {
        std::string name;
        double seconds;
    };

    explicit arrangement(context &with, const std::vector<lap_operand> &operands,
                         const lap_arrangement_options &options = arrangement_options())
    {
        lap_arrangement *made = nullptr;
        const std::int32_t status = lap_arrangement_new(with.get(), static_cast<std::int64_t>(operands.size()),
                                                        operands.data(), &options, &made);
        handle_.reset(made);
        with.run(status);
    }
    /* With half-spaces a x + b y + c z + d < 0 (four numbers each) as further operands; bounds: six numbers, or none for a box around all vertices. */
    arrangement(context &with, const std::vector<lap_operand> &operands, const std::vector<double> &half_spaces,
                const std::vector<double> &bounds, const lap_arrangement_options &options = arrangement_options())
    {
        if (half_spaces.size() % 4 != 0) throw error(LAP_ERR_BAD_ARGUMENT, "half_spaces does not hold four numbers per plane");
        if (!bounds.empty() && bounds.size() != 6) throw error(LAP_ERR_BAD_ARGUMENT, "bounds does not hold six numbers");
        lap_arrangement *made = nullptr;
        const std::int32_t status = lap_arrangement_new_half_spaces(
            with.get(), static_cast<std::int64_t>(operands.size()), operands.data(),
            static_cast<std::int64_t>(half_spaces.size() / 4), half_spaces.data(), bounds.empty() ? nullptr : bounds.data(),
            &options, &made);
        handle_.reset(made);
        with.run(status);
    }

    counts_t counts() const
    {
        counts_t n{};
        check(lap_arrangement_counts(get(), &n.vertices, &n.faces, &n.patches, &n.cells, &n.intersecting_pairs, &n.dropped));
        return n;
    }
    operands_t operands() const
    {
        operands_t o;
        check(lap_arrangement_operands(get(), &o.dropped.count, &o.first_vertices.data, &o.first_triangles.data,
                                       &o.dropped.data));
        o.first_vertices.count = o.first_triangles.count = o.dropped.count + 1;
        return o;
    }
    groups<double, 3> vertices() const
    {
        groups<double, 3> v;
        check(lap_arrangement_vertices(get(), &v.count, &v.data));
        return v;
    }
    origins_t vertex_origins() const
    {
        origins_t o;
        check(lap_arrangement_vertex_origins(get(), &o.kinds.count, &o.kinds.data, &o.ids.data));
        o.ids.count = o.kinds.count;
        return o;
    }
    std::array<std::string, 3> exact_vertex(context &with, std::int32_t vertex) const
    {
        const char *x = "", *y = "", *z = "";
        with.run(lap_arrangement_vertex_exact(with.get(), get(), vertex, &x, &y, &z));
        return {x, y, z};
    }
    faces_t faces() const
    {
        faces_t f;
        check(lap_arrangement_faces(get(), &f.vertices.count, &f.vertices.data, &f.patches.data, &f.cells.data));
        f.patches.count = f.cells.count = f.vertices.count;
        return f;
    }
    births_t face_births() const
    {
        births_t b;
        check(lap_arrangement_face_births(get(), &b.operands.count, &b.operands.offsets, &b.operands.items,
                                          &b.triangles.items, &b.reversed.items));
        b.triangles.count = b.reversed.count = b.operands.count;
        b.triangles.offsets = b.reversed.offsets = b.operands.offsets;
        return b;
    }
    patches_t patches() const
    {
        patches_t p;
        check(lap_arrangement_patches(get(), &p.faces.count, &p.faces.data, &p.cells.data, &p.operands.offsets,
                                      &p.operands.items, &p.multiplicities.items));
        p.cells.count = p.operands.count = p.multiplicities.count = p.faces.count;
        p.multiplicities.offsets = p.operands.offsets;
        return p;
    }
    /* Operands with winding numbers other than 0, and these. */
    cells_t cells() const
    {
        cells_t c;
        check(lap_arrangement_cells(get(), &c.operands.count, &c.operands.offsets, &c.operands.items, &c.windings.items));
        c.windings.count = c.operands.count;
        c.windings.offsets = c.operands.offsets;
        return c;
    }
    view<double> cell_volumes() const
    {
        view<double> v;
        check(lap_arrangement_cell_volumes(get(), &v.count, &v.data));
        return v;
    }
    std::string exact_cell_volume(context &with, std::int32_t cell) const
    {
        const char *volume = "";
        with.run(lap_arrangement_cell_volume_exact(with.get(), get(), cell, &volume));
        return volume;
    }

    /* The bounded cells, borrowed from this arrangement; of each vertex and face there those of the arrangement. */
    struct places_t {
        view<std::int32_t> vertices;
        rows<std::int32_t> faces;
    };
    class complex complex(context &with) const
    {
        const lap_complex *borrowed = nullptr;
        with.run(lap_arrangement_complex(with.get(), get(), &borrowed));
        return lapidary::complex(borrowed);
    }
    /* Only after complex(). */
    places_t complex_places() const
    {
        places_t p;
        check(lap_arrangement_complex_places(get(), &p.vertices.count, &p.vertices.data, &p.faces.count, &p.faces.offsets,
                                             &p.faces.items));
        return p;
    }

    /* The surface of a solid: LAP_EXTRACT_*, an expression, a table with a byte for each cell, or a function of each cell and its winding
       number for every operand; an exception of the function leaves the call. */
    surface extract(context &with, std::int32_t operation, std::int32_t at_least = 1) const
    {
        return made(with, [&](lap_surface **to) {
            return lap_arrangement_extract(with.get(), get(), operation, at_least, to);
        });
    }
    surface extract(context &with, const std::string &expression) const
    {
        return made(with, [&](lap_surface **to) {
            return lap_arrangement_extract_expression(with.get(), get(), expression.c_str(), to);
        });
    }
    surface extract(context &with, const std::vector<std::uint8_t> &table) const
    {
        return made(with, [&](lap_surface **to) {
            return lap_arrangement_extract_table(with.get(), get(), static_cast<std::int64_t>(table.size()), table.data(), to);
        });
    }
    using inside = std::function<bool(std::int32_t cell, const std::vector<std::int32_t> &winding)>;
    surface extract(context &with, const inside &chosen) const
    {
        const cells_t c = cells();
        std::vector<std::int32_t> winding(static_cast<std::size_t>(operands().dropped.size()));
        std::vector<std::uint8_t> table(static_cast<std::size_t>(c.windings.size()));
        for (std::size_t i = 0; i < table.size(); ++i) {
            const auto cell = static_cast<std::int64_t>(i);
            const view<std::int32_t> at = c.operands[cell], numbers = c.windings[cell];
            for (std::int64_t k = 0; k < at.size(); ++k) winding[static_cast<std::size_t>(at[k])] = numbers[k];
            table[i] = chosen(static_cast<std::int32_t>(i), winding) ? 1 : 0;
            for (const std::int32_t k : at) winding[static_cast<std::size_t>(k)] = 0;
        }
        return extract(with, table);
    }

    std::vector<stage> stages() const
    {
        std::int32_t count = 0;
        check(lap_arrangement_stage_count(get(), &count));
        std::vector<stage> all;
        for (std::int32_t i = 0; i < count; ++i) {
            const char *name = "";
            double seconds = 0;
            check(lap_arrangement_stage(get(), i, &name, &seconds));
            all.push_back({name, seconds});
        }
        return all;
    }

    const lap_arrangement *get() const { return handle_.get(); }

private:
    template <class Make>
    static surface made(context &with, Make call)
    {
        lap_surface *handle = nullptr;
        const std::int32_t status = call(&handle);
        surface result(handle);
        with.run(status);
        return result;
    }
    struct free_it {
        void operator()(lap_arrangement *handle) const { lap_arrangement_free(handle); }
    };
    std::unique_ptr<lap_arrangement, free_it> handle_;
};

} // namespace lapidary

#endif /* LAPIDARY_HPP */
