#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
// One lane per tile of 8 x 8 pixels: bounds the tile's receivers by a plane and a thickness, and asks the hierarchy whether all
// of them are lit or all in umbra. Lit tiles are done already, umbra tiles are written here; neither is seen again. The others
// go to classify_pixels with the nearest occluder there can be.
#include "ss_types.h"
#include "ss_specialization.glsl"
#include "ss_occluder_bindings.glsl"
#include "ss_io_bindings.glsl"
#include "ss_receiver.glsl"
#include "ss_range.glsl"
#include "ss_kernel.glsl"
#include "ss_bounds.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// Receivers of a tile in device depth: first + step x + step y + residual.
struct tile_depth
{
    float first;
    vec2 step;
    vec2 residual; // least, most; least > most: no receivers
};

vec4 load_column(uint tile, uint column)
{
    const uint slot = ss_column_slot(tile, column);
    return uintBitsToFloat(uvec4(tiles[slot], tiles[slot + 1u], tiles[slot + 2u], tiles[slot + 3u]));
}

// Device depth is affine in the pixel on any plane, so the residuals measure how far the tile is from being one.
tile_depth combine_columns(uint tile)
{
    vec4 columns[SS_TILE_X];
    for (uint i = 0u; i < SS_TILE_X; i++)
        columns[i] = load_column(tile, i);
    const vec4 left = columns[0], right = columns[SS_TILE_X - 1];
    const vec2 last = vec2(SS_TILE_X - 1, SS_TILE_Y - 1);
    tile_depth d;
    d.first = left.x;
    d.step = vec2(right.x - left.x, left.y - left.x) / last;
    d.residual = vec2(3e38, -3e38);
    for (uint i = 0u; i < SS_TILE_X; i++) {
        const vec4 column = columns[i];
        // Between its ends a column's line leaves the plane by no more than at one of them.
        const vec2 off = column.xy - (d.first + d.step.x * float(i) + vec2(0.0, d.step.y * last.y));
        const bool any_receiver = column.z <= column.w;
        d.residual.x = any_receiver ? min(d.residual.x, min(off.x, off.y) + column.z) : d.residual.x;
        d.residual.y = any_receiver ? max(d.residual.y, max(off.x, off.y) + column.w) : d.residual.y;
    }
    return d;
}

// Convex hull of the pixels' plane, thickened by the residuals: a projective map keeps it convex.
ss_bounds bound(ivec2 corner, tile_depth d)
{
    ss_bounds t;
    t.usable = true;
    t.lo = vec2(3e38);
    t.hi = vec2(-3e38);
    t.g_lo = 3e38;
    t.g_hi = -3e38;
    // Homogeneous map coordinates are affine in the pixel and the depth: one corner, and the steps to the others.
    const mat4 to_map = mat4(frame.to_map[0], frame.to_map[1], frame.to_map[2], frame.to_map[3]);
    const vec2 side = vec2(SS_TILE_X - 1, SS_TILE_Y - 1);
    const vec4 origin = vec4((vec2(corner) + 0.5) * frame.camera.yz - 1.0, d.first - frame.camera.x + d.residual.x, 1.0) * to_map;
    const vec4 along_x = vec4(side.x * frame.camera.y, 0.0, side.x * d.step.x, 0.0) * to_map;
    const vec4 along_y = vec4(0.0, side.y * frame.camera.z, side.y * d.step.y, 0.0) * to_map;
    const vec4 across = vec4(0.0, 0.0, d.residual.y - d.residual.x, 0.0) * to_map;
    vec3 p[8];
    vec4 h;
    for (int i = 0; i < 8; i++) {
        h = origin;
        if ((i & 1) != 0)
            h += along_x;
        if ((i & 2) != 0)
            h += along_y;
        if ((i & 4) != 0)
            h += across;
        t.usable = t.usable && ss_is_in_front(h);
        p[i] = h.xyz / h.w;
        t.lo = min(t.lo, p[i].xy);
        t.hi = max(t.hi, p[i].xy);
        t.g_lo = min(t.g_lo, p[i].z);
        t.g_hi = max(t.g_hi, p[i].z);
    }
    t.eta = ss_eta(h, vec2(0.0));
    const vec3 e = p[1] - p[0], f = p[2] - p[0];
    const float det = e.x * f.y - e.y * f.x;
    vec2 gradient = vec2(e.z * f.y - f.z * e.y, f.z * e.x - e.z * f.x) / det;
    if (!(det * det > 1e-6 * dot(e.xy, e.xy) * dot(f.xy, f.xy)))
        gradient = vec2(0.0);
    t.gradient = ss_finite_gradient(gradient);
    t.exact = d.residual.y - d.residual.x <= 8.0 * frame.camera.w;
    t.side = ss_side(h, t.gradient);
    gradient = ss_clamp_gradient(gradient, t.g_hi);
    float base = 3e38, top = -3e38;
    for (int i = 0; i < 8; i++) {
        const float rest = p[i].z - dot(gradient, p[i].xy);
        base = min(base, rest);
        top = max(top, rest);
    }
    t.plane = vec3(gradient, base);
    t.thickness = top - base;
    t.usable = t.usable && t.hi.x - t.lo.x < 1e6 && t.hi.y - t.lo.y < 1e6 && t.g_hi - t.g_lo < 1e30;
    return t;
}

