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

static VkDeviceSize align(VkDeviceSize value, VkDeviceSize alignment)
{
    return (value + alignment - 1) / alignment * alignment;
}

void softshi_block_measure(const softsh_context *context, softshi_block *block)
{
    context->vk.GetBufferMemoryRequirements(context->device, block->buffer, &block->requirements);
    if (!block->image)
        return;
    VkMemoryRequirements image;
    context->vk.GetImageMemoryRequirements(context->device, block->image, &image);
    /* Buffer and image in one block: keep them apart by the device's granularity. */
    VkDeviceSize alignment = image.alignment;
    if (alignment < context->limits.bufferImageGranularity)
        alignment = context->limits.bufferImageGranularity;
    block->image_offset = align(block->requirements.size, alignment);
    block->requirements.size = block->image_offset + image.size;
    if (block->requirements.alignment < alignment)
        block->requirements.alignment = alignment;
    block->requirements.memoryTypeBits &= image.memoryTypeBits;
}

static softsh_result bind(const softsh_context *context, softshi_block *block, VkDeviceMemory memory,
                          VkDeviceSize offset)
{
    block->bound = true;
    VkResult result = context->vk.BindBufferMemory(context->device, block->buffer, memory, offset);
    if (result == VK_SUCCESS && block->image)
        result = context->vk.BindImageMemory(context->device, block->image, memory, offset + block->image_offset);
    if (result != VK_SUCCESS)
        return softshi_fail_vulkan(context, result, "binding memory");
    block->ready = true;
    return SOFTSH_SUCCESS;
}

static uint32_t choose_type(const softsh_context *context, uint32_t bits)
{
    uint32_t any = UINT32_MAX;
    for (uint32_t i = 0; i < context->memory.memoryTypeCount; i++) {
        if (!(bits & 1u << i))
            continue;
        if (context->memory.memoryTypes[i].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)
            return i;
        if (any == UINT32_MAX)
            any = i;
    }
    return any;
}

softsh_result softshi_block_allocate(const softsh_context *context, softshi_block *block)
{
    const uint32_t type = choose_type(context, block->requirements.memoryTypeBits);
    if (type == UINT32_MAX)
        return softshi_fail(context, SOFTSH_ERROR_UNSUPPORTED, "no memory type suits both a buffer and an image");
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
    if (block->image)
        context->vk.DestroyImage(context->device, block->image, context->allocator);
    if (block->owned)
        context->vk.FreeMemory(context->device, block->owned, context->allocator);
    *block = (softshi_block){0};
}
