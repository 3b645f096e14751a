// The pixels that one invocation evaluates for their contours: what is kept of each receiver, and what they are to samples and
// edges. Those that belong together make a packet (Yang et al. 2009, section 4.1).
// Needs the packet, the edges and the push constants.
#ifndef SS_RECEIVERS_GLSL
#define SS_RECEIVERS_GLSL

// Samples that a packet may compare with its receivers one by one: what asks for more is hardly of one contour, and drivers end
// shaders that run too long.
const uint MOST_RESOLVED = 512u;

const int N = SS_PACKET * SS_PACKET;
const bool ALONE = N == 1;
// Whether the areas of cells that receivers see from behind are found, too.
const bool BACKS = SS_RECONSTRUCTION == SS_RECONSTRUCTION_BACKS;

ss_packet packet;
uint together;      // its receivers
ss_samples samples; // that any of them asks for
ss_light_map light_map;
uint resolved; // samples compared one by one
bool diverged;

// Of each receiver. Arrays of scalars, few of them: drivers may have to keep all of it in memory.
float at_u[N], at_v[N], at_g[N]; // g: biased
float border[N], gradient_x[N], gradient_y[N], drift[N]; // of what counts as its own surface; border: at uv
float horizon[N];
float area[N], backs[N], occlusion[N]; // backs: of cells seen from behind
uint edges;   // found
uint refined; // those whose level is finer than the budget's
uint touched; // those whose light edges of the contours come near enough to hide parts of

ivec2 ss_offset_of(int i)
{
    return ivec2(i % SS_PACKET, i / SS_PACKET) * int(push.stride);
}

// A packet's mask has a bit for each of 4 x 4 pixels; from one that is in the packet to its number.
int ss_receiver_of(int bit)
{
    const int shift = int(push.stride) >> 1;
    return ((bit & 3) >> shift) + SS_PACKET * (bit >> 2 >> shift);
}

// Whether a sample occludes one receiver, computed as for a packet of one.
bool ss_occludes_one(int i, vec2 place, float g)
{
    const vec2 away = place - vec2(at_u[i], at_v[i]), far = abs(away);
    const float height = packet.side * (g - gradient_y[i] * away.y - gradient_x[i] * away.x);
    return g > at_g[i] && g < packet.g_limit && height > border[i] + drift[i] * far.y + drift[i] * far.x;
}

vec2 ss_project(int i, vec3 at)
{
    return ss_map_to_light(light_map, vec3(at_u[i], at_v[i], at_g[i]), at);
}

// Whether a sample that bounds do not tell about occludes. It occludes all receivers, or none, or the packet diverges.
bool ss_resolve_sample(ss_grid grid, ivec2 at)
{
    const float g = ss_sample_depth(grid, at);
    const vec2 place = ss_sample_place(at, grid.level);
    uint by = 0u;
    for (uint left = together; left != 0u; left &= left - 1u) {
        const int i = findLSB(left);
        by |= uint(ss_occludes_one(i, place, g)) << i;
    }
    resolved++;
    diverged = (by != 0u && by != together) || resolved > MOST_RESOLVED;
    return by == together;
}

// An edge of a cell's contours to the receivers' areas, unless there is none.
void ss_add_edge(ss_grid grid, ivec2 cell, uint corners, bool any)
{
    vec3 from, to;
    ss_contour_edge(grid, cell, corners, from, to);
    edges += uint(any);
    [[unroll]] for (int i = 0; i < N; i++) {
        const vec2 p = ss_project(i, from), q = ss_project(i, to);
        const float a = ss_edge_area(p, q);
        area[i] += any ? a : 0.0;
        if (SS_SPARSE)
            touched |= uint(any && ss_edge_touches(p, q)) << i;
    }
}

// The areas of one layer are known.
void ss_end_layer()
{
    const float turn = ss_turn(light_map);
    [[unroll]] for (int i = 0; i < N; i++) {
        const float signed_area = turn * area[i];
        float a = signed_area > 0.0 ? min(signed_area, 1.0) : 0.0; // not a number is nothing
        if (BACKS) {
            const float folded = turn * backs[i];
            a += folded > 0.0 ? min(folded, 1.0) * (1.0 - a) * (1.0 - a) : 0.0;
            backs[i] = 0.0;
        }
        occlusion[i] = SS_MERGE_MAXIMUM ? max(occlusion[i], a) : min(occlusion[i] + a, 1.0);
        area[i] = 0.0;
    }
}

