/* Contours of what occludes a receiver, extracted by marching squares: section 10 of docs/numerics.md. */
#ifndef REFERENCE_CONTOUR_H
#define REFERENCE_CONTOUR_H

#include "reference_dual_grid.h"
#include "reference_visibility.h"

/* A point on the border of an occluding sample, half the way to a neighbour that does not occlude. */
typedef struct reference_contour_vertex {
    int32_t x, y; /* the sample */
    int32_t side; /* its neighbour: 0 right, 1 above, 2 left, 3 below; above is where v grows */
} reference_contour_vertex;

/* The occluder lies to the left, seen with u to the right and v up. */
typedef struct reference_contour_edge {
    reference_contour_vertex from, to;
} reference_contour_edge;

typedef enum reference_extraction {
    REFERENCE_EXTRACT_SCAN, /* every cell */
    REFERENCE_EXTRACT_WALK  /* the cells that no node rules out */
} reference_extraction;

/* Of one receiver or a packet of them. */
typedef struct reference_contour {
    reference_contour_edge *edges;
    size_t count, capacity;
    bool diverged; /* not all receivers have one contour; the edges are not complete */
    reference_walk walk;
} reference_contour;

/* Edges of one cell whose corners, in the order (x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1), occlude or do not.
 * Returns 0, 1 or 2. */
uint32_t reference_marching_squares(int32_t x, int32_t y, const bool occludes[4], reference_contour_edge edges[2]);

/* Contours of the samples of `range` that occlude the receivers; other samples do not. `contour` is zero, or reused.
 * `start` as for reference_dual_grid_walk, or NULL. False for want of memory. */
bool reference_contour_extract(const reference_dual_grid *grid, const reference_map *map,
                               const reference_settings *settings, const reference_receiver *receivers, uint32_t count,
                               reference_rect range, reference_extraction extraction, const int32_t *start,
                               reference_contour *contour);
void reference_contour_free(reference_contour *contour);

/* How much of the light the contour hides from one of its receivers: area and mask. */
void reference_contour_occlusion(const reference_dual_grid *grid, const reference_map *map,
                                 const reference_settings *settings, const reference_receiver *receiver,
                                 const reference_contour *contour, reference_occlusion *out);

/* A packet as the paper has it: one contour over the union of the receivers' ranges, and where it diverges one for
 * each. `out` gets an occlusion for each receiver; `walk`, unless NULL, what was visited in all, and `diverged`, unless
 * NULL, whether it did. False for want of memory. */
bool reference_contour_packet(const reference_dual_grid *grid, const reference_map *map,
                              const reference_settings *settings, const reference_receiver *receivers,
                              const reference_rect *ranges, uint32_t count, reference_walk *walk, bool *diverged,
                              reference_occlusion *out);

/* The area of the whole map's contours in the light, 0 to 1. False for want of memory. */
bool reference_contour_area(const reference_dual_grid *grid, const reference_map *map,
                            const reference_settings *settings, const reference_receiver *receiver, double *area);

/* What SOFTSH_TECHNIQUE_CONTOUR makes of all layers, one grid each: visibility by the whole maps' contours. The light
 * has an extent; settings->primitive is not looked at. False for want of memory. */
bool reference_contour_visibility(const reference_dual_grid *grids, uint32_t layer_count, const reference_map *map,
                                  const reference_settings *settings, const reference_receiver *receiver,
                                  double *visibility);

#endif
