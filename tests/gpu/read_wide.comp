#version 460
#extension GL_EXT_samplerless_texture_functions : require
// The library's image of wide levels has no transfer usage: texels one by one into a buffer, layer after layer.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform texture2DArray wide;
layout(set = 0, binding = 1, std430) writeonly buffer texels
{
    vec2 texel[];
};
layout(push_constant) uniform size
{
    uint width, height, layers;
};

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i < width * height * layers)
        texel[i] = texelFetch(wide, ivec3(i % width, i / width % height, i / (width * height)), 0).xy;
}
