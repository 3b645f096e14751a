// A peer that is one dispatch on the case's own depth buffers.
#include "estimators.hpp"

#include <algorithm>
#include <cstring>

#include "error.hpp"
#include "library_context.hpp"
#include "queries.hpp"

peer_depth to_peer(const gpu_image &image, const Frustum &frustum)
{
    peer_depth out{};
    out.view = image.view;
    out.layout = image.layout;
    out.format = image.format;
    out.width = image.width;
    out.height = image.height;
    to_library(frustum, out.view_matrix, out.projection);
    return out;
}

peer_light to_peer(const Light &light)
{
    const softsh_light from = to_library(light);
    peer_light out{};
    std::memcpy(out.center, from.center, sizeof out.center);
    std::memcpy(out.half_u, from.half_u, sizeof out.half_u);
    std::memcpy(out.half_v, from.half_v, sizeof out.half_v);
    std::memcpy(out.direction, from.direction, sizeof out.direction);
    out.angular_radius = from.angular_radius;
    return out;
}

namespace
{

// What a renderer that fits its near planes knows.
double nearest_blocker(const peer_inputs &inputs, const FloatImage &depth)
{
    float least = 1.0f, greatest = 0.0f;
    for (const float texel : depth.texels) {
        // NaN counts as far away.
        least = texel < least ? texel : least;
        greatest = texel > greatest ? texel : greatest;
    }
    return peer_nearest_blocker(&inputs.map, &inputs.light, static_cast<double>(std::max(least, 0.0f)),
                                static_cast<double>(std::min(greatest, 1.0f)));
}

class PeerEstimator final : public Estimator
{
  public:
    PeerEstimator(gpu &g, DeviceCase &device_case, const Technique &technique)
        : gpu_(g), case_(device_case), name_(technique.name), queries_(g, 2),
          map_(layer_maps(device_case.data, technique.layers).front()),
          output_(make_output(g, device_case.data.camera.depth))
    {
        const Case &data = case_.data;
        inputs_.camera = to_peer(case_.camera, data.camera.frustum);
        inputs_.map = to_peer(case_.maps[map_], data.maps[map_].frustum);
        inputs_.light = to_peer(data.light);
        inputs_.visibility = output_.view;
        peer_info info{};
        info.kind = technique.peer;
        info.settings = technique.peer_options;
        if (technique.fit_near)
            info.settings.nearest_blocker = nearest_blocker(inputs_, data.maps[map_].depth);
        info.directional = data.light.shape == LightShape::directional;
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
        const VkCommandBuffer cmd = gpu_begin(&gpu_);
        queries_.reset(cmd);
        gpu_cmd_image_layout(cmd, &output_, VK_IMAGE_LAYOUT_GENERAL);
        queries_.write(cmd, 0, true);
        const bool recorded = peer_record(&gpu_, peer_, cmd, &inputs_);
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
    gpu &gpu_;
    DeviceCase &case_;
    std::string name_;
    Queries queries_;
    size_t map_;
    gpu_image output_;
    peer_inputs inputs_{};
    peer *peer_ = nullptr;
};

} // namespace

std::unique_ptr<Estimator> make_peer_estimator(gpu &g, DeviceCase &device_case, const Technique &technique)
{
    return std::make_unique<PeerEstimator>(g, device_case, technique);
}
