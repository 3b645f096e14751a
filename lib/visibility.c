/* softsh_cmd_compute_visibility: checks, the frame's parameters, and the stages in order. */
#include <math.h>
#include <string.h>

#include "techniques/settings.h"
#include "techniques/techniques.h"
#include "validate.h"

static softsh_result check(const softsh_view *v, const softsh_visibility_info *info, VkRect2D *area)
{
    const softsh_context *context = v->context;
    if (!info)
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT, "softsh_visibility_info is NULL");
    if (info->struct_size != sizeof *info)
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT,
                            "softsh_visibility_info::struct_size is %u, expected %u", info->struct_size,
                            (unsigned)sizeof *info);
    if (!v->block.ready)
        return softshi_fail(context, SOFTSH_ERROR_STATE,
                            "softsh_cmd_compute_visibility: no memory is bound to the view");
    if (!info->occluders)
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT, "softsh_visibility_info::occluders is NULL");
    if (info->occluders->context != context)
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT,
                            "softsh_visibility_info::occluders belongs to another context");
    if (!info->occluders->built)
        return softshi_fail(context, SOFTSH_ERROR_STATE, "softsh_visibility_info::occluders was never built");
    if (info->camera_count == 0)
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT,
                            "softsh_visibility_info::camera_count is 0, expected 1");
    if (!info->cameras)
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT, "softsh_visibility_info::cameras is NULL");
    if (info->camera_count > 1)
        return softshi_fail(context, SOFTSH_ERROR_UNSUPPORTED,
                            "softsh_visibility_info::camera_count is %u, more than 1 is not supported yet",
                            info->camera_count);
    softsh_result result = softshi_check_camera(context, info->cameras, v->normals);
    if (result != SOFTSH_SUCCESS)
        return result;
    *area = info->render_area;
    result = softshi_check_rect(context, "softsh_visibility_info::render_area", v->max_extent, area);
    if (result != SOFTSH_SUCCESS)
        return result;
    if (!info->visibility)
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT,
                            "softsh_visibility_info::visibility is VK_NULL_HANDLE");
    if (info->override_bias && !(info->bias >= 0.0 && info->bias < 1e30))
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT,
                            "softsh_visibility_info::bias is %g, expected a finite number of world units, at least 0",
                            info->bias);
    if (info->stats_buffer && !v->stats)
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT,
                            "softsh_visibility_info::stats_buffer is set, but the view was created without stats");
    if (info->stats_offset % 4 != 0)
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT,
                            "softsh_visibility_info::stats_offset is %llu, expected a multiple of 4",
                            (unsigned long long)info->stats_offset);
    if (softshi_settings_need_folds(&v->settings) && !info->occluders->light.point && !info->occluders->folds)
        return softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT,
                            "softsh_visibility_info::occluders was created with no_folds, but it must know which cells "
                            "fold, which the view's settings need");
    if (v->settings.search == SOFTSH_SEARCH_WALK && !info->occluders->light.point && !info->occluders->dual_grids)
        return softshi_fail(
            context, SOFTSH_ERROR_INVALID_ARGUMENT,
            "softsh_visibility_info::occluders was created without dual_grids, which the view's settings need");
    if (softshi_settings_need_alignment(&v->settings) && !info->occluders->light.point &&
        !info->occluders->light.axis_aligned)
        return softshi_fail(
            context, SOFTSH_ERROR_UNSUPPORTED,
            "softsh_light: its axes are turned against the map's, which micropatches cannot do; use microquads");
    return softshi_check_timestamps(context, info->timestamps);
}

