/* Sample points of the light, the same for every pixel, so that there is no noise: a Fibonacci lattice in [-1, 1]^2, or a
 * Vogel spiral in the unit disc. Computed, because a table in the shader costs ten times as much on a software driver. */
layout(constant_id = 4) const bool disc = false;

/* Tap i of count; `turn` is (1, 0) before the first. */
vec2 next_tap(int i, int count, inout vec2 turn)
{
    const float x = (float(i) + 0.5) / float(count);

    if (disc) {
        const vec2 at = sqrt(x) * turn;
        /* The golden angle. */
        turn = vec2(-0.73736888 * turn.x - 0.67549029 * turn.y, 0.67549029 * turn.x - 0.73736888 * turn.y);
        return at;
    }
    return vec2(x, fract(float(i) * 0.61803399 + 0.5)) * 2.0 - 1.0;
}
