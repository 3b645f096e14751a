/* The scene of the interface tests. */
#include "scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { QUERIES = 2 * (SOFTSH_MAX_PASSES + 1) };

static const double near_plane = 0.5, far_plane = 20.0;
static const double blocker = 0.8; /* half side of the square at height 1 */

unsigned scene_message_count;
softsh_result scene_message_result;
char scene_message[512];

static void on_message(void *user, softsh_result result, const char *message)
{
    (void)user;
    scene_message_count++;
    scene_message_result = result;
    snprintf(scene_message, sizeof scene_message, "%s", message);
}

void scene_expect_words(const char *words)
{
    if (!strstr(scene_message, words))
        fail_msg("the message is \"%s\", expected it to contain \"%s\"", scene_message, words);
}

/* Where a camera or a light looks from: right, down and forward. */
typedef struct eye {
    double at[3], axes[3][3];
    double tangent[2]; /* half sizes if orthographic */
    bool orthographic;
} eye;

static eye camera_eye(void)
{
    const double length = sqrt(3.0 * 3.0 + 5.0 * 5.0);
    return (eye){.at = {0.0, 3.0, -5.0},
                 .axes = {{-1.0, 0.0, 0.0}, {0.0, -5.0 / length, -3.0 / length}, {0.0, -3.0 / length, 5.0 / length}},
                 .tangent = {0.6, 0.6 * SCENE_HEIGHT / SCENE_WIDTH}};
}

static eye lamp_eye(scene_lamp lamp)
{
    eye e = {.at = {lamp == LAMP_SECOND ? 1.0 : 0.0, 4.0, 0.0},
             .axes = {{1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, {0.0, -1.0, 0.0}},
             .tangent = {1.0, 1.0},
             .orthographic = lamp == LAMP_DIRECTIONAL};
    if (e.orthographic)
        e.tangent[0] = e.tangent[1] = 4.0;
    return e;
}

static void eye_matrices(const eye *e, double view[16], double projection[16])
{
    memset(view, 0, 16 * sizeof *view);
    memset(projection, 0, 16 * sizeof *projection);
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            view[4 * c + r] = e->axes[r][c];
            view[12 + r] -= e->axes[r][c] * e->at[c];
        }
    }
    view[15] = 1.0;
    const double range = far_plane - near_plane;
    projection[0] = 1.0 / e->tangent[0];
    projection[5] = 1.0 / e->tangent[1];
    projection[10] = (e->orthographic ? 1.0 : far_plane) / range;
    projection[14] = -near_plane * (e->orthographic ? 1.0 : far_plane) / range;
    projection[e->orthographic ? 15 : 11] = 1.0;
}

/* Device depth through a pixel's centre. Layer 0 sees the square and the ground, layer 1 the ground alone. */
static float cast(const eye *e, double s, double t, int first_plane)
{
    double start[3], way[3];
    for (int i = 0; i < 3; i++) {
        const double aside = s * e->tangent[0] * e->axes[0][i] + t * e->tangent[1] * e->axes[1][i];
        start[i] = e->at[i] + (e->orthographic ? aside : 0.0);
        way[i] = e->axes[2][i] + (e->orthographic ? 0.0 : aside);
    }
    for (int plane = first_plane; plane >= 0; plane--) {
        const double z = (plane - start[1]) / way[1];
        if (!(z > near_plane && z < far_plane))
            continue;
        if (plane == 1 && (fabs(start[0] + z * way[0]) > blocker || fabs(start[2] + z * way[2]) > blocker))
            continue;
        const double range = far_plane - near_plane;
        return (float)(e->orthographic ? (z - near_plane) / range : far_plane / range * (1.0 - near_plane / z));
    }
    return 1.0f;
}

static void make_depth(scene *s, gpu_image *image, const eye *e, uint32_t width, uint32_t height, int first_plane)
{
    const gpu_image_info info = {.format = VK_FORMAT_D32_SFLOAT,
                                 .width = width,
                                 .height = height,
                                 .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT};
    float *texels = malloc((size_t)width * height * sizeof *texels);
    assert_non_null(texels);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            texels[y * width + x] = cast(e, 2.0 * (x + 0.5) / width - 1.0, 2.0 * (y + 0.5) / height - 1.0, first_plane);
    if (!gpu_image_create(&s->g, &info, image) ||
        !gpu_image_upload(&s->g, image, texels, (size_t)width * height * sizeof *texels,
                          VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL))
        fail_msg("%s", s->g.error);
    free(texels);
}

static void make_normals(scene *s)
{
    const gpu_image_info info = {.format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                 .width = SCENE_WIDTH,
                                 .height = SCENE_HEIGHT,
                                 .usage = VK_IMAGE_USAGE_SAMPLED_BIT};
    static float texels[SCENE_PIXELS][4];
    for (size_t i = 0; i < SCENE_PIXELS; i++)
        texels[i][1] = 1.0f;
    if (!gpu_image_create(&s->g, &info, &s->normals) ||
        !gpu_image_upload(&s->g, &s->normals, texels, sizeof texels, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL))
        fail_msg("%s", s->g.error);
}

