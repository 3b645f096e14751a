/* Fold-safe contours hide what exact microquads hide, with few primitives. Every case has a fixed seed. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "contour_case.h"
#include "reference_fold.h"
#include "reference_matrix.h"
#include "reference_outline.h"
#include "reference_polygon.h"

static void evaluate_outline(const reference_map *map, const reference_settings *settings, const float *g,
                             const reference_receiver *receiver, bool walk, reference_occlusion *out, size_t counts[2])
{
    reference_dual_grid grid;
    reference_outline outline = {0};
    assert_true(reference_dual_grid_create(&grid, map, settings, g));
    const reference_rect range =
        walk ? reference_dual_grid_kernel(&grid, map, settings, receiver, highest(&grid)) : all_samples(&grid);
    assert_true(reference_outline_extract(&grid, map, settings, receiver, 1, range,
                                          walk ? REFERENCE_EXTRACT_WALK : REFERENCE_EXTRACT_SCAN, NULL, &outline));
    reference_outline_occlusion(&grid, map, settings, receiver, &outline, out);
    counts[0] += outline.edge_count;
    counts[1] += outline.bridge_count;
    reference_outline_free(&outline);
    reference_dual_grid_destroy(&grid);
}

static void fold_safe_contours_hide_what_microquads_hide(void **unused)
{
    (void)unused;
    static float g[texels];
    uint64_t state = 7;
    uint32_t penumbra = 0;
    size_t counts[2] = {0};
    for (int round = 0; round < 2400; ++round) {
        const double light_size = round % 8 < 4 ? 0.6 : reference_random_range(&state, 0.05, 2.0);
        const reference_map map = build_map((setup_kind)(round % setup_count), light_size, 0);
        const reference_settings settings = random_settings(&state, SOFTSH_PRIMITIVE_MICROQUAD);
        const float *const layers[1] = {g};
        reference_occlusion quads, outline;
        if (round % 4 == 0)
            random_map(&state, &map, g);
        else
            random_map(&(uint64_t){(uint64_t)round / 4}, &map, g);
        const reference_receiver receiver = random_receiver(&state, &map);
        assert_true(reference_visibility(&map, layers, 1, &settings, &receiver, &quads));
        for (int walk = 0; walk < 2; ++walk) {
            evaluate_outline(&map, &settings, g, &receiver, walk, &outline, counts);
            if (!same_masks(&quads, &outline))
                fail_msg("round %d: %u samples, microquads hide %u", round, outline.occluded, quads.occluded);
        }
        penumbra += in_penumbra(&quads);
    }
    assert_true(penumbra > 400);
    assert_true(counts[0] > 10000 && counts[1] > 10000);
}

/* Area: that of every quad within the light, added up. */
static void outlines_have_the_area_of_their_quads(void **unused)
{
    (void)unused;
    static float g[texels];
    uint64_t state = 8;
    for (int round = 0; round < 300; ++round) {
        const reference_map map = build_map((setup_kind)(round % setup_count), 0.6, 0);
        const reference_settings settings = random_settings(&state, SOFTSH_PRIMITIVE_MICROQUAD);
        const reference_receiver receiver = random_receiver(&state, &map);
        const double raised[3] = {receiver.uvg[0], receiver.uvg[1], reference_raised_g(&map, &settings, &receiver)};
        const double side = reference_area_side(&map);
        size_t counts[2] = {0};
        double sum = 0.0;
        reference_dual_grid grid;
        reference_occlusion outline;
        random_map(&state, &map, g);
        evaluate_outline(&map, &settings, g, &receiver, true, &outline, counts);
        assert_true(reference_dual_grid_create(&grid, &map, &settings, g));
        for (int32_t y = 0; y + 1 < (int32_t)grid.rows; ++y) {
            for (int32_t x = 0; x + 1 < (int32_t)grid.columns; ++x) {
                double q[4][2], area = 0.0;
                bool all = true;
                for (int k = 0; k < 4 && all; ++k) {
                    const double *const place = reference_dual_grid_place(&grid, x + (k == 1 || k == 2), y + (k >= 2));
                    all = reference_occludes(&map, &settings, &receiver, place);
                    if (all)
                        reference_map_backproject(&map, raised, place, q[k]);
                }
                for (int k = 0; k < 4 && all; ++k)
                    area += reference_edge_area(q[k], q[(k + 1) % 4], side);
                sum += fabs(area) / (4.0 * side * side);
            }
        }
        if (!(fabs(sum - outline.area) < 1e-7 * (1.0 + sum)))
            fail_msg("round %d: %.17g, quads have %.17g", round, outline.area, sum);
        reference_dual_grid_destroy(&grid);
    }
}

