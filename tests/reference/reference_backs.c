/* Contours, and what a surface hides where the receiver sees its back: section 10 of docs/numerics.md. No paper has
 * that. */
#include "reference_backs.h"
#include "reference_polygon.h"

#include <math.h>

static const int32_t corner_x[4] = {0, 1, 1, 0}, corner_y[4] = {0, 0, 1, 1};

bool reference_seen_from_behind(const reference_dual_grid *grid, const reference_map *map,
                                const reference_settings *settings, const reference_receiver *receiver, int32_t x,
                                int32_t y)
{
    const double *const first = reference_dual_grid_place(grid, 0, 0);
    double g[4];
    for (int k = 0; k < 4; ++k)
        g[k] = reference_dual_grid_place(grid, x + corner_x[k], y + corner_y[k])[2];
    const double du = 0.5 * (g[1] - g[0] + g[2] - g[3]), dv = 0.5 * (g[3] - g[0] + g[2] - g[1]);
    const double u = (receiver->uvg[0] - first[0]) / grid->spacing - (x + 0.5);
    const double v = (receiver->uvg[1] - first[1]) / grid->spacing - (y + 0.5);
    return 0.25 * (g[0] + g[1] + g[2] + g[3]) + du * u + dv * v <= reference_raised_g(map, settings, receiver);
}

double reference_backs_area(const reference_dual_grid *grid, const reference_map *map,
                            const reference_settings *settings, const reference_receiver *receiver)
{
    const double raised[3] = {receiver->uvg[0], receiver->uvg[1], reference_raised_g(map, settings, receiver)};
    reference_polygons polygons;
    reference_occlusion out;
    reference_polygons_begin(&polygons, map, SOFTSH_PATTERN_8X8);
    for (int32_t y = 0; y + 1 < (int32_t)grid->rows; ++y)
        for (int32_t x = 0; x + 1 < (int32_t)grid->columns; ++x) {
            bool back = reference_dual_grid_node(grid, 0, x, y)->folds;
            double q[4][2];
            for (int k = 0; k < 4 && back; ++k) {
                const double *const place = reference_dual_grid_place(grid, x + corner_x[k], y + corner_y[k]);
                back = reference_occludes(map, settings, receiver, place);
                if (back)
                    reference_map_backproject(map, raised, place, q[k]);
            }
            if (!back || !reference_seen_from_behind(grid, map, settings, receiver, x, y))
                continue;
            for (int k = 0; k < 4; ++k)
                reference_polygons_add(&polygons, q[(k + 1) % 4], q[k]);
        }
    reference_polygons_end(&polygons, &out);
    return out.area;
}

bool reference_backs_visibility(const reference_dual_grid *grids, uint32_t layer_count, const reference_map *map,
                                const reference_settings *settings, const reference_receiver *receiver,
                                double *visibility)
{
    reference_settings flat = *settings;
    double occlusion = 0.0;
    bool success = true;
    *visibility = receiver->state == REFERENCE_RECEIVER_AWAY ? 0.0 : 1.0;
    if (receiver->state != REFERENCE_RECEIVER_ACTIVE)
        return true;
    flat.primitive = SOFTSH_PRIMITIVE_MICROPATCH; /* the band around the receiver's plane */
    for (uint32_t i = 0; i < layer_count && success; ++i) {
        double area;
        success = reference_contour_area(&grids[i], map, &flat, receiver, &area);
        if (i + 1 == layer_count) {
            const double back = reference_backs_area(&grids[i], map, &flat, receiver);
            area += fmin(fmax(back, 0.0), 1.0) * (1.0 - area) * (1.0 - area);
        }
        occlusion = settings->merge == SOFTSH_MERGE_MAXIMUM ? fmax(occlusion, area) : fmin(occlusion + area, 1.0);
    }
    *visibility = reference_visible(receiver, occlusion);
    return success;
}
