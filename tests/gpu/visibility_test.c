/* Every estimator against the double-precision reference, pixel by pixel, without hierarchy: all receivers are
 * evaluated and no occluder is left out.
 *
 * The shader's floats move the borders of back-projections a little, so that single light samples change sides; the
 * reference is right about them, and nobody would notice. What is tested is how many do, in numbers that a mistake in
 * any formula exceeds. The table printed at the end has the differences of each estimator. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fixture.h"
#include "readback.h"
#include "reference_backs.h"
#include "reference_outline.h"
#include "reference_separate.h"
#include "reference_visibility.h"
#include "scenes.h"

enum { MAX_PIXELS = 32 * 24, SCENES = 13 };

/* Several times what the software drivers have. */
static const double mean_limit = 1e-5, notable_limit = 2.5e-4, hard_limit = 1e-4;

/* A scene on the device, and its receivers in double precision. */
typedef struct stage {
    scene_info info;
    sight_options options;
    scene scene;
    lamp lamp;
    eye eye[2];
    reference_map map;
    float *g[2];
    reference_receiver *receivers[2]; /* without and with normals */
} stage;

static stage stages[SCENES] = {
    {.info = {.light = SCENE_CENTRED}},
    {.info = {.light = SCENE_IN_FRONT, .content = SCENE_NOISE}},
    {.info = {.light = SCENE_SUN}},
    {.info = {.light = SCENE_TILTED_SUN, .content = SCENE_NOISE}},
    {.info = {.light = SCENE_ROTATED}},
    {.info = {.light = SCENE_CENTRED, .content = SCENE_NASTY}},
    {.info = {.light = SCENE_TILTED_SUN, .range = REFERENCE_DEPTH_REVERSED}},
    {.info = {.light = SCENE_IN_FRONT, .layers = 2, .range = REFERENCE_DEPTH_REVERSED_INFINITE}},
    {.info = {.light = SCENE_ROTATED, .content = SCENE_NOISE}},
    {.info = {.light = SCENE_SUN, .content = SCENE_NASTY, .layers = 2}},
    {.info = {.light = SCENE_CENTRED, .content = SCENE_NOISE}, .options = {true, 0.05}},
    {.info = {.light = SCENE_IN_FRONT, .range = REFERENCE_DEPTH_INFINITE}},
    {.info = {.light = SCENE_TILTED_SUN}, .options = {true, 0.02}},
};

/* Differences of one estimator. */
typedef struct differences {
    uint64_t pixels, penumbra, notable; /* all, partly lit ones, and those off by more than 4/256 */
    double sum, most;
    char worst[160];
} differences;

static void stage_create(stage *s)
{
    scene_create(&s->info, &s->scene);
    lamp_create(&s->scene.lamp, &s->lamp);
    lamp_reference(&s->scene.lamp, &s->map);
    for (uint32_t i = 0; i < s->scene.lamp.layer_count; i++) {
        s->g[i] = malloc((size_t)s->map.width * s->map.height * sizeof(float));
        assert_non_null(s->g[i]);
        lamp_fan_depth(&s->scene.lamp, i, s->g[i]);
    }
    for (int normals = 0; normals < 2; normals++) {
        eye_info info = s->scene.eye;
        reference_camera camera;
        if (!normals)
            info.normals = NULL;
        eye_create(&info, &s->eye[normals]);
        eye_reference(&info, &camera);
        const reference_camera_image image = {info.depth, info.normals};
        reference_bias bias = precision_of(&s->scene.lamp, &info);
        bias.override_bias = s->options.override_bias;
        bias.bias = s->options.bias;
        s->receivers[normals] = calloc(MAX_PIXELS, sizeof *s->receivers[normals]);
        assert_non_null(s->receivers[normals]);
        for (uint32_t i = 0; i < camera.width * camera.height; i++)
            reference_receiver_derive(&s->receivers[normals][i], &s->map, &camera, &image, &bias, i % camera.width,
                                      i / camera.width);
    }
}

static void stage_destroy(stage *s)
{
    lamp_destroy(&s->lamp);
    for (int i = 0; i < 2; i++) {
        eye_destroy(&s->eye[i]);
        free(s->g[i]);
        free(s->receivers[i]);
    }
    scene_destroy(&s->scene);
}

