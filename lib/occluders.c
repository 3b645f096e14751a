/* Creation and destruction of the occluders object. */
#include "occluders.h"

#include <stdio.h>
#include <string.h>

#include "techniques/dual_grid.h"
#include "techniques/hierarchy.h"
#include "validate.h"

static softsh_result check_limits(const softsh_occluders *o)
{
    const softsh_context *context = o->context;
    const struct {
        const char *what;
        VkDeviceSize size;
    } ranges[] = {{"fan depth", o->layout.fan_depth.size},
                  {o->dual_grids           ? "levels and dual grids"
                   : o->layout.wide_levels ? "pyramid and full-resolution levels"
                                           : "pyramid",
                   o->layout.ranges.size}};
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++)
        if (ranges[i].size > context->limits.maxStorageBufferRange)
            return softshi_fail(context, SOFTSH_ERROR_LIMIT,
                                "softsh_occluders_info: %u layers of %u x %u take %llu MiB of %s, the device's "
                                "maxStorageBufferRange is %llu MiB",
                                o->max_layers, o->max_extent.width, o->max_extent.height,
                                (unsigned long long)(ranges[i].size >> 20), ranges[i].what,
                                (unsigned long long)(context->limits.maxStorageBufferRange >> 20));
    const VkDeviceSize depths = o->layout.fan_depth.size / sizeof(float),
                       pairs = o->layout.ranges.size / (2 * sizeof(float));
    const VkDeviceSize texels = depths > pairs ? depths : pairs;
    if (texels > context->limits.maxTexelBufferElements)
        return softshi_fail(context, SOFTSH_ERROR_LIMIT,
                            "softsh_occluders_info: %u layers of %u x %u take %llu texels, the device's "
                            "maxTexelBufferElements is %u",
                            o->max_layers, o->max_extent.width, o->max_extent.height, (unsigned long long)texels,
                            context->limits.maxTexelBufferElements);
    return SOFTSH_SUCCESS;
}

static softsh_result create_sets(softsh_occluders *o, uint32_t recordings)
{
    const softsh_context *context = o->context;
    o->io_set_count = recordings * o->max_layers;
    o->io_sets = softshi_host_allocate(context->allocator, o->io_set_count * sizeof *o->io_sets);
    if (!o->io_sets)
        return softshi_fail(context, SOFTSH_ERROR_OUT_OF_HOST_MEMORY, "no host memory for %u descriptor sets",
                            o->io_set_count);
    const uint32_t n = o->io_set_count;
    const VkDescriptorPoolSize sizes[] = {
        {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1 + n},   {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1 + 3 * n},
        {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 2 * n},    {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, n},
        {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, 4}, {VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, 3},
    };
    const VkDescriptorPoolCreateInfo pool_info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .maxSets = 1 + n,
        .poolSizeCount = sizeof sizes / sizeof *sizes,
        .pPoolSizes = sizes,
    };
    VkResult result = context->vk.CreateDescriptorPool(context->device, &pool_info, context->allocator, &o->pool);
    if (result != VK_SUCCESS) {
        o->pool = VK_NULL_HANDLE;
        return softshi_fail_vulkan(context, result, "vkCreateDescriptorPool");
    }
    VkDescriptorSetAllocateInfo set_info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
        .descriptorPool = o->pool,
        .descriptorSetCount = 1,
        .pSetLayouts = &context->set_layouts[SS_SET_OCCLUDERS],
    };
    result = context->vk.AllocateDescriptorSets(context->device, &set_info, &o->set);
    set_info.pSetLayouts = &context->set_layouts[SS_SET_IO];
    for (uint32_t i = 0; i < n && result == VK_SUCCESS; i++)
        result = context->vk.AllocateDescriptorSets(context->device, &set_info, &o->io_sets[i]);
    return result == VK_SUCCESS ? SOFTSH_SUCCESS : softshi_fail_vulkan(context, result, "vkAllocateDescriptorSets");
}

static softsh_result create_texels(softsh_occluders *o, const softshi_range *range, VkFormat format, VkBufferView *out)
{
    const softsh_context *context = o->context;
    const VkBufferViewCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
        .buffer = o->block.buffer,
        .format = format,
        .offset = range->offset,
        .range = range->size,
    };
    const VkResult result = context->vk.CreateBufferView(context->device, &info, context->allocator, out);
    if (result == VK_SUCCESS)
        return SOFTSH_SUCCESS;
    *out = VK_NULL_HANDLE;
    return softshi_fail_vulkan(context, result, "vkCreateBufferView");
}

/* The descriptors that never change. */
static void write_descriptors(const softsh_occluders *o)
{
    const softsh_context *context = o->context;
    const VkDescriptorBufferInfo header = {o->block.buffer, o->layout.header.offset, o->layout.header.size};
    const VkDescriptorBufferInfo plan = {o->block.buffer, o->layout.header.offset + sizeof(ss_occluders),
                                         sizeof(ss_plan)};
    const struct {
        uint32_t binding;
        VkDescriptorType type;
        const VkDescriptorBufferInfo *buffer;
        const VkBufferView *view;
    } list[SS_OCCLUDER_BINDINGS] = {
        {SS_BIND_OCCLUDERS, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, &header, NULL},
        {SS_BIND_PLAN, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, &plan, NULL},
        {SS_BIND_MADE_DEPTH, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, NULL, &o->depth_quads},
        {SS_BIND_MADE_RANGES, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, NULL, &o->ranges},
        {SS_BIND_DEPTHS, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, NULL, &o->depths},
        {SS_BIND_DEPTH_QUADS, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, NULL, &o->depth_quads},
        {SS_BIND_RANGES, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, NULL, &o->ranges},
        {SS_BIND_BITS, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, NULL, &o->bits},
        {SS_BIND_MADE_BITS, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, NULL, &o->bits},
    };
    VkWriteDescriptorSet writes[SS_OCCLUDER_BINDINGS];
    for (uint32_t i = 0; i < SS_OCCLUDER_BINDINGS; i++)
        writes[i] = (VkWriteDescriptorSet){
            .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
            .dstSet = o->set,
            .dstBinding = list[i].binding,
            .descriptorCount = 1,
            .descriptorType = list[i].type,
            .pBufferInfo = list[i].buffer,
            .pTexelBufferView = list[i].view,
        };
    context->vk.UpdateDescriptorSets(context->device, SS_OCCLUDER_BINDINGS, writes, 0, NULL);
}

