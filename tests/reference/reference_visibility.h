/* How much of the light one receiver sees, by looking at every micro-occluder of every layer: sections 4 and 5 of
 * docs/numerics.md. No kernel, no hierarchy, no classification. */
#ifndef REFERENCE_VISIBILITY_H
#define REFERENCE_VISIBILITY_H

#include "reference_occluder.h"

#define REFERENCE_MAX_PATTERN 32

typedef struct reference_occlusion {
    uint32_t counted;  /* samples of the pattern on the light */
    uint32_t occluded; /* of those; visibility by bitmask is 1 - occluded / counted */
    double bitmask;    /* occluded / counted */
    double area;       /* area occlusion, not clamped; visibility by area is 1 - min(area, 1) */
    uint32_t mask[REFERENCE_MAX_PATTERN * REFERENCE_MAX_PATTERN /
                  32]; /* bit j N + i: sample of column i, row j is occluded */
} reference_occlusion;

/* N of an N x N pattern. */
uint32_t reference_pattern_size(softsh_pattern pattern);
/* Sample coordinates, in [0, N], of column i, row j. */
void reference_pattern_sample(softsh_pattern pattern, uint32_t i, uint32_t j, double xy[2]);
/* Whether the sample lies on the light. */
bool reference_pattern_counted(softsh_pattern pattern, bool directional, uint32_t i, uint32_t j);

/* Smallest level that keeps a kernel of `extent` texels within budget x budget micro-occluders; budget 0: level 0. */
uint32_t reference_level(uint32_t extent, uint32_t budget);
/* q to sample coordinates. */
double reference_to_sample(softsh_pattern pattern, double q);
/* Half the side of the square that stands for the light in areas. */
double reference_area_side(const reference_map *map);
/* ORs the samples inside a quad of light points, by the crossing rule, into out->mask. */
void reference_cover_quad(softsh_pattern pattern, double q[4][2], reference_occlusion *out);
/* Drops the samples of out->mask beside the light and counts. */
void reference_count(const reference_map *map, softsh_pattern pattern, reference_occlusion *out);

/* Visible share of the light, given that of what hides it: the receiver's horizon hides some too. */
double reference_visible(const reference_receiver *receiver, double occlusion);

/* `layers` are layer_count fan depth images of the map's size, row by row. False where the definitions have no answer:
 * a micropatch under a light that is not axis-aligned, or an unsupported primitive. */
bool reference_visibility(const reference_map *map, const float *const *layers, uint32_t layer_count,
                          const reference_settings *settings, const reference_receiver *receiver,
                          reference_occlusion *out);

#endif
