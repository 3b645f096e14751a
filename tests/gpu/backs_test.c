/* What surfaces hide where a receiver sees their backs: a solid thing whose sides only the second layer has; packets
 * against single pixels; and as many such cells as an invocation may have to visit. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fixture.h"
#include "reference_matrix.h"
#include "scenes.h"

enum { WIDTH = 40, HEIGHT = 30, PIXELS = WIDTH * HEIGHT };

/* Half the side of a tower on the floor, and where its top and the floor are. */
static const double half_side = 0.3, top = -4.0, floor_z = -10.0;

/* Whether the tower stands between two points. */
static bool tower_between(const double from[3], const double to[3])
{
    double enter = 0.0, leave = 1.0;
    for (int axis = 0; axis < 3; axis++) {
        const double low = axis < 2 ? -half_side : floor_z, high = axis < 2 ? half_side : top;
        const double along = to[axis] - from[axis];
        if (along == 0.0 && (from[axis] < low || from[axis] > high))
            return false;
        if (along == 0.0)
            continue;
        const double a = (low - from[axis]) / along, b = (high - from[axis]) / along;
        enter = fmax(enter, fmin(a, b));
        leave = fmin(leave, fmax(a, b));
    }
    return enter < leave;
}

/* The light stands above the tower and sees its top only; the second layer sees the sides from within. Against rays to
 * 32 x 32 points of the light. */
static void towers_have_sides(void **state)
{
    enum { SIDE = 48, MAP = 256 };
    static const softsh_reconstruction how[] = {SOFTSH_RECONSTRUCTION_JOINED, SOFTSH_RECONSTRUCTION_BACKS,
                                                SOFTSH_RECONSTRUCTION_FOLDS};
    const double middle = 0.5 * (top + floor_z), half_height = 0.5 * (top - floor_z);
    const reference_surface surfaces[6] = {
        {.infinite = true, .center = {0, 0, floor_z}, .u = {1, 0, 0}, .v = {0, 1, 0}},
        {.center = {half_side, 0, middle}, .u = {0, half_side, 0}, .v = {0, 0, half_height}},
        {.center = {-half_side, 0, middle}, .u = {0, half_side, 0}, .v = {0, 0, half_height}},
        {.center = {0, half_side, middle}, .u = {half_side, 0, 0}, .v = {0, 0, half_height}},
        {.center = {0, -half_side, middle}, .u = {half_side, 0, 0}, .v = {0, 0, half_height}},
        {.center = {0, 0, top}, .u = {half_side, 0, 0}, .v = {0, half_side, 0}},
    };
    static float visibility[SIDE * SIDE];
    static double truth[SIDE * SIDE];
    const double nowhere[3] = {0, 0, 0}, up[3] = {0, 1, 0}, down[3] = {0, 0, -10};
    double error[3] = {0};
    uint32_t pixels = 0;
    scene s, inner;
    lamp l;
    eye e;
    (void)state;
    memset(&s, 0, sizeof s);
    s.lamp.light = (softsh_light){.struct_size = sizeof s.lamp.light, .half_u = {1, 0, 0}, .half_v = {0, 1, 0}};
    s.lamp.place = (placement){.width = MAP, .height = MAP};
    s.lamp.layer_count = 1;
    s.eye.place = (placement){.width = SIDE, .height = SIDE};
    reference_look_at(nowhere, down, up, s.lamp.view);
    reference_perspective((const double[4]){-0.4, 0.4, -0.4, 0.4}, 1.0, 30.0, REFERENCE_DEPTH_NORMAL,
                          s.lamp.layers[0].projection);
    reference_look_at(nowhere, down, up, s.eye.view);
    reference_orthographic((const double[4]){-3, 3, -3, 3}, 0.1, 12.0, REFERENCE_DEPTH_NORMAL, s.eye.projection);
    inner = s;
    scene_cast(&s, surfaces, 6);
    scene_cast(&inner, surfaces, 5); /* what is behind the top */
    s.lamp.layer_count = 2;
    s.lamp.layers[1] = inner.lamp.layers[0];
    s.eye.normals = NULL;
    lamp_create(&s.lamp, &l);
    eye_create(&s.eye, &e);
    reference_camera camera;
    eye_reference(&s.eye, &camera);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        double at[3], derivative[3];
        assert_true(reference_camera_unproject(&camera, i % SIDE, i / SIDE, (double)s.depth[i], at, derivative));
        truth[i] = at[2] > floor_z + 0.1 ? -1.0 : 0.0; /* of the floor */
        for (int k = 0; k < 1024 && truth[i] >= 0.0; k++) {
            const double light[3] = {(k % 32 + 0.5) / 16.0 - 1.0, (k / 32 + 0.5) / 16.0 - 1.0, 0.0};
            truth[i] += !tower_between(at, light) / 1024.0;
        }
        pixels += truth[i] >= 0.0 && truth[i] < 1.0;
    }
    for (int k = 0; k < 3; k++) {
        const sight_info info = {.settings = {.technique = SOFTSH_TECHNIQUE_CONTOUR, .reconstruction = how[k]},
                                 .width = SIDE,
                                 .height = SIDE};
        sight view;
        sight_create(&info, &view);
        sight_run(&view, &l, &e, NULL, visibility, NULL);
        sight_destroy(&view);
        for (uint32_t i = 0; i < SIDE * SIDE; i++)
            error[k] += truth[i] >= 0.0 ? fabs((double)visibility[i] - truth[i]) / pixels : 0.0;
    }
    print_message("mean error joined %.4f, with backs %.4f, cut at folds %.4f\n", error[0], error[1], error[2]);
    assert_true(error[1] < 0.7 * error[0]);
    eye_destroy(&e);
    lamp_destroy(&l);
    scene_destroy(&inner);
    scene_destroy(&s);
}

