/* Every wrong argument is answered by the right result, by one sentence that names the field, and by nothing else: no
 * object is left, no descriptor written, no command recorded, and the objects work afterwards as if nothing had been.
 */
#include "scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define INVALID SOFTSH_ERROR_INVALID_ARGUMENT
#define UNSUPPORTED SOFTSH_ERROR_UNSUPPORTED
#define LIMIT SOFTSH_ERROR_LIMIT
#define STATE SOFTSH_ERROR_STATE

typedef enum call { CONTEXT, OCCLUDERS, VIEW, BUILD, VISIBILITY } call;

/* The objects that the recording calls get. */
static struct {
    scene *s;
    scene_lamp lamp;
    softsh_context *context;
    softsh_occluders *occluders;
    softsh_view *view;
    VkCommandBuffer cmd;
} with;

static softsh_result make_call(call what, scene_inputs *in)
{
    void *made = in; /* not NULL */
    softsh_result result = SOFTSH_SUCCESS;
    switch (what) {
    case CONTEXT:
        result = softsh_context_create(&in->context, (softsh_context **)&made);
        break;
    case OCCLUDERS:
        result = softsh_occluders_create(with.context, &in->occluders, (softsh_occluders **)&made);
        break;
    case VIEW:
        result = softsh_view_create(with.context, &in->view, (softsh_view **)&made);
        break;
    case BUILD:
        return softsh_cmd_build_occluders(with.cmd, with.occluders, &in->build);
    case VISIBILITY:
        return softsh_cmd_compute_visibility(with.cmd, with.view, &in->visibility);
    }
    if (made)
        fail_msg("the call failed with %s and gave an object", softsh_result_string(result));
    return result;
}

static void check_failure(int line, softsh_result result, softsh_result expected, const char *words,
                          const spy_counts *before)
{
    const spy_counts after = spy_read();
    if (result != expected)
        fail_msg("line %d: %s (\"%s\"), expected %s", line, softsh_result_string(result), scene_message,
                 softsh_result_string(expected));
    if (scene_message_count != 1 || scene_message_result != expected || !strstr(scene_message, words))
        fail_msg("line %d: %u messages, the last with %s: \"%s\", expected one that contains \"%s\"", line,
                 scene_message_count, softsh_result_string(scene_message_result), scene_message, words);
    if (after.commands != before->commands || after.updates != before->updates)
        fail_msg("line %d: a failed call has recorded commands or written descriptors", line);
    if (after.alive != before->alive || after.strangers != before->strangers)
        fail_msg("line %d: a failed call has left objects, or destroyed others'", line);
}

#define EXPECT(expression, expected, words)                                                                            \
    do {                                                                                                               \
        const spy_counts before_ = spy_read();                                                                         \
        scene_message_count = 0;                                                                                       \
        const softsh_result result_ = (expression);                                                                    \
        check_failure(__LINE__, result_, expected, words, &before_);                                                   \
    } while (0)

/* One valid set of structures, spoilt by the statement `change`. */
#define BAD(what, change, expected, words)                                                                             \
    do {                                                                                                               \
        scene_inputs in;                                                                                               \
        scene_fill(with.s, with.lamp, 1, &in);                                                                         \
        in.visibility.occluders = with.occluders;                                                                      \
        change;                                                                                                        \
        EXPECT(make_call(what, &in), expected, words);                                                                 \
    } while (0)

#define BAD_NUMBERS(what, field, expected, words)                                                                      \
    do {                                                                                                               \
        BAD(what, in.field = NAN, expected, words);                                                                    \
        BAD(what, in.field = INFINITY, expected, words);                                                               \
        BAD(what, in.field = -INFINITY, expected, words);                                                              \
    } while (0)

static int setup(void **state)
{
    if (scene_setup(state))
        return -1;
    scene_inputs valid;
    with.s = *state;
    with.context = scene_context(with.s, false, NULL);
    scene_fill(with.s, LAMP_RECTANGLE, 1, &valid);
    with.occluders = scene_occluders(with.context, &valid);
    with.view = scene_view(with.context, &valid);
    with.cmd = gpu_begin(&with.s->g);
    return with.cmd ? 0 : -1;
}

static int teardown(void **state)
{
    const bool ended = gpu_submit(&with.s->g, with.cmd);
    softsh_view_destroy(with.view);
    softsh_occluders_destroy(with.occluders);
    softsh_context_destroy(with.context);
    return scene_teardown(state) || !ended ? -1 : 0;
}

static void context_errors(void **state)
{
    (void)state;
    with.lamp = LAMP_RECTANGLE;
    BAD(CONTEXT, in.context.instance = VK_NULL_HANDLE, INVALID, "softsh_context_info::instance");
    BAD(CONTEXT, in.context.physical_device = VK_NULL_HANDLE, INVALID, "softsh_context_info::physical_device");
    BAD(CONTEXT, in.context.device = VK_NULL_HANDLE, INVALID, "softsh_context_info::device");
    BAD(CONTEXT, in.context.get_instance_proc_addr = NULL, INVALID, "softsh_context_info::get_instance_proc_addr");
    BAD(CONTEXT, in.context.get_device_proc_addr = NULL, INVALID, "softsh_context_info::get_device_proc_addr");
    BAD(CONTEXT, in.context.allocation_callbacks = &in.callbacks;
        in.callbacks.pfnAllocation = NULL, INVALID, "softsh_context_info::allocation_callbacks");
    BAD(CONTEXT, in.context.allocation_callbacks = &in.callbacks;
        in.callbacks.pfnReallocation = NULL, INVALID, "softsh_context_info::allocation_callbacks");
    BAD(CONTEXT, in.context.allocation_callbacks = &in.callbacks;
        in.callbacks.pfnFree = NULL, INVALID, "softsh_context_info::allocation_callbacks");
    scene_inputs valid;
    scene_fill(with.s, LAMP_RECTANGLE, 1, &valid);
    EXPECT(softsh_context_create(&valid.context, NULL), INVALID, "out is NULL");
    /* Without a structure, or one of a size that is not known, there is no callback to tell. */
    static const uint32_t sizes[] = {0, 1, sizeof valid.context - 1, sizeof valid.context + 8, UINT32_MAX};
    softsh_context *context = (softsh_context *)&valid;
    scene_message_count = 0;
    assert_int_equal(softsh_context_create(NULL, &context), INVALID);
    assert_null(context);
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        valid.context.struct_size = sizes[i];
        context = (softsh_context *)&valid;
        assert_int_equal(softsh_context_create(&valid.context, &context), INVALID);
        assert_null(context);
    }
    assert_int_equal(scene_message_count, 0);
    /* No callback at all. */
    scene_fill(with.s, LAMP_RECTANGLE, 1, &valid);
    valid.context.message = NULL;
    valid.context.device = VK_NULL_HANDLE;
    assert_int_equal(softsh_context_create(&valid.context, &context), INVALID);
    softsh_context_destroy(NULL);
}

