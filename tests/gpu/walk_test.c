/* The walk for contours down the dual grid against the search in strips, which finds the same contours; and how many
 * nodes and cells it looks at for them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fixture.h"
#include "reference_dual_grid.h"
#include "reference_matrix.h"
#include "scenes.h"

enum { WIDTH = 40, HEIGHT = 30, PIXELS = WIDTH * HEIGHT };

/* On one scene after the other, with each of the hierarchies: kernels of several nodes, cut by borders, and receivers
 * outside the map; levels as budgets choose them. */
static void walks_find_what_strips_find(void **state)
{
    static const softsh_settings views[] = {
        {.packet = SOFTSH_PACKET_1X1},
        {.packet = SOFTSH_PACKET_1X1, .no_hierarchy = 1, .merge = SOFTSH_MERGE_UNION},
        {.packet = SOFTSH_PACKET_1X1, .budget = 9},
        {.packet = SOFTSH_PACKET_1X1, .min_level = 2, .sparse = 1},
        {.packet = SOFTSH_PACKET_2X2, .merge = SOFTSH_MERGE_UNION},
        {.packet = SOFTSH_PACKET_3X3, .budget = 20},
        {.packet = SOFTSH_PACKET_4X4},
        {.packet = SOFTSH_PACKET_4X4, .budget = 32, .sparse = 1},
        {.packet = SOFTSH_PACKET_4X4, .no_hierarchy = 1, .budget = 24},
        {.packet = SOFTSH_PACKET_ADAPTIVE, .min_level = 1},
    };
    static const softsh_accel accels[] = {SOFTSH_ACCEL_HSM, SOFTSH_ACCEL_MSSM, SOFTSH_ACCEL_YSM};
    (void)state;
    for (size_t k = 0; k < sizeof views / sizeof *views; k++) {
        static float strips[PIXELS], walked[PIXELS];
        sight_info info = {.settings = views[k], .width = WIDTH, .height = HEIGHT};
        /* Packets that diverge leave more or less behind, and which pixels are interpolated is a matter of the last
         * bit: a few differ by what that costs. */
        const bool same_edges = views[k].packet == SOFTSH_PACKET_1X1 && !views[k].sparse;
        uint64_t between = 0, edges = 0, apart = 0;
        double most = 0.0;
        sight by_strips, by_walk;
        info.settings.technique = SOFTSH_TECHNIQUE_CONTOUR;
        info.settings.search = SOFTSH_SEARCH_STRIPS;
        sight_create(&info, &by_strips);
        info.settings.search = SOFTSH_SEARCH_WALK;
        sight_create(&info, &by_walk);
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
                softsh_stats right, stats;
                scene s;
                lamp l;
                eye e;
                scene_create(&from, &s);
                s.eye.normals = NULL;
                s.lamp.dual_grids = true;
                s.lamp.accel = accels[(size_t)(light + content) % 3];
                s.lamp.ysm_join = k % 2 ? 33 : 20;
                lamp_create(&s.lamp, &l);
                eye_create(&s.eye, &e);
                sight_run(&by_strips, &l, &e, NULL, strips, &right);
                sight_run(&by_walk, &l, &e, NULL, walked, &stats);
                for (int i = 0; i < PIXELS; i++) {
                    const double difference = fabs((double)strips[i] - (double)walked[i]);
                    most = difference <= most ? most : difference;
                    apart += !(difference <= 1e-5);
                    between += strips[i] > 0.0f && strips[i] < 1.0f;
                }
                assert_int_equal(stats.lit, right.lit);
                assert_int_equal(stats.umbra, right.umbra);
                assert_int_equal(stats.active, right.active);
                if (same_edges) {
                    assert_int_equal(stats.edges, right.edges);
                    assert_int_equal(stats.primitives, right.primitives);
                }
                edges += stats.edges;
                eye_destroy(&e);
                lamp_destroy(&l);
                scene_destroy(&s);
            }
        print_message("view %u: %.1e apart, %u pixels notably, %u of %u in between, %u edges\n", (unsigned)k, most,
                      (unsigned)apart, (unsigned)between, 15 * PIXELS, (unsigned)edges);
        assert_true(between > PIXELS && edges > 10 * PIXELS);
        assert_true(apart <= (views[k].sparse ? 5u : 0u) && most <= 0.05);
        sight_destroy(&by_walk);
        sight_destroy(&by_strips);
    }
}

