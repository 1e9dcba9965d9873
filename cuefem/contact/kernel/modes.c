/* Modal propagation: the modes of the cue under loads that are constant over a step.

   With z = eigenvalue h, a load that drives xi by d adds d h phi_1(z) to xi and d h phi_2(z) to its mean over
   the step. A free mode becomes exp(z) xi, with the mean phi_1(z) xi. phi_1 = (exp(z) - 1)/z, phi_2 = (phi_1
   - 1)/z. */
#include "contact.h"

FAST static double product(const double *a, const double *b, int count)
{
    double sum = 0;
    for (int i = 0; i < count; i++) sum += a[i] * b[i];
    return sum;
}

/* Product a phi of complex numbers stored by parts; sign -1: of an output row, whose imaginary part is stored
   negated. */
static void multiply(double *out, const double *a, int modes, int k, double complex phi, int sign)
{
    double re = a[k], im = sign * a[modes + k];
    out[k] = re * creal(phi) - im * cimag(phi), out[modes + k] = sign * (re * cimag(phi) + im * creal(phi));
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
    const int K = w->c->modes, n_cue = w->c->ports + w->c->slopes, n_state = 2 * K;
    if (!t->propagator) t->propagator = malloc((size_t)(4 * n_cue + 1) * n_state * sizeof(double));
    if (!t->propagator) return 0;
    double *mean_response = t->propagator + (size_t)(1 + 3 * n_cue) * n_state;
    t->h = h, t->ends = t->propagator + n_state, t->means = t->ends + n_cue * n_state,
    t->response = t->means + n_cue * n_state;
    for (int k = 0; k < K; k++) {
        double complex z = h * (w->c->eigenvalues[2 * k] + I * w->c->eigenvalues[2 * k + 1]), phi2 = phi_2(z),
                       phi1 = 1 + z * phi2;
        double complex propagated = 1 + z * phi1;
        t->propagator[k] = creal(propagated), t->propagator[K + k] = cimag(propagated);
        for (int q = 0; q < n_cue; q++) {
            multiply(t->ends + q * n_state, w->outputs + q * n_state, K, k, propagated, -1);
            multiply(t->means + q * n_state, w->outputs + q * n_state, K, k, phi1, -1);
            multiply(t->response + q * n_state, w->inputs + q * n_state, K, k, h * phi1, 1);
            multiply(mean_response + q * n_state, w->inputs + q * n_state, K, k, h * phi2, 1);
        }
    }
    for (int p = 0; p < n_cue; p++)
        for (int q = 0; q < n_cue; q++) {
            t->end[p][q] = product(w->outputs + p * n_state, t->response + q * n_state, n_state);
            t->mean[p][q] = product(w->outputs + p * n_state, mean_response + q * n_state, n_state);
        }
    return 1;
}

/* Velocities of ports and slopes without loads, m/s, at the end of the step and on average over it. */
FAST void free_motion(Work *w)
{
    const int n_cue = w->c->ports + w->c->slopes, n_state = 2 * w->c->modes;
    for (int q = 0; q < n_cue; q++) {
        const double *ends = w->t.ends + q * n_state, *means = w->t.means + q * n_state;
        double end = 0, mean = 0;
        for (int i = 0; i < n_state; i++) end += ends[i] * w->state[i], mean += means[i] * w->state[i];
        w->end_free[q] = end, w->mean_free[q] = mean;
    }
}

/* Advance the modes over the step under loads on ports and slopes. */
FAST void advance_modes(Work *w, const double *loads)
{
    const int K = w->c->modes, n_cue = w->c->ports + w->c->slopes;
    const double *re = w->t.propagator, *im = re + K;
    double *restrict x = w->state, *restrict y = x + K;
    for (int k = 0; k < K; k++) {
        double before = x[k];
        x[k] = re[k] * before - im[k] * y[k], y[k] = re[k] * y[k] + im[k] * before;
    }
    for (int q = 0; q < n_cue; q++) {
        const double *response = w->t.response + q * 2 * K;
        for (int i = 0; i < 2 * K && loads[q] != 0; i++) x[i] += loads[q] * response[i];
    }
}

/* Apply impulses on ports and slopes, N s. */
void apply_impulses(Work *w, const double *impulses)
{
    const int n_cue = w->c->ports + w->c->slopes, n_state = 2 * w->c->modes;
    for (int q = 0; q < n_cue; q++)
        for (int i = 0; i < n_state; i++) w->state[i] += impulses[q] * w->inputs[q * n_state + i];
}

/* Mobility: velocity of port p per unit impulse on port q, 1/kg. */
double mobility(const Work *w, int p, int q)
{
    const int n_state = 2 * w->c->modes;
    return product(w->outputs + p * n_state, w->inputs + q * n_state, n_state);
}
