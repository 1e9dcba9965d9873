/* Propagation of the modes over a step under constant loads, by the tables of its length. */
#include "contact.h"

FAST double product(const double *a, const double *b, int count)
{
    double sum = 0;
    for (int i = 0; i < count; i++) sum += a[i] * b[i];
    return sum;
}

/* Velocities of ports and slopes without loads, m/s, at the end of the step and on average over it. */
FAST void free_motion(const Input *in, const StepTables *t, const State *s, Work *w)
{
    const int n_cue = in->ports + in->slopes, n_state = 2 * in->modes;
    const double *state = s->modes;
    for (int q = 0; q < n_cue; q++) {
        const double *ends = t->ends + q * n_state, *means = t->means + q * n_state;
        double end = 0, mean = 0;
        for (int i = 0; i < n_state; i++) {
            end += ends[i] * state[i];
            mean += means[i] * state[i];
        }
        w->end_free[q] = end;
        w->mean_free[q] = mean;
    }
}

/* The forces of the dashpots, which follow from the loads on ports and slopes. */
static void load_dashpots(const Input *in, const StepTables *t, const State *s, Work *w)
{
    const int n_cue = in->ports + in->slopes, n_state = 2 * in->modes;
    for (int d = 0; d < in->dashpots; d++) {
        const double *row = t->dashpots + d * (n_state + n_cue);
        w->loads[n_cue + d] = product(row, s->modes, n_state) + product(row + n_state, w->loads, n_cue);
    }
}

/* Sum of the loads on one mode. */
static double modal_load(const Input *in, const Work *w, int mode)
{
    const int n_rows = in->ports + in->slopes + in->dashpots;
    double sum = 0;
    for (int q = 0; q < n_rows; q++) sum += w->loads[q] * in->rows[q * in->modes + mode];
    return sum;
}

/* State and loads of the modes that radiate, which all of them change together. */
static void gather_radiating(const Input *in, const State *s, Work *w)
{
    const int n_modes = in->modes, m = in->radiating;
    for (int i = 0; i < m; i++) {
        int k = in->radiating_modes[i];
        w->radiating[i] = s->modes[k];
        w->radiating[m + i] = s->modes[n_modes + k];
        w->radiating[2 * m + i] = modal_load(in, w, k);
    }
}

/* Load the modes for the step, by the loads on ports and slopes. */
void load_modes(const Input *in, const StepTables *t, const State *s, Work *w)
{
    load_dashpots(in, t, s, w);
    gather_radiating(in, s, w);
}

/* Energy that damping takes from a mode in the step: the work of its load, less the increase of its energy.
 */
static double energy_lost(const Input *in, const State *s, const Work *w, int k)
{
    const int n_modes = in->modes;
    const double *v = s->modes, *a = v + n_modes, *v_before = w->before, *a_before = w->before + n_modes;
    double increase = (v[k] * v[k] - v_before[k] * v_before[k] + a[k] * a[k] - a_before[k] * a_before[k]) / 2;
    return modal_load(in, w, k) * (a[k] - a_before[k]) / in->omega[k] - increase;
}

/* Add the energies that dashpots and loss factors dissipate in the step, and what leaves the modes that
   radiate. The row of a dashpot includes the root of its constant. */
void add_losses(const Input *in, const StepTables *t, State *s, const Work *w)
{
    const int n_cue = in->ports + in->slopes;
    double radiated = 0;
    for (int i = 0; i < in->radiating; i++) radiated += energy_lost(in, s, w, in->radiating_modes[i]);
    for (int d = 0; d < in->dashpots; d++)
        s->damping_loss += t->h * w->loads[n_cue + d] * w->loads[n_cue + d];
    s->radiated += radiated;
    if (!in->structural_loss) return;
    s->damping_loss -= radiated;
    for (int k = 0; k < in->modes; k++)
        if (in->omega[k] > 0) s->damping_loss += energy_lost(in, s, w, k);
}

static void advance_radiating(const Input *in, const StepTables *t, State *s, const Work *w)
{
    const int n_modes = in->modes, m = in->radiating;
    for (int i = 0; i < m; i++) {
        int k = in->radiating_modes[i];
        s->modes[k] = product(t->radiating + 3 * m * i, w->radiating, 3 * m);
        s->modes[n_modes + k] = product(t->radiating + 3 * m * (m + i), w->radiating, 3 * m);
    }
}

/* Free motion of all other modes, each by itself. */
FAST static void advance_own(int n_modes, const double *restrict own, double *restrict state)
{
    for (int k = 0; k < n_modes; k++) {
        double v = state[k], a = state[n_modes + k];
        state[k] = own[k] * v - own[n_modes + k] * a;
        state[n_modes + k] = own[n_modes + k] * v + own[2 * n_modes + k] * a;
    }
}

/* Add the response to a load. */
FAST static void add_scaled(double *restrict sum, double load, const double *restrict response, int count)
{
    for (int i = 0; i < count; i++) sum[i] += load * response[i];
}

/* Advance the modes over the step under their loads. */
void advance_modes(const Input *in, const StepTables *t, State *s, Work *w)
{
    const int n_state = 2 * in->modes, n_rows = in->ports + in->slopes + in->dashpots;
    memcpy(w->before, s->modes, n_state * sizeof(double));
    advance_own(in->modes, t->own, s->modes);
    for (int q = 0; q < n_rows; q++)
        if (w->loads[q] != 0) add_scaled(s->modes, w->loads[q], t->response + q * n_state, n_state);
    advance_radiating(in, t, s, w);
}
