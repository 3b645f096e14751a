/* The reference on cases small enough to compute by hand: samples and areas of single micro-occluders, levels, layers,
 * hard shadows, hierarchies and the post filter. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "reference_filter.h"
#include "reference_hierarchy.h"
#include "reference_map.h"
#include "reference_scene.h"
#include "reference_visibility.h"

/* The table's map: 8 x 8 texels over tangents -1 to 1, looking down -z, a square light of half size 1 around the
 * projection centre, so that A is 4. From a receiver at g = 1/4 an offset of one texel at g = 1/2 is one unit of q. */
enum { side = 8 };

static reference_map table_map(double half, double behind, uint32_t size)
{
    const double eye[3] = {0, 0, 0}, target[3] = {0, 0, -1}, up[3] = {0, 1, 0};
    const double bounds[4] = {-1, 1, -1, 1};
    softsh_light light = {.struct_size = sizeof(light), .shape = SOFTSH_LIGHT_RECTANGLE};
    light.center[2] = -behind;
    light.half_u[0] = half;
    light.half_v[1] = half;
    double view[16], projection[16];
    reference_map map;
    reference_look_at(eye, target, up, view);
    reference_perspective(bounds, 0.1, 100.0, REFERENCE_DEPTH_REVERSED_INFINITE, projection);
    assert_true(reference_map_derive(&map, view, projection, size, size, &light));
    return map;
}

static reference_receiver at(double u, double v, double g)
{
    return (reference_receiver){.state = REFERENCE_RECEIVER_ACTIVE, .uvg = {u, v, g}, .side = 1};
}

static reference_occlusion evaluate(const reference_map *map, const float *g, const reference_settings *settings,
                                    const reference_receiver *receiver)
{
    reference_occlusion out;
    assert_true(reference_visibility(map, &g, 1, settings, receiver, &out));
    return out;
}

static void assert_area(double a, double b)
{
    if (!(fabs(a - b) <= 1e-12))
        fail_msg("%.17g is not %.17g", a, b);
}

static bool bit(const reference_occlusion *occlusion, uint32_t n, uint32_t i, uint32_t j)
{
    return (occlusion->mask[(j * n + i) / 32] >> ((j * n + i) % 32) & 1u) != 0;
}

static void one_patch_covers_a_quarter(void **unused)
{
    (void)unused;
    const reference_map map = table_map(1.0, 0.0, side);
    const reference_receiver receiver = at(4.0, 4.0, 0.25);
    float g[side * side] = {0};
    g[4 * side + 4] = 0.5f;
    const softsh_pattern patterns[] = {SOFTSH_PATTERN_8X8, SOFTSH_PATTERN_16X16, SOFTSH_PATTERN_16X16_JITTERED,
                                       SOFTSH_PATTERN_32X32};
    for (int k = 0; k < 4; ++k) {
        const uint32_t n = reference_pattern_size(patterns[k]);
        for (int extended = 0; extended < 2; ++extended) {
            const reference_settings settings = {.pattern = patterns[k],
                                                 .primitive = extended ? SOFTSH_PRIMITIVE_MICROPATCH
                                                                       : SOFTSH_PRIMITIVE_MICROPATCH_UNEXTENDED};
            const reference_occlusion o = evaluate(&map, g, &settings, &receiver);
            assert_int_equal(o.counted, n * n);
            assert_int_equal(o.occluded, n * n / 4);
            assert_area(o.bitmask, 0.25);
            assert_area(o.area, 0.25);
            for (uint32_t j = 0; j < n; ++j)
                for (uint32_t i = 0; i < n; ++i)
                    assert_int_equal(bit(&o, n, i, j), i >= n / 2 && j >= n / 2);
        }
    }
    /* At g = 3/4 one texel is half a unit. */
    g[4 * side + 4] = 0.75f;
    const reference_settings settings = {.primitive = SOFTSH_PRIMITIVE_MICROPATCH};
    const reference_occlusion o = evaluate(&map, g, &settings, &receiver);
    assert_int_equal(o.occluded, 16);
    assert_area(o.area, 1.0 / 16.0);
    /* At or below the receiver's depth nothing is left of it. */
    g[4 * side + 4] = 0.25f;
    assert_int_equal(evaluate(&map, g, &settings, &receiver).occluded, 0);
}

static void patches_may_straddle_the_light(void **unused)
{
    (void)unused;
    const reference_map map = table_map(1.0, 0.0, side);
    /* Texel (4, 4) covers q in [0.5, 1.5] x [-0.25, 0.75]. */
    const reference_receiver receiver = at(3.5, 4.25, 0.25);
    float g[side * side] = {0};
    g[4 * side + 4] = 0.5f;
    const reference_settings settings = {.pattern = SOFTSH_PATTERN_16X16, .primitive = SOFTSH_PRIMITIVE_MICROPATCH};
    const reference_occlusion o = evaluate(&map, g, &settings, &receiver);
    assert_int_equal(o.occluded, 4 * 8); /* columns 12 to 15, rows 6 to 13 */
    assert_area(o.area, 0.5 * 1.0 / 4.0);
    assert_true(bit(&o, 16, 12, 6) && bit(&o, 16, 15, 13));
    assert_false(bit(&o, 16, 11, 6) || bit(&o, 16, 12, 5) || bit(&o, 16, 12, 14));
}

