/* Ranges of fan depth, each computed from the map itself: section 7 of docs/numerics.md. The HSM is Guennebaud et al.'s
 * of 2006, the MSSM section 5 of Schwarz and Stamminger's Bitmask Soft Shadows of 2007, the YSM section 6 of their
 * Quality Scalability of Soft Shadow Mapping of 2008. */
#include "reference_hierarchy.h"

#include <math.h>
#include <stddef.h>

uint32_t reference_hsm_size(uint32_t size, uint32_t level)
{
    return (uint32_t)(((uint64_t)size + ((uint64_t)1 << level) - 1) >> level);
}

reference_range reference_block_range(const float *g, uint32_t width, uint32_t height, int64_t x0, int64_t y0,
                                      int64_t x1, int64_t y1)
{
    reference_range range = {INFINITY, -INFINITY};
    for (int64_t y = y0 < 0 ? 0 : y0; y <= y1 && y < (int64_t)height; ++y) {
        for (int64_t x = x0 < 0 ? 0 : x0; x <= x1 && x < (int64_t)width; ++x) {
            const float here = g[(size_t)y * width + (size_t)x];
            range.min = here < range.min ? here : range.min;
            range.max = here > range.max ? here : range.max;
        }
    }
    return range;
}

reference_range reference_hsm(const float *g, uint32_t width, uint32_t height, uint32_t level, uint32_t x, uint32_t y)
{
    const int64_t side = (int64_t)1 << level, left = x * side, bottom = y * side;
    return reference_block_range(g, width, height, left, bottom, left + side - 1, bottom + side - 1);
}

reference_range reference_mssm(const float *g, uint32_t width, uint32_t height, uint32_t level, uint32_t x, uint32_t y)
{
    if (level == 0)
        return reference_hsm(g, width, height, 0, x, y);
    const int64_t half = (int64_t)1 << (level - 1);
    return reference_block_range(g, width, height, x - half, y - half, x + half - 1, y + half - 1);
}

reference_range reference_ysm(const float *g, uint32_t width, uint32_t height, uint32_t join, uint32_t level,
                              uint32_t x, uint32_t y)
{
    if (level <= join)
        return reference_hsm(g, width, height, level, x, y);
    /* Whole texels of the join level; each is a block of the map. */
    const int64_t half = (int64_t)1 << (level - join - 1), side = (int64_t)1 << join;
    return reference_block_range(g, width, height, (x - half) * side, (y - half) * side, (x + half) * side - 1,
                                 (y + half) * side - 1);
}
