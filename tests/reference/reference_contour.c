/* Contours of what occludes a receiver, extracted by marching squares: section 10 of docs/numerics.md, after section 4
 * of Yang et al., Packet-based Hierarchical Soft Shadow Mapping, 2009, and the contours of Guennebaud et al.,
 * High-Quality Adaptive Soft Shadow Mapping, 2007. Departures: a sample is compared with the receiver's plane instead
 * of its depth, and contours close at the border of the kernel and of the map. */
#include "reference_contour.h"
#include "reference_polygon.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const int32_t corner_x[4] = {0, 1, 1, 0}, corner_y[4] = {0, 0, 1, 1};

uint32_t reference_marching_squares(int32_t x, int32_t y, const bool occludes[4], reference_contour_edge edges[2])
{
    uint32_t count = 0;
    /* Each run of occluding corners is cut off by itself, so that occluders that touch at a corner stay apart. */
    for (int first = 0; first < 4; ++first) {
        int last = first;
        if (!occludes[first] || occludes[(first + 3) % 4])
            continue;
        while (occludes[(last + 1) % 4])
            last = (last + 1) % 4;
        /* The neighbour of corner k in the order of corners is on side k, the one before on side k + 1. */
        edges[count++] = (reference_contour_edge){
            {x + corner_x[last], y + corner_y[last], last},
            {x + corner_x[first], y + corner_y[first], (first + 1) % 4},
        };
    }
    return count;
}

typedef struct extraction {
    const reference_dual_grid *grid;
    const reference_map *map;
    const reference_settings *settings;
    const reference_receiver *receivers;
    uint32_t receiver_count;
    reference_rect range;
    reference_contour *contour;
    bool out_of_memory;
} extraction;

static bool in_range(const reference_rect *range, int32_t x, int32_t y)
{
    return x >= range->x0 && x <= range->x1 && y >= range->y0 && y <= range->y1;
}

/* The three-valued status of a sample for a packet: MIXED is the paper's null. */
static reference_status sample_status(const extraction *e, int32_t x, int32_t y)
{
    uint32_t occluded = 0;
    if (!in_range(&e->range, x, y))
        return REFERENCE_FREE;
    for (uint32_t i = 0; i < e->receiver_count; ++i)
        occluded += reference_occludes(e->map, e->settings, &e->receivers[i], reference_dual_grid_place(e->grid, x, y));
    return occluded == 0 ? REFERENCE_FREE : occluded == e->receiver_count ? REFERENCE_FULL : REFERENCE_MIXED;
}

/* Cases 4 and 5 of the paper's figure 6, for every receiver of the packet. */
static bool has_no_contour(void *user, uint32_t level, int32_t x, int32_t y)
{
    const extraction *const e = user;
    const int32_t span = (int32_t)1 << level;
    bool all_free = true, all_full = in_range(&e->range, x, y) && in_range(&e->range, x + span, y + span);
    double low[3], high[3];
    reference_dual_grid_bounds(e->grid, level, x, y, low, high);
    for (uint32_t i = 0; i < e->receiver_count; ++i) {
        const reference_status status = reference_block_status(e->map, e->settings, &e->receivers[i], low, high);
        all_free = all_free && status == REFERENCE_FREE;
        all_full = all_full && status == REFERENCE_FULL;
    }
    return all_free || all_full;
}

static bool add_cell(void *user, int32_t x, int32_t y)
{
    extraction *const e = user;
    reference_contour *const contour = e->contour;
    reference_contour_edge edges[2];
    bool occludes[4];
    for (int k = 0; k < 4; ++k) {
        const reference_status status = sample_status(e, x + corner_x[k], y + corner_y[k]);
        contour->diverged = contour->diverged || status == REFERENCE_MIXED;
        occludes[k] = status == REFERENCE_FULL;
    }
    if (contour->diverged)
        return false;
    const uint32_t count = reference_marching_squares(x, y, occludes, edges);
    if (contour->count + count > contour->capacity) {
        const size_t capacity = 2 * contour->capacity + 64;
        reference_contour_edge *grown = realloc(contour->edges, capacity * sizeof(*grown));
        if (!grown) {
            e->out_of_memory = true;
            return false;
        }
        contour->edges = grown;
        contour->capacity = capacity;
    }
    for (uint32_t i = 0; i < count; ++i)
        contour->edges[contour->count++] = edges[i];
    return true;
}

