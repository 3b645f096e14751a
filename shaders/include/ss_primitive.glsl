// Back-projected micro-occluders into the bitmask and the area: docs/numerics.md, sections 4 and 5. Points are in sample
// coordinates, 0 to SS_SIDE across the light.
#ifndef SS_PRIMITIVE_GLSL
#define SS_PRIMITIVE_GLSL

float ss_area;

// Half side of the light's square (the square of equal area for a disc), in sample coordinates around the middle.
vec2 ss_clip_area(vec2 p)
{
    const float middle = 0.5 * float(SS_SIDE), half_side = middle * occ.extent.x;
    return clamp(p, vec2(middle - half_side), vec2(middle + half_side));
}

float ss_area_scale()
{
    const float side = float(SS_SIDE) * occ.extent.x;
    return 1.0 / (side * side);
}

void ss_mask_rectangle(vec2 lo, vec2 hi)
{
    const int from = ss_line_from(lo.y), to = ss_line_from(hi.y);
    const uint even = ss_columns_before(hi.x, 0) & ~ss_columns_before(lo.x, 0);
    const uint odd = SS_JITTERED ? ss_columns_before(hi.x, 1) & ~ss_columns_before(lo.x, 1) : even;
    ss_mask_set_lines(from, to, ss_repeat_rows(even, odd));
}

void ss_add_rectangle(vec2 lo, vec2 hi)
{
    if (SS_AREA) {
        const vec2 d = ss_clip_area(hi) - ss_clip_area(lo);
        ss_area += d.x * d.y;
    }
    if (SS_PATTERN_SIDE != 0)
        ss_mask_rectangle(lo, hi);
}

// Bits left of where an edge crosses a height; none if it does not. Both quads that share an edge compute the same.
uint ss_edge_columns(vec2 p, vec2 q, float y, int row)
{
    const vec2 a = p.y <= q.y ? p : q, b = p.y <= q.y ? q : p;
    if (!(a.y <= y && y < b.y))
        return 0u;
    return ss_columns_before(a.x + (y - a.y) * ((b.x - a.x) / (b.y - a.y)), row);
}

void ss_add_quad(vec2 a, vec2 b, vec2 c, vec2 d)
{
    if (SS_AREA) {
        const vec2 p = ss_clip_area(a), q = ss_clip_area(b), r = ss_clip_area(c), s = ss_clip_area(d);
        ss_area += 0.5 * abs((r.x - p.x) * (s.y - q.y) - (s.x - q.x) * (r.y - p.y));
    }
    if (SS_PATTERN_SIDE == 0)
        return;
    if (SS_PRIMITIVE == SS_PRIMITIVE_QUAD_RECTANGLE) {
        // a b are the lower side, d c the upper one.
        const float x0 = 0.5 * (a.x + d.x), x1 = 0.5 * (b.x + c.x), y0 = 0.5 * (a.y + b.y), y1 = 0.5 * (c.y + d.y);
        ss_mask_rectangle(vec2(min(x0, x1), min(y0, y1)), vec2(max(x0, x1), max(y0, y1)));
        return;
    }
    const int from = ss_line_from(min(min(a.y, b.y), min(c.y, d.y)));
    const int to = ss_line_from(max(max(a.y, b.y), max(c.y, d.y)));
    for (int line = from; line < to; line++) {
        const float y = ss_line_height(line);
        const int row = ss_line_row(line);
        ss_mask_set(line, ss_edge_columns(a, b, y, row) ^ ss_edge_columns(b, c, y, row) ^ ss_edge_columns(c, d, y, row) ^
                              ss_edge_columns(d, a, y, row));
    }
}

#endif
