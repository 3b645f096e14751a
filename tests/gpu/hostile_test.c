/* Depth buffers of any bits at all, under valid matrices of any size: every visibility is a number from 0 to 1, nothing
 * outside the render area is written, everything ends, and validation has nothing to say. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fixture.h"
#include "readback.h"
#include "reference_matrix.h"
#include "reference_scene.h"

enum { LARGEST = 70 };

typedef enum bits { ANY_BITS, MOSTLY_DEPTHS, EXTREMES, CONSTANT, BITS } bits;

static void fill(bits kind, uint64_t *state, uint32_t count, float *out)
{
    static const uint32_t extremes[] = {0x7fc00000, 0xffc00000, 0x7f800001, 0x7f800000, 0xff800000, 0x7f7fffff,
                                        0xff7fffff, 0x00000001, 0x80000001, 0x007fffff, 0x00000000, 0x80000000,
                                        0x3f800000, 0x3f800001, 0x3f7fffff, 0x3f000000, 0xffffffff};
    const uint32_t same = extremes[reference_random(state) % 17];
    for (uint32_t i = 0; i < count; i++) {
        uint32_t word = reference_random(state);
        if (kind == MOSTLY_DEPTHS && reference_random(state) % 8) {
            const float depth = (float)reference_random_range(state, 0.0, 1.0);
            memcpy(&word, &depth, sizeof word);
        } else if (kind == EXTREMES) {
            word = extremes[word % 17];
        } else if (kind == CONSTANT) {
            word = same;
        }
        memcpy(&out[i], &word, sizeof word);
    }
}

static void random_direction(uint64_t *state, double out[3])
{
    do
        for (int i = 0; i < 3; i++)
            out[i] = reference_random_range(state, -1.0, 1.0);
    while (!reference_normalize(out, out));
}

/* A view from `at` towards `target` or, without one, anywhere; its right, down and forward come back in `axes`. */
static void random_view(uint64_t *state, const double at[3], const double *towards, double view[16], double axes[3][3])
{
    double up[3], target[3], distance;
    random_direction(state, axes[2]);
    if (towards) {
        reference_along(towards, -1.0, at, axes[2]);
        reference_normalize(axes[2], axes[2]);
    }
    do {
        random_direction(state, up);
        distance = fabs(reference_dot(up, axes[2]));
    } while (distance > 0.99);
    reference_along(at, 1.0 + reference_random_range(state, 0.0, 1.0) * sqrt(reference_dot(at, at)), axes[2], target);
    reference_look_at(at, target, up, view);
    for (int axis = 0; axis < 3; axis++)
        for (int i = 0; i < 3; i++)
            axes[axis][i] = (axis == 2 ? -1.0 : 1.0) * view[4 * i + axis];
}

static void random_bounds(uint64_t *state, double scale, double out[4])
{
    for (int i = 0; i < 2; i++) {
        const double middle = scale * reference_random_range(state, -0.5, 0.5);
        const double half = scale * reference_random_range(state, 0.05, 1.0);
        out[2 * i] = middle - half;
        out[2 * i + 1] = middle + half;
    }
}

static double random_magnitude(uint64_t *state, double low, double high)
{
    return pow(10.0, reference_random_range(state, low, high));
}

/* A projection of either kind; an orthographic one covers `size`. */
static void random_projection(uint64_t *state, bool orthographic, double size, double out[16])
{
    const double near = size * random_magnitude(state, -3.0, 0.0),
                 far = near * (1.01 + random_magnitude(state, -1.0, 5.0));
    const reference_depth_range range = (reference_depth_range)(reference_random(state) % 4);
    double bounds[4];
    random_bounds(state, orthographic ? size : random_magnitude(state, -1.5, 1.0), bounds);
    if (orthographic)
        reference_orthographic(bounds, near, far, range, out);
    else
        reference_perspective(bounds, near, far, range, out);
}

typedef struct attack {
    lamp_info lamp;
    eye_info eye;
    sight_options options;
    float map[2][LARGEST * LARGEST], depth[LARGEST * LARGEST], normals[3 * LARGEST * LARGEST];
} attack;

