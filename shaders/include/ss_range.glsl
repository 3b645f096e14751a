// Nearest and farthest fan depth of a rectangle of texels: four overlapping fetches in an HSM, an MSSM or a YSM
// (Schwarz and Stamminger 2007, section 5; 2008, section 6).
// Needs the occluder bindings.
#ifndef SS_RANGE_GLSL
#define SS_RANGE_GLSL

uint ss_level_offset(uint level)
{
    return occ.pyramid[level].x;
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

// (farthest, nearest) of texels lo to hi, both inside the map, from the pyramid: up to four times their number. Level 0 is
// never read: a branch costs more than the texels it saves.
vec2 ss_range_pyramid(uint layer, ivec2 lo, ivec2 hi)
{
    const int d = max(hi.x - lo.x, hi.y - lo.y);
    // One level below the one that always will do is enough if the rectangle lies well in it.
    const int above = findMSB(max(d - 1, 1));
    const ivec2 cells = (hi >> above) - (lo >> above);
    const int level = min(above + (above > 0 && max(cells.x, cells.y) <= 1 ? 0 : 1), int(occ.levels.x));
    const ivec2 a = lo >> level, b = hi >> level;
    const int row = int(occ.pyramid[level].y);
    const uint base = layer * occ.strides.y + ss_level_offset(uint(level));
    return ss_unite(ss_unite(pyramid[base + uint(a.y * row + a.x)], pyramid[base + uint(a.y * row + b.x)]),
                    ss_unite(pyramid[base + uint(b.y * row + a.x)], pyramid[base + uint(b.y * row + b.x)]));
}

// The same, from the wide levels where they are: at most twice the width and height.
vec2 ss_range(uint layer, ivec2 lo, ivec2 hi)
{
    const vec2 range = ss_range_pyramid(layer, lo, hi);
    if (!SS_ACCEL_WIDE)
        return range;
    const int join = int(occ.levels.y);
    const ivec2 a = lo >> join, b = hi >> join;
    const int cells = max(b.x - a.x, b.y - a.y) + 1, k = findMSB(cells);
    if (k < 1 || k > int(plan.built.x))
        return range;
    // A wide texel at x covers [x - h, x + h - 1]; a side shorter than 2 h is covered by one in its middle.
    const int h = 1 << (k - 1);
    const ivec2 middle = (a + b + 1) >> 1;
    const ivec2 first = mix(a + h, middle, lessThan(b - a + 1, ivec2(2 * h)));
    const ivec2 last = mix(b - h + 1, middle, lessThan(b - a + 1, ivec2(2 * h)));
    return ss_unite(
        ss_unite(ss_load_wide(layer, uint(k), first), ss_load_wide(layer, uint(k), ivec2(last.x, first.y))),
        ss_unite(ss_load_wide(layer, uint(k), ivec2(first.x, last.y)), ss_load_wide(layer, uint(k), last)));
}

#endif