static void missing_functions(void **state)
{
    (void)state;
    with.lamp = LAMP_RECTANGLE;
    static const char *const names[] = {"vkGetPhysicalDeviceProperties2",
                                        "vkGetPhysicalDeviceMemoryProperties",
                                        "vkGetPhysicalDeviceFormatProperties",
                                        "vkCreateBuffer",
                                        "vkCmdDispatchIndirect",
                                        "vkCmdWriteTimestamp"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        spy_hide(names[i]);
        BAD(CONTEXT, (void)in, INVALID, names[i]);
    }
    spy_hide("vkGetPhysicalDeviceFeatures");
    BAD(CONTEXT, (void)in, INVALID, "softsh_context_info::physical_device");
    spy_hide(NULL);
}

static void requirements_errors(void **state)
{
    (void)state;
    const gpu *g = &with.s->g;
    softsh_requirements r = {.struct_size = sizeof r};
    scene_message_count = 0;
    assert_int_equal(softsh_get_requirements(vkGetInstanceProcAddr, g->instance, g->physical_device, NULL), INVALID);
    assert_int_equal(softsh_get_requirements(NULL, g->instance, g->physical_device, &r), INVALID);
    r.struct_size = 4;
    assert_int_equal(softsh_get_requirements(vkGetInstanceProcAddr, g->instance, g->physical_device, &r), INVALID);
    /* Without a device: what is needed, and no word on whether it is there. */
    r = (softsh_requirements){.struct_size = sizeof r};
    assert_int_equal(softsh_get_requirements(vkGetInstanceProcAddr, g->instance, VK_NULL_HANDLE, &r), SOFTSH_SUCCESS);
    assert_int_equal(r.supported, 0);
    assert_true(r.features.shaderStorageImageWriteWithoutFormat);
    assert_int_equal(r.api_version, VK_API_VERSION_1_1);
    assert_int_equal(r.extension_count, 0);
    assert_int_equal(softsh_get_requirements(vkGetInstanceProcAddr, g->instance, g->physical_device, &r),
                     SOFTSH_SUCCESS);
    assert_true(r.supported);
    assert_int_equal(softsh_version(), SOFTSH_VERSION);
    for (int i = SOFTSH_ERROR_VULKAN; i <= SOFTSH_SUCCESS; i++)
        assert_memory_equal(softsh_result_string((softsh_result)i), "SOFTSH_", 7);
    assert_non_null(softsh_result_string((softsh_result)7));
}

static void occluders_errors(void **state)
{
    (void)state;
    with.lamp = LAMP_RECTANGLE;
    BAD(OCCLUDERS, in.occluders.struct_size = 0, INVALID, "softsh_occluders_info::struct_size");
    BAD(OCCLUDERS, in.occluders.struct_size += 8, INVALID, "softsh_occluders_info::struct_size");
    BAD(OCCLUDERS, in.occluders.max_extent.width = 0, INVALID, "softsh_occluders_info::max_extent");
    BAD(OCCLUDERS, in.occluders.max_extent.height = 0, INVALID, "softsh_occluders_info::max_extent");
    BAD(OCCLUDERS, in.occluders.max_extent.width = SOFTSH_MAX_EXTENT + 1, INVALID, "softsh_occluders_info::max_extent");
    BAD(OCCLUDERS, in.occluders.max_extent.height = UINT32_MAX, INVALID, "softsh_occluders_info::max_extent");
    BAD(OCCLUDERS, in.occluders.max_layers = SOFTSH_MAX_LAYERS + 1, INVALID, "softsh_occluders_info::max_layers");
    BAD(OCCLUDERS, in.occluders.max_layers = UINT32_MAX, INVALID, "softsh_occluders_info::max_layers");
    BAD(OCCLUDERS, in.occluders.accel = (softsh_accel)4, INVALID, "softsh_occluders_info::accel");
    BAD(OCCLUDERS, in.occluders.accel = (softsh_accel)-1, INVALID, "softsh_occluders_info::accel");
    BAD(OCCLUDERS, in.occluders.ysm_join = SOFTSH_MAX_EXTENT + 1, INVALID, "softsh_occluders_info::ysm_join");
    BAD(OCCLUDERS, in.occluders.max_recordings = 1025, INVALID, "softsh_occluders_info::max_recordings");
    BAD(OCCLUDERS, in.occluders.max_recordings = UINT32_MAX, INVALID, "softsh_occluders_info::max_recordings");
    BAD(OCCLUDERS, in.occluders.memory_mode = (softsh_memory_mode)2, INVALID, "softsh_occluders_info::memory_mode");
    scene_inputs valid;
    scene_fill(with.s, LAMP_RECTANGLE, 1, &valid);
    softsh_occluders *occluders = with.occluders;
    EXPECT(softsh_occluders_create(with.context, NULL, &occluders), INVALID, "softsh_occluders_info is NULL");
    assert_null(occluders);
    EXPECT(softsh_occluders_create(with.context, &valid.occluders, NULL), INVALID, "out is NULL");
    scene_message_count = 0;
    occluders = with.occluders;
    assert_int_equal(softsh_occluders_create(NULL, &valid.occluders, &occluders), INVALID);
    assert_null(occluders);
    VkMemoryRequirements requirements;
    assert_int_equal(softsh_occluders_memory_requirements(NULL, &requirements), INVALID);
    assert_int_equal(softsh_occluders_bind_memory(NULL, VK_NULL_HANDLE, 0, 0), INVALID);
    assert_int_equal(scene_message_count, 0);
    EXPECT(softsh_occluders_memory_requirements(with.occluders, NULL), INVALID, "out is NULL");
    softsh_occluders_destroy(NULL);
}

