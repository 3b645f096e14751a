// A case made from a scene: the depth buffers that a renderer of that scene has, and the truth.
#pragma once

#include <optional>

#include "case_io.hpp"
#include "progress.hpp"
#include "raster.hpp"
#include "scene.hpp"

struct SceneCaseOptions {
    uint32_t width = 640, height = 480;
    uint32_t map_size = 0;  // edge in texels; 0: the scene's own
    uint32_t layers = 2;    // depth-peeled maps: the nearest surfaces, the nearest behind those
    uint32_t sublights = 0; // instead, a map for each of N x N parts of the light
};

// Renders the depth buffers; `pixels`, if not null, gets what shading needs. Throws Error.
Case render_case(gpu &g, const Scene &scene, const SceneCaseOptions &options, GBufferPixels *pixels = nullptr);

// Adds truth and mask: `samples` rays per pixel, kept in `cache_folder` unless that is empty.
void add_truth(Case &data, const Scene &scene, uint32_t samples, const std::string &cache_folder, Progress &progress);