static void spans_are_half_open(void **unused)
{
    (void)unused;
    const reference_map map = table_map(1.0, 0.0, side);
    float g[side * side] = {0};
    g[4 * side + 4] = 0.5f;
    const reference_settings settings = {.pattern = SOFTSH_PATTERN_8X8, .primitive = SOFTSH_PRIMITIVE_MICROPATCH};
    /* Borders at q = 0.125 and 1.125 on both axes: sample coordinates 4.5 and 8.5, the first on a sample. */
    reference_receiver receiver = at(3.875, 3.875, 0.25);
    reference_occlusion o = evaluate(&map, g, &settings, &receiver);
    assert_int_equal(o.occluded, 16);
    /* Borders at -0.125 and 0.875: 3.5 and 7.5, the last on a sample and left out. */
    receiver = at(4.125, 4.125, 0.25);
    o = evaluate(&map, g, &settings, &receiver);
    assert_int_equal(o.occluded, 16);
    assert_true(bit(&o, 8, 3, 3) && bit(&o, 8, 6, 6));
    assert_false(bit(&o, 8, 7, 7));
    /* The exact microquad follows the same rule: a quad of four centres, shifted by half a texel. */
    for (int y = 4; y < 6; ++y)
        for (int x = 4; x < 6; ++x)
            g[y * side + x] = 0.5f;
    const reference_settings quads = {.pattern = SOFTSH_PATTERN_8X8};
    receiver = at(4.625, 4.625, 0.25);
    o = evaluate(&map, g, &quads, &receiver);
    assert_int_equal(o.occluded, 16);
    assert_true(bit(&o, 8, 3, 3) && bit(&o, 8, 6, 6));
    assert_false(bit(&o, 8, 7, 7));
    assert_area(o.area, 0.25);
}

static void a_wall_hides_all_of_the_light(void **unused)
{
    (void)unused;
    const reference_map map = table_map(1.0, 0.0, side);
    const reference_receiver receiver = at(4.2, 3.9, 0.25);
    float g[side * side];
    for (int i = 0; i < side * side; ++i)
        g[i] = 0.5f;
    for (int primitive = SOFTSH_PRIMITIVE_DEFAULT; primitive <= SOFTSH_PRIMITIVE_MICROQUAD_RECTANGLE; ++primitive) {
        for (int pattern = SOFTSH_PATTERN_DEFAULT; pattern <= SOFTSH_PATTERN_32X32; ++pattern) {
            const reference_settings settings = {.pattern = (softsh_pattern)pattern,
                                                 .primitive = (softsh_primitive)primitive};
            const reference_occlusion o = evaluate(&map, g, &settings, &receiver);
            assert_int_equal(o.occluded, o.counted);
            assert_area(o.area, 1.0);
        }
    }
}

static void extension_closes_gaps(void **unused)
{
    (void)unused;
    const reference_map map = table_map(2.0, 0.0, side); /* A is 8 */
    const reference_receiver receiver = at(2.0, 3.5, 0.25);
    /* The left texel is nearer to the light: seen from the receiver it ends at 2 / (0.75 * 8) = 1/3, and the right one
     * begins at 2 / (0.5 * 8) = 1/2 and ends at 3/4. */
    float g[side * side] = {0};
    g[3 * side + 3] = 1.0f;
    g[3 * side + 4] = 0.75f;
    reference_settings settings = {.pattern = SOFTSH_PATTERN_32X32,
                                   .primitive = SOFTSH_PRIMITIVE_MICROPATCH_UNEXTENDED};
    const reference_occlusion open = evaluate(&map, g, &settings, &receiver);
    /* Heights: +-0.5 / 6 = +-1/12 and +-0.5 / 4 = +-1/8. Left texel from 1 / 6 to 1/3. */
    assert_area(open.area, (1.0 / 6.0 * 1.0 / 6.0 + 0.25 * 0.25) / 4.0);
    settings.primitive = SOFTSH_PRIMITIVE_MICROPATCH;
    const reference_occlusion closed = evaluate(&map, g, &settings, &receiver);
    assert_area(closed.area, (1.0 / 6.0 * 1.0 / 6.0 + (0.75 - 1.0 / 3.0) * 0.25) / 4.0);
    /* Sample coordinates 16 q + 16: the left texel from 18.67 to 21.33, the right one from 24. */
    for (uint32_t j = 14; j < 18; ++j) {
        for (uint32_t i = 18; i < 28; ++i) {
            const bool gap = i == 21 || i == 22 || i == 23;
            const bool left = i <= 20 && (j == 15 || j == 16), right = i >= 24;
            assert_int_equal(bit(&open, 32, i, j), (left && i > 18) || right);
            assert_int_equal(bit(&closed, 32, i, j), (left && i > 18) || right || gap);
        }
    }
    /* Likewise with the neighbour below. */
    memset(g, 0, sizeof(g));
    g[3 * side + 3] = 1.0f;
    g[4 * side + 3] = 0.75f;
    const reference_receiver below = at(3.5, 2.0, 0.25);
    const reference_occlusion upright = evaluate(&map, g, &settings, &below);
    assert_area(upright.area, closed.area);
    for (uint32_t j = 0; j < 32; ++j)
        for (uint32_t i = 0; i < 32; ++i)
            assert_int_equal(bit(&upright, 32, j, i), bit(&closed, 32, i, j));
    /* A neighbour that does not pass is no neighbour, and extension only ever widens. */
    g[3 * side + 3] = 0.2f;
    assert_area(evaluate(&map, g, &settings, &below).area, 0.25 * 0.25 / 4.0);
    g[3 * side + 3] = 0.5f;
    assert_area(evaluate(&map, g, &settings, &below).area, (0.25 * 0.25 + 0.5 * 0.5) / 4.0);
}

