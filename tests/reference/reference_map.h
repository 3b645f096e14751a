/* A map and its light in map space (u, v, g): sections 1 and 2 of docs/numerics.md. */
#ifndef REFERENCE_MAP_H
#define REFERENCE_MAP_H

#include <stdbool.h>
#include <stdint.h>

#include <softshadow/types.h>

typedef struct reference_map {
    uint32_t width, height; /* texels */
    bool perspective;
    double matrix[16]; /* projection * view */
    double matrix_inverse[16];
    double rows[4][4];                /* of `matrix` */
    double axis[3];                   /* unit world vector along which z grows, away from the light */
    double axis_length;               /* perspective: |n| */
    double depth_scale, depth_offset; /* g = depth_scale * device depth + depth_offset */
    double far_depth;                 /* device depth of the far plane, 0 or 1 */
    double texel[2];                  /* lateral world size of a texel; perspective: at distance 1 */

    bool directional;            /* the light is the unit disc in q; otherwise the square [-1, 1] x [-1, 1] */
    bool point;                  /* the light has no size; `a` is zero and `a_inverse` unset */
    bool axis_aligned;           /* `a` is diagonal: micropatches are possible */
    double center[3];            /* rectangle: its centre; directional: unit vector towards the light's centre */
    double axis_s[3], axis_t[3]; /* the half axes, swapped and mirrored; directional: tan(angular radius) long */
    double a[2][2];              /* rows u, v; columns s, t */
    double a_inverse[2][2];
    double offset[2]; /* U */
    double delta, epsilon;
} reference_map;

/* False where section 2 has no formula: an oblique or singular frustum, a light whose plane is not parallel to the
 * image plane or lies behind the projection centre, or shape and projection that do not go together. Matrices are
 * column-major. */
bool reference_map_derive(reference_map *map, const double view[16], const double projection[16], uint32_t width,
                          uint32_t height, const softsh_light *light);

/* Fan depth of a map's device depth: NaN is the far plane, other values are clamped to [0, 1]. */
double reference_map_depth_to_g(const reference_map *map, double depth);
/* Device depth of a fan depth, not clamped. */
double reference_map_g_to_depth(const reference_map *map, double g);
/* World point to (u, v, g); false, and uvg untouched, at or behind a perspective map's projection centre. */
bool reference_map_project(const reference_map *map, const double world[3], double uvg[3]);
/* (u, v, g) to the world point. */
void reference_map_unproject(const reference_map *map, const double uvg[3], double world[3]);

/* (u, v) where the segment from receiver (u, v, g) to light point q passes fan depth g. */
void reference_map_segment(const reference_map *map, const double receiver[3], const double q[2], double g,
                           double uv[2]);
/* The light point q behind map sample (u, v, g) as seen from the receiver; sample[2] > receiver[2]. */
void reference_map_backproject(const reference_map *map, const double receiver[3], const double sample[3], double q[2]);
/* Kernel of a receiver for occluders up to g_hi: u0, v0, u1, v1. It bounds the light's square, for a disc as well. */
void reference_map_kernel(const reference_map *map, const double receiver[3], double g_hi, double box[4]);

/* World point q of a rectangle, or the world ray from any receiver towards q of a directional light. */
void reference_map_light_point(const reference_map *map, const double q[2], double out[3]);
/* Whether all of the light lies on or behind the plane through `world` with normal `normal`. */
bool reference_map_light_behind(const reference_map *map, const double world[3], const double normal[3]);

#endif
