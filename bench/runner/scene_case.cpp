// A case made from a scene.
#include "scene_case.hpp"

#include <cmath>

#include "error.hpp"
#include "truth.hpp"

namespace
{

void add_layers(gpu &g, Rasteriser &rasteriser, const Scene &scene, uint32_t size, uint32_t layers, Case &data)
{
    DepthTarget *previous = nullptr;
    for (uint32_t i = 0; i < layers; i++) {
        DepthTarget &layer = rasteriser.create_depth_target(size, size);
        rasteriser.depth(layer, scene.map, scene.origin, previous);
        previous = &layer;
        CaseMap map;
        map.frustum = scene.map;
        map.depth = read_depth(g, layer.image);
        map.index = i;
        data.maps.push_back(std::move(map));
    }
}

void add_sublights(gpu &g, Rasteriser &rasteriser, const Scene &scene, uint32_t size, uint32_t grid, Case &data)
{
    DepthTarget &target = rasteriser.create_depth_target(size, size);
    for (uint32_t j = 0; j < grid; j++)
        for (uint32_t i = 0; i < grid; i++) {
            CaseMap map;
            map.frustum = sub_light_frustum(scene, grid, i, j);
            rasteriser.depth(target, map.frustum, scene.origin);
            map.depth = read_depth(g, target.image);
            map.role = MapRole::sublight;
            map.grid[0] = map.grid[1] = grid;
            map.cell[0] = i;
            map.cell[1] = j;
            data.maps.push_back(std::move(map));
        }
}

} // namespace

Case render_case(gpu &g, const Scene &scene, const SceneCaseOptions &options, GBufferPixels *pixels)
{
    Case data;
    data.name = scene.name;
    data.light = scene.light;
    data.triangles = static_cast<uint32_t>(scene.mesh.triangle_count());
    Rasteriser rasteriser(g);
    rasteriser.set_mesh(scene.mesh);
    data.camera.frustum = camera_frustum(scene, options.width, options.height);
    if (pixels) {
        GBuffer &gbuffer = rasteriser.create_gbuffer(options.width, options.height);
        rasteriser.gbuffer(gbuffer, data.camera.frustum, scene.origin);
        *pixels = read_gbuffer(g, gbuffer);
        data.camera.depth = pixels->depth;
    } else {
        DepthTarget &target = rasteriser.create_depth_target(options.width, options.height);
        rasteriser.depth(target, data.camera.frustum, scene.origin);
        data.camera.depth = read_depth(g, target.image);
    }

    const uint32_t size = options.map_size ? options.map_size : scene.map_size;
    if (options.sublights)
        add_sublights(g, rasteriser, scene, size, options.sublights, data);
    else
        add_layers(g, rasteriser, scene, size, options.layers, data);
    return data;
}

void add_truth(Case &data, const Scene &scene, uint32_t samples, const std::string &cache_folder, Progress &progress)
{
    TruthOptions options;
    options.samples = samples;
    if (scene.light.shape == LightShape::rectangle)
        options.light_near = scene.map_range.near_plane; // nothing nearer is in the map
    const auto report = [&](double done) { progress.fraction(done); };
    Truth truth = cache_folder.empty()
                      ? compute_truth(scene.mesh, scene.origin, data.camera, scene.light, options, report)
                      : cached_truth(cache_folder, scene.mesh, scene.origin, data.camera, scene.light, options, report);
    data.truth = std::move(truth.visibility);
    data.mask = std::move(truth.mask);
    const uint32_t edge = static_cast<uint32_t>(std::sqrt(static_cast<double>(samples)) + 1e-9);
    data.truth_light_samples = edge * edge;
}
