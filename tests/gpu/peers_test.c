/* The peers against an analytic scene: a square blocker over a ground plane, seen by a perspective camera, under a
 * rectangular light with a perspective map and under a directional one with an orthographic map. Depth buffers are cast
 * ray by ray in double precision. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "peers.h"

#define WIDTH 160u
#define HEIGHT 120u
#define BLOCKER 0.8      /* half size of the square, at height 1 over the ground */
#define LIGHT_HEIGHT 4.0 /* of the rectangle; the orthographic map starts there too */
#define NEAR 0.5
#define FAR 20.0

static gpu device;

/* An eye with three axes (right, down, forward), and how its pixels become rays. */
typedef struct eye {
    double at[3], right[3], down[3], forward[3];
    double tan_x, tan_y; /* perspective: of half the field of view; orthographic: half sizes */
    bool orthographic, reversed;
    bool empty; /* sees the ground alone */
    uint32_t width, height;
} eye;

typedef struct scene {
    bool directional, reversed;
    bool empty; /* no blocker */
    uint32_t map_size;
    eye map_eye;
    peer_inputs inputs;
    gpu_image camera, map, visibility;
    float truth[WIDTH * HEIGHT]; /* negative where the camera sees nothing */
    float result[WIDTH * HEIGHT];
} scene;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void eye_matrices(const eye *e, double view[16], double projection[16])
{
    const double *axes[3] = {e->right, e->down, e->forward};
    const double n = e->reversed ? FAR : NEAR, f = e->reversed ? NEAR : FAR;

    memset(view, 0, 16 * sizeof *view);
    memset(projection, 0, 16 * sizeof *projection);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            view[j * 4 + i] = axes[i][j];
        view[12 + i] = -dot(axes[i], e->at);
    }
    view[15] = 1.0;
    projection[0] = 1.0 / e->tan_x;
    projection[5] = 1.0 / e->tan_y;
    if (e->orthographic) {
        projection[10] = 1.0 / (f - n);
        projection[14] = -n / (f - n);
        projection[15] = 1.0;
    } else {
        projection[10] = f / (f - n);
        projection[14] = -n * f / (f - n);
        projection[11] = 1.0;
    }
}

/* Distance along the axis of the nearest surface through a pixel's centre, its place in `hit`; 0 if there is none. */
static double cast(const eye *e, uint32_t x, uint32_t y, double hit[3])
{
    const double s = (2.0 * (x + 0.5) / e->width - 1.0) * e->tan_x, t = (2.0 * (y + 0.5) / e->height - 1.0) * e->tan_y;
    double start[3], way[3];

    for (int i = 0; i < 3; i++) {
        const double aside = s * e->right[i] + t * e->down[i];
        start[i] = e->at[i] + (e->orthographic ? aside : 0.0);
        way[i] = e->forward[i] + (e->orthographic ? 0.0 : aside);
    }
    for (int plane = e->empty ? 0 : 1; plane >= 0; plane--) {
        const double z = (plane - start[1]) / way[1];
        if (!(z > NEAR && z < FAR))
            continue;
        for (int i = 0; i < 3; i++)
            hit[i] = start[i] + z * way[i];
        if (plane == 0 || (fabs(hit[0]) <= BLOCKER && fabs(hit[2]) <= BLOCKER))
            return z;
    }
    return 0.0;
}

static float device_depth(const eye *e, double z)
{
    const double n = e->reversed ? FAR : NEAR, f = e->reversed ? NEAR : FAR;

    if (!(z > 0.0))
        return e->reversed ? 0.0f : 1.0f;
    return (float)(e->orthographic ? (z - n) / (f - n) : f / (f - n) - n * f / ((f - n) * z));
}

/* Fraction of the light a point sees, by 64 x 64 rays. */
static float visible_fraction(const scene *s, const double p[3])
{
    const peer_light *light = &s->inputs.light;
    unsigned seen = 0, count = 0;

    if (s->empty || p[1] > 0.5)
        return 1.0f;
    for (int i = 0; i < 64; i++)
        for (int j = 0; j < 64; j++) {
            const double a = (i + 0.5) / 32.0 - 1.0, b = (j + 0.5) / 32.0 - 1.0;
            double x, z;
            if (s->directional) {
                const double r = tan(light->angular_radius);
                if (a * a + b * b > 1.0)
                    continue;
                x = p[0] + r * a + light->direction[0] / light->direction[1];
                z = p[2] + r * b + light->direction[2] / light->direction[1];
            } else {
                const double qx = light->center[0] + a * light->half_u[0] + b * light->half_v[0];
                const double qz = light->center[2] + a * light->half_u[2] + b * light->half_v[2];
                x = p[0] + (qx - p[0]) / LIGHT_HEIGHT;
                z = p[2] + (qz - p[2]) / LIGHT_HEIGHT;
            }
            count++;
            seen += !(fabs(x) <= BLOCKER && fabs(z) <= BLOCKER);
        }
    return (float)seen / (float)count;
}

