/* Compute pipelines of the manifest's shaders. */
#include "pipeline.h"

softsh_result softshi_pipeline_create(const softsh_context *context, softshi_shader shader,
                                      const softshi_specialization *specialization, softshi_pipeline *out)
{
    const softshi_shader_code *code = &softshi_shaders[shader];
    const VkShaderModuleCreateInfo module_info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
        .codeSize = code->size,
        .pCode = code->words,
    };
    VkShaderModule module;
    VkResult result = context->vk.CreateShaderModule(context->device, &module_info, context->allocator, &module);
    if (result != VK_SUCCESS)
        return softshi_fail_vulkan(context, result, "vkCreateShaderModule");
    VkSpecializationMapEntry entries[SS_SPEC_COUNT + 1];
    for (uint32_t i = 0; i <= SS_SPEC_COUNT; i++)
        entries[i] = (VkSpecializationMapEntry){i, i * (uint32_t)sizeof(uint32_t), sizeof(uint32_t)};
    const VkSpecializationInfo specialization_info = {
        .mapEntryCount = SS_SPEC_COUNT + 1,
        .pMapEntries = entries,
        .dataSize = sizeof specialization->values,
        .pData = specialization->values,
    };
    const VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage =
            {
                .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                .module = module,
                .pName = "main",
                .pSpecializationInfo = &specialization_info,
            },
        .layout = context->pipeline_layout,
    };
    result = context->vk.CreateComputePipelines(context->device, context->pipeline_cache, 1, &info, context->allocator,
                                                &out->handle);
    context->vk.DestroyShaderModule(context->device, module, context->allocator);
    if (result != VK_SUCCESS) {
        out->handle = VK_NULL_HANDLE;
        return softshi_fail_vulkan(context, result, "vkCreateComputePipelines");
    }
    out->name = code->name;
    softshi_name_object(context, VK_OBJECT_TYPE_PIPELINE, (uint64_t)out->handle, "softshadow", code->name);
    return SOFTSH_SUCCESS;
}

void softshi_pipeline_destroy(const softsh_context *context, softshi_pipeline *pipeline)
{
    if (pipeline->handle)
        context->vk.DestroyPipeline(context->device, pipeline->handle, context->allocator);
    pipeline->handle = VK_NULL_HANDLE;
}
