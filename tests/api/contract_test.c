/* What the headers promise beyond the pictures: recording allocates nothing, memory stays inside its bounds, objects
 * and command buffers may be used again and again and from several threads, timestamps and debug names work, lights may
 * share a view, and what does not fit says so. Under validation with synchronization validation, which stays silent. */
#include "scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <threads.h>

enum { WORKER_ROUNDS = 8 };

static float reference[LAMP_COUNT][SCENE_PIXELS];

static void submit(scene *s, VkCommandBuffer cmd)
{
    if (!gpu_submit(&s->g, cmd))
        fail_msg("%s", s->g.error);
}

/* The pictures that everything else is compared with. */
static void plain_pictures(void **state)
{
    scene *s = *state;
    softsh_context *context = scene_context(s, false, NULL);
    for (int lamp = 0; lamp < LAMP_COUNT; lamp++) {
        scene_inputs in;
        scene_fill(s, lamp, 1, &in);
        softsh_occluders *occluders = scene_occluders(context, &in);
        softsh_view *view = scene_view(context, &in);
        scene_render(s, occluders, view, &in);
        memcpy(reference[lamp], s->picture, sizeof s->picture);
        if (lamp != LAMP_POINT)
            scene_expect_shadow(s->picture);
        softsh_view_destroy(view);
        softsh_occluders_destroy(occluders);
    }
    assert_memory_not_equal(reference[LAMP_RECTANGLE], reference[LAMP_SECOND], sizeof reference[0]);
    assert_memory_not_equal(reference[LAMP_RECTANGLE], reference[LAMP_DIRECTIONAL], sizeof reference[0]);
    softsh_context_destroy(context);
    scene_expect_silence(s);
}

static void recording_allocates_nothing(void **state)
{
    scene *s = *state;
    scene_inputs in;
    softsh_context *context = scene_context(s, true, spy_allocator());
    assert_true(spy_host_alive() > 0);
    for (int lamp = 0; lamp < LAMP_COUNT; lamp++) {
        scene_fill(s, lamp, 2, &in);
        in.settings.filter_passes = 2;
        softsh_occluders *occluders = scene_occluders(context, &in);
        softsh_view *view = scene_view(context, &in);
        VkCommandBuffer cmd = gpu_begin(&s->g);
        const spy_counts before = spy_read();
        const unsigned host_before = spy_host_alive();
        spy_fail_host(1); /* any allocation would fail, and be noticed */
        spy_fail(1, VK_ERROR_OUT_OF_HOST_MEMORY);
        in.visibility.occluders = occluders;
        in.visibility.stats_buffer = s->stats.buffer;
        assert_int_equal(softsh_cmd_build_occluders(cmd, occluders, &in.build), SOFTSH_SUCCESS);
        assert_int_equal(softsh_cmd_compute_visibility(cmd, view, &in.visibility), SOFTSH_SUCCESS);
        assert_null(spy_failed_call());
        assert_false(spy_host_failed());
        spy_fail_host(0);
        spy_fail(0, VK_SUCCESS);
        const spy_counts after = spy_read();
        assert_int_equal(after.creations, before.creations);
        assert_int_equal(after.alive, before.alive);
        assert_int_equal(spy_host_alive(), host_before);
        assert_true(after.commands > before.commands + 10);
        submit(s, cmd);
        softsh_view_destroy(view);
        softsh_occluders_destroy(occluders);
    }
    softsh_context_destroy(context);
    assert_int_equal(spy_host_alive(), 0);
    scene_expect_silence(s);
}

/* An allocation that is filled with a pattern, and a part of it that is the library's. */
typedef struct guarded {
    VkDeviceMemory memory;
    VkDeviceSize offset, part, size;
    unsigned char *mapped;
} guarded;