/* Area within outlines; overlaps of quads count twice, but clipped to the light each. */
static double outline_area(const reference_dual_grid *grids, uint32_t layer_count, const reference_map *map,
                           const reference_settings *settings, const reference_receiver *receiver)
{
    reference_outline outline = {0};
    double area = 0.0;
    if (receiver->state != REFERENCE_RECEIVER_ACTIVE)
        return 0.0;
    for (uint32_t i = 0; i < layer_count; i++) {
        const reference_rect all = {0, 0, (int32_t)grids[i].columns - 1, (int32_t)grids[i].rows - 1};
        reference_occlusion layer;
        assert_true(reference_outline_extract(&grids[i], map, settings, receiver, 1, all, REFERENCE_EXTRACT_WALK, NULL,
                                              &outline));
        reference_outline_occlusion(&grids[i], map, settings, receiver, &outline, &layer);
        area = settings->merge == SOFTSH_MERGE_MAXIMUM ? fmax(area, layer.area) : area + layer.area;
    }
    reference_outline_free(&outline);
    return fmin(area, 1.0);
}

/* What the settings ask for, of all receivers. */
static void reference_image(const stage *s, const softsh_settings *settings, bool normals, double *visibility)
{
    const float *const layers[2] = {s->g[0], s->g[1]};
    const reference_settings wanted = {.pattern = settings->pattern,
                                       .primitive = settings->primitive,
                                       .aggregation = settings->aggregation,
                                       .merge = settings->merge,
                                       .level = settings->min_level};
    const uint32_t layer_count = s->scene.lamp.layer_count;
    const bool contours = settings->technique == SOFTSH_TECHNIQUE_CONTOUR && !s->map.point;
    const bool outlines = settings->outline && settings->technique == SOFTSH_TECHNIQUE_AREA;
    reference_dual_grid grids[2];
    for (uint32_t i = 0; i < layer_count && (contours || outlines); i++)
        assert_true(reference_dual_grid_create(&grids[i], &s->map, &wanted, layers[i]));
    for (uint32_t i = 0; i < MAX_PIXELS; i++) {
        const reference_receiver *const r = &s->receivers[normals][i];
        reference_occlusion o;
        if (contours && settings->reconstruction == SOFTSH_RECONSTRUCTION_BACKS) {
            assert_true(reference_backs_visibility(grids, layer_count, &s->map, &wanted, r, &visibility[i]));
            continue;
        }
        if (contours && settings->reconstruction > SOFTSH_RECONSTRUCTION_JOINED) {
            visibility[i] =
                reference_separate_visibility(grids, layer_count, &s->map, &wanted, r, settings->reconstruction);
            continue;
        }
        if (contours) {
            assert_true(reference_contour_visibility(grids, layer_count, &s->map, &wanted, r, &visibility[i]));
            continue;
        }
        if (outlines) {
            visibility[i] = reference_visible(r, outline_area(grids, layer_count, &s->map, &wanted, r));
            continue;
        }
        assert_true(reference_visibility(&s->map, layers, layer_count, &wanted, r, &o));
        visibility[i] =
            reference_visible(r, settings->technique == SOFTSH_TECHNIQUE_AREA ? fmin(o.area, 1.0) : o.bitmask);
    }
    for (uint32_t i = 0; i < layer_count && (contours || outlines); i++)
        reference_dual_grid_destroy(&grids[i]);
}

static void compare(const stage *s, sight *view, const softsh_settings *settings, bool normals, differences *out)
{
    float visibility[MAX_PIXELS];
    double reference[MAX_PIXELS];

    sight_run(view, &s->lamp, &s->eye[normals], &s->options, visibility, NULL);
    reference_image(s, settings, normals, reference);
    for (uint32_t i = 0; i < MAX_PIXELS; i++) {
        const double right = reference[i], difference = fabs((double)visibility[i] - right);
        out->penumbra += right > 0.0 && right < 1.0;
        /* Not a number is not near anything. */
        out->notable += !(difference <= 4.0 / 256.0);
        out->sum += difference;
        out->pixels++;
        if (!(difference <= out->most)) {
            out->most = difference;
            snprintf(out->worst, sizeof out->worst, "%s, %s%s, aggregation %d, level %u, pixel (%u, %u): %.4f for %.4f",
                     scene_light_name(s->info.light), scene_content_name(s->info.content), normals ? ", normals" : "",
                     (int)settings->aggregation, settings->min_level, i % 32, i / 32, (double)visibility[i], right);
        }
    }
}

/* Levels `first` to 2 of one view, each seen by `scenes` of the scenes; the walk through the scenes goes on from view
 * to view. */
static void check_view(softsh_settings settings, bool normals, uint32_t first, uint32_t scenes, uint32_t *next,
                       differences *out)
{
    const bool patches = settings.primitive == SOFTSH_PRIMITIVE_MICROPATCH ||
                         settings.primitive == SOFTSH_PRIMITIVE_MICROPATCH_UNEXTENDED;
    const sight_info info = {.settings = settings, .width = 32, .height = 24, .normals = normals};
    sight view;

    sight_create(&info, &view);
    for (settings.min_level = first; settings.min_level <= 2; settings.min_level++) {
        sight_set_level(&view, settings.min_level);
        for (uint32_t k = 0; k < scenes; k++) {
            while (patches && stages[*next % SCENES].info.light == SCENE_ROTATED)
                ++*next;
            compare(&stages[(*next)++ % SCENES], &view, &settings, normals, out);
        }
    }
    sight_destroy(&view);
}

