#include "scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference_matrix.h"

static const double up[3] = {0.0, 1.0, 0.0};

/* The floor is 10 below the lamp and does not fill the camera's image; one rectangle is level, one is not. */
static const reference_surface stage[3] = {
    {.center = {0.0, 0.0, -10.0}, .u = {7.0, 0.0, 0.4}, .v = {0.0, 7.0, -0.3}},
    {.center = {-0.6, 0.4, -7.0}, .u = {1.3, 0.4, 0.0}, .v = {-0.3, 0.9, 0.0}},
    {.center = {1.0, -0.5, -4.5}, .u = {0.5, 0.3, 0.3}, .v = {-0.4, 0.5, -0.2}},
};

const char *scene_light_name(scene_light light)
{
    static const char *const names[] = {"centred", "in front", "sun", "tilted sun", "rotated"};
    return names[light];
}

const char *scene_content_name(scene_content content)
{
    static const char *const names[] = {"rectangles", "noise", "nasty"};
    return names[content];
}

static void lamp_matrices(const scene_info *info, lamp_info *out)
{
    const double behind = info->light == SCENE_IN_FRONT ? 1.5 : 0.0;
    const double at[3] = {0.0, 0.0, behind}, target[3] = {0.0, 0.0, -20.0};
    const double bounds[4] = {-0.5, 0.45, -0.5, 0.55}, box[4] = {-4.5, 5.0, -5.0, 4.5};

    reference_look_at(at, target, up, out->view);
    for (uint32_t i = 0; i < out->layer_count; i++) {
        const double near = behind + (i ? 1.0 : 0.5), far = i ? 30.0 : 60.0;
        if (info->light == SCENE_SUN || info->light == SCENE_TILTED_SUN)
            reference_orthographic(box, near, far, info->range, out->layers[i].projection);
        else
            reference_perspective(bounds, near, far, info->range, out->layers[i].projection);
    }
}

static void light_of(const scene_info *info, softsh_light *out)
{
    const double scale = info->hard ? 0.0 : info->light_scale > 0.0 ? info->light_scale : 1.0;

    out->struct_size = sizeof *out;
    switch (info->light) {
    case SCENE_SUN:
    case SCENE_TILTED_SUN:
        out->shape = SOFTSH_LIGHT_DIRECTIONAL;
        out->direction[0] = info->light == SCENE_SUN ? 0.0 : -0.6;
        out->direction[1] = info->light == SCENE_SUN ? 0.0 : 0.4;
        out->direction[2] = -2.0;
        out->angular_radius = atan(0.25 * scale);
        break;
    case SCENE_IN_FRONT:
        out->half_u[1] = -0.6 * scale;
        out->half_v[0] = -0.9 * scale;
        break;
    case SCENE_ROTATED:
        out->half_u[0] = 0.8 * scale * cos(0.5);
        out->half_u[1] = 0.8 * scale * sin(0.5);
        out->half_v[0] = -0.5 * scale * sin(0.5);
        out->half_v[1] = 0.5 * scale * cos(0.5);
        break;
    default:
        out->half_u[0] = 0.8 * scale;
        out->half_v[1] = 0.6 * scale;
        break;
    }
}

/* Blocks and single texels at random heights between the floor and the lamp. */
static void add_noise(const reference_map *map, uint64_t *state, float *depth)
{
    const uint32_t width = map->width, height = map->height;
    for (uint32_t block = 0; block < 10 + width * height / 100; block++) {
        const uint32_t x0 = reference_random(state) % width, y0 = reference_random(state) % height;
        const uint32_t w = block < 10 ? 1 + reference_random(state) % 8 : 1,
                       h = block < 10 ? 1 + reference_random(state) % 8 : 1;
        const double z = reference_random_range(state, 3.0, 11.0);
        for (uint32_t y = y0; y < y0 + h && y < height; y++)
            for (uint32_t x = x0; x < x0 + w && x < width; x++) {
                const double here = z + reference_random_range(state, -0.1, 0.1);
                depth[y * width + x] = (float)reference_map_g_to_depth(map, map->perspective ? 1.0 / here : -here);
            }
    }
}

