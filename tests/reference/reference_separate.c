/* Contours of surfaces cut apart where they are not one: section 10 of docs/numerics.md. No paper has them; what is cut
 * where comes from measurements of what one map can tell. */
#include "reference_separate.h"
#include "reference_polygon.h"

#include <math.h>
#include <string.h>

static const int32_t corner_x[4] = {0, 1, 1, 0}, corner_y[4] = {0, 0, 1, 1};

static int32_t clamp_index(int32_t i, uint32_t count)
{
    return i < 0 ? 0 : i >= (int32_t)count ? (int32_t)count - 1 : i;
}

static const double *sample(const reference_dual_grid *grid, int32_t x, int32_t y)
{
    return reference_dual_grid_place(grid, clamp_index(x, grid->columns), clamp_index(y, grid->rows));
}

bool reference_is_cut(const reference_dual_grid *grid, const reference_map *map, const reference_settings *settings,
                      const reference_receiver *receiver, softsh_reconstruction reconstruction, int32_t x, int32_t y,
                      int axis)
{
    const int32_t dx = axis == 0, dy = axis == 1;
    const double *const a = sample(grid, x, y), *const b = sample(grid, x + dx, y + dy);
    if (reconstruction == SOFTSH_RECONSTRUCTION_FOLDS) {
        const double raised = reference_raised_g(map, settings, receiver);
        const double ka = 1.0 / (a[2] - raised), kb = 1.0 / (b[2] - raised), from = receiver->uvg[axis];
        return (b[axis] - from) * kb - (a[axis] - from) * ka <= -grid->spacing * fmax(ka, kb);
    }
    const double step = b[2] - a[2], before = a[2] - sample(grid, x - dx, y - dy)[2],
                 after = sample(grid, x + 2 * dx, y + 2 * dy)[2] - b[2];
    const double reach = fabs(map->a[axis][0]) + fabs(map->a[axis][1]);
    const bool steep = fabs(step) * reach >= grid->spacing * (map->epsilon - map->delta * fmax(a[2], b[2]));
    return steep && fmin(fabs(step - before), fabs(step - after)) > 0.5 * fabs(step);
}

static bool folds(const reference_dual_grid *grid, int32_t x, int32_t y)
{
    return x >= 0 && y >= 0 && x < (int32_t)grid->columns && y < (int32_t)grid->rows &&
           reference_dual_grid_node(grid, 0, x, y)->folds;
}

/* Half a step from an occluding corner of a cell towards another corner, at its own depth, on the light. */
static void project(const reference_dual_grid *grid, const reference_map *map, const double raised[3], int32_t x,
                    int32_t y, int corner, int towards, double q[2])
{
    double place[3];
    memcpy(place, sample(grid, x + corner_x[corner], y + corner_y[corner]), sizeof place);
    place[0] += 0.5 * grid->spacing * (corner_x[towards] - corner_x[corner]);
    place[1] += 0.5 * grid->spacing * (corner_y[towards] - corner_y[corner]);
    reference_map_backproject(map, raised, place, q);
}

void reference_separate_layer(const reference_dual_grid *grid, const reference_map *map,
                              const reference_settings *settings, const reference_receiver *receiver,
                              softsh_reconstruction reconstruction, reference_separate *out)
{
    const double raised[3] = {receiver->uvg[0], receiver->uvg[1], reference_raised_g(map, settings, receiver)};
    const double turn = map->a[0][0] * map->a[1][1] - map->a[0][1] * map->a[1][0] < 0.0 ? -1.0 : 1.0;
    reference_polygons polygons;
    reference_occlusion occlusion;
    memset(out, 0, sizeof *out);
    reference_polygons_begin(&polygons, map, SOFTSH_PATTERN_16X16_JITTERED);
    for (int32_t y = -1; y < (int32_t)grid->rows; ++y)
        for (int32_t x = -1; x < (int32_t)grid->columns; ++x) {
            bool occludes[4], joined[4];
            for (int k = 0; k < 4; ++k) {
                const int32_t i = x + corner_x[k], j = y + corner_y[k];
                occludes[k] = i >= 0 && j >= 0 && i < (int32_t)grid->columns && j < (int32_t)grid->rows &&
                              reference_occludes(map, settings, receiver, sample(grid, i, j));
            }
            for (int k = 0; k < 4; ++k) {
                const int next = (k + 1) % 4, lower = k == 1 ? 1 : k == 2 ? 3 : 0;
                const int32_t over_x = k == 1 ? 1 : k == 3 ? -1 : 0, over_y = k == 0 ? -1 : k == 2 ? 1 : 0;
                const bool may = folds(grid, x, y) && folds(grid, x + over_x, y + over_y);
                joined[k] = occludes[k] && occludes[next] &&
                            !(may && reference_is_cut(grid, map, settings, receiver, reconstruction,
                                                      x + corner_x[lower], y + corner_y[lower], k % 2));
            }
            for (int first = 0; first < 4; ++first) {
                int last = first;
                double from[2], to[2];
                if (!occludes[first] || joined[(first + 3) % 4])
                    continue;
                while (joined[last])
                    last = (last + 1) % 4;
                project(grid, map, raised, x, y, last, (last + 1) % 4, from);
                project(grid, map, raised, x, y, first, (first + 3) % 4, to);
                reference_polygons_add(&polygons, from, to);
                ++out->edges;
            }
        }
    reference_polygons_end(&polygons, &occlusion);
    out->area = occlusion.area;
    for (int i = 0; i < 256; ++i) {
        const double winding = turn * polygons.winding[i];
        out->covered[i] = winding > 0.0;
        out->windings += winding > 0.0 ? (uint64_t)winding : 0;
    }
}

double reference_separate_visibility(const reference_dual_grid *grids, uint32_t layer_count, const reference_map *map,
                                     const reference_settings *settings, const reference_receiver *receiver,
                                     softsh_reconstruction reconstruction)
{
    reference_settings flat = *settings;
    bool covered[256] = {false};
    double occlusion = 0.0;
    if (receiver->state != REFERENCE_RECEIVER_ACTIVE)
        return receiver->state == REFERENCE_RECEIVER_AWAY ? 0.0 : 1.0;
    flat.primitive = SOFTSH_PRIMITIVE_MICROPATCH; /* the band around the receiver's plane */
    for (uint32_t layer = 0; layer < layer_count; ++layer) {
        const bool maximum = settings->merge == SOFTSH_MERGE_MAXIMUM;
        reference_separate s;
        uint32_t count = 0;
        reference_separate_layer(&grids[layer], map, &flat, receiver, reconstruction, &s);
        for (int i = 0; i < 256; ++i) {
            count += s.covered[i] && (maximum || !covered[i]);
            covered[i] = covered[i] || s.covered[i];
        }
        const double share = s.windings > 0 ? (double)count / (double)s.windings : 1.0;
        const double hidden = fmin(fmax(s.area * share, 0.0), 1.0);
        occlusion = maximum ? fmax(occlusion, hidden) : fmin(occlusion + hidden, 1.0);
    }
    return reference_visible(receiver, occlusion);
}
