#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
// Active pixels between those that were evaluated: the mean of their neighbours where these lie on the same surface and differ
// little, otherwise on to the second round of evaluation. Penumbrae are smooth, and the smoother the wider they are (the adaptive
// precision of Guennebaud et al. 2007); no noise, and nothing that moves with the camera but the lattice. One lane per block of
// 4 x 4 pixels. Of a steep penumbra a whole block is left, which is a packet again; elsewhere those that have no contour in common.
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

const uint BETWEEN_MASK = 0xffffu & ~SS_LATTICE_MASK;

// The 3 x 3 pixels of the lattice in and around the block, which its other pixels share.
float lattice_depth[9], lattice_visible[9];

int lattice_index(ivec2 away)
{
    return (away.x >> 1) + 3 * (away.y >> 1);
}

void main()
{
    const uint index = (gl_WorkGroupID.y * SS_DISPATCH_WIDTH + gl_WorkGroupID.x) * SS_EVALUATE_GROUP + gl_LocalInvocationIndex;
    if (index >= control.interpolate_args.w)
        return;
    const uint slot = ss_interpolated_slot(index, SS_PACKET_WORDS), id = tiles[slot], mask = tiles[slot + 2u];
    const float g_hi = uintBitsToFloat(tiles[slot + 1u]);
    const ivec2 corner = ss_tile_pixel(id / SS_TILE_PIXELS, id % SS_TILE_PIXELS);
    for (int i = 0; i < 9; i++) {
        const ivec2 at = corner + 2 * ivec2(i % 3, i / 3);
        lattice_depth[i] = ss_near_depth(at);
        lattice_visible[i] = ss_near_visible(at);
    }
    uint left = 0u, interpolated = 0u;
    for (uint todo = mask & BETWEEN_MASK; todo != 0u; todo &= todo - 1u) {
        const uint bit = uint(findLSB(todo));
        const ivec2 away = ivec2(bit & 3u, bit >> 2), pixel = corner + away;
        const ivec4 steps = ss_neighbour_steps(pixel);
        const ivec4 at = ivec4(lattice_index(away - steps.xy), lattice_index(away + steps.xy), lattice_index(away - steps.zw),
                               lattice_index(away + steps.zw));
        const vec4 depths = vec4(lattice_depth[at.x], lattice_depth[at.y], lattice_depth[at.z], lattice_depth[at.w]);
        const vec4 stored = vec4(lattice_visible[at.x], lattice_visible[at.y], lattice_visible[at.z], lattice_visible[at.w]);
        float mean;
        const bool may = ss_interpolates(pixel, g_hi, ss_near_depth(pixel), depths, stored, mean);
        if (may)
            ss_write_visibility(pixel, mean);
        interpolated += uint(may);
        left |= uint(!may) << bit;
    }
    if (SS_PACKET > 1 && left == BETWEEN_MASK) {
        ss_append_packet(1u, SS_LIST_LARGE, id, g_hi, left);
        left = 0u;
    }
    for (uint todo = left; todo != 0u; todo &= todo - 1u) {
        const uint bit = uint(findLSB(todo));
        ss_append_pixel(1u, id + (bit & 3u) + SS_TILE_X * (bit >> 2), g_hi);
    }
    if (SS_STATS) {
        ss_count(SS_STAT_INTERPOLATED, interpolated);
        ss_count(SS_STAT_ACTIVE, interpolated);
    }
}
