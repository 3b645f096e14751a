/* Structures and constants shared by C and GLSL. In C every size and offset is asserted (lib/shared.h); in GLSL the
 * structures mean the same under std140 and std430. vec3 and bool never appear. */
#ifndef SS_TYPES_H
#define SS_TYPES_H

#ifdef SS_HOST
#include <stdint.h>
typedef struct ss_vec4 {
    float x, y, z, w;
} ss_vec4;
typedef struct ss_uvec4 {
    uint32_t x, y, z, w;
} ss_uvec4;
typedef struct ss_ivec4 {
    int32_t x, y, z, w;
} ss_ivec4;
#define SS_VEC4 ss_vec4
#define SS_UVEC4 ss_uvec4
#define SS_IVEC4 ss_ivec4
#define SS_UINT uint32_t
#define SS_FLOAT float
#define SS_STRUCT(name) typedef struct name
#define SS_STRUCT_END(name) name
#else
#define SS_VEC4 vec4
#define SS_UVEC4 uvec4
#define SS_IVEC4 ivec4
#define SS_UINT uint
#define SS_FLOAT float
#define SS_STRUCT(name) struct name
#define SS_STRUCT_END(name)
#endif

/* Descriptor sets and bindings; every pipeline uses the same two set layouts. */
#define SS_SET_OCCLUDERS 0
#define SS_BIND_OCCLUDERS 0 /* uniform: ss_occluders and ss_plan */
#define SS_BIND_PLAN 1       /* ss_plan, where it is written */
#define SS_BIND_MADE_DEPTH 2  /* storage texels, where they are written: fan depths, four of a row to a texel */
#define SS_BIND_MADE_RANGES 3 /* vec2 (farthest, nearest): HSM levels 1 to top of each layer, and with several of all together;
                                 MSSM levels 1 to n of all together; dual grids of each layer */
#define SS_BIND_DEPTHS 4      /* uniform texels, where they are read: single fan depths */
#define SS_BIND_DEPTH_QUADS 5 /* four of them */
#define SS_BIND_RANGES 6
#define SS_BIND_BITS 7      /* levels that are too coarse for what is thin: a word for each texel of the pyramid from level 2 on,
                               of all layers together; then bits of cells that fold, of each layer and level: 32 of a row to a
                               word */
#define SS_BIND_MADE_BITS 8 /* storage texels, where they are written */
#define SS_OCCLUDER_BINDINGS 9

#define SS_SET_IO 1
#define SS_BIND_DEPTH 0      /* sampled: the map (build) or the camera's depth */
#define SS_BIND_NORMALS 1    /* sampled */
#define SS_BIND_VISIBILITY 2 /* storage */
#define SS_BIND_FRAME 3      /* uniform: ss_frame */
#define SS_BIND_CONTROL 4    /* ss_control */
#define SS_BIND_TILES 5      /* tile states and lists */
#define SS_BIND_FILTER 6     /* area and bitmask occlusion per pixel */
#define SS_IO_BINDINGS 7

/* Specialization constants. */
#define SS_SPEC_PATTERN_SIDE 0 /* 0 (area only), 8, 16, 32 */
#define SS_SPEC_JITTERED 1
#define SS_SPEC_PRIMITIVE 2 /* SS_PRIMITIVE_* */
#define SS_SPEC_SAMPLED 3   /* 1: coarse levels take one texel's depth, 0: the nearest depth */
#define SS_SPEC_MERGE_MAXIMUM 4
#define SS_SPEC_AREA 5      /* 1: accumulate areas */
#define SS_SPEC_HIERARCHY 6 /* 0: no pruning, no classification */
#define SS_SPEC_STATS 7
#define SS_SPEC_FILTER 8   /* 1: keep values for the post filter */
#define SS_SPEC_NORMALS 9  /* 1: normals are bound */
#define SS_SPEC_LAYERED 10 /* 1: perhaps more than one layer */
#define SS_SPEC_SPARSE 11  /* 1: some pixels are interpolated */
#define SS_SPEC_PACKET 12  /* pixels a side of a packet that one invocation evaluates: 1 to 4 */
#define SS_SPEC_BLOCK 13   /* pixels a side of the blocks that are classified: 3 or 4; 1: single pixels */
#define SS_SPEC_SPLIT 14   /* 1: 4 x 4 packets that are not of one contour go on as 2 x 2 ones, before single pixels */
#define SS_SPEC_SUBLIGHTS 15 /* 1: visibility goes to a plane of its own, to be combined */
#define SS_SPEC_REFINE 16 /* 1: finer levels where a kernel's level is too coarse for what is thin */
#define SS_SPEC_RECONSTRUCTION 17 /* SS_RECONSTRUCTION_* */
#define SS_SPEC_WALK 18 /* 1: contours are searched by a walk down the dual grid, not in strips */
#define SS_SPEC_COUNT 19

