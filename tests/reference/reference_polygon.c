/* What directed straight edges on the light contribute: sections 5 and 10 of docs/numerics.md. Area by clamped
 * trapezoids: unlike the radial integration of the papers it has no arctangent, no branch cut, and no special case at
 * the light's centre. */
#include "reference_polygon.h"
#include "reference_visibility.h"

#include <math.h>
#include <string.h>

bool reference_crosses(const double a[2], const double b[2], double y, double *x)
{
    const double *const low = a[1] > b[1] ? b : a, *const high = a[1] > b[1] ? a : b;
    if (!(low[1] <= y && y < high[1]))
        return false;
    *x = low[0] + (y - low[1]) * (high[0] - low[0]) / (high[1] - low[1]);
    return true;
}

static double clamp(double x, double limit)
{
    return fmin(fmax(x, -limit), limit);
}

/* Mean of clamp(x) for x from x0 to x1 in even steps. */
static double mean_clamped(double x0, double x1, double limit)
{
    const double low = fmin(x0, x1), high = fmax(x0, x1);
    const double inside0 = clamp(low, limit), inside1 = clamp(high, limit);
    if (!(inside1 > inside0))
        return inside0;
    /* Three pieces: beyond one side, inside, beyond the other. */
    return ((inside0 - low) * -limit + (inside1 - inside0) * 0.5 * (inside0 + inside1) + (high - inside1) * limit) /
           (high - low);
}

double reference_edge_area(const double a[2], const double b[2], double limit)
{
    const double y0 = clamp(a[1], limit), y1 = clamp(b[1], limit);
    if (!(fabs(y1 - y0) > 0.0))
        return 0.0;
    const double slope = (b[0] - a[0]) / (b[1] - a[1]);
    return (y1 - y0) * (limit + mean_clamped(a[0] + (y0 - a[1]) * slope, a[0] + (y1 - a[1]) * slope, limit));
}

void reference_polygons_begin(reference_polygons *polygons, const reference_map *map, softsh_pattern pattern)
{
    memset(polygons, 0, sizeof(*polygons));
    polygons->map = map;
    polygons->pattern = pattern;
}

void reference_polygons_add(reference_polygons *polygons, const double a[2], const double b[2])
{
    const uint32_t n = reference_pattern_size(polygons->pattern);
    double from[2], to[2];
    for (int axis = 0; axis < 2; ++axis) {
        from[axis] = reference_to_sample(polygons->pattern, a[axis]);
        to[axis] = reference_to_sample(polygons->pattern, b[axis]);
    }
    const int32_t turn = from[1] < to[1] ? 1 : -1;
    for (uint32_t j = 0; j < n; ++j) {
        for (uint32_t i = 0; i < n; ++i) {
            double xy[2], crossing;
            reference_pattern_sample(polygons->pattern, i, j, xy);
            if (reference_crosses(from, to, xy[1], &crossing) && crossing > xy[0])
                polygons->winding[j * n + i] += turn;
        }
    }
    polygons->area += reference_edge_area(a, b, reference_area_side(polygons->map));
}

void reference_polygons_end(const reference_polygons *polygons, reference_occlusion *out)
{
    const reference_map *const map = polygons->map;
    const uint32_t n = reference_pattern_size(polygons->pattern);
    const double side = reference_area_side(map);
    const double determinant = map->a[0][0] * map->a[1][1] - map->a[0][1] * map->a[1][0];
    memset(out, 0, sizeof(*out));
    for (uint32_t bit = 0; bit < n * n; ++bit)
        if (polygons->winding[bit] != 0)
            out->mask[bit / 32] |= 1u << bit % 32;
    /* Mirrored axes turn polygons the other way. */
    out->area = (determinant < 0.0 ? -1.0 : 1.0) * polygons->area / (4.0 * side * side);
    reference_count(map, polygons->pattern, out);
}
