/* Every call that can fail fails once, and so does every host allocation of the library: each time there is one clear
 * error, nothing is left, nothing is destroyed that was not made, and the same call succeeds afterwards. */
#include "scene.h"

#include <stdio.h>
#include <string.h>

/* A creation to be made to fail: returns the object, NULL after a failure. */
typedef struct subject {
    const char *name;
    softsh_accel accel;
    softsh_memory_mode memory_mode;
    uint32_t filter_passes;
    softsh_result (*create)(const struct subject *what, softsh_context *context, scene_inputs *in, void **out);
    void (*destroy)(void *object);
} subject;

static softsh_result create_context(const subject *what, softsh_context *context, scene_inputs *in, void **out)
{
    (void)what;
    (void)context;
    softsh_context *made = (softsh_context *)in;
    in->context.allocation_callbacks = spy_allocator();
    const softsh_result result = softsh_context_create(&in->context, &made);
    *out = made;
    return result;
}

static void destroy_context(void *object)
{
    softsh_context_destroy(object);
}

static softsh_result create_occluders(const subject *what, softsh_context *context, scene_inputs *in, void **out)
{
    softsh_occluders *made = (softsh_occluders *)in;
    in->occluders.accel = what->accel;
    in->occluders.memory_mode = what->memory_mode;
    const softsh_result result = softsh_occluders_create(context, &in->occluders, &made);
    *out = made;
    return result;
}

static void destroy_occluders(void *object)
{
    softsh_occluders_destroy(object);
}

static softsh_result create_view(const subject *what, softsh_context *context, scene_inputs *in, void **out)
{
    softsh_view *made = (softsh_view *)in;
    in->settings.filter_passes = what->filter_passes;
    in->view.memory_mode = what->memory_mode;
    const softsh_result result = softsh_view_create(context, &in->view, &made);
    *out = made;
    return result;
}

static void destroy_view(void *object)
{
    softsh_view_destroy(object);
}

static const subject subjects[] = {
    {"context", 0, 0, 0, create_context, destroy_context},
    {"occluders, HSM", SOFTSH_ACCEL_HSM, SOFTSH_MEMORY_LIBRARY, 0, create_occluders, destroy_occluders},
    {"occluders, MSSM", SOFTSH_ACCEL_MSSM, SOFTSH_MEMORY_LIBRARY, 0, create_occluders, destroy_occluders},
    {"occluders, YSM", SOFTSH_ACCEL_YSM, SOFTSH_MEMORY_CALLER, 0, create_occluders, destroy_occluders},
    {"view", 0, SOFTSH_MEMORY_LIBRARY, 0, create_view, destroy_view},
    {"view with filter", 0, SOFTSH_MEMORY_CALLER, 2, create_view, destroy_view},
};
enum { SUBJECTS = sizeof subjects / sizeof *subjects, MOST_CALLS = 1000 };

static void check(const subject *what, unsigned k, softsh_result result, softsh_result expected, const void *object,
                  const spy_counts *before, unsigned host_before)
{
    const spy_counts after = spy_read();
    if (result != expected || object)
        fail_msg("%s, failure %u: %s (\"%s\"), expected %s and no object", what->name, k, softsh_result_string(result),
                 scene_message, softsh_result_string(expected));
    if (scene_message_count != 1 || scene_message_result != expected || !scene_message[0])
        fail_msg("%s, failure %u: %u messages, expected one", what->name, k, scene_message_count);
    if (after.alive != before->alive || after.strangers != before->strangers)
        fail_msg("%s, failure %u: %u objects left, %u destroyed that were none", what->name, k,
                 after.alive - before->alive, after.strangers - before->strangers);
    if (spy_host_alive() != host_before)
        fail_msg("%s, failure %u: %u host allocations left", what->name, k, spy_host_alive() - host_before);
}

/* What the message must say about a Vulkan call that failed: its name, or what it was for. */
static void expect_name(const char *call)
{
    if (!strcmp(call, "vkCreateDescriptorSetLayout") || !strcmp(call, "vkCreatePipelineLayout"))
        scene_expect_words("creating the pipeline layout");
    else
        scene_expect_words(call);
    scene_expect_words("VkResult -");
}

static void vulkan_failures(void **state)
{
    scene *s = *state;
    static const struct {
        VkResult vulkan;
        softsh_result expected;
    } kinds[] = {{VK_ERROR_OUT_OF_HOST_MEMORY, SOFTSH_ERROR_OUT_OF_HOST_MEMORY},
                 {VK_ERROR_OUT_OF_DEVICE_MEMORY, SOFTSH_ERROR_OUT_OF_DEVICE_MEMORY},
                 {VK_ERROR_DEVICE_LOST, SOFTSH_ERROR_VULKAN}};
    softsh_context *context = scene_context(s, false, spy_allocator());
    for (size_t i = 0; i < SUBJECTS; i++) {
        unsigned k = 1;
        for (bool failed = true; failed; k++) {
            const size_t kind = k % (sizeof kinds / sizeof *kinds);
            scene_inputs in;
            void *object;
            assert_true(k < MOST_CALLS);
            scene_fill(s, LAMP_RECTANGLE, 1, &in);
            in.occluders.dual_grids = in.view.sublights = 1;
            const spy_counts before = spy_read();
            const unsigned host_before = spy_host_alive();
            scene_message_count = 0;
            spy_fail(k, kinds[kind].vulkan);
            const softsh_result result = subjects[i].create(&subjects[i], context, &in, &object);
            failed = spy_failed_call() != NULL;
            if (failed) {
                check(&subjects[i], k, result, kinds[kind].expected, object, &before, host_before);
                expect_name(spy_failed_call());
            } else {
                assert_int_equal(result, SOFTSH_SUCCESS);
                subjects[i].destroy(object);
                assert_int_equal(spy_read().alive, before.alive);
            }
            spy_fail(0, VK_SUCCESS);
        }
        printf("%s: %u calls can fail\n", subjects[i].name, k - 2);
        assert_true(k > 3);
    }
    softsh_context_destroy(context);
}

