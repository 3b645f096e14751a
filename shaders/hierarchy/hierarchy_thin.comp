#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
// What samples of a level may miss: blocks of texels with something in front of all squares of a block's side that lie about
// them. A bit for the block's level in the word of its texel of the pyramid, from level 2 on, and of all texels above that.
// docs/numerics.md, section 5. Of all layers together; one lane per 4 x 4 blocks; the words are zero before.
#include "ss_types.h"
#include "ss_occluder_texels.glsl"

layout(local_size_x = SS_SAMPLE_GROUP) in;

layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_OCCLUDERS, std140) uniform ss_occluders_buffer
{
    ss_occluders occ;
};
layout(set = SS_SET_OCCLUDERS, binding = SS_BIND_MADE_BITS, r32ui) uniform uimageBuffer made_bits;
layout(constant_id = SS_SPEC_COUNT) const bool FROM_FAN_DEPTH = false; // level 1, whose half blocks are texels; else all others

// Last texel of a level of the pyramid.
ivec2 last_of(uint level)
{
    return (ivec2(occ.size.xy) + (1 << level) - 1 >> level) - 1;
}

// Six half blocks of a row: the farthest depth in each, of the layer where that is nearest.
float[6] covered_below(ivec2 at, uint below)
{
    const ivec2 last = last_of(below);
    const uint row = FROM_FAN_DEPTH ? 4u * occ.pyramid[0].w : uint(last.x + 1);
    uint first = uint(clamp(at.y, 0, last.y)) * row + (FROM_FAN_DEPTH ? 4u * occ.pyramid[0].z : occ.pyramid[below].x);
    float g[6] = float[6](-3e38, -3e38, -3e38, -3e38, -3e38, -3e38);
    for (uint layer = 0u; layer < occ.size.z; layer++) {
        [[unroll]] for (int i = 0; i < 6; i++) {
            const uint x = first + uint(clamp(at.x + i, 0, last.x));
            g[i] = max(g[i], FROM_FAN_DEPTH ? ss_depth_at(x) : ss_range_at(x).x);
        }
        first += FROM_FAN_DEPTH ? 4u * occ.strides.x : occ.strides.y;
    }
    return g;
}

// The nearest of the squares of a block's side that half blocks make, in the block and around it.
float nearest_square(ivec2 block, uint level)
{
    const ivec2 corner = 2 * block - 2;
    float under[6] = covered_below(corner, level - 1u);
    float nearest = -3e38;
    [[unroll]] for (int y = 1; y < 6; y++) {
        const float here[6] = covered_below(corner + ivec2(0, y), level - 1u);
        [[unroll]] for (int x = 0; x < 5; x++)
            nearest = max(nearest, min(min(under[x], under[x + 1]), min(here[x], here[x + 1])));
        under = here;
    }
    return nearest;
}

// Over all layers: the first one's farthest, the nearest of all that is before the light.
vec2 range_of(uint level, ivec2 at)
{
    const uint in_level = uint(at.y * (last_of(level).x + 1) + at.x);
    const vec2 range = ss_range_at(occ.size.w * occ.strides.y + occ.pyramid[level].x + in_level);
    return vec2(range.x, occ.light.z > 0.0 ? min(range.y, occ.light.w / occ.light.z) : range.y);
}

// Whether the step from `far` to `near` opens a kernel of more than two samples.
bool is_step(float far, float near, uint level)
{
    const float reach = max(abs(occ.a.x) + abs(occ.a.y), abs(occ.a.z) + abs(occ.a.w));
    return (near - far) * reach > max(occ.light.w - occ.light.z * near, 0.0) * float(1u << level);
}

void add_bit(uint of_level, uint level, ivec2 texel)
{
    const int word = int(occ.pyramid[level].x - occ.pyramid[2].x) + texel.y * int(occ.pyramid[level].y) + texel.x;
    imageAtomicOr(made_bits, word, 1u << of_level);
}

void main()
{
    const uint lane = (gl_WorkGroupID.y * SS_DISPATCH_WIDTH + gl_WorkGroupID.x) * SS_SAMPLE_GROUP + gl_LocalInvocationIndex;
    // The texel two levels up, or the last one of all: what its range leaves no step for, needs no look at its blocks.
    const uint top = occ.levels.x, lowest = FROM_FAN_DEPTH ? 3u : 4u;
    const uint above = lane + (lowest <= top ? occ.pyramid[lowest].x : occ.strides.y);
    uint level = FROM_FAN_DEPTH ? 1u : 2u;
    ivec2 group = ivec2(0);
    if (FROM_FAN_DEPTH) {
        const uint columns = uint(last_of(3u).x + 1);
        group = ivec2(lane % columns, lane / columns);
        if (group.y > last_of(3u).y)
            return;
    } else if (above < occ.strides.y) {
        while (level + 3u <= top && above >= occ.pyramid[level + 3u].x)
            level++;
        const uint at = above - occ.pyramid[level + 2u].x, y = at / occ.pyramid[level + 2u].y;
        group = ivec2(at - y * occ.pyramid[level + 2u].y, y);
    } else {
        // The two levels below the top have one group each.
        level = max(top, 2u) - 1u + (above - occ.strides.y);
        if (level > top || level < 2u)
            return;
    }
    const vec2 whole = range_of(min(level + 2u, top), group >> int(level + 2u - min(level + 2u, top)));
    const ivec2 last = last_of(level);
    // Blocks that are no such square themselves, and of these, what looking around leaves.
    uint steep = 0u, thin = 0u;
    for (int i = is_step(whole.x, whole.y, level) ? 0 : 16; i < 16; i++) {
        const ivec2 block = 4 * group + ivec2(i & 3, i >> 2);
        const vec2 range = range_of(level, min(block, last));
        steep |= uint(all(lessThanEqual(block, last)) && is_step(range.x, range.y, level)) << i;
    }
    while (steep != 0u) {
        const int i = max(findLSB(steep), 0);
        steep &= steep - 1u;
        const ivec2 block = 4 * group + ivec2(i & 3, i >> 2);
        if (is_step(nearest_square(block, level), range_of(level, block).y, level)) {
            thin |= 1u << i;
            if (level > 1u)
                add_bit(level, level, block);
            if (level < top)
                add_bit(level, level + 1u, block >> 1);
        }
    }
    for (uint up = thin != 0u ? level + 2u : top + 1u; up <= top; up++)
        add_bit(level, up, group >> int(up - level - 2u));
}
