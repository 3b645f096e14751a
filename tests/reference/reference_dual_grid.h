/* Ranges over the dual grid of a level's samples, and the walk that finds the cells a contour may run through: section
 * 10 of docs/numerics.md. */
#ifndef REFERENCE_DUAL_GRID_H
#define REFERENCE_DUAL_GRID_H

#include "reference_occluder.h"

/* The lowest and highest g of the samples under a node, and whether a cell of it folds. */
typedef struct reference_node {
    double min, max;
    bool folds;
} reference_node;

/* Cell (x, y) joins samples (x, y) to (x + 1, y + 1); cells -1 and columns - 1 (rows - 1) reach beyond the map. Node
 * (x, y) of level l spans cells x to x + 2^l - 1, and so samples x to x + 2^l. */
typedef struct reference_dual_grid {
    uint32_t columns, rows; /* of samples */
    double spacing;
    double (*place)[3];    /* (u, v, g) of each sample, row by row */
    uint32_t level_count;  /* the last level's node spans all cells */
    reference_node *nodes; /* level by level, rows + 1 by columns + 1 each */
} reference_dual_grid;

/* Cells or samples x0 to x1, y0 to y1, both ends included. */
typedef struct reference_rect {
    int32_t x0, y0, x1, y1;
} reference_rect;

typedef struct reference_walk {
    uint64_t nodes;       /* tested, of levels above 0 */
    uint64_t cells;       /* visited */
    uint32_t stack_depth; /* the most nodes waiting at a time */
} reference_walk;

/* Whether nothing is to be found in the cells of a node. */
typedef bool (*reference_prune)(void *user, uint32_t level, int32_t x, int32_t y);
/* False stops the walk. */
typedef bool (*reference_visit)(void *user, int32_t x, int32_t y);

/* False for want of memory. */
bool reference_dual_grid_create(reference_dual_grid *grid, const reference_map *map, const reference_settings *settings,
                                const float *g);
void reference_dual_grid_destroy(reference_dual_grid *grid);

const double *reference_dual_grid_place(const reference_dual_grid *grid, int32_t x, int32_t y);
const reference_node *reference_dual_grid_node(const reference_dual_grid *grid, uint32_t level, int32_t x, int32_t y);
/* Samples of the map under a node: the box of their places in u and v and their range of g. */
void reference_dual_grid_bounds(const reference_dual_grid *grid, uint32_t level, int32_t x, int32_t y, double low[3],
                                double high[3]);

/* Samples, at least one, whose cells hold the kernel of a receiver for occluders up to g_hi. */
reference_rect reference_dual_grid_kernel(const reference_dual_grid *grid, const reference_map *map,
                                          const reference_settings *settings, const reference_receiver *receiver,
                                          double g_hi);
/* The union of both. */
reference_rect reference_rect_union(reference_rect a, reference_rect b);

/* Visits every cell of `cells` that is in no pruned node, depth first from the smallest node that starts at the
 * cells' corner and spans them all, or from `start` = (x, y, level), which has to span them too. */
void reference_dual_grid_walk(reference_rect cells, const int32_t *start, reference_prune prune, reference_visit visit,
                              void *user, reference_walk *counts);

#endif
