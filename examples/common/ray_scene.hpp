// An Embree scene of one mesh; Embree 3 and 4 differ only in ray_scene.cpp.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "mesh.hpp"

struct RTCDeviceTy;
struct RTCSceneTy;

class RayScene
{
  public:
    // Copies what it needs. Throws Error.
    explicit RayScene(const Mesh &mesh);
    ~RayScene();
    RayScene(const RayScene &) = delete;
    RayScene &operator=(const RayScene &) = delete;

    // The nearest triangle along origin + t * direction with t in [t_near, t_far], or -1. Thread safe.
    int64_t nearest(const glm::vec3 &origin, const glm::vec3 &direction, float t_near, float t_far) const;

    // Of up to 8 segments from origin to origin + direction[i], how many are not blocked. Thread safe.
    uint32_t count_free(const glm::vec3 &origin, const glm::vec3 *directions, uint32_t count) const;

  private:
    RTCDeviceTy *device_ = nullptr;
    RTCSceneTy *scene_ = nullptr;
};
