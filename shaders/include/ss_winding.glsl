// Winding numbers of all samples of a pattern, four bits each: docs/numerics.md, sections 4 and 10. Sums modulo 2^32 of whole words
// are exact as long as the numbers that come out in the end are 0 to 15, whatever they were in between.
// Needs the pattern, of 8 x 8 or 16 x 16 samples.
#ifndef SS_WINDING_GLSL
#define SS_WINDING_GLSL

// Lines of eight samples: rows of 8 x 8, the even and the odd columns of a row of 16 x 16, one after the other.
const int SS_WINDING_LINES = SS_SIDE == 8 ? 8 : 32;
const int SS_WINDING_STEP = SS_SIDE == 8 ? 1 : 2;

uint ss_winding[SS_WINDING_LINES];

void ss_winding_clear()
{
    for (int i = 0; i < SS_WINDING_LINES; i++)
        ss_winding[i] = 0u;
}

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

// Adds the samples that are wound around to the mask. Contours of a mirrored light run the other way.
void ss_winding_to_mask(bool mirrored)
{
    for (int line = 0; line < SS_WINDING_LINES; line++) {
        const uint word = mirrored ? 0u - ss_winding[line] : ss_winding[line];
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

#endif
