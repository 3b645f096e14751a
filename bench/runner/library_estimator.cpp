// The library itself: its occluders and its view for one case.
#include "estimators.hpp"

#include <cstring>

#include "error.hpp"
#include "library_context.hpp"
#include "queries.hpp"

namespace
{

void check(const gpu &g, bool ok)
{
    if (!ok)
        fail("%s", g.error);
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

} // namespace

std::unique_ptr<Estimator> make_library_estimator(gpu &g, DeviceCase &device_case, const Technique &technique,
                                                  bool stats)
{
    return std::make_unique<LibraryEstimator>(g, device_case, technique, stats);
}
