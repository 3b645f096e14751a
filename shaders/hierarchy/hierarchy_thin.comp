#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
// What samples of a level may miss: blocks of texels with something in front of all squares of a block's side that lie about
// them. A bit for the block's level in the word of its texel of the pyramid, from level 2 on, and of all texels above that.
// docs/numerics.md, section 5. Of all layers together; one lane per texel of the pyramid; the words are zero before.
#include "ss_types.h"
#include "ss_occluder_texels.glsl"

layout(local_size_x = SS_SAMPLE_GROUP) in;

layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_OCCLUDERS, std140) uniform ss_occluders_buffer
{
    ss_occluders occ;
};
layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_MADE_BITS, r32ui) uniform uimageBuffer made_bits;

// Six texels of a row of the level below, half a block's side wide each: the farthest in each, of the layer where it is nearest.
float[6] covered_below(ivec2 at, uint below)
{
    const ivec2 last = (ivec2(occ.size.xy) + (1 << below) - 1 >> below) - 1;
    const bool of_depths = below == 0u;
    const uint row = of_depths ? 4u * occ.pyramid[0].w : occ.pyramid[below].y;
    uint first = uint(clamp(at.y, 0, last.y)) * row + (of_depths ? 4u * occ.pyramid[0].z : occ.pyramid[below].x);
    float g[6] = float[6](-3e38, -3e38, -3e38, -3e38, -3e38, -3e38);
    for (uint layer = 0u; layer < occ.size.z; layer++) {
        [[unroll]] for (int i = 0; i < 6; i++) {
            const uint x = first + uint(clamp(at.x + i, 0, last.x));
            g[i] = max(g[i], of_depths ? ss_depth_at(x) : ss_range_at(x).x);
        }
        first += of_depths ? 4u * occ.strides.x : occ.strides.y;
    }
    return g;
}

// The nearest of the squares of a block's side that half blocks make, in the block and around it.
float nearest_square(ivec2 block, uint level)
{
    const ivec2 corner = 2 * block - 2;
    float under[6] = covered_below(corner, level - 1u);
    float nearest = -3e38;
    for (int y = 1; y < 6; y++) {
        const float here[6] = covered_below(corner + ivec2(0, y), level - 1u);
        [[unroll]] for (int x = 0; x < 5; x++)
            nearest = max(nearest, min(min(under[x], under[x + 1]), min(here[x], here[x + 1])));
        under = here;
    }
    return nearest;
}

void main()
{
    const uint texel = (gl_WorkGroupID.y * SS_DISPATCH_WIDTH + gl_WorkGroupID.x) * SS_SAMPLE_GROUP + gl_LocalInvocationIndex;
    if (texel >= occ.strides.y)
        return;
    uint level = 1u;
    while (level < occ.levels.x && texel >= occ.pyramid[level + 1u].x)
        level++;
    const uint at = texel - occ.pyramid[level].x, y = at / occ.pyramid[level].y;
    const ivec2 block = ivec2(at - y * occ.pyramid[level].y, y);
    const vec2 range = ss_range_at(occ.size.w * occ.strides.y + texel);
    const float nearest = occ.light.z > 0.0 ? min(range.y, occ.light.w / occ.light.z) : range.y;
    // Steps in fan depth over which a kernel grows to two samples.
    const float reach = max(abs(occ.a.x) + abs(occ.a.y), abs(occ.a.z) + abs(occ.a.w));
    const float step = max(occ.light.w - occ.light.z * nearest, 0.0) * float(1u << level);
    // The block itself is such a square: most of them need no look around.
    if (!((nearest - range.x) * reach > step))
        return;
    if (!((nearest - nearest_square(block, level)) * reach > step))
        return;
    for (uint above = max(level, 2u); above <= occ.levels.x; above++) {
        const ivec2 to = block >> int(above - level);
        imageAtomicOr(made_bits, int(occ.pyramid[above].x - occ.pyramid[2].x + uint(to.y) * occ.pyramid[above].y) + to.x, 1u << level);
    }
}
