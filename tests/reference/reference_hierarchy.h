/* Ranges of fan depth, each computed from the map itself: section 7 of docs/numerics.md. */
#ifndef REFERENCE_HIERARCHY_H
#define REFERENCE_HIERARCHY_H

#include <stdint.h>

typedef struct reference_range {
    float min, max;
} reference_range;

/* Texels along a side of HSM level `level` of a map `size` texels wide (or high). */
uint32_t reference_hsm_size(uint32_t size, uint32_t level);
/* Range of texels x0..x1, y0..y1, both ends included; what lies outside the map is ignored, but not all of it may. */
reference_range reference_block_range(const float *g, uint32_t width, uint32_t height, int64_t x0, int64_t y0,
                                      int64_t x1, int64_t y1);

/* One texel of each hierarchy over a width x height map g, row by row. */
reference_range reference_hsm(const float *g, uint32_t width, uint32_t height, uint32_t level, uint32_t x, uint32_t y);
/* Level 0 is the map. */
reference_range reference_mssm(const float *g, uint32_t width, uint32_t height, uint32_t level, uint32_t x, uint32_t y);
/* Levels 0 to `join` are the HSM's; level join + k is MSSM level k of HSM level `join`, at that level's resolution. */
reference_range reference_ysm(const float *g, uint32_t width, uint32_t height, uint32_t join, uint32_t level,
                              uint32_t x, uint32_t y);

#endif
