/* Column-major 4 x 4 matrices and small vectors in double precision. */
#include "matrix.h"

#include <math.h>
#include <string.h>

void softshi_matrix_multiply(const double a[16], const double b[16], double out[16])
{
    for (int c = 0; c < 4; c++) {
        for (int r = 0; r < 4; r++) {
            double sum = 0.0;
            for (int k = 0; k < 4; k++)
                sum += a[4 * k + r] * b[4 * c + k];
            out[4 * c + r] = sum;
        }
    }
}

static void swap_rows(double m[4][8], int a, int b)
{
    double row[8];
    memcpy(row, m[a], sizeof row);
    memcpy(m[a], m[b], sizeof row);
    memcpy(m[b], row, sizeof row);
}

bool softshi_matrix_invert(const double matrix[16], double out[16])
{
    double m[4][8] = {{0}};
    double largest = 0.0;
    for (int r = 0; r < 4; r++) {
        for (int c = 0; c < 4; c++) {
            m[r][c] = matrix[4 * c + r];
            largest = fmax(largest, fabs(m[r][c]));
        }
        m[r][4 + r] = 1.0;
    }
    if (!softshi_all_finite(matrix, 16) || !(largest > 0.0))
        return false;
    for (int c = 0; c < 4; c++) {
        int pivot = c;
        for (int r = c + 1; r < 4; r++)
            if (fabs(m[r][c]) > fabs(m[pivot][c]))
                pivot = r;
        /* Projections mix tiny and huge entries, so only an exact zero or underflow counts as singular. */
        if (!(fabs(m[pivot][c]) > 1e-250))
            return false;
        swap_rows(m, c, pivot);
        for (int r = 0; r < 4; r++) {
            if (r == c)
                continue;
            const double factor = m[r][c] / m[c][c];
            for (int k = c; k < 8; k++)
                m[r][k] -= factor * m[c][k];
        }
    }
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++)
            out[4 * c + r] = m[r][4 + c] / m[r][r];
    return softshi_all_finite(out, 16);
}

bool softshi_all_finite(const double *values, int count)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(values[i]))
            return false;
    return true;
}

void softshi_matrix_row(const double m[16], int r, double out[4])
{
    for (int c = 0; c < 4; c++)
        out[c] = m[4 * c + r];
}

double softshi_dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double softshi_length3(const double a[3])
{
    return sqrt(softshi_dot3(a, a));
}

void softshi_cross3(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}
