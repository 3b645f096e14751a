/* Contours by marching squares: every way of extracting them gives the same edges and the same occlusion. Every case
 * has a fixed seed. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "contour_case.h"
#include "reference_backs.h"
#include "reference_contour.h"
#include "reference_hierarchy.h"
#include "reference_separate.h"

static int compare_edges(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(reference_contour_edge));
}

/* Equal as sets. Sorts both. */
static bool same_contours(reference_contour *a, reference_contour *b)
{
    if (a->count != b->count || a->count == 0)
        return a->count == b->count;
    qsort(a->edges, a->count, sizeof(*a->edges), compare_edges);
    qsort(b->edges, b->count, sizeof(*b->edges), compare_edges);
    return memcmp(a->edges, b->edges, a->count * sizeof(*a->edges)) == 0;
}

static void nodes_bound_their_samples(void **unused)
{
    (void)unused;
    static float g[texels];
    uint64_t state = 1;
    const reference_settings settings = {0};
    const reference_map map = build_map(setup_on_light, 0.6, 0);
    reference_dual_grid grid;
    random_map(&state, &map, g);
    assert_true(reference_dual_grid_create(&grid, &map, &settings, g));
    assert_int_equal(grid.level_count, 7); /* 38 cells */
    for (uint32_t level = 0; level < grid.level_count; ++level) {
        for (int32_t y = -1; y < height; ++y) {
            for (int32_t x = -1; x < width; ++x) {
                const int32_t span = 1 << level;
                const reference_node *const node = reference_dual_grid_node(&grid, level, x, y);
                const reference_range range = reference_block_range(g, width, height, x, y, x + span, y + span);
                bool folds = false;
                for (int32_t j = y; j < y + span && j < height; ++j)
                    for (int32_t i = x; i < x + span && i < width; ++i)
                        folds = folds || reference_dual_grid_node(&grid, 0, i, j)->folds;
                assert_true(node->min == (double)range.min && node->max == (double)range.max && node->folds == folds);
            }
        }
    }
    reference_dual_grid_destroy(&grid);
}

static void block_statuses_are_never_wrong(void **unused)
{
    (void)unused;
    static float g[texels];
    uint64_t state = 2;
    uint32_t found[3] = {0};
    for (int round = 0; round < 200; ++round) {
        const reference_map map = build_map((setup_kind)(round % setup_count), 0.6, 0);
        const reference_settings settings =
            random_settings(&state, round % 2 ? SOFTSH_PRIMITIVE_MICROQUAD : SOFTSH_PRIMITIVE_MICROPATCH);
        reference_dual_grid grid;
        random_map(&state, &map, g);
        assert_true(reference_dual_grid_create(&grid, &map, &settings, g));
        for (int k = 0; k < 100; ++k) {
            const reference_receiver receiver = random_receiver(&state, &map);
            const uint32_t level = reference_random(&state) % 4;
            const int32_t x = (int32_t)(reference_random(&state) % (grid.columns + 1)) - 1;
            const int32_t y = (int32_t)(reference_random(&state) % (grid.rows + 1)) - 1;
            double low[3], high[3];
            reference_dual_grid_bounds(&grid, level, x, y, low, high);
            const reference_status status = reference_block_status(&map, &settings, &receiver, low, high);
            ++found[status];
            for (int32_t j = y < 0 ? 0 : y; j <= y + (1 << level) && j < (int32_t)grid.rows; ++j)
                for (int32_t i = x < 0 ? 0 : x; i <= x + (1 << level) && i < (int32_t)grid.columns; ++i)
                    assert_true(
                        status == REFERENCE_MIXED ||
                        reference_occludes(&map, &settings, &receiver, reference_dual_grid_place(&grid, i, j)) ==
                            (status == REFERENCE_FULL));
        }
        reference_dual_grid_destroy(&grid);
    }
    assert_true(found[0] > 1000 && found[1] > 1000 && found[2] > 1000);
}

static bool never(void *user, uint32_t level, int32_t x, int32_t y)
{
    (void)user, (void)level, (void)x, (void)y;
    return false;
}

