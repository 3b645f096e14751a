/* From the public settings to specialization constants. */
#ifndef SOFTSHI_SETTINGS_H
#define SOFTSHI_SETTINGS_H

#include <stdbool.h>

#include "vulkan/pipeline.h"

/* Settings with every default filled in, for CPUs (`software`) or GPUs; NULL gives the automatic ones. */
softsh_settings softshi_settings_resolve(const softsh_settings *settings, bool software);

/* What one invocation of each list's evaluation pass takes. */
typedef struct softshi_packets {
    uint32_t side[SS_LISTS]; /* pixels a side; 0: the list is not used */
    uint32_t block;          /* pixels a side of the blocks they are classified in; 1: one by one */
    bool split;              /* large packets that are not of one contour go on as small ones */
} softshi_packets;

/* Whether contours are cut apart where surfaces are. */
bool softshi_settings_separate(const softsh_settings *settings);
/* Whether evaluation asks which cells fold. */
bool softshi_settings_need_folds(const softsh_settings *settings);

/* Whether the technique evaluates packets of pixels (or blocks of them one by one). */
bool softshi_settings_in_packets(const softsh_settings *settings);
softshi_packets softshi_settings_packets(const softsh_settings *settings);

/* Constants for the passes of a view. */
softshi_specialization softshi_settings_specialize(const softsh_settings *settings, bool normals, bool stats);

/* Whether the settings' micro-occluders need a light whose axes run along the map's. */
bool softshi_settings_need_alignment(const softsh_settings *settings);

#endif
