// Receivers of a tile or of a block of pixels, bounded by a plane and a thickness, and what the depth ranges of their common kernel
// say about all of them at once: docs/numerics.md, section 8.
// Needs the receiver and the kernel.
#ifndef SS_BOUNDS_GLSL
#define SS_BOUNDS_GLSL

// Above a box of so many texels a side receivers are not looked at cell by cell.
const int SS_MAX_PLANE_SIDE = 32;

struct ss_bounds
{
    bool usable;
    vec2 lo, hi;     // box of (u, v)
    float g_lo, g_hi;
    vec3 plane;      // g >= plane.x u + plane.y v + plane.z for every receiver
    float thickness; // how far receivers rise above that plane
    float eta;
    float side;      // of the plane that their fronts are on
    vec2 gradient;   // of the plane, however steep
    bool exact;      // nothing leaves the plane but for the precision of depths
};

// Whether the receivers leave their plane by no more than it rises over two texels.
bool ss_is_planar(ss_bounds t)
{
    const float slope = abs(t.plane.x) + abs(t.plane.y) + ss_slack(t.g_hi);
    return t.thickness <= 2.0 * slope + 4.0 * t.eta;
}

// Whether all of the light lies in front of the plane through any of the receivers; and whether none does.
void ss_bounds_horizon(ss_bounds t, out bool all_before, out bool all_behind)
{
    const vec2 middle = 0.5 * (t.lo + t.hi), half_side = 0.5 * (t.hi - t.lo);
    const ss_horizon_line line = ss_horizon_of(middle, 0.5 * (t.g_lo + t.g_hi), t.gradient);
    const float widest = abs(line.n.x) + abs(line.n.y);
    const float room = abs(occ.light.z) * (0.5 * (t.g_hi - t.g_lo) + dot(abs(t.gradient), half_side));
    const bool before = line.c - room >= widest, behind = line.c + room <= -widest;
    all_before = t.side > 0.0 ? before : behind;
    all_behind = t.exact && (t.side > 0.0 ? behind : before);
}

// Whether no texel of the box rises above the receivers' plane by more than the plane itself does within a cell of 4 x 4
// texels, a footprint the pixels' own test allows as well. Only for receivers of one plane, and boxes of a few cells.
bool ss_lies_under_plane(ss_bounds t, ivec2 lo, ivec2 hi)
{
    const int side = max(hi.x - lo.x, hi.y - lo.y) + 1;
    const float slope = abs(t.plane.x) + abs(t.plane.y) + ss_slack(t.g_hi);
    const bool planar = ss_is_planar(t);
    const int level = min(2, int(occ.levels.x));
    const ivec2 a = lo >> level, b = side <= SS_MAX_PLANE_SIDE && planar ? hi >> level : a - 1;
    const float cell = float(1 << level), footprint = 0.5 * cell * slope + t.eta;
    const int row = int(occ.pyramid[level].y);
    const uint base = occ.size.w * occ.strides.y + ss_level_offset(uint(level));
    bool under = side <= SS_MAX_PLANE_SIDE && planar;
    for (int y = a.y; y <= b.y && under; y++) {
        for (int x = a.x; x <= b.x; x++) {
            const float g = ss_range_at(base + uint(y * row + x)).y;
            under = under && g <= dot(t.plane.xy, (vec2(x, y) + 0.5) * cell) + t.plane.z + footprint;
        }
    }
    return under;
}

// The receivers' state; g_hi comes back as the nearest occluder they can have.
uint ss_classify_bounds(ss_bounds t, int refinements, inout float g_hi, inout uint nodes)
{
    const vec2 limit = vec2(occ.size.xy);
    const float den = occ.light.w - occ.light.z * t.g_hi;
    if (!t.usable || !(den > 0.0) || !SS_HIERARCHY)
        return SS_STATE_PIXELS;
    if (any(lessThan(t.hi, vec2(0.0))) || any(greaterThan(t.lo, limit)))
        return SS_STATE_LIT;
    const bool biased = (ss_flags & SS_FLAG_OVERRIDE_BIAS) != 0u;
    bool all_before, all_behind;
    ss_bounds_horizon(t, all_before, all_behind);
    uint state = SS_STATE_PIXELS;
    for (int i = 0; i < refinements && state == SS_STATE_PIXELS; i++) {
        const ss_samples s = ss_kernel_samples(ss_kernel_box(t.lo, t.hi, t.g_lo, den, g_hi));
        const vec2 range = ss_range_pyramid(s.texel_lo, s.texel_hi);
        nodes += 4u;
        const float rise = dot(abs(t.plane.xy), vec2(s.texel_hi - s.texel_lo + 1)) + t.eta;
        const bool inside = all(greaterThanEqual(t.lo, vec2(0.0))) && all(lessThanEqual(t.hi, limit));
        const bool dark = ss_rim_occludes(
            s, t.side > 0.0 && s.covered && inside && range.x > t.g_hi + rise && occ.light.z * range.y < occ.light.w && !biased,
            t.g_hi + rise + (abs(t.plane.x) + abs(t.plane.y)) * float(1u << s.level));
        if (!(range.y > t.g_lo + (biased ? 0.0 : t.eta)))
            state = SS_STATE_LIT;
        else if (dark || (all_behind && !biased))
            state = SS_STATE_UMBRA;
        g_hi = min(g_hi, range.y);
    }
    if (state != SS_STATE_PIXELS || biased)
        return state;
    const ss_samples s = ss_kernel_samples(ss_kernel_box(t.lo, t.hi, t.g_lo, den, g_hi));
    const bool under = t.side > 0.0 && all_before && ss_lies_under_plane(t, s.texel_lo, s.texel_hi);
    return under ? SS_STATE_LIT : SS_STATE_PIXELS;
}

#endif
