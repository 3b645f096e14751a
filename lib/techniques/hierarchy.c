/* Acceleration structures over a map: the min/max pyramid (HSM, Guennebaud et al. 2006), the multi-scale shadow map
 * (MSSM, Schwarz and Stamminger 2007, section 5) and their hybrid (YSM, Schwarz and Stamminger 2008, section 6).
 *
 * The three are one structure here: a full pyramid, and an MSSM over one of its levels (level 0: an MSSM, none: an
 * HSM). Departures: level 0 holds one value per texel instead of a pair; an MSSM has a pyramid beside it, a thirtieth
 * more memory at ten levels, which gives the light's largest kernel, so that levels no kernel asks for are not built.
 */
#include "hierarchy.h"

enum { GROUP_X = 32, GROUP_Y = 4 };

softsh_result softshi_hierarchy_create(softsh_occluders *o)
{
    softshi_specialization constants = {{0}};
    softshi_hierarchy_pipelines *p = &o->pipelines;
    const struct {
        softshi_shader shader;
        uint32_t from_fan_depth;
        softshi_pipeline *pipeline;
    } list[] = {
        {SOFTSHI_SHADER_HIERARCHY_CONVERT, 0, &p->convert}, {SOFTSHI_SHADER_HIERARCHY_SAMPLE, 0, &p->sample},
        {SOFTSHI_SHADER_HIERARCHY_REDUCE, 0, &p->reduce},   {SOFTSHI_SHADER_HIERARCHY_MERGE, 0, &p->merge},
        {SOFTSHI_SHADER_HIERARCHY_PLAN, 0, &p->plan},       {SOFTSHI_SHADER_HIERARCHY_WIDEN, 1, &p->widen_first},
        {SOFTSHI_SHADER_HIERARCHY_WIDEN, 0, &p->widen},     {SOFTSHI_SHADER_HIERARCHY_THIN, 1, &p->thin_first},
        {SOFTSHI_SHADER_HIERARCHY_THIN, 0, &p->thin},       {SOFTSHI_SHADER_HIERARCHY_FOLD, 0, &p->fold},
    };
    for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
        if (list[i].shader == SOFTSHI_SHADER_HIERARCHY_FOLD && !o->folds)
            continue;
        constants.values[SS_SPEC_COUNT] = list[i].from_fan_depth;
        const softsh_result result = softshi_pipeline_create(o->context, list[i].shader, &constants, list[i].pipeline);
        if (result != SOFTSH_SUCCESS)
            return result;
    }
    return SOFTSH_SUCCESS;
}

void softshi_hierarchy_destroy(softsh_occluders *o)
{
    softshi_hierarchy_pipelines *p = &o->pipelines;
    softshi_pipeline *const all[] = {&p->convert,     &p->sample, &p->reduce,     &p->merge, &p->plan,
                                     &p->widen_first, &p->widen,  &p->thin_first, &p->thin,  &p->fold};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        softshi_pipeline_destroy(o->context, all[i]);
}

static uint32_t divide_up(uint32_t a, uint32_t b)
{
    return (a + b - 1) / b;
}

void softshi_hierarchy_record_convert(softshi_recorder *recorder, const softsh_occluders *o, VkExtent2D extent,
                                      const ss_convert_push *push)
{
    const softshi_pass pass = {
        .pipeline = &o->pipelines.convert,
        .reads = SOFTSHI_HEADER,
        /* Layers write different parts and need no order between them. */
        .writes = push->layer == 0 ? SOFTSHI_FAN_DEPTH | SOFTSHI_PYRAMID : 0,
        .groups = {divide_up(extent.width, 4 * GROUP_X), divide_up(extent.height, 4 * GROUP_Y), 1},
        .push = push,
        .push_size = sizeof *push,
    };
    softshi_record_pass(recorder, &pass);
}

