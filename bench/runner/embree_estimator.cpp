// Shadow rays with Embree on all cores, for the receivers that every other technique finds in the camera's depth: what
// ray casting on the CPU costs. Positions and normals are found once and not timed, as a renderer has them anyway.
#include "estimators.hpp"

#include <chrono>

#include "error.hpp"
#include "fast_sampler.hpp"
#include "ray_scene.hpp"
#include "ray_shadow.hpp"
#include "receivers.hpp"

namespace
{

template <typename Work>
PassTime timed(const char *name, const Work &work)
{
    const auto start = std::chrono::steady_clock::now();
    work();
    return {name, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count()};
}

const Scene &scene_of(const DeviceCase &device_case)
{
    if (!device_case.scene)
        fail("technique embree needs the scene's mesh, which a case folder does not have; use --scene or --model");
    return *device_case.scene;
}

// By the ground truth's rays, so that both start from the same points.
Receivers receivers_of(const DeviceCase &device_case)
{
    const Scene &scene = scene_of(device_case);
    return find_receivers(scene.mesh, RayScene(scene.mesh), scene.origin, device_case.data.camera);
}

class EmbreeEstimator final : public Estimator
{
  public:
    EmbreeEstimator(DeviceCase &device_case, const Technique &technique)
        : mesh_(scene_of(device_case).mesh), receivers_(receivers_of(device_case)),
          sampler_(device_case.data.light, receivers_, technique.rays), rays_(mesh_, RayAccuracy::fast)
    {
    }

    RunTimes run(bool build) override
    {
        RunTimes times;
        if (build || !built_)
            times.build.push_back(timed("embree_build", [&] { rays_.build(mesh_); }));
        built_ = true;
        times.visibility.push_back(
            timed("embree_rays", [&] { visibility_ = trace_shadows(rays_, receivers_, sampler_); }));
        return times;
    }
    FloatImage visibility() override
    {
        return visibility_;
    }
    bool stats(softsh_stats &) override
    {
        return false;
    }
    MemoryUse memory() const override
    {
        return {rays_.memory(), 0};
    }

  private:
    const Mesh &mesh_;
    Receivers receivers_;
    FastLightSampler sampler_;
    RayScene rays_;
    bool built_ = false;
    FloatImage visibility_;
};

} // namespace

std::unique_ptr<Estimator> make_embree_estimator(DeviceCase &device_case, const Technique &technique)
{
    return std::make_unique<EmbreeEstimator>(device_case, technique);
}
