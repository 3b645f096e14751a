#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
// The blocks of undecided tiles, one lane each, for techniques that evaluate packets of pixels: bounds a block's receivers as
// classify_tiles does a tile's, and asks the hierarchy about them. Umbra blocks are written; the pixels of undecided ones go on to
// evaluation, in packets or one by one.
#include "ss_types.h"
#include "ss_specialization.glsl"
#include "ss_occluder_bindings.glsl"
#include "ss_io_bindings.glsl"
#include "ss_filter_values.glsl"
#include "ss_lists.glsl"
#include "ss_receiver.glsl"
#include "ss_range.glsl"
#include "ss_kernel.glsl"
#include "ss_bounds.glsl"

const int PIXELS = SS_BLOCK * SS_BLOCK;

layout(local_size_x = SS_EVALUATE_GROUP) in;

ivec2 offset_of(int i)
{
    return ivec2(i % SS_BLOCK, i / SS_BLOCK);
}

uint mask_bit(int i)
{
    return uint(i % SS_BLOCK + 4 * (i / SS_BLOCK));
}

// `mask`: pixels that are receivers in front of the light, and inside the map.
ss_bounds bound(ivec2 corner, ivec2 end, out uint mask)
{
    ss_bounds t;
    vec3 p[PIXELS];
    vec4 any_h = vec4(0.0, 0.0, 0.0, 1.0);
    t.usable = true;
    t.exact = false;
    t.lo = vec2(3e38);
    t.hi = vec2(-3e38);
    t.g_lo = 3e38;
    t.g_hi = -3e38;
    mask = 0u;
    [[unroll]] for (int i = 0; i < PIXELS; i++) {
        const ivec2 pixel = corner + offset_of(i);
        const float depth = ss_load_depth(pixel);
        const vec4 h = ss_to_map(vec2(pixel) + 0.5, depth);
        p[i] = h.xyz / h.w;
        const bool valid = all(lessThan(pixel, end)) && ss_is_receiver(depth) && ss_is_in_front(h) &&
                           all(greaterThanEqual(p[i].xy, vec2(0.0))) && all(lessThanEqual(p[i].xy, vec2(occ.size.xy))) &&
                           occ.light.w - occ.light.z * p[i].z > 0.0;
        mask |= uint(valid) << mask_bit(i);
        any_h = valid ? h : any_h;
        t.lo = valid ? min(t.lo, p[i].xy) : t.lo;
        t.hi = valid ? max(t.hi, p[i].xy) : t.hi;
        t.g_lo = valid ? min(t.g_lo, p[i].z) : t.g_lo;
        t.g_hi = valid ? max(t.g_hi, p[i].z) : t.g_hi;
    }
    t.eta = ss_eta(any_h, vec2(0.0));
    // The plane through three corners, if all are there.
    const int right = SS_BLOCK - 1, below = PIXELS - SS_BLOCK;
    const vec3 e = p[right] - p[0], f = p[below] - p[0];
    const uint corners = 1u | 1u << mask_bit(right) | 1u << mask_bit(below);
    const float det = e.x * f.y - e.y * f.x;
    vec2 gradient = vec2(e.z * f.y - f.z * e.y, f.z * e.x - e.z * f.x) / det;
    if ((mask & corners) != corners || !(det * det > 1e-6 * dot(e.xy, e.xy) * dot(f.xy, f.xy)))
        gradient = vec2(0.0);
    t.gradient = ss_finite_gradient(gradient);
    t.side = ss_side(any_h, t.gradient);
    gradient = ss_clamp_gradient(gradient, t.g_hi);
    float base = 3e38, top = -3e38;
    [[unroll]] for (int i = 0; i < PIXELS; i++) {
        const bool valid = (mask >> mask_bit(i) & 1u) != 0u;
        const float rest = p[i].z - dot(gradient, p[i].xy);
        base = valid ? min(base, rest) : base;
        top = valid ? max(top, rest) : top;
    }
    t.plane = vec3(gradient, base);
    t.thickness = top - base;
    return t;
}