/* Sub-lights come one after the other; a first one may always begin. */
static softsh_result check_sublight(const softsh_view *v, const softsh_visibility_info *info, VkRect2D area)
{
    const softsh_context *context = v->context;
    const softshi_sublight *const now = &info->occluders->sublight, *const last = &v->combined_last;
    const uint32_t index = softshi_sublight_index(now);
    if (!v->sublights && softshi_sublight_count(now) > 1)
        return softshi_fail(
            context, SOFTSH_ERROR_INVALID_ARGUMENT,
            "softsh_visibility_info::occluders is of a sub-light of %u x %u, but the view was created without "
            "sublights",
            now->grid[0], now->grid[1]);
    if (index == 0)
        return SOFTSH_SUCCESS;
    if (v->combined == 0)
        return softshi_fail(
            context, SOFTSH_ERROR_STATE,
            "softsh_visibility_info::occluders is of sub-light (%u, %u) of %u x %u, expected (0, 0) first",
            now->cell[0], now->cell[1], now->grid[0], now->grid[1]);
    if (index != v->combined || !softshi_sublight_same_grid(now, last))
        return softshi_fail(
            context, SOFTSH_ERROR_STATE,
            "softsh_visibility_info::occluders is of sub-light (%u, %u) of %u x %u, expected (%u, %u) of %u x %u",
            now->cell[0], now->cell[1], now->grid[0], now->grid[1], v->combined % last->grid[0],
            v->combined / last->grid[0], last->grid[0], last->grid[1]);
    if (memcmp(&area, &v->combined_area, sizeof area) != 0)
        return softshi_fail(
            context, SOFTSH_ERROR_INVALID_ARGUMENT,
            "softsh_visibility_info::render_area is %d, %d, %u x %u, expected that of the other sub-lights, "
            "%d, %d, %u x %u",
            area.offset.x, area.offset.y, area.extent.width, area.extent.height, v->combined_area.offset.x,
            v->combined_area.offset.y, v->combined_area.extent.width, v->combined_area.extent.height);
    return SOFTSH_SUCCESS;
}

static void fill_frame(const softsh_view *v, const softsh_visibility_info *info, VkRect2D area, ss_frame *frame)
{
    frame->camera.y = 2.0f / (float)area.extent.width;
    frame->camera.z = 2.0f / (float)area.extent.height;
    frame->bias.x = (float)info->bias;
    frame->area = (ss_ivec4){area.offset.x, area.offset.y, (int32_t)area.extent.width, (int32_t)area.extent.height};
    frame->tiles.x = (area.extent.width + SS_TILE_X - 1) / SS_TILE_X;
    frame->tiles.y = (area.extent.height + SS_TILE_Y - 1) / SS_TILE_Y;
    frame->tiles.z = frame->tiles.x * frame->tiles.y;
    frame->flags.x |= (info->occluders->map.orthographic ? SS_FLAG_ORTHOGRAPHIC : 0u) |
                      (info->occluders->light.disc ? SS_FLAG_DISC : 0u) |
                      (info->override_bias ? SS_FLAG_OVERRIDE_BIAS : 0u);
    softshi_layout_lists(&v->settings, frame->tiles.z, &frame->lists);
    const softsh_packet_cost *cost = &v->settings.packet_cost;
    frame->cost = (ss_vec4){cost->node, cost->edge, cost->projection, cost->divergence};
    frame->quality.x = v->settings.budget;
    frame->quality.y = v->settings.min_level;
    frame->quality.z = area.extent.width * area.extent.height;
    frame->quality.w = softshi_layout_planes(&v->settings) * frame->quality.z;
}

static void write_descriptors(const softsh_view *v, VkDescriptorSet set, const softsh_visibility_info *info)
{
    const softsh_camera *camera = info->cameras;
    const VkDescriptorImageInfo images[] = {
        [SS_BIND_DEPTH] = {VK_NULL_HANDLE, camera->depth, camera->depth_layout},
        /* Passes without normals do not read theirs, but the binding is in the shader. */
        [SS_BIND_NORMALS] = {VK_NULL_HANDLE, v->normals ? camera->normals : camera->depth,
                             v->normals ? camera->normals_layout : camera->depth_layout},
        [SS_BIND_VISIBILITY] = {VK_NULL_HANDLE, info->visibility, VK_IMAGE_LAYOUT_GENERAL},
    };
    const softshi_range ranges[] = {v->layout.frame, v->layout.control, v->layout.tiles, v->layout.filter};
    VkDescriptorBufferInfo buffers[4];
    VkWriteDescriptorSet writes[SS_IO_BINDINGS];
    for (uint32_t i = 0; i < SS_IO_BINDINGS; i++) {
        writes[i] = (VkWriteDescriptorSet){
            .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, .dstSet = set, .dstBinding = i, .descriptorCount = 1};
        if (i <= SS_BIND_VISIBILITY) {
            writes[i].descriptorType =
                i == SS_BIND_VISIBILITY ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE : VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
            writes[i].pImageInfo = &images[i];
        } else {
            const softshi_range *range = &ranges[i - SS_BIND_FRAME];
            buffers[i - SS_BIND_FRAME] = (VkDescriptorBufferInfo){v->block.buffer, range->offset, range->size};
            writes[i].descriptorType =
                i == SS_BIND_FRAME ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
            writes[i].pBufferInfo = &buffers[i - SS_BIND_FRAME];
        }
    }
    v->context->vk.UpdateDescriptorSets(v->context->device, SS_IO_BINDINGS, writes, 0, NULL);
}

