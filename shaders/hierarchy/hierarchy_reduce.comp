#version 460
#extension GL_GOOGLE_include_directive : require
// One level of the min/max pyramid (HSM; Guennebaud et al. 2006) from the one below. Odd sizes: the last texel of a level
// covers what is left of its block.
#include "ss_types.h"

layout(local_size_x = 32, local_size_y = 4) in;

layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_OCCLUDERS, std140) uniform ss_occluders_buffer
{
    ss_occluders occ;
};
layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_FAN_DEPTH, std430) readonly buffer ss_fan_depth_buffer
{
    float fan_depth[];
};
layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_PYRAMID, std430) buffer ss_pyramid_buffer
{
    vec2 pyramid[];
};
layout(push_constant) uniform ss_push
{
    ss_level_push push;
};
layout(constant_id = SS_SPEC_COUNT) const bool FROM_FAN_DEPTH = false; // level 1 reads level 0, which has one value a texel

uint level_offset(uint level)
{
    return push.layer * occ.strides.y + occ.pyramid[level].x;
}

void main()
{
    const uvec2 size = (occ.size.xy + (1u << push.level) - 1u) >> push.level;
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, size)))
        return;
    const uvec2 below = (occ.size.xy + (1u << (push.level - 1u)) - 1u) >> (push.level - 1u);
    const uvec2 a = 2u * at, b = min(a + 1u, below - 1u);
    vec2 range;
    if (FROM_FAN_DEPTH) {
        const uint base = push.layer * occ.strides.x;
        const float p = fan_depth[base + a.y * below.x + a.x], q = fan_depth[base + a.y * below.x + b.x];
        const float r = fan_depth[base + b.y * below.x + a.x], s = fan_depth[base + b.y * below.x + b.x];
        range = vec2(min(min(p, q), min(r, s)), max(max(p, q), max(r, s)));
    } else {
        const uint base = level_offset(push.level - 1u);
        const vec2 p = pyramid[base + a.y * below.x + a.x], q = pyramid[base + a.y * below.x + b.x];
        const vec2 r = pyramid[base + b.y * below.x + a.x], s = pyramid[base + b.y * below.x + b.x];
        range = vec2(min(min(p.x, q.x), min(r.x, s.x)), max(max(p.y, q.y), max(r.y, s.y)));
    }
    pyramid[level_offset(push.level) + at.y * size.x + at.x] = range;
}
