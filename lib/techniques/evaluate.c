/* The evaluation pass, and the interpolation between its two rounds: every second pixel of every second row first, then
 * those between them whose neighbours do not tell enough (after Guennebaud et al. 2007). */
#include "techniques.h"

void softshi_evaluate_record(const softshi_visibility *visibility, uint32_t round)
{
    const softsh_view *view = visibility->view;
    const ss_evaluate_push push = {.round = round};
    const softshi_pass evaluate = {
        .pipeline = &view->pipelines.evaluate[visibility->kind],
        .reads = SOFTSHI_HIERARCHY | SOFTSHI_FRAME | SOFTSHI_TILES,
        .writes = SOFTSHI_CONTROL | SOFTSHI_FILTER | SOFTSHI_VISIBILITY,
        .push = &push,
        .push_size = sizeof push,
        .indirect = view->block.buffer,
        .indirect_offset = view->layout.control.offset + offsetof(ss_control, evaluate_args) + round * sizeof(ss_uvec4),
    };
    softshi_record_pass(visibility->recorder, &evaluate);
}

softsh_result softshi_interpolate_create(softsh_view *view, const softshi_specialization *constants)
{
    return softshi_pipeline_create(view->context, SOFTSHI_SHADER_INTERPOLATE, constants, &view->pipelines.interpolate);
}

void softshi_interpolate_record(const softshi_visibility *visibility)
{
    const softsh_view *view = visibility->view;
    const softshi_pass interpolate = {
        .pipeline = &view->pipelines.interpolate,
        .reads = SOFTSHI_HEADER | SOFTSHI_FRAME | SOFTSHI_FILTER,
        .writes = SOFTSHI_CONTROL | SOFTSHI_TILES | SOFTSHI_VISIBILITY,
        .indirect = view->block.buffer,
        .indirect_offset = view->layout.control.offset + offsetof(ss_control, interpolate_args),
    };
    softshi_record_pass(visibility->recorder, &interpolate);
}
