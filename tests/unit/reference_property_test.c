/* Properties of the reference on generated cases: surfaces that must not shadow themselves, rays traced through the
 * world as the truth, symmetries, layers, and what a kernel may leave out. Every case has a fixed seed. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "reference_hierarchy.h"
#include "reference_map.h"
#include "reference_matrix.h"
#include "reference_receiver.h"
#include "reference_scene.h"
#include "reference_visibility.h"

enum { max_texels = 64 * 64 };

/* A lamp at height 0 that looks down -z: the kinds of map section 2 knows. */
typedef enum setup_kind { setup_on_light, setup_behind_light, setup_directional, setup_count } setup_kind;

typedef struct setup {
    reference_map map;
    double view[16], projection[16];
    double depth_of_center; /* world distance from the light to the middle of the scene */
} setup;

static void build_setup(setup *s, setup_kind kind, uint32_t width, uint32_t height, double light_size,
                        reference_depth_range range)
{
    const double up[3] = {0, 1, 0};
    const double bounds[4] = {-0.8, 0.7, -0.75, 0.85}, box[4] = {-5, 5.5, -6, 5};
    softsh_light light = {.struct_size = sizeof(light)};
    double eye[3] = {0, 0, 0};
    s->depth_of_center = 6.0;
    if (kind == setup_directional) {
        light.shape = SOFTSH_LIGHT_DIRECTIONAL;
        light.direction[2] = -1.0;
        light.angular_radius = atan(light_size);
        reference_orthographic(box, 0.5, 60.0, range, s->projection);
    } else {
        light.shape = SOFTSH_LIGHT_RECTANGLE;
        light.half_u[0] = light_size;
        light.half_v[1] = light_size * 0.75;
        eye[2] = kind == setup_behind_light ? 1.5 : 0.0;
        reference_perspective(bounds, kind == setup_behind_light ? 1.6 : 0.2, 60.0, range, s->projection);
    }
    reference_look_at(eye, (const double[3]){0, 0, -20}, up, s->view);
    assert_true(reference_map_derive(&s->map, s->view, s->projection, width, height, &light));
}

static reference_receiver on_plane(const setup *s, const double uvg[3], const double normal[3],
                                   const reference_bias *bias)
{
    reference_receiver receiver = {.state = REFERENCE_RECEIVER_ACTIVE, .side = 1};
    memcpy(receiver.uvg, uvg, sizeof(receiver.uvg));
    reference_plane_gradient(&s->map, uvg, normal, receiver.gradient);
    reference_gradient_clamp(&s->map, uvg[2], receiver.gradient);
    receiver.eta = reference_eta(&s->map, bias, uvg[2], 0.0, receiver.gradient);
    return receiver;
}

static double precision_of(reference_depth_format format)
{
    return format == REFERENCE_FORMAT_UNORM16 ? REFERENCE_PRECISION_16 : REFERENCE_PRECISION;
}

/* A plane through the middle of the scene, `degrees` away from facing the light, leaning towards `azimuth`. */
static reference_surface slanted_plane(const setup *s, double degrees, double azimuth)
{
    const double slope = degrees * acos(-1.0) / 180.0;
    reference_surface plane = {.infinite = true, .center = {0, 0, -s->depth_of_center}};
    plane.u[0] = cos(slope) * cos(azimuth);
    plane.u[1] = cos(slope) * sin(azimuth);
    plane.u[2] = -sin(slope);
    plane.v[0] = -sin(azimuth);
    plane.v[1] = cos(azimuth);
    return plane;
}

