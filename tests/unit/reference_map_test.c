/* The reference's geometry: map space against world space, light axes, receivers, their planes and their bias. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "reference_map.h"
#include "reference_matrix.h"
#include "reference_receiver.h"
#include "reference_scene.h"

static const double unit_bounds[4] = {-1.0, 1.0, -1.0, 1.0};

static void assert_near(double a, double b, double tolerance)
{
    const double scale = fmax(1.0, fmax(fabs(a), fabs(b)));
    if (!(fabs(a - b) <= tolerance * scale))
        fail_msg("%.17g is not %.17g", a, b);
}

static softsh_light rectangle(const double center[3], const double half_u[3], const double half_v[3])
{
    softsh_light light = {.struct_size = sizeof(light), .shape = SOFTSH_LIGHT_RECTANGLE};
    memcpy(light.center, center, sizeof(light.center));
    memcpy(light.half_u, half_u, sizeof(light.half_u));
    memcpy(light.half_v, half_v, sizeof(light.half_v));
    return light;
}

static softsh_light directional(const double direction[3], double angular_radius)
{
    softsh_light light = {
        .struct_size = sizeof(light), .shape = SOFTSH_LIGHT_DIRECTIONAL, .angular_radius = angular_radius};
    memcpy(light.direction, direction, sizeof(light.direction));
    return light;
}

/* A random pose: eye, and the camera's right, down and forward axes in world space. */
typedef struct pose {
    double view[16], eye[3], right[3], down[3], forward[3];
} pose;

static pose random_pose(uint64_t *state, double offset)
{
    pose out;
    double target[3], up[3] = {0.3, 1.0, -0.2};
    for (int i = 0; i < 3; ++i) {
        out.eye[i] = offset + reference_random_range(state, -5.0, 5.0);
        target[i] = offset + reference_random_range(state, -5.0, 5.0);
    }
    target[2] += 20.0;
    reference_look_at(out.eye, target, up, out.view);
    for (int i = 0; i < 3; ++i) {
        out.right[i] = out.view[4 * i];
        out.down[i] = out.view[4 * i + 1];
        out.forward[i] = -out.view[4 * i + 2];
    }
    return out;
}

static void in_pose(const pose *p, double x, double y, double z, double out[3])
{
    reference_along(p->eye, x, p->right, out);
    reference_along(out, y, p->down, out);
    reference_along(out, z, p->forward, out);
}

static void random_bounds(uint64_t *state, double scale, double bounds[4])
{
    for (int i = 0; i < 4; ++i)
        bounds[i] = (i % 2 ? 1.0 : -1.0) * scale * reference_random_range(state, 0.3, 1.2);
}

static void inverse_times_matrix_is_identity(void **unused)
{
    (void)unused;
    uint64_t state = 1;
    for (int round = 0; round < 100; ++round) {
        double m[16], inverse[16], product[16];
        for (int i = 0; i < 16; ++i)
            m[i] = reference_random_range(&state, -2.0, 2.0);
        m[0] = round % 3 ? m[0] : 0.0; /* a zero first pivot */
        assert_true(reference_matrix_inverse(m, inverse));
        reference_matrix_multiply(m, inverse, product);
        for (int i = 0; i < 16; ++i)
            assert_near(product[i], i % 5 == 0 ? 1.0 : 0.0, 1e-9);
    }
    const double singular[16] = {1, 2, 3, 4, 2, 4, 6, 8, 0, 0, 1, 0, 0, 0, 0, 1};
    double inverse[16];
    assert_false(reference_matrix_inverse(singular, inverse));
}

static void perspective_depth_ranges_give_the_same_g(void **unused)
{
    (void)unused;
    uint64_t state = 2;
    const reference_depth_range ranges[] = {REFERENCE_DEPTH_NORMAL, REFERENCE_DEPTH_REVERSED, REFERENCE_DEPTH_INFINITE,
                                            REFERENCE_DEPTH_REVERSED_INFINITE};
    const double far_depths[] = {1.0, 0.0, 1.0, 0.0}, far_g[] = {1.0 / 50.0, 1.0 / 50.0, 0.0, 0.0};
    for (int k = 0; k < 4; ++k) {
        const pose p = random_pose(&state, 0.0);
        double projection[16], bounds[4];
        random_bounds(&state, 1.0, bounds);
        reference_perspective(bounds, 0.5, 50.0, ranges[k], projection);
        /* A projection means the same times any positive number. */
        for (int i = 0; i < 16; ++i)
            projection[i] *= 2.5;
        const softsh_light light = rectangle(p.eye, p.right, p.down);
        reference_map map;
        assert_true(reference_map_derive(&map, p.view, projection, 100, 60, &light));
        assert_true(map.far_depth == far_depths[k]);
        assert_near(reference_map_depth_to_g(&map, far_depths[k]), far_g[k], 1e-12);
        assert_near(reference_map_depth_to_g(&map, (double)NAN), far_g[k], 1e-12);
        assert_near(reference_map_depth_to_g(&map, 1.0 - far_depths[k]), 2.0, 1e-12);
        assert_near(reference_map_depth_to_g(&map, far_depths[k] > 0.5 ? -3.0 : 7.0), 2.0, 1e-12);
        for (int round = 0; round < 50; ++round) {
            const double z = reference_random_range(&state, 0.6, 49.0);
            const double x = z * reference_random_range(&state, -1.0, 1.0);
            double world[3], uvg[3], clip[4], back[3];
            in_pose(&p, x, 0.3 * z, z, world);
            assert_true(reference_map_project(&map, world, uvg));
            assert_near(uvg[0], 100.0 * (x / z - bounds[0]) / (bounds[1] - bounds[0]), 1e-10);
            assert_near(uvg[1], 60.0 * (0.3 - bounds[2]) / (bounds[3] - bounds[2]), 1e-10);
            assert_near(uvg[2], 1.0 / z, 1e-12);
            reference_matrix_apply(map.matrix, (const double[4]){world[0], world[1], world[2], 1.0}, clip);
            assert_near(reference_map_depth_to_g(&map, clip[2] / clip[3]), uvg[2], 1e-10);
            assert_near(reference_map_g_to_depth(&map, uvg[2]), clip[2] / clip[3], 1e-10);
            reference_map_unproject(&map, uvg, back);
            for (int i = 0; i < 3; ++i)
                assert_near(back[i], world[i], 1e-9);
        }
        double behind[3], uvg[3];
        in_pose(&p, 0.0, 0.0, -1.0, behind);
        assert_false(reference_map_project(&map, behind, uvg));
    }
}

