/* Lit, umbra or penumbra: first whole tiles, then the pixels, or blocks of pixels, of the tiles that are undecided
 * (search area refinement of Schwarz and Stamminger 2007, section 5; tiles, blocks and compaction are ours). Each stage
 * dispatches the next. */
#include "settings.h"
#include "techniques.h"

softsh_result softshi_classify_create(softsh_view *view, const softshi_specialization *constants)
{
    softsh_result result = softshi_pipeline_create(view->context, SOFTSHI_SHADER_CLASSIFY_COLUMNS, constants,
                                                   &view->pipelines.classify_columns);
    if (result == SOFTSH_SUCCESS)
        result = softshi_pipeline_create(view->context, SOFTSHI_SHADER_CLASSIFY_TILES, constants,
                                         &view->pipelines.classify_tiles);
    if (result == SOFTSH_SUCCESS)
        result = softshi_pipeline_create(view->context,
                                         softshi_settings_in_packets(&view->settings) ? SOFTSHI_SHADER_CLASSIFY_BLOCKS
                                                                                      : SOFTSHI_SHADER_CLASSIFY_PIXELS,
                                         constants, &view->pipelines.classify_pixels);
    return result;
}

void softshi_classify_record(const softshi_visibility *visibility)
{
    const softsh_view *view = visibility->view;
    const softshi_pass columns = {
        .pipeline = &view->pipelines.classify_columns,
        .reads = SOFTSHI_HEADER | SOFTSHI_FRAME,
        .writes = SOFTSHI_TILES | SOFTSHI_VISIBILITY,
        .groups = {(visibility->frame.tiles.x * SS_TILE_X + 63) / 64, visibility->frame.tiles.y, 1},
    };
    softshi_record_pass(visibility->recorder, &columns);
    const softshi_pass tiles = {
        .pipeline = &view->pipelines.classify_tiles,
        .reads = SOFTSHI_HIERARCHY | SOFTSHI_FRAME,
        .writes = SOFTSHI_CONTROL | SOFTSHI_TILES | SOFTSHI_VISIBILITY,
        .groups = {(visibility->frame.tiles.x + 7) / 8, (visibility->frame.tiles.y + 7) / 8, 1},
    };
    softshi_record_pass(visibility->recorder, &tiles);
    const softshi_pass pixels = {
        .pipeline = &view->pipelines.classify_pixels,
        .reads = SOFTSHI_HIERARCHY | SOFTSHI_FRAME,
        .writes = SOFTSHI_CONTROL | SOFTSHI_TILES | SOFTSHI_FILTER | SOFTSHI_VISIBILITY,
        .indirect = view->block.buffer,
        .indirect_offset = view->layout.control.offset + offsetof(ss_control, pixels_args),
    };
    softshi_record_pass(visibility->recorder, &pixels);
}
