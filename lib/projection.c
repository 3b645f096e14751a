/* From matrices and a light to map space: docs/numerics.md, sections 1 to 3. Everything a depth convention can be is
 * read off the matrices here and nowhere else. */
#include "projection.h"

#include <math.h>
#include <string.h>

#include "matrix.h"

/* Depth of a clip matrix: affine in 1/w (perspective) or in position (orthographic). */
typedef struct clip_depth {
    bool orthographic;
    double alpha, beta; /* perspective: depth = alpha + beta/w */
    double far_depth;
} clip_depth;

static double determinant_sign(const double a[3], const double b[3], const double c[3])
{
    double cross[3];
    softshi_cross3(a, b, cross);
    const double det = softshi_dot3(cross, c);
    return det > 0.0 ? 1.0 : det < 0.0 ? -1.0 : 0.0;
}

static bool fits_floats(const double *values, int count)
{
    for (int i = 0; i < count; i++)
        if (!isfinite((float)values[i]))
            return false;
    return true;
}

/* Reads the depth convention off projection * view. */
static softsh_result read_clip_depth(const softsh_context *context, const double clip[16], const char *field,
                                     clip_depth *out)
{
    double r0[4], r1[4], r2[4], r3[4];
    softshi_matrix_row(clip, 0, r0);
    softshi_matrix_row(clip, 1, r1);
    softshi_matrix_row(clip, 2, r2);
    softshi_matrix_row(clip, 3, r3);
    const double n = softshi_length3(r3);
    memset(out, 0, sizeof *out);
    out->orthographic = n <= 1e-9 * (softshi_length3(r0) + softshi_length3(r1) + softshi_length3(r2));
    if (out->orthographic) {
        /* Right, down and forward form a right-handed frame, so a reversed depth shows in the orientation. */
        out->far_depth = determinant_sign(r0, r1, r2) >= 0.0 ? 1.0 : 0.0;
        if (!(r3[3] > 0.0))
            return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT,
                                "%s::projection: clip w is %g everywhere, expected a positive number", field, r3[3]);
        return SOFTSH_SUCCESS;
    }
    out->alpha = softshi_dot3(r2, r3) / (n * n);
    out->beta = r2[3] - out->alpha * r3[3];
    double residual = 0.0;
    for (int i = 0; i < 3; i++)
        residual = fmax(residual, fabs(r2[i] - out->alpha * r3[i]));
    if (residual > 1e-5 * n)
        return softshi_fail(
            context, SOFTSH_ERROR_UNSUPPORTED,
            "%s::projection: depth is not a function of distance (an oblique near plane), which is not supported",
            field);
    if (!(fabs(out->beta) > 0.0))
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT, "%s::projection: every point has the same depth",
                            field);
    out->far_depth = out->beta < 0.0 ? 1.0 : 0.0;
    return SOFTSH_SUCCESS;
}

static softsh_result clip_matrix(const softsh_context *context, const double view[16], const double projection[16],
                                 const char *field, double clip[16], double inverse[16])
{
    if (!softshi_all_finite(view, 16))
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT, "%s::view_matrix has an element that is not finite",
                            field);
    if (!softshi_all_finite(projection, 16))
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT, "%s::projection has an element that is not finite",
                            field);
    if (!softshi_matrix_invert(view, inverse))
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT, "%s::view_matrix is singular", field);
    if (!softshi_matrix_invert(projection, inverse))
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT, "%s::projection is singular", field);
    softshi_matrix_multiply(projection, view, clip);
    if (!softshi_matrix_invert(clip, inverse))
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT, "%s: projection * view_matrix is singular", field);
    return SOFTSH_SUCCESS;
}

