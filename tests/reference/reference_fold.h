/* Which cells of a map can be seen folded over within the light: section 10 of docs/numerics.md. */
#ifndef REFERENCE_FOLD_H
#define REFERENCE_FOLD_H

#include "reference_map.h"

/* Whether a receiver may see the back of the cell of these samples, given as (u, v, g) in turn, through the light. */
bool reference_folds(const reference_map *map, const double *const corner[4]);

#endif
