/* Outlines in maps larger than a strip of samples, with and without hierarchy, against microquads one by one; and the
 * bits that say which cells fold. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fixture.h"
#include "readback.h"
#include "reference_dual_grid.h"
#include "scenes.h"

enum { WIDTH = 40, HEIGHT = 30, PIXELS = WIDTH * HEIGHT };

static void bits_say_what_folds(void **state)
{
    static const uint32_t sizes[][2] = {{1, 1}, {2, 1}, {31, 7}, {32, 33}, {70, 41}, {129, 20}};
    uint64_t cells = 0, folds = 0, differ = 0;
    (void)state;
    for (int light = 0; light < SCENE_LIGHT_COUNT; light++)
        for (size_t size = 0; size < sizeof sizes / sizeof *sizes; size++) {
            const scene_info from = {.light = (scene_light)light,
                                     .content = (scene_content)(size % SCENE_CONTENT_COUNT),
                                     .map_width = sizes[size][0],
                                     .map_height = sizes[size][1],
                                     .layers = 1 + size % 2,
                                     .seed = 100 * (uint64_t)light + size};
            reference_map map;
            scene s;
            lamp l;
            readback r;
            scene_create(&from, &s);
            lamp_create(&s.lamp, &l);
            readback_create(&l, &r);
            lamp_reference(&s.lamp, &map);
            float *const g = malloc((size_t)r.width * r.height * sizeof *g);
            assert_non_null(g);
            for (uint32_t layer = 0; layer < r.layers; layer++) {
                lamp_fan_depth(&s.lamp, layer, g);
                for (uint32_t level = 0; level <= r.top; level++) {
                    const reference_settings settings = {.primitive = SOFTSH_PRIMITIVE_MICROQUAD,
                                                         .aggregation = SOFTSH_AGGREGATION_SAMPLED,
                                                         .level = level};
                    reference_dual_grid grid;
                    assert_true(reference_dual_grid_create(&grid, &map, &settings, g));
                    for (uint32_t y = 0; y < grid.rows; y++)
                        for (uint32_t x = 0; x < grid.columns; x++) {
                            const bool right = reference_dual_grid_node(&grid, 0, (int32_t)x, (int32_t)y)->folds;
                            cells++;
                            folds += right;
                            differ += right != readback_folds(&r, layer, level, x, y);
                        }
                    reference_dual_grid_destroy(&grid);
                }
            }
            free(g);
            readback_destroy(&r);
            lamp_destroy(&l);
            scene_destroy(&s);
        }
    print_message("%u of %u cells fold, %u bits differ\n", (unsigned)folds, (unsigned)cells, (unsigned)differ);
    assert_true(folds > cells / 20 && folds < cells && differ <= cells / 20000);
}

/* Kernels of several strips in both directions, cut by borders; levels as budgets choose them. */
static void outlines_are_microquads(void **state)
{
    static const softsh_settings views[] = {
        {.technique = SOFTSH_TECHNIQUE_BITMASK},
        {.technique = SOFTSH_TECHNIQUE_BITMASK, .pattern = SOFTSH_PATTERN_16X16, .no_hierarchy = 1},
        {.technique = SOFTSH_TECHNIQUE_BITMASK, .pattern = SOFTSH_PATTERN_8X8, .merge = SOFTSH_MERGE_MAXIMUM},
        {.technique = SOFTSH_TECHNIQUE_BITMASK, .budget = 40},
        {.technique = SOFTSH_TECHNIQUE_BITMASK, .budget = 8, .sparse = 1},
        {.technique = SOFTSH_TECHNIQUE_AREA, .merge = SOFTSH_MERGE_MAXIMUM},
    };
    (void)state;
    for (size_t k = 0; k < sizeof views / sizeof *views; k++) {
        static float quads[PIXELS], outlines[PIXELS];
        sight_info info = {.settings = views[k], .width = WIDTH, .height = HEIGHT};
        const bool area = views[k].technique == SOFTSH_TECHNIQUE_AREA;
        uint64_t edges = 0, primitives = 0, pixels = 0, differ = 0;
        double sum = 0.0;
        sight each, together;
        sight_create(&info, &each);
        info.settings.outline = 1;
        sight_create(&info, &together);
        for (int light = 0; light < SCENE_LIGHT_COUNT; light++)
            for (int content = 0; content < SCENE_CONTENT_COUNT; content++) {
                const scene_info from = {.light = (scene_light)light,
                                         .content = (scene_content)content,
                                         .light_scale = 2.0,
                                         .map_width = 131,
                                         .map_height = 97,
                                         .layers = 1 + (uint32_t)(light + content) % 2,
                                         .width = WIDTH,
                                         .height = HEIGHT,
                                         .seed = k};
                softsh_stats all, few;
                scene s;
                lamp l;
                eye e;
                scene_create(&from, &s);
                s.eye.normals = NULL;
                lamp_create(&s.lamp, &l);
                eye_create(&s.eye, &e);
                sight_run(&each, &l, &e, NULL, quads, &all);
                sight_run(&together, &l, &e, NULL, outlines, &few);
                assert_int_equal(all.lit, few.lit);
                assert_int_equal(all.active, few.active);
                /* Microquads' vertices are clamped to the light, outlines clipped: not the same where quads are steep.
                 */
                for (int i = 0; i < PIXELS && (!area || content == SCENE_RECTANGLES); i++) {
                    const double difference = fabs((double)quads[i] - (double)outlines[i]);
                    differ += difference > (area ? 0.02 : 1.5 / 64.0);
                    sum += difference;
                }
                pixels += PIXELS;
                if (content == SCENE_RECTANGLES) {
                    edges += few.primitives;
                    primitives += all.primitives;
                }
                eye_destroy(&e);
                lamp_destroy(&l);
                scene_destroy(&s);
            }
        print_message("view %u: %.1f times fewer primitives, %.6f apart on average, %u of %u pixels notably\n",
                      (unsigned)k, (double)primitives / (double)edges, sum / (double)pixels, (unsigned)differ,
                      (unsigned)pixels);
        assert_true(sum <= (area ? 2e-3 : 2e-5) * (double)pixels && differ <= pixels / (area ? 50 : 2000));
        assert_true(primitives > (views[k].budget ? 1 : 5) * edges);
        sight_destroy(&together);
        sight_destroy(&each);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bits_say_what_folds),
        cmocka_unit_test(outlines_are_microquads),
    };
    return cmocka_run_group_tests(tests, fixture_setup, fixture_teardown);
}
