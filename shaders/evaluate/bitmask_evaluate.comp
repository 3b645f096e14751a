#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
// Bitmask Soft Shadows (Schwarz and Stamminger 2007) and area accumulation, for the active pixels: every
// micro-occluder of the kernel is back-projected onto the light. One lane per pixel of the active list.
#include "ss_types.h"
#include "ss_specialization.glsl"
#include "ss_occluder_bindings.glsl"
#include "ss_io_bindings.glsl"
#include "ss_filter_values.glsl"
#include "ss_receiver.glsl"
#include "ss_range.glsl"
#include "ss_kernel.glsl"
#include "ss_sample.glsl"
#include "ss_pattern.glsl"
#include "ss_primitive.glsl"

layout(local_size_x = SS_EVALUATE_GROUP) in;
layout(push_constant) uniform ss_push
{
    ss_evaluate_push push;
};

struct vertex
{
    vec2 at; // sample coordinates
    bool occludes;
};

vertex load_vertex(ss_grid grid, ivec2 at, ss_back_projection b, ss_receiver r, float band)
{
    const float g = ss_sample_depth(grid, at);
    const vec2 place = ss_sample_place(at, grid.level);
    return vertex(ss_back_project(b, place, g), ss_occludes(g, place, b, r, band));
}

// Whether any sample of the kernel occludes.
bool any_occludes;

void add_quads(ss_grid grid, ss_samples s, ss_back_projection b, ss_receiver r, float band)
{
    const ivec2 up = ivec2(0, 1);
    for (int y = s.lo.y; y < s.hi.y; y++) {
        vertex low = load_vertex(grid, ivec2(s.lo.x, y), b, r, band);
        vertex high = load_vertex(grid, ivec2(s.lo.x, y) + up, b, r, band);
        for (int x = s.lo.x + 1; x <= s.hi.x; x++) {
            const vertex next_low = load_vertex(grid, ivec2(x, y), b, r, band);
            const vertex next_high = load_vertex(grid, ivec2(x, y) + up, b, r, band);
            any_occludes = any_occludes || next_low.occludes || next_high.occludes;
            if (low.occludes && high.occludes && next_low.occludes && next_high.occludes)
                ss_add_quad(low.at, next_low.at, next_high.at, high.at);
            low = next_low;
            high = next_high;
        }
    }
}

struct micropatch
{
    vec2 lo, hi; // sample coordinates; hi >= lo, for the light's axes run along the map's
    bool occludes;
};

micropatch load_patch(ss_grid grid, ivec2 at, ss_back_projection b, ss_receiver r, float band)
{
    const float g = ss_sample_depth(grid, at);
    const vec2 place = ss_sample_place(at, grid.level);
    const vec2 scale = vec2(b.matrix[0].x, b.matrix[1].y) * (b.den / (g - b.g));
    const vec2 middle = scale * (place - b.uv) + b.constant, half_size = scale * (0.5 * float(1u << grid.level));
    return micropatch(middle - half_size, middle + half_size, ss_occludes(g, place, b, r, band));
}

void add_patches(ss_grid grid, ss_samples s, ss_back_projection b, ss_receiver r, float band)
{
    const bool extended = SS_PRIMITIVE == SS_PRIMITIVE_PATCH_EXTENDED;
    for (int y = s.lo.y; y <= s.hi.y; y++) {
        // Extension to the left and bottom neighbours closes the gaps between patches of different depth.
        micropatch left;
        left.occludes = false;
        if (extended && s.lo.x > 0)
            left = load_patch(grid, ivec2(s.lo.x - 1, y), b, r, band);
        for (int x = s.lo.x; x <= s.hi.x; x++) {
            const micropatch here = load_patch(grid, ivec2(x, y), b, r, band);
            vec2 lo = here.lo;
            if (extended) {
                const micropatch below = load_patch(grid, ivec2(x, max(y - 1, 0)), b, r, band);
                lo.x = left.occludes ? min(lo.x, left.hi.x) : lo.x;
                lo.y = below.occludes && y > 0 ? min(lo.y, below.hi.y) : lo.y;
            }
            any_occludes = any_occludes || here.occludes;
            if (here.occludes)
                ss_add_rectangle(lo, here.hi);
            left = here;
        }
    }
}

void main()
{
    const uint index = (gl_WorkGroupID.y * SS_DISPATCH_WIDTH + gl_WorkGroupID.x) * SS_EVALUATE_GROUP + gl_LocalInvocationIndex;
    if (index >= control.evaluate_args[SS_LISTS * push.round + SS_LIST_PIXELS].w)
        return;
    const uint id = tiles[ss_pixel_slot(index)];
    const float g_hi = uintBitsToFloat(tiles[ss_pixel_slot(index) + 1u]);
    const ivec2 pixel = ss_tile_pixel(id / SS_TILE_PIXELS, id % SS_TILE_PIXELS);

    const ss_receiver r = ss_load_receiver(pixel);
    const ss_samples samples = ss_evaluated_samples(r, g_hi);
    const float half_side = 0.5 * float(SS_SIDE);
    float band;
    const ss_back_projection b = ss_back_project_from(r, ss_biased(r, samples.level, band), half_side, half_side);
    const bool disc = (ss_flags & SS_FLAG_DISC) != 0u;
    float mask_occlusion = 0.0, area_occlusion = 0.0;
    ss_mask_clear();
    ss_area = 0.0;
    any_occludes = false;
    for (uint layer = 0u; layer < ss_layers(); layer++) {
        const ss_grid grid = ss_load_grid(layer, samples.level);
        if (SS_IS_PATCH)
            add_patches(grid, samples, b, r, band);
        else
            add_quads(grid, samples, b, r, band);
        if (SS_MERGE_MAXIMUM || layer + 1u == ss_layers()) {
            if (SS_PATTERN_SIDE != 0)
                mask_occlusion = max(mask_occlusion, ss_mask_occlusion(disc));
            area_occlusion = max(area_occlusion, ss_area * ss_area_scale());
            ss_mask_clear();
            ss_area = 0.0;
        }
    }
    const float occlusion = min((SS_PATTERN_SIDE != 0 ? mask_occlusion : area_occlusion) + r.horizon, 1.0);
    ss_write_visibility(pixel, 1.0 - occlusion);
    if (SS_SPARSE)
        ss_store_visible(pixel, any_occludes || r.horizon > 0.0 ? 1.0 - occlusion : SS_ALL_LIT);
    if (SS_FILTER)
        ss_store_filter_values(pixel, area_occlusion + r.horizon, occlusion);
    if (SS_STATS) {
        const ivec2 n = samples.hi - samples.lo + (SS_IS_PATCH ? 1 : 0);
        ss_count(SS_STAT_PRIMITIVES, uint(max(n.x, 0) * max(n.y, 0)) * ss_layers());
        ss_count(SS_STAT_CLAMPED, samples.clamped ? 1u : 0u);
        ss_count(SS_STAT_REFINED, samples.refined ? 1u : 0u);
    }
}
