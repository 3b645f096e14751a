#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
// One MSSM level (Schwarz and Stamminger 2007, section 5) over all layers: the range of 2^i x 2^i cells around each cell, from
// four texels of the level below. The cells are texels of pyramid level `join`: 0 gives the MSSM, more a YSM (2008, section 6).
#include "ss_types.h"
#include "ss_occluder_texels.glsl"

layout(local_size_x = 32, local_size_y = 4) in;

layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_OCCLUDERS, std140) uniform ss_occluders_buffer
{
    ss_occluders occ;
};
layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_MADE_RANGES) uniform writeonly imageBuffer made_ranges;
layout(constant_id = SS_SPEC_COUNT) const bool FROM_FAN_DEPTH = false; // an MSSM's level 1
layout(push_constant) uniform ss_push
{
    ss_level_push push;
};

vec2 unite(vec2 a, vec2 b)
{
    return vec2(min(a.x, b.x), max(a.y, b.y));
}

// A texel of the level below; rows of fan depths are whole quads. Of layers: the first one's, and the nearest of all.
vec2 load(uint row, int x)
{
    if (!FROM_FAN_DEPTH)
        return ss_range_at(row + uint(x));
    const float first = ss_depth_at(4u * row + uint(x));
    float nearest = first;
    for (uint layer = 1u; layer < occ.size.z; layer++)
        nearest = max(nearest, ss_depth_at(4u * (row + layer * occ.strides.x) + uint(x)));
    return vec2(first, nearest);
}

void main()
{
    const ivec2 size = ivec2((occ.size.xy + (1u << occ.levels.y) - 1u) >> occ.levels.y);
    // Level 1 covers cells x - 1 and x; level i > 1 unites the level below at x - 2^(i-2) and x + 2^(i-2): either way two
    // texels 2^(i-1) apart, so that one row of them serves the texels above and below it.
    const int shift = int(push.level) - 1, apart = 1 << shift, lo = -max(apart >> 1, 1);
    const int x = int(gl_GlobalInvocationID.x), row = int(gl_GlobalInvocationID.y);
    int y = ((row >> shift) * SS_WIDEN_ROWS << shift) + (row & (apart - 1));
    if (x >= size.x || y >= size.y)
        return;
    const uint to = occ.strides.z + uint(shift) * occ.strides.w;
    uint from = shift > 0 ? to - occ.strides.w : occ.size.w * occ.strides.y + occ.pyramid[occ.levels.y].x;
    if (FROM_FAN_DEPTH)
        from = occ.pyramid[0].z;
    const int left = max(x + lo, 0), right = min(x + lo + apart, size.x - 1);
    const uint stride = FROM_FAN_DEPTH ? occ.pyramid[0].w : uint(size.x), first = from + uint(max(y + lo, 0)) * stride;
    vec2 above = unite(load(first, left), load(first, right));
    for (int i = 0; i < SS_WIDEN_ROWS; i++) {
        const uint next = from + uint(min(y + lo + apart, size.y - 1)) * stride;
        const vec2 below = unite(load(next, left), load(next, right));
        if (y < size.y)
            imageStore(made_ranges, int(to) + y * size.x + x, vec4(unite(above, below), 0.0, 0.0));
        above = below;
        y += apart;
    }
}
