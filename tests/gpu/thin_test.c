/* What a budget's samples would miss: bits bit for bit against brute force over the device's own depths, and bars
 * thinner than the distance of samples, which keep their shadows wherever they lie. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "readback.h"
#include "scenes.h"

enum { SIDE = 48, PIXELS = SIDE * SIDE };

/* The farthest depth of a square of texels, which is clamped into the map, of the layer where that is nearest. */
static float covered(const readback *r, int64_t x0, int64_t y0, int64_t side)
{
    float nearest = -INFINITY;
    for (uint32_t layer = 0; layer < r->layers; layer++) {
        const float *const g = r->fan_depth + (size_t)layer * r->width * r->height;
        float farthest = INFINITY;
        for (int64_t y = y0; y < y0 + side; y++)
            for (int64_t x = x0; x < x0 + side; x++) {
                const int64_t u = x < 0 ? 0 : x >= r->width ? r->width - 1 : x;
                const int64_t v = y < 0 ? 0 : y >= r->height ? r->height - 1 : y;
                farthest = fminf(farthest, g[v * r->width + u]);
            }
        nearest = fmaxf(nearest, farthest);
    }
    return nearest;
}

/* Numbers in section 5 of docs/numerics.md. Squares are looked for where half blocks begin; those reaching out of the
 * map are made of what half blocks at its border hold. */
static bool misses(const readback *r, uint32_t level, uint32_t x, uint32_t y)
{
    const int64_t block = (int64_t)1 << level, half = block / 2;
    const uint32_t columns = reference_hsm_size(r->width, level - 1), rows = reference_hsm_size(r->height, level - 1);
    float nearest = -INFINITY, square = -INFINITY;
    for (uint32_t layer = 0; layer < r->layers; layer++) {
        const float *const g = r->fan_depth + (size_t)layer * r->width * r->height;
        nearest = fmaxf(nearest, reference_hsm(g, r->width, r->height, level, x, y).max);
    }
    for (int j = -2; j < 3; j++)
        for (int i = -2; i < 3; i++) {
            float farthest = INFINITY;
            for (int k = 0; k < 4; k++) {
                int64_t hx = 2 * (int64_t)x + i + (k & 1), hy = 2 * (int64_t)y + j + (k >> 1);
                hx = hx < 0 ? 0 : hx >= columns ? columns - 1 : hx;
                hy = hy < 0 ? 0 : hy >= rows ? rows - 1 : hy;
                farthest = fminf(farthest, covered(r, hx * half, hy * half, half));
            }
            square = fmaxf(square, farthest);
        }
    if (r->delta > 0.0f)
        nearest = fminf(nearest, r->epsilon / r->delta);
    const float reach = fmaxf(fabsf(r->a[0]) + fabsf(r->a[1]), fabsf(r->a[2]) + fabsf(r->a[3]));
    return (nearest - square) * reach > fmaxf(r->epsilon - r->delta * nearest, 0.0f) * (float)block;
}

/* Blobs and lines of all widths over a floor with some relief; the second layer lies behind the first, or anywhere. */
static void draw(uint64_t *state, uint32_t width, uint32_t height, const float *before, float *depth)
{
    const bool behind = before && reference_random(state) % 2;
    for (uint32_t i = 0; i < width * height; i++)
        depth[i] = (float)(0.9 + 0.02 * reference_random_range(state, 0.0, 1.0));
    for (int k = 0; k < 12; k++) {
        const double x0 = reference_random_range(state, 0.0, width), y0 = reference_random_range(state, 0.0, height);
        const double angle = reference_random_range(state, 0.0, 3.2), half = reference_random_range(state, 0.3, 6.0);
        const double length = k % 3 ? width : 2.0 * half, z = reference_random_range(state, 0.2, 0.9);
        for (uint32_t i = 0; i < width * height; i++) {
            const double x = i % width + 0.5 - x0, y = i / width + 0.5 - y0;
            if (fabs(x * sin(angle) - y * cos(angle)) < half && fabs(x * cos(angle) + y * sin(angle)) < length)
                depth[i] = (float)z;
        }
    }
    for (uint32_t i = 0; i < width * height && behind; i++)
        depth[i] = fmaxf(depth[i], before[i]);
}

