// Renders a mesh's depth, and a G-buffer for shading, with ordinary graphics pipelines: what a renderer has before it
// calls the library.
#pragma once

#include <list>
#include <map>
#include <vector>

#include <glm/glm.hpp>

#include "gpu.h"
#include "image_io.hpp"
#include "light.hpp"
#include "mesh.hpp"

struct DepthTarget {
    gpu_image image{};
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    VkDescriptorPool pool = VK_NULL_HANDLE; // of the set through which peeling reads this image
    VkDescriptorSet set = VK_NULL_HANDLE;
};

struct GBuffer {
    gpu_image depth{};  // D32
    gpu_image normal{}; // RGBA16F: world space, unit length, towards the viewer; zero where there is nothing
    gpu_image albedo{}; // RGBA8, linear
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
};

// Not thread safe. Owns its targets. All calls throw Error.
class Rasteriser
{
  public:
    explicit Rasteriser(gpu &g);
    ~Rasteriser();
    Rasteriser(const Rasteriser &) = delete;
    Rasteriser &operator=(const Rasteriser &) = delete;

    // Replaces the mesh; nothing recorded with the old one may still be pending.
    void set_mesh(const Mesh &mesh);

    // Format: D32_SFLOAT, D16_UNORM, or another depth format the device can render to.
    DepthTarget &create_depth_target(uint32_t width, uint32_t height, VkFormat format = VK_FORMAT_D32_SFLOAT);
    GBuffer &create_gbuffer(uint32_t width, uint32_t height);
    void destroy(DepthTarget &target);
    void destroy(GBuffer &target);

    // Record rendering of the mesh, whose zero lies at `origin` in the world. On entry images may be in any state
    // (after earlier work on the queue is waited for by the render pass); they leave in SHADER_READ_ONLY_OPTIMAL,
    // visible to compute and fragment shaders and transfers. With `first_layer`, which was rendered with the same
    // matrices and size, only what lies strictly behind that layer is drawn.
    void cmd_depth(VkCommandBuffer cmd, DepthTarget &target, const Frustum &frustum, const glm::dvec3 &origin,
                   const DepthTarget *first_layer = nullptr);
    void cmd_gbuffer(VkCommandBuffer cmd, GBuffer &target, const Frustum &frustum, const glm::dvec3 &origin);

    // The same, submitted and waited for.
    void depth(DepthTarget &target, const Frustum &frustum, const glm::dvec3 &origin,
               const DepthTarget *first_layer = nullptr);
    void gbuffer(GBuffer &target, const Frustum &frustum, const glm::dvec3 &origin);

  private:
    enum class Pass { depth, peel, gbuffer };
    struct PipelineKey {
        Pass pass;
        VkFormat format;
        bool reversed;
        bool operator<(const PipelineKey &other) const;
    };

    VkShaderModule create_shader(const uint32_t *code, size_t size);
    VkRenderPass render_pass(Pass pass, VkFormat format);
    VkPipeline pipeline(const PipelineKey &key);
    VkFramebuffer create_framebuffer(VkRenderPass pass, const std::vector<VkImageView> &views, uint32_t width,
                                     uint32_t height);
    void upload(gpu_buffer &buffer, const void *data, size_t size, VkBufferUsageFlags usage);
    void draw(VkCommandBuffer cmd, const PipelineKey &key, VkFramebuffer framebuffer, uint32_t width, uint32_t height,
              const Frustum &frustum, const glm::dvec3 &origin, const DepthTarget *first_layer);
    void free_mesh();
    void free_everything();

    gpu &gpu_;
    VkShaderModule vertex_shader_ = VK_NULL_HANDLE;
    VkShaderModule peel_shader_ = VK_NULL_HANDLE;
    VkShaderModule gbuffer_shader_ = VK_NULL_HANDLE;
    VkSampler sampler_ = VK_NULL_HANDLE;
    VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    std::map<std::pair<bool, VkFormat>, VkRenderPass> render_passes_;
    std::map<PipelineKey, VkPipeline> pipelines_;
    std::list<DepthTarget> depth_targets_;
    std::list<GBuffer> gbuffers_;
    gpu_buffer positions_{}, normals_{}, colours_{}, indices_{};
    uint32_t index_count_ = 0;
};

// D16, D32 or R32F to floats.
FloatImage read_depth(gpu &g, gpu_image &image);

struct GBufferPixels {
    FloatImage depth;
    std::vector<glm::vec3> normal;
    std::vector<glm::vec3> albedo;
};
GBufferPixels read_gbuffer(gpu &g, GBuffer &target);
