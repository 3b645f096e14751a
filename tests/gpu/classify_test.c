/* What hierarchies leave out: with them, evaluated pixels are what they are without, bit for bit; pixels found lit or
 * in umbra differ by no more than section 8 of docs/numerics.md allows. Render areas, borders and statistics as well.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fixture.h"
#include "reference_matrix.h"
#include "reference_visibility.h"
#include "scenes.h"

enum { WIDTH = 61, HEIGHT = 45, PIXELS = WIDTH * HEIGHT };

/* A scene with its lamps, one per structure, and its receivers. */
typedef struct stage {
    scene_info info;
    sight_options options;
    scene scene;
    lamp lamps[3];
    eye eye[2]; /* without and with normals */
    reference_map map;
    float *g[2];
    reference_receiver *receivers[2];
} stage;

static void stage_create(stage *s)
{
    static const softsh_accel accels[3] = {SOFTSH_ACCEL_HSM, SOFTSH_ACCEL_MSSM, SOFTSH_ACCEL_YSM};

    s->info.map_width = 70;
    s->info.map_height = 56;
    s->info.width = WIDTH;
    s->info.height = HEIGHT;
    scene_create(&s->info, &s->scene);
    lamp_reference(&s->scene.lamp, &s->map);
    for (int i = 0; i < 3; i++) {
        lamp_info info = s->scene.lamp;
        info.accel = accels[i];
        info.ysm_join = 16;
        lamp_create(&info, &s->lamps[i]);
    }
    for (uint32_t i = 0; i < s->scene.lamp.layer_count; i++) {
        s->g[i] = malloc((size_t)s->map.width * s->map.height * sizeof(float));
        assert_non_null(s->g[i]);
        lamp_fan_depth(&s->scene.lamp, i, s->g[i]);
    }
    for (int normals = 0; normals < 2; normals++) {
        eye_info info = s->scene.eye;
        reference_camera camera;
        if (!normals)
            info.normals = NULL;
        eye_create(&info, &s->eye[normals]);
        eye_reference(&info, &camera);
        const reference_camera_image image = {info.depth, info.normals};
        reference_bias bias = precision_of(&s->scene.lamp, &info);
        bias.override_bias = s->options.override_bias;
        bias.bias = s->options.bias;
        s->receivers[normals] = calloc(PIXELS, sizeof *s->receivers[normals]);
        assert_non_null(s->receivers[normals]);
        for (uint32_t i = 0; i < PIXELS; i++)
            reference_receiver_derive(&s->receivers[normals][i], &s->map, &camera, &image, &bias, i % WIDTH, i / WIDTH);
    }
}

static void stage_destroy(stage *s)
{
    for (int i = 0; i < 3; i++)
        lamp_destroy(&s->lamps[i]);
    for (int i = 0; i < 2; i++) {
        eye_destroy(&s->eye[i]);
        free(s->g[i]);
        free(s->receivers[i]);
    }
    scene_destroy(&s->scene);
}

static double plane_at(const reference_receiver *r, double u, double v)
{
    return r->uvg[2] + r->gradient[0] * (u - r->uvg[0]) + r->gradient[1] * (v - r->uvg[1]);
}

static double nearest_of(const stage *s, uint32_t texel)
{
    double g = -INFINITY;
    for (uint32_t layer = 0; layer < s->scene.lamp.layer_count; layer++)
        g = fmax(g, (double)s->g[layer][texel]);
    return g;
}

/* The texels x0, y0, x1, y1 of a receiver's kernel for occluders up to g_hi. With a spacing: of the blocks of the
 * samples whose cells the kernel meets. */
static void kernel_texels(const stage *s, const reference_receiver *r, double g_hi, double spacing, bool nearest,
                          uint32_t out[4])
{
    const double size[2] = {s->map.width, s->map.height};
    const double first = spacing > 1.0 && !nearest ? 0.5 * spacing + 0.5 : 0.5 * spacing; /* place of sample 0 */
    double box[4];
    if (s->map.delta > 0.0)
        g_hi = fmin(g_hi, s->map.epsilon / s->map.delta);
    reference_map_kernel(&s->map, r->uvg, fmax(g_hi, r->uvg[2]), box);
    for (int i = 0; i < 4; i++) {
        if (spacing > 0.0)
            box[i] = (floor((box[i] - first) / spacing) + (i < 2 ? 0.0 : 2.0)) * spacing - (i < 2 ? 0.0 : 1.0);
        out[i] = (uint32_t)fmin(fmax(floor(box[i]), 0.0), size[i % 2] - 1.0);
    }
}