static void orthographic_g_is_minus_z_either_way_round(void **unused)
{
    (void)unused;
    uint64_t state = 3;
    for (int k = 0; k < 4; ++k) {
        const pose p = random_pose(&state, 0.0);
        double projection[16], bounds[4], travel[3], uvg[3], world[3];
        random_bounds(&state, 8.0, bounds);
        reference_orthographic(bounds, -3.0, 30.0, k % 2 ? REFERENCE_DEPTH_REVERSED : REFERENCE_DEPTH_NORMAL,
                               projection);
        /* The light travels along the view, or (k >= 2) a map is looked at from behind. */
        const double sign = k < 2 ? 1.0 : -1.0;
        for (int i = 0; i < 3; ++i)
            travel[i] = sign * 3.0 * p.forward[i];
        const softsh_light light = directional(travel, 0.1);
        reference_map map;
        assert_true(reference_map_derive(&map, p.view, projection, 64, 64, &light));
        in_pose(&p, 1.0, 2.0, 5.0, world);
        assert_true(reference_map_project(&map, world, uvg));
        assert_near(uvg[2], sign * 8.5, 1e-11); /* from the middle of -3 to 30 */
        assert_near(uvg[0], 64.0 * (1.0 - bounds[0]) / (bounds[1] - bounds[0]), 1e-11);
        const double near_depth = k % 2 ? 1.0 : 0.0;
        assert_near(reference_map_depth_to_g(&map, near_depth), sign * 16.5, 1e-11);
        assert_near(reference_map_depth_to_g(&map, 1.0 - near_depth), sign * -16.5, 1e-11);
        assert_true(map.far_depth == (k < 2 ? 1.0 - near_depth : near_depth));
    }
}

/* Points on the world segment from receiver to light point, projected by the matrices, lie on the formula's line, and
 * back-project to that light point. */
static void check_segment(const reference_map *map, const double receiver[3], const double towards[3], double reach,
                          const double q[2])
{
    double uvg[3];
    assert_true(reference_map_project(map, receiver, uvg));
    for (int step = 1; step < 20; ++step) {
        double point[3], there[3], uv[2], back[2];
        reference_along(receiver, reach * step / 20.0, towards, point);
        if (!reference_map_project(map, point, there))
            continue; /* between the projection centre and a light point beside it */
        assert_true(there[2] > uvg[2]);
        reference_map_segment(map, uvg, q, there[2], uv);
        assert_near(uv[0], there[0], 1e-9);
        assert_near(uv[1], there[1], 1e-9);
        reference_map_backproject(map, uvg, there, back);
        assert_near(back[0], q[0], 1e-9);
        assert_near(back[1], q[1], 1e-9);
        assert_true(map->epsilon - map->delta * there[2] > 0.0);
    }
}