bool reference_contour_extract(const reference_dual_grid *grid, const reference_map *map,
                               const reference_settings *settings, const reference_receiver *receivers, uint32_t count,
                               reference_rect range, reference_extraction method, const int32_t *start,
                               reference_contour *contour)
{
    extraction e = {.grid = grid,
                    .map = map,
                    .settings = settings,
                    .receivers = receivers,
                    .receiver_count = count,
                    .range = range,
                    .contour = contour};
    /* Also the cells around the range, where its contours close. */
    const reference_rect cells = {range.x0 - 1, range.y0 - 1, range.x1, range.y1};
    contour->count = 0;
    contour->diverged = false;
    memset(&contour->walk, 0, sizeof(contour->walk));
    if (method == REFERENCE_EXTRACT_WALK) {
        reference_dual_grid_walk(cells, start, has_no_contour, add_cell, &e, &contour->walk);
        return !e.out_of_memory;
    }
    for (int32_t y = cells.y0; y <= cells.y1; ++y) {
        for (int32_t x = cells.x0; x <= cells.x1; ++x) {
            ++contour->walk.cells;
            if (!add_cell(&e, x, y))
                return !e.out_of_memory;
        }
    }
    return true;
}

void reference_contour_free(reference_contour *contour)
{
    free(contour->edges);
    memset(contour, 0, sizeof(*contour));
}

/* Half a spacing from the occluder's place towards the neighbour, at the occluder's depth. */
static void vertex_place(const reference_dual_grid *grid, const reference_contour_vertex *vertex, double place[3])
{
    memcpy(place, reference_dual_grid_place(grid, vertex->x, vertex->y), 3 * sizeof(*place));
    place[vertex->side % 2] += (vertex->side < 2 ? 0.5 : -0.5) * grid->spacing;
}

void reference_contour_occlusion(const reference_dual_grid *grid, const reference_map *map,
                                 const reference_settings *settings, const reference_receiver *receiver,
                                 const reference_contour *contour, reference_occlusion *out)
{
    const double raised[3] = {receiver->uvg[0], receiver->uvg[1], reference_raised_g(map, settings, receiver)};
    reference_polygons polygons;
    reference_polygons_begin(&polygons, map, settings->pattern);
    for (size_t i = 0; i < contour->count; ++i) {
        double place[2][3], q[2][2];
        for (int end = 0; end < 2; ++end) {
            vertex_place(grid, end ? &contour->edges[i].to : &contour->edges[i].from, place[end]);
            reference_map_backproject(map, raised, place[end], q[end]);
        }
        reference_polygons_add(&polygons, q[0], q[1]);
    }
    reference_polygons_end(&polygons, out);
}

bool reference_contour_packet(const reference_dual_grid *grid, const reference_map *map,
                              const reference_settings *settings, const reference_receiver *receivers,
                              const reference_rect *ranges, uint32_t count, reference_walk *walk, bool *diverged,
                              reference_occlusion *out)
{
    reference_contour contour = {0};
    reference_walk visited = {0};
    reference_rect all = ranges[0];
    for (uint32_t i = 1; i < count; ++i)
        all = reference_rect_union(all, ranges[i]);
    bool success =
        reference_contour_extract(grid, map, settings, receivers, count, all, REFERENCE_EXTRACT_WALK, NULL, &contour);
    visited = contour.walk;
    const bool together = !contour.diverged;
    for (uint32_t i = 0; success && i < count; ++i) {
        if (!together) {
            success = reference_contour_extract(grid, map, settings, &receivers[i], 1, ranges[i],
                                                REFERENCE_EXTRACT_WALK, NULL, &contour);
            visited.nodes += contour.walk.nodes;
            visited.cells += contour.walk.cells;
            if (contour.walk.stack_depth > visited.stack_depth)
                visited.stack_depth = contour.walk.stack_depth;
        }
        reference_contour_occlusion(grid, map, settings, &receivers[i], &contour, &out[i]);
    }
    reference_contour_free(&contour);
    if (walk)
        *walk = visited;
    if (diverged)
        *diverged = !together;
    return success;
}

bool reference_contour_area(const reference_dual_grid *grid, const reference_map *map,
                            const reference_settings *settings, const reference_receiver *receiver, double *area)
{
    const reference_rect all = {0, 0, (int32_t)grid->columns - 1, (int32_t)grid->rows - 1};
    reference_contour contour = {0};
    reference_occlusion occlusion;
    const bool success =
        reference_contour_extract(grid, map, settings, receiver, 1, all, REFERENCE_EXTRACT_WALK, NULL, &contour);
    reference_contour_occlusion(grid, map, settings, receiver, &contour, &occlusion);
    reference_contour_free(&contour);
    *area = fmin(fmax(occlusion.area, 0.0), 1.0);
    return success;
}

bool reference_contour_visibility(const reference_dual_grid *grids, uint32_t layer_count, const reference_map *map,
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
        occlusion = settings->merge == SOFTSH_MERGE_MAXIMUM ? fmax(occlusion, area) : fmin(occlusion + area, 1.0);
    }
    *visibility = reference_visible(receiver, occlusion);
    return success;
}
