// The occluders' descriptor set, as every pass but the pyramid builders reads it.
#ifndef SS_OCCLUDER_BINDINGS_GLSL
#define SS_OCCLUDER_BINDINGS_GLSL

#include "ss_occluder_texels.glsl"

layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_OCCLUDERS, std140) uniform ss_occluders_buffer
{
    ss_occluders occ;
    ss_plan plan;
};

uint ss_layers()
{
    return SS_LAYERED ? occ.size.z : 1u;
}

#endif
