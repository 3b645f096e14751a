/* Valid recordings of every kind stay silent under validation with synchronization validation. So that silence means
 * something, recordings and programs with known faults must be reported, among them the library's own passes with their
 * barriers taken away one at a time. */
#include "scene.h"

#include <stdio.h>
#include <string.h>

/* Messages since the last call. */
static unsigned heard(scene *s)
{
    const unsigned count = s->g.validation_messages;
    s->g.validation_messages = 0;
    return count;
}

static void settings_are_silent(void **state)
{
    scene *s = *state;
    softsh_context *context = scene_context(s, true, NULL);
    for (int i = 0; i < 24; i++) {
        scene_inputs in;
        const scene_lamp lamp = i % LAMP_COUNT;
        scene_fill(s, lamp, 1 + i % SCENE_LAYERS, &in);
        in.settings.technique = i % 5 == 2   ? SOFTSH_TECHNIQUE_CONTOUR
                                : i % 3 == 0 ? SOFTSH_TECHNIQUE_AREA
                                             : SOFTSH_TECHNIQUE_BITMASK;
        in.settings.pattern = i % 5;
        in.settings.primitive = i % SOFTSH_PRIMITIVE_MICRORECT;
        in.settings.aggregation = i % 3;
        in.settings.merge = i % 2;
        in.settings.budget = i % 4 == 3 ? 4 : 0;
        in.settings.min_level = i % 7 == 6;
        in.settings.filter_passes = i % 4;
        in.settings.no_hierarchy = i % 6 == 5;
        in.occluders.accel = i % 4;
        in.occluders.ysm_join = i % 8 == 7 ? 8 : 0;
        in.view.stats = i % 2;
        in.view.normals = i % 3 == 1;
        if (in.view.normals) {
            in.camera.normals = s->normals.view;
            in.camera.normals_layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        }
        if (in.view.stats)
            in.visibility.stats_buffer = s->stats.buffer;
        if (i % 5 == 4)
            in.visibility.render_area = (VkRect2D){{8, 5}, {33, 17}};
        if (i % 7 == 5)
            in.maps[0].rect = in.maps[1].rect = (VkRect2D){{3, 1}, {37, 29}};
        if (i == 9)
            in.view.settings = NULL;
        /* Folds, dual grids, and views that combine sub-lights. */
        const bool folds = i % 4 == 1;
        in.occluders.no_folds = !folds && in.view.settings;
        in.view.sublights = i % 3 == 2;
        if (folds && in.settings.technique != SOFTSH_TECHNIQUE_CONTOUR) {
            in.settings.outline = 1;
            in.settings.primitive = SOFTSH_PRIMITIVE_DEFAULT;
            in.settings.aggregation = SOFTSH_AGGREGATION_SAMPLED;
            in.settings.pattern = i % 3;
            in.settings.filter_passes = 0;
        }
        if (folds && in.settings.technique == SOFTSH_TECHNIQUE_CONTOUR) {
            in.settings.reconstruction = 2 + i / 4 % 3;
            in.settings.aggregation = SOFTSH_AGGREGATION_SAMPLED;
        }
        in.occluders.dual_grids = i % 3 == 2;
        if (in.occluders.dual_grids && in.settings.technique == SOFTSH_TECHNIQUE_CONTOUR) {
            in.settings.search = SOFTSH_SEARCH_WALK;
            in.settings.aggregation = SOFTSH_AGGREGATION_SAMPLED;
        }
        if (in.view.sublights && lamp != LAMP_DIRECTIONAL) {
            for (uint32_t m = 0; m < in.build.map_count; m++) {
                in.maps[m].role = SOFTSH_MAP_SUBLIGHT;
                in.maps[m].grid[0] = in.maps[m].grid[1] = 1;
            }
        }
        softsh_occluders *occluders = scene_occluders(context, &in);
        softsh_view *view = scene_view(context, &in);
        scene_render(s, occluders, view, &in);
        for (size_t p = 0; p < SCENE_PIXELS; p++)
            assert_true(s->picture[p] >= 0.0f && s->picture[p] <= 1.0f);
        softsh_view_destroy(view);
        softsh_occluders_destroy(occluders);
        scene_expect_silence(s);
    }
    softsh_context_destroy(context);
}

static bool has_feature(scene *s, VkFormat format, VkFormatFeatureFlags feature)
{
    VkFormatProperties properties;
    vkGetPhysicalDeviceFormatProperties(s->g.physical_device, format, &properties);
    return properties.optimalTilingFeatures & feature;
}

/* Every depth format as map and as camera depth, in every layout, and every output format; what the device lacks is
 * refused. */