/* A plane is invisible to itself, wherever the light is. */
static void check_plane(setup_kind kind, double degrees, double azimuth, reference_depth_format format, uint64_t *state)
{
    const uint32_t width = 33, height = 29;
    const reference_bias bias = {.map_precision = precision_of(format)};
    /* All of the light stays in front of the plane. */
    const double steepness = tan(degrees * acos(-1.0) / 180.0);
    const double reach = kind == setup_directional ? 1.0 : 6.0;
    const double light_size = fmin(kind == setup_directional ? 0.4 : 1.5, 0.6 * reach / fmax(steepness, 1e-3));
    setup s;
    float depth[33 * 29], g[33 * 29];
    build_setup(&s, kind, width, height, light_size, (reference_depth_range)(reference_random(state) % 4));
    const reference_surface plane = slanted_plane(&s, degrees, azimuth);
    double normal[3];
    reference_surface_normal(&plane, (const double[3]){0, 0, 0}, normal);
    reference_cast(s.view, s.projection, width, height, s.map.far_depth, format, &plane, 1, depth, NULL);
    reference_map_convert(&s.map, depth, g);
    const float *const layers[1] = {g};
    for (int k = 0; k < 24; ++k) {
        double world[3], uvg[3];
        memcpy(world, plane.center, sizeof(world));
        reference_along(world, reference_random_range(state, -4.0, 4.0), plane.u, world);
        reference_along(world, reference_random_range(state, -4.0, 4.0), plane.v, world);
        if (!reference_map_project(&s.map, world, uvg) || uvg[0] < 0.0 || uvg[0] > width || uvg[1] < 0.0 ||
            uvg[1] > height || reference_map_light_behind(&s.map, world, normal) ||
            s.map.epsilon - s.map.delta * uvg[2] <= 0.0)
            continue;
        const reference_receiver receiver = on_plane(&s, uvg, normal, &bias);
        for (int mode = 0; mode < 32; ++mode) {
            const reference_settings settings = {.pattern = SOFTSH_PATTERN_16X16_JITTERED,
                                                 .primitive = (softsh_primitive)(1 + mode % 4),
                                                 .aggregation = (softsh_aggregation)(1 + mode / 4 % 2),
                                                 .level = (uint32_t)mode / 8 % 4};
            reference_occlusion o;
            assert_true(reference_visibility(&s.map, layers, 1, &settings, &receiver, &o));
            if (o.area > 1e-12)
                fail_msg("kind %d, %g degrees, azimuth %g, primitive %d: area %g", kind, degrees, azimuth,
                         settings.primitive, o.area);
            if (o.occluded != 0)
                fail_msg("kind %d, %g degrees, azimuth %g, format %d, primitive %d, aggregation %d, level %u: %u", kind,
                         degrees, azimuth, format, settings.primitive, settings.aggregation, settings.level,
                         o.occluded);
        }
    }
}

static void planes_do_not_shadow_themselves(void **unused)
{
    (void)unused;
    const double slopes[] = {0, 5, 20, 45, 60, 75, 85, 89};
    uint64_t state = 11;
    for (int kind = 0; kind < setup_count; ++kind)
        for (int format = 0; format < 3; ++format)
            for (size_t k = 0; k < sizeof(slopes) / sizeof(slopes[0]); ++k)
                for (int turn = 0; turn < 6; ++turn)
                    check_plane((setup_kind)kind, slopes[k], turn < 4 ? turn * acos(0.0) : turn * 1.234,
                                (reference_depth_format)format, &state);
}

/* Rays through the world against a rectangle grown by `margin` on each side: which samples are hidden from a receiver.
 */
static void trace(const setup *s, const reference_settings *settings, const double world[3],
                  const reference_surface *surface, double margin, reference_occlusion *out)
{
    memset(out, 0, sizeof(*out));
    const uint32_t n = reference_pattern_size(settings->pattern);
    double normal[3], grown[2];
    reference_cross(surface->u, surface->v, normal);
    const double lengths[2] = {sqrt(reference_dot(surface->u, surface->u)),
                               sqrt(reference_dot(surface->v, surface->v))};
    for (int i = 0; i < 2; ++i)
        grown[i] = fmax(1.0 + margin / lengths[i], 0.0);
    for (uint32_t j = 0; j < n; ++j) {
        for (uint32_t i = 0; i < n; ++i) {
            double xy[2], towards[3], offset[3];
            if (!reference_pattern_counted(settings->pattern, s->map.directional, i, j))
                continue;
            ++out->counted;
            reference_pattern_sample(settings->pattern, i, j, xy);
            const double q[2] = {2.0 * xy[0] / n - 1.0, 2.0 * xy[1] / n - 1.0};
            reference_map_light_point(&s->map, q, towards);
            if (!s->map.directional)
                reference_along(towards, -1.0, world, towards);
            reference_along(world, -1.0, surface->center, offset);
            const double t = -reference_dot(normal, offset) / reference_dot(normal, towards);
            reference_along(offset, t, towards, offset);
            if (t > 0.0 && (s->map.directional || t < 1.0) &&
                fabs(reference_dot(offset, surface->u)) <= grown[0] * lengths[0] * lengths[0] &&
                fabs(reference_dot(offset, surface->v)) <= grown[1] * lengths[1] * lengths[1]) {
                out->mask[(j * n + i) / 32] |= 1u << (j * n + i) % 32;
                ++out->occluded;
            }
        }
    }
}