static guarded guard(scene *s, const VkMemoryRequirements *need)
{
    VkPhysicalDeviceMemoryProperties properties;
    const VkMemoryPropertyFlags wanted = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    vkGetPhysicalDeviceMemoryProperties(s->g.physical_device, &properties);
    VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    uint32_t type = 0;
    while (type < properties.memoryTypeCount &&
           (!(need->memoryTypeBits & 1u << type) || (properties.memoryTypes[type].propertyFlags & wanted) != wanted))
        type++;
    guarded g = {.offset = 3 * need->alignment, .part = need->size};
    while (g.offset < 4096)
        g.offset += need->alignment;
    g.size = info.allocationSize = g.offset + g.part + 4096;
    /* Devices whose images cannot lie in host-visible memory get the test without the pattern. */
    const bool visible = type < properties.memoryTypeCount;
    for (type = visible ? type : 0; !(need->memoryTypeBits & 1u << type);)
        type++;
    info.memoryTypeIndex = type;
    assert_int_equal(vkAllocateMemory(s->g.device, &info, NULL, &g.memory), VK_SUCCESS);
    if (visible) {
        assert_int_equal(vkMapMemory(s->g.device, g.memory, 0, VK_WHOLE_SIZE, 0, (void **)&g.mapped), VK_SUCCESS);
        memset(g.mapped, 0xc5, g.size);
    }
    return g;
}

static void check_guard(const guarded *g)
{
    unsigned changed = 0;
    for (VkDeviceSize i = 0; g->mapped && i < g->size; i++) {
        const bool inside = i >= g->offset && i < g->offset + g->part;
        if (!inside && g->mapped[i] != 0xc5)
            fail_msg("byte %llu of %llu is changed, the part is %llu to %llu", (unsigned long long)i,
                     (unsigned long long)g->size, (unsigned long long)g->offset,
                     (unsigned long long)(g->offset + g->part));
        changed += inside && g->mapped[i] != 0xc5;
    }
    assert_true(!g->mapped || changed > 0);
}

static void caller_memory(void **state)
{
    scene *s = *state;
    softsh_context *context = scene_context(s, false, NULL);
    for (softsh_accel accel = SOFTSH_ACCEL_HSM; accel <= SOFTSH_ACCEL_YSM; accel++) {
        scene_inputs in;
        VkMemoryRequirements need, library_need, view_need;
        scene_fill(s, LAMP_RECTANGLE, 2, &in);
        in.occluders.accel = accel;
        in.occluders.ysm_join = 16;
        in.settings.filter_passes = 1;
        softsh_occluders *own = scene_occluders(context, &in);
        softsh_view *own_view = scene_view(context, &in);
        scene_render(s, own, own_view, &in);
        static float expected[SCENE_PIXELS];
        memcpy(expected, s->picture, sizeof expected);

        in.occluders.memory_mode = in.view.memory_mode = SOFTSH_MEMORY_CALLER;
        const spy_counts before = spy_read();
        softsh_occluders *occluders = scene_occluders(context, &in);
        softsh_view *view = scene_view(context, &in);
        assert_int_equal(softsh_occluders_memory_requirements(own, &library_need), SOFTSH_SUCCESS);
        assert_int_equal(softsh_occluders_memory_requirements(occluders, &need), SOFTSH_SUCCESS);
        assert_int_equal(softsh_view_memory_requirements(view, &view_need), SOFTSH_SUCCESS);
        assert_memory_equal(&need, &library_need, sizeof need);
        guarded a = guard(s, &need), b = guard(s, &view_need);
        assert_int_equal(softsh_occluders_bind_memory(occluders, a.memory, a.offset, a.part), SOFTSH_SUCCESS);
        assert_int_equal(softsh_view_bind_memory(view, b.memory, b.offset, b.part), SOFTSH_SUCCESS);
        scene_render(s, occluders, view, &in);
        assert_memory_equal(s->picture, expected, sizeof expected);
        check_guard(&a);
        check_guard(&b);
        softsh_view_destroy(view);
        softsh_occluders_destroy(occluders);
        assert_int_equal(spy_read().alive, before.alive);
        vkFreeMemory(s->g.device, a.memory, NULL); /* still the caller's */
        vkFreeMemory(s->g.device, b.memory, NULL);
        softsh_view_destroy(own_view);
        softsh_occluders_destroy(own);
    }
    softsh_context_destroy(context);
    scene_expect_silence(s);
}

