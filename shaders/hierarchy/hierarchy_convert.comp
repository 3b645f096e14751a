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
layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_MADE_DEPTH) uniform writeonly imageBuffer made_depth;
layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_MADE_RANGES) uniform writeonly imageBuffer made_ranges;
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
    return push.depth_scale * d + push.depth_offset;
}

// Four texels of a row; what is outside the map is clamped into it.
vec4 convert_quad(ivec2 at, ivec2 last)
{
    const int y = min(at.y, last.y);
    return vec4(convert(ivec2(at.x, y)), convert(ivec2(min(at.x + 1, last.x), y)), convert(ivec2(min(at.x + 2, last.x), y)),
                convert(ivec2(min(at.x + 3, last.x), y)));
}

void store_range(uint at, vec2 range)
{
    imageStore(made_ranges, int(push.layer * occ.strides.y + at), vec4(range, 0.0, 0.0));
}

void main()
{
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy), last = ivec2(occ.size.xy) - 1;
    if (any(greaterThan(4 * at, last)))
        return;
    vec2 whole = vec2(3e38, -3e38);
    for (int i = 0; i < 2; i++) {
        const ivec2 pair = ivec2(4 * at.x, 4 * at.y + 2 * i);
        const vec4 lower = convert_quad(pair, last), upper = convert_quad(pair + ivec2(0, 1), last);
        const int quad = int(push.layer * occ.strides.x + occ.pyramid[0].z + uint(pair.y) * occ.pyramid[0].w) + at.x;
        if (pair.y <= last.y)
            imageStore(made_depth, quad, lower);
        if (pair.y + 1 <= last.y)
            imageStore(made_depth, quad + int(occ.pyramid[0].w), upper);
        const vec4 farther = min(lower, upper), nearer = max(lower, upper);
        const vec2 left = vec2(min(farther.x, farther.y), max(nearer.x, nearer.y));
        const vec2 right = vec2(min(farther.z, farther.w), max(nearer.z, nearer.w));
        const uint block = occ.pyramid[1].x + uint(2 * at.y + i) * occ.pyramid[1].y + uint(2 * at.x);
        if (pair.y <= last.y)
            store_range(block, left);
        if (pair.y <= last.y && pair.x + 2 <= last.x)
            store_range(block + 1u, right);
        whole = vec2(min(whole.x, min(left.x, right.x)), max(whole.y, max(left.y, right.y)));
    }
    if (occ.levels.x > 1u)
        store_range(occ.pyramid[2].x + uint(at.y) * occ.pyramid[2].y + uint(at.x), whole);
}
