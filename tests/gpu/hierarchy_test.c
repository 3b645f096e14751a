/* The structures on the device, texel by texel: fan depths against double precision, hierarchies bit for bit against
 * brute force over the device's own fan depths. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fixture.h"
#include "readback.h"
#include "reference_hierarchy.h"
#include "reference_scene.h"

typedef enum filling { RANDOM, CHECKERBOARD, NONSENSE, FILLINGS } filling;

static void fill(filling kind, uint64_t *state, uint32_t width, uint32_t height, float *depth)
{
    static const float odd[] = {NAN, INFINITY, -INFINITY, -0.25f, 1.5f, 1e-40f, 3e38f, -0.0f, -NAN};
    for (uint32_t i = 0; i < width * height; i++) {
        depth[i] = (float)reference_random_range(state, 0.0, 1.0);
        if (kind == CHECKERBOARD)
            depth[i] = (i % width + i / width) % 2 ? 0.25f : 0.75f;
        else if (kind == NONSENSE && reference_random(state) % 3 == 0)
            depth[i] = odd[reference_random(state) % 9];
    }
}

/* A lamp with `layers` maps of random depth; its light is as large as its map, so that some kernel needs every level.
 */
typedef struct subject {
    lamp_info info;
    float *depth[SOFTSH_MAX_LAYERS];
} subject;

static void subject_create(subject *s, uint32_t width, uint32_t height, uint32_t layers, filling kind, uint64_t *state)
{
    const double at[3] = {0, 0, 0}, target[3] = {0, 0, -1}, up[3] = {0, 1, 0};
    memset(s, 0, sizeof *s);
    s->info.light.struct_size = sizeof s->info.light;
    s->info.light.half_u[0] = s->info.light.half_v[1] = 3.0;
    s->info.place = (placement){.width = width, .height = height};
    s->info.layer_count = layers;
    reference_look_at(at, target, up, s->info.view);
    for (uint32_t i = 0; i < layers; i++) {
        s->depth[i] = calloc((size_t)width * height, sizeof(float));
        assert_non_null(s->depth[i]);
        fill(kind, state, width, height, s->depth[i]);
        s->info.layers[i].depth = s->depth[i];
        reference_perspective((const double[4]){-1, 1, -1, 1}, 1.0 + i, 20.0, REFERENCE_DEPTH_NORMAL,
                              s->info.layers[i].projection);
    }
}

static void subject_destroy(subject *s)
{
    for (uint32_t i = 0; i < s->info.layer_count; i++)
        free(s->depth[i]);
}

/* g = scale d + offset in floats: two roundings of either term. */
static void check_fan_depths(const lamp_info *info, const readback *r)
{
    const size_t texels = (size_t)r->width * r->height;
    for (uint32_t layer = 0; layer < r->layers; layer++) {
        reference_map map;
        assert_true(
            reference_map_derive(&map, info->view, info->layers[layer].projection, r->width, r->height, &info->light));
        for (size_t i = 0; i < texels; i++) {
            const float stored = stored_depth(info->layers[layer].format, info->layers[layer].depth[i]);
            const double g = reference_map_depth_to_g(&map, (double)stored);
            const double room = ldexp(fabs(g - map.depth_offset) + fabs(map.depth_offset), -23);
            if (!(fabs((double)r->fan_depth[layer * texels + i] - g) <= room))
                fail_msg("layer %u, texel %zu, depth %g: %.9g for %.9g", layer, i, (double)stored,
                         (double)r->fan_depth[layer * texels + i], g);
        }
    }
}

static void same(reference_range a, reference_range b, const readback *r, const char *what, uint32_t level, uint32_t x,
                 uint32_t y)
{
    if (memcmp(&a, &b, sizeof a))
        fail_msg("%u x %u, join %u, %s level %u, texel (%u, %u): %.9g..%.9g for %.9g..%.9g", r->width, r->height,
                 r->join, what, level, x, y, (double)a.min, (double)a.max, (double)b.min, (double)b.max);
}