/* What the refined kernel holds. */
typedef struct contents {
    double lowest;  /* texel over the receiver's plane, or over what an override compares with */
    double highest; /* texel over the receiver or over its plane, whichever is less */
} contents;

static contents look_into_kernel(const stage *s, const softsh_settings *settings, const reference_receiver *r)
{
    const reference_settings finest = {.pattern = SOFTSH_PATTERN_DEFAULT};
    const double raised = reference_raised_g(&s->map, &finest, r);
    const bool contours = settings->technique == SOFTSH_TECHNIQUE_CONTOUR;
    const double spacing = contours ? (double)(1u << settings->min_level) : 0.0;
    contents c = {INFINITY, -INFINITY};
    double g_hi = INFINITY;
    uint32_t k[4] = {0, 0, s->map.width - 1, s->map.height - 1};
    for (int pass = 0; pass < 4; pass++) {
        double nearest = -INFINITY;
        for (uint32_t y = k[1]; y <= k[3]; y++)
            for (uint32_t x = k[0]; x <= k[2]; x++)
                nearest = fmax(nearest, nearest_of(s, y * s->map.width + x));
        g_hi = fmin(g_hi, nearest);
        if (pass < 3)
            kernel_texels(s, r, g_hi, spacing, settings->aggregation == SOFTSH_AGGREGATION_NEAREST, k);
    }
    for (uint32_t y = k[1]; y <= k[3]; y++)
        for (uint32_t x = k[0]; x <= k[2]; x++) {
            const double g = nearest_of(s, y * s->map.width + x);
            const double height = g - (r->override_bias ? raised : plane_at(r, x + 0.5, y + 0.5));
            c.lowest = fmin(c.lowest, height);
            c.highest = fmax(c.highest, fmin(height, g - r->uvg[2]));
        }
    return c;
}

typedef struct tally {
    uint32_t lit, umbra; /* found so without evaluation, and not so with */
    double lit_by, umbra_by;
    uint32_t broken;
} tally;

static bool is_exact(const softsh_settings *settings)
{
    return settings->technique == SOFTSH_TECHNIQUE_CONTOUR ||
           (settings->technique == SOFTSH_TECHNIQUE_BITMASK && settings->primitive == SOFTSH_PRIMITIVE_DEFAULT);
}

/* One pixel whose values differ with (`h`) and without (`n`) hierarchy. */
static void check_difference(const stage *s, const softsh_settings *settings, bool normals, uint32_t i, float h,
                             float n, tally *t)
{
    const reference_receiver *const r = &s->receivers[normals][i];
    const contents c = look_into_kernel(s, settings, r);
    const double slope = fabs(r->gradient[0]) + fabs(r->gradient[1]);
    bool allowed = false;

    /* Section 8: corners of an eighth of a cell, in a kernel of four by four. */
    if (settings->technique == SOFTSH_TECHNIQUE_CONTOUR && fabsf(h - n) <= 1.0f / 32.0f)
        return;
    if (h == 1.0f) {
        /* Section 8: at most two texels' rise and slack above the plane at a cell's centre, or as much as the plane
         * rises over 4 texels; a tile's plane may lie that much below its pixels'. */
        const double slack = 0.5 * fmax(s->map.texel[0], s->map.texel[1]) * (s->map.perspective ? r->uvg[2] : 1.0);
        t->lit++;
        t->lit_by = fmax(t->lit_by, (double)(h - n));
        allowed = !s->options.override_bias && c.highest <= 5.5 * slope + 2.0 * slack + 4.0 * r->eta;
    } else if (h == 0.0f) {
        /* All of the kernel lies above the plane; gaps between primitives and rounding are all that is lost. */
        t->umbra++;
        t->umbra_by = fmax(t->umbra_by, (double)(n - h));
        allowed = c.lowest > 0.0 && !is_exact(settings);
    }
    /* Clamped quads next to a light turned against the map have areas, and kernels differ in which they take in. */
    if (settings->technique == SOFTSH_TECHNIQUE_AREA && s->info.light == SCENE_ROTATED && fabsf(h - n) <= 0.05f)
        return;
    if (allowed)
        return;
    t->broken++;
    print_message("pixel (%u, %u) is %.9g, without hierarchy %.9g; kernel %g to %g over the plane, slope %g, eta %g\n",
                  i % WIDTH, i / WIDTH, (double)h, (double)n, c.lowest, c.highest, slope, r->eta);
}

