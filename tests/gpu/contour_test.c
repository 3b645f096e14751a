/* Contours where they are awkward: occluders that touch at a corner only, single texels, borders, kernels of several
 * words of samples, and as many edges as an invocation may have to visit. Against the double-precision reference, with
 * and without hierarchy, in strips and by the walk. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fixture.h"
#include "reference_contour.h"
#include "reference_matrix.h"
#include "scenes.h"

enum { MAX_SIDE = 24, MAX_PIXELS = MAX_SIDE * MAX_SIDE };

/* Several times what the software drivers have. */
static const double mean_limit = 1e-5, most_limit = 1e-4;

typedef bool (*pattern)(uint32_t x, uint32_t y);

/* A floor 10 below the light, and texels 5 below it where `occludes` says so; above them all of the floor in the map is
 * seen by a camera of side x side pixels. */
typedef struct board {
    const char *name;
    pattern occludes;
    uint32_t map_width, map_height;
    double half_u, half_v, turn; /* of the light */
    uint32_t layers;
    uint32_t side;
    double seen;    /* half the side of what the camera sees of the floor, 5 being the map's border */
    uint32_t level; /* that the budget asks for */
    softsh_settings settings;
} board;

static bool checkers(uint32_t x, uint32_t y)
{
    return (x + y) % 2 == 0;
}

static bool wide_checkers(uint32_t x, uint32_t y)
{
    return (x / 2 + y / 2) % 2 == 0;
}

static bool lone_texels(uint32_t x, uint32_t y)
{
    return x % 5 == 2 && y % 7 == 3;
}

/* Its corners are both convex and concave, and it runs into the map's border. */
static bool cross(uint32_t x, uint32_t y)
{
    return (x >= 11 && x < 17) || (y >= 20 && y < 23);
}

static bool diagonals(uint32_t x, uint32_t y)
{
    return (x + y) % 9 == 0 || (x + 2 * y) % 13 == 0;
}

static bool everywhere(uint32_t x, uint32_t y)
{
    (void)x, (void)y;
    return true;
}

static void board_create(const board *b, scene *s)
{
    const double nowhere[3] = {0, 0, 0}, up[3] = {0, 1, 0}, floor_at[3] = {0, 0, -10}, at[3] = {0, 0, -6};
    const reference_surface floor_below = {.infinite = true, .center = {0, 0, -10}, .u = {1, 0, 0}, .v = {0, 1, 0}};
    const double box[4] = {-b->seen, b->seen, -b->seen, b->seen};
    memset(s, 0, sizeof *s);
    s->lamp.light.struct_size = sizeof s->lamp.light;
    s->lamp.light.half_u[0] = b->half_u * cos(b->turn);
    s->lamp.light.half_u[1] = b->half_u * sin(b->turn);
    s->lamp.light.half_v[0] = -b->half_v * sin(b->turn);
    s->lamp.light.half_v[1] = b->half_v * cos(b->turn);
    s->lamp.place = (placement){.width = b->map_width, .height = b->map_height};
    s->lamp.layer_count = 1;
    s->eye.place = (placement){.width = b->side, .height = b->side};
    reference_look_at(nowhere, floor_at, up, s->lamp.view);
    reference_perspective((const double[4]){-0.5, 0.5, -0.5, 0.5}, 1.0, 30.0, REFERENCE_DEPTH_REVERSED,
                          s->lamp.layers[0].projection);
    reference_look_at(at, floor_at, up, s->eye.view);
    reference_orthographic(box, 0.1, 10.0, REFERENCE_DEPTH_NORMAL, s->eye.projection);
    scene_cast(s, &floor_below, 1);
    /* Every layer has the same texels, a little lower each. */
    s->lamp.layer_count = b->layers ? b->layers : 1;
    reference_map map;
    lamp_reference(&s->lamp, &map);
    const size_t texels = (size_t)b->map_width * b->map_height;
    float *const casters = malloc(s->lamp.layer_count * texels * sizeof(float));
    assert_non_null(casters);
    for (uint32_t layer = 0; layer < s->lamp.layer_count; layer++) {
        float *const depth = casters + layer * texels;
        for (size_t i = 0; i < texels; i++)
            depth[i] = b->occludes((uint32_t)i % b->map_width, (uint32_t)i / b->map_width)
                           ? (float)reference_map_g_to_depth(&map, 1.0 / (5.0 + 0.01 * layer))
                           : s->map_depth[0][i];
        s->lamp.layers[layer] = s->lamp.layers[0];
        s->lamp.layers[layer].depth = depth;
    }
    free(s->map_depth[0]);
    s->map_depth[0] = casters;
}

