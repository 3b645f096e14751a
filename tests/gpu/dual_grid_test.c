/* The dual grids on the device: every node of every level, of every level's samples, of every layer, bit for bit
 * against brute force over the device's own samples. */
#include <stdlib.h>
#include <string.h>

#include "fixture.h"
#include "readback.h"
#include "reference_hierarchy.h"
#include "reference_scene.h"

/* Maps of random depth. */
typedef struct subject {
    lamp_info info;
    float *depth[SOFTSH_MAX_LAYERS];
} subject;

static void subject_create(subject *s, uint32_t width, uint32_t height, uint32_t layers, uint64_t *state)
{
    const double at[3] = {0, 0, 0}, target[3] = {0, 0, -1}, up[3] = {0, 1, 0};
    memset(s, 0, sizeof *s);
    s->info.light.struct_size = sizeof s->info.light;
    s->info.light.half_u[0] = s->info.light.half_v[1] = 1.0;
    s->info.place = (placement){.width = width, .height = height};
    s->info.layer_count = layers;
    s->info.dual_grids = true;
    reference_look_at(at, target, up, s->info.view);
    for (uint32_t i = 0; i < layers; i++) {
        s->depth[i] = malloc((size_t)width * height * sizeof(float));
        assert_non_null(s->depth[i]);
        for (uint32_t k = 0; k < width * height; k++)
            s->depth[i][k] = (float)reference_random_range(state, 0.0, 1.0);
        s->info.layers[i].depth = s->depth[i];
        reference_perspective((const double[4]){-1, 1, -1, 1}, 1.0, 20.0, REFERENCE_DEPTH_NORMAL,
                              s->info.layers[i].projection);
    }
}

static void subject_destroy(subject *s)
{
    for (uint32_t i = 0; i < s->info.layer_count; i++)
        free(s->depth[i]);
}

/* Samples first to last of a row or column, of those there are. */
static uint32_t clip(uint32_t at, uint32_t count)
{
    return at < count ? at : count - 1;
}

/* Of cells x to x + span - 1 and as many rows, cell 0 being the one before the first sample. */
static reference_range brute_force(const readback *r, uint32_t layer, uint32_t level, uint32_t x, uint32_t y,
                                   uint32_t span)
{
    const uint32_t columns = reference_hsm_size(r->width, level), rows = reference_hsm_size(r->height, level);
    reference_range range = {3e38f, -3e38f};
    for (uint32_t j = clip(y > 0 ? y - 1 : 0, rows); j <= clip(y + span - 1, rows); j++)
        for (uint32_t i = clip(x > 0 ? x - 1 : 0, columns); i <= clip(x + span - 1, columns); i++) {
            const float g = readback_sample(r, layer, level, i, j);
            range.min = g < range.min ? g : range.min;
            range.max = g > range.max ? g : range.max;
        }
    return range;
}

/* Returns how many nodes there are. */
static uint64_t check_nodes(const readback *r)
{
    uint64_t nodes = 0;
    for (uint32_t layer = 0; layer < r->layers; layer++)
        for (uint32_t level = 0; level <= r->top; level++) {
            const uint32_t columns = reference_hsm_size(r->width, level) + 1,
                           rows = reference_hsm_size(r->height, level) + 1;
            /* Up to the last level that more than one node of spans all cells. */
            for (uint32_t k = 0; columns > 1u << k || rows > 1u << k; k++) {
                const uint32_t join = readback_dual_join(r, level), shift = k < join ? k : join;
                for (uint32_t y = 0; y < reference_hsm_size(rows, shift); y++)
                    for (uint32_t x = 0; x < reference_hsm_size(columns, shift); x++) {
                        const reference_range is = readback_dual(r, layer, level, k, x, y),
                                              right = brute_force(r, layer, level, x << shift, y << shift, 1u << k);
                        nodes++;
                        if (memcmp(&is, &right, sizeof is))
                            fail_msg("%u x %u, join %u, layer %u, samples of level %u, node (%u, %u) of level %u: "
                                     "%.9g..%.9g for %.9g..%.9g",
                                     r->width, r->height, r->join, layer, level, x, y, k, (double)is.min,
                                     (double)is.max, (double)right.min, (double)right.max);
                    }
            }
        }
    return nodes;
}