static void check_stats(const softsh_stats *stats, const float *visibility, uint32_t width, uint32_t height)
{
    uint64_t between = 0, dark = 0;
    for (uint32_t i = 0; i < width * height; i++) {
        between += visibility[i] > 0.0f && visibility[i] < 1.0f;
        dark += visibility[i] == 0.0f;
    }
    assert_int_equal(stats->pixels, (uint64_t)width * height);
    assert_int_equal(stats->lit + stats->umbra + stats->active, stats->pixels);
    assert_int_equal(stats->tiles, (uint64_t)((width + 7) / 8) * ((height + 7) / 8));
    assert_true(stats->undecided_tiles <= stats->tiles);
    assert_true(stats->active >= between && stats->active <= 64 * stats->undecided_tiles);
    assert_true(stats->umbra <= dark && stats->clamped <= stats->active);
}

/* The views of one group of settings: without and with normals, with and without hierarchy. */
typedef struct views {
    softsh_settings settings;
    sight with[2], without[2];
} views;

static void views_create(const softsh_settings *settings, views *out)
{
    sight_info info = {.settings = *settings, .width = WIDTH, .height = HEIGHT};
    out->settings = *settings;
    for (int normals = 0; normals < 2; normals++) {
        info.normals = normals != 0;
        info.settings.no_hierarchy = 0;
        sight_create(&info, &out->with[normals]);
        info.settings.no_hierarchy = 1;
        sight_create(&info, &out->without[normals]);
    }
}

static void views_destroy(views *v)
{
    for (int normals = 0; normals < 2; normals++) {
        sight_destroy(&v->with[normals]);
        sight_destroy(&v->without[normals]);
    }
}

static void compare(const stage *s, views *v, bool normals, tally *t)
{
    static float with[3][PIXELS], without[PIXELS];
    softsh_stats stats;

    for (int k = 0; k < 3; k++) {
        sight_run(&v->with[normals], &s->lamps[k], &s->eye[normals], &s->options, with[k], &stats);
        check_stats(&stats, with[k], WIDTH, HEIGHT);
    }
    sight_run(&v->without[normals], &s->lamps[0], &s->eye[normals], &s->options, without, &stats);
    check_stats(&stats, without, WIDTH, HEIGHT);
    for (uint32_t i = 0; i < PIXELS; i++)
        for (int k = 0; k < 3; k++)
            /* The same to the bit on the software driver; pipelines may be rounded apart elsewhere. */
            if (fabsf(with[k][i] - without[i]) > 1e-6f)
                check_difference(s, &v->settings, normals, i, with[k][i], without[i], t);
}

static stage stages[] = {
    {.info = {.light = SCENE_CENTRED, .light_scale = 0.3}},
    {.info = {.light = SCENE_IN_FRONT, .light_scale = 0.2, .layers = 2}},
    {.info = {.light = SCENE_SUN, .light_scale = 0.15, .content = SCENE_NOISE}},
    {.info = {.light = SCENE_TILTED_SUN, .light_scale = 0.4}},
    {.info = {.light = SCENE_ROTATED, .light_scale = 0.5}},
    {.info = {.light = SCENE_CENTRED, .light_scale = 0.1, .content = SCENE_NASTY}},
    {.info = {.light = SCENE_IN_FRONT, .light_scale = 1.0, .content = SCENE_NOISE}},
    {.info = {.light = SCENE_CENTRED, .light_scale = 0.3}, .options = {true, 0.03}},
    {.info = {.light = SCENE_TILTED_SUN, .light_scale = 0.4}, .options = {true, 0.03}},
    {.info = {.light = SCENE_SUN, .light_scale = 0.15, .content = SCENE_NOISE}, .options = {true, 0.03}},
};
enum { SCENES = sizeof stages / sizeof stages[0] };

