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

bool is_in_front_of_light(float g)
{
    return occ.light.w - occ.light.z * g > 0.0;
}

void add_quads(uint layer, ss_samples s, back_projection b)
{
    for (int y = s.lo.y; y < s.hi.y; y++) {
        const ivec2 first = ivec2(s.lo.x, y);
        float low = sample_depth(layer, first, s.level), high = sample_depth(layer, first + ivec2(0, 1), s.level);
        vec2 low_at = back_project(b, sample_place(first, s.level), low);
        vec2 high_at = back_project(b, sample_place(first + ivec2(0, 1), s.level), high);
        bool left = low > b.g && high > b.g && is_in_front_of_light(max(low, high));
        for (int x = s.lo.x + 1; x <= s.hi.x; x++) {
            low = sample_depth(layer, ivec2(x, y), s.level);
            high = sample_depth(layer, ivec2(x, y + 1), s.level);
            const vec2 p = back_project(b, sample_place(ivec2(x, y), s.level), low);
            const vec2 q = back_project(b, sample_place(ivec2(x, y + 1), s.level), high);
            const bool right = low > b.g && high > b.g && is_in_front_of_light(max(low, high));
            if (left && right)
                ss_add_quad(low_at, p, q, high_at);
            left = right;
            low_at = p;
            high_at = q;
        }
    }
}

bool patch_occludes(float g, vec2 at, back_projection b, ss_receiver r, float band)
{
    return g > b.g && is_in_front_of_light(g) && !(abs(g - (r.g + dot(r.gradient, at - r.uv))) <= band);
}

void add_patches(uint layer, ss_samples s, back_projection b, ss_receiver r, float band)
{
    const float half_size = 0.5 * float(1u << s.level);
    for (int y = s.lo.y; y <= s.hi.y; y++) {
        for (int x = s.lo.x; x <= s.hi.x; x++) {
            const ivec2 at = ivec2(x, y);
            const float g = sample_depth(layer, at, s.level);
            const vec2 place = sample_place(at, s.level);
            if (!patch_occludes(g, place, b, r, band))
                continue;
            vec2 lo = back_project(b, place - half_size, g);
            const vec2 hi = back_project(b, place + half_size, g);
            if (SS_PRIMITIVE == SS_PRIMITIVE_PATCH_EXTENDED) {
                const ivec2 left = max(at - ivec2(1, 0), ivec2(0)), below = max(at - ivec2(0, 1), ivec2(0));
                const float g_left = sample_depth(layer, left, s.level), g_below = sample_depth(layer, below, s.level);
                const vec2 at_left = sample_place(left, s.level), at_below = sample_place(below, s.level);
                if (x > 0 && patch_occludes(g_left, at_left, b, r, band))
                    lo.x = min(lo.x, back_project(b, at_left + half_size, g_left).x);
                if (y > 0 && patch_occludes(g_below, at_below, b, r, band))
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
            add_quads(layer, k.samples, b);
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