/* Every texel while brute force is quick; of large blocks all at the borders and one in `step` inside. */
static bool looked_at(uint32_t x, uint32_t y, uint32_t width, uint32_t height, uint32_t step)
{
    return x == 0 || y == 0 || x + 1 == width || y + 1 == height ? (x + y) % ((step + 15) / 16) == 0
                                                                 : (y * width + x) % step == 0;
}

static void check_levels(const readback *r)
{
    for (uint32_t layer = 0; layer < r->layers; layer++) {
        const float *const g = r->fan_depth + (size_t)layer * r->width * r->height;
        for (uint32_t level = 1; level <= r->top; level++)
            for (uint32_t y = 0; y < reference_hsm_size(r->height, level); y++)
                for (uint32_t x = 0; x < reference_hsm_size(r->width, level); x++)
                    same(readback_pyramid(r, layer, level, x, y), reference_hsm(g, r->width, r->height, level, x, y), r,
                         "pyramid", level, x, y);
        for (uint32_t level = 1; level <= r->top; level++)
            for (uint32_t y = 0; y < reference_hsm_size(r->height, level); y++)
                for (uint32_t x = 0; x < reference_hsm_size(r->width, level); x++) {
                    const uint32_t half = 1u << (level - 1), far_u = (x << level) + half, far_v = (y << level) + half;
                    const uint32_t u = far_u < r->width ? far_u : r->width - 1,
                                   v = far_v < r->height ? far_v : r->height - 1;
                    const float sample = readback_sample(r, layer, level, x, y);
                    assert_memory_equal(&sample, &g[(size_t)v * r->width + u], sizeof sample);
                }
    }
    /* Over all layers: the first one's farthest, the nearest of all. */
    for (uint32_t level = 1; level <= r->top && r->layers > 1; level++)
        for (uint32_t y = 0; y < reference_hsm_size(r->height, level); y++)
            for (uint32_t x = 0; x < reference_hsm_size(r->width, level); x++) {
                reference_range all = readback_pyramid(r, 0, level, x, y);
                for (uint32_t layer = 1; layer < r->layers; layer++)
                    all.max = fmaxf(all.max, readback_pyramid(r, layer, level, x, y).max);
                same(readback_pyramid(r, r->layers, level, x, y), all, r, "pyramid over all", level, x, y);
            }
    for (uint32_t level = 1; level <= r->wide_built; level++) {
        const uint32_t width = reference_hsm_size(r->width, r->join), height = reference_hsm_size(r->height, r->join);
        const uint64_t work = ((uint64_t)r->width * r->height) << 2 * (level < 8 ? level : 8);
        const uint32_t step = (uint32_t)(work / 50000000) * 2 + 1;
        for (uint32_t y = 0; y < height; y++)
            for (uint32_t x = 0; x < width; x++)
                if (looked_at(x, y, width, height, step)) {
                    reference_range all = {0};
                    for (uint32_t layer = 0; layer < r->layers; layer++) {
                        const float *const g = r->fan_depth + (size_t)layer * r->width * r->height;
                        const reference_range own =
                            reference_ysm(g, r->width, r->height, r->join, r->join + level, x, y);
                        all.max = layer ? fmaxf(all.max, own.max) : own.max;
                        all.min = layer ? all.min : own.min;
                    }
                    same(readback_wide(r, level, x, y), all, r, "wide", level, x, y);
                }
    }
}

/* Levels a full-resolution part of this size has. */
static uint32_t wide_levels(const readback *r)
{
    const uint32_t width = reference_hsm_size(r->width, r->join), height = reference_hsm_size(r->height, r->join);
    uint32_t levels = 0;
    while ((width > height ? width : height) >> (levels + 1))
        levels++;
    return levels;
}

