// Camera pixels as receivers in map space: docs/numerics.md, section 3.
// Needs the frame and occluder bindings and the horizon.
#ifndef SS_RECEIVER_GLSL
#define SS_RECEIVER_GLSL

#include "ss_horizon.glsl"

// Share of its own rise by which a neighbour may leave the plane before the plane may not tell that its front is turned away.
const float SS_SMOOTH = 0.03;
// Share of the steps to both sides by which they differ where a crease lies between, and how many times straighter the side of it
// is that a pixel lies on.
const float SS_CREASE = 0.15;
const float SS_STRAIGHTER = 8.0;

struct ss_receiver
{
    bool valid; // something was rendered here and it lies in front of the map and inside it
    vec2 uv;
    float g;
    vec2 gradient; // of g over (u, v) on the receiver's plane
    float eta;     // precision of the depths compared with g
    float drift;   // precision of the plane, per texel of distance
    bool away;     // all of the light lies behind the plane its normal gives
    float side;    // of its plane that the surface's front is on: 1 where g is greater, -1 where it is less
    float horizon; // share of the light behind its plane
};

bool ss_is_receiver(float depth)
{
    // Written so that NaN is no receiver.
    return (ss_flags & SS_FLAG_REVERSED) != 0u ? depth > 0.0 : depth < 1.0;
}

// Homogeneous map coordinates (u w, v w, g w, w) of a point of the render area; `at` counts pixels from its corner.
vec4 ss_to_map(vec2 at, float depth)
{
    const vec4 p = vec4(at * frame.camera.yz - 1.0, clamp(depth, 0.0, 1.0) - frame.camera.x, 1.0);
    return vec4(dot(frame.to_map[0], p), dot(frame.to_map[1], p), dot(frame.to_map[2], p), dot(frame.to_map[3], p));
}

bool ss_is_in_front(vec4 h)
{
    return h.w > 0.0 && ((ss_flags & SS_FLAG_ORTHOGRAPHIC) != 0u || h.z > 0.0);
}

float ss_load_depth(ivec2 pixel)
{
    const ivec2 p = clamp(pixel, ivec2(0), frame.area.zw - 1) + frame.area.xy;
    return texelFetch(camera_depth, p, 0).x;
}

// How fast a point leaves the plane through it when the camera's device depth grows.
float ss_leaves_plane(vec4 h, vec2 gradient)
{
    const vec3 here = h.xyz / h.w;
    const vec3 per_depth = (vec3(frame.to_map[0].z, frame.to_map[1].z, frame.to_map[2].z) - here * frame.to_map[3].z) / h.w;
    return per_depth.z - dot(gradient, per_depth.xy);
}

// The camera's depth is precise to rho: how far that moves the point off its own plane, plus the map's share and rounding.
float ss_eta(vec4 h, vec2 gradient)
{
    return occ.depths.x + abs(ss_leaves_plane(h, gradient)) * frame.camera.w +
           exp2(-20.0) * max(abs(h.z / h.w), abs(gradient.x) + abs(gradient.y));
}

// The camera sees the front of a surface.
float ss_side(vec4 h, vec2 gradient)
{
    const float away = ss_leaves_plane(h, gradient);
    return ((ss_flags & SS_FLAG_REVERSED) != 0u ? -away : away) > 0.0 ? -1.0 : 1.0;
}

// What a surface turned by another 27 degrees would rise over a texel: surfaces are less flat than their planes, and what is
// lower than that over a receiver is lit as far as the map can tell.
float ss_slack(float g)
{
    const float texel = 0.5 * (occ.depths.y + occ.depths.z);
    return 0.5 * texel * ((ss_flags & SS_FLAG_ORTHOGRAPHIC) != 0u ? 1.0 : abs(g));
}

// A receiver's fan depth after the caller's bias, in world units.
float ss_shifted(float g)
{
    const float b = frame.bias.x;
    const float perspective = b * g < 1.0 ? g / (1.0 - b * g) : 3e38;
    return (ss_flags & SS_FLAG_ORTHOGRAPHIC) != 0u ? g + b : perspective;
}

