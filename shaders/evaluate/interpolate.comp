#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
// Active pixels between those that were evaluated: the mean of their neighbours where these lie on the same surface and differ
// little, otherwise on to the second round of evaluation. Penumbrae are smooth, and the smoother the wider they are (the adaptive
// precision of Guennebaud et al. 2007); no noise, and nothing that moves with the camera but the lattice. One lane per pixel.
#include "ss_types.h"
#include "ss_specialization.glsl"
#include "ss_occluder_bindings.glsl"
#include "ss_io_bindings.glsl"
#include "ss_filter_values.glsl"
#include "ss_lists.glsl"
#include "ss_receiver.glsl"
#include "ss_range.glsl"
#include "ss_kernel.glsl"
#include "ss_interpolation.glsl"

layout(local_size_x = SS_EVALUATE_GROUP) in;

void main()
{
    const uint index = (gl_WorkGroupID.y * SS_DISPATCH_WIDTH + gl_WorkGroupID.x) * SS_EVALUATE_GROUP + gl_LocalInvocationIndex;
    if (index >= control.interpolate_args.w)
        return;
    const uint slot = ss_interpolated_slot(index, 2u), id = tiles[slot];
    const float g_hi = uintBitsToFloat(tiles[slot + 1u]);
    const ivec2 pixel = ss_tile_pixel(id / SS_TILE_PIXELS, id % SS_TILE_PIXELS);
    const ivec4 steps = ss_neighbour_steps(pixel);
    const ivec2 at[4] = ivec2[](pixel - steps.xy, pixel + steps.xy, pixel - steps.zw, pixel + steps.zw);
    vec4 depths, stored;
    for (int i = 0; i < 4; i++) {
        depths[i] = ss_near_depth(at[i]);
        stored[i] = ss_near_visible(at[i]);
    }
    float mean;
    if (ss_interpolates(pixel, g_hi, ss_near_depth(pixel), depths, stored, mean)) {
        ss_write_visibility(pixel, mean);
        if (SS_STATS)
            ss_count(SS_STAT_INTERPOLATED, 1u);
    } else {
        ss_append_pixel(1u, id, g_hi);
    }
}
