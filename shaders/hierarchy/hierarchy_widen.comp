#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// One MSSM level (Schwarz and Stamminger 2007, section 5): the range of 2^i x 2^i cells around each cell, from four texels of
// the level below. The cells are texels of pyramid level `join`: 0 gives the MSSM, more a YSM (2008, section 6).
#include "ss_types.h"
#include "ss_specialization.glsl"
#include "ss_occluder_bindings.glsl"

layout(local_size_x = 32, local_size_y = 4) in;

layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_WIDE_OUT) uniform writeonly image2DArray wide_out;
layout(push_constant) uniform ss_push
{
    ss_level_push push;
};

vec2 below(ivec2 at, ivec2 size)
{
    const ivec2 t = clamp(at, ivec2(0), size - 1);
    if (push.level > 1u)
        return texelFetch(wide, ivec3(t, int(push.layer * occ.levels.z + push.level) - 2), 0).xy;
    const uint join = occ.levels.y, i = uint(t.y * size.x + t.x);
    if (join == 0u)
        return vec2(fan_depth[push.layer * occ.strides.x + i]);
    return pyramid[push.layer * occ.strides.y + occ.pyramid[join].x + i];
}

void main()
{
    const ivec2 size = ivec2((occ.size.xy + (1u << occ.levels.y) - 1u) >> occ.levels.y);
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, size)))
        return;
    // Level 1 covers cells x - 1 and x; level i > 1 unites the level below at x - 2^(i-2) and x + 2^(i-2).
    const int lo = push.level == 1u ? -1 : -(1 << (push.level - 2u));
    const int hi = push.level == 1u ? 0 : -lo;
    const vec2 a = below(at + ivec2(lo, lo), size), b = below(at + ivec2(hi, lo), size);
    const vec2 c = below(at + ivec2(lo, hi), size), d = below(at + ivec2(hi, hi), size);
    const vec2 range = vec2(min(min(a.x, b.x), min(c.x, d.x)), max(max(a.y, b.y), max(c.y, d.y)));
    imageStore(wide_out, ivec3(at, int(push.layer * occ.levels.z + push.level) - 1), vec4(range, 0.0, 0.0));
}
