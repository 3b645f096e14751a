/* Images, buffers, transfers and one-time command buffers of gpu.h. Every transfer blocks, and every barrier here is
 * the full one: these helpers set tests and tools up, they are never measured. */
#include "gpu.h"

#include <stdio.h>
#include <string.h>

static bool fail(gpu *g, const char *what, VkResult result)
{
    snprintf(g->error, sizeof g->error, "%s failed (VkResult %d)", what, (int)result);
    return false;
}

static VkImageAspectFlags format_aspect(VkFormat format)
{
    switch (format) {
    case VK_FORMAT_D16_UNORM:
    case VK_FORMAT_X8_D24_UNORM_PACK32:
    case VK_FORMAT_D32_SFLOAT:
        return VK_IMAGE_ASPECT_DEPTH_BIT;
    case VK_FORMAT_D16_UNORM_S8_UINT:
    case VK_FORMAT_D24_UNORM_S8_UINT:
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
        return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    default:
        return VK_IMAGE_ASPECT_COLOR_BIT;
    }
}

/* Depth-stencil formats count their depth aspect as buffer copies pack it. */
size_t gpu_format_size(VkFormat format)
{
    switch (format) {
    case VK_FORMAT_R8_UNORM:
    case VK_FORMAT_R8_SNORM:
    case VK_FORMAT_R8_UINT:
        return 1;
    case VK_FORMAT_R8G8_UNORM:
    case VK_FORMAT_R16_UNORM:
    case VK_FORMAT_R16_SFLOAT:
    case VK_FORMAT_R16_UINT:
    case VK_FORMAT_D16_UNORM:
    case VK_FORMAT_D16_UNORM_S8_UINT:
        return 2;
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_R8G8B8A8_SRGB:
    case VK_FORMAT_R8G8B8A8_SNORM:
    case VK_FORMAT_B8G8R8A8_UNORM:
    case VK_FORMAT_B8G8R8A8_SRGB:
    case VK_FORMAT_A2B10G10R10_UNORM_PACK32:
    case VK_FORMAT_R16G16_SFLOAT:
    case VK_FORMAT_R16G16_UNORM:
    case VK_FORMAT_R32_SFLOAT:
    case VK_FORMAT_R32_UINT:
    case VK_FORMAT_R32_SINT:
    case VK_FORMAT_X8_D24_UNORM_PACK32:
    case VK_FORMAT_D32_SFLOAT:
    case VK_FORMAT_D24_UNORM_S8_UINT:
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
        return 4;
    case VK_FORMAT_R16G16B16A16_SFLOAT:
    case VK_FORMAT_R16G16B16A16_UNORM:
    case VK_FORMAT_R32G32_SFLOAT:
    case VK_FORMAT_R32G32_UINT:
        return 8;
    case VK_FORMAT_R32G32B32A32_SFLOAT:
    case VK_FORMAT_R32G32B32A32_UINT:
        return 16;
    default:
        return 0;
    }
}

/* The first allowed type with all of `required`, preferring one with `preferred` too; UINT32_MAX if none. */
static uint32_t find_memory_type(const gpu *g, uint32_t allowed, VkMemoryPropertyFlags required,
                                 VkMemoryPropertyFlags preferred)
{
    VkPhysicalDeviceMemoryProperties properties;
    uint32_t fallback = UINT32_MAX;

    vkGetPhysicalDeviceMemoryProperties(g->physical_device, &properties);
    for (uint32_t i = 0; i < properties.memoryTypeCount; i++) {
        const VkMemoryPropertyFlags flags = properties.memoryTypes[i].propertyFlags;
        if (!(allowed >> i & 1u) || (flags & required) != required)
            continue;
        if ((flags & preferred) == preferred)
            return i;
        if (fallback == UINT32_MAX)
            fallback = i;
    }
    return fallback;
}

