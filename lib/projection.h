/* From matrices and a light to map space: docs/numerics.md, sections 1 to 3. All in double precision. */
#ifndef SOFTSHI_PROJECTION_H
#define SOFTSHI_PROJECTION_H

#include "context.h"
#include "shared.h"

/* A map's space. Rows act on world points (x, y, z, 1); dividing the first three by the last gives (u, v, g). */
typedef struct softshi_map_space {
    double rows[4][4]; /* u w, v w, g w, w */
    bool orthographic;
    double depth_scale, depth_offset; /* g = scale * device depth + offset */
    double far_depth;                 /* device depth of the far plane */
    double texel[2];                  /* tangent per texel (perspective), world size of a texel (orthographic) */
    double normal_sign;               /* orientation of the rows */
} softshi_map_space;

/* A light in a map's space. */
typedef struct softshi_light_space {
    double a[2][2]; /* A by rows */
    double u[2];
    double delta, epsilon;
    bool disc;
    bool point;        /* no extent: hard shadows */
    bool axis_aligned; /* A is diagonal */
} softshi_light_space;

/* Both tell the message callback what is wrong; `field` is the name to put in front. */
softsh_result softshi_map_space_create(const softsh_context *context, const softsh_light *light, const softsh_map *map,
                                       VkExtent2D extent, const char *field, softshi_map_space *out);
softsh_result softshi_light_space_create(const softsh_context *context, const softsh_light *light,
                                         const softshi_map_space *map, softshi_light_space *out);

/* Fills to_map, normal_map and the depth convention of a frame. */
softsh_result softshi_camera_space_create(const softsh_context *context, const softsh_camera *camera,
                                          const softshi_map_space *map, ss_frame *out);

/* Precision of a depth format in device depth: docs/numerics.md, rho. */
double softshi_depth_precision(VkFormat format);

#endif
