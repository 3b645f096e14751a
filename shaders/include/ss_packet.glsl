// Receivers that are evaluated together, and what samples are to all of them: Yang et al. 2009, section 4.1. The paper compares
// depths; here samples are compared with the receivers' planes, of which a packet keeps bounds: docs/numerics.md, section 10.
// Needs the sample and the kernel.
#ifndef SS_PACKET_GLSL
#define SS_PACKET_GLSL

// Heights are measured in front of a plane through uv: of gradient `gradient`, and g = 0 there. Up to `least` above it at uv no
// sample occludes any receiver, from `most` on every sample does; farther away these borders part from the plane.
struct ss_packet
{
    vec2 uv, gradient;
    float side;
    vec2 reach;        // how far receivers are from uv
    float g_lo, g_hi;  // range of what occluders are compared with
    float least, most;
    vec2 narrow, wide; // how fast those borders rise per texel: at least (negative: fall), at most
    float eta;         // the least
    float g_limit;     // occluders beyond are behind the light
};

// `gradient`: the middle of the receivers'; uv: among them. They have one side.
void ss_packet_begin(vec2 uv, vec2 gradient, float side, float eta, out ss_packet p)
{
    p.uv = uv;
    p.gradient = gradient;
    p.side = side;
    p.reach = vec2(0.0);
    p.eta = eta;
    p.g_lo = p.least = 3e38;
    p.g_hi = p.most = -3e38;
    p.narrow = vec2(3e38);
    p.wide = vec2(-3e38);
    p.g_limit = occ.light.z > 0.0 ? occ.light.w / occ.light.z : 3e38;
}

// A receiver at uv, of which samples nearer than g can occlude; `border` is that of its own surface there, in front of g = 0.
void ss_packet_add(inout ss_packet p, vec2 uv, float g, float border, vec2 gradient, float drift)
{
    const vec2 away = uv - p.uv, differ = abs(gradient - p.gradient);
    const float at_uv = border - p.side * dot(p.gradient, away);
    p.reach = max(p.reach, abs(away));
    p.g_lo = min(p.g_lo, g);
    p.g_hi = max(p.g_hi, g);
    p.least = min(p.least, at_uv);
    p.most = max(p.most, at_uv);
    p.narrow = min(p.narrow, drift - differ);
    p.wide = max(p.wide, drift + differ);
}

// A block of samples around `middle`, up to half_side away on each axis, of depths range.x to range.y: whether all of them
// occlude every receiver, or none occludes any. Neither is said in doubt.
void ss_block_status(ss_packet p, vec2 range, vec2 middle, float half_side, out bool every, out bool none)
{
    const vec2 away = middle - p.uv, far = abs(away) + half_side, near = max(abs(away) - half_side, vec2(0.0));
    const vec2 steep = abs(p.gradient);
    const vec2 height = p.side * (range - dot(p.gradient, away));
    // More than these sums are rounded by.
    const float slack = 0.25 * p.eta + exp2(-21.0) * dot(steep + p.wide, far);
    const float rise = (steep.x + steep.y) * half_side + slack;
    const float most = p.most + dot(p.wide, far + p.reach) + rise;
    const float least = p.least + dot(max(p.narrow, vec2(0.0)), max(near - p.reach, vec2(0.0))) +
                        dot(min(p.narrow, vec2(0.0)), far + p.reach) - rise;
    every = range.y < p.g_limit && range.x > p.g_hi && min(height.x, height.y) > most;
    none = !(range.x < p.g_limit) || !(range.y > p.g_lo) || max(height.x, height.y) <= least;
}

// Samples, blocks and nodes looked at, for statistics.
uint ss_visited = 0u;

// What the tests of a row of samples have in common.
struct ss_row
{
    float plane, most, least;
    float slack; // per texel of distance in u
};

// A packet of one is compared exactly; of more, with room for rounding, so that none of its receivers, alone, differs.
ss_row ss_begin_row(ss_packet p, float v, bool one)
{
    const float away = v - p.uv.y, far = abs(away);
    const float slack = one ? 0.0 : 0.25 * p.eta + exp2(-21.0) * (abs(p.gradient.y) + p.wide.y) * far;
    ss_row row;
    row.plane = p.gradient.y * away;
    row.most = p.most + p.wide.y * (far + p.reach.y) + slack;
    row.least = p.least + max(p.narrow.y, 0.0) * max(far - p.reach.y, 0.0) + min(p.narrow.y, 0.0) * (far + p.reach.y) - slack;
    row.slack = one ? 0.0 : exp2(-21.0) * (abs(p.gradient.x) + p.wide.x);
    return row;
}

uint ss_bits(bvec4 b)
{
    return uint(b.x) | uint(b.y) << 1 | uint(b.z) << 2 | uint(b.w) << 3;
}

// Four samples at u with depths g: bits of those that occlude every receiver; and of those that occlude some, perhaps.
void ss_quad_status(ss_packet p, ss_row row, vec4 u, vec4 g, bool one, out uint every, out uint unknown)
{
    const vec4 away = u - p.uv.x, far = abs(away), height = p.side * (g - row.plane - p.gradient.x * away);
    const vec4 slack = row.slack * far, most = row.most + p.wide.x * (far + p.reach.x) + slack;
    const uint before = ss_bits(lessThan(g, vec4(p.g_limit)));
    every = ss_bits(greaterThan(g, vec4(p.g_hi))) & before & ss_bits(greaterThan(height, most));
    unknown = 0u;
    if (!one) {
        const vec4 least = row.least - slack + max(p.narrow.x, 0.0) * max(far - p.reach.x, vec4(0.0)) +
                           min(p.narrow.x, 0.0) * (far + p.reach.x);
        unknown = ss_bits(greaterThan(g, vec4(p.g_lo))) & before & ~every & ss_bits(greaterThan(height, least));
    }
}

#endif
