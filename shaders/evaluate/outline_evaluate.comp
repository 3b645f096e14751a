#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
// What bitmask_evaluate makes of microquads, at the cost of contours: quads that cannot fold by the outline of all of them
// together, whose winding number tells which light samples they hide; quads that may fold one by one. docs/numerics.md,
// section 10. One lane per pixel of the active list.
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
#include "ss_primitive.glsl"
#include "ss_winding.glsl"
#include "ss_edge.glsl"
#include "ss_packet.glsl"
#include "ss_strip.glsl"
#include "ss_folds.glsl"

layout(local_size_x = SS_EVALUATE_GROUP) in;
layout(push_constant) uniform ss_push
{
    ss_evaluate_push push;
};

// Edges and lines of samples they cross, of all layers: drivers end shaders that run too long, the software driver silently after
// 65,535 rounds of all loops. Depth buffers of noise may have more; what they would hide is not looked at.
const uint MOST_ROUNDS = 40000u;

ss_light_map light_map;
vec3 receiver; // u, v, biased g
float outline_area, bridge_area;
uint rounds, edges, bridges;
bool any_occludes; // any sample of the kernel

// What ss_fill_strip leaves in its arrays is replaced by these, row by row of cells.
#define smooth_quads ss_strip
#define bridge_quads ss_strip_unknown

// From samples to quads: the rows that outlines run through, and those with bridges. `below` is the row of smooth quads under the
// strip and becomes the last one in it.
void find_quads(ss_folds folds, int x0, int y0, int count, uint columns, inout uint below, out uint outlines,
                out uint bridged)
{
    uint before = below;
    outlines = bridged = 0u;
    for (int j = 0; j < count; j++) {
        const uint row = ss_strip[j] & ss_strip[j + 1], quads = row & row >> 1 & 0x7fffffffu;
        const uint fold = ss_folds_of_row(folds, x0, y0 + j);
        const uint smooth_row = quads & ~fold;
        bridge_quads[j] = quads & fold & columns;
        const uint sides = (smooth_row ^ before | smooth_row ^ smooth_row << 1) & columns;
        outlines |= uint(sides != 0u) << j;
        bridged |= uint((quads & fold & columns) != 0u) << j;
        any_occludes = any_occludes || (ss_strip[j] | ss_strip[j + 1]) != 0u;
        smooth_quads[j] = smooth_row;
        before = smooth_row;
    }
    below = before;
}

vec2 project(ss_grid grid, ivec2 at)
{
    return ss_map_to_light(light_map, receiver, vec3(ss_sample_place(at, grid.level), ss_sample_depth(grid, at)));
}

// Of the square that areas are clipped to, which is the light or of its area.
float edge_area(vec2 from, vec2 to)
{
    const float middle = 0.5 * float(SS_SIDE), scale = 0.5 / (middle * occ.extent.x);
    return ss_edge_area((from - middle) * scale + 0.5, (to - middle) * scale + 0.5);
}

// Sides between smooth quads and others, one after the other, and for each the lines of samples it crosses.
void add_outline(ss_grid grid, int x0, int y0, uint rows, uint columns, uint below)
{
    uint across = 0u, along = 0u;
    uint smooth_row = 0u, smooth_below = 0u;
    int row = 0;
    ss_crossing crossing = ss_no_crossing();
    while ((rows != 0u || (across | along) != 0u || crossing.line < crossing.end) && rounds < MOST_ROUNDS) {
        rounds++;
        const bool idle = crossing.line >= crossing.end;
        if ((across | along) == 0u && idle) {
            row = findLSB(rows);
            rows &= rows - 1u;
            smooth_row = smooth_quads[row];
            smooth_below = row == 0 ? below : smooth_quads[max(row - 1, 0)];
            across = (smooth_row ^ smooth_below) & columns;
            along = (smooth_row ^ smooth_row << 1) & columns;
        }
        if (idle) {
            const bool is_across = across != 0u;
            const int k = findLSB(is_across ? across : along);
            across &= across - uint(is_across);
            along &= is_across ? along : along - 1u;
            // The quad lies to the left of the edge: u to the right, v up.
            const bool inside = (smooth_row >> k & 1u) != 0u;
            const ivec2 at = ivec2(x0 + k, y0 + row), step = is_across ? ivec2(1, 0) : ivec2(0, 1);
            const vec2 a = project(grid, at), b = project(grid, at + step);
            const bool forward = inside == is_across;
            const vec2 from = forward ? a : b, to = forward ? b : a;
            edges++;
            if (SS_AREA)
                outline_area += edge_area(from, to);
            if (SS_PATTERN_SIDE != 0)
                crossing = ss_winding_edge(from, to);
        }
        if (SS_PATTERN_SIDE != 0 && crossing.line < crossing.end)
            ss_winding_step(crossing);
    }
}