// Yang et al. 2009, equation 6: what `receivers` cost that share the contours of a kernel.
float ss_cost_of(ivec2 lo, ivec2 hi, uint receivers)
{
    const float w = float(max(hi.x - lo.x, hi.y - lo.y) + 2);
    return w * (frame.cost.x * log2(w) + frame.cost.y + frame.cost.z * float(receivers));
}

// Equations 4 and 5: how probable it is that some sample occludes some receivers and not others, if the kernel's depths were
// spread evenly. Heights over planes stand for the paper's depths.
float ss_divergence()
{
    const ivec2 lo = samples.lo << int(samples.level),
                hi = min((samples.hi + 1 << int(samples.level)) - 1, ivec2(occ.size.xy) - 1);
    const vec2 range = packet.side * ss_range(lo, max(hi, lo));
    const float low = min(range.x, range.y), high = max(range.x, range.y);
    const float null = max(min(packet.most, high) - max(packet.least, low), 0.0) / max(high - low, 1e-30);
    const vec2 w = vec2(max(samples.hi - samples.lo + 1, 0));
    return 1.0 - pow(1.0 - min(null, 1.0), w.x * w.y);
}

// Loads the pixels of `mask` that are neither lit nor dark by what their kernels hold; those of one level and side make the packet.
// Returns the others.
uint ss_load_packet(ivec2 corner, uint mask, float g_hi)
{
    vec2 gradient_lo = vec2(3e38), gradient_hi = vec2(-3e38), uv = vec2(0.0);
    float side = 1.0, alone = 0.0, eta = 3e38;
    uint apart = 0u, lit_count = 0u, dark_count = 0u;
    together = 0u;
    samples.level = 0u;
    samples.lo = ivec2(0);
    samples.hi = ivec2(-2);
    samples.clamped = false;
    refined = 0u;
    // Loops over receivers go through bits: with a fixed number of rounds drivers would unroll them.
    for (uint todo = mask; todo != 0u; todo &= todo - 1u) {
        const int i = ss_receiver_of(findLSB(todo));
        const ivec2 pixel = corner + ss_offset_of(i);
        const ss_receiver r = ss_load_receiver(pixel);
        bool empty;
        const float nearest = ss_refine_kernel(r, g_hi, empty);
        const ss_samples own = ss_evaluated_samples(r, nearest);
        float band;
        at_u[i] = r.uv.x;
        at_v[i] = r.uv.y;
        at_g[i] = ss_biased(r, own.level, band);
        horizon[i] = r.horizon;
        const bool lit = !r.valid || (empty && !r.away), dark = !lit && (r.away || r.horizon >= 1.0);
        if (dark)
            ss_write_visibility(pixel, 0.0);
        if (SS_SPARSE && (lit || dark))
            ss_store_visible(pixel, lit ? SS_ALL_LIT : SS_ALL_DARK);
        lit_count += uint(lit);
        dark_count += uint(dark);
        if (!lit && !dark) {
            const bool first = together == 0u;
            samples.level = first ? own.level : samples.level;
            side = first ? r.side : side;
            if (own.level == samples.level && r.side == side) {
                samples.lo = first ? own.lo : min(samples.lo, own.lo);
                samples.hi = first ? own.hi : max(samples.hi, own.hi);
                samples.clamped = own.clamped;
                refined |= uint(own.refined) << i;
                uv = first ? r.uv : uv;
                gradient_lo = min(gradient_lo, r.gradient);
                gradient_hi = max(gradient_hi, r.gradient);
                border[i] = r.side * r.g + band;
                gradient_x[i] = r.gradient.x;
                gradient_y[i] = r.gradient.y;
                drift[i] = r.drift;
                eta = min(eta, r.eta);
                alone += ss_cost_of(own.lo, own.hi, 1u);
                together |= 1u << i;
            } else {
                apart |= 1u << i;
            }
        }
    }
    ss_packet_begin(uv, 0.5 * (gradient_lo + gradient_hi), side, eta, packet);
    for (uint todo = together; todo != 0u; todo &= todo - 1u) {
        const int i = findLSB(todo);
        ss_packet_add(packet, vec2(at_u[i], at_v[i]), at_g[i], border[i], vec2(gradient_x[i], gradient_y[i]), drift[i]);
    }
    if (!ALONE && (ss_cost_of(samples.lo, samples.hi, uint(bitCount(together))) > alone || ss_divergence() > frame.cost.w)) {
        apart |= together;
        together = 0u;
        samples.hi = samples.lo - 2;
    }
    if (SS_STATS) {
        ss_count(SS_STAT_LIT, lit_count);
        ss_count(SS_STAT_UMBRA, dark_count);
    }
    return apart;
}

#endif