/* A quad folds where the light reaches behind a plane that rises as steeply as a ray. */
static void quads_fold_where_the_light_is_behind_them(void **unused)
{
    (void)unused;
    uint64_t state = 9;
    uint32_t smooth = 0, folded = 0, seen_folded = 0;
    const reference_map aligned = build_map(setup_on_light, 0.6, 0);
    for (int k = 0; k < 4; ++k) {
        const double rise = (k % 2 ? 1.001 : 0.999) / aligned.a[k / 2][k / 2];
        double corner[4][3];
        const double *corners[4];
        for (int i = 0; i < 4; ++i) {
            const double u = i == 1 || i == 2, v = i >= 2, place[3] = {4.5 + u, 4.5 + v, 0.2 + rise * (k / 2 ? v : u)};
            memcpy(corner[i], place, sizeof(place));
            corners[i] = corner[i];
        }
        assert_int_equal(reference_folds(&aligned, corners), k % 2);
    }
    for (int round = 0; round < 6000; ++round) {
        const reference_map map = build_map((setup_kind)(round % setup_count), 0.6, 0);
        const double step = fan_depth(&map, 1.0) - fan_depth(&map, 0.0);
        double corner[4][3], low = INFINITY;
        const double *corners[4];
        const double middle = reference_random_range(&state, 0.3, 0.8);
        const double u = reference_random_range(&state, 0, width), v = reference_random_range(&state, 0, height);
        for (int i = 0; i < 4; ++i) {
            const double rough = step * reference_random_range(&state, -0.1, 0.1);
            const double place[3] = {u + (i == 1 || i == 2), v + (i >= 2), fan_depth(&map, middle) + rough};
            memcpy(corner[i], place, sizeof(place));
            corners[i] = corner[i];
            low = fmin(low, place[2]);
        }
        const bool folds = reference_folds(&map, corners);
        smooth += !folds;
        folded += folds;
        /* Receivers that see the quad somewhere before the light, from close by to far away. */
        for (int k = 0; k < 20; ++k) {
            const double q[2] = {reference_random_range(&state, -1, 1), reference_random_range(&state, -1, 1)};
            const double distance = pow(10.0, reference_random_range(&state, -3, 0)) * step;
            double receiver[3] = {u + 0.5, v + 0.5, low}, points[4][2], uv[2];
            /* Backwards along the ray. */
            reference_map_segment(&map, receiver, q, low - distance, uv);
            memcpy(receiver, uv, sizeof(uv));
            receiver[2] = low - distance;
            reference_polygons polygons;
            reference_occlusion unused_occlusion;
            reference_polygons_begin(&polygons, &map, SOFTSH_PATTERN_16X16);
            for (int i = 0; i < 4; ++i)
                reference_map_backproject(&map, receiver, corner[i], points[i]);
            for (int i = 0; i < 4; ++i)
                reference_polygons_add(&polygons, points[i], points[(i + 1) % 4]);
            reference_polygons_end(&polygons, &unused_occlusion);
            int32_t lowest = 0;
            for (uint32_t bit = 0; bit < 256; ++bit)
                if (reference_pattern_counted(SOFTSH_PATTERN_16X16, map.directional, bit % 16, bit / 16) &&
                    polygons.winding[bit] < lowest)
                    lowest = polygons.winding[bit];
            assert_true(folds || lowest == 0);
            seen_folded += lowest < 0;
        }
    }
    assert_true(smooth > 1000 && folded > 1000 && seen_folded > 1000);
}

