/* A map and its light in map space: sections 1 and 2 of docs/numerics.md. Everything is derived from the matrices'
 * rows as the page writes it; nothing is simplified for speed. */
#include "reference_map.h"
#include "reference_matrix.h"

#include <math.h>
#include <string.h>

/* How far from parallel or from diagonal counts as rounding. */
static const double tolerance = 1e-6;

/* Width of a line light over its length, in texels. */
static const double line_width = 1e-3;

static double length3(const double a[3])
{
    return sqrt(reference_dot(a, a));
}

static double dot4(const double row[4], const double point[3], double w)
{
    return reference_dot(row, point) + row[3] * w;
}

/* The part of a row's gradient parallel to the image plane. */
static void lateral(const double row[4], const double axis[3], double out[3])
{
    reference_along(row, -reference_dot(row, axis), axis, out);
}

static bool derive_projection(reference_map *map, const double view[16], const double projection[16])
{
    reference_matrix_multiply(projection, view, map->matrix);
    if (!reference_matrix_inverse(map->matrix, map->matrix_inverse))
        return false;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            map->rows[row][column] = map->matrix[4 * column + row];
    /* The view is affine, so alpha and beta may be read off the projection, where no world offset is in the way. */
    const double p2[4] = {projection[2], projection[6], projection[10], projection[14]};
    const double p3[4] = {projection[3], projection[7], projection[11], projection[15]};
    if (fabs(view[3]) + fabs(view[7]) + fabs(view[11]) > 0.0 || fabs(view[15] - 1.0) > 0.0)
        return false;

    const double p3_length = length3(p3);
    map->perspective = p3_length > 0.0;
    if (map->perspective) {
        const double alpha = reference_dot(p2, p3) / (p3_length * p3_length);
        const double beta = p2[3] - alpha * p3[3];
        double rest[3];
        reference_along(p2, -alpha, p3, rest);
        if (!(length3(rest) <= tolerance * p3_length) || !(fabs(beta) > 0.0))
            return false;
        map->axis_length = length3(map->rows[3]);
        map->depth_scale = map->axis_length / beta;
        map->depth_offset = -alpha * map->axis_length / beta;
        if (!reference_normalize(map->rows[3], map->axis))
            return false;
    } else {
        if (fabs(projection[15] - 1.0) > 0.0 || !reference_normalize(map->rows[2], map->axis))
            return false;
        map->axis_length = 1.0;
        /* Oriented along growing device depth for now. */
        map->depth_scale = -1.0 / length3(map->rows[2]);
        map->depth_offset = -0.5 * map->depth_scale;
    }
    return true;
}

static void orient_orthographic(reference_map *map, const double towards_light[3])
{
    if (reference_dot(map->axis, towards_light) > 0.0) {
        for (int i = 0; i < 3; ++i)
            map->axis[i] = -map->axis[i];
        map->depth_scale = -map->depth_scale;
        map->depth_offset = -map->depth_offset;
    }
}

/* The light's half axes become columns of A; `per_unit` is the numerator's divisor. */
static void column_of(const reference_map *map, const double axis[3], double per_unit, double out[2])
{
    const double size[2] = {map->width, map->height};
    for (int i = 0; i < 2; ++i) {
        out[i] = 0.5 * size[i] * reference_dot(map->rows[i], axis) / per_unit;
        if (map->perspective)
            out[i] += 0.5 * size[i] * reference_dot(map->rows[3], axis) / per_unit;
    }
}

static void negate_column(reference_map *map, int column, double axis[3])
{
    map->a[0][column] = -map->a[0][column];
    map->a[1][column] = -map->a[1][column];
    for (int i = 0; i < 3; ++i)
        axis[i] = -axis[i];
}

/* Section 2: as near to a positive diagonal as it can be. */
static void normalize_axes(reference_map *map)
{
    if (fabs(map->a[0][0]) + fabs(map->a[1][1]) < fabs(map->a[0][1]) + fabs(map->a[1][0])) {
        for (int i = 0; i < 2; ++i) {
            const double swapped = map->a[i][0];
            map->a[i][0] = map->a[i][1];
            map->a[i][1] = swapped;
        }
        for (int i = 0; i < 3; ++i) {
            const double swapped = map->axis_s[i];
            map->axis_s[i] = map->axis_t[i];
            map->axis_t[i] = swapped;
        }
    }
    if (map->a[0][0] < 0.0)
        negate_column(map, 0, map->axis_s);
    if (map->a[1][1] < 0.0)
        negate_column(map, 1, map->axis_t);
}