static bool note_cell(void *user, int32_t x, int32_t y)
{
    uint8_t *const seen = user;
    assert_true(x >= 3 && y >= 5);
    ++seen[(y - 5) * 64 + x - 3];
    return true;
}

/* Seed check S6: 1 + 4 + 16 nodes to the 64 cells of an unpruned 8 x 8 kernel. Any kernel is visited once and whole. */
static void walks_visit_every_cell_once(void **unused)
{
    (void)unused;
    for (int32_t columns = 1; columns <= 20; ++columns) {
        for (int32_t rows = 1; rows <= 20; ++rows) {
            static uint8_t seen[64 * 64];
            const reference_rect cells = {3, 5, 2 + columns, 4 + rows};
            reference_walk walk;
            memset(seen, 0, sizeof(seen));
            reference_dual_grid_walk(cells, NULL, never, note_cell, seen, &walk);
            for (int32_t i = 0; i < 64 * 64; ++i)
                assert_int_equal(seen[i], i % 64 < columns && i / 64 < rows);
            assert_int_equal(walk.cells, columns * rows);
            assert_true(walk.stack_depth <= 3 * 5 + 1);
            if (columns == 8 && rows == 8)
                assert_int_equal(walk.nodes, 21);
        }
    }
}

/* The side of an edge's line a point is on: positive to the left. */
static double side_of(const double from[2], const double to[2], double x, double y)
{
    return (to[0] - from[0]) * (y - from[1]) - (to[1] - from[1]) * (x - from[0]);
}

static void cells_are_cut_the_same_way_all_around(void **unused)
{
    (void)unused;
    static const double corner_x[4] = {0, 1, 1, 0}, corner_y[4] = {0, 0, 1, 1};
    for (int code = 0; code < 16; ++code) {
        bool occludes[4], turned[4];
        reference_contour_edge edges[2], turned_edges[2];
        for (int k = 0; k < 4; ++k)
            turned[(k + 1) % 4] = occludes[k] = (code >> k & 1) != 0;
        const uint32_t count = reference_marching_squares(0, 0, occludes, edges);
        assert_int_equal(count, code == 0 || code == 15 ? 0 : code == 5 || code == 10 ? 2 : 1);
        assert_int_equal(reference_marching_squares(0, 0, turned, turned_edges), count);
        for (uint32_t i = 0; i < count; ++i) {
            double end[2][2];
            for (int k = 0; k < 2; ++k) {
                const reference_contour_vertex *const vertex = k ? &edges[i].to : &edges[i].from;
                end[k][0] = vertex->x + (vertex->side == 0 ? 0.5 : vertex->side == 2 ? -0.5 : 0.0);
                end[k][1] = vertex->y + (vertex->side == 1 ? 0.5 : vertex->side == 3 ? -0.5 : 0.0);
                /* A vertex belongs to a corner that occludes, and lies on the cell's border. */
                assert_true(occludes[vertex->y ? 3 - vertex->x : vertex->x]);
                assert_true(fabs(end[k][0] - 0.5) + fabs(end[k][1] - 0.5) == 0.5);
            }
            /* Occluders to the left: all of them in the cases of one edge, the corner that is cut off in the others. */
            for (int k = 0; k < 4; ++k) {
                const double side = side_of(end[0], end[1], corner_x[k], corner_y[k]);
                if (count == 1)
                    assert_true(occludes[k] ? side > 0.0 : side < 0.0);
            }
            assert_true(side_of(end[0], end[1], edges[i].from.x, edges[i].from.y) > 0.0);
            if (count == 2)
                assert_true(side_of(end[0], end[1], 0.5, 0.5) < 0.0);
            /* Turned by a right angle, the cell has turned edges. */
            bool found = false;
            for (uint32_t j = 0; j < count; ++j) {
                const reference_contour_edge *const t = &turned_edges[j];
                found = found || (t->from.side == (edges[i].from.side + 1) % 4 && t->from.x == 1 - edges[i].from.y &&
                                  t->from.y == edges[i].from.x && t->to.side == (edges[i].to.side + 1) % 4 &&
                                  t->to.x == 1 - edges[i].to.y && t->to.y == edges[i].to.x);
            }
            assert_true(found);
        }
    }
}