// Not a number, and what is close to overflow, is 0.
vec2 ss_finite_gradient(vec2 gradient)
{
    return mix(vec2(0.0), gradient, lessThan(abs(gradient), vec2(1e30)));
}

vec2 ss_clamp_gradient(vec2 gradient, float g)
{
    const float tan_limit = 114.0; // tan 89.5 degrees
    const float scale = (ss_flags & SS_FLAG_ORTHOGRAPHIC) != 0u ? 1.0 : abs(g);
    const vec2 limit = tan_limit * scale * occ.depths.yz;
    return clamp(ss_finite_gradient(gradient), -limit, limit);
}

// Not a number is 0.
float ss_clamp_depth(float depth)
{
    return depth >= 0.0 ? min(depth, 1.0) : 0.0;
}

// What a pixel's neighbour to one side tells about its plane.
struct ss_neighbour
{
    bool found;
    vec3 difference; // in (u, v, g)
    float step;      // in device depth, which is affine in the pixel on a plane
    float bend;      // by how much the step from the neighbour to the next one differs from that
};

ss_neighbour ss_look_at_neighbour(ivec2 pixel, ivec2 step, float depth, vec3 here)
{
    const ivec2 at = pixel + step;
    const float depth_at = ss_load_depth(at), clamped_at = ss_clamp_depth(depth_at);
    const vec4 h = ss_to_map(vec2(at) + 0.5, depth_at);
    ss_neighbour n;
    n.found = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, frame.area.zw)) && ss_is_receiver(depth_at) &&
              ss_is_in_front(h);
    n.difference = h.xyz / h.w - here;
    n.step = clamped_at - ss_clamp_depth(depth);
    n.bend = abs(ss_clamp_depth(ss_load_depth(at + step)) - clamped_at - n.step);
    return n;
}

// Of two neighbours on an axis the one whose g is nearer; but where a crease is between them, the one on the pixel's side of it.
vec3 ss_choose_neighbour(ss_neighbour before, ss_neighbour after)
{
    const float rho = frame.camera.w;
    const bool crease = abs(before.step + after.step) > SS_CREASE * (abs(before.step) + abs(after.step)) + 4.0 * rho;
    const bool this_side = SS_STRAIGHTER * before.bend + rho < after.bend;
    const bool other_side = SS_STRAIGHTER * after.bend + rho < before.bend;
    const bool nearer = abs(before.difference.z) <= abs(after.difference.z);
    const bool first = crease && (this_side || other_side) ? this_side : nearer;
    return before.found && (!after.found || first) ? before.difference : after.difference;
}

// Gradient from a neighbour on each axis. `smooth_surface` says whether all four neighbours agree on the plane: noise and edges do
// not.
vec2 ss_gradient_from_depth(ivec2 pixel, float depth, vec3 here, float eta, out float drift, out bool smooth_surface)
{
    ss_neighbour n[4];
    for (int i = 0; i < 4; i++) {
        const int step = 2 * (i & 1) - 1;
        n[i] = ss_look_at_neighbour(pixel, i < 2 ? ivec2(step, 0) : ivec2(0, step), depth, here);
    }
    const vec3 dx = ss_choose_neighbour(n[0], n[1]), dy = ss_choose_neighbour(n[2], n[3]);
    const float det = dx.x * dy.y - dx.y * dy.x;
    const float scale = dot(dx.xy, dx.xy) * dot(dy.xy, dy.xy);
    smooth_surface = false;
    drift = 0.0;
    // Two directions that differ by less than a thousandth of a radian do not span a plane.
    if (!(n[0].found || n[1].found) || !(n[2].found || n[3].found) || !(det * det > 1e-6 * scale))
        return vec2(0.0);
    const vec2 gradient = vec2(dx.z * dy.y - dy.z * dx.y, dy.z * dx.x - dx.z * dy.x) / det;
    // Both ends of a difference are precise to eta.
    drift = 2.0 * eta * inversesqrt(min(dot(dx.xy, dx.xy), dot(dy.xy, dy.xy)));
    smooth_surface = true;
    for (int i = 0; i < 4; i++)
        smooth_surface = smooth_surface && n[i].found &&
                         abs(n[i].difference.z - dot(gradient, n[i].difference.xy)) <=
                             4.0 * eta + SS_SMOOTH * dot(abs(gradient), abs(n[i].difference.xy));
    return gradient;
}

