#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
// How many wide levels the largest possible kernel can ask for, given the light and the map's actual depth range. The rest
// are dispatched with zero groups; a query above what was built falls back on the pyramid's root.
#include "ss_types.h"
#include "ss_occluder_texels.glsl"

layout(local_size_x = 1) in;

layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_OCCLUDERS, std140) uniform ss_occluders_buffer
{
    ss_occluders occ;
};
layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_PLAN, std430) writeonly buffer ss_plan_buffer
{
    ss_plan plan;
};

void main()
{
    float nearest = occ.depths.w, farthest = occ.depths.w;
    for (uint layer = 0u; layer < occ.size.z; layer++) {
        const uint top = occ.levels.x;
        const vec2 range = ss_range_at(layer * occ.strides.y + occ.pyramid[top].x);
        nearest = max(nearest, range.y);
        farthest = min(farthest, range.x);
    }
    if (occ.light.z > 0.0)
        nearest = min(nearest, occ.light.w / occ.light.z);
    // Receivers farther than the far plane have larger kernels; they take the root instead.
    const float k = (nearest - farthest) / (occ.light.w - occ.light.z * nearest);
    const vec2 corner = max(abs(occ.light.xy), abs(occ.light.xy - occ.light.z * vec2(occ.size.xy)));
    const vec2 side = (2.0 * vec2(abs(occ.a.x) + abs(occ.a.y), abs(occ.a.z) + abs(occ.a.w)) + corner) * k;
    const float map_side = float(max(occ.size.x, occ.size.y));
    float texels = max(side.x, side.y) + 4.0;
    if (!(texels <= map_side))
        texels = map_side;
    const uint cells = (uint(ceil(texels)) >> occ.levels.y) + 2u;
    const uint wanted = min(uint(findMSB(cells)), occ.levels.z);
    const uvec2 size = (occ.size.xy + (1u << occ.levels.y) - 1u) >> occ.levels.y;
    for (uint i = 0u; i < SS_MAX_LEVELS; i++) {
        // Rows of invocations: every one makes SS_WIDEN_ROWS rows of texels, 2^i apart.
        const uint block = SS_WIDEN_ROWS << i, rows = (size.y + block - 1u) / block << i;
        plan.args[i] = uvec4(i < wanted ? (size.x + 31u) / 32u : 0u, (rows + 3u) / 4u, 1u, 0u);
    }
    plan.built = uvec4(wanted, occ.levels.z - wanted, 0u, 0u);
}
