/* Random maps, receivers and settings for the tests of contours. */
#ifndef CONTOUR_CASE_H
#define CONTOUR_CASE_H

#include "reference_dual_grid.h"
#include "reference_scene.h"
#include "reference_visibility.h"

enum { width = 37, height = 29, texels = width * height };

typedef enum setup_kind { setup_on_light, setup_behind_light, setup_turned, setup_directional, setup_count } setup_kind;

/* A lamp that looks down -z over a map of width x height texels. Its rectangle, setup_turned's not along the map's
 * axes, is given by axes turned by 0 to 3 right angles: always the same light. */
reference_map build_map(setup_kind kind, double light_size, int turns);

/* Fan depths from far, 0, to near, 1. */
double fan_depth(const reference_map *map, double nearness);
/* A wavy floor under domes, whose borders are discontinuities, and specks. */
void random_map(uint64_t *state, const reference_map *map, float *g);
/* On the map or beside it, among the floor or above it. */
reference_receiver random_receiver(uint64_t *state, const reference_map *map);
/* Any pattern and aggregation, mostly level 0. */
reference_settings random_settings(uint64_t *state, softsh_primitive primitive);

double highest(const reference_dual_grid *grid);
reference_rect all_samples(const reference_dual_grid *grid);

bool same_masks(const reference_occlusion *a, const reference_occlusion *b);
bool in_penumbra(const reference_occlusion *occlusion);

#endif
