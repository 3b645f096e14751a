#include "ray_scene.hpp"

#include <algorithm>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "error.hpp"

namespace
{

constexpr uint32_t widest_packet = 16;
// From this number of segments towards one light on, their packets are dense enough for a common traversal to pay.
constexpr uint32_t dense = 64;

bool count_bytes(void *total, ssize_t bytes, bool)
{
    *static_cast<std::atomic<int64_t> *>(total) += bytes;
    return true;
}

template <typename Packet, uint32_t width, typename Occluded>
uint32_t count_free_packets(const glm::vec3 &start, const SegmentList &segments, const Occluded &occluded)
{
    alignas(64) int valid[width];
    Packet rays;
    for (uint32_t i = 0; i < width; i++) {
        rays.org_x[i] = start.x;
        rays.org_y[i] = start.y;
        rays.org_z[i] = start.z;
        rays.tnear[i] = 0.0f;
        rays.time[i] = 0.0f;
        rays.mask[i] = 0xffffffffu;
        rays.id[i] = i;
        rays.flags[i] = 0;
    }
    uint32_t free = 0;
    for (uint32_t first = 0; first < segments.count; first += width) {
        const uint32_t used = std::min(width, segments.count - first);
        for (uint32_t i = 0; i < width; i++) {
            valid[i] = i < used ? -1 : 0;
            rays.dir_x[i] = segments.x[first + i];
            rays.dir_y[i] = segments.y[first + i];
            rays.dir_z[i] = segments.z[first + i];
            rays.tfar[i] = 1.0f;
        }
        occluded(valid, rays);
        for (uint32_t i = 0; i < used; i++)
            free += rays.tfar[i] >= 0.0f; // Embree marks a blocked ray by minus infinity
    }
    return free;
}

} // namespace

void SegmentList::resize(uint32_t n)
{
    count = n;
    const size_t padded = (static_cast<size_t>(n) + widest_packet - 1) / widest_packet * widest_packet;
    for (std::vector<float> *v : {&x, &y, &z})
        v->resize(padded);
}

RayScene::RayScene(const Mesh &mesh, RayAccuracy accuracy) : accuracy_(accuracy)
{
    device_ = rtcNewDevice(nullptr);
    if (!device_)
        fail("ray casting: Embree cannot start (error %d)", static_cast<int>(rtcGetDeviceError(nullptr)));
    rtcSetDeviceMemoryMonitorFunction(device_, count_bytes, &memory_);
    wide_ = rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
    try {
        build(mesh);
    } catch (...) {
        rtcReleaseDevice(device_);
        throw;
    }
}

RayScene::~RayScene()
{
    if (scene_)
        rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

void RayScene::build(const Mesh &mesh)
{
    if (scene_)
        rtcReleaseScene(scene_);
    scene_ = rtcNewScene(device_);
    // Fast scenes keep Embree's default quality: a higher one takes four times as long to build without robust rays,
    // and the rays were no faster for it.
    if (accuracy_ == RayAccuracy::robust) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    }
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    // Copied, because Embree reads 16 bytes at the last vertex.
    void *vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                             mesh.positions.size());
    void *indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t),
                                            mesh.triangle_count());
    if (vertices && indices) {
        std::copy(mesh.positions.begin(), mesh.positions.end(), static_cast<glm::vec3 *>(vertices));
        std::copy(mesh.indices.begin(), mesh.indices.begin() + static_cast<std::ptrdiff_t>(mesh.triangle_count() * 3),
                  static_cast<uint32_t *>(indices));
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
    }
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
    const RTCError error = rtcGetDeviceError(device_);
    if (error != RTC_ERROR_NONE) {
        rtcReleaseScene(scene_);
        scene_ = nullptr;
        fail("ray casting: Embree cannot build the scene (error %d)", static_cast<int>(error));
    }
}

int64_t RayScene::nearest(const glm::vec3 &origin, const glm::vec3 &direction, float t_near, float t_far) const
{
    RTCRayHit query{};
    query.ray.org_x = origin.x;
    query.ray.org_y = origin.y;
    query.ray.org_z = origin.z;
    query.ray.dir_x = direction.x;
    query.ray.dir_y = direction.y;
    query.ray.dir_z = direction.z;
    query.ray.tnear = t_near;
    query.ray.tfar = t_far;
    query.ray.mask = 0xffffffffu;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(scene_, &query, nullptr);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_, &context, &query);
#endif
    return query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? -1 : static_cast<int64_t>(query.hit.primID);
}

uint32_t RayScene::count_free(const glm::vec3 &start, const SegmentList &segments) const
{
#if RTC_VERSION_MAJOR >= 4
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.flags = segments.count >= dense ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    const auto occluded8 = [&](int *valid, RTCRay8 &rays) { rtcOccluded8(valid, scene_, &rays, &arguments); };
    const auto occluded16 = [&](int *valid, RTCRay16 &rays) { rtcOccluded16(valid, scene_, &rays, &arguments); };
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags =
        segments.count >= dense ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    const auto occluded8 = [&](int *valid, RTCRay8 &rays) { rtcOccluded8(valid, scene_, &context, &rays); };
    const auto occluded16 = [&](int *valid, RTCRay16 &rays) { rtcOccluded16(valid, scene_, &context, &rays); };
#endif
    return wide_ ? count_free_packets<RTCRay16, 16>(start, segments, occluded16)
                 : count_free_packets<RTCRay8, 8>(start, segments, occluded8);
}