/* Steps and roughness along the camera's rays. */
static void add_steps(uint64_t *state, double far_depth, uint32_t width, uint32_t height, float *depth)
{
    for (int block = 0; block < 14; block++) {
        const uint32_t x0 = reference_random(state) % width, y0 = reference_random(state) % height;
        const uint32_t w = 1 + reference_random(state) % 9, h = 1 + reference_random(state) % 9;
        const double step = reference_random_range(state, -0.1, 0.1);
        /* From what the format's precision explains to what nobody would take for a plane. */
        const double rough = block % 3 ? pow(10.0, reference_random_range(state, -6.0, -1.7)) : 0.0;
        for (uint32_t y = y0; y < y0 + h && y < height; y++)
            for (uint32_t x = x0; x < x0 + w && x < width; x++) {
                float *const here = &depth[y * width + x];
                const double distance =
                    fabs((double)*here - far_depth) * (1.0 + step + reference_random_range(state, -rough, rough));
                *here = (float)(far_depth > 0.5 ? far_depth - distance : far_depth + distance);
            }
    }
}

static void add_nonsense(uint64_t *state, uint32_t count, float *depth)
{
    const float values[] = {NAN, INFINITY, -INFINITY, -0.25f, 1.5f, 0.0f, 1.0f, 1e-40f, 3e38f, -0.0f};
    for (uint32_t i = 0; i < count / 20 + 1; i++)
        depth[reference_random(state) % count] = values[reference_random(state) % 10];
}

static void cast_camera(const scene_info *info, scene *s, uint64_t *state)
{
    const double at[3] = {5.0, -6.0, -2.0}, target[3] = {0.3, 0.0, -9.5}, upright[3] = {0.0, 0.0, 1.0};
    const uint32_t width = s->eye.place.width, height = s->eye.place.height;
    int32_t *const hits = malloc((size_t)width * height * sizeof *hits);
    reference_camera camera;

    assert_non_null(hits);
    reference_look_at(at, target, upright, s->eye.view);
    reference_perspective((const double[4]){-0.5, 0.5, -0.375, 0.375}, 0.5, 60.0, info->range, s->eye.projection);
    eye_reference(&s->eye, &camera);
    reference_cast(s->eye.view, s->eye.projection, width, height, camera.far_depth, REFERENCE_FORMAT_EXACT, stage, 3,
                   s->depth, hits);
    for (uint32_t i = 0; i < width * height; i++) {
        double normal[3] = {0.0, 0.0, 0.0};
        if (hits[i] >= 0)
            reference_surface_normal(&stage[hits[i]], at, normal);
        /* Some blocks face away from everything. */
        const double side = (i % width / 5 + i / width / 5) % 9 == 0 ? -2.5 : 2.5;
        for (int k = 0; k < 3; k++) {
            const double bend = info->content == SCENE_RECTANGLES ? 0.0 : reference_random_range(state, -0.7, 0.7);
            s->normals[3 * i + (uint32_t)k] = (float)(side * (normal[k] + bend));
        }
        if (info->content != SCENE_RECTANGLES && reference_random(state) % 50 == 0)
            memset(&s->normals[3 * i], 0, 3 * sizeof *s->normals);
    }
    free(hits);
    if (info->content != SCENE_RECTANGLES)
        add_steps(state, camera.far_depth, width, height, s->depth);
    if (info->content == SCENE_NASTY)
        add_nonsense(state, width * height, s->depth);
}