// Gradient of the plane with world normal `n` through the point, and whether it faces away from all of the light.
vec2 ss_gradient_from_normal(vec3 n, vec3 here, out bool away, out float side)
{
    const vec3 a = frame.normal_map[0].xyz - here.x * frame.normal_map[3].xyz;
    const vec3 b = frame.normal_map[1].xyz - here.y * frame.normal_map[3].xyz;
    const vec3 c = frame.normal_map[2].xyz - here.z * frame.normal_map[3].xyz;
    const float ab = dot(n, cross(a, b)), bc = dot(n, cross(b, c)), ca = dot(n, cross(c, a));
    // A ray towards the light point q moves by (D(q), 1): it leaves the plane's front if n . dP > 0, up to a positive factor.
    const float den = occ.light.w - occ.light.z * here.z;
    const vec2 d = (occ.light.xy - occ.light.z * here.xy) / den;
    const vec2 spread = vec2(abs(bc * occ.a.x + ca * occ.a.z), abs(bc * occ.a.y + ca * occ.a.w)) / den;
    const float widest = (ss_flags & SS_FLAG_DISC) != 0u ? length(spread) : spread.x + spread.y;
    const float reach = frame.normal_map[0].w * (ab + bc * d.x + ca * d.y) + widest;
    away = reach <= 0.0;
    side = frame.normal_map[0].w * ab < 0.0 ? -1.0 : 1.0;
    return vec2(-bc / ab, -ca / ab);
}

ss_receiver ss_load_receiver(ivec2 pixel)
{
    ss_receiver r;
    const float depth = ss_load_depth(pixel);
    const vec4 h = ss_to_map(vec2(pixel) + 0.5, depth);
    r.away = false;
    r.valid = ss_is_receiver(depth) && ss_is_in_front(h);
    const vec3 here = h.xyz / (r.valid ? h.w : 1.0);
    r.uv = here.xy;
    r.g = here.z;
    r.valid = r.valid && all(greaterThanEqual(r.uv, vec2(0.0))) && all(lessThanEqual(r.uv, vec2(occ.size.xy))) &&
              occ.light.w - occ.light.z * r.g > 0.0;
    r.gradient = vec2(0.0);
    r.side = 1.0;
    bool from_depth = true;
    if (SS_NORMALS) {
        const vec3 n = texelFetch(camera_normals, pixel + frame.area.xy, 0).xyz;
        if (dot(n, n) > 0.0) {
            r.gradient = ss_gradient_from_normal(n, here, r.away, r.side);
            from_depth = false;
        }
    }
    r.drift = 0.0;
    bool smooth_surface = false;
    if (from_depth)
        r.gradient = ss_gradient_from_depth(pixel, depth, here, ss_eta(h, vec2(0.0)), r.drift, smooth_surface);
    // Before the steepest planes are made less steep: their sides would change.
    const vec2 steep = ss_finite_gradient(r.gradient);
    if (smooth_surface)
        r.side = ss_side(h, steep);
    r.horizon = (ss_flags & SS_FLAG_OVERRIDE_BIAS) != 0u ? 0.0 : ss_horizon(r.uv, r.g, steep, r.side);
    r.gradient = ss_clamp_gradient(steep, r.g);
    r.eta = ss_eta(h, r.gradient);
    return r;
}

#endif