static void microquads_join_texel_centres(void **unused)
{
    (void)unused;
    const reference_map map = table_map(1.0, 0.0, side);
    const reference_receiver receiver = at(4.0, 4.0, 0.25);
    /* 3 x 2 centres: q from -0.5 to 1.5 (clipped to 1) and from -0.5 to 0.5. */
    float g[side * side] = {0};
    for (int y = 3; y < 5; ++y)
        for (int x = 3; x < 6; ++x)
            g[y * side + x] = 0.5f;
    for (int primitive = SOFTSH_PRIMITIVE_MICROQUAD; primitive <= SOFTSH_PRIMITIVE_MICROQUAD_RECTANGLE; ++primitive) {
        const reference_settings settings = {.pattern = SOFTSH_PATTERN_16X16, .primitive = (softsh_primitive)primitive};
        const reference_occlusion o = evaluate(&map, g, &settings, &receiver);
        assert_int_equal(o.occluded, 12 * 8);
        assert_area(o.area, 1.5 / 4.0);
    }
    /* Without one vertex its quad is gone. */
    g[3 * side + 5] = 0.0f;
    const reference_settings settings = {.pattern = SOFTSH_PATTERN_16X16};
    assert_int_equal(evaluate(&map, g, &settings, &receiver).occluded, 8 * 8);
}

static void microquad_and_its_rectangle_differ_on_slants(void **unused)
{
    (void)unused;
    const reference_map map = table_map(1.0, 0.0, side);
    const reference_receiver receiver = at(4.0, 4.0, 0.25);
    /* Right edge nearer to the light: vertices (-0.5, -+0.5) and (0.25, -+0.25), a trapezoid. */
    float g[side * side] = {0};
    g[3 * side + 3] = g[4 * side + 3] = 0.5f;
    g[3 * side + 4] = g[4 * side + 4] = 0.75f;
    reference_settings settings = {.pattern = SOFTSH_PATTERN_32X32};
    const reference_occlusion exact = evaluate(&map, g, &settings, &receiver);
    assert_area(exact.area, 0.75 * (1.0 + 0.5) / 2.0 / 4.0);
    settings.primitive = SOFTSH_PRIMITIVE_MICROQUAD_RECTANGLE;
    const reference_occlusion box = evaluate(&map, g, &settings, &receiver);
    assert_area(box.area, exact.area);
    /* The rectangle is [-0.5, 0.25] x [-0.375, 0.375]: columns 8 to 19, rows 10 to 21. */
    assert_int_equal(box.occluded, 12 * 12);
    for (uint32_t j = 0; j < 32; ++j) {
        for (uint32_t i = 0; i < 32; ++i) {
            const double x = (i + 0.5) / 16.0 - 1.0, y = (j + 0.5) / 16.0 - 1.0;
            const double half = 0.5 - (x + 0.5) / 3.0;
            assert_int_equal(bit(&exact, 32, i, j), x > -0.5 && x < 0.25 && fabs(y) < half);
            assert_int_equal(bit(&box, 32, i, j), i >= 8 && i < 20 && j >= 10 && j < 22);
        }
    }
}

/* The quads of a slanted plane cover every sample of their common outline once. */
static void microquad_meshes_have_no_seams(void **unused)
{
    (void)unused;
    const reference_map map = table_map(1.0, 0.0, side);
    const reference_receiver receiver = at(4.3, 3.8, 0.25);
    float g[side * side] = {0};
    for (int y = 1; y < 7; ++y)
        for (int x = 1; x < 7; ++x)
            g[y * side + x] = (float)(0.6 + 0.02 * x - 0.015 * y);
    const reference_settings settings = {.pattern = SOFTSH_PATTERN_32X32};
    const reference_occlusion whole = evaluate(&map, g, &settings, &receiver);
    uint32_t sum = 0;
    double area = 0.0;
    reference_occlusion joined = {0};
    for (int y = 1; y < 6; ++y) {
        for (int x = 1; x < 6; ++x) {
            float one[side * side] = {0};
            for (int k = 0; k < 4; ++k) {
                const int corner = (y + k / 2) * side + x + k % 2;
                one[corner] = g[corner];
            }
            const reference_occlusion o = evaluate(&map, one, &settings, &receiver);
            sum += o.occluded;
            area += o.area;
            for (int w = 0; w < 32; ++w)
                joined.mask[w] |= o.mask[w];
        }
    }
    assert_int_equal(sum, whole.occluded);
    assert_memory_equal(joined.mask, whole.mask, sizeof(whole.mask));
    assert_area(area, whole.area);
    const int outline[4][2] = {{1, 1}, {6, 1}, {6, 6}, {1, 6}};
    double q[4][2];
    for (int k = 0; k < 4; ++k) {
        const double sample[3] = {outline[k][0] + 0.5, outline[k][1] + 0.5,
                                  (double)g[outline[k][1] * side + outline[k][0]]};
        reference_map_backproject(&map, receiver.uvg, sample, q[k]);
    }
    for (uint32_t j = 0; j < 32; ++j) {
        for (uint32_t i = 0; i < 32; ++i) {
            const double x = (i + 0.5) / 16.0 - 1.0, y = (j + 0.5) / 16.0 - 1.0;
            bool inside = true;
            for (int k = 0; k < 4; ++k) {
                const double *a = q[k], *b = q[(k + 1) % 4];
                inside = inside && (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) > 0.0;
            }
            assert_int_equal(bit(&whole, 32, i, j), inside);
        }
    }
}

