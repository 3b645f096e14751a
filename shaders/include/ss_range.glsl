// Nearest and farthest fan depth of a rectangle of texels: four overlapping fetches in an HSM, an MSSM or a YSM
// (Schwarz and Stamminger 2007, section 5; 2008, section 6).
// Needs the occluder bindings.
#ifndef SS_RANGE_GLSL
#define SS_RANGE_GLSL

uint ss_level_offset(uint level)
{
    return occ.offsets[level >> 2][level & 3u];
}

ivec2 ss_level_size(uint level)
{
    return (ivec2(occ.size.xy) + (1 << level) - 1) >> level;
}

float ss_load_fan_depth(uint layer, ivec2 texel)
{
    const ivec2 t = clamp(texel, ivec2(0), ivec2(occ.size.xy) - 1);
    return fan_depth[layer * occ.strides.x + uint(t.y) * occ.size.x + uint(t.x)];
}

vec2 ss_load_pyramid(uint layer, uint level, ivec2 texel)
{
    const ivec2 size = ss_level_size(level);
    const ivec2 t = clamp(texel, ivec2(0), size - 1);
    return pyramid[layer * occ.strides.y + ss_level_offset(level) + uint(t.y * size.x + t.x)];
}

vec2 ss_root(uint layer)
{
    if (occ.levels.x == 0u)
        return vec2(fan_depth[layer * occ.strides.x]);
    return ss_load_pyramid(layer, occ.levels.x, ivec2(0));
}

vec2 ss_load_wide(uint layer, uint level, ivec2 texel)
{
    return texelFetch(wide, ivec3(texel, int(layer * occ.levels.z + level) - 1), 0).xy;
}

vec2 ss_unite(vec2 a, vec2 b)
{
    return vec2(min(a.x, b.x), max(a.y, b.y));
}

// (farthest, nearest) of texels lo to hi, both inside the map.
vec2 ss_range(uint layer, ivec2 lo, ivec2 hi)
{
    const int d = max(hi.x - lo.x, hi.y - lo.y);
    const uint level = d <= 1 ? 0u : min(uint(findMSB(d - 1)) + 1u, occ.levels.x);
    if (SS_ACCEL_WIDE && level > occ.levels.y) {
        const ivec2 a = lo >> int(occ.levels.y), b = hi >> int(occ.levels.y);
        const int cells = max(b.x - a.x, b.y - a.y) + 1;
        const uint k = uint(findMSB(cells));
        if (k == 0u || k > plan.built.x)
            return ss_root(layer);
        // A wide texel at x covers [x - h, x + h - 1]; a side shorter than 2 h is covered by one in its middle.
        const int h = 1 << (k - 1u);
        const ivec2 middle = (a + b + 1) >> 1;
        const ivec2 first = mix(a + h, middle, lessThan(b - a + 1, ivec2(2 * h)));
        const ivec2 last = mix(b - h + 1, middle, lessThan(b - a + 1, ivec2(2 * h)));
        return ss_unite(ss_unite(ss_load_wide(layer, k, first), ss_load_wide(layer, k, ivec2(last.x, first.y))),
                        ss_unite(ss_load_wide(layer, k, ivec2(first.x, last.y)), ss_load_wide(layer, k, last)));
    }
    if (level == 0u) {
        const float a = ss_load_fan_depth(layer, lo), b = ss_load_fan_depth(layer, ivec2(hi.x, lo.y));
        const float c = ss_load_fan_depth(layer, ivec2(lo.x, hi.y)), e = ss_load_fan_depth(layer, hi);
        return vec2(min(min(a, b), min(c, e)), max(max(a, b), max(c, e)));
    }
    const ivec2 a = lo >> int(level), b = hi >> int(level);
    return ss_unite(ss_unite(ss_load_pyramid(layer, level, a), ss_load_pyramid(layer, level, ivec2(b.x, a.y))),
                    ss_unite(ss_load_pyramid(layer, level, ivec2(a.x, b.y)), ss_load_pyramid(layer, level, b)));
}

#endif
