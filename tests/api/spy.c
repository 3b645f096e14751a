/* The spy's wrappers. Every function the library asks for must be wrapped here or known to be harmless. */
#include "spy.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <threads.h>

enum { MOST_OBJECTS = 16384, MOST_BARRIERS = 512, NAME_SIZE = 64, HEADER_SIZE = 64 };

static struct {
    spy_counts counts;
    unsigned fail_at;
    VkResult fail_result;
    const char *failed_call, *hidden;
    unsigned drop_first, drop_count;
    char after_barrier[MOST_BARRIERS][NAME_SIZE];
    struct {
        const char *kind;
        uint64_t handle;
    } objects[MOST_OBJECTS];
    unsigned host_alive, host_fail_at;
    bool host_failed;
} spy;

static mtx_t lock;
static once_flag lock_made = ONCE_FLAG_INIT;
static thread_local bool in_driver;

static void make_lock(void)
{
    if (mtx_init(&lock, mtx_plain) != thrd_success)
        abort();
}

static void acquire(void)
{
    call_once(&lock_made, make_lock);
    mtx_lock(&lock);
}

static void release(void)
{
    mtx_unlock(&lock);
}

static void command(const char *name)
{
    acquire();
    spy.counts.commands++;
    if (spy.counts.barriers > 0 && spy.counts.barriers <= MOST_BARRIERS) {
        char *after = spy.after_barrier[spy.counts.barriers - 1];
        if (!after[0])
            snprintf(after, NAME_SIZE, "%s", name);
    }
    release();
}

static bool fails(const char *name, VkResult *result)
{
    acquire();
    spy.counts.creations++;
    const bool hit = spy.fail_at > 0 && --spy.fail_at == 0;
    if (hit) {
        *result = spy.fail_result;
        spy.failed_call = name;
    }
    release();
    return hit;
}

static void born(const char *kind, uint64_t handle)
{
    acquire();
    if (spy.counts.alive == MOST_OBJECTS)
        abort();
    spy.objects[spy.counts.alive].kind = kind;
    spy.objects[spy.counts.alive].handle = handle;
    spy.counts.alive++;
    release();
}

/* False if there was no such object: it must not reach the driver. */
static bool dies(const char *kind, uint64_t handle)
{
    bool found = false;
    acquire();
    for (unsigned i = 0; i < spy.counts.alive && !found; i++) {
        if (spy.objects[i].handle != handle || strcmp(spy.objects[i].kind, kind) != 0)
            continue;
        spy.objects[i] = spy.objects[--spy.counts.alive];
        found = true;
    }
    spy.counts.strangers += !found;
    release();
    return found;
}

