/* Loads the function table. */
#include "functions.h"

#include <string.h>

const char *softshi_load_functions(const softsh_context_info *info, softshi_functions *out)
{
    memset(out, 0, sizeof *out);
#define SOFTSHI_LOAD(name)                                                                                             \
    out->name = (PFN_vk##name)info->get_instance_proc_addr(info->instance, "vk" #name);                                \
    if (!out->name)                                                                                                    \
        return "vk" #name;
    SOFTSHI_INSTANCE_FUNCTIONS(SOFTSHI_LOAD)
#undef SOFTSHI_LOAD
#define SOFTSHI_LOAD(name)                                                                                             \
    out->name = (PFN_vk##name)info->get_device_proc_addr(info->device, "vk" #name);                                    \
    if (!out->name)                                                                                                    \
        return "vk" #name;
    SOFTSHI_DEVICE_FUNCTIONS(SOFTSHI_LOAD)
#undef SOFTSHI_LOAD
    if (info->debug_names) {
#define SOFTSHI_LOAD(name) out->name = (PFN_vk##name)info->get_device_proc_addr(info->device, "vk" #name);
        SOFTSHI_DEBUG_FUNCTIONS(SOFTSHI_LOAD)
#undef SOFTSHI_LOAD
    }
    return NULL;
}
