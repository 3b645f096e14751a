/* Fold-safe contours: section 10 of docs/numerics.md. The papers' contours follow the border of what occludes and lose
 * an occluder in front of another. Here every edge of a microquad is in the outline unless the quad beyond it takes the
 * same edge away again, and quads that may turn their back to the receiver are left out of the sum. */
#include "reference_outline.h"
#include "reference_polygon.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const int32_t corner_x[4] = {0, 1, 1, 0}, corner_y[4] = {0, 0, 1, 1};

/* What a cell holds for the receivers. */
typedef enum cell_kind { cell_empty, cell_smooth, cell_bridge, cell_diverged } cell_kind;

typedef struct extraction {
    const reference_dual_grid *grid;
    const reference_map *map;
    const reference_settings *settings;
    const reference_receiver *receivers;
    uint32_t receiver_count;
    reference_rect range;
    reference_outline *outline;
    bool out_of_memory;
} extraction;

static bool in_range(const extraction *e, int32_t x, int32_t y)
{
    return x >= e->range.x0 && x < e->range.x1 && y >= e->range.y0 && y < e->range.y1;
}

/* A quad is there if all four samples occlude. */
static cell_kind kind_of(const extraction *e, int32_t x, int32_t y)
{
    uint32_t occluded = 0;
    if (!in_range(e, x, y))
        return cell_empty;
    for (uint32_t i = 0; i < e->receiver_count; ++i) {
        bool all = true;
        for (int k = 0; k < 4; ++k)
            all = all && reference_occludes(e->map, e->settings, &e->receivers[i],
                                            reference_dual_grid_place(e->grid, x + corner_x[k], y + corner_y[k]));
        occluded += all;
    }
    if (occluded != 0 && occluded != e->receiver_count)
        return cell_diverged;
    if (occluded == 0)
        return cell_empty;
    return reference_dual_grid_node(e->grid, 0, x, y)->folds ? cell_bridge : cell_smooth;
}

static bool has_no_outline(void *user, uint32_t level, int32_t x, int32_t y)
{
    const extraction *const e = user;
    const int32_t span = (int32_t)1 << level;
    /* Nothing but smooth quads in it: their edges are all shared, or given by the cell beyond. */
    bool all_full = in_range(e, x, y) && in_range(e, x + span - 1, y + span - 1) &&
                    !reference_dual_grid_node(e->grid, level, x, y)->folds;
    bool all_free = true;
    double low[3], high[3];
    reference_dual_grid_bounds(e->grid, level, x, y, low, high);
    for (uint32_t i = 0; i < e->receiver_count; ++i) {
        const reference_status status = reference_block_status(e->map, e->settings, &e->receivers[i], low, high);
        all_free = all_free && status == REFERENCE_FREE;
        all_full = all_full && status == REFERENCE_FULL;
    }
    return all_free || all_full;
}

/* Room for one more; false for want of memory. */
static bool reserve(void **items, size_t count, size_t *capacity, size_t size)
{
    if (count < *capacity)
        return true;
    void *const grown = realloc(*items, (2 * *capacity + 64) * size);
    if (!grown)
        return false;
    *items = grown;
    *capacity = 2 * *capacity + 64;
    return true;
}

