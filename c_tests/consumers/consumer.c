/* The smallest host: cuts a tetrahedron by one plane and counts the cells. Exit status 0: as expected. */
#include <lapidary.h>
#include <stdio.h>

int main(void)
{
    const double xyz[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const int32_t triangles[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    const double plane[] = {1, 1, 1, -0.5};
    lap_context *context = NULL;
    lap_mesh *mesh = NULL;
    lap_cut *cut = NULL;
    const lap_complex *complex = NULL;
    const char *version = "", *message = "";
    int64_t cells = 0;

    int32_t status = lap_version(NULL, NULL, NULL, &version);
    if (status == LAP_OK) status = lap_context_new(&context);
    if (status == LAP_OK) status = lap_mesh_new(context, 4, xyz, 4, triangles, NULL, NULL, &mesh);
    if (status == LAP_OK) status = lap_cut_new(context, mesh, 1, plane, NULL, &cut);
    if (status == LAP_OK) status = lap_cut_complex(cut, &complex);
    if (status == LAP_OK) status = lap_complex_counts(complex, NULL, NULL, NULL, &cells, NULL, NULL, NULL);
    if (status != LAP_OK && context != NULL) lap_context_last_error(context, NULL, &message);
    printf("lapidary %s: status %d, %lld cells %s\n", version, (int)status, (long long)cells, message);
    lap_cut_free(cut);
    lap_mesh_free(mesh);
    lap_context_free(context);
    return status == LAP_OK && cells == 2 ? 0 : 1;
}
