/* The frame around an estimate: render areas and atlases, images, formats, several calls in one command buffer. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fixture.h"
#include "scenes.h"

enum { WIDTH = 61, HEIGHT = 45, PIXELS = WIDTH * HEIGHT };

static scene_info info_of(scene_light light)
{
    return (scene_info){
        .light = light, .light_scale = 0.5, .map_width = 70, .map_height = 56, .width = WIDTH, .height = HEIGHT};
}

/* Views are slow to make, so each is made once. */
typedef struct kept {
    sight_info info;
    sight sight;
} kept;
static kept views[32];
static uint32_t view_count;

static sight *view_for(const sight_info *info)
{
    for (uint32_t i = 0; i < view_count; i++)
        if (!memcmp(&views[i].info, info, sizeof *info))
            return &views[i].sight;
    assert_true(view_count < sizeof views / sizeof views[0]);
    views[view_count].info = *info;
    sight_create(info, &views[view_count].sight);
    return &views[view_count++].sight;
}

static int teardown(void **state)
{
    for (uint32_t i = 0; i < view_count; i++)
        sight_destroy(&views[i].sight);
    return fixture_teardown(state);
}

/* One run with lamp and eye made anew. */
static void run(const lamp_info *lamp_from, const eye_info *eye_from, const softsh_settings *settings, VkFormat format,
                float *visibility, softsh_stats *stats)
{
    sight_info info;
    lamp l;
    eye e;
    memset(&info, 0, sizeof info);
    lamp_create(lamp_from, &l);
    eye_create(eye_from, &e);
    info.settings = *settings;
    info.format = format;
    info.width = e.place.image_width;
    info.height = e.place.image_height;
    info.normals = eye_from->normals != NULL;
    sight_run(view_for(&info), &l, &e, NULL, visibility, stats);
    eye_destroy(&e);
    lamp_destroy(&l);
}

/* The same depths somewhere in larger images, with rubbish around them: the same visibility, nothing else written. */
static void parts_of_images_are_like_whole_ones(void **state)
{
    static const uint32_t places[][4] = {{0, 0, 61, 45}, {5, 3, 80, 60}, {8, 16, 69, 61}, {0, 7, 64, 64}};
    static float whole[PIXELS], part[PIXELS];
    (void)state;
    for (int light = 0; light < SCENE_LIGHT_COUNT; light++) {
        const scene_info info = info_of((scene_light)light);
        const softsh_settings plain = {.technique =
                                           light == SCENE_SUN ? SOFTSH_TECHNIQUE_CONTOUR : SOFTSH_TECHNIQUE_BITMASK,
                                       .filter_passes = light % 2 ? 0 : 2};
        softsh_stats before, after;
        scene s;
        scene_create(&info, &s);
        if (light % 2)
            s.eye.normals = NULL;
        run(&s.lamp, &s.eye, &plain, VK_FORMAT_UNDEFINED, whole, &before);
        for (size_t k = 1; k < sizeof places / sizeof places[0]; k++) {
            s.eye.place = (placement){WIDTH, HEIGHT, places[k][0], places[k][1], places[k][2], places[k][3]};
            s.lamp.place = (placement){70, 56, places[k][1], places[k][0], 70 + places[k][3], 56 + places[k][2]};
            s.lamp.max_extent = (VkExtent2D){70 + (uint32_t)k, 56 + 9 * (uint32_t)k};
            run(&s.lamp, &s.eye, &plain, VK_FORMAT_UNDEFINED, part, &after);
            assert_memory_equal(part, whole, sizeof whole);
            assert_int_equal(after.pixels, PIXELS);
            assert_int_equal(after.tiles, before.tiles);
            assert_int_equal(after.active, before.active);
        }
        scene_destroy(&s);
    }
}

