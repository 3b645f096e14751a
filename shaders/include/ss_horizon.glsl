// Which part of the light lies behind a receiver's plane: docs/numerics.md, section 3.
// Needs the frame and occluder bindings.
#ifndef SS_HORIZON_GLSL
#define SS_HORIZON_GLSL

// On the light's square the plane's front is where n . q < c, times the side.
struct ss_horizon_line
{
    vec2 n;
    float c;
};

ss_horizon_line ss_horizon_of(vec2 uv, float g, vec2 gradient)
{
    ss_horizon_line line;
    line.n = vec2(dot(gradient, occ.a.xz), dot(gradient, occ.a.yw));
    line.c = occ.light.w - occ.light.z * g - dot(gradient, occ.light.xy - occ.light.z * uv);
    return line;
}

// Share of the square [-1, 1] x [-1, 1] where n . q >= c: a corner, or two of them.
float ss_square_beyond(vec2 n, float c)
{
    const vec2 a = abs(n);
    const float p = max(a.x, a.y), s = min(a.x, a.y), t = abs(c);
    const float corner = max(p + s - t, 0.0) / (2.0 * max(s, 1e-30));
    const float beyond = t <= p - s ? 0.5 - 0.5 * t / p : min(corner * corner * 0.5 * s / max(p, 1e-30), 0.5);
    const float share = p > 0.0 ? beyond : 0.0;
    return c < 0.0 ? 1.0 - share : share;
}

// Share of the unit disc.
float ss_disc_beyond(vec2 n, float c)
{
    const float size = length(n), t = size > 0.0 ? clamp(c / size, -1.0, 1.0) : (c < 0.0 ? -1.0 : 1.0);
    return (acos(t) - t * sqrt(1.0 - t * t)) * 0.318309886;
}

float ss_horizon(vec2 uv, float g, vec2 gradient, float side)
{
    const ss_horizon_line line = ss_horizon_of(uv, g, gradient);
    const float square = ss_square_beyond(line.n, line.c), disc = ss_disc_beyond(line.n, line.c);
    const float beyond = (ss_flags & SS_FLAG_DISC) != 0u ? disc : square;
    return side < 0.0 ? 1.0 - beyond : beyond;
}

#endif