static void bits_say_what_samples_miss(void **state)
{
    static const uint32_t sizes[][2] = {{64, 64}, {37, 51}, {1, 40}, {70, 2}, {130, 67}, {3, 3}, {2, 1}};
    const double at[3] = {0, 0, 0}, target[3] = {0, 0, -1}, up[3] = {0, 1, 0};
    uint64_t seed = 7, words = 0, set = 0, differ = 0;
    (void)state;
    for (uint32_t k = 0; k < 4 * sizeof sizes / sizeof sizes[0]; k++) {
        const uint32_t width = sizes[k / 4][0], height = sizes[k / 4][1];
        lamp_info info = {.layer_count = 1 + k % 2, .place = {.width = width, .height = height}, .no_folds = k % 4 < 2};
        float *depth[2];
        /* In the light's plane, and behind it. */
        info.light =
            (softsh_light){.struct_size = sizeof info.light, .half_u = {0.9, 0.2, 0}, .half_v = {-0.1, 0.45, 0}};
        info.light.center[2] = k % 3 ? 0.0 : -0.5;
        reference_look_at(at, target, up, info.view);
        for (uint32_t i = 0; i < info.layer_count; i++) {
            depth[i] = malloc((size_t)width * height * sizeof(float));
            assert_non_null(depth[i]);
            draw(&seed, width, height, i ? depth[0] : NULL, depth[i]);
            info.layers[i].depth = depth[i];
            reference_perspective((const double[4]){-1, 1, -1, 1}, 1.0, 20.0, REFERENCE_DEPTH_NORMAL,
                                  info.layers[i].projection);
        }
        lamp l;
        readback r;
        lamp_create(&info, &l);
        readback_create(&l, &r);
        for (uint32_t level = 2; level <= r.top; level++)
            for (uint32_t y = 0; y < reference_hsm_size(height, level); y++)
                for (uint32_t x = 0; x < reference_hsm_size(width, level); x++) {
                    uint32_t bits = 0;
                    for (uint32_t of = 1; of <= level; of++)
                        for (uint32_t v = y << (level - of); v < (y + 1) << (level - of); v++)
                            for (uint32_t u = x << (level - of); u < (x + 1) << (level - of); u++)
                                if (u < reference_hsm_size(width, of) && v < reference_hsm_size(height, of))
                                    bits |= (uint32_t)misses(&r, of, u, v) << of;
                    words++;
                    set += bits != 0;
                    differ += bits != readback_thin(&r, level, x, y);
                }
        readback_destroy(&r);
        lamp_destroy(&l);
        for (uint32_t i = 0; i < info.layer_count; i++)
            free(depth[i]);
    }
    print_message("%u of %u words have bits, %u differ\n", (unsigned)set, (unsigned)words, (unsigned)differ);
    /* A product may be rounded once or twice. */
    assert_true(set > words / 20 && set < words && differ <= words / 1000);
}

/* A bar half the way between a light and a floor, `width` texels wide and moved sideways by `shift`. */
static void bar_create(double angle, double width, double shift, scene *s)
{
    const double nowhere[3] = {0, 0, 0}, up[3] = {0, 1, 0}, floor_at[3] = {0, 0, -10}, eye_at[3] = {0, 0, -6};
    const double texel = 5.0 / 256.0, c = cos(angle), n = sin(angle);
    const reference_surface surfaces[2] = {
        {.infinite = true, .center = {0, 0, -10}, .u = {1, 0, 0}, .v = {0, 1, 0}},
        {.center = {-n * shift * texel, c * shift * texel, -5},
         .u = {2 * c, 2 * n, 0},
         .v = {-0.5 * n * width * texel, 0.5 * c * width * texel, 0}},
    };
    memset(s, 0, sizeof *s);
    s->lamp.light = (softsh_light){.struct_size = sizeof s->lamp.light, .half_u = {2, 0, 0}, .half_v = {0, 2, 0}};
    s->lamp.place = (placement){.width = 256, .height = 256};
    s->lamp.layer_count = 1;
    s->eye.place = (placement){.width = SIDE, .height = SIDE};
    reference_look_at(nowhere, floor_at, up, s->lamp.view);
    reference_perspective((const double[4]){-0.5, 0.5, -0.5, 0.5}, 1.0, 30.0, REFERENCE_DEPTH_NORMAL,
                          s->lamp.layers[0].projection);
    /* Under the bar, which the camera does not see. */
    reference_look_at(eye_at, floor_at, up, s->eye.view);
    reference_orthographic((const double[4]){-3, 3, -3, 3}, 0.1, 10.0, REFERENCE_DEPTH_NORMAL, s->eye.projection);
    scene_cast(s, surfaces, 2);
}

