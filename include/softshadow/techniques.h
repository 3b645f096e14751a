/* How visibility is estimated: the techniques and their settings.
 *
 * Leave everything zero (or give no settings at all) for the best the library does by default. The other values exist
 * for people who compare techniques; docs/techniques.md says which paper each comes from and where the code departs. */
#ifndef SOFTSHADOW_TECHNIQUES_H
#define SOFTSHADOW_TECHNIQUES_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum softsh_technique {
    SOFTSH_TECHNIQUE_AUTO = 0,    /* ignores all other settings; not on occluders with `no_folds` */
    SOFTSH_TECHNIQUE_AREA = 1,    /* accumulated areas of back-projected micro-occluders (overlaps count twice) */
    SOFTSH_TECHNIQUE_BITMASK = 2, /* Bitmask Soft Shadows, Schwarz and Stamminger 2007 */
    SOFTSH_TECHNIQUE_CONTOUR = 3  /* area within the contours of what occludes, Guennebaud et al. 2007 and Yang et al.
                                     2009; ignores pattern, primitive and filter_passes */
} softsh_technique;

/* Light sample points, section 3 of the 2007 paper. */
typedef enum softsh_pattern {
    SOFTSH_PATTERN_DEFAULT = 0, /* 16 x 16 jittered */
    SOFTSH_PATTERN_8X8 = 1,
    SOFTSH_PATTERN_16X16 = 2,
    SOFTSH_PATTERN_16X16_JITTERED = 3, /* 8 x 8 tiling of the 2 x 2 rotated grid */
    SOFTSH_PATTERN_32X32 = 4
} softsh_pattern;

/* What a map texel stands for. */
typedef enum softsh_primitive {
    SOFTSH_PRIMITIVE_DEFAULT = 0,    /* microquad, exact */
    SOFTSH_PRIMITIVE_MICROPATCH = 1, /* rectangle parallel to the light, extended to its left and bottom neighbours */
    SOFTSH_PRIMITIVE_MICROPATCH_UNEXTENDED = 2, /* without the extension: gaps leak light */
    SOFTSH_PRIMITIVE_MICROQUAD = 3,             /* quad of four texel centres, its true coverage */
    SOFTSH_PRIMITIVE_MICROQUAD_RECTANGLE = 4,   /* the 2007 paper's rectangle through the edge midpoints */
    SOFTSH_PRIMITIVE_MICRORECT = 5              /* not supported yet */
} softsh_primitive;

/* Depth of a coarse texel when a budget makes levels above the finest necessary. */
typedef enum softsh_aggregation {
    SOFTSH_AGGREGATION_DEFAULT = 0, /* sampled */
    SOFTSH_AGGREGATION_NEAREST = 1, /* nearest depth of the block, as in the papers: fattens occluders */
    SOFTSH_AGGREGATION_SAMPLED = 2  /* depth of one texel per block, always the same one: unbiased */
} softsh_aggregation;

/* How layers combine. */
typedef enum softsh_merge {
    SOFTSH_MERGE_DEFAULT = 0, /* union of bitmasks, maximum of areas */
    SOFTSH_MERGE_UNION = 1,   /* bitmasks are OR-ed; areas are added, so that what two layers hide counts twice */
    SOFTSH_MERGE_MAXIMUM = 2  /* the darkest single layer, as Atty et al. 2006 do for front and back faces */
} softsh_merge;

/* Where neighbouring samples that both occlude are taken for one surface; contour only. What is cut apart ends half a
 * step beyond its last sample, at its own depth, as all contours do. */
typedef enum softsh_reconstruction {
    SOFTSH_RECONSTRUCTION_DEFAULT = 0, /* joined */
    SOFTSH_RECONSTRUCTION_JOINED = 1,  /* everywhere: one layer of a map casts a shadow without gaps */
    SOFTSH_RECONSTRUCTION_FOLDS = 2, /* unless the receiver sees them the other way round: what is near lies in front of
                                        what is far, as seen from the light's centre. Slower, the least error */
    SOFTSH_RECONSTRUCTION_SECOND_DIFFERENCES = 3, /* unless fan depth jumps: leaks light where solid things overlap */
    SOFTSH_RECONSTRUCTION_BACKS = 4 /* everywhere, and where the receiver sees a surface's back, what that hides is
                                       estimated and added: nearly the error of folds at nearly the time of joined */
} softsh_reconstruction;

