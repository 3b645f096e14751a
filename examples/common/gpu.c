/* Instance, device and messenger of the small Vulkan host in gpu.h; images and buffers are in gpu_resources.c.
 *
 * The instance asks for Vulkan 1.1, the library's minimum, even where the driver offers more, so that validation
 * reports any use of something newer. */
#define VOLK_IMPLEMENTATION
#include "gpu.h"

#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define VALIDATION_LAYER "VK_LAYER_KHRONOS_validation"
#define MAX_DEVICES 16u
#define MAX_EXTENSIONS 16u

/* Extensions a library of compute passes can use. Each needs no feature structure, or has one below. */
static const char *const useful_extensions[] = {
    VK_KHR_SHADER_FLOAT16_INT8_EXTENSION_NAME,   VK_EXT_SAMPLER_FILTER_MINMAX_EXTENSION_NAME,
    VK_EXT_SUBGROUP_SIZE_CONTROL_EXTENSION_NAME, VK_EXT_SCALAR_BLOCK_LAYOUT_EXTENSION_NAME,
    VK_KHR_DRIVER_PROPERTIES_EXTENSION_NAME,
};

static const char *result_name(VkResult result)
{
    switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return "out of host memory";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        return "out of device memory";
    case VK_ERROR_INITIALIZATION_FAILED:
        return "initialization failed";
    case VK_ERROR_LAYER_NOT_PRESENT:
        return "layer not present";
    case VK_ERROR_EXTENSION_NOT_PRESENT:
        return "extension not present";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
        return "no compatible driver";
    case VK_ERROR_DEVICE_LOST:
        return "device lost";
    default:
        return "unexpected result";
    }
}

static bool fail(gpu *g, const char *what, VkResult result)
{
    snprintf(g->error, sizeof g->error, "%s failed: %s (VkResult %d)", what, result_name(result), (int)result);
    return false;
}

/* Layers may report from any thread that records. */
static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                 VkDebugUtilsMessageTypeFlagsEXT types,
                                                 const VkDebugUtilsMessengerCallbackDataEXT *data, void *user)
{
    static atomic_flag lock = ATOMIC_FLAG_INIT;
    gpu *g = user;

    if (!(types & VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT) ||
        severity < VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT)
        return VK_FALSE;
    while (atomic_flag_test_and_set_explicit(&lock, memory_order_acquire)) {
    }
    g->validation_messages++;
    snprintf(g->last_validation_message, sizeof g->last_validation_message, "%s",
             data->pMessage ? data->pMessage : "(no text)");
    if (!g->validation_quiet)
        fprintf(stderr, "validation: %s\n", g->last_validation_message);
    atomic_flag_clear_explicit(&lock, memory_order_release);
    return VK_FALSE;
}

static bool has_instance_extension(const char *layer, const char *name)
{
    VkExtensionProperties list[256];
    uint32_t count = sizeof list / sizeof list[0];

    if (vkEnumerateInstanceExtensionProperties(layer, &count, list) < 0)
        return false;
    for (uint32_t i = 0; i < count; i++)
        if (!strcmp(list[i].extensionName, name))
            return true;
    return false;
}

static bool has_validation_layer(void)
{
    VkLayerProperties list[64];
    uint32_t count = sizeof list / sizeof list[0];

    if (vkEnumerateInstanceLayerProperties(&count, list) < 0)
        return false;
    for (uint32_t i = 0; i < count; i++)
        if (!strcmp(list[i].layerName, VALIDATION_LAYER))
            return true;
    return false;
}

