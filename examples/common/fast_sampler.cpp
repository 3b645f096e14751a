// Samples of a light for ray casting against time.
#include "fast_sampler.hpp"

#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "light_sampling.hpp"

namespace
{

// Not the ground truth's, so that the two differ by the noise of both.
constexpr uint64_t seed = 0x5851f42d4c957f2du;

// The map of light_sampling.cpp, from the square to the disc, without branches: the angle from the nearer axis is at
// most 45 degrees, where short series are good to single precision.
void squares_to_discs(float *x, float *y, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        const bool wide = std::fabs(x[k]) > std::fabs(y[k]);
        const float radius = wide ? x[k] : y[k], other = wide ? y[k] : x[k];
        const float angle = 0.78539816f * other / (radius == 0.0f ? 1.0f : radius);
        const float a2 = angle * angle;
        const float cosine = 1.0f + a2 * (-0.5f + a2 * (0.041666667f + a2 * (-0.0013888889f + a2 * 2.4801587e-5f)));
        const float sine =
            angle * (1.0f + a2 * (-0.16666667f + a2 * (0.0083333333f + a2 * (-1.9841270e-4f + a2 * 2.7557319e-6f))));
        x[k] = radius * (wide ? cosine : sine);
        y[k] = radius * (wide ? sine : cosine);
    }
}

} // namespace

FastLightSampler::FastLightSampler(const Light &light, const Receivers &receivers, uint32_t samples)
    : light_(light), reach_(receivers.reach), grid_(light_grid(samples))
{
    if (samples < 1 || samples > 65536)
        fail("ray casting: %u light samples, expected 1 to 65536", samples);
    light_.centre -= receivers.origin;
    const float size = 2.0f / static_cast<float>(grid_);
    for (const LightCell &cell : light_cells(grid_)) {
        cell_x_.push_back(static_cast<float>(cell.i) * size - 1.0f);
        cell_y_.push_back(static_cast<float>(cell.j) * size - 1.0f);
    }
    // Two samples are made at a time.
    cell_x_.resize((cell_x_.size() + 1) / 2 * 2);
    cell_y_.resize(cell_x_.size());
}

bool FastLightSampler::aim(const Receiver &receiver, const glm::dvec3 &start, SegmentList &out) const
{
    const LightOutline outline = light_outline(light_, start, reach_);
    if (!(highest_above(outline, receiver.normal) > 0.0))
        return false;
    float *const x = out.x.data(), *const y = out.y.data(), *const z = out.z.data();
    const size_t count = cell_x_.size();
    // One hash has the 16 bits that place a sample in its cell for both coordinates of two samples.
    const float step = 0x1p-15f / static_cast<float>(grid_);
    const uint64_t base = seed + static_cast<uint64_t>(receiver.pixel) * count;
    for (size_t k = 0; k < count; k += 2) {
        const uint64_t random = mix(base + k);
        x[k] = cell_x_[k] + step * static_cast<float>(static_cast<int32_t>(random & 0xffff));
        y[k] = cell_y_[k] + step * static_cast<float>(static_cast<int32_t>(random >> 16 & 0xffff));
        x[k + 1] = cell_x_[k + 1] + step * static_cast<float>(static_cast<int32_t>(random >> 32 & 0xffff));
        y[k + 1] = cell_y_[k + 1] + step * static_cast<float>(static_cast<int32_t>(random >> 48));
    }
    if (outline.round)
        squares_to_discs(x, y, count);
    const glm::vec3 c(outline.centre), u(outline.half_u), v(outline.half_v);
    for (size_t k = 0; k < count; k++) {
        const float s = x[k], t = y[k];
        x[k] = c.x + u.x * s + v.x * t;
        y[k] = c.y + u.y * s + v.y * t;
        z[k] = c.z + u.z * s + v.z * t;
    }
    return true;
}