static void check(const subject *s)
{
    lamp l;
    readback r;
    lamp_create(&s->info, &l);
    readback_create(&l, &r);
    assert_int_equal(r.width, s->info.place.width);
    assert_int_equal(r.height, s->info.place.height);
    assert_int_equal(r.layers, s->info.layer_count);
    assert_int_equal(reference_hsm_size(r.width, r.top), 1);
    assert_int_equal(reference_hsm_size(r.height, r.top), 1);
    if (s->info.accel == SOFTSH_ACCEL_HSM) {
        assert_int_equal(r.wide_built, 0);
    } else {
        const uint32_t most = s->info.accel == SOFTSH_ACCEL_MSSM ? UINT32_MAX
                              : s->info.ysm_join                 ? s->info.ysm_join
                                                                 : 256;
        assert_true(reference_hsm_size(r.width, r.join) <= most && reference_hsm_size(r.height, r.join) <= most);
        assert_true(r.join == 0 || reference_hsm_size(r.width, r.join - 1) > most ||
                    reference_hsm_size(r.height, r.join - 1) > most);
        assert_true(r.wide_built >= wide_levels(&r) && r.wide_built <= r.wide_allocated);
    }
    check_fan_depths(&s->info, &r);
    check_levels(&r);
    readback_destroy(&r);
    lamp_destroy(&l);
}

static const uint32_t sizes[][2] = {{1, 1},   {1, 37},  {300, 1},  {2, 2},    {7, 5},
                                    {33, 17}, {64, 64}, {100, 37}, {257, 129}};
enum { SIZES = sizeof sizes / sizeof sizes[0] };

static void all_sizes(softsh_accel accel, uint32_t join)
{
    uint64_t state = 100 + (uint64_t)accel + join;
    for (uint32_t k = 0; k < SIZES; k++) {
        subject s;
        subject_create(&s, sizes[k][0], sizes[k][1], 1 + k % 2, (filling)(k % FILLINGS), &state);
        s.info.accel = accel;
        s.info.ysm_join = join;
        check(&s);
        subject_destroy(&s);
    }
}

static void pyramids(void **state)
{
    (void)state;
    all_sizes(SOFTSH_ACCEL_HSM, 0);
}

static void multi_scale_maps(void **state)
{
    (void)state;
    all_sizes(SOFTSH_ACCEL_MSSM, 0);
}

static void hybrids_by_default(void **state)
{
    (void)state;
    all_sizes(SOFTSH_ACCEL_YSM, 0);
}

static void hybrids_of_small_joins(void **state)
{
    (void)state;
    all_sizes(SOFTSH_ACCEL_YSM, 16);
    all_sizes(SOFTSH_ACCEL_YSM, 4);
    all_sizes(SOFTSH_ACCEL_YSM, 1);
}

static void all_fillings(void **state)
{
    uint64_t seed = 7;
    (void)state;
    for (int kind = 0; kind < FILLINGS; kind++)
        for (uint32_t layers = 1; layers <= 4; layers++) {
            subject s;
            subject_create(&s, 37, 21, layers, (filling)kind, &seed);
            s.info.accel = layers % 2 ? SOFTSH_ACCEL_MSSM : SOFTSH_ACCEL_YSM;
            s.info.ysm_join = 16;
            s.info.reverse_order = layers > 2;
            s.info.layout = layers == 2 ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_UNDEFINED;
            check(&s);
            subject_destroy(&s);
        }
}

/* Parts of an atlas, and maps smaller than the object's largest. */
static void parts_of_images(void **state)
{
    const VkExtent2D largest[] = {{0, 0}, {64, 64}, {300, 50}, {50, 200}};
    const softsh_accel accels[] = {SOFTSH_ACCEL_HSM, SOFTSH_ACCEL_MSSM, SOFTSH_ACCEL_YSM};
    uint64_t seed = 9;
    (void)state;
    for (uint32_t k = 0; k < 12; k++) {
        subject s;
        subject_create(&s, 37, 21, 2, RANDOM, &seed);
        s.info.place = (placement){37, 21, 5 * (k % 3), 11 * (k % 2), 37 + 5 * (k % 3) + k, 64};
        s.info.max_extent = largest[k % 4];
        s.info.accel = accels[k / 4];
        s.info.ysm_join = 16;
        check(&s);
        subject_destroy(&s);
    }
}