softsh_result softshi_map_space_create(const softsh_context *context, const softsh_light *light, const softsh_map *map,
                                       VkExtent2D extent, const char *field, softshi_map_space *out)
{
    double clip[16], inverse[16], r0[4], r1[4], r2[4], r3[4];
    clip_depth depth;
    softsh_result result = clip_matrix(context, map->view_matrix, map->projection, field, clip, inverse);
    if (result == SOFTSH_SUCCESS)
        result = read_clip_depth(context, clip, field, &depth);
    if (result != SOFTSH_SUCCESS)
        return result;
    softshi_matrix_row(clip, 0, r0);
    softshi_matrix_row(clip, 1, r1);
    softshi_matrix_row(clip, 2, r2);
    softshi_matrix_row(clip, 3, r3);
    const double half[2] = {0.5 * extent.width, 0.5 * extent.height};
    memset(out, 0, sizeof *out);
    out->orthographic = depth.orthographic;
    for (int i = 0; i < 4; i++) {
        out->rows[0][i] = half[0] * (r0[i] + r3[i]);
        out->rows[1][i] = half[1] * (r1[i] + r3[i]);
        out->rows[3][i] = r3[i];
    }
    if (depth.orthographic) {
        if (light->shape != SOFTSH_LIGHT_DIRECTIONAL)
            return softshi_fail(context, SOFTSH_ERROR_UNSUPPORTED, "%s: an orthographic map needs a directional light",
                                field);
        /* Depth per world unit along the axis; g grows against the light's direction. */
        const double axis = softshi_length3(r2), along = softshi_dot3(r2, light->direction);
        const double per_unit = (along < 0.0 ? -axis : axis) / r3[3];
        out->far_depth = per_unit > 0.0 ? 1.0 : 0.0;
        out->depth_scale = -1.0 / per_unit;
        out->depth_offset = 0.5 / per_unit; /* zero in the middle of the range */
        for (int i = 0; i < 4; i++)
            out->rows[2][i] = (0.5 * r3[i] - r2[i]) / per_unit;
        out->texel[0] = r3[3] / (half[0] * softshi_length3(r0));
        out->texel[1] = r3[3] / (half[1] * softshi_length3(r1));
        out->normal_sign = determinant_sign(out->rows[0], out->rows[1], out->rows[2]);
    } else {
        if (light->shape == SOFTSH_LIGHT_DIRECTIONAL)
            return softshi_fail(context, SOFTSH_ERROR_UNSUPPORTED, "%s: a directional light needs an orthographic map",
                                field);
        const double n = softshi_length3(r3);
        out->far_depth = depth.far_depth;
        out->depth_scale = n / depth.beta;
        out->depth_offset = -depth.alpha * n / depth.beta;
        out->rows[2][3] = n;
        /* Off-centre frusta: only the part of r0 and r1 across the axis moves a point sideways. */
        double across[2][3];
        for (int i = 0; i < 3; i++) {
            across[0][i] = r0[i] - softshi_dot3(r0, r3) / (n * n) * r3[i];
            across[1][i] = r1[i] - softshi_dot3(r1, r3) / (n * n) * r3[i];
        }
        out->texel[0] = n / (half[0] * softshi_length3(across[0]));
        out->texel[1] = n / (half[1] * softshi_length3(across[1]));
        out->normal_sign = -determinant_sign(out->rows[0], out->rows[1], r3);
    }
    /* Shaders get the linear part as it is, the rest only together with a camera. */
    for (int i = 0; i < 4; i++)
        if (!fits_floats(out->rows[i], 3) || !isfinite(out->rows[i][3]))
            return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT, "%s: its matrices overflow", field);
    if (!isfinite(out->texel[0]) || !isfinite(out->texel[1]) || out->normal_sign == 0.0 ||
        !isfinite((float)out->depth_scale) || !isfinite((float)out->depth_offset))
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT, "%s: its matrices are degenerate", field);
    return SOFTSH_SUCCESS;
}

static double row_dot(const double row[4], const double v[3], double w)
{
    return softshi_dot3(row, v) + row[3] * w;
}

static softsh_result rectangle_space(const softsh_context *context, const softsh_light *light,
                                     const softshi_map_space *map, softshi_light_space *out)
{
    const double n = softshi_length3(map->rows[3]);
    const double half = fmax(softshi_length3(light->half_u), softshi_length3(light->half_v));
    const double tilt =
        fmax(fabs(softshi_dot3(map->rows[3], light->half_u)), fabs(softshi_dot3(map->rows[3], light->half_v)));
    if (tilt > 1e-3 * n * half)
        return softshi_fail(
            context, SOFTSH_ERROR_UNSUPPORTED,
            "softsh_light: its plane is tilted by %.3g rad against the map's image plane, expected parallel planes",
            asin(fmin(tilt / (n * half), 1.0)));
    out->delta = row_dot(map->rows[3], light->center, 1.0) / n;
    out->epsilon = 1.0;
    if (out->delta < -1e-3 * half - 1e-9 * fabs(map->rows[3][3] / n))
        return softshi_fail(
            context, SOFTSH_ERROR_INVALID_ARGUMENT,
            "softsh_light::center lies %.6g behind the map's projection centre, expected it at the centre or in front",
            -out->delta);
    const double *axes[2] = {light->half_u, light->half_v};
    for (int i = 0; i < 2; i++) {
        out->u[i] = row_dot(map->rows[i], light->center, 1.0) / n;
        for (int k = 0; k < 2; k++)
            out->a[i][k] = row_dot(map->rows[i], axes[k], 0.0) / n;
    }
    out->point = half == 0.0;
    return SOFTSH_SUCCESS;
}