static void patterns_are_where_they_should_be(void **unused)
{
    (void)unused;
    const softsh_pattern patterns[] = {SOFTSH_PATTERN_8X8, SOFTSH_PATTERN_16X16, SOFTSH_PATTERN_32X32};
    const uint32_t sizes[] = {8, 16, 32};
    for (int k = 0; k < 3; ++k) {
        double xy[2];
        assert_int_equal(reference_pattern_size(patterns[k]), sizes[k]);
        reference_pattern_sample(patterns[k], sizes[k] - 1, 2, xy);
        assert_area(xy[0], sizes[k] - 0.5);
        assert_area(xy[1], 2.5);
    }
    /* The jittered one: a sample per cell, and each row and column of half cells of a 2 x 2 tile once. */
    assert_int_equal(reference_pattern_size(SOFTSH_PATTERN_DEFAULT), 16);
    bool quarter[64][64] = {{false}};
    for (uint32_t j = 0; j < 16; ++j) {
        for (uint32_t i = 0; i < 16; ++i) {
            double xy[2];
            reference_pattern_sample(SOFTSH_PATTERN_16X16_JITTERED, i, j, xy);
            assert_true(xy[0] > i && xy[0] < i + 1 && xy[1] > j && xy[1] < j + 1);
            bool *place = &quarter[(uint32_t)(4.0 * xy[0])][(uint32_t)(4.0 * xy[1])];
            assert_false(*place);
            *place = true;
        }
    }
    for (uint32_t tile = 0; tile < 64; ++tile) {
        uint32_t seen_x = 0, seen_y = 0;
        for (uint32_t k = 0; k < 4; ++k) {
            double xy[2];
            const uint32_t i = 2 * (tile % 8) + k % 2, j = 2 * (tile / 8) + k / 2;
            reference_pattern_sample(SOFTSH_PATTERN_16X16_JITTERED, i, j, xy);
            seen_x |= 1u << (uint32_t)((xy[0] - 2 * (tile % 8)) * 2.0);
            seen_y |= 1u << (uint32_t)((xy[1] - 2 * (tile / 8)) * 2.0);
        }
        assert_int_equal(seen_x, 15);
        assert_int_equal(seen_y, 15);
    }
    /* Samples of the disc: 8 x 8 without three in each corner. */
    uint32_t counted = 0;
    for (uint32_t k = 0; k < 64; ++k)
        counted += reference_pattern_counted(SOFTSH_PATTERN_8X8, true, k % 8, k / 8);
    assert_int_equal(counted, 52);
    assert_false(reference_pattern_counted(SOFTSH_PATTERN_8X8, true, 0, 1));
    assert_true(reference_pattern_counted(SOFTSH_PATTERN_8X8, true, 0, 2));
    assert_true(reference_pattern_counted(SOFTSH_PATTERN_8X8, false, 0, 0));
}

static void levels_take_their_depth_and_place(void **unused)
{
    (void)unused;
    /* 5 x 5 texels of tangent 0.4: A is 2.5. Level 1 has 3 x 3 samples. From g = 1/4 at g = 1/2 a texel is 1 / 0.625 =
     * 1.6 units; a light of half size 8 makes it 0.2. */
    const reference_map map = table_map(8.0, 0.0, 5);
    const reference_receiver receiver = at(2.5, 2.5, 0.25);
    reference_settings settings = {
        .pattern = SOFTSH_PATTERN_32X32, .primitive = SOFTSH_PRIMITIVE_MICROPATCH_UNEXTENDED, .level = 1};
    for (int texel = 0; texel < 25; ++texel) {
        const int x = texel % 5, y = texel / 5;
        float g[25] = {0};
        g[texel] = 0.5f;
        /* Nearest: the block's patch at the block's centre, whichever of its texels is near. */
        settings.aggregation = SOFTSH_AGGREGATION_NEAREST;
        reference_occlusion o = evaluate(&map, g, &settings, &receiver);
        double left = fmax(0.2 * (x / 2 * 2 - 2.5), -1.0), right = fmin(0.2 * (x / 2 * 2 + 2 - 2.5), 1.0);
        double bottom = fmax(0.2 * (y / 2 * 2 - 2.5), -1.0), top = fmin(0.2 * (y / 2 * 2 + 2 - 2.5), 1.0);
        assert_area(o.area, (right - left) * (top - bottom) / 4.0);
        for (uint32_t k = 0; k < 1024; ++k) {
            const double s = (k % 32 + 0.5) / 16.0 - 1.0, t = (k / 32 + 0.5) / 16.0 - 1.0;
            assert_int_equal(bit(&o, 32, k % 32, k / 32), s > left && s < right && t > bottom && t < top);
        }
        /* Sampled: texels 1, 3 and (for want of 5) 4 of each axis, at their centres. */
        settings.aggregation = SOFTSH_AGGREGATION_SAMPLED;
        o = evaluate(&map, g, &settings, &receiver);
        const bool taken = (x == 1 || x >= 3) && (y == 1 || y >= 3);
        left = fmax(0.2 * (x + 0.5 - 1.0 - 2.5), -1.0), right = fmin(0.2 * (x + 0.5 + 1.0 - 2.5), 1.0);
        bottom = fmax(0.2 * (y + 0.5 - 1.0 - 2.5), -1.0), top = fmin(0.2 * (y + 0.5 + 1.0 - 2.5), 1.0);
        assert_area(o.area, taken ? (right - left) * (top - bottom) / 4.0 : 0.0);
        settings.aggregation = SOFTSH_AGGREGATION_DEFAULT;
        assert_area(evaluate(&map, g, &settings, &receiver).area, o.area);
    }
    /* Level 0 knows no difference, and a level that leaves one sample has no quads. */
    float all[25];
    for (int i = 0; i < 25; ++i)
        all[i] = 0.5f;
    settings.level = 3;
    settings.primitive = SOFTSH_PRIMITIVE_MICROQUAD;
    assert_int_equal(evaluate(&map, all, &settings, &receiver).occluded, 0);
    settings.primitive = SOFTSH_PRIMITIVE_MICROPATCH;
    assert_area(evaluate(&map, all, &settings, &receiver).area, 1.4 * 1.4 / 4.0); /* texel 4, from 0.5 on */
}

