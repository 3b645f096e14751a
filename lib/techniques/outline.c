/* Microquads by the outline of those that cannot fold and the others one by one: ours, after what contours (Guennebaud
 * et al. 2007; Yang et al. 2009) save and what they lose. */
#include "techniques.h"

softsh_result softshi_outline_create(softsh_view *view, const softshi_specialization *constants)
{
    return softshi_pipeline_create(view->context, SOFTSHI_SHADER_OUTLINE_EVALUATE, constants,
                                   &view->pipelines.evaluate[SS_LIST_PIXELS]);
}
