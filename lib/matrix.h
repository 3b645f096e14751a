/* Column-major 4 x 4 matrices and small vectors in double precision. */
#ifndef SOFTSHI_MATRIX_H
#define SOFTSHI_MATRIX_H

#include <stdbool.h>

/* out = a b; out may not alias. */
void softshi_matrix_multiply(const double a[16], const double b[16], double out[16]);
/* Gauss-Jordan with row pivoting; false if the matrix is singular or not finite. */
bool softshi_matrix_invert(const double m[16], double out[16]);
bool softshi_all_finite(const double *values, int count);

/* Row r of a column-major matrix. */
void softshi_matrix_row(const double m[16], int r, double out[4]);
double softshi_dot3(const double a[3], const double b[3]);
double softshi_length3(const double a[3]);
void softshi_cross3(const double a[3], const double b[3], double out[3]);

#endif
