// A peer that is one dispatch on the case's own depth buffers.
#include "estimators.hpp"

#include <cstring>

#include "error.hpp"
#include "library_context.hpp"
#include "queries.hpp"

namespace
{

class PeerEstimator final : public Estimator
{
  public:
    PeerEstimator(gpu &g, DeviceCase &device_case, const Technique &technique)
        : gpu_(g), case_(device_case), name_(technique.name), queries_(g, 2),
          map_(layer_maps(device_case.data, technique.layers).front()),
          output_(make_output(g, device_case.data.camera.depth))
    {
        peer_info info{};
        info.kind = technique.peer;
        info.settings = technique.peer_options;
        info.directional = device_case.data.light.shape == LightShape::directional;
        if (!peer_create(&g, &info, &peer_)) {
            gpu_image_destroy(&gpu_, &output_);
            fail("%s", g.error);
        }
    }
    ~PeerEstimator() override
    {
        peer_destroy(&gpu_, peer_);
        gpu_image_destroy(&gpu_, &output_);
    }

    RunTimes run(bool) override
    {
        const Case &data = case_.data;
        peer_inputs inputs{};
        fill(inputs.camera, case_.camera, data.camera.frustum);
        fill(inputs.map, case_.maps[map_], data.maps[map_].frustum);
        const softsh_light light = to_library(data.light);
        std::memcpy(inputs.light.center, light.center, sizeof light.center);
        std::memcpy(inputs.light.half_u, light.half_u, sizeof light.half_u);
        std::memcpy(inputs.light.half_v, light.half_v, sizeof light.half_v);
        std::memcpy(inputs.light.direction, light.direction, sizeof light.direction);
        inputs.light.angular_radius = light.angular_radius;
        inputs.visibility = output_.view;
        const VkCommandBuffer cmd = gpu_begin(&gpu_);
        queries_.reset(cmd);
        gpu_cmd_image_layout(cmd, &output_, VK_IMAGE_LAYOUT_GENERAL);
        queries_.write(cmd, 0, true);
        const bool recorded = peer_record(&gpu_, peer_, cmd, &inputs);
        const std::string error = gpu_.error;
        queries_.write(cmd, 1);
        if (!gpu_submit(&gpu_, cmd))
            fail("%s", gpu_.error);
        if (!recorded)
            fail("%s", error.c_str());
        RunTimes times;
        times.visibility.push_back({name_, queries_.differences(0, 1)[0]});
        return times;
    }
    FloatImage visibility() override
    {
        return read_output(gpu_, output_);
    }
    bool stats(softsh_stats &) override
    {
        return false;
    }
    MemoryUse memory() const override
    {
        return {};
    }

  private:
    static void fill(peer_depth &out, const gpu_image &image, const Frustum &frustum)
    {
        out.view = image.view;
        out.layout = image.layout;
        out.format = image.format;
        out.width = image.width;
        out.height = image.height;
        to_library(frustum, out.view_matrix, out.projection);
    }

    gpu &gpu_;
    DeviceCase &case_;
    std::string name_;
    Queries queries_;
    size_t map_;
    gpu_image output_;
    peer *peer_ = nullptr;
};

} // namespace

std::unique_ptr<Estimator> make_peer_estimator(gpu &g, DeviceCase &device_case, const Technique &technique)
{
    return std::make_unique<PeerEstimator>(g, device_case, technique);
}
