/* Contours (Guennebaud et al. 2007; Yang et al. 2009) of surfaces cut apart where they are not one: ours. */
#include "settings.h"
#include "techniques.h"

softsh_result softshi_separate_create(softsh_view *view, const softshi_specialization *constants)
{
    softshi_specialization own = *constants;
    /* What finds overlaps. */
    own.values[SS_SPEC_PATTERN_SIDE] = 16;
    own.values[SS_SPEC_JITTERED] = 1;
    return softshi_pipeline_create(view->context, SOFTSHI_SHADER_SEPARATE_EVALUATE, &own,
                                   &view->pipelines.evaluate[SS_LIST_PIXELS]);
}