/* On one scene after the other: kernels of several strips, cut by borders, levels as budgets choose them. */
static void packets_find_what_pixels_find(void **state)
{
    static const softsh_settings views[] = {
        {.packet = SOFTSH_PACKET_2X2, .merge = SOFTSH_MERGE_UNION, .budget = 40},
        {.packet = SOFTSH_PACKET_4X4, .no_hierarchy = 1, .budget = 40},
        {.packet = SOFTSH_PACKET_4X4, .budget = 12},
        {.packet = SOFTSH_PACKET_ADAPTIVE, .min_level = 1, .budget = 40},
    };
    (void)state;
    for (size_t k = 0; k < sizeof views / sizeof *views; k++) {
        static float alone[PIXELS], joined[PIXELS], packed[PIXELS];
        sight_info info = {.settings = views[k], .width = WIDTH, .height = HEIGHT};
        uint64_t backs = 0, apart = 0;
        double most = 0.0;
        sight by_packets, by_pixels, without;
        info.settings.technique = SOFTSH_TECHNIQUE_CONTOUR;
        info.settings.no_refinement = 1; /* else joined ones may be looked at more finely */
        info.settings.reconstruction = SOFTSH_RECONSTRUCTION_BACKS;
        sight_create(&info, &by_packets);
        info.settings.packet = SOFTSH_PACKET_1X1;
        sight_create(&info, &by_pixels);
        info.settings.reconstruction = SOFTSH_RECONSTRUCTION_JOINED;
        sight_create(&info, &without);
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
                scene s;
                lamp l;
                eye e;
                scene_create(&from, &s);
                s.eye.normals = NULL;
                lamp_create(&s.lamp, &l);
                eye_create(&s.eye, &e);
                sight_run(&by_pixels, &l, &e, NULL, alone, NULL);
                sight_run(&by_packets, &l, &e, NULL, packed, NULL);
                sight_run(&without, &l, &e, NULL, joined, NULL);
                for (uint32_t i = 0; i < PIXELS; i++) {
                    const double difference = fabs((double)packed[i] - (double)alone[i]);
                    most = difference <= most ? most : difference;
                    apart += !(difference <= 1e-4);
                    /* What backs hide is added. */
                    assert_true(alone[i] <= joined[i] + 1e-5);
                    backs += alone[i] < joined[i] - 1.0 / 256.0;
                }
                eye_destroy(&e);
                lamp_destroy(&l);
                scene_destroy(&s);
            }
        print_message("view %zu: %llu pixels with backs, %llu apart, most %.5f\n", k, (unsigned long long)backs,
                      (unsigned long long)apart, most);
        assert_true(backs > 20 && apart < 20 && most <= 1.0 / 32.0);
        sight_destroy(&without);
        sight_destroy(&by_pixels);
        sight_destroy(&by_packets);
    }
}

