/* The post filter: section 6 of docs/numerics.md. */
#ifndef REFERENCE_FILTER_H
#define REFERENCE_FILTER_H

#include <stdbool.h>
#include <stdint.h>

typedef enum reference_filter_pixel {
    REFERENCE_FILTER_NO_RECEIVER = 0, /* skips the axes of its neighbours, never changes */
    REFERENCE_FILTER_FIXED = 1,       /* a receiver outside penumbra tiles */
    REFERENCE_FILTER_PENUMBRA = 2     /* a receiver that may change */
} reference_filter_pixel;

/* Filters bitmask occlusion `b` in place, steered by area occlusion `a`, `passes` times. Images are width x height, row
 * by row; `kinds` holds reference_filter_pixel values. Every pass reads the previous pass's b. False when out of
 * memory. */
bool reference_filter(double *b, const double *a, const uint8_t *kinds, uint32_t width, uint32_t height,
                      uint32_t passes);

/* One axis, neighbours first and last: false where the area occlusion gives no guidance, else the pixel's new value. */
bool reference_filter_axis(const double a[3], const double b[3], double *value);

#endif