/* Map and receiver moved by whole texels; without delta the light is where it was. */
static void moving_by_whole_texels_changes_nothing(void **unused)
{
    (void)unused;
    static float g[2][texels];
    uint64_t state = 10;
    for (int round = 0; round < 200; ++round) {
        const reference_map map = build_map(round % 2 ? setup_on_light : setup_directional, 0.4, 0);
        const reference_settings settings = {.primitive = SOFTSH_PRIMITIVE_MICROQUAD};
        const int du = (int)(reference_random(&state) % 7), dv = (int)(reference_random(&state) % 7);
        /* Only the middle is not the floor. */
        random_map(&state, &map, g[0]);
        for (int i = 0; i < texels; ++i) {
            const int x = i % width, y = i / width;
            if (x < 6 || y < 6 || x >= width - 8 || y >= height - 8)
                g[0][i] = (float)fan_depth(&map, 0.0);
            g[1][i] = (float)fan_depth(&map, 0.0);
        }
        for (int y = 0; y + dv < height; ++y)
            for (int x = 0; x + du < width; ++x)
                g[1][(y + dv) * width + x + du] = g[0][y * width + x];
        reference_receiver receivers[2];
        receivers[0] = random_receiver(&state, &map);
        /* Dyadic, so that moving is exact. */
        for (int axis = 0; axis < 2; ++axis)
            receivers[0].uvg[axis] = floor(64.0 * receivers[0].uvg[axis]) / 64.0;
        receivers[1] = receivers[0];
        receivers[1].uvg[0] += du;
        receivers[1].uvg[1] += dv;
        reference_occlusion contours[2], outlines[2];
        size_t edges[2] = {0}, counts[2][2] = {{0}};
        for (int k = 0; k < 2; ++k) {
            reference_dual_grid grid;
            reference_contour contour = {0};
            assert_true(reference_dual_grid_create(&grid, &map, &settings, g[k]));
            assert_true(reference_contour_extract(&grid, &map, &settings, &receivers[k], 1, all_samples(&grid),
                                                  REFERENCE_EXTRACT_WALK, NULL, &contour));
            reference_contour_occlusion(&grid, &map, &settings, &receivers[k], &contour, &contours[k]);
            edges[k] = contour.count;
            reference_contour_free(&contour);
            reference_dual_grid_destroy(&grid);
            evaluate_outline(&map, &settings, g[k], &receivers[k], false, &outlines[k], counts[k]);
        }
        assert_int_equal(edges[0], edges[1]);
        assert_int_equal(counts[0][0], counts[1][0]);
        assert_int_equal(counts[0][1], counts[1][1]);
        assert_true(same_masks(&contours[0], &contours[1]) && same_masks(&outlines[0], &outlines[1]));
        assert_true(fabs(contours[0].area - contours[1].area) < 1e-9);
        assert_true(fabs(outlines[0].area - outlines[1].area) < 1e-9);
    }
}

static void turning_the_light_by_a_right_angle_changes_nothing(void **unused)
{
    (void)unused;
    static float g[texels];
    uint64_t state = 11;
    for (int round = 0; round < 100; ++round) {
        const setup_kind kind = (setup_kind)(round % setup_directional);
        reference_settings settings = random_settings(&state, SOFTSH_PRIMITIVE_MICROQUAD);
        reference_occlusion first[2], next[2];
        reference_receiver receiver;
        size_t counts[2] = {0};
        for (int turn = 0; turn < 4; ++turn) {
            const reference_map map = build_map(kind, 0.6, turn);
            if (turn == 0) {
                random_map(&state, &map, g);
                receiver = random_receiver(&state, &map);
            }
            reference_dual_grid grid;
            reference_contour contour = {0};
            assert_true(reference_dual_grid_create(&grid, &map, &settings, g));
            assert_true(reference_contour_extract(&grid, &map, &settings, &receiver, 1, all_samples(&grid),
                                                  REFERENCE_EXTRACT_WALK, NULL, &contour));
            reference_contour_occlusion(&grid, &map, &settings, &receiver, &contour, &next[0]);
            reference_contour_free(&contour);
            reference_dual_grid_destroy(&grid);
            evaluate_outline(&map, &settings, g, &receiver, true, &next[1], counts);
            for (int k = 0; k < 2; ++k) {
                if (turn == 0)
                    first[k] = next[k];
                assert_true(same_masks(&first[k], &next[k]) && fabs(first[k].area - next[k].area) < 1e-9);
            }
        }
    }
}