#define CREATE(kind, call, info_type)                                                                                  \
    static PFN_vk##call real_##call;                                                                                   \
    static VKAPI_ATTR VkResult VKAPI_CALL wrap_##call(VkDevice device, const info_type *info,                          \
                                                      const VkAllocationCallbacks *allocator, Vk##kind *out)           \
    {                                                                                                                  \
        VkResult result;                                                                                               \
        if (fails("vk" #call, &result)) {                                                                              \
            memset(out, 0xab, sizeof *out);                                                                            \
            return result;                                                                                             \
        }                                                                                                              \
        in_driver = true;                                                                                              \
        result = real_##call(device, info, allocator, out);                                                            \
        in_driver = false;                                                                                             \
        if (result == VK_SUCCESS)                                                                                      \
            born(#kind, (uint64_t)*out);                                                                               \
        return result;                                                                                                 \
    }
#define DESTROY(kind, call)                                                                                            \
    static PFN_vk##call real_##call;                                                                                   \
    static VKAPI_ATTR void VKAPI_CALL wrap_##call(VkDevice device, Vk##kind handle,                                    \
                                                  const VkAllocationCallbacks *allocator)                              \
    {                                                                                                                  \
        if (handle && !dies(#kind, (uint64_t)handle))                                                                  \
            return;                                                                                                    \
        in_driver = true;                                                                                              \
        real_##call(device, handle, allocator);                                                                        \
        in_driver = false;                                                                                             \
    }
#define FALLIBLE(call, parameters, arguments)                                                                          \
    static PFN_vk##call real_##call;                                                                                   \
    static VKAPI_ATTR VkResult VKAPI_CALL wrap_##call parameters                                                       \
    {                                                                                                                  \
        VkResult result;                                                                                               \
        if (fails("vk" #call, &result))                                                                                \
            return result;                                                                                             \
        in_driver = true;                                                                                              \
        result = real_##call arguments;                                                                                \
        in_driver = false;                                                                                             \
        return result;                                                                                                 \
    }
#define COMMAND(call, parameters, arguments)                                                                           \
    static PFN_vk##call real_##call;                                                                                   \
    static VKAPI_ATTR void VKAPI_CALL wrap_##call parameters                                                           \
    {                                                                                                                  \
        command("vk" #call);                                                                                           \
        real_##call arguments;                                                                                         \
    }

CREATE(Buffer, CreateBuffer, VkBufferCreateInfo)
DESTROY(Buffer, DestroyBuffer)
CREATE(BufferView, CreateBufferView, VkBufferViewCreateInfo)
DESTROY(BufferView, DestroyBufferView)
CREATE(DeviceMemory, AllocateMemory, VkMemoryAllocateInfo)
DESTROY(DeviceMemory, FreeMemory)
CREATE(ShaderModule, CreateShaderModule, VkShaderModuleCreateInfo)
DESTROY(ShaderModule, DestroyShaderModule)
CREATE(DescriptorSetLayout, CreateDescriptorSetLayout, VkDescriptorSetLayoutCreateInfo)
DESTROY(DescriptorSetLayout, DestroyDescriptorSetLayout)
CREATE(PipelineLayout, CreatePipelineLayout, VkPipelineLayoutCreateInfo)
DESTROY(PipelineLayout, DestroyPipelineLayout)
CREATE(DescriptorPool, CreateDescriptorPool, VkDescriptorPoolCreateInfo)
DESTROY(DescriptorPool, DestroyDescriptorPool)
DESTROY(Pipeline, DestroyPipeline)
FALLIBLE(BindBufferMemory, (VkDevice device, VkBuffer buffer, VkDeviceMemory memory, VkDeviceSize offset),
         (device, buffer, memory, offset))
COMMAND(CmdBindPipeline, (VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipeline pipeline), (cmd, point, pipeline))
COMMAND(CmdBindDescriptorSets,
        (VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipelineLayout layout, uint32_t first, uint32_t count,
         const VkDescriptorSet *sets, uint32_t offset_count, const uint32_t *offsets),
        (cmd, point, layout, first, count, sets, offset_count, offsets))
COMMAND(CmdPushConstants,
        (VkCommandBuffer cmd, VkPipelineLayout layout, VkShaderStageFlags stages, uint32_t offset, uint32_t size,
         const void *values),
        (cmd, layout, stages, offset, size, values))
COMMAND(CmdDispatch, (VkCommandBuffer cmd, uint32_t x, uint32_t y, uint32_t z), (cmd, x, y, z))
COMMAND(CmdDispatchIndirect, (VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset), (cmd, buffer, offset))
COMMAND(CmdUpdateBuffer,
        (VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size, const void *data),
        (cmd, buffer, offset, size, data))
COMMAND(CmdFillBuffer, (VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size, uint32_t data),
        (cmd, buffer, offset, size, data))
COMMAND(CmdCopyBuffer, (VkCommandBuffer cmd, VkBuffer from, VkBuffer to, uint32_t count, const VkBufferCopy *regions),
        (cmd, from, to, count, regions))
COMMAND(CmdWriteTimestamp, (VkCommandBuffer cmd, VkPipelineStageFlagBits stage, VkQueryPool pool, uint32_t query),
        (cmd, stage, pool, query))
COMMAND(CmdEndDebugUtilsLabelEXT, (VkCommandBuffer cmd), (cmd))

static PFN_vkCmdBeginDebugUtilsLabelEXT real_CmdBeginDebugUtilsLabelEXT;
static VKAPI_ATTR void VKAPI_CALL wrap_CmdBeginDebugUtilsLabelEXT(VkCommandBuffer cmd,
                                                                  const VkDebugUtilsLabelEXT *label)
{
    command(label->pLabelName);
    real_CmdBeginDebugUtilsLabelEXT(cmd, label);
}

static PFN_vkSetDebugUtilsObjectNameEXT real_SetDebugUtilsObjectNameEXT;
static VKAPI_ATTR VkResult VKAPI_CALL wrap_SetDebugUtilsObjectNameEXT(VkDevice device,
                                                                      const VkDebugUtilsObjectNameInfoEXT *info)
{
    return real_SetDebugUtilsObjectNameEXT(device, info);
}

static PFN_vkCmdPipelineBarrier real_CmdPipelineBarrier;
static VKAPI_ATTR void VKAPI_CALL wrap_CmdPipelineBarrier(VkCommandBuffer cmd, VkPipelineStageFlags from,
                                                          VkPipelineStageFlags to, VkDependencyFlags flags,
                                                          uint32_t memory_count, const VkMemoryBarrier *memory,
                                                          uint32_t buffer_count, const VkBufferMemoryBarrier *buffers,
                                                          uint32_t image_count, const VkImageMemoryBarrier *images)
{
    command("vkCmdPipelineBarrier");
    acquire();
    const bool drop = spy.counts.barriers - spy.drop_first < spy.drop_count; /* wraps */
    spy.counts.barriers++;
    if (spy.counts.barriers <= MOST_BARRIERS)
        spy.after_barrier[spy.counts.barriers - 1][0] = '\0';
    release();
    if (!drop)
        real_CmdPipelineBarrier(cmd, from, to, flags, memory_count, memory, buffer_count, buffers, image_count, images);
}

static PFN_vkUpdateDescriptorSets real_UpdateDescriptorSets;
static VKAPI_ATTR void VKAPI_CALL wrap_UpdateDescriptorSets(VkDevice device, uint32_t write_count,
                                                            const VkWriteDescriptorSet *writes, uint32_t copy_count,
                                                            const VkCopyDescriptorSet *copies)
{
    acquire();
    spy.counts.updates++;
    release();
    real_UpdateDescriptorSets(device, write_count, writes, copy_count, copies);
}

static PFN_vkCreateComputePipelines real_CreateComputePipelines;
static VKAPI_ATTR VkResult VKAPI_CALL wrap_CreateComputePipelines(VkDevice device, VkPipelineCache cache,
                                                                  uint32_t count,
                                                                  const VkComputePipelineCreateInfo *infos,
                                                                  const VkAllocationCallbacks *allocator,
                                                                  VkPipeline *out)
{
    VkResult result;
    if (fails("vkCreateComputePipelines", &result)) {
        memset(out, 0, count * sizeof *out); /* specified so, unlike for other objects */
        return result;
    }
    in_driver = true;
    result = real_CreateComputePipelines(device, cache, count, infos, allocator, out);
    in_driver = false;
    for (uint32_t i = 0; i < count; i++)
        if (out[i])
            born("Pipeline", (uint64_t)out[i]);
    return result;
}

static PFN_vkAllocateDescriptorSets real_AllocateDescriptorSets;
static VKAPI_ATTR VkResult VKAPI_CALL wrap_AllocateDescriptorSets(VkDevice device,
                                                                  const VkDescriptorSetAllocateInfo *info,
                                                                  VkDescriptorSet *out)
{
    VkResult result;
    if (fails("vkAllocateDescriptorSets", &result)) {
        memset(out, 0, info->descriptorSetCount * sizeof *out);
        return result;
    }
    in_driver = true;
    result = real_AllocateDescriptorSets(device, info, out);
    in_driver = false;
    return result;
}

#define WRAPPED(X)                                                                                                     \
    X(CreateBuffer)                                                                                                    \
    X(DestroyBuffer)                                                                                                   \
    X(CreateBufferView)                                                                                                \
    X(DestroyBufferView)                                                                                               \
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
    X(BindBufferMemory)                                                                                                \
    X(CmdBindPipeline)                                                                                                 \
    X(CmdBindDescriptorSets)                                                                                           \
    X(CmdPushConstants)                                                                                                \
    X(CmdDispatch)                                                                                                     \
    X(CmdDispatchIndirect)                                                                                             \
    X(CmdPipelineBarrier)                                                                                              \
    X(CmdUpdateBuffer)                                                                                                 \
    X(CmdFillBuffer)                                                                                                   \
    X(CmdCopyBuffer)                                                                                                   \
    X(CmdWriteTimestamp)                                                                                               \
    X(SetDebugUtilsObjectNameEXT)                                                                                      \
    X(CmdBeginDebugUtilsLabelEXT)                                                                                      \
    X(CmdEndDebugUtilsLabelEXT)

/* What is neither a recording nor an object's birth or death passes through; everything else a compute library has no
 * business with. */
static bool is_query(const char *name)
{
    return !strncmp(name, "vkGet", 5) && !strstr(name, "Queue") && !strstr(name, "Fence");
}

static PFN_vkVoidFunction through(PFN_vkVoidFunction real, const char *name)
{
    if (!is_query(name)) {
        acquire();
        spy.counts.forbidden++;
        release();
        fprintf(stderr, "the library asks for %s, which the spy does not know\n", name);
        return NULL;
    }
    return real;
}

PFN_vkVoidFunction VKAPI_CALL spy_get_instance_proc_addr(VkInstance instance, const char *name)
{
    if (spy.hidden && !strcmp(name, spy.hidden))
        return NULL;
    return through(vkGetInstanceProcAddr(instance, name), name);
}

PFN_vkVoidFunction VKAPI_CALL spy_get_device_proc_addr(VkDevice device, const char *name)
{
    const PFN_vkVoidFunction real = vkGetDeviceProcAddr(device, name);
    if (!real || (spy.hidden && !strcmp(name, spy.hidden)))
        return NULL;
#define WRAP(call)                                                                                                     \
    if (!strcmp(name, "vk" #call)) {                                                                                   \
        real_##call = (PFN_vk##call)real;                                                                              \
        return (PFN_vkVoidFunction)wrap_##call;                                                                        \
    }
    WRAPPED(WRAP)
#undef WRAP
    return through(real, name);
}

spy_counts spy_read(void)
{
    acquire();
    const spy_counts counts = spy.counts;
    release();
    return counts;
}

void spy_fail(unsigned k, VkResult result)
{
    spy.fail_at = k;
    spy.fail_result = result;
    spy.failed_call = NULL;
}

const char *spy_failed_call(void)
{
    return spy.failed_call;
}

void spy_hide(const char *name)
{
    spy.hidden = name;
}

void spy_drop_barriers(unsigned first, unsigned count)
{
    spy.counts.barriers = 0;
    spy.drop_first = first;
    spy.drop_count = count;
}

const char *spy_after_barrier(unsigned k)
{
    return k < MOST_BARRIERS && k < spy.counts.barriers ? spy.after_barrier[k] : "";
}

/* Header in front of every allocation: where malloc's block begins, and the size. */
typedef struct host_header {
    void *block;
    size_t size;
} host_header;

static void *VKAPI_CALL allocate(void *user, size_t size, size_t alignment, VkSystemAllocationScope scope)
{
    (void)user;
    (void)scope;
    acquire();
    const bool fail = !in_driver && spy.host_fail_at > 0 && --spy.host_fail_at == 0;
    spy.host_failed = spy.host_failed || fail;
    spy.host_alive += !fail;
    release();
    if (fail)
        return NULL;
    if (alignment < HEADER_SIZE)
        alignment = HEADER_SIZE;
    char *block = malloc(size + 2 * alignment);
    if (!block)
        abort();
    char *memory = (char *)(((uintptr_t)block + 2 * alignment - 1) / alignment * alignment);
    memcpy(memory - sizeof(host_header), &(host_header){block, size}, sizeof(host_header));
    memset(memory, 0xab, size);
    return memory;
}

static void VKAPI_CALL deallocate(void *user, void *memory)
{
    (void)user;
    if (!memory)
        return;
    host_header header;
    memcpy(&header, (char *)memory - sizeof header, sizeof header);
    free(header.block);
    acquire();
    spy.host_alive--;
    release();
}

static void *VKAPI_CALL reallocate(void *user, void *memory, size_t size, size_t alignment,
                                   VkSystemAllocationScope scope)
{
    if (size == 0) {
        deallocate(user, memory);
        return NULL;
    }
    void *grown = allocate(user, size, alignment, scope);
    if (grown && memory) {
        host_header header;
        memcpy(&header, (char *)memory - sizeof header, sizeof header);
        memcpy(grown, memory, header.size < size ? header.size : size);
        deallocate(user, memory);
    }
    return grown;
}

const VkAllocationCallbacks *spy_allocator(void)
{
    static const VkAllocationCallbacks callbacks = {
        .pfnAllocation = allocate, .pfnReallocation = reallocate, .pfnFree = deallocate};
    return &callbacks;
}

void spy_fail_host(unsigned k)
{
    spy.host_fail_at = k;
    spy.host_failed = false;
}

bool spy_host_failed(void)
{
    return spy.host_failed;
}

unsigned spy_host_alive(void)
{
    acquire();
    const unsigned alive = spy.host_alive;
    release();
    return alive;
}