/* One texel occludes: half a texel's area, a diamond. In a checkerboard diamonds touch and stay apart. */
static void lone_texels_are_diamonds(void **unused)
{
    (void)unused;
    static float g[texels];
    const reference_map map = build_map(setup_on_light, 0.6, 0);
    const reference_settings settings = {.primitive = SOFTSH_PRIMITIVE_MICROPATCH};
    for (int board = 0; board < 2; ++board) {
        uint32_t occluders = 0;
        for (int i = 0; i < texels; ++i) {
            const int x = i % width, y = i / width;
            const bool set = board ? x % 2 == y % 2 && x >= 14 && x < 20 && y >= 12 && y < 16 : x == 17 && y == 14;
            g[i] = set ? 1.0f : 0.01f;
            occluders += set;
        }
        reference_dual_grid grid;
        reference_contour contour = {0};
        reference_occlusion o;
        assert_true(reference_dual_grid_create(&grid, &map, &settings, g));
        /* Straight under the light's centre, so that all of the occluders are inside the light. */
        const reference_receiver receiver = {
            .state = REFERENCE_RECEIVER_ACTIVE, .uvg = {17.5, 14.2, 0.25}, .eta = 1e-6, .side = 1};
        assert_true(reference_contour_extract(&grid, &map, &settings, &receiver, 1, all_samples(&grid),
                                              REFERENCE_EXTRACT_SCAN, NULL, &contour));
        assert_int_equal(contour.count, 4 * occluders);
        reference_contour_occlusion(&grid, &map, &settings, &receiver, &contour, &o);
        double corners[2][2];
        const double raised = reference_raised_g(&map, &settings, &receiver), place[3] = {17, 14, 1},
                     opposite[3] = {18, 15, 1}, from[3] = {17.5, 14.2, raised};
        reference_map_backproject(&map, from, place, corners[0]);
        reference_map_backproject(&map, from, opposite, corners[1]);
        const double texel = (corners[1][0] - corners[0][0]) * (corners[1][1] - corners[0][1]) / 4.0;
        assert_true(fabs(o.area - 0.5 * occluders * texel) < 1e-12);
        reference_contour_free(&contour);
        reference_dual_grid_destroy(&grid);
    }
}

/* Whether every vertex is where one edge ends and one begins. */
static bool closed(const reference_contour *contour)
{
    for (size_t i = 0; i < contour->count; ++i) {
        uint32_t begins = 0, ends = 0;
        for (size_t j = 0; j < contour->count; ++j) {
            begins += memcmp(&contour->edges[i].to, &contour->edges[j].from, sizeof(reference_contour_vertex)) == 0;
            ends += memcmp(&contour->edges[i].to, &contour->edges[j].to, sizeof(reference_contour_vertex)) == 0;
        }
        if (begins != 1 || ends != 1)
            return false;
    }
    return true;
}

