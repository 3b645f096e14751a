// The walk down a dual grid (Yang et al. 2009, section 4.2): from the node that spans the kernel to the cells that no node rules
// out, and which of the samples around them occlude. docs/numerics.md, section 10. Departures: a round of the loop asks four
// children at once, so that the node it starts with is not asked; and the stack is four bits a level, those of a node's children
// that wait.
// Needs the packet, the contour and the dual grid.
#ifndef SS_WALK_GLSL
#define SS_WALK_GLSL

const uint SS_PATCHES = 32u; // looked for in one go: bits of a word

// Nodes of level 1 with cells that are left: the first cell, x and y in 16 bits each; and bits of the nine samples around its
// four cells, 3 y + x, of those that occlude all receivers, and from bit 16 on of those that may occlude some and not others.
uint ss_patch[SS_PATCHES], ss_patch_samples[SS_PATCHES];

struct ss_walk
{
    ivec2 start, at; // cells; of the last node seen, from there
    uvec2 waiting;   // four bits a level
};

// Cells lo to hi + 1 are those around samples lo to hi. The node begins with the first one, as far as nodes do: it is aligned up
// to the join, and to that above.
ss_walk ss_begin_walk(uint level, ivec2 lo, ivec2 hi)
{
    const ivec2 differ = lo ^ (hi + 1);
    const int aligned = findMSB(differ.x | differ.y) + 1, join = int(max(occ.levels.y, level) - level);
    ss_walk w;
    w.start = lo & -(1 << min(aligned, join));
    const ivec2 cells = hi + 1 - w.start;
    const uint slot = 4u * uint(findMSB(max(cells.x, cells.y)) + 1), bit = 1u << (slot & 31u);
    w.at = ivec2(0);
    w.waiting = slot < 32u ? uvec2(bit, 0u) : uvec2(0u, bit);
    return w;
}

// Bits of the nodes at `cell` and `side` cells farther on each axis that hold cells around samples lo to hi, and of those of them
// whose cells contours may run through.
void ss_ask_nodes(ss_packet p, ss_nodes nodes, uint level, ivec2 cell, int side, ivec2 lo, ivec2 hi, out uint held,
                  out uint mixed)
{
    const float half_side = 0.5 * float(side << level);
    held = mixed = 0u;
    [[unroll]] for (int i = 0; i < 4; i++) {
        const ivec2 at = cell + ivec2(i & 1, i >> 1) * side;
        const bool holds = all(lessThanEqual(at, hi + 1)) && all(greaterThan(at + side, lo));
        const bool inside = all(greaterThan(at, lo)) && all(lessThanEqual(at + side, hi + 1)); // all of its samples
        bool every, none;
        const vec2 range = ss_range_at(ss_node_at(nodes, at));
        ss_block_status(p, range, ss_sample_place(at - 1, level) + half_side, half_side, every, none);
        const bool pruned = SS_HIERARCHY && (none || (every && inside));
        held |= uint(holds) << i;
        mixed |= uint(holds && !pruned) << i;
    }
}

// Goes on until there is no room for more patches, or nothing is left to see. Returns how many there are.
uint ss_find_patches(ss_packet p, uint layer, uint level, ivec2 lo, ivec2 hi, inout ss_walk w)
{
    uint count = 0u;
    while ((w.waiting.x | w.waiting.y) != 0u && count < SS_PATCHES) {
        // The lowest level first.
        const bool low = w.waiting.x != 0u;
        const uint slot = uint(findLSB(low ? w.waiting.x : w.waiting.y)) + (low ? 0u : 32u), node_level = slot >> 2;
        w.waiting = low ? uvec2(w.waiting.x & w.waiting.x - 1u, w.waiting.y) : uvec2(0u, w.waiting.y & w.waiting.y - 1u);
        w.at = (w.at & -(2 << node_level)) | ivec2(slot & 1u, slot >> 1 & 1u) << node_level;
        const uint below = node_level - 1u;
        const ivec2 cell = w.start + w.at;
        uint held, mixed;
        ss_ask_nodes(p, ss_load_nodes(layer, level, below), level, cell, 1 << below, lo, hi, held, mixed);
        ss_visited += below == 0u ? uint(bitCount(held)) : 4u;
        const uint push = below == 0u ? 0u : mixed << (4u * below & 31u);
        w.waiting |= below < 8u ? uvec2(push, 0u) : uvec2(0u, push);
        if (below == 0u && mixed != 0u) {
            ss_patch[count] = uint(cell.x) | uint(cell.y) << 16;
            count++;
        }
    }
    return count;
}

ivec2 ss_patch_sample(uint k, int bit)
{
    const uint cell = ss_patch[k];
    return ivec2(cell & 0xffffu, cell >> 16) - 1 + ivec2(bit % 3, bit / 3);
}

// Fills the patches in with those of samples lo to hi. Returns which of them hold unknown ones.
uint ss_fill_patches(ss_packet p, bool one, ss_grid grid, ivec2 lo, ivec2 hi, uint count)
{
    const ivec2 last_texel = ivec2(occ.size.xy) - 1;
    uint unknown_patches = 0u;
    for (uint k = 0u; k < count; k++) {
        const ivec2 first = ss_patch_sample(k, 0);
        // Three of a row, the last one twice.
        const ivec4 x = first.x + ivec4(0, 1, 2, 2), from = clamp(x, ivec4(0), ivec4(grid.last.x));
        const float after = ss_sample_axis(x.z, grid.level, last_texel.x);
        const vec4 u = vec4(ss_sample_axis(x.x, grid.level, last_texel.x), ss_sample_axis(x.y, grid.level, last_texel.x), after,
                            after);
        const uint columns = ss_bits(greaterThanEqual(x, ivec4(lo.x))) & ss_bits(lessThanEqual(x, ivec4(hi.x))) & 7u;
        uint bits = 0u;
        [[unroll]] for (int j = 0; j < 3; j++) {
            const int y = first.y + j;
            const uint wanted = y >= lo.y && y <= hi.y ? columns : 0u;
            const uint base = grid.depths + uint(clamp(y, 0, grid.last.y)) * grid.row;
            const float g = ss_depth_at(base + uint(from.z));
            uint every, some;
            ss_quad_status(p, ss_begin_row(p, ss_sample_axis(y, grid.level, last_texel.y), one), u,
                           vec4(ss_depth_at(base + uint(from.x)), ss_depth_at(base + uint(from.y)), g, g), one, every, some);
            bits |= (every & wanted | (some & wanted) << 16) << (3 * j);
        }
        ss_patch_samples[k] = bits;
        unknown_patches |= uint(bits >> 16 != 0u) << k;
    }
    return unknown_patches;
}

// The cells of a patch that contours run through.
ss_contour_cells ss_begin_patch(uint k)
{
    const uint bits = ss_patch_samples[k];
    return ss_begin_cells(bits, bits >> 3, 0x1bu);
}

#endif
