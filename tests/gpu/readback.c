/* volk defines Vulkan's functions as pointers, the library's headers only need the types. */
#include "readback.h"

#include <stdlib.h>
#include <string.h>

#include "occluders.h"
#include "read_wide.comp.h"
#include "view.h"

static_assert(sizeof(reference_range) == 8, "a range is what the device calls a vec2");

static void check(VkResult result)
{
    assert_int_equal(result, VK_SUCCESS);
}

typedef struct copier {
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkShaderModule shader;
    VkPipeline pipeline;
    VkDescriptorPool pool;
    VkDescriptorSet set;
} copier;

static void copier_create(VkImageView image, VkBuffer buffer, copier *out)
{
    const VkDescriptorSetLayoutBinding bindings[2] = {
        {0, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1, VK_SHADER_STAGE_COMPUTE_BIT, NULL},
        {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, NULL}};
    const VkDescriptorSetLayoutCreateInfo set_info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, .bindingCount = 2, .pBindings = bindings};
    check(vkCreateDescriptorSetLayout(device.device, &set_info, NULL, &out->set_layout));
    const VkPushConstantRange push = {VK_SHADER_STAGE_COMPUTE_BIT, 0, 12};
    const VkPipelineLayoutCreateInfo layout_info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                                    .setLayoutCount = 1,
                                                    .pSetLayouts = &out->set_layout,
                                                    .pushConstantRangeCount = 1,
                                                    .pPushConstantRanges = &push};
    check(vkCreatePipelineLayout(device.device, &layout_info, NULL, &out->layout));
    const VkShaderModuleCreateInfo shader_info = {.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                                  .codeSize = sizeof read_wide_comp,
                                                  .pCode = read_wide_comp};
    check(vkCreateShaderModule(device.device, &shader_info, NULL, &out->shader));
    const VkComputePipelineCreateInfo pipeline_info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = out->shader,
                  .pName = "main"},
        .layout = out->layout};
    check(vkCreateComputePipelines(device.device, VK_NULL_HANDLE, 1, &pipeline_info, NULL, &out->pipeline));
    const VkDescriptorPoolSize sizes[2] = {{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1},
                                           {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1}};
    const VkDescriptorPoolCreateInfo pool_info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, .maxSets = 1, .poolSizeCount = 2, .pPoolSizes = sizes};
    check(vkCreateDescriptorPool(device.device, &pool_info, NULL, &out->pool));
    const VkDescriptorSetAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                                  .descriptorPool = out->pool,
                                                  .descriptorSetCount = 1,
                                                  .pSetLayouts = &out->set_layout};
    check(vkAllocateDescriptorSets(device.device, &allocate, &out->set));
    const VkDescriptorImageInfo image_info = {VK_NULL_HANDLE, image, VK_IMAGE_LAYOUT_GENERAL};
    const VkDescriptorBufferInfo buffer_info = {buffer, 0, VK_WHOLE_SIZE};
    const VkWriteDescriptorSet writes[2] = {{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                             .dstSet = out->set,
                                             .descriptorCount = 1,
                                             .descriptorType = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
                                             .pImageInfo = &image_info},
                                            {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                             .dstSet = out->set,
                                             .dstBinding = 1,
                                             .descriptorCount = 1,
                                             .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                             .pBufferInfo = &buffer_info}};
    vkUpdateDescriptorSets(device.device, 2, writes, 0, NULL);
}

static void copier_destroy(copier *c)
{
    vkDestroyDescriptorPool(device.device, c->pool, NULL);
    vkDestroyPipeline(device.device, c->pipeline, NULL);
    vkDestroyShaderModule(device.device, c->shader, NULL);
    vkDestroyPipelineLayout(device.device, c->layout, NULL);
    vkDestroyDescriptorSetLayout(device.device, c->set_layout, NULL);
}

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

static void copy_wide(const softsh_occluders *o, readback *r)
{
    const uint32_t layers = r->wide_allocated * r->layers;
    const size_t texels = (size_t)r->wide_width * r->wide_height * layers;
    const uint32_t push[3] = {r->wide_width, r->wide_height, layers};
    const VkMemoryBarrier after = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                   .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
                                   .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
    gpu_buffer staging;
    copier c;

    assert_true(
        gpu_buffer_create(&device, texels * sizeof *r->wide, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, true, &staging));
    copier_create(o->wide_view, staging.buffer, &c);
    VkCommandBuffer cmd = gpu_begin(&device);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, c.pipeline);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, c.layout, 0, 1, &c.set, 0, NULL);
    vkCmdPushConstants(cmd, c.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof push, push);
    vkCmdDispatch(cmd, (uint32_t)((texels + 63) / 64), 1, 1);
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &after, 0, NULL,
                         0, NULL);
    assert_true(gpu_submit(&device, cmd));
    r->wide = malloc(texels * sizeof *r->wide);
    assert_non_null(r->wide);
    memcpy(r->wide, staging.mapped, texels * sizeof *r->wide);
    copier_destroy(&c);
    gpu_buffer_destroy(&device, &staging);
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
    softshi_layout_occluders((VkExtent2D){out->width, out->height}, out->layers, o->join_texels, &layout);
    out->top = layout.top;
    out->join = layout.join;
    out->wide_allocated = o->layout.wide_levels;
    out->wide_built = plan->built.x;
    out->wide_width = o->layout.wide_extent.width;
    out->wide_height = o->layout.wide_extent.height;
    out->pyramid_stride = layout.pyramid_texels;
    memcpy(out->pyramid_offsets, layout.offsets, sizeof out->pyramid_offsets);
    out->fan_depth = copy_range(&o->block, o->layout.fan_depth.offset, o->layout.fan_depth.size);
    out->pyramid = copy_range(&o->block, o->layout.pyramid.offset, o->layout.pyramid.size);
    if (out->wide_built > 0)
        copy_wide(o, out);
    free(header);
    free(plan);
}

void readback_destroy(readback *r)
{
    free(r->fan_depth);
    free(r->pyramid);
    free(r->wide);
}

reference_range readback_pyramid(const readback *r, uint32_t layer, uint32_t level, uint32_t x, uint32_t y)
{
    return r->pyramid[(size_t)layer * r->pyramid_stride + r->pyramid_offsets[level] +
                      (size_t)y * reference_hsm_size(r->width, level) + x];
}

reference_range readback_wide(const readback *r, uint32_t layer, uint32_t level, uint32_t x, uint32_t y)
{
    const size_t slice = (size_t)layer * r->wide_allocated + level - 1;
    return r->wide[(slice * r->wide_height + y) * r->wide_width + x];
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