static void perspective_segments_are_straight(void **unused)
{
    (void)unused;
    uint64_t state = 4;
    for (int round = 0; round < 200; ++round) {
        const pose p = random_pose(&state, 0.0);
        double projection[16], bounds[4], center[3], half_u[3], half_v[3];
        random_bounds(&state, 1.0, bounds);
        reference_perspective(bounds, 0.3, 40.0, (reference_depth_range)(round % 4), projection);
        /* The light anywhere on a plane 0 to 2 in front of the projection centre, turned in that plane. */
        const double distance = round % 2 ? 0.0 : reference_random_range(&state, 0.1, 2.0);
        const double turn = reference_random_range(&state, 0.0, 6.3), aspect = reference_random_range(&state, 0.2, 1.0);
        in_pose(&p, reference_random_range(&state, -1.0, 1.0), 0.4, distance, center);
        for (int i = 0; i < 3; ++i) {
            half_u[i] = cos(turn) * p.right[i] + sin(turn) * p.down[i];
            half_v[i] = aspect * (-sin(turn) * p.right[i] + cos(turn) * p.down[i]);
        }
        const softsh_light light = rectangle(center, half_u, half_v);
        reference_map map;
        assert_true(reference_map_derive(&map, p.view, projection, 128, 80, &light));
        assert_near(map.delta, distance, 1e-12);
        assert_true(map.a[0][0] >= 0.0 && map.a[1][1] >= 0.0);
        assert_true(map.a[0][0] + map.a[1][1] >= fabs(map.a[0][1]) + fabs(map.a[1][0]));
        for (int ray = 0; ray < 10; ++ray) {
            const double z = reference_random_range(&state, 3.0, 30.0);
            const double q[2] = {reference_random_range(&state, -1.0, 1.0), reference_random_range(&state, -1.0, 1.0)};
            double receiver[3], point[3], towards[3];
            in_pose(&p, 0.8 * z * reference_random_range(&state, -1.0, 1.0), 0.2 * z, z, receiver);
            reference_map_light_point(&map, q, point);
            reference_along(point, -1.0, receiver, towards);
            check_segment(&map, receiver, towards, 1.0, q);
        }
    }
}

static void directional_rays_are_straight(void **unused)
{
    (void)unused;
    uint64_t state = 5;
    for (int round = 0; round < 100; ++round) {
        const pose p = random_pose(&state, 0.0);
        double projection[16], bounds[4], travel[3];
        random_bounds(&state, 10.0, bounds);
        reference_orthographic(bounds, 0.0, 30.0, (reference_depth_range)(round % 2), projection);
        memcpy(travel, p.forward, sizeof(travel));
        const double tilt = round % 3 ? 0.0 : 0.4;
        reference_along(travel, tilt, p.right, travel);
        const double radius = reference_random_range(&state, 0.005, 0.5);
        const softsh_light light = directional(travel, radius);
        reference_map map;
        assert_true(reference_map_derive(&map, p.view, projection, 64, 96, &light));
        assert_true(map.axis_aligned && map.a[0][0] > 0.0 && map.a[1][1] > 0.0);
        for (int ray = 0; ray < 10; ++ray) {
            const double q[2] = {reference_random_range(&state, -0.7, 0.7), reference_random_range(&state, -0.7, 0.7)};
            double receiver[3], towards[3];
            in_pose(&p, 1.0, reference_random_range(&state, -5.0, 5.0), reference_random_range(&state, 5.0, 29.0),
                    receiver);
            reference_map_light_point(&map, q, towards);
            check_segment(&map, receiver, towards, 10.0, q);
        }
        /* The rim of the disc is the angular radius away from the centre. */
        if (tilt > 0.0)
            continue;
        double rim[3];
        reference_map_light_point(&map, (const double[2]){0.6, -0.8}, rim);
        assert_near(reference_dot(rim, map.center) / sqrt(reference_dot(rim, rim)), cos(radius), 1e-12);
        assert_near(map.offset[0], 0.0, 1e-12);
        assert_near(map.offset[1], 0.0, 1e-12);
        assert_near(map.a[0][0], 64.0 / (bounds[1] - bounds[0]) * tan(radius), 1e-12);
    }
}

static void light_axes_are_seen_in_map_orientation(void **unused)
{
    (void)unused;
    const double eye[3] = {0, 0, 0}, target[3] = {0, 0, -1}, up[3] = {0, 1, 0};
    const double x[3] = {0.5, 0, 0}, y[3] = {0, 0.25, 0}, minus_x[3] = {-0.5, 0, 0}, minus_y[3] = {0, -0.25, 0};
    const double *const pairs[8][2] = {{x, y}, {x, minus_y}, {minus_x, y}, {minus_x, minus_y},
                                       {y, x}, {y, minus_x}, {minus_y, x}, {minus_y, minus_x}};
    double view[16], projection[16];
    reference_look_at(eye, target, up, view);
    reference_perspective(unit_bounds, 0.1, 10.0, REFERENCE_DEPTH_NORMAL, projection);
    for (int k = 0; k < 8; ++k) {
        const softsh_light light = rectangle(eye, pairs[k][0], pairs[k][1]);
        reference_map map;
        assert_true(reference_map_derive(&map, view, projection, 8, 4, &light));
        assert_true(map.axis_aligned);
        assert_near(map.a[0][0], 8.0 / 2.0 * 0.5, 1e-15);
        assert_near(map.a[1][1], 4.0 / 2.0 * 0.25, 1e-15);
        assert_near(fabs(map.a[0][1]) + fabs(map.a[1][0]), 0.0, 1e-15);
        /* s runs with u and t with v: v points down, against y. */
        assert_near(map.axis_s[0], 0.5, 1e-15);
        assert_near(map.axis_t[1], -0.25, 1e-15);
    }
}

/* Texels of another shape than the light decide by the sum of the diagonal, not by the smaller rotation; a line light
 * is a thousandth as wide as long. */