void scene_create(scene *s)
{
    const eye camera = camera_eye();
    make_depth(s, &s->camera_depth, &camera, SCENE_WIDTH, SCENE_HEIGHT, 1);
    make_normals(s);
    for (int lamp = 0; lamp < LAMP_COUNT; lamp++) {
        const eye e = lamp_eye(lamp);
        for (int layer = 0; layer < SCENE_LAYERS; layer++)
            make_depth(s, &s->maps[lamp][layer], &e, SCENE_MAP, SCENE_MAP, 1 - layer);
    }
    const gpu_image_info output = {.format = VK_FORMAT_R32_SFLOAT,
                                   .width = SCENE_WIDTH,
                                   .height = SCENE_HEIGHT,
                                   .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT};
    static const float nothing[SCENE_PIXELS];
    if (!gpu_image_create(&s->g, &output, &s->output) ||
        !gpu_image_upload(&s->g, &s->output, nothing, sizeof nothing, VK_IMAGE_LAYOUT_GENERAL) ||
        !gpu_buffer_create(&s->g, 4096, VK_BUFFER_USAGE_TRANSFER_DST_BIT, true, &s->stats))
        fail_msg("%s", s->g.error);
    const VkQueryPoolCreateInfo queries = {
        .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, .queryType = VK_QUERY_TYPE_TIMESTAMP, .queryCount = QUERIES};
    assert_int_equal(vkCreateQueryPool(s->g.device, &queries, NULL, &s->queries), VK_SUCCESS);
    VkCommandBuffer cmd = gpu_begin(&s->g);
    assert_non_null(cmd);
    vkCmdResetQueryPool(cmd, s->queries, 0, QUERIES);
    assert_true(gpu_submit(&s->g, cmd));
}

void scene_destroy(scene *s)
{
    if (s->queries)
        vkDestroyQueryPool(s->g.device, s->queries, NULL);
    gpu_buffer_destroy(&s->g, &s->stats);
    gpu_image_destroy(&s->g, &s->output);
    gpu_image_destroy(&s->g, &s->normals);
    gpu_image_destroy(&s->g, &s->camera_depth);
    for (int lamp = 0; lamp < LAMP_COUNT; lamp++)
        for (int layer = 0; layer < SCENE_LAYERS; layer++)
            gpu_image_destroy(&s->g, &s->maps[lamp][layer]);
}

int scene_setup(void **state)
{
    scene *s = calloc(1, sizeof *s);
    if (!s)
        return -1;
    *state = s;
    if (!gpu_create(&(gpu_info){.validation = true}, &s->g)) {
        fprintf(stderr, "no device: %s\n", s->g.error);
        return -1;
    }
    scene_create(s);
    return 0;
}

int scene_teardown(void **state)
{
    scene *s = *state;
    const spy_counts counts = spy_read();
    scene_destroy(s);
    gpu_destroy(&s->g);
    int problems = 0;
    if (s->g.validation_messages > 0)
        problems = fprintf(stderr, "%u messages of the validation layer\n", s->g.validation_messages);
    if (counts.alive > 0 || counts.strangers > 0 || counts.forbidden > 0)
        problems = fprintf(stderr, "%u objects left, %u strangers destroyed, %u functions that are not the library's\n",
                           counts.alive, counts.strangers, counts.forbidden);
    if (spy_host_alive() > 0)
        problems = fprintf(stderr, "%u host allocations left\n", spy_host_alive());
    free(s);
    return problems ? -1 : 0;
}

