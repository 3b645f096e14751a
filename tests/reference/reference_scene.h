/* Small scenes for tests of the reference and against it: matrices, planes and rectangles cast into maps and camera
 * images by intersecting rays, and a fixed-seed generator. */
#ifndef REFERENCE_SCENE_H
#define REFERENCE_SCENE_H

#include "reference_map.h"
#include "reference_receiver.h"

typedef enum reference_depth_range {
    REFERENCE_DEPTH_NORMAL,
    REFERENCE_DEPTH_REVERSED,
    REFERENCE_DEPTH_INFINITE,
    REFERENCE_DEPTH_REVERSED_INFINITE
} reference_depth_range;

typedef enum reference_depth_format {
    REFERENCE_FORMAT_EXACT, /* as good as the float the image is stored in */
    REFERENCE_FORMAT_UNORM16,
    REFERENCE_FORMAT_UNORM24
} reference_depth_format;

/* A rectangle or, with `infinite`, the plane it lies in: center + [-1, 1] u + [-1, 1] v. */
typedef struct reference_surface {
    double center[3], u[3], v[3];
    bool infinite;
} reference_surface;

/* View space looks along -z with y down, as Vulkan's clip space. */
void reference_look_at(const double eye[3], const double target[3], const double up[3], double out[16]);
/* Frustum of the rectangle left..right, top..bottom at distance 1 (bounds[0..3]), near to far. */
void reference_perspective(const double bounds[4], double near, double far, reference_depth_range range,
                           double out[16]);
/* Box left..right, top..bottom in view space; the infinite ranges are as the finite ones. */
void reference_orthographic(const double bounds[4], double near, double far, reference_depth_range range,
                            double out[16]);

/* Casts a ray per pixel centre between its near and far points. `depth` gets width x height device depths, the far
 * plane's where nothing is hit or only behind the near plane; `hits`, unless NULL, the surface's index or -1. */
void reference_cast(const double view[16], const double projection[16], uint32_t width, uint32_t height,
                    double far_depth, reference_depth_format format, const reference_surface *surfaces, uint32_t count,
                    float *depth, int32_t *hits);
/* Unit normal of a surface on the side of `viewer`. */
void reference_surface_normal(const reference_surface *surface, const double viewer[3], double normal[3]);
/* Fan depths of a map's device depths, as floats. */
void reference_map_convert(const reference_map *map, const float *depth, float *g);

/* Reproducible numbers: 64-bit state, any seed. */
uint32_t reference_random(uint64_t *state);
double reference_random_range(uint64_t *state, double low, double high);

#endif
