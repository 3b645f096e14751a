/* What must not matter: depth conventions and formats, the near plane, the map's resolution, units, where the world's
 * origin is, which texels are which; and planes, which do not shadow themselves. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fixture.h"
#include "readback.h"
#include "reference_matrix.h"
#include "scenes.h"

enum { WIDTH = 64, HEIGHT = 48, PIXELS = WIDTH * HEIGHT };
enum { PLANE_WIDTH = 30, PLANE_HEIGHT = 22, PLANE_PIXELS = PLANE_WIDTH * PLANE_HEIGHT };

/* What a test is run with; its state. */
typedef struct subject {
    const char *name;
    softsh_technique technique;
    sight views[2]; /* without and with normals */
} subject;

static subject subjects[] = {{.name = "bitmask", .technique = SOFTSH_TECHNIQUE_BITMASK},
                             {.name = "contour", .technique = SOFTSH_TECHNIQUE_CONTOUR}};
enum { SUBJECTS = sizeof subjects / sizeof subjects[0] };

static void look(subject *with, const scene *s, bool normals, float *visibility)
{
    eye_info info = s->eye;
    lamp l;
    eye e;
    if (!normals)
        info.normals = NULL;
    lamp_create(&s->lamp, &l);
    eye_create(&info, &e);
    sight_run(&with->views[normals], &l, &e, NULL, visibility, NULL);
    eye_destroy(&e);
    lamp_destroy(&l);
}

typedef struct distance {
    double mean, notable; /* over all pixels; share of those off by more than 4/256 */
} distance;

static distance between(const float *a, const float *b)
{
    distance d = {0};
    for (uint32_t i = 0; i < PIXELS; i++) {
        const double difference = fabs((double)a[i] - (double)b[i]);
        d.mean += difference / PIXELS;
        d.notable += (difference > 4.0 / 256.0 ? 1.0 : 0.0) / PIXELS;
    }
    return d;
}

static void near_enough(const char *what, const float *a, const float *b, double mean, double notable)
{
    const distance d = between(a, b);
    print_message("%-40s mean %.6f, over 4/256 %.3f%%\n", what, d.mean, 100.0 * d.notable);
    if (!(d.mean <= mean && d.notable <= notable))
        fail_msg("%s: more than %g or %g%%", what, mean, 100.0 * notable);
}

/* How much of the image is in shadow, so that two empty ones do not pass for equal. */
static void shadows_are_there(const float *a)
{
    uint32_t penumbra = 0, umbra = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        penumbra += a[i] > 0.0f && a[i] < 1.0f;
        umbra += a[i] == 0.0f;
    }
    print_message("penumbra %u, umbra %u of %u pixels\n", penumbra, umbra, (uint32_t)PIXELS);
    assert_true(penumbra > PIXELS / 50 && umbra > PIXELS / 200);
}

static scene_info info_of(scene_light light)
{
    return (scene_info){
        .light = light, .light_scale = 0.6, .map_width = 90, .map_height = 80, .width = WIDTH, .height = HEIGHT};
}

static const VkFormat formats[] = {VK_FORMAT_D32_SFLOAT, VK_FORMAT_X8_D24_UNORM_PACK32, VK_FORMAT_D24_UNORM_S8_UINT,
                                   VK_FORMAT_D32_SFLOAT_S8_UINT, VK_FORMAT_D16_UNORM};

