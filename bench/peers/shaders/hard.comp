/* A hard shadow: one texel of the map against the receiver's plane. */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

#include "receiver.glsl"

layout(local_size_x_id = 0, local_size_y_id = 1) in;

void main()
{
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    const ivec2 size = imageSize(visibility);

    if (any(greaterThanEqual(pixel, size)))
        return;
    const receiver r = receiver_at(pixel, size);
    float depth;
    const bool dark = r.valid && blocks(r, r.uv, map_limit(), depth);
    imageStore(visibility, pixel, vec4(dark ? 0.0 : 1.0));
}