static void print_heading(void)
{
    print_message("%-9s%-23s%-16s%9s%9s%10s%12s\n", "", "primitive", "pattern", "penumbra", "maximum", "mean",
                  "over 4/256");
}

static bool within_limits(const char *technique, const char *primitive, const char *pattern, const differences *d)
{
    const double pixels = (double)d->pixels;
    print_message("%-9s%-23s%-16s%8.1f%%%9.5f%10.7f%11.3f%%\n", technique, primitive, pattern,
                  100.0 * (double)d->penumbra / pixels, d->most, d->sum / pixels, 100.0 * (double)d->notable / pixels);
    if (d->notable)
        print_message("         worst: %s\n", d->worst);
    assert_true((double)d->penumbra > 0.1 * pixels);
    return d->sum <= mean_limit * pixels && (double)d->notable <= notable_limit * pixels;
}

static void check_estimators(softsh_technique technique, softsh_pattern first, softsh_pattern last)
{
    static const char *const primitives[] = {"", "micropatch", "micropatch unextended", "microquad",
                                             "microquad rectangle"};
    static const char *const patterns[] = {"", "8x8", "16x16", "16x16 jittered", "32x32"};
    uint32_t next = 0, views = 0;
    bool failed = false;

    print_heading();
    for (int primitive = SOFTSH_PRIMITIVE_MICROPATCH; primitive <= SOFTSH_PRIMITIVE_MICROQUAD_RECTANGLE; primitive++)
        for (int pattern = (int)first; pattern <= (int)last; pattern++) {
            differences d = {0};
            for (uint32_t nearest = 0; nearest < 2; nearest++) {
                const softsh_settings settings = {
                    .technique = technique,
                    .pattern = (softsh_pattern)pattern,
                    .primitive = (softsh_primitive)primitive,
                    .aggregation = nearest ? SOFTSH_AGGREGATION_NEAREST : SOFTSH_AGGREGATION_SAMPLED,
                    .merge = views / 2 % 2 ? SOFTSH_MERGE_MAXIMUM : SOFTSH_MERGE_UNION,
                    .no_hierarchy = 1,
                };
                check_view(settings, views++ % 3 == 2, nearest, 3, &next, &d);
            }
            const bool area = technique == SOFTSH_TECHNIQUE_AREA;
            failed |=
                !within_limits(area ? "area" : "bitmask", primitives[primitive], area ? "" : patterns[pattern], &d);
        }
    assert_false(failed);
}

static void bitmasks_are_the_references(void **state)
{
    (void)state;
    check_estimators(SOFTSH_TECHNIQUE_BITMASK, SOFTSH_PATTERN_8X8, SOFTSH_PATTERN_32X32);
}

static void areas_are_the_references(void **state)
{
    (void)state;
    check_estimators(SOFTSH_TECHNIQUE_AREA, SOFTSH_PATTERN_16X16, SOFTSH_PATTERN_16X16);
}

/* Every scene at every level; patterns do not matter. */
static void contours_are_the_references(void **state)
{
    uint32_t next = 0;
    differences d = {0};
    (void)state;
    for (uint32_t view = 0; view < 8; view++) {
        const bool nearest = view & 1, maximum = view & 2, normals = view & 4;
        const softsh_settings settings = {
            .technique = SOFTSH_TECHNIQUE_CONTOUR,
            .pattern = SOFTSH_PATTERN_8X8,
            .aggregation = nearest ? SOFTSH_AGGREGATION_NEAREST : SOFTSH_AGGREGATION_SAMPLED,
            .merge = maximum ? SOFTSH_MERGE_MAXIMUM : SOFTSH_MERGE_UNION,
            .no_hierarchy = 1,
        };
        check_view(settings, normals, nearest, SCENES, &next, &d);
    }
    print_heading();
    assert_true(within_limits("contour", "", "", &d));
}

/* Cut apart by folds and by second differences. */
static void separate_contours_are_the_references(void **state)
{
    bool failed = false;
    uint32_t next = 0;
    (void)state;
    print_heading();
    for (uint32_t folds = 0; folds < 2; folds++) {
        differences d = {0};
        for (uint32_t view = 0; view < 2; view++) {
            const softsh_settings settings = {
                .technique = SOFTSH_TECHNIQUE_CONTOUR,
                .pattern = SOFTSH_PATTERN_8X8,
                .aggregation = SOFTSH_AGGREGATION_SAMPLED,
                .merge = view ? SOFTSH_MERGE_MAXIMUM : SOFTSH_MERGE_UNION,
                .reconstruction = folds ? SOFTSH_RECONSTRUCTION_FOLDS : SOFTSH_RECONSTRUCTION_SECOND_DIFFERENCES,
                .no_hierarchy = 1,
            };
            check_view(settings, view == 1, 0, SCENES, &next, &d);
        }
        failed |= !within_limits("contour", folds ? "folds" : "second differences", "", &d);
    }
    assert_false(failed);
}