/* A cell without a smooth quad gives the edges it shares with smooth quads. */
static bool add_cell(void *user, int32_t x, int32_t y)
{
    extraction *const e = user;
    reference_outline *const outline = e->outline;
    const cell_kind kind = kind_of(e, x, y);
    outline->diverged = outline->diverged || kind == cell_diverged;
    if (kind == cell_bridge) {
        if (!reserve((void **)&outline->bridges, outline->bridge_count, &outline->bridge_capacity,
                     sizeof(*outline->bridges))) {
            e->out_of_memory = true;
            return false;
        }
        int32_t *const bridge = outline->bridges[outline->bridge_count++];
        bridge[0] = x;
        bridge[1] = y;
    }
    for (int side = 0; kind != cell_smooth && side < 4; ++side) {
        static const int32_t beyond[4][2] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}};
        const int next = (side + 1) % 4;
        const cell_kind neighbour = kind_of(e, x + beyond[side][0], y + beyond[side][1]);
        outline->diverged = outline->diverged || neighbour == cell_diverged;
        if (neighbour != cell_smooth)
            continue;
        if (!reserve((void **)&outline->edges, outline->edge_count, &outline->edge_capacity, sizeof(*outline->edges))) {
            e->out_of_memory = true;
            return false;
        }
        outline->edges[outline->edge_count++] = (reference_outline_edge){
            {x + corner_x[next], y + corner_y[next]},
            {x + corner_x[side], y + corner_y[side]},
        };
    }
    return !outline->diverged;
}

bool reference_outline_extract(const reference_dual_grid *grid, const reference_map *map,
                               const reference_settings *settings, const reference_receiver *receivers, uint32_t count,
                               reference_rect range, reference_extraction method, const int32_t *start,
                               reference_outline *outline)
{
    extraction e = {.grid = grid,
                    .map = map,
                    .settings = settings,
                    .receivers = receivers,
                    .receiver_count = count,
                    .range = range,
                    .outline = outline};
    /* Also the cells around the quads, which give their outer edges. */
    const reference_rect cells = {range.x0 - 1, range.y0 - 1, range.x1, range.y1};
    outline->edge_count = outline->bridge_count = 0;
    outline->diverged = false;
    memset(&outline->walk, 0, sizeof(outline->walk));
    if (method == REFERENCE_EXTRACT_WALK) {
        reference_dual_grid_walk(cells, start, has_no_outline, add_cell, &e, &outline->walk);
        return !e.out_of_memory;
    }
    for (int32_t y = cells.y0; y <= cells.y1; ++y) {
        for (int32_t x = cells.x0; x <= cells.x1; ++x) {
            ++outline->walk.cells;
            if (!add_cell(&e, x, y))
                return !e.out_of_memory;
        }
    }
    return true;
}

void reference_outline_free(reference_outline *outline)
{
    free(outline->edges);
    free(outline->bridges);
    memset(outline, 0, sizeof(*outline));
}

void reference_outline_occlusion(const reference_dual_grid *grid, const reference_map *map,
                                 const reference_settings *settings, const reference_receiver *receiver,
                                 const reference_outline *outline, reference_occlusion *out)
{
    const double raised[3] = {receiver->uvg[0], receiver->uvg[1], reference_raised_g(map, settings, receiver)};
    const double side = reference_area_side(map);
    reference_polygons polygons;
    reference_polygons_begin(&polygons, map, settings->pattern);
    for (size_t i = 0; i < outline->edge_count; ++i) {
        const reference_outline_edge *const edge = &outline->edges[i];
        double q[2][2];
        reference_map_backproject(map, raised, reference_dual_grid_place(grid, edge->from[0], edge->from[1]), q[0]);
        reference_map_backproject(map, raised, reference_dual_grid_place(grid, edge->to[0], edge->to[1]), q[1]);
        reference_polygons_add(&polygons, q[0], q[1]);
    }
    reference_polygons_end(&polygons, out);
    for (size_t i = 0; i < outline->bridge_count; ++i) {
        double q[4][2], area = 0.0;
        for (int k = 0; k < 4; ++k)
            reference_map_backproject(map, raised,
                                      reference_dual_grid_place(grid, outline->bridges[i][0] + corner_x[k],
                                                                outline->bridges[i][1] + corner_y[k]),
                                      q[k]);
        reference_cover_quad(settings->pattern, q, out);
        for (int k = 0; k < 4; ++k)
            area += reference_edge_area(q[k], q[(k + 1) % 4], side);
        out->area += fabs(area) / (4.0 * side * side);
    }
    reference_count(map, settings->pattern, out);
}