static void evaluated_pixels_are_unchanged(void **state)
{
    static const softsh_settings all[] = {
        {.technique = SOFTSH_TECHNIQUE_BITMASK},
        {.technique = SOFTSH_TECHNIQUE_BITMASK,
         .primitive = SOFTSH_PRIMITIVE_MICROPATCH,
         .pattern = SOFTSH_PATTERN_16X16},
        {.technique = SOFTSH_TECHNIQUE_AREA},
        {.technique = SOFTSH_TECHNIQUE_BITMASK,
         .primitive = SOFTSH_PRIMITIVE_MICROQUAD_RECTANGLE,
         .pattern = SOFTSH_PATTERN_32X32,
         .merge = SOFTSH_MERGE_MAXIMUM},
        {.technique = SOFTSH_TECHNIQUE_BITMASK, .aggregation = SOFTSH_AGGREGATION_NEAREST, .min_level = 1},
        {.technique = SOFTSH_TECHNIQUE_BITMASK, .pattern = SOFTSH_PATTERN_8X8, .min_level = 2},
        {.technique = SOFTSH_TECHNIQUE_AREA,
         .primitive = SOFTSH_PRIMITIVE_MICROPATCH_UNEXTENDED,
         .aggregation = SOFTSH_AGGREGATION_NEAREST,
         .min_level = 1},
        {.technique = SOFTSH_TECHNIQUE_CONTOUR},
        {.technique = SOFTSH_TECHNIQUE_CONTOUR, .aggregation = SOFTSH_AGGREGATION_NEAREST, .min_level = 1},
        {.technique = SOFTSH_TECHNIQUE_CONTOUR, .merge = SOFTSH_MERGE_MAXIMUM, .min_level = 2},
    };
    uint32_t broken = 0;
    (void)state;
    for (uint32_t m = 0; m < sizeof all / sizeof all[0]; m++) {
        const bool patches = all[m].primitive == SOFTSH_PRIMITIVE_MICROPATCH ||
                             all[m].primitive == SOFTSH_PRIMITIVE_MICROPATCH_UNEXTENDED;
        tally t = {0};
        views v;
        views_create(&all[m], &v);
        for (uint32_t k = 0; k < SCENES; k++) {
            const uint32_t before = t.broken;
            if (patches && stages[k].info.light == SCENE_ROTATED)
                continue;
            compare(&stages[k], &v, (k + m) % 3 == 0, &t);
            if (t.broken > before)
                print_message("in scene %u (%s, %s)\n", k, scene_light_name(stages[k].info.light),
                              scene_content_name(stages[k].info.content));
        }
        views_destroy(&v);
        print_message("settings %u: found lit %u by %.4f, found in umbra %u by %.4f\n", m, t.lit, t.lit_by, t.umbra,
                      t.umbra_by);
        broken += t.broken;
    }
    assert_int_equal(broken, 0);
}

/* The cases that borders make are all there: else the test above says nothing about them. */
static void scenes_have_all_kinds_of_receivers(void **state)
{
    uint32_t background = 0, outside = 0, away = 0, cut = 0;
    (void)state;
    for (uint32_t k = 0; k < SCENES; k++) {
        const stage *const s = &stages[k];
        reference_camera camera;
        eye_reference(&s->scene.eye, &camera);
        for (uint32_t i = 0; i < PIXELS; i++) {
            const reference_receiver *const r = &s->receivers[1][i];
            double world[3], derivative[3];
            const bool rendered =
                reference_camera_unproject(&camera, i % WIDTH, i / WIDTH, (double)s->scene.depth[i], world, derivative);
            background += !rendered;
            outside += rendered && r->state == REFERENCE_RECEIVER_NONE;
            away += r->state == REFERENCE_RECEIVER_AWAY;
            if (r->state == REFERENCE_RECEIVER_ACTIVE) {
                double box[4];
                reference_map_kernel(&s->map, r->uvg, r->uvg[2] * (s->map.perspective ? 1.3 : 1.0) + 0.1, box);
                cut += box[0] < 0.0 || box[1] < 0.0 || box[2] > s->map.width || box[3] > s->map.height;
            }
        }
    }
    print_message("background %u, outside %u, away %u, kernels cut %u\n", background, outside, away, cut);
    assert_true(background > 100 && outside > 100 && away > 100 && cut > 100);
}

/* Section 5: the level is the smallest whose spacing keeps the kernel within the budget. Without hierarchy the kernel
 * is that of the map's nearest occluder, which the reference knows as well. */