static bool allocate(gpu *g, const VkMemoryRequirements *requirements, VkMemoryPropertyFlags required,
                     VkMemoryPropertyFlags preferred, VkDeviceMemory *memory)
{
    const VkMemoryAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
        .allocationSize = requirements->size,
        .memoryTypeIndex = find_memory_type(g, requirements->memoryTypeBits, required, preferred),
    };
    VkResult result;

    if (info.memoryTypeIndex == UINT32_MAX) {
        snprintf(g->error, sizeof g->error, "no suitable memory type");
        return false;
    }
    result = vkAllocateMemory(g->device, &info, NULL, memory);
    return result == VK_SUCCESS || fail(g, "vkAllocateMemory", result);
}

bool gpu_image_create(gpu *g, const gpu_image_info *info, gpu_image *out)
{
    const uint32_t layers = info->layers ? info->layers : 1;
    const VkImageAspectFlags aspect = format_aspect(info->format);
    const VkImageCreateInfo create = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .imageType = VK_IMAGE_TYPE_2D,
        .format = info->format,
        .extent = {info->width, info->height, 1},
        .mipLevels = 1,
        .arrayLayers = layers,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .tiling = VK_IMAGE_TILING_OPTIMAL,
        .usage = info->usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
        .sharingMode = VK_SHARING_MODE_EXCLUSIVE,
        .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
    };
    VkImageViewCreateInfo view = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .viewType = layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D,
        .format = info->format,
        .subresourceRange = {aspect & VK_IMAGE_ASPECT_DEPTH_BIT ? VK_IMAGE_ASPECT_DEPTH_BIT : aspect, 0, 1, 0, layers},
    };
    /* Transfers only: Vulkan forbids a view. */
    const bool needs_view =
        (info->usage & ~(VkImageUsageFlags)(VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT)) != 0;
    VkImageFormatProperties limits;
    VkMemoryRequirements requirements;
    VkResult result;

    memset(out, 0, sizeof *out);
    out->format = info->format;
    out->width = info->width;
    out->height = info->height;
    out->layers = layers;
    out->aspect = aspect;
    out->layout = VK_IMAGE_LAYOUT_UNDEFINED;
    result = vkGetPhysicalDeviceImageFormatProperties(g->physical_device, create.format, create.imageType,
                                                      create.tiling, create.usage, 0, &limits);
    if (result != VK_SUCCESS) {
        snprintf(g->error, sizeof g->error, "image format %d is not supported with usage 0x%x", (int)info->format,
                 (unsigned)create.usage);
        return false;
    }
    if (info->width < 1 || info->height < 1 || info->width > limits.maxExtent.width ||
        info->height > limits.maxExtent.height || layers > limits.maxArrayLayers) {
        snprintf(g->error, sizeof g->error, "image size %ux%u with %u layers is outside 1..%ux%u with %u",
                 (unsigned)info->width, (unsigned)info->height, (unsigned)layers, (unsigned)limits.maxExtent.width,
                 (unsigned)limits.maxExtent.height, (unsigned)limits.maxArrayLayers);
        return false;
    }
    result = vkCreateImage(g->device, &create, NULL, &out->image);
    if (result != VK_SUCCESS) {
        fail(g, "vkCreateImage", result);
        goto error;
    }
    vkGetImageMemoryRequirements(g->device, out->image, &requirements);
    if (!allocate(g, &requirements, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, &out->memory))
        goto error;
    result = vkBindImageMemory(g->device, out->image, out->memory, 0);
    if (result != VK_SUCCESS) {
        fail(g, "vkBindImageMemory", result);
        goto error;
    }
    if (needs_view) {
        view.image = out->image;
        result = vkCreateImageView(g->device, &view, NULL, &out->view);
        if (result != VK_SUCCESS) {
            fail(g, "vkCreateImageView", result);
            goto error;
        }
    }
    return true;
error:
    gpu_image_destroy(g, out);
    return false;
}

