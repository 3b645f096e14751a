/* The context: what every object of one device shares. Immutable once created. */
#ifndef SOFTSHI_CONTEXT_H
#define SOFTSHI_CONTEXT_H

#include <stdbool.h>

#include <softshadow/softshadow.h>

#include "vulkan/functions.h"

struct softsh_context {
    softshi_functions vk;
    VkDevice device;
    VkPhysicalDevice physical_device;
    const VkAllocationCallbacks *allocator; /* NULL or &allocator_copy */
    VkAllocationCallbacks allocator_copy;
    VkPipelineCache pipeline_cache;
    softsh_message_fn message;
    void *message_user;
    VkPhysicalDeviceLimits limits;
    bool software;               /* a CPU takes the GPU's place */
    VkDeviceSize max_allocation; /* maxMemoryAllocationSize */
    VkPhysicalDeviceMemoryProperties memory;
    VkDescriptorSetLayout set_layouts[2]; /* SS_SET_OCCLUDERS, SS_SET_IO */
    VkPipelineLayout pipeline_layout;
};

#if defined(__GNUC__)
#define SOFTSHI_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define SOFTSHI_PRINTF(text, first)
#endif

/* Hands the sentence to the message callback and returns `result`. */
softsh_result softshi_fail(const softsh_context *context, softsh_result result, const char *format, ...)
    SOFTSHI_PRINTF(3, 4);

/* The result that goes with a VkResult, after telling the callback which call failed. */
softsh_result softshi_fail_vulkan(const softsh_context *context, VkResult result, const char *call);

/* Names an object for tools, where VK_EXT_debug_utils is there. */
void softshi_name_object(const softsh_context *context, VkObjectType type, uint64_t handle, const char *owner,
                         const char *what);

#endif