static void formats_are_silent(void **state)
{
    scene *s = *state;
    static const VkFormat depths[] = {VK_FORMAT_D16_UNORM,  VK_FORMAT_X8_D24_UNORM_PACK32, VK_FORMAT_D24_UNORM_S8_UINT,
                                      VK_FORMAT_D32_SFLOAT, VK_FORMAT_D32_SFLOAT_S8_UINT,  VK_FORMAT_R32_SFLOAT};
    static const VkFormat outputs[] = {VK_FORMAT_R8_UNORM, VK_FORMAT_R16_UNORM, VK_FORMAT_R16_SFLOAT,
                                       VK_FORMAT_R32_SFLOAT};
    static const VkImageLayout layouts[] = {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL,
                                            VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL};
    softsh_context *context = scene_context(s, false, NULL);
    unsigned rendered = 0;
    for (int i = 0; i < 24; i++) {
        const VkFormat depth = depths[i % 6], format = outputs[i % 4];
        const bool colour = depth == VK_FORMAT_R32_SFLOAT;
        const VkImageLayout layout = layouts[(i / 6) % (colour ? 2 : 3)];
        scene_inputs in;
        scene_fill(s, LAMP_RECTANGLE, 1, &in);
        in.view.output_format = format;
        softsh_occluders *occluders = scene_occluders(context, &in);
        softsh_view *view;
        scene_message_count = 0;
        const softsh_result created = softsh_view_create(context, &in.view, &view);
        if (!has_feature(s, format, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT)) {
            assert_int_equal(created, SOFTSH_ERROR_UNSUPPORTED);
            scene_message_count = 0;
            softsh_occluders_destroy(occluders);
            continue;
        }
        assert_int_equal(created, SOFTSH_SUCCESS);
        in.maps[0].format = in.camera.depth_format = depth;
        in.maps[0].layout = in.camera.depth_layout = layout;
        VkCommandBuffer cmd = gpu_begin(&s->g);
        assert_non_null(cmd);
        gpu_image image = {0}, output = {0};
        if (!has_feature(s, depth, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT)) {
            assert_int_equal(softsh_cmd_build_occluders(cmd, occluders, &in.build), SOFTSH_ERROR_UNSUPPORTED);
            scene_expect_words("softsh_map[0]::format");
            scene_message_count = 0;
        } else {
            const gpu_image_info info = {.format = depth,
                                         .width = SCENE_WIDTH,
                                         .height = SCENE_HEIGHT,
                                         .usage = VK_IMAGE_USAGE_SAMPLED_BIT |
                                                  (colour ? 0 : VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT)};
            const gpu_image_info output_info = {
                .format = format, .width = SCENE_WIDTH, .height = SCENE_HEIGHT, .usage = VK_IMAGE_USAGE_STORAGE_BIT};
            if (!gpu_image_create(&s->g, &info, &image) || !gpu_image_create(&s->g, &output_info, &output))
                fail_msg("%s", s->g.error);
            gpu_cmd_image_layout(cmd, &image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
            const VkImageSubresourceRange range = {image.aspect, 0, 1, 0, 1};
            if (colour)
                vkCmdClearColorImage(cmd, image.image, image.layout, &(VkClearColorValue){.float32 = {1.0f}}, 1,
                                     &range);
            else
                vkCmdClearDepthStencilImage(cmd, image.image, image.layout, &(VkClearDepthStencilValue){1.0f, 0}, 1,
                                            &range);
            gpu_cmd_image_layout(cmd, &image, layout);
            gpu_cmd_image_layout(cmd, &output, VK_IMAGE_LAYOUT_GENERAL);
            in.maps[0].view = in.camera.depth = image.view;
            in.maps[0].rect.extent = (VkExtent2D){SCENE_HEIGHT, SCENE_HEIGHT};
            in.maps[0].image_extent = (VkExtent2D){SCENE_WIDTH, SCENE_HEIGHT};
            in.visibility.occluders = occluders;
            in.visibility.visibility = output.view;
            assert_int_equal(softsh_cmd_build_occluders(cmd, occluders, &in.build), SOFTSH_SUCCESS);
            assert_int_equal(softsh_cmd_compute_visibility(cmd, view, &in.visibility), SOFTSH_SUCCESS);
            rendered++;
        }
        assert_true(gpu_submit(&s->g, cmd));
        gpu_image_destroy(&s->g, &image);
        gpu_image_destroy(&s->g, &output);
        softsh_view_destroy(view);
        softsh_occluders_destroy(occluders);
        scene_expect_silence(s);
    }
    assert_true(rendered >= 12);
    softsh_context_destroy(context);
}

/* Objects of one light and one view, for the canaries. */
typedef struct objects {
    softsh_context *context;
    softsh_occluders *occluders;
    softsh_view *view;
} objects;

static objects create_objects(scene *s, scene_inputs *in)
{
    objects o = {.context = scene_context(s, true, NULL)};
    scene_fill(s, LAMP_RECTANGLE, 2, in);
    in->occluders.accel = SOFTSH_ACCEL_YSM;
    in->occluders.ysm_join = 16;
    in->settings.filter_passes = 2;
    o.occluders = scene_occluders(o.context, in);
    o.view = scene_view(o.context, in);
    in->visibility.occluders = o.occluders;
    in->visibility.stats_buffer = s->stats.buffer;
    return o;
}

static void destroy_objects(const objects *o)
{
    softsh_view_destroy(o->view);
    softsh_occluders_destroy(o->occluders);
    softsh_context_destroy(o->context);
}

/* The camera's depth is not in the layout that it is said to be in. */
static void wrong_layout_is_reported(void **state)
{
    scene *s = *state;
    scene_inputs in;
    const objects o = create_objects(s, &in);
    s->g.validation_quiet = true;
    VkCommandBuffer cmd = gpu_begin(&s->g);
    in.camera.depth_layout = VK_IMAGE_LAYOUT_GENERAL;
    assert_int_equal(softsh_cmd_build_occluders(cmd, o.occluders, &in.build), SOFTSH_SUCCESS);
    assert_int_equal(softsh_cmd_compute_visibility(cmd, o.view, &in.visibility), SOFTSH_SUCCESS);
    assert_true(gpu_submit(&s->g, cmd));
    assert_true(heard(s) > 0);
    s->g.validation_quiet = false;
    destroy_objects(&o);
}

/* The visibility image is read without the caller's barrier, and the map is written while it is being read. */
static void caller_hazards_are_reported(void **state)
{
    scene *s = *state;
    scene_inputs in;
    const objects o = create_objects(s, &in);
    gpu_buffer copy;
    assert_true(gpu_buffer_create(&s->g, sizeof s->picture, VK_BUFFER_USAGE_TRANSFER_DST_BIT, true, &copy));
    s->g.validation_quiet = true;
    VkCommandBuffer cmd = gpu_begin(&s->g);
    assert_int_equal(softsh_cmd_build_occluders(cmd, o.occluders, &in.build), SOFTSH_SUCCESS);
    assert_int_equal(softsh_cmd_compute_visibility(cmd, o.view, &in.visibility), SOFTSH_SUCCESS);
    assert_int_equal(heard(s), 0);
    const VkBufferImageCopy region = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                      .imageExtent = {SCENE_WIDTH, SCENE_HEIGHT, 1}};
    vkCmdCopyImageToBuffer(cmd, s->output.image, VK_IMAGE_LAYOUT_GENERAL, copy.buffer, 1, &region);
    assert_true(heard(s) > 0);
    assert_non_null(strstr(s->g.last_validation_message, "READ_AFTER_WRITE"));
    vkCmdFillBuffer(cmd, s->stats.buffer, 0, VK_WHOLE_SIZE, 0); /* the statistics were just copied there */
    assert_true(heard(s) > 0);
    assert_non_null(strstr(s->g.last_validation_message, "WRITE_AFTER_WRITE"));
    assert_true(gpu_submit(&s->g, cmd));
    heard(s);
    s->g.validation_quiet = false;
    gpu_buffer_destroy(&s->g, &copy);
    destroy_objects(&o);
}