static void depth_conventions(void **state)
{
    subject *const with = *state;
    static const char *const ranges[] = {"normal", "reversed", "infinite", "reversed infinite"};
    static const char *const names[] = {"D32", "D24", "D24S8", "D32S8", "D16"};
    static float plain[2][PIXELS], other[PIXELS];
    for (int light = 0; light < SCENE_LIGHT_COUNT; light++) {
        for (int range = 0; range < 4; range++) {
            scene_info info = info_of((scene_light)light);
            scene s;
            char what[80];
            info.range = (reference_depth_range)range;
            scene_create(&info, &s);
            for (int normals = 0; normals < 2; normals++) {
                look(with, &s, normals != 0, range ? other : plain[normals]);
                snprintf(what, sizeof what, "%s, %s, %s%s", with->name, scene_light_name(info.light), ranges[range],
                         normals ? ", normals" : "");
                if (range)
                    near_enough(what, other, plain[normals], 5e-4, 0.002);
                else
                    shadows_are_there(plain[normals]);
            }
            for (size_t k = 0; k < sizeof formats / sizeof formats[0]; k++) {
                const bool coarse = formats[k] == VK_FORMAT_D16_UNORM;
                if (!depth_format_supported(formats[k]) || (light != SCENE_IN_FRONT && light != SCENE_TILTED_SUN))
                    continue;
                s.lamp.layers[0].format = formats[k];
                s.eye.format = formats[k];
                /* Neighbours' differences drown in 16 bits: normals. */
                look(with, &s, coarse, other);
                snprintf(what, sizeof what, "%s, %s, %s, %s", with->name, scene_light_name(info.light), ranges[range],
                         names[k]);
                near_enough(what, other, plain[coarse], coarse ? 0.004 : 5e-4, coarse ? 0.03 : 0.003);
            }
            scene_destroy(&s);
        }
    }
}

/* Light and camera of info_of, with other matrices. */
static void near_plane(void **state)
{
    subject *const with = *state;
    static const double planes[] = {0.01, 0.5, 3.0};
    static float images[3][PIXELS];
    for (int k = 0; k < 3; k++) {
        const scene_info info = info_of(SCENE_CENTRED);
        scene s;
        scene_create(&info, &s);
        free(s.map_depth[0]);
        free(s.depth);
        free(s.normals);
        reference_perspective((const double[4]){-0.5, 0.45, -0.5, 0.55}, planes[k], k ? 60.0 : 1000.0,
                              REFERENCE_DEPTH_NORMAL, s.lamp.layers[0].projection);
        reference_perspective((const double[4]){-0.5, 0.5, -0.375, 0.375}, planes[k], k ? 60.0 : 1000.0,
                              REFERENCE_DEPTH_REVERSED, s.eye.projection);
        const reference_surface surfaces[2] = {{.center = {0, 0, -10}, .u = {7, 0, 0.4}, .v = {0, 7, -0.3}},
                                               {.center = {-0.6, 0.4, -6}, .u = {1.3, 0.4, 0}, .v = {-0.3, 0.9, 0}}};
        scene_cast(&s, surfaces, 2);
        look(with, &s, true, images[k]);
        scene_destroy(&s);
    }
    shadows_are_there(images[1]);
    near_enough("near plane at 0.01", images[0], images[1], 0.002, 0.01);
    near_enough("near plane at 3", images[2], images[1], 5e-4, 0.002);
}

/* A half plane 5 below a light of width 1, over a floor at 10, seen from between the two: the penumbra on the floor is
 * linear and 1 wide. `unit` scales everything, `origin` moves it. */
static void edge(subject *with, uint32_t map_size, double unit, const double origin[3], float *visibility)
{
    const double up[3] = {0, 1, 0};
    const reference_surface surfaces[2] = {
        {.center = {origin[0], origin[1], origin[2] - 10 * unit}, .u = {20 * unit, 0, 0}, .v = {0, 20 * unit, 0}},
        {.center = {origin[0] - 5 * unit, origin[1], origin[2] - 5 * unit},
         .u = {5 * unit, 0, 0},
         .v = {0, 8 * unit, 0}}};
    const double target[3] = {origin[0], origin[1], origin[2] - unit};
    const double at[3] = {origin[0], origin[1], origin[2] - 6 * unit};
    const double below[3] = {origin[0], origin[1], origin[2] - 7 * unit};
    const double box[4] = {-unit, unit, -0.75 * unit, 0.75 * unit};
    scene s;
    memset(&s, 0, sizeof s);
    s.lamp.light.struct_size = sizeof s.lamp.light;
    memcpy(s.lamp.light.center, origin, sizeof s.lamp.light.center);
    s.lamp.light.half_u[0] = s.lamp.light.half_v[1] = 0.5 * unit;
    s.lamp.place = (placement){.width = map_size, .height = map_size};
    s.lamp.layer_count = 1;
    s.eye.place = (placement){.width = WIDTH, .height = HEIGHT};
    reference_look_at(origin, target, up, s.lamp.view);
    reference_perspective((const double[4]){-0.5, 0.5, -0.5, 0.5}, unit, 30 * unit, REFERENCE_DEPTH_REVERSED,
                          s.lamp.layers[0].projection);
    reference_look_at(at, below, up, s.eye.view);
    reference_orthographic(box, 0.1 * unit, 10 * unit, REFERENCE_DEPTH_NORMAL, s.eye.projection);
    scene_cast(&s, surfaces, 2);
    look(with, &s, false, visibility);
    scene_destroy(&s);
}

