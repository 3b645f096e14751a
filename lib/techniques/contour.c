/* Contours by marching squares, integrated on the light (Guennebaud et al. 2007), for packets of pixels (Yang et al.
 * 2009): one shader, made once for each size of packet and for single pixels. */
#include "settings.h"
#include "techniques.h"

softsh_result softshi_contour_create(softsh_view *view, const softshi_specialization *constants)
{
    const softshi_packets packets = softshi_settings_packets(&view->settings);
    softsh_result result = SOFTSH_SUCCESS;
    for (int list = 0; list < SS_LISTS && result == SOFTSH_SUCCESS; list++) {
        softshi_specialization own = *constants;
        own.values[SS_SPEC_PACKET] = packets.side[list];
        own.values[SS_SPEC_SPLIT] = list == SS_LIST_LARGE && packets.split;
        if (packets.side[list])
            result = softshi_pipeline_create(view->context, SOFTSHI_SHADER_CONTOUR_EVALUATE, &own,
                                             &view->pipelines.evaluate[list]);
    }
    return result;
}
