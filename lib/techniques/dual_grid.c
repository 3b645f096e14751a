/* Ranges over the dual grid, which a walk for contours goes down (Yang et al. 2009, section 4.2): those of the cells
 * between four samples, then of ever more of them.
 *
 * Departures: every level's samples have a dual grid, since budgets choose levels; nodes begin at their cell instead of
 * being centred, so that a node's children tile it; they are aligned below the join, so that an HSM and a YSM have the
 * form of theirs; and there are no levels so high that one node spans all cells, where a walk may begin but has nothing
 * to ask for. */
#include "dual_grid.h"

softsh_result softshi_dual_grid_create(softsh_occluders *o)
{
    softshi_specialization constants = {{0}};
    softsh_result result =
        softshi_pipeline_create(o->context, SOFTSHI_SHADER_HIERARCHY_DUAL, &constants, &o->pipelines.dual);
    constants.values[SS_SPEC_COUNT] = 1; /* from samples */
    if (result == SOFTSH_SUCCESS)
        result =
            softshi_pipeline_create(o->context, SOFTSHI_SHADER_HIERARCHY_DUAL, &constants, &o->pipelines.dual_first);
    return result;
}

void softshi_dual_grid_destroy(softsh_occluders *o)
{
    softshi_pipeline_destroy(o->context, &o->pipelines.dual_first);
    softshi_pipeline_destroy(o->context, &o->pipelines.dual);
}

void softshi_dual_grid_record(softshi_recorder *recorder, const softsh_occluders *o, VkExtent2D extent,
                              const softshi_occluder_layout *layout, uint32_t layers)
{
    const uint32_t levels = softshi_dual_levels(extent, 0);
    for (uint32_t level = 0; level < levels; level++) {
        const ss_level_push push = {.level = level};
        const uint32_t nodes = layout->duals[level + 1][0] - layout->duals[level][0],
                       groups = (nodes + SS_SAMPLE_GROUP - 1) / SS_SAMPLE_GROUP;
        const softshi_pass pass = {
            .pipeline = level == 0 ? &o->pipelines.dual_first : &o->pipelines.dual,
            /* Wide levels are no part of it, but to those who check they are: one view is of both. */
            .reads = SOFTSHI_HEADER | SOFTSHI_FAN_DEPTH | SOFTSHI_WIDE,
            .writes = SOFTSHI_DUAL,
            .groups = {groups < SS_DISPATCH_WIDTH ? groups : SS_DISPATCH_WIDTH,
                       (groups + SS_DISPATCH_WIDTH - 1) / SS_DISPATCH_WIDTH, layers},
            .push = &push,
            .push_size = sizeof push,
        };
        softshi_record_pass(recorder, &pass);
    }
}
