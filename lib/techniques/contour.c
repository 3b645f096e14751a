/* Contours by marching squares, integrated on the light (Guennebaud et al. 2007; Yang et al. 2009): another pipeline
 * for the evaluation pass. */
#include "techniques.h"

softsh_result softshi_contour_create(softsh_view *view, int kind, const softshi_specialization *constants)
{
    return softshi_pipeline_create(view->context, SOFTSHI_SHADER_CONTOUR_EVALUATE, constants,
                                   &view->pipelines.evaluate[kind]);
}