static void random_attack(uint64_t *state, uint32_t width, uint32_t height, attack *out)
{
    const double size = random_magnitude(state, -5.0, 5.0), offset = reference_random(state) % 3 ? 0.0 : 1e4 * size;
    const bool directional = reference_random(state) % 2;
    double at[3], axes[3][3];
    memset(out, 0, sizeof *out);
    softsh_light *const light = &out->lamp.light;
    light->struct_size = sizeof *light;
    for (int i = 0; i < 3; i++)
        at[i] = offset + size * reference_random_range(state, -1.0, 1.0);
    random_view(state, at, NULL, out->lamp.view, axes);
    const double half_u = size * random_magnitude(state, -4.0, 1.0), half_v = size * random_magnitude(state, -4.0, 1.0);
    const double turn = reference_random(state) % 2 ? 0.0 : reference_random_range(state, 0.0, 6.3);
    if (directional) {
        double aside[3];
        random_direction(state, aside);
        light->shape = SOFTSH_LIGHT_DIRECTIONAL;
        light->angular_radius = reference_random(state) % 8 ? reference_random_range(state, 0.0, 0.5) : 0.0;
        reference_along(axes[2], 0.4, aside, light->direction);
    } else {
        const double front = reference_random(state) % 2 ? size * reference_random_range(state, 0.0, 2.0) : 0.0;
        reference_along(at, front, axes[2], light->center);
        for (int i = 0; i < 3; i++) {
            light->half_u[i] = half_u * (cos(turn) * axes[0][i] + sin(turn) * axes[1][i]);
            light->half_v[i] = half_v * (cos(turn) * axes[1][i] - sin(turn) * axes[0][i]);
        }
        if (reference_random(state) % 8 == 0)
            memset(light->half_u, 0, sizeof light->half_u);
        if (reference_random(state) % 8 == 0)
            memset(light->half_v, 0, sizeof light->half_v);
    }
    out->lamp.place =
        (placement){.width = 1 + reference_random(state) % LARGEST, .height = 1 + reference_random(state) % LARGEST};
    out->lamp.layer_count = 1 + reference_random(state) % 2;
    out->lamp.accel = (softsh_accel)(reference_random(state) % 4);
    out->lamp.ysm_join = 1 + reference_random(state) % 64;
    random_projection(state, directional, size, out->lamp.layers[0].projection);
    memcpy(out->lamp.layers[1].projection, out->lamp.layers[0].projection, sizeof out->lamp.layers[1].projection);
    for (int i = 0; i < 2; i++) {
        fill((bits)(reference_random(state) % BITS), state, LARGEST * LARGEST, out->map[i]);
        out->lamp.layers[i].depth = out->map[i];
    }
    /* Most cameras look at something that may be in the map. */
    double seen[3];
    reference_along(at, size * random_magnitude(state, -1.0, 1.0), axes[2], seen);
    for (int i = 0; i < 3; i++)
        at[i] += size * reference_random_range(state, -1.0, 1.0);
    random_view(state, at, reference_random(state) % 8 ? seen : NULL, out->eye.view, axes);
    random_projection(state, reference_random(state) % 3 == 0, size, out->eye.projection);
    fill((bits)(reference_random(state) % BITS), state, LARGEST * LARGEST, out->depth);
    fill((bits)(reference_random(state) % BITS), state, 3 * LARGEST * LARGEST, out->normals);
    out->eye.place = (placement){width, height, 3, 2, LARGEST + 5, LARGEST + 5};
    out->eye.depth = out->depth;
    out->options.override_bias = reference_random(state) % 4 == 0;
    out->options.bias = size * random_magnitude(state, -6.0, 2.0);
}

