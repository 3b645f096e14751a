#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
// One pass of the visibility buffer filter (Schwarz and Stamminger 2007, section 3.1): area occlusion, which varies smoothly
// though it is often wrong, places each bitmask value between its neighbours. Undecided tiles only.
#include "ss_types.h"
#include "ss_specialization.glsl"
#include "ss_io_bindings.glsl"
#include "ss_filter_values.glsl"

layout(local_size_x = SS_TILE_X, local_size_y = SS_TILE_Y) in;

layout(push_constant) uniform ss_push
{
    ss_filter_push push;
};

// (area, bitmask) occlusion; false if there is no receiver.
bool load_values(ivec2 pixel, out vec2 values)
{
    values = vec2(0.0);
    if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, frame.area.zw)))
        return false;
    const float depth = texelFetch(camera_depth, frame.area.xy + pixel, 0).x;
    if (!((ss_flags & SS_FLAG_REVERSED) != 0u ? depth > 0.0 : depth < 1.0))
        return false;
    const uint state = tiles[uint(pixel.y / SS_TILE_Y) * frame.tiles.x + uint(pixel.x / SS_TILE_X)];
    const uint i = ss_filter_index(pixel);
    if (state == SS_STATE_PIXELS)
        values = vec2(filter_values[i], filter_values[(1u + push.source) * ss_filter_plane() + i]);
    else
        values = vec2(state == SS_STATE_UMBRA ? 1.0 : 0.0);
    return true;
}

// The value one axis gives; false if it gives none.
bool filter_axis(ivec2 pixel, ivec2 axis, vec2 here, out float value)
{
    vec2 before, after;
    value = here.y;
    if (!load_values(pixel - axis, before) || !load_values(pixel + axis, after))
        return false;
    const vec2 d = after - before;
    const float position = here.x - before.x;
    // The area value lies strictly between its neighbours' or on one of them, and both values change the same way.
    if (!(d.x * d.y > 0.0) || !(position * d.x >= 0.0) || !(abs(position) <= abs(d.x)))
        return false;
    value = position / d.x * d.y + before.y;
    return true;
}

void main()
{
    const uint index = gl_WorkGroupID.y * SS_DISPATCH_WIDTH + gl_WorkGroupID.x;
    if (index >= control.pixels_args.w)
        return;
    const ivec2 pixel = ss_tile_pixel(tiles[ss_undecided_slot(index)], gl_LocalInvocationIndex);
    vec2 here;
    if (any(greaterThanEqual(pixel, frame.area.zw)) || !load_values(pixel, here))
        return;
    float x, y;
    const bool along_x = filter_axis(pixel, ivec2(1, 0), here, x), along_y = filter_axis(pixel, ivec2(0, 1), here, y);
    // The smaller change; an axis without a value has no say, or edges along an axis would never be filtered.
    const bool take_x = along_x && (!along_y || abs(x - here.y) <= abs(y - here.y));
    const float occlusion = clamp(take_x ? x : y, 0.0, 1.0);
    filter_values[(2u - push.source) * ss_filter_plane() + ss_filter_index(pixel)] = occlusion;
    if (push.last != 0u)
        ss_write_visibility(pixel, 1.0 - occlusion);
}
