// Keeps only what lies strictly behind the first layer; the depth test then keeps the nearest of it.
#version 460

layout(push_constant) uniform Constants {
    mat4 mesh_to_clip;
    vec4 eye;
    float depth_sign;
    float depth_step;
};

layout(set = 0, binding = 0) uniform sampler2D first_layer;

void main()
{
    float first = texelFetch(first_layer, ivec2(gl_FragCoord.xy), 0).r;
    if (!((gl_FragCoord.z - first) * depth_sign > depth_step))
        discard;
}