static void view_errors(void **state)
{
    (void)state;
    with.lamp = LAMP_RECTANGLE;
    BAD(VIEW, in.view.struct_size = 0, INVALID, "softsh_view_info::struct_size");
    BAD(VIEW, in.view.struct_size--, INVALID, "softsh_view_info::struct_size");
    BAD(VIEW, in.view.max_extent.width = 0, INVALID, "softsh_view_info::max_extent");
    BAD(VIEW, in.view.max_extent.height = SOFTSH_MAX_EXTENT + 1, INVALID, "softsh_view_info::max_extent");
    BAD(VIEW, in.view.output_format = VK_FORMAT_UNDEFINED, UNSUPPORTED, "softsh_view_info::output_format");
    BAD(VIEW, in.view.output_format = VK_FORMAT_R8G8B8A8_UNORM, UNSUPPORTED, "softsh_view_info::output_format");
    BAD(VIEW, in.view.output_format = VK_FORMAT_D32_SFLOAT, UNSUPPORTED, "softsh_view_info::output_format");
    BAD(VIEW, in.view.output_format = (VkFormat)0x7fffffff, UNSUPPORTED, "softsh_view_info::output_format");
    BAD(VIEW, in.view.max_recordings = 1025, INVALID, "softsh_view_info::max_recordings");
    BAD(VIEW, in.view.max_views = 2, UNSUPPORTED, "softsh_view_info::max_views");
    BAD(VIEW, in.view.memory_mode = (softsh_memory_mode)-1, INVALID, "softsh_view_info::memory_mode");
    BAD(VIEW, in.settings.struct_size = 0, INVALID, "softsh_settings::struct_size");
    BAD(VIEW, in.settings.technique = (softsh_technique)4, INVALID, "softsh_settings::technique");
    BAD(VIEW, in.settings.technique = (softsh_technique)-1, INVALID, "softsh_settings::technique");
    BAD(VIEW, in.settings.pattern = (softsh_pattern)5, INVALID, "softsh_settings::pattern");
    BAD(VIEW, in.settings.primitive = (softsh_primitive)6, INVALID, "softsh_settings::primitive");
    BAD(VIEW, in.settings.primitive = SOFTSH_PRIMITIVE_MICRORECT, UNSUPPORTED, "softsh_settings::primitive");
    BAD(VIEW, in.settings.aggregation = (softsh_aggregation)3, INVALID, "softsh_settings::aggregation");
    BAD(VIEW, in.settings.merge = (softsh_merge)3, INVALID, "softsh_settings::merge");
    BAD(VIEW, in.settings.budget = 4097, INVALID, "softsh_settings::budget");
    BAD(VIEW, in.settings.min_level = 14, INVALID, "softsh_settings::min_level");
    BAD(VIEW, in.settings.packet = (softsh_packet)6, INVALID, "softsh_settings::packet");
    BAD(VIEW, in.settings.reconstruction = (softsh_reconstruction)5, INVALID, "softsh_settings::reconstruction");
    BAD(VIEW, in.settings.technique = SOFTSH_TECHNIQUE_CONTOUR;
        in.settings.reconstruction = SOFTSH_RECONSTRUCTION_FOLDS;
        in.settings.aggregation = SOFTSH_AGGREGATION_NEAREST, INVALID, "softsh_settings::reconstruction");
    BAD(VIEW, in.settings.technique = SOFTSH_TECHNIQUE_BITMASK; in.settings.outline = 1;
        in.settings.primitive = SOFTSH_PRIMITIVE_MICROPATCH, INVALID, "softsh_settings::outline");
    BAD(VIEW, in.settings.technique = SOFTSH_TECHNIQUE_AREA; in.settings.outline = 1;
        in.settings.aggregation = SOFTSH_AGGREGATION_NEAREST, INVALID, "softsh_settings::outline");
    BAD(VIEW, in.settings.technique = SOFTSH_TECHNIQUE_BITMASK; in.settings.outline = 1;
        in.settings.pattern = SOFTSH_PATTERN_32X32, UNSUPPORTED, "softsh_settings::outline");
    BAD(VIEW, in.settings.technique = SOFTSH_TECHNIQUE_BITMASK; in.settings.outline = 1;
        in.settings.filter_passes = 1, INVALID, "softsh_settings::outline");
    BAD(VIEW, in.settings.search = (softsh_search)3, INVALID, "softsh_settings::search");
    BAD(VIEW, in.settings.search = (softsh_search)-1, INVALID, "softsh_settings::search");
    BAD(VIEW, in.settings.technique = SOFTSH_TECHNIQUE_CONTOUR; in.settings.search = SOFTSH_SEARCH_WALK;
        in.settings.aggregation = SOFTSH_AGGREGATION_NEAREST, UNSUPPORTED, "softsh_settings::search");
    BAD(VIEW, in.settings.packet_cost.node = -1.0f, INVALID, "softsh_settings::packet_cost.node");
    BAD(VIEW, in.settings.packet_cost.edge = 2e6f, INVALID, "softsh_settings::packet_cost.edge");
    BAD(VIEW, in.settings.packet_cost.projection = NAN, INVALID, "softsh_settings::packet_cost.projection");
    BAD(VIEW, in.settings.packet_cost.divergence = 1.5f, INVALID, "softsh_settings::packet_cost.divergence");
    BAD(VIEW, in.settings.packet_cost.divergence = NAN, INVALID, "softsh_settings::packet_cost.divergence");
    BAD(VIEW, in.settings.filter_passes = 17, INVALID, "softsh_settings::filter_passes");
    scene_inputs valid;
    scene_fill(with.s, LAMP_RECTANGLE, 1, &valid);
    softsh_view *view = with.view;
    EXPECT(softsh_view_create(with.context, NULL, &view), INVALID, "softsh_view_info is NULL");
    assert_null(view);
    EXPECT(softsh_view_create(with.context, &valid.view, NULL), INVALID, "out is NULL");
    scene_message_count = 0;
    view = with.view;
    assert_int_equal(softsh_view_create(NULL, &valid.view, &view), INVALID);
    assert_null(view);
    VkMemoryRequirements requirements;
    assert_int_equal(softsh_view_memory_requirements(NULL, &requirements), INVALID);
    assert_int_equal(softsh_view_bind_memory(NULL, VK_NULL_HANDLE, 0, 0), INVALID);
    assert_int_equal(scene_message_count, 0);
    EXPECT(softsh_view_memory_requirements(with.view, NULL), INVALID, "out is NULL");
    softsh_view_destroy(NULL);
    /* A device that cannot hold the largest view's filter values says so. */
    if (with.s->g.properties.limits.maxStorageBufferRange < 3ull * 4 * SOFTSH_MAX_EXTENT * SOFTSH_MAX_EXTENT)
        BAD(VIEW, in.view.max_extent = ((VkExtent2D){SOFTSH_MAX_EXTENT, SOFTSH_MAX_EXTENT});
            in.settings.filter_passes = 1, LIMIT, "softsh_view_info: scratch for 16384 x 16384");
}

static void light_errors(void **state)
{
    (void)state;
    with.lamp = LAMP_RECTANGLE;
    BAD(BUILD, in.build.light = NULL, INVALID, "softsh_build_info::light");
    BAD(BUILD, in.light.struct_size = 0, INVALID, "softsh_light::struct_size");
    BAD(BUILD, in.light.shape = (softsh_light_shape)4, INVALID, "softsh_light::shape");
    BAD(BUILD, in.light.shape = SOFTSH_LIGHT_DISC, UNSUPPORTED, "softsh_light::shape");
    BAD(BUILD, in.light.shape = SOFTSH_LIGHT_SPHERE, UNSUPPORTED, "softsh_light::shape");
    BAD(BUILD, in.light.color_count = 2, UNSUPPORTED, "softsh_light::color_count");
    BAD(BUILD, in.light.texture = with.s->camera_depth.view, UNSUPPORTED, "softsh_light::texture");
    BAD_NUMBERS(BUILD, light.center[1], INVALID, "softsh_light::center");
    BAD_NUMBERS(BUILD, light.half_u[2], INVALID, "softsh_light::half_u");
    BAD_NUMBERS(BUILD, light.half_v[0], INVALID, "softsh_light::half_v");
    BAD_NUMBERS(BUILD, light.radius, INVALID, "softsh_light::radius");
    BAD(BUILD, in.light.radius = 1.0, INVALID, "softsh_light::radius");
    BAD(BUILD, in.light.half_v[2] = 0.0; in.light.half_v[0] = 0.3, INVALID, "softsh_light::half_u and half_v");
    BAD(BUILD, in.light.half_v[0] = 0.01, INVALID, "softsh_light::half_u and half_v");
    BAD(BUILD, in.light.half_u[0] = 1e100, INVALID, "softsh_light");
    BAD(BUILD, in.light.half_u[0] = 1e200, INVALID, "softsh_light::half_u");
    BAD(BUILD, in.light.half_u[0] = in.light.half_v[2] = 1e-30, INVALID, "softsh_light");
    BAD(BUILD, in.light.center[0] = 1e60, INVALID, "softsh_light::center");
    BAD(BUILD, in.light.center[1] = 1e60, INVALID, "softsh_light::center");
    /* Tilted against the map, and behind its projection centre. */
    BAD(BUILD, in.light.half_u[1] = 0.01, UNSUPPORTED, "tilted");
    BAD(BUILD, in.light.center[1] += 0.1, INVALID, "softsh_light::center");
    /* Its shape and the map's projection go together. */
    BAD(BUILD, in.light.shape = SOFTSH_LIGHT_DIRECTIONAL;
        in.light.direction[1] = -1.0, UNSUPPORTED, "orthographic map");
    with.lamp = LAMP_DIRECTIONAL;
    BAD(BUILD, in.light.shape = SOFTSH_LIGHT_RECTANGLE, UNSUPPORTED, "directional light");
    BAD(BUILD, in.light.direction[1] = 0.0, INVALID, "softsh_light::direction");
    BAD(BUILD, in.light.direction[0] = 1.0; in.light.direction[1] = 0.0, UNSUPPORTED, "softsh_light::direction");
    BAD(BUILD, in.light.direction[0] = 2.0, UNSUPPORTED, "softsh_light::direction");
    BAD(BUILD, in.light.direction[0] = 1e200, INVALID, "softsh_light::direction");
    BAD_NUMBERS(BUILD, light.direction[1], INVALID, "softsh_light::direction");
    BAD(BUILD, in.light.angular_radius = -0.1, INVALID, "softsh_light::angular_radius");
    BAD(BUILD, in.light.angular_radius = 0.51, INVALID, "softsh_light::angular_radius");
    BAD_NUMBERS(BUILD, light.angular_radius, INVALID, "softsh_light::angular_radius");
    BAD(BUILD, in.light.radius = 1.0, INVALID, "softsh_light::radius");
}

