/* The path of lights without extent: one comparison per pixel, no classification. */
#include "techniques.h"

softsh_result softshi_hard_create(softsh_view *view, const softshi_specialization *constants)
{
    return softshi_pipeline_create(view->context, SOFTSHI_SHADER_HARD_EVALUATE, constants, &view->pipelines.hard);
}

void softshi_hard_record(const softshi_visibility *visibility)
{
    const softshi_pass pass = {
        .pipeline = &visibility->view->pipelines.hard,
        .reads = SOFTSHI_HIERARCHY | SOFTSHI_FRAME,
        .writes = SOFTSHI_CONTROL | SOFTSHI_VISIBILITY,
        .groups = {visibility->frame.tiles.x, visibility->frame.tiles.y, 1},
    };
    softshi_record_pass(visibility->recorder, &pass);
}