// The pixels that are evaluated first: all, or of those between which others are interpolated every second one of every second
// row.
void append(uint id, uint mask, float g_hi)
{
    if (SS_SPARSE) {
        const uint slot = ss_add_interpolated(SS_PACKET_WORDS);
        tiles[slot] = id;
        tiles[slot + 1u] = floatBitsToUint(g_hi);
        tiles[slot + 2u] = mask;
    }
    const uint first = SS_SPARSE ? mask & SS_LATTICE_MASK : mask;
    if (SS_PACKET == 1) {
        for (uint todo = first; todo != 0u; todo &= todo - 1u) {
            const uint bit = uint(findLSB(todo));
            ss_append_pixel(0u, id + (bit & 3u) + SS_TILE_X * (bit >> 2), g_hi);
        }
    } else if (SS_SPARSE) {
        if (first != 0u)
            ss_append_packet(0u, SS_LIST_SMALL, id, g_hi, first);
    } else if (SS_PACKET == 2) {
        for (uint i = 0u; i < 4u; i++) {
            const uint x = 2u * (i & 1u), y = i & 2u, part = mask >> (x + 4u * y) & SS_SMALL_MASK;
            if (part != 0u)
                ss_append_packet(0u, SS_LIST_SMALL, id + x + SS_TILE_X * y, g_hi, part);
        }
    } else {
        ss_append_packet(0u, SS_LIST_LARGE, id, g_hi, mask);
    }
}

void main()
{
    const uint index = (gl_WorkGroupID.y * SS_DISPATCH_WIDTH + gl_WorkGroupID.x) * SS_EVALUATE_GROUP + gl_LocalInvocationIndex;
    const uint entry = index / SS_TILE_BLOCKS, block = index % SS_TILE_BLOCKS;
    if (entry >= control.pixels_args.w)
        return;
    const uint tile = tiles[ss_undecided_slot(entry)];
    const ivec2 tile_corner = ss_tile_pixel(tile, 0u), at = ivec2(block % SS_BLOCK_ROW, block / SS_BLOCK_ROW) * SS_BLOCK;
    const ivec2 corner = tile_corner + at, end = min(tile_corner + ivec2(SS_TILE_X, SS_TILE_Y), frame.area.zw);
    uint mask, nodes = 0u;
    float g_hi = uintBitsToFloat(tiles[ss_undecided_slot(entry) + 1u]);
    const ss_bounds bounds = bound(corner, end, mask);
    uint state = mask == 0u ? SS_STATE_LIT : ss_classify_bounds(bounds, SS_MAX_REFINEMENTS, g_hi, nodes);
    // Normals can make single pixels face away.
    if (SS_NORMALS && state == SS_STATE_LIT && mask != 0u)
        state = SS_STATE_PIXELS;
    if (state == SS_STATE_PIXELS)
        append(tile * SS_TILE_PIXELS + uint(at.x + at.y * SS_TILE_X), mask, g_hi);
    for (int i = 0; i < (state == SS_STATE_UMBRA ? PIXELS : 0); i++)
        if ((mask >> mask_bit(i) & 1u) != 0u)
            ss_write_visibility(corner + offset_of(i), 0.0);
    // Pixels that are evaluated store this themselves.
    for (int i = 0; i < (SS_SPARSE ? PIXELS : 0); i++) {
        const ivec2 pixel = corner + offset_of(i);
        const bool receiver = (mask >> mask_bit(i) & 1u) != 0u;
        if (((pixel.x | pixel.y) & 1) == 0 && all(lessThan(pixel, end)) && (state != SS_STATE_PIXELS || !receiver))
            ss_store_visible(pixel, receiver && state == SS_STATE_UMBRA ? SS_ALL_DARK : SS_ALL_LIT);
    }
    if (SS_STATS) {
        const ivec2 size = min(end - corner, SS_BLOCK);
        const uint receivers = uint(bitCount(mask)), others = uint(max(size.x, 0) * max(size.y, 0)) - receivers;
        ss_count(SS_STAT_NODES, nodes);
        ss_count(SS_STAT_LIT, others + (state == SS_STATE_LIT ? receivers : 0u));
        ss_count(SS_STAT_UMBRA, state == SS_STATE_UMBRA ? receivers : 0u);
    }
}
