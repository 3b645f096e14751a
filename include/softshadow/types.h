/* Types of libsoftshadow: results, lights, maps, cameras and the create and record structures.
 *
 * Conventions, valid everywhere unless a field says otherwise:
 * - Lengths are world units, angles are radians. Texels and "softness" appear nowhere.
 * - Matrices are column-major, act on column vectors and lead world -> view -> Vulkan clip space, whose depth is 0 to
 * 1; clip (-1, -1) is the first texel of the image. They are doubles so that large world offsets cancel on the host.
 *   Reversed depth, an infinite far plane and off-centre frusta need no flag: they are read off the matrices.
 * - The first field of every structure is struct_size = sizeof(the structure); it lets structures grow.
 * - A zeroed field is its default. Arrays and structures are read during the call and never kept; Vulkan handles are
 *   kept where their comment says so. Handles are trusted, every number is checked. */
#ifndef SOFTSHADOW_TYPES_H
#define SOFTSHADOW_TYPES_H

#include <stddef.h>
#include <stdint.h>

#ifndef VK_NO_PROTOTYPES
#define VK_NO_PROTOTYPES
#define SOFTSH_UNDEF_VK_NO_PROTOTYPES
#endif
#include <vulkan/vulkan_core.h>
#ifdef SOFTSH_UNDEF_VK_NO_PROTOTYPES
#undef VK_NO_PROTOTYPES
#undef SOFTSH_UNDEF_VK_NO_PROTOTYPES
#endif

#include <softshadow/techniques.h>