static void upload_texels(gpu_image *image, const float *texels)
{
    assert_true(gpu_image_upload(&device, image, texels, (size_t)image->width * image->height * sizeof *texels,
                                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL));
}

static void upload(const eye *e, VkFormat format, gpu_image *image, peer_depth *depth)
{
    const gpu_image_info info = {
        .format = format, .width = e->width, .height = e->height, .usage = VK_IMAGE_USAGE_SAMPLED_BIT};
    float *texels = malloc((size_t)e->width * e->height * sizeof *texels);
    double hit[3];

    assert_non_null(texels);
    for (uint32_t y = 0; y < e->height; y++)
        for (uint32_t x = 0; x < e->width; x++)
            texels[y * e->width + x] = device_depth(e, cast(e, x, y, hit));
    if (!image->image)
        assert_true(gpu_image_create(&device, &info, image));
    upload_texels(image, texels);
    free(texels);
    depth->view = image->view;
    depth->layout = image->layout;
    depth->format = format;
    depth->width = e->width;
    depth->height = e->height;
    eye_matrices(e, depth->view_matrix, depth->projection);
}

static void scene_create(scene *s)
{
    const double c = sqrt(0.5);
    const eye camera = {.at = {0.3, 5.0, -5.0},
                        .right = {-1.0, 0.0, 0.0},
                        .down = {0.0, -c, -c},
                        .forward = {0.0, -c, c},
                        .tan_x = 0.6,
                        .tan_y = 0.45,
                        .reversed = s->reversed,
                        .empty = s->empty,
                        .width = WIDTH,
                        .height = HEIGHT};
    const double size = s->directional ? 4.0 : 1.0;
    const eye map = {.at = {0.0, LIGHT_HEIGHT, 0.0},
                     .right = {0.0, 0.0, 1.0},
                     .down = {1.0, 0.0, 0.0},
                     .forward = {0.0, -1.0, 0.0},
                     .tan_x = size,
                     .tan_y = size,
                     .orthographic = s->directional,
                     .reversed = s->reversed,
                     .empty = s->empty,
                     .width = s->map_size,
                     .height = s->map_size};
    const peer_light light = {.center = {0.0, LIGHT_HEIGHT, 0.0},
                              .half_u = {0.6, 0.0, 0.0},
                              .half_v = {0.0, 0.0, 0.3},
                              .direction = {0.2, -2.0, 0.1},
                              .angular_radius = 0.25};
    const gpu_image_info info = {
        .format = VK_FORMAT_R32_SFLOAT, .width = WIDTH, .height = HEIGHT, .usage = VK_IMAGE_USAGE_STORAGE_BIT};
    VkCommandBuffer cmd;

    upload(&camera, VK_FORMAT_D32_SFLOAT, &s->camera, &s->inputs.camera);
    upload(&map, VK_FORMAT_R32_SFLOAT, &s->map, &s->inputs.map);
    s->map_eye = map;
    s->inputs.light = light;
    assert_true(gpu_image_create(&device, &info, &s->visibility));
    cmd = gpu_begin(&device);
    gpu_cmd_image_layout(cmd, &s->visibility, VK_IMAGE_LAYOUT_GENERAL);
    assert_true(gpu_submit(&device, cmd));
    s->inputs.visibility = s->visibility.view;
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            double hit[3];
            s->truth[y * WIDTH + x] = cast(&camera, x, y, hit) > 0.0 ? visible_fraction(s, hit) : -1.0f;
        }
}

static void scene_destroy(scene *s)
{
    gpu_image_destroy(&device, &s->camera);
    gpu_image_destroy(&device, &s->map);
    gpu_image_destroy(&device, &s->visibility);
}

