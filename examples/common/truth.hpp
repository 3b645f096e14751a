// Ground truth by ray casting with Embree: the fraction of the light each camera pixel sees.
#pragma once

#include <cstdint>
#include <string>

#include "case_io.hpp"
#include "mesh.hpp"
#include "ray_shadow.hpp"

struct Truth {
    FloatImage visibility; // 1 where there is no receiver
    FloatImage mask;       // 1 where a pixel is a receiver facing the light's centre, else 0
};

struct TruthOptions {
    // Of the light, rounded down to a square number. What the estimate's own noise adds to the error of a technique
    // with none, by the measure of softshadow-eval, in balls and in fence at 640 x 480: with 256 samples a mean of
    // 0.0034 and 0.0062 (rms 0.0052, 0.0082), with 1024 of 0.0012 and 0.0022 (rms 0.0018, 0.0029).
    uint32_t samples = 1024;
    uint64_t seed = 0;       // of the jitter; another one gives another estimate
    double light_near = 0.0; // receivers nearer to the light's plane than this, or behind it, are not in the mask
};

using TruthProgress = RayProgress;

// Casts rays from the receivers in `camera` (whose matrices map world to clip space) to points of the light:
// one in each cell of a regular grid over the light, jittered differently in every
// pixel. The mesh's zero lies at `origin`. The result does not depend on the number of threads. Throws Error.
Truth compute_truth(const Mesh &mesh, const glm::dvec3 &origin, const DepthView &camera, const Light &light,
                    const TruthOptions &options, const TruthProgress &progress = {});

// As above, but keeps results in `folder` (created if needed) under a hash of everything that determines them.
Truth cached_truth(const std::string &folder, const Mesh &mesh, const glm::dvec3 &origin, const DepthView &camera,
                   const Light &light, const TruthOptions &options, const TruthProgress &progress = {});
