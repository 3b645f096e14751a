/* Pipelines, descriptors and recording of the peers; their mathematics is in peer_geometry.c and shaders/. */
#include "peers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "average.comp.h"
#include "copy.comp.h"
#include "hard.comp.h"
#include "march.comp.h"
#include "pcf.comp.h"
#include "pcss.comp.h"
#include "peer_geometry.h"

#define BINDING_COUNT 3u
#define MAX_TAPS 1024u
/* Some drivers end a shader without a word after 65,535 rounds of its loops. */
#define MAX_MARCH_STEPS 60000u
#define MAX_EXTENT 16384u

struct peer {
    peer_info info;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkDescriptorPool pool;
    VkDescriptorSet *sets; /* one per recording that may be pending, used in turn */
    uint32_t set_count, next_set;
    uint32_t group_width, group_height;
};

typedef struct peer_row {
    const char *name;
    const uint32_t *code;
    size_t code_size;
    /* Wide groups for wide machines; software drivers run their lanes along x as well. */
    uint32_t group_width, group_height;
} peer_row;

static const peer_row rows[PEER_KIND_COUNT] = {
    [PEER_COPY] = {"copy", copy_comp, sizeof copy_comp, 32, 8},
    [PEER_HARD] = {"hard", hard_comp, sizeof hard_comp, 32, 8},
    [PEER_PCF] = {"pcf", pcf_comp, sizeof pcf_comp, 32, 8},
    [PEER_PCSS] = {"pcss", pcss_comp, sizeof pcss_comp, 32, 8},
    [PEER_MARCH] = {"march", march_comp, sizeof march_comp, 32, 8},
    [PEER_AVERAGE] = {"average", average_comp, sizeof average_comp, 32, 8},
};

static bool fail(gpu *g, const char *what, VkResult result)
{
    snprintf(g->error, sizeof g->error, "%s failed (VkResult %d)", what, (int)result);
    return false;
}

const char *peer_name(peer_kind kind)
{
    return (unsigned)kind < PEER_KIND_COUNT ? rows[kind].name : "unknown";
}

peer_kind peer_find(const char *name)
{
    int kind = 0;

    while (kind < PEER_KIND_COUNT && strcmp(rows[kind].name, name) != 0)
        kind++;
    return (peer_kind)kind;
}

static bool create_layouts(gpu *g, peer *p)
{
    const VkDescriptorSetLayoutBinding bindings[BINDING_COUNT] = {
        {0, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1, VK_SHADER_STAGE_COMPUTE_BIT, NULL},
        {1, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1, VK_SHADER_STAGE_COMPUTE_BIT, NULL},
        {2, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1, VK_SHADER_STAGE_COMPUTE_BIT, NULL},
    };
    const VkDescriptorSetLayoutCreateInfo set_info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = BINDING_COUNT,
        .pBindings = bindings,
    };
    const VkPushConstantRange range = {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(struct peer_params)};
    VkPipelineLayoutCreateInfo layout_info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 1,
        .pSetLayouts = &p->set_layout,
        .pushConstantRangeCount = 1,
        .pPushConstantRanges = &range,
    };
    VkResult result = vkCreateDescriptorSetLayout(g->device, &set_info, NULL, &p->set_layout);

    if (result != VK_SUCCESS)
        return fail(g, "vkCreateDescriptorSetLayout", result);
    result = vkCreatePipelineLayout(g->device, &layout_info, NULL, &p->layout);
    return result == VK_SUCCESS || fail(g, "vkCreatePipelineLayout", result);
}

static bool create_sets(gpu *g, peer *p)
{
    const VkDescriptorPoolSize sizes[] = {
        {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 2 * p->set_count},
        {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, p->set_count},
    };
    const VkDescriptorPoolCreateInfo pool_info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .maxSets = p->set_count,
        .poolSizeCount = 2,
        .pPoolSizes = sizes,
    };
    VkResult result = vkCreateDescriptorPool(g->device, &pool_info, NULL, &p->pool);

    if (result != VK_SUCCESS)
        return fail(g, "vkCreateDescriptorPool", result);
    p->sets = calloc(p->set_count, sizeof *p->sets);
    if (!p->sets) {
        snprintf(g->error, sizeof g->error, "out of memory");
        return false;
    }
    for (uint32_t i = 0; i < p->set_count; i++) {
        const VkDescriptorSetAllocateInfo allocate = {
            .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
            .descriptorPool = p->pool,
            .descriptorSetCount = 1,
            .pSetLayouts = &p->set_layout,
        };
        result = vkAllocateDescriptorSets(g->device, &allocate, &p->sets[i]);
        if (result != VK_SUCCESS)
            return fail(g, "vkAllocateDescriptorSets", result);
    }
    return true;
}