static void run(scene *s, peer_kind kind, peer_settings settings)
{
    const peer_info info = {.kind = kind, .settings = settings, .directional = s->directional};
    peer *p;
    VkCommandBuffer cmd;

    assert_true(peer_create(&device, &info, &p));
    cmd = gpu_begin(&device);
    assert_true(peer_record(&device, p, cmd, &s->inputs));
    assert_true(gpu_submit(&device, cmd));
    peer_destroy(&device, p);
    assert_true(gpu_image_read(&device, &s->visibility, s->result, sizeof s->result));
}

/* The mean of `count` maps; `spread`: from points of the rectangular light, else all the same. */
static void run_average(scene *s, uint32_t count, bool spread)
{
    const peer_info info = {.kind = PEER_AVERAGE, .settings = {.light_samples = count}, .directional = s->directional};
    static const float zeros[WIDTH * HEIGHT];
    peer *p;

    assert_true(gpu_image_upload(&device, &s->visibility, zeros, sizeof zeros, VK_IMAGE_LAYOUT_GENERAL));
    assert_true(peer_create(&device, &info, &p));
    for (uint32_t i = 0; i < count; i++) {
        VkCommandBuffer cmd;

        if (spread) {
            s->map_eye.at[0] = s->inputs.light.half_u[0] * (2.0 * (i + 0.5) / count - 1.0);
            s->map_eye.at[2] = s->inputs.light.half_v[2] * (2.0 * fmod(i * 0.61803399 + 0.5, 1.0) - 1.0);
            upload(&s->map_eye, VK_FORMAT_R32_SFLOAT, &s->map, &s->inputs.map);
        }
        cmd = gpu_begin(&device);
        assert_true(peer_record(&device, p, cmd, &s->inputs));
        assert_true(gpu_submit(&device, cmd));
    }
    peer_destroy(&device, p);
    assert_true(gpu_image_read(&device, &s->visibility, s->result, sizeof s->result));
}

/* Mean absolute error where something is shadowed; `sure` is the share of right answers where the truth is 0 or 1. */
static double error(const scene *s, double *sure)
{
    double sum = 0.0;
    unsigned count = 0, agree = 0, known = 0;

    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        const float t = s->truth[i], r = s->result[i];
        if (t < 0.0f) {
            assert_true(r == 1.0f);
            continue;
        }
        if (t == 0.0f || t == 1.0f) {
            known++;
            agree += fabsf(t - r) < 0.5f;
        }
        if (t < 1.0f || r < 1.0f) {
            sum += fabsf(t - r);
            count++;
        }
    }
    assert_true(count > 500 && known > 500);
    *sure = (double)agree / known;
    return sum / count;
}

/* The blocker is 3 below the light, 2.5 below the orthographic map's near plane: the search need not look nearer. */
static peer_settings near_blockers(const scene *s)
{
    const peer_settings settings = {.nearest_blocker = s->directional ? 2.4 : 2.9};

    return settings;
}

static void check_all(scene *s)
{
    const peer_settings defaults = {0};
    double hard, pcss, march, sure;

    scene_create(s);
    run(s, PEER_COPY, defaults);
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        assert_true(s->result[i] == 1.0f);
    run(s, PEER_HARD, defaults);
    hard = error(s, &sure);
    assert_true(sure > 0.999);
    run(s, PEER_PCF, defaults);
    error(s, &sure);
    assert_true(sure > 0.99);
    run(s, PEER_PCSS, near_blockers(s));
    pcss = error(s, &sure);
    assert_true(sure > 0.999);
    assert_true(pcss < 0.025 && pcss < 0.25 * hard);
    run(s, PEER_MARCH, near_blockers(s));
    march = error(s, &sure);
    print_message("mean absolute error: hard %.4f, pcss %.4f, march %.4f\n", hard, pcss, march);
    assert_true(sure > 0.999);
    assert_true(march < 0.03 && march < 0.25 * hard);
    scene_destroy(s);
}

static void test_rectangle(void **state)
{
    static scene s = {.map_size = 256};
    (void)state;
    check_all(&s);
}

static void test_rectangle_reversed(void **state)
{
    static scene s = {.map_size = 256, .reversed = true};
    (void)state;
    check_all(&s);
}

static void test_directional(void **state)
{
    static scene s = {.map_size = 256, .directional = true};
    (void)state;
    check_all(&s);
}

static void test_directional_reversed(void **state)
{
    static scene s = {.map_size = 256, .directional = true, .reversed = true};
    (void)state;
    check_all(&s);
}

