/* The view object: settings, pipelines and scratch of one camera view. */
#ifndef SOFTSHI_VIEW_H
#define SOFTSHI_VIEW_H

#include "context.h"
#include "layout.h"
#include "occluders.h"
#include "vulkan/memory.h"
#include "vulkan/pass.h"

/* Passes that query the hierarchy come in kinds, for what a view cannot know: occluders without and with wide levels
 * (bit 0), with one layer and with more (bit 1). */
enum { SOFTSHI_KIND_WIDE = 1, SOFTSHI_KIND_LAYERED = 2, SOFTSHI_KINDS = 4 };

typedef struct softshi_view_pipelines {
    softshi_pipeline classify_tiles[SOFTSHI_KINDS], classify_pixels[SOFTSHI_KINDS], evaluate[SOFTSHI_KINDS];
    softshi_pipeline classify_columns, hard, filter, interpolate;
} softshi_view_pipelines;

struct softsh_view {
    const softsh_context *context;
    char name[SOFTSHI_NAME_SIZE];
    VkExtent2D max_extent;
    VkFormat output_format;
    softsh_settings settings; /* resolved */
    bool stats, normals;
    softshi_view_layout layout;
    softshi_block block;
    VkDescriptorPool pool;
    VkDescriptorSet *io_sets; /* a ring: one per recording */
    uint32_t io_set_count, next_io_set;
    softshi_view_pipelines pipelines;
};

/* One visibility call, as the techniques see it. */
typedef struct softshi_visibility {
    softsh_view *view;
    const softsh_occluders *occluders;
    int kind; /* of pipelines */
    softshi_recorder *recorder;
    ss_frame frame;
} softshi_visibility;

#endif