static bool subset(const reference_occlusion *a, const reference_occlusion *b)
{
    for (int word = 0; word < 32; ++word)
        if (a->mask[word] & ~b->mask[word])
            return false;
    return true;
}

/* A rectangle over a floor parallel to the image plane. Microquads lie within the rectangle and reach to within a texel
 * of its border; patches of a rectangle parallel to the image plane reach at most half a texel over it. Returns
 * how many receivers were in penumbra. */
static uint32_t check_rectangle(setup_kind kind, uint32_t size, reference_depth_range range, bool tilted,
                                uint64_t *state)
{
    setup s;
    build_setup(&s, kind, size, size - 7, kind == setup_directional ? 0.3 : 0.7, range);
    const reference_bias bias = {.map_precision = REFERENCE_PRECISION};
    const double turn = tilted ? reference_random_range(state, 0.0, 1.5) : 0.0;
    const double tilt = tilted ? reference_random_range(state, -0.5, 0.5) : 0.0;
    reference_surface scene[2] = {
        {.center = {0, 0, -10.0}, .u = {1, 0, 0}, .v = {0, 1, 0}, .infinite = true},
        {.center = {reference_random_range(state, -1.0, 1.0), reference_random_range(state, -1.0, 1.0),
                    reference_random_range(state, -8.0, -4.0)},
         .u = {1.2 * cos(turn), 1.2 * sin(turn), 1.2 * tilt},
         .v = {-0.8 * sin(turn), 0.8 * cos(turn), 0}}};
    static float depth[max_texels], g[max_texels];
    reference_cast(s.view, s.projection, size, size - 7, s.map.far_depth, REFERENCE_FORMAT_EXACT, scene, 2, depth,
                   NULL);
    reference_map_convert(&s.map, depth, g);
    const float *const layers[1] = {g};
    /* The world size of a texel's diagonal on the rectangle, at its farthest. */
    const double farthest = (s.map.perspective ? 1.5 - scene[1].center[2] + 0.6 : 1.0) * sqrt(1.0 + tilt * tilt);
    const double texel = farthest * hypot(s.map.texel[0], s.map.texel[1]);
    uint32_t penumbra = 0;
    for (int k = 0; k < 60; ++k) {
        const double world[3] = {reference_random_range(state, -3.5, 3.5), reference_random_range(state, -3.5, 3.5),
                                 -10.0};
        double uvg[3];
        assert_true(reference_map_project(&s.map, world, uvg));
        const reference_receiver receiver = on_plane(&s, uvg, (const double[3]){0, 0, 1}, &bias);
        const reference_settings quads = {.pattern = SOFTSH_PATTERN_32X32};
        reference_occlusion estimate, outer, inner;
        assert_true(reference_visibility(&s.map, layers, 1, &quads, &receiver, &estimate));
        trace(&s, &quads, world, &scene[1], 1e-4, &outer);
        trace(&s, &quads, world, &scene[1], -1.01 * texel, &inner);
        assert_true(subset(&estimate, &outer));
        assert_true(subset(&inner, &estimate));
        assert_int_equal(estimate.counted, outer.counted);
        penumbra += estimate.occluded > 0 && estimate.occluded < estimate.counted;
        if (tilted)
            continue;
        const reference_settings patches = {.pattern = SOFTSH_PATTERN_32X32, .primitive = SOFTSH_PRIMITIVE_MICROPATCH};
        assert_true(reference_visibility(&s.map, layers, 1, &patches, &receiver, &estimate));
        trace(&s, &quads, world, &scene[1], 0.51 * texel, &outer);
        trace(&s, &quads, world, &scene[1], -0.51 * texel, &inner);
        assert_true(subset(&estimate, &outer));
        assert_true(subset(&inner, &estimate));
    }
    return penumbra;
}

