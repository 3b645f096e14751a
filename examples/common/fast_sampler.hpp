// Samples of a light for ray casting against time: single precision, in loops that compilers turn into vector
// instructions. The ground truth has its own, which favour nothing but accuracy.
#pragma once

#include "ray_shadow.hpp"

class FastLightSampler final : public LightSampler
{
  public:
    // One sample in each cell of a grid of at most `samples` (1 to 65536) cells, jittered in every pixel. `receivers`
    // gives the scene's place and extent; it is not kept. Throws Error.
    FastLightSampler(const Light &light, const Receivers &receivers, uint32_t samples);

    uint32_t count() const override
    {
        return grid_ * grid_;
    }
    // False for receivers that face away from the whole light.
    bool aim(const Receiver &receiver, const glm::dvec3 &start, SegmentList &out) const override;

  private:
    Light light_; // in mesh space
    double reach_;
    uint32_t grid_;
    std::vector<float> cell_x_, cell_y_; // lower corners of the cells, in light coordinates from -1 to 1
};