/* A floor of 40 x 40 texels, 10 below the light, that a camera sees SIDE x SIDE texels of, one in a pixel; 5 above it a
 * checkerboard, of texels or of wide squares. The kernel of what is seen in the middle of a texel has SAMPLES a side,
 * and CELLS cells around them. */
enum { TEXELS = 40, SIDE = 8, SAMPLES = 7, CELLS = SAMPLES + 1, FIRST = 13 };

static void board_create(uint32_t square, scene *s)
{
    static const double nowhere[3] = {0, 0, 0}, up[3] = {0, 1, 0}, floor_at[3] = {0, 0, -10}, at[3] = {0, 0, -6};
    const reference_surface floor_below = {.infinite = true, .center = {0, 0, -10}, .u = {1, 0, 0}, .v = {0, 1, 0}};
    const double seen = 5.0 * SIDE / TEXELS;
    reference_map map;
    memset(s, 0, sizeof *s);
    s->lamp.light.struct_size = sizeof s->lamp.light;
    s->lamp.light.half_u[0] = s->lamp.light.half_v[1] = (SAMPLES - 1.5) / (0.2 * TEXELS);
    s->lamp.place = (placement){.width = TEXELS, .height = TEXELS};
    s->lamp.layer_count = 1;
    s->lamp.dual_grids = true;
    s->eye.place = (placement){.width = SIDE, .height = SIDE};
    reference_look_at(nowhere, floor_at, up, s->lamp.view);
    reference_perspective((const double[4]){-0.5, 0.5, -0.5, 0.5}, 1.0, 30.0, REFERENCE_DEPTH_REVERSED,
                          s->lamp.layers[0].projection);
    reference_look_at(at, floor_at, up, s->eye.view);
    reference_orthographic((const double[4]){-seen, seen, -seen, seen}, 0.1, 10.0, REFERENCE_DEPTH_NORMAL,
                           s->eye.projection);
    scene_cast(s, &floor_below, 1);
    s->eye.normals = NULL;
    lamp_reference(&s->lamp, &map);
    for (uint32_t i = 0; i < TEXELS * TEXELS; i++)
        if ((i % TEXELS / square + i / TEXELS / square) % 2 == 0)
            s->map_depth[0][i] = (float)reference_map_g_to_depth(&map, 1.0 / 5.0);
}

static bool never(void *user, uint32_t level, int32_t x, int32_t y)
{
    (void)user, (void)level, (void)x, (void)y;
    return false;
}

static bool on(void *user, int32_t x, int32_t y)
{
    (void)user, (void)x, (void)y;
    return true;
}

/* The smallest node that spans cells of one axis after the other and is aligned up to a join; counted, as on the
 * device, from the cell before the first sample. */
static uint32_t unpruned_nodes(uint32_t x, uint32_t y, uint32_t join)
{
    const reference_rect cells = {(int32_t)x, (int32_t)y, (int32_t)x + CELLS - 1, (int32_t)y + CELLS - 1};
    for (uint32_t level = 0;; level++) {
        const uint32_t step = 1u << (level < join ? level : join);
        const int32_t start[3] = {(int32_t)(x / step * step), (int32_t)(y / step * step), (int32_t)level};
        if (start[0] + (1 << level) <= cells.x1 || start[1] + (1 << level) <= cells.y1)
            continue;
        reference_walk walk;
        reference_dual_grid_walk(cells, start, never, on, NULL, &walk);
        assert_int_equal(walk.cells, CELLS * CELLS);
        return (uint32_t)walk.nodes;
    }
}

