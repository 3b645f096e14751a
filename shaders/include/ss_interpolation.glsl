// Whether a pixel between those that were evaluated may take their mean: docs/numerics.md, section 11.
// Needs the kernel and the values of other passes.
#ifndef SS_INTERPOLATION_GLSL
#define SS_INTERPOLATION_GLSL

// Neighbours that differ by more have an edge between them.
const float SS_MOST_DIFFERENCE = 0.25;
// Share of its own slope by which a surface may bend from one neighbour to the opposite one.
const float SS_MOST_BEND = 0.5;

float ss_near_depth(ivec2 pixel)
{
    const ivec2 p = clamp(pixel, ivec2(0), frame.area.zw - 1);
    return texelFetch(camera_depth, p + frame.area.xy, 0).x;
}

// Of a pixel that was classified as a whole tile, by itself, or evaluated.
float ss_near_visible(ivec2 pixel)
{
    const ivec2 p = clamp(pixel, ivec2(0), frame.area.zw - 1);
    const uint state = tiles[uint(p.y / SS_TILE_Y) * frame.tiles.x + uint(p.x / SS_TILE_X)];
    const float stored = filter_values[ss_filter_index(p)];
    return state == SS_STATE_PIXELS ? stored : state == SS_STATE_UMBRA ? SS_ALL_DARK : SS_ALL_LIT;
}

// Whether the kernels of neighbours that are `steps` away on either side overlap: what lies in the kernel of a pixel at `here`,
// `reach` wide, is in one of theirs then. Where occluders are close and kernels small, a shadow may be narrower than that.
bool ss_kernels_overlap(ivec2 pixel, vec2 here, ivec2 steps, float depth, vec2 reach)
{
    const vec4 there = ss_to_map(vec2(pixel + steps) + 0.5, depth);
    return all(lessThanEqual(abs(there.xy / there.w - here), reach));
}

// Depth is affine on a plane: opposite neighbours and the pixel between them.
bool ss_is_one_surface(float before, float here, float after)
{
    const float bend = abs(before - 2.0 * here + after), slope = max(abs(before - here), abs(after - here));
    return bend <= SS_MOST_BEND * slope + 4.0 * frame.camera.w;
}

// Where a pixel's neighbours are: at plus and minus the first and the second, two of them twice along an axis, or the four
// corners.
ivec4 ss_neighbour_steps(ivec2 pixel)
{
    const ivec2 a = pixel & 1;
    return ivec4(a, a.x, -a.y);
}

// `depths` and `stored` visibility are the neighbours', in the order -a, a, -b, b; `here` is the pixel's own depth. `mean` is the
// neighbours' in either case. Occluders up to g_hi may be in the pixel's kernel.
bool ss_interpolates(ivec2 pixel, float g_hi, float here, vec4 depths, vec4 stored, out float mean)
{
    const ivec4 steps = ss_neighbour_steps(pixel);
    const ivec2 a = steps.xy, b = steps.zw;
    const bool smooth_surface =
        ss_is_one_surface(depths.x, here, depths.y) && ss_is_one_surface(depths.z, here, depths.w);
    const vec4 seen = clamp(stored, vec4(0.0), vec4(1.0));
    const float most = max(max(seen.x, seen.y), max(seen.z, seen.w)), least = min(min(seen.x, seen.y), min(seen.z, seen.w));
    const vec4 h = ss_to_map(vec2(pixel) + 0.5, here);
    const vec3 uvg = h.xyz / h.w;
    const float den = occ.light.w - occ.light.z * uvg.z;
    const bool plain = all(equal(stored, vec4(SS_ALL_LIT))) || all(equal(stored, vec4(SS_ALL_DARK)));
    // Beside penumbrae the nearest occluder in this pixel's own kernel: no farther than that its neighbours' may be.
    const ss_samples s = ss_kernel_samples(ss_kernel_box(uvg.xy, uvg.xy, uvg.z, den, g_hi));
    const float nearest = SS_HIERARCHY && !plain ? min(g_hi, ss_range(s.texel_lo, s.texel_hi).y) : g_hi;
    const vec2 reach = ss_light_reach() * ((ss_clip_to_light(nearest) - uvg.z) / den);
    const bool overlap = ss_kernels_overlap(pixel, uvg.xy, a, depths.y, reach) &&
                         ss_kernels_overlap(pixel, uvg.xy, b, depths.w, reach);
    // Between kernels in which nothing occludes, or everything, there can be nothing else. But beside ones whose occluders just
    // miss the light, a narrow shadow may lie between.
    const bool tells = plain || (least < 1.0 && most > 0.0);
    const bool inside = all(greaterThan(pixel, ivec2(0))) && all(lessThan(pixel + 1, frame.area.zw));
    mean = 0.25 * (seen.x + seen.y + seen.z + seen.w);
    return smooth_surface && inside && most - least <= SS_MOST_DIFFERENCE && tells && overlap;
}

#endif
