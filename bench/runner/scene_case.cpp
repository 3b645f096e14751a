// A case made from a scene.
#include "scene_case.hpp"

#include <cmath>

#include "error.hpp"
#include "truth.hpp"

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
    DepthTarget *previous = nullptr;
    for (uint32_t i = 0; i < options.layers; i++) {
        DepthTarget &layer = rasteriser.create_depth_target(size, size);
        rasteriser.depth(layer, scene.map, scene.origin, previous);
        previous = &layer;
        CaseMap map;
        map.frustum = scene.map;
        map.depth = read_depth(g, layer.image);
        map.index = i;
        data.maps.push_back(std::move(map));
    }
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
