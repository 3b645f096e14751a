// Cells of a surface that a receiver sees from behind: there the surface folds over on the light, and the area of its contours takes
// what the cell hides for negative. docs/numerics.md, section 10.
// Needs the receivers, the strip and the folds.
#ifndef SS_BACKS_GLSL
#define SS_BACKS_GLSL

// Of the strip's cells, as bits: those that every receiver sees from behind; those that some may.
uint ss_back_every[SS_STRIP_ROWS], ss_back_some[SS_STRIP_ROWS];

// Fills those arrays in, for the rows it returns. Looks at `full_rows`, at cells in `columns` that fold and whose corners all occlude.
uint ss_find_backs(ss_grid grid, ss_folds folds, int x0, int y0, uint full_rows, uint columns)
{
    const float per_step = 1.0 / float(1u << grid.level);
    const vec2 at = (packet.uv - ss_sample_place(ivec2(0), grid.level)) * per_step, reach = packet.reach * per_step;
    const uint last_quad = grid.row / 4u - 1u;
    uint rows = full_rows, cells = 0u, todo = 0u, every = 0u, some = 0u, found = 0u;
    int row = 0;
    while (todo != 0u || rows != 0u) {
        if (todo == 0u) {
            row = findLSB(rows);
            rows &= rows - 1u;
            const uint below = ss_strip[row], above = ss_strip[row + 1];
            cells = below & below >> 1 & above & above >> 1 & columns & ss_folds_of_row(folds, x0, y0 + row);
            todo = (cells | cells >> 1 | cells >> 2 | cells >> 3) & 0x11111111u;
            every = some = 0u;
        }
        const bool any = todo != 0u;
        const int k = max(findLSB(todo), 0);
        todo &= todo - 1u;
        const uint quad = min(uint(max(x0 + k, 0)) / 4u, last_quad), next = min(quad + 1u, last_quad);
        const uint lower = (grid.depths + uint(y0 + row) * grid.row) / 4u, upper = lower + grid.row / 4u;
        const vec4 low = ss_depth_quad_at(lower + quad), high = ss_depth_quad_at(upper + quad);
        const vec4 low_right = vec4(low.yzw, ss_depth_at(4u * (lower + next)));
        const vec4 high_right = vec4(high.yzw, ss_depth_at(4u * (upper + next)));
        const vec4 dx = low_right - low + (high_right - high), dy = high - low + (high_right - low_right);
        const vec4 sum = low + low_right + (high + high_right);
        const vec4 x = at.x - (float(x0 + k) + vec4(0.5, 1.5, 2.5, 3.5)); // in steps from the cells' middles
        const float y = at.y - (float(y0 + row) + 0.5);
        const vec4 height = sum + 2.0 * (dx * x + dy * y); // of the mean plane there, four times
        const vec4 room = 2.0 * (abs(dx) * reach.x + abs(dy) * reach.y);
        const uint of_quad = any ? cells >> k & 15u : 0u;
        const uint may = ss_bits(lessThanEqual(height - room, vec4(4.0 * packet.g_hi))) & of_quad;
        const uint do_all = ALONE ? may : ss_bits(lessThanEqual(height + room, vec4(4.0 * packet.g_lo))) & of_quad;
        every |= do_all << k;
        some |= (may & ~do_all) << k;
        ss_back_every[row] = every;
        ss_back_some[row] = some;
        found |= uint((every | some) != 0u) << row;
    }
    return found;
}

// Rounds of a loop that may be spent on them, of one strip: docs/numerics.md, section 8.
uint ss_most_back_rounds()
{
    const uint n = ss_most_budgeted(), strips = ((n + 5u) / 28u + 1u) * ((n + 32u) / 31u);
    return 24000u / (ss_layers() * strips);
}