static void level_follows_the_budget(void **unused)
{
    (void)unused;
    assert_int_equal(reference_level(100, 0), 0);
    assert_int_equal(reference_level(16, 16), 0);
    assert_int_equal(reference_level(17, 16), 1);
    assert_int_equal(reference_level(32, 16), 1);
    assert_int_equal(reference_level(33, 16), 2);
    assert_int_equal(reference_level(16384, 1), 14);
}

static void layers_unite_or_the_darkest_counts(void **unused)
{
    (void)unused;
    const reference_map map = table_map(1.0, 0.0, side);
    const reference_receiver receiver = at(4.0, 4.0, 0.25);
    float first[side * side] = {0}, second[side * side] = {0};
    first[4 * side + 4] = 0.5f;  /* [0, 1] x [0, 1] */
    second[4 * side + 4] = 0.5f; /* the same, and [-1, 0] x [0, 1] */
    second[4 * side + 3] = 0.5f;
    const float *const layers[2] = {first, second};
    reference_settings settings = {.pattern = SOFTSH_PATTERN_16X16, .primitive = SOFTSH_PRIMITIVE_MICROPATCH};
    reference_occlusion o;
    assert_true(reference_visibility(&map, layers, 2, &settings, &receiver, &o));
    assert_int_equal(o.occluded, 128);
    assert_area(o.area, 0.75);
    settings.merge = SOFTSH_MERGE_MAXIMUM;
    assert_true(reference_visibility(&map, layers, 2, &settings, &receiver, &o));
    assert_int_equal(o.occluded, 128);
    assert_area(o.area, 0.5);
    /* Side by side instead: half of the light together, a quarter each. */
    second[4 * side + 4] = 0.0f;
    assert_true(reference_visibility(&map, layers, 2, &settings, &receiver, &o));
    assert_int_equal(o.occluded, 64);
    settings.merge = SOFTSH_MERGE_UNION;
    assert_true(reference_visibility(&map, layers, 2, &settings, &receiver, &o));
    assert_int_equal(o.occluded, 128);
    assert_area(o.area, 0.5);
}

static void nothing_behind_the_light_occludes(void **unused)
{
    (void)unused;
    /* Projection centre 1 behind the light: g from 1 up is behind it. Receiver on the axis at distance 4. */
    const reference_map map = table_map(0.5, 1.0, side);
    const reference_receiver receiver = at(4.0, 4.0, 0.25);
    float g[side * side];
    const reference_settings settings = {.pattern = SOFTSH_PATTERN_16X16};
    for (int behind = 0; behind < 2; ++behind) {
        for (int i = 0; i < side * side; ++i)
            g[i] = behind ? 1.0f : 0.99f;
        assert_int_equal(evaluate(&map, g, &settings, &receiver).occluded, behind ? 0 : 256);
    }
    /* Half way between light and receiver, at z = 2.5, an occluder of half size 0.5 hides what is twice its size. */
    const reference_map fine = table_map(1.0, 1.0, 40); /* texel 0.05 at distance 1, 0.125 at 2.5 */
    const reference_receiver center = at(20.0, 20.0, 0.25);
    float wide[40 * 40] = {0};
    for (int y = 18; y < 22; ++y)
        for (int x = 18; x < 22; ++x)
            wide[y * 40 + x] = 0.4f;
    const reference_settings patches = {.pattern = SOFTSH_PATTERN_16X16,
                                        .primitive = SOFTSH_PRIMITIVE_MICROPATCH_UNEXTENDED};
    const reference_occlusion o = evaluate(&fine, wide, &patches, &center);
    /* 4 texels of 0.125, half size 0.25; from half way twice as large on the light: half size 0.5. */
    if (!(fabs(o.area - 0.25) < 1e-6)) /* 0.4f is not 0.4 */
        fail_msg("%.9g", o.area);
    assert_int_equal(o.occluded, 64);
}

static void directional_light_is_a_disc(void **unused)
{
    (void)unused;
    const double eye[3] = {0, 0, 10}, target[3] = {0, 0, 0}, up[3] = {0, 1, 0}, bounds[4] = {-4, 4, -4, 4};
    softsh_light light = {.struct_size = sizeof(light), .shape = SOFTSH_LIGHT_DIRECTIONAL};
    light.direction[2] = -2.0;
    light.angular_radius = atan(0.25);
    double view[16], projection[16];
    reference_look_at(eye, target, up, view);
    reference_orthographic(bounds, 0.0, 20.0, REFERENCE_DEPTH_NORMAL, projection);
    reference_map map;
    assert_true(reference_map_derive(&map, view, projection, side, side, &light));
    /* Texels of world size 1: A is 1/4, and 4 above the receiver a texel is one unit of q. */
    const reference_receiver receiver = at(4.0, 4.0, -10.0);
    float g[side * side];
    for (int i = 0; i < side * side; ++i)
        g[i] = -20.0f;
    reference_settings settings = {.pattern = SOFTSH_PATTERN_8X8, .primitive = SOFTSH_PRIMITIVE_MICROPATCH};
    g[4 * side + 4] = -6.0f;
    reference_occlusion o = evaluate(&map, g, &settings, &receiver);
    assert_int_equal(o.counted, 52);
    assert_int_equal(o.occluded, 13);
    const double side_of_square = sqrt(acos(-1.0)) / 2.0;
    assert_area(o.area, side_of_square * side_of_square / acos(-1.0));
    for (int i = 0; i < side * side; ++i)
        g[i] = -6.0f;
    o = evaluate(&map, g, &settings, &receiver);
    assert_int_equal(o.occluded, 52);
    assert_area(o.bitmask, 1.0);
    assert_area(o.area, 1.0);
    settings.primitive = SOFTSH_PRIMITIVE_MICROQUAD;
    o = evaluate(&map, g, &settings, &receiver);
    assert_int_equal(o.occluded, 52);
    assert_area(o.area, 1.0);
}

