#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
// Device depth of a map to fan depth, once per build: everything after it sees finite numbers that grow towards the light.
// And the pyramid's first two levels (HSM; Guennebaud et al. 2006), while the depths are at hand. Odd sizes: the last texel
// of a level covers what is left of its block.
#include "ss_types.h"

layout(local_size_x = 32, local_size_y = 4) in;

layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_OCCLUDERS, std140) uniform ss_occluders_buffer
{
    ss_occluders occ;
};
layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_FAN_DEPTH, std430) writeonly buffer ss_fan_depth_buffer
{
    float fan_depth[];
};
layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_RANGES, std430) writeonly buffer ss_ranges_buffer
{
    vec2 ranges[];
};
layout(set = SS_SET_IO, binding = SS_BIND_DEPTH) uniform texture2D map_depth;
layout(push_constant) uniform ss_push
{
    ss_convert_push push;
};

float convert(ivec2 at)
{
    const float depth = texelFetch(map_depth, push.rect.xy + at, 0).x;
    // NaN fails every comparison and becomes the far plane.
    const float d = depth >= 0.0 ? min(depth, 1.0) : (depth < 0.0 ? 0.0 : push.far_depth);
    const float g = push.depth_scale * d + push.depth_offset;
    fan_depth[push.layer * occ.strides.x + uint(at.y) * occ.size.x + uint(at.x)] = g;
    return g;
}

// A block of 2 x 2 texels; what is outside the map is clamped into it.
vec2 convert_block(ivec2 at, ivec2 last)
{
    const ivec2 a = min(at, last), b = min(at + 1, last);
    const float p = convert(a), q = convert(ivec2(b.x, a.y)), r = convert(ivec2(a.x, b.y)), s = convert(b);
    return vec2(min(min(p, q), min(r, s)), max(max(p, q), max(r, s)));
}

void main()
{
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy), last = ivec2(occ.size.xy) - 1;
    if (any(greaterThan(4 * at, last)))
        return;
    const uint base = push.layer * occ.strides.y;
    vec2 whole = vec2(3e38, -3e38);
    for (int i = 0; i < 4; i++) {
        const ivec2 block = 2 * at + ivec2(i & 1, i >> 1);
        const vec2 range = convert_block(2 * block, last);
        if (all(lessThanEqual(2 * block, last)))
            ranges[base + occ.pyramid[1].x + uint(block.y) * occ.pyramid[1].y + uint(block.x)] = range;
        whole = vec2(min(whole.x, range.x), max(whole.y, range.y));
    }
    if (occ.levels.x > 1u)
        ranges[base + occ.pyramid[2].x + uint(at.y) * occ.pyramid[2].y + uint(at.x)] = whole;
}
