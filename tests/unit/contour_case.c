/* Random maps, receivers and settings for the tests of contours. */
#include "contour_case.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

reference_map build_map(setup_kind kind, double light_size, int turns)
{
    const double up[3] = {0, 1, 0}, target[3] = {0, 0, -20};
    const double bounds[4] = {-0.8, 0.7, -0.75, 0.85}, box[4] = {-5, 5.5, -6, 5};
    double view[16], projection[16], eye[3] = {0, 0, 0};
    softsh_light light = {.struct_size = sizeof(light)};
    reference_map map;
    if (kind == setup_directional) {
        light.shape = SOFTSH_LIGHT_DIRECTIONAL;
        light.direction[0] = 0.1;
        light.direction[2] = -1.0;
        light.angular_radius = atan(light_size);
        reference_orthographic(box, 0.5, 60.0, REFERENCE_DEPTH_NORMAL, projection);
    } else {
        const double angle = kind == setup_turned ? 0.4 : 0.0;
        const double axes[2][2] = {{light_size * cos(angle), light_size * sin(angle)},
                                   {-0.75 * light_size * sin(angle), 0.75 * light_size * cos(angle)}};
        light.shape = SOFTSH_LIGHT_RECTANGLE;
        for (int i = 0; i < 2; ++i) {
            light.half_u[i] = (turns > 1 ? -1.0 : 1.0) * axes[turns % 2][i];
            light.half_v[i] = (turns % 3 ? 1.0 : -1.0) * axes[1 - turns % 2][i];
        }
        eye[2] = kind == setup_behind_light ? 1.5 : 0.0;
        reference_perspective(bounds, kind == setup_behind_light ? 1.6 : 0.2, 60.0, REFERENCE_DEPTH_NORMAL, projection);
    }
    reference_look_at(eye, target, up, view);
    assert_true(reference_map_derive(&map, view, projection, width, height, &light));
    return map;
}

double fan_depth(const reference_map *map, double nearness)
{
    return map->perspective ? 0.06 + 0.44 * nearness : -10.0 + 16.0 * nearness;
}

void random_map(uint64_t *state, const reference_map *map, float *g)
{
    const double wave = reference_random_range(state, 0.0, 0.04), fu = reference_random_range(state, 0.1, 0.6);
    const double fv = reference_random_range(state, 0.1, 0.6);
    for (int i = 0; i < texels; ++i)
        g[i] = (float)fan_depth(map, 0.1 + wave * sin(fu * (i % width)) * cos(fv * (i / width)));
    for (int dome = 0; dome < 4; ++dome) {
        const double u = reference_random_range(state, 0, width), v = reference_random_range(state, 0, height);
        const double radius = reference_random_range(state, 2, 10), top = reference_random_range(state, 0.25, 1.0);
        const double rise = reference_random_range(state, 0.0, 0.15);
        for (int i = 0; i < texels; ++i) {
            const double distance = hypot(i % width - u, i / width - v) / radius;
            const double here = fan_depth(map, top - rise + rise * sqrt(fmax(1.0 - distance * distance, 0.0)));
            if (distance < 1.0 && here > (double)g[i])
                g[i] = (float)here;
        }
    }
    for (int speck = 0; speck < 4; ++speck)
        g[reference_random(state) % texels] = (float)fan_depth(map, reference_random_range(state, 0.0, 1.0));
}

reference_receiver random_receiver(uint64_t *state, const reference_map *map)
{
    const double step = fan_depth(map, 1.0) - fan_depth(map, 0.0);
    reference_receiver receiver = {.state = REFERENCE_RECEIVER_ACTIVE, .eta = 1e-5 * step};
    receiver.uvg[0] = reference_random_range(state, -4.0, width + 4.0);
    receiver.uvg[1] = reference_random_range(state, -4.0, height + 4.0);
    receiver.uvg[2] = fan_depth(map, reference_random_range(state, 0.0, 0.3));
    for (int i = 0; i < 2; ++i)
        receiver.gradient[i] = step * reference_random_range(state, -0.01, 0.01);
    receiver.side = reference_random(state) % 2 ? 1 : -1;
    receiver.drift = reference_random(state) % 3 ? 0.0 : 1e-4 * step;
    if (reference_random(state) % 8 == 0) {
        receiver.override_bias = true;
        receiver.bias = 0.01;
    }
    return receiver;
}

reference_settings random_settings(uint64_t *state, softsh_primitive primitive)
{
    return (reference_settings){.pattern = (softsh_pattern)(reference_random(state) % 5),
                                .primitive = primitive,
                                .aggregation = (softsh_aggregation)(reference_random(state) % 3),
                                .level = reference_random(state) % 4 ? 0 : 1 + reference_random(state) % 2};
}

double highest(const reference_dual_grid *grid)
{
    return reference_dual_grid_node(grid, grid->level_count - 1, -1, -1)->max;
}

reference_rect all_samples(const reference_dual_grid *grid)
{
    return (reference_rect){0, 0, (int32_t)grid->columns - 1, (int32_t)grid->rows - 1};
}

bool same_masks(const reference_occlusion *a, const reference_occlusion *b)
{
    return memcmp(a->mask, b->mask, sizeof(a->mask)) == 0 && a->counted == b->counted && a->occluded == b->occluded;
}

bool in_penumbra(const reference_occlusion *occlusion)
{
    return occlusion->occluded > 0 && occlusion->occluded < occlusion->counted;
}
