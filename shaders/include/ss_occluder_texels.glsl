// Fan depths and ranges where they are read: texel buffers, because some drivers read those several times as fast as storage
// buffers.
#ifndef SS_OCCLUDER_TEXELS_GLSL
#define SS_OCCLUDER_TEXELS_GLSL

layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_DEPTHS) uniform textureBuffer depths;
layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_DEPTH_QUADS) uniform textureBuffer depth_quads;
layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_RANGES) uniform textureBuffer ranges;

layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_BITS) uniform utextureBuffer bits;

// Four fan depths of a row.
vec4 ss_depth_quad_at(uint quad)
{
    return texelFetch(depth_quads, int(quad));
}

float ss_depth_at(uint i)
{
    return texelFetch(depths, int(i)).x;
}

// (farthest, nearest)
vec2 ss_range_at(uint i)
{
    return texelFetch(ranges, int(i)).xy;
}

uint ss_bits_at(uint word)
{
    return texelFetch(bits, int(word)).x;
}

#endif
