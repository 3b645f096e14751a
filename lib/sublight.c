/* Sub-lights (Yang et al. 2009, section 5): a light cut into a grid of rectangles, each seen from its own centre. */
#include "sublight.h"

#include <softshadow/softshadow.h>

#include "validate.h"

softshi_sublight softshi_sublight_of(const softsh_map *map)
{
    softshi_sublight s = {{1, 1}, {0, 0}};
    for (int axis = 0; axis < 2 && map->role == SOFTSH_MAP_SUBLIGHT; axis++) {
        s.grid[axis] = map->grid[axis];
        s.cell[axis] = map->cell[axis];
    }
    return s;
}

softsh_light softshi_sublight_light(const softsh_light *light, const softshi_sublight *s)
{
    softsh_light part = *light;
    for (int i = 0; i < 3; i++) {
        part.center[i] += ((2.0 * s->cell[0] + 1.0) / s->grid[0] - 1.0) * light->half_u[i] +
                          ((2.0 * s->cell[1] + 1.0) / s->grid[1] - 1.0) * light->half_v[i];
        part.half_u[i] /= s->grid[0];
        part.half_v[i] /= s->grid[1];
    }
    return part;
}

uint32_t softshi_sublight_count(const softshi_sublight *s)
{
    return s->grid[0] * s->grid[1];
}

uint32_t softshi_sublight_index(const softshi_sublight *s)
{
    return s->cell[0] + s->grid[0] * s->cell[1];
}

bool softshi_sublight_same_grid(const softshi_sublight *a, const softshi_sublight *b)
{
    return a->grid[0] == b->grid[0] && a->grid[1] == b->grid[1];
}

softsh_result softsh_sublight_create(const softsh_light *light, const uint32_t grid[2], const uint32_t cell[2],
                                     softsh_light *out)
{
    if (!grid || !cell || !out || out->struct_size != sizeof *out)
        return SOFTSH_ERROR_INVALID_ARGUMENT;
    const softsh_result checked = softshi_check_rectangle_light(light);
    if (checked != SOFTSH_SUCCESS)
        return checked;
    for (int axis = 0; axis < 2; axis++)
        if (grid[axis] == 0 || grid[axis] > SOFTSH_MAX_SUBLIGHTS || cell[axis] >= grid[axis])
            return SOFTSH_ERROR_INVALID_ARGUMENT;
    *out = softshi_sublight_light(light, &(softshi_sublight){{grid[0], grid[1]}, {cell[0], cell[1]}});
    return SOFTSH_SUCCESS;
}
