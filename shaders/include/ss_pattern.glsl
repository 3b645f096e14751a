// Sample patterns on the light as bit rows: docs/numerics.md, section 4. The mask has SS_PATTERN_SIDE rows of as many bits,
// 32 / side rows to a word.
#ifndef SS_PATTERN_GLSL
#define SS_PATTERN_GLSL

const int SS_SIDE = SS_PATTERN_SIDE > 0 ? SS_PATTERN_SIDE : 8;
const int SS_ROWS_PER_WORD = 32 / SS_SIDE;
const int SS_WORDS = SS_SIDE * SS_SIDE / 32;
// In the jittered pattern the samples of a row lie at two heights, by the parity of their column: twice as many lines.
const int SS_LINES = SS_JITTERED ? 2 * SS_SIDE : SS_SIDE;
const uint SS_ROW_BITS = SS_SIDE == 32 ? 0xffffffffu : (1u << SS_SIDE) - 1u;

uint ss_mask[SS_WORDS];

float ss_line_height(int line)
{
    return (float(line) + 0.5) * (float(SS_SIDE) / float(SS_LINES));
}

int ss_line_row(int line)
{
    return SS_JITTERED ? line >> 1 : line;
}

// The columns that have their samples on this line.
uint ss_line_columns(int line)
{
    return !SS_JITTERED ? SS_ROW_BITS : (line & 1) == 0 ? 0x5555u & SS_ROW_BITS : 0xaaaau & SS_ROW_BITS;
}

float ss_row_offset(int row)
{
    return !SS_JITTERED ? 0.5 : (row & 1) == 0 ? 0.75 : 0.25;
}

// Bits of the columns whose samples in this row lie left of x: i + offset < x.
uint ss_columns_before(float x, int row)
{
    const int n = int(clamp(ceil(x - ss_row_offset(row)), 0.0, float(SS_SIDE)));
    return n >= 32 ? 0xffffffffu : (1u << n) - 1u;
}

// First line at or above a height.
int ss_line_from(float y)
{
    return int(clamp(ceil(y * (float(SS_LINES) / float(SS_SIDE)) - 0.5), 0.0, float(SS_LINES)));
}

void ss_mask_clear()
{
    for (int i = 0; i < SS_WORDS; i++)
        ss_mask[i] = 0u;
}

void ss_mask_set(int line, uint columns)
{
    const int row = ss_line_row(line);
    ss_mask[row / SS_ROWS_PER_WORD] |= (columns & ss_line_columns(line)) << ((row % SS_ROWS_PER_WORD) * SS_SIDE);
}

const int SS_LINES_PER_WORD = SS_LINES / SS_WORDS;

// Bits of a word's first n lines, n less than SS_LINES_PER_WORD.
uint ss_lines_before(int n)
{
    if (!SS_JITTERED)
        return (1u << (n * SS_SIDE)) - 1u;
    return n == 0 ? 0u : n == 1 ? 0x00005555u : n == 2 ? 0x0000ffffu : 0x5555ffffu;
}

// Lines from to to - 1; `columns` has the bits of a whole word of full rows. Every word is updated, in registers: cheaper
// than finding the few that change in an array that is indexed at run time.
void ss_mask_set_lines(int from, int to, uint columns)
{
    const int first = from / SS_LINES_PER_WORD, last = to / SS_LINES_PER_WORD;
    const uint skipped = ss_lines_before(from % SS_LINES_PER_WORD), partial = ss_lines_before(to % SS_LINES_PER_WORD);
    for (int i = 0; i < SS_WORDS; i++) {
        // All ones below the word a count ends in, that word's own part, nothing above.
        const uint before_to = uint((i - last) >> 31) | (i == last ? partial : 0u);
        const uint before_from = uint((i - first) >> 31) | (i == first ? skipped : 0u);
        ss_mask[i] |= columns & before_to & ~before_from;
    }
}

// The bits of a row repeated through a word: `even` and `odd` are those of even and odd rows.
uint ss_repeat_rows(uint even, uint odd)
{
    if (SS_SIDE == 32)
        return even;
    if (SS_SIDE == 16)
        return even | odd << 16;
    return (even | odd << 8) * 0x00010001u;
}

// The samples inside the unit disc, for the lines of one mask word.
uint ss_disc_word(int word)
{
    uint bits = 0u;
    for (int i = 0; i < SS_LINES_PER_WORD; i++) {
        const int line = word * SS_LINES_PER_WORD + i, row = ss_line_row(line);
        const float y = ss_line_height(line) * (2.0 / float(SS_SIDE)) - 1.0;
        const float half_width = 0.5 * float(SS_SIDE) * sqrt(max(1.0 - y * y, 0.0)), middle = 0.5 * float(SS_SIDE);
        const uint columns = ss_columns_before(middle + half_width, row) & ~ss_columns_before(middle - half_width, row);
        bits |= (columns & ss_line_columns(line)) << ((row % SS_ROWS_PER_WORD) * SS_SIDE);
    }
    return bits;
}

// Occluded samples of those that count, over their number.
float ss_mask_occlusion(bool disc)
{
    uint set = 0u, all = 0u;
    for (int i = 0; i < SS_WORDS; i++) {
        const uint counted = disc ? ss_disc_word(i) : 0xffffffffu;
        set += uint(bitCount(ss_mask[i] & counted));
        all += uint(bitCount(counted));
    }
    return float(set) / float(all);
}

#endif
