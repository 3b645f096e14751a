// Directed edges on the light's square, made [0, 1] x [0, 1], and what they contribute to areas: docs/numerics.md, section 10.
#ifndef SS_EDGE_GLSL
#define SS_EDGE_GLSL

// Mean of clamp(x, 0, 1) for x from x0 to x1 in even steps.
float ss_mean_clamped(float x0, float x1)
{
    const float inside0 = clamp(x0, 0.0, 1.0), inside1 = clamp(x1, 0.0, 1.0);
    // Beyond the left side nothing, then a trapezoid, then the whole width.
    const float sum = 0.5 * (inside1 - inside0) * (inside0 + inside1) + (max(x1, 1.0) - max(x0, 1.0));
    return x0 != x1 ? sum / (x1 - x0) : inside0;
}

// The integral of x dy along an edge.
float ss_edge_area(vec2 from, vec2 to)
{
    const float y0 = clamp(from.y, 0.0, 1.0), y1 = clamp(to.y, 0.0, 1.0);
    const float slope = (to.x - from.x) / (to.y - from.y);
    const float area = (y1 - y0) * ss_mean_clamped(from.x + (y0 - from.y) * slope, from.x + (y1 - from.y) * slope);
    return y0 != y1 ? area : 0.0;
}

// Whether an edge comes near enough to the light to hide a part of it.
bool ss_edge_touches(vec2 from, vec2 to)
{
    const vec2 sum = clamp(from, 0.0, 1.0) + clamp(to, 0.0, 1.0);
    return all(greaterThan(sum, vec2(0.0))) && all(lessThan(sum, vec2(2.0)));
}

#endif
