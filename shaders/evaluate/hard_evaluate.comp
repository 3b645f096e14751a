#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
// A light without extent: one texel per layer, compared with the receiver's plane at the texel's centre.
#include "ss_types.h"
#include "ss_specialization.glsl"
#include "ss_occluder_bindings.glsl"
#include "ss_io_bindings.glsl"
#include "ss_receiver.glsl"
#include "ss_range.glsl"
#include "ss_kernel.glsl"
#include "ss_sample.glsl"

layout(local_size_x = SS_TILE_X, local_size_y = SS_TILE_Y) in;

void main()
{
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, frame.area.zw)))
        return;
    const ss_receiver r = ss_load_receiver(pixel);
    bool dark = r.valid && r.away;
    const ivec2 texel = ivec2(clamp(floor(r.uv), vec2(0.0), vec2(occ.size.xy) - 1.0));
    const vec2 to_centre = vec2(texel) + 0.5 - r.uv;
    const float planar = r.g + dot(r.gradient, to_centre) + r.eta + 0.5 * (abs(r.gradient.x) + abs(r.gradient.y));
    const float g = (ss_flags & SS_FLAG_OVERRIDE_BIAS) != 0u ? ss_shifted(r.g) : planar;
    for (uint layer = 0u; layer < ss_layers(); layer++) {
        const float occluder = ss_sample_depth(ss_load_grid(layer, 0u), texel);
        dark = dark || (r.valid && occluder > g && occ.light.w - occ.light.z * occluder > 0.0);
    }
    ss_write_visibility(pixel, dark ? 0.0 : 1.0);
    if (SS_STATS) {
        ss_count(SS_STAT_PIXELS, 1u);
        ss_count(dark ? SS_STAT_UMBRA : SS_STAT_LIT, 1u);
    }
}
