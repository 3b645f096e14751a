/* Depth buffers for tests: a lamp over a floor and two rectangles, seen by a camera; rays cast in double precision, or
 * noise and worse on top of that. */
#ifndef SCENES_H
#define SCENES_H

#include "fixture.h"
#include "reference_scene.h"

typedef enum scene_light {
    SCENE_CENTRED,    /* a rectangle around the projection centre */
    SCENE_IN_FRONT,   /* in front of it, its axes swapped and mirrored, the frustum off-centre */
    SCENE_SUN,        /* a directional light along an orthographic map's axis */
    SCENE_TILTED_SUN, /* across it */
    SCENE_ROTATED,    /* a rectangle whose axes are no texel axes: microquads only */
    SCENE_LIGHT_COUNT
} scene_light;

typedef enum scene_content {
    SCENE_RECTANGLES,
    SCENE_NOISE, /* random blocks and texels in the map, steps in the camera's depth */
    SCENE_NASTY, /* that, and NaN, infinities, negative depths and depths beyond 1 in both */
    SCENE_CONTENT_COUNT
} scene_content;

typedef struct scene_info {
    scene_light light;
    scene_content content;
    uint32_t map_width, map_height, width, height; /* 0: 48 x 40 and 32 x 24 */
    uint32_t layers;                               /* 0: 1; the second one has planes of its own */
    double light_scale;                            /* 0: 1 */
    bool hard;                                     /* a light without size */
    reference_depth_range range;
    uint64_t seed;
} scene_info;

typedef struct scene {
    lamp_info lamp;
    eye_info eye; /* with normals; clear the pointer for a camera without */
    float *map_depth[2], *depth, *normals;
} scene;

void scene_create(const scene_info *info, scene *out);
/* Depths and normals of surfaces for the light, matrices and sizes `out->lamp` and `out->eye` have already. */
void scene_cast(scene *out, const reference_surface *surfaces, uint32_t count);
void scene_destroy(scene *s);
/* A sentence's worth of what a scene is. */
const char *scene_light_name(scene_light light);
const char *scene_content_name(scene_content content);

#endif