static void rectangles_hide_what_rays_say(void **unused)
{
    (void)unused;
    uint64_t state = 12;
    uint32_t penumbra = 0;
    for (int kind = 0; kind < setup_count; ++kind)
        for (int range = 0; range < 4; ++range)
            for (int k = 0; k < 4; ++k)
                penumbra += check_rectangle((setup_kind)kind, k < 2 ? 64 : 40, (reference_depth_range)range, k % 2 != 0,
                                            &state);
    assert_true(penumbra > 200);
}

/* A camera looks at a floor and a slope; nothing is above them, so every pixel is lit, whether planes come from normals
 * or from neighbours, and whatever the depth formats. */
static void surfaces_seen_by_a_camera_are_lit(void **unused)
{
    (void)unused;
    enum { width = 24, height = 18 };
    static float depth[max_texels], g[max_texels];
    float camera_depth[width * height], normals[3 * width * height];
    int32_t hits[width * height];
    const double eye[3] = {4.0, -5.0, -3.0}, target[3] = {0.3, 0.2, -10.0}, up[3] = {0, 0, 1};
    for (int variant = 0; variant < 24; ++variant) {
        const setup_kind kind = (setup_kind)(variant % 3);
        const reference_depth_range range = (reference_depth_range)(variant / 3 % 4);
        const bool short_camera = variant >= 12; /* 16-bit camera depth, less of it */
        setup s;
        build_setup(&s, kind, 40, 35, kind == setup_directional ? 0.3 : 0.8, range);
        reference_surface scene = {.center = {0, 0, -10.0}, .u = {1, 0, 0.4}, .v = {0.1, 1, -0.2}, .infinite = true};
        reference_cast(s.view, s.projection, 40, 35, s.map.far_depth, REFERENCE_FORMAT_EXACT, &scene, 1, depth, NULL);
        reference_map_convert(&s.map, depth, g);
        double view[16], projection[16], normal[3];
        reference_look_at(eye, target, up, view);
        reference_perspective((const double[4]){-0.4, 0.4, -0.3, 0.3}, 1.0, 50.0, range, projection);
        reference_camera camera;
        assert_true(reference_camera_derive(&camera, view, projection, width, height));
        reference_cast(view, projection, width, height, camera.far_depth,
                       short_camera ? REFERENCE_FORMAT_UNORM16 : REFERENCE_FORMAT_EXACT, &scene, 1, camera_depth, hits);
        reference_surface_normal(&scene, (const double[3]){0, 0, 0}, normal);
        for (int i = 0; i < 3 * width * height; ++i)
            normals[i] = (float)normal[i % 3];
        const float *const layers[1] = {g};
        const reference_bias bias = {.map_precision = REFERENCE_PRECISION,
                                     .camera_precision = short_camera ? REFERENCE_PRECISION_16 : REFERENCE_PRECISION};
        const reference_camera_image images[2] = {{camera_depth, normals}, {camera_depth, NULL}};
        uint32_t active = 0;
        for (uint32_t pixel = 0; pixel < width * height; ++pixel) {
            /* Neighbours' differences drown in 16 bits: normals only. */
            for (int image = 0; image < (short_camera ? 1 : 2); ++image) {
                reference_receiver receiver;
                reference_receiver_derive(&receiver, &s.map, &camera, &images[image], &bias, pixel % width,
                                          pixel / width);
                assert_int_not_equal(receiver.state, REFERENCE_RECEIVER_AWAY);
                active += receiver.state == REFERENCE_RECEIVER_ACTIVE;
                for (int primitive = 1; primitive <= 3; ++primitive) {
                    const reference_settings settings = {.primitive = (softsh_primitive)primitive};
                    reference_occlusion o;
                    assert_true(reference_visibility(&s.map, layers, 1, &settings, &receiver, &o));
                    if (o.occluded != 0)
                        fail_msg("variant %d, pixel %u, %s, primitive %d: %u", variant, pixel,
                                 image ? "neighbours" : "normals", primitive, o.occluded);
                }
            }
        }
        assert_true(active > width * height / 2);
    }
}

/* A camera whose view runs across a steep slope, with 16 bits of depth: its errors leave g alone but move the receivers
 * along u, away from their plane. */