/* Tiny areas, cut tiles, and one pixel. */
static void small_areas(void **state)
{
    static const uint32_t sizes[][2] = {{1, 1}, {7, 9}, {8, 8}, {9, 7}, {17, 1}, {1, 17}};
    (void)state;
    for (size_t k = 0; k < sizeof sizes / sizeof sizes[0]; k++) {
        const softsh_settings plain = {.technique = SOFTSH_TECHNIQUE_BITMASK};
        scene_info info = info_of(SCENE_CENTRED);
        float alone[17 * 17], within[17 * 17];
        softsh_stats stats;
        scene s;
        info.width = sizes[k][0];
        info.height = sizes[k][1];
        scene_create(&info, &s);
        run(&s.lamp, &s.eye, &plain, VK_FORMAT_UNDEFINED, alone, &stats);
        assert_int_equal(stats.pixels, sizes[k][0] * sizes[k][1]);
        assert_int_equal(stats.tiles, (sizes[k][0] + 7) / 8 * ((sizes[k][1] + 7) / 8));
        assert_int_equal(stats.lit + stats.umbra + stats.active, stats.pixels);
        s.eye.place = (placement){sizes[k][0], sizes[k][1], 3, 2, 40, 33};
        run(&s.lamp, &s.eye, &plain, VK_FORMAT_UNDEFINED, within, NULL);
        assert_memory_equal(alone, within, sizes[k][0] * sizes[k][1] * sizeof(float));
        scene_destroy(&s);
    }
}

/* Nothing depends on the order in which anything ran. */
static void runs_repeat(void **state)
{
    static float first[PIXELS], again[PIXELS];
    (void)state;
    for (int k = 0; k < 2 * SCENE_LIGHT_COUNT; k++) {
        const scene_info info = info_of((scene_light)(k / 2));
        const softsh_settings plain = {.technique = k % 2 ? SOFTSH_TECHNIQUE_CONTOUR : SOFTSH_TECHNIQUE_BITMASK,
                                       .filter_passes = 2};
        softsh_stats stats[2];
        scene s;
        scene_create(&info, &s);
        run(&s.lamp, &s.eye, &plain, VK_FORMAT_UNDEFINED, first, &stats[0]);
        for (int turn = 0; turn < 3; turn++) {
            run(&s.lamp, &s.eye, &plain, VK_FORMAT_UNDEFINED, again, &stats[1]);
            assert_memory_equal(first, again, sizeof first);
            assert_memory_equal(&stats[0], &stats[1], sizeof stats[0]);
        }
        scene_destroy(&s);
    }
}

static void formats_agree(void **state)
{
    static const struct {
        VkFormat format;
        double step;
    } formats[] = {
        {VK_FORMAT_R8_UNORM, 0.5 / 255.0}, {VK_FORMAT_R16_UNORM, 0.5 / 65535.0}, {VK_FORMAT_R16_SFLOAT, 0.5 / 1024.0}};
    static float exact[PIXELS], rounded[PIXELS];
    (void)state;
    for (size_t k = 0; k < sizeof formats / sizeof formats[0]; k++) {
        const scene_info info = info_of(SCENE_IN_FRONT);
        const softsh_settings plain = {.technique = SOFTSH_TECHNIQUE_BITMASK, .pattern = SOFTSH_PATTERN_32X32};
        VkFormatProperties properties;
        scene s;
        vkGetPhysicalDeviceFormatProperties(device.physical_device, formats[k].format, &properties);
        if (!(properties.optimalTilingFeatures & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT)) {
            print_message("no storage images of format %d here\n", (int)formats[k].format);
            continue;
        }
        scene_create(&info, &s);
        run(&s.lamp, &s.eye, &plain, VK_FORMAT_UNDEFINED, exact, NULL);
        s.eye.place = (placement){WIDTH, HEIGHT, 3, 1, 70, 50};
        run(&s.lamp, &s.eye, &plain, formats[k].format, rounded, NULL);
        for (uint32_t i = 0; i < PIXELS; i++) {
            assert_true(fabs((double)exact[i] - (double)rounded[i]) <= formats[k].step * 1.001);
            if (exact[i] == 0.0f || exact[i] == 1.0f)
                assert_true(exact[i] == rounded[i]);
        }
        scene_destroy(&s);
    }
}

static void record(VkCommandBuffer cmd, sight *v, const lamp *l, const eye *e, const gpu_image *image)
{
    const softsh_visibility_info info = {.struct_size = sizeof info,
                                         .occluders = l->occluders,
                                         .camera_count = 1,
                                         .cameras = &e->camera,
                                         .render_area = {{0, 0}, {WIDTH, HEIGHT}},
                                         .visibility = image->view};
    require(softsh_cmd_compute_visibility(cmd, v->view, &info));
}

