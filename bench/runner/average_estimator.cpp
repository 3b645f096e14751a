// The mean of hard shadows from many points of the light: for each of them the mesh's depth is rendered and every pixel
// tested against it. Needs the mesh itself, as a renderer has it.
#include "estimators.hpp"

#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "queries.hpp"
#include "raster.hpp"

namespace
{

// Maps per submission: few enough that none takes so long that a driver gives up on it.
constexpr uint32_t batch = 16;

void check(const gpu &g, bool ok)
{
    if (!ok)
        fail("%s", g.error);
}

// The pattern of bench/peers/shaders/taps.glsl: a Fibonacci lattice in [-1, 1]^2 or a Vogel spiral in the unit disc.
glm::dvec2 light_point(uint32_t i, uint32_t count, bool disc)
{
    const double x = (i + 0.5) / count;
    if (disc) {
        const double angle = i * 2.399963229728653; // the golden angle
        return std::sqrt(x) * glm::dvec2(std::cos(angle), std::sin(angle));
    }
    const double y = i * 0.6180339887498949 + 0.5;
    return glm::dvec2(x, y - std::floor(y)) * 2.0 - 1.0;
}

struct PointLight {
    Light light; // without size
    Frustum map;
};

// The map's projection centre is the point: a map seen from behind the light would not be that point's shadow.
PointLight rectangle_point(const Scene &scene, const glm::dvec2 &q)
{
    PointLight point{scene.light, scene.map};
    point.light.centre += scene.light.half_u * q.x + scene.light.half_v * q.y;
    point.light.half_u = point.light.half_v = glm::dvec3(0.0);
    point.map.view[3] = glm::dvec4(-(glm::dmat3(scene.map.view) * point.light.centre), 1.0);
    point.map.projection = perspective(scene.map_fov, 1.0, scene.map_range);
    return point;
}

// The scene's map sheared along the point's direction; its footprint stays where it is in the middle of the range.
PointLight directional_point(const Scene &scene, const glm::dvec2 &q)
{
    PointLight point{scene.light, scene.map};
    const glm::dvec2 slope = std::tan(scene.light.angular_radius) * q;
    const glm::dmat4 &projection = scene.map.projection;
    const double middle = (0.5 - projection[3][2]) / projection[2][2];
    glm::dmat4 shear(1.0);
    shear[2] += glm::dvec4(slope, 0.0, 0.0);
    shear[3] -= glm::dvec4(slope * middle, 0.0, 0.0);
    point.map.projection = projection * shear;
    point.light.direction =
        glm::normalize(glm::transpose(glm::dmat3(scene.map.view)) * glm::dvec3(-slope.x, -slope.y, 1.0));
    point.light.angular_radius = 0.0;
    return point;
}

class AverageEstimator final : public Estimator
{
  public:
    AverageEstimator(gpu &g, DeviceCase &device_case, const Technique &technique)
        : gpu_(g), case_(device_case), scene_(scene_of(device_case, technique)), queries_(g, 2 * batch + 1),
          rasteriser_(g), map_(make_map(device_case, *scene_)), output_(make_output(g, device_case.data.camera.depth))
    {
        const bool directional = scene_->light.shape == LightShape::directional;
        peer_info info{};
        info.kind = technique.peer;
        info.settings = technique.peer_options;
        info.settings.light_samples = info.settings.light_samples ? info.settings.light_samples : 64;
        info.directional = directional;
        info.max_recordings = batch;
        for (uint32_t i = 0; i < info.settings.light_samples; i++) {
            const glm::dvec2 q = light_point(i, info.settings.light_samples, directional);
            points_.push_back(directional ? directional_point(*scene_, q) : rectangle_point(*scene_, q));
        }
        if (!peer_create(&g, &info, &peer_)) {
            gpu_image_destroy(&gpu_, &output_);
            fail("%s", g.error);
        }
    }
    ~AverageEstimator() override
    {
        peer_destroy(&gpu_, peer_);
        gpu_image_destroy(&gpu_, &output_);
    }

