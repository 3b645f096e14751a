#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
// Reads the camera depth once, writes every pixel lit, and keeps what classify_tiles needs to bound a tile's receivers: per
// column of 8 pixels its first and last depth, and how far the receivers between them leave the line through both.
#include "ss_types.h"
#include "ss_specialization.glsl"
#include "ss_occluder_bindings.glsl"
#include "ss_io_bindings.glsl"
#include "ss_receiver.glsl"

layout(local_size_x = 64) in;

void main()
{
    // One lane per column; a render area cut inside a tile visits its last pixels again.
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= frame.tiles.x * SS_TILE_X)
        return;
    const ivec2 first = ivec2(at.x, at.y * SS_TILE_Y), end = frame.area.zw - 1;
    float depth[SS_TILE_Y];
    bool receiver[SS_TILE_Y];
    for (int y = 0; y < SS_TILE_Y; y++) {
        const ivec2 pixel = frame.area.xy + min(first + ivec2(0, y), end);
        const float d = texelFetch(camera_depth, pixel, 0).x;
        ss_write_visibility(pixel - frame.area.xy, 1.0);
        receiver[y] = ss_is_receiver(d);
        depth[y] = receiver[y] ? clamp(d, 0.0, 1.0) : frame.camera.x;
    }
    const float slope = (depth[SS_TILE_Y - 1] - depth[0]) * (1.0 / float(SS_TILE_Y - 1));
    vec2 residual = vec2(3e38, -3e38);
    for (int y = 0; y < SS_TILE_Y; y++) {
        const float r = depth[y] - (depth[0] + slope * float(y));
        residual.x = receiver[y] ? min(residual.x, r) : residual.x;
        residual.y = receiver[y] ? max(residual.y, r) : residual.y;
    }
    const uint slot = ss_column_slot(at.y * frame.tiles.x + at.x / SS_TILE_X, at.x % SS_TILE_X);
    tiles[slot] = floatBitsToUint(depth[0]);
    tiles[slot + 1u] = floatBitsToUint(depth[SS_TILE_Y - 1]);
    tiles[slot + 2u] = floatBitsToUint(residual.x);
    tiles[slot + 3u] = floatBitsToUint(residual.y);
}