static void odd_lights_have_axes_too(void **unused)
{
    (void)unused;
    const double eye[3] = {0, 0, 0}, target[3] = {0, 0, -1}, up[3] = {0, 1, 0}, zero[3] = {0, 0, 0};
    const double x[3] = {0.5, 0, 0}, slanted[3] = {0.3, 0.4, 0}, across[3] = {-0.8, 0.6, 0};
    double view[16], projection[16];
    reference_look_at(eye, target, up, view);
    reference_perspective(unit_bounds, 0.1, 10.0, REFERENCE_DEPTH_NORMAL, projection);
    reference_map map;
    softsh_light light = rectangle(eye, slanted, across);
    /* 40 (0.3 0.8; 0.4 0.6), rows scaled by 4 and 1: 1.2 + 0.6 against 3.2 + 0.4. */
    assert_true(reference_map_derive(&map, view, projection, 80, 20, &light));
    assert_near(map.axis_s[0], 0.8, 1e-15);
    assert_near(map.axis_t[0], 0.3 * (slanted[1] * map.axis_t[1] > 0.0 ? 1.0 : -1.0), 1e-15);
    assert_true(map.a[0][0] > 0.0 && map.a[1][1] > 0.0 && !map.axis_aligned);
    for (int missing = 0; missing < 2; ++missing) {
        light = missing ? rectangle(eye, x, zero) : rectangle(eye, zero, x);
        assert_true(reference_map_derive(&map, view, projection, 8, 8, &light));
        assert_true(map.axis_aligned && !map.point);
        assert_near(map.a[0][0], 2.0, 1e-15);
        assert_near(map.a[1][1], 0.002, 1e-15);
    }
}

static void unusable_maps_are_refused(void **unused)
{
    (void)unused;
    const double eye[3] = {0, 0, 0}, target[3] = {0, 0, -1}, up[3] = {0, 1, 0}, zero[3] = {0, 0, 0};
    const double x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, z[3] = {0, 0, 1}, behind[3] = {0, 0, 1};
    double view[16], perspective[16], orthographic[16], oblique[16];
    reference_look_at(eye, target, up, view);
    reference_perspective(unit_bounds, 0.1, 10.0, REFERENCE_DEPTH_NORMAL, perspective);
    reference_orthographic(unit_bounds, 0.1, 10.0, REFERENCE_DEPTH_NORMAL, orthographic);
    memcpy(oblique, perspective, sizeof(oblique));
    oblique[2] = 0.1;
    reference_map map;
    softsh_light light = rectangle(eye, x, y);
    assert_true(reference_map_derive(&map, view, perspective, 4, 4, &light));
    assert_false(reference_map_derive(&map, view, orthographic, 4, 4, &light));
    assert_false(reference_map_derive(&map, view, oblique, 4, 4, &light));
    assert_false(reference_map_derive(&map, view, perspective, 0, 4, &light));
    light = rectangle(eye, x, z);
    assert_false(reference_map_derive(&map, view, perspective, 4, 4, &light));
    light = rectangle(behind, x, y);
    assert_false(reference_map_derive(&map, view, perspective, 4, 4, &light));
    light = rectangle(eye, zero, zero);
    assert_true(reference_map_derive(&map, view, perspective, 4, 4, &light) && map.point);
    light = directional(target, 0.1);
    assert_true(reference_map_derive(&map, view, orthographic, 4, 4, &light));
    assert_false(reference_map_derive(&map, view, perspective, 4, 4, &light));
    light = directional(x, 0.1);
    assert_false(reference_map_derive(&map, view, orthographic, 4, 4, &light));
    light = directional(zero, 0.1);
    assert_false(reference_map_derive(&map, view, orthographic, 4, 4, &light));
}

static void large_offsets_cancel(void **unused)
{
    (void)unused;
    const double eye[3] = {1e6, -2e6, 3e6}, target[3] = {1e6 + 1.0, -2e6 - 4.0, 3e6 + 0.5}, up[3] = {0, 0, 1};
    pose p;
    reference_look_at(eye, target, up, p.view);
    memcpy(p.eye, eye, sizeof(p.eye));
    for (int i = 0; i < 3; ++i) {
        p.right[i] = p.view[4 * i];
        p.down[i] = p.view[4 * i + 1];
        p.forward[i] = -p.view[4 * i + 2];
    }
    double projection[16];
    reference_perspective(unit_bounds, 0.1, 100.0, REFERENCE_DEPTH_NORMAL, projection);
    const softsh_light light = rectangle(p.eye, p.right, p.down);
    reference_map map;
    assert_true(reference_map_derive(&map, p.view, projection, 100, 100, &light));
    assert_near(map.offset[0], 0.0, 1e-6);
    double world[3], uvg[3];
    in_pose(&p, 0.5, -0.25, 2.0, world);
    assert_true(reference_map_project(&map, world, uvg));
    assert_near(uvg[0], 62.5, 1e-7);
    assert_near(uvg[1], 43.75, 1e-7);
    assert_near(uvg[2], 0.5, 1e-7);
}

