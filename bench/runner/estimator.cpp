// Sets up and runs one technique for one case.
#include "estimator.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <glm/gtc/type_ptr.hpp>

#include "error.hpp"

namespace
{

void on_message(void *user, softsh_result, const char *message)
{
    *static_cast<std::string *>(user) = message;
}

void check(const gpu &g, bool ok)
{
    if (!ok)
        fail("%s", g.error);
}

// Timestamps of one recording.
class Queries
{
  public:
    explicit Queries(gpu &g, uint32_t count) : gpu_(g), count_(count)
    {
        VkQueryPoolCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
        info.queryType = VK_QUERY_TYPE_TIMESTAMP;
        info.queryCount = count;
        if (vkCreateQueryPool(g.device, &info, nullptr, &pool) != VK_SUCCESS)
            fail("vkCreateQueryPool failed");
    }
    ~Queries()
    {
        vkDestroyQueryPool(gpu_.device, pool, nullptr);
    }
    Queries(const Queries &) = delete;
    Queries &operator=(const Queries &) = delete;

    void reset(VkCommandBuffer cmd)
    {
        vkCmdResetQueryPool(cmd, pool, 0, count_);
    }
    // Milliseconds between query i and query i + 1.
    std::vector<double> differences(uint32_t first, uint32_t n)
    {
        std::vector<uint64_t> ticks(n + 1);
        if (vkGetQueryPoolResults(gpu_.device, pool, first, n + 1, ticks.size() * sizeof(uint64_t), ticks.data(),
                                  sizeof(uint64_t), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT) != VK_SUCCESS)
            fail("vkGetQueryPoolResults failed");
        std::vector<double> ms(n);
        for (uint32_t i = 0; i < n; i++)
            ms[i] = static_cast<double>(ticks[i + 1] - ticks[i]) * 1e-6 *
                    static_cast<double>(gpu_.properties.limits.timestampPeriod);
        return ms;
    }

    VkQueryPool pool = VK_NULL_HANDLE;

  private:
    gpu &gpu_;
    uint32_t count_;
};

gpu_image make_output(gpu &g, const FloatImage &size)
{
    gpu_image image{};
    gpu_image_info info{};
    info.format = VK_FORMAT_R32_SFLOAT;
    info.width = size.width;
    info.height = size.height;
    info.usage = VK_IMAGE_USAGE_STORAGE_BIT;
    check(g, gpu_image_create(&g, &info, &image));
    return image;
}

FloatImage read_output(gpu &g, gpu_image &image)
{
    FloatImage result(image.width, image.height);
    check(g, gpu_image_read(&g, &image, result.texels.data(), result.texels.size() * sizeof(float)));
    return result;
}

// Layer maps in order of their index, at most `limit`.
std::vector<size_t> layer_maps(const Case &data, std::optional<uint32_t> limit)
{
    std::vector<size_t> maps;
    for (size_t i = 0; i < data.maps.size(); i++) {
        if (data.maps[i].role != MapRole::layer)
            fail("case %s: maps[%zu] has role %s, which the library does not support yet", data.name.c_str(), i,
                 map_role_name(data.maps[i].role));
        maps.push_back(i);
    }
    std::sort(maps.begin(), maps.end(), [&](size_t a, size_t b) { return data.maps[a].index < data.maps[b].index; });
    if (limit && maps.size() < *limit)
        fail("setting layers is %u, but case %s has %zu layer maps", *limit, data.name.c_str(), maps.size());
    if (limit)
        maps.resize(*limit);
    return maps;
}

class LibraryEstimator final : public Estimator
{
  public:
    LibraryEstimator(gpu &g, DeviceCase &device_case, const Technique &technique, bool stats)
        : gpu_(g), case_(device_case), library_(g), queries_(g, 2 * query_count),
          maps_(layer_maps(device_case.data, technique.layers)), output_(make_output(g, device_case.data.camera.depth))
    {
        const Case &data = case_.data;
        try {
            softsh_occluders_info occluders{};
            occluders.struct_size = sizeof occluders;
            occluders.max_extent = {data.maps[maps_[0]].depth.width, data.maps[maps_[0]].depth.height};
            occluders.max_layers = static_cast<uint32_t>(maps_.size());
            occluders.accel = technique.accel;
            library_.check(softsh_occluders_create(library_.context, &occluders, &occluders_));
            softsh_view_info view{};
            view.struct_size = sizeof view;
            view.max_extent = {data.camera.depth.width, data.camera.depth.height};
            view.output_format = VK_FORMAT_R32_SFLOAT;
            view.settings = technique.automatic ? nullptr : &technique.library;
            view.stats = stats;
            library_.check(softsh_view_create(library_.context, &view, &view_));
            if (stats)
                check(gpu_,
                      gpu_buffer_create(&gpu_, sizeof(softsh_stats), VK_BUFFER_USAGE_TRANSFER_DST_BIT, true, &stats_));
        } catch (...) {
            release();
            throw;
        }
    }
    ~LibraryEstimator() override
    {
        release();
    }

