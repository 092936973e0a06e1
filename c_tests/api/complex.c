/* lap_complex_*: every view, and what they must say of a cut cube and of a hollow one. */
#include "api.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int64_t n_vertices, n_edges, n_faces, n_cells, n_loops, n_corners, n_shells;

static void counts(const lap_complex *c)
{
    STATUS(LAP_OK, lap_complex_counts(c, &n_vertices, &n_edges, &n_faces, &n_cells, &n_loops, &n_corners, &n_shells));
    STATUS(LAP_OK, lap_complex_counts(c, NULL, NULL, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_counts(NULL, &n_vertices, NULL, NULL, NULL, NULL, NULL, NULL));
    CHECK(n_vertices > 0 && n_edges > 0 && n_faces > 0 && n_cells > 0);
    CHECK(n_loops >= n_faces && n_shells >= n_cells);
}

static int is_csr(const int32_t *offsets, int64_t rows, int64_t items)
{
    int64_t i;
    if (offsets == NULL || offsets[0] != 0 || offsets[rows] != items) return 0;
    for (i = 0; i < rows; ++i) {
        if (offsets[i] > offsets[i + 1]) return 0;
    }
    return 1;
}

static int in_range(const int32_t *ids, int64_t count, int64_t low, int64_t high)
{
    int64_t i;
    for (i = 0; i < count; ++i) {
        if (ids[i] < low || ids[i] >= high) return 0;
    }
    return 1;
}

/* Views that hold for any complex of a mesh with n_mesh vertices. */
static void structure(const lap_complex *c, int64_t n_mesh, int64_t n_planes, int64_t n_triangles)
{
    int64_t count = -1, i, k;
    const double *xyz = NULL;
    const int32_t *kinds = NULL, *ids = NULL, *offsets = NULL, *planes = NULL, *edges = NULL, *cells = NULL;
    const int32_t *face_loops = NULL, *loop_corners = NULL, *vertices = NULL, *corner_edges = NULL, *tags = NULL;
    const int32_t *cell_shells = NULL, *shell_faces = NULL, *half_faces = NULL, *components = NULL;
    const int32_t *mates = NULL, *corner_faces = NULL;
    int32_t *owned;

    counts(c);
    STATUS(LAP_OK, lap_complex_vertices(c, &count, &xyz));
    CHECK(count == n_vertices);
    for (i = 0; i < 3 * count; ++i) CHECK(isfinite(xyz[i]) && !(xyz[i] == 0 && signbit(xyz[i])));
    STATUS(LAP_OK, lap_complex_vertices(c, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_vertices(NULL, &count, &xyz));

    STATUS(LAP_OK, lap_complex_vertex_origins(c, &count, &kinds, &ids));
    CHECK(count == n_vertices);
    for (i = 0; i < count; ++i) {
        CHECK(kinds[i] >= LAP_VERTEX_MESH && kinds[i] <= LAP_VERTEX_PLANES);
        CHECK((kinds[i] == LAP_VERTEX_MESH) == (i < n_mesh));
        if (kinds[i] == LAP_VERTEX_MESH) {
            CHECK(ids[3 * i] >= 0 && ids[3 * i + 1] == -1 && ids[3 * i + 2] == -1);
        } else {
            CHECK(in_range(ids + 3 * i + 2, 1, 0, n_planes) && ids[3 * i] >= 0 && ids[3 * i + 1] >= 0);
        }
    }
    STATUS(LAP_OK, lap_complex_vertex_origins(c, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_vertex_origins(NULL, &count, &kinds, &ids));

    STATUS(LAP_OK, lap_complex_vertex_planes(c, &count, &offsets, &planes));
    CHECK(count == n_vertices && is_csr(offsets, count, offsets[count]) && in_range(planes, offsets[count], 0, n_planes));
    for (i = 0; i < count; ++i) {
        for (k = offsets[i] + 1; k < offsets[i + 1]; ++k) CHECK(planes[k - 1] < planes[k]);
        if (kinds[i] == LAP_VERTEX_PLANES) CHECK(offsets[i + 1] - offsets[i] >= 3);
    }
    STATUS(LAP_OK, lap_complex_vertex_planes(c, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_vertex_planes(NULL, &count, &offsets, &planes));

    STATUS(LAP_OK, lap_complex_edges(c, &count, &edges));
    CHECK(count == n_edges && in_range(edges, 2 * count, 0, n_vertices));
    for (i = 0; i < count; ++i) CHECK(edges[2 * i] != edges[2 * i + 1]);
    STATUS(LAP_OK, lap_complex_edges(c, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_edges(NULL, &count, &edges));

    STATUS(LAP_OK, lap_complex_faces(c, &count, &face_loops, &loop_corners, &vertices, &corner_edges));
    CHECK(count == n_faces && is_csr(face_loops, n_faces, n_loops) && is_csr(loop_corners, n_loops, n_corners));
    CHECK(in_range(vertices, n_corners, 0, n_vertices) && in_range(corner_edges, n_corners, 0, n_edges));
    for (i = 0; i < n_loops; ++i) {
        for (k = loop_corners[i]; k < loop_corners[i + 1]; ++k) {
            const int32_t a = vertices[k], b = vertices[k + 1 < loop_corners[i + 1] ? k + 1 : loop_corners[i]];
            const int32_t *e = edges + 2 * corner_edges[k];
            CHECK((e[0] == a && e[1] == b) || (e[0] == b && e[1] == a));
        }
    }
    STATUS(LAP_OK, lap_complex_faces(c, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_faces(NULL, &count, &face_loops, &loop_corners, &vertices, &corner_edges));

    STATUS(LAP_OK, lap_complex_face_supports(c, &count, &kinds, &ids, &planes, &tags));
    CHECK(count == n_faces && in_range(planes, count, -1, n_planes));
    for (i = 0; i < count; ++i) {
        CHECK(kinds[i] == LAP_SUPPORT_TRIANGLE || kinds[i] == LAP_SUPPORT_PLANE);
        if (kinds[i] == LAP_SUPPORT_TRIANGLE) {
            CHECK(in_range(ids + i, 1, 0, n_triangles));
        } else {
            CHECK(in_range(ids + i, 1, 0, n_planes) && planes[i] == ids[i] && tags[i] == 0);
        }
    }
    STATUS(LAP_OK, lap_complex_face_supports(c, NULL, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_face_supports(NULL, &count, &kinds, &ids, &planes, &tags));

    STATUS(LAP_OK, lap_complex_face_cells(c, &count, &cells));
    CHECK(count == n_faces && in_range(cells, 2 * count, -1, n_cells));
    for (i = 0; i < count; ++i) {
        CHECK(cells[2 * i] >= 0);
        /* Faces on the surface have the outside before them, the others a cell on each side. */
        CHECK((cells[2 * i + 1] == -1) == (kinds[i] == LAP_SUPPORT_TRIANGLE));
    }
    STATUS(LAP_OK, lap_complex_face_cells(c, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_face_cells(NULL, &count, &cells));

    STATUS(LAP_OK, lap_complex_cells(c, &count, &cell_shells, &shell_faces, &half_faces));
    CHECK(count == n_cells && is_csr(cell_shells, n_cells, n_shells));
    CHECK(is_csr(shell_faces, n_shells, shell_faces[n_shells]) && in_range(half_faces, shell_faces[n_shells], 0, 2 * n_faces));
    owned = (int32_t *)calloc((size_t)n_faces * 2, sizeof *owned);
    for (i = 0; i < n_cells; ++i) {
        for (k = shell_faces[cell_shells[i]]; k < shell_faces[cell_shells[i + 1]]; ++k) {
            owned[half_faces[k]]++;
            CHECK(cells[half_faces[k]] == i);
        }
    }
    for (i = 0; i < 2 * n_faces; ++i) CHECK(owned[i] == (cells[i] >= 0 ? 1 : 0));
    free(owned);
    STATUS(LAP_OK, lap_complex_cells(c, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_cells(NULL, &count, &cell_shells, &shell_faces, &half_faces));

    STATUS(LAP_OK, lap_complex_cell_components(c, &count, &components));
    CHECK(count == n_cells && in_range(components, count, 0, 1));
    STATUS(LAP_OK, lap_complex_cell_components(c, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_cell_components(NULL, &count, &components));

    STATUS(LAP_OK, lap_complex_adjacency(c, &count, &mates, &corner_faces));
    CHECK(count == n_corners && in_range(mates, 2 * count, -1, 2 * count) && in_range(corner_faces, count, 0, n_faces));
    for (i = 0; i < 2 * count; ++i) {
        const int64_t half_face = 2 * (int64_t)corner_faces[i / 2] + i % 2;
        CHECK((mates[i] == -1) == (cells[half_face] == -1));
        if (mates[i] < 0) continue;
        /* Mates are mutual, at one edge, in one cell. */
        CHECK(mates[mates[i]] == i);
        CHECK(corner_edges[mates[i] / 2] == corner_edges[i / 2]);
        CHECK(cells[2 * corner_faces[mates[i] / 2] + mates[i] % 2] == cells[half_face]);
    }
    STATUS(LAP_OK, lap_complex_adjacency(c, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_adjacency(NULL, &count, &mates, &corner_faces));
}

static void polygons(const lap_complex *c, int32_t style, int64_t expected_count)
{
    int64_t count = -1, i;
    const int32_t *offsets = NULL, *vertices = NULL, *faces = NULL;
    STATUS(LAP_OK, lap_complex_polygons(c, style, &count, &offsets, &vertices, &faces));
    CHECK(expected_count < 0 ? count >= n_faces : count == expected_count);
    CHECK(is_csr(offsets, count, offsets[count]) && in_range(vertices, offsets[count], 0, n_vertices));
    CHECK(in_range(faces, count, 0, n_faces));
    for (i = 0; i < count; ++i) {
        CHECK(i == 0 || faces[i - 1] <= faces[i]);
        if (style == LAP_FACES_TRIANGLES) CHECK(offsets[i] == 3 * i);
    }
    STATUS(LAP_OK, lap_complex_polygons(c, style, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_polygons(NULL, style, &count, &offsets, &vertices, &faces));
}

static void all_polygons(const lap_complex *c)
{
    int64_t count;
    polygons(c, LAP_FACES_HOLES, n_loops);
    polygons(c, LAP_FACES_BRIDGED, n_faces);
    polygons(c, LAP_FACES_TRIANGLES, -1);
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_complex_polygons(c, 3, &count, NULL, NULL, NULL));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_complex_polygons(c, -1, &count, NULL, NULL, NULL));
}

/* Volumes by the divergence theorem over faces: closure of every cell, and the moments against one another. */
static void moments(const lap_complex *c, double expected_volume)
{
    int64_t count = -1, i, k;
    const double *volumes = NULL, *centroids = NULL, *areas = NULL, *face_centroids = NULL;
    const uint8_t *flags = NULL, *face_flags = NULL;
    const int32_t *cell_shells = NULL, *shell_faces = NULL, *half_faces = NULL;
    double total = 0;

    STATUS(LAP_OK, lap_complex_cell_moments(c, &count, &volumes, &centroids, &flags));
    CHECK(count == n_cells);
    STATUS(LAP_OK, lap_complex_face_moments(c, &count, &areas, &face_centroids, &face_flags));
    CHECK(count == n_faces);
    STATUS(LAP_OK, lap_complex_cells(c, NULL, &cell_shells, &shell_faces, &half_faces));
    for (i = 0; i < n_cells; ++i) {
        double sum[3] = {0, 0, 0}, volume = 0;
        CHECK(flags[i] == 0 && volumes[i] > 0);
        for (k = shell_faces[cell_shells[i]]; k < shell_faces[cell_shells[i + 1]]; ++k) {
            const int32_t face = half_faces[k] / 2;
            const double sign = half_faces[k] % 2 == 0 ? 1 : -1;
            int axis;
            CHECK(face_flags[face] == 0);
            for (axis = 0; axis < 3; ++axis) {
                sum[axis] += sign * areas[3 * face + axis];
                volume += sign * areas[3 * face + axis] * face_centroids[3 * face + axis] / 3;
            }
        }
        /* The shapes are small multiples of halves and of eighths, so these sums are exact but for the centroids. */
        CHECK(sum[0] == 0 && sum[1] == 0 && sum[2] == 0);
        CHECK(fabs(volume - volumes[i]) <= 64 * 0x1p-52 * expected_volume);
        total += volumes[i];
    }
    CHECK(total == expected_volume);
    STATUS(LAP_OK, lap_complex_cell_moments(c, NULL, NULL, NULL, NULL));
    STATUS(LAP_OK, lap_complex_face_moments(c, NULL, NULL, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_cell_moments(NULL, &count, &volumes, &centroids, &flags));
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_face_moments(NULL, &count, &areas, &face_centroids, &face_flags));
}

static void exact(lap_context *context, const lap_complex *c)
{
    const char *x = NULL, *y = NULL, *z = NULL, *volume = NULL;
    const double *xyz = NULL;
    int64_t i;

    STATUS(LAP_OK, lap_complex_vertices(c, NULL, &xyz));
    for (i = 0; i < n_vertices; ++i) {
        char text[64];
        STATUS_IN(context, LAP_OK, lap_complex_vertex_exact(context, c, (int32_t)i, &x, &y, &z));
        /* The vertices of these shapes have whole coordinates, or halves. */
        snprintf(text, sizeof text, xyz[3 * i] == floor(xyz[3 * i]) ? "%.0f" : "%.0f/2",
                 xyz[3 * i] == floor(xyz[3 * i]) ? xyz[3 * i] : 2 * xyz[3 * i]);
        CHECK(strcmp(text, x) == 0 && y != NULL && z != NULL);
    }
    STATUS(LAP_OK, lap_complex_vertex_exact(context, c, 0, NULL, NULL, NULL));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_complex_vertex_exact(context, c, (int32_t)n_vertices, &x, &y, &z));
    CHECK(has_message(context));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_complex_vertex_exact(context, c, -1, &x, &y, &z));
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_vertex_exact(context, NULL, 0, &x, &y, &z));
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_vertex_exact(NULL, c, 0, &x, &y, &z));

    STATUS_IN(context, LAP_OK, lap_complex_cell_volume_exact(context, c, 0, &volume));
    CHECK(volume != NULL && atof(volume) > 0);
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_cell_volume_exact(context, c, 0, NULL));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_complex_cell_volume_exact(context, c, (int32_t)n_cells, &volume));
    CHECK(has_message(context));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_complex_cell_volume_exact(context, c, -1, &volume));
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_cell_volume_exact(context, NULL, 0, &volume));
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_cell_volume_exact(NULL, c, 0, &volume));
}

static void euler_and_check(lap_context *context, const lap_complex *c, int64_t expected)
{
    int64_t output = -99, input = -99;
    STATUS(LAP_OK, lap_complex_euler(c, &output, &input));
    CHECK(output == expected && input == expected);
    STATUS(LAP_OK, lap_complex_euler(c, NULL, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_euler(NULL, &output, &input));
    STATUS_IN(context, LAP_OK, lap_complex_check(context, c));
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_check(context, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_check(NULL, c));
}

/* The cube [0, 2]^3 along x = 1, y = 1, x = 1 again and reversed, its top z = 2, and z = 5 which misses it. */
static void cube(lap_context *context)
{
    const double planes[20] = {1, 0, 0, -1, 0, 1, 0, -1, -3, 0, 0, 3, 0, 0, 1, -2, 0, 0, 1, -5};
    lap_mesh *mesh = good_mesh(context, 8, cube_xyz, 12, cube_indices, cube_tags);
    lap_cut *cut = NULL;
    const lap_complex *c = NULL;
    const int32_t *kinds = NULL, *ids = NULL, *on_plane = NULL, *tags = NULL;
    const double *centroids = NULL, *volumes = NULL;
    const char *volume = NULL;
    int32_t i, side = 0;

    STATUS_IN(context, LAP_OK, lap_cut_new(context, mesh, 5, planes, NULL, &cut));
    STATUS(LAP_OK, lap_cut_complex(cut, &c));
    structure(c, 8, 5, 12);
    /* Corners; 12 edge points of the cube's edges and diagonals on each plane, less those that are common or at corners;
       what matters is that V - E + F - C is 1, which euler_and_check asks for. */
    CHECK(n_cells == 4 && n_shells == 4 && n_loops == n_faces);
    all_polygons(c);
    moments(c, 8);
    exact(context, c);
    euler_and_check(context, c, 1);

    STATUS(LAP_OK, lap_complex_face_supports(c, NULL, &kinds, &ids, &on_plane, &tags));
    for (i = 0; i < n_faces; ++i) {
        if (kinds[i] != LAP_SUPPORT_TRIANGLE) continue;
        CHECK(tags[i] == cube_tags[ids[i]]);
        /* Triangles 2 and 3 are the top, which plane 3 lies on. */
        CHECK(on_plane[i] == (ids[i] == 2 || ids[i] == 3 ? 3 : -1));
    }

    STATUS(LAP_OK, lap_complex_cell_moments(c, NULL, &volumes, &centroids, NULL));
    for (i = 0; i < 4; ++i) {
        const double x = centroids[3 * i], y = centroids[3 * i + 1];
        CHECK(volumes[i] == 2);
        STATUS(LAP_OK, lap_complex_cell_side(c, i, 0, &side));
        CHECK(side == (x > 1 ? 1 : -1));
        STATUS(LAP_OK, lap_complex_cell_side(c, i, 1, &side));
        CHECK(side == (y > 1 ? 1 : -1));
        STATUS(LAP_OK, lap_complex_cell_side(c, i, 2, &side));
        CHECK(side == (x > 1 ? -1 : 1));
        STATUS(LAP_OK, lap_complex_cell_side(c, i, 3, &side));
        CHECK(side == -1);
        STATUS(LAP_OK, lap_complex_cell_side(c, i, 4, &side));
        CHECK(side == -1);
        STATUS_IN(context, LAP_OK, lap_complex_cell_volume_exact(context, c, i, &volume));
        CHECK(strcmp(volume, "2") == 0);
    }
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_complex_cell_side(c, 4, 0, &side));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_complex_cell_side(c, -1, 0, &side));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_complex_cell_side(c, 0, 5, &side));
    STATUS(LAP_ERR_BAD_ARGUMENT, lap_complex_cell_side(c, 0, -1, &side));
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_cell_side(c, 0, 0, NULL));
    STATUS(LAP_ERR_NULL_POINTER, lap_complex_cell_side(NULL, 0, 0, &side));
    STATUS(LAP_OK, lap_cut_free(cut));
    STATUS(LAP_OK, lap_mesh_free(mesh));
}

