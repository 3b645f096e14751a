/* A small Vulkan host shared by the examples, the tests and the benchmark: one instance, one device, one queue, and
 * just enough images and buffers. Everything here may block; nothing of it is part of the library. */
#ifndef GPU_H
#define GPU_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <volk.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct gpu_info {
    const char *device; /* index or part of a device's name; NULL: the first GPU, else the software driver */
    bool validation;    /* the validation layer with synchronization validation; its absence is an error */
    bool debug_utils;   /* enable VK_EXT_debug_utils even without validation */
} gpu_info;

typedef struct gpu {
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    VkQueue queue;
    uint32_t queue_family; /* graphics, compute and transfer */
    VkPhysicalDeviceProperties properties;
    char driver[512]; /* driver name and version, for reports */
    VkCommandPool command_pool;
    VkDebugUtilsMessengerEXT messenger;
    /* Messages of type VALIDATION at severity warning or error, counted by the messenger; the last one's text. */
    uint32_t validation_messages;
    char last_validation_message[2048];
    bool validation_quiet; /* canaries set this so that expected messages are counted but not printed */
    char error[1024];      /* why the last call failed, one line */
} gpu;

typedef struct gpu_image_info {
    VkFormat format;
    uint32_t width, height;
    uint32_t layers;         /* 0 means 1; more than 1 makes the view a 2D array view */
    VkImageUsageFlags usage; /* transfer source and destination are added */
} gpu_image_info;

typedef struct gpu_image {
    VkImage image;
    VkDeviceMemory memory;
    VkImageView view; /* depth aspect only for depth-stencil formats */
    VkFormat format;
    uint32_t width, height, layers;
    VkImageAspectFlags aspect;
    VkImageLayout layout; /* as the helpers below left it; set it after recording a transition yourself */
} gpu_image;

typedef struct gpu_buffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    VkDeviceSize size;
    void *mapped; /* host-visible and coherent, mapped for its whole life; NULL if created device local */
} gpu_buffer;

/* Creates instance and device. On failure `out->error` says why and everything made so far is destroyed. Enables the
 * device features the library requires (shaderStorageImageWriteWithoutFormat) and, where present, those it can use. */
bool gpu_create(const gpu_info *info, gpu *out);
void gpu_destroy(gpu *g);

/* Number of devices, and a printable list ("0: name (type)\n..."), for --device help. */
uint32_t gpu_list_devices(char *text, size_t text_size);

bool gpu_image_create(gpu *g, const gpu_image_info *info, gpu_image *out);
void gpu_image_destroy(gpu *g, gpu_image *image);
/* Tightly packed texels, all layers one after the other; leaves the image in `layout`. */
bool gpu_image_upload(gpu *g, gpu_image *image, const void *texels, size_t size, VkImageLayout layout);
bool gpu_image_read(gpu *g, gpu_image *image, void *texels, size_t size);
/* Records a full barrier from image->layout to `layout` and updates image->layout. */
void gpu_cmd_image_layout(VkCommandBuffer cmd, gpu_image *image, VkImageLayout layout);

bool gpu_buffer_create(gpu *g, VkDeviceSize size, VkBufferUsageFlags usage, bool host_visible, gpu_buffer *out);
void gpu_buffer_destroy(gpu *g, gpu_buffer *buffer);

/* A one-time command buffer; gpu_submit ends, submits, waits for and frees it. */
VkCommandBuffer gpu_begin(gpu *g);
bool gpu_submit(gpu *g, VkCommandBuffer cmd);

/* Bytes per texel of the formats used here; 0 if unknown. */
size_t gpu_format_size(VkFormat format);

#ifdef __cplusplus
}
#endif

#endif