    RunTimes run(bool build) override
    {
        RunTimes times;
        softsh_timestamps build_times{}, visibility_times{};
        for (softsh_timestamps *t : {&build_times, &visibility_times}) {
            t->struct_size = sizeof *t;
            t->pool = queries_.pool;
            t->query_count = query_count;
        }
        visibility_times.first_query = query_count;
        const VkCommandBuffer cmd = gpu_begin(&gpu_);
        queries_.reset(cmd);
        gpu_cmd_image_layout(cmd, &output_, VK_IMAGE_LAYOUT_GENERAL);
        if (build || !built_)
            record_build(cmd, &build_times);
        record_visibility(cmd, &visibility_times);
        check(gpu_, gpu_submit(&gpu_, cmd));
        collect(build_times, times.build);
        collect(visibility_times, times.visibility);
        return times;
    }
    FloatImage visibility() override
    {
        return read_output(gpu_, output_);
    }
    bool stats(softsh_stats &out) override
    {
        if (stats_.mapped)
            std::memcpy(&out, stats_.mapped, sizeof out);
        return stats_.mapped != nullptr;
    }
    MemoryUse memory() const override
    {
        VkMemoryRequirements persistent{}, transient{};
        softsh_occluders_memory_requirements(occluders_, &persistent);
        softsh_view_memory_requirements(view_, &transient);
        return {persistent.size, transient.size};
    }

  private:
    static constexpr uint32_t query_count = SOFTSH_MAX_PASSES + 1;

    void record_build(VkCommandBuffer cmd, softsh_timestamps *timestamps)
    {
        const Case &data = case_.data;
        std::vector<softsh_map> maps;
        for (size_t i = 0; i < maps_.size(); i++) {
            const gpu_image &image = case_.maps[maps_[i]];
            softsh_map map{};
            map.struct_size = sizeof map;
            map.role = SOFTSH_MAP_LAYER;
            map.index = static_cast<uint32_t>(i);
            map.view = image.view;
            map.format = image.format;
            map.layout = image.layout;
            map.image_extent = {image.width, image.height};
            to_library(data.maps[maps_[i]].frustum, map.view_matrix, map.projection);
            maps.push_back(map);
        }
        const softsh_light light = to_library(data.light);
        softsh_build_info info{};
        info.struct_size = sizeof info;
        info.light = &light;
        info.map_count = static_cast<uint32_t>(maps.size());
        info.maps = maps.data();
        info.timestamps = timestamps;
        library_.check(softsh_cmd_build_occluders(cmd, occluders_, &info));
        built_ = true;
    }
    void record_visibility(VkCommandBuffer cmd, softsh_timestamps *timestamps)
    {
        softsh_camera camera{};
        camera.struct_size = sizeof camera;
        camera.depth = case_.camera.view;
        camera.depth_format = case_.camera.format;
        camera.depth_layout = case_.camera.layout;
        to_library(case_.data.camera.frustum, camera.view_matrix, camera.projection);
        softsh_visibility_info info{};
        info.struct_size = sizeof info;
        info.occluders = occluders_;
        info.camera_count = 1;
        info.cameras = &camera;
        info.visibility = output_.view;
        info.stats_buffer = stats_.buffer;
        info.timestamps = timestamps;
        library_.check(softsh_cmd_compute_visibility(cmd, view_, &info));
    }
    void collect(const softsh_timestamps &timestamps, std::vector<PassTime> &out)
    {
        if (timestamps.pass_count == 0)
            return;
        const std::vector<double> ms = queries_.differences(timestamps.first_query, timestamps.pass_count);
        for (uint32_t i = 0; i < timestamps.pass_count; i++)
            out.push_back({timestamps.pass_names[i], ms[i]});
    }
    void release()
    {
        softsh_view_destroy(view_);
        softsh_occluders_destroy(occluders_);
        gpu_image_destroy(&gpu_, &output_);
        if (stats_.buffer)
            gpu_buffer_destroy(&gpu_, &stats_);
    }

