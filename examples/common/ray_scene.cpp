#include "ray_scene.hpp"

#include <algorithm>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "error.hpp"

RayScene::RayScene(const Mesh &mesh)
{
    device_ = rtcNewDevice(nullptr);
    if (!device_)
        fail("ground truth: Embree cannot start (error %d)", static_cast<int>(rtcGetDeviceError(nullptr)));
    scene_ = rtcNewScene(device_);
    // Robust: rays through shared edges must not slip between triangles.
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
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
        rtcReleaseDevice(device_);
        fail("ground truth: Embree cannot build the scene (error %d)", static_cast<int>(error));
    }
}

RayScene::~RayScene()
{
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
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

uint32_t RayScene::count_free(const glm::vec3 &origin, const glm::vec3 *directions, uint32_t count) const
{
    alignas(32) int valid[8];
    RTCRay8 rays;
    for (uint32_t i = 0; i < 8; i++) {
        const glm::vec3 &d = directions[i < count ? i : 0];
        valid[i] = i < count ? -1 : 0;
        rays.org_x[i] = origin.x;
        rays.org_y[i] = origin.y;
        rays.org_z[i] = origin.z;
        rays.dir_x[i] = d.x;
        rays.dir_y[i] = d.y;
        rays.dir_z[i] = d.z;
        rays.tnear[i] = 0.0f;
        rays.tfar[i] = 1.0f;
        rays.time[i] = 0.0f;
        rays.mask[i] = 0xffffffffu;
        rays.id[i] = i;
        rays.flags[i] = 0;
    }
#if RTC_VERSION_MAJOR >= 4
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcOccluded8(valid, scene_, &rays, &arguments);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcOccluded8(valid, scene_, &context, &rays);
#endif
    uint32_t free = 0;
    for (uint32_t i = 0; i < count; i++)
        free += rays.tfar[i] >= 0.0f; // Embree marks a blocked ray by minus infinity
    return free;
}