/* Where a row's visibility, from dark to lit, passes `level`: in world units of edge() from the middle. */
static double crossing(const float *row, double level)
{
    for (int x = 1; x < WIDTH; x++) {
        const double a = (double)row[x - 1], b = (double)row[x];
        if (a < level && b >= level)
            return ((x - 0.5 + (level - a) / (b - a)) / WIDTH - 0.5) * 2.0;
    }
    fail_msg("no penumbra across the row");
    return 0.0;
}

static const double nowhere[3] = {0, 0, 0};

/* The penumbra's width is the light's affair; the map's resolution moves it by less than a texel, seen from the light
 * on the floor. */
static void resolution(void **state)
{
    subject *const with = *state;
    static float image[PIXELS];
    for (uint32_t size = 32; size <= 256; size *= 2) {
        const double texel = 2.0 * 5.0 / size;
        double widest = 0.0, narrowest = 10.0, farthest = 0.0;
        edge(with, size, 1.0, nowhere, image);
        for (uint32_t y = 0; y < HEIGHT; y++) {
            const double from = crossing(image + y * WIDTH, 0.1), to = crossing(image + y * WIDTH, 0.9);
            widest = fmax(widest, (to - from) / 0.8);
            narrowest = fmin(narrowest, (to - from) / 0.8);
            farthest = fmax(farthest, fabs(from + to) / 2.0);
        }
        print_message("map %3u: penumbra %.3f to %.3f wide for 1, off by %.3f, texel %.3f\n", size, narrowest, widest,
                      farthest, texel);
        /* A row of 16 x 16 samples is a sixteenth of the width. */
        assert_true(widest < 1.0 + 1.0 / 16.0 && narrowest > 1.0 - 1.0 / 16.0);
        assert_true(farthest < texel + 1.0 / 32.0);
    }
}

static void units(void **state)
{
    subject *const with = *state;
    static float plain[PIXELS], other[PIXELS];
    static const double scales[] = {1e-3, 1000.0, 1e6};
    char what[80];
    edge(with, 100, 1.0, nowhere, plain);
    shadows_are_there(plain);
    for (size_t k = 0; k < sizeof scales / sizeof scales[0]; k++) {
        edge(with, 100, scales[k], nowhere, other);
        snprintf(what, sizeof what, "units of %g", scales[k]);
        near_enough(what, other, plain, 5e-4, 0.002);
    }
}

static void world_offsets(void **state)
{
    subject *const with = *state;
    static float plain[PIXELS], other[PIXELS];
    static const double places[][3] = {{1e6, 0, 0}, {-1e6, 1e6, 1e6}, {1e7, -1e7, 3e6}};
    char what[80];
    edge(with, 100, 1.0, nowhere, plain);
    for (size_t k = 0; k < sizeof places / sizeof places[0]; k++) {
        edge(with, 100, 1.0, places[k], other);
        snprintf(what, sizeof what, "at (%g, %g, %g)", places[k][0], places[k][1], places[k][2]);
        near_enough(what, other, plain, 5e-4, 0.002);
    }
}

/* A level square and a slanted one over a floor, under a map that is turned by `turns` right angles and moved by whole
 * texels, and by the same points of the world: only texels' numbers change. */
