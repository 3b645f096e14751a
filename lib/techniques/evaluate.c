/* The evaluation passes, and the interpolation between their two rounds: every second pixel of every second row first,
 * then those between them whose neighbours do not tell enough (after Guennebaud et al. 2007). */
#include "settings.h"
#include "techniques.h"

static void record_list(const softshi_visibility *visibility, uint32_t round, uint32_t list, uint32_t stride)
{
    const softsh_view *view = visibility->view;
    const softshi_view_pipelines *pipelines = &view->pipelines;
    const bool layered = visibility->occluders->layered && pipelines->evaluate_layered.handle;
    const ss_evaluate_push push = {.round = round, .stride = stride};
    const softshi_pass evaluate = {
        .pipeline = layered ? &pipelines->evaluate_layered : &pipelines->evaluate[list],
        .reads = SOFTSHI_HIERARCHY | SOFTSHI_FRAME,
        /* Packets append to the lists that come after theirs. */
        .writes = SOFTSHI_CONTROL | SOFTSHI_TILES | SOFTSHI_FILTER | SOFTSHI_VISIBILITY,
        .push = &push,
        .push_size = sizeof push,
        .indirect = view->block.buffer,
        .indirect_offset = view->layout.control.offset + offsetof(ss_control, evaluate_args) +
                           (SS_LISTS * round + list) * sizeof(ss_uvec4),
    };
    softshi_record_pass(visibility->recorder, &evaluate);
}

void softshi_evaluate_record(const softshi_visibility *visibility, uint32_t round)
{
    const softsh_settings *settings = &visibility->view->settings;
    const softshi_packets packets = softshi_settings_packets(settings);
    /* Packets of every second pixel are those of the small list. */
    const bool lattice = settings->sparse && round == 0;
    if (packets.side[SS_LIST_LARGE] && !lattice)
        record_list(visibility, round, SS_LIST_LARGE, 1);
    if (packets.side[SS_LIST_SMALL] && (lattice || !settings->sparse || packets.split))
        record_list(visibility, round, SS_LIST_SMALL, lattice ? 2 : 1);
    record_list(visibility, round, SS_LIST_PIXELS, 1);
}

softsh_result softshi_interpolate_create(softsh_view *view, const softshi_specialization *constants)
{
    const bool blocks = softshi_settings_in_packets(&view->settings);
    return softshi_pipeline_create(view->context,
                                   blocks ? SOFTSHI_SHADER_INTERPOLATE_BLOCKS : SOFTSHI_SHADER_INTERPOLATE, constants,
                                   &view->pipelines.interpolate);
}

void softshi_interpolate_record(const softshi_visibility *visibility)
{
    const softsh_view *view = visibility->view;
    const softshi_pass interpolate = {
        .pipeline = &view->pipelines.interpolate,
        .reads = SOFTSHI_HIERARCHY | SOFTSHI_FRAME | SOFTSHI_FILTER,
        .writes = SOFTSHI_CONTROL | SOFTSHI_TILES | SOFTSHI_VISIBILITY,
        .indirect = view->block.buffer,
        .indirect_offset = view->layout.control.offset + offsetof(ss_control, interpolate_args),
    };
    softshi_record_pass(visibility->recorder, &interpolate);
}
