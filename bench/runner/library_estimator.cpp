// The library itself: its occluders and its view for one case; of each sub-light, or one for all of them.
#include "estimators.hpp"

#include <algorithm>
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
        : gpu_(g), case_(device_case), library_(g), maps_(sublight_maps(device_case.data, technique.layers)),
          queries_(g, static_cast<uint32_t>(2 * maps_.size()) * query_count), reuse_(technique.reuse),
          output_(make_output(g, device_case.data.camera.depth))
    {
        const Case &data = case_.data;
        try {
            softsh_occluders_info occluders{};
            occluders.struct_size = sizeof occluders;
            for (const CaseMap &map : data.maps) {
                occluders.max_extent.width = std::max(occluders.max_extent.width, map.depth.width);
                occluders.max_extent.height = std::max(occluders.max_extent.height, map.depth.height);
            }
            occluders.max_layers = static_cast<uint32_t>(maps_[0].size());
            occluders.max_recordings = static_cast<uint32_t>(maps_.size());
            occluders.accel = technique.accel;
            occluders.no_folds = technique.library.technique != SOFTSH_TECHNIQUE_AUTO && !technique.library.outline &&
                                 technique.library.reconstruction <= SOFTSH_RECONSTRUCTION_JOINED;
            occluders.dual_grids = technique.library.search == SOFTSH_SEARCH_WALK;
            occluders_.resize(reuse_ ? 1 : maps_.size());
            for (softsh_occluders *&o : occluders_)
                library_.check(softsh_occluders_create(library_.context, &occluders, &o));
            softsh_view_info view{};
            view.struct_size = sizeof view;
            view.max_extent = {data.camera.depth.width, data.camera.depth.height};
            view.output_format = VK_FORMAT_R32_SFLOAT;
            view.settings = technique.automatic ? nullptr : &technique.library;
            view.stats = stats;
            view.sublights = maps_.size() > 1;
            view.max_recordings = static_cast<uint32_t>(maps_.size());
            library_.check(softsh_view_create(library_.context, &view, &view_));
            if (stats)
                check(gpu_, gpu_buffer_create(&gpu_, maps_.size() * sizeof(softsh_stats),
                                              VK_BUFFER_USAGE_TRANSFER_DST_BIT, true, &stats_));
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
        std::vector<softsh_timestamps> stamps(2 * maps_.size());
        for (size_t i = 0; i < stamps.size(); i++) {
            stamps[i].struct_size = sizeof stamps[i];
            stamps[i].pool = queries_.pool;
            stamps[i].first_query = static_cast<uint32_t>(i) * query_count;
            stamps[i].query_count = query_count;
        }
        const VkCommandBuffer cmd = gpu_begin(&gpu_);
        queries_.reset(cmd);
        gpu_cmd_image_layout(cmd, &output_, VK_IMAGE_LAYOUT_GENERAL);
        for (size_t i = 0; i < maps_.size(); i++) {
            if (build || !built_ || reuse_)
                record_build(cmd, i, &stamps[2 * i]);
            record_visibility(cmd, i, &stamps[2 * i + 1]);
        }
        built_ = true;
        check(gpu_, gpu_submit(&gpu_, cmd));
        for (size_t i = 0; i < maps_.size(); i++) {
            collect(stamps[2 * i], times.build);
            collect(stamps[2 * i + 1], times.visibility);
        }
        return times;
    }
    FloatImage visibility() override
    {
        return read_output(gpu_, output_);
    }
    bool stats(softsh_stats &out) override
    {
        if (!stats_.mapped)
            return false;
        std::vector<softsh_stats> all(maps_.size());
        std::memcpy(all.data(), stats_.mapped, all.size() * sizeof all[0]);
        out = sum(all);
        return true;
    }
    MemoryUse memory() const override
    {
        VkMemoryRequirements persistent{}, transient{};
        softsh_occluders_memory_requirements(occluders_[0], &persistent);
        softsh_view_memory_requirements(view_, &transient);
        return {occluders_.size() * persistent.size, transient.size};
    }

  private:
    static constexpr uint32_t query_count = SOFTSH_MAX_PASSES + 1;

    // Counts add up; levels built are those of one structure.
    static softsh_stats sum(const std::vector<softsh_stats> &all)
    {
        softsh_stats total = all[0];
        for (size_t i = 1; i < all.size(); i++)
            for (uint64_t softsh_stats::*count :
                 {&softsh_stats::pixels, &softsh_stats::lit, &softsh_stats::umbra, &softsh_stats::active,
                  &softsh_stats::nodes, &softsh_stats::primitives, &softsh_stats::tiles, &softsh_stats::undecided_tiles,
                  &softsh_stats::clamped, &softsh_stats::interpolated, &softsh_stats::packets,
                  &softsh_stats::incoherent, &softsh_stats::diverged, &softsh_stats::edges, &softsh_stats::visited,
                  &softsh_stats::refined})
                total.*count += all[i].*count;
        return total;
    }
    softsh_occluders *occluders(size_t sublight) const
    {
        return occluders_[reuse_ ? 0 : sublight];
    }
    void record_build(VkCommandBuffer cmd, size_t sublight, softsh_timestamps *timestamps)
    {
        const Case &data = case_.data;
        std::vector<softsh_map> maps;
        for (size_t i = 0; i < maps_[sublight].size(); i++) {
            const size_t from = maps_[sublight][i];
            const gpu_image &image = case_.maps[from];
            softsh_map map{};
            map.struct_size = sizeof map;
            map.role = data.maps[from].role == MapRole::sublight ? SOFTSH_MAP_SUBLIGHT : SOFTSH_MAP_LAYER;
            if (map.role == SOFTSH_MAP_SUBLIGHT) {
                std::copy_n(data.maps[from].grid, 2, map.grid);
                std::copy_n(data.maps[from].cell, 2, map.cell);
            }
            map.index = static_cast<uint32_t>(i);
            map.view = image.view;
            map.format = image.format;
            map.layout = image.layout;
            map.image_extent = {image.width, image.height};
            to_library(data.maps[from].frustum, map.view_matrix, map.projection);
            maps.push_back(map);
        }
        const softsh_light light = to_library(data.light);
        softsh_build_info info{};
        info.struct_size = sizeof info;
        info.light = &light;
        info.map_count = static_cast<uint32_t>(maps.size());
        info.maps = maps.data();
        info.timestamps = timestamps;
        library_.check(softsh_cmd_build_occluders(cmd, occluders(sublight), &info));
    }
    void record_visibility(VkCommandBuffer cmd, size_t sublight, softsh_timestamps *timestamps)
    {
        softsh_camera camera{};
        camera.struct_size = sizeof camera;
        camera.depth = case_.camera.view;
        camera.depth_format = case_.camera.format;
        camera.depth_layout = case_.camera.layout;
        to_library(case_.data.camera.frustum, camera.view_matrix, camera.projection);
        softsh_visibility_info info{};
        info.struct_size = sizeof info;
        info.occluders = occluders(sublight);
        info.camera_count = 1;
        info.cameras = &camera;
        info.visibility = output_.view;
        info.stats_buffer = stats_.buffer;
        info.stats_offset = sublight * sizeof(softsh_stats);
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
        for (softsh_occluders *o : occluders_)
            softsh_occluders_destroy(o);
        gpu_image_destroy(&gpu_, &output_);
        if (stats_.buffer)
            gpu_buffer_destroy(&gpu_, &stats_);
    }

    gpu &gpu_;
    DeviceCase &case_;
    LibraryContext library_;
    std::vector<std::vector<size_t>> maps_; // layers of each sub-light
    Queries queries_;
    bool reuse_;
    gpu_image output_;
    gpu_buffer stats_{};
    std::vector<softsh_occluders *> occluders_;
    softsh_view *view_ = nullptr;
    bool built_ = false;
};

} // namespace

std::unique_ptr<Estimator> make_library_estimator(gpu &g, DeviceCase &device_case, const Technique &technique,
                                                  bool stats)
{
    return std::make_unique<LibraryEstimator>(g, device_case, technique, stats);
}