static bool invert_a(reference_map *map)
{
    const double determinant = map->a[0][0] * map->a[1][1] - map->a[0][1] * map->a[1][0];
    if (!(fabs(determinant) > 0.0))
        return false;
    map->a_inverse[0][0] = map->a[1][1] / determinant;
    map->a_inverse[0][1] = -map->a[0][1] / determinant;
    map->a_inverse[1][0] = -map->a[1][0] / determinant;
    map->a_inverse[1][1] = map->a[0][0] / determinant;
    map->axis_aligned = fabs(map->a[0][1]) + fabs(map->a[1][0]) <= tolerance * fmin(map->a[0][0], map->a[1][1]);
    return true;
}

static bool derive_rectangle(reference_map *map, const softsh_light *light)
{
    const double size[2] = {map->width, map->height};
    if (!map->perspective)
        return false;
    memcpy(map->center, light->center, sizeof(map->center));
    memcpy(map->axis_s, light->half_u, sizeof(map->axis_s));
    memcpy(map->axis_t, light->half_v, sizeof(map->axis_t));
    map->point = !(length3(map->axis_s) > 0.0) && !(length3(map->axis_t) > 0.0);
    map->epsilon = 1.0;
    map->delta = dot4(map->rows[3], map->center, 1.0) / map->axis_length;
    const double extent = fmax(length3(map->axis_s), length3(map->axis_t));
    if (fabs(reference_dot(map->axis, map->axis_s)) > tolerance * extent ||
        fabs(reference_dot(map->axis, map->axis_t)) > tolerance * extent)
        return false;
    /* A hair behind the projection centre is rounding. */
    if (map->delta < -tolerance * fmax(1.0, fmax(extent, length3(map->center))))
        return false;
    for (int i = 0; i < 2; ++i)
        map->offset[i] = 0.5 * size[i] * (dot4(map->rows[i], map->center, 1.0) + dot4(map->rows[3], map->center, 1.0)) /
                         map->axis_length;
    double columns[2][2];
    column_of(map, map->axis_s, map->axis_length, columns[0]);
    column_of(map, map->axis_t, map->axis_length, columns[1]);
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
            map->a[i][j] = columns[j][i];
    if (map->point)
        return true;
    normalize_axes(map);
    for (int i = 0; i < 2; ++i)
        map->a[i][i] = fmax(map->a[i][i], line_width * map->a[1 - i][1 - i]);
    return invert_a(map);
}

static bool derive_directional(reference_map *map, const softsh_light *light)
{
    double direction[3], axes[2][3];
    if (map->perspective || !reference_normalize(light->direction, direction))
        return false;
    map->directional = true;
    map->point = !(light->angular_radius > 0.0);
    for (int i = 0; i < 3; ++i)
        map->center[i] = -direction[i];
    orient_orthographic(map, map->center);
    map->epsilon = 1.0;
    map->delta = 0.0;
    /* World units a ray towards the light's centre rises per unit of its length; all of the light shares it, because
     * the light's axes are parallel to the image plane. */
    const double rise = -reference_dot(map->axis, map->center);
    if (!(rise > tolerance))
        return false;
    for (int i = 0; i < 2; ++i) {
        lateral(map->rows[i], map->axis, axes[i]);
        if (!reference_normalize(axes[i], axes[i]))
            return false;
        for (int k = 0; k < 3; ++k)
            axes[i][k] *= tan(light->angular_radius);
    }
    memcpy(map->axis_s, axes[0], sizeof(map->axis_s));
    memcpy(map->axis_t, axes[1], sizeof(map->axis_t));
    double columns[2][2];
    column_of(map, map->center, rise, map->offset);
    column_of(map, map->axis_s, rise, columns[0]);
    column_of(map, map->axis_t, rise, columns[1]);
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
            map->a[i][j] = columns[j][i];
    return map->point || invert_a(map);
}