/* Depths at random, nearly all of which occlude: cells fold everywhere, and half of them show their backs. Drivers end
 * shaders that run too long: single pixels never do, and packets that would are evaluated as single pixels. */
static void noise_is_survived(void **state)
{
    enum { SIDE = 16, MAP = 300 }; /* so that kernels have almost as many samples as they may */
    static const struct {
        uint32_t layers, budget;
        softsh_packet packet;
    } runs[] = {{1, 0, SOFTSH_PACKET_4X4},
                {4, 0, SOFTSH_PACKET_2X2},
                {2, 32, SOFTSH_PACKET_4X4},
                {2, 0, SOFTSH_PACKET_ADAPTIVE}};
    static float alone[SIDE * SIDE], visibility[SIDE * SIDE], depth[MAP * MAP];
    const reference_surface floor_below = {.infinite = true, .center = {0, 0, -10}, .u = {1, 0, 0}, .v = {0, 1, 0}};
    const double nowhere[3] = {0, 0, 0}, up[3] = {0, 1, 0}, down[3] = {0, 0, -10};
    uint64_t seed = 99;
    reference_map map;
    scene s;
    eye e;
    (void)state;
    memset(&s, 0, sizeof s);
    s.lamp.light = (softsh_light){.struct_size = sizeof s.lamp.light, .half_u = {3, 0, 0}, .half_v = {0, 3, 0}};
    s.lamp.place = (placement){.width = MAP, .height = MAP};
    s.lamp.layer_count = 1;
    s.eye.place = (placement){.width = SIDE, .height = SIDE};
    reference_look_at(nowhere, down, up, s.lamp.view);
    reference_perspective((const double[4]){-0.5, 0.5, -0.5, 0.5}, 1.0, 30.0, REFERENCE_DEPTH_REVERSED,
                          s.lamp.layers[0].projection);
    reference_look_at(nowhere, down, up, s.eye.view);
    reference_orthographic((const double[4]){-1, 1, -1, 1}, 0.1, 12.0, REFERENCE_DEPTH_NORMAL, s.eye.projection);
    scene_cast(&s, &floor_below, 1);
    s.eye.normals = NULL;
    lamp_reference(&s.lamp, &map);
    for (uint32_t i = 0; i < MAP * MAP; i++)
        depth[i] = reference_random(&seed) % 64 == 0
                       ? s.map_depth[0][i]
                       : (float)reference_map_g_to_depth(&map, 1.0 / reference_random_range(&seed, 5.0, 9.0));
    eye_create(&s.eye, &e);
    for (size_t k = 0; k < sizeof runs / sizeof *runs; k++) {
        sight_info info = {.settings = {.technique = SOFTSH_TECHNIQUE_CONTOUR,
                                        .reconstruction = SOFTSH_RECONSTRUCTION_BACKS,
                                        .budget = runs[k].budget,
                                        .packet = SOFTSH_PACKET_1X1},
                           .width = SIDE,
                           .height = SIDE};
        lamp_info noise = s.lamp;
        softsh_stats stats;
        sight by_pixels, by_packets;
        lamp l;
        noise.layer_count = runs[k].layers;
        for (uint32_t i = 0; i < runs[k].layers; i++) {
            noise.layers[i] = s.lamp.layers[0];
            noise.layers[i].depth = depth;
        }
        lamp_create(&noise, &l);
        sight_create(&info, &by_pixels);
        info.settings.packet = runs[k].packet;
        sight_create(&info, &by_packets);
        sight_run(&by_pixels, &l, &e, NULL, alone, &stats);
        assert_int_equal(stats.active, SIDE * SIDE);
        assert_true(stats.primitives > 1000 * stats.active);
        sight_run(&by_packets, &l, &e, NULL, visibility, &stats);
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            assert_true(alone[i] >= 0.0f && alone[i] < 0.5f);
            assert_float_equal(visibility[i], alone[i], 1e-3f);
        }
        sight_destroy(&by_pixels);
        sight_destroy(&by_packets);
        lamp_destroy(&l);
    }
    eye_destroy(&e);
    scene_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(towers_have_sides),
        cmocka_unit_test(packets_find_what_pixels_find),
        cmocka_unit_test(noise_is_survived),
    };
    return cmocka_run_group_tests(tests, fixture_setup, fixture_teardown);
}
