/* The structures shared with GLSL, as C sees them, with the std430 sizes and offsets the shaders rely on. */
#ifndef SOFTSHI_SHARED_H
#define SOFTSHI_SHARED_H

#include <assert.h>
#include <stddef.h>

#define SS_HOST
#include "ss_types.h"

static_assert(offsetof(ss_occluders, depths) == 48, "std430");
static_assert(offsetof(ss_occluders, size) == 80, "std430");
static_assert(offsetof(ss_occluders, pyramid) == 256, "std430");
static_assert(offsetof(ss_occluders, duals) == 512, "std430");
static_assert(sizeof(ss_occluders) == 1536, "std430"); /* ss_plan begins here: a multiple of 256 */
static_assert(sizeof(ss_plan) == 16 * SS_MAX_LEVELS + 16, "std430");
static_assert(offsetof(ss_frame, camera) == 128, "std430");
static_assert(offsetof(ss_frame, area) == 160, "std430");
static_assert(sizeof(ss_frame) == 256, "std430");
static_assert(offsetof(ss_control, stats) == 128, "std430");
static_assert(sizeof(ss_control) == 256, "std430");
static_assert(sizeof(ss_convert_push) == 32, "std430");
static_assert(sizeof(ss_level_push) == 16, "std430");
static_assert(sizeof(ss_filter_push) == 16, "std430");
static_assert(sizeof(ss_combine_push) == 16, "std430");

#endif