/* The penumbra is the light's, not the map's: it stays when the map's resolution doubles. */
static void test_resolution(void **state)
{
    static scene coarse = {.map_size = 256}, fine = {.map_size = 512};
    double sum = 0.0;
    (void)state;

    scene_create(&coarse);
    scene_create(&fine);
    run(&coarse, PEER_PCSS, near_blockers(&coarse));
    run(&fine, PEER_PCSS, near_blockers(&fine));
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        sum += fabsf(coarse.result[i] - fine.result[i]);
    assert_true(sum / (WIDTH * HEIGHT) < 0.005);
    scene_destroy(&coarse);
    scene_destroy(&fine);
}

/* Many rays of many steps come near the truth, and where that is 0 or 1 they all agree but for single texels. */
static void check_converged_march(scene *s)
{
    peer_settings settings = near_blockers(s);
    unsigned dark = 0, all_dark = 0, lit = 0, all_lit = 0;
    double mean, sure;

    settings.light_samples = 256;
    settings.march_steps = 64;
    scene_create(s);
    run(s, PEER_MARCH, settings);
    mean = error(s, &sure);
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        dark += s->truth[i] == 0.0f;
        all_dark += s->truth[i] == 0.0f && s->result[i] == 0.0f;
        lit += s->truth[i] == 1.0f;
        all_lit += s->truth[i] == 1.0f && s->result[i] == 1.0f;
    }
    print_message("mean absolute error: march of many rays %.4f; umbra %u of %u, lit %u of %u\n", mean, all_dark, dark,
                  all_lit, lit);
    assert_true(sure > 0.999 && mean < 0.009);
    assert_true(dark > 100 && all_dark > 0.99 * dark && all_lit > 0.99 * lit);
    scene_destroy(s);
}

static void test_march(void **state)
{
    static scene rectangle = {.map_size = 512}, sun = {.map_size = 512, .directional = true};
    (void)state;
    check_converged_march(&rectangle);
    check_converged_march(&sun);
}

/* Maps from points of the light: as near to the truth as their number allows. One map, however often, is a hard shadow;
 * 49 times 1/49 is not 1 in floats. */
static void test_average(void **state)
{
    static scene s = {.map_size = 256};
    static float hard[WIDTH * HEIGHT];
    const peer_settings defaults = {0};
    double mean, sure;
    (void)state;

    scene_create(&s);
    run(&s, PEER_HARD, defaults);
    memcpy(hard, s.result, sizeof hard);
    run_average(&s, 1, false);
    assert_memory_equal(hard, s.result, sizeof hard);
    run_average(&s, 49, false);
    assert_memory_equal(hard, s.result, sizeof hard);
    run_average(&s, 64, true);
    mean = error(&s, &sure);
    print_message("mean absolute error: average %.4f\n", mean);
    assert_true(sure > 0.999 && mean < 0.015);
    scene_destroy(&s);
}

/* Nothing shadows itself: the ground alone is lit, exactly. */
static void test_empty(void **state)
{
    const peer_settings defaults = {0};
    (void)state;

    for (int directional = 0; directional < 2; directional++) {
        scene *s = calloc(1, sizeof *s);

        assert_non_null(s);
        s->directional = directional;
        s->empty = true;
        s->map_size = 256;
        scene_create(s);
        for (int kind = 0; kind < PEER_KIND_COUNT; kind++) {
            if (kind == PEER_AVERAGE)
                run_average(s, 3, false);
            else
                run(s, (peer_kind)kind, defaults);
            for (size_t i = 0; i < WIDTH * HEIGHT; i++)
                assert_true(s->result[i] == 1.0f);
        }
        scene_destroy(s);
        free(s);
    }
}

/* xorshift32 */
static uint32_t random_bits(uint32_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 17;
    *state ^= *state << 5;
    return *state;
}

/* Colour formats hold any float. */
static void make_hostile(gpu_image *image, peer_depth *depth, uint32_t seed)
{
    const gpu_image_info info = {.format = VK_FORMAT_R32_SFLOAT,
                                 .width = image->width,
                                 .height = image->height,
                                 .usage = VK_IMAGE_USAGE_SAMPLED_BIT};
    static const float hostile[] = {NAN, INFINITY, -INFINITY, -1.0f, 2.0f, 1e30f, 1e-40f, -0.0f, 0.0f, 1.0f};
    const size_t count = (size_t)info.width * info.height;
    float *texels = malloc(count * sizeof *texels);

    assert_non_null(texels);
    for (size_t i = 0; i < count; i++) {
        const uint32_t choice = random_bits(&seed) % 20;
        texels[i] = choice < 10 ? hostile[choice] : (float)(random_bits(&seed) >> 8) * 0x1p-24f;
    }
    gpu_image_destroy(&device, image);
    assert_true(gpu_image_create(&device, &info, image));
    upload_texels(image, texels);
    free(texels);
    depth->view = image->view;
    depth->layout = image->layout;
    depth->format = image->format;
}