static void map_errors(void **state)
{
    (void)state;
    with.lamp = LAMP_RECTANGLE;
    BAD(BUILD, in.build.struct_size = 0, INVALID, "softsh_build_info::struct_size");
    BAD(BUILD, in.build.map_count = 0, INVALID, "softsh_build_info::map_count");
    BAD(BUILD, in.build.maps = NULL, INVALID, "softsh_build_info::maps");
    BAD(BUILD, in.build.map_count = SCENE_LAYERS + 1, LIMIT, "softsh_build_info::map_count");
    BAD(BUILD, in.build.map_count = UINT32_MAX, LIMIT, "softsh_build_info::map_count");
    BAD(BUILD, in.maps[0].struct_size = 0, INVALID, "softsh_map[0]::struct_size");
    BAD(BUILD, in.maps[0].role = (softsh_map_role)4, INVALID, "softsh_map[0]::role");
    BAD(BUILD, in.maps[0].grid[1] = 1, INVALID, "softsh_map[0]::grid");
    BAD(BUILD, in.maps[0].cell[0] = 1, INVALID, "::cell");
    BAD(BUILD, in.maps[0].role = SOFTSH_MAP_FACE, UNSUPPORTED, "softsh_map[0]::role");
    BAD(BUILD, in.maps[0].role = SOFTSH_MAP_CASCADE, UNSUPPORTED, "softsh_map[0]::role");
    BAD(BUILD, in.maps[0].index = 1, INVALID, "softsh_map[0]::index");
    BAD(BUILD, in.maps[0].index = UINT32_MAX, INVALID, "softsh_map[0]::index");
    BAD(BUILD, in.maps[0].view = VK_NULL_HANDLE, INVALID, "softsh_map[0]::view");
    BAD(BUILD, in.maps[0].format = VK_FORMAT_UNDEFINED, UNSUPPORTED, "softsh_map[0]::format");
    BAD(BUILD, in.maps[0].format = VK_FORMAT_R8_UNORM, UNSUPPORTED, "softsh_map[0]::format");
    BAD(BUILD, in.maps[0].format = (VkFormat)0x7fffffff, UNSUPPORTED, "softsh_map[0]::format");
    BAD(BUILD, in.maps[0].layout = VK_IMAGE_LAYOUT_UNDEFINED, INVALID, "softsh_map[0]::layout");
    BAD(BUILD, in.maps[0].layout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, INVALID, "softsh_map[0]::layout");
    BAD(BUILD, in.maps[0].format = VK_FORMAT_R32_SFLOAT, INVALID, "softsh_map[0]::layout");
    BAD(BUILD, in.maps[0].image_extent.width = 0, INVALID, "softsh_map[0]::image_extent");
    BAD(BUILD, in.maps[0].image_extent.height = SOFTSH_MAX_EXTENT + 1, INVALID, "softsh_map[0]::image_extent");
    BAD(BUILD, in.maps[0].image_extent.width = SCENE_MAP + 1, LIMIT, "softsh_map");
    BAD(BUILD, in.maps[0].rect = ((VkRect2D){{1, 0}, {SCENE_MAP, SCENE_MAP}}), INVALID, "softsh_map[0]::rect");
    BAD(BUILD, in.maps[0].rect = ((VkRect2D){{-1, 0}, {8, 8}}), INVALID, "softsh_map[0]::rect");
    BAD(BUILD, in.maps[0].rect = ((VkRect2D){{0, INT32_MIN}, {8, 8}}), INVALID, "softsh_map[0]::rect");
    BAD(BUILD, in.maps[0].rect = ((VkRect2D){{INT32_MAX, 0}, {UINT32_MAX, 8}}), INVALID, "softsh_map[0]::rect");
    BAD(BUILD, in.maps[0].rect = ((VkRect2D){{0, 0}, {8, 0}}), INVALID, "softsh_map[0]::rect");
    BAD(BUILD, in.maps[0].rect = ((VkRect2D){{4, 4}, {0, 0}}), INVALID, "softsh_map[0]::rect");
    BAD(BUILD, in.maps[0].array_layer = 1, UNSUPPORTED, "softsh_map[0]::array_layer");
    /* Of two layers. */
    BAD(BUILD, in.build.map_count = 2; in.maps[1].index = 0, INVALID, "softsh_map[1]::index");
    BAD(BUILD, in.build.map_count = 2; in.maps[1].index = 2, INVALID, "softsh_map[1]::index");
    BAD(BUILD, in.build.map_count = 2; in.maps[1].struct_size = 1, INVALID, "softsh_map[1]::struct_size");
    BAD(BUILD, in.build.map_count = 2; in.maps[1].view = VK_NULL_HANDLE, INVALID, "softsh_map[1]::view");
    BAD(BUILD, in.build.map_count = 2; in.maps[1].rect.extent = ((VkExtent2D){32, 32}), INVALID, "softsh_map[1]");
    BAD(BUILD, in.build.map_count = 2; in.maps[1].projection[0] *= 1.01, INVALID, "softsh_map[1]");
    BAD(BUILD, in.build.map_count = 2; in.maps[1].view_matrix[12] += 0.1, INVALID, "softsh_map[1]");
    BAD(BUILD, in.build.map_count = 2;
        memset(in.maps[1].projection, 0, sizeof in.maps[1].projection), INVALID, "softsh_map[1]::projection");
}

static void scale(double *values, double by)
{
    for (int i = 0; i < 16; i++)
        values[i] *= by;
}

