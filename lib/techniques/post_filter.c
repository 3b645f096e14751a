/* The visibility buffer filter of Schwarz and Stamminger 2007, section 3.1, on undecided tiles. Departure: neighbours
 * that are no receivers are left out. */
#include "techniques.h"

softsh_result softshi_post_filter_create(softsh_view *view, const softshi_specialization *constants)
{
    return softshi_pipeline_create(view->context, SOFTSHI_SHADER_POST_FILTER, constants, &view->pipelines.filter);
}

void softshi_post_filter_record(const softshi_visibility *visibility)
{
    const softsh_view *view = visibility->view;
    for (uint32_t i = 0; i < view->settings.filter_passes; i++) {
        const ss_filter_push push = {.source = i & 1, .last = i + 1 == view->settings.filter_passes};
        const softshi_pass pass = {
            .pipeline = &view->pipelines.filter,
            .reads = SOFTSHI_FRAME | SOFTSHI_CONTROL | SOFTSHI_TILES,
            .writes = SOFTSHI_FILTER | SOFTSHI_VISIBILITY,
            .push = &push,
            .push_size = sizeof push,
            .indirect = view->block.buffer,
            .indirect_offset = view->layout.control.offset + offsetof(ss_control, pixels_args),
        };
        softshi_record_pass(visibility->recorder, &pass);
    }
}
