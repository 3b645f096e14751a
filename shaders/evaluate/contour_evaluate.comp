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
#include "ss_contour.glsl"

layout(local_size_x = SS_EVALUATE_GROUP) in;
layout(push_constant) uniform ss_push
{
    ss_evaluate_push push;
};
#include "ss_receivers.glsl"
#include "ss_strip.glsl"
#include "ss_dual_grid.glsl"
#include "ss_walk.glsl"
#include "ss_folds.glsl"
#include "ss_backs.glsl"

const uint LIST = ALONE ? SS_LIST_PIXELS : SS_PACKET == 2 ? SS_LIST_SMALL : SS_LIST_LARGE;

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
        ss_strip[row] |= uint(ss_resolve_sample(grid, ivec2(x0 + k, y0 + row))) << k;
    }
}

// Edges of the strip's contours to the receivers' areas.
void add_contours(ss_grid grid, int x0, int y0, uint rows, uint columns)
{
    ss_contour_cells cells;
    int row = 0;
    cells.todo = 0u;
    while (rows != 0u || cells.todo != 0u) {
        if (cells.todo == 0u) {
            row = findLSB(rows);
            cells = ss_begin_cells(ss_strip[row], ss_strip[row + 1], columns);
            rows &= rows - 1u;
        }
        const bool any = cells.todo != 0u;
        uint corners;
        const int k = ss_next_cell(cells, corners);
        ss_add_edge(grid, ivec2(x0 + k, y0 + row), corners, any);
    }
}

// One strip of one layer's samples after the other.
void search_strips()
{
    const int first = samples.lo.x - 1, start = first & ~3;
    const bool in_blocks = SS_HIERARCHY && samples.level + 2u <= occ.levels.x;
    ss_grid grid = ss_load_grid(0u, samples.level);
    // Blocks of 4 x 4 samples are the texels two levels up.
    ss_grid blocks = ss_load_grid(0u, min(samples.level + 2u, occ.levels.x));
    uint layer = 0u;
    int x0 = start, y0 = samples.lo.y - 1, skip = first - start;
    while (layer < ss_layers() && together != 0u && !diverged) {
        const int count = min(samples.hi.y + 1 - y0, SS_STRIP_ROWS);
        const uint unknown_rows = ss_fill_strip(packet, ALONE, grid, blocks, in_blocks, samples.lo, samples.hi, x0, y0, count);
        if (!ALONE)
            resolve_strip(grid, x0, y0, unknown_rows);
        const uint columns = 0x7fffffffu & (0xffffffffu << skip);
        uint full_rows;
        const uint contour_rows = ss_contour_rows(diverged ? 0 : count, full_rows);
        add_contours(grid, x0, y0, contour_rows, columns);
        if (BACKS) {
            // What an earlier layer loses the next one sees.
            const uint rows = layer + 1u < ss_layers() ? 0u : full_rows;
            const uint back_rows = ss_find_backs(grid, ss_load_folds(layer, samples.level), x0, y0, rows, columns);
            const bool done = ss_add_backs(grid, x0, y0, back_rows, ss_most_back_rounds());
            diverged = diverged || (!ALONE && !done);
        }
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
            ss_end_layer();
        }
    }
}

// The same for patches of four cells between nine samples, a bit for each.
void resolve_patches(ss_grid grid, uint unknown_patches)
{
    uint at = 0u, todo = 0u;
    while ((todo != 0u || unknown_patches != 0u) && !diverged) {
        if (todo == 0u) {
            at = uint(findLSB(unknown_patches));
            todo = ss_patch_samples[at] >> 16;
            unknown_patches &= unknown_patches - 1u;
        }
        const int k = findLSB(todo);
        todo &= todo - 1u;
        ss_patch_samples[at] |= uint(ss_resolve_sample(grid, ss_patch_sample(at, k))) << k;
    }
}

void add_patches(ss_grid grid, uint count)
{
    ss_contour_cells cells;
    uint next = 0u;
    cells.todo = 0u;
    while (next < count || cells.todo != 0u) {
        if (cells.todo == 0u) {
            cells = ss_begin_patch(next);
            next++;
        }
        const bool any = cells.todo != 0u;
        uint corners;
        const int k = ss_next_cell(cells, corners);
        ss_add_edge(grid, ss_patch_sample(next - 1u, k), corners, any);
    }
}

// As many patches at a time as there is room for, of one layer after the other.
void search_by_walk()
{
    ss_grid grid = ss_load_grid(0u, samples.level);
    const ss_walk begin = ss_begin_walk(samples.level, samples.lo, samples.hi);
    ss_walk walk = begin;
    uint layer = 0u;
    ss_visited += uint(together != 0u); // the node it begins with
    while (layer < ss_layers() && together != 0u && !diverged) {
        const uint count = ss_find_patches(packet, layer, samples.level, samples.lo, samples.hi, walk);
        const uint unknown_patches = ss_fill_patches(packet, ALONE, grid, samples.lo, samples.hi, count);
        if (!ALONE)
            resolve_patches(grid, unknown_patches);
        add_patches(grid, diverged ? 0u : count);
        if ((walk.waiting.x | walk.waiting.y) == 0u) {
            walk = begin;
            layer++;
            ss_visited += uint(layer < ss_layers());
            grid.depths += 4u * occ.strides.x;
            ss_end_layer();
        }
    }
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
            const ivec2 at = ss_offset_of(findLSB(todo));
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
    uint apart = ss_load_packet(corner, mask, g_hi);
    const bool incoherent = apart != 0u;
    edges = 0u;
    touched = 0u;
    resolved = 0u;
    diverged = false;
    [[unroll]] for (int i = 0; i < N; i++)
        area[i] = backs[i] = occlusion[i] = 0.0;
    if (SS_WALK)
        search_by_walk();
    else
        search_strips();
    const uint done = diverged ? 0u : together;
    apart |= together & ~done;
    for (uint todo = done; todo != 0u; todo &= todo - 1u) {
        const int i = findLSB(todo);
        const ivec2 pixel = corner + ss_offset_of(i);
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