/* With what surfaces hide where their backs are seen, of the last layer. */
static void backs_are_the_references(void **state)
{
    uint32_t next = 0;
    differences d = {0};
    (void)state;
    for (uint32_t view = 0; view < 4; view++) {
        const softsh_settings settings = {
            .technique = SOFTSH_TECHNIQUE_CONTOUR,
            .pattern = SOFTSH_PATTERN_8X8,
            .aggregation = SOFTSH_AGGREGATION_SAMPLED,
            .merge = view & 1 ? SOFTSH_MERGE_MAXIMUM : SOFTSH_MERGE_UNION,
            .reconstruction = SOFTSH_RECONSTRUCTION_BACKS,
            .no_hierarchy = 1,
        };
        check_view(settings, view & 2, 0, SCENES, &next, &d);
    }
    print_heading();
    assert_true(within_limits("contour", "backs", "", &d));
}

/* Outlines are what all microquads together are, in bits; areas are those of the outline. */
static void outlines_are_the_references(void **state)
{
    static const softsh_pattern patterns[] = {SOFTSH_PATTERN_8X8, SOFTSH_PATTERN_16X16, SOFTSH_PATTERN_16X16_JITTERED,
                                              SOFTSH_PATTERN_8X8};
    uint32_t next = 0;
    bool failed = false;
    (void)state;
    print_heading();
    for (uint32_t view = 0; view < 4; view++) {
        const bool area = view == 3;
        differences d = {0};
        const softsh_settings settings = {
            .technique = area ? SOFTSH_TECHNIQUE_AREA : SOFTSH_TECHNIQUE_BITMASK,
            .pattern = patterns[view],
            .primitive = SOFTSH_PRIMITIVE_MICROQUAD,
            .aggregation = SOFTSH_AGGREGATION_SAMPLED,
            .merge = view & 1 ? SOFTSH_MERGE_MAXIMUM : SOFTSH_MERGE_UNION,
            .outline = 1,
            .no_hierarchy = 1,
        };
        check_view(settings, view == 1, 0, SCENES, &next, &d);
        failed |= !within_limits(area ? "area" : "bitmask", "outline", area ? "" : view ? "16x16" : "8x8", &d);
    }
    assert_false(failed);
}

/* Lights without size: every pixel is dark or lit, and settings do not matter. */
static void hard_shadows_are_the_references(void **state)
{
    differences d = {0};
    (void)state;
    for (int normals = 0; normals < 2; normals++) {
        const softsh_settings settings = {.technique = normals ? SOFTSH_TECHNIQUE_CONTOUR : SOFTSH_TECHNIQUE_BITMASK,
                                          .primitive = SOFTSH_PRIMITIVE_MICROPATCH};
        const sight_info info = {.settings = settings, .width = 32, .height = 24, .normals = normals != 0};
        sight view;
        sight_create(&info, &view);
        for (uint32_t k = 0; k < 2 * SCENES; k++) {
            stage s = {.info = stages[k % SCENES].info, .options = stages[k % SCENES].options};
            s.info.hard = true;
            s.info.seed = 7 + k;
            stage_create(&s);
            compare(&s, &view, &settings, normals != 0, &d);
            stage_destroy(&s);
        }
        sight_destroy(&view);
    }
    print_message("hard: %u of %u pixels differ; %s\n", (unsigned)d.notable, (unsigned)d.pixels, d.worst);
    assert_true((double)d.notable <= hard_limit * (double)d.pixels);
}

static int setup(void **state)
{
    const int failed = fixture_setup(state);
    for (uint32_t i = 0; i < SCENES && !failed; i++) {
        stages[i].info.seed = i;
        stage_create(&stages[i]);
    }
    return failed;
}

static int teardown(void **state)
{
    for (uint32_t i = 0; i < SCENES; i++)
        stage_destroy(&stages[i]);
    return fixture_teardown(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bitmasks_are_the_references),     cmocka_unit_test(areas_are_the_references),
        cmocka_unit_test(contours_are_the_references),     cmocka_unit_test(outlines_are_the_references),
        cmocka_unit_test(backs_are_the_references),        cmocka_unit_test(separate_contours_are_the_references),
        cmocka_unit_test(hard_shadows_are_the_references),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
