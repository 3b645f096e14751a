// The occluders' descriptor set, as every pass but the pyramid builders reads it.
#ifndef SS_OCCLUDER_BINDINGS_GLSL
#define SS_OCCLUDER_BINDINGS_GLSL

#include "ss_occluder_texels.glsl"

layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_OCCLUDERS, std140) uniform ss_occluders_buffer
{
    ss_occluders occ;
    ss_plan plan;
};

// Plus an index that is always 0 but that no compiler sees through: the software driver compiles a shader anew for every dispatch,
// in 10 ms, if a branch or the end of a loop depends on uniforms alone.
uint ss_layers()
{
    return SS_LAYERED ? occ.size.z + gl_WorkGroupID.z : 1u;
}

#endif