static void lights_without_size_cast_hard_shadows(void **unused)
{
    (void)unused;
    const reference_map map = table_map(0.0, 0.0, side);
    float g[side * side] = {0};
    g[3 * side + 4] = 0.5f;
    const reference_settings settings = {.primitive = SOFTSH_PRIMITIVE_MICROPATCH, .level = 2};
    reference_receiver receiver = at(4.9, 3.0, 0.25);
    reference_occlusion o = evaluate(&map, g, &settings, &receiver);
    assert_int_equal(o.occluded, 256);
    assert_area(o.area, 1.0);
    receiver = at(5.0, 3.0, 0.25);
    assert_int_equal(evaluate(&map, g, &settings, &receiver).occluded, 0);
    /* Plane at the texel's centre: 0.25 + 0.1 (4.5 - 4.9) = 0.21, and half a texel of slope: 0.26. */
    receiver = at(4.9, 3.5, 0.25);
    receiver.gradient[0] = 0.1;
    g[3 * side + 4] = 0.2599f;
    assert_int_equal(evaluate(&map, g, &settings, &receiver).occluded, 0);
    g[3 * side + 4] = 0.2601f;
    assert_int_equal(evaluate(&map, g, &settings, &receiver).occluded, 256);
    receiver.eta = 0.001;
    assert_int_equal(evaluate(&map, g, &settings, &receiver).occluded, 0);
    /* The far border belongs to the last texel. */
    g[7 * side + 7] = 0.5f;
    receiver = at(8.0, 8.0, 0.25);
    assert_int_equal(evaluate(&map, g, &settings, &receiver).occluded, 256);
}

static void bias_leaves_out_what_it_should(void **unused)
{
    (void)unused;
    const reference_map map = table_map(1.0, 0.0, side);
    float g[side * side] = {0};
    reference_receiver receiver = at(4.0, 4.0, 0.25);
    receiver.eta = 0.01;
    receiver.gradient[0] = 0.04;
    receiver.gradient[1] = -0.02; /* s is 0.06; the plane at (4.5, 4.5) is 0.26 */
    reference_settings settings = {.primitive = SOFTSH_PRIMITIVE_MICROPATCH};
    g[4 * side + 4] = 0.2999f; /* within 0.26 + 0.01 + 0.03 */
    assert_int_equal(evaluate(&map, g, &settings, &receiver).occluded, 0);
    g[4 * side + 4] = 0.3001f;
    assert_true(evaluate(&map, g, &settings, &receiver).occluded > 0);
    /* An occluder above the receiver but behind its plane hides only what is below the horizon. */
    receiver.gradient[0] = 0.4;
    receiver.gradient[1] = 0.0; /* plane 0.45, half a texel of slope 0.2 */
    receiver.eta = 0.0;
    receiver.uvg[2] = 0.2;
    receiver.uvg[0] = 3.0; /* plane 0.8 */
    g[4 * side + 4] = 0.5f;
    assert_true(evaluate(&map, g, &settings, &receiver).area == 0.0);
    /* On a surface whose front is the plane's other side that is in front. */
    receiver.side = -1;
    assert_true(evaluate(&map, g, &settings, &receiver).area > 0.0);
    receiver.side = 1;
    receiver.uvg[0] = 4.0; /* plane 0.4, and 0.5 is within it */
    assert_true(evaluate(&map, g, &settings, &receiver).area == 0.0);
    /* With an override only the depth counts. */
    receiver.override_bias = true;
    assert_true(evaluate(&map, g, &settings, &receiver).area > 0.0);

    settings.primitive = SOFTSH_PRIMITIVE_MICROQUAD;
    settings.level = 2;
    receiver.eta = 0.01;
    receiver.override_bias = false;
    assert_area(reference_raised_g(&map, &settings, &receiver), 0.21);
    settings.aggregation = SOFTSH_AGGREGATION_NEAREST;
    assert_area(reference_raised_g(&map, &settings, &receiver), 0.21 + 0.4 * 1.5);
    settings.primitive = SOFTSH_PRIMITIVE_MICROPATCH;
    assert_area(reference_raised_g(&map, &settings, &receiver), 0.21);
    /* 2 nearer to the projection centre than 5. */
    receiver.override_bias = true;
    receiver.bias = 2.0;
    assert_area(reference_raised_g(&map, &settings, &receiver), 1.0 / 3.0);
    receiver.bias = 5.0;
    assert_true(isinf(reference_raised_g(&map, &settings, &receiver)));
    assert_int_equal(evaluate(&map, g, &settings, &receiver).occluded, 0);
}

