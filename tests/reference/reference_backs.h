/* Contours, and what a surface hides where the receiver sees its back: section 10 of docs/numerics.md. */
#ifndef REFERENCE_BACKS_H
#define REFERENCE_BACKS_H

#include "reference_contour.h"

/* Whether the receiver is behind the mean plane of a cell's four samples. */
bool reference_seen_from_behind(const reference_dual_grid *grid, const reference_map *map,
                                const reference_settings *settings, const reference_receiver *receiver, int32_t x,
                                int32_t y);

/* Area on the light of a layer's cells that fold, whose samples all occlude, and that are seen from behind. */
double reference_backs_area(const reference_dual_grid *grid, const reference_map *map,
                            const reference_settings *settings, const reference_receiver *receiver);

/* What SOFTSH_TECHNIQUE_CONTOUR makes of all layers, one grid each, with SOFTSH_RECONSTRUCTION_BACKS. The light has an
 * extent. False for want of memory. */
bool reference_backs_visibility(const reference_dual_grid *grids, uint32_t layer_count, const reference_map *map,
                                const reference_settings *settings, const reference_receiver *receiver,
                                double *visibility);

#endif
