/* libsoftshadow: accurate soft shadows of area lights from the depth buffers a renderer already has.
 *
 * Call order:
 *     softsh_context_create -> softsh_occluders_create (per light), softsh_view_create (per camera)
 *     per frame, into the caller's command buffer:
 *         softsh_cmd_build_occluders         only when the light or its maps changed
 *         softsh_cmd_compute_visibility      per light and view
 *
 * The library creates no device and no queue, submits nothing, waits for nothing, and allocates nothing while
 * recording. A failed recording function has recorded nothing and left every object as it was.
 *
 * Threads: a context may be used by any number of threads at once. An occluders or view object is used by one thread at
 * a time; different objects are independent. Objects must be idle on the device when they are destroyed. */
#ifndef SOFTSHADOW_SOFTSHADOW_H
#define SOFTSHADOW_SOFTSHADOW_H

#include <softshadow/types.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(_WIN32) && defined(SOFTSH_SHARED)
#ifdef SOFTSH_BUILDING
#define SOFTSH_API __declspec(dllexport)
#else
#define SOFTSH_API __declspec(dllimport)
#endif
#elif defined(__GNUC__)
#define SOFTSH_API __attribute__((visibility("default")))
#else
#define SOFTSH_API
#endif

/* Version of the linked library, as SOFTSH_MAKE_VERSION. */
SOFTSH_API uint32_t softsh_version(void);

/* Static name of a result, "SOFTSH_ERROR_LIMIT" for example; never NULL. */
SOFTSH_API const char *softsh_result_string(softsh_result result);

/* What a device must offer and whether this one does. `out->struct_size` is set by the caller. */
SOFTSH_API softsh_result softsh_get_requirements(PFN_vkGetInstanceProcAddr get_instance_proc_addr, VkInstance instance,
                                                 VkPhysicalDevice physical_device, softsh_requirements *out);

/* One per VkDevice. Immutable afterwards. On failure *out is NULL. Destroying NULL is allowed; destroy the objects made
 * from a context before it. */
SOFTSH_API softsh_result softsh_context_create(const softsh_context_info *info, softsh_context **out);
SOFTSH_API void softsh_context_destroy(softsh_context *context);

/* One per light: the acceleration structures built from its maps. Compiles pipelines. */
SOFTSH_API softsh_result softsh_occluders_create(softsh_context *context, const softsh_occluders_info *info,
                                                 softsh_occluders **out);
SOFTSH_API void softsh_occluders_destroy(softsh_occluders *occluders);

/* One per camera: settings, pipelines and scratch memory, shared by all lights seen by that camera. Compiles pipelines.
 */
SOFTSH_API softsh_result softsh_view_create(softsh_context *context, const softsh_view_info *info, softsh_view **out);
SOFTSH_API void softsh_view_destroy(softsh_view *view);

/* Device memory an object needs; for SOFTSH_MEMORY_LIBRARY objects, what they have. The occluders' memory is
 * persistent: it holds the hierarchy until the next build. The view's is scratch: it may alias other passes' memory
 * outside softsh_cmd_compute_visibility (the caller makes the aliases' accesses visible to each other). */
SOFTSH_API softsh_result softsh_occluders_memory_requirements(const softsh_occluders *occluders,
                                                              VkMemoryRequirements *out);
SOFTSH_API softsh_result softsh_view_memory_requirements(const softsh_view *view, VkMemoryRequirements *out);

/* Binds caller memory, once, before the first recording. `size` is what is available from `offset` on. The memory stays
 * the caller's and outlives the object. Any memory type the requirements allow will do; device local is fastest.
 * After SOFTSH_ERROR_INVALID_ARGUMENT it may be tried again; after a Vulkan error the object can only be destroyed. */
SOFTSH_API softsh_result softsh_occluders_bind_memory(softsh_occluders *occluders, VkDeviceMemory memory,
                                                      VkDeviceSize offset, VkDeviceSize size);
SOFTSH_API softsh_result softsh_view_bind_memory(softsh_view *view, VkDeviceMemory memory, VkDeviceSize offset,
                                                 VkDeviceSize size);

/* Records the build of a light's hierarchy. Outside a render pass, on a queue with compute.
 * Entry: each map is in `layout`, its writes made available and visible to COMPUTE_SHADER / SHADER_READ.
 * Exit: the maps are unchanged, last read in COMPUTE_SHADER; the hierarchy is visible to COMPUTE_SHADER / SHADER_READ,
 * so visibility may follow with no barrier, in this or a later command buffer of the same queue. Clobbers the compute
 * pipeline, compute descriptor sets 0 and 1 and the push constants. */
SOFTSH_API softsh_result softsh_cmd_build_occluders(VkCommandBuffer cmd, softsh_occluders *occluders,
                                                    const softsh_build_info *info);

/* Records the visible fraction of one light for every texel of the render area: 1 lit, 0 dark, 1 where nothing was
 * rendered or outside the map, 0 where normals are given and face away from all of the light.
 * Entry: depth (and normals) in their layouts, visible to COMPUTE_SHADER / SHADER_READ; the visibility image in
 * GENERAL, earlier accesses made available to COMPUTE_SHADER / SHADER_WRITE; the stats buffer likewise to TRANSFER /
 * TRANSFER_WRITE. Exit: the visibility image in GENERAL, last written in COMPUTE_SHADER / SHADER_WRITE; the stats
 * buffer last written in TRANSFER / TRANSFER_WRITE. The caller's barrier makes them visible to what reads them. Calls
 * with one view, or with one occluders object, are ordered by the library's own barriers on one queue. Clobbers the
 * compute pipeline, compute descriptor sets 0 and 1 and the push constants.
 * Sub-lights: one call for each, in the order of their cells, u first, with the same render area; the last one writes
 * the mean, the others leave the visibility image alone. They are recorded in the order of submission, with no other
 * call with this view in between and its memory left alone. Occluders may be one object for each sub-light, or one for
 * all of them, built again before each call. */
SOFTSH_API softsh_result softsh_cmd_compute_visibility(VkCommandBuffer cmd, softsh_view *view,
                                                       const softsh_visibility_info *info);

/* The part of a rectangular light that belongs to a cell of a grid, as a light: for the frustum of a sub-light's map.
 * `out->struct_size` is set by the caller; what is not the rectangle's is copied. */
SOFTSH_API softsh_result softsh_sublight_create(const softsh_light *light, const uint32_t grid[2],
                                                const uint32_t cell[2], softsh_light *out);

/* Matrices for a square map of a rectangular light looking along its normal (half_u x half_v, or the other way if
 * `target` lies behind): the frustum's centre is `behind` world units behind the light's centre (0: on it) and it
 * covers the sphere (target, radius). `out->struct_size` is set by the caller. Depth is 0 at near, 1 at far. Neither
 * axis is zero. */
SOFTSH_API softsh_result softsh_light_frustum_create(const softsh_light *light, const double target[3], double radius,
                                                     double behind, softsh_light_frustum *out);

#ifdef __cplusplus
}
#endif

#endif
