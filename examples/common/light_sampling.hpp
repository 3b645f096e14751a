// Points of a light, for casting rays at them.
#pragma once

#include <cstdint>
#include <vector>

#include "light.hpp"

// The segment from p to the light's sample (s, t), both in [0, 1): the occlusion test's direction, whose length is the
// segment's. For a directional light it is as long as `far_away`.
glm::dvec3 to_light_sample(const Light &light, const glm::dvec3 &p, double s, double t, double far_away);

// From p to the light's centre; for a directional light of length one.
glm::dvec3 to_light_centre(const Light &light, const glm::dvec3 &p);

// How a light appears from a point: the segments from there to its samples are centre + half_u * x + half_v * y, with x
// and y from -1 to 1 over the square, or over the disc in it.
struct LightOutline {
    glm::dvec3 centre, half_u, half_v;
    bool round;
};
LightOutline light_outline(const Light &light, const glm::dvec3 &p, double far_away);
// How far the light rises above the plane through the point with this normal.
double highest_above(const LightOutline &outline, const glm::dvec3 &normal);

// `samples` of a light are a regular grid: this many along each side.
uint32_t light_grid(uint32_t samples);

// The cells of a grid in blocks of 4 x 4 and halves of these, so that packets of 16 or 8 rays are compact.
struct LightCell {
    uint32_t i, j;
};
std::vector<LightCell> light_cells(uint32_t grid);

// A well-mixed hash of a counter (splitmix64), so that every pixel has its own reproducible random numbers.
inline uint64_t mix(uint64_t x)
{
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}