#ifdef __cplusplus
extern "C" {
#endif

#define SOFTSH_VERSION_MAJOR 0
#define SOFTSH_VERSION_MINOR 1
#define SOFTSH_VERSION_PATCH 0
#define SOFTSH_MAKE_VERSION(major, minor, patch)                                                                       \
    (((uint32_t)(major) << 22) | ((uint32_t)(minor) << 12) | (uint32_t)(patch))
#define SOFTSH_VERSION SOFTSH_MAKE_VERSION(SOFTSH_VERSION_MAJOR, SOFTSH_VERSION_MINOR, SOFTSH_VERSION_PATCH)

/* Largest number of layer maps of one light. */
#define SOFTSH_MAX_LAYERS 4u
/* Largest number of parts of a light along each of its axes. */
#define SOFTSH_MAX_SUBLIGHTS 16u
/* Largest width and height of a map and of a camera image, in texels. */
#define SOFTSH_MAX_EXTENT 16384u
/* Most passes one recording function records; the size to give softsh_timestamps arrays. */
#define SOFTSH_MAX_PASSES 128u

/* Every function that can fail returns one of these; the message callback gets the sentence that goes with it. */
typedef enum softsh_result {
    SOFTSH_SUCCESS = 0,
    SOFTSH_ERROR_INVALID_ARGUMENT = -1, /* a pointer, size, number or matrix that can never work */
    SOFTSH_ERROR_UNSUPPORTED = -2,      /* valid, but not done by this version or on this device */
    SOFTSH_ERROR_LIMIT = -3,            /* exceeds a limit of the device or of the object's create info */
    SOFTSH_ERROR_OUT_OF_HOST_MEMORY = -4,
    SOFTSH_ERROR_OUT_OF_DEVICE_MEMORY = -5,
    SOFTSH_ERROR_STATE = -6, /* called out of order: memory not bound, occluders never built */
    SOFTSH_ERROR_VULKAN = -7 /* another Vulkan error; the message holds the VkResult */
} softsh_result;

/* One sentence per failed call, naming the field, its value and what was expected. May be called from whichever thread
 * calls the library; must not call back into it. Calls on a NULL object, and the two functions without one
 * (softsh_get_requirements, softsh_light_frustum_create), have no callback: their result is all there is. */
typedef void (*softsh_message_fn)(void *user, softsh_result result, const char *message);

typedef struct softsh_context softsh_context;
typedef struct softsh_occluders softsh_occluders;
typedef struct softsh_view softsh_view;

typedef struct softsh_context_info {
    uint32_t struct_size;
    uint32_t
        debug_names; /* nonzero: name objects and label passes; the instance must have VK_EXT_debug_utils enabled */
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device; /* with the features softsh_get_requirements lists enabled */
    PFN_vkGetInstanceProcAddr get_instance_proc_addr;
    PFN_vkGetDeviceProcAddr get_device_proc_addr;
    const VkAllocationCallbacks
        *allocation_callbacks;      /* used for host memory and passed to Vulkan; copied; may be NULL */
    VkPipelineCache pipeline_cache; /* kept, used when pipelines are made; may be VK_NULL_HANDLE */
    softsh_message_fn message;      /* may be NULL */
    void *message_user;
} softsh_context_info;

/* What the device must and may offer. Strings are static. */
typedef struct softsh_requirements {
    uint32_t struct_size;
    uint32_t api_version;              /* lowest Vulkan version: 1.1 */
    VkPhysicalDeviceFeatures features; /* required, to be enabled at device creation */
    VkPhysicalDeviceFeatures useful;   /* used where enabled, never required */
    uint32_t extension_count;          /* required device extensions: none */
    const char *const *extensions;
    uint32_t useful_extension_count; /* instance extensions used where enabled */
    const char *const *useful_extensions;
    uint32_t supported; /* nonzero if this physical device meets the requirements */
} softsh_requirements;

typedef enum softsh_light_shape {
    SOFTSH_LIGHT_RECTANGLE = 0,   /* center, half_u, half_v; its plane parallel to the map's image plane */
    SOFTSH_LIGHT_DIRECTIONAL = 1, /* direction, angular_radius; with orthographic maps only */
    SOFTSH_LIGHT_DISC = 2,        /* not supported yet */
    SOFTSH_LIGHT_SPHERE = 3       /* not supported yet */
} softsh_light_shape;

/* A light with its physical size. All-zero extents mean a point (or parallel) light and take the hard-shadow path. */
typedef struct softsh_light {
    uint32_t struct_size;
    softsh_light_shape shape;
    double center[3];      /* rectangle: centre, world units */
    double half_u[3];      /* rectangle: from the centre to the middle of an edge, world units */
    double half_v[3];      /* rectangle: likewise for the other axis, perpendicular to half_u */
    double direction[3];   /* directional: the way the light travels, any length but zero */
    double angular_radius; /* directional: half the angle the disc of the sun spans, radians, 0 to 0.5 */
    double radius;         /* disc, sphere: world units; not supported yet, must be 0 with the other shapes */
    uint32_t color_count;  /* 0 or 1; more is not supported yet */
    VkImageView texture;   /* not supported yet, must be VK_NULL_HANDLE */
} softsh_light;

/* What a map is to its light. */
typedef enum softsh_map_role {
    SOFTSH_MAP_LAYER = 0,    /* depth-peeled or per-object map; all layers share one projection; occlusion is united */
    SOFTSH_MAP_SUBLIGHT = 1, /* map, or one of several layers, of a cell of a rectangular light cut into a grid */
    SOFTSH_MAP_FACE = 2,     /* not supported yet */
    SOFTSH_MAP_CASCADE = 3   /* not supported yet */
} softsh_map_role;

/* A depth buffer seen from the light. Perspective maps have their projection centre on the light's plane or behind it;
 * orthographic maps go with directional lights. The texture is read by the build only: afterwards it may be reused. */
typedef struct softsh_map {
    uint32_t struct_size;
    softsh_map_role role;
    uint32_t index;   /* layer: 0 to the number of maps - 1, each once */
    uint32_t grid[2]; /* sublight: parts along half_u and half_v, 1 to SOFTSH_MAX_SUBLIGHTS each; otherwise 0 */
    uint32_t cell[2]; /* sublight: which of them, (0, 0) at -half_u - half_v; otherwise 0 */
    VkImageView view; /* 2D, one layer, depth aspect (or colour for R32F); usage SAMPLED */
    VkFormat format; /* D16_UNORM, X8_D24_UNORM_PACK32, D24_UNORM_S8_UINT, D32_SFLOAT, D32_SFLOAT_S8_UINT, R32_SFLOAT */
    VkImageLayout layout;    /* during the build: SHADER_READ_ONLY_OPTIMAL, GENERAL or, for depth formats,
                                DEPTH_STENCIL_READ_ONLY_OPTIMAL */
    VkExtent2D image_extent; /* size of the image behind the view */
    VkRect2D rect;           /* the map's part of the image (atlas); all zero: all of it */
    uint32_t array_layer;    /* must be 0: give a view of the layer */
    double view_matrix[16];
    double projection[16];
} softsh_map;

/* Which structure answers "nearest and farthest occluder of this region". */
typedef enum softsh_accel {
    SOFTSH_ACCEL_AUTO = 0, /* YSM */
    SOFTSH_ACCEL_HSM = 1,  /* min/max pyramid: smallest, loosest */
    SOFTSH_ACCEL_MSSM = 2, /* every level at full resolution: tightest, 8 bytes * texels * levels, for all layers
                            * together within the device's maxStorageBufferRange */
    SOFTSH_ACCEL_YSM = 3   /* pyramid down to ysm_join texels, full resolution from there */
} softsh_accel;

/* Where an object's device memory comes from. */
typedef enum softsh_memory_mode {
    SOFTSH_MEMORY_LIBRARY = 0, /* one vkAllocateMemory per object, freed with it */
    SOFTSH_MEMORY_CALLER = 1   /* query requirements, then bind once before the first recording */
} softsh_memory_mode;

typedef struct softsh_occluders_info {
    uint32_t struct_size;
    VkExtent2D max_extent; /* largest map, 1 to SOFTSH_MAX_EXTENT */
    uint32_t max_layers;   /* 0 means 1; at most SOFTSH_MAX_LAYERS */
    softsh_accel accel;
    uint32_t ysm_join;       /* the YSM's full-resolution part has at most this many texels a side; 0 means 256 */
    uint32_t no_folds;       /* nonzero: save the bits of where surfaces fold, a sixth of a byte a texel and layer, and
                                their time; only for views that are neither automatic nor have softsh_settings::outline
                                or a reconstruction other than joined */
    uint32_t dual_grids;     /* nonzero: views with SOFTSH_SEARCH_WALK may use this light; 14 bytes a texel and layer
                                with an HSM, some more with a YSM, 10 bytes a texel, layer and level with an MSSM */
    uint32_t max_recordings; /* the last so many builds may be pending or submitted again; 0 means 4, at most 1024 */
    softsh_memory_mode memory_mode;
    const char *name; /* debug name; copied; may be NULL */
} softsh_occluders_info;

typedef struct softsh_build_info {
    uint32_t struct_size;
    const softsh_light *light; /* all of it, also for the maps of a sub-light */
    uint32_t map_count;
    const softsh_map *maps;               /* all layers, or all of one sub-light, in any order */
    struct softsh_timestamps *timestamps; /* may be NULL */
} softsh_build_info;

typedef struct softsh_view_info {
    uint32_t struct_size;
    VkExtent2D max_extent;  /* largest camera image, 1 to SOFTSH_MAX_EXTENT */
    VkFormat output_format; /* R8_UNORM, R16_SFLOAT, R16_UNORM or R32_SFLOAT, with STORAGE usage on this device */
    const softsh_settings *settings; /* NULL: automatic */
    uint32_t stats;                  /* nonzero: count pixels, nodes and primitives (costs a little) */
    uint32_t max_recordings; /* the last so many visibility calls may be pending or submitted again; 0 means 16, at most
                                1024 */
    uint32_t normals;        /* nonzero: this view's cameras come with normals */
    uint32_t sublights;      /* nonzero: can combine sub-lights; 8 bytes of memory a pixel */
    uint32_t max_views;      /* 0 or 1; more is not supported yet */
    softsh_memory_mode memory_mode;
    const char *name; /* debug name; copied; may be NULL */
} softsh_view_info;

/* The renderer's camera and the depth buffer it has rendered. */
typedef struct softsh_camera {
    uint32_t struct_size;
    VkImageView depth;             /* 2D, depth aspect (or colour for R32F); usage SAMPLED */
    VkFormat depth_format;         /* as softsh_map::format */
    VkImageLayout depth_layout;    /* as softsh_map::layout */
    VkSampleCountFlagBits samples; /* 0 or VK_SAMPLE_COUNT_1_BIT; more is not supported yet */
    VkImageView normals; /* optional: world-space normals in xyz, of any length, as floats; zero: none here; given if
                            and only if the view has normals */
    VkImageLayout normals_layout;
    double view_matrix[16];
    double projection[16]; /* of the render area: clip (-1, -1) is the render area's first texel */
} softsh_camera;

/* Counts of one visibility call, written by the device as this structure. 64-bit counts are exact. */
typedef struct softsh_stats {
    uint64_t pixels; /* in the render area */
    uint64_t
        lit; /* found lit by classification (or by the one comparison of a light without size); background included */
    uint64_t umbra;           /* found dark likewise */
    uint64_t active;          /* neither: evaluated one by one, or interpolated */
    uint64_t nodes;           /* four per query of the hierarchy */
    uint64_t primitives;      /* micro-occluders, or edges of contours, projected */
    uint64_t tiles;           /* 8 x 8 pixel tiles in the render area */
    uint64_t undecided_tiles; /* needed a look at their pixels */
    uint64_t clamped;         /* active pixels whose level the budget, or the bound on one pixel's work, coarsened */
    uint64_t interpolated;    /* active pixels that took their neighbours' mean instead */
    uint64_t packets;         /* packets of pixels that evaluation began with; of contours */
    uint64_t incoherent;      /* of these, with pixels that did not belong together and were evaluated apart */
    uint64_t diverged;        /* of these, not of one contour: all pixels were evaluated apart */
    uint64_t edges;           /* edges of contours or outlines, or sides of backs, by packets and pixels */
    uint64_t visited;         /* looked at for these, likewise: samples and blocks of them; by SOFTSH_SEARCH_WALK, nodes
                                 of levels above 0, and cells between four samples */
    uint64_t refined;         /* active pixels evaluated finer than the budget, for something thin in their kernels */
    uint32_t wide_levels_built;   /* MSSM levels of the occluders' last build */
    uint32_t wide_levels_skipped; /* MSSM levels that no kernel of this light and map can ask for */
} softsh_stats;

/* Optional timing: the library writes pass_count + 1 timestamps from first_query on; pass i took query i+1 - query i.
 * The caller has reset the queries. Filled in by the recording function. */
typedef struct softsh_timestamps {
    uint32_t struct_size;
    VkQueryPool pool;
    uint32_t first_query;                      /* first_query + query_count fits 32 bits and the pool */
    uint32_t query_count;                      /* at least SOFTSH_MAX_PASSES + 1 */
    uint32_t pass_count;                       /* out */
    const char *pass_names[SOFTSH_MAX_PASSES]; /* out; static strings */
} softsh_timestamps;

typedef struct softsh_visibility_info {
    uint32_t struct_size;
    softsh_occluders *occluders; /* built by an earlier recording */
    uint32_t camera_count;       /* 1; more is not supported yet */
    const softsh_camera *cameras;
    VkRect2D render_area;      /* the part of the images that was rendered; all zero: all of max_extent */
    VkImageView visibility;    /* 2D storage image of the view's output_format, layout GENERAL */
    uint32_t override_bias;    /* nonzero: shift receivers by `bias` towards the light instead of the automatic bias */
    double bias;               /* world units along the map's axis, >= 0 */
    VkBuffer stats_buffer;     /* optional; usage TRANSFER_DST; gets a softsh_stats at stats_offset */
    VkDeviceSize stats_offset; /* multiple of 4 */
    softsh_timestamps *timestamps; /* may be NULL */
} softsh_visibility_info;

/* A perspective frustum for a rectangular light, for renderers that have none yet. */
typedef struct softsh_light_frustum {
    uint32_t struct_size;
    double near_distance; /* out: distance of the near plane from the projection centre */
    double view_matrix[16];
    double projection[16];
} softsh_light_frustum;

#ifdef __cplusplus
}
#endif

#endif