/* Far more recordings than max_recordings, with other lights in between. */
static void many_recordings(void **state)
{
    scene *s = *state;
    scene_inputs in;
    softsh_context *context = scene_context(s, false, NULL);
    scene_fill(s, LAMP_RECTANGLE, 1, &in);
    in.occluders.max_recordings = 2;
    in.view.max_recordings = 3;
    softsh_occluders *occluders = scene_occluders(context, &in);
    softsh_view *view = scene_view(context, &in);
    for (int i = 0; i < 24; i++) {
        const scene_lamp lamp = i % LAMP_COUNT;
        scene_fill(s, lamp, 1, &in);
        scene_render(s, occluders, view, &in);
        assert_memory_equal(s->picture, reference[lamp], sizeof reference[lamp]);
    }
    softsh_view_destroy(view);
    softsh_occluders_destroy(occluders);
    softsh_context_destroy(context);
    scene_expect_silence(s);
}

/* One build and one visibility call in command buffers that are submitted twice each. */
static void submitted_twice(void **state)
{
    scene *s = *state;
    scene_inputs in;
    static const float nothing[SCENE_PIXELS];
    softsh_context *context = scene_context(s, false, NULL);
    scene_fill(s, LAMP_RECTANGLE, 1, &in);
    softsh_occluders *occluders = scene_occluders(context, &in);
    softsh_view *view = scene_view(context, &in);
    const VkCommandBufferAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                              .commandPool = s->g.command_pool,
                                              .commandBufferCount = 2};
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    VkCommandBuffer cmd[2];
    assert_int_equal(vkAllocateCommandBuffers(s->g.device, &info, cmd), VK_SUCCESS);
    assert_int_equal(vkBeginCommandBuffer(cmd[0], &begin), VK_SUCCESS);
    assert_int_equal(vkBeginCommandBuffer(cmd[1], &begin), VK_SUCCESS);
    in.visibility.occluders = occluders;
    assert_int_equal(softsh_cmd_build_occluders(cmd[0], occluders, &in.build), SOFTSH_SUCCESS);
    assert_int_equal(softsh_cmd_compute_visibility(cmd[1], view, &in.visibility), SOFTSH_SUCCESS);
    assert_int_equal(vkEndCommandBuffer(cmd[0]), VK_SUCCESS);
    assert_int_equal(vkEndCommandBuffer(cmd[1]), VK_SUCCESS);
    for (int i = 0; i < 3; i++) {
        /* Both, then each alone. */
        const VkSubmitInfo submission = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                         .commandBufferCount = i == 0 ? 2 : 1,
                                         .pCommandBuffers = i == 2 ? &cmd[1] : cmd};
        assert_true(gpu_image_upload(&s->g, &s->output, nothing, sizeof nothing, VK_IMAGE_LAYOUT_GENERAL));
        assert_int_equal(vkQueueSubmit(s->g.queue, 1, &submission, VK_NULL_HANDLE), VK_SUCCESS);
        assert_int_equal(vkQueueWaitIdle(s->g.queue), VK_SUCCESS);
        assert_true(gpu_image_read(&s->g, &s->output, s->picture, sizeof s->picture));
        assert_memory_equal(s->picture, i == 1 ? nothing : reference[LAMP_RECTANGLE], sizeof nothing);
    }
    vkFreeCommandBuffers(s->g.device, s->g.command_pool, 2, cmd);
    softsh_view_destroy(view);
    softsh_occluders_destroy(occluders);
    softsh_context_destroy(context);
    scene_expect_silence(s);
}

/* A thread with objects of its own; the context, the map and the camera are shared. */
typedef struct worker {
    scene *s;
    softsh_context *context;
    scene_lamp lamp;
    VkCommandPool pool;
    VkCommandBuffer cmd;
    gpu_image output;
    softsh_occluders *occluders;
    softsh_view *view;
    bool failed;
} worker;

