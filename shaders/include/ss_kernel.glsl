// The kernel of a receiver and the map samples it asks for: docs/numerics.md, sections 2 and 5.
// Needs the frame and occluder bindings.
#ifndef SS_KERNEL_GLSL
#define SS_KERNEL_GLSL

const bool SS_IS_CONTOUR = SS_PRIMITIVE == SS_PRIMITIVE_CONTOUR;
const bool SS_IS_PATCH = SS_PRIMITIVE == SS_PRIMITIVE_PATCH || SS_PRIMITIVE == SS_PRIMITIVE_PATCH_EXTENDED;
const bool SS_IS_FLAT = SS_IS_PATCH || SS_IS_CONTOUR; // where the surface rises through it

// Occluders at or beyond the light do not count: the fan depth of the light's plane bounds them.
float ss_clip_to_light(float g)
{
    return occ.light.z > 0.0 ? min(g, occ.light.w / occ.light.z) : g;
}

// Half the sides of the light's bounding box, per unit of fan depth.
vec2 ss_light_reach()
{
    return vec2(abs(occ.a.x) + abs(occ.a.y), abs(occ.a.z) + abs(occ.a.w));
}

// Bounding box (x0, y0, x1, y1), in texels, of the light seen from receivers in uv_lo..uv_hi no farther than g, for
// occluders up to g_hi; den is the least epsilon - delta g of these receivers.
vec4 ss_kernel_box(vec2 uv_lo, vec2 uv_hi, float g, float den, float g_hi)
{
    const float k = max(ss_clip_to_light(g_hi) - g, 0.0) / den;
    const vec2 reach = ss_light_reach() * k;
    const vec2 lo = (occ.light.xy - occ.light.z * (occ.light.z > 0.0 ? uv_hi : uv_lo)) * k;
    const vec2 hi = (occ.light.xy - occ.light.z * (occ.light.z > 0.0 ? uv_lo : uv_hi)) * k;
    return vec4(uv_lo + min(lo - reach, 0.0), uv_hi + max(hi + reach, 0.0));
}

struct ss_samples
{
    uint level;
    ivec2 lo, hi;       // samples, inclusive, clipped to the level
    ivec2 texel_lo, texel_hi; // the texels that classification looks at
    bool covered;       // nothing was clipped
    bool clamped;       // the budget made the level coarser
    bool refined;       // but less so, for what is thin
};

// Samples a side from which on a contour's kernel is large: four corners of an eighth of a cell are 1/32 of it.
const float SS_INNER_SAMPLES = 4.0;

ivec2 ss_floor(vec2 x)
{
    // Clamped first: the conversion of huge values is not defined.
    return ivec2(floor(clamp(x, vec2(-65536.0), vec2(65536.0))));
}

// Samples a side that one invocation may look at without a budget. A bound for the loops: drivers stop shaders that run too
// long, the software driver silently after 65,535 rounds of all loops together; a quad takes two, a contour's sample one and
// its cell up to two.
uint ss_most_samples()
{
    const float of_contours = SS_RECONSTRUCTION == SS_RECONSTRUCTION_BACKS ? 96.0 : 128.0;
    return uint((SS_IS_PATCH ? 240.0 : SS_IS_CONTOUR ? of_contours : 160.0) * inversesqrt(float(ss_layers())));
}

// The same with the budget.
uint ss_most_budgeted()
{
    const uint most = ss_most_samples();
    return frame.quality.x == 0u ? most : min(frame.quality.x, most);
}

// The least level at which so many texels are at most the budget's samples. No division: drivers may do that lane by lane.
uint ss_extent_level(int extent)
{
    const uint budget = ss_most_budgeted();
    const uint steps = uint(extent) - 1u, shift = uint(max(findMSB(steps) - findMSB(budget), 0));
    const uint level = shift + uint(steps >= budget << shift);
    return min(max(level, frame.quality.y), occ.levels.x);
}

// Place of sample 0 of a level, in texels.
float ss_sample_offset(uint level)
{
    return level == 0u ? 0.5 : 0.5 * float(1u << level) + (SS_SAMPLED ? 0.5 : 0.0);
}

// The texels that a kernel meets.
struct ss_kernel_texels
{
    ivec2 lo, hi;
};

ss_kernel_texels ss_texels_of(vec4 box)
{
    const ivec2 limit = ivec2(occ.size.xy) - 1;
    return ss_kernel_texels(clamp(ss_floor(box.xy), ivec2(0), limit), clamp(ss_floor(box.zw), ivec2(0), limit));
}

uint ss_texels_level(ss_kernel_texels t)
{
    return ss_extent_level(max(t.hi.x - t.lo.x, t.hi.y - t.lo.y) + 1);
}

