/* The post filter against the reference, from the values the device itself had: bitmask occlusion of a run without
 * filter, area occlusion and tiles of the run with it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fixture.h"
#include "readback.h"
#include "reference_filter.h"
#include "scenes.h"

enum { WIDTH = 61, HEIGHT = 45, PIXELS = WIDTH * HEIGHT };

typedef struct counts {
    uint32_t pixels, changed, wrong;
    double most;
} counts;

/* Lit, umbra and undecided tiles as section 6 has them. */
static void check(const scene *s, sight *plain, sight *filtered, bool normals, uint32_t passes, counts *c)
{
    static float before[PIXELS], after[PIXELS], areas[PIXELS];
    static double a[PIXELS], b[PIXELS];
    static bool undecided[PIXELS];
    static uint8_t kinds[PIXELS];
    eye_info info = s->eye;
    reference_camera camera;
    lamp l;
    eye e;

    if (!normals)
        info.normals = NULL;
    eye_reference(&info, &camera);
    lamp_create(&s->lamp, &l);
    eye_create(&info, &e);
    sight_run(plain, &l, &e, NULL, before, NULL);
    sight_run(filtered, &l, &e, NULL, after, NULL);
    sight_read_areas(filtered, WIDTH, HEIGHT, areas, undecided);
    for (uint32_t i = 0; i < PIXELS; i++) {
        double world[3], derivative[3];
        const bool receiver =
            reference_camera_unproject(&camera, i % WIDTH, i / WIDTH, (double)s->depth[i], world, derivative);
        kinds[i] = !receiver      ? REFERENCE_FILTER_NO_RECEIVER
                   : undecided[i] ? REFERENCE_FILTER_PENUMBRA
                                  : REFERENCE_FILTER_FIXED;
        b[i] = 1.0 - (double)before[i];
        a[i] = undecided[i] ? (double)areas[i] : b[i];
    }
    assert_true(reference_filter(b, a, kinds, WIDTH, HEIGHT, passes));
    for (uint32_t i = 0; i < PIXELS; i++) {
        const double difference = fabs(1.0 - (double)after[i] - b[i]);
        c->pixels += kinds[i] == REFERENCE_FILTER_PENUMBRA;
        c->changed += before[i] != after[i];
        c->wrong += !(difference <= 1e-5);
        c->most = fmax(c->most, difference);
        if (kinds[i] != REFERENCE_FILTER_PENUMBRA)
            assert_true(before[i] == after[i]);
    }
    eye_destroy(&e);
    lamp_destroy(&l);
}

static void filter_is_the_references(void **state)
{
    static const uint32_t passes[] = {1, 2, 3, 16};
    (void)state;
    for (size_t k = 0; k < sizeof passes / sizeof passes[0]; k++) {
        const bool normals = k % 2;
        const softsh_settings settings = {.technique = SOFTSH_TECHNIQUE_BITMASK,
                                          .pattern = k % 2 ? SOFTSH_PATTERN_8X8 : SOFTSH_PATTERN_16X16,
                                          .primitive =
                                              k < 2 ? SOFTSH_PRIMITIVE_MICROQUAD : SOFTSH_PRIMITIVE_MICROPATCH};
        sight_info info = {.settings = settings, .width = WIDTH, .height = HEIGHT, .normals = normals};
        counts c = {0};
        sight plain, filtered;
        sight_create(&info, &plain);
        info.settings.filter_passes = passes[k];
        sight_create(&info, &filtered);
        for (int light = 0; light < SCENE_ROTATED; light++)
            for (int content = 0; content < SCENE_CONTENT_COUNT; content++) {
                const scene_info from = {.light = (scene_light)light,
                                         .content = (scene_content)content,
                                         .light_scale = 0.7,
                                         .map_width = 70,
                                         .map_height = 56,
                                         .width = WIDTH,
                                         .height = HEIGHT,
                                         .range = (reference_depth_range)((light + content) % 4),
                                         .seed = k};
                scene s;
                scene_create(&from, &s);
                check(&s, &plain, &filtered, normals, passes[k], &c);
                scene_destroy(&s);
            }
        print_message("%2u passes: %u pixels, %u changed, %u wrong, at most by %g\n", passes[k], c.pixels, c.changed,
                      c.wrong, c.most);
        assert_true(c.changed > c.pixels / 20);
        /* Ties of floats that are none in doubles, or the other way round: every pass has its own and hands on those
         * before. */
        assert_true(c.wrong <= passes[k] * (c.pixels / 1000));
        sight_destroy(&filtered);
        sight_destroy(&plain);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(filter_is_the_references)};
    return cmocka_run_group_tests(tests, fixture_setup, fixture_teardown);
}
