/* Receivers from a camera's depth image: section 3 of docs/numerics.md. A pixel goes to the world through the inverse
 * projection and the inverse view, one after the other, and from there into the map. */
#include "reference_receiver.h"
#include "reference_matrix.h"

#include <math.h>
#include <string.h>

/* About tan 89.5 degrees, the steepest receiver plane. */
static const double steepest = 114.0;

/* Sine of the angle in (u, v) below which two differences are one. */
static const double parallel = 1e-6;

bool reference_camera_derive(reference_camera *camera, const double view[16], const double projection[16],
                             uint32_t width, uint32_t height)
{
    memset(camera, 0, sizeof(*camera));
    camera->width = width;
    camera->height = height;
    if (!reference_matrix_inverse(view, camera->view_inverse) ||
        !reference_matrix_inverse(projection, camera->projection_inverse))
        return false;
    /* Before the division by its own w, an unprojected point's w is one over its distance. */
    double start[4], end[4];
    reference_matrix_apply(camera->projection_inverse, (const double[4]){0.0, 0.0, 0.0, 1.0}, start);
    reference_matrix_apply(camera->projection_inverse, (const double[4]){0.0, 0.0, 1.0, 1.0}, end);
    const bool perspective = fabs(projection[3]) + fabs(projection[7]) + fabs(projection[11]) > 0.0;
    const bool reversed = perspective ? end[3] > start[3] : end[2] / end[3] > start[2] / start[3];
    camera->far_depth = reversed ? 0.0 : 1.0;
    return true;
}

bool reference_camera_unproject(const reference_camera *camera, int64_t x, int64_t y, double depth, double world[3],
                                double derivative[3])
{
    if (x < 0 || y < 0 || x >= (int64_t)camera->width || y >= (int64_t)camera->height || isnan(depth))
        return false;
    depth = fmin(fmax(depth, 0.0), 1.0);
    if (!(fabs(depth - camera->far_depth) > 0.0))
        return false;
    double point[4] = {2.0 * ((double)x + 0.5) / camera->width - 1.0, 2.0 * ((double)y + 0.5) / camera->height - 1.0,
                       depth, 1.0};
    double step[4] = {0.0, 0.0, 1.0, 0.0};
    reference_matrix_apply(camera->projection_inverse, point, point);
    reference_matrix_apply(camera->projection_inverse, step, step);
    reference_matrix_apply(camera->view_inverse, point, point);
    reference_matrix_apply(camera->view_inverse, step, step);
    for (int i = 0; i < 3; ++i) {
        world[i] = point[i] / point[3];
        derivative[i] = (step[i] - world[i] * step[3]) / point[3];
    }
    return true;
}

void reference_plane_gradient(const reference_map *map, const double uvg[3], const double normal[3], double gradient[2])
{
    /* The plane's equation in clip space: k . (x, y, depth, 1) = 0. */
    double world[3];
    reference_map_unproject(map, uvg, world);
    const double plane[4] = {normal[0], normal[1], normal[2], -reference_dot(normal, world)};
    double k[4];
    for (int column = 0; column < 4; ++column) {
        k[column] = 0.0;
        for (int row = 0; row < 4; ++row)
            k[column] += map->matrix_inverse[4 * column + row] * plane[row];
    }
    gradient[0] = -k[0] / k[2] * (2.0 / map->width) * map->depth_scale;
    gradient[1] = -k[1] / k[2] * (2.0 / map->height) * map->depth_scale;
}

void reference_gradient_clamp(const reference_map *map, double g, double gradient[2])
{
    for (int i = 0; i < 2; ++i) {
        const double limit = steepest * map->texel[i] * (map->perspective ? fabs(g) : 1.0);
        if (isnan(gradient[i]))
            gradient[i] = 0.0;
        gradient[i] = fmin(fmax(gradient[i], -limit), limit);
    }
}

double reference_eta(const reference_map *map, const reference_bias *bias, double g, double away_per_depth,
                     const double gradient[2])
{
    const double rounding = ldexp(1.0, -20) * fmax(fabs(g), fabs(gradient[0]) + fabs(gradient[1]));
    return fabs(map->depth_scale) * bias->map_precision + fabs(away_per_depth) * bias->camera_precision + rounding;
}