/* Once the memory is there. */
static softsh_result finish(softsh_occluders *o)
{
    const softshi_occluder_layout *layout = &o->layout;
    softsh_result result = create_texels(o, &layout->fan_depth, VK_FORMAT_R32_SFLOAT, &o->depths);
    if (result == SOFTSH_SUCCESS)
        result = create_texels(o, &layout->fan_depth, VK_FORMAT_R32G32B32A32_SFLOAT, &o->depth_quads);
    if (result == SOFTSH_SUCCESS)
        result = create_texels(o, &layout->ranges, VK_FORMAT_R32G32_SFLOAT, &o->ranges);
    if (result == SOFTSH_SUCCESS)
        result = create_texels(o, &layout->bits, VK_FORMAT_R32_UINT, &o->bits);
    o->block.ready = result == SOFTSH_SUCCESS;
    if (result == SOFTSH_SUCCESS)
        write_descriptors(o);
    return result;
}

softsh_result softsh_occluders_create(softsh_context *context, const softsh_occluders_info *info,
                                      softsh_occluders **out)
{
    if (out)
        *out = NULL;
    if (!context)
        return SOFTSH_ERROR_INVALID_ARGUMENT;
    softsh_result result = softshi_check_occluders_info(context, info, out);
    if (result != SOFTSH_SUCCESS)
        return result;
    softsh_occluders *o = softshi_host_allocate(context->allocator, sizeof *o);
    if (!o)
        return softshi_fail(context, SOFTSH_ERROR_OUT_OF_HOST_MEMORY, "no host memory for the occluders");
    memset(o, 0, sizeof *o);
    o->context = context;
    snprintf(o->name, sizeof o->name, "%s", info->name ? info->name : "softshadow");
    o->max_extent = info->max_extent;
    o->max_layers = info->max_layers ? info->max_layers : 1;
    o->join_texels = info->ysm_join ? info->ysm_join : 256;
    if (info->accel == SOFTSH_ACCEL_HSM)
        o->join_texels = 0;
    else if (info->accel == SOFTSH_ACCEL_MSSM)
        o->join_texels = UINT32_MAX;
    o->folds = info->no_folds == 0;
    o->dual_grids = info->dual_grids != 0;
    softshi_layout_occluders(o->max_extent, o->max_layers, o->join_texels, o->folds, o->dual_grids, &o->layout);
    result = check_limits(o);
    if (result == SOFTSH_SUCCESS)
        result = softshi_block_create(context, &o->block, o->layout.buffer_size, o->name, "occluders");
    if (result == SOFTSH_SUCCESS)
        result = create_sets(o, info->max_recordings ? info->max_recordings : 4);
    if (result == SOFTSH_SUCCESS)
        result = softshi_hierarchy_create(o);
    if (result == SOFTSH_SUCCESS && o->dual_grids)
        result = softshi_dual_grid_create(o);
    if (result == SOFTSH_SUCCESS && info->memory_mode == SOFTSH_MEMORY_LIBRARY) {
        result = softshi_block_allocate(context, &o->block);
        if (result == SOFTSH_SUCCESS)
            result = finish(o);
    }
    if (result != SOFTSH_SUCCESS) {
        softsh_occluders_destroy(o);
        return result;
    }
    *out = o;
    return SOFTSH_SUCCESS;
}

void softsh_occluders_destroy(softsh_occluders *o)
{
    if (!o)
        return;
    const softsh_context *context = o->context;
    softshi_hierarchy_destroy(o);
    softshi_dual_grid_destroy(o);
    if (o->pool)
        context->vk.DestroyDescriptorPool(context->device, o->pool, context->allocator);
    const VkBufferView texels[] = {o->depths, o->depth_quads, o->ranges, o->bits};
    for (size_t i = 0; i < sizeof texels / sizeof *texels; i++)
        if (texels[i])
            context->vk.DestroyBufferView(context->device, texels[i], context->allocator);
    softshi_block_destroy(context, &o->block);
    if (o->io_sets)
        softshi_host_free(context->allocator, o->io_sets);
    softshi_host_free(context->allocator, o);
}

softsh_result softsh_occluders_memory_requirements(const softsh_occluders *o, VkMemoryRequirements *out)
{
    if (!o)
        return SOFTSH_ERROR_INVALID_ARGUMENT;
    if (!out)
        return softshi_fail(o->context, SOFTSH_ERROR_INVALID_ARGUMENT,
                            "softsh_occluders_memory_requirements: out is NULL");
    *out = o->block.requirements;
    return SOFTSH_SUCCESS;
}

softsh_result softsh_occluders_bind_memory(softsh_occluders *o, VkDeviceMemory memory, VkDeviceSize offset,
                                           VkDeviceSize size)
{
    if (!o)
        return SOFTSH_ERROR_INVALID_ARGUMENT;
    const softsh_result result =
        softshi_block_bind(o->context, &o->block, memory, offset, size, "softsh_occluders_bind_memory");
    return result == SOFTSH_SUCCESS ? finish(o) : result;
}
