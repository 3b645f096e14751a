// World normal towards the viewer, and albedo.
#version 460

layout(push_constant) uniform Constants {
    mat4 mesh_to_clip;
    vec4 eye;
    float depth_sign;
    float depth_step;
};

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 colour;

layout(location = 0) out vec4 out_normal;
layout(location = 1) out vec4 out_albedo;

void main()
{
    // Meshes may be wound either way, so the triangle's own plane decides which side is seen, and the interpolated
    // normal follows it.
    vec3 to_viewer = eye.xyz - position * eye.w;
    vec3 plane = cross(dFdx(position), dFdy(position));
    plane = dot(plane, to_viewer) < 0.0 ? -plane : plane;
    vec3 n = dot(normal, normal) > 0.0 ? normalize(normal) : normalize(plane);
    out_normal = vec4(dot(n, plane) < 0.0 ? -n : n, 1.0);
    out_albedo = vec4(colour, 1.0);
}
