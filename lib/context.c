/* Context creation: function table, limits and the two descriptor set layouts all passes share. */
#include "context.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "shared.h"
#include "validate.h"
#include "vulkan/memory.h"

enum { MAX_PUSH_CONSTANTS = 32 };

static void message(softsh_message_fn fn, void *user, softsh_result result, const char *format, va_list arguments)
{
    if (!fn)
        return;
    char text[512];
    vsnprintf(text, sizeof text, format, arguments);
    fn(user, result, text);
}

softsh_result softshi_fail(const softsh_context *context, softsh_result result, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    message(context->message, context->message_user, result, format, arguments);
    va_end(arguments);
    return result;
}

softsh_result softshi_fail_vulkan(const softsh_context *context, VkResult result, const char *call)
{
    softsh_result mapped = SOFTSH_ERROR_VULKAN;
    if (result == VK_ERROR_OUT_OF_HOST_MEMORY)
        mapped = SOFTSH_ERROR_OUT_OF_HOST_MEMORY;
    else if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_POOL_MEMORY ||
             result == VK_ERROR_FRAGMENTED_POOL)
        mapped = SOFTSH_ERROR_OUT_OF_DEVICE_MEMORY;
    return softshi_fail(context, mapped, "%s failed with VkResult %d", call, (int)result);
}

void softshi_name_object(const softsh_context *context, VkObjectType type, uint64_t handle, const char *owner,
                         const char *what)
{
    if (!context->vk.SetDebugUtilsObjectNameEXT || !handle)
        return;
    char name[128];
    snprintf(name, sizeof name, "%s: %s", owner, what);
    const VkDebugUtilsObjectNameInfoEXT info = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
        .objectType = type,
        .objectHandle = handle,
        .pObjectName = name,
    };
    context->vk.SetDebugUtilsObjectNameEXT(context->device, &info);
}

static VkResult create_set_layout(softsh_context *context, const VkDescriptorType *types, uint32_t count,
                                  VkDescriptorSetLayout *out)
{
    VkDescriptorSetLayoutBinding bindings[SS_OCCLUDER_BINDINGS];
    for (uint32_t i = 0; i < count; i++) {
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = i,
            .descriptorType = types[i],
            .descriptorCount = 1,
            .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT,
        };
    }
    const VkDescriptorSetLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = count,
        .pBindings = bindings,
    };
    const VkResult result = context->vk.CreateDescriptorSetLayout(context->device, &info, context->allocator, out);
    if (result != VK_SUCCESS)
        *out = VK_NULL_HANDLE; /* what a failed call leaves there is undefined */
    return result;
}

static VkResult create_layouts(softsh_context *context)
{
    static const VkDescriptorType occluders[SS_OCCLUDER_BINDINGS] = {
        [SS_BIND_OCCLUDERS] = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
        [SS_BIND_PLAN] = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
        [SS_BIND_MADE_DEPTH] = VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER,
        [SS_BIND_MADE_RANGES] = VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER,
        [SS_BIND_DEPTHS] = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
        [SS_BIND_DEPTH_QUADS] = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
        [SS_BIND_RANGES] = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
        [SS_BIND_BITS] = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
        [SS_BIND_MADE_BITS] = VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER,
    };
    static const VkDescriptorType io[SS_IO_BINDINGS] = {
        [SS_BIND_DEPTH] = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,      [SS_BIND_NORMALS] = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
        [SS_BIND_VISIBILITY] = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, [SS_BIND_FRAME] = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
        [SS_BIND_CONTROL] = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,   [SS_BIND_TILES] = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
        [SS_BIND_FILTER] = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
    };
    VkResult result =
        create_set_layout(context, occluders, SS_OCCLUDER_BINDINGS, &context->set_layouts[SS_SET_OCCLUDERS]);
    if (result == VK_SUCCESS)
        result = create_set_layout(context, io, SS_IO_BINDINGS, &context->set_layouts[SS_SET_IO]);
    if (result != VK_SUCCESS)
        return result;
    const VkPushConstantRange range = {VK_SHADER_STAGE_COMPUTE_BIT, 0, MAX_PUSH_CONSTANTS};
    const VkPipelineLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 2,
        .pSetLayouts = context->set_layouts,
        .pushConstantRangeCount = 1,
        .pPushConstantRanges = &range,
    };
    result = context->vk.CreatePipelineLayout(context->device, &info, context->allocator, &context->pipeline_layout);
    if (result != VK_SUCCESS)
        context->pipeline_layout = VK_NULL_HANDLE;
    return result;
}