/* Microquads: a twentieth of the slope per spacing, around a plane that nearest depths lift. */
static void microquads_keep_to_their_band(void **unused)
{
    (void)unused;
    const reference_map map = table_map(16.0, 0.0, side);
    float g[side * side];
    reference_settings settings = {.primitive = SOFTSH_PRIMITIVE_MICROQUAD};
    reference_receiver receiver = at(4.0, 4.0, 0.25);
    receiver.gradient[0] = 0.02;
    receiver.gradient[1] = -0.01; /* s is 0.03 */
    receiver.eta = 1e-4;
    for (int level = 0; level < 2; ++level) {
        const double band = 1e-4 + 0.05 * 0.03 * (level ? 2.0 : 1.0);
        for (int nearest = 0; nearest < 2; ++nearest) {
            const double lift = nearest && level ? 0.03 * 0.5 : 0.0;
            settings.level = (uint32_t)level;
            settings.aggregation = nearest ? SOFTSH_AGGREGATION_NEAREST : SOFTSH_AGGREGATION_SAMPLED;
            for (int above = -1; above <= 1; ++above) {
                for (int sign = -1; sign < 2; sign += 2) {
                    receiver.side = sign;
                    for (int outside = 0; outside < 2; ++outside) {
                        /* Every sample at the same height over the plane at its place. */
                        const double height = above * (band + (outside ? 1e-6 : -1e-6)) + lift;
                        for (int y = 0; y < side; ++y) {
                            for (int x = 0; x < side; ++x) {
                                const double block = level ? (nearest ? 0.0 : 0.5) : -0.5;
                                const double u = level ? x / 2 * 2 + 1 + block : x + 0.5;
                                const double v = level ? y / 2 * 2 + 1 + block : y + 0.5;
                                g[y * side + x] = (float)(0.25 + height + 0.02 * (u - 4.0) - 0.01 * (v - 4.0));
                            }
                        }
                        const bool hidden = above && outside && above == sign;
                        assert_int_equal(evaluate(&map, g, &settings, &receiver).area > 0.0, hidden);
                    }
                }
            }
        }
    }
}

static void states_decide_without_a_look(void **unused)
{
    (void)unused;
    const reference_map map = table_map(1.0, 0.0, side);
    float g[side * side];
    for (int i = 0; i < side * side; ++i)
        g[i] = 0.5f;
    const reference_settings settings = {0};
    reference_receiver receiver = at(4.0, 4.0, 0.25);
    receiver.state = REFERENCE_RECEIVER_NONE;
    assert_int_equal(evaluate(&map, g, &settings, &receiver).occluded, 0);
    receiver.state = REFERENCE_RECEIVER_BEHIND;
    assert_int_equal(evaluate(&map, g, &settings, &receiver).occluded, 0);
    receiver.state = REFERENCE_RECEIVER_AWAY;
    memset(g, 0, sizeof(g));
    assert_int_equal(evaluate(&map, g, &settings, &receiver).occluded, 256);
    assert_area(evaluate(&map, g, &settings, &receiver).area, 1.0);
}

static void assert_range(reference_range range, float low, float high)
{
    if (range.min != low || range.max != high)
        fail_msg("%g..%g is not %g..%g", (double)range.min, (double)range.max, (double)low, (double)high);
}

static void hierarchies_on_odd_sizes(void **unused)
{
    (void)unused;
    /* 5 x 3 */
    const float g[15] = {3, 1, 4, 1, 5, /**/ 9, 2, 6, 5, 3, /**/ 5, 8, 9, 7, 0};
    assert_int_equal(reference_hsm_size(5, 1), 3);
    assert_int_equal(reference_hsm_size(3, 1), 2);
    assert_int_equal(reference_hsm_size(5, 3), 1);
    assert_range(reference_hsm(g, 5, 3, 0, 3, 1), 5, 5);
    assert_range(reference_hsm(g, 5, 3, 1, 0, 0), 1, 9);
    assert_range(reference_hsm(g, 5, 3, 1, 1, 0), 1, 6);
    assert_range(reference_hsm(g, 5, 3, 1, 2, 0), 3, 5);
    assert_range(reference_hsm(g, 5, 3, 1, 1, 1), 7, 9);
    assert_range(reference_hsm(g, 5, 3, 1, 2, 1), 0, 0);
    assert_range(reference_hsm(g, 5, 3, 2, 0, 0), 1, 9);
    assert_range(reference_hsm(g, 5, 3, 2, 1, 0), 0, 5);
    assert_range(reference_hsm(g, 5, 3, 3, 0, 0), 0, 9);
    /* MSSM level 1 looks one to the left and up, level 2 from -2 to +1. */
    assert_range(reference_mssm(g, 5, 3, 0, 4, 2), 0, 0);
    assert_range(reference_mssm(g, 5, 3, 1, 0, 0), 3, 3);
    assert_range(reference_mssm(g, 5, 3, 1, 2, 1), 1, 6);
    assert_range(reference_mssm(g, 5, 3, 1, 4, 2), 0, 7);
    assert_range(reference_mssm(g, 5, 3, 2, 0, 0), 1, 9);
    assert_range(reference_mssm(g, 5, 3, 2, 4, 0), 1, 6);
    assert_range(reference_mssm(g, 5, 3, 2, 4, 2), 0, 9);
    /* YSM joined at level 1: level 1 is 3 x 2 texels {1..9, 1..6, 3..5; 5..8, 7..9, 0..0}. */
    assert_range(reference_ysm(g, 5, 3, 1, 1, 2, 1), 0, 0);
    assert_range(reference_ysm(g, 5, 3, 1, 2, 0, 0), 1, 9);
    assert_range(reference_ysm(g, 5, 3, 1, 2, 2, 0), 1, 6);
    assert_range(reference_ysm(g, 5, 3, 1, 2, 2, 1), 0, 9);
    assert_range(reference_ysm(g, 5, 3, 1, 3, 0, 1), 1, 9);
    assert_range(reference_ysm(g, 5, 3, 0, 2, 4, 0), 1, 6);
    /* 1 x 7 and 7 x 1 */
    const float line[7] = {4, 2, 7, 1, 9, 3, 5};
    for (int upright = 0; upright < 2; ++upright) {
        const uint32_t width = upright ? 1 : 7, height = upright ? 7 : 1;
#define CALL(hierarchy, level, k) hierarchy(line, width, height, level, upright ? 0 : (k), upright ? (k) : 0)
        assert_range(CALL(reference_hsm, 1, 3), 5, 5);
        assert_range(CALL(reference_hsm, 1, 1), 1, 7);
        assert_range(CALL(reference_hsm, 2, 1), 3, 9);
        assert_range(CALL(reference_hsm, 3, 0), 1, 9);
        assert_range(CALL(reference_mssm, 1, 0), 4, 4);
        assert_range(CALL(reference_mssm, 1, 6), 3, 5);
        assert_range(CALL(reference_mssm, 2, 6), 3, 9);
        assert_range(CALL(reference_mssm, 3, 0), 1, 7);
        assert_range(CALL(reference_mssm, 4, 3), 1, 9);
#undef CALL
    }
    /* Joined at level 2: two texels, {1..7, 3..9}. */
    assert_range(reference_ysm(line, 7, 1, 2, 2, 1, 0), 3, 9);
    assert_range(reference_ysm(line, 7, 1, 2, 3, 0, 0), 1, 7);
    assert_range(reference_ysm(line, 7, 1, 2, 3, 1, 0), 1, 9);
}