void gpu_image_destroy(gpu *g, gpu_image *image)
{
    if (image && g->device) {
        vkDestroyImageView(g->device, image->view, NULL);
        vkDestroyImage(g->device, image->image, NULL);
        vkFreeMemory(g->device, image->memory, NULL);
        memset(image, 0, sizeof *image);
    }
}

void gpu_cmd_image_layout(VkCommandBuffer cmd, gpu_image *image, VkImageLayout layout)
{
    const VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
        .oldLayout = image->layout,
        .newLayout = layout,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image->image,
        .subresourceRange = {image->aspect, 0, 1, 0, image->layers},
    };

    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, NULL, 0,
                         NULL, 1, &barrier);
    image->layout = layout;
}

static VkBufferImageCopy whole_image(const gpu_image *image)
{
    const VkBufferImageCopy copy = {
        .imageSubresource = {image->aspect & VK_IMAGE_ASPECT_DEPTH_BIT ? VK_IMAGE_ASPECT_DEPTH_BIT : image->aspect, 0,
                             0, image->layers},
        .imageExtent = {image->width, image->height, 1},
    };

    return copy;
}

static bool check_size(gpu *g, const gpu_image *image, size_t size)
{
    const size_t wanted = (size_t)image->width * image->height * image->layers * gpu_format_size(image->format);

    if (wanted == 0)
        snprintf(g->error, sizeof g->error, "image format %d has no known texel size", (int)image->format);
    else if (wanted != size)
        snprintf(g->error, sizeof g->error, "image transfer of %zu bytes, expected %zu", size, wanted);
    return wanted != 0 && wanted == size;
}