/* Neighbouring pixels that share one search for contours; contour only, see Yang et al. 2009. Packets that do not pay,
 * or are not of one contour, are evaluated pixel by pixel. With `sparse`, packets are of every second pixel of 4 x 4,
 * and of the others where none of them is interpolated. No result depends on it but for rounding, for corners of
 * samples beside the kernel, and with 3X3, whose pixels are classified in blocks of their own, for the shortcuts that
 * classification takes (docs/numerics.md, section 8). */
typedef enum softsh_packet {
    SOFTSH_PACKET_DEFAULT = 0, /* what is fast on this kind of device: 4X4 on CPUs, 1X1 elsewhere */
    SOFTSH_PACKET_1X1 = 1,
    SOFTSH_PACKET_2X2 = 2,
    SOFTSH_PACKET_3X3 = 3,
    SOFTSH_PACKET_4X4 = 4,
    SOFTSH_PACKET_ADAPTIVE = 5 /* 4 x 4, 2 x 2 or single pixels, chosen for each part of the image */
} softsh_packet;

/* What decides whether a packet pays, Yang et al. 2009. They change times only. */
typedef struct softsh_packet_cost {
    /* Relative costs, equation 6: of a sample or block looked at, of an edge of the contour, of an edge's projection
     * for one pixel. 0 to 1e6 each; all zero: what was measured on this kind of device. */
    float node, edge, projection;
    /* Packets whose pixels are likelier not to have one contour (equation 5) are evaluated apart: 0 to 1, 1: none; 0:
     * this kind of device's. */
    float divergence;
} softsh_packet_cost;

/* How contours are searched for; contour only. No result depends on it but for the order of sums. */
typedef enum softsh_search {
    SOFTSH_SEARCH_DEFAULT = 0, /* strips */
    SOFTSH_SEARCH_STRIPS = 1,  /* blocks of 4 x 4 samples, then samples, of all of the kernel */
    SOFTSH_SEARCH_WALK = 2     /* down a hierarchy from the node that spans the kernel, Yang et al. 2009, section 4.2;
                                  for sampled depth, on occluders with `dual_grids` */
} softsh_search;

typedef struct softsh_settings {
    uint32_t struct_size;
    softsh_technique technique;
    softsh_pattern pattern;
    softsh_primitive primitive;
    softsh_aggregation aggregation;
    softsh_merge merge;
    uint32_t budget;        /* about budget x budget micro-occluders per layer and pixel; 0 and large numbers:
                               240 x 240 micropatches, 160 x 160 microquads or 128 x 128 samples of contours (96 x 96
                               with their backs), shared by the layers; at most 4096 */
    uint32_t min_level;     /* never evaluate below this level; 0 to 13; for comparisons */
    uint32_t filter_passes; /* post filter of section 3.1, 0 to 16; bitmask only */
    uint32_t sparse;        /* nonzero: evaluate every second pixel of every second row, and of the rest those whose
                               neighbours differ or lie on other surfaces; interpolate the others. Ignored with
                               filter_passes */
    softsh_packet packet;   /* contour only */
    softsh_packet_cost packet_cost;       /* contour only; `softshadow-bench tune` measures it */
    softsh_reconstruction reconstruction; /* contour only; other than joined: for sampled depth, on occluders
                                             without `no_folds`, and cut apart without packets */
    softsh_search search;                 /* contour only, and joined */
    uint32_t outline; /* nonzero: of microquads that cannot fold, only the outline of all of them is projected; the
                         result is the same. For area and bitmask, microquads, sampled depth and patterns up to
                         16 x 16, without filter_passes, not on occluders with `no_folds`; contour ignores it */
    uint32_t no_refinement; /* nonzero: keep to the budget's level also where something in the kernel is thinner than
                               the distance of its samples, and perhaps lose its shadow. By default such pixels are
                               evaluated one or two levels finer, at four times the work each. Sampled depth only */
    uint32_t no_hierarchy;  /* nonzero: neither prune kernels nor classify; for comparisons */
} softsh_settings;

#ifdef __cplusplus
}
#endif

#endif