static void steep_slopes_seen_from_the_side_are_lit(void **unused)
{
    (void)unused;
    enum { width = 4, height = 240 };
    static float depth[max_texels], g[max_texels];
    static float camera_depth[width * height], normals[3 * width * height];
    const double degree = acos(-1.0) / 180.0;
    setup s;
    build_setup(&s, setup_on_light, 64, 64, 0.3, REFERENCE_DEPTH_NORMAL);
    reference_surface scene = {
        .center = {0, 0, -8}, .u = {cos(75.0 * degree), 0, sin(75.0 * degree)}, .v = {0, 1, 0}, .infinite = true};
    reference_cast(s.view, s.projection, 64, 64, s.map.far_depth, REFERENCE_FORMAT_EXACT, &scene, 1, depth, NULL);
    reference_map_convert(&s.map, depth, g);
    double view[16], projection[16], normal[3];
    reference_look_at((const double[3]){-6, 0, -7.5}, scene.center, (const double[3]){0, 0, 1}, view);
    reference_perspective((const double[4]){-0.05, 0.05, -0.2, 0.2}, 0.02, 100.0, REFERENCE_DEPTH_NORMAL, projection);
    reference_camera camera;
    assert_true(reference_camera_derive(&camera, view, projection, width, height));
    reference_cast(view, projection, width, height, camera.far_depth, REFERENCE_FORMAT_UNORM16, &scene, 1, camera_depth,
                   NULL);
    reference_surface_normal(&scene, (const double[3]){0, 0, 0}, normal);
    for (int i = 0; i < 3 * width * height; ++i)
        normals[i] = (float)normal[i % 3];
    const float *const layers[1] = {g};
    const reference_camera_image image = {camera_depth, normals};
    const reference_bias bias = {.map_precision = REFERENCE_PRECISION, .camera_precision = REFERENCE_PRECISION_16};
    for (uint32_t pixel = 0; pixel < width * height; ++pixel) {
        reference_receiver receiver;
        reference_receiver_derive(&receiver, &s.map, &camera, &image, &bias, pixel % width, pixel / width);
        assert_int_equal(receiver.state, REFERENCE_RECEIVER_ACTIVE);
        const reference_settings settings = {.primitive = SOFTSH_PRIMITIVE_MICROQUAD};
        reference_occlusion o;
        assert_true(reference_visibility(&s.map, layers, 1, &settings, &receiver, &o));
        assert_int_equal(o.occluded, 0);
    }
}

/* Floor, boxes and noise, straight in g. */
static void random_map(uint64_t *state, uint32_t width, uint32_t height, float *g)
{
    for (uint32_t i = 0; i < width * height; ++i)
        g[i] = 0.1f;
    for (int box = 0; box < 5; ++box) {
        const uint32_t x0 = reference_random(state) % width, y0 = reference_random(state) % height;
        const uint32_t w = 1 + reference_random(state) % 6, h = 1 + reference_random(state) % 6;
        const double depth = reference_random_range(state, 0.12, 0.6);
        for (uint32_t y = y0; y < y0 + h && y < height; ++y)
            for (uint32_t x = x0; x < x0 + w && x < width; ++x)
                g[y * width + x] = (float)(depth + reference_random_range(state, 0.0, 0.02));
    }
    for (int dot = 0; dot < 6; ++dot)
        g[reference_random(state) % (width * height)] = (float)reference_random_range(state, 0.0, 0.6);
}

static reference_receiver random_receiver(uint64_t *state, const reference_map *map)
{
    reference_receiver receiver = {.state = REFERENCE_RECEIVER_ACTIVE, .eta = 1e-5, .side = 1};
    receiver.uvg[0] = reference_random_range(state, 0.0, map->width);
    receiver.uvg[1] = reference_random_range(state, 0.0, map->height);
    receiver.uvg[2] = reference_random_range(state, 0.08, 0.15);
    for (int i = 0; i < 2; ++i)
        receiver.gradient[i] = reference_random_range(state, -0.005, 0.005);
    return receiver;
}

static reference_settings random_settings(uint64_t *state)
{
    return (reference_settings){.pattern = (softsh_pattern)(reference_random(state) % 5),
                                .primitive = (softsh_primitive)(reference_random(state) % 5),
                                .aggregation = (softsh_aggregation)(reference_random(state) % 3),
                                .merge = (softsh_merge)(reference_random(state) % 2),
                                .level = reference_random(state) % 3};
}