bool gpu_image_upload(gpu *g, gpu_image *image, const void *texels, size_t size, VkImageLayout layout)
{
    const VkBufferImageCopy copy = whole_image(image);
    gpu_buffer staging = {0};
    VkCommandBuffer cmd;
    bool ok;

    if (!check_size(g, image, size) || !gpu_buffer_create(g, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, true, &staging))
        return false;
    memcpy(staging.mapped, texels, size);
    cmd = gpu_begin(g);
    if (cmd) {
        image->layout = VK_IMAGE_LAYOUT_UNDEFINED; /* everything is overwritten */
        gpu_cmd_image_layout(cmd, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        vkCmdCopyBufferToImage(cmd, staging.buffer, image->image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
        gpu_cmd_image_layout(cmd, image, layout);
    }
    ok = cmd && gpu_submit(g, cmd);
    gpu_buffer_destroy(g, &staging);
    return ok;
}

bool gpu_image_read(gpu *g, gpu_image *image, void *texels, size_t size)
{
    const VkBufferImageCopy copy = whole_image(image);
    const VkImageLayout layout = image->layout;
    gpu_buffer staging = {0};
    VkCommandBuffer cmd;
    bool ok;

    if (layout == VK_IMAGE_LAYOUT_UNDEFINED) {
        snprintf(g->error, sizeof g->error, "reading an image that was never written");
        return false;
    }
    if (!check_size(g, image, size) || !gpu_buffer_create(g, size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, true, &staging))
        return false;
    cmd = gpu_begin(g);
    if (cmd) {
        const VkMemoryBarrier to_host = {
            .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
            .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
            .dstAccessMask = VK_ACCESS_HOST_READ_BIT,
        };
        gpu_cmd_image_layout(cmd, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        vkCmdCopyImageToBuffer(cmd, image->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, staging.buffer, 1, &copy);
        gpu_cmd_image_layout(cmd, image, layout);
        vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &to_host, 0, NULL,
                             0, NULL);
    }
    ok = cmd && gpu_submit(g, cmd);
    if (ok)
        memcpy(texels, staging.mapped, size);
    gpu_buffer_destroy(g, &staging);
    return ok;
}

bool gpu_buffer_create(gpu *g, VkDeviceSize size, VkBufferUsageFlags usage, bool host_visible, gpu_buffer *out)
{
    const VkBufferCreateInfo create = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
        .size = size,
        .usage = usage,
        .sharingMode = VK_SHARING_MODE_EXCLUSIVE,
    };
    const VkMemoryPropertyFlags required =
        host_visible ? VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT : 0;
    /* Cached, because most host-visible buffers here are read back. */
    const VkMemoryPropertyFlags preferred =
        host_visible ? VK_MEMORY_PROPERTY_HOST_CACHED_BIT : VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    VkMemoryRequirements requirements;
    VkResult result;

    memset(out, 0, sizeof *out);
    out->size = size;
    result = vkCreateBuffer(g->device, &create, NULL, &out->buffer);
    if (result != VK_SUCCESS) {
        fail(g, "vkCreateBuffer", result);
        goto error;
    }
    vkGetBufferMemoryRequirements(g->device, out->buffer, &requirements);
    if (!allocate(g, &requirements, required, preferred, &out->memory))
        goto error;
    result = vkBindBufferMemory(g->device, out->buffer, out->memory, 0);
    if (result != VK_SUCCESS) {
        fail(g, "vkBindBufferMemory", result);
        goto error;
    }
    if (host_visible) {
        result = vkMapMemory(g->device, out->memory, 0, VK_WHOLE_SIZE, 0, &out->mapped);
        if (result != VK_SUCCESS) {
            fail(g, "vkMapMemory", result);
            goto error;
        }
    }
    return true;
error:
    gpu_buffer_destroy(g, out);
    return false;
}

void gpu_buffer_destroy(gpu *g, gpu_buffer *buffer)
{
    if (buffer && g->device) {
        vkDestroyBuffer(g->device, buffer->buffer, NULL);
        vkFreeMemory(g->device, buffer->memory, NULL);
        memset(buffer, 0, sizeof *buffer);
    }
}

VkCommandBuffer gpu_begin(gpu *g)
{
    const VkCommandBufferAllocateInfo allocate_info = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = g->command_pool,
        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
        .commandBufferCount = 1,
    };
    const VkCommandBufferBeginInfo begin = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
    };
    VkCommandBuffer cmd = VK_NULL_HANDLE;
    VkResult result = vkAllocateCommandBuffers(g->device, &allocate_info, &cmd);

    if (result != VK_SUCCESS) {
        fail(g, "vkAllocateCommandBuffers", result);
        return VK_NULL_HANDLE;
    }
    result = vkBeginCommandBuffer(cmd, &begin);
    if (result != VK_SUCCESS) {
        fail(g, "vkBeginCommandBuffer", result);
        vkFreeCommandBuffers(g->device, g->command_pool, 1, &cmd);
        return VK_NULL_HANDLE;
    }
    return cmd;
}

bool gpu_submit(gpu *g, VkCommandBuffer cmd)
{
    const VkSubmitInfo submit = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
        .commandBufferCount = 1,
        .pCommandBuffers = &cmd,
    };
    const VkFenceCreateInfo fence_info = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    VkFence fence = VK_NULL_HANDLE;
    bool submitted = false;
    VkResult result;

    g->error[0] = '\0';
    result = vkEndCommandBuffer(cmd);
    if (result != VK_SUCCESS) {
        fail(g, "vkEndCommandBuffer", result);
        goto done;
    }
    result = vkCreateFence(g->device, &fence_info, NULL, &fence);
    if (result != VK_SUCCESS) {
        fail(g, "vkCreateFence", result);
        goto done;
    }
    result = vkQueueSubmit(g->queue, 1, &submit, fence);
    if (result != VK_SUCCESS) {
        fail(g, "vkQueueSubmit", result);
        goto done;
    }
    result = vkWaitForFences(g->device, 1, &fence, VK_TRUE, UINT64_MAX);
    submitted = result == VK_SUCCESS || fail(g, "vkWaitForFences", result);
done:
    vkDestroyFence(g->device, fence, NULL);
    vkFreeCommandBuffers(g->device, g->command_pool, 1, &cmd);
    return submitted;
}
