#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
// One level of nodes of the dual grids over all levels' samples, of all layers (Yang et al. 2009, section 4.2): the range of a
// cell's four samples, or of four nodes of the level below. docs/numerics.md, section 10. One lane per node.
#include "ss_types.h"
#include "ss_occluder_texels.glsl"

layout(local_size_x = SS_SAMPLE_GROUP) in;

layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_OCCLUDERS, std140) uniform ss_occluders_buffer
{
    ss_occluders occ;
};
#include "ss_dual_grid.glsl"

layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_MADE_RANGES) uniform writeonly imageBuffer made_ranges;
layout(constant_id = SS_SPEC_COUNT) const bool FROM_SAMPLES = false; // level 0
layout(push_constant) uniform ss_push
{
    ss_level_push push;
};

// Of a level's samples those around a cell; where there are none, their neighbours stand in for them.
vec2 sample_range(uint layer, uint level, ivec2 cell)
{
    const ivec2 last = (ivec2(occ.size.xy) + (1 << level) - 1 >> level) - 1;
    const ivec2 a = clamp(cell - 1, ivec2(0), last), b = min(cell, last);
    const uint row = 4u * occ.pyramid[level].w, base = 4u * (layer * occ.strides.x + occ.pyramid[level].z);
    const uint lower = base + uint(a.y) * row, upper = base + uint(b.y) * row;
    const vec4 g = vec4(ss_depth_at(lower + uint(a.x)), ss_depth_at(lower + uint(b.x)), ss_depth_at(upper + uint(a.x)),
                        ss_depth_at(upper + uint(b.x)));
    return vec2(min(min(g.x, g.y), min(g.z, g.w)), max(max(g.x, g.y), max(g.z, g.w)));
}

vec2 children_range(uint layer, uint level, ivec2 cell)
{
    const ss_nodes below = ss_load_nodes(layer, level, push.level - 1u);
    const int apart = 1 << (push.level - 1u);
    vec2 range = vec2(3e38, -3e38);
    for (int i = 0; i < 4; i++) {
        const vec2 child = ss_range_at(ss_node_at(below, cell + ivec2(i & 1, i >> 1) * apart));
        range = vec2(min(range.x, child.x), max(range.y, child.y));
    }
    return range;
}

void main()
{
    const uint index = ss_first_node(0u, push.level) + gl_LocalInvocationIndex +
                       (gl_WorkGroupID.y * SS_DISPATCH_WIDTH + gl_WorkGroupID.x) * SS_SAMPLE_GROUP;
    if (index >= ss_first_node(0u, push.level + 1u))
        return;
    uint level = 0u;
    while (level < occ.levels.x && index >= ss_first_node(level + 1u, push.level))
        level++;
    const uint layer = gl_GlobalInvocationID.z;
    const ss_nodes nodes = ss_load_nodes(layer, level, push.level);
    const int i = int(index - ss_first_node(level, push.level));
    const ivec2 at = ivec2(i % nodes.size.x, i / nodes.size.x), cell = at << nodes.shift;
    // What is left of the room for a smaller join.
    if (at.y >= nodes.size.y)
        return;
    const vec2 range = FROM_SAMPLES ? sample_range(layer, level, cell) : children_range(layer, level, cell);
    imageStore(made_ranges, int(ss_node_at(nodes, cell)), vec4(range, 0.0, 0.0));
}