/* Points of a world plane lie on g_p + gradient . ((u, v) - (u, v)_p). */
static void planes_are_affine(void **unused)
{
    (void)unused;
    uint64_t state = 6;
    for (int round = 0; round < 100; ++round) {
        const pose p = random_pose(&state, 0.0);
        double projection[16], bounds[4];
        const bool perspective = round % 2 == 0;
        random_bounds(&state, perspective ? 1.0 : 10.0, bounds);
        softsh_light light;
        if (perspective) {
            reference_perspective(bounds, 0.1, 40.0, (reference_depth_range)(round / 2 % 4), projection);
            light = rectangle(p.eye, p.right, p.down);
        } else {
            reference_orthographic(bounds, 0.1, 40.0, (reference_depth_range)(round / 2 % 2), projection);
            light = directional(p.forward, 0.2);
        }
        reference_map map;
        assert_true(reference_map_derive(&map, p.view, projection, 50, 70, &light));
        double base[3], normal[3], across[2][3], uvg[3], gradient[2];
        in_pose(&p, 0.3, -0.2, 10.0, base);
        for (int i = 0; i < 3; ++i)
            normal[i] = reference_random_range(&state, -1.0, 1.0) - 1.5 * p.forward[i];
        assert_true(reference_map_project(&map, base, uvg));
        reference_plane_gradient(&map, uvg, normal, gradient);
        reference_cross(normal, p.right, across[0]);
        reference_cross(normal, across[0], across[1]);
        for (int k = 0; k < 10; ++k) {
            double point[3], there[3];
            reference_along(base, reference_random_range(&state, -0.5, 0.5), across[0], point);
            reference_along(point, reference_random_range(&state, -0.2, 0.2), across[1], point);
            assert_true(reference_map_project(&map, point, there));
            assert_near(there[2], uvg[2] + gradient[0] * (there[0] - uvg[0]) + gradient[1] * (there[1] - uvg[1]), 1e-9);
        }
    }
}

static void gradients_stop_at_a_steep_slope(void **unused)
{
    (void)unused;
    const double eye[3] = {0, 0, 0}, target[3] = {0, 0, -1}, up[3] = {0, 1, 0}, x[3] = {1, 0, 0}, y[3] = {0, 1, 0};
    double view[16], projection[16], gradient[2] = {1e9, -1e9};
    reference_look_at(eye, target, up, view);
    reference_map map;
    reference_perspective((const double[4]){-1, 1, -2, 2}, 0.1, 10.0, REFERENCE_DEPTH_NORMAL, projection);
    for (int i = 0; i < 16; ++i)
        projection[i] *= 3.0;
    softsh_light light = rectangle(eye, x, y);
    assert_true(reference_map_derive(&map, view, projection, 10, 10, &light));
    assert_near(map.texel[0], 0.2, 1e-15);
    assert_near(map.texel[1], 0.4, 1e-15);
    reference_gradient_clamp(&map, 0.25, gradient);
    assert_near(gradient[0], 114.0 * 0.25 * 0.2, 1e-12);
    assert_near(gradient[1], -114.0 * 0.25 * 0.4, 1e-12);
    /* On the axis that is the plane whose depth changes by 114 per unit sideways. */
    double free_gradient[2];
    reference_plane_gradient(&map, (const double[3]){5.0, 5.0, 0.25}, (const double[3]){114.0, 0.0, 1.0},
                             free_gradient);
    assert_near(fabs(free_gradient[0]), gradient[0], 1e-12);
    gradient[0] = (double)NAN;
    reference_gradient_clamp(&map, 0.25, gradient);
    assert_true(gradient[0] == 0.0);

    reference_orthographic((const double[4]){-1, 1, -2, 2}, 0.1, 10.0, REFERENCE_DEPTH_NORMAL, projection);
    light = directional(target, 0.1);
    assert_true(reference_map_derive(&map, view, projection, 10, 10, &light));
    gradient[0] = -1e9;
    reference_gradient_clamp(&map, -7.0, gradient);
    assert_near(gradient[0], -114.0 * 0.2, 1e-12);
    reference_plane_gradient(&map, (const double[3]){5.0, 5.0, -7.0}, (const double[3]){114.0, 0.0, 1.0},
                             free_gradient);
    assert_near(fabs(free_gradient[0]), 114.0 * 0.2, 1e-12);
}

/* A floor 4 below a lamp that looks down, seen by a camera beside it. */
typedef struct stage {
    reference_map map;
    reference_camera camera;
    double camera_view[16], camera_projection[16];
    float depth[12 * 8], normals[3 * 12 * 8];
} stage;

static void build_stage(stage *s, reference_depth_range range)
{
    const double lamp[3] = {0, 4, 0}, floor_point[3] = {0, 0, 0}, north[3] = {0, 0, -1}, up[3] = {0, 1, 0};
    const double half_u[3] = {0.5, 0, 0}, half_v[3] = {0, 0, 0.5}, camera_eye[3] = {0.5, 3, 4};
    double view[16], projection[16];
    reference_look_at(lamp, floor_point, north, view);
    reference_perspective((const double[4]){-3, 3, -3, 3}, 0.1, 20.0, REFERENCE_DEPTH_NORMAL, projection);
    const softsh_light light = rectangle(lamp, half_u, half_v);
    assert_true(reference_map_derive(&s->map, view, projection, 64, 64, &light));
    reference_look_at(camera_eye, floor_point, up, s->camera_view);
    reference_perspective((const double[4]){-0.6, 0.6, -0.4, 0.4}, 0.2, 30.0, range, s->camera_projection);
    assert_true(reference_camera_derive(&s->camera, s->camera_view, s->camera_projection, 12, 8));
    const reference_surface ground = {.u = {1, 0, 0.3}, .v = {0, 0, 1}, .center = {0, 0, 0}, .infinite = true};
    reference_cast(s->camera_view, s->camera_projection, 12, 8, s->camera.far_depth, REFERENCE_FORMAT_EXACT, &ground, 1,
                   s->depth, NULL);
    for (int i = 0; i < 12 * 8; ++i) {
        s->normals[3 * i] = 0.0f;
        s->normals[3 * i + 1] = 2.5f;
        s->normals[3 * i + 2] = 0.0f;
    }
}

