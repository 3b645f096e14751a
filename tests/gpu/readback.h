/* What only the library's internal headers reach: what objects hold on the device, and settings of views that exist. */
#ifndef READBACK_H
#define READBACK_H

#include "fixture.h"
#include "reference_hierarchy.h"

typedef struct readback {
    uint32_t width, height, layers;
    uint32_t top, join;                  /* levels of the pyramid; the one the wide levels start from */
    uint32_t wide_allocated, wide_built; /* levels */
    uint32_t pyramid_offsets[16], pyramids, wide_texels;
    size_t pyramid_texels, wide_offset;
    uint32_t quads[16]; /* of fan depths, where levels begin */
    size_t layer_quads;
    float *samples;                  /* as the device has them */
    float a[4], delta, epsilon;      /* of the light */
    size_t dual_offset, dual_texels; /* of the ranges; where the dual grids begin, how many of each layer */
    uint32_t duals[16][16];          /* by level of nodes and of samples */
    uint32_t *bits, fold_levels[16]; /* words; where the levels' folds begin */
    size_t layer_fold_words;
    float *fan_depth; /* of level 0, layer after layer */
    reference_range *ranges;
} readback;

void readback_create(const lamp *l, readback *out);
void readback_destroy(readback *r);
/* One texel of pyramid level `level`, which counts from 1; pyramid `layers`, if there is one, is that over all layers.
 */
reference_range readback_pyramid(const readback *r, uint32_t layer, uint32_t level, uint32_t x, uint32_t y);
/* Sampled fan depth of a level. */
float readback_sample(const readback *r, uint32_t layer, uint32_t level, uint32_t x, uint32_t y);
/* Whether cell (x, y) of a level folds. */
bool readback_folds(const readback *r, uint32_t layer, uint32_t level, uint32_t x, uint32_t y);
/* Levels whose samples may miss something under texel (x, y) of the pyramid's level, from 2 on, a bit each. */
uint32_t readback_thin(const readback *r, uint32_t level, uint32_t x, uint32_t y);
/* Over all layers, at the resolution of level `join`, of wide level `level`, which counts from 1. */
reference_range readback_wide(const readback *r, uint32_t level, uint32_t x, uint32_t y);

/* Level from which nodes of a sample level's dual grid are no longer aligned. */
uint32_t readback_dual_join(const readback *r, uint32_t level);
/* Node (x, y) of a level of the dual grid over the samples of another; counted in steps of the smaller of 2^node_level
 * and 2^join cells, from the cells before the map's first samples. */
reference_range readback_dual(const readback *r, uint32_t layer, uint32_t level, uint32_t node_level, uint32_t x,
                              uint32_t y);

/* What the post filter of a view's last run worked on: area occlusions of the pixels of a width x height render area,
 * and whether a pixel's tile was undecided. Areas of the other tiles mean nothing. */
void sight_read_areas(sight *s, uint32_t width, uint32_t height, float *areas, bool *undecided);
/* Another least level for a view that was made with one: levels are no part of its pipelines, which are slow to make.
 */
void sight_set_level(sight *s, uint32_t level);

#endif
