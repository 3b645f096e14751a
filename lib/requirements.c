/* Version, result names, and what a device must offer. */
#include <softshadow/softshadow.h>

#include <stdbool.h>
#include <string.h>

uint32_t softsh_version(void)
{
    return SOFTSH_VERSION;
}

const char *softsh_result_string(softsh_result result)
{
    switch (result) {
    case SOFTSH_SUCCESS:
        return "SOFTSH_SUCCESS";
    case SOFTSH_ERROR_INVALID_ARGUMENT:
        return "SOFTSH_ERROR_INVALID_ARGUMENT";
    case SOFTSH_ERROR_UNSUPPORTED:
        return "SOFTSH_ERROR_UNSUPPORTED";
    case SOFTSH_ERROR_LIMIT:
        return "SOFTSH_ERROR_LIMIT";
    case SOFTSH_ERROR_OUT_OF_HOST_MEMORY:
        return "SOFTSH_ERROR_OUT_OF_HOST_MEMORY";
    case SOFTSH_ERROR_OUT_OF_DEVICE_MEMORY:
        return "SOFTSH_ERROR_OUT_OF_DEVICE_MEMORY";
    case SOFTSH_ERROR_STATE:
        return "SOFTSH_ERROR_STATE";
    case SOFTSH_ERROR_VULKAN:
        return "SOFTSH_ERROR_VULKAN";
    }
    return "unknown softsh_result";
}

softsh_result softsh_get_requirements(PFN_vkGetInstanceProcAddr get_instance_proc_addr, VkInstance instance,
                                      VkPhysicalDevice physical_device, softsh_requirements *out)
{
    static const char *const useful_extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
    if (!out || out->struct_size != sizeof *out || !get_instance_proc_addr)
        return SOFTSH_ERROR_INVALID_ARGUMENT;
    memset(out, 0, sizeof *out);
    out->struct_size = sizeof *out;
    out->api_version = VK_API_VERSION_1_1;
    /* One shader writes every output format. */
    out->features.shaderStorageImageWriteWithoutFormat = VK_TRUE;
    out->useful_extensions = useful_extensions;
    out->useful_extension_count = 1;
    if (!instance || !physical_device)
        return SOFTSH_SUCCESS;
    const PFN_vkGetPhysicalDeviceProperties get_properties =
        (PFN_vkGetPhysicalDeviceProperties)get_instance_proc_addr(instance, "vkGetPhysicalDeviceProperties");
    const PFN_vkGetPhysicalDeviceFeatures get_features =
        (PFN_vkGetPhysicalDeviceFeatures)get_instance_proc_addr(instance, "vkGetPhysicalDeviceFeatures");
    if (!get_properties || !get_features)
        return SOFTSH_ERROR_INVALID_ARGUMENT;
    VkPhysicalDeviceProperties properties;
    VkPhysicalDeviceFeatures features;
    get_properties(physical_device, &properties);
    get_features(physical_device, &features);
    /* The plan; control, tiles and filter values. Every device has that many. */
    const bool enough_buffers = properties.limits.maxPerStageDescriptorStorageBuffers >= 4;
    out->supported =
        enough_buffers && properties.apiVersion >= VK_API_VERSION_1_1 && features.shaderStorageImageWriteWithoutFormat;
    return SOFTSH_SUCCESS;
}