// One loop, not one in another: some drivers run the body of a loop once though it has nothing to do.
void add_bridges(ss_grid grid, int x0, int y0, uint rows)
{
    uint todo = 0u;
    int row = 0;
    while ((rows | todo) != 0u && rounds < MOST_ROUNDS) {
        if (todo == 0u) {
            row = findLSB(rows);
            rows &= rows - 1u;
            todo = bridge_quads[row];
        }
        const ivec2 at = ivec2(x0 + findLSB(todo), y0 + row);
        todo &= todo - 1u;
        const vec2 a = project(grid, at), b = project(grid, at + ivec2(1, 0)), c = project(grid, at + 1),
                   d = project(grid, at + ivec2(0, 1));
        if (SS_PATTERN_SIDE != 0)
            ss_add_quad(a, b, c, d);
        else
            bridge_area += abs(edge_area(a, b) + edge_area(b, c) + edge_area(c, d) + edge_area(d, a));
        rounds++;
        bridges++;
    }
}

// One strip of samples after the other.
void add_layer(ss_packet packet, uint layer, ss_samples samples)
{
    const int start = samples.lo.x & ~3;
    const bool in_blocks = SS_HIERARCHY && samples.level + 2u <= occ.levels.x;
    const ss_grid grid = ss_load_grid(layer, samples.level);
    // Blocks of 4 x 4 samples are the texels two levels up.
    const ss_grid blocks = ss_load_grid(layer, min(samples.level + 2u, occ.levels.x));
    const ss_folds folds = ss_load_folds(layer, samples.level);
    int x0 = start, y0 = samples.lo.y, skip = samples.lo.x - start;
    uint below = 0u;
    while (x0 + skip <= samples.hi.x && samples.lo.y <= samples.hi.y) {
        const int count = min(samples.hi.y + 1 - y0, SS_STRIP_ROWS);
        const uint columns = 0x7fffffffu & (0xffffffffu << skip), under = below;
        ss_fill_strip(packet, true, grid, blocks, in_blocks, samples.lo, samples.hi, x0, y0, count);
        uint outlines, bridged;
        find_quads(folds, x0, y0, count, columns, below, outlines, bridged);
        add_outline(grid, x0, y0, outlines, columns, under);
        add_bridges(grid, x0, y0, bridged);
        y0 += SS_STRIP_ROWS;
        if (y0 > samples.hi.y) {
            y0 = samples.lo.y;
            x0 += SS_STRIP_STEP;
            skip = SS_STRIP_COLUMNS - SS_STRIP_STEP;
            below = 0u;
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
    ss_packet packet;
    ss_packet_begin(r.uv, r.gradient, r.side, r.eta, packet);
    ss_packet_add(packet, r.uv, receiver.z, r.side * r.g + band, r.gradient, r.drift);
    const bool disc = (ss_flags & SS_FLAG_DISC) != 0u;
    const float turn = ss_turn(light_map);
    float mask_occlusion = 0.0, area_occlusion = 0.0;
    any_occludes = false;
    rounds = edges = bridges = 0u;
    ss_mask_clear();
    ss_winding_clear(0u);
    outline_area = bridge_area = 0.0;
    for (uint layer = 0u; layer < ss_layers(); layer++) {
        add_layer(packet, layer, samples);
        if (SS_PATTERN_SIDE != 0) {
            ss_winding_to_mask(int(turn));
            ss_winding_clear(0u);
        }
        if (SS_MERGE_MAXIMUM || layer + 1u == ss_layers()) {
            if (SS_PATTERN_SIDE != 0)
                mask_occlusion = max(mask_occlusion, ss_mask_occlusion(disc));
            const float outlines = turn * outline_area;
            area_occlusion = max(area_occlusion, (outlines > 0.0 ? outlines : 0.0) + (bridge_area > 0.0 ? bridge_area : 0.0));
            ss_mask_clear();
            outline_area = bridge_area = 0.0;
        }
    }
    const float occlusion = min((SS_PATTERN_SIDE != 0 ? mask_occlusion : area_occlusion) + r.horizon, 1.0);
    ss_write_visibility(pixel, 1.0 - occlusion);
    if (SS_SPARSE)
        ss_store_visible(pixel, any_occludes || r.horizon > 0.0 ? 1.0 - occlusion : SS_ALL_LIT);
    if (SS_STATS) {
        ss_count(SS_STAT_PRIMITIVES, edges + bridges);
        ss_count(SS_STAT_EDGES, edges);
        ss_count(SS_STAT_VISITED, ss_visited);
        ss_count(SS_STAT_CLAMPED, samples.clamped ? 1u : 0u);
        ss_count(SS_STAT_REFINED, samples.refined ? 1u : 0u);
    }
}