static uint64_t check(const subject *s)
{
    lamp l;
    readback r;
    lamp_create(&s->info, &l);
    readback_create(&l, &r);
    const uint64_t nodes = check_nodes(&r);
    readback_destroy(&r);
    lamp_destroy(&l);
    return nodes;
}

static const uint32_t sizes[][2] = {{1, 1}, {1, 37}, {70, 1}, {2, 2}, {7, 5}, {33, 17}, {64, 64}, {63, 65}, {100, 37}};

static uint64_t all_sizes(softsh_accel accel, uint32_t join)
{
    uint64_t state = 300 + (uint64_t)accel + join, nodes = 0;
    for (uint32_t k = 0; k < sizeof sizes / sizeof sizes[0]; k++) {
        subject s;
        subject_create(&s, sizes[k][0], sizes[k][1], 1 + k % 3, &state);
        s.info.accel = accel;
        s.info.ysm_join = join;
        nodes += check(&s);
        subject_destroy(&s);
    }
    return nodes;
}

/* An MSSM has a node at every cell, an HSM those of a pyramid, and a YSM is between. */
static void every_form(void **state)
{
    (void)state;
    const uint64_t hsm = all_sizes(SOFTSH_ACCEL_HSM, 0), mssm = all_sizes(SOFTSH_ACCEL_MSSM, 0);
    const uint64_t ysm[] = {all_sizes(SOFTSH_ACCEL_YSM, 1), all_sizes(SOFTSH_ACCEL_YSM, 4),
                            all_sizes(SOFTSH_ACCEL_YSM, 16), all_sizes(SOFTSH_ACCEL_YSM, 256)};
    print_message("nodes: HSM %u, YSM of 1 %u, 4 %u, 16 %u, 256 %u, MSSM %u\n", (unsigned)hsm, (unsigned)ysm[0],
                  (unsigned)ysm[1], (unsigned)ysm[2], (unsigned)ysm[3], (unsigned)mssm);
    assert_true(ysm[0] == hsm && hsm < ysm[1] && ysm[1] < ysm[2] && ysm[2] < mssm && ysm[3] == mssm);
}

/* A smaller map that joins at a finer level has room in the memory of a larger one, and nothing else lies there. */
static void smaller_maps(void **state)
{
    static const VkExtent2D largest[] = {{33, 33}, {64, 64}, {129, 20}, {20, 129}};
    static const uint32_t maps[][2] = {{32, 32}, {31, 33}, {64, 20}, {16, 64}, {20, 17}};
    const softsh_accel accels[] = {SOFTSH_ACCEL_HSM, SOFTSH_ACCEL_MSSM, SOFTSH_ACCEL_YSM};
    uint64_t seed = 21;
    (void)state;
    for (size_t accel = 0; accel < 3; accel++)
        for (size_t large = 0; large < sizeof largest / sizeof largest[0]; large++)
            for (size_t map = 0; map < sizeof maps / sizeof maps[0]; map++) {
                subject s;
                if (maps[map][0] > largest[large].width || maps[map][1] > largest[large].height)
                    continue;
                subject_create(&s, maps[map][0], maps[map][1], 2, &seed);
                s.info.max_extent = largest[large];
                s.info.accel = accels[accel];
                s.info.ysm_join = 16;
                s.info.no_folds = map % 2;
                check(&s);
                subject_destroy(&s);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_form),
        cmocka_unit_test(smaller_maps),
    };
    return cmocka_run_group_tests(tests, fixture_setup, fixture_teardown);
}
