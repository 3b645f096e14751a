// Winding numbers of all samples of a pattern, four bits each: docs/numerics.md, sections 4 and 10. Sums modulo 2^32 of whole words
// are exact as long as the numbers that come out in the end fit, whatever they were in between.
// Needs the pattern, of 8 x 8 or 16 x 16 samples.
#ifndef SS_WINDING_GLSL
#define SS_WINDING_GLSL

// Lines of eight samples: rows of 8 x 8, the even and the odd columns of a row of 16 x 16, one after the other.
const int SS_WINDING_LINES = SS_SIDE == 8 ? 8 : 32;
const int SS_WINDING_STEP = SS_SIDE == 8 ? 1 : 2;

uint ss_winding[SS_WINDING_LINES];

// `zero` stands for 0 from there on: 0 for numbers from 0 to 15, SS_WINDING_SIGNED for -2 to 13.
void ss_winding_clear(uint zero)
{
    for (int i = 0; i < SS_WINDING_LINES; i++)
        ss_winding[i] = zero;
}

const uint SS_WINDING_SIGNED = 0x22222222u;

float ss_winding_height(int line)
{
    return SS_JITTERED ? 0.5 * (float(line) + 0.5) : float(line / SS_WINDING_STEP) + 0.5;
}

// First line at or above a height.
int ss_winding_from(float y)
{
    const float line = SS_JITTERED ? ceil(2.0 * y - 0.5) : float(SS_WINDING_STEP) * ceil(y - 0.5);
    return int(clamp(line, 0.0, float(SS_WINDING_LINES)));
}

// Samples of a line left of x: by `sign` more.
void ss_winding_add(int line, float x, uint sign)
{
    const int parity = SS_WINDING_STEP == 2 ? line & 1 : 0, row = line / SS_WINDING_STEP;
    const float columns = ceil((x - ss_row_offset(row) - float(parity)) * (1.0 / float(SS_WINDING_STEP)));
    const int n = int(clamp(columns, 0.0, 8.0));
    const uint ones = n == 8 ? 0x11111111u : 0x11111111u & ((1u << (4 * n)) - 1u);
    ss_winding[line] += ones * sign;
}

// The lines of samples that an edge has yet to cross.
struct ss_crossing
{
    int line, end;
    vec2 low;
    float slope;
    uint sign;
};

ss_crossing ss_no_crossing()
{
    return ss_crossing(0, 0, vec2(0.0), 0.0, 0u);
}

ss_crossing ss_winding_edge(vec2 from, vec2 to)
{
    const bool rises = from.y <= to.y;
    const vec2 high = rises ? to : from;
    ss_crossing c;
    c.low = rises ? from : to;
    c.sign = rises ? 1u : 0xffffffffu;
    c.slope = (high.x - c.low.x) / (high.y - c.low.y);
    c.line = ss_winding_from(c.low.y);
    // Nothing is left of an edge that is left of the light.
    c.end = max(c.low.x, high.x) > 0.0 ? ss_winding_from(high.y) : c.line;
    return c;
}

void ss_winding_step(inout ss_crossing c)
{
    ss_winding_add(c.line, c.low.x + (ss_winding_height(c.line) - c.low.y) * c.slope, c.sign);
    c.line++;
}

// Adds the samples that are wound around to the mask; `turn` is 1, or -1 if contours run the other way on the light.
void ss_winding_to_mask(int turn)
{
    for (int line = 0; line < SS_WINDING_LINES; line++) {
        const uint word = ss_winding[line] * uint(turn);
        uint bits = (word | word >> 1 | word >> 2 | word >> 3) & 0x11111111u;
        // From every fourth bit to every second or to each.
        bits = (bits | bits >> 2) & 0x05050505u;
        bits = (bits | bits >> 4) & 0x00550055u;
        bits = (bits | bits >> 8) & 0x00005555u;
        if (SS_WINDING_STEP == 1) {
            bits = (bits | bits >> 1) & 0x3333u;
            bits = (bits | bits >> 2) & 0x0f0fu;
            bits = (bits | bits >> 4) & 0x00ffu;
        } else {
            bits <<= line & 1;
        }
        const int row = line / SS_WINDING_STEP;
        ss_mask[row / SS_ROWS_PER_WORD] |= bits << ((row % SS_ROWS_PER_WORD) * SS_SIDE);
    }
}

// Samples that were wound around before, a bit each as the numbers have four.
uint ss_covered[SS_WINDING_LINES];

void ss_covered_clear()
{
    for (int i = 0; i < SS_WINDING_LINES; i++)
        ss_covered[i] = 0u;
}

// Of signed numbers: how many samples have one above zero, and the sum of these; `added`: of the first only those that no earlier
// call has found.
uvec2 ss_winding_cover(bool added)
{
    uint count = 0u, sum = 0u;
    for (int line = 0; line < SS_WINDING_LINES; line++) {
        const uint word = ss_winding[line], from_zero = (word >> 1 | word >> 2 | word >> 3) & 0x11111111u;
        const uint above = (word & from_zero * 15u) - from_zero * 2u;
        const uint covered = (above | above >> 1 | above >> 2 | above >> 3) & 0x11111111u;
        count += uint(bitCount(added ? covered & ~ss_covered[line] : covered));
        ss_covered[line] |= covered;
        sum += ((above & 0x0f0f0f0fu) + (above >> 4 & 0x0f0f0f0fu)) * 0x01010101u >> 24;
    }
    return uvec2(count, sum);
}

#endif