/* Derivative of (u, v, g) along a world-space step at a point in front of the projection centre. */
static void derive_along(const reference_map *map, const double world[3], const double step[3], double out[3])
{
    const double size[2] = {map->width, map->height};
    const double w = reference_dot(map->rows[3], world) + map->rows[3][3], dw = reference_dot(map->rows[3], step);
    for (int i = 0; i < 2; ++i) {
        const double x = reference_dot(map->rows[i], world) + map->rows[i][3], dx = reference_dot(map->rows[i], step);
        out[i] = 0.5 * size[i] * (dx * w - x * dw) / (w * w);
    }
    out[2] = map->perspective ? -map->axis_length * dw / (w * w) : -reference_dot(map->axis, step);
}

static bool locate(const reference_map *map, const reference_camera *camera, const reference_camera_image *image,
                   int64_t x, int64_t y, double uvg[3])
{
    double world[3], derivative[3];
    if (x < 0 || y < 0 || x >= (int64_t)camera->width || y >= (int64_t)camera->height)
        return false;
    const double depth = image->depth[(size_t)y * camera->width + (size_t)x];
    return reference_camera_unproject(camera, x, y, depth, world, derivative) && reference_map_project(map, world, uvg);
}

/* The difference to the neighbour along (dx, dy) or (-dx, -dy) whose g differs less; the first of two equals. */
static bool difference(const reference_map *map, const reference_camera *camera, const reference_camera_image *image,
                       int64_t x, int64_t y, int dx, int dy, const double center[3], double out[3])
{
    bool found = false;
    for (int side = -1; side <= 1; side += 2) {
        double neighbour[3];
        if (!locate(map, camera, image, x + side * dx, y + side * dy, neighbour))
            continue;
        const double here = fabs(neighbour[2] - center[2]);
        if (found && !(here < fabs(out[2])))
            continue;
        for (int i = 0; i < 3; ++i)
            out[i] = neighbour[i] - center[i];
        found = true;
    }
    return found;
}

static void gradient_from_depth(const reference_map *map, const reference_camera *camera,
                                const reference_camera_image *image, uint32_t x, uint32_t y, const double uvg[3],
                                double gradient[2])
{
    double a[3], b[3];
    gradient[0] = gradient[1] = 0.0;
    if (!difference(map, camera, image, x, y, 1, 0, uvg, a) || !difference(map, camera, image, x, y, 0, 1, uvg, b))
        return;
    const double determinant = a[0] * b[1] - a[1] * b[0];
    if (!(fabs(determinant) > parallel * hypot(a[0], a[1]) * hypot(b[0], b[1])))
        return;
    gradient[0] = (a[2] * b[1] - b[2] * a[1]) / determinant;
    gradient[1] = (a[0] * b[2] - b[0] * a[2]) / determinant;
}

void reference_receiver_derive(reference_receiver *out, const reference_map *map, const reference_camera *camera,
                               const reference_camera_image *image, const reference_bias *bias, uint32_t x, uint32_t y)
{
    memset(out, 0, sizeof(*out));
    out->state = REFERENCE_RECEIVER_NONE;
    const size_t index = (size_t)y * camera->width + x;
    double world[3], derivative[3], uvg[3];
    if (!reference_camera_unproject(camera, x, y, image->depth[index], world, derivative) ||
        !reference_map_project(map, world, uvg))
        return;
    if (!(uvg[0] >= 0.0 && uvg[0] <= map->width && uvg[1] >= 0.0 && uvg[1] <= map->height))
        return;
    memcpy(out->uvg, uvg, sizeof(uvg));
    out->state = REFERENCE_RECEIVER_BEHIND;
    if (!(map->epsilon - map->delta * uvg[2] > 0.0))
        return;
    double normal[3];
    bool has_normal = false;
    if (image->normals) {
        const float *stored = image->normals + 3 * index;
        has_normal = reference_normalize((const double[3]){stored[0], stored[1], stored[2]}, normal);
    }
    if (has_normal && reference_map_light_behind(map, world, normal)) {
        out->state = REFERENCE_RECEIVER_AWAY;
        return;
    }
    out->state = REFERENCE_RECEIVER_ACTIVE;
    if (has_normal)
        reference_plane_gradient(map, uvg, normal, out->gradient);
    else
        gradient_from_depth(map, camera, image, x, y, uvg, out->gradient);
    reference_gradient_clamp(map, uvg[2], out->gradient);
    /* An error of the camera's depth moves the point in (u, v) as well; on its own plane that is no error. */
    double moved[3];
    derive_along(map, world, derivative, moved);
    const double away = moved[2] - out->gradient[0] * moved[0] - out->gradient[1] * moved[1];
    out->eta = reference_eta(map, bias, uvg[2], away, out->gradient);
    out->override_bias = bias->override_bias;
    out->bias = bias->bias;
}
