// Drawing and targets; pipelines are made in raster_pipeline.cpp.
#include "raster.hpp"

#include <cstring>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>

#include "error.hpp"
#include "raster_constants.hpp"

static void check(bool ok, const gpu &g)
{
    if (!ok)
        fail("rendering: %s", g.error);
}

void Rasteriser::upload(gpu_buffer &buffer, const void *data, size_t size, VkBufferUsageFlags usage)
{
    gpu_buffer staging{};
    check(gpu_buffer_create(&gpu_, size, usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT, false, &buffer), gpu_);
    check(gpu_buffer_create(&gpu_, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, true, &staging), gpu_);
    std::memcpy(staging.mapped, data, size);
    bool ok = false;
    if (const VkCommandBuffer cmd = gpu_begin(&gpu_)) {
        const VkBufferCopy copy = {0, 0, size};
        VkMemoryBarrier barrier{};
        barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
        barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        barrier.dstAccessMask = VK_ACCESS_VERTEX_ATTRIBUTE_READ_BIT | VK_ACCESS_INDEX_READ_BIT;
        vkCmdCopyBuffer(cmd, staging.buffer, buffer.buffer, 1, &copy);
        vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_VERTEX_INPUT_BIT, 0, 1, &barrier, 0,
                             nullptr, 0, nullptr);
        ok = gpu_submit(&gpu_, cmd);
    }
    gpu_buffer_destroy(&gpu_, &staging);
    check(ok, gpu_);
}

