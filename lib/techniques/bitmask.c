/* Bitmask Soft Shadows (Schwarz and Stamminger 2007) and area accumulation (Guennebaud et al. 2006): one evaluation
 * pass over the active pixels; pattern, primitive and budget are specialization constants and parameters of its shader.
 */
#include "techniques.h"

softsh_result softshi_bitmask_create(softsh_view *view, int kind, const softshi_specialization *constants)
{
    return softshi_pipeline_create(view->context, SOFTSHI_SHADER_BITMASK_EVALUATE, constants,
                                   &view->pipelines.evaluate[kind]);
}
