#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
// Contours of what occludes a receiver, by marching squares over the kernel's samples, back-projected and integrated on the
// light (Guennebaud et al. 2007; Yang et al. 2009, section 4): docs/numerics.md, section 10. One lane per pixel of the active
// list. First which samples occlude, 32 to a word; words tell by bit operations which cells have a contour, so that only
// those are looked at again: their number grows with the length of the shadow's edge.
#include "ss_types.h"
#include "ss_specialization.glsl"
#include "ss_occluder_bindings.glsl"
#include "ss_io_bindings.glsl"
#include "ss_filter_values.glsl"
#include "ss_receiver.glsl"
#include "ss_range.glsl"
#include "ss_kernel.glsl"
#include "ss_sample.glsl"

layout(local_size_x = SS_EVALUATE_GROUP) in;
layout(push_constant) uniform ss_push
{
    ss_evaluate_push push;
};

const int SS_WORD_CELLS = 31; // a cell has samples of two neighbouring bits

// Samples x0 to x0 + 31 of a few rows, as far as blocks of them tell.
struct row_blocks
{
    uint full;  // these occlude
    uint mixed; // these must be looked at; the rest do not occlude
};

// What the depth range of a block of 2^log2_side x 2^log2_side samples says about them: docs/numerics.md, section 10.
void add_block(uint layer, ivec2 block, int log2_side, int x0, ss_samples s, ss_back_projection b, ss_receiver r, float band,
               inout row_blocks rows)
{
    const int shift = log2_side + int(s.level), level = min(shift, int(occ.levels.x));
    const vec2 range = ss_load_pyramid(layer, uint(level), (block << shift) >> level);
    const float half_side = 0.5 * float((1 << shift) - 1);
    const vec2 away = vec2(block << shift) + (0.5 + half_side) - r.uv;
    const float plane = b.g - r.eta + dot(r.gradient, away), rise = (abs(r.gradient.x) + abs(r.gradient.y)) * half_side;
    const float noise = r.drift * (abs(away.x) + abs(away.y) + 2.0 * half_side);
    // A quarter of eta is more than these sums are rounded by.
    const bool under = r.side > 0.0 ? range.y <= plane - rise + band - 0.25 * r.eta : range.x >= plane + rise - band + 0.25 * r.eta;
    const bool none = level == shift && (!(range.y > b.g) || under);
    const bool over = r.side > 0.0 ? range.x > plane + rise + band + noise + 0.25 * r.eta
                                   : range.y < plane - rise - band - noise - 0.25 * r.eta;
    const bool every = level == shift && range.x > b.g && occ.light.w - occ.light.z * range.y > 0.0 && over;
    const int first = (block.x << log2_side) - x0;
    const uint side = (1u << (1 << log2_side)) - 1u, bits = first < 0 ? side >> -first : side << first;
    rows.full |= every ? bits : 0u;
    rows.mixed |= none || every ? 0u : bits;
}

// Which of the samples x0 to x0 + 31 of a row occlude; `inside` are those of the kernel, the others do not.
uint occluding(ss_grid grid, int x0, int y, uint inside, row_blocks rows, ss_samples s, ss_back_projection b, ss_receiver r,
               float band)
{
    uint bits = rows.full & inside;
    for (uint todo = rows.mixed & inside; todo != 0u; todo &= todo - 1u) {
        const int k = findLSB(todo);
        const ivec2 at = ivec2(x0 + k, y);
        const float g = ss_sample_depth(grid, at);
        bits |= uint(ss_occludes(g, ss_sample_place(at, s.level), b, r, band)) << k;
    }
    return bits;
}

// From corner `corner` of a cell to the next, counter-clockwise from the lower left: half a step.
vec2 towards_next(int corner)
{
    const float step = (corner & 2) == 0 ? 0.5 : -0.5;
    return (corner & 1) == 0 ? vec2(step, 0.0) : vec2(0.0, step);
}

// The point of a contour half the way from an occluding corner of a cell to a neighbour, at the occluder's depth.
vec2 contour_point(ss_grid grid, ivec2 cell, int corner, vec2 half_step, ss_back_projection b)
{
    const ivec2 at = cell + ivec2((corner + 1) >> 1 & 1, corner >> 1);
    const float g = ss_sample_depth(grid, at);
    return ss_back_project(b, ss_sample_place(at, grid.level) + half_step * float(1u << grid.level), g);
}

// Mean of clamp(x, 0, 1) for x from x0 to x1 in even steps.
float mean_clamped(float x0, float x1)
{
    const float low = min(x0, x1), high = max(x0, x1), inside_low = clamp(low, 0.0, 1.0), inside_high = clamp(high, 0.0, 1.0);
    // Beyond the left side nothing, then a trapezoid, then the whole width.
    const float sum = 0.5 * (inside_high - inside_low) * (inside_low + inside_high) + (high - inside_high);
    return inside_high > inside_low ? sum / (high - low) : inside_low;
}

// The integral of x dy along an edge, in the light's square [0, 1] x [0, 1].
float edge_area(vec2 from, vec2 to)
{
    const float y0 = clamp(from.y, 0.0, 1.0), y1 = clamp(to.y, 0.0, 1.0);
    const float slope = (to.x - from.x) / (to.y - from.y);
    const float area = (y1 - y0) * mean_clamped(from.x + (y0 - from.y) * slope, from.x + (y1 - from.y) * slope);
    return abs(y1 - y0) > 0.0 ? area : 0.0;
}