void write_umbra(ivec2 corner, ivec2 last)
{
    for (int y = 0; y <= last.y; y++)
        for (int x = 0; x <= last.x; x++)
            if (ss_is_receiver(ss_load_depth(corner + ivec2(x, y))))
                ss_write_visibility(corner + ivec2(x, y), 0.0);
}

void main()
{
    if (any(greaterThanEqual(gl_GlobalInvocationID.xy, frame.tiles.xy)))
        return;
    const uint tile = gl_GlobalInvocationID.y * frame.tiles.x + gl_GlobalInvocationID.x;
    const ivec2 corner = ivec2(gl_GlobalInvocationID.xy) * ivec2(SS_TILE_X, SS_TILE_Y);
    const ivec2 last = min(corner + ivec2(SS_TILE_X, SS_TILE_Y), frame.area.zw) - 1 - corner;

    const tile_depth d = combine_columns(tile);
    const bool empty = d.residual.x > d.residual.y;
    uint nodes = 0u;
    float g_hi = ss_nearest();
    uint state = ss_classify_bounds(bound(corner, d), SS_TILE_REFINEMENTS, g_hi, nodes);
    // Normals can make single pixels face away, which only classify_pixels looks at.
    if (SS_NORMALS && state == SS_STATE_LIT)
        state = SS_STATE_PIXELS;
    if (empty)
        state = SS_STATE_LIT;
    tiles[tile] = state;
    if (state == SS_STATE_PIXELS) {
        const uint i = atomicAdd(control.pixels_args.w, 1u);
        // A group of the next pass has the pixels of one tile, or the blocks of several.
        const uint group = ((i + 1u) * SS_TILE_BLOCKS - 1u) / SS_EVALUATE_GROUP;
        atomicMax(control.pixels_args.x, min(group + 1u, SS_DISPATCH_WIDTH));
        atomicMax(control.pixels_args.y, group / SS_DISPATCH_WIDTH + 1u);
        tiles[ss_undecided_slot(i)] = tile;
        tiles[ss_undecided_slot(i) + 1u] = floatBitsToUint(g_hi);
    }
    if (state == SS_STATE_UMBRA)
        write_umbra(corner, last);
    if (SS_STATS) {
        const uint pixels = uint((last.x + 1) * (last.y + 1));
        ss_count(SS_STAT_PIXELS, pixels);
        ss_count(SS_STAT_TILES, 1u);
        ss_count(SS_STAT_NODES, nodes);
        if (state == SS_STATE_PIXELS)
            ss_count(SS_STAT_UNDECIDED, 1u);
        else
            ss_count(state == SS_STATE_UMBRA ? SS_STAT_UMBRA : SS_STAT_LIT, pixels);
    }
}