static void reference_image(const board *b, const scene *s, double *visibility)
{
    reference_dual_grid grids[SOFTSH_MAX_LAYERS];
    reference_map map;
    reference_camera camera;
    const reference_camera_image image = {s->eye.depth, NULL};
    const reference_bias bias = precision_of(&s->lamp, &s->eye);
    const reference_settings settings = {.pattern = SOFTSH_PATTERN_8X8,
                                         .aggregation = b->settings.aggregation,
                                         .merge = b->settings.merge,
                                         .level = b->level};
    lamp_reference(&s->lamp, &map);
    eye_reference(&s->eye, &camera);
    float *const g = malloc((size_t)map.width * map.height * sizeof *g);
    assert_non_null(g);
    for (uint32_t i = 0; i < s->lamp.layer_count; i++) {
        lamp_fan_depth(&s->lamp, i, g);
        assert_true(reference_dual_grid_create(&grids[i], &map, &settings, g));
    }
    for (uint32_t i = 0; i < b->side * b->side; i++) {
        reference_receiver r;
        reference_receiver_derive(&r, &map, &camera, &image, &bias, i % b->side, i / b->side);
        assert_true(reference_contour_visibility(grids, s->lamp.layer_count, &map, &settings, &r, &visibility[i]));
    }
    for (uint32_t i = 0; i < s->lamp.layer_count; i++)
        reference_dual_grid_destroy(&grids[i]);
    free(g);
}

/* `stats` are those with hierarchy, of either search. */
static void check(const board *b, softsh_stats *stats)
{
    static const softsh_accel accels[] = {SOFTSH_ACCEL_YSM, SOFTSH_ACCEL_MSSM, SOFTSH_ACCEL_HSM};
    static uint32_t next;
    const uint32_t searches = b->settings.aggregation == SOFTSH_AGGREGATION_NEAREST ? 1 : 2;
    static float visibility[MAX_PIXELS];
    static double right[MAX_PIXELS];
    const uint32_t pixels = b->side * b->side;
    scene s;
    lamp l;
    eye e;
    board_create(b, &s);
    s.eye.normals = NULL;
    reference_image(b, &s, right);
    s.lamp.dual_grids = searches > 1;
    s.lamp.accel = accels[next++ % 3];
    s.lamp.ysm_join = 24;
    lamp_create(&s.lamp, &l);
    eye_create(&s.eye, &e);
    for (uint32_t variant = 0; variant < 2 * searches; variant++) {
        const bool hierarchy = variant % 2, walk = variant / 2;
        sight_info info = {.settings = b->settings, .width = b->side, .height = b->side};
        double sum = 0.0, most = 0.0, shadow = 0.0;
        sight view;
        info.settings.technique = SOFTSH_TECHNIQUE_CONTOUR;
        info.settings.no_hierarchy = !hierarchy;
        info.settings.search = walk ? SOFTSH_SEARCH_WALK : SOFTSH_SEARCH_STRIPS;
        sight_create(&info, &view);
        sight_run(&view, &l, &e, NULL, visibility, stats);
        for (uint32_t i = 0; i < pixels; i++) {
            const double difference = fabs((double)visibility[i] - right[i]);
            shadow += (1.0 - right[i]) / pixels;
            sum += difference;
            most = difference <= most ? most : difference;
        }
        print_message("%-36s%-8s%-14s occluded %.3f, most %.6f, mean %.7f\n", b->name, walk ? "walk" : "strips",
                      hierarchy ? "hierarchy" : "", shadow, most, sum / pixels);
        assert_true(shadow > 0.01);
        assert_true(most <= most_limit && sum <= mean_limit * pixels);
        sight_destroy(&view);
    }
    eye_destroy(&e);
    lamp_destroy(&l);
    scene_destroy(&s);
}