static void visibilities_are_numbers(void **state)
{
    static const softsh_settings settings[] = {
        {.technique = SOFTSH_TECHNIQUE_AUTO},
        {.technique = SOFTSH_TECHNIQUE_BITMASK, .pattern = SOFTSH_PATTERN_32X32, .filter_passes = 3},
        {.technique = SOFTSH_TECHNIQUE_AREA, .budget = 16},
        {.technique = SOFTSH_TECHNIQUE_BITMASK,
         .primitive = SOFTSH_PRIMITIVE_MICROQUAD_RECTANGLE,
         .pattern = SOFTSH_PATTERN_8X8,
         .aggregation = SOFTSH_AGGREGATION_NEAREST,
         .merge = SOFTSH_MERGE_MAXIMUM,
         .budget = 7},
        {.technique = SOFTSH_TECHNIQUE_BITMASK, .no_hierarchy = 1},
        {.technique = SOFTSH_TECHNIQUE_AREA, .primitive = SOFTSH_PRIMITIVE_MICROQUAD, .min_level = 3},
        {.technique = SOFTSH_TECHNIQUE_BITMASK, .outline = 1},
        {.technique = SOFTSH_TECHNIQUE_CONTOUR},
        {.technique = SOFTSH_TECHNIQUE_CONTOUR, .reconstruction = SOFTSH_RECONSTRUCTION_FOLDS, .budget = 9},
        {.technique = SOFTSH_TECHNIQUE_CONTOUR, .reconstruction = SOFTSH_RECONSTRUCTION_BACKS},
        {.technique = SOFTSH_TECHNIQUE_CONTOUR,
         .aggregation = SOFTSH_AGGREGATION_NEAREST,
         .merge = SOFTSH_MERGE_MAXIMUM,
         .budget = 5,
         .no_hierarchy = 1},
        {.technique = SOFTSH_TECHNIQUE_CONTOUR, .search = SOFTSH_SEARCH_WALK},
    };
    static attack a;
    static float visibility[LARGEST * LARGEST];
    uint64_t seed = 4711;
    uint32_t between = 0, dark = 0, pixels = 0;
    (void)state;
    for (size_t k = 0; k < sizeof settings / sizeof settings[0]; k++)
        for (int normals = 0; normals < 2; normals++) {
            const sight_info info = {
                .settings = settings[k], .width = LARGEST + 5, .height = LARGEST + 5, .normals = normals != 0};
            sight view;
            sight_create(&info, &view);
            for (uint32_t round = 0; round < 40; round++) {
                const uint32_t width = 1 + reference_random(&seed) % LARGEST,
                               height = 1 + reference_random(&seed) % LARGEST;
                softsh_stats stats;
                lamp l;
                eye e;
                random_attack(&seed, width, height, &a);
                a.eye.normals = normals ? a.normals : NULL;
                a.lamp.dual_grids = settings[k].search == SOFTSH_SEARCH_WALK;
                lamp_create(&a.lamp, &l);
                eye_create(&a.eye, &e);
                sight_run(&view, &l, &e, &a.options, visibility, &stats);
                for (uint32_t i = 0; i < width * height; i++) {
                    if (!(visibility[i] >= 0.0f && visibility[i] <= 1.0f))
                        fail_msg("settings %zu, round %u: pixel (%u, %u) is %g", k, round, i % width, i / width,
                                 (double)visibility[i]);
                    between += visibility[i] > 0.0f && visibility[i] < 1.0f;
                    dark += visibility[i] == 0.0f;
                }
                pixels += width * height;
                assert_int_equal(stats.pixels, width * height);
                assert_int_equal(stats.lit + stats.umbra + stats.active, stats.pixels);
                eye_destroy(&e);
                lamp_destroy(&l);
            }
            sight_destroy(&view);
        }
    print_message("%u pixels: %u dark, %u in between\n", pixels, dark, between);
    assert_true(dark > pixels / 100 && between > pixels / 100);
}

/* Structures over any bits hold numbers, ordered and within the range of depths. */
static void hierarchies_hold_numbers(void **state)
{
    static attack a;
    uint64_t seed = 815;
    (void)state;
    for (uint32_t round = 0; round < 60; round++) {
        lamp l;
        readback r;
        random_attack(&seed, 8, 8, &a);
        a.lamp.layer_count = 1;
        lamp_create(&a.lamp, &l);
        readback_create(&l, &r);
        const uint32_t texels = r.width * r.height;
        float lowest = INFINITY, highest = -INFINITY;
        for (uint32_t i = 0; i < texels; i++) {
            assert_true(isfinite(r.fan_depth[i]));
            lowest = fminf(lowest, r.fan_depth[i]);
            highest = fmaxf(highest, r.fan_depth[i]);
        }
        const reference_range top = readback_pyramid(&r, 0, r.top, 0, 0);
        assert_true(r.top == 0 || (top.min == lowest && top.max == highest));
        readback_destroy(&r);
        lamp_destroy(&l);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(visibilities_are_numbers),
        cmocka_unit_test(hierarchies_hold_numbers),
    };
    return cmocka_run_group_tests(tests, fixture_setup, fixture_teardown);
}
