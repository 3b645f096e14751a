// The occluders' descriptor set, as every pass but the pyramid builders reads it.
#ifndef SS_OCCLUDER_BINDINGS_GLSL
#define SS_OCCLUDER_BINDINGS_GLSL

layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_OCCLUDERS, std140) uniform ss_occluders_buffer
{
    ss_occluders occ;
    ss_plan plan;
};
layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_FAN_DEPTH, std430) readonly buffer ss_fan_depth_buffer
{
    float fan_depth[];
};
layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_RANGES, std430) readonly buffer ss_ranges_buffer
{
    vec2 ranges[];
};

uint ss_layers()
{
    return SS_LAYERED ? occ.size.z : 1u;
}

#endif