/* Balls over a floor: what is looked at and what is projected, against the texels of the kernel. */
static void primitives_are_few(void **unused)
{
    (void)unused;
    enum { side = 192 };
    static float g[side * side];
    const double up[3] = {0, 1, 0}, eye[3] = {0, 0, 0}, target[3] = {0, 0, -1}, bounds[4] = {-0.6, 0.6, -0.6, 0.6};
    softsh_light light = {.struct_size = sizeof(light), .shape = SOFTSH_LIGHT_RECTANGLE};
    double view[16], projection[16];
    reference_map map;
    light.half_u[0] = light.half_v[1] = 0.8;
    reference_look_at(eye, target, up, view);
    reference_perspective(bounds, 0.5, 40.0, REFERENCE_DEPTH_NORMAL, projection);
    assert_true(reference_map_derive(&map, view, projection, side, side, &light));
    for (int i = 0; i < side * side; ++i) {
        /* The ray through the texel, against nine balls of radius 0.8 at distance 6 and four at 4.5. */
        const double ray[3] = {1.2 * (i % side + 0.5) / side - 0.6, 1.2 * (i / side + 0.5) / side - 0.6, 1.0};
        double nearest = 9.0;
        for (int ball = 0; ball < 13; ++ball) {
            const double c[3] = {ball < 9 ? ball % 3 * 2.2 - 2.2 : (ball - 9) % 2 * 2.2 - 1.1,
                                 ball < 9 ? ball / 3 * 2.2 - 2.2 : (ball - 9) / 2 * 2.2 - 1.1, ball < 9 ? 6.0 : 4.5};
            const double a = reference_dot(ray, ray), b = reference_dot(ray, c), d = reference_dot(c, c) - 0.64;
            const double root = b * b - a * d;
            if (root > 0.0)
                nearest = fmin(nearest, (b - sqrt(root)) / a);
        }
        g[i] = (float)(1.0 / nearest);
    }
    const reference_settings settings = {.primitive = SOFTSH_PRIMITIVE_MICROQUAD};
    const float *const layers[1] = {g};
    reference_dual_grid grid;
    uint64_t state = 12, kernel_texels = 0, edges = 0, bridges = 0, visited = 0, contour_edges = 0;
    uint32_t penumbra = 0;
    assert_true(reference_dual_grid_create(&grid, &map, &settings, g));
    while (penumbra < 100) {
        const reference_receiver receiver = {
            .state = REFERENCE_RECEIVER_ACTIVE,
            .uvg = {reference_random_range(&state, 0, side), reference_random_range(&state, 0, side), 1.0 / 9.0},
            .eta = 1e-6,
            .side = 1};
        const reference_rect kernel = reference_dual_grid_kernel(&grid, &map, &settings, &receiver, highest(&grid));
        reference_outline outline = {0};
        reference_contour contour = {0};
        reference_occlusion quads, o;
        assert_true(reference_visibility(&map, layers, 1, &settings, &receiver, &quads));
        if (!in_penumbra(&quads))
            continue;
        ++penumbra;
        assert_true(reference_outline_extract(&grid, &map, &settings, &receiver, 1, kernel, REFERENCE_EXTRACT_WALK,
                                              NULL, &outline));
        assert_true(reference_contour_extract(&grid, &map, &settings, &receiver, 1, kernel, REFERENCE_EXTRACT_WALK,
                                              NULL, &contour));
        reference_outline_occlusion(&grid, &map, &settings, &receiver, &outline, &o);
        assert_true(same_masks(&quads, &o));
        kernel_texels += (uint64_t)(kernel.x1 - kernel.x0 + 1) * (uint64_t)(kernel.y1 - kernel.y0 + 1);
        edges += outline.edge_count;
        bridges += outline.bridge_count;
        contour_edges += contour.count;
        visited += outline.walk.nodes + outline.walk.cells;
        reference_outline_free(&outline);
        reference_contour_free(&contour);
    }
    reference_dual_grid_destroy(&grid);
    print_message("per receiver: %g texels in the kernel, %g outline edges, %g bridges, %g contour edges, %g nodes and "
                  "cells visited\n",
                  (double)kernel_texels / 100.0, (double)edges / 100.0, (double)bridges / 100.0,
                  (double)contour_edges / 100.0, (double)visited / 100.0);
    assert_true(4 * (edges + bridges) < kernel_texels);
    assert_true(2 * visited < kernel_texels);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fold_safe_contours_hide_what_microquads_hide),
        cmocka_unit_test(outlines_have_the_area_of_their_quads),
        cmocka_unit_test(quads_fold_where_the_light_is_behind_them),
        cmocka_unit_test(moving_by_whole_texels_changes_nothing),
        cmocka_unit_test(turning_the_light_by_a_right_angle_changes_nothing),
        cmocka_unit_test(primitives_are_few),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
