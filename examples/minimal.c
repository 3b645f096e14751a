/* The smallest complete use of the library: one light, one camera, no window.
 *
 * A square floats above a floor, a camera looks down at both. A renderer would have two depth buffers by now, the
 * camera's and the light's; here a few lines of ray-plane arithmetic stand in for it. The library turns them into the
 * visible fraction of the light per pixel, printed as ASCII art: blank is fully lit, '@' is dark.
 *
 * The Vulkan host (device, images, transfers) is common/gpu.h; what to look at are the softsh_ calls, in the order in
 * which a renderer makes them. With --validate it runs under the validation layer and fails if that has anything to
 * say. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <softshadow/softshadow.h>

#include "gpu.h"

enum { WIDTH = 72, HEIGHT = 36, MAP = 128 };

/* The world: z is up, the floor is z = 0, and the occluder is the square |x|, |y| < 0.9 at z = 1.6. */
static const double occluder_height = 1.6, occluder_half = 0.9, floor_half = 6.0;

/* Depth 0 to 1 of the nearest of the two planes through each texel's centre. The point of the plane z = c that
 * projects to clip (x, y) solves two linear equations, (r0 - x r3) . p = 0 and (r1 - y r3) . p = 0, where r0 to r3 are
 * the rows of projection * view. */
static void render_depth(const double view[16], const double projection[16], int width, int height, float *depth)
{
    double r[4][4] = {{0}};
    for (int row = 0; row < 4; row++)
        for (int column = 0; column < 4; column++)
            for (int k = 0; k < 4; k++)
                r[row][column] += projection[4 * k + row] * view[4 * column + k];
    for (int i = 0; i < width * height; i++) {
        const double x = 2.0 * (i % width + 0.5) / width - 1.0, y = 2.0 * (i / width + 0.5) / height - 1.0;
        double nearest = 1.0; /* the far plane: nothing here */
        for (int plane = 0; plane < 2; plane++) {
            const double c = plane ? occluder_height : 0.0, half = plane ? occluder_half : floor_half;
            double a[4], b[4];
            for (int k = 0; k < 4; k++) {
                a[k] = r[0][k] - x * r[3][k];
                b[k] = r[1][k] - y * r[3][k];
            }
            const double determinant = a[0] * b[1] - a[1] * b[0], ac = a[2] * c + a[3], bc = b[2] * c + b[3];
            const double px = (a[1] * bc - b[1] * ac) / determinant, py = (b[0] * ac - a[0] * bc) / determinant;
            const double w = r[3][0] * px + r[3][1] * py + r[3][2] * c + r[3][3];
            const double d = (r[2][0] * px + r[2][1] * py + r[2][2] * c + r[2][3]) / w;
            if (fabs(px) < half && fabs(py) < half && w > 0.0 && d >= 0.0 && d < nearest)
                nearest = d;
        }
        depth[i] = (float)nearest;
    }
}

static bool make_depth_image(gpu *g, uint32_t width, uint32_t height, const float *texels, gpu_image *out)
{
    const gpu_image_info info = {
        .format = VK_FORMAT_D32_SFLOAT, .width = width, .height = height, .usage = VK_IMAGE_USAGE_SAMPLED_BIT};
    return gpu_image_create(g, &info, out) &&
           gpu_image_upload(g, out, texels, sizeof *texels * width * height, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

static void on_message(void *user, softsh_result result, const char *message)
{
    (void)user;
    fprintf(stderr, "softshadow: %s (%s)\n", message, softsh_result_string(result));
}

static void print(const float *visibility)
{
    static const char shades[] = "@%#*+=-:. "; /* dark to lit */
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++)
            putchar(shades[lrintf(9.0f * fminf(fmaxf(visibility[y * WIDTH + x], 0.0f), 1.0f))]);
        putchar('\n');
    }
}

