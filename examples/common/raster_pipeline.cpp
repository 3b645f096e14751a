// Render passes and pipelines of the rasteriser, made when first needed.
#include <tuple>

#include "error.hpp"
#include "raster.hpp"
#include "raster_constants.hpp"

#include "gbuffer_frag.h"
#include "mesh_vert.h"
#include "peel_frag.h"

static void check(VkResult result, const char *what)
{
    if (result != VK_SUCCESS)
        fail("rendering: %s failed (VkResult %d)", what, static_cast<int>(result));
}

bool Rasteriser::PipelineKey::operator<(const PipelineKey &other) const
{
    return std::tie(pass, format, reversed) < std::tie(other.pass, other.format, other.reversed);
}

VkShaderModule Rasteriser::create_shader(const uint32_t *code, size_t size)
{
    VkShaderModuleCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    info.codeSize = size;
    info.pCode = code;
    VkShaderModule module = VK_NULL_HANDLE;
    check(vkCreateShaderModule(gpu_.device, &info, nullptr, &module), "vkCreateShaderModule");
    return module;
}

Rasteriser::Rasteriser(gpu &g) : gpu_(g)
{
    try {
        vertex_shader_ = create_shader(mesh_vert, sizeof mesh_vert);
        peel_shader_ = create_shader(peel_frag, sizeof peel_frag);
        gbuffer_shader_ = create_shader(gbuffer_frag, sizeof gbuffer_frag);

        VkSamplerCreateInfo sampler{};
        sampler.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
        sampler.addressModeU = sampler.addressModeV = sampler.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
        check(vkCreateSampler(gpu_.device, &sampler, nullptr, &sampler_), "vkCreateSampler");

        const VkDescriptorSetLayoutBinding binding = {0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1,
                                                      VK_SHADER_STAGE_FRAGMENT_BIT, nullptr};
        VkDescriptorSetLayoutCreateInfo set{};
        set.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
        set.bindingCount = 1;
        set.pBindings = &binding;
        check(vkCreateDescriptorSetLayout(gpu_.device, &set, nullptr, &set_layout_), "vkCreateDescriptorSetLayout");

        const VkPushConstantRange range = {VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                                           sizeof(RasterConstants)};
        VkPipelineLayoutCreateInfo layout{};
        layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
        layout.setLayoutCount = 1;
        layout.pSetLayouts = &set_layout_;
        layout.pushConstantRangeCount = 1;
        layout.pPushConstantRanges = &range;
        check(vkCreatePipelineLayout(gpu_.device, &layout, nullptr, &layout_), "vkCreatePipelineLayout");
    } catch (...) {
        free_everything();
        throw;
    }
}

Rasteriser::~Rasteriser()
{
    free_everything();
}

void Rasteriser::free_everything()
{
    vkDeviceWaitIdle(gpu_.device);
    while (!depth_targets_.empty())
        destroy(depth_targets_.front());
    while (!gbuffers_.empty())
        destroy(gbuffers_.front());
    free_mesh();
    for (const auto &entry : pipelines_)
        vkDestroyPipeline(gpu_.device, entry.second, nullptr);
    for (const auto &entry : render_passes_)
        vkDestroyRenderPass(gpu_.device, entry.second, nullptr);
    vkDestroyPipelineLayout(gpu_.device, layout_, nullptr);
    vkDestroyDescriptorSetLayout(gpu_.device, set_layout_, nullptr);
    vkDestroySampler(gpu_.device, sampler_, nullptr);
    for (VkShaderModule module : {vertex_shader_, peel_shader_, gbuffer_shader_})
        vkDestroyShaderModule(gpu_.device, module, nullptr);
}

VkFramebuffer Rasteriser::create_framebuffer(VkRenderPass pass, const std::vector<VkImageView> &views, uint32_t width,
                                             uint32_t height)
{
    VkFramebufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    info.renderPass = pass;
    info.attachmentCount = static_cast<uint32_t>(views.size());
    info.pAttachments = views.data();
    info.width = width;
    info.height = height;
    info.layers = 1;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    check(vkCreateFramebuffer(gpu_.device, &info, nullptr, &framebuffer), "vkCreateFramebuffer");
    return framebuffer;
}

static VkAttachmentDescription attachment(VkFormat format)
{
    VkAttachmentDescription description{};
    description.format = format;
    description.samples = VK_SAMPLE_COUNT_1_BIT;
    description.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    description.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    description.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    description.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    description.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    description.finalLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    return description;
}