static void record_stats(softshi_recorder *recorder, const softsh_view *v, const softsh_visibility_info *info)
{
    const softsh_occluders *o = info->occluders;
    softshi_record_copy(recorder, SOFTSHI_CONTROL, v->block.buffer,
                        v->layout.control.offset + offsetof(ss_control, stats), info->stats_buffer, info->stats_offset,
                        offsetof(softsh_stats, wide_levels_built));
    softshi_record_copy(recorder, SOFTSHI_PLAN, o->block.buffer,
                        o->layout.header.offset + sizeof(ss_occluders) + offsetof(ss_plan, built), info->stats_buffer,
                        info->stats_offset + offsetof(softsh_stats, wide_levels_built), 2 * sizeof(uint32_t));
}

softsh_result softsh_cmd_compute_visibility(VkCommandBuffer cmd, softsh_view *v, const softsh_visibility_info *info)
{
    if (!v)
        return SOFTSH_ERROR_INVALID_ARGUMENT;
    if (!cmd)
        return softshi_fail(v->context, SOFTSH_ERROR_INVALID_ARGUMENT,
                            "softsh_cmd_compute_visibility: cmd is VK_NULL_HANDLE");
    VkRect2D area;
    softsh_result result = check(v, info, &area);
    if (result != SOFTSH_SUCCESS)
        return result;
    result = check_sublight(v, info, area);
    if (result != SOFTSH_SUCCESS)
        return result;
    const softsh_occluders *o = info->occluders;
    softshi_visibility visibility = {
        .view = v,
        .occluders = o,
    };
    result = softshi_camera_space_create(v->context, info->cameras, &info->occluders->map, &visibility.frame);
    if (result != SOFTSH_SUCCESS)
        return result;
    fill_frame(v, info, area, &visibility.frame);

    ss_control cleared = {.pixels_args = {0, 1, 1, 0}, .interpolate_args = {0, 1, 1, 0}};
    for (int i = 0; i < 2 * SS_LISTS; i++)
        cleared.evaluate_args[i] = (ss_uvec4){0, 1, 1, 0};
    softshi_recorder recorder;
    visibility.recorder = &recorder;
    softshi_record_begin(&recorder, v->context, cmd, info->timestamps, v->name);
    recorder.sets[SS_SET_OCCLUDERS] = info->occluders->set;
    recorder.sets[SS_SET_IO] = v->io_sets[v->next_io_set];
    v->next_io_set = (v->next_io_set + 1) % v->io_set_count;
    write_descriptors(v, recorder.sets[SS_SET_IO], info);
    softshi_record_update(&recorder, SOFTSHI_FRAME, v->block.buffer, v->layout.frame.offset, &visibility.frame,
                          sizeof visibility.frame);
    softshi_record_update(&recorder, SOFTSHI_CONTROL, v->block.buffer, v->layout.control.offset, &cleared,
                          sizeof cleared);
    if (info->occluders->light.point) {
        softshi_hard_record(&visibility);
    } else {
        softshi_classify_record(&visibility);
        softshi_evaluate_record(&visibility, 0);
        if (v->settings.sparse) {
            softshi_interpolate_record(&visibility);
            softshi_evaluate_record(&visibility, 1);
        }
        softshi_post_filter_record(&visibility);
    }
    if (v->sublights) {
        softshi_combine_record(&visibility);
        v->combined = (softshi_sublight_index(&o->sublight) + 1) % softshi_sublight_count(&o->sublight);
        v->combined_last = o->sublight;
        v->combined_area = area;
    }
    if (info->stats_buffer)
        record_stats(&recorder, v, info);
    softshi_record_end(&recorder);
    return SOFTSH_SUCCESS;
}