void softshi_hierarchy_record_levels(softshi_recorder *recorder, const softsh_occluders *o, VkExtent2D extent,
                                     const softshi_occluder_layout *layout, uint32_t layers)
{
    if (layout->thin_words > 0)
        softshi_record_clear(recorder, SOFTSHI_BITS, o->block.buffer, o->layout.bits.offset,
                             layout->thin_words * sizeof(uint32_t));
    const uint32_t sample_groups = divide_up((uint32_t)layout->layer_quads - layout->quads[1], SS_SAMPLE_GROUP);
    const softshi_pass sample = {
        .pipeline = &o->pipelines.sample,
        .reads = SOFTSHI_HEADER,
        .writes = SOFTSHI_FAN_DEPTH,
        .groups = {sample_groups < SS_DISPATCH_WIDTH ? sample_groups : SS_DISPATCH_WIDTH,
                   divide_up(sample_groups, SS_DISPATCH_WIDTH), layers},
    };
    softshi_record_pass(recorder, &sample);
    if (o->folds) {
        const uint32_t fold_groups = divide_up((uint32_t)layout->layer_fold_words, SS_SAMPLE_GROUP);
        const softshi_pass fold = {
            .pipeline = &o->pipelines.fold,
            .reads = SOFTSHI_HEADER | SOFTSHI_FAN_DEPTH,
            .writes = SOFTSHI_BITS,
            .groups = {fold_groups < SS_DISPATCH_WIDTH ? fold_groups : SS_DISPATCH_WIDTH,
                       divide_up(fold_groups, SS_DISPATCH_WIDTH), layers},
        };
        softshi_record_pass(recorder, &fold);
    }
    for (uint32_t level = 3; level <= layout->top; level += 2) {
        const ss_level_push push = {.level = level};
        const softshi_pass pass = {
            .pipeline = &o->pipelines.reduce,
            .reads = SOFTSHI_HEADER,
            .writes = SOFTSHI_PYRAMID,
            .groups = {divide_up(softshi_level_size(extent.width, level + 1), GROUP_X),
                       divide_up(softshi_level_size(extent.height, level + 1), GROUP_Y), layers},
            .push = &push,
            .push_size = sizeof push,
        };
        softshi_record_pass(recorder, &pass);
    }
    if (layers > 1) {
        const uint32_t groups = divide_up((uint32_t)layout->pyramid_texels, SS_SAMPLE_GROUP);
        const softshi_pass merge = {
            .pipeline = &o->pipelines.merge,
            .reads = SOFTSHI_HEADER,
            .writes = SOFTSHI_PYRAMID,
            .groups = {groups < SS_DISPATCH_WIDTH ? groups : SS_DISPATCH_WIDTH, divide_up(groups, SS_DISPATCH_WIDTH),
                       1},
        };
        softshi_record_pass(recorder, &merge);
    }
    const softshi_pass plan = {
        .pipeline = &o->pipelines.plan,
        .reads = SOFTSHI_PYRAMID,
        /* Both are one uniform to the other passes. */
        .writes = SOFTSHI_PLAN | SOFTSHI_HEADER,
        .groups = {1, 1, 1},
    };
    softshi_record_pass(recorder, &plan);
    for (uint32_t later = 0; later < 2 && layout->thin_words > 0; later++) {
        /* Level 1, then all others, of which the last two have one group of blocks each. */
        const uint32_t lanes = later == 0 ? softshi_level_size(extent.width, 3) * softshi_level_size(extent.height, 3)
                               : layout->top < 4 ? 2
                                                 : (uint32_t)layout->pyramid_texels - layout->offsets[4] + 2;
        const uint32_t groups = divide_up(lanes, SS_SAMPLE_GROUP);
        const softshi_pass thin = {
            .pipeline = later ? &o->pipelines.thin : &o->pipelines.thin_first,
            /* Of the ranges only the pyramid, but all of them are one view. */
            .reads = SOFTSHI_HEADER | SOFTSHI_FAN_DEPTH | SOFTSHI_PYRAMID | SOFTSHI_WIDE | SOFTSHI_DUAL,
            .writes = SOFTSHI_BITS,
            .groups = {groups < SS_DISPATCH_WIDTH ? groups : SS_DISPATCH_WIDTH, divide_up(groups, SS_DISPATCH_WIDTH),
                       1},
        };
        softshi_record_pass(recorder, &thin);
    }
    for (uint32_t level = 1; level <= layout->wide_levels; level++) {
        const ss_level_push push = {.level = level};
        const softshi_pass pass = {
            .pipeline = level == 1 && layout->join == 0 ? &o->pipelines.widen_first : &o->pipelines.widen,
            .reads = SOFTSHI_HEADER | SOFTSHI_PLAN | SOFTSHI_FAN_DEPTH | SOFTSHI_PYRAMID,
            .writes = SOFTSHI_WIDE,
            .push = &push,
            .push_size = sizeof push,
            .indirect = o->block.buffer,
            .indirect_offset = o->layout.header.offset + sizeof(ss_occluders) + offsetof(ss_plan, args) +
                               (level - 1) * sizeof(ss_uvec4),
        };
        softshi_record_pass(recorder, &pass);
    }
}
