/* HSM, MSSM and YSM: the passes that build them. */
#ifndef SOFTSHI_HIERARCHY_H
#define SOFTSHI_HIERARCHY_H

#include "occluders.h"

softsh_result softshi_hierarchy_create(softsh_occluders *o);
void softshi_hierarchy_destroy(softsh_occluders *o);

/* Level 0 of one layer from its map; recorder->sets are set up for it. */
void softshi_hierarchy_record_convert(softshi_recorder *recorder, const softsh_occluders *o, VkExtent2D extent,
                                      const ss_convert_push *push);
/* Everything above level 0 of all layers. */
void softshi_hierarchy_record_levels(softshi_recorder *recorder, const softsh_occluders *o, VkExtent2D extent,
                                     const softshi_occluder_layout *layout, uint32_t layers);

#endif