static void awkward_occluders(void **state)
{
    static const board boards[] = {
        {"checkers", checkers, 40, 40, 0.4, 0.4, .side = 24, .seen = 3},
        {"checkers, turned light", checkers, 40, 40, 0.5, 0.3, .turn = 0.7, .side = 24, .seen = 3},
        {"checkers of four, level 1", wide_checkers, 41, 39, 0.6, 0.4, .side = 24, .seen = 5, .level = 1,
         .settings = {.min_level = 1}},
        {"lone texels", lone_texels, 40, 40, 0.3, 0.3, .side = 24, .seen = 3},
        {"lone texels, light of one texel", lone_texels, 40, 40, 0.06, 0.06, .side = 24, .seen = 3},
        {"lone texels, nearest, level 2", lone_texels, 43, 42, 0.8, 0.5, .side = 24, .seen = 5, .level = 2,
         .settings = {.min_level = 2, .aggregation = SOFTSH_AGGREGATION_NEAREST}},
        {"corners, light below a texel", cross, 40, 40, 0.04, 0.04, .side = 24, .seen = 2.5},
        {"corners, level 2", cross, 39, 41, 0.2, 0.2, .side = 24, .seen = 5, .level = 2, .settings = {.min_level = 2}},
        {"diagonals, two layers", diagonals, 40, 40, 0.4, 0.4, .layers = 2, .side = 24, .seen = 3,
         .settings = {.merge = SOFTSH_MERGE_UNION}},
        {"diagonals, darkest of two layers", diagonals, 40, 40, 0.4, 0.4, .layers = 2, .side = 24, .seen = 3,
         .settings = {.merge = SOFTSH_MERGE_MAXIMUM}},
    };
    softsh_stats stats;
    (void)state;
    for (size_t k = 0; k < sizeof boards / sizeof boards[0]; k++)
        check(&boards[k], &stats);
}

/* Receivers at the map's border, and outside, where they are lit. */
static void borders(void **state)
{
    static const board boards[] = {
        {"border, all occluded", everywhere, 33, 32, 1.5, 1.0, .side = 24, .seen = 6},
        {"border, cross", cross, 33, 32, 1.5, 1.0, .side = 24, .seen = 6},
        {"border, checkers", checkers, 35, 31, 2.0, 0.7, .side = 24, .seen = 6},
        {"border, level 2", diagonals, 35, 34, 2.0, 1.2, .side = 24, .seen = 6, .level = 2,
         .settings = {.min_level = 2}},
        {"map of one texel", everywhere, 1, 1, 1.0, 1.0, .side = 24, .seen = 6},
    };
    softsh_stats stats;
    (void)state;
    for (size_t k = 0; k < sizeof boards / sizeof boards[0]; k++) {
        check(&boards[k], &stats);
        assert_true(stats.lit > 100);
    }
}

/* A kernel's side is a fifth of the light's, half a side 1 being a texel in 10 of the map's: more samples than a word
 * has bits, on one axis or both. */
static void wide_kernels(void **state)
{
    static const board boards[] = {
        {"32 samples", diagonals, 80, 80, 2.0, 2.0, .side = 12, .seen = 3},
        {"62 by 4 samples", diagonals, 100, 100, 3.1, 0.2, .side = 12, .seen = 3},
        {"4 by 63 samples", checkers, 90, 100, 0.2, 3.15, .side = 12, .seen = 3},
        {"94 samples, turned", diagonals, 120, 120, 3.9, 1.0, .turn = 0.4, .side = 8, .seen = 2},
    };
    softsh_stats stats;
    (void)state;
    for (size_t k = 0; k < sizeof boards / sizeof boards[0]; k++)
        check(&boards[k], &stats);
}

/* Two edges in every cell of the largest kernels an invocation looks at: 128 samples a side, shared by the layers. */
static void most_edges(void **state)
{
    static const board boards[] = {
        {"126 samples of checkers", checkers, 210, 210, 3.0, 3.0, .side = 8, .seen = 1.5},
        {"170 texels of checkers, level 1", wide_checkers, 284, 284, 3.0, 3.0, .side = 8, .seen = 1.5, .level = 1},
        {"126 samples of checkers, cut apart", checkers, 210, 210, 3.0, 3.0, .side = 8, .seen = 1.5,
         .settings = {.reconstruction = SOFTSH_RECONSTRUCTION_FOLDS}},
        {"62 samples of checkers, four layers", checkers, 104, 104, 3.0, 3.0, .layers = 4, .side = 8, .seen = 1.5,
         .settings = {.merge = SOFTSH_MERGE_MAXIMUM}},
    };
    (void)state;
    for (size_t k = 0; k < sizeof boards / sizeof boards[0]; k++) {
        const uint32_t samples = (uint32_t)(0.6 * boards[k].map_width) >> boards[k].level;
        softsh_stats stats;
        check(&boards[k], &stats);
        assert_int_equal(stats.active, 64);
        /* Nearly two a cell: without them this proves nothing. */
        assert_true(stats.primitives > stats.active * 2 * (samples - 2) * (samples - 2));
        assert_int_equal(stats.clamped, boards[k].level ? 64 : 0);
    }
}

