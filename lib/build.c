/* softsh_cmd_build_occluders: checks, the light in map space, and the passes of the hierarchy. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "occluders.h"
#include "techniques/dual_grid.h"
#include "techniques/hierarchy.h"
#include "validate.h"

typedef struct build_plan {
    VkExtent2D extent;
    softshi_occluder_layout layout;            /* of the maps' extent */
    softshi_map_space maps[SOFTSH_MAX_LAYERS]; /* in the order given */
    softshi_light_space light;
    softshi_sublight sublight;
} build_plan;

/* Layers differ in their near and far planes at most. */
static softsh_result check_same_projection(const softsh_context *context, const softshi_map_space *a,
                                           const softshi_map_space *b, uint32_t i)
{
    for (int r = 0; r < 4; r++) {
        /* An orthographic map's third row is a fan depth whose zero follows the depth range. */
        double largest = 0.0, difference = 0.0;
        for (int c = 0; c < (a->orthographic && r == 2 ? 3 : 4); c++) {
            largest = fmax(largest, fabs(a->rows[r][c]));
            difference = fmax(difference, fabs(a->rows[r][c] - b->rows[r][c]));
        }
        if (a->orthographic != b->orthographic || !(difference <= 1e-6 * largest))
            return softshi_fail(
                context, SOFTSH_ERROR_INVALID_ARGUMENT,
                "softsh_map[%u] has another projection than softsh_map[0], expected layers of one projection", i);
    }
    return SOFTSH_SUCCESS;
}

/* An orthographic map's fan depth has its zero in the middle of the depth range: layers take over the first one's. */
static void share_zero(const softshi_map_space *first, softshi_map_space *map)
{
    if (map->orthographic)
        map->depth_offset += first->rows[2][3] / first->rows[3][3] - map->rows[2][3] / map->rows[3][3];
}

static softsh_result plan_build(const softsh_occluders *o, const softsh_build_info *info, build_plan *plan)
{
    const softsh_context *context = o->context;
    if (!info)
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT, "softsh_build_info is NULL");
    if (info->struct_size != sizeof *info)
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT, "softsh_build_info::struct_size is %u, expected %u",
                            info->struct_size, (unsigned)sizeof *info);
    if (!o->block.ready)
        return softshi_fail(context, SOFTSH_ERROR_STATE,
                            "softsh_cmd_build_occluders: no memory is bound to the occluders");
    softsh_result result = softshi_check_light(context, info->light);
    if (result == SOFTSH_SUCCESS)
        result = softshi_check_maps(context, info, o->max_extent, o->max_layers, &plan->extent);
    if (result == SOFTSH_SUCCESS)
        result = softshi_check_timestamps(context, info->timestamps);
    softsh_light light;
    if (result == SOFTSH_SUCCESS) {
        plan->sublight = softshi_sublight_of(info->maps);
        light = softshi_sublight_light(info->light, &plan->sublight);
    }
    for (uint32_t i = 0; i < info->map_count && result == SOFTSH_SUCCESS; i++) {
        char field[32];
        snprintf(field, sizeof field, "softsh_map[%u]", i);
        result = softshi_map_space_create(context, &light, &info->maps[i], plan->extent, field, &plan->maps[i]);
        if (result == SOFTSH_SUCCESS && i > 0)
            result = check_same_projection(context, &plan->maps[0], &plan->maps[i], i);
        if (result == SOFTSH_SUCCESS && i > 0)
            share_zero(&plan->maps[0], &plan->maps[i]);
    }
    if (result == SOFTSH_SUCCESS)
        result = softshi_light_space_create(context, &light, &plan->maps[0], &plan->light);
    if (result == SOFTSH_SUCCESS)
        softshi_layout_occluders(plan->extent, info->map_count, o->join_texels, o->folds, o->dual_grids, &plan->layout);
    return result;
}