    RunTimes run(bool) override
    {
        RunTimes times{{}, {{"average_maps", 0.0}, {"average_tests", 0.0}}};
        for (size_t first = 0; first < points_.size(); first += batch)
            run_batch(first, std::min(points_.size() - first, static_cast<size_t>(batch)), times.visibility);
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
        VkMemoryRequirements requirements{};
        vkGetImageMemoryRequirements(gpu_.device, map_.image.image, &requirements);
        return {0, requirements.size};
    }

  private:
    static const Scene *scene_of(const DeviceCase &device_case, const Technique &technique)
    {
        if (!device_case.scene)
            fail("technique %s needs the scene's mesh, which case %s does not have: render a --scene or a --model",
                 technique.name.c_str(), device_case.data.name.c_str());
        const LightShape shape = device_case.scene->light.shape;
        if (shape != LightShape::rectangle && shape != LightShape::directional)
            fail("technique %s supports rectangles and directional lights, not a %s", technique.name.c_str(),
                 light_shape_name(shape));
        return device_case.scene;
    }
    DepthTarget &make_map(const DeviceCase &device_case, const Scene &scene)
    {
        rasteriser_.set_mesh(scene.mesh);
        const std::vector<CaseMap> &maps = device_case.data.maps;
        const uint32_t size = maps.empty() ? scene.map_size : maps[0].depth.width;
        return rasteriser_.create_depth_target(size, size);
    }

    void run_batch(size_t first, size_t count, std::vector<PassTime> &times)
    {
        const VkCommandBuffer cmd = gpu_begin(&gpu_);
        check(gpu_, cmd != VK_NULL_HANDLE);
        queries_.reset(cmd);
        queries_.write(cmd, 0, true);
        if (first == 0)
            clear(cmd);
        bool recorded = true;
        for (uint32_t i = 0; i < count && recorded; i++) {
            const PointLight &point = points_[first + i];
            peer_inputs inputs{};
            rasteriser_.cmd_depth(cmd, map_, point.map, scene_->origin);
            queries_.write(cmd, 2 * i + 1, true);
            inputs.camera = to_peer(case_.camera, case_.data.camera.frustum);
            inputs.map = to_peer(map_.image, point.map);
            inputs.light = to_peer(point.light);
            inputs.visibility = output_.view;
            wait_for_sum(cmd);
            recorded = peer_record(&gpu_, peer_, cmd, &inputs);
            queries_.write(cmd, 2 * i + 2, true);
        }
        const std::string error = gpu_.error;
        check(gpu_, gpu_submit(&gpu_, cmd));
        if (!recorded)
            fail("%s", error.c_str());
        const std::vector<double> ms = queries_.differences(0, static_cast<uint32_t>(2 * count));
        for (size_t i = 0; i < ms.size(); i++)
            times[i % 2].ms += ms[i];
    }
    void clear(VkCommandBuffer cmd)
    {
        const VkClearColorValue zero{};
        const VkImageSubresourceRange all = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        gpu_cmd_image_layout(cmd, &output_, VK_IMAGE_LAYOUT_GENERAL);
        vkCmdClearColorImage(cmd, output_.image, VK_IMAGE_LAYOUT_GENERAL, &zero, 1, &all);
    }
    // The sum of the maps before this one, or its zeros.
    static void wait_for_sum(VkCommandBuffer cmd)
    {
        VkMemoryBarrier barrier{};
        barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
        barrier.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
        barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
        vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                             VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 1, &barrier, 0, nullptr, 0, nullptr);
    }

    gpu &gpu_;
    DeviceCase &case_;
    const Scene *scene_;
    Queries queries_;
    Rasteriser rasteriser_;
    DepthTarget &map_;
    gpu_image output_;
    std::vector<PointLight> points_;
    peer *peer_ = nullptr;
};

} // namespace

std::unique_ptr<Estimator> make_average_estimator(gpu &g, DeviceCase &device_case, const Technique &technique)
{
    return std::make_unique<AverageEstimator>(g, device_case, technique);
}