/* Memory that the leak checker does not look at. */
static void *VKAPI_CALL bump(void *user, size_t size, size_t alignment, VkSystemAllocationScope scope)
{
    static _Alignas(64) unsigned char pool[1 << 16];
    static size_t used;
    (void)user;
    (void)scope;
    used = (used + alignment - 1) / alignment * alignment;
    if (size > sizeof pool - used)
        return NULL;
    used += size;
    return pool + used - size;
}

static void *VKAPI_CALL bump_again(void *user, void *memory, size_t size, size_t alignment,
                                   VkSystemAllocationScope scope)
{
    (void)memory;
    return bump(user, size, alignment, scope);
}

static void VKAPI_CALL keep(void *user, void *memory)
{
    (void)user;
    (void)memory;
}

static void leak_is_reported(void **state)
{
    (void)state;
    static gpu g;
    const VkAllocationCallbacks callbacks = {.pfnAllocation = bump, .pfnReallocation = bump_again, .pfnFree = keep};
    const VkBufferCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = 64, .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT};
    VkBuffer buffer;
    if (!gpu_create(&(gpu_info){.validation = true}, &g))
        fail_msg("%s", g.error);
    assert_int_equal(vkCreateBuffer(g.device, &info, &callbacks, &buffer), VK_SUCCESS);
    g.validation_quiet = true;
    gpu_destroy(&g);
    assert_true(g.validation_messages > 0);
}