static void matrix_errors(void **state)
{
    (void)state;
    with.lamp = LAMP_RECTANGLE;
    BAD_NUMBERS(BUILD, maps[0].view_matrix[7], INVALID, "softsh_map[0]::view_matrix");
    BAD_NUMBERS(BUILD, maps[0].projection[0], INVALID, "softsh_map[0]::projection");
    BAD(BUILD, memset(in.maps[0].view_matrix, 0, sizeof in.maps[0].view_matrix), INVALID, "softsh_map[0]::view_matrix");
    BAD(BUILD, in.maps[0].projection[5] = 0.0, INVALID, "softsh_map[0]::projection");
    BAD(BUILD, in.maps[0].projection[14] = 0.0, INVALID, "softsh_map[0]::projection");
    /* An oblique near plane. */
    BAD(BUILD, in.maps[0].projection[2] = 0.1, UNSUPPORTED, "softsh_map[0]::projection");
    BAD(BUILD, scale(in.maps[0].view_matrix, 1e300); scale(in.maps[0].projection, 1e300), INVALID, "softsh_map[0]");
    BAD(BUILD, scale(in.maps[0].view_matrix, 1e-300); scale(in.maps[0].projection, 1e-300), INVALID, "softsh_map[0]");
    BAD(BUILD, in.maps[0].projection[14] *= 1e-60, INVALID, "softsh_map[0]");
    with.lamp = LAMP_DIRECTIONAL;
    BAD(BUILD, in.maps[0].projection[15] = -1.0, INVALID, "softsh_map[0]::projection");
    BAD(BUILD, in.maps[0].projection[0] = 1e-300, INVALID, "softsh_map[0]::projection");
    with.lamp = LAMP_RECTANGLE;
    BAD_NUMBERS(VISIBILITY, camera.view_matrix[3], INVALID, "softsh_camera::view_matrix");
    BAD_NUMBERS(VISIBILITY, camera.projection[15], INVALID, "softsh_camera::projection");
    BAD(VISIBILITY, memset(in.camera.view_matrix, 0, sizeof in.camera.view_matrix), INVALID,
        "softsh_camera::view_matrix");
    BAD(VISIBILITY, memset(in.camera.projection, 0, sizeof in.camera.projection), INVALID, "softsh_camera::projection");
    BAD(VISIBILITY, in.camera.projection[6] = 0.2, UNSUPPORTED, "softsh_camera::projection");
    BAD(VISIBILITY, scale(in.camera.view_matrix, 1e300); scale(in.camera.projection, 1e300), INVALID, "softsh_camera");
}

static void visibility_errors(void **state)
{
    (void)state;
    with.lamp = LAMP_RECTANGLE;
    scene *s = with.s;
    BAD(VISIBILITY, in.visibility.struct_size = 0, INVALID, "softsh_visibility_info::struct_size");
    BAD(VISIBILITY, in.visibility.occluders = NULL, INVALID, "softsh_visibility_info::occluders");
    BAD(VISIBILITY, in.visibility.cameras = NULL, INVALID, "softsh_visibility_info::cameras");
    BAD(VISIBILITY, in.visibility.camera_count = 0, INVALID, "softsh_visibility_info::camera_count");
    BAD(VISIBILITY, in.visibility.camera_count = 2, UNSUPPORTED, "softsh_visibility_info::camera_count");
    BAD(VISIBILITY, in.visibility.visibility = VK_NULL_HANDLE, INVALID, "softsh_visibility_info::visibility");
    BAD(VISIBILITY, in.visibility.render_area = ((VkRect2D){{0, 0}, {SCENE_WIDTH + 1, 1}}), INVALID,
        "softsh_visibility_info::render_area");
    BAD(VISIBILITY, in.visibility.render_area = ((VkRect2D){{1, 1}, {0, 0}}), INVALID,
        "softsh_visibility_info::render_area");
    BAD(VISIBILITY, in.visibility.render_area = ((VkRect2D){{0, -1}, {4, 4}}), INVALID,
        "softsh_visibility_info::render_area");
    BAD(VISIBILITY, in.visibility.override_bias = 1;
        in.visibility.bias = -1.0, INVALID, "softsh_visibility_info::bias");
    BAD(VISIBILITY, in.visibility.override_bias = 1; in.visibility.bias = NAN, INVALID, "softsh_visibility_info::bias");
    BAD(VISIBILITY, in.visibility.override_bias = 1;
        in.visibility.bias = INFINITY, INVALID, "softsh_visibility_info::bias");
    BAD(VISIBILITY, in.visibility.stats_buffer = s->stats.buffer;
        in.visibility.stats_offset = 2, INVALID, "softsh_visibility_info::stats_offset");
    BAD(VISIBILITY, in.camera.struct_size = 0, INVALID, "softsh_camera::struct_size");
    BAD(VISIBILITY, in.camera.depth = VK_NULL_HANDLE, INVALID, "softsh_camera::depth");
    BAD(VISIBILITY, in.camera.depth_format = VK_FORMAT_R16_SFLOAT, UNSUPPORTED, "softsh_camera::depth_format");
    BAD(VISIBILITY, in.camera.depth_layout = VK_IMAGE_LAYOUT_PREINITIALIZED, INVALID, "softsh_camera::depth_layout");
    BAD(VISIBILITY, in.camera.samples = VK_SAMPLE_COUNT_4_BIT, UNSUPPORTED, "softsh_camera::samples");
    BAD(VISIBILITY, in.camera.samples = (VkSampleCountFlagBits)3, UNSUPPORTED, "softsh_camera::samples");
    BAD(VISIBILITY, in.camera.normals = s->normals.view, INVALID, "softsh_camera::normals");
    BAD(VISIBILITY, in.visibility.timestamps = &in.timestamps;
        in.timestamps.struct_size = 0, INVALID, "softsh_timestamps::struct_size");
    BAD(VISIBILITY, in.visibility.timestamps = &in.timestamps;
        in.timestamps.pool = VK_NULL_HANDLE, INVALID, "softsh_timestamps::pool");
    BAD(VISIBILITY, in.visibility.timestamps = &in.timestamps;
        in.timestamps.query_count = SOFTSH_MAX_PASSES, INVALID, "softsh_timestamps::query_count");
    BAD(VISIBILITY, in.visibility.timestamps = &in.timestamps;
        in.timestamps.first_query = UINT32_MAX, INVALID, "softsh_timestamps::first_query");
    BAD(BUILD, in.build.timestamps = &in.timestamps;
        in.timestamps.query_count = 0, INVALID, "softsh_timestamps::query_count");

    scene_inputs valid;
    scene_fill(s, LAMP_RECTANGLE, 1, &valid);
    EXPECT(softsh_cmd_build_occluders(VK_NULL_HANDLE, with.occluders, &valid.build), INVALID, "cmd is VK_NULL_HANDLE");
    EXPECT(softsh_cmd_build_occluders(with.cmd, with.occluders, NULL), INVALID, "softsh_build_info is NULL");
    EXPECT(softsh_cmd_compute_visibility(VK_NULL_HANDLE, with.view, &valid.visibility), INVALID,
           "cmd is VK_NULL_HANDLE");
    EXPECT(softsh_cmd_compute_visibility(with.cmd, with.view, NULL), INVALID, "softsh_visibility_info is NULL");
    assert_int_equal(softsh_cmd_build_occluders(with.cmd, NULL, &valid.build), INVALID);
    assert_int_equal(softsh_cmd_compute_visibility(with.cmd, NULL, &valid.visibility), INVALID);
}