static const reference_bias exact_bias = {.map_precision = REFERENCE_PRECISION,
                                          .camera_precision = REFERENCE_PRECISION};

static void camera_pixels_become_receivers(void **unused)
{
    (void)unused;
    stage s;
    for (int range = 0; range < 4; ++range) {
        build_stage(&s, (reference_depth_range)range);
        assert_true(s.camera.far_depth == (range % 2 ? 0.0 : 1.0));
        const reference_camera_image with_normals = {s.depth, s.normals}, without = {s.depth, NULL};
        for (uint32_t y = 0; y < 8; ++y) {
            for (uint32_t x = 0; x < 12; ++x) {
                reference_receiver a, b;
                double world[3];
                reference_receiver_derive(&a, &s.map, &s.camera, &with_normals, &exact_bias, x, y);
                reference_receiver_derive(&b, &s.map, &s.camera, &without, &exact_bias, x, y);
                assert_int_equal(a.state, REFERENCE_RECEIVER_ACTIVE);
                assert_int_equal(b.state, REFERENCE_RECEIVER_ACTIVE);
                reference_map_unproject(&s.map, a.uvg, world);
                assert_near(world[1], 0.0, 1e-4);
                assert_near(a.uvg[2], 0.25, 1e-5);
                /* The floor is parallel to the image plane. */
                assert_near(a.gradient[0], 0.0, 1e-12);
                assert_near(a.gradient[1], 0.0, 1e-12);
                assert_near(b.gradient[0], 0.0, 1e-5);
                assert_near(b.gradient[1], 0.0, 1e-5);
            }
        }
    }
}

/* How far from its plane a receiver gets by an error of the camera's depth, against two points of the pixel's ray. */
static void bias_covers_the_camera_depth(void **unused)
{
    (void)unused;
    stage s;
    build_stage(&s, REFERENCE_DEPTH_NORMAL);
    const double step = 1e-7;
    for (uint32_t x = 0; x < 12; ++x) {
        const reference_camera_image image = {s.depth, s.normals};
        double low[3], high[3], unused_derivative[3], uvg[2][3];
        const double depth = (double)s.depth[3 * 12 + x];
        s.normals[3 * (3 * 12 + x)] = 0.05f * (float)x;
        s.normals[3 * (3 * 12 + x) + 2] = -0.7f;
        assert_true(reference_camera_unproject(&s.camera, x, 3, depth - step, low, unused_derivative));
        assert_true(reference_camera_unproject(&s.camera, x, 3, depth + step, high, unused_derivative));
        assert_true(reference_map_project(&s.map, low, uvg[0]) && reference_map_project(&s.map, high, uvg[1]));
        const reference_bias bias = {.map_precision = 0.0, .camera_precision = 1.0};
        reference_receiver receiver;
        reference_receiver_derive(&receiver, &s.map, &s.camera, &image, &bias, x, 3);
        assert_int_equal(receiver.state, REFERENCE_RECEIVER_ACTIVE);
        assert_true(fabs(receiver.gradient[1]) > 1e-4);
        double away = uvg[1][2] - uvg[0][2];
        for (int i = 0; i < 2; ++i)
            away -= receiver.gradient[i] * (uvg[1][i] - uvg[0][i]);
        assert_near(receiver.eta - ldexp(0.25, -20), fabs(away) / (2.0 * step), 1e-5);
    }
}

static void orthographic_cameras_have_right_down_and_forward(void **unused)
{
    (void)unused;
    stage s;
    build_stage(&s, REFERENCE_DEPTH_NORMAL);
    for (int reversed = 0; reversed < 2; ++reversed) {
        double projection[16], world[3], derivative[3], view_point[4];
        reference_orthographic((const double[4]){-6, 6, -4, 4}, 1.0, 11.0, (reference_depth_range)reversed, projection);
        assert_true(reference_camera_derive(&s.camera, s.camera_view, projection, 12, 8));
        assert_true(s.camera.far_depth == (reversed ? 0.0 : 1.0));
        assert_false(reference_camera_unproject(&s.camera, 0, 0, s.camera.far_depth, world, derivative));
        assert_true(reference_camera_unproject(&s.camera, 7, 5, reversed ? 0.75 : 0.25, world, derivative));
        reference_matrix_apply(s.camera_view, (const double[4]){world[0], world[1], world[2], 1.0}, view_point);
        assert_near(view_point[0], 1.5, 1e-12);
        assert_near(view_point[1], 1.5, 1e-12);
        assert_near(view_point[2], -3.5, 1e-12);
        assert_near(sqrt(reference_dot(derivative, derivative)), 10.0, 1e-12);
        /* The same camera with the halves of its transform swapped: a view that looks along +z. */
        double flipped_view[16], flipped_projection[16];
        for (int i = 0; i < 16; ++i) {
            flipped_view[i] = s.camera_view[i] * (i % 4 == 1 || i % 4 == 2 ? -1.0 : 1.0);
            flipped_projection[i] = projection[i] * (i / 4 == 1 || i / 4 == 2 ? -1.0 : 1.0);
        }
        assert_true(reference_camera_derive(&s.camera, flipped_view, flipped_projection, 12, 8));
        assert_true(s.camera.far_depth == (reversed ? 0.0 : 1.0));
    }
}