static void random_cases_keep_their_bounds(void **unused)
{
    (void)unused;
    uint64_t state = 13;
    setup s[2];
    build_setup(&s[0], setup_on_light, 19, 14, 0.6, REFERENCE_DEPTH_NORMAL);
    build_setup(&s[1], setup_behind_light, 19, 14, 0.6, REFERENCE_DEPTH_REVERSED);
    for (int round = 0; round < 600; ++round) {
        float g[2][19 * 14];
        const reference_map *map = &s[round % 2].map;
        const float *const layers[2] = {g[0], g[1]};
        const reference_receiver receiver = random_receiver(&state, map);
        reference_settings settings = random_settings(&state);
        reference_occlusion one[2], both, darkest, wide;
        for (int i = 0; i < 2; ++i) {
            random_map(&state, 19, 14, g[i]);
            assert_true(reference_visibility(map, &layers[i], 1, &settings, &receiver, &one[i]));
            assert_true(one[i].occluded <= one[i].counted && one[i].bitmask >= 0.0 && one[i].bitmask <= 1.0);
            assert_true(one[i].area >= 0.0 && isfinite(one[i].area));
        }
        settings.merge = SOFTSH_MERGE_UNION;
        assert_true(reference_visibility(map, layers, 2, &settings, &receiver, &both));
        settings.merge = SOFTSH_MERGE_MAXIMUM;
        assert_true(reference_visibility(map, layers, 2, &settings, &receiver, &darkest));
        assert_true(subset(&one[0], &both) && subset(&one[1], &both) && subset(&darkest, &both));
        assert_true(fabs(both.area - one[0].area - one[1].area) < 1e-12);
        assert_int_equal(darkest.occluded, one[0].occluded > one[1].occluded ? one[0].occluded : one[1].occluded);
        assert_true(fabs(darkest.area - fmax(one[0].area, one[1].area)) < 1e-12);
        assert_true(both.occluded <= one[0].occluded + one[1].occluded);
        if (settings.primitive == SOFTSH_PRIMITIVE_MICROPATCH_UNEXTENDED) {
            settings.primitive = SOFTSH_PRIMITIVE_MICROPATCH;
            assert_true(reference_visibility(map, layers, 1, &settings, &receiver, &wide));
            assert_true(subset(&one[0], &wide) && wide.area >= one[0].area);
        }
    }
}

static void turning_the_light_by_a_right_angle_changes_nothing(void **unused)
{
    (void)unused;
    uint64_t state = 14;
    for (int round = 0; round < 100; ++round) {
        setup s;
        float g[17 * 17];
        build_setup(&s, round % 2 ? setup_behind_light : setup_on_light, 17, 17, 0.6, REFERENCE_DEPTH_NORMAL);
        random_map(&state, 17, 17, g);
        const float *const layers[1] = {g};
        const reference_receiver receiver = random_receiver(&state, &s.map);
        const reference_settings settings = random_settings(&state);
        const double axes[2][3] = {{0.6, 0, 0}, {0, 0.45, 0}};
        reference_occlusion first;
        for (int turn = 0; turn < 4; ++turn) {
            softsh_light light = {.struct_size = sizeof(light), .shape = SOFTSH_LIGHT_RECTANGLE};
            for (int i = 0; i < 3; ++i) {
                light.half_u[i] = (turn > 1 ? -1.0 : 1.0) * axes[turn % 2][i];
                light.half_v[i] = (turn % 3 ? 1.0 : -1.0) * axes[1 - turn % 2][i];
            }
            reference_map map;
            reference_occlusion o;
            assert_true(reference_map_derive(&map, s.view, s.projection, 17, 17, &light));
            assert_true(reference_visibility(&map, layers, 1, &settings, &receiver, &o));
            if (turn == 0)
                first = o;
            assert_memory_equal(o.mask, first.mask, sizeof(o.mask));
            assert_true(fabs(o.area - first.area) < 1e-12);
        }
    }
}

