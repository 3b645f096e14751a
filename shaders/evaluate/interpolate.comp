#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
// Pixels between those that were evaluated: the mean of their neighbours where these lie on the same surface and differ little,
// otherwise on to the second round of evaluation. Penumbrae are smooth, and the smoother the wider they are (the adaptive
// precision of Guennebaud et al. 2007); no noise, and nothing that moves with the camera but the lattice.
#include "ss_types.h"
#include "ss_specialization.glsl"
#include "ss_occluder_bindings.glsl"
#include "ss_io_bindings.glsl"
#include "ss_filter_values.glsl"
#include "ss_lists.glsl"
#include "ss_receiver.glsl"
#include "ss_range.glsl"
#include "ss_kernel.glsl"

layout(local_size_x = SS_EVALUATE_GROUP) in;

// Neighbours that differ by more have an edge between them.
const float MOST_DIFFERENCE = 0.25;
// Share of its own slope by which a surface may bend from one neighbour to the opposite one.
const float MOST_BEND = 0.5;

float depth_at(ivec2 pixel)
{
    const ivec2 p = clamp(pixel, ivec2(0), frame.area.zw - 1);
    return texelFetch(camera_depth, p + frame.area.xy, 0).x;
}

// Of a pixel that was classified as a whole tile, by itself, or evaluated.
float visible_at(ivec2 pixel)
{
    const ivec2 p = clamp(pixel, ivec2(0), frame.area.zw - 1);
    const uint state = tiles[uint(p.y / SS_TILE_Y) * frame.tiles.x + uint(p.x / SS_TILE_X)];
    const float stored = filter_values[ss_filter_index(p)];
    return state == SS_STATE_PIXELS ? stored : state == SS_STATE_UMBRA ? SS_ALL_DARK : SS_ALL_LIT;
}

// Whether the kernels of neighbours that are `steps` away on either side overlap: what lies in this pixel's kernel is in one of
// theirs then. Where occluders are close and kernels small, a shadow may be narrower than that.
bool kernels_overlap(ivec2 pixel, float depth, ivec2 steps, float g_hi)
{
    const vec4 h = ss_to_map(vec2(pixel) + 0.5, depth);
    const vec4 there = ss_to_map(vec2(pixel + steps) + 0.5, depth_at(pixel + steps));
    const vec2 uv = h.xy / h.w, away = abs(there.xy / there.w - uv);
    const float g = h.z / h.w, k = (ss_clip_to_light(g_hi) - g) / (occ.light.w - occ.light.z * g);
    return all(lessThanEqual(away, ss_light_reach() * k));
}

// Depth is affine on a plane: opposite neighbours and the pixel between them.
bool is_one_surface(float before, float here, float after)
{
    const float bend = abs(before - 2.0 * here + after), slope = max(abs(before - here), abs(after - here));
    return bend <= MOST_BEND * slope + 4.0 * frame.camera.w;
}

void main()
{
    const uint index = (gl_WorkGroupID.y * SS_DISPATCH_WIDTH + gl_WorkGroupID.x) * SS_EVALUATE_GROUP + gl_LocalInvocationIndex;
    if (index >= control.interpolate_args.w)
        return;
    const uint id = tiles[ss_interpolated_slot(index)];
    const uint g_hi = tiles[ss_interpolated_slot(index) + 1u];
    const ivec2 pixel = ss_tile_pixel(id / SS_TILE_PIXELS, id % SS_TILE_PIXELS);

    // Two neighbours, twice, along an axis, or the four corners.
    const ivec2 a = pixel & 1, b = ivec2(a.x, -a.y);
    const float here = depth_at(pixel);
    const bool smooth_surface = is_one_surface(depth_at(pixel - a), here, depth_at(pixel + a)) &&
                                is_one_surface(depth_at(pixel - b), here, depth_at(pixel + b));
    const vec4 stored = vec4(visible_at(pixel - a), visible_at(pixel + a), visible_at(pixel - b), visible_at(pixel + b));
    const vec4 seen = clamp(stored, vec4(0.0), vec4(1.0));
    const float most = max(max(seen.x, seen.y), max(seen.z, seen.w)), least = min(min(seen.x, seen.y), min(seen.z, seen.w));
    const bool overlap = kernels_overlap(pixel, here, a, uintBitsToFloat(g_hi)) && kernels_overlap(pixel, here, b, uintBitsToFloat(g_hi));
    // Between kernels in which nothing occludes, or everything, there can be nothing else. But beside ones whose occluders just
    // miss the light, a narrow shadow may lie between.
    const bool tells = (least < 1.0 && most > 0.0) || all(equal(stored, vec4(SS_ALL_LIT))) || all(equal(stored, vec4(SS_ALL_DARK)));
    const bool inside = all(greaterThan(pixel, ivec2(0))) && all(lessThan(pixel + 1, frame.area.zw));
    if (smooth_surface && inside && most - least <= MOST_DIFFERENCE && tells && overlap) {
        ss_write_visibility(pixel, 0.25 * (seen.x + seen.y + seen.z + seen.w));
        if (SS_STATS)
            ss_count(SS_STAT_INTERPOLATED, 1u);
    } else {
        ss_append_active(1u, id, uintBitsToFloat(g_hi));
    }
}