static void host_failures(void **state)
{
    scene *s = *state;
    softsh_context *context = scene_context(s, false, spy_allocator());
    for (size_t i = 0; i < SUBJECTS; i++) {
        unsigned k = 1;
        for (bool failed = true; failed; k++) {
            scene_inputs in;
            void *object;
            assert_true(k < MOST_CALLS);
            scene_fill(s, LAMP_RECTANGLE, 1, &in);
            in.occluders.dual_grids = in.view.sublights = 1;
            const spy_counts before = spy_read();
            const unsigned host_before = spy_host_alive();
            scene_message_count = 0;
            spy_fail_host(k);
            const softsh_result result = subjects[i].create(&subjects[i], context, &in, &object);
            failed = spy_host_failed();
            if (failed) {
                check(&subjects[i], k, result, SOFTSH_ERROR_OUT_OF_HOST_MEMORY, object, &before, host_before);
            } else {
                assert_int_equal(result, SOFTSH_SUCCESS);
                subjects[i].destroy(object);
                assert_int_equal(spy_host_alive(), host_before);
            }
            spy_fail_host(0);
        }
        assert_true(k > 2);
    }
    softsh_context_destroy(context);
}

/* A failed binding leaves an object that says so, that cannot be recorded with, and that can be destroyed. */
static void binding_failures(void **state)
{
    scene *s = *state;
    softsh_context *context = scene_context(s, false, spy_allocator());
    for (int which = 0; which < 2; which++) {
        bool failed = true;
        for (unsigned k = 1; failed; k++) {
            scene_inputs in;
            scene_fill(s, LAMP_RECTANGLE, 1, &in);
            in.occluders.memory_mode = in.view.memory_mode = SOFTSH_MEMORY_CALLER;
            softsh_occluders *occluders = scene_occluders(context, &in);
            softsh_view *view = scene_view(context, &in);
            VkMemoryRequirements need;
            assert_int_equal(which ? softsh_view_memory_requirements(view, &need)
                                   : softsh_occluders_memory_requirements(occluders, &need),
                             SOFTSH_SUCCESS);
            VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = need.size};
            while (!(need.memoryTypeBits & 1u << info.memoryTypeIndex))
                info.memoryTypeIndex++;
            VkDeviceMemory memory;
            assert_int_equal(vkAllocateMemory(s->g.device, &info, NULL, &memory), VK_SUCCESS);
            const spy_counts before = spy_read();
            scene_message_count = 0;
            spy_fail(k, VK_ERROR_OUT_OF_DEVICE_MEMORY);
            const softsh_result result = which ? softsh_view_bind_memory(view, memory, 0, need.size)
                                               : softsh_occluders_bind_memory(occluders, memory, 0, need.size);
            failed = spy_failed_call() != NULL;
            spy_fail(0, VK_SUCCESS);
            if (failed) {
                assert_int_equal(result, SOFTSH_ERROR_OUT_OF_DEVICE_MEMORY);
                assert_int_equal(scene_message_count, 1);
                VkCommandBuffer cmd = gpu_begin(&s->g);
                if (which) {
                    softsh_occluders *built;
                    scene_fill(s, LAMP_RECTANGLE, 1, &in);
                    built = scene_occluders(context, &in);
                    assert_int_equal(softsh_cmd_build_occluders(cmd, built, &in.build), SOFTSH_SUCCESS);
                    in.visibility.occluders = built;
                    assert_int_equal(softsh_cmd_compute_visibility(cmd, view, &in.visibility), SOFTSH_ERROR_STATE);
                    assert_int_equal(softsh_view_bind_memory(view, memory, 0, need.size), SOFTSH_ERROR_STATE);
                    assert_true(gpu_submit(&s->g, cmd));
                    softsh_occluders_destroy(built);
                } else {
                    assert_int_equal(softsh_cmd_build_occluders(cmd, occluders, &in.build), SOFTSH_ERROR_STATE);
                    assert_int_equal(softsh_occluders_bind_memory(occluders, memory, 0, need.size), SOFTSH_ERROR_STATE);
                    assert_int_equal(spy_read().commands, before.commands);
                    assert_true(gpu_submit(&s->g, cmd));
                }
            } else {
                assert_int_equal(result, SOFTSH_SUCCESS);
                assert_true(k > 1);
            }
            softsh_view_destroy(view);
            softsh_occluders_destroy(occluders);
            vkFreeMemory(s->g.device, memory, NULL);
        }
    }
    softsh_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(vulkan_failures),
        cmocka_unit_test(host_failures),
        cmocka_unit_test(binding_failures),
    };
    return cmocka_run_group_tests_name("failures", tests, scene_setup, scene_teardown);
}
