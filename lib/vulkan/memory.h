/* Host memory through the caller's callbacks, and the one block of device memory an object has. */
#ifndef SOFTSHI_MEMORY_H
#define SOFTSHI_MEMORY_H

#include "context.h"

void *softshi_host_allocate(const VkAllocationCallbacks *allocator, size_t size);
void softshi_host_free(const VkAllocationCallbacks *allocator, void *memory);

/* An object's buffer and optional image, one behind the other in one allocation. */
typedef struct softshi_block {
    VkBuffer buffer;
    VkImage image; /* may be VK_NULL_HANDLE */
    VkDeviceSize image_offset;
    VkMemoryRequirements requirements;
    VkDeviceMemory owned; /* VK_NULL_HANDLE if the memory is the caller's */
    bool bound;           /* or tried to be: Vulkan binds once */
    bool ready;           /* bound, and the object made usable with it */
} softshi_block;

/* Works out `requirements` and `image_offset` from buffer and image. */
void softshi_block_measure(const softsh_context *context, softshi_block *block);
/* Allocates and binds. */
softsh_result softshi_block_allocate(const softsh_context *context, softshi_block *block);
/* Binds the caller's memory. */
softsh_result softshi_block_bind(const softsh_context *context, softshi_block *block, VkDeviceMemory memory,
                                 VkDeviceSize offset, VkDeviceSize size, const char *call);
void softshi_block_destroy(const softsh_context *context, softshi_block *block);

#endif
