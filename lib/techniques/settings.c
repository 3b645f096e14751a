/* From the public settings to specialization constants; what `auto` means. */
#include "settings.h"

/* What `softshadow-bench tune` measured, by class of device; costs are nanoseconds of two CPU cores. A sample of the
 * search is one of four in a vector and does not show beside edges. Of packets of every second pixel it is best on CPUs
 * to count less than half of what projections take: one that is not taken leaves its lane idle between others that are.
 * A GPU (H200) has lanes to spare before it has work to save: there single pixels are fastest, 4 x 4 take five times as
 * long, and costs do not matter. */
static const struct device_class {
    softsh_packet packet;
    softsh_packet_cost cost, sparse_cost;
} device_classes[] = {
    [false] = {SOFTSH_PACKET_1X1, {0.0f, 13.5f, 5.8f, 1.0f}, {0.0f, 13.5f, 5.8f, 1.0f}},
    [true] = {SOFTSH_PACKET_4X4, {0.0f, 13.5f, 5.8f, 1.0f}, {0.0f, 13.5f, 2.7f, 1.0f}},
};

softsh_settings softshi_settings_resolve(const softsh_settings *settings, bool software)
{
    softsh_settings s = {.struct_size = sizeof s};
    if (settings)
        s = *settings;
    if (s.technique == SOFTSH_TECHNIQUE_AUTO)
        s = (softsh_settings){.struct_size = sizeof s,
                              .technique = SOFTSH_TECHNIQUE_CONTOUR,
                              .reconstruction = SOFTSH_RECONSTRUCTION_BACKS,
                              .budget = 32,
                              .sparse = 1};
    const struct device_class *device = &device_classes[software];
    if (s.packet == SOFTSH_PACKET_DEFAULT)
        s.packet = device->packet;
    const softsh_packet_cost *cost = s.sparse ? &device->sparse_cost : &device->cost;
    if (s.packet_cost.divergence == 0.0f)
        s.packet_cost.divergence = cost->divergence;
    if (s.packet_cost.node == 0.0f && s.packet_cost.edge == 0.0f && s.packet_cost.projection == 0.0f) {
        s.packet_cost.node = cost->node;
        s.packet_cost.edge = cost->edge;
        s.packet_cost.projection = cost->projection;
    }
    if (s.pattern == SOFTSH_PATTERN_DEFAULT)
        s.pattern = SOFTSH_PATTERN_16X16_JITTERED;
    if (s.primitive == SOFTSH_PRIMITIVE_DEFAULT)
        s.primitive = SOFTSH_PRIMITIVE_MICROQUAD;
    if (s.aggregation == SOFTSH_AGGREGATION_DEFAULT)
        s.aggregation = SOFTSH_AGGREGATION_SAMPLED;
    if (s.reconstruction == SOFTSH_RECONSTRUCTION_DEFAULT)
        s.reconstruction = SOFTSH_RECONSTRUCTION_JOINED;
    if (s.merge == SOFTSH_MERGE_DEFAULT)
        s.merge = s.technique == SOFTSH_TECHNIQUE_BITMASK ? SOFTSH_MERGE_UNION : SOFTSH_MERGE_MAXIMUM;
    if (s.technique != SOFTSH_TECHNIQUE_BITMASK)
        s.filter_passes = 0;
    if (s.technique == SOFTSH_TECHNIQUE_CONTOUR)
        s.outline = 0;
    if (s.technique != SOFTSH_TECHNIQUE_CONTOUR || s.reconstruction != SOFTSH_RECONSTRUCTION_JOINED ||
        s.search == SOFTSH_SEARCH_DEFAULT)
        s.search = SOFTSH_SEARCH_STRIPS;
    if (s.filter_passes > 0)
        s.sparse = 0;
    return s;
}

bool softshi_settings_separate(const softsh_settings *s)
{
    return s->technique == SOFTSH_TECHNIQUE_CONTOUR && (s->reconstruction == SOFTSH_RECONSTRUCTION_FOLDS ||
                                                        s->reconstruction == SOFTSH_RECONSTRUCTION_SECOND_DIFFERENCES);
}

bool softshi_settings_need_folds(const softsh_settings *s)
{
    return s->outline ||
           (s->technique == SOFTSH_TECHNIQUE_CONTOUR && s->reconstruction != SOFTSH_RECONSTRUCTION_JOINED);
}

bool softshi_settings_in_packets(const softsh_settings *s)
{
    return s->technique == SOFTSH_TECHNIQUE_CONTOUR && !softshi_settings_separate(s);
}