/* Exchanging u and v in map and receiver exchanges columns and rows of the mask. Regular patterns only. */
static void transposed_maps_have_transposed_masks(void **unused)
{
    (void)unused;
    uint64_t state = 15;
    const double up[3] = {0, 1, 0}, eye[3] = {0, 0, 0}, target[3] = {0, 0, -1};
    for (int round = 0; round < 200; ++round) {
        double view[16], projections[2][16];
        reference_map maps[2];
        float g[2][15 * 15];
        reference_look_at(eye, target, up, view);
        reference_perspective((const double[4]){-0.8, 0.7, -0.6, 0.9}, 0.1, 50, REFERENCE_DEPTH_NORMAL, projections[0]);
        reference_perspective((const double[4]){-0.6, 0.9, -0.8, 0.7}, 0.1, 50, REFERENCE_DEPTH_NORMAL, projections[1]);
        for (int k = 0; k < 2; ++k) {
            softsh_light light = {.struct_size = sizeof(light), .shape = SOFTSH_LIGHT_RECTANGLE};
            light.half_u[k] = 0.6;
            light.half_v[1 - k] = 0.4;
            assert_true(reference_map_derive(&maps[k], view, projections[k], 15, 15, &light));
        }
        random_map(&state, 15, 15, g[0]);
        for (int i = 0; i < 15 * 15; ++i)
            g[1][i] = g[0][i % 15 * 15 + i / 15];
        reference_receiver receivers[2];
        receivers[0] = receivers[1] = random_receiver(&state, &maps[0]);
        for (int i = 0; i < 2; ++i) {
            receivers[1].uvg[i] = receivers[0].uvg[1 - i];
            receivers[1].gradient[i] = receivers[0].gradient[1 - i];
        }
        reference_settings settings = random_settings(&state);
        settings.pattern = SOFTSH_PATTERN_16X16;
        reference_occlusion o[2];
        for (int k = 0; k < 2; ++k) {
            const float *const layers[1] = {g[k]};
            assert_true(reference_visibility(&maps[k], layers, 1, &settings, &receivers[k], &o[k]));
        }
        assert_int_equal(o[0].occluded, o[1].occluded);
        assert_true(fabs(o[0].area - o[1].area) < 1e-12);
        for (uint32_t bit = 0; bit < 256; ++bit) {
            const uint32_t other = bit % 16 * 16 + bit / 16;
            assert_int_equal(o[0].mask[bit / 32] >> bit % 32 & 1u, o[1].mask[other / 32] >> other % 32 & 1u);
        }
    }
}

/* World, light and matrices in other units: the same shadow. */
static void units_do_not_matter(void **unused)
{
    (void)unused;
    uint64_t state = 16;
    const double up[3] = {0, 1, 0}, eye[3] = {0, 0, 0}, target[3] = {0, 0, -1};
    const double bounds[4] = {-0.8, 0.7, -0.6, 0.9};
    for (int round = 0; round < 100; ++round) {
        const reference_settings settings = random_settings(&state);
        reference_occlusion o[2];
        float g[2][15 * 15];
        random_map(&state, 15, 15, g[0]);
        reference_receiver receiver = {0};
        for (int k = 0; k < 2; ++k) {
            const double unit = k ? 64.0 : 1.0; /* a power of two keeps the floats' digits */
            double view[16], projection[16];
            softsh_light light = {.struct_size = sizeof(light), .shape = SOFTSH_LIGHT_RECTANGLE};
            light.half_u[0] = 0.6 * unit;
            light.half_v[1] = 0.4 * unit;
            light.center[2] = -0.5 * unit;
            reference_look_at(eye, target, up, view);
            reference_perspective(bounds, 0.1 * unit, 50.0 * unit, REFERENCE_DEPTH_NORMAL, projection);
            reference_map map;
            assert_true(reference_map_derive(&map, view, projection, 15, 15, &light));
            if (k == 0)
                receiver = random_receiver(&state, &map);
            for (int i = 0; i < 15 * 15; ++i)
                g[1][i] = g[0][i] / (float)unit;
            reference_receiver scaled = receiver;
            scaled.uvg[2] /= unit;
            scaled.eta /= unit;
            for (int i = 0; i < 2; ++i)
                scaled.gradient[i] /= unit;
            const float *const layers[1] = {g[k]};
            assert_true(reference_visibility(&map, layers, 1, &settings, &scaled, &o[k]));
        }
        assert_memory_equal(o[0].mask, o[1].mask, sizeof(o[0].mask));
        assert_true(fabs(o[0].area - o[1].area) < 1e-9);
    }
}

