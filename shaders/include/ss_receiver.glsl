// Camera pixels as receivers in map space: docs/numerics.md, section 3.
// Needs the frame and occluder bindings.
#ifndef SS_RECEIVER_GLSL
#define SS_RECEIVER_GLSL

struct ss_receiver
{
    bool valid; // something was rendered here and it lies in front of the map and inside it
    vec2 uv;
    float g;
    vec2 gradient; // of g over (u, v) on the receiver's plane
    float eta;     // precision of the depths compared with g
    bool away;     // all of the light lies behind the plane its normal gives
};

bool ss_is_receiver(float depth)
{
    // Written so that NaN is no receiver.
    return frame.quality.w != 0u ? depth > 0.0 : depth < 1.0;
}

// Homogeneous map coordinates (u w, v w, g w, w) of a point of the render area; `at` counts pixels from its corner.
vec4 ss_to_map(vec2 at, float depth)
{
    const vec4 p = vec4(at * frame.camera.yz - 1.0, clamp(depth, 0.0, 1.0), 1.0);
    return vec4(dot(frame.to_map[0], p), dot(frame.to_map[1], p), dot(frame.to_map[2], p), dot(frame.to_map[3], p));
}

bool ss_is_in_front(vec4 h)
{
    return h.w > 0.0 && ((occ.size.w & SS_FLAG_ORTHOGRAPHIC) != 0u || h.z > 0.0);
}

float ss_load_depth(ivec2 pixel)
{
    const ivec2 p = clamp(pixel, ivec2(0), frame.area.zw - 1) + frame.area.xy;
    return texelFetch(camera_depth, p, 0).x;
}

// Change of g with the camera's device depth, for the share of eta that the camera's precision has.
float ss_depth_slope(vec4 h)
{
    return (frame.to_map[2].z - h.z / h.w * frame.to_map[3].z) / h.w;
}

float ss_eta(vec4 h, vec2 gradient)
{
    const float g = abs(h.z / h.w);
    return occ.depths.x + abs(ss_depth_slope(h)) * frame.camera.w +
           exp2(-20.0) * max(g, max(abs(gradient.x), abs(gradient.y)));
}

vec2 ss_clamp_gradient(vec2 gradient, float g)
{
    const float tan_limit = 114.0; // tan 89.5 degrees
    const float scale = (occ.size.w & SS_FLAG_ORTHOGRAPHIC) != 0u ? 1.0 : abs(g);
    const vec2 limit = tan_limit * scale * occ.depths.yz;
    return vec2(abs(gradient.x) < 1e30 ? clamp(gradient.x, -limit.x, limit.x) : 0.0,
                abs(gradient.y) < 1e30 ? clamp(gradient.y, -limit.y, limit.y) : 0.0);
}

// Difference to the neighbour one step along an axis whose g is nearer; false if there is none.
bool ss_neighbour_difference(ivec2 pixel, ivec2 axis, vec3 here, out vec3 difference)
{
    difference = vec3(0.0);
    bool found = false;
    for (int i = -1; i <= 1; i += 2) {
        const ivec2 at = pixel + i * axis;
        if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, frame.area.zw)))
            continue;
        const float depth = texelFetch(camera_depth, at + frame.area.xy, 0).x;
        const vec4 h = ss_to_map(vec2(at) + 0.5, depth);
        if (!ss_is_receiver(depth) || !ss_is_in_front(h))
            continue;
        const vec3 d = h.xyz / h.w - here;
        if (!found || abs(d.z) < abs(difference.z)) {
            difference = d;
            found = true;
        }
    }
    return found;
}

vec2 ss_gradient_from_depth(ivec2 pixel, vec3 here)
{
    vec3 dx, dy;
    const bool x = ss_neighbour_difference(pixel, ivec2(1, 0), here, dx);
    const bool y = ss_neighbour_difference(pixel, ivec2(0, 1), here, dy);
    const float det = dx.x * dy.y - dx.y * dy.x;
    const float scale = dot(dx.xy, dx.xy) * dot(dy.xy, dy.xy);
    // Two directions that differ by less than a thousandth of a radian do not span a plane.
    if (!x || !y || !(det * det > 1e-6 * scale))
        return vec2(0.0);
    return vec2(dx.z * dy.y - dy.z * dx.y, dy.z * dx.x - dx.z * dy.x) / det;
}

// Gradient of the plane with world normal `n` through the point, and whether it faces away from all of the light.
vec2 ss_gradient_from_normal(vec3 n, vec3 here, out bool away)
{
    const vec3 a = frame.normal_map[0].xyz - here.x * frame.normal_map[3].xyz;
    const vec3 b = frame.normal_map[1].xyz - here.y * frame.normal_map[3].xyz;
    const vec3 c = frame.normal_map[2].xyz - here.z * frame.normal_map[3].xyz;
    const float ab = dot(n, cross(a, b)), bc = dot(n, cross(b, c)), ca = dot(n, cross(c, a));
    // A ray towards the light point q moves by (D(q), 1): it leaves the plane's front if n . dP > 0, up to a positive factor.
    const float den = occ.light.w - occ.light.z * here.z;
    const vec2 d = (occ.light.xy - occ.light.z * here.xy) / den;
    const vec2 spread = vec2(abs(bc * occ.a.x + ca * occ.a.z), abs(bc * occ.a.y + ca * occ.a.w)) / den;
    const float reach = frame.normal_map[0].w * (ab + bc * d.x + ca * d.y) + spread.x + spread.y;
    away = reach <= 0.0;
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
    bool from_depth = true;
    if (SS_NORMALS) {
        const vec3 n = texelFetch(camera_normals, pixel + frame.area.xy, 0).xyz;
        if (dot(n, n) > 0.0) {
            r.gradient = ss_gradient_from_normal(n, here, r.away);
            from_depth = false;
        }
    }
    if (from_depth)
        r.gradient = ss_gradient_from_depth(pixel, here);
    r.gradient = ss_clamp_gradient(r.gradient, r.g);
    r.eta = ss_eta(h, r.gradient);
    return r;
}

#endif