// `sides` of a cell between places lo and hi, to one receiver's area. The depths of the corners go counter-clockwise from the lower
// left, the sides clockwise: the way round of what is seen from behind.
void ss_add_back_cell(int i, vec2 lo, vec2 hi, vec4 g, uint sides)
{
    const vec2 p[4] = vec2[4](ss_project(i, vec3(lo, g.x)), ss_project(i, vec3(hi.x, lo.y, g.y)), ss_project(i, vec3(hi, g.z)),
                              ss_project(i, vec3(lo.x, hi.y, g.w)));
    float sum = 0.0;
    bool touches = false;
    [[unroll]] for (int j = 0; j < 4; j++) {
        const bool counts = (sides >> j & 1u) != 0u;
        const vec2 from = p[j + 1 & 3], to = p[j];
        const float a = ss_edge_area(from, to);
        sum += counts ? a : 0.0;
        touches = touches || (counts && ss_edge_touches(from, to));
    }
    backs[i] += sum;
    if (SS_SPARSE)
        touched |= uint(touches) << i;
}

// Adds up the areas of the strip's cells in `back_rows`. Sides between cells that all receivers see from behind need not be looked at.
// Returns whether it is done within so many rounds.
bool ss_add_backs(ss_grid grid, int x0, int y0, uint back_rows, uint most_rounds)
{
    const float per_step = 1.0 / float(1u << grid.level);
    const ivec2 last_texel = ivec2(occ.size.xy) - 1;
    uint rows = back_rows, todo = 0u, every = 0u, below = 0u, above = 0u, rounds = 0u;
    int row = 0;
    while ((rows | todo) != 0u && rounds < most_rounds) {
        if (todo == 0u) {
            row = findLSB(rows);
            rows &= rows - 1u;
            every = ss_back_every[row];
            below = (back_rows << 1 >> row & 1u) != 0u ? ss_back_every[row - 1] : 0u;
            above = (back_rows >> row >> 1 & 1u) != 0u ? ss_back_every[row + 1] : 0u;
            todo = ss_back_some[row] | (every & ~(below & above & every << 1 & every >> 1));
        }
        const bool any = todo != 0u;
        const int k = max(findLSB(todo), 0), x = max(x0 + k, 0), y = y0 + row;
        todo &= todo - 1u;
        const uint at = grid.depths + uint(y) * grid.row + uint(x);
        const vec2 lo = vec2(ss_sample_axis(x, grid.level, last_texel.x), ss_sample_axis(y, grid.level, last_texel.y));
        const vec2 hi = vec2(ss_sample_axis(x + 1, grid.level, last_texel.x), ss_sample_axis(y + 1, grid.level, last_texel.y));
        // Of the corners, counter-clockwise from the lower left; four times the mean plane in the middle, and its slopes.
        const vec4 g = vec4(ss_depth_at(at), ss_depth_at(at + 1u), ss_depth_at(at + grid.row + 1u), ss_depth_at(at + grid.row));
        const float sum = g.x + g.y + (g.w + g.z), dx = g.y - g.x + (g.z - g.w), dy = g.w - g.x + (g.z - g.y);
        const bool of_all = (every >> k & 1u) != 0u;
        const uint inner = (below >> k & 1u) | (every >> 1 >> k & 1u) << 1 | (above >> k & 1u) << 2 | (every << 1 >> k & 1u) << 3;
        const uint sides = of_all ? ~inner & 15u : 15u;
        bool seen = any && ALONE;
        if (ALONE) {
            ss_add_back_cell(0, lo, hi, g, any ? sides : 0u);
        } else {
            for (uint left = any ? together : 0u; left != 0u; left &= left - 1u) {
                const int i = findLSB(left);
                const vec2 away = (vec2(at_u[i], at_v[i]) - lo) * per_step - 0.5;
                const bool sees = of_all || sum + 2.0 * (dx * away.x + dy * away.y) <= 4.0 * at_g[i];
                ss_add_back_cell(i, lo, hi, g, sees ? sides : 0u);
                seen = seen || sees;
                rounds++;
            }
        }
        edges += seen ? uint(bitCount(sides)) : 0u;
        rounds++;
    }
    return (rows | todo) == 0u;
}

#endif