static int work(void *data)
{
    worker *w = data;
    scene_inputs in;
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    scene_fill(w->s, w->lamp, 1, &in);
    for (int i = 0; i < WORKER_ROUNDS; i++) {
        bool ok = softsh_occluders_create(w->context, &in.occluders, &w->occluders) == SOFTSH_SUCCESS;
        ok = ok && softsh_view_create(w->context, &in.view, &w->view) == SOFTSH_SUCCESS;
        ok = ok && vkBeginCommandBuffer(w->cmd, &begin) == VK_SUCCESS;
        in.visibility.occluders = w->occluders;
        in.visibility.visibility = w->output.view;
        for (int k = 0; k < 4; k++) {
            ok = ok && softsh_cmd_build_occluders(w->cmd, w->occluders, &in.build) == SOFTSH_SUCCESS;
            ok = ok && softsh_cmd_compute_visibility(w->cmd, w->view, &in.visibility) == SOFTSH_SUCCESS;
            if (ok)
                scene_barrier(w->cmd); /* the caller's, between writes of one visibility image */
        }
        ok = ok && vkEndCommandBuffer(w->cmd) == VK_SUCCESS;
        if (!ok) {
            w->failed = true;
            return 1;
        }
        if (i == WORKER_ROUNDS - 1)
            return 0;
        vkResetCommandPool(w->s->g.device, w->pool, 0);
        softsh_view_destroy(w->view);
        softsh_occluders_destroy(w->occluders);
    }
    return 0;
}

static void create_output(scene *s, gpu_image *image)
{
    static const float nothing[SCENE_PIXELS];
    const gpu_image_info info = {.format = VK_FORMAT_R32_SFLOAT,
                                 .width = SCENE_WIDTH,
                                 .height = SCENE_HEIGHT,
                                 .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT};
    if (!gpu_image_create(&s->g, &info, image) ||
        !gpu_image_upload(&s->g, image, nothing, sizeof nothing, VK_IMAGE_LAYOUT_GENERAL))
        fail_msg("%s", s->g.error);
}

static void two_threads(void **state)
{
    scene *s = *state;
    worker workers[2];
    thrd_t threads[2];
    softsh_context *context = scene_context(s, false, NULL);
    for (int i = 0; i < 2; i++) {
        worker *w = &workers[i];
        *w = (worker){.s = s, .context = context, .lamp = i ? LAMP_SECOND : LAMP_RECTANGLE};
        create_output(s, &w->output);
        const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                              .queueFamilyIndex = s->g.queue_family};
        assert_int_equal(vkCreateCommandPool(s->g.device, &pool, NULL, &w->pool), VK_SUCCESS);
        const VkCommandBufferAllocateInfo info = {
            .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, .commandPool = w->pool, .commandBufferCount = 1};
        assert_int_equal(vkAllocateCommandBuffers(s->g.device, &info, &w->cmd), VK_SUCCESS);
    }
    for (int i = 0; i < 2; i++)
        assert_int_equal(thrd_create(&threads[i], work, &workers[i]), thrd_success);
    for (int i = 0; i < 2; i++)
        assert_int_equal(thrd_join(threads[i], NULL), thrd_success);
    for (int i = 0; i < 2; i++) {
        worker *w = &workers[i];
        assert_false(w->failed);
        const VkSubmitInfo submission = {
            .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &w->cmd};
        assert_int_equal(vkQueueSubmit(s->g.queue, 1, &submission, VK_NULL_HANDLE), VK_SUCCESS);
    }
    assert_int_equal(vkQueueWaitIdle(s->g.queue), VK_SUCCESS);
    for (int i = 0; i < 2; i++) {
        worker *w = &workers[i];
        assert_true(gpu_image_read(&s->g, &w->output, s->picture, sizeof s->picture));
        assert_memory_equal(s->picture, reference[w->lamp], sizeof s->picture);
        vkDestroyCommandPool(s->g.device, w->pool, NULL);
        gpu_image_destroy(&s->g, &w->output);
        softsh_view_destroy(w->view);
        softsh_occluders_destroy(w->occluders);
    }
    softsh_context_destroy(context);
    scene_expect_silence(s);
}

