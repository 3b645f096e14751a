/* What the interface tests share: a device with validation, a small analytic scene (a square over a ground plane, depth
 * buffers cast ray by ray), structures filled in validly, and rendering through the spy. */
#ifndef API_SCENE_H
#define API_SCENE_H

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <setjmp.h>

#include <cmocka.h>

#include <gpu.h>
#include <softshadow/softshadow.h>

#include "spy.h"

enum {
    SCENE_WIDTH = 72,
    SCENE_HEIGHT = 52,
    SCENE_MAP = 64,
    SCENE_LAYERS = 2,
    SCENE_PIXELS = SCENE_WIDTH * SCENE_HEIGHT
};

/* Lights, each with its maps. */
typedef enum scene_lamp { LAMP_RECTANGLE, LAMP_SECOND, LAMP_DIRECTIONAL, LAMP_POINT, LAMP_COUNT } scene_lamp;

/* Every public structure, valid and pointing at each other; tests spoil single fields. */
typedef struct scene_inputs {
    softsh_context_info context;
    VkAllocationCallbacks callbacks; /* copy of the spy's, not set in `context` */
    softsh_occluders_info occluders;
    softsh_settings settings;
    softsh_view_info view;
    softsh_light light;
    softsh_map maps[SOFTSH_MAX_LAYERS];
    softsh_build_info build;
    softsh_camera camera;
    softsh_visibility_info visibility;
    softsh_timestamps timestamps; /* not set in `build` and `visibility` */
} scene_inputs;

typedef struct scene {
    gpu g;
    gpu_image camera_depth, normals, output;
    gpu_image maps[LAMP_COUNT][SCENE_LAYERS];
    gpu_buffer stats;
    VkQueryPool queries;
    float picture[SCENE_PIXELS];
} scene;

/* Messages of the library. */
extern unsigned scene_message_count;
extern softsh_result scene_message_result;
extern char scene_message[512];
/* Fails the running test if the last message does not contain `words`. */
void scene_expect_words(const char *words);

/* For cmocka's group fixtures; `*state` becomes the scene. The teardown fails on any message of the validation layer,
 * and on anything the library left behind. */
int scene_setup(void **state);
int scene_teardown(void **state);
/* Without device: makes the scene's images on an existing g. */
void scene_create(scene *s);
void scene_destroy(scene *s);

/* One layer unless `layers` says otherwise; visibility goes to s->output, and the occluders are left out. */
void scene_fill(scene *s, scene_lamp lamp, uint32_t layers, scene_inputs *in);

softsh_context *scene_context(scene *s, bool debug_names, const VkAllocationCallbacks *allocator);
/* With the infos of `in`. */
softsh_occluders *scene_occluders(softsh_context *context, const scene_inputs *in);
softsh_view *scene_view(softsh_context *context, const scene_inputs *in);

/* A barrier from everything to everything. */
void scene_barrier(VkCommandBuffer cmd);
/* Records into one command buffer, submits, and reads s->picture; `in` has what the calls take. */
void scene_render(scene *s, softsh_occluders *occluders, softsh_view *view, scene_inputs *in);
/* Some pixels are dark, some lit and some between: the picture is one of a soft shadow. */
void scene_expect_shadow(const float *picture);
/* Fails if the library has said anything, or the layer has. */
void scene_expect_silence(const scene *s);

#endif