static void filter_by_hand(void **unused)
{
    (void)unused;
    double value = 0.0;
    assert_true(reference_filter_axis((const double[3]){0, 0.25, 1}, (const double[3]){0, 0, 0.5}, &value));
    assert_area(value, 0.125);
    assert_true(reference_filter_axis((const double[3]){1, 0.25, 0}, (const double[3]){0.5, 0, 0}, &value));
    assert_area(value, 0.125);
    assert_true(reference_filter_axis((const double[3]){0, 1, 1}, (const double[3]){0.25, 0.5, 0.75}, &value));
    assert_area(value, 0.75);
    assert_false(reference_filter_axis((const double[3]){0, 0.5, 1}, (const double[3]){1, 0.5, 0}, &value));
    assert_false(reference_filter_axis((const double[3]){0, 1.5, 1}, (const double[3]){0, 0.5, 1}, &value));
    assert_false(reference_filter_axis((const double[3]){0, 0, 0}, (const double[3]){0, 0.5, 1}, &value));
    assert_false(reference_filter_axis((const double[3]){0, 0.5, 1}, (const double[3]){1, 0.5, 1}, &value));

    /* A row: only inner penumbra pixels change, and the second pass reads the first. */
    const double a[5] = {0, 0.25, 0.5, 0.75, 1};
    uint8_t kinds[5] = {REFERENCE_FILTER_FIXED, REFERENCE_FILTER_PENUMBRA, REFERENCE_FILTER_PENUMBRA,
                        REFERENCE_FILTER_PENUMBRA, REFERENCE_FILTER_FIXED};
    double b[5] = {0, 0, 0, 1, 1};
    assert_true(reference_filter(b, a, kinds, 5, 1, 1));
    const double once[5] = {0, 0, 0.5, 0.5, 1};
    for (int i = 0; i < 5; ++i)
        assert_area(b[i], once[i]);
    assert_true(reference_filter(b, a, kinds, 5, 1, 1));
    const double twice[5] = {0, 0.25, 0.25, 0.75, 1};
    for (int i = 0; i < 5; ++i)
        assert_area(b[i], twice[i]);
    double both[5] = {0, 0, 0, 1, 1};
    assert_true(reference_filter(both, a, kinds, 5, 1, 2));
    assert_memory_equal(both, b, sizeof(b));
    /* A missing neighbour skips the axis; a fixed pixel stays. */
    double other[5] = {0, 0, 0, 1, 1};
    kinds[0] = REFERENCE_FILTER_NO_RECEIVER;
    kinds[2] = REFERENCE_FILTER_FIXED;
    assert_true(reference_filter(other, a, kinds, 5, 1, 1));
    const double expected[5] = {0, 0, 0, 0.5, 1};
    for (int i = 0; i < 5; ++i)
        assert_area(other[i], expected[i]);

    /* Two axes: the smaller change; one axis without guidance: the other one's. */
    const uint8_t all[9] = {2, 2, 2, 2, 2, 2, 2, 2, 2};
    const double a2[9] = {0, 0.2, 0, 0, 0.5, 1, 0, 0.6, 0};
    double b2[9] = {0, 0, 0, 0, 0.9, 1, 0, 1, 0};
    assert_true(reference_filter(b2, a2, all, 3, 3, 1));
    assert_area(b2[4], 0.75); /* x gives 0.5, y gives 0.75 */
    const double a3[9] = {0, 0.5, 0, 0, 0.5, 1, 0, 0.5, 0};
    double b3[9] = {0, 0, 0, 0, 0.9, 1, 0, 1, 0};
    assert_true(reference_filter(b3, a3, all, 3, 3, 1));
    assert_area(b3[4], 0.5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_patch_covers_a_quarter),
        cmocka_unit_test(patches_may_straddle_the_light),
        cmocka_unit_test(spans_are_half_open),
        cmocka_unit_test(a_wall_hides_all_of_the_light),
        cmocka_unit_test(extension_closes_gaps),
        cmocka_unit_test(microquads_join_texel_centres),
        cmocka_unit_test(microquad_and_its_rectangle_differ_on_slants),
        cmocka_unit_test(microquad_meshes_have_no_seams),
        cmocka_unit_test(patterns_are_where_they_should_be),
        cmocka_unit_test(levels_take_their_depth_and_place),
        cmocka_unit_test(level_follows_the_budget),
        cmocka_unit_test(layers_unite_or_the_darkest_counts),
        cmocka_unit_test(nothing_behind_the_light_occludes),
        cmocka_unit_test(directional_light_is_a_disc),
        cmocka_unit_test(lights_without_size_cast_hard_shadows),
        cmocka_unit_test(bias_leaves_out_what_it_should),
        cmocka_unit_test(microquads_keep_to_their_band),
        cmocka_unit_test(states_decide_without_a_look),
        cmocka_unit_test(hierarchies_on_odd_sizes),
        cmocka_unit_test(filter_by_hand),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
