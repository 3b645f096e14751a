/* Ranges over the dual grid of a level's samples, and the walk over it: section 10 of docs/numerics.md, after
 * section 4.2 of Yang et al., Packet-based Hierarchical Soft Shadow Mapping, 2009. Unlike the paper's, windows begin at
 * their node's cell instead of being centred, so that a node's children tile it, and there are cells beyond the map's
 * border, where contours close. */
#include "reference_dual_grid.h"
#include "reference_fold.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { max_levels = 31 };

static size_t cell_columns(const reference_dual_grid *grid)
{
    return (size_t)grid->columns + 1;
}

static reference_node *node_at(const reference_dual_grid *grid, uint32_t level, int32_t x, int32_t y)
{
    const size_t level_size = cell_columns(grid) * ((size_t)grid->rows + 1);
    return &grid->nodes[level * level_size + (size_t)(y + 1) * cell_columns(grid) + (size_t)(x + 1)];
}

const reference_node *reference_dual_grid_node(const reference_dual_grid *grid, uint32_t level, int32_t x, int32_t y)
{
    return node_at(grid, level, x, y);
}

const double *reference_dual_grid_place(const reference_dual_grid *grid, int32_t x, int32_t y)
{
    return grid->place[(size_t)y * grid->columns + (size_t)x];
}

static bool in_map(const reference_dual_grid *grid, int32_t x, int32_t y)
{
    return x >= 0 && y >= 0 && x < (int32_t)grid->columns && y < (int32_t)grid->rows;
}

static reference_node derive_cell(const reference_dual_grid *grid, const reference_map *map, int32_t x, int32_t y)
{
    reference_node node = {INFINITY, -INFINITY, false};
    const double *corner[4];
    bool whole = true;
    for (int k = 0; k < 4; ++k) {
        const int32_t i = x + (k == 1 || k == 2), j = y + (k >= 2);
        corner[k] = in_map(grid, i, j) ? reference_dual_grid_place(grid, i, j) : NULL;
        whole = whole && corner[k];
        if (corner[k]) {
            node.min = fmin(node.min, corner[k][2]);
            node.max = fmax(node.max, corner[k][2]);
        }
    }
    node.folds = whole && reference_folds(map, corner);
    return node;
}

static reference_node join_children(const reference_dual_grid *grid, uint32_t level, int32_t x, int32_t y)
{
    reference_node node = {INFINITY, -INFINITY, false};
    for (int k = 0; k < 4; ++k) {
        const int32_t half = (int32_t)1 << (level - 1), i = x + (k & 1) * half, j = y + (k >> 1) * half;
        if (i >= (int32_t)grid->columns || j >= (int32_t)grid->rows)
            continue;
        const reference_node *child = node_at(grid, level - 1, i, j);
        node.min = fmin(node.min, child->min);
        node.max = fmax(node.max, child->max);
        node.folds = node.folds || child->folds;
    }
    return node;
}

bool reference_dual_grid_create(reference_dual_grid *grid, const reference_map *map, const reference_settings *settings,
                                const float *g)
{
    const uint32_t spacing = 1u << settings->level;
    memset(grid, 0, sizeof(*grid));
    grid->spacing = spacing;
    grid->columns = (map->width + spacing - 1) / spacing;
    grid->rows = (map->height + spacing - 1) / spacing;
    const uint32_t side = (grid->columns > grid->rows ? grid->columns : grid->rows) + 1;
    grid->level_count = 1;
    while (side > (uint32_t)1 << (grid->level_count - 1))
        ++grid->level_count;
    grid->place = calloc((size_t)grid->columns * grid->rows, sizeof(*grid->place));
    grid->nodes = calloc(grid->level_count * cell_columns(grid) * ((size_t)grid->rows + 1), sizeof(*grid->nodes));
    if (!grid->place || !grid->nodes) {
        reference_dual_grid_destroy(grid);
        return false;
    }
    for (uint32_t y = 0; y < grid->rows; ++y)
        for (uint32_t x = 0; x < grid->columns; ++x)
            reference_level_sample(map, settings, g, x, y, grid->place[(size_t)y * grid->columns + x]);
    for (uint32_t level = 0; level < grid->level_count; ++level)
        for (int32_t y = -1; y < (int32_t)grid->rows; ++y)
            for (int32_t x = -1; x < (int32_t)grid->columns; ++x)
                *node_at(grid, level, x, y) =
                    level == 0 ? derive_cell(grid, map, x, y) : join_children(grid, level, x, y);
    return true;
}