static softsh_result initialize(softsh_context *context, const softsh_context_info *info)
{
    const char *missing = softshi_load_functions(info, &context->vk);
    if (missing)
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT,
                            "softsh_context_info: the proc-addr functions do not know %s", missing);
    softsh_requirements requirements = {.struct_size = sizeof requirements};
    const softsh_result known =
        softsh_get_requirements(info->get_instance_proc_addr, info->instance, info->physical_device, &requirements);
    if (known != SOFTSH_SUCCESS)
        return softshi_fail(context, known, "softsh_context_info::physical_device: its properties cannot be read");
    if (!requirements.supported)
        return softshi_fail(context, SOFTSH_ERROR_UNSUPPORTED,
                            "softsh_context_info::physical_device does not meet softsh_get_requirements");
    VkPhysicalDeviceMaintenance3Properties maintenance = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES};
    VkPhysicalDeviceProperties2 properties = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                              .pNext = &maintenance};
    context->vk.GetPhysicalDeviceProperties2(info->physical_device, &properties);
    context->limits = properties.properties.limits;
    context->software = properties.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    context->max_allocation = maintenance.maxMemoryAllocationSize;
    context->vk.GetPhysicalDeviceMemoryProperties(info->physical_device, &context->memory);
    const VkResult result = create_layouts(context);
    return result == VK_SUCCESS ? SOFTSH_SUCCESS : softshi_fail_vulkan(context, result, "creating the pipeline layout");
}

softsh_result softsh_context_create(const softsh_context_info *info, softsh_context **out)
{
    if (out)
        *out = NULL;
    /* Before there is a context, its message callback is the only part of it that is needed. */
    softsh_context early = {0};
    const softsh_result checked = softshi_check_context_info(&early, info, out);
    if (checked != SOFTSH_SUCCESS)
        return checked;
    softsh_context *context = softshi_host_allocate(info->allocation_callbacks, sizeof *context);
    if (!context)
        return softshi_fail(&early, SOFTSH_ERROR_OUT_OF_HOST_MEMORY, "no host memory for the context");
    memset(context, 0, sizeof *context);
    context->device = info->device;
    context->physical_device = info->physical_device;
    context->pipeline_cache = info->pipeline_cache;
    context->message = info->message;
    context->message_user = info->message_user;
    if (info->allocation_callbacks) {
        context->allocator_copy = *info->allocation_callbacks;
        context->allocator = &context->allocator_copy;
    }
    const softsh_result result = initialize(context, info);
    if (result != SOFTSH_SUCCESS) {
        softsh_context_destroy(context);
        return result;
    }
    *out = context;
    return SOFTSH_SUCCESS;
}

void softsh_context_destroy(softsh_context *context)
{
    if (!context)
        return;
    if (context->pipeline_layout)
        context->vk.DestroyPipelineLayout(context->device, context->pipeline_layout, context->allocator);
    for (int i = 0; i < 2; i++)
        if (context->set_layouts[i])
            context->vk.DestroyDescriptorSetLayout(context->device, context->set_layouts[i], context->allocator);
    /* The allocator lives in what is freed. */
    const VkAllocationCallbacks allocator = context->allocator_copy;
    softshi_host_free(context->allocator ? &allocator : NULL, context);
}