static bool create_pipeline(gpu *g, peer *p)
{
    const peer_row *row = &rows[p->info.kind];
    const uint32_t constants[] = {p->group_width,
                                  p->group_height,
                                  p->info.settings.blocker_taps,
                                  p->info.settings.filter_taps,
                                  p->info.directional,
                                  p->info.settings.light_samples,
                                  p->info.settings.march_steps};
    VkSpecializationMapEntry entries[sizeof constants / sizeof constants[0]];
    const VkSpecializationInfo specialization = {sizeof constants / sizeof constants[0], entries, sizeof constants,
                                                 constants};
    const VkShaderModuleCreateInfo module_info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
        .codeSize = row->code_size,
        .pCode = row->code,
    };
    VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .pName = "main",
                  .pSpecializationInfo = &specialization},
        .layout = p->layout,
    };
    VkResult result;

    for (uint32_t i = 0; i < sizeof constants / sizeof constants[0]; i++) {
        const VkSpecializationMapEntry entry = {i, i * (uint32_t)sizeof constants[0], sizeof constants[0]};
        entries[i] = entry;
    }
    result = vkCreateShaderModule(g->device, &module_info, NULL, &info.stage.module);
    if (result != VK_SUCCESS)
        return fail(g, "vkCreateShaderModule", result);
    result = vkCreateComputePipelines(g->device, p->info.cache, 1, &info, NULL, &p->pipeline);
    vkDestroyShaderModule(g->device, info.stage.module, NULL);
    return result == VK_SUCCESS || fail(g, "vkCreateComputePipelines", result);
}

/* What zero stands for. */
static peer_settings with_defaults(peer_settings s, peer_kind kind)
{
    if (!s.blocker_taps)
        s.blocker_taps = 16;
    if (!s.filter_taps)
        s.filter_taps = 32;
    if (!s.light_samples)
        s.light_samples = kind == PEER_AVERAGE ? 64 : 16;
    if (!s.march_steps)
        s.march_steps = 16;
    return s;
}

static bool in_range(const peer_settings *s)
{
    return s->blocker_taps <= MAX_TAPS && s->filter_taps <= MAX_TAPS && s->light_samples <= MAX_TAPS &&
           s->march_steps <= MAX_TAPS && s->pcf_kernel >= 0.0 && s->nearest_blocker >= 0.0;
}

bool peer_create(gpu *g, const peer_info *info, peer **out)
{
    const peer_settings settings = with_defaults(info->settings, info->kind);
    peer *p;

    *out = NULL;
    if ((unsigned)info->kind >= PEER_KIND_COUNT || !in_range(&settings)) {
        snprintf(g->error, sizeof g->error, "peer kind or settings out of range");
        return false;
    }
    if (info->kind == PEER_MARCH && settings.light_samples * settings.march_steps > MAX_MARCH_STEPS) {
        snprintf(g->error, sizeof g->error, "march: %u samples of %u steps each, expected at most %u steps in all",
                 settings.light_samples, settings.march_steps, MAX_MARCH_STEPS);
        return false;
    }
    p = calloc(1, sizeof *p);
    if (!p) {
        snprintf(g->error, sizeof g->error, "out of memory");
        return false;
    }
    p->info = *info;
    p->info.settings = settings;
    p->set_count = info->max_recordings ? info->max_recordings : 4;
    p->group_width = rows[info->kind].group_width;
    p->group_height = rows[info->kind].group_height;
    if (create_layouts(g, p) && create_sets(g, p) && create_pipeline(g, p)) {
        *out = p;
        return true;
    }
    peer_destroy(g, p);
    return false;
}

void peer_destroy(gpu *g, peer *p)
{
    if (!p)
        return;
    vkDestroyPipeline(g->device, p->pipeline, NULL);
    vkDestroyDescriptorPool(g->device, p->pool, NULL);
    vkDestroyPipelineLayout(g->device, p->layout, NULL);
    vkDestroyDescriptorSetLayout(g->device, p->set_layout, NULL);
    free(p->sets);
    free(p);
}

static bool valid_extent(const peer_depth *depth)
{
    return depth->width - 1u < MAX_EXTENT && depth->height - 1u < MAX_EXTENT;
}

bool peer_record(gpu *g, peer *p, VkCommandBuffer cmd, const peer_inputs *inputs)
{
    const VkDescriptorSet set = p->sets[p->next_set];
    const VkDescriptorImageInfo images[BINDING_COUNT] = {
        {VK_NULL_HANDLE, inputs->camera.view, inputs->camera.layout},
        {VK_NULL_HANDLE, inputs->map.view, inputs->map.layout},
        {VK_NULL_HANDLE, inputs->visibility, VK_IMAGE_LAYOUT_GENERAL},
    };
    VkWriteDescriptorSet writes[BINDING_COUNT];
    struct peer_params params;
    const char *problem;

    if (!valid_extent(&inputs->camera) || !valid_extent(&inputs->map)) {
        snprintf(g->error, sizeof g->error, "the size of the camera's depth or of the map is out of range");
        return false;
    }
    problem = peer_geometry(&p->info, inputs, &params);
    if (problem) {
        snprintf(g->error, sizeof g->error, "%s", problem);
        return false;
    }
    for (uint32_t i = 0; i < BINDING_COUNT; i++) {
        const VkWriteDescriptorSet write = {
            .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
            .dstSet = set,
            .dstBinding = i,
            .descriptorCount = 1,
            .descriptorType = i == 2 ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE : VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
            .pImageInfo = &images[i],
        };
        writes[i] = write;
    }
    vkUpdateDescriptorSets(g->device, BINDING_COUNT, writes, 0, NULL);
    p->next_set = (p->next_set + 1) % p->set_count;
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, p->pipeline);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, p->layout, 0, 1, &set, 0, NULL);
    vkCmdPushConstants(cmd, p->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof params, &params);
    vkCmdDispatch(cmd, (inputs->camera.width + p->group_width - 1) / p->group_width,
                  (inputs->camera.height + p->group_height - 1) / p->group_height, 1);
    return true;
}
