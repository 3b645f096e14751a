/* The view object: settings, pipelines and scratch of one camera view. */
#ifndef SOFTSHI_VIEW_H
#define SOFTSHI_VIEW_H

#include "context.h"
#include "layout.h"
#include "occluders.h"
#include "vulkan/memory.h"
#include "vulkan/pass.h"

/* Passes that this view's settings do not need are not there. */
typedef struct softshi_view_pipelines {
    softshi_pipeline classify_columns, classify_tiles;
    softshi_pipeline classify_pixels;    /* or, for techniques that evaluate packets, of blocks of them */
    softshi_pipeline evaluate[SS_LISTS]; /* by what one invocation evaluates */
    softshi_pipeline evaluate_layered;   /* bitmasks of occluders that have more than one layer */
    softshi_pipeline interpolate, hard, filter, combine;
} softshi_view_pipelines;

struct softsh_view {
    const softsh_context *context;
    char name[SOFTSHI_NAME_SIZE];
    VkExtent2D max_extent;
    VkFormat output_format;
    softsh_settings settings; /* resolved */
    bool stats, normals, sublights;
    softshi_view_layout layout;
    softshi_block block;
    VkDescriptorPool pool;
    VkDescriptorSet *io_sets; /* a ring: one per recording */
    uint32_t io_set_count, next_io_set;
    softshi_view_pipelines pipelines;
    /* Sub-lights recorded so far, of those before the last one. */
    uint32_t combined;
    softshi_sublight combined_last;
    VkRect2D combined_area;
};

/* One visibility call, as the techniques see it. */
typedef struct softshi_visibility {
    softsh_view *view;
    const softsh_occluders *occluders;
    softshi_recorder *recorder;
    ss_frame frame;
} softshi_visibility;

#endif