/* Lights of one view in one command buffer: its scratch is used by one after the other. */
static void shared_view(void **state)
{
    scene *s = *state;
    softsh_context *context = scene_context(s, false, NULL);
    softsh_occluders *occluders[LAMP_COUNT];
    gpu_image outputs[LAMP_COUNT];
    scene_inputs in;
    scene_fill(s, LAMP_RECTANGLE, 1, &in);
    softsh_view *view = scene_view(context, &in);
    VkCommandBuffer cmd = gpu_begin(&s->g);
    for (int lamp = 0; lamp < LAMP_COUNT; lamp++) {
        scene_fill(s, lamp, 1, &in);
        occluders[lamp] = scene_occluders(context, &in);
        create_output(s, &outputs[lamp]);
        assert_int_equal(softsh_cmd_build_occluders(cmd, occluders[lamp], &in.build), SOFTSH_SUCCESS);
    }
    for (int lamp = 0; lamp < LAMP_COUNT; lamp++) {
        scene_fill(s, lamp, 1, &in);
        in.visibility.occluders = occluders[lamp];
        in.visibility.visibility = outputs[lamp].view;
        assert_int_equal(softsh_cmd_compute_visibility(cmd, view, &in.visibility), SOFTSH_SUCCESS);
    }
    submit(s, cmd);
    for (int lamp = 0; lamp < LAMP_COUNT; lamp++) {
        assert_true(gpu_image_read(&s->g, &outputs[lamp], s->picture, sizeof s->picture));
        assert_memory_equal(s->picture, reference[lamp], sizeof s->picture);
        gpu_image_destroy(&s->g, &outputs[lamp]);
        softsh_occluders_destroy(occluders[lamp]);
    }
    softsh_view_destroy(view);
    softsh_context_destroy(context);
    scene_expect_silence(s);
}

static void check_timestamps(scene *s, const softsh_timestamps *t)
{
    uint64_t times[SOFTSH_MAX_PASSES + 1];
    assert_true(t->pass_count > 0 && t->pass_count <= SOFTSH_MAX_PASSES);
    assert_int_equal(vkGetQueryPoolResults(s->g.device, t->pool, t->first_query, t->pass_count + 1, sizeof times, times,
                                           sizeof *times, VK_QUERY_RESULT_64_BIT),
                     VK_SUCCESS); /* not VK_NOT_READY: every query of the passes is written */
    for (uint32_t i = 0; i < t->pass_count; i++) {
        assert_non_null(t->pass_names[i]);
        assert_true(t->pass_names[i][0] != '\0');
        assert_true(times[i + 1] >= times[i]);
    }
}

static void timestamps_and_names(void **state)
{
    scene *s = *state;
    scene_inputs in;
    softsh_context *context = scene_context(s, true, NULL);
    scene_fill(s, LAMP_RECTANGLE, 2, &in);
    in.occluders.name = "a light with a name that is longer than what the library keeps of it, by far";
    in.view.name = "";
    in.occluders.accel = SOFTSH_ACCEL_MSSM;
    in.settings.filter_passes = 16;
    softsh_occluders *occluders = scene_occluders(context, &in);
    softsh_view *view = scene_view(context, &in);
    softsh_timestamps second = in.timestamps;
    second.first_query = SOFTSH_MAX_PASSES + 1;
    in.build.timestamps = &in.timestamps;
    in.visibility.timestamps = &second;
    scene_render(s, occluders, view, &in);
    check_timestamps(s, &in.timestamps);
    check_timestamps(s, &second);
    assert_string_equal(in.timestamps.pass_names[0], "hierarchy_convert");
    assert_string_equal(second.pass_names[second.pass_count - 1], "post_filter");
    softsh_view_destroy(view);
    softsh_occluders_destroy(occluders);
    softsh_context_destroy(context);
    scene_expect_silence(s);
}

