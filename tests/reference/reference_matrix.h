/* The little linear algebra the reference needs: column-major 4 x 4 matrices and 3-vectors, in double. */
#ifndef REFERENCE_MATRIX_H
#define REFERENCE_MATRIX_H

#include <stdbool.h>

double reference_dot(const double a[3], const double b[3]);
void reference_cross(const double a[3], const double b[3], double out[3]);
/* a + t b. */
void reference_along(const double a[3], double t, const double b[3], double out[3]);
/* False, and `out` untouched, for a vector without a direction (zero, or not finite). */
bool reference_normalize(const double a[3], double out[3]);

/* a b; `out` may be neither. Sums are long double. */
void reference_matrix_multiply(const double a[16], const double b[16], double out[16]);
/* Gauss-Jordan with pivoting in long double. False for a singular matrix. */
bool reference_matrix_inverse(const double a[16], double out[16]);
/* a x; `out` may be x. */
void reference_matrix_apply(const double a[16], const double x[4], double out[4]);

#endif