void Rasteriser::set_mesh(const Mesh &mesh)
{
    free_mesh();
    if (mesh.indices.empty())
        fail("rendering: the mesh has no triangles");
    if (mesh.indices.size() > UINT32_MAX)
        fail("rendering: the mesh has more than %u indices", UINT32_MAX);
    const size_t size = mesh.positions.size() * sizeof(glm::vec3);
    upload(positions_, mesh.positions.data(), size, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    upload(normals_, mesh.normals.data(), size, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    upload(colours_, mesh.colours.data(), size, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    upload(indices_, mesh.indices.data(), mesh.indices.size() * sizeof(uint32_t), VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    index_count_ = static_cast<uint32_t>(mesh.indices.size());
}

void Rasteriser::free_mesh()
{
    for (gpu_buffer *buffer : {&positions_, &normals_, &colours_, &indices_})
        gpu_buffer_destroy(&gpu_, buffer);
    index_count_ = 0;
}

DepthTarget &Rasteriser::create_depth_target(uint32_t width, uint32_t height, VkFormat format)
{
    gpu_image_info info{};
    info.format = format;
    info.width = width;
    info.height = height;
    info.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    DepthTarget &target = depth_targets_.emplace_back();
    check(gpu_image_create(&gpu_, &info, &target.image), gpu_);
    target.framebuffer = create_framebuffer(render_pass(Pass::depth, format), {target.image.view}, width, height);

    const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};
    VkDescriptorPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool.maxSets = 1;
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    if (vkCreateDescriptorPool(gpu_.device, &pool, nullptr, &target.pool) != VK_SUCCESS)
        fail("rendering: no descriptor pool");
    VkDescriptorSetAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    allocate.descriptorPool = target.pool;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &set_layout_;
    if (vkAllocateDescriptorSets(gpu_.device, &allocate, &target.set) != VK_SUCCESS)
        fail("rendering: no descriptor set");
    const VkDescriptorImageInfo image = {sampler_, target.image.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = target.set;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    write.pImageInfo = &image;
    vkUpdateDescriptorSets(gpu_.device, 1, &write, 0, nullptr);
    return target;
}

GBuffer &Rasteriser::create_gbuffer(uint32_t width, uint32_t height)
{
    gpu_image_info info{};
    info.width = width;
    info.height = height;
    info.format = VK_FORMAT_D32_SFLOAT;
    info.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    GBuffer &target = gbuffers_.emplace_back();
    check(gpu_image_create(&gpu_, &info, &target.depth), gpu_);
    info.format = VK_FORMAT_R16G16B16A16_SFLOAT;
    info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    check(gpu_image_create(&gpu_, &info, &target.normal), gpu_);
    info.format = VK_FORMAT_R8G8B8A8_UNORM;
    check(gpu_image_create(&gpu_, &info, &target.albedo), gpu_);
    target.framebuffer = create_framebuffer(render_pass(Pass::gbuffer, VK_FORMAT_D32_SFLOAT),
                                            {target.depth.view, target.normal.view, target.albedo.view}, width, height);
    return target;
}

void Rasteriser::destroy(DepthTarget &target)
{
    vkDestroyDescriptorPool(gpu_.device, target.pool, nullptr);
    vkDestroyFramebuffer(gpu_.device, target.framebuffer, nullptr);
    gpu_image_destroy(&gpu_, &target.image);
    depth_targets_.remove_if([&](const DepthTarget &other) { return &other == &target; });
}

void Rasteriser::destroy(GBuffer &target)
{
    vkDestroyFramebuffer(gpu_.device, target.framebuffer, nullptr);
    for (gpu_image *image : {&target.depth, &target.normal, &target.albedo})
        gpu_image_destroy(&gpu_, image);
    gbuffers_.remove_if([&](const GBuffer &other) { return &other == &target; });
}

// Where the viewer is in mesh space: the point all view rays meet in, or the direction they come from (w = 0).
static glm::dvec4 find_eye(const Frustum &frustum, const glm::dvec3 &origin)
{
    const glm::dmat4 inverse = glm::inverse(frustum.projection * frustum.view);
    // Clip-space points (0, 0, z, 0) are the eye for every projection that keeps lines.
    const glm::dvec4 eye = inverse * glm::dvec4(0.0, 0.0, frustum.reversed ? 1.0 : -1.0, 0.0);
    if (glm::abs(eye.w) > 1e-12 * glm::length(glm::dvec3(eye)))
        return glm::dvec4(glm::dvec3(eye) / eye.w - origin, 1.0);
    return glm::dvec4(glm::normalize(glm::dvec3(eye)), 0.0);
}

void Rasteriser::draw(VkCommandBuffer cmd, const PipelineKey &key, VkFramebuffer framebuffer, uint32_t width,
                      uint32_t height, const Frustum &frustum, const glm::dvec3 &origin, const DepthTarget *first_layer)
{
    if (index_count_ == 0)
        fail("rendering: no mesh was set");
    VkClearValue clear[3] = {};
    clear[0].depthStencil = {frustum.reversed ? 0.0f : 1.0f, 0};
    VkRenderPassBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    begin.renderPass = render_pass(key.pass, key.format);
    begin.framebuffer = framebuffer;
    begin.renderArea.extent = {width, height};
    begin.clearValueCount = key.pass == Pass::gbuffer ? 3 : 1;
    begin.pClearValues = clear;

    RasterConstants constants{};
    // Combined in double precision, so that a far-away origin cancels before anything becomes a float.
    constants.mesh_to_clip = glm::mat4(frustum.projection * (frustum.view * glm::translate(glm::dmat4(1.0), origin)));
    constants.eye = glm::vec4(find_eye(frustum, origin));
    constants.depth_sign = frustum.reversed ? -1.0f : 1.0f;
    // A fragment's depth is not yet rounded to the format; the first layer's is. (A little over half a step, for the
    // rounding that comes before.)
    if (first_layer && first_layer->image.format == VK_FORMAT_D16_UNORM)
        constants.depth_step = 0.51f / 65535.0f;
    else if (first_layer && first_layer->image.format != VK_FORMAT_D32_SFLOAT &&
             first_layer->image.format != VK_FORMAT_D32_SFLOAT_S8_UINT)
        constants.depth_step = 1.0f / 16777215.0f;

    const VkViewport viewport = {0.0f, 0.0f, static_cast<float>(width), static_cast<float>(height), 0.0f, 1.0f};
    const VkBuffer buffers[] = {positions_.buffer, normals_.buffer, colours_.buffer};
    const VkDeviceSize offsets[] = {0, 0, 0};
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline(key));
    vkCmdSetViewport(cmd, 0, 1, &viewport);
    vkCmdSetScissor(cmd, 0, 1, &begin.renderArea);
    vkCmdPushConstants(cmd, layout_, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof constants,
                       &constants);
    if (first_layer)
        vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1, &first_layer->set, 0, nullptr);
    vkCmdBindVertexBuffers(cmd, 0, 3, buffers, offsets);
    vkCmdBindIndexBuffer(cmd, indices_.buffer, 0, VK_INDEX_TYPE_UINT32);
    vkCmdDrawIndexed(cmd, index_count_, 1, 0, 0, 0);
    vkCmdEndRenderPass(cmd);
}

void Rasteriser::cmd_depth(VkCommandBuffer cmd, DepthTarget &target, const Frustum &frustum, const glm::dvec3 &origin,
                           const DepthTarget *first_layer)
{
    if (first_layer && (first_layer == &target || first_layer->image.width != target.image.width ||
                        first_layer->image.height != target.image.height))
        fail("rendering: the first layer must be another target of the same size");
    draw(cmd, {first_layer ? Pass::peel : Pass::depth, target.image.format, frustum.reversed}, target.framebuffer,
         target.image.width, target.image.height, frustum, origin, first_layer);
    target.image.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
}

void Rasteriser::cmd_gbuffer(VkCommandBuffer cmd, GBuffer &target, const Frustum &frustum, const glm::dvec3 &origin)
{
    draw(cmd, {Pass::gbuffer, target.depth.format, frustum.reversed}, target.framebuffer, target.depth.width,
         target.depth.height, frustum, origin, nullptr);
    for (gpu_image *image : {&target.depth, &target.normal, &target.albedo})
        image->layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
}

void Rasteriser::depth(DepthTarget &target, const Frustum &frustum, const glm::dvec3 &origin,
                       const DepthTarget *first_layer)
{
    const VkCommandBuffer cmd = gpu_begin(&gpu_);
    check(cmd != VK_NULL_HANDLE, gpu_);
    cmd_depth(cmd, target, frustum, origin, first_layer);
    check(gpu_submit(&gpu_, cmd), gpu_);
}

void Rasteriser::gbuffer(GBuffer &target, const Frustum &frustum, const glm::dvec3 &origin)
{
    const VkCommandBuffer cmd = gpu_begin(&gpu_);
    check(cmd != VK_NULL_HANDLE, gpu_);
    cmd_gbuffer(cmd, target, frustum, origin);
    check(gpu_submit(&gpu_, cmd), gpu_);
}

FloatImage read_depth(gpu &g, gpu_image &image)
{
    FloatImage out(image.width, image.height);
    if (image.format == VK_FORMAT_D16_UNORM) {
        std::vector<uint16_t> texels(out.texels.size());
        check(gpu_image_read(&g, &image, texels.data(), texels.size() * sizeof texels[0]), g);
        for (size_t i = 0; i < texels.size(); i++)
            out.texels[i] = static_cast<float>(texels[i]) / 65535.0f;
    } else if (image.format == VK_FORMAT_D32_SFLOAT || image.format == VK_FORMAT_D32_SFLOAT_S8_UINT ||
               image.format == VK_FORMAT_R32_SFLOAT) {
        check(gpu_image_read(&g, &image, out.texels.data(), out.texels.size() * sizeof out.texels[0]), g);
    } else {
        fail("reading depth: format %d is not D16, D32 or R32F", static_cast<int>(image.format));
    }
    return out;
}

GBufferPixels read_gbuffer(gpu &g, GBuffer &target)
{
    GBufferPixels out;
    out.depth = read_depth(g, target.depth);
    const size_t count = out.depth.texels.size();
    std::vector<uint64_t> normals(count);
    std::vector<uint8_t> albedo(count * 4);
    check(gpu_image_read(&g, &target.normal, normals.data(), count * sizeof normals[0]), g);
    check(gpu_image_read(&g, &target.albedo, albedo.data(), albedo.size()), g);
    out.normal.resize(count);
    out.albedo.resize(count);
    for (size_t i = 0; i < count; i++) {
        out.normal[i] = glm::vec3(glm::unpackHalf4x16(normals[i]));
        for (int c = 0; c < 3; c++)
            out.albedo[i][c] = static_cast<float>(albedo[i * 4 + static_cast<size_t>(c)]) / 255.0f;
    }
    return out;
}