static void formats(void **state)
{
    const VkFormat list[] = {VK_FORMAT_D16_UNORM, VK_FORMAT_D32_SFLOAT, VK_FORMAT_X8_D24_UNORM_PACK32,
                             VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_D32_SFLOAT_S8_UINT};
    uint64_t seed = 11;
    (void)state;
    for (size_t k = 0; k < sizeof list / sizeof list[0]; k++) {
        subject s;
        /* The two that every device has. */
        if (k > 1 && !depth_format_supported(list[k]))
            continue;
        subject_create(&s, 33, 17, 2, RANDOM, &seed);
        s.info.layers[0].format = list[k];
        s.info.layout = k % 2 ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL : VK_IMAGE_LAYOUT_UNDEFINED;
        s.info.layers[1].format = list[k];
        check(&s);
        subject_destroy(&s);
    }
}

/* Levels no kernel can ask for are left out, never one that is needed: the largest kernel any receiver in front of the
 * far plane has must fit into the levels built. */
static void levels_for_the_largest_kernel(void **state)
{
    uint64_t seed = 13;
    uint32_t skipped = 0;
    (void)state;
    for (uint32_t k = 0; k < 8; k++) {
        subject s;
        lamp l;
        readback r;
        subject_create(&s, 100, 64, 1, RANDOM, &seed);
        s.info.accel = SOFTSH_ACCEL_MSSM;
        s.info.light.half_u[0] = s.info.light.half_v[1] = 3.0 / (1u << k);
        lamp_create(&s.info, &l);
        readback_create(&l, &r);
        check_levels(&r);
        skipped += wide_levels(&r) - r.wide_built;
        const reference_range all = reference_hsm(r.fan_depth, 100, 64, r.top, 0, 0);
        reference_map map;
        double box[4];
        lamp_reference(&s.info, &map);
        reference_map_kernel(&map, (const double[3]){50.0, 32.0, reference_map_depth_to_g(&map, map.far_depth)},
                             (double)all.max, box);
        const double side = fmin(fmax(box[2] - box[0], box[3] - box[1]) - 1.0, 100.0);
        if (r.wide_built < wide_levels(&r))
            assert_true(side < ldexp(2.0, (int)r.wide_built));
        readback_destroy(&r);
        lamp_destroy(&l);
        subject_destroy(&s);
    }
    assert_true(skipped > 4);
}

/* A second build into the same object leaves nothing of the first, and needs nothing recorded in between. */
static void rebuilt(void **state)
{
    uint64_t seed = 17;
    (void)state;
    for (int accel = SOFTSH_ACCEL_HSM; accel <= SOFTSH_ACCEL_YSM; accel++) {
        subject first, second;
        lamp l, other;
        readback r;
        subject_create(&first, 64, 50, 2, RANDOM, &seed);
        subject_create(&second, 41, 64, 2, NONSENSE, &seed);
        first.info.max_extent = second.info.max_extent = (VkExtent2D){64, 64};
        first.info.accel = second.info.accel = (softsh_accel)accel;
        first.info.ysm_join = second.info.ysm_join = 16;
        first.info.reverse_order = true;
        lamp_create(&first.info, &l);
        lamp_create(&second.info, &other);
        softsh_occluders *const own = other.occluders;
        other.occluders = l.occluders;
        VkCommandBuffer cmd = gpu_begin(&device);
        lamp_record(&l, cmd);
        lamp_record(&other, cmd);
        assert_true(gpu_submit(&device, cmd));
        readback_create(&other, &r);
        assert_int_equal(r.width, 41);
        check_fan_depths(&second.info, &r);
        check_levels(&r);
        readback_destroy(&r);
        other.occluders = own;
        lamp_destroy(&other);
        lamp_destroy(&l);
        subject_destroy(&first);
        subject_destroy(&second);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pyramids),
        cmocka_unit_test(multi_scale_maps),
        cmocka_unit_test(hybrids_by_default),
        cmocka_unit_test(hybrids_of_small_joins),
        cmocka_unit_test(all_fillings),
        cmocka_unit_test(parts_of_images),
        cmocka_unit_test(formats),
        cmocka_unit_test(levels_for_the_largest_kernel),
        cmocka_unit_test(rebuilt),
    };
    return cmocka_run_group_tests(tests, fixture_setup, fixture_teardown);
}