/* Scan of the whole map, scan and walk of the kernel, walks from other nodes; receivers on and beside the map. */
static void every_extraction_gives_one_contour(void **unused)
{
    (void)unused;
    static float g[texels];
    uint64_t state = 5, scanned = 0, walked = 0;
    uint32_t penumbra = 0;
    for (int round = 0; round < 300; ++round) {
        const reference_map map = build_map((setup_kind)(round % setup_count), 0.4, 0);
        const reference_settings settings = random_settings(&state, SOFTSH_PRIMITIVE_MICROPATCH);
        reference_dual_grid grid;
        random_map(&state, &map, g);
        assert_true(reference_dual_grid_create(&grid, &map, &settings, g));
        for (int k = 0; k < 8; ++k) {
            const reference_receiver receiver = random_receiver(&state, &map);
            const reference_rect kernel = reference_dual_grid_kernel(&grid, &map, &settings, &receiver, highest(&grid));
            reference_contour all = {0}, scan = {0}, walk = {0};
            reference_occlusion of_all, of_kernel;
            assert_true(reference_contour_extract(&grid, &map, &settings, &receiver, 1, all_samples(&grid),
                                                  REFERENCE_EXTRACT_SCAN, NULL, &all));
            assert_true(reference_contour_extract(&grid, &map, &settings, &receiver, 1, kernel, REFERENCE_EXTRACT_SCAN,
                                                  NULL, &scan));
            assert_false(all.diverged || scan.diverged);
            assert_true(closed(&scan));
            for (int from = 0; from < 4; ++from) {
                const int32_t level = (int32_t)grid.level_count - 1;
                const int32_t starts[3][3] = {{-1, -1, level}, {kernel.x0 - 1, -1, level}, {-1, kernel.y0 - 1, level}};
                assert_true(reference_contour_extract(&grid, &map, &settings, &receiver, 1, kernel,
                                                      REFERENCE_EXTRACT_WALK, from ? starts[from - 1] : NULL, &walk));
                assert_true(same_contours(&scan, &walk));
                if (from == 0) {
                    scanned += scan.walk.cells;
                    walked += walk.walk.nodes + walk.walk.cells;
                }
            }
            reference_contour_occlusion(&grid, &map, &settings, &receiver, &all, &of_all);
            reference_contour_occlusion(&grid, &map, &settings, &receiver, &walk, &of_kernel);
            if (!same_masks(&of_all, &of_kernel) || !(fabs(of_all.area - of_kernel.area) < 1e-9))
                fail_msg("round %d, receiver %d: area %.17g and %.17g, %u and %u samples", round, k, of_all.area,
                         of_kernel.area, of_all.occluded, of_kernel.occluded);
            penumbra += in_penumbra(&of_all);
            reference_contour_free(&all);
            reference_contour_free(&scan);
            reference_contour_free(&walk);
        }
        reference_dual_grid_destroy(&grid);
    }
    assert_true(penumbra > 400);
    assert_true(walked < scanned);
}

/* Packets of 1 x 1 to 4 x 4 neighbours. What the receiver would have extracted alone, it gets from the packet. */
static void packets_give_what_pixels_give(void **unused)
{
    (void)unused;
    static float g[texels];
    uint64_t state = 6, alone = 0, together = 0;
    uint32_t coherent = 0, divergent = 0, penumbra = 0;
    for (int round = 0; round < 400; ++round) {
        const uint32_t side = 1 + (uint32_t)round % 4, count = side * side;
        const reference_map map = build_map((setup_kind)(round / 4 % setup_count), 0.4, 0);
        const reference_settings settings = random_settings(&state, SOFTSH_PRIMITIVE_MICROPATCH);
        reference_dual_grid grid;
        reference_receiver receivers[16];
        reference_rect ranges[16];
        reference_occlusion packed[16];
        reference_contour one = {0}, scan = {0}, walk = {0};
        reference_rect all;
        random_map(&state, &map, g);
        assert_true(reference_dual_grid_create(&grid, &map, &settings, g));
        /* On one plane, a pixel's distance apart. */
        const reference_receiver first = random_receiver(&state, &map);
        const double step = reference_random_range(&state, 0.0, round % 8 < 4 ? 0.1 : 1.0);
        for (uint32_t i = 0; i < count; ++i) {
            const double du = step * (i % side), dv = step * (i / side);
            receivers[i] = first;
            receivers[i].uvg[0] += du;
            receivers[i].uvg[1] += dv;
            receivers[i].uvg[2] += first.gradient[0] * du + first.gradient[1] * dv;
            ranges[i] = reference_dual_grid_kernel(&grid, &map, &settings, &receivers[i], highest(&grid));
            all = i == 0 ? ranges[0] : reference_rect_union(all, ranges[i]);
        }
        assert_true(reference_contour_extract(&grid, &map, &settings, receivers, count, all, REFERENCE_EXTRACT_SCAN,
                                              NULL, &scan));
        assert_true(reference_contour_extract(&grid, &map, &settings, receivers, count, all, REFERENCE_EXTRACT_WALK,
                                              NULL, &walk));
        assert_int_equal(scan.diverged, walk.diverged);
        assert_true(scan.diverged || same_contours(&scan, &walk));
        reference_walk visited;
        bool diverged;
        assert_true(
            reference_contour_packet(&grid, &map, &settings, receivers, ranges, count, &visited, &diverged, packed));
        assert_int_equal(diverged, scan.diverged);
        assert_true(count > 1 || !diverged);
        coherent += count > 1 && !diverged;
        divergent += diverged;
        for (uint32_t i = 0; i < count; ++i) {
            reference_occlusion o;
            assert_true(reference_contour_extract(&grid, &map, &settings, &receivers[i], 1, all, REFERENCE_EXTRACT_WALK,
                                                  NULL, &one));
            assert_true(diverged || same_contours(&scan, &one));
            assert_true(reference_contour_extract(&grid, &map, &settings, &receivers[i], 1, ranges[i],
                                                  REFERENCE_EXTRACT_WALK, NULL, &one));
            reference_contour_occlusion(&grid, &map, &settings, &receivers[i], &one, &o);
            assert_true(same_masks(&o, &packed[i]) && fabs(o.area - packed[i].area) < 1e-9);
            penumbra += in_penumbra(&o);
            if (!diverged && count > 1) {
                alone += one.walk.nodes + one.walk.cells;
                together += i == 0 ? visited.nodes + visited.cells : 0;
            }
        }
        reference_contour_free(&one);
        reference_contour_free(&scan);
        reference_contour_free(&walk);
        reference_dual_grid_destroy(&grid);
    }
    assert_true(coherent > 100 && divergent > 15 && penumbra > 300);
    assert_true(2 * together < alone);
}

