#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
// Device depth of a map to fan depth, once per build: everything after it sees finite numbers that grow towards the light.
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
layout(set = SS_SET_IO, binding = SS_BIND_DEPTH) uniform texture2D map_depth;
layout(push_constant) uniform ss_push
{
    ss_convert_push push;
};

void main()
{
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, occ.size.xy)))
        return;
    const float depth = texelFetch(map_depth, push.rect.xy + ivec2(at), 0).x;
    // NaN fails every comparison and becomes the far plane.
    const float d = depth >= 0.0 ? min(depth, 1.0) : (depth < 0.0 ? 0.0 : push.far_depth);
    fan_depth[push.layer * occ.strides.x + at.y * occ.size.x + at.x] = push.depth_scale * d + push.depth_offset;
}
