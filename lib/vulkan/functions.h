/* The Vulkan functions the library calls, loaded through the caller's pointers: the loader is never linked. */
#ifndef SOFTSHI_FUNCTIONS_H
#define SOFTSHI_FUNCTIONS_H

#include <stdbool.h>

#include <softshadow/types.h>

#define SOFTSHI_INSTANCE_FUNCTIONS(X)                                                                                  \
    X(GetPhysicalDeviceProperties2)                                                                                    \
    X(GetPhysicalDeviceFormatProperties)                                                                               \
    X(GetPhysicalDeviceMemoryProperties)

#define SOFTSHI_DEVICE_FUNCTIONS(X)                                                                                    \
    X(CreateBuffer)                                                                                                    \
    X(DestroyBuffer)                                                                                                   \
    X(CreateBufferView)                                                                                                \
    X(DestroyBufferView)                                                                                               \
    X(GetBufferMemoryRequirements)                                                                                     \
    X(BindBufferMemory)                                                                                                \
    X(AllocateMemory)                                                                                                  \
    X(FreeMemory)                                                                                                      \
    X(CreateShaderModule)                                                                                              \
    X(DestroyShaderModule)                                                                                             \
    X(CreateDescriptorSetLayout)                                                                                       \
    X(DestroyDescriptorSetLayout)                                                                                      \
    X(CreatePipelineLayout)                                                                                            \
    X(DestroyPipelineLayout)                                                                                           \
    X(CreateComputePipelines)                                                                                          \
    X(DestroyPipeline)                                                                                                 \
    X(CreateDescriptorPool)                                                                                            \
    X(DestroyDescriptorPool)                                                                                           \
    X(AllocateDescriptorSets)                                                                                          \
    X(UpdateDescriptorSets)                                                                                            \
    X(CmdBindPipeline)                                                                                                 \
    X(CmdBindDescriptorSets)                                                                                           \
    X(CmdPushConstants)                                                                                                \
    X(CmdDispatch)                                                                                                     \
    X(CmdDispatchIndirect)                                                                                             \
    X(CmdPipelineBarrier)                                                                                              \
    X(CmdUpdateBuffer)                                                                                                 \
    X(CmdFillBuffer)                                                                                                   \
    X(CmdCopyBuffer)                                                                                                   \
    X(CmdWriteTimestamp)

/* Of VK_EXT_debug_utils; NULL without it. */
#define SOFTSHI_DEBUG_FUNCTIONS(X)                                                                                     \
    X(SetDebugUtilsObjectNameEXT)                                                                                      \
    X(CmdBeginDebugUtilsLabelEXT)                                                                                      \
    X(CmdEndDebugUtilsLabelEXT)

typedef struct softshi_functions {
#define SOFTSHI_MEMBER(name) PFN_vk##name name;
    SOFTSHI_INSTANCE_FUNCTIONS(SOFTSHI_MEMBER)
    SOFTSHI_DEVICE_FUNCTIONS(SOFTSHI_MEMBER)
    SOFTSHI_DEBUG_FUNCTIONS(SOFTSHI_MEMBER)
#undef SOFTSHI_MEMBER
} softshi_functions;

/* Returns NULL, or the name of a function that could not be loaded. */
const char *softshi_load_functions(const softsh_context_info *info, softshi_functions *out);

#endif