/* Where no cell folds, nothing is cut: contours are the joined ones, and cover nothing twice. On planes of any slope
 * second differences cut nothing either. */
static void smooth_surfaces_are_not_cut(void **unused)
{
    (void)unused;
    static float g[texels];
    uint64_t state = 8;
    uint32_t smooth = 0, folded = 0;
    for (int round = 0; round < 80; ++round) {
        const reference_map map = build_map((setup_kind)(round % setup_count), round < 40 ? 1e-4 : 0.6, 0);
        reference_settings settings = random_settings(&state, SOFTSH_PRIMITIVE_MICROPATCH);
        reference_dual_grid grid;
        settings.aggregation = SOFTSH_AGGREGATION_SAMPLED;
        random_map(&state, &map, g);
        assert_true(reference_dual_grid_create(&grid, &map, &settings, g));
        const bool folds = reference_dual_grid_node(&grid, grid.level_count - 1, -1, -1)->folds;
        smooth += !folds;
        folded += folds;
        for (int k = 0; k < 20; ++k) {
            const reference_receiver receiver = random_receiver(&state, &map);
            reference_contour joined = {0};
            reference_occlusion o;
            reference_separate s;
            uint64_t covered = 0;
            assert_true(reference_contour_extract(&grid, &map, &settings, &receiver, 1, all_samples(&grid),
                                                  REFERENCE_EXTRACT_SCAN, NULL, &joined));
            reference_contour_occlusion(&grid, &map, &settings, &receiver, &joined, &o);
            reference_separate_layer(&grid, &map, &settings, &receiver, SOFTSH_RECONSTRUCTION_FOLDS, &s);
            for (int i = 0; i < 256; ++i)
                covered += s.covered[i];
            assert_true(covered <= s.windings && s.edges >= joined.count);
            if (!folds)
                assert_true(s.edges == joined.count && fabs(s.area - o.area) < 1e-9);
            reference_contour_free(&joined);
        }
        reference_dual_grid_destroy(&grid);

        const double slope =
            (fan_depth(&map, 1.0) - fan_depth(&map, 0.0)) * reference_random_range(&state, -0.02, 0.02);
        for (int i = 0; i < texels; ++i)
            g[i] = (float)(fan_depth(&map, 0.6) + slope * (i % width - i / width));
        assert_true(reference_dual_grid_create(&grid, &map, &settings, g));
        const reference_receiver receiver = random_receiver(&state, &map);
        for (int32_t y = 1; y + 2 < (int32_t)grid.rows; ++y)
            for (int32_t x = 1; x + 2 < (int32_t)grid.columns; ++x)
                for (int axis = 0; axis < 2; ++axis)
                    assert_false(reference_is_cut(&grid, &map, &settings, &receiver,
                                                  SOFTSH_RECONSTRUCTION_SECOND_DIFFERENCES, x, y, axis));
        reference_dual_grid_destroy(&grid);
    }
    assert_true(smooth > 20 && folded > 20);
}