/* Builds and visibility of two lights with one view in one command buffer, with nothing of the caller's between them:
 * what the header promises, watched by synchronization validation. */
static void calls_follow_each_other(void **state)
{
    static float apart[3][PIXELS], together[3][PIXELS];
    const gpu_image_info image_info = {
        .format = VK_FORMAT_R32_SFLOAT, .width = WIDTH, .height = HEIGHT, .usage = VK_IMAGE_USAGE_STORAGE_BIT};
    (void)state;
    for (int accel = SOFTSH_ACCEL_HSM; accel <= SOFTSH_ACCEL_YSM; accel++) {
        scene scenes[2];
        lamp lamps[2];
        gpu_image images[3];
        eye e;
        for (int i = 0; i < 2; i++) {
            scene_info info = info_of(i ? SCENE_SUN : SCENE_IN_FRONT);
            info.layers = 2;
            scene_create(&info, &scenes[i]);
            scenes[i].lamp.accel = (softsh_accel)accel;
            scenes[i].lamp.ysm_join = 32;
            scenes[i].lamp.reverse_order = i != 0;
            lamp_create(&scenes[i].lamp, &lamps[i]);
        }
        eye_create(&scenes[0].eye, &e);
        sight_info info;
        memset(&info, 0, sizeof info);
        info.settings = (softsh_settings){.technique = accel == SOFTSH_ACCEL_MSSM ? SOFTSH_TECHNIQUE_CONTOUR
                                                                                  : SOFTSH_TECHNIQUE_BITMASK,
                                          .filter_passes = 2};
        info.width = WIDTH;
        info.height = HEIGHT;
        info.normals = true;
        sight *const v = view_for(&info);
        for (int i = 0; i < 3; i++)
            assert_true(gpu_image_create(&device, &image_info, &images[i]));
        sight_run(v, &lamps[0], &e, NULL, apart[0], NULL);
        sight_run(v, &lamps[1], &e, NULL, apart[1], NULL);
        /* The third time around the first light is dimmer. */
        const softsh_light large = lamps[0].light;
        softsh_light small = large;
        for (int k = 0; k < 3; k++) {
            small.half_u[k] *= 0.3;
            small.half_v[k] *= 0.3;
        }
        VkCommandBuffer cmd = gpu_begin(&device);
        lamps[0].light = small;
        lamp_record(&lamps[0], cmd);
        assert_true(gpu_submit(&device, cmd));
        sight_run(v, &lamps[0], &e, NULL, apart[2], NULL);

        cmd = gpu_begin(&device);
        for (int i = 0; i < 3; i++)
            gpu_cmd_image_layout(cmd, &images[i], VK_IMAGE_LAYOUT_GENERAL);
        lamps[0].light = large;
        lamp_record(&lamps[0], cmd);
        lamp_record(&lamps[1], cmd);
        record(cmd, v, &lamps[0], &e, &images[0]);
        record(cmd, v, &lamps[1], &e, &images[1]);
        lamps[0].light = small;
        lamp_record(&lamps[0], cmd);
        record(cmd, v, &lamps[0], &e, &images[2]);
        assert_true(gpu_submit(&device, cmd));
        for (int i = 0; i < 3; i++) {
            assert_true(gpu_image_read(&device, &images[i], together[i], sizeof together[i]));
            assert_memory_equal(together[i], apart[i], sizeof together[i]);
            gpu_image_destroy(&device, &images[i]);
        }
        assert_memory_not_equal(apart[0], apart[1], sizeof apart[0]);
        assert_memory_not_equal(apart[0], apart[2], sizeof apart[0]);
        eye_destroy(&e);
        for (int i = 0; i < 2; i++) {
            lamp_destroy(&lamps[i]);
            scene_destroy(&scenes[i]);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_of_images_are_like_whole_ones),
        cmocka_unit_test(small_areas),
        cmocka_unit_test(runs_repeat),
        cmocka_unit_test(formats_agree),
        cmocka_unit_test(calls_follow_each_other),
    };
    return cmocka_run_group_tests(tests, fixture_setup, teardown);
}
