// Marching squares over samples as bits: docs/numerics.md, section 10.
// Needs the sample.
#ifndef SS_CONTOUR_GLSL
#define SS_CONTOUR_GLSL

// Two bits for each of the sixteen cases of a cell's corners, counter-clockwise from the lower left: the last and the first corner
// of the run that occludes.
const uint SS_LAST_CORNER = 0x3343a250u, SS_FIRST_CORNER = 0x1acf1210u;

// Which cells between samples are left to be visited; some twice.
struct ss_contour_cells
{
    uint below, above; // samples: bits k and k + 1 of both are cell k's
    uint todo, twice;
};

// Those of `cells` that the contour runs through.
ss_contour_cells ss_begin_cells(uint below, uint above, uint cells)
{
    ss_contour_cells c;
    c.below = below;
    c.above = above;
    const uint right = c.below >> 1, across = c.above >> 1;
    c.todo = (c.below | right | across | c.above) & ~(c.below & right & across & c.above) & cells;
    c.twice = ((c.below & across & ~(right | c.above)) | (right & c.above & ~(c.below | across))) & cells;
    return c;
}

// The next cell, and the corners of a run that occludes, as bits. Occluders that touch at a corner stay apart: two runs, one
// after the other.
int ss_next_cell(inout ss_contour_cells c, out uint corners)
{
    const int k = max(findLSB(c.todo), 0);
    corners = (c.below >> k & 3u) | (c.above >> k & 2u) << 1 | (c.above >> k & 1u) << 3;
    const bool more = (c.twice >> k & 1u) != 0u;
    corners &= more ? 3u : corners == 5u || corners == 10u ? 12u : 15u;
    c.todo &= more ? c.todo : ~(1u << k);
    c.twice &= ~(1u << k);
    return k;
}

// From a corner of a cell to the next, counter-clockwise: half a step.
vec2 ss_towards_next(uint corner)
{
    const float step = (corner & 2u) == 0u ? 0.5 : -0.5;
    return (corner & 1u) == 0u ? vec2(step, 0.0) : vec2(0.0, step);
}

// (u, v, g) half the way from an occluding corner of a cell to a neighbour, at the occluder's depth.
vec3 ss_contour_point(ss_grid grid, ivec2 cell, uint corner, vec2 half_step)
{
    const ivec2 at = cell + ivec2((corner + 1u) >> 1 & 1u, corner >> 1);
    return vec3(ss_sample_place(at, grid.level) + half_step * float(1u << grid.level), ss_sample_depth(grid, at));
}

// An edge of the contour: the occluder lies to its left, u to the right and v up.
void ss_contour_edge(ss_grid grid, ivec2 cell, uint corners, out vec3 from, out vec3 to)
{
    const uint last = SS_LAST_CORNER >> (2u * corners) & 3u, first = SS_FIRST_CORNER >> (2u * corners) & 3u;
    from = ss_contour_point(grid, cell, last, ss_towards_next(last));
    to = ss_contour_point(grid, cell, first, -ss_towards_next(first + 3u & 3u));
}

#endif