static bool create_instance(const gpu_info *info, gpu *g)
{
    const VkApplicationInfo application = {
        .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
        .pApplicationName = "softshadow",
        .apiVersion = VK_API_VERSION_1_1,
    };
    const VkDebugUtilsMessengerCreateInfoEXT messenger = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = on_message,
        .pUserData = g,
    };
    const VkValidationFeatureEnableEXT enables[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    /* Chained to the instance as well, so that creating and destroying it is watched too. */
    const VkValidationFeaturesEXT features = {
        .sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
        .pNext = &messenger,
        .enabledValidationFeatureCount = 1,
        .pEnabledValidationFeatures = enables,
    };
    const char *layers[] = {VALIDATION_LAYER};
    const char *extensions[2];
    uint32_t extension_count = 0;
    VkInstanceCreateInfo create = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pApplicationInfo = &application,
        .ppEnabledExtensionNames = extensions,
    };
    const bool debug_utils = has_instance_extension(NULL, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    VkResult result;

    if (info->validation) {
        if (!has_validation_layer() || !debug_utils) {
            snprintf(g->error, sizeof g->error, "validation was asked for, but %s is not installed", VALIDATION_LAYER);
            return false;
        }
        if (!has_instance_extension(VALIDATION_LAYER, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME)) {
            snprintf(g->error, sizeof g->error, "%s is too old for synchronization validation", VALIDATION_LAYER);
            return false;
        }
        create.ppEnabledLayerNames = layers;
        create.enabledLayerCount = 1;
        create.pNext = &features;
        extensions[extension_count++] = VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME;
    }
    if ((info->validation || info->debug_utils) && debug_utils)
        extensions[extension_count++] = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    create.enabledExtensionCount = extension_count;
    result = vkCreateInstance(&create, NULL, &g->instance);
    if (result != VK_SUCCESS)
        return fail(g, "vkCreateInstance", result);
    volkLoadInstance(g->instance);
    if (info->validation) {
        result = vkCreateDebugUtilsMessengerEXT(g->instance, &messenger, NULL, &g->messenger);
        if (result != VK_SUCCESS)
            return fail(g, "vkCreateDebugUtilsMessengerEXT", result);
    }
    return true;
}

/* A family for everything, or UINT32_MAX. */
static uint32_t find_queue_family(VkPhysicalDevice device)
{
    const VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    VkQueueFamilyProperties families[32];
    uint32_t count = sizeof families / sizeof families[0];

    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families);
    for (uint32_t i = 0; i < count; i++)
        if ((families[i].queueFlags & wanted) == wanted)
            return i;
    return UINT32_MAX;
}

static uint32_t list_physical_devices(VkInstance instance, VkPhysicalDevice devices[MAX_DEVICES])
{
    uint32_t count = MAX_DEVICES;

    return vkEnumeratePhysicalDevices(instance, &count, devices) < 0 ? 0 : count;
}

static bool is_usable(VkPhysicalDevice device)
{
    VkPhysicalDeviceProperties properties;

    vkGetPhysicalDeviceProperties(device, &properties);
    return properties.apiVersion >= VK_API_VERSION_1_1 && find_queue_family(device) != UINT32_MAX;
}

static bool choose_device(const char *wanted, gpu *g)
{
    VkPhysicalDevice devices[MAX_DEVICES];
    const uint32_t count = list_physical_devices(g->instance, devices);
    uint32_t chosen = count;

    if (count == 0) {
        snprintf(g->error, sizeof g->error, "no Vulkan device found");
        return false;
    }
    if (wanted && *wanted) {
        char *end;
        const unsigned long index = strtoul(wanted, &end, 10);
        const bool is_index = *end == '\0' && *wanted >= '0' && *wanted <= '9';

        for (uint32_t i = 0; i < count && chosen == count; i++) {
            VkPhysicalDeviceProperties properties;
            vkGetPhysicalDeviceProperties(devices[i], &properties);
            if (is_index ? i == index : strstr(properties.deviceName, wanted) != NULL)
                chosen = i;
        }
        if (chosen == count) {
            snprintf(g->error, sizeof g->error, "no Vulkan device matches '%.200s' (there are %u)", wanted,
                     (unsigned)count);
            return false;
        }
        if (!is_usable(devices[chosen])) {
            snprintf(g->error, sizeof g->error,
                     "Vulkan device '%.200s' lacks Vulkan 1.1 or a queue for graphics and compute", wanted);
            return false;
        }
    } else {
        uint32_t software = count;
        for (uint32_t i = 0; i < count && chosen == count; i++) {
            VkPhysicalDeviceProperties properties;
            vkGetPhysicalDeviceProperties(devices[i], &properties);
            if (!is_usable(devices[i]))
                continue;
            if (properties.deviceType != VK_PHYSICAL_DEVICE_TYPE_CPU)
                chosen = i;
            else if (software == count)
                software = i;
        }
        if (chosen == count)
            chosen = software;
        if (chosen == count) {
            snprintf(g->error, sizeof g->error,
                     "no Vulkan device offers Vulkan 1.1 and a queue for graphics and compute");
            return false;
        }
    }
    g->physical_device = devices[chosen];
    g->queue_family = find_queue_family(g->physical_device);
    vkGetPhysicalDeviceProperties(g->physical_device, &g->properties);
    return true;
}

