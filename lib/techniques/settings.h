/* From the public settings to specialization constants. */
#ifndef SOFTSHI_SETTINGS_H
#define SOFTSHI_SETTINGS_H

#include "vulkan/pipeline.h"

/* Settings with every default filled in; NULL gives the automatic ones. */
softsh_settings softshi_settings_resolve(const softsh_settings *settings);

/* Constants for the passes of a view. */
softshi_specialization softshi_settings_specialize(const softsh_settings *settings, bool normals, bool stats);

/* Whether the settings' micro-occluders need a light whose axes run along the map's. */
bool softshi_settings_need_alignment(const softsh_settings *settings);

#endif
