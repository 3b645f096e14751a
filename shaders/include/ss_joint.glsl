// Whether neighbouring samples that both occlude a receiver are one surface for it: docs/numerics.md, section 10.
// Needs the sample.
#ifndef SS_JOINT_GLSL
#define SS_JOINT_GLSL

// Of samples `at` and at + step, a step of one along an axis.
bool ss_is_cut(ss_grid grid, vec3 receiver, ivec2 at, ivec2 step)
{
    const bool along_u = step.x != 0;
    const float g0 = ss_sample_depth(grid, at), g1 = ss_sample_depth(grid, at + step), spacing = float(1u << grid.level);
    if (SS_RECONSTRUCTION == SS_RECONSTRUCTION_FOLDS) {
        // The images of the two have changed sides, and are farther apart than those of samples of one depth.
        const vec2 p0 = ss_sample_place(at, grid.level) - receiver.xy, p1 = ss_sample_place(at + step, grid.level) - receiver.xy;
        const float k0 = 1.0 / (g0 - receiver.z), k1 = 1.0 / (g1 - receiver.z);
        const float apart = (along_u ? p1.x : p1.y) * k1 - (along_u ? p0.x : p0.y) * k0;
        return apart <= -spacing * max(k0, k1);
    }
    // On planes the differences before and after are the same. What is not steep cannot turn over within the light.
    const float step_g = g1 - g0;
    const float before = g0 - ss_sample_depth(grid, at - step), after = ss_sample_depth(grid, at + 2 * step) - g1;
    const float reach = along_u ? abs(occ.a.x) + abs(occ.a.y) : abs(occ.a.z) + abs(occ.a.w);
    const bool steep = abs(step_g) * reach >= spacing * (occ.light.w - occ.light.z * max(g0, g1));
    return steep && min(abs(step_g - before), abs(step_g - after)) > 0.5 * abs(step_g);
}

#endif