int main(int argc, char **argv)
{
    static gpu g;
    static float camera_depth[WIDTH * HEIGHT], map_depth[MAP * MAP], result[WIDTH * HEIGHT];
    const gpu_info host = {.validation = argc > 1 && strcmp(argv[1], "--validate") == 0};
    gpu_image camera_image = {0}, map_image = {0}, output = {0};
    softsh_context *context = NULL;
    softsh_occluders *occluders = NULL;
    softsh_view *view = NULL;
    VkCommandBuffer cmd = VK_NULL_HANDLE;
    softsh_result recorded;
    int status = 1;

    /* A light of 1 x 1 at z = 5, and a map that covers the occluder and its shadow. */
    const softsh_light light = {.struct_size = sizeof light,
                                .shape = SOFTSH_LIGHT_RECTANGLE,
                                .center = {0.5, 1.2, 5.0},
                                .half_u = {0.5, 0.0, 0.0},
                                .half_v = {0.0, 0.5, 0.0}};
    const double target[3] = {0.0, 0.0, 0.75};
    softsh_light_frustum frustum = {.struct_size = sizeof frustum};
    if (softsh_light_frustum_create(&light, target, 3.0, 0.0, &frustum) != SOFTSH_SUCCESS)
        goto error;

    /* The camera stands at (0, -5, 5) and looks at the origin. Matrices are listed column by column; the rows of the
     * view matrix are right (1, 0, 0), down (0, -q, -q) and forward (0, q, -q). Depth is 0 at n and 1 at f. */
    const double q = 0.70710678118654752, n = 0.5, f = 20.0;
    softsh_camera camera = {
        .struct_size = sizeof camera,
        .depth_format = VK_FORMAT_D32_SFLOAT,
        .depth_layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
        .view_matrix = {1, 0, 0, 0, 0, -q, q, 0, 0, -q, -q, 0, 0, 0, 10 * q, 1},
        .projection = {2.8, 0, 0, 0, 0, 2.8, 0, 0, 0, 0, f / (f - n), 1, 0, 0, -n * f / (f - n), 0},
    };

    /* The renderer's part: a device with the features softsh_get_requirements lists (gpu_create enables them), and
     * the two depth buffers, in a layout that shaders can read. */
    if (!gpu_create(&host, &g)) {
        fprintf(stderr, "minimal: %s\n", g.error);
        return 1;
    }
    softsh_requirements requirements = {.struct_size = sizeof requirements};
    if (softsh_get_requirements(vkGetInstanceProcAddr, g.instance, g.physical_device, &requirements) !=
            SOFTSH_SUCCESS ||
        !requirements.supported) {
        fprintf(stderr, "minimal: %s cannot run the library\n", g.properties.deviceName);
        goto error;
    }
    render_depth(camera.view_matrix, camera.projection, WIDTH, HEIGHT, camera_depth);
    render_depth(frustum.view_matrix, frustum.projection, MAP, MAP, map_depth);
    const gpu_image_info output_info = {
        .format = VK_FORMAT_R32_SFLOAT, .width = WIDTH, .height = HEIGHT, .usage = VK_IMAGE_USAGE_STORAGE_BIT};
    if (!make_depth_image(&g, WIDTH, HEIGHT, camera_depth, &camera_image) ||
        !make_depth_image(&g, MAP, MAP, map_depth, &map_image) || !gpu_image_create(&g, &output_info, &output))
        goto error;

    /* Once per device, light and camera. */
    const softsh_context_info context_info = {
        .struct_size = sizeof context_info,
        .instance = g.instance,
        .physical_device = g.physical_device,
        .device = g.device,
        .get_instance_proc_addr = vkGetInstanceProcAddr,
        .get_device_proc_addr = vkGetDeviceProcAddr,
        .message = on_message,
    };
    const softsh_occluders_info occluders_info = {.struct_size = sizeof occluders_info, .max_extent = {MAP, MAP}};
    const softsh_view_info view_info = {
        .struct_size = sizeof view_info, .max_extent = {WIDTH, HEIGHT}, .output_format = VK_FORMAT_R32_SFLOAT};
    if (softsh_context_create(&context_info, &context) != SOFTSH_SUCCESS ||
        softsh_occluders_create(context, &occluders_info, &occluders) != SOFTSH_SUCCESS ||
        softsh_view_create(context, &view_info, &view) != SOFTSH_SUCCESS)
        goto error;

    /* Per frame. The build is needed only when the light or its map has changed. */
    softsh_map map = {.struct_size = sizeof map,
                      .view = map_image.view,
                      .format = map_image.format,
                      .layout = map_image.layout,
                      .image_extent = {MAP, MAP}};
    memcpy(map.view_matrix, frustum.view_matrix, sizeof map.view_matrix);
    memcpy(map.projection, frustum.projection, sizeof map.projection);
    const softsh_build_info build = {.struct_size = sizeof build, .light = &light, .map_count = 1, .maps = &map};
    camera.depth = camera_image.view;
    const softsh_visibility_info compute = {.struct_size = sizeof compute,
                                            .occluders = occluders,
                                            .camera_count = 1,
                                            .cameras = &camera,
                                            .visibility = output.view};
    cmd = gpu_begin(&g);
    if (!cmd)
        goto error;
    gpu_cmd_image_layout(cmd, &output, VK_IMAGE_LAYOUT_GENERAL); /* where the library wants to find it */
    recorded = softsh_cmd_build_occluders(cmd, occluders, &build);
    if (recorded == SOFTSH_SUCCESS)
        recorded = softsh_cmd_compute_visibility(cmd, view, &compute);
    if (!gpu_submit(&g, cmd) || recorded != SOFTSH_SUCCESS)
        goto error;

    /* A renderer would now multiply its lighting by the image, after a barrier; this reads it back instead. */
    if (!gpu_image_read(&g, &output, result, sizeof result))
        goto error;
    print(result);
    status = 0;
error:
    if (status && g.error[0])
        fprintf(stderr, "minimal: %s\n", g.error);
    softsh_view_destroy(view);
    softsh_occluders_destroy(occluders);
    softsh_context_destroy(context);
    gpu_image_destroy(&g, &output);
    gpu_image_destroy(&g, &map_image);
    gpu_image_destroy(&g, &camera_image);
    gpu_destroy(&g);
    return status || g.validation_messages ? 1 : 0;
}
