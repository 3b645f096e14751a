/* Sizes and offsets inside the objects' memory: the only place where they are computed. */
#ifndef SOFTSHI_LAYOUT_H
#define SOFTSHI_LAYOUT_H

#include "context.h"
#include "shared.h"

typedef struct softshi_range {
    VkDeviceSize offset, size; /* bytes */
} softshi_range;

/* Texels of a side at a pyramid level: rounded up. */
uint32_t softshi_level_size(uint32_t texels, uint32_t level);
/* Words of a row of bits there. */
uint32_t softshi_level_words(uint32_t texels, uint32_t level);
/* Quads of a row of fan depths there. */
uint32_t softshi_level_quads(uint32_t texels, uint32_t level);
/* Levels of the dual grid over that level's samples: one more, of a single node, would span all of its cells. */
uint32_t softshi_dual_levels(VkExtent2D extent, uint32_t level);

/* One light's structures for maps of `extent`. */
typedef struct softshi_occluder_layout {
    softshi_range header, fan_depth, ranges, bits; /* in the buffer */
    VkDeviceSize buffer_size;
    VkDeviceSize pyramid_texels;     /* of `ranges`, of each layer */
    uint32_t pyramids;               /* one for each layer, and of several one over all; then come the wide levels */
    uint32_t top;                    /* levels above level 0 */
    uint32_t offsets[SS_MAX_LEVELS]; /* first texel of a pyramid level */
    VkDeviceSize layer_quads;        /* of `fan_depth`, four depths each: a layer's levels 0 to top */
    uint32_t quads[SS_MAX_LEVELS];   /* first quad of a level's sampled fan depths */
    VkDeviceSize thin_words;         /* the first of `bits`: a word for each texel of the pyramid from level 2 on */
    VkDeviceSize layer_fold_words;   /* of `bits`, of each layer; 0 without folds */
    uint32_t folds[SS_MAX_LEVELS];   /* first word of a level's folds, of the first layer */
    uint32_t join;                   /* pyramid level the wide part starts from; `top` without one */
    uint32_t wide_levels;            /* 0 without a wide part */
    VkDeviceSize wide_offset;        /* first texel of wide level 1 */
    uint32_t wide_texels;            /* room for a wide level */
    VkDeviceSize dual_offset;        /* first texel of the first layer's dual grids */
    VkDeviceSize dual_texels;        /* of `ranges`, of each layer; 0 without dual grids */
    /* By level of the nodes, then by level of the samples: first texel in a layer's; where there are none, the next. */
    uint32_t duals[SS_MAX_LEVELS][SS_MAX_LEVELS];
} softshi_occluder_layout;

/* `join_texels`: the most texels a side of the wide part; 0: no wide part (HSM), UINT32_MAX: an MSSM. */
void softshi_layout_occluders(VkExtent2D extent, uint32_t layers, uint32_t join_texels, bool folds, bool dual_grids,
                              softshi_occluder_layout *out);

/* A view's scratch. */
typedef struct softshi_view_layout {
    softshi_range frame, control, tiles, filter;
    VkDeviceSize buffer_size;
} softshi_view_layout;

/* First words of the lists in the tiles buffer of so many tiles, as ss_frame has them; returns the words of all. */
VkDeviceSize softshi_layout_lists(const softsh_settings *settings, VkDeviceSize tiles, ss_uvec4 *lists);

/* Planes of `filter` that the settings' own passes need; those of sub-lights come after them. */
uint32_t softshi_layout_planes(const softsh_settings *settings);

/* For resolved settings. */
void softshi_layout_view(VkExtent2D extent, const softsh_settings *settings, bool sublights, softshi_view_layout *out);

#endif
