/* Parts of a rectangular light that have maps of their own. */
#ifndef SOFTSHI_SUBLIGHT_H
#define SOFTSHI_SUBLIGHT_H

#include <stdbool.h>

#include <softshadow/types.h>

/* A light that is not divided is cell (0, 0) of 1 x 1. */
typedef struct softshi_sublight {
    uint32_t grid[2], cell[2];
} softshi_sublight;

/* Of a checked map. */
softshi_sublight softshi_sublight_of(const softsh_map *map);

/* The rectangle of that cell. */
softsh_light softshi_sublight_light(const softsh_light *light, const softshi_sublight *sublight);

uint32_t softshi_sublight_count(const softshi_sublight *sublight);
/* Place in the order of evaluation. */
uint32_t softshi_sublight_index(const softshi_sublight *sublight);
bool softshi_sublight_same_grid(const softshi_sublight *a, const softshi_sublight *b);

#endif
