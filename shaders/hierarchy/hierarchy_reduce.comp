#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
// Two levels of the min/max pyramid (HSM; Guennebaud et al. 2006) from the one below them, of all layers. Odd sizes: the last
// texel of a level covers what is left of its block.
#include "ss_types.h"
#include "ss_occluder_texels.glsl"

layout(local_size_x = 32, local_size_y = 4) in;

layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_OCCLUDERS, std140) uniform ss_occluders_buffer
{
    ss_occluders occ;
};
layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_MADE_RANGES) uniform writeonly imageBuffer made_ranges;
layout(push_constant) uniform ss_push
{
    ss_level_push push;
};

void store_range(uint at, vec2 range)
{
    imageStore(made_ranges, int(at), vec4(range, 0.0, 0.0));
}

void main()
{
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy), whole_map = ivec2(occ.size.xy) - 1;
    const ivec2 last = whole_map >> push.level, last_below = whole_map >> (push.level - 1u);
    if (any(greaterThan(2 * at, last)))
        return;
    const uint layer = gl_GlobalInvocationID.z * occ.strides.y, below = layer + occ.pyramid[push.level - 1u].x;
    const uint level = layer + occ.pyramid[push.level].x;
    const int row = last.x + 1, row_below = last_below.x + 1;
    vec2 whole = vec2(3e38, -3e38);
    for (int i = 0; i < 4; i++) {
        const ivec2 block = 2 * at + ivec2(i & 1, i >> 1);
        const ivec2 a = min(2 * block, last_below), b = min(2 * block + 1, last_below);
        const vec2 p = ss_range_at(below + uint(a.y * row_below + a.x)), q = ss_range_at(below + uint(a.y * row_below + b.x));
        const vec2 r = ss_range_at(below + uint(b.y * row_below + a.x)), s = ss_range_at(below + uint(b.y * row_below + b.x));
        const vec2 range = vec2(min(min(p.x, q.x), min(r.x, s.x)), max(max(p.y, q.y), max(r.y, s.y)));
        if (all(lessThanEqual(block, last)))
            store_range(level + uint(block.y * row + block.x), range);
        whole = vec2(min(whole.x, range.x), max(whole.y, range.y));
    }
    if (push.level < occ.levels.x)
        store_range(layer + occ.pyramid[push.level + 1u].x + uint(at.y) * occ.pyramid[push.level + 1u].y + uint(at.x), whole);
}
