#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
// Contours of what occludes receivers, by marching squares over the kernel's samples, back-projected and integrated on the
// light (Guennebaud et al. 2007; Yang et al. 2009, section 4): docs/numerics.md, section 10. One lane per packet: which samples
// occlude and where the contours run is found once for all of its pixels; edges are projected for each of them. Pixels that
// do not belong together go on to a list of smaller packets or single pixels, which is evaluated next, and so does a packet that
// is not of one contour.
#include "ss_types.h"
#include "ss_specialization.glsl"
#include "ss_occluder_bindings.glsl"
#include "ss_io_bindings.glsl"
#include "ss_filter_values.glsl"
#include "ss_lists.glsl"
#include "ss_receiver.glsl"
#include "ss_range.glsl"
#include "ss_kernel.glsl"
#include "ss_sample.glsl"
#include "ss_edge.glsl"
#include "ss_packet.glsl"
#include "ss_strip.glsl"
#include "ss_contour.glsl"

layout(local_size_x = SS_EVALUATE_GROUP) in;
layout(push_constant) uniform ss_push
{
    ss_evaluate_push push;
};

// Samples that a packet may compare with its receivers one by one: what asks for more is hardly of one contour, and drivers end
// shaders that run too long.
const uint MOST_RESOLVED = 512u;

const int N = SS_PACKET * SS_PACKET;
const bool ALONE = N == 1;
const uint LIST = ALONE ? SS_LIST_PIXELS : SS_PACKET == 2 ? SS_LIST_SMALL : SS_LIST_LARGE;

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
float area[N], occlusion[N];
uint refined; // those whose level is finer than the budget's
uint touched; // those whose light edges of the contours come near enough to hide parts of

ivec2 offset_of(int i)
{
    return ivec2(i % SS_PACKET, i / SS_PACKET) * int(push.stride);
}

// A packet's mask has a bit for each of 4 x 4 pixels; from one that is in the packet to its number.
int receiver_of(int bit)
{
    const int shift = int(push.stride) >> 1;
    return ((bit & 3) >> shift) + SS_PACKET * (bit >> 2 >> shift);
}

// Whether a sample occludes one receiver, computed as for a packet of one.
bool occludes_one(int i, vec2 place, float g)
{
    const vec2 away = place - vec2(at_u[i], at_v[i]), far = abs(away);
    const float height = packet.side * (g - gradient_y[i] * away.y - gradient_x[i] * away.x);
    return g > at_g[i] && g < packet.g_limit && height > border[i] + drift[i] * far.y + drift[i] * far.x;
}

vec2 back_project(int i, vec3 at)
{
    return ss_map_to_light(light_map, vec3(at_u[i], at_v[i], at_g[i]), at);
}

// Samples of the strip that bounds do not tell about, one by one: they occlude all receivers, or none, or the packet diverges.
void resolve_strip(ss_grid grid, int x0, int y0, uint unknown_rows)
{
    int row = 0;
    uint todo = 0u;
    while ((todo != 0u || unknown_rows != 0u) && !diverged) {
        if (todo == 0u) {
            row = findLSB(unknown_rows);
            todo = ss_strip_unknown[row];
            unknown_rows &= unknown_rows - 1u;
        }
        const int k = findLSB(todo);
        todo &= todo - 1u;
        const ivec2 at = ivec2(x0 + k, y0 + row);
        const float g = ss_sample_depth(grid, at);
        const vec2 place = ss_sample_place(at, grid.level);
        uint by = 0u;
        for (uint left = together; left != 0u; left &= left - 1u) {
            const int i = findLSB(left);
            by |= uint(occludes_one(i, place, g)) << i;
        }
        resolved++;
        diverged = (by != 0u && by != together) || resolved > MOST_RESOLVED;
        ss_strip[row] |= by == together ? 1u << k : 0u;
    }
}

// Edges of the strip's contours to the receivers' areas.
void add_contours(ss_grid grid, int x0, int y0, uint rows, uint columns, inout uint edges)
{
    ss_contour_cells cells;
    cells.todo = 0u;
    while (rows != 0u || cells.todo != 0u) {
        if (cells.todo == 0u) {
            cells = ss_begin_cells(findLSB(rows), columns);
            rows &= rows - 1u;
        }
        const bool any = cells.todo != 0u;
        uint corners;
        const int k = ss_next_cell(cells, corners);
        vec3 from, to;
        ss_contour_edge(grid, ivec2(x0 + k, y0 + cells.row), corners, from, to);
        edges += uint(any);
        [[unroll]] for (int i = 0; i < N; i++) {
            const vec2 p = back_project(i, from), q = back_project(i, to);
            const float a = ss_edge_area(p, q);
            area[i] += any ? a : 0.0;
            if (SS_SPARSE)
                touched |= uint(any && ss_edge_touches(p, q)) << i;
        }
    }
}

