// Map samples of a level: where they lie, how deep, whether they occlude a receiver, and where on the light they land.
// docs/numerics.md, sections 2, 3 and 5.
// Needs the kernel.
#ifndef SS_SAMPLE_GLSL
#define SS_SAMPLE_GLSL

struct ss_back_projection
{
    vec2 uv;       // receiver
    float g;       // its fan depth, biased
    float den;     // epsilon - delta g
    mat2 matrix;   // map offset -> sample coordinates
    vec2 constant;
};

// To `middle` +- `half_side` across the light.
ss_back_projection ss_back_project_from(ss_receiver r, float g, float middle, float half_side)
{
    ss_back_projection b;
    b.uv = r.uv;
    b.g = g;
    b.den = occ.light.w - occ.light.z * g;
    b.matrix = half_side * mat2(occ.a_inverse.x, occ.a_inverse.z, occ.a_inverse.y, occ.a_inverse.w);
    b.constant = middle - b.matrix * (occ.light.xy - occ.light.z * r.uv);
    return b;
}

vec2 ss_back_project(ss_back_projection b, vec2 uv, float g)
{
    return b.matrix * ((uv - b.uv) * (b.den / (g - b.g))) + b.constant;
}

// The same for many receivers of one light: what does not depend on them.
struct ss_light_map
{
    mat2 matrix;
    vec2 constant;
};

// 1, or -1 if contours run the other way on a mirrored light.
float ss_turn(ss_light_map l)
{
    return determinant(l.matrix) < 0.0 ? -1.0 : 1.0;
}

// To `middle` +- `half_side` across the light.
ss_light_map ss_to_light(float middle, float half_side)
{
    ss_light_map l;
    l.matrix = half_side * mat2(occ.a_inverse.x, occ.a_inverse.z, occ.a_inverse.y, occ.a_inverse.w);
    l.constant = middle - l.matrix * occ.light.xy;
    return l;
}

vec2 ss_map_to_light(ss_light_map l, vec3 receiver, vec3 at)
{
    const float t = (occ.light.w - occ.light.z * receiver.z) / (at.z - receiver.z);
    return l.matrix * ((at.xy - receiver.xy) * t + occ.light.z * receiver.xy) + l.constant;
}

// The texel whose depth a coarse texel takes; level 0 is its own.
ivec2 ss_sampled_texel(ivec2 at, uint level)
{
    return (at << int(level)) + ((1 << int(level)) >> 1);
}

vec2 ss_sample_place(ivec2 at, uint level)
{
    if (SS_SAMPLED)
        return vec2(min(ss_sampled_texel(at, level), ivec2(occ.size.xy) - 1)) + 0.5;
    return (vec2(at) + 0.5) * float(1u << level);
}

// (u, v) of sample `at` along one axis; `last`: the map's last texel on it.
float ss_sample_axis(int at, uint level, int last)
{
    const int spacing = 1 << int(level);
    return SS_SAMPLED ? float(min((at << int(level)) + (spacing >> 1), last)) + 0.5 : (float(at) + 0.5) * float(spacing);
}

// Where a layer's samples of a level are. Looked up once, not for every sample: indexing a uniform costs as much as a fetch.
struct ss_grid
{
    uint level;
    ivec2 last;
    uint depths, row; // first fan depth, and fan depths in a row
    uint ranges;      // first texel of the pyramid's level
};

ss_grid ss_load_grid(uint layer, uint level)
{
    const uvec4 of_level = occ.pyramid[level];
    return ss_grid(level, ss_level_size(level) - 1, 4u * (layer * occ.strides.x + of_level.z), 4u * of_level.w,
                   layer * occ.strides.y + of_level.x);
}

float ss_sample_depth(ss_grid grid, ivec2 at)
{
    const ivec2 t = clamp(at, ivec2(0), grid.last);
    if (SS_SAMPLED || grid.level == 0u)
        return ss_depth_at(grid.depths + uint(t.y) * grid.row + uint(t.x));
    return ss_range_at(grid.ranges + uint(t.y * (grid.last.x + 1) + t.x)).y;
}

bool ss_occludes(float g, vec2 at, ss_back_projection b, ss_receiver r, float band)
{
    // Over the plane through the biased receiver: blocks of nearest depths lift the surface and the receiver alike.
    const vec2 away = at - r.uv;
    const float height = g - (b.g - r.eta + dot(r.gradient, away)), noise = r.drift * (abs(away.x) + abs(away.y));
    const bool nearer = g > b.g, before_light = occ.light.w - occ.light.z * g > 0.0;
    const bool off_plane = ss_is_off_plane(r, height, band + noise);
    return nearer && before_light && off_plane;
}

#endif
