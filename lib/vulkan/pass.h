/* Recording: passes with what they read and write, from which the barriers between them follow. */
#ifndef SOFTSHI_PASS_H
#define SOFTSHI_PASS_H

#include "pipeline.h"

/* What passes touch. Two passes need a barrier between them if one writes what the other touches. */
typedef enum softshi_resource {
    SOFTSHI_HEADER = 1 << 0, /* ss_occluders */
    SOFTSHI_PLAN = 1 << 1,   /* ss_plan: arguments and levels built */
    SOFTSHI_FAN_DEPTH = 1 << 2,
    SOFTSHI_PYRAMID = 1 << 3, /* of the ranges */
    SOFTSHI_WIDE = 1 << 4,    /* likewise */
    SOFTSHI_FRAME = 1 << 5,
    SOFTSHI_CONTROL = 1 << 6, /* arguments, list lengths, counters */
    SOFTSHI_TILES = 1 << 7,
    SOFTSHI_FILTER = 1 << 8,
    SOFTSHI_VISIBILITY = 1 << 9,
    SOFTSHI_BITS = 1 << 10, /* of what is thin, and folds */
    SOFTSHI_DUAL = 1 << 11  /* of the ranges */
} softshi_resource;

typedef struct softshi_recorder {
    const softsh_context *context;
    VkCommandBuffer cmd;
    softsh_timestamps *timestamps; /* may be NULL */
    uint32_t read, written;        /* resources touched since the last barrier */
    VkDescriptorSet sets[2];
} softshi_recorder;

typedef struct softshi_pass {
    const softshi_pipeline *pipeline;
    uint32_t reads, writes; /* softshi_resource */
    const void *push;       /* may be NULL */
    uint32_t push_size;
    uint32_t groups[3];
    VkBuffer indirect; /* instead of groups; VK_NULL_HANDLE: direct */
    VkDeviceSize indirect_offset;
} softshi_pass;

/* Starts recording: orders everything after earlier work with the same objects on the queue, and writes the first
 * timestamp. `label` names the region. */
void softshi_record_begin(softshi_recorder *recorder, const softsh_context *context, VkCommandBuffer cmd,
                          softsh_timestamps *timestamps, const char *label);
void softshi_record_end(softshi_recorder *recorder);

/* Barriers as needed, then the dispatch. Sets recorder->sets are bound for every pass. */
void softshi_record_pass(softshi_recorder *recorder, const softshi_pass *pass);

/* vkCmdUpdateBuffer; size a multiple of 4 and at most 65,536. */
void softshi_record_update(softshi_recorder *recorder, uint32_t writes, VkBuffer buffer, VkDeviceSize offset,
                           const void *data, VkDeviceSize size);
/* Zeros; size a multiple of 4. */
void softshi_record_clear(softshi_recorder *recorder, uint32_t writes, VkBuffer buffer, VkDeviceSize offset,
                          VkDeviceSize size);
void softshi_record_copy(softshi_recorder *recorder, uint32_t reads, VkBuffer from, VkDeviceSize from_offset,
                         VkBuffer to, VkDeviceSize to_offset, VkDeviceSize size);
/* Makes everything written so far visible to compute shaders recorded later by anybody. */
void softshi_record_release(softshi_recorder *recorder);

#endif
