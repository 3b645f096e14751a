/* Argument checks: all of them run before the first recorded command, and each failure names the field, its value and
 * what was expected. */
#ifndef SOFTSHI_VALIDATE_H
#define SOFTSHI_VALIDATE_H

#include "context.h"

softsh_result softshi_check_context_info(softsh_context *early, const softsh_context_info *info, softsh_context **out);
softsh_result softshi_check_occluders_info(const softsh_context *context, const softsh_occluders_info *info,
                                           softsh_occluders **out);
softsh_result softshi_check_view_info(const softsh_context *context, const softsh_view_info *info, softsh_view **out);
softsh_result softshi_check_settings(const softsh_context *context, const softsh_settings *settings);
softsh_result softshi_check_light(const softsh_context *context, const softsh_light *light);
/* For what needs no context, and so cannot say more: a rectangle of finite numbers, whose sides may be zero. */
softsh_result softshi_check_rectangle_light(const softsh_light *light);
/* Maps of one light, which was checked: roles, indices, formats, rectangles; the map's size goes to `extent`. */
softsh_result softshi_check_maps(const softsh_context *context, const softsh_build_info *info, VkExtent2D max_extent,
                                 uint32_t max_layers, VkExtent2D *extent);
softsh_result softshi_check_camera(const softsh_context *context, const softsh_camera *camera, bool normals);
softsh_result softshi_check_timestamps(const softsh_context *context, const softsh_timestamps *timestamps);
/* A rectangle inside an extent; a zero extent becomes the whole. */
softsh_result softshi_check_rect(const softsh_context *context, const char *field, VkExtent2D inside, VkRect2D *rect);

#endif