static void what_is_no_receiver(void **unused)
{
    (void)unused;
    stage s;
    reference_receiver receiver;
    const reference_camera_image image = {s.depth, s.normals};
    for (int range = 0; range < 4; ++range) {
        build_stage(&s, (reference_depth_range)range);
        s.depth[0] = (float)s.camera.far_depth;
        s.depth[1] = NAN;
        s.depth[2] = s.camera.far_depth > 0.5 ? 1.5f : -0.5f;
        for (uint32_t x = 0; x < 3; ++x) {
            reference_receiver_derive(&receiver, &s.map, &s.camera, &image, &exact_bias, x, 0);
            assert_int_equal(receiver.state, REFERENCE_RECEIVER_NONE);
        }
        /* The camera is in front of the lamp's map, its near plane outside of it. */
        s.depth[3] = (float)(1.0 - s.camera.far_depth);
        reference_receiver_derive(&receiver, &s.map, &s.camera, &image, &exact_bias, 3, 0);
        assert_int_equal(receiver.state, REFERENCE_RECEIVER_NONE);
    }
    /* All of the light on the back of the plane; then one corner of it in front. */
    build_stage(&s, REFERENCE_DEPTH_NORMAL);
    for (int i = 0; i < 96; ++i)
        s.normals[3 * i + 1] = -1.0f;
    reference_receiver_derive(&receiver, &s.map, &s.camera, &image, &exact_bias, 6, 4);
    assert_int_equal(receiver.state, REFERENCE_RECEIVER_AWAY);
    const double normal_in[3] = {0.9, -0.1, 0.0}, normal_out[3] = {0.5, -0.2, 0.0}, origin[3] = {0, 0, 0};
    assert_false(reference_map_light_behind(&s.map, origin, normal_in)); /* 0.9 * 0.5 - 0.1 * 4 > 0 */
    assert_true(reference_map_light_behind(&s.map, origin, normal_out)); /* 0.5 * 0.5 - 0.2 * 4 < 0 */
}

static void neighbours_across_edges_are_left_out(void **unused)
{
    (void)unused;
    stage s;
    build_stage(&s, REFERENCE_DEPTH_NORMAL);
    const reference_camera_image image = {s.depth, NULL};
    reference_receiver receiver;
    /* A jump on one side of each axis, background on the other axis's side: the plane is still the floor's. */
    s.depth[4 * 12 + 5] = s.depth[4 * 12 + 5] - 0.01f;
    s.depth[5 * 12 + 6] = 1.0f;
    reference_receiver_derive(&receiver, &s.map, &s.camera, &image, &exact_bias, 6, 4);
    assert_near(receiver.gradient[0], 0.0, 1e-5);
    assert_near(receiver.gradient[1], 0.0, 1e-5);
    /* No neighbour on an axis: no plane. */
    s.depth[3 * 12 + 6] = 1.0f;
    s.depth[4 * 12 + 7] = s.depth[4 * 12 + 7] - 0.01f;
    reference_receiver_derive(&receiver, &s.map, &s.camera, &image, &exact_bias, 6, 4);
    assert_int_equal(receiver.state, REFERENCE_RECEIVER_ACTIVE);
    assert_true(receiver.gradient[0] == 0.0 && receiver.gradient[1] == 0.0);
}

/* All four neighbours on the plane, within the depths' precision and 3 % of their own slope. */
static void planes_are_smooth_if_all_neighbours_agree(void **unused)
{
    (void)unused;
    const double gradient[2] = {0.1, -0.2}, eta = 0.001;
    const double flat[4][3] = {{-1, 0, -0.1}, {1, 0.5, 0.0}, {0, -1, 0.2}, {0.5, 1, -0.15}};
    const double room[4] = {0.004 + 0.003, 0.004 + 0.006, 0.004 + 0.006, 0.004 + 0.0075};
    assert_true(reference_plane_smooth(flat, gradient, eta));
    for (int k = 0; k < 4; ++k) {
        for (int sign = -1; sign <= 1; sign += 2) {
            double bent[4][3];
            memcpy(bent, flat, sizeof(bent));
            bent[k][2] = flat[k][2] + sign * (room[k] - 1e-9);
            assert_true(reference_plane_smooth((const double(*)[3])bent, gradient, eta));
            bent[k][2] = flat[k][2] + sign * (room[k] + 1e-9);
            assert_false(reference_plane_smooth((const double(*)[3])bent, gradient, eta));
        }
    }
}