/* Micro-occluders none of whose samples lies within a texel of the kernel do not matter. */
static void kernels_hold_every_occluder(void **unused)
{
    (void)unused;
    uint64_t state = 17;
    uint32_t removed = 0;
    for (int round = 0; round < 400; ++round) {
        setup s;
        float g[2][31 * 31];
        build_setup(&s, round % 2 ? setup_behind_light : setup_on_light, 31, 31, 0.35, REFERENCE_DEPTH_NORMAL);
        random_map(&state, 31, 31, g[0]);
        memcpy(g[1], g[0], sizeof(g[0]));
        const reference_receiver receiver = random_receiver(&state, &s.map);
        reference_settings settings = random_settings(&state);
        settings.level = 0;
        const reference_range all = reference_block_range(g[0], 31, 31, 0, 0, 30, 30);
        double box[4];
        reference_map_kernel(&s.map, receiver.uvg, (double)all.max, box);
        for (int i = 0; i < 31 * 31; ++i) {
            const double u = i % 31 + 0.5, v = i / 31 + 0.5;
            if (u < box[0] - 1.5 || u > box[2] + 1.5 || v < box[1] - 1.5 || v > box[3] + 1.5) {
                removed += g[1][i] > (float)receiver.uvg[2];
                g[1][i] = 0.0f;
            }
        }
        reference_occlusion o[2];
        for (int k = 0; k < 2; ++k) {
            const float *const layers[1] = {g[k]};
            assert_true(reference_visibility(&s.map, layers, 1, &settings, &receiver, &o[k]));
        }
        assert_memory_equal(o[0].mask, o[1].mask, sizeof(o[0].mask));
        assert_true(fabs(o[0].area - o[1].area) < 1e-12);
    }
    assert_true(removed > 1000);
}

/* The three hierarchies bound the same depths: a YSM joined at 0 is the MSSM, one joined high is the HSM, and every
 * texel's range holds those of the texels it is made of. */
static void hierarchies_agree(void **unused)
{
    (void)unused;
    uint64_t state = 18;
    for (int round = 0; round < 40; ++round) {
        const uint32_t width = 1 + reference_random(&state) % 24, height = 1 + reference_random(&state) % 24;
        float g[24 * 24];
        random_map(&state, width, height, g);
        for (uint32_t level = 0; level < 6; ++level) {
            for (uint32_t k = 0; k < 20; ++k) {
                const uint32_t x = reference_random(&state) % width, y = reference_random(&state) % height;
                const reference_range mssm = reference_mssm(g, width, height, level, x, y);
                const reference_range ysm = reference_ysm(g, width, height, 0, level, x, y);
                assert_memory_equal(&mssm, &ysm, sizeof(mssm));
                assert_true(mssm.min <= g[y * width + x] && g[y * width + x] <= mssm.max);
                const reference_range hsm = reference_hsm(g, width, height, level, x >> level, y >> level);
                const reference_range joined = reference_ysm(g, width, height, 6, level, x >> level, y >> level);
                assert_memory_equal(&hsm, &joined, sizeof(hsm));
                assert_true(hsm.min <= g[y * width + x] && g[y * width + x] <= hsm.max);
                /* An MSSM over a materialised HSM level, against the ranges taken from the map. */
                const uint32_t w1 = reference_hsm_size(width, 1), h1 = reference_hsm_size(height, 1);
                float low[12 * 12], high[12 * 12];
                for (uint32_t i = 0; i < w1 * h1; ++i) {
                    const reference_range texel = reference_hsm(g, width, height, 1, i % w1, i / w1);
                    low[i] = texel.min;
                    high[i] = texel.max;
                }
                const reference_range y1 = reference_ysm(g, width, height, 1, 1 + level, x / 2, y / 2);
                assert_true(y1.min == reference_mssm(low, w1, h1, level, x / 2, y / 2).min);
                assert_true(y1.max == reference_mssm(high, w1, h1, level, x / 2, y / 2).max);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(planes_do_not_shadow_themselves),
        cmocka_unit_test(surfaces_seen_by_a_camera_are_lit),
        cmocka_unit_test(steep_slopes_seen_from_the_side_are_lit),
        cmocka_unit_test(rectangles_hide_what_rays_say),
        cmocka_unit_test(random_cases_keep_their_bounds),
        cmocka_unit_test(turning_the_light_by_a_right_angle_changes_nothing),
        cmocka_unit_test(transposed_maps_have_transposed_masks),
        cmocka_unit_test(units_do_not_matter),
        cmocka_unit_test(kernels_hold_every_occluder),
        cmocka_unit_test(hierarchies_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