#define SS_PRIMITIVE_PATCH 0
#define SS_PRIMITIVE_PATCH_EXTENDED 1
#define SS_PRIMITIVE_QUAD 2
#define SS_PRIMITIVE_QUAD_RECTANGLE 3
#define SS_PRIMITIVE_CONTOUR 4

/* Where neighbours that occlude are cut apart. */
#define SS_RECONSTRUCTION_JOINED 0
#define SS_RECONSTRUCTION_FOLDS 1
#define SS_RECONSTRUCTION_SECOND_DIFFERENCES 2
#define SS_RECONSTRUCTION_BACKS 3

#define SS_TILE_X 8 /* pixels of a tile */
#define SS_TILE_Y 8
#define SS_TILE_PIXELS 64
#define SS_EVALUATE_GROUP 64
#define SS_MAX_LEVELS 16      /* levels of a 32768 texel map */
#define SS_SAMPLE_GROUP 64    /* of hierarchy_sample, whose invocations make a quad each, and the like */
#define SS_WIDEN_ROWS 4       /* that one invocation of hierarchy_widen makes */
#define SS_TILE_REFINEMENTS 2 /* of kernels: a third pays for pixels only */
#define SS_MAX_REFINEMENTS 3
#define SS_PACKET_REFINEMENTS 2 /* of a pixel's kernel after its block's */
/* Lists of what one invocation evaluates: packets of the largest size, packets of 2 x 2 pixels, single pixels. There are two
 * rounds of them, the second for what interpolation leaves. */
#define SS_LIST_LARGE 0
#define SS_LIST_SMALL 1
#define SS_LIST_PIXELS 2
#define SS_LISTS 3
#define SS_SMALL_MASK 0x0033u   /* of a packet of 2 x 2 pixels: bit x + 4 y */
#define SS_LATTICE_MASK 0x0505u /* every second pixel of every second row */
/* Words per tile in the tiles buffer. All tiles: state; undecided list (tile, nearest occluder); scratch for the bounds of the
 * tile's columns first and the list of single pixels (pixel, nearest occluder) later. Then what settings ask for: lists of
 * packets (first pixel, nearest occluder, mask of pixels), at most one for each 3 x 3 or 2 x 2 pixels, and what is looked at
 * between the rounds: pixels (pixel, nearest occluder) or blocks (as packets). A list serves both rounds in turn. */
#define SS_PACKET_WORDS 3
#define SS_INTERPOLATED_WORDS (2 * SS_TILE_PIXELS * 3 / 4)
#define SS_DISPATCH_WIDTH 32768 /* indirect dispatches wrap into y beyond this */

#define SS_STATE_LIT 0
#define SS_STATE_UMBRA 1
#define SS_STATE_PIXELS 2 /* values differ within the tile */

#define SS_FLAG_ORTHOGRAPHIC 1u
#define SS_FLAG_DISC 2u
#define SS_FLAG_OVERRIDE_BIAS 4u
#define SS_FLAG_REVERSED 8u /* the camera's depth */

/* The light and its maps in map space: docs/numerics.md, sections 1 and 2. */
SS_STRUCT(ss_occluders)
{
    SS_VEC4 a;          /* A by rows */
    SS_VEC4 a_inverse;  /* its inverse by rows */
    SS_VEC4 light;      /* U.x, U.y, delta, epsilon */
    SS_VEC4 depths;     /* map's part of eta; tangent (or world size) of a texel in u, v; fan depth of the far plane */
    SS_VEC4 extent;     /* half side of the square that areas are clipped to; words of folds per layer; unused */
    SS_UVEC4 size;      /* width, height, layers; place of the pyramid over all layers among the layers' */
    SS_UVEC4 levels;    /* top of the pyramid, join level, wide levels there is room for, their width */
    SS_UVEC4 strides;   /* per layer: quads of fan depths, texels of the pyramid; first texel of wide level 1, texels per
                           wide level */
    SS_UVEC4 folds[SS_MAX_LEVELS / 2]; /* two levels each: first word of the first layer, words in a row */
    /* Per level: first texel and width of its ranges, which level 0 has none of; first quad of its sampled fan depths, quads
     * in a row of them. */
    SS_UVEC4 pyramid[SS_MAX_LEVELS];
    /* Dual grids, after the wide levels. By level of the nodes, then by level of the samples, four to a vector: first texel in a
     * layer's; where there are none, that of the next ones, and at last what a layer takes. */
    SS_UVEC4 duals[SS_MAX_LEVELS * SS_MAX_LEVELS / 4];
}
SS_STRUCT_END(ss_occluders);