/* Whether the segment between two points meets a rectangle parallel to z = 0. */
static bool meets(const double from[3], const double to[3], const reference_surface *s)
{
    const double t = (s->center[2] - from[2]) / (to[2] - from[2]);
    return t > 0.0 && t < 1.0 && fabs(from[0] + t * (to[0] - from[0]) - s->center[0]) < s->u[0] &&
           fabs(from[1] + t * (to[1] - from[1]) - s->center[1]) < s->v[1];
}

/* A plate over another one, which it hides from the map in part: only cut apart do both have their shadows. Against
 * rays to 32 x 32 points of the light. */
static void surfaces_apart(void **state)
{
    enum { SIDE = 48, MAP = 128 };
    static const softsh_reconstruction how[] = {SOFTSH_RECONSTRUCTION_JOINED, SOFTSH_RECONSTRUCTION_FOLDS,
                                                SOFTSH_RECONSTRUCTION_SECOND_DIFFERENCES};
    static const reference_surface surfaces[3] = {
        {.infinite = true, .center = {0, 0, -10}, .u = {1, 0, 0}, .v = {0, 1, 0}},
        {.center = {-0.2, 0, -3}, .u = {0.5, 0, 0}, .v = {0, 0.5, 0}},
        {.center = {1.2, 0, -7.5}, .u = {0.75, 0, 0}, .v = {0, 0.75, 0}},
    };
    static float visibility[SIDE * SIDE], again[SIDE * SIDE];
    static double truth[SIDE * SIDE];
    const double nowhere[3] = {0, 0, 0}, up[3] = {0, 1, 0}, floor_at[3] = {0, 0, -10}, at[3] = {0, 0, -8};
    double error[3] = {0};
    scene s;
    lamp l;
    eye e;
    (void)state;
    memset(&s, 0, sizeof s);
    s.lamp.light = (softsh_light){.struct_size = sizeof s.lamp.light, .half_u = {1, 0, 0}, .half_v = {0, 1, 0}};
    s.lamp.place = (placement){.width = MAP, .height = MAP};
    s.lamp.layer_count = 1;
    s.eye.place = (placement){.width = SIDE, .height = SIDE};
    reference_look_at(nowhere, floor_at, up, s.lamp.view);
    reference_perspective((const double[4]){-0.5, 0.5, -0.5, 0.5}, 1.0, 30.0, REFERENCE_DEPTH_NORMAL,
                          s.lamp.layers[0].projection);
    reference_look_at(at, floor_at, up, s.eye.view);
    reference_orthographic((const double[4]){-4, 4, -4, 4}, 0.1, 10.0, REFERENCE_DEPTH_NORMAL, s.eye.projection);
    scene_cast(&s, surfaces, 3);
    s.eye.normals = NULL;
    lamp_create(&s.lamp, &l);
    eye_create(&s.eye, &e);
    reference_camera camera;
    eye_reference(&s.eye, &camera);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        double floor_point[3], derivative[3];
        assert_true(
            reference_camera_unproject(&camera, i % SIDE, i / SIDE, (double)s.depth[i], floor_point, derivative));
        truth[i] = 0.0;
        for (int k = 0; k < 1024; k++) {
            const double light[3] = {(k % 32 + 0.5) / 16.0 - 1.0, (k / 32 + 0.5) / 16.0 - 1.0, 0.0};
            truth[i] += !meets(floor_point, light, &surfaces[1]) && !meets(floor_point, light, &surfaces[2]);
        }
        truth[i] /= 1024.0;
    }
    for (int k = 0; k < 3; k++) {
        for (uint32_t hierarchy = 0; hierarchy < 2; hierarchy++) {
            const sight_info info = {.settings = {.technique = SOFTSH_TECHNIQUE_CONTOUR,
                                                  .reconstruction = how[k],
                                                  .no_hierarchy = !hierarchy},
                                     .width = SIDE,
                                     .height = SIDE};
            sight view;
            sight_create(&info, &view);
            sight_run(&view, &l, &e, NULL, hierarchy ? again : visibility, NULL);
            sight_destroy(&view);
        }
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            error[k] += fabs((double)visibility[i] - truth[i]) / (SIDE * SIDE);
            assert_true(fabs((double)visibility[i] - (double)again[i]) <= 1.0 / 32.0);
        }
    }
    print_message("mean error joined %.4f, cut at folds %.4f, by second differences %.4f\n", error[0], error[1],
                  error[2]);
    assert_true(error[1] < 0.85 * error[0] && error[2] < 0.7 * error[0]);
    eye_destroy(&e);
    lamp_destroy(&l);
    scene_destroy(&s);
}

