/* volk defines Vulkan's functions as pointers, the library's headers only need the types. */
#include "readback.h"

#include <stdlib.h>
#include <string.h>

#include "occluders.h"
#include "view.h"

static_assert(sizeof(reference_range) == 8, "a range is what the device calls a vec2");

/* A host-visible copy of a part of the object's buffer. */
static void *copy_range(const softshi_block *block, VkDeviceSize offset, VkDeviceSize size)
{
    const VkMemoryBarrier before = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                    .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
                                    .dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT};
    const VkMemoryBarrier after = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                   .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                   .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
    const VkBufferCopy region = {offset, 0, size};
    gpu_buffer staging;
    void *const out = malloc(size);

    assert_non_null(out);
    assert_true(gpu_buffer_create(&device, size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, true, &staging));
    VkCommandBuffer cmd = gpu_begin(&device);
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 1, &before, 0,
                         NULL, 0, NULL);
    vkCmdCopyBuffer(cmd, block->buffer, staging.buffer, 1, &region);
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &after, 0, NULL, 0,
                         NULL);
    assert_true(gpu_submit(&device, cmd));
    memcpy(out, staging.mapped, size);
    gpu_buffer_destroy(&device, &staging);
    return out;
}

void readback_create(const lamp *l, readback *out)
{
    const softsh_occluders *const o = l->occluders;
    ss_occluders *const header = copy_range(&o->block, o->layout.header.offset, sizeof *header);
    ss_plan *const plan = copy_range(&o->block, o->layout.header.offset + sizeof *header, sizeof *plan);

    softshi_occluder_layout layout;
    memset(out, 0, sizeof *out);
    out->width = header->size.x;
    out->height = header->size.y;
    out->layers = header->size.z;
    softshi_layout_occluders((VkExtent2D){out->width, out->height}, out->layers, o->join_texels, o->folds,
                             o->dual_grids, &layout);
    out->top = layout.top;
    out->join = layout.join;
    out->wide_built = plan->built.x;
    out->wide_allocated = layout.wide_levels;
    out->wide_offset = (size_t)layout.wide_offset;
    out->wide_texels = layout.wide_texels;
    out->pyramid_texels = (size_t)layout.pyramid_texels;
    out->pyramids = layout.pyramids;
    memcpy(out->pyramid_offsets, layout.offsets, sizeof out->pyramid_offsets);
    memcpy(out->quads, layout.quads, sizeof out->quads);
    out->layer_quads = (size_t)layout.layer_quads;
    out->samples = copy_range(&o->block, o->layout.fan_depth.offset, o->layout.fan_depth.size);
    out->fan_depth = malloc((size_t)out->width * out->height * out->layers * sizeof *out->fan_depth);
    assert_non_null(out->fan_depth);
    for (uint32_t layer = 0; layer < out->layers; layer++)
        for (uint32_t y = 0; y < out->height; y++)
            for (uint32_t x = 0; x < out->width; x++)
                out->fan_depth[((size_t)layer * out->height + y) * out->width + x] =
                    readback_sample(out, layer, 0, x, y);
    memcpy(out->a, &header->a, sizeof out->a);
    out->delta = header->light.z;
    out->epsilon = header->light.w;
    out->dual_offset = (size_t)layout.dual_offset;
    out->dual_texels = (size_t)layout.dual_texels;
    memcpy(out->duals, layout.duals, sizeof out->duals);
    memcpy(out->fold_levels, layout.folds, sizeof out->fold_levels);
    out->layer_fold_words = (size_t)layout.layer_fold_words;
    out->bits = copy_range(&o->block, o->layout.bits.offset, o->layout.bits.size);
    out->ranges = copy_range(&o->block, o->layout.ranges.offset, o->layout.ranges.size);
    free(header);
    free(plan);
}

void readback_destroy(readback *r)
{
    free(r->samples);
    free(r->fan_depth);
    free(r->ranges);
    free(r->bits);
}

reference_range readback_pyramid(const readback *r, uint32_t layer, uint32_t level, uint32_t x, uint32_t y)
{
    return r->ranges[layer * r->pyramid_texels + r->pyramid_offsets[level] +
                     (size_t)y * reference_hsm_size(r->width, level) + x];
}

float readback_sample(const readback *r, uint32_t layer, uint32_t level, uint32_t x, uint32_t y)
{
    const size_t row = (reference_hsm_size(r->width, level) + 3) / 4 * 4;
    return r->samples[4 * (layer * r->layer_quads + r->quads[level]) + y * row + x];
}

bool readback_folds(const readback *r, uint32_t layer, uint32_t level, uint32_t x, uint32_t y)
{
    const size_t words = (reference_hsm_size(r->width, level) + 31) / 32;
    return r->bits[layer * r->layer_fold_words + r->fold_levels[level] + y * words + x / 32] >> x % 32 & 1;
}

uint32_t readback_thin(const readback *r, uint32_t level, uint32_t x, uint32_t y)
{
    return r
        ->bits[r->pyramid_offsets[level] - r->pyramid_offsets[2] + (size_t)y * reference_hsm_size(r->width, level) + x];
}

reference_range readback_wide(const readback *r, uint32_t level, uint32_t x, uint32_t y)
{
    return r->ranges[r->wide_offset + (size_t)(level - 1) * r->wide_texels +
                     (size_t)y * reference_hsm_size(r->width, r->join) + x];
}

uint32_t readback_dual_join(const readback *r, uint32_t level)
{
    return r->join > level ? r->join - level : 0;
}

reference_range readback_dual(const readback *r, uint32_t layer, uint32_t level, uint32_t node_level, uint32_t x,
                              uint32_t y)
{
    const uint32_t join = readback_dual_join(r, level), shift = node_level < join ? node_level : join;
    const size_t row = reference_hsm_size(reference_hsm_size(r->width, level) + 1, shift);
    return r->ranges[r->dual_offset + layer * r->dual_texels + r->duals[node_level][level] + y * row + x];
}

void sight_read_areas(sight *s, uint32_t width, uint32_t height, float *areas, bool *undecided)
{
    const softsh_view *const v = s->view;
    const uint32_t columns = (width + SS_TILE_X - 1) / SS_TILE_X, rows = (height + SS_TILE_Y - 1) / SS_TILE_Y;
    const size_t size = (size_t)width * height * sizeof *areas;
    float *const plane = copy_range(&v->block, v->layout.filter.offset, size);
    uint32_t *const tiles = copy_range(&v->block, v->layout.tiles.offset, columns * rows * sizeof *tiles);
    memcpy(areas, plane, size);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            undecided[y * width + x] = tiles[y / SS_TILE_Y * columns + x / SS_TILE_X] == SS_STATE_PIXELS;
    free(plane);
    free(tiles);
}

void sight_set_level(sight *s, uint32_t level)
{
    s->view->settings.min_level = level;
}
