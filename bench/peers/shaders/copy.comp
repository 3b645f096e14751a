/* The floor under every technique: reads the camera depth, writes 1. */
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x_id = 0, local_size_y_id = 1) in;

layout(set = 0, binding = 0) uniform texture2D camera_depth;
layout(set = 0, binding = 2) uniform writeonly image2D visibility;

void main()
{
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);

    if (any(greaterThanEqual(pixel, imageSize(visibility))))
        return;
    /* Lit for every depth, NaN included; the comparison keeps the compiler from dropping the read. */
    imageStore(visibility, pixel, vec4(texelFetch(camera_depth, pixel, 0).x > 2.0 ? 0.0 : 1.0));
}