// Area of what a layer hides, signed by the orientation of the light's axes.
float layer_area(uint layer, ss_samples s, ss_back_projection b, ss_receiver r, float band, inout uint edges)
{
    const ss_grid grid = ss_load_grid(layer, s.level);
    float area = 0.0;
    // Blocks pay in kernels of several; measured: not below 24 samples a side, and larger ones from 48.
    const int side = max(s.hi.x - s.lo.x, s.hi.y - s.lo.y) + 1, log2_side = side > 48 ? 3 : 2;
    const bool in_blocks = SS_HIERARCHY && side > 24;
    for (int x0 = s.lo.x - 1; x0 <= s.hi.x; x0 += SS_WORD_CELLS) {
        // Bits of the samples of the kernel: first to last of 32.
        const int first = max(s.lo.x - x0, 0), last = min(s.hi.x - x0, SS_WORD_CELLS);
        const uint columns = (0xffffffffu >> (SS_WORD_CELLS - last)) & (0xffffffffu << first);
        row_blocks rows;
        uint below = 0u;
        for (int y = s.lo.y; y <= s.hi.y + 1; y++) {
            // New blocks, by a loop that most rows skip.
            const bool entered = y == s.lo.y || (y & ((1 << log2_side) - 1)) == 0;
            const int first_block = max(x0 + first, 0) >> log2_side, end_block = entered && in_blocks ? (x0 + last >> log2_side) + 1 : first_block;
            rows.full = entered ? 0u : rows.full;
            rows.mixed = entered ? (in_blocks ? 0u : 0xffffffffu) : rows.mixed;
            for (int x = first_block; x < end_block; x++)
                add_block(layer, ivec2(x, y >> log2_side), log2_side, x0, s, b, r, band, rows);
            const uint above = occluding(grid, x0, y, y <= s.hi.y ? columns : 0u, rows, s, b, r, band);
            // Corners a, b, c, d of all cells of the row, counter-clockwise from the lower left.
            const uint ca = below, cb = below >> 1, cc = above >> 1, cd = above;
            const uint any = (ca | cb | cc | cd) & 0x7fffffffu, all = ca & cb & cc & cd;
            // Occluders that touch at a corner stay apart: two runs of corners, one after the other.
            const uint twice = ((ca & cc & ~(cb | cd)) | (cb & cd & ~(ca | cc))) & 0x7fffffffu;
            uint todo = any & ~all;
            bool second = false;
            edges += uint(bitCount(todo) + bitCount(twice));
            while (todo != 0u || (!second && twice != 0u)) {
                if (todo == 0u) {
                    todo = twice;
                    second = true;
                }
                const int k = findLSB(todo);
                todo &= todo - 1u;
                uint corners = (ca >> k & 1u) | (cb >> k & 1u) << 1 | (cc >> k & 1u) << 2 | (cd >> k & 1u) << 3;
                const bool ambiguous = (twice >> k & 1u) != 0u;
                corners &= ambiguous ? (second ? 12u : 3u) : 15u;
                // Bit i of `following` is corner i + 1.
                const uint following = (corners >> 1) | (corners & 1u) << 3;
                const int leaves = findLSB(corners & ~following), enters = findLSB(~corners & following);
                const ivec2 cell = ivec2(x0 + k, y - 1);
                const vec2 from = contour_point(grid, cell, leaves, towards_next(leaves), b);
                const vec2 to = contour_point(grid, cell, (enters + 1) & 3, -towards_next(enters), b);
                area += edge_area(from, to);
            }
            below = above;
        }
    }
    return area;
}

void main()
{
    const uint index = (gl_WorkGroupID.y * SS_DISPATCH_WIDTH + gl_WorkGroupID.x) * SS_EVALUATE_GROUP + gl_LocalInvocationIndex;
    if (index >= control.evaluate_args[push.round].w)
        return;
    const uint id = tiles[ss_active_slot(index)];
    const float g_hi = uintBitsToFloat(tiles[ss_active_slot(index) + 1u]);
    const ivec2 pixel = ss_tile_pixel(id / SS_TILE_PIXELS, id % SS_TILE_PIXELS);

    const ss_receiver r = ss_load_receiver(pixel);
    const ss_samples samples = ss_receiver_samples(r, g_hi);
    float band;
    // The square that areas are clipped to becomes [0, 1] x [0, 1].
    const ss_back_projection b = ss_back_project_from(r, ss_biased(r, samples.level, band), 0.5, 0.5 / occ.extent.x);
    const float orientation = determinant(b.matrix) < 0.0 ? -1.0 : 1.0;
    float occlusion = 0.0;
    uint edges = 0u;
    for (uint layer = 0u; layer < ss_layers(); layer++) {
        const float signed_area = orientation * layer_area(layer, samples, b, r, band, edges);
        const float area = signed_area > 0.0 ? min(signed_area, 1.0) : 0.0; // not a number is nothing
        occlusion = SS_MERGE_MAXIMUM ? max(occlusion, area) : min(occlusion + area, 1.0);
    }
    const float visible = max(1.0 - occlusion - r.horizon, 0.0);
    ss_write_visibility(pixel, visible);
    if (SS_SPARSE)
        ss_store_visible(pixel, edges == 0u && r.horizon == 0.0 ? SS_ALL_LIT : visible);
    if (SS_STATS) {
        ss_count(SS_STAT_PRIMITIVES, edges);
        if (samples.clamped)
            ss_count(SS_STAT_CLAMPED, 1u);
    }
}