// How many levels finer than its budget a kernel may be evaluated.
const int SS_MOST_REFINED = 2;
// A quad needs two samples on what is thin.
const uint SS_THIN_LEVELS = SS_IS_FLAT ? 0u : 1u;

// The level, or a finer one if samples of it may miss something thin in the kernel: docs/numerics.md, section 5.
uint ss_refined_level(ss_kernel_texels t, uint level)
{
    const ivec2 size = t.hi - t.lo;
    const int extent = max(size.x, size.y);
    // Two texels a side of some level of the pyramid, which holds bits for the levels up to it.
    const int above = min(max(max(findMSB(max(extent - 1, 1)) + 1, int(level + SS_THIN_LEVELS)), 2), int(occ.levels.x));
    const uint base = occ.pyramid[above].x - occ.pyramid[2].x, row = occ.pyramid[above].y;
    const ivec2 a = t.lo >> above, b = t.hi >> above;
    const uint lower = base + uint(a.y) * row, upper = base + uint(b.y) * row;
    const uint thin = ss_bits_at(lower + uint(a.x)) | ss_bits_at(lower + uint(b.x)) | ss_bits_at(upper + uint(a.x)) |
                      ss_bits_at(upper + uint(b.x));
    [[unroll]] for (int i = 0; i < SS_MOST_REFINED; i++) {
        const uint finer = max(level, 1u) - 1u;
        const bool misses = level > 0u && (thin >> (level + SS_THIN_LEVELS) & 1u) != 0u;
        const bool refine = misses && finer >= frame.quality.y && uint(extent >> finer) < ss_most_samples();
        level = refine ? finer : level;
    }
    return level;
}

// Samples of a level that a kernel asks for.
ss_samples ss_level_samples(vec4 box, uint level)
{
    ss_samples s;
    const ivec2 limit = ivec2(occ.size.xy) - 1;
    s.level = level;
    s.clamped = s.level > frame.quality.y;
    s.refined = false;
    const float t = float(1u << s.level);
    const vec2 a = (box.xy - ss_sample_offset(s.level)) / t, b = (box.zw - ss_sample_offset(s.level)) / t;
    const ivec2 lo = ss_floor(SS_IS_PATCH ? a + 0.5 : a), hi = SS_IS_PATCH ? ss_floor(b + 0.5) : ss_floor(b) + 1;
    const ivec2 top = ss_level_size(s.level) - 1;
    s.covered = all(greaterThanEqual(lo, ivec2(0))) && all(lessThanEqual(hi, top));
    s.lo = clamp(lo, ivec2(0), top);
    s.hi = clamp(hi, ivec2(0), top);
    // Around a contour's samples lies a rim of others whose squares the kernel does not meet. In large kernels they are left to
    // the evaluation: they hide a corner of it at most.
    const bool inner = SS_IS_CONTOUR && all(greaterThanEqual(b - a, vec2(SS_INNER_SAMPLES)));
    s.texel_lo = (inner ? clamp(ss_floor(a + 0.5), ivec2(0), top) : s.lo) << int(s.level);
    s.texel_hi = min((((inner ? clamp(ss_floor(b + 0.5), ivec2(0), top) : s.hi) + 1) << int(s.level)) - 1, limit);
    return s;
}

ss_samples ss_kernel_samples(vec4 box)
{
    return ss_level_samples(box, ss_texels_level(ss_texels_of(box)));
}

// Half the thickness of the band around the receiver's plane that counts as the receiver's own surface, in texels' rise. A
// patch is flat where the surface rises through it; a quad's vertices lie on the surface, up to noise.
const float SS_BAND = SS_IS_FLAT ? 0.5 : 0.05;

const float SS_NO_BAND = -3e38;

// The fan depth occluders are compared with, and that thickness (SS_NO_BAND: nothing is left out): docs/numerics.md, section 3.
float ss_biased(ss_receiver r, uint level, out float band)
{
    const float slope = abs(r.gradient.x) + abs(r.gradient.y), t = float(1u << level);
    // The nearest depth of a block lifts the whole plane by as much as it rises from the block's centre.
    const float lift = SS_IS_FLAT || SS_SAMPLED ? 0.0 : 0.5 * slope * (t - 1.0);
    const bool overridden = (ss_flags & SS_FLAG_OVERRIDE_BIAS) != 0u;
    band = overridden ? SS_NO_BAND : r.eta + SS_BAND * slope * t;
    return overridden ? ss_shifted(r.g) : r.g + r.eta + lift;
}

// Whether a sample at height `height` over the receiver's plane is in front of the receiver's surface.
bool ss_is_off_plane(ss_receiver r, float height, float band)
{
    return !(r.side * height <= band);
}

