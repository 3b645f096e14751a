// Every pass uses this shader, so that all of them compute the same depth for the same matrix: peeling compares depths
// of two passes for equality.
#version 460

layout(push_constant) uniform Constants {
    mat4 mesh_to_clip;
    vec4 eye;         // in mesh space; w is 0 for a direction towards the viewer
    float depth_sign; // 1, or -1 for reversed depth
    float depth_step; // half a step of the first layer's format
};

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec3 in_colour;

layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec3 colour;

invariant gl_Position;

void main()
{
    gl_Position = mesh_to_clip * vec4(in_position, 1.0);
    position = in_position;
    normal = in_normal;
    colour = in_colour;
}
