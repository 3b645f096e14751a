/* What directed straight edges on the light contribute to the polygons they bound: to their area clipped to the light,
 * and to the winding numbers of light samples. Sections 5 and 10 of docs/numerics.md. */
#ifndef REFERENCE_POLYGON_H
#define REFERENCE_POLYGON_H

#include <stdbool.h>
#include <stdint.h>

#include "reference_visibility.h"

/* Whether the edge between a and b, in either order, crosses row y, and where: both polygons that share it get the same
 * bits. */
bool reference_crosses(const double a[2], const double b[2], double y, double *x);

/* The integral of clamp(x) + limit over dy from a to b, x and y clamped to the square of half side `limit`. Over the
 * edges of a polygon these add up to its area in the square, once per winding, positive if the polygon turns from x to
 * y. */
double reference_edge_area(const double a[2], const double b[2], double limit);

/* Closed polygons, edge by edge, in any order. */
typedef struct reference_polygons {
    const reference_map *map;
    softsh_pattern pattern;
    double area;                                                    /* of q, as reference_edge_area has it */
    int32_t winding[REFERENCE_MAX_PATTERN * REFERENCE_MAX_PATTERN]; /* of each sample, row by row */
} reference_polygons;

void reference_polygons_begin(reference_polygons *polygons, const reference_map *map, softsh_pattern pattern);
/* An edge between two light points. */
void reference_polygons_add(reference_polygons *polygons, const double a[2], const double b[2]);
/* Occlusion by what the polygons turn around: the samples whose winding number is not zero, and the area, of which
 * nothing is clamped. */
void reference_polygons_end(const reference_polygons *polygons, reference_occlusion *out);

#endif
