/* The occluders object: one light's acceleration structures. */
#ifndef SOFTSHI_OCCLUDERS_H
#define SOFTSHI_OCCLUDERS_H

#include "context.h"
#include "layout.h"
#include "projection.h"
#include "sublight.h"
#include "vulkan/memory.h"
#include "vulkan/pass.h"

enum { SOFTSHI_NAME_SIZE = 64 };

typedef struct softshi_hierarchy_pipelines {
    softshi_pipeline convert, sample, reduce, merge, plan, widen_first, widen, thin_first, thin, fold, dual_first, dual;
} softshi_hierarchy_pipelines;

struct softsh_occluders {
    const softsh_context *context;
    char name[SOFTSHI_NAME_SIZE];
    VkExtent2D max_extent;
    uint32_t max_layers;
    uint32_t join_texels; /* as softshi_layout_occluders takes it */
    softshi_occluder_layout layout;
    softshi_block block;
    bool folds, dual_grids;
    VkBufferView depths, depth_quads, ranges, bits; /* fan depths one by one and by four; ranges; bits */
    VkDescriptorPool pool;
    VkDescriptorSet set;
    VkDescriptorSet *io_sets; /* a ring: one per layer of each recording */
    uint32_t io_set_count, next_io_set;
    softshi_hierarchy_pipelines pipelines;

    /* Of the last recorded build. */
    bool built;
    bool layered; /* more than one layer */
    softshi_sublight sublight;
    softshi_map_space map;
    softshi_light_space light;
};

#endif
