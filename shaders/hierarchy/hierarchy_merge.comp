#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
// The pyramid over all layers from the layers' own, texel by texel: the first layer's farthest and the nearest of all, so that one
// query answers for every layer.
#include "ss_types.h"
#include "ss_occluder_texels.glsl"

layout(local_size_x = SS_SAMPLE_GROUP) in;

layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_OCCLUDERS, std140) uniform ss_occluders_buffer
{
    ss_occluders occ;
};
layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_MADE_RANGES) uniform writeonly imageBuffer made_ranges;

void main()
{
    const uint i = (gl_WorkGroupID.y * SS_DISPATCH_WIDTH + gl_WorkGroupID.x) * SS_SAMPLE_GROUP + gl_LocalInvocationIndex;
    if (i >= occ.strides.y)
        return;
    vec2 range = ss_range_at(i);
    for (uint layer = 1u; layer < occ.size.z; layer++)
        range.y = max(range.y, ss_range_at(layer * occ.strides.y + i).y);
    imageStore(made_ranges, int(occ.size.w * occ.strides.y + i), vec4(range, 0.0, 0.0));
}
