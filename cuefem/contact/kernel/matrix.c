/* Small systems of linear equations; a matrix stands by columns. */
#include "contact.h"

/* LU factors of a matrix with scaled rows and pivots; 0 if it has none. */
FAST int factor(int n, Factor *to)
{
    double *A = to->matrix;
    for (int i = 0; i < n; i++) to->scale[i] = 1e-300;
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) to->scale[i] = larger(to->scale[i], fabs(A[j * n + i]));
    for (int i = 0; i < n; i++) to->scale[i] = 1 / to->scale[i];
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) A[j * n + i] *= to->scale[i];
    for (int k = 0; k < n; k++) {
        double *own = A + k * n;
        int q = k;
        for (int i = k + 1; i < n; i++)
            if (fabs(own[i]) > fabs(own[q])) q = i;
        to->pivots[k] = q;
        if (!(fabs(own[q]) > 0)) return 0;
        if (q != k)
            for (int j = 0; j < n; j++) {
                double t = A[j * n + k];
                A[j * n + k] = A[j * n + q], A[j * n + q] = t;
            }
        double by = 1 / own[k];
        for (int i = k + 1; i < n; i++) own[i] *= by;
        for (int j = k + 1; j < n; j++) {
            double *other = A + j * n, f = other[k];
            if (f == 0) continue;
            for (int i = k + 1; i < n; i++) other[i] -= f * own[i];
        }
    }
    return 1;
}

FAST void solve_factored(int n, const Factor *by, double *b)
{
    for (int i = 0; i < n; i++) b[i] *= by->scale[i];
    for (int k = 0; k < n; k++) {
        double t = b[k];
        b[k] = b[by->pivots[k]], b[by->pivots[k]] = t;
    }
    for (int k = 0; k < n; k++) {
        const double *column = by->matrix + k * n;
        for (int i = k + 1; i < n; i++) b[i] -= b[k] * column[i];
    }
    for (int k = n - 1; k >= 0; k--) {
        const double *column = by->matrix + k * n;
        b[k] /= column[k];
        for (int i = 0; i < k; i++) b[i] -= b[k] * column[i];
    }
}
