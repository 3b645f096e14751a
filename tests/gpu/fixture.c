#include "fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "reference_matrix.h"

gpu device;
softsh_context *context;

static char message[1024];

static void on_message(void *user, softsh_result result, const char *text)
{
    (void)user;
    snprintf(message, sizeof message, "%s: %s", softsh_result_string(result), text);
}

void require(softsh_result result)
{
    if (result != SOFTSH_SUCCESS)
        fail_msg("%s", message);
}

static void require_gpu(bool ok)
{
    if (!ok)
        fail_msg("%s", device.error);
}

/* Two writes to the same bytes with nothing between them: a layer that is awake reports it. */
static bool hazard_is_reported(void)
{
    gpu_buffer buffer;
    VkCommandBuffer cmd;

    if (!gpu_buffer_create(&device, 64, VK_BUFFER_USAGE_TRANSFER_DST_BIT, true, &buffer))
        return false;
    device.validation_quiet = true;
    cmd = gpu_begin(&device);
    vkCmdFillBuffer(cmd, buffer.buffer, 0, 64, 1);
    vkCmdFillBuffer(cmd, buffer.buffer, 0, 64, 2);
    gpu_submit(&device, cmd);
    gpu_buffer_destroy(&device, &buffer);
    device.validation_quiet = false;
    const bool reported = device.validation_messages > 0;
    device.validation_messages = 0;
    return reported;
}

int fixture_setup(void **state)
{
    const gpu_info info = {.validation = true};
    softsh_context_info create = {.struct_size = sizeof create, .debug_names = 1, .message = on_message};
    (void)state;

    if (!gpu_create(&info, &device)) {
        fprintf(stderr, "%s\n", device.error);
        return 1;
    }
    if (!hazard_is_reported()) {
        fprintf(stderr, "synchronization validation is not running\n");
        return 1;
    }
    create.instance = device.instance;
    create.physical_device = device.physical_device;
    create.device = device.device;
    create.get_instance_proc_addr = vkGetInstanceProcAddr;
    create.get_device_proc_addr = vkGetDeviceProcAddr;
    if (softsh_context_create(&create, &context) == SOFTSH_SUCCESS)
        return 0;
    fprintf(stderr, "%s\n", message);
    return 1;
}

int fixture_teardown(void **state)
{
    (void)state;
    softsh_context_destroy(context);
    /* A failed test leaks: one message says enough. */
    const uint32_t before = device.validation_messages;
    device.validation_quiet = true;
    gpu_destroy(&device);
    if (device.validation_messages > before)
        fprintf(stderr, "validation: %u messages, the last: %.200s\n", device.validation_messages - before,
                device.last_validation_message);
    return device.validation_messages != 0;
}

static placement whole(placement p)
{
    p.image_width = p.image_width ? p.image_width : p.width;
    p.image_height = p.image_height ? p.image_height : p.height;
    return p;
}

static VkFormat format_or_float(VkFormat format)
{
    return format ? format : VK_FORMAT_R32_SFLOAT;
}

/* Unorm steps of a depth format; 0 for floats. */
static double depth_steps(VkFormat format)
{
    switch (format) {
    case VK_FORMAT_D16_UNORM:
        return 65535.0;
    case VK_FORMAT_X8_D24_UNORM_PACK32:
    case VK_FORMAT_D24_UNORM_S8_UINT:
        return 16777215.0;
    default:
        return 0.0;
    }
}

float stored_depth(VkFormat format, float depth)
{
    const double steps = depth_steps(format);
    return steps > 0.0 ? (float)(nearbyint(fmin(fmax((double)depth, 0.0), 1.0) * steps) / steps) : depth;
}

bool depth_format_supported(VkFormat format)
{
    VkFormatProperties properties;
    vkGetPhysicalDeviceFormatProperties(device.physical_device, format, &properties);
    const VkFormatFeatureFlags needed = VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_TRANSFER_DST_BIT;
    return (properties.optimalTilingFeatures & needed) == needed;
}

/* Rubbish that would be seen: nearest, farthest and, in floats, everything that is no depth. */
static float rubbish(size_t i)
{
    static const float values[] = {0.0f, 1.0f, NAN, 0.5f, INFINITY, -1.0f};
    return values[i * 7 % 6];
}