/* What of the light lies behind a plane: against counting points of the light, from rays in map space. */
static void horizons_are_shares_of_the_light(void **unused)
{
    (void)unused;
    uint64_t state = 23;
    for (int round = 0; round < 400; ++round) {
        stage s;
        build_stage(&s, REFERENCE_DEPTH_NORMAL);
        const double uvg[3] = {reference_random_range(&state, 0, s.map.width),
                               reference_random_range(&state, 0, s.map.height), 0.05};
        double gradient[2];
        for (int i = 0; i < 2; ++i)
            gradient[i] =
                reference_random_range(&state, -1, 1) * pow(10, reference_random_range(&state, -3, 2)) / s.map.a[0][0];
        int behind = 0;
        const int n = 64;
        for (int j = 0; j < n * n; ++j) {
            const double q[2] = {(2 * (j % n) + 1.0) / n - 1, (2 * (j / n) + 1.0) / n - 1};
            double uv[2];
            reference_map_segment(&s.map, uvg, q, uvg[2] + 1e-3, uv);
            behind += uvg[2] + gradient[0] * (uv[0] - uvg[0]) + gradient[1] * (uv[1] - uvg[1]) >= uvg[2] + 1e-3;
        }
        const double share = reference_horizon(&s.map, uvg, gradient, 1);
        assert_near(share, behind / (double)(n * n), 2.0 / n);
        assert_near(reference_horizon(&s.map, uvg, gradient, -1), 1.0 - share, 1e-12);
    }
}

/* The camera's side of a plane and the normal's are the same, and the floor's is the light's. */
static void surfaces_have_a_front(void **unused)
{
    (void)unused;
    static const reference_depth_range ranges[] = {REFERENCE_DEPTH_NORMAL, REFERENCE_DEPTH_REVERSED};
    for (size_t k = 0; k < sizeof(ranges) / sizeof(ranges[0]); ++k) {
        stage s;
        build_stage(&s, ranges[k]);
        const reference_camera_image image = {s.depth, NULL}, with_normals = {s.depth, s.normals};
        for (uint32_t y = 0; y < 8; ++y) {
            for (uint32_t x = 0; x < 12; ++x) {
                reference_receiver receiver;
                reference_receiver_derive(&receiver, &s.map, &s.camera, &image, &exact_bias, x, y);
                assert_int_equal(receiver.side, 1);
                assert_true(receiver.horizon == 0.0);
                reference_receiver_derive(&receiver, &s.map, &s.camera, &with_normals, &exact_bias, x, y);
                assert_int_equal(receiver.side, 1);
            }
        }
    }
}

static void receivers_behind_the_light_are_known(void **unused)
{
    (void)unused;
    stage s;
    build_stage(&s, REFERENCE_DEPTH_NORMAL);
    /* The projection centre 4 behind a lamp that is level with the floor. */
    const double eye[3] = {0, 4, 0}, lamp[3] = {0, 0.001, 0}, down[3] = {0, 0, 0}, north[3] = {0, 0, -1};
    const double half_u[3] = {0.5, 0, 0}, half_v[3] = {0, 0, 0.5};
    double view[16], projection[16];
    reference_look_at(eye, down, north, view);
    reference_perspective(unit_bounds, 0.1, 20.0, REFERENCE_DEPTH_NORMAL, projection);
    for (int below = 0; below < 2; ++below) {
        const double center[3] = {0, below ? -lamp[1] : lamp[1], 0};
        const softsh_light light = rectangle(center, half_u, half_v);
        assert_true(reference_map_derive(&s.map, view, projection, 64, 64, &light));
        const reference_camera_image image = {s.depth, NULL};
        reference_receiver receiver;
        reference_receiver_derive(&receiver, &s.map, &s.camera, &image, &exact_bias, 6, 4);
        assert_int_equal(receiver.state, below ? REFERENCE_RECEIVER_BEHIND : REFERENCE_RECEIVER_ACTIVE);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(inverse_times_matrix_is_identity),
        cmocka_unit_test(perspective_depth_ranges_give_the_same_g),
        cmocka_unit_test(orthographic_g_is_minus_z_either_way_round),
        cmocka_unit_test(perspective_segments_are_straight),
        cmocka_unit_test(directional_rays_are_straight),
        cmocka_unit_test(light_axes_are_seen_in_map_orientation),
        cmocka_unit_test(odd_lights_have_axes_too),
        cmocka_unit_test(unusable_maps_are_refused),
        cmocka_unit_test(large_offsets_cancel),
        cmocka_unit_test(planes_are_affine),
        cmocka_unit_test(gradients_stop_at_a_steep_slope),
        cmocka_unit_test(camera_pixels_become_receivers),
        cmocka_unit_test(bias_covers_the_camera_depth),
        cmocka_unit_test(orthographic_cameras_have_right_down_and_forward),
        cmocka_unit_test(what_is_no_receiver),
        cmocka_unit_test(neighbours_across_edges_are_left_out),
        cmocka_unit_test(planes_are_smooth_if_all_neighbours_agree),
        cmocka_unit_test(horizons_are_shares_of_the_light),
        cmocka_unit_test(surfaces_have_a_front),
        cmocka_unit_test(receivers_behind_the_light_are_known),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
