#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
// The pixels of undecided tiles, one group per tile: lit and umbra pixels are written, the others are marked active and their
// tile goes on the penumbra list.
#include "ss_types.h"
#include "ss_specialization.glsl"
#include "ss_occluder_bindings.glsl"
#include "ss_io_bindings.glsl"
#include "ss_filter_values.glsl"
#include "ss_receiver.glsl"
#include "ss_range.glsl"
#include "ss_kernel.glsl"

layout(local_size_x = SS_TILE, local_size_y = SS_TILE) in;

shared uint active_pixels[2];

void main()
{
    const uint index = gl_WorkGroupID.y * SS_DISPATCH_WIDTH + gl_WorkGroupID.x;
    const bool exists = index < control.pixels_args.w; // the same for the whole group
    const uint lane = gl_LocalInvocationIndex;
    if (lane < 2u)
        active_pixels[lane] = 0u;
    barrier();

    const uint tile = exists ? tiles[ss_undecided_slot(index)] : 0u;
    const ivec2 pixel = ss_tile_pixel(tile, lane);
    const bool inside = exists && all(lessThan(pixel, frame.area.zw));
    const ss_receiver r = ss_load_receiver(min(pixel, frame.area.zw - 1));
    uint state = SS_STATE_LIT, nodes = 0u;
    if (inside && r.valid && r.away)
        state = SS_STATE_UMBRA;
    else if (inside && r.valid) {
        const ss_kernel k = ss_find_kernel(r);
        state = k.state;
        nodes = k.nodes;
    }
    if (inside && state == SS_STATE_PIXELS)
        atomicOr(active_pixels[lane >> 5], 1u << (lane & 31u));
    if (inside && state != SS_STATE_PIXELS) {
        const float dark = state == SS_STATE_UMBRA ? 1.0 : 0.0;
        ss_write_visibility(pixel, 1.0 - dark);
        if (SS_FILTER)
            ss_store_filter_values(pixel, dark, dark);
    }
    barrier();

    if (exists && lane == 0u && (active_pixels[0] | active_pixels[1]) != 0u) {
        const uint i = atomicAdd(control.evaluate_args.w, 1u), slot = ss_penumbra_slot(i);
        atomicMax(control.evaluate_args.x, min(i + 1u, SS_DISPATCH_WIDTH));
        atomicMax(control.evaluate_args.y, i / SS_DISPATCH_WIDTH + 1u);
        tiles[slot] = tile;
        tiles[slot + 1u] = active_pixels[0];
        tiles[slot + 2u] = active_pixels[1];
        if (SS_STATS) {
            ss_count(SS_STAT_ACTIVE, uint(bitCount(active_pixels[0]) + bitCount(active_pixels[1])));
            ss_count(SS_STAT_PENUMBRA, 1u);
        }
    }
    if (SS_STATS && inside) {
        ss_count(SS_STAT_NODES, nodes);
        if (state != SS_STATE_PIXELS)
            ss_count(state == SS_STATE_UMBRA ? SS_STAT_UMBRA : SS_STAT_LIT, 1u);
    }
}
