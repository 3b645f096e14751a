/* How much of the light one receiver sees, by looking at every micro-occluder of every layer: sections 4 and 5 of
 * docs/numerics.md, after sections 3 and 4 of Schwarz and Stamminger, Bitmask Soft Shadows, 2007. Departures from the
 * paper are the page's: exact microquad coverage, and a bias from the receiver's plane. */
#include "reference_visibility.h"
#include "reference_polygon.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* One sample of the chosen level. */
typedef struct micro_sample {
    double place[3]; /* u, v, g */
    bool passes;     /* the bias test */
    double q[2];     /* its back-projection, if it passes */
} micro_sample;

typedef struct evaluation {
    const reference_map *map;
    const reference_settings *settings;
    const reference_receiver *receiver;
    double raised[3]; /* (u, v, g') of the receiver */
    uint32_t columns, rows, spacing;
    micro_sample *samples;
    uint32_t pattern_size;
    reference_occlusion *out;
} evaluation;

uint32_t reference_pattern_size(softsh_pattern pattern)
{
    switch (pattern) {
    case SOFTSH_PATTERN_8X8:
        return 8;
    case SOFTSH_PATTERN_32X32:
        return 32;
    case SOFTSH_PATTERN_DEFAULT:
    case SOFTSH_PATTERN_16X16:
    case SOFTSH_PATTERN_16X16_JITTERED:
        break;
    }
    return 16;
}

void reference_pattern_sample(softsh_pattern pattern, uint32_t i, uint32_t j, double xy[2])
{
    xy[0] = i + 0.5;
    xy[1] = j + 0.5;
    if (pattern == SOFTSH_PATTERN_DEFAULT || pattern == SOFTSH_PATTERN_16X16_JITTERED) {
        xy[0] = i + (j % 2 == 0 ? 0.75 : 0.25);
        xy[1] = j + (i % 2 == 0 ? 0.25 : 0.75);
    }
}

bool reference_pattern_counted(softsh_pattern pattern, bool directional, uint32_t i, uint32_t j)
{
    const double n = reference_pattern_size(pattern);
    double xy[2];
    reference_pattern_sample(pattern, i, j, xy);
    const double s = 2.0 * xy[0] / n - 1.0, t = 2.0 * xy[1] / n - 1.0;
    return !directional || s * s + t * t <= 1.0;
}

uint32_t reference_level(uint32_t extent, uint32_t budget)
{
    uint32_t level = 0;
    while (budget != 0 && extent > (uint64_t)budget << level)
        ++level;
    return level;
}

static bool is_micropatch(const reference_settings *settings)
{
    return reference_flat(reference_primitive(settings));
}

static void prepare_samples(evaluation *e, const float *g)
{
    for (uint32_t y = 0; y < e->rows; ++y) {
        for (uint32_t x = 0; x < e->columns; ++x) {
            micro_sample *sample = &e->samples[(size_t)y * e->columns + x];
            reference_level_sample(e->map, e->settings, g, x, y, sample->place);
            sample->passes = reference_occludes(e->map, e->settings, e->receiver, sample->place);
            if (sample->passes)
                reference_map_backproject(e->map, e->raised, sample->place, sample->q);
        }
    }
}

double reference_to_sample(softsh_pattern pattern, double q)
{
    return (q + 1.0) * 0.5 * reference_pattern_size(pattern);
}

static void set_bit(reference_occlusion *out, uint32_t bit)
{
    out->mask[bit / 32] |= 1u << (bit % 32);
}

/* Samples of [x0, x1) x [y0, y1), given in q. */
static void cover_rectangle(const evaluation *e, const double rectangle[4])
{
    const uint32_t n = e->pattern_size;
    const double x0 = reference_to_sample(e->settings->pattern, rectangle[0]),
                 y0 = reference_to_sample(e->settings->pattern, rectangle[1]);
    const double x1 = reference_to_sample(e->settings->pattern, rectangle[2]),
                 y1 = reference_to_sample(e->settings->pattern, rectangle[3]);
    if (!(x1 > 0.0 && y1 > 0.0 && x0 < n && y0 < n))
        return;
    for (uint32_t j = 0; j < n; ++j) {
        for (uint32_t i = 0; i < n; ++i) {
            double xy[2];
            reference_pattern_sample(e->settings->pattern, i, j, xy);
            if (x0 <= xy[0] && xy[0] < x1 && y0 <= xy[1] && xy[1] < y1)
                set_bit(e->out, j * n + i);
        }
    }
}

