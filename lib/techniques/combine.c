/* The mean over sub-lights, which cover equal areas of the light (Yang et al. 2009, section 5). */
#include "techniques.h"

softsh_result softshi_combine_create(softsh_view *view, const softshi_specialization *constants)
{
    return softshi_pipeline_create(view->context, SOFTSHI_SHADER_COMBINE_SUBLIGHTS, constants,
                                   &view->pipelines.combine);
}

void softshi_combine_record(const softshi_visibility *visibility)
{
    const softsh_view *view = visibility->view;
    const softshi_sublight *sublight = &visibility->occluders->sublight;
    const uint32_t count = softshi_sublight_count(sublight), index = softshi_sublight_index(sublight);
    const ss_combine_push push = {.first = index == 0, .count = index + 1 == count ? count : 0};
    const softshi_pass pass = {
        .pipeline = &view->pipelines.combine,
        .reads = SOFTSHI_FRAME,
        /* What a sub-light shows is kept where values of other passes are. */
        .writes = SOFTSHI_FILTER | SOFTSHI_VISIBILITY,
        .push = &push,
        .push_size = sizeof push,
        .groups = {visibility->frame.tiles.x, visibility->frame.tiles.y, 1},
    };
    softshi_record_pass(visibility->recorder, &pass);
}