    gpu &gpu_;
    DeviceCase &case_;
    LibraryContext library_;
    Queries queries_;
    std::vector<size_t> maps_;
    gpu_image output_;
    gpu_buffer stats_{};
    softsh_occluders *occluders_ = nullptr;
    softsh_view *view_ = nullptr;
    bool built_ = false;
};

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
        vkCmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries_.pool, 0);
        const bool recorded = peer_record(&gpu_, peer_, cmd, &inputs);
        const std::string error = gpu_.error;
        vkCmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries_.pool, 1);
        check(gpu_, gpu_submit(&gpu_, cmd));
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

LibraryContext::LibraryContext(gpu &g)
{
    softsh_context_info info{};
    info.struct_size = sizeof info;
    info.instance = g.instance;
    info.physical_device = g.physical_device;
    info.device = g.device;
    info.get_instance_proc_addr = vkGetInstanceProcAddr;
    info.get_device_proc_addr = vkGetDeviceProcAddr;
    info.message = on_message;
    info.message_user = &last_message;
    check(softsh_context_create(&info, &context));
}

LibraryContext::~LibraryContext()
{
    softsh_context_destroy(context);
}

void LibraryContext::check(softsh_result result) const
{
    if (result != SOFTSH_SUCCESS)
        fail("%s (%s)", last_message.c_str(), softsh_result_string(result));
}

softsh_light to_library(const Light &light)
{
    softsh_light out{};
    out.struct_size = sizeof out;
    switch (light.shape) {
    case LightShape::rectangle:
        out.shape = SOFTSH_LIGHT_RECTANGLE;
        break;
    case LightShape::disc:
        out.shape = SOFTSH_LIGHT_DISC;
        break;
    case LightShape::sphere:
        out.shape = SOFTSH_LIGHT_SPHERE;
        break;
    case LightShape::directional:
        out.shape = SOFTSH_LIGHT_DIRECTIONAL;
        break;
    }
    for (int i = 0; i < 3; i++) {
        out.center[i] = light.centre[i];
        out.half_u[i] = light.half_u[i];
        out.half_v[i] = light.half_v[i];
        out.direction[i] = light.direction[i];
    }
    out.angular_radius = light.angular_radius;
    return out;
}

void to_library(const Frustum &frustum, double view[16], double projection[16])
{
    std::memcpy(view, glm::value_ptr(frustum.view), 16 * sizeof(double));
    std::memcpy(projection, glm::value_ptr(frustum.projection), 16 * sizeof(double));
}

std::unique_ptr<Estimator> make_estimator(gpu &g, DeviceCase &device_case, const Technique &technique, bool stats)
{
    if (technique.is_peer)
        return std::make_unique<PeerEstimator>(g, device_case, technique);
    return std::make_unique<LibraryEstimator>(g, device_case, technique, stats);
}