static bool contains(const char *const *names, uint32_t count, const char *name)
{
    for (uint32_t i = 0; i < count; i++)
        if (!strcmp(names[i], name))
            return true;
    return false;
}

/* Fills names with the useful extensions the device has. */
static uint32_t choose_extensions(VkPhysicalDevice device, const char *names[MAX_EXTENSIONS])
{
    uint32_t available = 0, count = 0;
    VkExtensionProperties *list;

    if (vkEnumerateDeviceExtensionProperties(device, NULL, &available, NULL) != VK_SUCCESS || available == 0)
        return 0;
    list = calloc(available, sizeof *list);
    if (!list)
        return 0;
    if (vkEnumerateDeviceExtensionProperties(device, NULL, &available, list) < 0)
        available = 0;
    for (size_t u = 0; u < sizeof useful_extensions / sizeof useful_extensions[0]; u++)
        for (uint32_t i = 0; i < available; i++)
            if (!strcmp(list[i].extensionName, useful_extensions[u])) {
                names[count++] = useful_extensions[u];
                break;
            }
    free(list);
    return count;
}

static void describe_driver(gpu *g, bool has_driver_properties)
{
    const VkPhysicalDeviceProperties *p = &g->properties;

    if (has_driver_properties) {
        VkPhysicalDeviceDriverProperties driver = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
        VkPhysicalDeviceProperties2 properties = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                                  .pNext = &driver};
        vkGetPhysicalDeviceProperties2(g->physical_device, &properties);
        snprintf(g->driver, sizeof g->driver, "%.200s %.200s", driver.driverName, driver.driverInfo);
    } else {
        snprintf(g->driver, sizeof g->driver, "driver version 0x%x", (unsigned)p->driverVersion);
    }
}

static bool create_device(gpu *g)
{
    const float priority = 1.0f;
    const VkDeviceQueueCreateInfo queue = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
        .queueFamilyIndex = g->queue_family,
        .queueCount = 1,
        .pQueuePriorities = &priority,
    };
    VkPhysicalDevice16BitStorageFeatures storage16 = {.sType =
                                                          VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_16BIT_STORAGE_FEATURES};
    VkPhysicalDeviceShaderFloat16Int8Features float16 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_FLOAT16_INT8_FEATURES};
    VkPhysicalDeviceSubgroupSizeControlFeatures subgroup_size = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_FEATURES};
    VkPhysicalDeviceScalarBlockLayoutFeatures scalar = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES};
    VkPhysicalDeviceFeatures2 available = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &storage16};
    VkPhysicalDeviceFeatures2 enabled = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &storage16};
    const char *extensions[MAX_EXTENSIONS];
    const uint32_t extension_count = choose_extensions(g->physical_device, extensions);
    const VkDeviceCreateInfo create = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
        .pNext = &enabled,
        .queueCreateInfoCount = 1,
        .pQueueCreateInfos = &queue,
        .enabledExtensionCount = extension_count,
        .ppEnabledExtensionNames = extensions,
    };
    const VkPhysicalDeviceFeatures *f = &available.features;
    VkResult result;

    if (contains(extensions, extension_count, VK_KHR_SHADER_FLOAT16_INT8_EXTENSION_NAME)) {
        float16.pNext = storage16.pNext;
        storage16.pNext = &float16;
    }
    if (contains(extensions, extension_count, VK_EXT_SUBGROUP_SIZE_CONTROL_EXTENSION_NAME)) {
        subgroup_size.pNext = storage16.pNext;
        storage16.pNext = &subgroup_size;
    }
    if (contains(extensions, extension_count, VK_EXT_SCALAR_BLOCK_LAYOUT_EXTENSION_NAME)) {
        scalar.pNext = storage16.pNext;
        storage16.pNext = &scalar;
    }
    vkGetPhysicalDeviceFeatures2(g->physical_device, &available);
    if (!f->shaderStorageImageWriteWithoutFormat) {
        snprintf(g->error, sizeof g->error, "device '%s' lacks the feature shaderStorageImageWriteWithoutFormat",
                 g->properties.deviceName);
        return false;
    }
    /* Not everything: robustBufferAccess would hide out-of-bounds bugs and cost time. */
    enabled.features.shaderStorageImageWriteWithoutFormat = VK_TRUE;
    enabled.features.shaderStorageImageReadWithoutFormat = f->shaderStorageImageReadWithoutFormat;
    enabled.features.shaderStorageImageExtendedFormats = f->shaderStorageImageExtendedFormats;
    enabled.features.shaderInt16 = f->shaderInt16;
    enabled.features.shaderInt64 = f->shaderInt64;
    enabled.features.samplerAnisotropy = f->samplerAnisotropy;
    /* GPU-assisted validation writes its records from every stage. */
    enabled.features.vertexPipelineStoresAndAtomics = f->vertexPipelineStoresAndAtomics;
    enabled.features.fragmentStoresAndAtomics = f->fragmentStoresAndAtomics;
    result = vkCreateDevice(g->physical_device, &create, NULL, &g->device);
    if (result != VK_SUCCESS)
        return fail(g, "vkCreateDevice", result);
    volkLoadDevice(g->device);
    vkGetDeviceQueue(g->device, g->queue_family, 0, &g->queue);
    describe_driver(g, contains(extensions, extension_count, VK_KHR_DRIVER_PROPERTIES_EXTENSION_NAME));
    return true;
}

