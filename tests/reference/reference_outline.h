/* Fold-safe contours: the outline of the occluding microquads that cannot fold, and the others one by one. The samples
 * they hide are exactly those that all microquads hide. Section 10 of docs/numerics.md. */
#ifndef REFERENCE_OUTLINE_H
#define REFERENCE_OUTLINE_H

#include "reference_contour.h"

/* From sample to neighbouring sample; the quads lie to the left, seen with u to the right and v up. */
typedef struct reference_outline_edge {
    int32_t from[2], to[2];
} reference_outline_edge;

/* Of one receiver or a packet of them. */
typedef struct reference_outline {
    reference_outline_edge *edges;
    size_t edge_count, edge_capacity;
    int32_t (*bridges)[2]; /* cells */
    size_t bridge_count, bridge_capacity;
    bool diverged; /* not all receivers have one outline; it is not complete */
    reference_walk walk;
} reference_outline;

/* Of the quads between samples of `range`. Arguments as for reference_contour_extract. */
bool reference_outline_extract(const reference_dual_grid *grid, const reference_map *map,
                               const reference_settings *settings, const reference_receiver *receivers, uint32_t count,
                               reference_rect range, reference_extraction extraction, const int32_t *start,
                               reference_outline *outline);
void reference_outline_free(reference_outline *outline);

void reference_outline_occlusion(const reference_dual_grid *grid, const reference_map *map,
                                 const reference_settings *settings, const reference_receiver *receiver,
                                 const reference_outline *outline, reference_occlusion *out);

#endif