bool reference_map_derive(reference_map *map, const double view[16], const double projection[16], uint32_t width,
                          uint32_t height, const softsh_light *light)
{
    memset(map, 0, sizeof(*map));
    map->width = width;
    map->height = height;
    if (width == 0 || height == 0 || !derive_projection(map, view, projection))
        return false;
    if (light->shape == SOFTSH_LIGHT_RECTANGLE
            ? !derive_rectangle(map, light)
            : light->shape != SOFTSH_LIGHT_DIRECTIONAL || !derive_directional(map, light))
        return false;
    /* g grows towards the light: far is where it is smaller. */
    map->far_depth = map->depth_scale < 0.0 ? 1.0 : 0.0;
    const double size[2] = {width, height};
    for (int i = 0; i < 2; ++i) {
        double across[3];
        lateral(map->rows[i], map->axis, across);
        map->texel[i] = 2.0 * map->axis_length / (size[i] * length3(across));
    }
    return true;
}

double reference_map_depth_to_g(const reference_map *map, double depth)
{
    if (isnan(depth))
        depth = map->far_depth;
    return map->depth_scale * fmin(fmax(depth, 0.0), 1.0) + map->depth_offset;
}

double reference_map_g_to_depth(const reference_map *map, double g)
{
    return (g - map->depth_offset) / map->depth_scale;
}

bool reference_map_project(const reference_map *map, const double world[3], double uvg[3])
{
    const double w = dot4(map->rows[3], world, 1.0);
    if (map->perspective && !(w > 0.0))
        return false;
    uvg[0] = 0.5 * (dot4(map->rows[0], world, 1.0) / w + 1.0) * map->width;
    uvg[1] = 0.5 * (dot4(map->rows[1], world, 1.0) / w + 1.0) * map->height;
    uvg[2] =
        map->perspective ? map->axis_length / w : map->depth_scale * dot4(map->rows[2], world, 1.0) + map->depth_offset;
    return true;
}

void reference_map_unproject(const reference_map *map, const double uvg[3], double world[3])
{
    const double clip[4] = {2.0 * uvg[0] / map->width - 1.0, 2.0 * uvg[1] / map->height - 1.0,
                            reference_map_g_to_depth(map, uvg[2]), 1.0};
    double point[4];
    reference_matrix_apply(map->matrix_inverse, clip, point);
    for (int i = 0; i < 3; ++i)
        world[i] = point[i] / point[3];
}

void reference_map_segment(const reference_map *map, const double receiver[3], const double q[2], double g,
                           double uv[2])
{
    const double t = (g - receiver[2]) / (map->epsilon - map->delta * receiver[2]);
    for (int i = 0; i < 2; ++i)
        uv[i] =
            receiver[i] + t * (map->a[i][0] * q[0] + map->a[i][1] * q[1] + map->offset[i] - map->delta * receiver[i]);
}

void reference_map_backproject(const reference_map *map, const double receiver[3], const double sample[3], double q[2])
{
    const double t = (map->epsilon - map->delta * receiver[2]) / (sample[2] - receiver[2]);
    double rest[2];
    for (int i = 0; i < 2; ++i)
        rest[i] = (sample[i] - receiver[i]) * t - (map->offset[i] - map->delta * receiver[i]);
    for (int i = 0; i < 2; ++i)
        q[i] = map->a_inverse[i][0] * rest[0] + map->a_inverse[i][1] * rest[1];
}

void reference_map_kernel(const reference_map *map, const double receiver[3], double g_hi, double box[4])
{
    box[0] = box[2] = receiver[0];
    box[1] = box[3] = receiver[1];
    for (int corner = 0; corner < 4; ++corner) {
        const double q[2] = {corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0};
        double uv[2];
        reference_map_segment(map, receiver, q, g_hi, uv);
        for (int i = 0; i < 2; ++i) {
            box[i] = fmin(box[i], uv[i]);
            box[2 + i] = fmax(box[2 + i], uv[i]);
        }
    }
}

void reference_map_light_point(const reference_map *map, const double q[2], double out[3])
{
    for (int i = 0; i < 3; ++i)
        out[i] = map->center[i] + q[0] * map->axis_s[i] + q[1] * map->axis_t[i];
}

bool reference_map_light_behind(const reference_map *map, const double world[3], const double normal[3])
{
    const double along_s = reference_dot(normal, map->axis_s), along_t = reference_dot(normal, map->axis_t);
    if (map->directional)
        return reference_dot(normal, map->center) + hypot(along_s, along_t) <= 0.0;
    double to_center[3];
    reference_along(map->center, -1.0, world, to_center);
    return reference_dot(normal, to_center) + fabs(along_s) + fabs(along_t) <= 0.0;
}
