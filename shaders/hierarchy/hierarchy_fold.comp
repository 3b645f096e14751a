#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
// Which cells between four samples fold: may turn their back to a receiver that they hide a part of the light from.
// docs/numerics.md, section 10. Of all layers and levels; one lane per word of 32 cells.
#include "ss_types.h"
#include "ss_occluder_texels.glsl"

layout(local_size_x = SS_SAMPLE_GROUP) in;

layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_OCCLUDERS, std140) uniform ss_occluders_buffer
{
    ss_occluders occ;
    ss_plan plan;
};
layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_MADE_BITS, r32ui) uniform writeonly uimageBuffer made_bits;

uvec2 level_folds(uint level)
{
    const uvec4 both = occ.folds[level / 2u];
    return level % 2u == 0u ? both.xy : both.zw;
}

// The texel whose place and depth a sample has.
float place(uint at, uint level, uint size)
{
    return float(min((at << level) + ((1u << level) >> 1), size - 1u)) + 0.5;
}

// Four triangles side by side, with gradients d and one corner at (x, y, g): whether the light lies in front of each.
bvec4 faces_light(vec4 dx, vec4 dy, vec4 x, float y, vec4 g)
{
    const vec4 s = abs(dx * occ.a.x + dy * occ.a.z), t = abs(dx * occ.a.y + dy * occ.a.w);
    // The square of a disc's area stands in for it: extent.x is less than 1.
    const vec4 reach = occ.extent.x < 1.0 ? sqrt(s * s + t * t) : s + t;
    return lessThan(dx * (occ.light.x - occ.light.z * x) + dy * (occ.light.y - occ.light.z * y) + reach,
                    occ.light.w - occ.light.z * g);
}

void main()
{
    const uint word = (gl_WorkGroupID.y * SS_DISPATCH_WIDTH + gl_WorkGroupID.x) * SS_SAMPLE_GROUP + gl_LocalInvocationIndex;
    const uint layer = gl_GlobalInvocationID.z, words = uint(occ.extent.y), first = level_folds(0u).x;
    if (word >= words)
        return;
    uint level = 0u;
    while (level < occ.levels.x && word >= level_folds(level + 1u).x - first)
        level++;
    const uvec2 of_level = level_folds(level);
    const uint at = word + first - of_level.x, y = at / of_level.y, x = 32u * (at - y * of_level.y);
    const uint rows = (occ.size.y + (1u << level) - 1u) >> level, quads = occ.pyramid[level].w;
    const uint base = layer * occ.strides.x + occ.pyramid[level].z;
    const uint lower = base + y * quads, upper = base + min(y + 1u, rows - 1u) * quads;
    const float y0 = place(y, level, occ.size.y), y1 = place(min(y + 1u, rows - 1u), level, occ.size.y);
    const float per_y = 1.0 / max(y1 - y0, 0.5);
    vec4 low = ss_depth_quad_at(lower + min(x / 4u, quads - 1u)), high = ss_depth_quad_at(upper + min(x / 4u, quads - 1u));
    uint bits = 0u;
    for (uint q = 0u; q < 8u; q++) {
        const uint next = min(x / 4u + q + 1u, quads - 1u);
        const vec4 next_low = ss_depth_quad_at(lower + next), next_high = ss_depth_quad_at(upper + next);
        const vec4 right_low = vec4(low.yzw, next_low.x), right_high = vec4(high.yzw, next_high.x);
        vec4 x0, x1;
        for (uint i = 0u; i < 4u; i++) {
            x0[i] = place(x + 4u * q + i, level, occ.size.x);
            x1[i] = place(x + 4u * q + i + 1u, level, occ.size.x);
        }
        const vec4 per_x = 1.0 / max(x1 - x0, vec4(0.5));
        const vec4 dx_low = (right_low - low) * per_x, dx_high = (right_high - high) * per_x;
        const vec4 dy_left = (high - low) * per_y, dy_right = (right_high - right_low) * per_y;
        const uvec4 up = uvec4(faces_light(dx_low, dy_right, x0, y0, low)) & uvec4(faces_light(dx_high, dy_left, x0, y0, low));
        const uvec4 down = uvec4(faces_light(dx_low, dy_left, x0, y0, low)) &
                           uvec4(faces_light(dx_high, dy_right, x1, y1, right_high));
        const uvec4 folds = 1u - (up | down);
        bits |= (folds.x | folds.y << 1 | folds.z << 2 | folds.w << 3) << (4u * q);
        low = next_low;
        high = next_high;
    }
    // Cells that reach out of the map fold nowhere.
    const uint columns = (occ.size.x + (1u << level) - 1u) >> level, cells = min(max(columns - 1u, x) - x, 32u);
    bits &= y + 1u < rows ? cells == 32u ? 0xffffffffu : (1u << cells) - 1u : 0u;
    imageStore(made_bits, int(first + layer * words + word), uvec4(bits));
}
