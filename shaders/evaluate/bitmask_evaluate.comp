#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
// Bitmask Soft Shadows (Schwarz and Stamminger 2007) and area accumulation, for the active pixels of penumbra tiles: every
// micro-occluder of the kernel is back-projected onto the light. One group per tile; lane i takes the tile's i-th active
// pixel, so that idle lanes are at the end.
#include "ss_types.h"
#include "ss_specialization.glsl"
#include "ss_occluder_bindings.glsl"
#include "ss_io_bindings.glsl"
#include "ss_filter_values.glsl"
#include "ss_receiver.glsl"
#include "ss_range.glsl"
#include "ss_kernel.glsl"
#include "ss_pattern.glsl"
#include "ss_primitive.glsl"

layout(local_size_x = SS_TILE, local_size_y = SS_TILE) in;

struct back_projection
{
    vec2 uv;       // receiver
    float g;       // its fan depth, biased
    float den;     // epsilon - delta g
    mat2 matrix;   // map offset -> sample coordinates
    vec2 constant;
};

back_projection back_project_from(ss_receiver r, float g)
{
    const float half_side = 0.5 * float(SS_SIDE);
    back_projection b;
    b.uv = r.uv;
    b.g = g;
    b.den = occ.light.w - occ.light.z * g;
    b.matrix = half_side * mat2(occ.a_inverse.x, occ.a_inverse.z, occ.a_inverse.y, occ.a_inverse.w);
    b.constant = half_side - b.matrix * (occ.light.xy - occ.light.z * r.uv);
    return b;
}

vec2 back_project(back_projection b, vec2 uv, float g)
{
    return b.matrix * ((uv - b.uv) * (b.den / (g - b.g))) + b.constant;
}

vec2 sample_place(ivec2 at, uint level)
{
    if (SS_SAMPLED && level > 0u)
        return vec2(min((at << int(level)) + (1 << int(level - 1u)), ivec2(occ.size.xy) - 1)) + 0.5;
    return (vec2(at) + 0.5) * float(1u << level);
}

float sample_depth(uint layer, ivec2 at, uint level)
{
    if (level == 0u)
        return ss_load_fan_depth(layer, at);
    if (SS_SAMPLED)
        return ss_load_fan_depth(layer, (at << int(level)) + (1 << int(level - 1u)));
    return ss_load_pyramid(layer, level, at).y;
}

bool occludes(float g, vec2 at, back_projection b, ss_receiver r, float band)
{
    // Over the plane through the biased receiver: blocks of nearest depths lift the surface and the receiver alike.
    const float height = g - (b.g - r.eta + dot(r.gradient, at - r.uv));
    return g > b.g && occ.light.w - occ.light.z * g > 0.0 && (band < 0.0 || ss_is_off_plane(r, height, band));
}

struct vertex
{
    vec2 at; // sample coordinates
    bool occludes;
};

vertex load_vertex(uint layer, ivec2 at, uint level, back_projection b, ss_receiver r, float band)
{
    const float g = sample_depth(layer, at, level);
    const vec2 place = sample_place(at, level);
    return vertex(back_project(b, place, g), occludes(g, place, b, r, band));
}

void add_quads(uint layer, ss_samples s, back_projection b, ss_receiver r, float band)
{
    const ivec2 up = ivec2(0, 1);
    for (int y = s.lo.y; y < s.hi.y; y++) {
        vertex low = load_vertex(layer, ivec2(s.lo.x, y), s.level, b, r, band);
        vertex high = load_vertex(layer, ivec2(s.lo.x, y) + up, s.level, b, r, band);
        for (int x = s.lo.x + 1; x <= s.hi.x; x++) {
            const vertex next_low = load_vertex(layer, ivec2(x, y), s.level, b, r, band);
            const vertex next_high = load_vertex(layer, ivec2(x, y) + up, s.level, b, r, band);
            if (low.occludes && high.occludes && next_low.occludes && next_high.occludes)
                ss_add_quad(low.at, next_low.at, next_high.at, high.at);
            low = next_low;
            high = next_high;
        }
    }
}

