/* Sub-lights: the light is the mean of its parts, whichever maps they have and however their memory is used. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fixture.h"
#include "scenes.h"

enum { WIDTH = 61, HEIGHT = 45, PIXELS = WIDTH * HEIGHT, MOST_PARTS = 9 };

static const softsh_settings views[] = {
    {.technique = SOFTSH_TECHNIQUE_AUTO},
    {.technique = SOFTSH_TECHNIQUE_CONTOUR},
    {.technique = SOFTSH_TECHNIQUE_BITMASK, .filter_passes = 2},
};

typedef struct parts {
    uint32_t grid[2], count;
    lamp lamps[MOST_PARTS];            /* of a sub-light */
    softsh_light lights[MOST_PARTS];   /* the same as lights of their own */
    float *visibility[MOST_PARTS + 1]; /* after each call, and one to spare */
} parts;

static void parts_create(const scene *s, uint32_t columns, uint32_t rows, parts *out)
{
    *out = (parts){.grid = {columns, rows}, .count = columns * rows};
    for (uint32_t i = 0; i <= out->count; i++)
        assert_non_null(out->visibility[i] = malloc(PIXELS * sizeof(float)));
    for (uint32_t i = 0; i < out->count; i++) {
        lamp_info info = s->lamp;
        softsh_light whole = info.light;
        whole.struct_size = out->lights[i].struct_size = sizeof whole;
        memcpy(info.grid, out->grid, sizeof info.grid);
        info.cell[0] = i % columns;
        info.cell[1] = i / columns;
        assert_int_equal(softsh_sublight_create(&whole, info.grid, info.cell, &out->lights[i]), SOFTSH_SUCCESS);
        lamp_create(&info, &out->lamps[i]);
    }
}

static void parts_destroy(parts *p)
{
    for (uint32_t i = 0; i < p->count; i++)
        lamp_destroy(&p->lamps[i]);
    for (uint32_t i = 0; i <= p->count; i++)
        free(p->visibility[i]);
}

static void create_scene(scene_light light, bool hard, scene *s)
{
    const scene_info from = {.light = light,
                             .light_scale = 0.5,
                             .map_width = 70,
                             .map_height = 56,
                             .width = WIDTH,
                             .height = HEIGHT,
                             .hard = hard};
    scene_create(&from, s);
    s->eye.normals = NULL;
}

/* The mean of visibilities computed one by one, by views that know nothing of sub-lights, is what the last call writes,
 * and the first one that writes at all. */
static void the_mean_of_its_parts(void **state)
{
    static const scene_light lights[] = {SCENE_CENTRED, SCENE_IN_FRONT, SCENE_ROTATED};
    (void)state;
    for (size_t k = 0; k < sizeof views / sizeof *views; k++)
        for (size_t light = 0; light < 3; light++)
            for (int hard = 0; hard < 2; hard++) {
                const sight_info info = {.settings = views[k], .width = WIDTH, .height = HEIGHT};
                sight_info combined = info;
                double mean[PIXELS] = {0.0}, most = 0.0, dark = 0.0;
                sight alone, together;
                scene s;
                parts p;
                eye e;

                if (hard && light != 0)
                    continue;
                combined.sublights = true;
                create_scene(lights[light], hard != 0, &s);
                sight_create(&info, &alone);
                sight_create(&combined, &together);
                eye_create(&s.eye, &e);
                parts_create(&s, 3, 2, &p);
                for (uint32_t i = 0; i < p.count; i++) {
                    lamp_info part = s.lamp;
                    lamp l;
                    part.light = p.lights[i];
                    lamp_create(&part, &l);
                    sight_run(&alone, &l, &e, NULL, p.visibility[0], NULL);
                    for (int j = 0; j < PIXELS; j++)
                        mean[j] += (double)p.visibility[0][j] / p.count;
                    lamp_destroy(&l);
                }
                for (int rebuilt = 0; rebuilt < 2; rebuilt++) {
                    sight_run_all(&together, p.lamps, p.count, rebuilt != 0, &e, p.visibility);
                    for (uint32_t i = 0; i + 1 < p.count; i++)
                        for (int j = 0; j < PIXELS; j++)
                            assert_true(p.visibility[i][j] == -7.0f); /* the fixture's guard */
                    for (int j = 0; j < PIXELS; j++) {
                        most = fmax(most, fabs(mean[j] - (double)p.visibility[p.count - 1][j]));
                        dark += 1.0 - mean[j];
                    }
                }
                print_message("view %u, %s%s: differences up to %.1e\n", (unsigned)k, scene_light_name(lights[light]),
                              hard ? ", hard" : "", most);
                assert_true(dark > 100.0 && most <= 1e-6);
                parts_destroy(&p);
                eye_destroy(&e);
                sight_destroy(&together);
                sight_destroy(&alone);
                scene_destroy(&s);
            }
}

