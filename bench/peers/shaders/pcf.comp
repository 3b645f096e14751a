/* Percentage-closer filtering (Reeves, Salesin and Cook: Rendering Antialiased Shadows with Depth Maps, 1987) with a
 * kernel of one world size, the light's shape scaled: soft everywhere alike, wrong wherever blockers are nearer or
 * farther than the kernel assumes. */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

#include "receiver.glsl"
#include "taps.glsl"

layout(local_size_x_id = 0, local_size_y_id = 1) in;
layout(constant_id = 3) const int filter_taps = 32;

void main()
{
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    const ivec2 size = imageSize(visibility);

    if (any(greaterThanEqual(pixel, size)))
        return;
    const receiver r = receiver_at(pixel, size);
    const vec2 limit = map_limit();
    const float height = params.reach * mix(1.0, r.g, params.perspective);
    const mat2 extent = light_extent(r, height);
    const vec2 centre = light_centre(r, height);
    /* A trip count, not a branch: some drivers run both sides of every branch. */
    const int taps = r.valid ? filter_taps : 0;
    vec2 turn = vec2(1.0, 0.0);
    float dark = 0.0;

    for (int i = 0; i < taps; i++) {
        float depth;
        dark += blocks(r, centre + extent * next_tap(i, filter_taps, turn), limit, depth) ? 1.0 : 0.0;
    }
    imageStore(visibility, pixel, vec4(r.valid ? 1.0 - dark / float(filter_taps) : 1.0));
}