/* Of cells of planes, steep ones too: exactly those turn over on the light whose plane passes below the receiver. */
static void images_of_backs_are_turned_over(void **unused)
{
    (void)unused;
    static float g[texels];
    uint64_t state = 77;
    uint32_t backs = 0, fronts = 0;
    for (int round = 0; round < 200; ++round) {
        const reference_map map = build_map((setup_kind)(round % setup_count), 0.6, 0);
        reference_settings settings = random_settings(&state, SOFTSH_PRIMITIVE_MICROPATCH);
        reference_dual_grid grid;
        settings.aggregation = SOFTSH_AGGREGATION_SAMPLED;
        settings.level = 0;
        const double turn = map.a[0][0] * map.a[1][1] - map.a[0][1] * map.a[1][0] < 0.0 ? -1.0 : 1.0;
        const double range = fan_depth(&map, 1.0) - fan_depth(&map, 0.0);
        const double along_u = range * reference_random_range(&state, -0.4, 0.4),
                     along_v = range * reference_random_range(&state, -0.4, 0.4);
        for (int i = 0; i < texels; ++i)
            g[i] =
                (float)(fan_depth(&map, 0.5) + along_u * (i % width - width / 2) + along_v * (i / width - height / 2));
        assert_true(reference_dual_grid_create(&grid, &map, &settings, g));
        for (int k = 0; k < 20; ++k) {
            const reference_receiver receiver = random_receiver(&state, &map);
            const double raised[3] = {receiver.uvg[0], receiver.uvg[1], reference_raised_g(&map, &settings, &receiver)};
            for (int32_t y = 0; y + 1 < (int32_t)grid.rows; ++y)
                for (int32_t x = 0; x + 1 < (int32_t)grid.columns; ++x) {
                    static const int32_t corner_x[4] = {0, 1, 1, 0}, corner_y[4] = {0, 0, 1, 1};
                    double q[4][2], area = 0.0, size = 0.0;
                    bool before = true;
                    for (int i = 0; i < 4 && before; ++i) {
                        const double *const place = reference_dual_grid_place(&grid, x + corner_x[i], y + corner_y[i]);
                        before = place[2] > raised[2];
                        if (before)
                            reference_map_backproject(&map, raised, place, q[i]);
                    }
                    for (int i = 0; i < 4 && before; ++i) {
                        const double *const a = q[i], *const b = q[(i + 1) % 4];
                        area += 0.5 * turn * (a[0] * b[1] - a[1] * b[0]);
                        size += fabs(a[0]) + fabs(a[1]);
                    }
                    if (!before || fabs(area) < 1e-6 * size * size)
                        continue;
                    const bool back = reference_seen_from_behind(&grid, &map, &settings, &receiver, x, y);
                    backs += back;
                    fronts += !back;
                    assert_true(back == (area < 0.0));
                }
        }
        reference_dual_grid_destroy(&grid);
    }
    assert_true(backs > 1000 && fronts > 1000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nodes_bound_their_samples),       cmocka_unit_test(block_statuses_are_never_wrong),
        cmocka_unit_test(walks_visit_every_cell_once),     cmocka_unit_test(cells_are_cut_the_same_way_all_around),
        cmocka_unit_test(lone_texels_are_diamonds),        cmocka_unit_test(every_extraction_gives_one_contour),
        cmocka_unit_test(packets_give_what_pixels_give),   cmocka_unit_test(smooth_surfaces_are_not_cut),
        cmocka_unit_test(images_of_backs_are_turned_over),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