void scene_create(const scene_info *info, scene *out)
{
    uint64_t state = info->seed + 1;
    const uint32_t width = info->map_width ? info->map_width : 48, height = info->map_height ? info->map_height : 40;

    memset(out, 0, sizeof *out);
    out->lamp.place = (placement){.width = width, .height = height};
    out->lamp.layer_count = info->layers ? info->layers : 1;
    out->eye.place = (placement){.width = info->width ? info->width : 32, .height = info->height ? info->height : 24};
    lamp_matrices(info, &out->lamp);
    light_of(info, &out->lamp.light);
    out->depth = calloc((size_t)out->eye.place.width * out->eye.place.height, sizeof *out->depth);
    out->normals = calloc((size_t)out->eye.place.width * out->eye.place.height, 3 * sizeof *out->normals);
    assert_true(out->depth && out->normals);
    out->eye.depth = out->depth;
    out->eye.normals = out->normals;
    for (uint32_t i = 0; i < out->lamp.layer_count; i++) {
        reference_map map;
        out->map_depth[i] = calloc((size_t)width * height, sizeof(float));
        assert_non_null(out->map_depth[i]);
        out->lamp.layers[i].depth = out->map_depth[i];
        assert_true(reference_map_derive(&map, out->lamp.view, out->lamp.layers[i].projection, width, height,
                                         &out->lamp.light));
        /* The first of two layers lacks the nearer rectangle, the second all but that. */
        reference_cast(out->lamp.view, out->lamp.layers[i].projection, width, height, map.far_depth,
                       REFERENCE_FORMAT_EXACT, stage + (i ? 2 : 0),
                       i                           ? 1
                       : out->lamp.layer_count > 1 ? 2
                                                   : 3,
                       out->map_depth[i], NULL);
        if (info->content != SCENE_RECTANGLES)
            add_noise(&map, &state, out->map_depth[i]);
        if (info->content == SCENE_NASTY)
            add_nonsense(&state, width * height, out->map_depth[i]);
    }
    cast_camera(info, out, &state);
}

void scene_cast(scene *out, const reference_surface *surfaces, uint32_t count)
{
    const uint32_t pixels = out->eye.place.width * out->eye.place.height;
    const uint32_t texels = out->lamp.place.width * out->lamp.place.height;
    double inverse[16], at[4];
    reference_camera camera;
    int32_t *const hits = malloc(pixels * sizeof *hits);

    out->depth = calloc(pixels, sizeof *out->depth);
    out->normals = calloc(pixels, 3 * sizeof *out->normals);
    assert_true(hits && out->depth && out->normals);
    for (uint32_t i = 0; i < out->lamp.layer_count; i++) {
        reference_map map;
        out->map_depth[i] = calloc(texels, sizeof(float));
        assert_non_null(out->map_depth[i]);
        assert_true(reference_map_derive(&map, out->lamp.view, out->lamp.layers[i].projection, out->lamp.place.width,
                                         out->lamp.place.height, &out->lamp.light));
        reference_cast(out->lamp.view, out->lamp.layers[i].projection, map.width, map.height, map.far_depth,
                       REFERENCE_FORMAT_EXACT, surfaces, count, out->map_depth[i], NULL);
        out->lamp.layers[i].depth = out->map_depth[i];
    }
    eye_reference(&out->eye, &camera);
    reference_cast(out->eye.view, out->eye.projection, camera.width, camera.height, camera.far_depth,
                   REFERENCE_FORMAT_EXACT, surfaces, count, out->depth, hits);
    assert_true(reference_matrix_inverse(out->eye.view, inverse));
    reference_matrix_apply(inverse, (const double[4]){0.0, 0.0, 0.0, 1.0}, at);
    for (uint32_t i = 0; i < pixels; i++) {
        double normal[3] = {0.0, 0.0, 0.0};
        if (hits[i] >= 0)
            reference_surface_normal(&surfaces[hits[i]], at, normal);
        for (uint32_t k = 0; k < 3; k++)
            out->normals[3 * i + k] = (float)normal[k];
    }
    free(hits);
    out->eye.depth = out->depth;
    out->eye.normals = out->normals;
}

void scene_destroy(scene *s)
{
    for (uint32_t i = 0; i < 2; i++)
        free(s->map_depth[i]);
    free(s->depth);
    free(s->normals);
    memset(s, 0, sizeof *s);
}