/* Indirect dispatch arguments of one wide level, and what was decided; written by hierarchy_plan. */
SS_STRUCT(ss_plan)
{
    SS_UVEC4 args[SS_MAX_LEVELS]; /* groups x, y, z; unused */
    SS_UVEC4 built;               /* wide levels built, wide levels skipped; unused */
}
SS_STRUCT_END(ss_plan);

/* One visibility call: the receiver side. */
SS_STRUCT(ss_frame)
{
    SS_VEC4 to_map[4];     /* rows: (ndc x, ndc y, depth - far depth, 1) -> homogeneous u, v, g, w */
    SS_VEC4 normal_map[4]; /* xyz: rows of d(u w, v w, g w, w)/d(world); [0].w: sign of their orientation */
    SS_VEC4 camera;        /* far depth; ndc per pixel in x, y; camera's rho */
    SS_VEC4 bias;          /* override in world units; unused */
    SS_IVEC4 area;         /* render area: x, y, width, height */
    SS_UVEC4 tiles;        /* tiles in x, y, their number; unused */
    SS_UVEC4 quality;      /* budget (0: none), least level, pixels in the render area, first value of sub-lights */
    SS_UVEC4 flags;        /* x: SS_FLAG_*; unused */
    SS_VEC4 cost;          /* Yang et al. 2009: Q_n, Q_e, Q_v of equation 6, T_d for equation 5 */
    SS_UVEC4 lists;        /* where they begin in the tiles buffer: single pixels, large and small packets, interpolated */
}
SS_STRUCT_END(ss_frame);

/* Indirect arguments and counters; cleared by the host's update before each call. Counters are low, high words. */
SS_STRUCT(ss_control)
{
    SS_UVEC4 pixels_args;      /* groups x, y, z; tiles in the undecided list */
    SS_UVEC4 interpolate_args; /* groups x, y, z; entries in the list of what may be interpolated */
    SS_UVEC4 evaluate_args[2 * SS_LISTS]; /* groups x, y, z; entries: of each round's lists */
    SS_UINT stats[32];                    /* softsh_stats, as pairs of words; storage buffers only */
}
SS_STRUCT_END(ss_control);

#define SS_STAT_PIXELS 0
#define SS_STAT_LIT 1
#define SS_STAT_UMBRA 2
#define SS_STAT_ACTIVE 3
#define SS_STAT_NODES 4
#define SS_STAT_PRIMITIVES 5
#define SS_STAT_TILES 6
#define SS_STAT_UNDECIDED 7
#define SS_STAT_CLAMPED 8
#define SS_STAT_INTERPOLATED 9
#define SS_STAT_PACKETS 10
#define SS_STAT_INCOHERENT 11
#define SS_STAT_DIVERGED 12
#define SS_STAT_EDGES 13
#define SS_STAT_VISITED 14
#define SS_STAT_REFINED 15

/* Push constants of the passes that need some. */
SS_STRUCT(ss_convert_push)
{
    SS_FLOAT depth_scale, depth_offset, far_depth;
    SS_UINT layer;
    SS_IVEC4 rect; /* x, y of the map in the image; unused */
}
SS_STRUCT_END(ss_convert_push);

SS_STRUCT(ss_level_push)
{
    SS_UINT level; /* to build */
    SS_UINT unused[3];
}
SS_STRUCT_END(ss_level_push);

SS_STRUCT(ss_evaluate_push)
{
    SS_UINT round;  /* 0, or with interpolation 1: the pixels it left */
    SS_UINT stride; /* between the pixels of a packet: 2 where every second one is evaluated */
    SS_UINT unused[2];
}
SS_STRUCT_END(ss_evaluate_push);

SS_STRUCT(ss_combine_push)
{
    SS_UINT first; /* 1: nothing was combined yet */
    SS_UINT count; /* of sub-lights, with the last one: write their mean; else 0 */
    SS_UINT unused[2];
}
SS_STRUCT_END(ss_combine_push);

SS_STRUCT(ss_filter_push)
{
    SS_UINT source; /* which of the two bitmask planes is read: 0 or 1 */
    SS_UINT last;   /* 1: write the visibility image */
    SS_UINT unused[2];
}
SS_STRUCT_END(ss_filter_push);

#endif
