// Which samples of a part of the kernel occlude, as bits: 32 columns, 32 rows. Blocks of 4 x 4 samples are asked for their depth
// range first; what that leaves open is looked at four samples at a time.
// Needs the packet.
#ifndef SS_STRIP_GLSL
#define SS_STRIP_GLSL

const int SS_STRIP_ROWS = 31;    // of cells, between 32 rows of samples
const int SS_STRIP_COLUMNS = 31; // likewise
const int SS_STRIP_STEP = 28;    // from strip to strip: quads of samples begin at multiples of four

uint ss_strip[SS_STRIP_ROWS + 1];         // bits of samples x0 to x0 + 31, row by row: those that occlude all receivers
uint ss_strip_unknown[SS_STRIP_ROWS + 1]; // those that may occlude some and not others

// Bit i of 8 to bits 4 i to 4 i + 3.
uint ss_spread_bits(uint bits)
{
    uint b = (bits | bits << 12) & 0x000f000fu;
    b = (b | b << 6) & 0x03030303u;
    b = (b | b << 3) & 0x11111111u;
    return b * 15u;
}

// The samples around x0 to x0 + 31 whose block is known to occlude all receivers, or is not known, a bit for each of 8 blocks.
struct ss_strip_blocks
{
    uint full, mixed;
};

// Blocks `first` to end - 1 of a row; `blocks` is the grid of them, `texels` their side.
ss_strip_blocks ss_test_blocks(ss_packet p, ss_grid blocks, ivec2 at, int first, int end, int texels)
{
    ss_strip_blocks b;
    b.full = b.mixed = 0u;
    const float half_side = 0.5 * float(texels - 1);
    for (int i = first; i < end; i++) {
        const ivec2 here = clamp(at + ivec2(i, 0), ivec2(0), blocks.last);
        const vec2 range = ss_range_at(blocks.ranges + uint(here.y * (blocks.last.x + 1) + here.x));
        bool every, none;
        ss_block_status(p, range, (vec2(here) + 0.5) * float(texels), half_side, every, none);
        b.full |= uint(every) << i;
        b.mixed |= uint(!(every || none)) << i;
    }
    return b;
}

// Fills the strips' rows 0 to `count` with samples (x0, y0) and on, of those from `lo` to `hi`. x0 is a multiple of four. Returns
// which rows hold unknown ones.
uint ss_fill_strip(ss_packet p, bool one, ss_grid grid, ss_grid blocks, bool in_blocks, ivec2 lo, ivec2 hi, int x0, int y0,
                   int count)
{
    const int spacing = 1 << int(grid.level);
    const ivec2 last_texel = ivec2(occ.size.xy) - 1;
    const int first_x = max(lo.x - x0, 0), last_x = min(hi.x - x0, 31);
    const uint columns = (0xffffffffu >> (31 - last_x)) & (0xffffffffu << first_x);
    const int first_quad = first_x >> 2, end_quad = (last_x >> 2) + 1;
    const uint quads = ((1u << end_quad) - 1u) & ~((1u << first_quad) - 1u);
    uint unknown_rows = 0u;
    for (int block_y = y0 >> 2; 4 * block_y <= y0 + count; block_y++) {
        // A row of blocks, then its four rows of samples side by side: on the software driver rounds of loops cost more than rows
        // that need not be looked at.
        const int first_y = 4 * block_y, first = max(first_y, max(lo.y, y0)), last = min(first_y + 3, min(hi.y, y0 + count));
        const int end_block = in_blocks && first <= last ? end_quad : first_quad;
        ss_strip_blocks b = ss_test_blocks(p, blocks, ivec2(x0 >> 2, block_y), first_quad, end_block, 4 * spacing);
        ss_visited += uint(end_block - first_quad);
        b.mixed = in_blocks ? b.mixed & quads : first <= last ? quads : 0u;
        ss_visited += uint(max(last - first + 1, 0) * 4 * bitCount(b.mixed));
        ss_row row[4];
        uint base[4], bits[4], unknown[4];
        [[unroll]] for (int i = 0; i < 4; i++) {
            const int y = clamp(first_y + i, 0, grid.last.y);
            row[i] = ss_begin_row(p, ss_sample_axis(first_y + i, grid.level, last_texel.y), one);
            base[i] = (grid.depths + uint(y) * grid.row) / 4u;
            bits[i] = ss_spread_bits(b.full);
            unknown[i] = 0u;
        }
        for (uint todo = b.mixed; todo != 0u; todo &= todo - 1u) {
            const int q = findLSB(todo), x = x0 + 4 * q;
            const vec4 at = vec4(x) + vec4(0.0, 1.0, 2.0, 3.0);
            const vec4 u = SS_SAMPLED ? min(at * float(spacing) + float(spacing >> 1), vec4(last_texel.x)) + 0.5
                                      : (at + 0.5) * float(spacing);
            [[unroll]] for (int i = 0; i < 4; i++) {
                vec4 g;
                if (SS_SAMPLED) {
                    g = ss_depth_quad_at(base[i] + uint(x) / 4u);
                } else {
                    for (int k = 0; k < 4; k++)
                        g[k] = ss_sample_depth(grid, ivec2(x + k, clamp(first_y + i, 0, grid.last.y)));
                }
                uint every, some;
                ss_quad_status(p, row[i], u, g, one, every, some);
                bits[i] |= every << (4 * q);
                unknown[i] |= some << (4 * q);
            }
        }
        [[unroll]] for (int i = 0; i < 4; i++) {
            const int y = first_y + i, j = y - y0;
            const bool inside = y >= first && y <= last;
            if (j >= 0 && j <= count) {
                ss_strip[j] = inside ? bits[i] & columns : 0u;
                ss_strip_unknown[j] = inside ? unknown[i] & columns : 0u;
                unknown_rows |= uint(inside && (unknown[i] & columns) != 0u) << j;
            }
        }
    }
    return unknown_rows;
}

// Of `count` rows of cells, of 31 columns: those that the contour runs through, and those with cells all of whose corners occlude.
uint ss_contour_rows(int count, out uint full_rows)
{
    uint rows = 0u, below = ss_strip[0];
    full_rows = 0u;
    for (int j = 1; j <= count; j++) {
        const uint above = ss_strip[j];
        const uint any = below | below >> 1 | above | above >> 1, all = below & below >> 1 & above & above >> 1;
        rows |= (any & ~all & 0x7fffffffu) != 0u ? 1u << (j - 1) : 0u;
        full_rows |= (all & 0x7fffffffu) != 0u ? 1u << (j - 1) : 0u;
        below = above;
    }
    return rows;
}

#endif
