/* Argument checks. */
#include "validate.h"

#include <math.h>
#include <stdio.h>

#include "matrix.h"

#define INVALID(...) softshi_fail(context, SOFTSH_ERROR_INVALID_ARGUMENT, __VA_ARGS__)
#define UNSUPPORTED(...) softshi_fail(context, SOFTSH_ERROR_UNSUPPORTED, __VA_ARGS__)

/* Non-null and of this version's size. */
#define CHECK_STRUCT(pointer, type)                                                                                    \
    do {                                                                                                               \
        if (!(pointer))                                                                                                \
            return INVALID(#type " is NULL");                                                                          \
        if ((pointer)->struct_size != sizeof(type))                                                                    \
            return INVALID(#type "::struct_size is %u, expected %u", (pointer)->struct_size, (unsigned)sizeof(type));  \
    } while (0)

softsh_result softshi_check_context_info(softsh_context *context, const softsh_context_info *info, softsh_context **out)
{
    if (info && info->struct_size == sizeof *info) {
        context->message = info->message;
        context->message_user = info->message_user;
    }
    CHECK_STRUCT(info, softsh_context_info);
    if (!out)
        return INVALID("softsh_context_create: out is NULL");
    if (!info->instance)
        return INVALID("softsh_context_info::instance is VK_NULL_HANDLE");
    if (!info->physical_device)
        return INVALID("softsh_context_info::physical_device is VK_NULL_HANDLE");
    if (!info->device)
        return INVALID("softsh_context_info::device is VK_NULL_HANDLE");
    if (!info->get_instance_proc_addr)
        return INVALID("softsh_context_info::get_instance_proc_addr is NULL");
    if (!info->get_device_proc_addr)
        return INVALID("softsh_context_info::get_device_proc_addr is NULL");
    const VkAllocationCallbacks *allocator = info->allocation_callbacks;
    if (allocator && (!allocator->pfnAllocation || !allocator->pfnFree || !allocator->pfnReallocation))
        return INVALID("softsh_context_info::allocation_callbacks lacks pfnAllocation, pfnReallocation or pfnFree");
    if (allocator && !allocator->pfnInternalAllocation != !allocator->pfnInternalFree)
        return INVALID(
            "softsh_context_info::allocation_callbacks has one of pfnInternalAllocation and pfnInternalFree, "
            "expected both or none");
    return SOFTSH_SUCCESS;
}

static softsh_result check_extent(const softsh_context *context, const char *field, VkExtent2D extent)
{
    if (extent.width == 0 || extent.height == 0 || extent.width > SOFTSH_MAX_EXTENT ||
        extent.height > SOFTSH_MAX_EXTENT)
        return INVALID("%s is %u x %u, expected 1 to %u each", field, extent.width, extent.height, SOFTSH_MAX_EXTENT);
    return SOFTSH_SUCCESS;
}

static softsh_result check_memory_mode(const softsh_context *context, const char *field, softsh_memory_mode mode)
{
    if (mode != SOFTSH_MEMORY_LIBRARY && mode != SOFTSH_MEMORY_CALLER)
        return INVALID("%s is %d, expected a softsh_memory_mode", field, (int)mode);
    return SOFTSH_SUCCESS;
}

static softsh_result check_recordings(const softsh_context *context, const char *field, uint32_t count)
{
    if (count > 1024)
        return INVALID("%s is %u, expected at most 1024", field, count);
    return SOFTSH_SUCCESS;
}

softsh_result softshi_check_occluders_info(const softsh_context *context, const softsh_occluders_info *info,
                                           softsh_occluders **out)
{
    CHECK_STRUCT(info, softsh_occluders_info);
    if (!out)
        return INVALID("softsh_occluders_create: out is NULL");
    softsh_result result = check_extent(context, "softsh_occluders_info::max_extent", info->max_extent);
    if (result != SOFTSH_SUCCESS)
        return result;
    if (info->max_layers > SOFTSH_MAX_LAYERS)
        return INVALID("softsh_occluders_info::max_layers is %u, expected at most %u", info->max_layers,
                       SOFTSH_MAX_LAYERS);
    if ((unsigned)info->accel > SOFTSH_ACCEL_YSM)
        return INVALID("softsh_occluders_info::accel is %d, expected a softsh_accel", (int)info->accel);
    if (info->ysm_join > SOFTSH_MAX_EXTENT)
        return INVALID("softsh_occluders_info::ysm_join is %u, expected at most %u", info->ysm_join, SOFTSH_MAX_EXTENT);
    result = check_recordings(context, "softsh_occluders_info::max_recordings", info->max_recordings);
    if (result != SOFTSH_SUCCESS)
        return result;
    return check_memory_mode(context, "softsh_occluders_info::memory_mode", info->memory_mode);
}

softsh_result softshi_check_settings(const softsh_context *context, const softsh_settings *s)
{
    if (s->struct_size != sizeof *s)
        return INVALID("softsh_settings::struct_size is %u, expected %u", s->struct_size, (unsigned)sizeof *s);
    if ((unsigned)s->technique > SOFTSH_TECHNIQUE_CONTOUR)
        return INVALID("softsh_settings::technique is %d, expected a softsh_technique", (int)s->technique);
    if ((unsigned)s->pattern > SOFTSH_PATTERN_32X32)
        return INVALID("softsh_settings::pattern is %d, expected a softsh_pattern", (int)s->pattern);
    if ((unsigned)s->primitive > SOFTSH_PRIMITIVE_MICRORECT)
        return INVALID("softsh_settings::primitive is %d, expected a softsh_primitive", (int)s->primitive);
    if (s->primitive == SOFTSH_PRIMITIVE_MICRORECT)
        return UNSUPPORTED("softsh_settings::primitive is SOFTSH_PRIMITIVE_MICRORECT, which is not supported yet");
    if ((unsigned)s->aggregation > SOFTSH_AGGREGATION_SAMPLED)
        return INVALID("softsh_settings::aggregation is %d, expected a softsh_aggregation", (int)s->aggregation);
    if ((unsigned)s->merge > SOFTSH_MERGE_MAXIMUM)
        return INVALID("softsh_settings::merge is %d, expected a softsh_merge", (int)s->merge);
    if (s->budget > 4096)
        return INVALID("softsh_settings::budget is %u, expected at most 4096", s->budget);
    if (s->min_level > 13)
        return INVALID("softsh_settings::min_level is %u, expected at most 13", s->min_level);
    if ((unsigned)s->packet > SOFTSH_PACKET_ADAPTIVE)
        return INVALID("softsh_settings::packet is %d, expected a softsh_packet", (int)s->packet);
    if ((unsigned)s->reconstruction > SOFTSH_RECONSTRUCTION_BACKS)
        return INVALID("softsh_settings::reconstruction is %d, expected a softsh_reconstruction",
                       (int)s->reconstruction);
    if (s->technique == SOFTSH_TECHNIQUE_CONTOUR && s->reconstruction > SOFTSH_RECONSTRUCTION_JOINED &&
        s->aggregation == SOFTSH_AGGREGATION_NEAREST)
        return INVALID("softsh_settings::reconstruction is %d, but aggregation is SOFTSH_AGGREGATION_NEAREST, expected "
                       "SOFTSH_AGGREGATION_SAMPLED",
                       (int)s->reconstruction);
    if ((unsigned)s->search > SOFTSH_SEARCH_WALK)
        return INVALID("softsh_settings::search is %d, expected a softsh_search", (int)s->search);
    if (s->search == SOFTSH_SEARCH_WALK && s->technique == SOFTSH_TECHNIQUE_CONTOUR &&
        s->aggregation == SOFTSH_AGGREGATION_NEAREST)
        return UNSUPPORTED("softsh_settings::search is SOFTSH_SEARCH_WALK, but aggregation is "
                           "SOFTSH_AGGREGATION_NEAREST, expected SOFTSH_AGGREGATION_SAMPLED");
    if (s->outline && (s->technique == SOFTSH_TECHNIQUE_AREA || s->technique == SOFTSH_TECHNIQUE_BITMASK)) {
        if (s->primitive != SOFTSH_PRIMITIVE_DEFAULT && s->primitive != SOFTSH_PRIMITIVE_MICROQUAD)
            return INVALID("softsh_settings::outline is set, but primitive is %d, expected SOFTSH_PRIMITIVE_MICROQUAD",
                           (int)s->primitive);
        if (s->aggregation == SOFTSH_AGGREGATION_NEAREST)
            return INVALID("softsh_settings::outline is set, but aggregation is SOFTSH_AGGREGATION_NEAREST, expected "
                           "SOFTSH_AGGREGATION_SAMPLED");
        if (s->pattern == SOFTSH_PATTERN_32X32)
            return UNSUPPORTED("softsh_settings::outline is set, but pattern is SOFTSH_PATTERN_32X32, expected at "
                               "most 16 x 16");
        if (s->filter_passes > 0)
            return INVALID("softsh_settings::outline is set, but filter_passes is %u, expected 0", s->filter_passes);
    }
    const struct {
        const char *name;
        float value;
    } costs[] = {
        {"node", s->packet_cost.node}, {"edge", s->packet_cost.edge}, {"projection", s->packet_cost.projection}};
    for (int i = 0; i < 3; i++)
        if (!(costs[i].value >= 0.0f && costs[i].value <= 1e6f))
            return INVALID("softsh_settings::packet_cost.%s is %g, expected 0 to 1e6", costs[i].name,
                           (double)costs[i].value);
    if (!(s->packet_cost.divergence >= 0.0f && s->packet_cost.divergence <= 1.0f))
        return INVALID("softsh_settings::packet_cost.divergence is %g, expected 0 to 1",
                       (double)s->packet_cost.divergence);
    if (s->filter_passes > 16)
        return INVALID("softsh_settings::filter_passes is %u, expected at most 16", s->filter_passes);
    return SOFTSH_SUCCESS;
}

softsh_result softshi_check_view_info(const softsh_context *context, const softsh_view_info *info, softsh_view **out)
{
    CHECK_STRUCT(info, softsh_view_info);
    if (!out)
        return INVALID("softsh_view_create: out is NULL");
    softsh_result result = check_extent(context, "softsh_view_info::max_extent", info->max_extent);
    if (result != SOFTSH_SUCCESS)
        return result;
    if (info->output_format != VK_FORMAT_R8_UNORM && info->output_format != VK_FORMAT_R16_SFLOAT &&
        info->output_format != VK_FORMAT_R16_UNORM && info->output_format != VK_FORMAT_R32_SFLOAT)
        return UNSUPPORTED(
            "softsh_view_info::output_format is VkFormat %d, expected R8_UNORM, R16_UNORM, R16_SFLOAT or R32_SFLOAT",
            (int)info->output_format);
    VkFormatProperties properties;
    context->vk.GetPhysicalDeviceFormatProperties(context->physical_device, info->output_format, &properties);
    if (!(properties.optimalTilingFeatures & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT))
        return UNSUPPORTED("softsh_view_info::output_format VkFormat %d cannot be a storage image on this device",
                           (int)info->output_format);
    if (info->max_views > 1)
        return UNSUPPORTED("softsh_view_info::max_views is %u, more than 1 is not supported yet", info->max_views);
    result = check_recordings(context, "softsh_view_info::max_recordings", info->max_recordings);
    if (result == SOFTSH_SUCCESS)
        result = check_memory_mode(context, "softsh_view_info::memory_mode", info->memory_mode);
    if (result == SOFTSH_SUCCESS && info->settings)
        result = softshi_check_settings(context, info->settings);
    return result;
}

softsh_result softshi_check_light(const softsh_context *context, const softsh_light *light)
{
    if (!light)
        return INVALID("softsh_build_info::light is NULL");
    CHECK_STRUCT(light, softsh_light);
    if ((unsigned)light->shape > SOFTSH_LIGHT_SPHERE)
        return INVALID("softsh_light::shape is %d, expected a softsh_light_shape", (int)light->shape);
    if (light->shape == SOFTSH_LIGHT_DISC || light->shape == SOFTSH_LIGHT_SPHERE)
        return UNSUPPORTED("softsh_light::shape is %s, which is not supported yet",
                           light->shape == SOFTSH_LIGHT_DISC ? "SOFTSH_LIGHT_DISC" : "SOFTSH_LIGHT_SPHERE");
    if (light->color_count > 1)
        return UNSUPPORTED("softsh_light::color_count is %u, more than 1 is not supported yet", light->color_count);
    if (light->texture)
        return UNSUPPORTED("softsh_light::texture is set, which is not supported yet");
    if (!(light->radius == 0.0))
        return INVALID("softsh_light::radius is %g, expected 0 for this shape", light->radius);
    if (light->shape == SOFTSH_LIGHT_DIRECTIONAL) {
        if (!softshi_all_finite(light->direction, 3) || !(softshi_length3(light->direction) > 0.0) ||
            !isfinite(softshi_length3(light->direction)))
            return INVALID("softsh_light::direction is (%g, %g, %g), expected a finite vector that is not zero",
                           light->direction[0], light->direction[1], light->direction[2]);
        if (!(light->angular_radius >= 0.0 && light->angular_radius <= 0.5))
            return INVALID("softsh_light::angular_radius is %g, expected 0 to 0.5 radians", light->angular_radius);
        return SOFTSH_SUCCESS;
    }
    if (!softshi_all_finite(light->center, 3))
        return INVALID("softsh_light::center is (%g, %g, %g), expected finite numbers", light->center[0],
                       light->center[1], light->center[2]);
    const struct {
        const char *name;
        const double *v;
    } axes[] = {{"half_u", light->half_u}, {"half_v", light->half_v}};
    for (int i = 0; i < 2; i++)
        if (!softshi_all_finite(axes[i].v, 3) || !isfinite(softshi_dot3(axes[i].v, axes[i].v)))
            return INVALID("softsh_light::%s is (%g, %g, %g), expected finite numbers", axes[i].name, axes[i].v[0],
                           axes[i].v[1], axes[i].v[2]);
    const double u = softshi_length3(light->half_u), v = softshi_length3(light->half_v);
    if (fabs(softshi_dot3(light->half_u, light->half_v)) > 1e-3 * u * v)
        return INVALID("softsh_light::half_u and half_v enclose %.3g rad, expected a right angle",
                       acos(fmax(fmin(softshi_dot3(light->half_u, light->half_v) / (u * v), 1.0), -1.0)));
    return SOFTSH_SUCCESS;
}

softsh_result softshi_check_rectangle_light(const softsh_light *light)
{
    if (!light || light->struct_size != sizeof *light || (unsigned)light->shape > SOFTSH_LIGHT_SPHERE)
        return SOFTSH_ERROR_INVALID_ARGUMENT;
    if (light->shape != SOFTSH_LIGHT_RECTANGLE)
        return SOFTSH_ERROR_UNSUPPORTED;
    const bool finite = softshi_all_finite(light->center, 3) && softshi_all_finite(light->half_u, 3) &&
                        softshi_all_finite(light->half_v, 3);
    return finite ? SOFTSH_SUCCESS : SOFTSH_ERROR_INVALID_ARGUMENT;
}

/* `owner` and the last three names make up the fields' names. */
static softsh_result check_depth_input(const softsh_context *context, const char *owner, const char *const names[3],
                                       VkImageView view, VkFormat format, VkImageLayout layout)
{
    static const VkFormat formats[] = {VK_FORMAT_D16_UNORM,  VK_FORMAT_X8_D24_UNORM_PACK32, VK_FORMAT_D24_UNORM_S8_UINT,
                                       VK_FORMAT_D32_SFLOAT, VK_FORMAT_D32_SFLOAT_S8_UINT,  VK_FORMAT_R32_SFLOAT};
    if (!view)
        return INVALID("%s::%s is VK_NULL_HANDLE", owner, names[0]);
    bool known = false;
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        known = known || format == formats[i];
    if (!known)
        return UNSUPPORTED("%s::%s is VkFormat %d, expected a depth format or R32_SFLOAT", owner, names[1],
                           (int)format);
    VkFormatProperties properties;
    context->vk.GetPhysicalDeviceFormatProperties(context->physical_device, format, &properties);
    if (!(properties.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT))
        return UNSUPPORTED("%s::%s is VkFormat %d, which this device cannot sample", owner, names[1], (int)format);
    if (layout != VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL &&
        layout != VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL && layout != VK_IMAGE_LAYOUT_GENERAL)
        return INVALID(
            "%s::%s is VkImageLayout %d, expected SHADER_READ_ONLY_OPTIMAL, DEPTH_STENCIL_READ_ONLY_OPTIMAL or GENERAL",
            owner, names[2], (int)layout);
    if (format == VK_FORMAT_R32_SFLOAT && layout == VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL)
        return INVALID("%s::%s is DEPTH_STENCIL_READ_ONLY_OPTIMAL, which colour images never are", owner, names[2]);
    return SOFTSH_SUCCESS;
}

softsh_result softshi_check_rect(const softsh_context *context, const char *field, VkExtent2D inside, VkRect2D *rect)
{
    if (rect->extent.width == 0 && rect->extent.height == 0 && rect->offset.x == 0 && rect->offset.y == 0)
        rect->extent = inside;
    const int64_t right = (int64_t)rect->offset.x + rect->extent.width,
                  bottom = (int64_t)rect->offset.y + rect->extent.height;
    if (rect->extent.width == 0 || rect->extent.height == 0 || rect->offset.x < 0 || rect->offset.y < 0 ||
        right > inside.width || bottom > inside.height)
        return INVALID("%s is %d, %d, %u x %u, expected a rectangle inside %u x %u", field, rect->offset.x,
                       rect->offset.y, rect->extent.width, rect->extent.height, inside.width, inside.height);
    return SOFTSH_SUCCESS;
}

static softsh_result check_map(const softsh_context *context, const softsh_map *map, uint32_t i, uint32_t count)
{
    if (map->struct_size != sizeof *map)
        return INVALID("softsh_map[%u]::struct_size is %u, expected %u", i, map->struct_size, (unsigned)sizeof *map);
    if ((unsigned)map->role > SOFTSH_MAP_CASCADE)
        return INVALID("softsh_map[%u]::role is %d, expected a softsh_map_role", i, (int)map->role);
    if (map->role == SOFTSH_MAP_FACE || map->role == SOFTSH_MAP_CASCADE)
        return UNSUPPORTED("softsh_map[%u]::role is %s, which is not supported yet", i,
                           map->role == SOFTSH_MAP_FACE ? "SOFTSH_MAP_FACE" : "SOFTSH_MAP_CASCADE");
    for (int axis = 0; axis < 2; axis++) {
        if (map->role == SOFTSH_MAP_LAYER && (map->grid[axis] != 0 || map->cell[axis] != 0))
            return INVALID("softsh_map[%u]::grid is (%u, %u) and ::cell (%u, %u), expected zeros with SOFTSH_MAP_LAYER",
                           i, map->grid[0], map->grid[1], map->cell[0], map->cell[1]);
        if (map->role == SOFTSH_MAP_SUBLIGHT && (map->grid[axis] == 0 || map->grid[axis] > SOFTSH_MAX_SUBLIGHTS))
            return INVALID("softsh_map[%u]::grid is (%u, %u), expected 1 to %u each", i, map->grid[0], map->grid[1],
                           SOFTSH_MAX_SUBLIGHTS);
        if (map->role == SOFTSH_MAP_SUBLIGHT && map->cell[axis] >= map->grid[axis])
            return INVALID("softsh_map[%u]::cell is (%u, %u), expected less than ::grid, (%u, %u)", i, map->cell[0],
                           map->cell[1], map->grid[0], map->grid[1]);
    }
    if (map->index >= count)
        return INVALID("softsh_map[%u]::index is %u, expected less than the number of maps, %u", i, map->index, count);
    if (map->array_layer != 0)
        return UNSUPPORTED("softsh_map[%u]::array_layer is %u, expected 0 and a view of the layer", i,
                           map->array_layer);
    static const char *const names[] = {"view", "format", "layout"};
    char field[48];
    snprintf(field, sizeof field, "softsh_map[%u]", i);
    const softsh_result result = check_depth_input(context, field, names, map->view, map->format, map->layout);
    if (result != SOFTSH_SUCCESS)
        return result;
    snprintf(field, sizeof field, "softsh_map[%u]::image_extent", i);
    return check_extent(context, field, map->image_extent);
}

/* Maps of a build are all layers of the light, or all of one sub-light. */
static softsh_result check_same_part(const softsh_context *context, const softsh_map *first, const softsh_map *map,
                                     uint32_t i)
{
    if (map->role != first->role)
        return INVALID("softsh_map[%u]::role is %d, but that of softsh_map[0] is %d, expected one role in a build", i,
                       (int)map->role, (int)first->role);
    if (map->grid[0] != first->grid[0] || map->grid[1] != first->grid[1] || map->cell[0] != first->cell[0] ||
        map->cell[1] != first->cell[1])
        return INVALID("softsh_map[%u] is of sub-light (%u, %u) of %u x %u, but softsh_map[0] of (%u, %u) of %u x %u, "
                       "expected a build for each sub-light",
                       i, map->cell[0], map->cell[1], map->grid[0], map->grid[1], first->cell[0], first->cell[1],
                       first->grid[0], first->grid[1]);
    return SOFTSH_SUCCESS;
}

softsh_result softshi_check_maps(const softsh_context *context, const softsh_build_info *info, VkExtent2D max_extent,
                                 uint32_t max_layers, VkExtent2D *extent)
{
    const softsh_map *const maps = info->maps;
    const uint32_t count = info->map_count;
    if (count == 0)
        return INVALID("softsh_build_info::map_count is 0, expected 1 to %u", max_layers);
    if (!maps)
        return INVALID("softsh_build_info::maps is NULL");
    if (count > max_layers)
        return softshi_fail(context, SOFTSH_ERROR_LIMIT,
                            "softsh_build_info::map_count is %u, expected at most max_layers, %u", count, max_layers);
    uint32_t seen = 0;
    for (uint32_t i = 0; i < count; i++) {
        softsh_result result = check_map(context, &maps[i], i, count);
        if (result == SOFTSH_SUCCESS)
            result = check_same_part(context, &maps[0], &maps[i], i);
        VkRect2D rect = maps[i].rect;
        char field[48];
        snprintf(field, sizeof field, "softsh_map[%u]::rect", i);
        if (result == SOFTSH_SUCCESS)
            result = softshi_check_rect(context, field, maps[i].image_extent, &rect);
        if (result != SOFTSH_SUCCESS)
            return result;
        if (seen & 1u << maps[i].index)
            return INVALID("softsh_map[%u]::index is %u, which another map has already", i, maps[i].index);
        seen |= 1u << maps[i].index;
        if (i == 0)
            *extent = rect.extent;
        if (rect.extent.width != extent->width || rect.extent.height != extent->height)
            return INVALID("softsh_map[%u] is %u x %u, expected the size of the first layer, %u x %u", i,
                           rect.extent.width, rect.extent.height, extent->width, extent->height);
    }
    if (maps[0].role == SOFTSH_MAP_SUBLIGHT && info->light->shape != SOFTSH_LIGHT_RECTANGLE)
        return UNSUPPORTED("softsh_map[0]::role is SOFTSH_MAP_SUBLIGHT, which is for SOFTSH_LIGHT_RECTANGLE");
    if (extent->width > max_extent.width || extent->height > max_extent.height)
        return softshi_fail(context, SOFTSH_ERROR_LIMIT, "softsh_map is %u x %u, expected at most max_extent, %u x %u",
                            extent->width, extent->height, max_extent.width, max_extent.height);
    return SOFTSH_SUCCESS;
}

softsh_result softshi_check_camera(const softsh_context *context, const softsh_camera *camera, bool normals)
{
    CHECK_STRUCT(camera, softsh_camera);
    if (camera->samples != 0 && camera->samples != VK_SAMPLE_COUNT_1_BIT)
        return UNSUPPORTED("softsh_camera::samples is %d, more than one is not supported yet", (int)camera->samples);
    static const char *const names[] = {"depth", "depth_format", "depth_layout"};
    const softsh_result result =
        check_depth_input(context, "softsh_camera", names, camera->depth, camera->depth_format, camera->depth_layout);
    if (result != SOFTSH_SUCCESS)
        return result;
    if (normals && !camera->normals)
        return INVALID("softsh_camera::normals is VK_NULL_HANDLE, but the view was created with normals");
    if (!normals && camera->normals)
        return INVALID("softsh_camera::normals is set, but the view was created without normals");
    if (normals && camera->normals_layout != VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL &&
        camera->normals_layout != VK_IMAGE_LAYOUT_GENERAL)
        return INVALID(
            "softsh_camera::normals_layout is VkImageLayout %d, expected SHADER_READ_ONLY_OPTIMAL or GENERAL",
            (int)camera->normals_layout);
    return SOFTSH_SUCCESS;
}

softsh_result softshi_check_timestamps(const softsh_context *context, const softsh_timestamps *timestamps)
{
    if (!timestamps)
        return SOFTSH_SUCCESS;
    CHECK_STRUCT(timestamps, softsh_timestamps);
    if (!timestamps->pool)
        return INVALID("softsh_timestamps::pool is VK_NULL_HANDLE");
    if (timestamps->query_count < SOFTSH_MAX_PASSES + 1)
        return INVALID("softsh_timestamps::query_count is %u, expected at least %u", timestamps->query_count,
                       SOFTSH_MAX_PASSES + 1);
    if (timestamps->first_query > UINT32_MAX - timestamps->query_count)
        return INVALID("softsh_timestamps::first_query is %u, which with %u queries passes the largest number",
                       timestamps->first_query, timestamps->query_count);
    return SOFTSH_SUCCESS;
}