static softsh_result directional_space(const softsh_context *context, const softsh_light *light,
                                       const softshi_map_space *map, softshi_light_space *out)
{
    const double length = softshi_length3(light->direction);
    double ray[3];
    for (int i = 0; i < 3; i++)
        ray[i] = -light->direction[i] / length;
    const double along = softshi_dot3(map->rows[2], ray) / map->rows[3][3];
    if (!(along >= 0.5))
        return softshi_fail(context, SOFTSH_ERROR_UNSUPPORTED,
                            "softsh_light::direction is %.3g rad off the map's axis, expected at most 1.05",
                            acos(fmax(fmin(along, 1.0), -1.0)));
    out->delta = 0.0;
    out->epsilon = 1.0;
    out->disc = true;
    for (int i = 0; i < 2; i++) {
        out->u[i] = softshi_dot3(map->rows[i], ray) / map->rows[3][3] / along;
        for (int k = 0; k < 2; k++)
            out->a[i][k] = tan(light->angular_radius) * softshi_dot3(map->rows[i], map->rows[k]) /
                           softshi_length3(map->rows[k]) / map->rows[3][3] / along;
    }
    out->point = light->angular_radius == 0.0;
    return SOFTSH_SUCCESS;
}

/* The light seen in map orientation: swap and mirror its axes until A is as near to a positive diagonal as it can be.
 */
static void orient(softshi_light_space *light)
{
    double(*a)[2] = light->a;
    if (fabs(a[0][0]) + fabs(a[1][1]) < fabs(a[0][1]) + fabs(a[1][0])) {
        for (int i = 0; i < 2; i++) {
            const double swap = a[i][0];
            a[i][0] = a[i][1];
            a[i][1] = swap;
        }
    }
    for (int k = 0; k < 2; k++) {
        if (a[k][k] < 0.0) {
            a[0][k] = -a[0][k];
            a[1][k] = -a[1][k];
        }
    }
    const double side = fmax(fabs(a[0][0]), fabs(a[1][1]));
    light->axis_aligned = fabs(a[0][1]) <= 1e-4 * side && fabs(a[1][0]) <= 1e-4 * side;
}

softsh_result softshi_light_space_create(const softsh_context *context, const softsh_light *light,
                                         const softshi_map_space *map, softshi_light_space *out)
{
    memset(out, 0, sizeof *out);
    const softsh_result result =
        map->orthographic ? directional_space(context, light, map, out) : rectangle_space(context, light, map, out);
    if (result != SOFTSH_SUCCESS)
        return result;
    orient(out);
    /* A line light keeps a sliver of width, so that A has an inverse. */
    const double side = fmax(out->a[0][0], out->a[1][1]);
    for (int k = 0; k < 2; k++)
        if (!out->point && out->a[k][k] < 1e-3 * side)
            out->a[k][k] = 1e-3 * side;
    if (!fits_floats(out->u, 2) || !fits_floats(&out->delta, 1))
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT, "softsh_light::center is too far from the map");
    if (!out->point && (!fits_floats(&out->a[0][0], 4) || side < 1e-12))
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT,
                            "softsh_light: its extent is %g texels per unit, expected 1e-12 to 3e38", side);
    return SOFTSH_SUCCESS;
}

softsh_result softshi_camera_space_create(const softsh_context *context, const softsh_camera *camera,
                                          const softshi_map_space *map, ss_frame *out)
{
    double clip[16], inverse[16];
    clip_depth depth;
    softsh_result result =
        clip_matrix(context, camera->view_matrix, camera->projection, "softsh_camera", clip, inverse);
    if (result == SOFTSH_SUCCESS)
        result = read_clip_depth(context, clip, "softsh_camera", &depth);
    if (result != SOFTSH_SUCCESS)
        return result;
    float *to_map = &out->to_map[0].x, *normal_map = &out->normal_map[0].x;
    double largest = 0.0;
    double rows[4][4];
    for (int r = 0; r < 4; r++) {
        for (int c = 0; c < 4; c++) {
            rows[r][c] = 0.0;
            for (int k = 0; k < 4; k++)
                rows[r][c] += map->rows[r][k] * inverse[4 * c + k];
        }
        /* Counted from the far plane depth has no digits to lose there, where w is least. */
        rows[r][3] += depth.far_depth * rows[r][2];
        for (int c = 0; c < 4; c++)
            largest = fmax(largest, fabs(rows[r][c]));
    }
    if (!(largest > 0.0) || !isfinite(largest))
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT,
                            "softsh_camera: its matrices overflow together with the map's");
    /* Homogeneous: the common factor is free, and near one no row leaves the range of floats. */
    for (int r = 0; r < 4; r++) {
        for (int c = 0; c < 4; c++) {
            to_map[4 * r + c] = (float)(rows[r][c] / largest);
            normal_map[4 * r + c] = c < 3 ? (float)map->rows[r][c] : 0.0f;
        }
    }
    normal_map[3] = (float)map->normal_sign;
    out->camera.x = (float)depth.far_depth;
    out->camera.w = (float)softshi_depth_precision(camera->depth_format);
    out->flags.x = depth.far_depth == 0.0 ? SS_FLAG_REVERSED : 0u;
    return SOFTSH_SUCCESS;
}

double softshi_depth_precision(VkFormat format)
{
    return format == VK_FORMAT_D16_UNORM ? ldexp(1.0, -16) : ldexp(1.0, -21);
}
