#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
// Contours as contour_evaluate has them, but cut where neighbours that occlude are not one surface: each side ends half a step
// beyond its last sample, at its own depth. What is cut apart overlaps on the light; of the area of all contours only the share
// counts that a pattern of samples finds covered, once. docs/numerics.md, section 10. One lane per pixel of the active list.
#include "ss_types.h"
#include "ss_specialization.glsl"
#include "ss_occluder_bindings.glsl"
#include "ss_io_bindings.glsl"
#include "ss_filter_values.glsl"
#include "ss_receiver.glsl"
#include "ss_range.glsl"
#include "ss_kernel.glsl"
#include "ss_sample.glsl"
#include "ss_pattern.glsl"
#include "ss_winding.glsl"
#include "ss_edge.glsl"
#include "ss_packet.glsl"
#include "ss_strip.glsl"
#include "ss_contour.glsl"
#include "ss_folds.glsl"
#include "ss_joint.glsl"

layout(local_size_x = SS_EVALUATE_GROUP) in;
layout(push_constant) uniform ss_push
{
    ss_evaluate_push push;
};

// Cells, their edges and the lines of samples these cross, of all layers: drivers end shaders that run too long, the software
// driver silently after 65,535 rounds of all loops. Depth buffers of noise may have more; what they would hide is not looked at.
const uint MOST_ROUNDS = 40000u;

ss_light_map light_map;
vec3 receiver; // u, v, biased g
float turn;
float area;
uint rounds, edges;
bool any_touches;

// What ss_fill_strip leaves in this array is replaced by the cells to look at.
#define cells_of_row ss_strip_unknown

// Rows with cells that contours run through, or may because they fold.
uint find_cells(ss_folds folds, int x0, int y0, int count, uint columns)
{
    uint rows = 0u;
    for (int j = 0; j < count; j++) {
        const uint below = ss_strip[j], above = ss_strip[j + 1];
        const uint any = below | below >> 1 | above | above >> 1, all = below & below >> 1 & above & above >> 1;
        const uint cells = ((any & ~all) | (all & ss_folds_of_row(folds, x0, y0 + j))) & columns & 0x7fffffffu;
        cells_of_row[j] = cells;
        rows |= uint(cells != 0u) << j;
    }
    return rows;
}

// Which sides of cell x0 + k of row y may be cut, counter-clockwise from the lower one: bits. Those with cells on both sides that
// fold, so that both cells cut alike, also where no contour leads to one of them.
uint may_be_cut(ss_folds folds, int x0, int k, int y)
{
    const uint row = ss_folds_of_row(folds, x0, y), here = row >> k & 1u;
    const uint below = ss_folds_of_row(folds, x0, y - 1) >> k & 1u, above = ss_folds_of_row(folds, x0, y + 1) >> k & 1u;
    const uint right = row >> (k + 1) & 1u, left = row << 1 >> k & 1u;
    return here != 0u ? below | right << 1 | above << 2 | left << 3 : 0u;
}

// Which corners of a cell are joined to the next one, counter-clockwise from the lower left: bits. No loop: it would count as one
// more round for each round of the loop around it, even where there is nothing to do.
uint find_joints(ss_grid grid, ivec2 cell, uint occluding, uint cuts)
{
    const uint joints = occluding & (occluding >> 1 | occluding << 3 & 8u);
    uint cut = 0u;
    [[unroll]] for (int i = 0; i < 4; i++) {
        const ivec2 lower = cell + ivec2(i == 1 ? 1 : 0, i == 2 ? 1 : 0), step = (i & 1) == 0 ? ivec2(1, 0) : ivec2(0, 1);
        cut |= uint(ss_is_cut(grid, receiver, lower, step)) << i;
    }
    return joints & ~(cut & cuts);
}

vec2 project(vec3 at)
{
    return ss_map_to_light(light_map, receiver, at);
}

// Of the square that areas are clipped to, which is the light or of its area.
vec2 to_unit_square(vec2 at)
{
    const float middle = 0.5 * float(SS_SIDE);
    return (at - middle) * (0.5 / (middle * occ.extent.x)) + 0.5;
}

// One cell after the other, one run of joined corners of it after the other, and for the edge that closes the run the lines of
// samples it crosses.
void add_cells(ss_grid grid, ss_folds folds, int x0, int y0, uint rows)
{
    uint cells = 0u, starts = 0u, joints = 0u;
    int row = 0;
    ivec2 cell = ivec2(0);
    ss_crossing crossing = ss_no_crossing();
    while ((rows | cells | starts) != 0u || crossing.line < crossing.end) {
        if (rounds++ >= MOST_ROUNDS)
            return;
        const bool idle = crossing.line >= crossing.end;
        if (idle && starts == 0u) {
            if (cells == 0u) {
                row = findLSB(rows);
                rows &= rows - 1u;
                cells = cells_of_row[row];
            }
            const int k = findLSB(cells);
            cells &= cells - 1u;
            cell = ivec2(x0 + k, y0 + row);
            const uint below = ss_strip[row] >> k & 3u, above = ss_strip[row + 1] >> k & 3u;
            const uint occluding = below | (above & 2u) << 1 | (above & 1u) << 3;
            joints = find_joints(grid, cell, occluding, may_be_cut(folds, x0, k, y0 + row));
            starts = occluding & ~(joints << 1 | joints >> 3);
        }
        if (idle && starts != 0u) {
            const uint first = uint(findLSB(starts));
            starts &= starts - 1u;
            const uint last = first + uint(findLSB(~((joints | joints << 4) >> first))) & 3u;
            const vec2 from = project(ss_contour_point(grid, cell, last, ss_towards_next(last)));
            const vec2 to = project(ss_contour_point(grid, cell, first, -ss_towards_next(first + 3u & 3u)));
            const vec2 p = to_unit_square(from), q = to_unit_square(to);
            area += ss_edge_area(p, q);
            any_touches = any_touches || ss_edge_touches(p, q);
            edges++;
            crossing = ss_winding_edge(from, to);
            crossing.sign *= uint(int(turn));
        }
        if (crossing.line < crossing.end)
            ss_winding_step(crossing);
    }
}

