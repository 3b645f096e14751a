#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
// The pixels of undecided tiles, one group per tile: lit and umbra pixels are written, the others go on the active list, in
// any order: no result depends on it.
#include "ss_types.h"
#include "ss_specialization.glsl"
#include "ss_occluder_bindings.glsl"
#include "ss_io_bindings.glsl"
#include "ss_filter_values.glsl"
#include "ss_receiver.glsl"
#include "ss_range.glsl"
#include "ss_kernel.glsl"

layout(local_size_x = SS_TILE_X, local_size_y = SS_TILE_Y) in;

void append_active_pixel(uint id, float g_hi)
{
    const uint i = atomicAdd(control.evaluate_args.w, 1u);
    // The first pixel of each group of the next pass makes the dispatch large enough for it.
    if (i % SS_EVALUATE_GROUP == 0u) {
        const uint group = i / SS_EVALUATE_GROUP;
        atomicMax(control.evaluate_args.x, min(group + 1u, SS_DISPATCH_WIDTH));
        atomicMax(control.evaluate_args.y, group / SS_DISPATCH_WIDTH + 1u);
    }
    tiles[ss_active_slot(i)] = id;
    tiles[ss_active_slot(i) + 1u] = floatBitsToUint(g_hi);
}

void main()
{
    const uint index = gl_WorkGroupID.y * SS_DISPATCH_WIDTH + gl_WorkGroupID.x;
    if (index >= control.pixels_args.w)
        return;
    const uint tile = tiles[ss_undecided_slot(index)], lane = gl_LocalInvocationIndex;
    const ivec2 pixel = ss_tile_pixel(tile, lane);
    if (any(greaterThanEqual(pixel, frame.area.zw)))
        return;
    const ss_receiver r = ss_load_receiver(pixel);
    const ss_kernel k = ss_find_kernel(r, uintBitsToFloat(tiles[ss_undecided_slot(index) + 1u]));
    const uint state = !r.valid ? SS_STATE_LIT : r.away ? SS_STATE_UMBRA : k.state;
    if (state == SS_STATE_PIXELS)
        append_active_pixel(tile * SS_TILE_PIXELS + lane, k.g_hi);
    if (state == SS_STATE_UMBRA)
        ss_write_visibility(pixel, 0.0);
    if (SS_FILTER) {
        const float dark = state == SS_STATE_UMBRA ? 1.0 : 0.0;
        ss_store_filter_values(pixel, dark, dark);
    }
    if (SS_STATS) {
        ss_count(SS_STAT_NODES, k.nodes);
        ss_count(state == SS_STATE_PIXELS ? SS_STAT_ACTIVE : state == SS_STATE_UMBRA ? SS_STAT_UMBRA : SS_STAT_LIT, 1u);
    }
}