/* Two walls and a floor that all of the light is in front of: of a pixel at a crease one neighbour lies on the other
 * surface, and the plane through that would be in shadow. The camera moves by parts of a pixel. */
static void corners_of_rooms(void **state)
{
    enum { SIDE = 64, MAP = 128, STEPS = 8 };
    static const reference_surface surfaces[3] = {
        {.infinite = true, .center = {0, 0, -10}, .u = {1, 0, 0}, .v = {0, 1, 0}},
        {.infinite = true, .center = {3, 0, 0}, .u = {0, 1, 0}, .v = {0, 0, 1}},
        {.infinite = true, .center = {0, -2.5, 0}, .u = {1, 0, 0}, .v = {0, 0, 1}},
    };
    static float visibility[SIDE * SIDE];
    const double nowhere[3] = {0, 0, 0}, up[3] = {0, 1, 0}, floor_at[3] = {0, 0, -10}, corner[3] = {3, -2.5, -10};
    const sight_info info = {.settings = {.technique = SOFTSH_TECHNIQUE_CONTOUR}, .width = SIDE, .height = SIDE};
    sight view;
    float darkest = 1.0f;
    (void)state;
    sight_create(&info, &view);
    for (int step = 0; step < STEPS; step++) {
        const double at[3] = {-1.0 + 0.013 * step, 1.5 + 0.007 * step, -4.0};
        scene s;
        lamp l;
        eye e;
        memset(&s, 0, sizeof s);
        s.lamp.light = (softsh_light){.struct_size = sizeof s.lamp.light, .half_u = {0.4, 0, 0}, .half_v = {0, 0.4, 0}};
        s.lamp.place = (placement){.width = MAP, .height = MAP};
        s.lamp.layer_count = 1;
        s.eye.place = (placement){.width = SIDE, .height = SIDE};
        reference_look_at(nowhere, floor_at, up, s.lamp.view);
        reference_perspective((const double[4]){-0.6, 0.6, -0.6, 0.6}, 1.0, 30.0, REFERENCE_DEPTH_NORMAL,
                              s.lamp.layers[0].projection);
        reference_look_at(at, corner, up, s.eye.view);
        reference_perspective((const double[4]){-0.3, 0.3, -0.3, 0.3}, 0.1, 30.0, REFERENCE_DEPTH_NORMAL,
                              s.eye.projection);
        scene_cast(&s, surfaces, 3);
        s.eye.normals = NULL;
        lamp_create(&s.lamp, &l);
        eye_create(&s.eye, &e);
        sight_run(&view, &l, &e, NULL, visibility, NULL);
        /* At the border a pixel may have no neighbour on its own surface. */
        for (uint32_t y = 1; y + 1 < SIDE; y++)
            for (uint32_t x = 1; x + 1 < SIDE; x++)
                darkest = fminf(darkest, visibility[y * SIDE + x]);
        eye_destroy(&e);
        lamp_destroy(&l);
        scene_destroy(&s);
    }
    sight_destroy(&view);
    print_message("darkest pixel in the corners of a room: %.4f\n", (double)darkest);
    assert_true(darkest >= 0.95f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(corners_of_rooms), cmocka_unit_test(awkward_occluders), cmocka_unit_test(borders),
        cmocka_unit_test(wide_kernels),     cmocka_unit_test(most_edges),        cmocka_unit_test(surfaces_apart),
    };
    return cmocka_run_group_tests(tests, fixture_setup, fixture_teardown);
}