static void same_texels(subject *with, int turns, const int moved[2], bool sun, float *visibility)
{
    static const double ups[4][3] = {{0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {1, 0, 0}};
    const double camera_at[3] = {3, -4, -3}, seen[3] = {0.2, 0.1, -9}, upright[3] = {0, 0, 1};
    const reference_surface surfaces[3] = {{.center = {0, 0, -10}, .u = {9, 0, 0.5}, .v = {0, 9, -0.4}},
                                           {.center = {-0.7, 0.5, -7}, .u = {1.1, 0.3, 0}, .v = {-0.2, 0.8, 0}},
                                           {.center = {0.9, -0.4, -6}, .u = {0.5, 0.2, 0.3}, .v = {-0.3, 0.6, -0.2}}};
    const int size = 96;
    const double half = sun ? 5.0 : 0.5, texel = 2.0 * half / size;
    const double bounds[4] = {-half + texel * moved[0], half + texel * moved[0], -half + texel * moved[1],
                              half + texel * moved[1]};
    scene s;
    memset(&s, 0, sizeof s);
    s.lamp.light.struct_size = sizeof s.lamp.light;
    s.lamp.place = (placement){.width = (uint32_t)size, .height = (uint32_t)size};
    s.lamp.layer_count = 1;
    s.eye.place = (placement){.width = WIDTH, .height = HEIGHT};
    reference_look_at(nowhere, surfaces[0].center, ups[turns], s.lamp.view);
    if (sun) {
        s.lamp.light.shape = SOFTSH_LIGHT_DIRECTIONAL;
        s.lamp.light.direction[0] = 0.2;
        s.lamp.light.direction[2] = -1.0;
        s.lamp.light.angular_radius = 0.1;
        reference_orthographic(bounds, 0.5, 30.0, REFERENCE_DEPTH_NORMAL, s.lamp.layers[0].projection);
    } else {
        s.lamp.light.half_u[0] = 0.5;
        s.lamp.light.half_u[1] = 0.1;
        s.lamp.light.half_v[0] = -0.06;
        s.lamp.light.half_v[1] = 0.3;
        reference_perspective(bounds, 1.0, 30.0, REFERENCE_DEPTH_REVERSED, s.lamp.layers[0].projection);
    }
    reference_look_at(camera_at, seen, upright, s.eye.view);
    reference_perspective((const double[4]){-0.4, 0.4, -0.3, 0.3}, 1.0, 60.0, REFERENCE_DEPTH_REVERSED,
                          s.eye.projection);
    scene_cast(&s, surfaces, 3);
    look(with, &s, true, visibility);
    scene_destroy(&s);
}

static void maps_shifted_by_texels(void **state)
{
    static const int shifts[][2] = {{1, 0}, {0, -1}, {3, 2}, {-4, 5}};
    static float plain[PIXELS], other[PIXELS];
    subject *const with = *state;
    for (int sun = 0; sun < 2; sun++) {
        same_texels(with, 0, (const int[2]){0, 0}, sun != 0, plain);
        shadows_are_there(plain);
        for (size_t k = 0; k < sizeof shifts / sizeof shifts[0]; k++) {
            char what[80];
            same_texels(with, 0, shifts[k], sun != 0, other);
            snprintf(what, sizeof what, "%s, moved by %d, %d%s", with->name, shifts[k][0], shifts[k][1],
                     sun ? ", sun" : "");
            near_enough(what, other, plain, 1e-5, 0.0);
        }
    }
}

static void maps_turned_by_right_angles(void **state)
{
    static float plain[PIXELS], other[PIXELS];
    subject *const with = *state;
    for (int sun = 0; sun < 2; sun++)
        for (int turns = 0; turns < 4; turns++) {
            char what[80];
            same_texels(with, turns, (const int[2]){0, 0}, sun != 0, turns ? other : plain);
            snprintf(what, sizeof what, "%s, turned by %d right angles%s", with->name, turns, sun ? ", sun" : "");
            if (turns)
                near_enough(what, other, plain, 1e-5, 0.0);
        }
}

/* A plane 6 from the light, `degrees` from facing it, seen along its normal or (`grazing`) across it, all of the light
 * in front of it. */
static void cast_plane(scene *s, int kind, double degrees, double azimuth, bool grazing)
{
    const double slope = degrees * acos(-1.0) / 180.0, up[3] = {0, 1, 0};
    const double reach = kind == 1 ? 1.0 : 6.0, most = kind == 1 ? 0.4 : 1.5;
    const double size = fmin(most, 0.6 * reach / fmax(tan(slope), 1e-3));
    const reference_surface plane = {.infinite = true,
                                     .center = {0, 0, -6},
                                     .u = {cos(slope) * cos(azimuth), cos(slope) * sin(azimuth), -sin(slope)},
                                     .v = {-sin(azimuth), cos(azimuth), 0}};
    const double lamp_at[3] = {0, 0, kind == 2 ? 1.5 : 0.0};
    double normal[3], at[3];
    memset(s, 0, sizeof *s);
    s->lamp.light.struct_size = sizeof s->lamp.light;
    s->lamp.place = (placement){.width = 31, .height = 27};
    s->lamp.layer_count = 1;
    s->eye.place = (placement){.width = PLANE_WIDTH, .height = PLANE_HEIGHT};
    reference_look_at(lamp_at, plane.center, up, s->lamp.view);
    if (kind == 1) {
        s->lamp.light.shape = SOFTSH_LIGHT_DIRECTIONAL;
        s->lamp.light.direction[2] = -1.0;
        s->lamp.light.angular_radius = atan(size);
        reference_orthographic((const double[4]){-3, 3.2, -3.5, 3}, 0.5, 40.0, REFERENCE_DEPTH_NORMAL,
                               s->lamp.layers[0].projection);
    } else {
        s->lamp.light.half_u[0] = size;
        s->lamp.light.half_v[1] = 0.8 * size;
        reference_perspective((const double[4]){-0.5, 0.45, -0.4, 0.5}, 0.2 + lamp_at[2], 60.0,
                              REFERENCE_DEPTH_REVERSED, s->lamp.layers[0].projection);
    }
    reference_surface_normal(&plane, nowhere, normal);
    reference_along(plane.center, grazing ? 1.2 : 4.0, normal, at);
    if (grazing)
        reference_along(at, 4.0, plane.v, at);
    reference_look_at(at, plane.center, grazing ? normal : plane.v, s->eye.view);
    reference_perspective((const double[4]){-0.4, 0.4, -0.3, 0.3}, 0.1, 50.0, REFERENCE_DEPTH_NORMAL,
                          s->eye.projection);
    scene_cast(s, &plane, 1);
}

/* Looks at a plane through both views; how many pixels are not fully lit. */
static uint32_t look_at_plane(const scene *s, sight mine[2], const char *what)
{
    static float visibility[PLANE_PIXELS];
    uint32_t dark = 0;
    lamp l;
    lamp_create(&s->lamp, &l);
    for (int normals = 0; normals < 2; normals++) {
        eye_info info = s->eye;
        eye e;
        uint32_t here = 0, last = 0;
        if (!normals)
            info.normals = NULL;
        eye_create(&info, &e);
        sight_run(&mine[normals], &l, &e, NULL, visibility, NULL);
        for (uint32_t i = 0; i < PLANE_PIXELS; i++)
            if (visibility[i] != 1.0f) {
                here++;
                last = i;
            }
        if (here)
            print_message("%s%s: %u pixels, the last (%u, %u) %.4f\n", what, normals ? ", normals" : "", here,
                          last % PLANE_WIDTH, last / PLANE_WIDTH, (double)visibility[last]);
        dark += here;
        eye_destroy(&e);
    }
    lamp_destroy(&l);
    return dark;
}

static const double angles[] = {0, 20, 45, 60, 75, 85, 89};
enum { ANGLES = sizeof angles / sizeof angles[0] };

/* Every third of the planes; `turn` chooses which, and their details. */
static uint32_t look_at_planes(sight mine[2], uint32_t turn, const char *settings)
{
    uint32_t dark = 0;
    for (uint32_t k = turn % 3; k < 3 * ANGLES; k += 3) {
        const int kind = (int)(k / ANGLES);
        const uint32_t detail = k + turn;
        const double azimuth = detail % 3 == 0 ? 0.0 : (double)detail;
        const bool grazing = detail % 4 == 3, coarse = detail % 5 == 4;
        char what[160];
        scene s;
        cast_plane(&s, kind, angles[k % ANGLES], azimuth, grazing);
        if (coarse)
            s.lamp.layers[0].format = VK_FORMAT_D16_UNORM;
        snprintf(what, sizeof what, "%s, kind %d, %g degrees, azimuth %g%s%s", settings, kind, angles[k % ANGLES],
                 azimuth, grazing ? ", grazing" : "", coarse ? ", D16" : "");
        dark += look_at_plane(&s, mine, what);
        scene_destroy(&s);
    }
    return dark;
}

/* All primitives, aggregations and levels, bitmask, area and contours, with and without hierarchy, normals, and 16 bits
 * of depth in the map. */
static void planes_do_not_shadow_themselves(void **state)
{
    uint32_t dark = 0, turn = 0;
    (void)state;
    for (uint32_t mode = 0; mode < 14; mode++) {
        const bool area = mode >= 8 && mode < 12, contour = mode >= 12;
        const bool nearest = contour ? mode % 2 != 0 : mode / 4 % 2 != 0;
        const softsh_technique technique = contour ? SOFTSH_TECHNIQUE_CONTOUR
                                           : area  ? SOFTSH_TECHNIQUE_AREA
                                                   : SOFTSH_TECHNIQUE_BITMASK;
        sight mine[2];
        for (int normals = 0; normals < 2; normals++) {
            const sight_info info = {
                .settings = {.technique = technique,
                             .primitive = (softsh_primitive)(contour ? 0 : 1 + mode % 4),
                             .aggregation = nearest ? SOFTSH_AGGREGATION_NEAREST : SOFTSH_AGGREGATION_SAMPLED,
                             .no_hierarchy = mode % 3 == 0},
                .width = PLANE_WIDTH,
                .height = PLANE_HEIGHT,
                .normals = normals != 0};
            sight_create(&info, &mine[normals]);
        }
        for (uint32_t level = 0; level < (area ? 1 : 3); level++, turn += 2) {
            char settings[80];
            sight_set_level(&mine[0], level);
            sight_set_level(&mine[1], level);
            snprintf(settings, sizeof settings, "technique %d, primitive %u, %s, level %u", (int)technique,
                     contour ? 0 : 1 + mode % 4, nearest ? "nearest" : "sampled", level);
            dark += look_at_planes(mine, turn, settings);
            dark += look_at_planes(mine, turn + 1, settings);
        }
        sight_destroy(&mine[0]);
        sight_destroy(&mine[1]);
    }
    assert_int_equal(dark, 0);
}

static int setup(void **state)
{
    const int failed = fixture_setup(state);
    for (int k = 0; k < 2 * SUBJECTS && !failed; k++) {
        const sight_info info = {.settings = {.technique = subjects[k / 2].technique},
                                 .width = WIDTH,
                                 .height = HEIGHT,
                                 .normals = k % 2 != 0};
        sight_create(&info, &subjects[k / 2].views[k % 2]);
    }
    return failed;
}

static int teardown(void **state)
{
    for (int k = 0; k < 2 * SUBJECTS; k++)
        sight_destroy(&subjects[k / 2].views[k % 2]);
    return fixture_teardown(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(depth_conventions, &subjects[0]),
        cmocka_unit_test_prestate(depth_conventions, &subjects[1]),
        cmocka_unit_test_prestate(near_plane, &subjects[0]),
        cmocka_unit_test_prestate(near_plane, &subjects[1]),
        cmocka_unit_test_prestate(resolution, &subjects[0]),
        cmocka_unit_test_prestate(resolution, &subjects[1]),
        cmocka_unit_test_prestate(units, &subjects[0]),
        cmocka_unit_test_prestate(units, &subjects[1]),
        cmocka_unit_test_prestate(world_offsets, &subjects[0]),
        cmocka_unit_test_prestate(world_offsets, &subjects[1]),
        cmocka_unit_test_prestate(maps_shifted_by_texels, &subjects[0]),
        cmocka_unit_test_prestate(maps_shifted_by_texels, &subjects[1]),
        /* Sample patterns are not the same all around. */
        cmocka_unit_test_prestate(maps_turned_by_right_angles, &subjects[1]),
        cmocka_unit_test(planes_do_not_shadow_themselves),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
