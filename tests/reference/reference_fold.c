/* Which cells of a map can be seen folded over within the light: section 10 of docs/numerics.md. */
#include "reference_fold.h"

#include <math.h>

/* Whether all of the light lies in front of the plane through a triangle's samples, which is nearer the light. */
static bool faces_light(const reference_map *map, const double *a, const double *b, const double *c)
{
    double gradient[2], along[2];
    const double du[2] = {b[0] - a[0], c[0] - a[0]}, dv[2] = {b[1] - a[1], c[1] - a[1]};
    const double dg[2] = {b[2] - a[2], c[2] - a[2]};
    const double determinant = du[0] * dv[1] - du[1] * dv[0];
    gradient[0] = (dg[0] * dv[1] - dg[1] * dv[0]) / determinant;
    gradient[1] = (du[0] * dg[1] - du[1] * dg[0]) / determinant;
    for (int i = 0; i < 2; ++i)
        along[i] = gradient[0] * map->a[0][i] + gradient[1] * map->a[1][i];
    /* How fast the plane rises along the steepest ray through `a` towards the light, over how fast the ray does. */
    const double centre =
        gradient[0] * (map->offset[0] - map->delta * a[0]) + gradient[1] * (map->offset[1] - map->delta * a[1]);
    const double widest = map->directional ? hypot(along[0], along[1]) : fabs(along[0]) + fabs(along[1]);
    return centre + widest < map->epsilon - map->delta * a[2];
}

bool reference_folds(const reference_map *map, const double *const corner[4])
{
    /* Either diagonal will do. */
    return !(faces_light(map, corner[0], corner[1], corner[2]) && faces_light(map, corner[0], corner[2], corner[3])) &&
           !(faces_light(map, corner[1], corner[2], corner[3]) && faces_light(map, corner[1], corner[3], corner[0]));
}
