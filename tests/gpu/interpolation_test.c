/* Pixels between those that are evaluated, against the rule written once more in C: every pixel of a sparse view is
 * what it is without interpolation, or the mean of neighbours that it has the right to take. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fixture.h"
#include "scenes.h"

enum { WIDTH = 61, HEIGHT = 45, PIXELS = WIDTH * HEIGHT };

typedef struct counts {
    uint64_t pixels, interpolated, active, changed;
    double sum, most;
    uint64_t corners;
} counts;

static const softsh_settings views[] = {
    {.technique = SOFTSH_TECHNIQUE_CONTOUR, .budget = 16},
    {.technique = SOFTSH_TECHNIQUE_BITMASK, .primitive = SOFTSH_PRIMITIVE_MICROPATCH, .budget = 16},
    {.technique = SOFTSH_TECHNIQUE_BITMASK, .primitive = SOFTSH_PRIMITIVE_MICROQUAD},
    {.technique = SOFTSH_TECHNIQUE_AREA, .primitive = SOFTSH_PRIMITIVE_MICROQUAD, .merge = SOFTSH_MERGE_MAXIMUM},
    {.technique = SOFTSH_TECHNIQUE_CONTOUR, .no_hierarchy = 1},
};

/* Packets sum the edges of all their pixels' kernels, hundreds where those are of noise. */
static const float rounding = 2e-5f;

static bool is_one_surface(float before, float here, float after)
{
    const float bend = fabsf(before - 2.0f * here + after), slope = fmaxf(fabsf(before - here), fabsf(after - here));
    /* More than the shader allows by its rounding: the precision of depths is some 2^-21. */
    return bend <= 0.5f * slope + 4.1f * 0x1p-21f;
}

/* Whether the pixel may be the mean of its neighbours in `full`, and that mean. */
static bool may_interpolate(const float *depth, const float *full, int x, int y, double *mean)
{
    const int ax = x & 1, ay = y & 1;
    const int at[4] = {(y - ay) * WIDTH + x - ax, (y + ay) * WIDTH + x + ax, (y + ay) * WIDTH + x - ax,
                       (y - ay) * WIDTH + x + ax};
    const float here = depth[y * WIDTH + x];
    float least = INFINITY, most = -INFINITY;
    if (!(ax | ay) || x == 0 || y == 0 || x == WIDTH - 1 || y == HEIGHT - 1)
        return false;
    *mean = 0.0;
    for (int i = 0; i < 4; i++) {
        *mean += 0.25 * (double)full[at[i]];
        least = fminf(least, full[at[i]]);
        most = fmaxf(most, full[at[i]]);
    }
    return most - least <= 0.25f && is_one_surface(depth[at[0]], here, depth[at[1]]) &&
           is_one_surface(depth[at[2]], here, depth[at[3]]);
}

static void check(const scene *s, sight *plain, sight *sparse, bool normals, counts *c)
{
    static float full[PIXELS], result[PIXELS];
    softsh_stats before, after;
    eye_info info = s->eye;
    uint64_t changed = 0;
    lamp l;
    eye e;

    if (!normals)
        info.normals = NULL;
    lamp_create(&s->lamp, &l);
    eye_create(&info, &e);
    sight_run(plain, &l, &e, NULL, full, &before);
    sight_run(sparse, &l, &e, NULL, result, &after);
    /* Evaluation may find that a pixel is lit or dark after all. */
    assert_true(before.active <= after.active && after.active - before.active <= after.interpolated);
    assert_int_equal(before.interpolated, 0);
    for (int i = 0; i < PIXELS; i++) {
        double mean = 0.0;
        if (fabsf(full[i] - result[i]) <= rounding)
            continue;
        /* What a cell's corner beside a large kernel hides is found or not, as the packet has it (docs/numerics.md,
         * section 8). */
        const bool may = may_interpolate(s->depth, full, i % WIDTH, i / WIDTH, &mean);
        const double off = fmin(fabs((double)result[i] - (double)full[i]), may ? fabs((double)result[i] - mean) : 1.0);
        assert_true(off <= 1.0 / 32.0);
        c->corners += off > (double)rounding;
        if (!may)
            continue;
        changed++;
        c->most = fmax(c->most, fabs((double)result[i] - (double)full[i]));
        c->sum += fabs((double)result[i] - (double)full[i]);
    }
    assert_true(changed <= after.interpolated && after.interpolated <= after.active);
    c->changed += changed;
    c->interpolated += after.interpolated;
    c->active += after.active;
    c->pixels += PIXELS;
    eye_destroy(&e);
    lamp_destroy(&l);
}