softshi_packets softshi_settings_packets(const softsh_settings *s)
{
    softshi_packets p = {.side = {[SS_LIST_PIXELS] = 1}, .block = softshi_settings_in_packets(s) ? 4 : 1};
    if (!softshi_settings_in_packets(s) || s->packet == SOFTSH_PACKET_1X1)
        return p;
    if (s->sparse) {
        /* Every second pixel of every second row of a block, and then the others where none is interpolated. */
        p.side[SS_LIST_SMALL] = 2;
        p.side[SS_LIST_LARGE] = 4;
        p.split = s->packet == SOFTSH_PACKET_2X2;
        return p;
    }
    if (s->packet == SOFTSH_PACKET_2X2) {
        p.side[SS_LIST_SMALL] = 2;
    } else if (s->packet == SOFTSH_PACKET_3X3) {
        p.side[SS_LIST_LARGE] = p.block = 3;
    } else {
        p.side[SS_LIST_LARGE] = 4;
        p.split = s->packet == SOFTSH_PACKET_ADAPTIVE;
        p.side[SS_LIST_SMALL] = p.split ? 2 : 0;
    }
    return p;
}

softshi_specialization softshi_settings_specialize(const softsh_settings *s, bool normals, bool stats)
{
    static const uint32_t sides[] = {[SOFTSH_PATTERN_8X8] = 8,
                                     [SOFTSH_PATTERN_16X16] = 16,
                                     [SOFTSH_PATTERN_16X16_JITTERED] = 16,
                                     [SOFTSH_PATTERN_32X32] = 32};
    static const uint32_t primitives[] = {[SOFTSH_PRIMITIVE_MICROPATCH] = SS_PRIMITIVE_PATCH_EXTENDED,
                                          [SOFTSH_PRIMITIVE_MICROPATCH_UNEXTENDED] = SS_PRIMITIVE_PATCH,
                                          [SOFTSH_PRIMITIVE_MICROQUAD] = SS_PRIMITIVE_QUAD,
                                          [SOFTSH_PRIMITIVE_MICROQUAD_RECTANGLE] = SS_PRIMITIVE_QUAD_RECTANGLE};
    static const uint32_t reconstructions[] = {
        [SOFTSH_RECONSTRUCTION_JOINED] = SS_RECONSTRUCTION_JOINED,
        [SOFTSH_RECONSTRUCTION_FOLDS] = SS_RECONSTRUCTION_FOLDS,
        [SOFTSH_RECONSTRUCTION_SECOND_DIFFERENCES] = SS_RECONSTRUCTION_SECOND_DIFFERENCES,
        [SOFTSH_RECONSTRUCTION_BACKS] = SS_RECONSTRUCTION_BACKS,
    };
    const bool area = s->technique != SOFTSH_TECHNIQUE_BITMASK;
    softshi_specialization c = {{0}};
    c.values[SS_SPEC_PATTERN_SIDE] = area ? 0 : sides[s->pattern];
    c.values[SS_SPEC_JITTERED] = !area && s->pattern == SOFTSH_PATTERN_16X16_JITTERED;
    c.values[SS_SPEC_PRIMITIVE] =
        s->technique == SOFTSH_TECHNIQUE_CONTOUR ? SS_PRIMITIVE_CONTOUR : primitives[s->primitive];
    c.values[SS_SPEC_RECONSTRUCTION] = reconstructions[s->reconstruction];
    c.values[SS_SPEC_SAMPLED] = s->aggregation == SOFTSH_AGGREGATION_SAMPLED;
    c.values[SS_SPEC_MERGE_MAXIMUM] = s->merge == SOFTSH_MERGE_MAXIMUM;
    c.values[SS_SPEC_AREA] = area || s->filter_passes > 0;
    c.values[SS_SPEC_HIERARCHY] = !s->no_hierarchy;
    c.values[SS_SPEC_STATS] = stats;
    c.values[SS_SPEC_FILTER] = s->filter_passes > 0;
    c.values[SS_SPEC_NORMALS] = normals;
    c.values[SS_SPEC_LAYERED] = 1;
    c.values[SS_SPEC_SPARSE] = s->sparse != 0;
    /* The nearest depth of a block misses nothing. */
    c.values[SS_SPEC_REFINE] = s->aggregation == SOFTSH_AGGREGATION_SAMPLED && !s->no_refinement;
    c.values[SS_SPEC_WALK] = s->search == SOFTSH_SEARCH_WALK;
    const softshi_packets packets = softshi_settings_packets(s);
    c.values[SS_SPEC_PACKET] = packets.side[SS_LIST_LARGE]   ? packets.side[SS_LIST_LARGE]
                               : packets.side[SS_LIST_SMALL] ? packets.side[SS_LIST_SMALL]
                                                             : 1;
    c.values[SS_SPEC_BLOCK] = packets.block;
    return c;
}

bool softshi_settings_need_alignment(const softsh_settings *s)
{
    if (s->technique == SOFTSH_TECHNIQUE_CONTOUR)
        return false;
    return s->primitive == SOFTSH_PRIMITIVE_MICROPATCH || s->primitive == SOFTSH_PRIMITIVE_MICROPATCH_UNEXTENDED;
}
