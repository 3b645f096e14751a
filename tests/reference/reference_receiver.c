/* Receivers from a camera's depth image: section 3 of docs/numerics.md. A pixel goes to the world through the inverse
 * projection and the inverse view, one after the other, and from there into the map. */
#include "reference_receiver.h"
#include "reference_matrix.h"

#include <math.h>
#include <string.h>

/* About tan 89.5 degrees, the steepest receiver plane. */
static const double steepest = 114.0;

/* Sine of the angle in (u, v) below which two differences are one. */
static const double parallel = 1e-3;

bool reference_camera_derive(reference_camera *camera, const double view[16], const double projection[16],
                             uint32_t width, uint32_t height)
{
    memset(camera, 0, sizeof(*camera));
    camera->width = width;
    camera->height = height;
    if (!reference_matrix_inverse(view, camera->view_inverse) ||
        !reference_matrix_inverse(projection, camera->projection_inverse))
        return false;
    const bool perspective = fabs(projection[3]) + fabs(projection[7]) + fabs(projection[11]) > 0.0;
    bool reversed;
    if (perspective) {
        /* Before the division by its own w, an unprojected point's w is one over its distance. */
        double start[4], end[4];
        reference_matrix_apply(camera->projection_inverse, (const double[4]){0.0, 0.0, 0.0, 1.0}, start);
        reference_matrix_apply(camera->projection_inverse, (const double[4]){0.0, 0.0, 1.0, 1.0}, end);
        reversed = end[3] > start[3];
    } else {
        /* Where clip x, y and depth lead in the world: forward is right x down. */
        double steps[3][4], forward[3];
        for (int i = 0; i < 3; ++i) {
            const double clip[4] = {i == 0, i == 1, i == 2, 0.0};
            reference_matrix_apply(camera->projection_inverse, clip, steps[i]);
            reference_matrix_apply(camera->view_inverse, steps[i], steps[i]);
        }
        reference_cross(steps[0], steps[1], forward);
        reversed = reference_dot(steps[2], forward) < 0.0;
    }
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

static bool in_image(const reference_camera *camera, int64_t x, int64_t y)
{
    return x >= 0 && y >= 0 && x < (int64_t)camera->width && y < (int64_t)camera->height;
}

static double depth_at(const reference_camera *camera, const reference_camera_image *image, int64_t x, int64_t y)
{
    return image->depth[(size_t)y * camera->width + (size_t)x];
}

/* In [0, 1], and of the image's nearest pixel. */
static double clamped_depth(const reference_camera *camera, const reference_camera_image *image, int64_t x, int64_t y)
{
    x = x < 0 ? 0 : x;
    y = y < 0 ? 0 : y;
    x = x < (int64_t)camera->width ? x : (int64_t)camera->width - 1;
    y = y < (int64_t)camera->height ? y : (int64_t)camera->height - 1;
    const double depth = depth_at(camera, image, x, y);
    return depth >= 0.0 ? fmin(depth, 1.0) : 0.0;
}

static bool locate(const reference_map *map, const reference_camera *camera, const reference_camera_image *image,
                   int64_t x, int64_t y, double uvg[3])
{
    double world[3], derivative[3];
    if (!in_image(camera, x, y))
        return false;
    const double depth = depth_at(camera, image, x, y);
    return reference_camera_unproject(camera, x, y, depth, world, derivative) && reference_map_project(map, world, uvg);
}

/* A pixel's four neighbours: left, right, above, below. */
typedef struct neighbourhood {
    bool counts[4];
    double offset[4][3]; /* (u, v, g) from the centre */
    double step[4];      /* of device depth from the centre */
    double bend[4];      /* how much the step from there to the next pixel differs from that */
    double precision;    /* of device depth */
} neighbourhood;

static void look_around(const reference_map *map, const reference_camera *camera, const reference_camera_image *image,
                        int64_t x, int64_t y, const double center[3], double precision, neighbourhood *out)
{
    static const int steps[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    out->precision = precision;
    for (int k = 0; k < 4; ++k) {
        double uvg[3];
        double depths[3];
        for (int i = 0; i < 3; ++i)
            depths[i] = clamped_depth(camera, image, x + i * steps[k][0], y + i * steps[k][1]);
        out->step[k] = depths[1] - depths[0];
        out->bend[k] = fabs(depths[2] - depths[1] - out->step[k]);
        out->counts[k] = locate(map, camera, image, x + steps[k][0], y + steps[k][1], uvg);
        for (int i = 0; out->counts[k] && i < 3; ++i)
            out->offset[k][i] = uvg[i] - center[i];
    }
}

/* Of neighbours `first` and first + 1 the one on the pixel's side of a crease, else that whose g differs less, the
 * first of two equals; NULL without any. */
static const double *difference(const neighbourhood *around, int first)
{
    const double *const before = around->offset[first], *const after = around->offset[first + 1];
    if (!around->counts[first] || !around->counts[first + 1])
        return around->counts[first] ? before : around->counts[first + 1] ? after : NULL;
    const double *const step = around->step + first, *const bend = around->bend + first;
    if (fabs(step[0] + step[1]) > 0.15 * (fabs(step[0]) + fabs(step[1])) + 4.0 * around->precision) {
        if (8.0 * bend[0] + around->precision < bend[1])
            return before;
        if (8.0 * bend[1] + around->precision < bend[0])
            return after;
    }
    return fabs(after[2]) < fabs(before[2]) ? after : before;
}

/* Also the gradient's precision, given that of the depths. */
static void gradient_from_depth(const neighbourhood *around, double flat_eta, double gradient[2], double *drift)
{
    const double *const a = difference(around, 0), *const b = difference(around, 2);
    gradient[0] = gradient[1] = *drift = 0.0;
    if (!a || !b)
        return;
    const double determinant = a[0] * b[1] - a[1] * b[0];
    if (!(fabs(determinant) > parallel * hypot(a[0], a[1]) * hypot(b[0], b[1])))
        return;
    gradient[0] = (a[2] * b[1] - b[2] * a[1]) / determinant;
    gradient[1] = (a[0] * b[2] - b[0] * a[2]) / determinant;
    *drift = 2.0 * flat_eta / fmin(hypot(a[0], a[1]), hypot(b[0], b[1]));
}

bool reference_plane_smooth(const double offset[4][3], const double gradient[2], double flat_eta)
{
    for (int k = 0; k < 4; ++k) {
        const double du = gradient[0] * offset[k][0], dv = gradient[1] * offset[k][1];
        if (!(fabs(offset[k][2] - du - dv) <= 4.0 * flat_eta + 0.03 * (fabs(du) + fabs(dv))))
            return false;
    }
    return true;
}

/* Area of a convex polygon where a[0] x + a[1] y >= a[2]. */
static double area_beyond(const double (*polygon)[2], int count, const double a[3])
{
    double kept[8][2], twice = 0.0;
    int n = 0;
    for (int k = 0; k < count; ++k) {
        const double *const p = polygon[k], *const q = polygon[(k + 1) % count];
        const double from = a[0] * p[0] + a[1] * p[1] - a[2], to = a[0] * q[0] + a[1] * q[1] - a[2];
        if (from >= 0.0)
            memcpy(kept[n++], p, sizeof(kept[0]));
        if ((from >= 0.0) != (to >= 0.0)) {
            for (int i = 0; i < 2; ++i)
                kept[n][i] = p[i] + (q[i] - p[i]) * from / (from - to);
            ++n;
        }
    }
    for (int k = 0; k < n; ++k)
        twice += kept[k][0] * kept[(k + 1) % n][1] - kept[(k + 1) % n][0] * kept[k][1];
    return 0.5 * fabs(twice);
}

double reference_horizon(const reference_map *map, const double uvg[3], const double gradient[2], int side)
{
    /* A ray towards q climbs over the plane where n . q < c. */
    double line[3];
    for (int i = 0; i < 2; ++i)
        line[i] = gradient[0] * map->a[0][i] + gradient[1] * map->a[1][i];
    line[2] = map->epsilon - map->delta * uvg[2];
    for (int i = 0; i < 2; ++i)
        line[2] -= gradient[i] * (map->offset[i] - map->delta * uvg[i]);
    double beyond;
    if (map->directional) {
        const double size = hypot(line[0], line[1]);
        const double t = size > 0.0 ? fmin(fmax(line[2] / size, -1.0), 1.0) : line[2] < 0.0 ? -1.0 : 1.0;
        beyond = (acos(t) - t * sqrt(1.0 - t * t)) / acos(-1.0);
    } else {
        static const double square[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
        beyond = area_beyond(square, 4, line) / 4.0;
    }
    return side < 0 ? 1.0 - beyond : beyond;
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
    /* An error of the camera's depth moves the point in (u, v) as well; on its own plane that is no error. */
    double moved[3];
    bool smooth = false;
    derive_along(map, world, derivative, moved);
    if (has_normal) {
        reference_plane_gradient(map, uvg, normal, out->gradient);
    } else {
        neighbourhood around;
        const double flat[2] = {0.0, 0.0};
        look_around(map, camera, image, x, y, uvg, bias->camera_precision, &around);
        const double flat_eta = reference_eta(map, bias, uvg[2], moved[2], flat);
        gradient_from_depth(&around, flat_eta, out->gradient, &out->drift);
        smooth = around.counts[0] && around.counts[1] && around.counts[2] && around.counts[3] &&
                 reference_plane_smooth((const double(*)[3])around.offset, out->gradient, flat_eta);
    }
    /* Which side is the front, and where the horizon is, before the steepest planes are made less steep. */
    for (int i = 0; i < 2; ++i)
        if (!(fabs(out->gradient[i]) < 1e30))
            out->gradient[i] = 0.0;
    if (has_normal) {
        /* Towards the light g grows. */
        double nearer[3];
        const double step = 1e-3 * (map->perspective ? uvg[2] : 1.0);
        reference_map_unproject(map, (const double[3]){uvg[0], uvg[1], uvg[2] + step}, nearer);
        for (int i = 0; i < 3; ++i)
            nearer[i] -= world[i];
        out->side = reference_dot(normal, nearer) < 0.0 ? -1 : 1;
    } else {
        /* The camera sees the front, and device depth grows away from it, unless it is reversed. Only a plane that its
         * neighbours lie on may be turned away. */
        const double leaves = moved[2] - out->gradient[0] * moved[0] - out->gradient[1] * moved[1];
        out->side = smooth && (camera->far_depth > 0.0 ? leaves : -leaves) > 0.0 ? -1 : 1;
    }
    out->horizon = bias->override_bias || map->point ? 0.0 : reference_horizon(map, uvg, out->gradient, out->side);
    reference_gradient_clamp(map, uvg[2], out->gradient);
    const double away = moved[2] - out->gradient[0] * moved[0] - out->gradient[1] * moved[1];
    out->eta = reference_eta(map, bias, uvg[2], away, out->gradient);
    out->override_bias = bias->override_bias;
    out->bias = bias->bias;
}
