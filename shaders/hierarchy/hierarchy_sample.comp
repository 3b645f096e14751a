#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
// Every level's sampled fan depths from level 0, of all layers: the texel in the middle of each block. Next to each other, so
// that four of a row are one fetch. One lane per quad of a level above 0.
#include "ss_types.h"
#include "ss_occluder_texels.glsl"

layout(local_size_x = SS_SAMPLE_GROUP) in;

layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_OCCLUDERS, std140) uniform ss_occluders_buffer
{
    ss_occluders occ;
};
layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_MADE_DEPTH) uniform writeonly imageBuffer made_depth;

void main()
{
    const uint quad = occ.pyramid[1].z +
                      (gl_WorkGroupID.y * SS_DISPATCH_WIDTH + gl_WorkGroupID.x) * SS_SAMPLE_GROUP + gl_LocalInvocationIndex;
    if (quad >= occ.strides.x)
        return;
    uint level = 1u;
    while (level < occ.levels.x && quad >= occ.pyramid[level + 1u].z)
        level++;
    const uint at = quad - occ.pyramid[level].z, row = at / occ.pyramid[level].w, x = 4u * (at - row * occ.pyramid[level].w);
    const uint half_block = 1u << (level - 1u), layer = gl_GlobalInvocationID.z * occ.strides.x;
    const uint from = layer + occ.pyramid[0].z + min((row << level) + half_block, occ.size.y - 1u) * occ.pyramid[0].w;
    vec4 g;
    for (uint i = 0u; i < 4u; i++)
        g[i] = ss_depth_at(4u * from + min((x + i << level) + half_block, occ.size.x - 1u));
    imageStore(made_depth, int(layer + quad), g);
}