static void pixels_are_evaluated_or_means(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof views / sizeof *views; k++) {
        const bool normals = k % 2;
        sight_info info = {.settings = views[k], .width = WIDTH, .height = HEIGHT, .normals = normals};
        counts smooth = {0}, rough = {0};
        sight plain, sparse;
        sight_create(&info, &plain);
        info.settings.sparse = 1;
        sight_create(&info, &sparse);
        for (int light = 0; light < SCENE_ROTATED; light++)
            for (int content = 0; content < SCENE_CONTENT_COUNT; content++) {
                const scene_info from = {.light = (scene_light)light,
                                         .content = (scene_content)content,
                                         .map_width = 70,
                                         .map_height = 56,
                                         .width = WIDTH,
                                         .height = HEIGHT,
                                         .range = (reference_depth_range)((light + content) % 4),
                                         .seed = k};
                scene s;
                scene_create(&from, &s);
                check(&s, &plain, &sparse, normals, content == SCENE_RECTANGLES ? &smooth : &rough);
                scene_destroy(&s);
            }
        print_message(
            "view %u: interpolated %.0f %% of the active pixels of smooth scenes, %.0f %% of rough ones; changed by "
            "%.4f on average, by %.3f at most\n",
            (unsigned)k, 100.0 * (double)smooth.interpolated / (double)smooth.active,
            100.0 * (double)rough.interpolated / (double)rough.active, smooth.sum / (double)(smooth.changed + 1),
            smooth.most);
        assert_true(smooth.corners == 0 && rough.corners <= rough.active / 500);
        assert_true(smooth.interpolated > smooth.active / 5);
        assert_true((double)rough.interpolated < 0.6 * (double)rough.active);
        assert_true(smooth.sum <= 0.02 * (double)smooth.changed);
        sight_destroy(&sparse);
        sight_destroy(&plain);
    }
}

/* All pixels active and none on one surface with its neighbours: both lists are as long as they can be. */
static void nothing_to_interpolate(void **state)
{
    const scene_info from = {.map_width = 70, .map_height = 56, .width = WIDTH, .height = HEIGHT};
    static float full[PIXELS], result[PIXELS];
    (void)state;
    for (int bits = 0; bits < 2; bits++) {
        sight_info info = {.settings = views[bits ? 1 : 4], .width = WIDTH, .height = HEIGHT};
        uint64_t random = 5;
        softsh_stats stats;
        sight plain, sparse;
        scene s;
        lamp l;
        eye e;

        info.settings.no_hierarchy = 1;
        scene_create(&from, &s);
        for (int i = 0; i < PIXELS; i++)
            s.depth[i] = (float)reference_random_range(&random, 0.955, 0.965);
        eye_info eye_from = s.eye;
        eye_from.normals = NULL;
        lamp_create(&s.lamp, &l);
        eye_create(&eye_from, &e);
        sight_create(&info, &plain);
        info.settings.sparse = 1;
        sight_create(&info, &sparse);
        sight_run(&plain, &l, &e, NULL, full, NULL);
        sight_run(&sparse, &l, &e, NULL, result, &stats);
        print_message("%u of %u pixels active, %u interpolated\n", (unsigned)stats.active, PIXELS,
                      (unsigned)stats.interpolated);
        assert_true(stats.active > 0.8 * PIXELS && stats.interpolated < PIXELS / 20);
        for (int i = 0; i < PIXELS; i++) {
            double mean = 0.0;
            if (fabsf(full[i] - result[i]) > 2e-6f)
                assert_true(may_interpolate(s.depth, full, i % WIDTH, i / WIDTH, &mean) &&
                            fabs((double)result[i] - mean) <= 2e-6);
        }
        sight_destroy(&sparse);
        sight_destroy(&plain);
        eye_destroy(&e);
        lamp_destroy(&l);
        scene_destroy(&s);
    }
}

/* The shadow of a wire close to the floor, narrower than the distance between the pixels that are always evaluated. */
static void narrow_shadows_stay(void **state)
{
    (void)state;
    for (int turn = 0; turn < 6; turn++) {
        const double angle = 0.5 * turn + 0.1, along[2] = {cos(angle), sin(angle)};
        const reference_surface surfaces[2] = {
            {.center = {0.0, 0.0, -10.0}, .u = {1.0, 0.0, 0.0}, .v = {0.0, 1.0, 0.0}, .infinite = true},
            {.center = {0.1, 0.2, -9.8},
             .u = {2.0 * along[0], 2.0 * along[1], 0.0},
             .v = {-0.08 * along[1], 0.08 * along[0], 0.0}},
        };
        const scene_info from = {
            .map_width = 256, .map_height = 256, .width = WIDTH, .height = HEIGHT, .light_scale = 0.5};
        sight_info info = {.settings = views[0], .width = WIDTH, .height = HEIGHT};
        static float full[PIXELS], result[PIXELS];
        double dark = 0.0, kept = 0.0, most = 0.0;
        sight plain, sparse;
        scene s;
        lamp l;
        eye e;

        scene_create(&from, &s);
        scene_cast(&s, surfaces, 2);
        eye_info eye_from = s.eye;
        eye_from.normals = NULL;
        lamp_create(&s.lamp, &l);
        eye_create(&eye_from, &e);
        sight_create(&info, &plain);
        info.settings.sparse = 1;
        sight_create(&info, &sparse);
        sight_run(&plain, &l, &e, NULL, full, NULL);
        sight_run(&sparse, &l, &e, NULL, result, NULL);
        for (int i = 0; i < PIXELS; i++) {
            dark += 1.0 - (double)full[i];
            kept += 1.0 - (double)result[i];
            most = fmax(most, fabs((double)full[i] - (double)result[i]));
        }
        print_message("wire %d: %.2f pixels' worth of shadow, %.2f of it kept, at most %.3f off\n", turn, dark, kept,
                      most);
        assert_true(dark > 2.0 && most <= 0.25);
        assert_true(fabs(kept - dark) <= 0.05 * dark);
        sight_destroy(&sparse);
        sight_destroy(&plain);
        eye_destroy(&e);
        lamp_destroy(&l);
        scene_destroy(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pixels_are_evaluated_or_means),
        cmocka_unit_test(nothing_to_interpolate),
        cmocka_unit_test(narrow_shadows_stay),
    };
    return cmocka_run_group_tests(tests, fixture_setup, fixture_teardown);
}
