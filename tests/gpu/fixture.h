/* What the tests on a device share: one device with validation, one context, and objects that carry depth buffers from
 * float arrays to a visibility image and back. Everything blocks; every failure fails the test.
 *
 * Around each map and each render area lies rubbish, and the visibility image is filled with a guard value before each
 * run, so that a read or write outside of the part that was handed over shows. */
#ifndef FIXTURE_H
#define FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <gpu.h>
#include <softshadow/softshadow.h>

#include "reference_map.h"
#include "reference_receiver.h"

extern gpu device;
extern softsh_context *context;

/* Group setup and teardown. The first also sees to it that a known hazard is reported, the second fails if validation
 * has said anything since. */
int fixture_setup(void **state);
int fixture_teardown(void **state);
/* Fails the test with the sentence the library sent to its callback. */
void require(softsh_result result);

/* Where a width x height part lies in its image; a zero image extent: all of it. */
typedef struct placement {
    uint32_t width, height;
    uint32_t x, y;
    uint32_t image_width, image_height;
} placement;

/* Device depth as a format stores it. */
float stored_depth(VkFormat format, float depth);
/* Whether the device can sample a depth format. */
bool depth_format_supported(VkFormat format);

typedef struct layer_info {
    const float *depth; /* device depths, row by row */
    double projection[16];
    VkFormat format; /* VK_FORMAT_UNDEFINED: R32_SFLOAT */
} layer_info;

/* A light, its maps, and how their structure is built. */
typedef struct lamp_info {
    softsh_light light;
    placement place;
    double view[16];
    uint32_t layer_count;
    layer_info layers[SOFTSH_MAX_LAYERS];
    bool reverse_order;    /* hand the last layer over first */
    VkImageLayout layout;  /* VK_IMAGE_LAYOUT_UNDEFINED: SHADER_READ_ONLY_OPTIMAL */
    VkExtent2D max_extent; /* zero: the map's */
    bool no_folds, dual_grids;
    uint32_t grid[2], cell[2]; /* of a sub-light; zero: layers of all of the light */
    softsh_accel accel;
    uint32_t ysm_join;
} lamp_info;

typedef struct lamp {
    softsh_light light;
    uint32_t layer_count;
    softsh_map maps[SOFTSH_MAX_LAYERS];
    gpu_image images[SOFTSH_MAX_LAYERS];
    softsh_occluders *occluders;
} lamp;

/* Uploads, creates and builds. */
void lamp_create(const lamp_info *info, lamp *out);
void lamp_destroy(lamp *l);
/* Records another build. */
void lamp_record(lamp *l, VkCommandBuffer cmd);
/* The same in double precision: the map, and the fan depths of a layer as they were stored. */
void lamp_reference(const lamp_info *info, reference_map *out);
void lamp_fan_depth(const lamp_info *info, uint32_t layer, float *g);

/* A camera's depth, and normals where given. */
typedef struct eye_info {
    placement place;
    const float *depth;
    const float *normals; /* xyz of each pixel, or NULL */
    VkFormat format;      /* VK_FORMAT_UNDEFINED: R32_SFLOAT */
    double view[16], projection[16];
} eye_info;

typedef struct eye {
    placement place;
    gpu_image depth, normals;
    softsh_camera camera;
} eye;

void eye_create(const eye_info *info, eye *out);
void eye_destroy(eye *e);
void eye_reference(const eye_info *info, reference_camera *out);
/* rho of lamp and eye; of several layers the largest error of g counts. */
reference_bias precision_of(const lamp_info *l, const eye_info *e);

typedef struct sight_info {
    softsh_settings settings; /* struct_size is filled in */
    VkFormat format;          /* VK_FORMAT_UNDEFINED: R32_SFLOAT */
    uint32_t width, height;   /* of the visibility image */
    bool normals, sublights;
} sight_info;

/* A view and the image it writes to. */
typedef struct sight {
    softsh_view *view;
    gpu_image image;
    gpu_buffer staging; /* the image, then the stats */
} sight;

void sight_create(const sight_info *info, sight *out);
void sight_destroy(sight *s);

typedef struct sight_options {
    bool override_bias;
    double bias;
} sight_options;

/* One visibility call. `visibility` gets the render area row by row, as floats; what lies around it must be untouched.
 * `options` and `stats` may be NULL. */
void sight_run(sight *s, const lamp *l, const eye *e, const sight_options *options, float *visibility,
               softsh_stats *stats);
/* A call for each of several lamps, one after the other; `visibility` gets what the image holds after each of them. If
 * `rebuilt`, only the first lamp's structure is used, built for each lamp before its call. */
void sight_run_all(sight *s, lamp *lamps, uint32_t count, bool rebuilt, const eye *e, float *const *visibility);

#endif
