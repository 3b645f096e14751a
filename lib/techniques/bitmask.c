/* Bitmask Soft Shadows (Schwarz and Stamminger 2007) and area accumulation (Guennebaud et al. 2006): one evaluation
 * pass over the active pixels; pattern, primitive and budget are specialization constants and parameters of its shader.
 */
#include "techniques.h"

softsh_result softshi_bitmask_create(softsh_view *view, const softshi_specialization *constants)
{
    softshi_pipeline *const pipelines[] = {&view->pipelines.evaluate[SS_LIST_PIXELS],
                                           &view->pipelines.evaluate_layered};
    softsh_result result = SOFTSH_SUCCESS;
    for (uint32_t layered = 0; layered < 2 && result == SOFTSH_SUCCESS; layered++) {
        softshi_specialization own = *constants;
        own.values[SS_SPEC_LAYERED] = layered;
        result = softshi_pipeline_create(view->context, SOFTSHI_SHADER_BITMASK_EVALUATE, &own, pipelines[layered]);
    }
    return result;
}
