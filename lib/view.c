/* Creation and destruction of the view object. */
#include "view.h"

#include <stdio.h>
#include <string.h>

#include "techniques/settings.h"
#include "techniques/techniques.h"
#include "validate.h"

static softsh_result check_limits(const softsh_view *v)
{
    const softsh_context *context = v->context;
    const VkDeviceSize most = context->limits.maxStorageBufferRange;
    if (v->layout.filter.size > most || v->layout.tiles.size > most)
        return softshi_fail(
            context, SOFTSH_ERROR_LIMIT,
            "softsh_view_info: scratch for %u x %u takes %llu MiB, the device's maxStorageBufferRange is %llu MiB",
            v->max_extent.width, v->max_extent.height,
            (unsigned long long)((v->layout.filter.size > most ? v->layout.filter.size : v->layout.tiles.size) >> 20),
            (unsigned long long)(most >> 20));
    return SOFTSH_SUCCESS;
}

static softsh_result create_sets(softsh_view *v, uint32_t recordings)
{
    const softsh_context *context = v->context;
    v->io_set_count = recordings;
    v->io_sets = softshi_host_allocate(context->allocator, recordings * sizeof *v->io_sets);
    if (!v->io_sets)
        return softshi_fail(context, SOFTSH_ERROR_OUT_OF_HOST_MEMORY, "no host memory for %u descriptor sets",
                            recordings);
    const VkDescriptorPoolSize sizes[] = {
        {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, recordings},
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 3 * recordings},
        {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 2 * recordings},
        {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, recordings},
    };
    const VkDescriptorPoolCreateInfo pool_info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .maxSets = recordings,
        .poolSizeCount = 4,
        .pPoolSizes = sizes,
    };
    VkResult result = context->vk.CreateDescriptorPool(context->device, &pool_info, context->allocator, &v->pool);
    if (result != VK_SUCCESS) {
        v->pool = VK_NULL_HANDLE;
        return softshi_fail_vulkan(context, result, "vkCreateDescriptorPool");
    }
    const VkDescriptorSetAllocateInfo set_info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
        .descriptorPool = v->pool,
        .descriptorSetCount = 1,
        .pSetLayouts = &context->set_layouts[SS_SET_IO],
    };
    for (uint32_t i = 0; i < recordings && result == VK_SUCCESS; i++)
        result = context->vk.AllocateDescriptorSets(context->device, &set_info, &v->io_sets[i]);
    return result == VK_SUCCESS ? SOFTSH_SUCCESS : softshi_fail_vulkan(context, result, "vkAllocateDescriptorSets");
}

static softsh_result create_pipelines(softsh_view *v)
{
    softshi_specialization constants = softshi_settings_specialize(&v->settings, v->normals, v->stats);
    constants.values[SS_SPEC_SUBLIGHTS] = v->sublights;
    softsh_result result = softshi_classify_create(v, &constants);
    if (result == SOFTSH_SUCCESS)
        result = softshi_settings_in_packets(&v->settings) ? softshi_contour_create(v, &constants)
                 : softshi_settings_separate(&v->settings) ? softshi_separate_create(v, &constants)
                 : v->settings.outline                     ? softshi_outline_create(v, &constants)
                                                           : softshi_bitmask_create(v, &constants);
    if (result == SOFTSH_SUCCESS && v->settings.sparse)
        result = softshi_interpolate_create(v, &constants);
    if (result == SOFTSH_SUCCESS)
        result = softshi_hard_create(v, &constants);
    if (result == SOFTSH_SUCCESS && v->settings.filter_passes > 0)
        result = softshi_post_filter_create(v, &constants);
    if (result == SOFTSH_SUCCESS && v->sublights)
        result = softshi_combine_create(v, &constants);
    return result;
}

softsh_result softsh_view_create(softsh_context *context, const softsh_view_info *info, softsh_view **out)
{
    if (out)
        *out = NULL;
    if (!context)
        return SOFTSH_ERROR_INVALID_ARGUMENT;
    softsh_result result = softshi_check_view_info(context, info, out);
    if (result != SOFTSH_SUCCESS)
        return result;
    softsh_view *v = softshi_host_allocate(context->allocator, sizeof *v);
    if (!v)
        return softshi_fail(context, SOFTSH_ERROR_OUT_OF_HOST_MEMORY, "no host memory for the view");
    memset(v, 0, sizeof *v);
    v->context = context;
    snprintf(v->name, sizeof v->name, "%s", info->name ? info->name : "softshadow");
    v->max_extent = info->max_extent;
    v->output_format = info->output_format;
    v->settings = softshi_settings_resolve(info->settings, context->software);
    v->stats = info->stats != 0;
    v->normals = info->normals != 0;
    v->sublights = info->sublights != 0;
    softshi_layout_view(v->max_extent, &v->settings, v->sublights, &v->layout);
    result = check_limits(v);
    if (result == SOFTSH_SUCCESS)
        result = softshi_block_create(context, &v->block, v->layout.buffer_size, v->name, "view scratch");
    if (result == SOFTSH_SUCCESS)
        result = create_sets(v, info->max_recordings ? info->max_recordings : 16);
    if (result == SOFTSH_SUCCESS)
        result = create_pipelines(v);
    if (result == SOFTSH_SUCCESS && info->memory_mode == SOFTSH_MEMORY_LIBRARY)
        result = softshi_block_allocate(context, &v->block);
    if (result != SOFTSH_SUCCESS) {
        softsh_view_destroy(v);
        return result;
    }
    *out = v;
    return SOFTSH_SUCCESS;
}

void softsh_view_destroy(softsh_view *v)
{
    if (!v)
        return;
    const softsh_context *context = v->context;
    softshi_view_pipelines *p = &v->pipelines;
    softshi_pipeline_destroy(context, &p->classify_columns);
    softshi_pipeline_destroy(context, &p->classify_tiles);
    softshi_pipeline_destroy(context, &p->classify_pixels);
    for (int list = 0; list < SS_LISTS; list++)
        softshi_pipeline_destroy(context, &p->evaluate[list]);
    softshi_pipeline_destroy(context, &p->evaluate_layered);
    softshi_pipeline_destroy(context, &p->interpolate);
    softshi_pipeline_destroy(context, &p->hard);
    softshi_pipeline_destroy(context, &p->filter);
    softshi_pipeline_destroy(context, &p->combine);
    if (v->pool)
        context->vk.DestroyDescriptorPool(context->device, v->pool, context->allocator);
    softshi_block_destroy(context, &v->block);
    if (v->io_sets)
        softshi_host_free(context->allocator, v->io_sets);
    softshi_host_free(context->allocator, v);
}

softsh_result softsh_view_memory_requirements(const softsh_view *v, VkMemoryRequirements *out)
{
    if (!v)
        return SOFTSH_ERROR_INVALID_ARGUMENT;
    if (!out)
        return softshi_fail(v->context, SOFTSH_ERROR_INVALID_ARGUMENT, "softsh_view_memory_requirements: out is NULL");
    *out = v->block.requirements;
    return SOFTSH_SUCCESS;
}

softsh_result softsh_view_bind_memory(softsh_view *v, VkDeviceMemory memory, VkDeviceSize offset, VkDeviceSize size)
{
    if (!v)
        return SOFTSH_ERROR_INVALID_ARGUMENT;
    return softshi_block_bind(v->context, &v->block, memory, offset, size, "softsh_view_bind_memory");
}