static bool create_command_pool(gpu *g)
{
    const VkCommandPoolCreateInfo create = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
        .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT | VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
        .queueFamilyIndex = g->queue_family,
    };
    const VkResult result = vkCreateCommandPool(g->device, &create, NULL, &g->command_pool);

    return result == VK_SUCCESS || fail(g, "vkCreateCommandPool", result);
}

bool gpu_create(const gpu_info *info, gpu *out)
{
    memset(out, 0, sizeof *out);
    if (volkInitialize() != VK_SUCCESS) {
        snprintf(out->error, sizeof out->error, "no Vulkan loader (libvulkan.so.1) found");
        return false;
    }
    if (volkGetInstanceVersion() < VK_API_VERSION_1_1) {
        snprintf(out->error, sizeof out->error, "the Vulkan loader is older than Vulkan 1.1");
        return false;
    }
    if (create_instance(info, out) && choose_device(info->device, out) && create_device(out) &&
        create_command_pool(out))
        return true;
    gpu_destroy(out);
    return false;
}

/* Leaves the message counters and the error readable. */
void gpu_destroy(gpu *g)
{
    if (g->device) {
        vkDeviceWaitIdle(g->device);
        vkDestroyCommandPool(g->device, g->command_pool, NULL);
        vkDestroyDevice(g->device, NULL);
    }
    if (g->messenger)
        vkDestroyDebugUtilsMessengerEXT(g->instance, g->messenger, NULL);
    if (g->instance)
        vkDestroyInstance(g->instance, NULL);
    g->command_pool = VK_NULL_HANDLE;
    g->queue = VK_NULL_HANDLE;
    g->device = VK_NULL_HANDLE;
    g->messenger = VK_NULL_HANDLE;
    g->physical_device = VK_NULL_HANDLE;
    g->instance = VK_NULL_HANDLE;
}

uint32_t gpu_list_devices(char *text, size_t text_size)
{
    static const char *const types[] = {"other", "integrated GPU", "discrete GPU", "virtual GPU", "software"};
    const gpu_info info = {0};
    VkPhysicalDevice devices[MAX_DEVICES];
    gpu *g = calloc(1, sizeof *g); /* kilobytes of message buffers: not for the stack */
    uint32_t count = 0;
    size_t used = 0;

    if (text_size)
        text[0] = '\0';
    if (!g)
        return 0;
    if (volkInitialize() == VK_SUCCESS && create_instance(&info, g)) {
        count = list_physical_devices(g->instance, devices);
        for (uint32_t i = 0; i < count && used < text_size; i++) {
            VkPhysicalDeviceProperties p;
            int n;
            vkGetPhysicalDeviceProperties(devices[i], &p);
            n = snprintf(text + used, text_size - used, "%u: %s (%s)\n", (unsigned)i, p.deviceName,
                         p.deviceType <= VK_PHYSICAL_DEVICE_TYPE_CPU ? types[p.deviceType] : types[0]);
            used += n > 0 ? (size_t)n : 0;
        }
        gpu_destroy(g);
    }
    free(g);
    return count;
}
