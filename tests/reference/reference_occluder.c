/* Samples of a level, and which of them occlude a receiver: sections 3 (bias) and 5 of docs/numerics.md. */
#include "reference_occluder.h"

#include <math.h>

/* Half width of the band around the receiver's plane that is its own surface, in slopes per spacing. */
static const double micropatch_band = 0.5, microquad_band = 0.05;

/* Bounds over a block are computed otherwise than a sample's own test; this much of them is rounding. */
static const double rounding = 1e-12;

softsh_primitive reference_primitive(const reference_settings *settings)
{
    return settings->primitive == SOFTSH_PRIMITIVE_DEFAULT ? SOFTSH_PRIMITIVE_MICROQUAD : settings->primitive;
}

bool reference_flat(softsh_primitive primitive)
{
    return primitive == SOFTSH_PRIMITIVE_MICROPATCH || primitive == SOFTSH_PRIMITIVE_MICROPATCH_UNEXTENDED;
}

static bool is_micropatch(const reference_settings *settings)
{
    return reference_flat(reference_primitive(settings));
}

static bool is_nearest(const reference_settings *settings)
{
    return settings->aggregation == SOFTSH_AGGREGATION_NEAREST;
}

static double slope(const reference_receiver *receiver)
{
    return fabs(receiver->gradient[0]) + fabs(receiver->gradient[1]);
}

static double plane_at(const reference_receiver *receiver, const double uv[2])
{
    return receiver->uvg[2] + receiver->gradient[0] * (uv[0] - receiver->uvg[0]) +
           receiver->gradient[1] * (uv[1] - receiver->uvg[1]);
}

/* How far a block's nearest texel lifts the receiver's plane. */
static double lift(const reference_settings *settings, const reference_receiver *receiver)
{
    const double spacing = (double)(1u << settings->level);
    return !is_micropatch(settings) && is_nearest(settings) ? slope(receiver) * 0.5 * (spacing - 1.0) : 0.0;
}

double reference_raised_g(const reference_map *map, const reference_settings *settings,
                          const reference_receiver *receiver)
{
    const double g = receiver->uvg[2];
    if (receiver->override_bias) {
        if (!map->perspective)
            return g + receiver->bias;
        return receiver->bias * g < 1.0 ? g / (1.0 - receiver->bias * g) : INFINITY;
    }
    return g + receiver->eta + lift(settings, receiver);
}

/* How high over the receiver's plane a sample is still its own surface. */
static double band_at(const reference_settings *settings, const reference_receiver *receiver, const double uv[2])
{
    const double band = is_micropatch(settings) ? micropatch_band : microquad_band;
    const double distance = fabs(uv[0] - receiver->uvg[0]) + fabs(uv[1] - receiver->uvg[1]);
    return receiver->eta + band * slope(receiver) * (double)(1u << settings->level) + receiver->drift * distance;
}

static bool in_front_of_light(const reference_map *map, double g)
{
    return map->epsilon - map->delta * g > 0.0;
}

void reference_level_sample(const reference_map *map, const reference_settings *settings, const float *g, uint32_t x,
                            uint32_t y, double place[3])
{
    const uint32_t width = map->width, height = map->height, spacing = 1u << settings->level;
    if (is_nearest(settings)) {
        place[0] = (x + 0.5) * spacing;
        place[1] = (y + 0.5) * spacing;
        place[2] = -INFINITY;
        for (uint32_t j = y * spacing; j < (y + 1) * spacing && j < height; ++j)
            for (uint32_t i = x * spacing; i < (x + 1) * spacing && i < width; ++i)
                place[2] = fmax(place[2], (double)g[(size_t)j * width + i]);
    } else {
        const uint32_t far_i = x * spacing + spacing / 2, far_j = y * spacing + spacing / 2;
        const uint32_t i = far_i < width - 1 ? far_i : width - 1, j = far_j < height - 1 ? far_j : height - 1;
        place[0] = i + 0.5;
        place[1] = j + 0.5;
        place[2] = (double)g[(size_t)j * width + i];
    }
}

bool reference_occludes(const reference_map *map, const reference_settings *settings,
                        const reference_receiver *receiver, const double place[3])
{
    if (!(place[2] > reference_raised_g(map, settings, receiver)) || !in_front_of_light(map, place[2]))
        return false;
    if (receiver->override_bias)
        return true;
    const double height = place[2] - plane_at(receiver, place) - lift(settings, receiver);
    const double margin = band_at(settings, receiver, place);
    return receiver->side * height > margin;
}

/* Range of slope x + rate |x| for x from low to high. */
static void bound_axis(double low, double high, double slope_of_axis, double rate, double range[2])
{
    const double at_low = slope_of_axis * low + rate * fabs(low), at_high = slope_of_axis * high + rate * fabs(high);
    range[0] = fmin(at_low, at_high);
    range[1] = fmax(at_low, at_high);
    if (low < 0.0 && high > 0.0) {
        range[0] = fmin(range[0], 0.0);
        range[1] = fmax(range[1], 0.0);
    }
}

reference_status reference_block_status(const reference_map *map, const reference_settings *settings,
                                        const reference_receiver *receiver, const double low[3], const double high[3])
{
    const double raised = reference_raised_g(map, settings, receiver);
    if (!(high[2] > raised) || !in_front_of_light(map, low[2]))
        return REFERENCE_FREE;
    const bool all_above = low[2] > raised && in_front_of_light(map, high[2]);
    if (receiver->override_bias)
        return all_above ? REFERENCE_FULL : REFERENCE_MIXED;
    /* Both borders of the band, plane + margin and plane - margin: sums of a part of u, a part of v and a constant, so
     * that their ranges are exact. */
    const double plane = receiver->uvg[2] + lift(settings, receiver);
    const double margin = band_at(settings, receiver, receiver->uvg);
    double above[2] = {plane + margin, plane + margin}, below[2] = {plane - margin, plane - margin};
    for (int axis = 0; axis < 2; ++axis) {
        const double from = low[axis] - receiver->uvg[axis], to = high[axis] - receiver->uvg[axis];
        double range[2];
        bound_axis(from, to, receiver->gradient[axis], receiver->drift, range);
        above[0] += range[0];
        above[1] += range[1];
        bound_axis(from, to, receiver->gradient[axis], -receiver->drift, range);
        below[0] += range[0];
        below[1] += range[1];
    }
    const double slack = rounding * (fabs(above[0]) + fabs(above[1]) + fabs(below[0]) + fabs(below[1]));
    if (receiver->side > 0 ? high[2] < above[0] - slack : low[2] > below[1] + slack)
        return REFERENCE_FREE;
    if (all_above && (receiver->side > 0 ? low[2] > above[1] + slack : high[2] < below[0] - slack))
        return REFERENCE_FULL;
    return REFERENCE_MIXED;
}

bool reference_hard_shadow(const reference_map *map, const reference_settings *settings, const float *g,
                           const reference_receiver *receiver)
{
    double cell[2];
    const uint32_t size[2] = {map->width, map->height};
    for (int i = 0; i < 2; ++i)
        cell[i] = fmin(fmax(floor(receiver->uvg[i]), 0.0), size[i] - 1.0);
    const double center[2] = {cell[0] + 0.5, cell[1] + 0.5};
    const double occluder = (double)g[(size_t)cell[1] * map->width + (size_t)cell[0]];
    if (!in_front_of_light(map, occluder))
        return false;
    if (receiver->override_bias)
        return occluder > reference_raised_g(map, settings, receiver);
    return occluder > plane_at(receiver, center) + receiver->eta + 0.5 * slope(receiver);
}
