/* Contours of surfaces cut apart where they are not one: section 10 of docs/numerics.md. */
#ifndef REFERENCE_SEPARATE_H
#define REFERENCE_SEPARATE_H

#include "reference_contour.h"

/* Whether the samples at (x, y) and one further along an axis, both of which occlude the receiver, are two surfaces. */
bool reference_is_cut(const reference_dual_grid *grid, const reference_map *map, const reference_settings *settings,
                      const reference_receiver *receiver, softsh_reconstruction reconstruction, int32_t x, int32_t y,
                      int axis);

/* What the contours of one layer hide, cut apart. */
typedef struct reference_separate {
    double area;       /* of all contours, clipped to the light; what overlaps counts as often as it does */
    uint64_t windings; /* sum over the samples of the 16 x 16 jittered pattern of the numbers above zero */
    bool covered[256]; /* the samples where it is */
    uint32_t edges;
} reference_separate;

void reference_separate_layer(const reference_dual_grid *grid, const reference_map *map,
                              const reference_settings *settings, const reference_receiver *receiver,
                              softsh_reconstruction reconstruction, reference_separate *out);

/* What SOFTSH_TECHNIQUE_CONTOUR makes of all layers, one grid each, with this reconstruction. The light has an extent.
 */
double reference_separate_visibility(const reference_dual_grid *grids, uint32_t layer_count, const reference_map *map,
                                     const reference_settings *settings, const reference_receiver *receiver,
                                     softsh_reconstruction reconstruction);

#endif
