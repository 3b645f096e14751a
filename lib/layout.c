/* Sizes and offsets inside the objects' memory. */
#include "layout.h"

#include <string.h>

#include "techniques/settings.h"

/* The largest minStorageBufferOffsetAlignment and minUniformBufferOffsetAlignment Vulkan allows. */
enum { ALIGNMENT = 256 };

static softshi_range append(VkDeviceSize *end, VkDeviceSize size)
{
    const softshi_range range = {*end, size};
    *end = (*end + size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    return range;
}

uint32_t softshi_level_quads(uint32_t texels, uint32_t level)
{
    return (softshi_level_size(texels, level) + 3) / 4;
}

uint32_t softshi_level_words(uint32_t texels, uint32_t level)
{
    return (softshi_level_size(texels, level) + 31) / 32;
}

uint32_t softshi_level_size(uint32_t texels, uint32_t level)
{
    return (uint32_t)(((uint64_t)texels + (UINT64_C(1) << level) - 1) >> level);
}

uint32_t softshi_dual_levels(VkExtent2D extent, uint32_t level)
{
    const uint32_t side = extent.width > extent.height ? extent.width : extent.height;
    const uint32_t cells = softshi_level_size(side, level) + 1;
    uint32_t levels = 0;
    while (cells > UINT32_C(1) << levels)
        levels++;
    return levels;
}

static uint32_t maximum(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

static uint32_t minimum(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

/* Nodes of a side, at most, also of a smaller map built into the same memory, which may join at a finer level. */
static uint32_t dual_room(uint32_t texels, uint32_t level, uint32_t node_level, uint32_t join_texels)
{
    const uint32_t samples = softshi_level_size(texels, level), aligned = softshi_level_size(samples + 1, node_level);
    return join_texels > 0 ? maximum(aligned, minimum(samples, join_texels) + 1) : aligned;
}

static void layout_dual_grids(VkExtent2D extent, uint32_t join_texels, softshi_occluder_layout *out)
{
    for (uint32_t k = 0; k < SS_MAX_LEVELS; k++)
        for (uint32_t level = 0; level < SS_MAX_LEVELS; level++) {
            out->duals[k][level] = (uint32_t)out->dual_texels;
            if (level <= out->top && k < softshi_dual_levels(extent, level))
                out->dual_texels += (VkDeviceSize)dual_room(extent.width, level, k, join_texels) *
                                    dual_room(extent.height, level, k, join_texels);
        }
}

void softshi_layout_occluders(VkExtent2D extent, uint32_t layers, uint32_t join_texels, bool folds, bool dual_grids,
                              softshi_occluder_layout *out)
{
    memset(out, 0, sizeof *out);
    const uint32_t side = maximum(extent.width, extent.height);
    /* Even a single texel has a level 1: queries never read level 0. */
    do
        out->top++;
    while (softshi_level_size(side, out->top) > 1);
    for (uint32_t i = 1; i <= out->top; i++) {
        out->offsets[i] = (uint32_t)out->pyramid_texels;
        out->pyramid_texels += softshi_level_size(extent.width, i) * softshi_level_size(extent.height, i);
    }
    for (uint32_t i = 0; i <= out->top; i++) {
        out->quads[i] = (uint32_t)out->layer_quads;
        out->layer_quads += (VkDeviceSize)softshi_level_quads(extent.width, i) * softshi_level_size(extent.height, i);
    }
    out->thin_words = out->top < 2 ? 0 : out->pyramid_texels - out->offsets[2];
    for (uint32_t i = 0; i <= out->top && folds; i++) {
        out->folds[i] = (uint32_t)(out->thin_words + out->layer_fold_words);
        out->layer_fold_words +=
            (VkDeviceSize)softshi_level_words(extent.width, i) * softshi_level_size(extent.height, i);
    }
    out->join = out->top;
    if (join_texels > 0) {
        out->join = 0;
        while (softshi_level_size(side, out->join) > join_texels)
            out->join++;
        /* Not the size at `join`: a smaller map built into the same memory may join at a finer level. */
        const uint32_t width = minimum(extent.width, join_texels), height = minimum(extent.height, join_texels);
        out->wide_texels = width * height;
        while (maximum(width, height) >> (out->wide_levels + 1))
            out->wide_levels++;
    }
    out->pyramids = layers > 1 ? layers + 1 : 1;
    out->wide_offset = out->pyramids * out->pyramid_texels;
    out->dual_offset = out->wide_offset + (VkDeviceSize)out->wide_levels * out->wide_texels;
    if (dual_grids)
        layout_dual_grids(extent, join_texels, out);
    const VkDeviceSize texels = out->dual_offset + layers * out->dual_texels;
    VkDeviceSize end = 0;
    out->header = append(&end, sizeof(ss_occluders) + sizeof(ss_plan));
    out->fan_depth = append(&end, out->layer_quads * layers * 4 * sizeof(float));
    out->ranges = append(&end, texels * 2 * sizeof(float));
    const VkDeviceSize words = out->thin_words + out->layer_fold_words * layers;
    /* Never empty: its view is among the descriptors. */
    out->bits = append(&end, (words ? words : 1) * sizeof(uint32_t));
    out->buffer_size = end;
}

VkDeviceSize softshi_layout_lists(const softsh_settings *settings, VkDeviceSize tiles, ss_uvec4 *lists)
{
    const softshi_packets packets = softshi_settings_packets(settings);
    const uint32_t row = (SS_TILE_X + packets.block - 1) / packets.block, blocks = row * row;
    VkDeviceSize first[4], end = 3 * tiles;
    const VkDeviceSize words[4] = {
        2 * SS_TILE_PIXELS,
        packets.side[SS_LIST_LARGE] ? SS_PACKET_WORDS * blocks : 0,
        packets.side[SS_LIST_SMALL] ? SS_PACKET_WORDS * SS_TILE_PIXELS / 4 : 0,
        !settings->sparse                       ? 0
        : softshi_settings_in_packets(settings) ? SS_PACKET_WORDS * blocks
                                                : SS_INTERPOLATED_WORDS,
    };
    for (int i = 0; i < 4; i++) {
        first[i] = end;
        end += words[i] * tiles;
    }
    /* No image has so many tiles that this does not fit. */
    *lists = (ss_uvec4){(uint32_t)first[0], (uint32_t)first[1], (uint32_t)first[2], (uint32_t)first[3]};
    return end;
}

uint32_t softshi_layout_planes(const softsh_settings *settings)
{
    return settings->filter_passes > 0 ? 3 : settings->sparse ? 1 : 0;
}

void softshi_layout_view(VkExtent2D extent, const softsh_settings *settings, bool sublights, softshi_view_layout *out)
{
    const VkDeviceSize tiles =
        (VkDeviceSize)((extent.width + SS_TILE_X - 1) / SS_TILE_X) * ((extent.height + SS_TILE_Y - 1) / SS_TILE_Y);
    const uint32_t planes = softshi_layout_planes(settings) + (sublights ? 2 : 0);
    ss_uvec4 lists;
    VkDeviceSize end = 0;
    out->frame = append(&end, sizeof(ss_frame));
    out->control = append(&end, sizeof(ss_control));
    out->tiles = append(&end, softshi_layout_lists(settings, tiles, &lists) * sizeof(uint32_t));
    out->filter = append(&end, planes ? (VkDeviceSize)extent.width * extent.height * planes * sizeof(float) : 4);
    out->buffer_size = end;
}
