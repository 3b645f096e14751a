/* Host and device memory. */
#include "memory.h"

#include <stdlib.h>

void *softshi_host_allocate(const VkAllocationCallbacks *allocator, size_t size)
{
    if (allocator)
        return allocator->pfnAllocation(allocator->pUserData, size, _Alignof(max_align_t),
                                        VK_SYSTEM_ALLOCATION_SCOPE_OBJECT);
    return malloc(size);
}

void softshi_host_free(const VkAllocationCallbacks *allocator, void *memory)
{
    if (allocator)
        allocator->pfnFree(allocator->pUserData, memory);
    else
        free(memory);
}

softsh_result softshi_block_create(const softsh_context *context, softshi_block *block, VkDeviceSize size,
                                   const char *owner, const char *what)
{
    const VkBufferCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
        .size = size,
        .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                 VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT |
                 VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
        .sharingMode = VK_SHARING_MODE_EXCLUSIVE,
    };
    const VkResult result = context->vk.CreateBuffer(context->device, &info, context->allocator, &block->buffer);
    if (result != VK_SUCCESS) {
        block->buffer = VK_NULL_HANDLE;
        return softshi_fail_vulkan(context, result, "vkCreateBuffer");
    }
    softshi_name_object(context, VK_OBJECT_TYPE_BUFFER, (uint64_t)block->buffer, owner, what);
    context->vk.GetBufferMemoryRequirements(context->device, block->buffer, &block->requirements);
    return SOFTSH_SUCCESS;
}

static softsh_result bind(const softsh_context *context, softshi_block *block, VkDeviceMemory memory,
                          VkDeviceSize offset)
{
    block->bound = true;
    const VkResult result = context->vk.BindBufferMemory(context->device, block->buffer, memory, offset);
    if (result != VK_SUCCESS)
        return softshi_fail_vulkan(context, result, "vkBindBufferMemory");
    block->ready = true;
    return SOFTSH_SUCCESS;
}

static uint32_t choose_type(const softsh_context *context, uint32_t bits)
{
    uint32_t chosen = 0; /* a buffer suits at least one */
    bool local = false;
    for (uint32_t i = context->memory.memoryTypeCount; i-- > 0;) {
        const bool here = context->memory.memoryTypes[i].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
        if (!(bits & 1u << i) || (local && !here))
            continue;
        chosen = i;
        local = here;
    }
    return chosen;
}

softsh_result softshi_block_allocate(const softsh_context *context, softshi_block *block)
{
    const uint32_t type = choose_type(context, block->requirements.memoryTypeBits);
    const VkDeviceSize heap = context->memory.memoryHeaps[context->memory.memoryTypes[type].heapIndex].size;
    const VkDeviceSize most = heap < context->max_allocation ? heap : context->max_allocation;
    if (block->requirements.size > most)
        return softshi_fail(context, SOFTSH_ERROR_OUT_OF_DEVICE_MEMORY,
                            "the object needs %llu MiB, more than the %llu MiB the device gives in one allocation",
                            (unsigned long long)(block->requirements.size >> 20), (unsigned long long)(most >> 20));
    const VkMemoryAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
        .allocationSize = block->requirements.size,
        .memoryTypeIndex = type,
    };
    const VkResult result = context->vk.AllocateMemory(context->device, &info, context->allocator, &block->owned);
    if (result != VK_SUCCESS) {
        block->owned = VK_NULL_HANDLE;
        return softshi_fail_vulkan(context, result, "vkAllocateMemory");
    }
    return bind(context, block, block->owned, 0);
}

softsh_result softshi_block_bind(const softsh_context *context, softshi_block *block, VkDeviceMemory memory,
                                 VkDeviceSize offset, VkDeviceSize size, const char *call)
{
    if (block->owned)
        return softshi_fail(context, SOFTSH_ERROR_STATE, "%s: the object has the library's memory", call);
    if (block->bound)
        return softshi_fail(context, SOFTSH_ERROR_STATE, "%s: %s", call,
                            block->ready ? "memory is bound already"
                                         : "an earlier try failed, the object is of no use");
    if (!memory)
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT, "%s: memory is VK_NULL_HANDLE", call);
    if (offset % block->requirements.alignment != 0)
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT, "%s: offset is %llu, expected a multiple of %llu",
                            call, (unsigned long long)offset, (unsigned long long)block->requirements.alignment);
    if (size < block->requirements.size)
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT, "%s: size is %llu bytes, expected at least %llu",
                            call, (unsigned long long)size, (unsigned long long)block->requirements.size);
    return bind(context, block, memory, offset);
}

void softshi_block_destroy(const softsh_context *context, softshi_block *block)
{
    if (block->buffer)
        context->vk.DestroyBuffer(context->device, block->buffer, context->allocator);
    if (block->owned)
        context->vk.FreeMemory(context->device, block->owned, context->allocator);
    *block = (softshi_block){0};
}
