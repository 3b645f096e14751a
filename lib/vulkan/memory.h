/* Host memory through the caller's callbacks, and the one block of device memory an object has. */
#ifndef SOFTSHI_MEMORY_H
#define SOFTSHI_MEMORY_H

#include "context.h"

void *softshi_host_allocate(const VkAllocationCallbacks *allocator, size_t size);
void softshi_host_free(const VkAllocationCallbacks *allocator, void *memory);

/* An object's one buffer, and the memory under it. */
typedef struct softshi_block {
    VkBuffer buffer;
    VkMemoryRequirements requirements;
    VkDeviceMemory owned; /* VK_NULL_HANDLE if the memory is the caller's */
    bool bound;           /* or tried to be: Vulkan binds once */
    bool ready;           /* bound */
} softshi_block;

/* Makes the buffer, for every use the library has of one, and asks for its requirements. `owner` and `what` are its
 * name.
 */
softsh_result softshi_block_create(const softsh_context *context, softshi_block *block, VkDeviceSize size,
                                   const char *owner, const char *what);
/* Allocates and binds. */
softsh_result softshi_block_allocate(const softsh_context *context, softshi_block *block);
/* Binds the caller's memory. */
softsh_result softshi_block_bind(const softsh_context *context, softshi_block *block, VkDeviceMemory memory,
                                 VkDeviceSize offset, VkDeviceSize size, const char *call);
void softshi_block_destroy(const softsh_context *context, softshi_block *block);

#endif