/* Areas add up: parts that share a map show what the whole light shows. */
static void parts_of_one_map_are_the_whole(void **state)
{
    static const uint32_t grids[][2] = {{1, 1}, {2, 2}, {3, 1}, {1, 4}, {3, 3}};
    const sight_info info = {.settings = {.technique = SOFTSH_TECHNIQUE_CONTOUR, .no_hierarchy = 1},
                             .width = WIDTH,
                             .height = HEIGHT,
                             .sublights = true};
    static float whole[PIXELS];
    sight view;
    scene s;
    lamp l;
    eye e;
    (void)state;
    create_scene(SCENE_CENTRED, false, &s);
    sight_create(&info, &view);
    lamp_create(&s.lamp, &l);
    eye_create(&s.eye, &e);
    sight_run(&view, &l, &e, NULL, whole, NULL);
    for (size_t g = 0; g < sizeof grids / sizeof *grids; g++) {
        double sum = 0.0, most = 0.0;
        parts p;
        parts_create(&s, grids[g][0], grids[g][1], &p);
        sight_run_all(&view, p.lamps, p.count, false, &e, p.visibility);
        for (int j = 0; j < PIXELS; j++) {
            const double difference = fabs((double)p.visibility[p.count - 1][j] - (double)whole[j]);
            sum += difference;
            most = fmax(most, difference);
        }
        print_message("%u x %u parts: %.1e on average, %.1e at most\n", grids[g][0], grids[g][1], sum / PIXELS, most);
        /* Where contours fold over themselves, a part's area may leave [0, 1], and is clamped. */
        assert_true(most <= 2e-2 && sum / PIXELS <= 1e-5);
        parts_destroy(&p);
    }
    eye_destroy(&e);
    lamp_destroy(&l);
    sight_destroy(&view);
    scene_destroy(&s);
}

/* A view for sub-lights serves other lights too, between complete ones, and begins anew after an incomplete one. */
static void other_lights_in_between(void **state)
{
    const sight_info info = {.width = WIDTH, .height = HEIGHT, .sublights = true, .format = VK_FORMAT_R8_UNORM};
    sight_info plain = info;
    static float before[PIXELS], after[PIXELS], expected[PIXELS];
    float *first[] = {before};
    sight view, reference;
    scene s;
    parts p;
    lamp l;
    eye e;
    (void)state;
    plain.sublights = false;
    create_scene(SCENE_CENTRED, false, &s);
    sight_create(&info, &view);
    sight_create(&plain, &reference);
    lamp_create(&s.lamp, &l);
    eye_create(&s.eye, &e);
    parts_create(&s, 2, 2, &p);
    sight_run(&reference, &l, &e, NULL, expected, NULL);
    sight_run_all(&view, p.lamps, p.count, false, &e, p.visibility);
    memcpy(p.visibility[p.count], p.visibility[p.count - 1], sizeof before);
    sight_run_all(&view, p.lamps, 1, false, &e, first);
    sight_run(&view, &l, &e, NULL, after, NULL);
    assert_memory_equal(after, expected, sizeof after);
    sight_run_all(&view, p.lamps, 1, false, &e, first);
    sight_run_all(&view, p.lamps, p.count, false, &e, p.visibility);
    assert_memory_equal(p.visibility[p.count - 1], p.visibility[p.count], sizeof before);
    parts_destroy(&p);
    eye_destroy(&e);
    lamp_destroy(&l);
    sight_destroy(&reference);
    sight_destroy(&view);
    scene_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_mean_of_its_parts),
        cmocka_unit_test(parts_of_one_map_are_the_whole),
        cmocka_unit_test(other_lights_in_between),
    };
    return cmocka_run_group_tests(tests, fixture_setup, fixture_teardown);
}