/* Errors that depend on what the objects were created with. */
static void mismatches(void **state)
{
    (void)state;
    scene *s = with.s;
    scene_inputs valid;
    softsh_view *const plain = with.view;
    softsh_context *other = scene_context(s, false, NULL);
    scene_fill(s, LAMP_RECTANGLE, 1, &valid);
    softsh_occluders *foreign = scene_occluders(other, &valid);
    assert_int_equal(softsh_cmd_build_occluders(with.cmd, foreign, &valid.build), SOFTSH_SUCCESS);
    with.lamp = LAMP_RECTANGLE;
    BAD(VISIBILITY, in.visibility.occluders = foreign, INVALID, "softsh_visibility_info::occluders");

    valid.view.stats = 0;
    valid.view.normals = 1;
    with.view = scene_view(with.context, &valid);
    BAD(VISIBILITY, in.camera.normals = s->normals.view; in.camera.normals_layout = VK_IMAGE_LAYOUT_GENERAL;
        in.visibility.stats_buffer = s->stats.buffer, INVALID, "softsh_visibility_info::stats_buffer");
    BAD(VISIBILITY, (void)in, INVALID, "softsh_camera::normals");
    BAD(VISIBILITY, in.camera.normals = s->normals.view;
        in.camera.normals_layout = VK_IMAGE_LAYOUT_UNDEFINED, INVALID, "softsh_camera::normals_layout");
    softsh_view_destroy(with.view);

    valid.view.normals = 0;
    valid.settings.technique = SOFTSH_TECHNIQUE_BITMASK;
    valid.settings.outline = 1;
    valid.occluders.no_folds = 1;
    softsh_occluders *const bare = scene_occluders(with.context, &valid);
    assert_int_equal(softsh_cmd_build_occluders(with.cmd, bare, &valid.build), SOFTSH_SUCCESS);
    with.view = scene_view(with.context, &valid);
    BAD(VISIBILITY, in.visibility.occluders = bare, INVALID, "no_folds");
    softsh_view_destroy(with.view);
    valid.settings.outline = 0;
    valid.settings.technique = SOFTSH_TECHNIQUE_CONTOUR;
    valid.settings.aggregation = SOFTSH_AGGREGATION_SAMPLED;
    for (int how = SOFTSH_RECONSTRUCTION_FOLDS; how <= SOFTSH_RECONSTRUCTION_BACKS; how++) {
        valid.settings.reconstruction = (softsh_reconstruction)how;
        with.view = scene_view(with.context, &valid);
        BAD(VISIBILITY, in.visibility.occluders = bare, INVALID, "no_folds");
        softsh_view_destroy(with.view);
    }
    valid.settings.reconstruction = SOFTSH_RECONSTRUCTION_DEFAULT;
    valid.settings.search = SOFTSH_SEARCH_WALK;
    with.view = scene_view(with.context, &valid);
    BAD(VISIBILITY, (void)in, INVALID, "dual_grids");
    softsh_view_destroy(with.view);
    valid.settings.technique = SOFTSH_TECHNIQUE_BITMASK;
    valid.settings.search = SOFTSH_SEARCH_DEFAULT;
    valid.view.normals = 1;

    /* Micropatches cannot do a light whose axes are turned against the map's. */
    valid.settings.primitive = SOFTSH_PRIMITIVE_MICROPATCH;
    with.view = scene_view(with.context, &valid);
    valid.light.half_u[2] = valid.light.half_u[0];
    valid.light.half_v[0] = -valid.light.half_v[2];
    softsh_occluders *turned = scene_occluders(with.context, &valid);
    assert_int_equal(softsh_cmd_build_occluders(with.cmd, turned, &valid.build), SOFTSH_SUCCESS);
    BAD(VISIBILITY, in.visibility.occluders = turned; in.camera.normals = s->normals.view;
        in.camera.normals_layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, UNSUPPORTED, "softsh_light");
    softsh_view_destroy(with.view);
    with.view = plain;

    assert_true(gpu_submit(&s->g, with.cmd));
    with.cmd = gpu_begin(&s->g);
    assert_non_null(with.cmd);
    softsh_occluders_destroy(bare);
    softsh_occluders_destroy(turned);
    softsh_occluders_destroy(foreign);
    softsh_context_destroy(other);
}

static VkDeviceMemory allocate(scene *s, const VkMemoryRequirements *requirements)
{
    uint32_t type = 0;
    while (!(requirements->memoryTypeBits & 1u << type))
        type++;
    const VkMemoryAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = requirements->size, .memoryTypeIndex = type};
    VkDeviceMemory memory;
    assert_int_equal(vkAllocateMemory(s->g.device, &info, NULL, &memory), VK_SUCCESS);
    return memory;
}

static void memory_errors(void **state)
{
    (void)state;
    scene *s = with.s;
    softsh_occluders *const occluders = with.occluders;
    softsh_view *const view = with.view;
    VkMemoryRequirements need, view_need;
    assert_int_equal(softsh_occluders_memory_requirements(occluders, &need), SOFTSH_SUCCESS);
    assert_true(need.size > 0 && need.alignment > 0 && need.memoryTypeBits != 0);
    VkDeviceMemory memory = allocate(s, &need);
    EXPECT(softsh_occluders_bind_memory(occluders, memory, 0, need.size), STATE, "softsh_occluders_bind_memory");
    assert_int_equal(softsh_view_memory_requirements(view, &view_need), SOFTSH_SUCCESS);
    EXPECT(softsh_view_bind_memory(view, memory, 0, view_need.size), STATE, "softsh_view_bind_memory");
    vkFreeMemory(s->g.device, memory, NULL);

    scene_inputs valid;
    scene_fill(s, LAMP_RECTANGLE, 1, &valid);
    valid.occluders.memory_mode = valid.view.memory_mode = SOFTSH_MEMORY_CALLER;
    with.occluders = scene_occluders(with.context, &valid);
    with.view = scene_view(with.context, &valid);
    assert_int_equal(softsh_occluders_memory_requirements(with.occluders, &need), SOFTSH_SUCCESS);
    assert_int_equal(softsh_view_memory_requirements(with.view, &view_need), SOFTSH_SUCCESS);
    memory = allocate(s, &need);
    VkDeviceMemory view_memory = allocate(s, &view_need);
    with.lamp = LAMP_RECTANGLE;
    BAD(BUILD, (void)in, STATE, "no memory");
    BAD(VISIBILITY, in.visibility.occluders = occluders, STATE, "no memory");
    EXPECT(softsh_occluders_bind_memory(with.occluders, VK_NULL_HANDLE, 0, need.size), INVALID,
           "memory is VK_NULL_HANDLE");
    EXPECT(softsh_occluders_bind_memory(with.occluders, memory, 1, need.size), INVALID, "offset is 1");
    EXPECT(softsh_occluders_bind_memory(with.occluders, memory, 0, need.size - 1), INVALID, "size is");
    EXPECT(softsh_view_bind_memory(with.view, VK_NULL_HANDLE, 0, view_need.size), INVALID, "memory is VK_NULL_HANDLE");
    EXPECT(softsh_view_bind_memory(with.view, view_memory, 3, view_need.size), INVALID, "offset is 3");
    EXPECT(softsh_view_bind_memory(with.view, view_memory, 0, 0), INVALID, "size is 0");
    /* None of these has used the one chance to bind. */
    assert_int_equal(softsh_occluders_bind_memory(with.occluders, memory, 0, need.size), SOFTSH_SUCCESS);
    assert_int_equal(softsh_view_bind_memory(with.view, view_memory, 0, view_need.size), SOFTSH_SUCCESS);
    EXPECT(softsh_occluders_bind_memory(with.occluders, memory, 0, need.size), STATE, "bound already");
    EXPECT(softsh_view_bind_memory(with.view, view_memory, 0, view_need.size), STATE, "bound already");
    BAD(VISIBILITY, in.visibility.occluders = with.occluders, STATE, "never built");
    softsh_view_destroy(with.view);
    softsh_occluders_destroy(with.occluders);
    vkFreeMemory(s->g.device, memory, NULL);
    vkFreeMemory(s->g.device, view_memory, NULL);
    with.occluders = occluders;
    with.view = view;
}