void reference_cover_quad(softsh_pattern pattern, double q[4][2], reference_occlusion *out)
{
    const uint32_t n = reference_pattern_size(pattern);
    double corner[4][2], lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY};
    for (int k = 0; k < 4; ++k) {
        for (int axis = 0; axis < 2; ++axis) {
            corner[k][axis] = reference_to_sample(pattern, q[k][axis]);
            lo[axis] = fmin(lo[axis], corner[k][axis]);
            hi[axis] = fmax(hi[axis], corner[k][axis]);
        }
    }
    if (!(hi[0] > 0.0 && hi[1] > 0.0 && lo[0] < n && lo[1] < n))
        return;
    for (uint32_t j = 0; j < n; ++j) {
        for (uint32_t i = 0; i < n; ++i) {
            double xy[2];
            bool covered = false;
            reference_pattern_sample(pattern, i, j, xy);
            for (int k = 0; k < 4; ++k) {
                double crossing;
                if (reference_crosses(corner[k], corner[(k + 1) % 4], xy[1], &crossing))
                    covered ^= crossing > xy[0];
            }
            if (covered)
                set_bit(out, j * n + i);
        }
    }
}

double reference_area_side(const reference_map *map)
{
    return map->directional ? 0.5 * sqrt(acos(-1.0)) : 1.0;
}

static double clamp(double x, double limit)
{
    return fmin(fmax(x, -limit), limit);
}

static void add_rectangle_area(const evaluation *e, const double rectangle[4])
{
    const double side = reference_area_side(e->map);
    const double width = clamp(rectangle[2], side) - clamp(rectangle[0], side);
    const double height = clamp(rectangle[3], side) - clamp(rectangle[1], side);
    e->out->area += width * height / (4.0 * side * side);
}

static void add_quad_area(const evaluation *e, double q[4][2])
{
    const double side = reference_area_side(e->map);
    double twice = 0.0;
    for (int k = 0; k < 4; ++k) {
        const double *a = q[k], *b = q[(k + 1) % 4];
        twice += clamp(a[0], side) * clamp(b[1], side) - clamp(b[0], side) * clamp(a[1], side);
    }
    e->out->area += 0.5 * fabs(twice) / (4.0 * side * side);
}

/* The back-projection of a patch's border at offset (du, dv) from its place. */
static void backproject_border(const evaluation *e, const micro_sample *sample, double du, double dv, double q[2])
{
    const double border[3] = {sample->place[0] + du, sample->place[1] + dv, sample->place[2]};
    reference_map_backproject(e->map, e->raised, border, q);
}

static void add_micropatch(const evaluation *e, uint32_t x, uint32_t y)
{
    const micro_sample *sample = &e->samples[(size_t)y * e->columns + x];
    const double half = 0.5 * e->spacing;
    double rectangle[4];
    if (!sample->passes)
        return;
    backproject_border(e, sample, -half, -half, &rectangle[0]);
    backproject_border(e, sample, half, half, &rectangle[2]);
    if (reference_primitive(e->settings) == SOFTSH_PRIMITIVE_MICROPATCH) {
        double q[2];
        if (x > 0 && sample[-1].passes) {
            backproject_border(e, sample - 1, half, 0.0, q);
            rectangle[0] = fmin(rectangle[0], q[0]);
        }
        if (y > 0 && (sample - e->columns)->passes) {
            backproject_border(e, sample - e->columns, 0.0, half, q);
            rectangle[1] = fmin(rectangle[1], q[1]);
        }
    }
    cover_rectangle(e, rectangle);
    add_rectangle_area(e, rectangle);
}

static void add_microquad(const evaluation *e, uint32_t x, uint32_t y)
{
    const micro_sample *first = &e->samples[(size_t)y * e->columns + x];
    const micro_sample *const corners[4] = {first, first + 1, first + 1 + e->columns, first + e->columns};
    double q[4][2];
    for (int k = 0; k < 4; ++k) {
        if (!corners[k]->passes)
            return;
        memcpy(q[k], corners[k]->q, sizeof(q[k]));
    }
    if (reference_primitive(e->settings) == SOFTSH_PRIMITIVE_MICROQUAD) {
        reference_cover_quad(e->settings->pattern, q, e->out);
    } else {
        const double left = 0.5 * (q[0][0] + q[3][0]), right = 0.5 * (q[1][0] + q[2][0]);
        const double bottom = 0.5 * (q[0][1] + q[1][1]), top = 0.5 * (q[3][1] + q[2][1]);
        const double rectangle[4] = {fmin(left, right), fmin(bottom, top), fmax(left, right), fmax(bottom, top)};
        cover_rectangle(e, rectangle);
    }
    add_quad_area(e, q);
}