/* Whatever the depths are, results are fractions. */
static void test_hostile(void **state)
{
    const peer_settings defaults = {0};
    (void)state;

    for (int variant = 0; variant < 4; variant++) {
        scene *s = calloc(1, sizeof *s);

        assert_non_null(s);
        s->directional = variant & 1;
        s->reversed = variant >> 1;
        s->map_size = 128;
        scene_create(s);
        make_hostile(&s->camera, &s->inputs.camera, 1u + (uint32_t)variant);
        make_hostile(&s->map, &s->inputs.map, 101u + (uint32_t)variant);
        for (int kind = 0; kind < PEER_KIND_COUNT; kind++) {
            if (kind == PEER_AVERAGE)
                run_average(s, 3, false);
            else
                run(s, (peer_kind)kind, defaults);
            for (size_t i = 0; i < WIDTH * HEIGHT; i++)
                assert_true(s->result[i] >= 0.0f && s->result[i] <= 1.0f);
        }
        scene_destroy(s);
        free(s);
    }
}

/* The blocker is 3 below the light; an orthographic map counts from its near plane. */
static void test_nearest_blocker(void **state)
{
    (void)state;

    for (int variant = 0; variant < 4; variant++) {
        scene *s = calloc(1, sizeof *s);
        double at_blocker, at_ground, distance;

        assert_non_null(s);
        s->directional = variant & 1;
        s->reversed = variant >> 1;
        s->map_size = 16;
        scene_create(s);
        at_blocker = (double)device_depth(&s->map_eye, LIGHT_HEIGHT - 1.0);
        at_ground = (double)device_depth(&s->map_eye, LIGHT_HEIGHT);
        distance = peer_nearest_blocker(&s->inputs.map, &s->inputs.light, fmin(at_blocker, at_ground),
                                        fmax(at_blocker, at_ground));
        assert_true(fabs(distance - (s->directional ? 3.0 - NEAR : 3.0)) < 1e-4);
        scene_destroy(s);
        free(s);
    }
}

/* Mismatched lights and maps are refused, not guessed at. */
static void test_refused(void **state)
{
    static scene s = {.map_size = 64};
    const peer_info info = {.kind = PEER_HARD, .directional = true};
    const peer_info unknown = {.kind = PEER_KIND_COUNT};
    const peer_info too_many = {.kind = PEER_MARCH, .settings = {.light_samples = 1025}};
    const peer_info too_long = {.kind = PEER_MARCH, .settings = {.light_samples = 1024, .march_steps = 64}};
    peer *p;
    VkCommandBuffer cmd;
    (void)state;

    assert_false(peer_create(&device, &unknown, &p));
    assert_null(p);
    assert_false(peer_create(&device, &too_many, &p));
    assert_false(peer_create(&device, &too_long, &p));
    scene_create(&s);
    assert_true(peer_create(&device, &info, &p));
    cmd = gpu_begin(&device);
    assert_false(peer_record(&device, p, cmd, &s.inputs));
    assert_true(strstr(device.error, "orthographic") != NULL);
    assert_true(gpu_submit(&device, cmd));
    peer_destroy(&device, p);
    scene_destroy(&s);
}

static int setup(void **state)
{
    const gpu_info info = {.validation = true};
    (void)state;

    if (gpu_create(&info, &device))
        return 0;
    fprintf(stderr, "%s\n", device.error);
    return 1;
}

static int teardown(void **state)
{
    const uint32_t messages = device.validation_messages;
    (void)state;

    gpu_destroy(&device);
    return messages != 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rectangle),   cmocka_unit_test(test_rectangle_reversed),
        cmocka_unit_test(test_directional), cmocka_unit_test(test_directional_reversed),
        cmocka_unit_test(test_resolution),  cmocka_unit_test(test_march),
        cmocka_unit_test(test_average),     cmocka_unit_test(test_empty),
        cmocka_unit_test(test_hostile),     cmocka_unit_test(test_nearest_blocker),
        cmocka_unit_test(test_refused),
    };

    return cmocka_run_group_tests(tests, setup, teardown);
}