/* Kernels are 103 texels wide: samples are 16 texels apart for a budget of 8, four with refinement. Microquads need two
 * of them on a bar. */
static void bars_keep_their_shadows(void **state)
{
    static const struct {
        const char *name;
        double width;
        softsh_settings settings;
    } kinds[] = {
        {"contours", 6.0, {.technique = SOFTSH_TECHNIQUE_CONTOUR}},
        {"single pixels", 6.0, {.technique = SOFTSH_TECHNIQUE_CONTOUR, .packet = SOFTSH_PACKET_1X1}},
        {"bitmasks", 14.0, {.technique = SOFTSH_TECHNIQUE_BITMASK}},
        {"areas", 14.0, {.technique = SOFTSH_TECHNIQUE_AREA}},
    };
    enum { PLAIN, REFINED, COARSE, STEPS = 9 };
    static float seen[3][PIXELS], before[3][PIXELS];
    (void)state;
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        sight views[3];
        for (int i = 0; i < 3; i++) {
            sight_info info = {.settings = kinds[k].settings, .width = SIDE, .height = SIDE};
            info.settings.budget = i == PLAIN ? 0 : 8;
            info.settings.no_refinement = i == COARSE;
            sight_create(&info, &views[i]);
        }
        for (int turn = 0; turn < 3; turn++) {
            double least[3], change[3] = {0}, error[3] = {0};
            for (int step = 0; step < STEPS; step++) {
                scene s;
                lamp l;
                eye e;
                bar_create(0.35 * turn, kinds[k].width, 2.0 * step, &s);
                s.eye.normals = NULL;
                lamp_create(&s.lamp, &l);
                eye_create(&s.eye, &e);
                for (int i = 0; i < 3; i++) {
                    softsh_stats stats;
                    double shade = 0.0;
                    sight_run(&views[i], &l, &e, NULL, seen[i], &stats);
                    for (int p = 0; p < PIXELS; p++) {
                        shade += (1.0 - (double)seen[i][p]) / PIXELS;
                        error[i] += fabs((double)seen[i][p] - (double)seen[PLAIN][p]) / PIXELS / STEPS;
                        if (step > 0)
                            change[i] = fmax(change[i], fabs((double)seen[i][p] - (double)before[i][p]));
                    }
                    least[i] = step ? fmin(least[i], shade) : shade;
                    memcpy(before[i], seen[i], sizeof seen[i]);
                    assert_true(stats.refined <= stats.active && (stats.refined > 0) == (i == REFINED));
                }
                eye_destroy(&e);
                lamp_destroy(&l);
                scene_destroy(&s);
            }
            print_message("%s, turn %d: least shade %.4f, refined %.4f, coarse %.4f; error %.4f, %.4f; largest change "
                          "%.4f, %.4f, %.4f\n",
                          kinds[k].name, turn, least[PLAIN], least[REFINED], least[COARSE], error[REFINED],
                          error[COARSE], change[PLAIN], change[REFINED], change[COARSE]);
            assert_true(least[REFINED] > 0.45 * least[PLAIN] && 2.5 * error[REFINED] < error[COARSE]);
            assert_true(change[REFINED] <= 2.0 * change[PLAIN] + 0.01);
        }
        for (int i = 0; i < 3; i++)
            sight_destroy(&views[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bits_say_what_samples_miss),
        cmocka_unit_test(bars_keep_their_shadows),
    };
    return cmocka_run_group_tests(tests, fixture_setup, fixture_teardown);
}