void reference_dual_grid_destroy(reference_dual_grid *grid)
{
    free(grid->place);
    free(grid->nodes);
    memset(grid, 0, sizeof(*grid));
}

static int32_t clamp_index(int64_t i, uint32_t count)
{
    return (int32_t)(i < 0 ? 0 : i >= (int64_t)count ? (int64_t)count - 1 : i);
}

void reference_dual_grid_bounds(const reference_dual_grid *grid, uint32_t level, int32_t x, int32_t y, double low[3],
                                double high[3])
{
    const int64_t span = (int64_t)1 << level;
    const double *const first =
        reference_dual_grid_place(grid, clamp_index(x, grid->columns), clamp_index(y, grid->rows));
    const double *const last =
        reference_dual_grid_place(grid, clamp_index(x + span, grid->columns), clamp_index(y + span, grid->rows));
    const reference_node *const node = node_at(grid, level, x, y);
    for (int axis = 0; axis < 2; ++axis) {
        low[axis] = first[axis];
        high[axis] = last[axis];
    }
    low[2] = node->min;
    high[2] = node->max;
}

reference_rect reference_dual_grid_kernel(const reference_dual_grid *grid, const reference_map *map,
                                          const reference_settings *settings, const reference_receiver *receiver,
                                          double g_hi)
{
    double box[4];
    const double raised[3] = {receiver->uvg[0], receiver->uvg[1], reference_raised_g(map, settings, receiver)};
    reference_map_kernel(map, raised, fmax(g_hi, raised[2]), box);
    const uint32_t count[2] = {grid->columns, grid->rows};
    int32_t first[2], last[2];
    for (int axis = 0; axis < 2; ++axis) {
        /* The last sample not after the kernel's beginning, the first not before its end. */
        first[axis] = 0;
        last[axis] = (int32_t)count[axis] - 1;
        for (int32_t i = 0; i < (int32_t)count[axis]; ++i) {
            if (reference_dual_grid_place(grid, axis ? 0 : i, axis ? i : 0)[axis] <= box[axis])
                first[axis] = i;
            const int32_t j = (int32_t)count[axis] - 1 - i;
            if (reference_dual_grid_place(grid, axis ? 0 : j, axis ? j : 0)[axis] >= box[2 + axis])
                last[axis] = j;
        }
    }
    return (reference_rect){first[0], first[1], last[0], last[1]};
}

reference_rect reference_rect_union(reference_rect a, reference_rect b)
{
    return (reference_rect){a.x0 < b.x0 ? a.x0 : b.x0, a.y0 < b.y0 ? a.y0 : b.y0, a.x1 > b.x1 ? a.x1 : b.x1,
                            a.y1 > b.y1 ? a.y1 : b.y1};
}

void reference_dual_grid_walk(reference_rect cells, const int32_t *start, reference_prune prune, reference_visit visit,
                              void *user, reference_walk *counts)
{
    struct {
        int32_t x, y;
        uint32_t level;
    } stack[3 * max_levels + 1], node = {cells.x0, cells.y0, 0};
    uint32_t waiting = 0;
    while (cells.x1 - cells.x0 >= (int32_t)1 << node.level || cells.y1 - cells.y0 >= (int32_t)1 << node.level)
        ++node.level;
    if (start) {
        node.x = start[0];
        node.y = start[1];
        node.level = (uint32_t)start[2];
    }
    memset(counts, 0, sizeof(*counts));
    stack[waiting++] = node;
    while (waiting > 0) {
        counts->stack_depth = waiting > counts->stack_depth ? waiting : counts->stack_depth;
        node = stack[--waiting];
        const int32_t span = (int32_t)1 << node.level;
        counts->nodes += node.level > 0;
        if (node.x > cells.x1 || node.y > cells.y1 || node.x + span <= cells.x0 || node.y + span <= cells.y0)
            continue;
        if (node.level > 0 && prune(user, node.level, node.x, node.y))
            continue;
        if (node.level == 0) {
            ++counts->cells;
            if (!visit(user, node.x, node.y))
                return;
            continue;
        }
        /* Pushed last to first, so that they are visited in order. */
        for (int k = 3; k >= 0; --k) {
            stack[waiting] = node;
            stack[waiting].x += (k & 1) * span / 2;
            stack[waiting].y += (k >> 1) * span / 2;
            stack[waiting++].level = node.level - 1;
        }
    }
}