/* Build and visibility, twice in one command buffer: the library's barriers are the only ones. */
static void record_twice(scene *s, const objects *o, scene_inputs *in)
{
    VkCommandBuffer cmd = gpu_begin(&s->g);
    assert_non_null(cmd);
    for (int i = 0; i < 2; i++) {
        in->visibility.stats_buffer = i == 1 ? s->stats.buffer : VK_NULL_HANDLE;
        assert_int_equal(softsh_cmd_build_occluders(cmd, o->occluders, &in->build), SOFTSH_SUCCESS);
        assert_int_equal(softsh_cmd_compute_visibility(cmd, o->view, &in->visibility), SOFTSH_SUCCESS);
    }
    assert_true(gpu_submit(&s->g, cmd));
}

/* What becomes of record_twice with fresh occluders and without some of its barriers. */
static unsigned report_without(scene *s, objects *o, scene_inputs *in, unsigned first, unsigned count)
{
    softsh_occluders_destroy(o->occluders);
    o->occluders = in->visibility.occluders = scene_occluders(o->context, in);
    s->g.last_validation_message[0] = '\0';
    spy_drop_barriers(first, count);
    record_twice(s, o, in);
    const char *hazard = strstr(s->g.last_validation_message, "SYNC-HAZARD-");
    const unsigned reports = heard(s);
    char kind[64] = "";
    if (hazard)
        sscanf(hazard, "%63[A-Z_-]", kind);
    printf("%2u + %u before %-22s %s %s\n", first, count, spy_after_barrier(first + count - 1),
           reports ? "reported" : "not seen", kind);
    return reports;
}

/* Passes that read what the pass before them wrote. The layer is blind in one command buffer where the reading pass
 * also writes what it reads through the same variable, which it takes for two writes by dispatches, and where the
 * writes were atomics alone. */
static bool must_be_seen(const char *after)
{
    static const char *const names[] = {"hierarchy_convert", "hierarchy_reduce", "hierarchy_plan", "hierarchy_widen",
                                        "bitmask_evaluate"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (!strcmp(after, names[i]))
            return true;
    return false;
}

static void missing_barriers_are_reported(void **state)
{
    scene *s = *state;
    scene_inputs in;
    objects o = create_objects(s, &in);
    assert_int_equal(report_without(s, &o, &in, 0, 0), 0);
    const unsigned barriers = spy_read().barriers;
    unsigned seen = 0, between = 0;
    bool overlooked = false;
    assert_true(barriers >= 20);
    s->g.validation_quiet = true;
    for (unsigned k = 0; k < barriers; k++) {
        const unsigned reports = report_without(s, &o, &in, k, 1);
        overlooked = overlooked || (reports == 0 && must_be_seen(spy_after_barrier(k)));
        seen += reports > 0;
    }
    const unsigned without_any = report_without(s, &o, &in, 0, barriers);
    printf("%u of %u missing barriers are reported\n", seen, barriers);

    /* Without filter passes, whose barriers come in between, parameters would be updated while they are still read. */
    softsh_view_destroy(o.view);
    in.settings.filter_passes = 0;
    o.view = scene_view(o.context, &in);
    report_without(s, &o, &in, 0, 0);
    const unsigned fewer = spy_read().barriers;
    for (unsigned k = fewer / 2; k < fewer; k++)
        if (report_without(s, &o, &in, k, 1) > 0 && !strcmp(spy_after_barrier(k), "vkCmdUpdateBuffer"))
            between++;
    spy_drop_barriers(0, 0);
    s->g.validation_quiet = false;
    destroy_objects(&o);
    assert_false(overlooked);
    assert_true(seen >= barriers / 2);
    assert_true(without_any > 0);
    assert_true(between > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(leak_is_reported),
        cmocka_unit_test(wrong_layout_is_reported),
        cmocka_unit_test(caller_hazards_are_reported),
        cmocka_unit_test(missing_barriers_are_reported),
        cmocka_unit_test(settings_are_silent),
        cmocka_unit_test(formats_are_silent),
    };
    return cmocka_run_group_tests_name("validation", tests, scene_setup, scene_teardown);
}