void add_patches(uint layer, ss_samples s, back_projection b, ss_receiver r, float band)
{
    const float half_size = 0.5 * float(1u << s.level);
    for (int y = s.lo.y; y <= s.hi.y; y++) {
        for (int x = s.lo.x; x <= s.hi.x; x++) {
            const ivec2 at = ivec2(x, y);
            const float g = sample_depth(layer, at, s.level);
            const vec2 place = sample_place(at, s.level);
            if (!occludes(g, place, b, r, band))
                continue;
            vec2 lo = back_project(b, place - half_size, g);
            const vec2 hi = back_project(b, place + half_size, g);
            if (SS_PRIMITIVE == SS_PRIMITIVE_PATCH_EXTENDED) {
                const ivec2 left = max(at - ivec2(1, 0), ivec2(0)), below = max(at - ivec2(0, 1), ivec2(0));
                const float g_left = sample_depth(layer, left, s.level), g_below = sample_depth(layer, below, s.level);
                const vec2 at_left = sample_place(left, s.level), at_below = sample_place(below, s.level);
                if (x > 0 && occludes(g_left, at_left, b, r, band))
                    lo.x = min(lo.x, back_project(b, at_left + half_size, g_left).x);
                if (y > 0 && occludes(g_below, at_below, b, r, band))
                    lo.y = min(lo.y, back_project(b, at_below + half_size, g_below).y);
            }
            ss_add_rectangle(lo, hi);
        }
    }
}

int nth_bit(uvec2 mask, uint n)
{
    const uint low = uint(bitCount(mask.x));
    uint word = n < low ? mask.x : mask.y;
    for (uint i = n < low ? n : n - low; i > 0u; i--)
        word &= word - 1u;
    return findLSB(word) + (n < low ? 0 : 32);
}

void main()
{
    const uint index = gl_WorkGroupID.y * SS_DISPATCH_WIDTH + gl_WorkGroupID.x;
    if (index >= control.evaluate_args.w)
        return;
    const uint slot = ss_penumbra_slot(index), tile = tiles[slot];
    const uvec2 active_mask = uvec2(tiles[slot + 1u], tiles[slot + 2u]);
    const uint lane = gl_LocalInvocationIndex;
    if (lane >= uint(bitCount(active_mask.x) + bitCount(active_mask.y)))
        return;
    const ivec2 pixel = ss_tile_pixel(tile, uint(nth_bit(active_mask, lane)));

    const ss_receiver r = ss_load_receiver(pixel);
    const ss_kernel k = ss_find_kernel(r);
    float band;
    const back_projection b = back_project_from(r, ss_biased(r, k.samples.level, band));
    const bool disc = (occ.size.w & SS_FLAG_DISC) != 0u;
    float mask_occlusion = 0.0, area_occlusion = 0.0;
    ss_mask_clear();
    ss_area = 0.0;
    for (uint layer = 0u; layer < occ.size.z; layer++) {
        if (SS_IS_PATCH)
            add_patches(layer, k.samples, b, r, band);
        else
            add_quads(layer, k.samples, b, r, band);
        if (SS_MERGE_MAXIMUM || layer + 1u == occ.size.z) {
            if (SS_PATTERN_SIDE != 0)
                mask_occlusion = max(mask_occlusion, ss_mask_occlusion(disc));
            area_occlusion = max(area_occlusion, ss_area * ss_area_scale());
            ss_mask_clear();
            ss_area = 0.0;
        }
    }
    const float occlusion = SS_PATTERN_SIDE != 0 ? mask_occlusion : min(area_occlusion, 1.0);
    ss_write_visibility(pixel, 1.0 - occlusion);
    if (SS_FILTER)
        ss_store_filter_values(pixel, area_occlusion, occlusion);
    if (SS_STATS) {
        const ivec2 n = k.samples.hi - k.samples.lo + (SS_IS_PATCH ? 1 : 0);
        ss_count(SS_STAT_PRIMITIVES, uint(max(n.x, 0) * max(n.y, 0)) * occ.size.z);
        if (k.samples.clamped)
            ss_count(SS_STAT_CLAMPED, 1u);
    }
}