/* An image with `values`, `channels` floats each, at their place, rubbish around them. */
static void upload(placement p, VkFormat format, uint32_t channels, const float *values, VkImageLayout layout,
                   gpu_image *out)
{
    /* A renderer's depth buffer is an attachment as well, which its read-only layout asks for. */
    const VkImageUsageFlags attachment =
        format == VK_FORMAT_R32_SFLOAT || channels > 1 ? 0 : VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    const gpu_image_info info = {.format = format,
                                 .width = p.image_width,
                                 .height = p.image_height,
                                 .usage = VK_IMAGE_USAGE_SAMPLED_BIT | attachment};
    const size_t texels = (size_t)p.image_width * p.image_height, texel = gpu_format_size(format);
    const double steps = depth_steps(format);
    unsigned char *bytes = malloc(texels * texel);

    assert_non_null(bytes);
    assert_true(p.x + p.width <= p.image_width && p.y + p.height <= p.image_height);
    for (size_t i = 0; i < texels; i++) {
        const uint32_t x = (uint32_t)(i % p.image_width) - p.x, y = (uint32_t)(i / p.image_width) - p.y;
        for (uint32_t c = 0; c < channels; c++) {
            const float value =
                x < p.width && y < p.height ? values[((size_t)y * p.width + x) * channels + c] : rubbish(i + c);
            if (steps > 0.0) {
                const uint32_t step =
                    isnan(value) ? 0 : (uint32_t)nearbyint(fmin(fmax((double)value, 0.0), 1.0) * steps);
                const uint16_t half = (uint16_t)step;
                memcpy(bytes + i * texel, texel == 2 ? (const void *)&half : (const void *)&step, texel);
            } else {
                memcpy(bytes + i * texel + c * sizeof value, &value, sizeof value);
            }
        }
    }
    require_gpu(gpu_image_create(&device, &info, out));
    require_gpu(gpu_image_upload(&device, out, bytes, texels * texel, layout));
    free(bytes);
}

void lamp_create(const lamp_info *info, lamp *out)
{
    const placement p = whole(info->place);
    const softsh_occluders_info create = {
        .struct_size = sizeof create,
        .max_extent = info->max_extent.width ? info->max_extent : (VkExtent2D){p.width, p.height},
        .max_layers = info->layer_count,
        .accel = info->accel,
        .ysm_join = info->ysm_join,
        .no_folds = info->no_folds,
        .dual_grids = info->dual_grids,
        .name = "test",
    };

    memset(out, 0, sizeof *out);
    out->light = info->light;
    out->light.struct_size = sizeof out->light;
    out->layer_count = info->layer_count;
    for (uint32_t i = 0; i < info->layer_count; i++) {
        const uint32_t layer = info->reverse_order ? info->layer_count - 1 - i : i;
        const VkFormat format = format_or_float(info->layers[layer].format);
        softsh_map *map = &out->maps[i];
        upload(p, format, 1, info->layers[layer].depth,
               info->layout ? info->layout : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, &out->images[i]);
        map->struct_size = sizeof *map;
        map->index = layer;
        map->role = info->grid[0] ? SOFTSH_MAP_SUBLIGHT : SOFTSH_MAP_LAYER;
        memcpy(map->grid, info->grid, sizeof map->grid);
        memcpy(map->cell, info->cell, sizeof map->cell);
        map->view = out->images[i].view;
        map->format = format;
        map->layout = out->images[i].layout;
        map->image_extent = (VkExtent2D){p.image_width, p.image_height};
        map->rect.offset = (VkOffset2D){(int32_t)p.x, (int32_t)p.y};
        map->rect.extent = (VkExtent2D){p.width, p.height};
        memcpy(map->view_matrix, info->view, sizeof map->view_matrix);
        memcpy(map->projection, info->layers[layer].projection, sizeof map->projection);
    }
    require(softsh_occluders_create(context, &create, &out->occluders));
    VkCommandBuffer cmd = gpu_begin(&device);
    lamp_record(out, cmd);
    require_gpu(gpu_submit(&device, cmd));
}

static void lamp_record_into(lamp *l, softsh_occluders *occluders, VkCommandBuffer cmd)
{
    const softsh_build_info build = {
        .struct_size = sizeof build, .light = &l->light, .map_count = l->layer_count, .maps = l->maps};
    require(softsh_cmd_build_occluders(cmd, occluders, &build));
}

void lamp_record(lamp *l, VkCommandBuffer cmd)
{
    lamp_record_into(l, l->occluders, cmd);
}

void lamp_destroy(lamp *l)
{
    softsh_occluders_destroy(l->occluders);
    for (uint32_t i = 0; i < l->layer_count; i++)
        gpu_image_destroy(&device, &l->images[i]);
    memset(l, 0, sizeof *l);
}

void lamp_reference(const lamp_info *info, reference_map *out)
{
    assert_true(reference_map_derive(out, info->view, info->layers[0].projection, info->place.width, info->place.height,
                                     &info->light));
}

