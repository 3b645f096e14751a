// Chooses the estimator of a technique.
#include "estimators.hpp"

#include <algorithm>
#include <chrono>

#include "error.hpp"

gpu_image make_output(gpu &g, const FloatImage &size)
{
    gpu_image image{};
    gpu_image_info info{};
    info.format = VK_FORMAT_R32_SFLOAT;
    info.width = size.width;
    info.height = size.height;
    info.usage = VK_IMAGE_USAGE_STORAGE_BIT;
    if (!gpu_image_create(&g, &info, &image))
        fail("%s", g.error);
    return image;
}

FloatImage read_output(gpu &g, gpu_image &image)
{
    FloatImage result(image.width, image.height);
    if (!gpu_image_read(&g, &image, result.texels.data(), result.texels.size() * sizeof(float)))
        fail("%s", g.error);
    return result;
}

std::vector<size_t> layer_maps(const Case &data, std::optional<uint32_t> limit)
{
    std::vector<size_t> maps;
    for (size_t i = 0; i < data.maps.size(); i++) {
        if (data.maps[i].role != MapRole::layer)
            fail("case %s: maps[%zu] has role %s, which this technique does not support", data.name.c_str(), i,
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

std::vector<std::vector<size_t>> sublight_maps(const Case &data, std::optional<uint32_t> limit)
{
    if (data.maps[0].role != MapRole::sublight)
        return {layer_maps(data, limit)};
    if (limit && *limit > 1)
        fail("setting layers is %u, but case %s has sub-lights of one layer", *limit, data.name.c_str());
    std::vector<std::vector<size_t>> groups(data.maps.size());
    for (size_t i = 0; i < data.maps.size(); i++)
        groups[data.maps[i].cell[0] + data.maps[i].grid[0] * data.maps[i].cell[1]].push_back(i);
    return groups;
}

RunTimes timed_run(Estimator &estimator, bool build)
{
    const auto start = std::chrono::steady_clock::now();
    RunTimes times = estimator.run(build);
    times.wall_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return times;
}

std::unique_ptr<Estimator> make_estimator(gpu &g, DeviceCase &device_case, const Technique &technique, bool stats)
{
    switch (technique.kind) {
    case TechniqueKind::library:
        return make_library_estimator(g, device_case, technique, stats);
    case TechniqueKind::dispatch:
        return make_peer_estimator(g, device_case, technique);
    case TechniqueKind::average:
        return make_average_estimator(g, device_case, technique);
    case TechniqueKind::embree:
        return make_embree_estimator(device_case, technique);
    }
    fail("technique %s has no estimator", technique.name.c_str());
}