// One strip of samples after the other.
void add_layer(ss_packet packet, uint layer, ss_samples samples)
{
    const int first = samples.lo.x - 1, start = first & ~3;
    const bool in_blocks = SS_HIERARCHY && samples.level + 2u <= occ.levels.x;
    const ss_grid grid = ss_load_grid(layer, samples.level);
    // Blocks of 4 x 4 samples are the texels two levels up.
    const ss_grid blocks = ss_load_grid(layer, min(samples.level + 2u, occ.levels.x));
    const ss_folds folds = ss_load_folds(layer, samples.level);
    int x0 = start, y0 = samples.lo.y - 1, skip = first - start;
    while (x0 + skip <= samples.hi.x) {
        const int count = min(samples.hi.y + 1 - y0, SS_STRIP_ROWS);
        ss_fill_strip(packet, true, grid, blocks, in_blocks, samples.lo, samples.hi, x0, y0, count);
        add_cells(grid, folds, x0, y0, find_cells(folds, x0, y0, count, 0xffffffffu << skip));
        y0 += SS_STRIP_ROWS;
        if (y0 > samples.hi.y) {
            y0 = samples.lo.y - 1;
            x0 += SS_STRIP_STEP;
            skip = SS_STRIP_COLUMNS - SS_STRIP_STEP;
        }
    }
}

void main()
{
    const uint index = (gl_WorkGroupID.y * SS_DISPATCH_WIDTH + gl_WorkGroupID.x) * SS_EVALUATE_GROUP + gl_LocalInvocationIndex;
    if (index >= control.evaluate_args[SS_LISTS * push.round + SS_LIST_PIXELS].w)
        return;
    const uint id = tiles[ss_pixel_slot(index)];
    const float g_hi = uintBitsToFloat(tiles[ss_pixel_slot(index) + 1u]);
    const ivec2 pixel = ss_tile_pixel(id / SS_TILE_PIXELS, id % SS_TILE_PIXELS);

    const ss_receiver r = ss_load_receiver(pixel);
    const ss_samples samples = ss_evaluated_samples(r, g_hi);
    const float half_side = 0.5 * float(SS_SIDE);
    float band;
    receiver = vec3(r.uv, ss_biased(r, samples.level, band));
    light_map = ss_to_light(half_side, half_side);
    turn = ss_turn(light_map);
    ss_packet packet;
    ss_packet_begin(r.uv, r.gradient, r.side, r.eta, packet);
    ss_packet_add(packet, r.uv, receiver.z, r.side * r.g + band, r.gradient, r.drift);
    float occlusion = 0.0;
    rounds = edges = 0u;
    any_touches = false;
    ss_covered_clear();
    for (uint layer = 0u; layer < ss_layers(); layer++) {
        area = 0.0;
        ss_winding_clear(SS_WINDING_SIGNED);
        add_layer(packet, layer, samples);
        const float signed_area = turn * area;
        // What contours cover, over how often they do; a layer that is added counts where no other one has covered.
        const uvec2 covered = ss_winding_cover(!SS_MERGE_MAXIMUM);
        const float share = covered.y > 0u ? float(covered.x) / float(covered.y) : 1.0;
        const float hidden = signed_area * share > 0.0 ? min(signed_area * share, 1.0) : 0.0; // not a number is nothing
        occlusion = SS_MERGE_MAXIMUM ? max(occlusion, hidden) : min(occlusion + hidden, 1.0);
    }
    const float visible = max(1.0 - occlusion - r.horizon, 0.0);
    const bool between = any_touches || r.horizon > 0.0;
    ss_write_visibility(pixel, visible);
    if (SS_SPARSE)
        ss_store_visible(pixel, between ? visible : visible > 0.5 ? SS_ALL_LIT : SS_ALL_DARK);
    if (SS_STATS) {
        ss_count(SS_STAT_PRIMITIVES, edges);
        ss_count(SS_STAT_EDGES, edges);
        ss_count(SS_STAT_VISITED, ss_visited);
        ss_count(SS_STAT_CLAMPED, samples.clamped ? 1u : 0u);
        ss_count(SS_STAT_REFINED, samples.refined ? 1u : 0u);
    }
}
