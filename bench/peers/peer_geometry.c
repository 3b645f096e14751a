/* Combines the camera's and the map's matrices in double precision, so that large world offsets cancel before anything
 * becomes a float. The notation is that of docs/numerics.md, sections 1 and 2. */
#include "peer_geometry.h"

#include <math.h>
#include <string.h>

_Static_assert(offsetof(struct peer_params, light) == 64 && offsetof(struct peer_params, offset) == 80 &&
                   offsetof(struct peer_params, light_plane) == 88 && offsetof(struct peer_params, map_count) == 124 &&
                   sizeof(struct peer_params) == 128,
               "C and GLSL must agree, and 128 bytes of push constants are all there is everywhere");

typedef struct mat4 {
    double m[4][4]; /* [row][column] */
} mat4;

static mat4 from_columns(const double columns[16])
{
    mat4 r;

    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            r.m[i][j] = columns[j * 4 + i];
    return r;
}

static mat4 multiply(const mat4 *a, const mat4 *b)
{
    mat4 r;

    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            r.m[i][j] = 0.0;
            for (int k = 0; k < 4; k++)
                r.m[i][j] += a->m[i][k] * b->m[k][j];
        }
    return r;
}

/* Gauss-Jordan elimination with row pivots. */
static bool invert(const mat4 *a, mat4 *out)
{
    double t[4][8] = {{0}};

    for (int i = 0; i < 4; i++) {
        memcpy(t[i], a->m[i], sizeof a->m[i]);
        t[i][4 + i] = 1.0;
    }
    for (int c = 0; c < 4; c++) {
        int pivot = c;
        for (int i = c + 1; i < 4; i++)
            if (fabs(t[i][c]) > fabs(t[pivot][c]))
                pivot = i;
        if (!(fabs(t[pivot][c]) > 0.0))
            return false;
        for (int j = 0; j < 8; j++) {
            const double swap = t[c][j];
            t[c][j] = t[pivot][j];
            t[pivot][j] = swap;
        }
        for (int j = 7; j >= 0; j--)
            t[c][j] /= t[c][c];
        for (int i = 0; i < 4; i++) {
            const double f = t[i][c];
            if (i == c)
                continue;
            for (int j = 0; j < 8; j++)
                t[i][j] -= f * t[c][j];
        }
    }
    for (int i = 0; i < 4; i++)
        memcpy(out->m[i], t[i] + 4, sizeof out->m[i]);
    return true;
}