VkRenderPass Rasteriser::render_pass(Pass pass, VkFormat format)
{
    const bool colour = pass == Pass::gbuffer;
    VkRenderPass &cached = render_passes_[{colour, format}];
    if (cached)
        return cached;

    const VkAttachmentDescription attachments[] = {attachment(format), attachment(VK_FORMAT_R16G16B16A16_SFLOAT),
                                                   attachment(VK_FORMAT_R8G8B8A8_UNORM)};
    const VkAttachmentReference depth = {0, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference colours[] = {{1, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
                                             {2, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL}};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = colour ? 2 : 0;
    subpass.pColorAttachments = colours;
    subpass.pDepthStencilAttachment = &depth;

    // Earlier users of the images, and later readers, are whatever the caller has.
    const VkPipelineStageFlags writes = VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                                        VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT |
                                        VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    const VkAccessFlags write_access =
        VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    const VkPipelineStageFlags reads =
        VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    VkSubpassDependency dependencies[2] = {};
    dependencies[0].srcSubpass = VK_SUBPASS_EXTERNAL;
    dependencies[0].dstSubpass = 0;
    dependencies[0].srcStageMask = writes | reads;
    dependencies[0].dstStageMask = writes | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
    dependencies[0].srcAccessMask = write_access | VK_ACCESS_TRANSFER_WRITE_BIT;
    dependencies[0].dstAccessMask = write_access | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT |
                                    VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_SHADER_READ_BIT;
    dependencies[1].srcSubpass = 0;
    dependencies[1].dstSubpass = VK_SUBPASS_EXTERNAL;
    dependencies[1].srcStageMask = writes;
    dependencies[1].dstStageMask = reads;
    dependencies[1].srcAccessMask = write_access;
    dependencies[1].dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT;

    VkRenderPassCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
    info.attachmentCount = colour ? 3 : 1;
    info.pAttachments = attachments;
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    info.dependencyCount = 2;
    info.pDependencies = dependencies;
    check(vkCreateRenderPass(gpu_.device, &info, nullptr, &cached), "vkCreateRenderPass");
    return cached;
}

VkPipeline Rasteriser::pipeline(const PipelineKey &key)
{
    VkPipeline &cached = pipelines_[key];
    if (cached)
        return cached;

    VkPipelineShaderStageCreateInfo stages[2] = {};
    stages[0].sType = stages[1].sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
    stages[0].module = vertex_shader_;
    stages[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT;
    stages[1].module = key.pass == Pass::gbuffer ? gbuffer_shader_ : peel_shader_;
    stages[0].pName = stages[1].pName = "main";

    VkVertexInputBindingDescription bindings[3] = {};
    VkVertexInputAttributeDescription attributes[3] = {};
    for (uint32_t i = 0; i < 3; i++) {
        bindings[i] = {i, sizeof(glm::vec3), VK_VERTEX_INPUT_RATE_VERTEX};
        attributes[i] = {i, i, VK_FORMAT_R32G32B32_SFLOAT, 0};
    }
    VkPipelineVertexInputStateCreateInfo vertex_input{};
    vertex_input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    vertex_input.vertexBindingDescriptionCount = vertex_input.vertexAttributeDescriptionCount = 3;
    vertex_input.pVertexBindingDescriptions = bindings;
    vertex_input.pVertexAttributeDescriptions = attributes;

    VkPipelineInputAssemblyStateCreateInfo assembly{};
    assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;

    VkPipelineViewportStateCreateInfo viewport{};
    viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
    viewport.viewportCount = viewport.scissorCount = 1;

    VkPipelineRasterizationStateCreateInfo raster{};
    raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
    raster.polygonMode = VK_POLYGON_MODE_FILL;
    raster.cullMode = VK_CULL_MODE_NONE;
    raster.lineWidth = 1.0f;

    VkPipelineMultisampleStateCreateInfo samples{};
    samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;

    VkPipelineDepthStencilStateCreateInfo depth{};
    depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
    depth.depthTestEnable = depth.depthWriteEnable = VK_TRUE;
    depth.depthCompareOp = key.reversed ? VK_COMPARE_OP_GREATER : VK_COMPARE_OP_LESS;

    VkPipelineColorBlendAttachmentState blend[2] = {};
    blend[0].colorWriteMask = blend[1].colorWriteMask =
        VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    VkPipelineColorBlendStateCreateInfo colour{};
    colour.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    colour.attachmentCount = key.pass == Pass::gbuffer ? 2 : 0;
    colour.pAttachments = blend;

    const VkDynamicState dynamic_states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic{};
    dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
    dynamic.dynamicStateCount = 2;
    dynamic.pDynamicStates = dynamic_states;

    VkGraphicsPipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    info.stageCount = key.pass == Pass::depth ? 1 : 2;
    info.pStages = stages;
    info.pVertexInputState = &vertex_input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &colour;
    info.pDynamicState = &dynamic;
    info.layout = layout_;
    info.renderPass = render_pass(key.pass, key.format);
    check(vkCreateGraphicsPipelines(gpu_.device, VK_NULL_HANDLE, 1, &info, nullptr, &cached),
          "vkCreateGraphicsPipelines");
    return cached;
}
