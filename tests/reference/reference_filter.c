/* The post filter: section 6 of docs/numerics.md, after section 3.1 of Schwarz and Stamminger, Bitmask Soft Shadows,
 * 2007. */
#include "reference_filter.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

bool reference_filter_axis(const double a[3], const double b[3], double *value)
{
    const double da = a[2] - a[0], db = b[2] - b[0];
    if (!((da > 0.0 && db > 0.0) || (da < 0.0 && db < 0.0)))
        return false;
    if (!(fmin(a[0], a[2]) <= a[1] && a[1] <= fmax(a[0], a[2])))
        return false;
    *value = (a[1] - a[0]) / da * db + b[0];
    return true;
}

static double filter_pixel(const double *b, const double *a, const uint8_t *kinds, uint32_t width, uint32_t height,
                           uint32_t x, uint32_t y)
{
    const size_t here = (size_t)y * width + x;
    const bool inside[2] = {x > 0 && x + 1 < width, y > 0 && y + 1 < height};
    const size_t step[2] = {1, width};
    double best = b[here];
    bool found = false;
    for (int axis = 0; axis < 2; ++axis) {
        if (!inside[axis])
            continue;
        const size_t before = here - step[axis], after = here + step[axis];
        if (kinds[before] == REFERENCE_FILTER_NO_RECEIVER || kinds[after] == REFERENCE_FILTER_NO_RECEIVER)
            continue;
        double value;
        if (!reference_filter_axis((const double[3]){a[before], a[here], a[after]},
                                   (const double[3]){b[before], b[here], b[after]}, &value))
            continue;
        /* An axis without a value has no say: else edges along an axis would never be filtered. */
        if (!found || fabs(value - b[here]) < fabs(best - b[here]))
            best = value;
        found = true;
    }
    return best;
}

bool reference_filter(double *b, const double *a, const uint8_t *kinds, uint32_t width, uint32_t height,
                      uint32_t passes)
{
    const size_t count = (size_t)width * height;
    double *previous = malloc(count * sizeof(*previous));
    if (!previous)
        return false;
    for (uint32_t pass = 0; pass < passes; ++pass) {
        memcpy(previous, b, count * sizeof(*previous));
        for (uint32_t y = 0; y < height; ++y)
            for (uint32_t x = 0; x < width; ++x)
                if (kinds[(size_t)y * width + x] == REFERENCE_FILTER_PENUMBRA)
                    b[(size_t)y * width + x] = filter_pixel(previous, a, kinds, width, height, x, y);
    }
    free(previous);
    return true;
}