/* The statistics go where they were asked to, and nowhere else. */
static void statistics(void **state)
{
    scene *s = *state;
    scene_inputs in;
    softsh_context *context = scene_context(s, false, NULL);
    scene_fill(s, LAMP_RECTANGLE, 1, &in);
    softsh_occluders *occluders = scene_occluders(context, &in);
    softsh_view *view = scene_view(context, &in);
    const size_t offset = 36;
    unsigned char *bytes = s->stats.mapped;
    memset(bytes, 0xc5, s->stats.size);
    in.visibility.stats_buffer = s->stats.buffer;
    in.visibility.stats_offset = offset;
    scene_render(s, occluders, view, &in);
    assert_memory_equal(s->picture, reference[LAMP_RECTANGLE], sizeof s->picture);
    softsh_stats stats;
    memcpy(&stats, bytes + offset, sizeof stats);
    assert_int_equal(stats.pixels, SCENE_PIXELS);
    assert_int_equal(stats.lit + stats.umbra + stats.active, stats.pixels);
    assert_true(stats.active > 0 && stats.primitives > 0 && stats.nodes > 0);
    assert_int_equal(stats.tiles, ((SCENE_WIDTH + 7) / 8) * ((SCENE_HEIGHT + 7) / 8));
    assert_true(stats.undecided_tiles > 0 && stats.undecided_tiles <= stats.tiles);
    for (size_t i = 0; i < s->stats.size; i++)
        if (i < offset || i >= offset + sizeof stats)
            assert_int_equal(bytes[i], 0xc5);
    softsh_view_destroy(view);
    softsh_occluders_destroy(occluders);
    softsh_context_destroy(context);
    scene_expect_silence(s);
}

/* The largest map of one layer that the smallest devices can hold is built; what they cannot hold is refused with
 * sizes. */
static void large_maps(void **state)
{
    scene *s = *state;
    scene_inputs in;
    const uint32_t side = 4096;
    softsh_context *context = scene_context(s, false, NULL);
    scene_fill(s, LAMP_RECTANGLE, 1, &in);
    in.occluders.max_extent = (VkExtent2D){side, side};
    in.occluders.max_layers = 1;
    softsh_occluders *occluders = scene_occluders(context, &in);
    softsh_view *view = scene_view(context, &in);
    const gpu_image_info info = {
        .format = VK_FORMAT_D32_SFLOAT, .width = side, .height = side, .usage = VK_IMAGE_USAGE_SAMPLED_BIT};
    gpu_image map;
    float *texels = malloc(sizeof *texels * side * side);
    assert_non_null(texels);
    for (size_t i = 0; i < (size_t)side * side; i++)
        texels[i] = 1.0f;
    assert_true(gpu_image_create(&s->g, &info, &map));
    assert_true(
        gpu_image_upload(&s->g, &map, texels, sizeof *texels * side * side, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL));
    free(texels);
    in.maps[0].view = map.view;
    in.maps[0].layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    in.maps[0].image_extent = (VkExtent2D){side, side};
    scene_render(s, occluders, view, &in);
    for (size_t i = 0; i < SCENE_PIXELS; i++)
        assert_true(s->picture[i] == 1.0f); /* nothing in the map */
    gpu_image_destroy(&s->g, &map);
    softsh_view_destroy(view);
    softsh_occluders_destroy(occluders);

    static const struct {
        uint32_t side, layers;
        softsh_accel accel;
        const char *size;
    } large[] = {{16384, 1, SOFTSH_ACCEL_MSSM, "16384 x 16384"},
                 {16384, 4, SOFTSH_ACCEL_YSM, "16384 x 16384"},
                 {16384, 4, SOFTSH_ACCEL_HSM, "16384 x 16384"},
                 {4096, 4, SOFTSH_ACCEL_MSSM, "4096 x 4096"}};
    for (size_t i = 0; i < sizeof large / sizeof *large; i++) {
        const spy_counts before = spy_read();
        in.occluders.max_extent = (VkExtent2D){large[i].side, large[i].side};
        in.occluders.max_layers = large[i].layers;
        in.occluders.accel = large[i].accel;
        scene_message_count = 0;
        const softsh_result result = softsh_occluders_create(context, &in.occluders, &occluders);
        if (result == SOFTSH_SUCCESS) { /* a device with room for it */
            softsh_occluders_destroy(occluders);
            assert_int_equal(spy_read().alive, before.alive);
            continue;
        }
        assert_null(occluders);
        assert_true(result == SOFTSH_ERROR_LIMIT || result == SOFTSH_ERROR_OUT_OF_DEVICE_MEMORY);
        assert_int_equal(scene_message_count, 1);
        scene_expect_words("MiB");
        if (result == SOFTSH_ERROR_LIMIT)
            scene_expect_words(large[i].size);
        assert_int_equal(spy_read().alive, before.alive);
        scene_message_count = 0;
    }
    softsh_context_destroy(context);
    scene_expect_silence(s);
}