static double dot3(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static bool is_perspective(const mat4 *m)
{
    return dot3(m->m[3], m->m[3]) > 1e-24;
}

/* r2 = alpha r3 + beta e4 for a perspective matrix, so that depth is alpha + beta / (r3 . p). */
static double depth_beta(const mat4 *m, double *alpha)
{
    *alpha = dot3(m->m[2], m->m[3]) / dot3(m->m[3], m->m[3]);
    return m->m[2][3] - *alpha * m->m[3][3];
}

/* Orthographic matrices do not tell near from far; a rotation without mirroring is assumed for the camera. */
static bool is_reversed(const mat4 *m)
{
    const double(*r)[4] = m->m;
    const double normal[3] = {r[0][1] * r[1][2] - r[0][2] * r[1][1], r[0][2] * r[1][0] - r[0][0] * r[1][2],
                              r[0][0] * r[1][1] - r[0][1] * r[1][0]};
    double alpha;

    return is_perspective(m) ? depth_beta(m, &alpha) > 0.0 : dot3(normal, r[2]) < 0.0;
}

static double depth_precision(VkFormat format)
{
    return format == VK_FORMAT_D16_UNORM || format == VK_FORMAT_D16_UNORM_S8_UINT ? ldexp(1.0, -16) : ldexp(1.0, -21);
}

static peer_vec4 to_vec4(const double v[4])
{
    const peer_vec4 r = {(float)v[0], (float)v[1], (float)v[2], (float)v[3]};

    return r;
}

/* The map's half of the parameters; `axis_row` such that g * w = axis_row . p. */
static const char *map_geometry(const peer_info *info, const peer_inputs *inputs, const mat4 *map, double axis_row[4],
                                struct peer_params *out)
{
    const double half_width = 0.5 * inputs->map.width, half_height = 0.5 * inputs->map.height;
    const double *r0 = map->m[0], *r1 = map->m[1], *r2 = map->m[2], *r3 = map->m[3];
    const peer_light *light = &inputs->light;
    const peer_settings *s = &info->settings;
    double scale, offset, texels, reach;

    if (is_perspective(map)) {
        const double n = sqrt(dot3(r3, r3));
        double alpha;
        const double beta = depth_beta(map, &alpha);
        const double *u = light->half_u, *v = light->half_v, *c = light->center;

        if (info->directional)
            return "a directional light needs an orthographic map";
        scale = n / beta;
        offset = -alpha * scale;
        texels = half_width * sqrt(dot3(r0, r0)) / n;
        out->light.x = (float)(half_width * (dot3(r0, u) + dot3(r3, u)) / n);
        out->light.y = (float)(half_height * (dot3(r1, u) + dot3(r3, u)) / n);
        out->light.z = (float)(half_width * (dot3(r0, v) + dot3(r3, v)) / n);
        out->light.w = (float)(half_height * (dot3(r1, v) + dot3(r3, v)) / n);
        out->offset.x = (float)(half_width * (dot3(r0, c) + r0[3] + dot3(r3, c) + r3[3]) / n);
        out->offset.y = (float)(half_height * (dot3(r1, c) + r1[3] + dot3(r3, c) + r3[3]) / n);
        out->light_plane = (float)((dot3(r3, c) + r3[3]) / n);
        for (int j = 0; j < 4; j++)
            axis_row[j] = j < 3 ? 0.0 : n;
        out->perspective = 1.0f;
    } else {
        const double *d = light->direction;
        const double n = sqrt(dot3(r2, r2)), along = dot3(r2, d) / n;
        double to_light[3];

        if (!info->directional)
            return "an orthographic map needs a directional light";
        if (!(fabs(along) > 1e-3 * sqrt(dot3(d, d))))
            return "the directional light travels along the map's image plane";
        /* Depth grows along the light if `along` is positive; g = -z grows against it. */
        scale = along > 0.0 ? -1.0 / n : 1.0 / n;
        offset = 0.0;
        texels = half_width * sqrt(dot3(r0, r0));
        for (int i = 0; i < 3; i++)
            to_light[i] = -d[i] / fabs(along);
        out->light.x = (float)(texels * tan(light->angular_radius));
        out->light.y = out->light.z = 0.0f;
        out->light.w = (float)(half_height * sqrt(dot3(r1, r1)) * tan(light->angular_radius));
        out->offset.x = (float)(half_width * dot3(r0, to_light));
        out->offset.y = (float)(half_height * dot3(r1, to_light));
        out->light_plane = 0.0f;
        for (int j = 0; j < 4; j++)
            axis_row[j] = scale * r2[j];
        out->perspective = 0.0f;
    }
    if (!isfinite(scale) || !isfinite(offset) || !(texels > 0.0))
        return "the map's matrices are degenerate";
    out->depth_scale = (float)scale;
    out->depth_offset = (float)offset;
    out->map_precision = (float)(fabs(scale) * depth_precision(inputs->map.format));
    /* tan 89.5 degrees, in g per texel; a perspective map's is multiplied by g in the shader. */
    out->slope_limit = (float)(114.0 / texels);
    if (info->kind == PEER_PCF) {
        const double range = fabs(scale); /* orthographic: depth 0 to 1 in world units */
        reach = s->pcf_kernel > 0.0 ? s->pcf_kernel : out->perspective > 0.0f ? 0.25 : 0.05 * range;
    } else {
        reach = fmax(offset, scale + offset); /* the near plane's fan depth */
        if (s->nearest_blocker > 0.0)
            reach = fmin(reach, out->perspective > 0.0f ? 1.0 / s->nearest_blocker : reach - s->nearest_blocker);
        if (out->light_plane > 0.0f)
            reach = fmin(reach, 1.0 / out->light_plane);
    }
    out->reach = (float)reach;
    return NULL;
}

const char *peer_geometry(const peer_info *info, const peer_inputs *inputs, struct peer_params *out)
{
    const mat4 camera_view = from_columns(inputs->camera.view_matrix);
    const mat4 camera_projection = from_columns(inputs->camera.projection);
    const mat4 map_view = from_columns(inputs->map.view_matrix);
    const mat4 map_projection = from_columns(inputs->map.projection);
    const mat4 camera = multiply(&camera_projection, &camera_view);
    const mat4 map = multiply(&map_projection, &map_view);
    const double half_width = 0.5 * inputs->map.width, half_height = 0.5 * inputs->map.height;
    const double far_depth = is_reversed(&camera) ? 0.0 : 1.0;
    /* Pixel to clip space, with depth counted from the far plane, where floats can tell the most depths apart. */
    const mat4 pixels = {{{2.0 / inputs->camera.width, 0.0, 0.0, -1.0},
                          {0.0, 2.0 / inputs->camera.height, 0.0, -1.0},
                          {0.0, 0.0, 1.0, far_depth},
                          {0.0, 0.0, 0.0, 1.0}}};
    mat4 texels, inverse, from_pixels, combined;
    double axis_row[4];
    const char *problem;

    memset(out, 0, sizeof *out);
    problem = map_geometry(info, inputs, &map, axis_row, out);
    if (problem)
        return problem;
    if (!invert(&camera, &inverse))
        return "the camera's matrices cannot be inverted";
    for (int j = 0; j < 4; j++) {
        texels.m[0][j] = half_width * (map.m[0][j] + map.m[3][j]);
        texels.m[1][j] = half_height * (map.m[1][j] + map.m[3][j]);
        texels.m[2][j] = axis_row[j];
        texels.m[3][j] = map.m[3][j];
    }
    from_pixels = multiply(&inverse, &pixels);
    combined = multiply(&texels, &from_pixels);
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            if (!isfinite(combined.m[i][j]))
                return "the matrices are not finite";
    out->row_u = to_vec4(combined.m[0]);
    out->row_v = to_vec4(combined.m[1]);
    out->row_g = to_vec4(combined.m[2]);
    out->row_w = to_vec4(combined.m[3]);
    out->far_depth = (float)far_depth;
    out->camera_precision = (float)depth_precision(inputs->camera.format);
    out->map_count = (float)info->settings.light_samples;
    return NULL;
}

/* Distance along the map's axis, in the terms of peer_settings::nearest_blocker. */
static double axis_distance(const mat4 *map, const double direction[3], double depth)
{
    double alpha;

    if (is_perspective(map)) {
        const double beta = depth_beta(map, &alpha);
        const double z = beta / ((depth - alpha) * sqrt(dot3(map->m[3], map->m[3])));
        return z > 0.0 ? z : INFINITY; /* rounding around an infinite far plane */
    }
    return (dot3(map->m[2], direction) > 0.0 ? depth : 1.0 - depth) / sqrt(dot3(map->m[2], map->m[2]));
}

double peer_nearest_blocker(const peer_depth *map, const peer_light *light, double least, double greatest)
{
    const mat4 view = from_columns(map->view_matrix), projection = from_columns(map->projection);
    const mat4 combined = multiply(&projection, &view);
    const double a = axis_distance(&combined, light->direction, least);
    const double b = axis_distance(&combined, light->direction, greatest);

    return fmax(fmin(a, b), 0.0);
}
