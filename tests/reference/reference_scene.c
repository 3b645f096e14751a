/* Small scenes for tests of the reference and against it. */
#include "reference_scene.h"
#include "reference_matrix.h"

#include <math.h>
#include <string.h>

void reference_look_at(const double eye[3], const double target[3], const double up[3], double out[16])
{
    double forward[3], right[3], down[3];
    reference_along(target, -1.0, eye, forward);
    reference_normalize(forward, forward);
    reference_cross(forward, up, right);
    reference_normalize(right, right);
    reference_cross(forward, right, down);
    for (int i = 0; i < 3; ++i) {
        out[4 * i + 0] = right[i];
        out[4 * i + 1] = down[i];
        out[4 * i + 2] = -forward[i];
        out[4 * i + 3] = 0.0;
    }
    out[12] = -reference_dot(right, eye);
    out[13] = -reference_dot(down, eye);
    out[14] = reference_dot(forward, eye);
    out[15] = 1.0;
}

void reference_perspective(const double bounds[4], double near, double far, reference_depth_range range, double out[16])
{
    memset(out, 0, 16 * sizeof(double));
    out[0] = 2.0 / (bounds[1] - bounds[0]);
    out[5] = 2.0 / (bounds[3] - bounds[2]);
    out[8] = (bounds[1] + bounds[0]) / (bounds[1] - bounds[0]);
    out[9] = (bounds[3] + bounds[2]) / (bounds[3] - bounds[2]);
    out[11] = -1.0;
    switch (range) {
    case REFERENCE_DEPTH_NORMAL:
        out[10] = far / (near - far);
        out[14] = near * far / (near - far);
        break;
    case REFERENCE_DEPTH_REVERSED:
        out[10] = near / (far - near);
        out[14] = near * far / (far - near);
        break;
    case REFERENCE_DEPTH_INFINITE:
        out[10] = -1.0;
        out[14] = -near;
        break;
    case REFERENCE_DEPTH_REVERSED_INFINITE:
        out[14] = near;
        break;
    }
}

void reference_orthographic(const double bounds[4], double near, double far, reference_depth_range range,
                            double out[16])
{
    memset(out, 0, 16 * sizeof(double));
    out[0] = 2.0 / (bounds[1] - bounds[0]);
    out[5] = 2.0 / (bounds[3] - bounds[2]);
    out[12] = -(bounds[1] + bounds[0]) / (bounds[1] - bounds[0]);
    out[13] = -(bounds[3] + bounds[2]) / (bounds[3] - bounds[2]);
    out[15] = 1.0;
    const bool reversed = range == REFERENCE_DEPTH_REVERSED || range == REFERENCE_DEPTH_REVERSED_INFINITE;
    out[10] = reversed ? 1.0 / (far - near) : 1.0 / (near - far);
    out[14] = reversed ? far / (far - near) : near / (near - far);
}

static float quantize(double depth, reference_depth_format format)
{
    const double steps = format == REFERENCE_FORMAT_UNORM16 ? 65535.0 : 16777215.0;
    return (float)(format == REFERENCE_FORMAT_EXACT ? depth : nearbyint(depth * steps) / steps);
}

/* Homogeneous intersection of the pixel's line start + t end with a surface; false if it misses. */
static bool intersect(const double start[4], const double end[4], const reference_surface *surface, double *t)
{
    double normal[3];
    reference_cross(surface->u, surface->v, normal);
    const double plane = reference_dot(normal, surface->center);
    const double at_start = reference_dot(normal, start) - plane * start[3];
    const double at_end = reference_dot(normal, end) - plane * end[3];
    *t = -at_start / at_end;
    if (!isfinite(*t))
        return false;
    double offset[3];
    const double w = start[3] + *t * end[3];
    for (int i = 0; i < 3; ++i)
        offset[i] = (start[i] + *t * end[i]) / w - surface->center[i];
    return surface->infinite || (fabs(reference_dot(offset, surface->u)) <= reference_dot(surface->u, surface->u) &&
                                 fabs(reference_dot(offset, surface->v)) <= reference_dot(surface->v, surface->v));
}

void reference_cast(const double view[16], const double projection[16], uint32_t width, uint32_t height,
                    double far_depth, reference_depth_format format, const reference_surface *surfaces, uint32_t count,
                    float *depth, int32_t *hits)
{
    double matrix[16], inverse[16];
    reference_matrix_multiply(projection, view, matrix);
    reference_matrix_inverse(matrix, inverse);
    for (uint32_t y = 0; y < height; ++y) {
        for (uint32_t x = 0; x < width; ++x) {
            /* The pixel's line, with the device depth as its parameter. */
            double start[4] = {2.0 * (x + 0.5) / width - 1.0, 2.0 * (y + 0.5) / height - 1.0, 0.0, 1.0};
            double end[4] = {0.0, 0.0, 1.0, 0.0};
            reference_matrix_apply(inverse, start, start);
            reference_matrix_apply(inverse, end, end);
            double nearest = far_depth;
            int32_t hit = -1;
            for (uint32_t k = 0; k < count; ++k) {
                double t;
                if (!intersect(start, end, &surfaces[k], &t) || !(t >= 0.0 && t <= 1.0))
                    continue;
                if (fabs(t - far_depth) > fabs(nearest - far_depth)) {
                    nearest = t;
                    hit = (int32_t)k;
                }
            }
            depth[(size_t)y * width + x] = quantize(nearest, format);
            if (hits)
                hits[(size_t)y * width + x] = hit;
        }
    }
}

void reference_surface_normal(const reference_surface *surface, const double viewer[3], double normal[3])
{
    double to_viewer[3];
    reference_cross(surface->u, surface->v, normal);
    reference_normalize(normal, normal);
    reference_along(viewer, -1.0, surface->center, to_viewer);
    if (reference_dot(normal, to_viewer) < 0.0)
        for (int i = 0; i < 3; ++i)
            normal[i] = -normal[i];
}

void reference_map_convert(const reference_map *map, const float *depth, float *g)
{
    for (size_t i = 0; i < (size_t)map->width * map->height; ++i)
        g[i] = (float)reference_map_depth_to_g(map, (double)depth[i]);
}

uint32_t reference_random(uint64_t *state)
{
    /* SplitMix64 (Steele, Lea, Flood 2014), its upper half. */
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (uint32_t)((z ^ (z >> 31)) >> 32);
}

double reference_random_range(uint64_t *state, double low, double high)
{
    return low + (high - low) * reference_random(state) / 4294967295.0;
}
