// A case's depth buffers as images on the device.
#include "device_case.hpp"

#include "error.hpp"

namespace
{

gpu_image upload(gpu &g, const FloatImage &depth)
{
    gpu_image image{};
    gpu_image_info info{};
    info.format = VK_FORMAT_D32_SFLOAT;
    info.width = depth.width;
    info.height = depth.height;
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    if (!gpu_image_create(&g, &info, &image))
        fail("%s", g.error);
    if (!gpu_image_upload(&g, &image, depth.texels.data(), depth.texels.size() * sizeof(float),
                          VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL)) {
        gpu_image_destroy(&g, &image);
        fail("%s", g.error);
    }
    return image;
}

} // namespace

DeviceCase::DeviceCase(gpu &g, const Case &case_data, const Scene *case_scene)
    : data(case_data), scene(case_scene), gpu_(g)
{
    camera = upload(g, data.camera.depth);
    try {
        for (const CaseMap &map : data.maps)
            maps.push_back(upload(g, map.depth));
    } catch (...) {
        gpu_image_destroy(&gpu_, &camera);
        for (gpu_image &image : maps)
            gpu_image_destroy(&gpu_, &image);
        throw;
    }
}

DeviceCase::~DeviceCase()
{
    gpu_image_destroy(&gpu_, &camera);
    for (gpu_image &image : maps)
        gpu_image_destroy(&gpu_, &image);
}

void DeviceCase::upload_map(size_t i)
{
    const FloatImage &depth = data.maps[i].depth;
    if (!gpu_image_upload(&gpu_, &maps[i], depth.texels.data(), depth.texels.size() * sizeof(float),
                          VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL))
        fail("%s", gpu_.error);
}