// One strip of one layer's samples after the other.
void add_layers(inout uint edges)
{
    const int first = samples.lo.x - 1, start = first & ~3;
    const bool in_blocks = SS_HIERARCHY && samples.level + 2u <= occ.levels.x;
    ss_grid grid = ss_load_grid(0u, samples.level);
    // Blocks of 4 x 4 samples are the texels two levels up.
    ss_grid blocks = ss_load_grid(0u, min(samples.level + 2u, occ.levels.x));
    const float orientation = determinant(light_map.matrix) < 0.0 ? -1.0 : 1.0;
    uint layer = 0u;
    int x0 = start, y0 = samples.lo.y - 1, skip = first - start;
    while (layer < ss_layers() && together != 0u && !diverged) {
        const int count = min(samples.hi.y + 1 - y0, SS_STRIP_ROWS);
        const uint unknown_rows = ss_fill_strip(packet, ALONE, grid, blocks, in_blocks, samples.lo, samples.hi, x0, y0, count);
        if (!ALONE)
            resolve_strip(grid, x0, y0, unknown_rows);
        add_contours(grid, x0, y0, diverged ? 0u : ss_contour_rows(count), 0x7fffffffu & (0xffffffffu << skip), edges);
        y0 += SS_STRIP_ROWS;
        if (y0 > samples.hi.y) {
            y0 = samples.lo.y - 1;
            x0 += SS_STRIP_STEP;
            skip = SS_STRIP_COLUMNS - SS_STRIP_STEP;
        }
        if (x0 + skip > samples.hi.x) {
            x0 = start;
            skip = first - start;
            layer++;
            grid.depths += 4u * occ.strides.x;
            grid.ranges += occ.strides.y;
            blocks.ranges += occ.strides.y;
            [[unroll]] for (int i = 0; i < N; i++) {
                const float signed_area = orientation * area[i];
                const float a = signed_area > 0.0 ? min(signed_area, 1.0) : 0.0; // not a number is nothing
                occlusion[i] = SS_MERGE_MAXIMUM ? max(occlusion[i], a) : min(occlusion[i] + a, 1.0);
                area[i] = 0.0;
            }
        }
    }
}

// Yang et al. 2009, equation 6: what `receivers` cost that share the contours of a kernel.
float cost_of(ivec2 lo, ivec2 hi, uint receivers)
{
    const float w = float(max(hi.x - lo.x, hi.y - lo.y) + 2);
    return w * (frame.cost.x * log2(w) + frame.cost.y + frame.cost.z * float(receivers));
}

// Equations 4 and 5: how probable it is that some sample occludes some receivers and not others, if the kernel's depths were
// spread evenly. Heights over planes stand for the paper's depths.
float divergence()
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
uint load_packet(ivec2 corner, uint mask, float g_hi)
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
        const int i = receiver_of(findLSB(todo));
        const ivec2 pixel = corner + offset_of(i);
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
                alone += cost_of(own.lo, own.hi, 1u);
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
    if (!ALONE && (cost_of(samples.lo, samples.hi, uint(bitCount(together))) > alone || divergence() > frame.cost.w)) {
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

// Pixels that a smaller packet or they themselves must be evaluated for.
void pass_on(uint id, uint pixels, float g_hi)
{
    if (SS_SPLIT) {
        for (uint i = 0u; i < 4u; i++) {
            const uint x = 2u * (i & 1u), y = i & 2u, part = pixels >> (x + 4u * y) & SS_SMALL_MASK;
            if (part != 0u)
                ss_append_packet(push.round, SS_LIST_SMALL, id + x + SS_TILE_X * y, g_hi, part);
        }
    } else {
        for (uint todo = pixels; todo != 0u; todo &= todo - 1u) {
            const ivec2 at = offset_of(findLSB(todo));
            ss_append_pixel(push.round, id + uint(at.x) + SS_TILE_X * uint(at.y), g_hi);
        }
    }
}

void main()
{
    const uint index = (gl_WorkGroupID.y * SS_DISPATCH_WIDTH + gl_WorkGroupID.x) * SS_EVALUATE_GROUP + gl_LocalInvocationIndex;
    if (index >= control.evaluate_args[SS_LISTS * push.round + LIST].w)
        return;
    const uint slot = ALONE ? ss_pixel_slot(index) : ss_packet_slot(LIST, index);
    const uint id = tiles[slot], mask = ALONE ? 1u : tiles[slot + 2u];
    const float g_hi = uintBitsToFloat(tiles[slot + 1u]);
    const ivec2 corner = ss_tile_pixel(id / SS_TILE_PIXELS, id % SS_TILE_PIXELS);

    // The square that areas are clipped to becomes [0, 1] x [0, 1].
    light_map = ss_to_light(0.5, 0.5 / occ.extent.x);
    uint apart = load_packet(corner, mask, g_hi), edges = 0u;
    const bool incoherent = apart != 0u;
    touched = 0u;
    resolved = 0u;
    diverged = false;
    [[unroll]] for (int i = 0; i < N; i++)
        area[i] = occlusion[i] = 0.0;
    add_layers(edges);
    const uint done = diverged ? 0u : together;
    apart |= together & ~done;
    for (uint todo = done; todo != 0u; todo &= todo - 1u) {
        const int i = findLSB(todo);
        const ivec2 pixel = corner + offset_of(i);
        const float visible = max(1.0 - occlusion[i] - horizon[i], 0.0);
        const bool between = (touched >> i & 1u) != 0u || horizon[i] > 0.0;
        ss_write_visibility(pixel, visible);
        if (SS_SPARSE)
            ss_store_visible(pixel, between ? visible : visible > 0.5 ? SS_ALL_LIT : SS_ALL_DARK);
    }
    if (!ALONE)
        pass_on(id, apart, g_hi);
    if (SS_STATS) {
        const uint n = uint(bitCount(done));
        ss_count(SS_STAT_ACTIVE, n);
        ss_count(SS_STAT_PRIMITIVES, edges * n);
        ss_count(SS_STAT_EDGES, edges);
        ss_count(SS_STAT_CLAMPED, samples.clamped ? n : 0u);
        ss_count(SS_STAT_REFINED, uint(bitCount(refined & done)));
        ss_count(SS_STAT_VISITED, ss_visited);
        ss_count(SS_STAT_PACKETS, ALONE ? 0u : 1u);
        ss_count(SS_STAT_INCOHERENT, incoherent ? 1u : 0u);
        ss_count(SS_STAT_DIVERGED, diverged ? 1u : 0u);
    }
}