/* A cube with a void: along z = 2 the section has a hole; along z = 1/2 the void stays whole, inside one cell. */
static void hollow(lap_context *context)
{
    const double through[4] = {0, 0, 1, -2}, below[4] = {0, 0, 2, -1};
    lap_mesh *mesh = good_mesh(context, 16, hollow_xyz, 24, hollow_indices, NULL);
    lap_cut *cut = NULL;
    const lap_complex *c = NULL;

    STATUS_IN(context, LAP_OK, lap_cut_new(context, mesh, 1, through, NULL, &cut));
    STATUS(LAP_OK, lap_cut_complex(cut, &c));
    structure(c, 16, 1, 24);
    CHECK(n_cells == 2 && n_shells == 2 && n_loops == n_faces + 1);
    all_polygons(c);
    moments(c, 56);
    exact(context, c);
    euler_and_check(context, c, 2);
    STATUS(LAP_OK, lap_cut_free(cut));

    STATUS_IN(context, LAP_OK, lap_cut_new(context, mesh, 1, below, NULL, &cut));
    STATUS(LAP_OK, lap_cut_complex(cut, &c));
    structure(c, 16, 1, 24);
    CHECK(n_cells == 2 && n_shells == 3 && n_loops == n_faces);
    all_polygons(c);
    moments(c, 56);
    exact(context, c);
    euler_and_check(context, c, 2);
    STATUS(LAP_OK, lap_cut_free(cut));
    STATUS(LAP_OK, lap_mesh_free(mesh));
}

void test_complex(void)
{
    lap_context *context = NULL;
    STATUS(LAP_OK, lap_context_new(&context));
    cube(context);
    hollow(context);
    STATUS(LAP_OK, lap_context_free(context));
}
