/* The little linear algebra the reference needs: products by definition, the inverse by elimination with pivoting. */
#include "reference_matrix.h"

#include <math.h>
#include <string.h>

double reference_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

void reference_cross(const double a[3], const double b[3], double out[3])
{
    const double x = a[1] * b[2] - a[2] * b[1];
    const double y = a[2] * b[0] - a[0] * b[2];
    const double z = a[0] * b[1] - a[1] * b[0];
    out[0] = x;
    out[1] = y;
    out[2] = z;
}

void reference_along(const double a[3], double t, const double b[3], double out[3])
{
    for (int i = 0; i < 3; ++i)
        out[i] = a[i] + t * b[i];
}

bool reference_normalize(const double a[3], double out[3])
{
    const double length = sqrt(reference_dot(a, a));
    if (!(length > 0.0) || !isfinite(length))
        return false;
    for (int i = 0; i < 3; ++i)
        out[i] = a[i] / length;
    return true;
}

void reference_matrix_multiply(const double a[16], const double b[16], double out[16])
{
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            long double sum = 0.0L;
            for (int k = 0; k < 4; ++k)
                sum += (long double)a[4 * k + row] * (long double)b[4 * column + k];
            out[4 * column + row] = (double)sum;
        }
    }
}

bool reference_matrix_inverse(const double a[16], double out[16])
{
    long double work[4][8];
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            work[row][column] = a[4 * column + row];
            work[row][4 + column] = row == column ? 1.0L : 0.0L;
        }
    }
    for (int k = 0; k < 4; ++k) {
        int pivot = k;
        for (int row = k + 1; row < 4; ++row)
            if (fabsl(work[row][k]) > fabsl(work[pivot][k]))
                pivot = row;
        if (!(fabsl(work[pivot][k]) > 0.0L))
            return false;
        for (int column = 0; column < 8; ++column) {
            const long double swapped = work[k][column];
            work[k][column] = work[pivot][column];
            work[pivot][column] = swapped;
        }
        const long double scale = 1.0L / work[k][k];
        for (int column = 0; column < 8; ++column)
            work[k][column] *= scale;
        for (int row = 0; row < 4; ++row) {
            const long double factor = work[row][k];
            if (row == k)
                continue;
            for (int column = 0; column < 8; ++column)
                work[row][column] -= factor * work[k][column];
        }
    }
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            out[4 * column + row] = (double)work[row][4 + column];
    return true;
}

void reference_matrix_apply(const double a[16], const double x[4], double out[4])
{
    double result[4];
    for (int row = 0; row < 4; ++row) {
        long double sum = 0.0L;
        for (int k = 0; k < 4; ++k)
            sum += (long double)a[4 * k + row] * (long double)x[k];
        result[row] = (double)sum;
    }
    memcpy(out, result, sizeof(result));
}
