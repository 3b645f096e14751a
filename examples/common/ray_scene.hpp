// An Embree scene of one mesh; Embree 3 and 4 differ only in ray_scene.cpp.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "mesh.hpp"

struct RTCDeviceTy;
struct RTCSceneTy;

// Segments from a common start, one per element; storage is padded so that whole packets of rays can be read.
struct SegmentList {
    std::vector<float> x, y, z; // from the start to the end
    uint32_t count = 0;

    void resize(uint32_t n);
};

enum class RayAccuracy {
    robust, // rays through shared edges never slip between triangles
    fast,
};

class RayScene
{
  public:
    // Copies what it needs. Throws Error.
    explicit RayScene(const Mesh &mesh, RayAccuracy accuracy = RayAccuracy::robust);
    ~RayScene();
    RayScene(const RayScene &) = delete;
    RayScene &operator=(const RayScene &) = delete;

    // Builds again from nothing, as for a mesh that has changed. Throws Error.
    void build(const Mesh &mesh);

    // The nearest triangle along origin + t * direction with t in [t_near, t_far], or -1. Thread safe.
    int64_t nearest(const glm::vec3 &origin, const glm::vec3 &direction, float t_near, float t_far) const;

    // How many of the segments from `start` are not blocked. Faster if neighbours in the list are neighbours in space.
    // Thread safe.
    uint32_t count_free(const glm::vec3 &start, const SegmentList &segments) const;

    // Bytes that Embree has allocated for the mesh and its hierarchy.
    uint64_t memory() const
    {
        return static_cast<uint64_t>(memory_.load());
    }

  private:
    RTCDeviceTy *device_ = nullptr;
    RTCSceneTy *scene_ = nullptr;
    RayAccuracy accuracy_;
    bool wide_ = false; // packets of 16
    std::atomic<int64_t> memory_{0};
};