/* Seed check S6. */
static void unpruned_kernels_take_21_nodes(void **state)
{
    static const struct {
        const char *name;
        softsh_accel accel;
        uint32_t ysm_join, join;
    } forms[] = {{"MSSM", SOFTSH_ACCEL_MSSM, 0, 0},
                 {"YSM, join 1", SOFTSH_ACCEL_YSM, TEXELS / 2, 1},
                 {"YSM, join 2", SOFTSH_ACCEL_YSM, TEXELS / 4, 2},
                 {"HSM", SOFTSH_ACCEL_HSM, 0, 6}};
    sight_info info = {.settings = {.technique = SOFTSH_TECHNIQUE_CONTOUR,
                                    .packet = SOFTSH_PACKET_1X1,
                                    .search = SOFTSH_SEARCH_WALK,
                                    .no_hierarchy = 1},
                       .width = SIDE,
                       .height = SIDE};
    sight view;
    scene s;
    (void)state;
    sight_create(&info, &view);
    board_create(1, &s);
    for (size_t k = 0; k < sizeof forms / sizeof *forms; k++) {
        float visibility[SIDE * SIDE];
        uint32_t nodes = 0, least = UINT32_MAX, most = 0;
        softsh_stats stats;
        lamp l;
        eye e;
        s.lamp.accel = forms[k].accel;
        s.lamp.ysm_join = forms[k].ysm_join;
        lamp_create(&s.lamp, &l);
        eye_create(&s.eye, &e);
        sight_run(&view, &l, &e, NULL, visibility, &stats);
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            const uint32_t n = unpruned_nodes(FIRST + i % SIDE, FIRST + i / SIDE, forms[k].join);
            nodes += n;
            least = n < least ? n : least;
            most = n > most ? n : most;
        }
        print_message("%s: %u to %u nodes, %.1f on average, on the device %.1f\n", forms[k].name, least, most,
                      (double)nodes / (SIDE * SIDE), (double)stats.visited / (SIDE * SIDE) - CELLS * CELLS);
        assert_int_equal(stats.active, SIDE * SIDE);
        assert_int_equal(stats.visited, nodes + SIDE * SIDE * CELLS * CELLS);
        assert_true(least == 21 && (forms[k].join > 0 || most == 21));
        eye_destroy(&e);
        lamp_destroy(&l);
    }
    sight_destroy(&view);
    scene_destroy(&s);
}

/* Where contours are far apart, nodes rule cells out. */
static void pruning_saves_cells(void **state)
{
    scene s;
    (void)state;
    board_create(12, &s);
    s.lamp.light.half_u[0] = s.lamp.light.half_v[1] = 2.0; /* 16 texels */
    for (int accel = SOFTSH_ACCEL_HSM; accel <= SOFTSH_ACCEL_YSM; accel++) {
        uint64_t visited[2], edges[2];
        lamp l;
        eye e;
        s.lamp.accel = (softsh_accel)accel;
        s.lamp.ysm_join = 20;
        lamp_create(&s.lamp, &l);
        eye_create(&s.eye, &e);
        for (uint32_t off = 0; off < 2; off++) {
            const sight_info info = {.settings = {.technique = SOFTSH_TECHNIQUE_CONTOUR,
                                                  .packet = SOFTSH_PACKET_1X1,
                                                  .search = SOFTSH_SEARCH_WALK,
                                                  .no_hierarchy = off},
                                     .width = SIDE,
                                     .height = SIDE};
            float visibility[SIDE * SIDE];
            softsh_stats stats;
            sight view;
            sight_create(&info, &view);
            sight_run(&view, &l, &e, NULL, visibility, &stats);
            sight_destroy(&view);
            assert_int_equal(stats.active, SIDE * SIDE);
            visited[off] = stats.visited;
            edges[off] = stats.edges;
        }
        print_message("accel %d: %u nodes and cells a pixel, without pruning %u\n", accel,
                      (unsigned)visited[0] / (SIDE * SIDE), (unsigned)visited[1] / (SIDE * SIDE));
        assert_true(edges[0] == edges[1] && edges[0] > 0);
        assert_true(visited[1] > 18 * 18 * SIDE * SIDE && 3 * visited[0] < 2 * visited[1]);
        eye_destroy(&e);
        lamp_destroy(&l);
    }
    scene_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(walks_find_what_strips_find),
        cmocka_unit_test(unpruned_kernels_take_21_nodes),
        cmocka_unit_test(pruning_saves_cells),
    };
    return cmocka_run_group_tests(tests, fixture_setup, fixture_teardown);
}
