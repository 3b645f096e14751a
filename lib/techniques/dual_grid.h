/* Ranges over the dual grid of each level's samples: the passes that build them. */
#ifndef SOFTSHI_DUAL_GRID_H
#define SOFTSHI_DUAL_GRID_H

#include "occluders.h"

softsh_result softshi_dual_grid_create(softsh_occluders *o);
void softshi_dual_grid_destroy(softsh_occluders *o);
/* Of all layers, from the sampled fan depths. */
void softshi_dual_grid_record(softshi_recorder *recorder, const softsh_occluders *o, VkExtent2D extent,
                              const softshi_occluder_layout *layout, uint32_t layers);

#endif