static void budgets_choose_levels(void **state)
{
    static float visibility[PIXELS];
    (void)state;
    for (uint32_t budget = 4; budget <= 64; budget *= 4) {
        const softsh_settings settings = {.technique = SOFTSH_TECHNIQUE_BITMASK, .budget = budget, .no_hierarchy = 1};
        const sight_info info = {.settings = settings, .width = WIDTH, .height = HEIGHT};
        uint32_t wrong = 0, active = 0, coarse = 0;
        sight view;
        sight_create(&info, &view);
        for (uint32_t k = 0; k < 5; k++) {
            const stage *const s = &stages[k];
            const float *const layers[2] = {s->g[0], s->g[1]};
            softsh_stats stats;
            uint32_t clamped = 0;
            double g_hi = -INFINITY;
            for (uint32_t i = 0; i < s->map.width * s->map.height; i++)
                g_hi = fmax(g_hi, nearest_of(s, i));
            sight_run(&view, &s->lamps[0], &s->eye[0], NULL, visibility, &stats);
            check_stats(&stats, visibility, WIDTH, HEIGHT);
            for (uint32_t i = 0; i < PIXELS; i += 3) {
                const reference_receiver *const r = &s->receivers[0][i];
                reference_settings wanted = {.pattern = SOFTSH_PATTERN_DEFAULT};
                reference_occlusion o;
                uint32_t box[4];
                if (r->state != REFERENCE_RECEIVER_ACTIVE)
                    continue;
                kernel_texels(s, r, g_hi, 0.0, false, box);
                const uint32_t extent = (box[2] - box[0] > box[3] - box[1] ? box[2] - box[0] : box[3] - box[1]) + 1;
                wanted.level = reference_level(extent, budget);
                clamped += wanted.level > 0;
                assert_true(reference_visibility(&s->map, layers, s->scene.lamp.layer_count, &wanted, r, &o));
                wrong += fabs(reference_visible(r, o.bitmask) - (double)visibility[i]) > 4.0 / 256.0;
                active++;
            }
            coarse += clamped;
            /* Every third pixel was looked at. */
            assert_true(fabs((double)stats.clamped - 3.0 * clamped) < 0.05 * (double)stats.active + 20.0);
            assert_true(stats.primitives <= stats.active * (budget + 2) * (budget + 2) * s->scene.lamp.layer_count);
        }
        print_message("budget %u: %u of %u pixels at other levels or values, %u above level 0\n", budget, wrong, active,
                      coarse);
        assert_true(wrong <= active / 500);
        assert_true(budget > 4 || coarse > active / 4);
        sight_destroy(&view);
    }
}

/* With refined kernels a pixel has the value of one of the levels; a budget no kernel exceeds changes nothing. */
static void budgets_keep_to_some_level(void **state)
{
    static float coarse[PIXELS], fine[PIXELS], unlimited[PIXELS];
    sight_info info = {.settings = {.technique = SOFTSH_TECHNIQUE_BITMASK}, .width = WIDTH, .height = HEIGHT};
    uint32_t strangers = 0, active = 0;
    sight limited[3];
    (void)state;
    for (int i = 0; i < 3; i++) {
        info.settings.budget = i == 0 ? 4 : i == 1 ? 128 : 0;
        sight_create(&info, &limited[i]);
    }
    for (uint32_t k = 0; k < 5; k++) {
        const stage *const s = &stages[k];
        const float *const layers[2] = {s->g[0], s->g[1]};
        softsh_stats stats;
        sight_run(&limited[0], &s->lamps[k % 3], &s->eye[0], NULL, coarse, &stats);
        check_stats(&stats, coarse, WIDTH, HEIGHT);
        assert_true(stats.primitives <= stats.active * 6 * 6 * s->scene.lamp.layer_count);
        sight_run(&limited[1], &s->lamps[k % 3], &s->eye[0], NULL, fine, &stats);
        assert_int_equal(stats.clamped, 0);
        sight_run(&limited[2], &s->lamps[k % 3], &s->eye[0], NULL, unlimited, &stats);
        assert_int_equal(stats.clamped, 0);
        assert_memory_equal(fine, unlimited, sizeof fine);
        for (uint32_t i = 0; i < PIXELS; i += 3) {
            const reference_receiver *const r = &s->receivers[0][i];
            bool found = coarse[i] == 0.0f || coarse[i] == 1.0f;
            for (uint32_t level = 0; level < 6 && !found; level++) {
                const reference_settings wanted = {.pattern = SOFTSH_PATTERN_DEFAULT, .level = level};
                reference_occlusion o;
                assert_true(reference_visibility(&s->map, layers, s->scene.lamp.layer_count, &wanted, r, &o));
                found = fabs(reference_visible(r, o.bitmask) - (double)coarse[i]) <= 1.5 / 200.0;
            }
            strangers += !found;
            active += coarse[i] > 0.0f && coarse[i] < 1.0f;
        }
    }
    assert_true(active > 300 && strangers <= active / 200);
    for (int i = 0; i < 3; i++)
        sight_destroy(&limited[i]);
}

static int setup(void **state)
{
    const int failed = fixture_setup(state);
    for (uint32_t i = 0; i < SCENES && !failed; i++) {
        stages[i].info.seed = i;
        stage_create(&stages[i]);
    }
    return failed;
}

static int teardown(void **state)
{
    for (uint32_t i = 0; i < SCENES; i++)
        stage_destroy(&stages[i]);
    return fixture_teardown(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scenes_have_all_kinds_of_receivers),
        cmocka_unit_test(evaluated_pixels_are_unchanged),
        cmocka_unit_test(budgets_choose_levels),
        cmocka_unit_test(budgets_keep_to_some_level),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
