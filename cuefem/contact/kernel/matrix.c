/* Small systems of linear equations. */
#include "contact.h"

/* LU factors of a matrix with scaled rows and pivots; 0 if it has none. */
FAST int factor(int n, Factor *to)
{
    double *A = to->matrix;
    for (int i = 0; i < n; i++) {
        double big = 1e-300;
        for (int j = 0; j < n; j++) big = larger(big, fabs(A[i * n + j]));
        to->scale[i] = 1 / big;
        for (int j = 0; j < n; j++) A[i * n + j] *= to->scale[i];
    }
    for (int k = 0; k < n; k++) {
        int q = k;
        for (int i = k + 1; i < n; i++)
            if (fabs(A[i * n + k]) > fabs(A[q * n + k])) q = i;
        to->pivots[k] = q;
        if (!(fabs(A[q * n + k]) > 0)) return 0;
        if (q != k)
            for (int j = 0; j < n; j++) {
                double t = A[k * n + j];
                A[k * n + j] = A[q * n + j], A[q * n + j] = t;
            }
        double by = 1 / A[k * n + k];
        for (int i = k + 1; i < n; i++) {
            double f = A[i * n + k] *= by;
            if (f == 0) continue;
            for (int j = k + 1; j < n; j++) A[i * n + j] -= f * A[k * n + j];
        }
    }
    return 1;
}

FAST void solve_factored(int n, const Factor *by, double *b)
{
    const double *A = by->matrix;
    for (int i = 0; i < n; i++) b[i] *= by->scale[i];
    for (int k = 0; k < n; k++) {
        double t = b[k];
        b[k] = b[by->pivots[k]], b[by->pivots[k]] = t;
    }
    for (int i = 1; i < n; i++) {
        double sum = b[i];
        for (int j = 0; j < i; j++) sum -= A[i * n + j] * b[j];
        b[i] = sum;
    }
    for (int i = n - 1; i >= 0; i--) {
        double sum = b[i];
        for (int j = i + 1; j < n; j++) sum -= A[i * n + j] * b[j];
        b[i] = sum / A[i * n + i];
    }
}
