/* Modal propagation: the modes of the cue under loads that are constant over a step.

   With z = rate h, a load that drives xi by d adds d h phi_1(z) to xi and d h phi_2(z) to its mean over the
   step. A free mode becomes exp(z) xi, with the mean phi_1(z) xi. phi_1 = (exp(z) - 1)/z, phi_2 = (phi_1 -
   1)/z. */
#include "contact.h"

FAST static double product(const double *a, const double *b, int count)
{
    double sum = 0;
    for (int i = 0; i < count; i++) sum += a[i] * b[i];
    return sum;
}

/* Product a phi of complex numbers stored by parts; sign -1: a row, whose imaginary part is stored negated.
 */
static void multiply(double *to, const double *a, int modes, int k, double complex phi, int sign)
{
    double re = a[k], im = sign * a[modes + k];
    to[k] = re * creal(phi) - im * cimag(phi), to[modes + k] = sign * (re * cimag(phi) + im * creal(phi));
}

static double complex phi_2(double complex z)
{
    if (cabs(z) > 0.5) return (cexp(z) - 1 - z) / (z * z);
    double complex sum = 0;
    for (int n = 14; n >= 2; n--) sum = (sum * z + 1) / n;
    return sum;
}

/* Tables for steps of length h; 0 if memory runs out. */
FAST int tabulate(Work *w, double h)
{
    Tables *t = &w->t;
    const int K = w->c->modes, Q = w->c->ports + w->c->slopes, wide = 2 * K;
    if (!t->propagator) t->propagator = malloc((size_t)(4 * Q + 1) * wide * sizeof(double));
    if (!t->propagator) return 0;
    double *glide = t->propagator + (size_t)(1 + 3 * Q) * wide;
    t->h = h, t->ends = t->propagator + wide, t->means = t->ends + Q * wide, t->push = t->means + Q * wide;
    for (int k = 0; k < K; k++) {
        double complex z = h * (w->c->rates[2 * k] + I * w->c->rates[2 * k + 1]), second = phi_2(z),
                       first = 1 + z * second;
        double complex turned = 1 + z * first;
        t->propagator[k] = creal(turned), t->propagator[K + k] = cimag(turned);
        for (int q = 0; q < Q; q++) {
            multiply(t->ends + q * wide, w->rows + q * wide, K, k, turned, -1);
            multiply(t->means + q * wide, w->rows + q * wide, K, k, first, -1);
            multiply(t->push + q * wide, w->drives + q * wide, K, k, h * first, 1);
            multiply(glide + q * wide, w->drives + q * wide, K, k, h * second, 1);
        }
    }
    for (int p = 0; p < Q; p++)
        for (int q = 0; q < Q; q++) {
            t->end[p][q] = product(w->rows + p * wide, t->push + q * wide, wide);
            t->mean[p][q] = product(w->rows + p * wide, glide + q * wide, wide);
        }
    return 1;
}

/* Velocities of ports and slopes without loads, at the end of the step and on average over it. */
FAST void free_motion(Work *w)
{
    const int Q = w->c->ports + w->c->slopes, wide = 2 * w->c->modes;
    for (int q = 0; q < Q; q++) {
        const double *ends = w->t.ends + q * wide, *means = w->t.means + q * wide;
        double end = 0, mean = 0;
        for (int i = 0; i < wide; i++) end += ends[i] * w->state[i], mean += means[i] * w->state[i];
        w->end_free[q] = end, w->mean_free[q] = mean;
    }
}

/* Advance the modes over the step under loads on ports and slopes. */
FAST void advance_modes(Work *w, const double *loads)
{
    const int K = w->c->modes, Q = w->c->ports + w->c->slopes;
    const double *re = w->t.propagator, *im = re + K;
    double *restrict x = w->state, *restrict y = x + K;
    for (int k = 0; k < K; k++) {
        double before = x[k];
        x[k] = re[k] * before - im[k] * y[k], y[k] = re[k] * y[k] + im[k] * before;
    }
    for (int q = 0; q < Q; q++) {
        const double *push = w->t.push + q * 2 * K;
        for (int i = 0; i < 2 * K && loads[q] != 0; i++) x[i] += loads[q] * push[i];
    }
}

/* Apply impulses on ports and slopes. */
void apply_impulses(Work *w, const double *impulses)
{
    const int Q = w->c->ports + w->c->slopes, wide = 2 * w->c->modes;
    for (int q = 0; q < Q; q++)
        for (int i = 0; i < wide; i++) w->state[i] += impulses[q] * w->drives[q * wide + i];
}

/* Mobility: velocity of port p per unit impulse on port q, 1/kg. */
double mobility(const Work *w, int p, int q)
{
    const int wide = 2 * w->c->modes;
    return product(w->rows + p * wide, w->drives + q * wide, wide);
}