void scene_fill(scene *s, scene_lamp lamp, uint32_t layers, scene_inputs *in)
{
    memset(in, 0, sizeof *in);
    in->callbacks = *spy_allocator();
    in->context = (softsh_context_info){.struct_size = sizeof in->context,
                                        .instance = s->g.instance,
                                        .physical_device = s->g.physical_device,
                                        .device = s->g.device,
                                        .get_instance_proc_addr = spy_get_instance_proc_addr,
                                        .get_device_proc_addr = spy_get_device_proc_addr,
                                        .message = on_message};
    in->occluders = (softsh_occluders_info){
        .struct_size = sizeof in->occluders, .max_extent = {SCENE_MAP, SCENE_MAP}, .max_layers = SCENE_LAYERS};
    in->settings = (softsh_settings){.struct_size = sizeof in->settings, .technique = SOFTSH_TECHNIQUE_BITMASK};
    in->view = (softsh_view_info){.struct_size = sizeof in->view,
                                  .max_extent = {SCENE_WIDTH, SCENE_HEIGHT},
                                  .output_format = VK_FORMAT_R32_SFLOAT,
                                  .settings = &in->settings,
                                  .stats = 1};
    const eye e = lamp_eye(lamp), camera = camera_eye();
    in->light = (softsh_light){.struct_size = sizeof in->light};
    if (lamp == LAMP_DIRECTIONAL) {
        in->light.shape = SOFTSH_LIGHT_DIRECTIONAL;
        in->light.direction[1] = -1.0;
        in->light.angular_radius = 0.2;
    } else {
        memcpy(in->light.center, e.at, sizeof e.at);
        in->light.half_u[0] = in->light.half_v[2] = lamp == LAMP_POINT ? 0.0 : 0.4;
    }
    for (uint32_t i = 0; i < SOFTSH_MAX_LAYERS; i++) {
        softsh_map *map = &in->maps[i];
        *map = (softsh_map){.struct_size = sizeof *map,
                            .index = i,
                            .view = s->maps[lamp][i % SCENE_LAYERS].view,
                            .format = VK_FORMAT_D32_SFLOAT,
                            .layout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL,
                            .image_extent = {SCENE_MAP, SCENE_MAP}};
        eye_matrices(&e, map->view_matrix, map->projection);
    }
    in->build = (softsh_build_info){
        .struct_size = sizeof in->build, .light = &in->light, .map_count = layers, .maps = in->maps};
    in->camera = (softsh_camera){.struct_size = sizeof in->camera,
                                 .depth = s->camera_depth.view,
                                 .depth_format = VK_FORMAT_D32_SFLOAT,
                                 .depth_layout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL};
    eye_matrices(&camera, in->camera.view_matrix, in->camera.projection);
    in->visibility = (softsh_visibility_info){
        .struct_size = sizeof in->visibility, .camera_count = 1, .cameras = &in->camera, .visibility = s->output.view};
    in->timestamps = (softsh_timestamps){
        .struct_size = sizeof in->timestamps, .pool = s->queries, .query_count = SOFTSH_MAX_PASSES + 1};
}

softsh_context *scene_context(scene *s, bool debug_names, const VkAllocationCallbacks *allocator)
{
    scene_inputs *in = malloc(sizeof *in);
    softsh_context *context;
    assert_non_null(in);
    scene_fill(s, LAMP_RECTANGLE, 1, in);
    in->context.debug_names = debug_names;
    in->context.allocation_callbacks = allocator;
    scene_message_count = 0;
    if (softsh_context_create(&in->context, &context) != SOFTSH_SUCCESS)
        fail_msg("softsh_context_create: %s", scene_message);
    free(in);
    return context;
}

softsh_occluders *scene_occluders(softsh_context *context, const scene_inputs *in)
{
    softsh_occluders *occluders;
    if (softsh_occluders_create(context, &in->occluders, &occluders) != SOFTSH_SUCCESS)
        fail_msg("softsh_occluders_create: %s", scene_message);
    return occluders;
}

softsh_view *scene_view(softsh_context *context, const scene_inputs *in)
{
    softsh_view *view;
    if (softsh_view_create(context, &in->view, &view) != SOFTSH_SUCCESS)
        fail_msg("softsh_view_create: %s", scene_message);
    return view;
}

void scene_barrier(VkCommandBuffer cmd)
{
    const VkMemoryBarrier all = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                 .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
                                 .dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT};
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &all, 0,
                         NULL, 0, NULL);
}

void scene_render(scene *s, softsh_occluders *occluders, softsh_view *view, scene_inputs *in)
{
    VkCommandBuffer cmd = gpu_begin(&s->g);
    assert_non_null(cmd);
    in->visibility.occluders = occluders;
    if (softsh_cmd_build_occluders(cmd, occluders, &in->build) != SOFTSH_SUCCESS)
        fail_msg("softsh_cmd_build_occluders: %s", scene_message);
    if (softsh_cmd_compute_visibility(cmd, view, &in->visibility) != SOFTSH_SUCCESS)
        fail_msg("softsh_cmd_compute_visibility: %s", scene_message);
    if (!gpu_submit(&s->g, cmd) || !gpu_image_read(&s->g, &s->output, s->picture, sizeof s->picture))
        fail_msg("%s", s->g.error);
}

void scene_expect_shadow(const float *picture)
{
    unsigned lit = 0, dark = 0, between = 0;
    for (size_t i = 0; i < SCENE_PIXELS; i++) {
        assert_true(picture[i] >= 0.0f && picture[i] <= 1.0f);
        lit += picture[i] == 1.0f;
        dark += picture[i] == 0.0f;
        between += picture[i] > 0.0f && picture[i] < 1.0f;
    }
    assert_true(lit > SCENE_PIXELS / 4);
    assert_true(dark > 20);
    assert_true(between > 20);
}

void scene_expect_silence(const scene *s)
{
    if (scene_message_count > 0)
        fail_msg("the library says \"%s\"", scene_message);
    if (s->g.validation_messages > 0)
        fail_msg("the validation layer says \"%s\"", s->g.last_validation_message);
}
