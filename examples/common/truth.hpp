// Ground truth by ray casting with Embree: the fraction of the light each camera pixel sees.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "case_io.hpp"
#include "mesh.hpp"

struct Truth {
    FloatImage visibility; // 1 where there is no receiver
    FloatImage mask;       // 1 where a pixel is a receiver facing the light's centre, else 0
};

struct TruthOptions {
    uint32_t samples = 1024; // of the light, rounded down to a square number
    double light_near = 0.0; // receivers nearer to the light's plane than this, or behind it, are not in the mask
};

// Progress from 0 to 1, called from one of the working threads at a time.
using TruthProgress = std::function<void(double)>;

// Casts rays from the receivers in `camera` (whose matrices map world to clip space) to points of the light:
// one in each cell of a regular grid over the light, jittered differently in every
// pixel. The mesh's zero lies at `origin`. The result does not depend on the number of threads. Throws Error.
Truth compute_truth(const Mesh &mesh, const glm::dvec3 &origin, const DepthView &camera, const Light &light,
                    const TruthOptions &options, const TruthProgress &progress = {});

// As above, but keeps results in `folder` (created if needed) under a hash of everything that determines them.
Truth cached_truth(const std::string &folder, const Mesh &mesh, const glm::dvec3 &origin, const DepthView &camera,
                   const Light &light, const TruthOptions &options, const TruthProgress &progress = {});
