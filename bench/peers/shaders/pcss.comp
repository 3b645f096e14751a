/* Percentage-closer soft shadows (Fernando: Percentage-Closer Soft Shadows, 2005): search blockers in the area the
 * receiver sees the light through, estimate the penumbra from their mean depth by similar triangles, filter over it.
 *
 * Departures, to its advantage: regions have the light's true extents, not a scalar radius; every tap is compared with
 * the receiver's plane at the texel it reads. Depths are averaged as fan depths, in which similar triangles are a
 * subtraction; averaging distances instead changes the error by less than 0.002. */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

#include "receiver.glsl"
#include "taps.glsl"

layout(local_size_x_id = 0, local_size_y_id = 1) in;
layout(constant_id = 2) const int blocker_taps = 16;
layout(constant_id = 3) const int filter_taps = 32;

void main()
{
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    const ivec2 size = imageSize(visibility);

    if (any(greaterThanEqual(pixel, size)))
        return;
    const receiver r = receiver_at(pixel, size);
    const vec2 limit = map_limit();
    const float reach = params.reach - r.g;
    const mat2 search = light_extent(r, reach);
    const vec2 search_centre = light_centre(r, reach);
    /* Trip counts, not branches: some drivers run both sides of every branch. */
    const int searched = r.valid && reach > 0.0 ? blocker_taps : 0;
    vec2 turn = vec2(1.0, 0.0);
    float blockers = 0.0;
    float sum = 0.0;

    for (int i = 0; i < searched; i++) {
        float depth;
        if (blocks(r, search_centre + search * next_tap(i, blocker_taps, turn), limit, depth)) {
            blockers += 1.0;
            sum += depth;
        }
    }

    const bool found = searched > 0 && blockers > 0.0;
    const float mean = params.depth_scale * sum / max(blockers, 1.0) + params.depth_offset;
    const float height = min(mean, params.reach) - r.g;
    const mat2 extent = light_extent(r, height);
    const vec2 centre = light_centre(r, height);
    const int taps = found ? filter_taps : 0;
    float dark = 0.0;

    turn = vec2(1.0, 0.0);
    for (int i = 0; i < taps; i++) {
        float depth;
        dark += blocks(r, centre + extent * next_tap(i, filter_taps, turn), limit, depth) ? 1.0 : 0.0;
    }
    imageStore(visibility, pixel, vec4(found ? 1.0 - dark / float(filter_taps) : 1.0));
}
