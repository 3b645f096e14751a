#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
// The pixels of undecided tiles, one group per tile: lit and umbra pixels are written, the others go on the active list, in
// any order: no result depends on it.
#include "ss_types.h"
#include "ss_specialization.glsl"
#include "ss_occluder_bindings.glsl"
#include "ss_io_bindings.glsl"
#include "ss_filter_values.glsl"
#include "ss_lists.glsl"
#include "ss_receiver.glsl"
#include "ss_range.glsl"
#include "ss_kernel.glsl"

layout(local_size_x = SS_TILE_X, local_size_y = SS_TILE_Y) in;

// With interpolation every second pixel of every second row is evaluated first.
bool is_on_lattice(ivec2 pixel)
{
    return !SS_SPARSE || ((pixel.x | pixel.y) & 1) == 0;
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
    const uint id = tile * SS_TILE_PIXELS + lane;
    if (state == SS_STATE_PIXELS && is_on_lattice(pixel))
        ss_append_pixel(0u, id, k.g_hi);
    if (SS_SPARSE && state == SS_STATE_PIXELS && !is_on_lattice(pixel)) {
        const uint slot = ss_add_interpolated(2u);
        tiles[slot] = id;
        tiles[slot + 1u] = floatBitsToUint(k.g_hi);
    }
    if (SS_SPARSE && state != SS_STATE_PIXELS)
        ss_store_visible(pixel, state == SS_STATE_UMBRA ? SS_ALL_DARK : SS_ALL_LIT);
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