void lamp_fan_depth(const lamp_info *info, uint32_t layer, float *g)
{
    const VkFormat format = format_or_float(info->layers[layer].format);
    reference_map map;
    assert_true(reference_map_derive(&map, info->view, info->layers[layer].projection, info->place.width,
                                     info->place.height, &info->light));
    /* Orthographic layers measure g from the first one's middle. */
    reference_map first;
    double here[3] = {0.0, 0.0, map.perspective ? 1.0 : 0.0}, world[3];
    lamp_reference(info, &first);
    reference_map_unproject(&map, here, world);
    assert_true(reference_map_project(&first, world, here));
    const double zero = map.perspective ? 0.0 : here[2];
    for (size_t i = 0; i < (size_t)info->place.width * info->place.height; i++)
        g[i] =
            (float)(zero + reference_map_depth_to_g(&map, (double)stored_depth(format, info->layers[layer].depth[i])));
}

void eye_create(const eye_info *info, eye *out)
{
    const VkFormat format = format_or_float(info->format);
    const VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;

    memset(out, 0, sizeof *out);
    out->place = whole(info->place);
    upload(out->place, format, 1, info->depth, layout, &out->depth);
    out->camera.struct_size = sizeof out->camera;
    out->camera.depth = out->depth.view;
    out->camera.depth_format = format;
    out->camera.depth_layout = layout;
    if (info->normals) {
        const size_t pixels = (size_t)info->place.width * info->place.height;
        float *four = calloc(pixels, 4 * sizeof *four);
        assert_non_null(four);
        for (size_t i = 0; i < pixels; i++)
            memcpy(four + 4 * i, info->normals + 3 * i, 3 * sizeof *four);
        upload(out->place, VK_FORMAT_R32G32B32A32_SFLOAT, 4, four, layout, &out->normals);
        free(four);
        out->camera.normals = out->normals.view;
        out->camera.normals_layout = layout;
    }
    memcpy(out->camera.view_matrix, info->view, sizeof info->view);
    memcpy(out->camera.projection, info->projection, sizeof info->projection);
}

void eye_destroy(eye *e)
{
    gpu_image_destroy(&device, &e->depth);
    if (e->normals.image)
        gpu_image_destroy(&device, &e->normals);
    memset(e, 0, sizeof *e);
}

void eye_reference(const eye_info *info, reference_camera *out)
{
    assert_true(reference_camera_derive(out, info->view, info->projection, info->place.width, info->place.height));
}

static double format_precision(VkFormat format)
{
    return format == VK_FORMAT_D16_UNORM ? REFERENCE_PRECISION_16 : REFERENCE_PRECISION;
}

reference_bias precision_of(const lamp_info *l, const eye_info *e)
{
    reference_bias bias = {.camera_precision = format_precision(e->format)};
    double first = 0.0, largest = 0.0;
    for (uint32_t i = 0; i < l->layer_count; i++) {
        reference_map map;
        assert_true(
            reference_map_derive(&map, l->view, l->layers[i].projection, l->place.width, l->place.height, &l->light));
        first = i == 0 ? fabs(map.depth_scale) : first;
        largest = fmax(largest, fabs(map.depth_scale) * format_precision(l->layers[i].format));
    }
    /* The reference multiplies by the first layer's scale. */
    bias.map_precision = largest / first;
    return bias;
}

void sight_create(const sight_info *info, sight *out)
{
    const VkFormat format = format_or_float(info->format);
    const gpu_image_info image = {
        .format = format, .width = info->width, .height = info->height, .usage = VK_IMAGE_USAGE_STORAGE_BIT};
    softsh_settings settings = info->settings;
    const softsh_view_info create = {
        .struct_size = sizeof create,
        .max_extent = {info->width, info->height},
        .output_format = format,
        .settings = &settings,
        .stats = 1,
        .normals = info->normals,
        .sublights = info->sublights,
        .name = "test",
    };

    memset(out, 0, sizeof *out);
    settings.struct_size = sizeof settings;
    require(softsh_view_create(context, &create, &out->view));
    require_gpu(gpu_image_create(&device, &image, &out->image));
    require_gpu(gpu_buffer_create(&device,
                                  (VkDeviceSize)info->width * info->height * sizeof(float) + sizeof(softsh_stats),
                                  VK_BUFFER_USAGE_TRANSFER_DST_BIT, true, &out->staging));
}

void sight_destroy(sight *s)
{
    softsh_view_destroy(s->view);
    gpu_image_destroy(&device, &s->image);
    gpu_buffer_destroy(&device, &s->staging);
    memset(s, 0, sizeof *s);
}

/* No visibility in formats that can hold it, a rare one in the others; exact in each of them. */
static float guard_value(VkFormat format)
{
    if (format == VK_FORMAT_R8_UNORM)
        return 77.0f / 255.0f;
    return format == VK_FORMAT_R16_UNORM ? 20001.0f / 65535.0f : -7.0f;
}

