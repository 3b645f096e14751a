#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
// One lane per tile of 8 x 8 pixels: reads the depth once, bounds the tile's receivers by a plane and a thickness, and asks
// the hierarchy whether all of them are lit or all in umbra. Such tiles are written here and never seen again; the others
// go to classify_pixels.
#include "ss_types.h"
#include "ss_specialization.glsl"
#include "ss_occluder_bindings.glsl"
#include "ss_io_bindings.glsl"
#include "ss_receiver.glsl"
#include "ss_range.glsl"
#include "ss_kernel.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

const int MAX_PLANE_SIDE = 32; // texels

// The receivers of a tile, in map space.
struct tile_bounds
{
    bool usable;
    vec2 lo, hi;        // box of (u, v)
    float g_lo, g_hi;
    vec3 plane;         // g >= plane.x u + plane.y v + plane.z for every receiver
    float thickness;    // how far receivers rise above that plane
    float eta;
};

// Convex hull of the pixels' plane, thickened by the residuals: a projective map keeps it convex.
tile_bounds bound(ivec2 corner, ivec2 last, vec3 depth_plane, vec2 residual)
{
    tile_bounds t;
    t.usable = true;
    t.lo = vec2(3e38);
    t.hi = vec2(-3e38);
    t.g_lo = 3e38;
    t.g_hi = -3e38;
    t.eta = 0.0;
    vec3 p[8];
    for (int i = 0; i < 8; i++) {
        const ivec2 at = ivec2((i & 1) == 0 ? 0 : last.x, (i & 2) == 0 ? 0 : last.y);
        const float depth = depth_plane.z + dot(depth_plane.xy, vec2(at)) + ((i & 4) == 0 ? residual.x : residual.y);
        const vec4 ndc = vec4((vec2(corner + at) + 0.5) * frame.camera.yz - 1.0, depth, 1.0);
        const vec4 h = vec4(dot(frame.to_map[0], ndc), dot(frame.to_map[1], ndc), dot(frame.to_map[2], ndc),
                            dot(frame.to_map[3], ndc));
        t.usable = t.usable && ss_is_in_front(h);
        p[i] = h.xyz / h.w;
        t.lo = min(t.lo, p[i].xy);
        t.hi = max(t.hi, p[i].xy);
        t.g_lo = min(t.g_lo, p[i].z);
        t.g_hi = max(t.g_hi, p[i].z);
        t.eta = max(t.eta, ss_eta(h, vec2(0.0)));
    }
    const vec3 e = p[1] - p[0], f = p[2] - p[0];
    const float det = e.x * f.y - e.y * f.x;
    vec2 gradient = vec2(e.z * f.y - f.z * e.y, f.z * e.x - e.z * f.x) / det;
    if (!(det * det > 1e-6 * dot(e.xy, e.xy) * dot(f.xy, f.xy)))
        gradient = vec2(0.0);
    gradient = ss_clamp_gradient(gradient, t.g_hi);
    float base = 3e38, top = -3e38;
    for (int i = 0; i < 8; i++) {
        base = min(base, p[i].z - dot(gradient, p[i].xy));
        top = max(top, p[i].z - dot(gradient, p[i].xy));
    }
    t.plane = vec3(gradient, base);
    t.thickness = top - base;
    t.usable = t.usable && t.hi.x - t.lo.x < 1e6 && t.hi.y - t.lo.y < 1e6 && t.g_hi - t.g_lo < 1e30;
    return t;
}

// Whether no texel of the box rises above the receivers' plane by more than the plane itself does within a cell of 4 x 4
// texels, a footprint the pixels' own test allows as well. Only for tiles that are one plane, and boxes of a few cells.
bool lies_under_plane(tile_bounds t, uint layer, ivec2 lo, ivec2 hi)
{
    const int side = max(hi.x - lo.x, hi.y - lo.y) + 1;
    const uint level = min(side <= 8 ? 0u : side <= 16 ? 1u : 2u, occ.levels.x);
    const ivec2 a = lo >> int(level), b = hi >> int(level);
    const float cell = float(1u << level), footprint = 0.5 * cell * (abs(t.plane.x) + abs(t.plane.y)) + t.eta;
    bool under = side <= MAX_PLANE_SIDE && t.thickness <= abs(t.plane.x) + abs(t.plane.y) + 4.0 * t.eta;
    if (!under)
        return false;
    for (int y = a.y; y <= b.y; y++) {
        for (int x = a.x; x <= b.x; x++) {
            const vec2 at = (vec2(x, y) + 0.5) * cell;
            const float g = level == 0u ? ss_load_fan_depth(layer, ivec2(x, y)) : ss_load_pyramid(layer, level, ivec2(x, y)).y;
            under = under && g <= dot(t.plane.xy, at) + t.plane.z + footprint;
        }
    }
    return under;
}