/* Sub-lights: maps of different ones, grids that do not match, calls out of order. */
static void sublight_errors(void **state)
{
    (void)state;
    scene *s = with.s;
    scene_inputs valid;
    softsh_view *const plain = with.view;
#define SUBLIGHT(map, columns, rows, x, y)                                                                             \
    (in.maps[map].role = SOFTSH_MAP_SUBLIGHT, in.maps[map].grid[0] = columns, in.maps[map].grid[1] = rows,             \
     in.maps[map].cell[0] = x, in.maps[map].cell[1] = y)
    with.lamp = LAMP_RECTANGLE;
    BAD(BUILD, SUBLIGHT(0, 0, 2, 0, 0), INVALID, "softsh_map[0]::grid is (0, 2)");
    BAD(BUILD, SUBLIGHT(0, 2, SOFTSH_MAX_SUBLIGHTS + 1, 0, 0), INVALID, "softsh_map[0]::grid");
    BAD(BUILD, SUBLIGHT(0, UINT32_MAX, UINT32_MAX, 0, 0), INVALID, "softsh_map[0]::grid");
    BAD(BUILD, SUBLIGHT(0, 2, 3, 2, 0), INVALID, "softsh_map[0]::cell is (2, 0), expected less than ::grid, (2, 3)");
    BAD(BUILD, SUBLIGHT(0, 2, 3, 0, UINT32_MAX), INVALID, "softsh_map[0]::cell");
    with.lamp = LAMP_DIRECTIONAL;
    BAD(BUILD, SUBLIGHT(0, 2, 2, 0, 0), UNSUPPORTED, "SOFTSH_MAP_SUBLIGHT");
    with.lamp = LAMP_RECTANGLE;
#define TWO(change, words)                                                                                             \
    do {                                                                                                               \
        scene_inputs in;                                                                                               \
        scene_fill(s, LAMP_RECTANGLE, 2, &in);                                                                         \
        SUBLIGHT(0, 2, 2, 0, 0);                                                                                       \
        SUBLIGHT(1, 2, 2, 0, 0);                                                                                       \
        change;                                                                                                        \
        EXPECT(softsh_cmd_build_occluders(with.cmd, with.occluders, &in.build), INVALID, words);                       \
    } while (0)
    TWO(SUBLIGHT(1, 2, 2, 1, 0), "softsh_map[1] is of sub-light (1, 0) of 2 x 2, but softsh_map[0] of (0, 0) of 2 x 2");
    TWO(SUBLIGHT(1, 2, 3, 0, 0), "softsh_map[1] is of sub-light (0, 0) of 2 x 3, but softsh_map[0] of (0, 0) of 2 x 2");
    TWO((in.maps[1].role = SOFTSH_MAP_LAYER, in.maps[1].grid[0] = in.maps[1].grid[1] = 0), "softsh_map[1]::role");
#undef TWO

    /* One object for each of these. */
    static const uint32_t cells[][4] = {{2, 2, 0, 0}, {2, 2, 1, 0}, {2, 2, 0, 1}, {3, 2, 1, 0}};
    softsh_occluders *parts[4];
    for (size_t i = 0; i < 4; i++) {
        scene_inputs in;
        scene_fill(s, LAMP_RECTANGLE, 1, &in);
        SUBLIGHT(0, cells[i][0], cells[i][1], cells[i][2], cells[i][3]);
        parts[i] = scene_occluders(with.context, &in);
        assert_int_equal(softsh_cmd_build_occluders(with.cmd, parts[i], &in.build), SOFTSH_SUCCESS);
    }
    BAD(VISIBILITY, in.visibility.occluders = parts[0], INVALID, "a sub-light of 2 x 2, but the view");
    scene_fill(s, LAMP_RECTANGLE, 1, &valid);
    valid.view.sublights = 1;
    with.view = scene_view(with.context, &valid);
    BAD(VISIBILITY, in.visibility.occluders = parts[1], STATE, "sub-light (1, 0) of 2 x 2, expected (0, 0) first");
    valid.visibility.occluders = parts[0];
    assert_int_equal(softsh_cmd_compute_visibility(with.cmd, with.view, &valid.visibility), SOFTSH_SUCCESS);
    BAD(VISIBILITY, in.visibility.occluders = parts[2], STATE, "(0, 1) of 2 x 2, expected (1, 0) of 2 x 2");
    BAD(VISIBILITY, in.visibility.occluders = parts[3], STATE, "(1, 0) of 3 x 2, expected (1, 0) of 2 x 2");
    BAD(VISIBILITY, in.visibility.occluders = parts[1];
        in.visibility.render_area = ((VkRect2D){{1, 0}, {3, 3}}), INVALID, "softsh_visibility_info::render_area");
    valid.visibility.occluders = parts[1];
    assert_int_equal(softsh_cmd_compute_visibility(with.cmd, with.view, &valid.visibility), SOFTSH_SUCCESS);
    /* A light that is not divided begins anew. */
    valid.visibility.occluders = with.occluders;
    assert_int_equal(softsh_cmd_compute_visibility(with.cmd, with.view, &valid.visibility), SOFTSH_SUCCESS);
    BAD(VISIBILITY, in.visibility.occluders = parts[2], STATE, "(0, 1) of 2 x 2, expected (0, 0) first");

    assert_true(gpu_submit(&s->g, with.cmd));
    with.cmd = gpu_begin(&s->g);
    assert_non_null(with.cmd);
    softsh_view_destroy(with.view);
    with.view = plain;
    for (size_t i = 0; i < 4; i++)
        softsh_occluders_destroy(parts[i]);

    scene_message_count = 0;
    softsh_light out = {.struct_size = sizeof out}, small = {.struct_size = 1};
    const uint32_t grid[2] = {2, 3}, cell[2] = {1, 2}, outside[2] = {1, 3}, none[2] = {2, 0}, many[2] = {17, 1};
    scene_fill(s, LAMP_RECTANGLE, 1, &valid);
    assert_int_equal(softsh_sublight_create(&valid.light, grid, cell, &out), SOFTSH_SUCCESS);
    for (int i = 0; i < 3; i++) {
        const double u = valid.light.half_u[i], v = valid.light.half_v[i], center = valid.light.center[i];
        assert_true(fabs(out.half_u[i] - u / 2.0) <= 1e-12 && fabs(out.half_v[i] - v / 3.0) <= 1e-12 &&
                    fabs(out.center[i] - (center + u / 2.0 + v * 2.0 / 3.0)) <= 1e-12);
    }
    assert_int_equal(softsh_sublight_create(NULL, grid, cell, &out), INVALID);
    assert_int_equal(softsh_sublight_create(&valid.light, NULL, cell, &out), INVALID);
    assert_int_equal(softsh_sublight_create(&valid.light, grid, NULL, &out), INVALID);
    assert_int_equal(softsh_sublight_create(&valid.light, grid, cell, NULL), INVALID);
    assert_int_equal(softsh_sublight_create(&valid.light, grid, cell, &small), INVALID);
    assert_int_equal(softsh_sublight_create(&valid.light, grid, outside, &out), INVALID);
    assert_int_equal(softsh_sublight_create(&valid.light, none, cell, &out), INVALID);
    assert_int_equal(softsh_sublight_create(&valid.light, many, cell, &out), INVALID);
    valid.light.center[1] = NAN;
    assert_int_equal(softsh_sublight_create(&valid.light, grid, cell, &out), INVALID);
    valid.light.shape = SOFTSH_LIGHT_DIRECTIONAL;
    assert_int_equal(softsh_sublight_create(&valid.light, grid, cell, &out), UNSUPPORTED);
    valid.light.shape = (softsh_light_shape)9;
    assert_int_equal(softsh_sublight_create(&valid.light, grid, cell, &out), INVALID);
    assert_int_equal(scene_message_count, 0);
#undef SUBLIGHT
}

