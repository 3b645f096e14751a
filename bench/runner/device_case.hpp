// A case's depth buffers as images on the device.
#pragma once

#include <vector>

#include "case_io.hpp"
#include "gpu.h"
#include "scene.hpp"

class DeviceCase
{
  public:
    // Depth goes to D32 images, in SHADER_READ_ONLY_OPTIMAL. `data` must outlive this, and so must `scene`, which is
    // what the case was rendered from, or null where that is not known. Throws Error.
    DeviceCase(gpu &g, const Case &data, const Scene *scene = nullptr);
    ~DeviceCase();
    DeviceCase(const DeviceCase &) = delete;
    DeviceCase &operator=(const DeviceCase &) = delete;

    // After data.maps[i] has changed; its size must not have. Nothing recorded before may be pending.
    void upload_map(size_t i);

    const Case &data;
    const Scene *scene;
    gpu_image camera{};
    std::vector<gpu_image> maps; // as data.maps

  private:
    gpu &gpu_;
};