static void fill_header(const softsh_build_info *info, const build_plan *plan, ss_occluders *out)
{
    const softshi_light_space *light = &plan->light;
    const softshi_map_space *map = &plan->maps[0];
    memset(out, 0, sizeof *out);
    out->a = (ss_vec4){(float)light->a[0][0], (float)light->a[0][1], (float)light->a[1][0], (float)light->a[1][1]};
    const double det = light->a[0][0] * light->a[1][1] - light->a[0][1] * light->a[1][0];
    if (!light->point)
        out->a_inverse = (ss_vec4){(float)(light->a[1][1] / det), (float)(-light->a[0][1] / det),
                                   (float)(-light->a[1][0] / det), (float)(light->a[0][0] / det)};
    out->light = (ss_vec4){(float)light->u[0], (float)light->u[1], (float)light->delta, (float)light->epsilon};
    double eta = 0.0, farthest = HUGE_VAL;
    for (uint32_t i = 0; i < info->map_count; i++) {
        const softshi_map_space *m = &plan->maps[i];
        eta = fmax(eta, fabs(m->depth_scale) * softshi_depth_precision(info->maps[i].format));
        farthest = fmin(farthest, m->depth_scale * m->far_depth + m->depth_offset);
    }
    out->depths = (ss_vec4){(float)eta, (float)map->texel[0], (float)map->texel[1], (float)farthest};
    /* The square of the disc's area stands in for it where areas are accumulated. */
    out->extent.x = light->disc ? 0.886226925f : 1.0f;
    out->size = (ss_uvec4){plan->extent.width, plan->extent.height, info->map_count, plan->layout.pyramids - 1};
    const softshi_occluder_layout *layout = &plan->layout;
    out->levels = (ss_uvec4){layout->top, layout->join, layout->wide_levels,
                             softshi_level_size(plan->extent.width, layout->join)};
    /* Creation made sure that all of it can be counted in 32 bits. */
    out->strides = (ss_uvec4){(uint32_t)layout->layer_quads, (uint32_t)layout->pyramid_texels,
                              (uint32_t)layout->wide_offset, layout->wide_texels};
    out->extent.y = (float)layout->layer_fold_words;
    for (uint32_t i = 0; i <= layout->top; i++) {
        const uint32_t first = layout->folds[i], words = softshi_level_words(plan->extent.width, i);
        ss_uvec4 *const two = &out->folds[i / 2];
        *two = i % 2 == 0 ? (ss_uvec4){first, words, 0, 0} : (ss_uvec4){two->x, two->y, first, words};
    }
    for (uint32_t i = 0; i <= layout->top; i++)
        out->pyramid[i] = (ss_uvec4){layout->offsets[i], softshi_level_size(plan->extent.width, i), layout->quads[i],
                                     softshi_level_quads(plan->extent.width, i)};
    memcpy(out->duals, layout->duals, sizeof out->duals);
}

static void write_map_descriptor(const softsh_context *context, VkDescriptorSet set, const softsh_map *map)
{
    const VkDescriptorImageInfo image = {VK_NULL_HANDLE, map->view, map->layout};
    const VkWriteDescriptorSet write = {
        .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
        .dstSet = set,
        .dstBinding = SS_BIND_DEPTH,
        .descriptorCount = 1,
        .descriptorType = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
        .pImageInfo = &image,
    };
    context->vk.UpdateDescriptorSets(context->device, 1, &write, 0, NULL);
}

softsh_result softsh_cmd_build_occluders(VkCommandBuffer cmd, softsh_occluders *o, const softsh_build_info *info)
{
    if (!o)
        return SOFTSH_ERROR_INVALID_ARGUMENT;
    if (!cmd)
        return softshi_fail(o->context, SOFTSH_ERROR_INVALID_ARGUMENT,
                            "softsh_cmd_build_occluders: cmd is VK_NULL_HANDLE");
    build_plan plan;
    const softsh_result result = plan_build(o, info, &plan);
    if (result != SOFTSH_SUCCESS)
        return result;

    ss_occluders header;
    fill_header(info, &plan, &header);
    softshi_recorder recorder;
    softshi_record_begin(&recorder, o->context, cmd, info->timestamps, o->name);
    recorder.sets[SS_SET_OCCLUDERS] = o->set;
    softshi_record_update(&recorder, SOFTSHI_HEADER, o->block.buffer, o->layout.header.offset, &header, sizeof header);
    for (uint32_t i = 0; i < info->map_count; i++) {
        const softsh_map *map = &info->maps[i];
        recorder.sets[SS_SET_IO] = o->io_sets[o->next_io_set];
        o->next_io_set = (o->next_io_set + 1) % o->io_set_count;
        write_map_descriptor(o->context, recorder.sets[SS_SET_IO], map);
        const ss_convert_push push = {
            .depth_scale = (float)plan.maps[i].depth_scale,
            .depth_offset = (float)plan.maps[i].depth_offset,
            .far_depth = (float)plan.maps[i].far_depth,
            .layer = map->index,
            .rect = {map->rect.offset.x, map->rect.offset.y, 0, 0},
        };
        softshi_hierarchy_record_convert(&recorder, o, plan.extent, &push);
    }
    softshi_hierarchy_record_levels(&recorder, o, plan.extent, &plan.layout, info->map_count);
    if (o->dual_grids)
        softshi_dual_grid_record(&recorder, o, plan.extent, &plan.layout, info->map_count);
    softshi_record_release(&recorder);
    softshi_record_end(&recorder);

    o->built = true;
    o->layered = info->map_count > 1;
    o->sublight = plan.sublight;
    o->map = plan.maps[0];
    o->light = plan.light;
    return SOFTSH_SUCCESS;
}
