// The library's context on a device, and the public structures for a case's light and matrices.
#include "library_context.hpp"

#include <cstring>

#include <glm/gtc/type_ptr.hpp>

#include "error.hpp"

namespace
{

void on_message(void *user, softsh_result, const char *message)
{
    *static_cast<std::string *>(user) = message;
}

} // namespace

LibraryContext::LibraryContext(gpu &g)
{
    softsh_context_info info{};
    info.struct_size = sizeof info;
    info.instance = g.instance;
    info.physical_device = g.physical_device;
    info.device = g.device;
    info.get_instance_proc_addr = vkGetInstanceProcAddr;
    info.get_device_proc_addr = vkGetDeviceProcAddr;
    info.message = on_message;
    info.message_user = &last_message;
    check(softsh_context_create(&info, &context));
}

LibraryContext::~LibraryContext()
{
    softsh_context_destroy(context);
}

void LibraryContext::check(softsh_result result) const
{
    if (result == SOFTSH_ERROR_LIMIT)
        throw LimitError(last_message);
    if (result != SOFTSH_SUCCESS)
        fail("%s (%s)", last_message.c_str(), softsh_result_string(result));
}

softsh_light to_library(const Light &light)
{
    softsh_light out{};
    out.struct_size = sizeof out;
    switch (light.shape) {
    case LightShape::rectangle:
        out.shape = SOFTSH_LIGHT_RECTANGLE;
        break;
    case LightShape::disc:
        out.shape = SOFTSH_LIGHT_DISC;
        break;
    case LightShape::sphere:
        out.shape = SOFTSH_LIGHT_SPHERE;
        break;
    case LightShape::directional:
        out.shape = SOFTSH_LIGHT_DIRECTIONAL;
        break;
    }
    for (int i = 0; i < 3; i++) {
        out.center[i] = light.centre[i];
        out.half_u[i] = light.half_u[i];
        out.half_v[i] = light.half_v[i];
        out.direction[i] = light.direction[i];
    }
    out.angular_radius = light.angular_radius;
    return out;
}

void to_library(const Frustum &frustum, double view[16], double projection[16])
{
    std::memcpy(view, glm::value_ptr(frustum.view), 16 * sizeof(double));
    std::memcpy(projection, glm::value_ptr(frustum.projection), 16 * sizeof(double));
}
