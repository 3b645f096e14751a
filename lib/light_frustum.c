/* softsh_light_frustum_create: the map that users of area lights end up building by hand. */
#include <math.h>
#include <string.h>

#include <softshadow/softshadow.h>

#include "matrix.h"
#include "validate.h"

static void normalize(double v[3])
{
    const double length = softshi_length3(v);
    for (int i = 0; i < 3; i++)
        v[i] /= length;
}

softsh_result softsh_light_frustum_create(const softsh_light *light, const double target[3], double radius,
                                          double behind, softsh_light_frustum *out)
{
    if (!target || !out || out->struct_size != sizeof *out)
        return SOFTSH_ERROR_INVALID_ARGUMENT;
    const softsh_result checked = softshi_check_rectangle_light(light);
    if (checked != SOFTSH_SUCCESS)
        return checked;
    if (!softshi_all_finite(target, 3) || !(radius > 0.0 && radius < HUGE_VAL) ||
        !(behind >= 0.0 && behind < HUGE_VAL) || !(softshi_length3(light->half_u) > 0.0) ||
        !(softshi_length3(light->half_v) > 0.0))
        return SOFTSH_ERROR_INVALID_ARGUMENT;
    double right[3], down[3], forward[3], to_target[3];
    memcpy(right, light->half_u, sizeof right);
    memcpy(down, light->half_v, sizeof down);
    normalize(right);
    normalize(down);
    softshi_cross3(right, down, forward);
    if (!(softshi_length3(forward) > 0.5))
        return SOFTSH_ERROR_INVALID_ARGUMENT;
    normalize(forward);
    for (int i = 0; i < 3; i++)
        to_target[i] = target[i] - light->center[i];
    if (softshi_dot3(forward, to_target) < 0.0) {
        for (int i = 0; i < 3; i++) {
            forward[i] = -forward[i];
            right[i] = -right[i];
        }
    }
    /* Squared up: right x down = forward exactly. */
    softshi_cross3(forward, right, down);
    double apex[3], offset[2];
    for (int i = 0; i < 3; i++) {
        apex[i] = light->center[i] - behind * forward[i];
        to_target[i] = target[i] - apex[i];
    }
    const double distance = softshi_dot3(forward, to_target);
    offset[0] = fabs(softshi_dot3(right, to_target));
    offset[1] = fabs(softshi_dot3(down, to_target));
    const double nearest = behind > 0.0                        ? behind
                           : distance - radius > 0.01 * radius ? distance - radius
                                                               : 0.01 * radius;
    if (!(distance > nearest))
        return SOFTSH_ERROR_INVALID_ARGUMENT;
    /* The cone that touches the sphere, widened by the target's offset from the axis. */
    const double span = hypot(distance, fmax(offset[0], offset[1]));
    const double angle = atan2(fmax(offset[0], offset[1]), distance) + (radius < span ? asin(radius / span) : 1.4);
    const double tangent = tan(fmin(angle, 1.4));
    const double farthest = distance + radius;
    if (!(nearest * farthest < HUGE_VAL))
        return SOFTSH_ERROR_INVALID_ARGUMENT;
    memset(out->view_matrix, 0, sizeof out->view_matrix);
    memset(out->projection, 0, sizeof out->projection);
    for (int c = 0; c < 3; c++) {
        out->view_matrix[4 * c] = right[c];
        out->view_matrix[4 * c + 1] = down[c];
        out->view_matrix[4 * c + 2] = forward[c];
    }
    out->view_matrix[12] = -softshi_dot3(right, apex);
    out->view_matrix[13] = -softshi_dot3(down, apex);
    out->view_matrix[14] = -softshi_dot3(forward, apex);
    out->view_matrix[15] = 1.0;
    out->projection[0] = out->projection[5] = 1.0 / tangent;
    out->projection[10] = farthest / (farthest - nearest);
    out->projection[11] = 1.0;
    out->projection[14] = -nearest * farthest / (farthest - nearest);
    out->near_distance = nearest;
    return SOFTSH_SUCCESS;
}
