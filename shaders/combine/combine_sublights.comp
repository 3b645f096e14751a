#version 460
#extension GL_GOOGLE_include_directive : require
// Sub-lights: each shows a share of itself, and the light's is the mean (Yang et al. 2009, section 5). One lane per pixel.
#include "ss_types.h"
#include "ss_specialization.glsl"
#include "ss_io_bindings.glsl"

layout(local_size_x = SS_TILE_X, local_size_y = SS_TILE_Y) in;
layout(push_constant) uniform ss_push
{
    ss_combine_push push;
};

void main()
{
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, frame.area.zw)))
        return;
    const float before = push.first != 0u ? 0.0 : filter_values[ss_sum_index(pixel)];
    const float sum = before + filter_values[ss_sublight_index(pixel)];
    filter_values[ss_sum_index(pixel)] = sum;
    if (push.count != 0u)
        imageStore(visibility_image, frame.area.xy + pixel, vec4(sum / float(push.count)));
}