/* An MSSM of 1024 x 1024 fits every device, one of 2048 x 2048 those with more than the least maxStorageBufferRange. */
static void large_multi_scale_maps(void **state)
{
    scene *s = *state;
    scene_inputs in;
    softsh_occluders *occluders;
    VkPhysicalDeviceProperties properties;
    char limit[64];
    softsh_context *context = scene_context(s, false, NULL);
    vkGetPhysicalDeviceProperties(s->g.physical_device, &properties);
    const unsigned most = properties.limits.maxStorageBufferRange >> 20;
    snprintf(limit, sizeof limit, "maxStorageBufferRange is %u MiB", most);
    scene_fill(s, LAMP_RECTANGLE, 1, &in);
    in.occluders.max_layers = 1;
    in.occluders.accel = SOFTSH_ACCEL_MSSM;
    in.occluders.max_extent = (VkExtent2D){1024, 1024};
    assert_int_equal(softsh_occluders_create(context, &in.occluders, &occluders), SOFTSH_SUCCESS);
    softsh_occluders_destroy(occluders);
    in.occluders.max_extent = (VkExtent2D){2048, 2048};
    scene_message_count = 0;
    const softsh_result result = softsh_occluders_create(context, &in.occluders, &occluders);
    if (result == SOFTSH_SUCCESS) {
        assert_true(most >= 362);
        softsh_occluders_destroy(occluders);
    } else if (most < 362) {
        assert_int_equal(result, SOFTSH_ERROR_LIMIT);
        assert_int_equal(scene_message_count, 1);
        scene_expect_words("2048 x 2048 take 362 MiB");
        scene_expect_words(limit);
    }
    in.occluders.max_extent = (VkExtent2D){1024, 1024};
    in.occluders.dual_grids = 1;
    scene_message_count = 0;
    if (softsh_occluders_create(context, &in.occluders, &occluders) == SOFTSH_SUCCESS) {
        assert_true(most >= 196);
        softsh_occluders_destroy(occluders);
    } else if (most < 196) {
        assert_int_equal(scene_message_count, 1);
        scene_expect_words("1024 x 1024 take 196 MiB of levels and dual grids");
        scene_expect_words(limit);
    }
    scene_message_count = 0;
    softsh_context_destroy(context);
    scene_expect_silence(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plain_pictures),
        cmocka_unit_test(recording_allocates_nothing),
        cmocka_unit_test(caller_memory),
        cmocka_unit_test(many_recordings),
        cmocka_unit_test(submitted_twice),
        cmocka_unit_test(two_threads),
        cmocka_unit_test(shared_view),
        cmocka_unit_test(timestamps_and_names),
        cmocka_unit_test(statistics),
        cmocka_unit_test(large_maps),
        cmocka_unit_test(large_multi_scale_maps),
    };
    return cmocka_run_group_tests_name("contract", tests, scene_setup, scene_teardown);
}
