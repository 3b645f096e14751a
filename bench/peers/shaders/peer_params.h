/* Push constants of every peer, shared by C and GLSL. */
#ifndef PEER_PARAMS_H
#define PEER_PARAMS_H

#ifdef GL_core_profile
#define PEER_VEC2 vec2
#define PEER_VEC4 vec4
#else
typedef struct peer_vec2 {
    float x, y;
} peer_vec2;
typedef struct peer_vec4 {
    float x, y, z, w;
} peer_vec4;
#define PEER_VEC2 peer_vec2
#define PEER_VEC4 peer_vec4
#endif

/* (u w, v w, g w, w) = the four rows times (pixel x, pixel y, camera depth - far_depth, 1); notation of
 * docs/numerics.md. */
struct peer_params {
    PEER_VEC4 row_u;
    PEER_VEC4 row_v;
    PEER_VEC4 row_g;
    PEER_VEC4 row_w;
    PEER_VEC4 light;   /* A, column by column: texels per unit of fan depth for q = (1, 0) and (0, 1) */
    PEER_VEC2 offset;  /* U, likewise for the light's centre */
    float light_plane; /* delta: distance of the light's plane from the map's projection centre */
    float depth_scale; /* g = depth_scale * map depth + depth_offset */
    float depth_offset;
    float reach;         /* pcss: fan depth of the nearest possible blocker; pcf: see peer_settings::pcf_kernel */
    float map_precision; /* of the map's depths, in units of g */
    float camera_precision;
    float far_depth; /* camera depth where nothing was rendered: 0 or 1 */
    float slope_limit;
    float perspective; /* 1 for a perspective map, 0 for an orthographic one */
    float map_count;   /* average: how many maps there are in all */
};

#endif
