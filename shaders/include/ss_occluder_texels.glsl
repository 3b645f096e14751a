// Fan depth and ranges where they are read: texel buffers, because some drivers read those several times as fast as storage
// buffers.
#ifndef SS_OCCLUDER_TEXELS_GLSL
#define SS_OCCLUDER_TEXELS_GLSL

layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_FAN_DEPTH_TEXELS) uniform textureBuffer fan_depth_texels;
layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_RANGES_TEXELS) uniform textureBuffer ranges_texels;

float ss_fan_depth_at(uint i)
{
    return texelFetch(fan_depth_texels, int(i)).x;
}

// (farthest, nearest)
vec2 ss_range_at(uint i)
{
    return texelFetch(ranges_texels, int(i)).xy;
}

#endif
