/* Samples of a level, and which of them occlude a receiver: sections 3 (bias) and 5 of docs/numerics.md. */
#ifndef REFERENCE_OCCLUDER_H
#define REFERENCE_OCCLUDER_H

#include <softshadow/techniques.h>

#include "reference_map.h"
#include "reference_receiver.h"

typedef struct reference_settings {
    softsh_pattern pattern;
    softsh_primitive primitive;
    softsh_aggregation aggregation;
    softsh_merge merge;
    uint32_t level;
} reference_settings;

/* Every sample of a block of samples: */
typedef enum reference_status {
    REFERENCE_FREE, /* does not occlude */
    REFERENCE_FULL, /* occludes */
    REFERENCE_MIXED /* may or may not */
} reference_status;

/* The settings' primitive, none being microquads. */
softsh_primitive reference_primitive(const reference_settings *settings);
/* Whether it lies flat at its sample's depth. */
bool reference_flat(softsh_primitive primitive);

/* Place (u, v) and depth g of sample (x, y) of the settings' level. */
void reference_level_sample(const reference_map *map, const reference_settings *settings, const float *g, uint32_t x,
                            uint32_t y, double place[3]);

/* The receiver's g that samples are compared with and projected from. Infinite if an override moves the receiver to or
 * beyond the projection centre. */
double reference_raised_g(const reference_map *map, const reference_settings *settings,
                          const reference_receiver *receiver);
/* Whether a sample occludes an active receiver. */
bool reference_occludes(const reference_map *map, const reference_settings *settings,
                        const reference_receiver *receiver, const double place[3]);
/* The same for all samples placed in low..high with depths low[2] to high[2]; never wrong, MIXED where it cannot tell.
 */
reference_status reference_block_status(const reference_map *map, const reference_settings *settings,
                                        const reference_receiver *receiver, const double low[3], const double high[3]);

/* A light without size: whether the one texel the receiver lies in hides it. */
bool reference_hard_shadow(const reference_map *map, const reference_settings *settings, const float *g,
                           const reference_receiver *receiver);

#endif
