/* What every peer but `copy` starts with: the receiver in map space (u, v, g), where g is the fan depth (1/z for a
 * perspective map, -z for an orthographic one), its plane there, and the test of a tap against that plane.
 *
 * The plane comes from the camera depth: of the two neighbours on each axis the one whose depth differs less, because
 * the other is more likely to lie on another surface. Device depth is affine on a plane, so the difference is the
 * plane's own slope, however far away it is. */
#include "peer_params.h"

layout(push_constant) uniform params_block
{
    peer_params params;
};
layout(set = 0, binding = 0) uniform texture2D camera_depth;
layout(set = 0, binding = 1) uniform texture2D map_depth;
#ifdef PEER_ACCUMULATES
layout(set = 0, binding = 2, r32f) uniform image2D visibility;
#else
layout(set = 0, binding = 2) uniform writeonly image2D visibility;
#endif

struct receiver {
    vec2 uv;
    float g;
    vec2 slope;       /* of g along u and v */
    vec2 slope_error; /* what the precision of the camera's depth leaves open of it */
    float threshold;  /* right side of the tap test at texel (u, v) */
    bool valid;       /* something was rendered, and it lies inside the map and in front of the light */
};

float camera_at(ivec2 pixel)
{
    return texelFetch(camera_depth, pixel, 0).x - params.far_depth;
}

/* Change of depth from one pixel to the next; `found` is false where neither neighbour is a receiver. */
float depth_step(float centre, float before, float after, bool has_before, bool has_after, out bool found)
{
    const float backward = centre - before;
    const float forward = after - centre;
    const bool use_before = has_before && before != 0.0;
    const bool use_after = has_after && after != 0.0;

    found = use_before || use_after;
    return use_after && (!use_before || abs(forward) <= abs(backward)) ? forward : backward;
}

void find_slope(ivec2 pixel, ivec2 size, float depth, inout receiver r)
{
    const ivec2 last = size - 1;
    const float left = camera_at(ivec2(max(pixel.x - 1, 0), pixel.y));
    const float right = camera_at(ivec2(min(pixel.x + 1, last.x), pixel.y));
    const float above = camera_at(ivec2(pixel.x, max(pixel.y - 1, 0)));
    const float below = camera_at(ivec2(pixel.x, min(pixel.y + 1, last.y)));
    bool found_x, found_y;
    const float step_x = depth_step(depth, left, right, pixel.x > 0, pixel.x < last.x, found_x);
    const float step_y = depth_step(depth, above, below, pixel.y > 0, pixel.y < last.y, found_y);
    /* The pixel axes on the plane, carried to map space times w. */
    const float wx = params.row_w.x + step_x * params.row_w.z;
    const float wy = params.row_w.y + step_y * params.row_w.z;
    const vec2 a = vec2(params.row_u.x + step_x * params.row_u.z, params.row_v.x + step_x * params.row_v.z) - r.uv * wx;
    const vec2 b = vec2(params.row_u.y + step_y * params.row_u.z, params.row_v.y + step_y * params.row_v.z) - r.uv * wy;
    const float ga = params.row_g.x + step_x * params.row_g.z - r.g * wx;
    const float gb = params.row_g.y + step_y * params.row_g.z - r.g * wy;
    const float determinant = a.x * b.y - a.y * b.x;
    const float g_error = 2.0 * params.camera_precision * abs(params.row_g.z - r.g * params.row_w.z);
    const float limit = params.slope_limit * mix(1.0, r.g, params.perspective);

    if (found_x && found_y && abs(determinant) > 0.0) {
        r.slope = clamp(vec2(ga * b.y - gb * a.y, gb * a.x - ga * b.x) / determinant, -limit, limit);
        r.slope_error = g_error * vec2(abs(a.y) + abs(b.y), abs(a.x) + abs(b.x)) / abs(determinant);
    } else {
        r.slope = vec2(0.0);
        r.slope_error = vec2(0.0);
    }
}

receiver receiver_at(ivec2 pixel, ivec2 size)
{
    const vec2 map_size = vec2(textureSize(map_depth, 0));
    const float depth = camera_at(pixel);
    const vec4 place = vec4(vec2(pixel) + 0.5, depth, 1.0);
    const float w = dot(params.row_w, place);
    receiver r;

    r.uv = vec2(dot(params.row_u, place), dot(params.row_v, place)) / w;
    r.g = dot(params.row_g, place) / w;
    /* Every comparison is false for NaN. */
    r.valid = abs(depth) > 0.0 && w > 0.0 && all(greaterThanEqual(r.uv, vec2(0.0))) &&
              all(lessThanEqual(r.uv, map_size)) && params.light_plane * r.g < 1.0;
    find_slope(pixel, size, depth, r);
    const float steepness = abs(r.slope.x) + abs(r.slope.y);
    const float precision_bias = params.map_precision + exp2(-20.0) * max(abs(r.g), steepness) +
                                 abs(params.row_g.z - r.g * params.row_w.z) / w * params.camera_precision;
    /* The plane is exact for a plane. Facets and curved surfaces leave theirs within the texel: one texel's change of
     * depth lets 99.9 % of what the light sees whole, or not at all, come out so. */
    const float surface_bias = steepness;
    /* The tap test counts from a texel's corner and in map depths: half a texel and depth_offset go here. */
    r.threshold = r.g + precision_bias + surface_bias + 0.5 * (r.slope.x + r.slope.y) - params.depth_offset;
    return r;
}

/* Depth of the map's texel around `at`, and whether it lies in front of the receiver's plane there: a tap's bias is the
 * plane's own height at the texel's centre, so the receiver never shadows itself, however steep and however wide the
 * kernel. Beyond the map's border its outermost texels go on. */
bool blocks(receiver r, vec2 at, vec2 map_limit, out float depth)
{
    const ivec2 texel = ivec2(clamp(at, vec2(0.0), map_limit));
    const vec2 offset = vec2(texel) - r.uv;

    depth = texelFetch(map_depth, texel, 0).x;
    return params.depth_scale * depth > r.threshold + dot(r.slope, offset) + dot(r.slope_error, abs(offset));
}

/* The image of the light, from its centre, at the fan depth `height` above the receiver. */
mat2 light_extent(receiver r, float height)
{
    return mat2(params.light.xy, params.light.zw) * (height / (1.0 - params.light_plane * r.g));
}

vec2 light_centre(receiver r, float height)
{
    return r.uv + (params.offset - params.light_plane * r.uv) * (height / (1.0 - params.light_plane * r.g));
}

vec2 map_limit()
{
    return vec2(textureSize(map_depth, 0)) - 0.5;
}
