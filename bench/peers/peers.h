/* The techniques the library is compared with, as Vulkan compute: `copy` (the floor: reads the depth, writes 1),
 * `hard`, `pcf`, `pcss`, `march` and `average`. Each is one dispatch (`average`: one for each of its maps), as fast and
 * as accurate as we can make it without changing what it is: no noise, no temporal input, the light's true extents, the
 * receiver's plane at every tap.
 *
 * Peers read the same depth buffers as the library and share its conventions (include/softshadow/types.h). A peer is
 * used by one thread at a time. */
#ifndef PEERS_H
#define PEERS_H

#include "gpu.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum peer_kind {
    PEER_COPY,
    PEER_HARD,
    PEER_PCF,
    PEER_PCSS,
    PEER_MARCH,
    PEER_AVERAGE,
    PEER_KIND_COUNT
} peer_kind;

/* Zero is the default everywhere. */
typedef struct peer_settings {
    uint32_t blocker_taps; /* pcss: 0 means 16; at most 1024 */
    uint32_t filter_taps;  /* pcf, pcss: 0 means 32; at most 1024 */
    /* pcf: the kernel's size at the receiver over the light's size; 0 means 0.25, the penumbra of a blocker at 80 % of
     * the way from the light. For a directional light: the blocker's distance in world units instead; 0 means a
     * twentieth of the map's depth range. */
    double pcf_kernel;
    /* march: points of the light, 0 means 16; average: how many maps there are in all, 0 means 64; at most 1024 */
    uint32_t light_samples;
    uint32_t march_steps; /* march: most steps of a ray, 0 means 16; at most 1024, and 60,000 for all rays together */
    /* pcss, march: distance along the map's axis of the nearest blocker there can be, in world units, from the
     * projection centre, or from the near plane of an orthographic map; 0 means the near plane. What a renderer that
     * fits its near planes to the scene would have: the smaller the search, the better its taps and the fewer pixels to
     * filter. */
    double nearest_blocker;
} peer_settings;

typedef struct peer_info {
    peer_kind kind;
    peer_settings settings;
    bool directional;        /* the light is a disc of directions, not a rectangle */
    uint32_t max_recordings; /* recordings that may be pending at once; 0 means 4 */
    VkPipelineCache cache;   /* may be VK_NULL_HANDLE */
} peer_info;

typedef struct peer_depth {
    VkImageView view;     /* depth aspect, or colour of an R32F image; usage SAMPLED */
    VkImageLayout layout; /* during the dispatch */
    VkFormat format;      /* tells the precision */
    uint32_t width, height;
    double view_matrix[16]; /* column-major, world -> view -> Vulkan clip space */
    double projection[16];
} peer_depth;

typedef struct peer_light {
    double center[3], half_u[3], half_v[3]; /* rectangle, parallel to the map's image plane */
    double direction[3], angular_radius;    /* directional: the way the light travels, radians */
} peer_light;

typedef struct peer_inputs {
    peer_depth camera; /* its size is the render size */
    peer_depth map;    /* projection centre on the light's plane, or behind it with the near plane on it or beyond;
                          orthographic with a directional light. Not read by `copy`, but must be given. `average`:
                          the map of one point of the light */
    peer_light light;
    VkImageView visibility; /* storage image of the camera's size, R8, R16, R16F or R32F, layout GENERAL. `average`:
                               R32F, 0 before the first map; each adds what it lights over the number of maps */
} peer_inputs;

typedef struct peer peer;

/* "copy", "hard", "pcf" and so on; also the pass's name. */
const char *peer_name(peer_kind kind);
/* PEER_KIND_COUNT if there is none of that name. */
peer_kind peer_find(const char *name);

/* Compiles the pipeline. On failure *out is NULL and g->error says why. */
bool peer_create(gpu *g, const peer_info *info, peer **out);
/* NULL is allowed; recordings must have finished. */
void peer_destroy(gpu *g, peer *p);

/* Records one dispatch. Entry: both depths visible to COMPUTE_SHADER / SHADER_READ, earlier accesses of the visibility
 * image made available to COMPUTE_SHADER / SHADER_WRITE (`average`: and SHADER_READ). Exit: the visibility image last
 * written there. Clobbers the compute pipeline, descriptor set 0 and the push constants. On failure nothing is recorded
 * and g->error says why. */
bool peer_record(gpu *g, peer *p, VkCommandBuffer cmd, const peer_inputs *inputs);

/* The value of peer_settings::nearest_blocker for a map whose depths run from `least` to `greatest`, whichever of the
 * two its convention has nearer. Never negative. */
double peer_nearest_blocker(const peer_depth *map, const peer_light *light, double least, double greatest);

#ifdef __cplusplus
}
#endif

#endif
