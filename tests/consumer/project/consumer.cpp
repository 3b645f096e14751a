// The installed library from C++: the same types, wrapped the way a C++ renderer would.
#include <softshadow/softshadow.h>

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <memory>
#include <type_traits>

namespace
{

struct destroy {
    void operator()(softsh_context *object) const
    {
        softsh_context_destroy(object);
    }
    void operator()(softsh_occluders *object) const
    {
        softsh_occluders_destroy(object);
    }
    void operator()(softsh_view *object) const
    {
        softsh_view_destroy(object);
    }
};

template <typename T>
using handle = std::unique_ptr<T, destroy>;

// Every public structure is plain data whose first field is its size.
template <typename T>
T sized()
{
    static_assert(std::is_trivial_v<T> && std::is_standard_layout_v<T>);
    static_assert(offsetof(T, struct_size) == 0);
    T value{};
    value.struct_size = sizeof value;
    return value;
}

template <typename... T>
bool all_set(T... functions)
{
    return (... && (functions != nullptr));
}

} // namespace

int main()
{
    const auto context_info = sized<softsh_context_info>();
    auto light = sized<softsh_light>();
    auto frustum = sized<softsh_light_frustum>();
    const auto map = sized<softsh_map>();
    auto build = sized<softsh_build_info>();
    const auto camera = sized<softsh_camera>();
    auto visibility = sized<softsh_visibility_info>();
    const auto settings = sized<softsh_settings>();
    auto view_info = sized<softsh_view_info>();
    const auto occluders_info = sized<softsh_occluders_info>();
    auto requirements = sized<softsh_requirements>();
    auto timestamps = sized<softsh_timestamps>();
    const softsh_stats stats{};
    const double target[3] = {0.0, 0.0, 0.0};
    softsh_context *context = nullptr;

    if (!all_set(softsh_version, softsh_result_string, softsh_get_requirements, softsh_context_create,
                 softsh_context_destroy, softsh_occluders_create, softsh_occluders_destroy, softsh_view_create,
                 softsh_view_destroy, softsh_occluders_memory_requirements, softsh_view_memory_requirements,
                 softsh_occluders_bind_memory, softsh_view_bind_memory, softsh_cmd_build_occluders,
                 softsh_cmd_compute_visibility, softsh_light_frustum_create))
        return 1;
    if (softsh_context_create(&context_info, &context) != SOFTSH_ERROR_INVALID_ARGUMENT)
        return 2;
    const handle<softsh_context> owned_context(context);
    const handle<softsh_occluders> no_occluders;
    const handle<softsh_view> no_view;

    light.center[1] = 4.0;
    light.half_u[0] = light.half_v[2] = 0.5;
    build.light = &light;
    build.map_count = 1;
    build.maps = &map;
    build.timestamps = &timestamps;
    view_info.settings = &settings;
    visibility.camera_count = 1;
    visibility.cameras = &camera;
    if (softsh_cmd_build_occluders(VK_NULL_HANDLE, no_occluders.get(), &build) != SOFTSH_ERROR_INVALID_ARGUMENT ||
        softsh_cmd_compute_visibility(VK_NULL_HANDLE, no_view.get(), &visibility) != SOFTSH_ERROR_INVALID_ARGUMENT ||
        softsh_get_requirements(nullptr, VK_NULL_HANDLE, VK_NULL_HANDLE, &requirements) !=
            SOFTSH_ERROR_INVALID_ARGUMENT)
        return 3;
    softsh_occluders *occluders = nullptr;
    softsh_view *view = nullptr;
    if (softsh_occluders_create(nullptr, &occluders_info, &occluders) != SOFTSH_ERROR_INVALID_ARGUMENT ||
        softsh_view_create(nullptr, &view_info, &view) != SOFTSH_ERROR_INVALID_ARGUMENT || occluders || view)
        return 4;
    if (softsh_light_frustum_create(&light, target, 1.0, 0.0, &frustum) != SOFTSH_SUCCESS ||
        !std::isfinite(frustum.view_matrix[0]) || !(frustum.near_distance > 0.0))
        return 5;
    if (stats.pixels != 0 || std::strcmp(softsh_result_string(SOFTSH_ERROR_STATE), "SOFTSH_ERROR_STATE") != 0)
        return 6;
    const uint32_t version = softsh_version();
    if (version != SOFTSH_VERSION)
        return 7;
    std::printf("%u.%u.%u\n", version >> 22, version >> 12 & 0x3ffu, version & 0xfffu);
    return 0;
}