// A receiver's kernel for occluders up to g_hi.
vec4 ss_receiver_box(ss_receiver r, float g_hi)
{
    return ss_kernel_box(r.uv, r.uv, r.g, occ.light.w - occ.light.z * r.g, g_hi);
}

ss_samples ss_receiver_samples(ss_receiver r, float g_hi)
{
    return ss_kernel_samples(ss_receiver_box(r, g_hi));
}

// What is evaluated of them: classification takes the level of the budget, whose samples stand for more.
ss_samples ss_evaluated_samples(ss_receiver r, float g_hi)
{
    const vec4 box = ss_receiver_box(r, g_hi);
    const ss_kernel_texels t = ss_texels_of(box);
    const uint level = ss_texels_level(t), evaluated = SS_REFINE ? ss_refined_level(t, level) : level;
    ss_samples s = ss_level_samples(box, evaluated);
    s.refined = evaluated < level;
    return s;
}

// Whether all samples occlude, given that those do which classification looks at: nearer than `least` in the first layer. The rim
// is looked at only where that is so, by a loop, because the software driver runs both sides of a branch.
bool ss_rim_occludes(ss_samples s, bool others_do, float least)
{
    const ivec2 lo = s.lo << int(s.level), hi = min(((s.hi + 1) << int(s.level)) - 1, ivec2(occ.size.xy) - 1);
    float farthest = -3e38;
    for (int i = SS_IS_CONTOUR && others_do ? 0 : 1; i < 1; i++)
        farthest = ss_range(lo, hi).x;
    return others_do && (!SS_IS_CONTOUR || farthest > least);
}

struct ss_kernel
{
    uint state; // SS_STATE_LIT, SS_STATE_UMBRA, or SS_STATE_PIXELS: to be evaluated
    ss_samples samples;
    float g_hi; // nearest occluder that matters
    uint nodes;
};

// Fan depth of the nearest occluder of the map.
float ss_nearest()
{
    return ss_root().y;
}

// Kernel with iterative refinement, and what follows from the depth ranges alone. No occluder that matters to the receiver is
// nearer than g_hi.
ss_kernel ss_find_kernel(ss_receiver r, float g_hi)
{
    ss_kernel k;
    k.nodes = 0u;
    k.state = SS_STATE_PIXELS;
    for (int i = 0; i < SS_MAX_REFINEMENTS && k.state == SS_STATE_PIXELS; i++) {
        k.samples = ss_receiver_samples(r, g_hi);
        if (!SS_HIERARCHY)
            break;
        const vec2 range = ss_range(k.samples.texel_lo, k.samples.texel_hi);
        k.nodes += 4u;
        float band;
        const float g = ss_biased(r, k.samples.level, band);
        // Rise of the receiver's plane over the samples, and over what a query of a few texels takes in.
        const vec2 reach = max(abs(vec2(k.samples.texel_lo & ~1) + 0.5 - r.uv), abs(vec2(k.samples.texel_hi | 1) + 0.5 - r.uv));
        const float rise = dot(abs(r.gradient), reach);
        const ivec2 size = k.samples.texel_hi - k.samples.texel_lo;
        const float least = g + max(rise + band, 0.0);
        const bool dark = ss_rim_occludes(
            k.samples, r.side > 0.0 && k.samples.covered && range.x > least && occ.light.z * range.y < occ.light.w,
            least + (abs(r.gradient.x) + abs(r.gradient.y)) * float(1u << k.samples.level));
        if (!(range.y > g))
            k.state = SS_STATE_LIT;
        else if (dark || r.horizon >= 1.0)
            k.state = SS_STATE_UMBRA;
        else if (max(size.x, size.y) <= 2 && (ss_flags & SS_FLAG_OVERRIDE_BIAS) == 0u && r.side > 0.0 && r.horizon == 0.0 &&
                 !(range.y > g + rise + ss_slack(r.g)))
            k.state = SS_STATE_LIT; // a few texels that all lie under the receiver's own plane
        g_hi = min(g_hi, range.y);
    }
    k.g_hi = g_hi;
    return k;
}

// Only what evaluation needs of that: the nearest occluder that matters, after so many refinements, and whether nothing in the
// kernel is nearer than the receiver.
float ss_refine_kernel(ss_receiver r, float g_hi, out bool lit)
{
    lit = false;
    [[unroll]] for (int i = 0; i < (SS_HIERARCHY ? SS_PACKET_REFINEMENTS : 0); i++) {
        const ss_samples s = ss_receiver_samples(r, g_hi);
        const float nearest = ss_range(s.texel_lo, s.texel_hi).y;
        float band;
        lit = lit || !(nearest > ss_biased(r, s.level, band));
        g_hi = min(g_hi, nearest);
    }
    return g_hi;
}

#endif
