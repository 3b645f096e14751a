/* A program that uses all of the public interface as an installed library offers it: every function is linked, every
 * structure is filled in, and what works without a device is called. Prints the version. */
#include <softshadow/softshadow.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#define CHECK(condition)                                                                                               \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition);                                            \
            return 1;                                                                                                  \
        }                                                                                                              \
    } while (0)

static unsigned messages;

static void on_message(void *user, softsh_result result, const char *message)
{
    (void)user;
    messages += result != SOFTSH_SUCCESS && message != NULL;
}

typedef void (*any_function)(void);

static const any_function functions[] = {
    (any_function)softsh_version,
    (any_function)softsh_result_string,
    (any_function)softsh_get_requirements,
    (any_function)softsh_context_create,
    (any_function)softsh_context_destroy,
    (any_function)softsh_occluders_create,
    (any_function)softsh_occluders_destroy,
    (any_function)softsh_view_create,
    (any_function)softsh_view_destroy,
    (any_function)softsh_occluders_memory_requirements,
    (any_function)softsh_view_memory_requirements,
    (any_function)softsh_occluders_bind_memory,
    (any_function)softsh_view_bind_memory,
    (any_function)softsh_cmd_build_occluders,
    (any_function)softsh_cmd_compute_visibility,
    (any_function)softsh_light_frustum_create,
};

static int check_calls(void)
{
    const softsh_context_info no_device = {.struct_size = sizeof no_device, .message = on_message};
    const softsh_occluders_info occluders_info = {.struct_size = sizeof occluders_info, .max_extent = {1024, 1024}};
    const softsh_settings settings = {.struct_size = sizeof settings, .technique = SOFTSH_TECHNIQUE_AUTO};
    const softsh_view_info view_info = {.struct_size = sizeof view_info,
                                        .max_extent = {640, 480},
                                        .output_format = VK_FORMAT_R8_UNORM,
                                        .settings = &settings};
    const softsh_light light = {.struct_size = sizeof light,
                                .shape = SOFTSH_LIGHT_RECTANGLE,
                                .center = {0.0, 4.0, 0.0},
                                .half_u = {0.5, 0.0, 0.0},
                                .half_v = {0.0, 0.0, 0.5}};
    const softsh_map map = {.struct_size = sizeof map, .role = SOFTSH_MAP_LAYER, .format = VK_FORMAT_D32_SFLOAT};
    const softsh_camera camera = {.struct_size = sizeof camera, .depth_format = VK_FORMAT_D32_SFLOAT};
    softsh_timestamps timestamps = {.struct_size = sizeof timestamps};
    const softsh_build_info build = {.struct_size = sizeof build, .light = &light, .map_count = 1, .maps = &map};
    const softsh_visibility_info visibility = {
        .struct_size = sizeof visibility, .camera_count = 1, .cameras = &camera, .timestamps = &timestamps};
    softsh_requirements requirements = {.struct_size = sizeof requirements};
    softsh_light_frustum frustum = {.struct_size = sizeof frustum};
    const double target[3] = {0.0, 0.0, 0.0};
    VkMemoryRequirements memory;
    softsh_context *context = NULL;
    softsh_occluders *occluders = NULL;
    softsh_view *view = NULL;

    CHECK(softsh_version() == SOFTSH_VERSION);
    CHECK(!strcmp(softsh_result_string(SOFTSH_SUCCESS), "SOFTSH_SUCCESS"));
    CHECK(!strcmp(softsh_result_string(SOFTSH_ERROR_LIMIT), "SOFTSH_ERROR_LIMIT"));
    CHECK(softsh_result_string((softsh_result)1234) != NULL);

    /* Without a device everything is refused, by name. */
    CHECK(softsh_get_requirements(NULL, VK_NULL_HANDLE, VK_NULL_HANDLE, &requirements) ==
          SOFTSH_ERROR_INVALID_ARGUMENT);
    CHECK(softsh_context_create(&no_device, &context) == SOFTSH_ERROR_INVALID_ARGUMENT);
    CHECK(context == NULL && messages == 1);
    CHECK(softsh_occluders_create(NULL, &occluders_info, &occluders) == SOFTSH_ERROR_INVALID_ARGUMENT);
    CHECK(softsh_view_create(NULL, &view_info, &view) == SOFTSH_ERROR_INVALID_ARGUMENT);
    CHECK(occluders == NULL && view == NULL);
    CHECK(softsh_occluders_memory_requirements(NULL, &memory) == SOFTSH_ERROR_INVALID_ARGUMENT);
    CHECK(softsh_view_memory_requirements(NULL, &memory) == SOFTSH_ERROR_INVALID_ARGUMENT);
    CHECK(softsh_occluders_bind_memory(NULL, VK_NULL_HANDLE, 0, 0) == SOFTSH_ERROR_INVALID_ARGUMENT);
    CHECK(softsh_view_bind_memory(NULL, VK_NULL_HANDLE, 0, 0) == SOFTSH_ERROR_INVALID_ARGUMENT);
    CHECK(softsh_cmd_build_occluders(VK_NULL_HANDLE, NULL, &build) == SOFTSH_ERROR_INVALID_ARGUMENT);
    CHECK(softsh_cmd_compute_visibility(VK_NULL_HANDLE, NULL, &visibility) == SOFTSH_ERROR_INVALID_ARGUMENT);
    softsh_view_destroy(NULL);
    softsh_occluders_destroy(NULL);
    softsh_context_destroy(NULL);

    CHECK(softsh_light_frustum_create(&light, target, 1.0, 0.0, &frustum) == SOFTSH_SUCCESS);
    CHECK(frustum.near_distance > 0.0 && isfinite(frustum.projection[0]));
    return 0;
}

int main(void)
{
    const uint32_t version = softsh_version();

    for (size_t i = 0; i < sizeof functions / sizeof functions[0]; i++)
        CHECK(functions[i] != NULL);
    if (check_calls())
        return 1;
    printf("%u.%u.%u\n", (unsigned)(version >> 22), (unsigned)(version >> 12 & 0x3ffu), (unsigned)(version & 0xfffu));
    return 0;
}