static void frustum_errors(void **state)
{
    (void)state;
    scene_inputs valid;
    const double target[3] = {0.0, 0.0, 0.0};
    softsh_light_frustum out = {.struct_size = sizeof out}, small = {.struct_size = 1};
    scene_message_count = 0;
#define FRUSTUM(change, expected)                                                                                      \
    do {                                                                                                               \
        scene_fill(with.s, LAMP_RECTANGLE, 1, &valid);                                                                 \
        double at[3] = {0.0, 0.0, 0.0}, radius = 1.0, behind = 0.1;                                                    \
        change;                                                                                                        \
        assert_int_equal(softsh_light_frustum_create(&valid.light, at, radius, behind, &out), expected);               \
    } while (0)
    FRUSTUM((void)at, SOFTSH_SUCCESS);
    FRUSTUM(valid.light.struct_size = 0, INVALID);
    FRUSTUM(valid.light.shape = SOFTSH_LIGHT_DIRECTIONAL, UNSUPPORTED);
    FRUSTUM(valid.light.shape = SOFTSH_LIGHT_SPHERE, UNSUPPORTED);
    FRUSTUM(valid.light.shape = (softsh_light_shape)9, INVALID);
    FRUSTUM(valid.light.center[0] = NAN, INVALID);
    FRUSTUM(valid.light.half_u[0] = 0.0, INVALID);
    FRUSTUM(valid.light.half_v[2] = INFINITY, INVALID);
    FRUSTUM(valid.light.half_v[0] = 1.0; valid.light.half_v[2] = 0.0, INVALID);
    FRUSTUM(at[1] = NAN, INVALID);
    FRUSTUM(radius = 0.0, INVALID);
    FRUSTUM(radius = -1.0, INVALID);
    FRUSTUM(radius = NAN, INVALID);
    FRUSTUM(radius = INFINITY, INVALID);
    FRUSTUM(radius = 1e308; at[1] = -1e308, INVALID);
    FRUSTUM(behind = -0.1, INVALID);
    FRUSTUM(behind = NAN, INVALID);
    FRUSTUM(at[1] = 4.0; behind = 0.0, INVALID);
#undef FRUSTUM
    scene_fill(with.s, LAMP_RECTANGLE, 1, &valid);
    assert_int_equal(softsh_light_frustum_create(NULL, target, 1.0, 0.0, &out), INVALID);
    assert_int_equal(softsh_light_frustum_create(&valid.light, NULL, 1.0, 0.0, &out), INVALID);
    assert_int_equal(softsh_light_frustum_create(&valid.light, target, 1.0, 0.0, NULL), INVALID);
    assert_int_equal(softsh_light_frustum_create(&valid.light, target, 1.0, 0.0, &small), INVALID);
    assert_int_equal(scene_message_count, 0);
}

/* What a failed build was told is not what a later visibility call uses. */
static void objects_survive(void **state)
{
    (void)state;
    scene *s = with.s;
    scene_inputs valid;
    static float before[SCENE_PIXELS];
    scene_fill(s, LAMP_RECTANGLE, 1, &valid);
    scene_render(s, with.occluders, with.view, &valid);
    scene_expect_shadow(s->picture);
    memcpy(before, s->picture, sizeof before);

    scene_fill(s, LAMP_SECOND, 1, &valid);
    valid.light.half_u[1] = 0.1;
    EXPECT(softsh_cmd_build_occluders(with.cmd, with.occluders, &valid.build), UNSUPPORTED, "tilted");
    scene_fill(s, LAMP_RECTANGLE, 1, &valid);
    VkCommandBuffer cmd = gpu_begin(&s->g);
    valid.visibility.occluders = with.occluders;
    assert_int_equal(softsh_cmd_compute_visibility(cmd, with.view, &valid.visibility), SOFTSH_SUCCESS);
    assert_true(gpu_submit(&s->g, cmd));
    assert_true(gpu_image_read(&s->g, &s->output, s->picture, sizeof s->picture));
    assert_memory_equal(s->picture, before, sizeof before);
}

/* The first test: nothing has been built yet. */
static void never_built(void **state)
{
    (void)state;
    with.lamp = LAMP_RECTANGLE;
    BAD(VISIBILITY, (void)in, STATE, "softsh_visibility_info::occluders was never built");
    BAD(BUILD, in.light.radius = 1.0, INVALID, "softsh_light::radius");
    BAD(VISIBILITY, (void)in, STATE, "softsh_visibility_info::occluders was never built");
    scene_inputs valid;
    scene_fill(with.s, LAMP_RECTANGLE, 1, &valid);
    assert_int_equal(softsh_cmd_build_occluders(with.cmd, with.occluders, &valid.build), SOFTSH_SUCCESS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(never_built),         cmocka_unit_test(context_errors),   cmocka_unit_test(missing_functions),
        cmocka_unit_test(requirements_errors), cmocka_unit_test(occluders_errors), cmocka_unit_test(view_errors),
        cmocka_unit_test(light_errors),        cmocka_unit_test(map_errors),       cmocka_unit_test(matrix_errors),
        cmocka_unit_test(visibility_errors),   cmocka_unit_test(mismatches),       cmocka_unit_test(memory_errors),
        cmocka_unit_test(sublight_errors),     cmocka_unit_test(frustum_errors),   cmocka_unit_test(objects_survive),
    };
    return cmocka_run_group_tests_name("errors", tests, setup, teardown);
}
