// Nearest and farthest fan depth of a rectangle of texels: four overlapping fetches in an HSM, an MSSM or a YSM
// (Schwarz and Stamminger 2007, section 5; 2008, section 6). Of several layers: the nearest of all, the first one's farthest.
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

vec2 ss_load_pyramid(uint layer, uint level, ivec2 texel)
{
    const ivec2 size = ss_level_size(level);
    const ivec2 t = clamp(texel, ivec2(0), size - 1);
    return ss_range_at(layer * occ.strides.y + ss_level_offset(level) + uint(t.y * size.x + t.x));
}

vec2 ss_root()
{
    return ss_load_pyramid(occ.size.w, occ.levels.x, ivec2(0));
}

vec2 ss_unite(vec2 a, vec2 b)
{
    return vec2(min(a.x, b.x), max(a.y, b.y));
}

// Four texels of one level, whose rows begin at `base` and are `row` long: the corners of a rectangle.
struct ss_corners
{
    uint base;
    int row;
    ivec2 a, b;
};

vec2 ss_range_corners(ss_corners c)
{
    const uint a = c.base + uint(c.a.y * c.row), b = c.base + uint(c.b.y * c.row);
    return ss_unite(ss_unite(ss_range_at(a + uint(c.a.x)), ss_range_at(a + uint(c.b.x))),
                    ss_unite(ss_range_at(b + uint(c.a.x)), ss_range_at(b + uint(c.b.x))));
}

// Those of the pyramid that cover texels lo to hi. Level 0 is never read: a branch costs more than the texels it saves.
ss_corners ss_pyramid_corners(ivec2 lo, ivec2 hi)
{
    const int d = max(hi.x - lo.x, hi.y - lo.y);
    // One level below the one that always will do is enough if the rectangle lies well in it.
    const int above = findMSB(max(d - 1, 1));
    const ivec2 cells = (hi >> above) - (lo >> above);
    const int level = min(above + (above > 0 && max(cells.x, cells.y) <= 1 ? 0 : 1), int(occ.levels.x));
    return ss_corners(occ.size.w * occ.strides.y + ss_level_offset(uint(level)), int(occ.pyramid[level].y), lo >> level,
                      hi >> level);
}

// (farthest, nearest) of texels lo to hi, both inside the map, from the pyramid: up to four times their number.
vec2 ss_range_pyramid(ivec2 lo, ivec2 hi)
{
    return ss_range_corners(ss_pyramid_corners(lo, hi));
}

// The same, from the wide levels where there are some: at most twice the width and height. Both lie in one buffer, so that
// choosing between them chooses an index, not a load.
vec2 ss_range(ivec2 lo, ivec2 hi)
{
    ss_corners c = ss_pyramid_corners(lo, hi);
    const int join = int(occ.levels.y);
    const ivec2 a = lo >> join, b = hi >> join;
    const int cells = max(b.x - a.x, b.y - a.y) + 1, k = findMSB(cells);
    // Rounding to cells of 2^join texels loosens small rectangles more than the pyramid does.
    const int least = join > 0 ? 2 : 1;
    if (k >= least && k <= int(plan.built.x)) {
        // A wide texel at x covers [x - h, x + h - 1]; a side shorter than 2 h is covered by one in its middle.
        const int h = 1 << (k - 1);
        const ivec2 middle = (a + b + 1) >> 1;
        c.base = occ.strides.z + uint(k - 1) * occ.strides.w;
        c.row = int(occ.levels.w);
        c.a = mix(a + h, middle, lessThan(b - a + 1, ivec2(2 * h)));
        c.b = mix(b - h + 1, middle, lessThan(b - a + 1, ivec2(2 * h)));
    }
    return ss_range_corners(c);
}

#endif