static float half_to_float(uint16_t half)
{
    const int exponent = half >> 10 & 31;
    const double fraction = half & 1023;
    const double size = exponent ? ldexp(1024.0 + fraction, exponent - 25) : ldexp(fraction, -24);
    return (float)(exponent == 31 ? (fraction > 0.0 ? (double)NAN : (double)INFINITY) : size) *
           (half & 0x8000 ? -1.0f : 1.0f);
}

static float texel_value(VkFormat format, const void *data, size_t i)
{
    switch (format) {
    case VK_FORMAT_R8_UNORM:
        return (float)((const uint8_t *)data)[i] / 255.0f;
    case VK_FORMAT_R16_UNORM:
        return (float)((const uint16_t *)data)[i] / 65535.0f;
    case VK_FORMAT_R16_SFLOAT:
        return half_to_float(((const uint16_t *)data)[i]);
    default:
        return ((const float *)data)[i];
    }
}

/* One submission: fills the image with the guard if told to, builds `built` if there is one, and runs. */
static void run_once(sight *s, bool clear, lamp *built, softsh_occluders *occluders, const eye *e,
                     const sight_options *options, float *visibility, softsh_stats *stats)
{
    const VkDeviceSize stats_offset = (VkDeviceSize)s->image.width * s->image.height * sizeof(float);
    const VkRect2D area = {{(int32_t)e->place.x, (int32_t)e->place.y}, {e->place.width, e->place.height}};
    const VkClearColorValue guard = {.float32 = {guard_value(s->image.format)}};
    const VkImageSubresourceRange all = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                    .imageExtent = {s->image.width, s->image.height, 1}};
    const softsh_visibility_info info = {
        .struct_size = sizeof info,
        .occluders = occluders,
        .camera_count = 1,
        .cameras = &e->camera,
        .render_area = area,
        .visibility = s->image.view,
        .override_bias = options && options->override_bias,
        .bias = options ? options->bias : 0.0,
        .stats_buffer = s->staging.buffer,
        .stats_offset = stats_offset,
    };

    const VkMemoryBarrier to_host = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                     .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                     .dstAccessMask = VK_ACCESS_HOST_READ_BIT};

    assert_int_equal(s->image.width, e->place.image_width);
    assert_int_equal(s->image.height, e->place.image_height);
    VkCommandBuffer cmd = gpu_begin(&device);
    if (built)
        lamp_record_into(built, occluders, cmd);
    if (clear) {
        s->image.layout = VK_IMAGE_LAYOUT_UNDEFINED;
        gpu_cmd_image_layout(cmd, &s->image, VK_IMAGE_LAYOUT_GENERAL);
        vkCmdClearColorImage(cmd, s->image.image, VK_IMAGE_LAYOUT_GENERAL, &guard, 1, &all);
    }
    gpu_cmd_image_layout(cmd, &s->image, VK_IMAGE_LAYOUT_GENERAL);
    require(softsh_cmd_compute_visibility(cmd, s->view, &info));
    gpu_cmd_image_layout(cmd, &s->image, VK_IMAGE_LAYOUT_GENERAL);
    vkCmdCopyImageToBuffer(cmd, s->image.image, VK_IMAGE_LAYOUT_GENERAL, s->staging.buffer, 1, &copy);
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &to_host, 0, NULL, 0,
                         NULL);
    require_gpu(gpu_submit(&device, cmd));

    for (uint32_t y = 0; y < s->image.height; y++)
        for (uint32_t x = 0; x < s->image.width; x++) {
            const float value = texel_value(s->image.format, s->staging.mapped, (size_t)y * s->image.width + x);
            const uint32_t i = x - e->place.x, j = y - e->place.y;
            if (i < e->place.width && j < e->place.height)
                visibility[(size_t)j * e->place.width + i] = value;
            else if (value != guard.float32[0])
                fail_msg("texel (%u, %u) outside the render area was written: %g", x, y, (double)value);
        }
    if (stats)
        memcpy(stats, (const char *)s->staging.mapped + stats_offset, sizeof *stats);
}

void sight_run(sight *s, const lamp *l, const eye *e, const sight_options *options, float *visibility,
               softsh_stats *stats)
{
    run_once(s, true, NULL, l->occluders, e, options, visibility, stats);
}

void sight_run_all(sight *s, lamp *lamps, uint32_t count, bool rebuilt, const eye *e, float *const *visibility)
{
    for (uint32_t i = 0; i < count; i++)
        run_once(s, i == 0, rebuilt ? &lamps[i] : NULL, lamps[rebuilt ? 0 : i].occluders, e, NULL, visibility[i], NULL);
}