/* Occlusion by one layer into e->out, whose mask and area are zero. */
static void evaluate_layer(evaluation *e, const float *g)
{
    const bool patches = is_micropatch(e->settings);
    prepare_samples(e, g);
    for (uint32_t y = 0; y + (patches ? 0 : 1) < e->rows; ++y)
        for (uint32_t x = 0; x + (patches ? 0 : 1) < e->columns; ++x)
            if (patches)
                add_micropatch(e, x, y);
            else
                add_microquad(e, x, y);
}

static void set_all(reference_occlusion *out, uint32_t pattern_size)
{
    for (uint32_t bit = 0; bit < pattern_size * pattern_size; ++bit)
        set_bit(out, bit);
    out->area = 1.0;
}

void reference_count(const reference_map *map, softsh_pattern pattern, reference_occlusion *out)
{
    const uint32_t n = reference_pattern_size(pattern);
    out->counted = out->occluded = 0;
    for (uint32_t j = 0; j < n; ++j) {
        for (uint32_t i = 0; i < n; ++i) {
            const uint32_t word = (j * n + i) / 32, bit = 1u << (j * n + i) % 32;
            if (!reference_pattern_counted(pattern, map->directional, i, j)) {
                out->mask[word] &= ~bit;
                continue;
            }
            ++out->counted;
            if (out->mask[word] & bit)
                ++out->occluded;
        }
    }
    out->bitmask = (double)out->occluded / out->counted;
}

static void merge_layer(const reference_settings *settings, const reference_occlusion *layer, reference_occlusion *out)
{
    if (settings->merge == SOFTSH_MERGE_MAXIMUM) {
        const double area = fmax(out->area, layer->area);
        if (layer->occluded > out->occluded)
            *out = *layer;
        out->area = area;
    } else {
        for (size_t word = 0; word < sizeof(out->mask) / sizeof(out->mask[0]); ++word)
            out->mask[word] |= layer->mask[word];
        out->area += layer->area;
    }
}

double reference_visible(const reference_receiver *receiver, double occlusion)
{
    return fmax(1.0 - occlusion - (receiver->state == REFERENCE_RECEIVER_ACTIVE ? receiver->horizon : 0.0), 0.0);
}

bool reference_visibility(const reference_map *map, const float *const *layers, uint32_t layer_count,
                          const reference_settings *settings, const reference_receiver *receiver,
                          reference_occlusion *out)
{
    memset(out, 0, sizeof(*out));
    const uint32_t n = reference_pattern_size(settings->pattern);
    if (reference_primitive(settings) > SOFTSH_PRIMITIVE_MICROQUAD_RECTANGLE || settings->level > 14 ||
        (is_micropatch(settings) && !map->point && !map->axis_aligned))
        return false;
    if (receiver->state == REFERENCE_RECEIVER_AWAY)
        set_all(out, n);
    if (receiver->state != REFERENCE_RECEIVER_ACTIVE) {
        reference_count(map, settings->pattern, out);
        return true;
    }

    const uint32_t spacing = 1u << settings->level;
    evaluation e = {.map = map, .settings = settings, .receiver = receiver, .spacing = spacing, .pattern_size = n};
    e.columns = (map->width + spacing - 1) / spacing;
    e.rows = (map->height + spacing - 1) / spacing;
    memcpy(e.raised, receiver->uvg, sizeof(e.raised));
    e.raised[2] = reference_raised_g(map, settings, receiver);
    e.samples = calloc((size_t)e.columns * e.rows, sizeof(*e.samples));
    if (!e.samples)
        return false;
    for (uint32_t i = 0; i < layer_count; ++i) {
        reference_occlusion layer;
        memset(&layer, 0, sizeof(layer));
        e.out = &layer;
        if (!map->point)
            evaluate_layer(&e, layers[i]);
        else if (reference_hard_shadow(map, settings, layers[i], receiver))
            set_all(&layer, n);
        reference_count(map, settings->pattern, &layer);
        merge_layer(settings, &layer, out);
    }
    free(e.samples);
    reference_count(map, settings->pattern, out);
    return true;
}
