// Shadow rays from receivers to samples of a light; where the samples lie is for the caller to say.
#pragma once

#include <functional>

#include "image_io.hpp"
#include "light.hpp"
#include "ray_scene.hpp"
#include "receivers.hpp"

// Samples of a light. Const functions are called from several threads.
class LightSampler
{
  public:
    virtual ~LightSampler() = default;
    virtual uint32_t count() const = 0;
    // Fills `out`, which has room for count() segments, with those from `start` to the samples for this receiver. False
    // if none is needed because the receiver can see nothing of the light.
    virtual bool aim(const Receiver &receiver, const glm::dvec3 &start, SegmentList &out) const = 0;
};

// Progress from 0 to 1, called from one of the working threads at a time.
using RayProgress = std::function<void(double)>;

// The fraction of the segments that is not blocked for every receiver, and 1 where there is none. Uses all cores; the
// result does not depend on their number.
FloatImage trace_shadows(const RayScene &rays, const Receivers &receivers, const LightSampler &sampler,
                         const RayProgress &progress = {});