uint classify(tile_bounds t, inout uint nodes)
{
    const vec2 limit = vec2(occ.size.xy);
    if (!t.usable)
        return SS_STATE_PIXELS;
    if (any(lessThan(t.hi, vec2(0.0))) || any(greaterThan(t.lo, limit)))
        return SS_STATE_LIT;
    const float den = occ.light.w - occ.light.z * t.g_hi;
    if (!(den > 0.0) || !SS_HIERARCHY)
        return SS_STATE_PIXELS;
    const vec2 slope = abs(t.plane.xy);
    const bool biased = (frame.tiles.w & SS_FLAG_OVERRIDE_BIAS) != 0u;
    float g_hi = -3e38;
    for (uint layer = 0u; layer < occ.size.z; layer++)
        g_hi = max(g_hi, ss_root(layer).y);
    ss_samples s;
    for (int i = 0; i < SS_MAX_REFINEMENTS; i++) {
        s = ss_kernel_samples(ss_kernel_box(t.lo, t.hi, t.g_lo, den, g_hi));
        vec2 range = vec2(-3e38);
        for (uint layer = 0u; layer < occ.size.z; layer++)
            range = max(range, ss_range(layer, s.texel_lo, s.texel_hi));
        nodes += 4u * occ.size.z;
        if (!(range.y > t.g_lo + (biased ? 0.0 : t.eta)))
            return SS_STATE_LIT;
        const float rise = dot(slope, vec2(s.texel_hi - s.texel_lo + 1)) + t.eta;
        if (s.covered && all(greaterThanEqual(t.lo, vec2(0.0))) && all(lessThanEqual(t.hi, limit)) &&
            range.x > t.g_hi + rise && occ.light.z * range.y < occ.light.w && !biased)
            return SS_STATE_UMBRA;
        g_hi = min(g_hi, range.y);
    }
    if (biased)
        return SS_STATE_PIXELS;
    s = ss_kernel_samples(ss_kernel_box(t.lo, t.hi, t.g_lo, den, g_hi));
    bool under = true;
    for (uint layer = 0u; layer < occ.size.z; layer++)
        under = under && lies_under_plane(t, layer, s.texel_lo, s.texel_hi);
    return under ? SS_STATE_LIT : SS_STATE_PIXELS;
}

void main()
{
    if (any(greaterThanEqual(gl_GlobalInvocationID.xy, frame.tiles.xy)))
        return;
    const uint tile = gl_GlobalInvocationID.y * frame.tiles.x + gl_GlobalInvocationID.x;
    const ivec2 corner = ivec2(gl_GlobalInvocationID.xy) * SS_TILE;
    const ivec2 last = min(corner + SS_TILE, frame.area.zw) - 1 - corner;

    // Device depth is affine in the pixel on any plane, so the residuals measure how far the tile is from being one.
    const float d00 = ss_load_depth(corner);
    vec3 depth_plane = vec3(last.x > 0 ? (ss_load_depth(corner + ivec2(last.x, 0)) - d00) / float(last.x) : 0.0,
                            last.y > 0 ? (ss_load_depth(corner + ivec2(0, last.y)) - d00) / float(last.y) : 0.0, d00);
    depth_plane = vec3(abs(depth_plane.x) < 1.0 ? depth_plane.x : 0.0, abs(depth_plane.y) < 1.0 ? depth_plane.y : 0.0,
                       abs(d00) <= 1.0 ? d00 : 0.0);
    vec2 residual = vec2(3e38, -3e38);
    uvec2 receivers = uvec2(0u);
    const bool reversed = frame.quality.w != 0u;
    for (int y = 0; y <= last.y; y++) {
        for (int x = 0; x <= last.x; x++) {
            const ivec2 at = ivec2(x, y);
            const float depth = texelFetch(camera_depth, frame.area.xy + corner + at, 0).x;
            // Lit until a later pass says otherwise: most tiles are never seen again.
            ss_write_visibility(corner + at, 1.0);
            const bool is_receiver = reversed ? depth > 0.0 : depth < 1.0;
            const float r = clamp(depth, 0.0, 1.0) - (depth_plane.z + dot(depth_plane.xy, vec2(at)));
            residual = is_receiver ? vec2(min(residual.x, r), max(residual.y, r)) : residual;
        }
    }

    uint nodes = 0u;
    uint state = SS_STATE_LIT;
    if (residual.x <= residual.y)
        state = classify(bound(corner, last, depth_plane, residual), nodes);
    // Normals can make single pixels face away, which only classify_pixels looks at.
    if (SS_NORMALS && state == SS_STATE_LIT && residual.x <= residual.y)
        state = SS_STATE_PIXELS;
    tiles[tile] = state;
    if (state == SS_STATE_PIXELS) {
        const uint i = atomicAdd(control.pixels_args.w, 1u);
        atomicMax(control.pixels_args.x, min(i + 1u, SS_DISPATCH_WIDTH));
        atomicMax(control.pixels_args.y, i / SS_DISPATCH_WIDTH + 1u);
        tiles[ss_undecided_slot(i)] = tile;
    } else if (state == SS_STATE_UMBRA) {
        const uvec2 dark = state == SS_STATE_UMBRA ? receivers : uvec2(0u);
        for (int y = 0; y <= last.y; y++)
            for (int x = 0; x <= last.x; x++)
                ss_write_visibility(corner + ivec2(x, y), 1.0 - float((dark[y >> 2] >> ((y & 3) * SS_TILE + x)) & 1u));
    }
    if (SS_STATS) {
        const uint pixels = uint((last.x + 1) * (last.y + 1)), dark = uint(bitCount(receivers.x) + bitCount(receivers.y));
        ss_count(SS_STAT_PIXELS, pixels);
        ss_count(SS_STAT_TILES, 1u);
        ss_count(SS_STAT_NODES, nodes);
        if (state == SS_STATE_LIT)
            ss_count(SS_STAT_LIT, pixels);
        if (state == SS_STATE_UMBRA) {
            ss_count(SS_STAT_UMBRA, dark);
            ss_count(SS_STAT_LIT, pixels - dark);
        }
        if (state == SS_STATE_PIXELS)
            ss_count(SS_STAT_UNDECIDED, 1u);
    }
}
