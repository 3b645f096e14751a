/* The mean of many hard shadows (Brotman and Badler: Generating Soft Shadows with a Depth Buffer Algorithm, 1984), the
 * reference of most papers on soft shadows: each dispatch adds the shadow map of one point of the light. */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

#define PEER_ACCUMULATES
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
    /* Counts are whole numbers, so that what every map lights is exactly 1. */
    const float lit = round(imageLoad(visibility, pixel).x * params.map_count);
    imageStore(visibility, pixel, vec4((lit + (dark ? 0.0 : 1.0)) / params.map_count));
}
