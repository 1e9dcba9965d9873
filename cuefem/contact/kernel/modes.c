/* Propagation of the modes over a step, under loads that are constant over it, by the tables of its length. */
#include "contact.h"

FAST static double product(const double *a, const double *b, int count)
{
    double sum = 0;
    for (int i = 0; i < count; i++) sum += a[i] * b[i];
    return sum;
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

/* Loads on ports and slopes, and behind them the forces of the dashpots, which follow from them. */
static void load_rows(Work *w, const double *cue_loads)
{
    const int n_cue = w->c->ports + w->c->slopes, n_state = 2 * w->c->modes;
    memcpy(w->loads, cue_loads, n_cue * sizeof(double));
    for (int d = 0; d < w->c->dashpots; d++) {
        const double *row = w->t.dashpots + d * (n_state + n_cue);
        w->loads[n_cue + d] = product(row, w->state, n_state) + product(row + n_state, w->loads, n_cue);
    }
}

/* Sum of the loads on one mode. */
static double modal_load(const Work *w, int mode)
{
    const int n_rows = w->c->ports + w->c->slopes + w->c->dashpots;
    double sum = 0;
    for (int q = 0; q < n_rows; q++) sum += w->loads[q] * w->c->rows[q * w->c->modes + mode];
    return sum;
}

/* State and loads of the modes that radiate, which all of them change together. */
static void gather_radiating(Work *w)
{
    const int n_modes = w->c->modes, m = w->c->radiating;
    for (int i = 0; i < m; i++) {
        int k = w->c->radiating_modes[i];
        w->group[i] = w->state[k];
        w->group[m + i] = w->state[n_modes + k];
        w->group[2 * m + i] = modal_load(w, k);
    }
}

/* Load the modes for the step: loads on ports and slopes, and the dashpots' forces. */
void load_modes(Work *w, const double *cue_loads)
{
    load_rows(w, cue_loads);
    gather_radiating(w);
}

static double quadratic_form(const double *matrix, const double *x, int count)
{
    double sum = 0;
    for (int i = 0; i < count; i++) sum += x[i] * product(matrix + i * count, x, count);
    return sum;
}

/* Energy lost in the step by the loss factor of each mode, a quadratic form in v and g = load - omega a. */
static double structural_loss(const Work *w)
{
    const int n_modes = w->c->modes;
    const double *v = w->state, *a = v + n_modes;
    const double *per_vv = w->t.loss, *per_vg = per_vv + n_modes, *per_gg = per_vg + n_modes;
    double sum = 0;
    for (int k = 0; k < n_modes; k++) {
        double g = modal_load(w, k) - w->c->omega[k] * a[k];
        sum += (per_vv[k] * v[k] + per_vg[k] * g) * v[k] + per_gg[k] * g * g;
    }
    return sum;
}

/* Add the energies that dashpots and loss factors dissipate in the step, and that waves radiate. The row of a
   dashpot includes the root of its constant. */
void add_losses(Work *w)
{
    const int n_cue = w->c->ports + w->c->slopes, n_group = 3 * w->c->radiating;
    for (int d = 0; d < w->c->dashpots; d++)
        w->damping_loss += w->t.h * w->loads[n_cue + d] * w->loads[n_cue + d];
    w->radiated += quadratic_form(w->t.radiated, w->group, n_group);
    if (!w->c->structural_loss) return;
    w->damping_loss += structural_loss(w) + quadratic_form(w->t.dissipated, w->group, n_group);
}

static void advance_radiating(Work *w)
{
    const int n_modes = w->c->modes, m = w->c->radiating;
    for (int i = 0; i < m; i++) {
        int k = w->c->radiating_modes[i];
        w->state[k] = product(w->t.radiating + 3 * m * i, w->group, 3 * m);
        w->state[n_modes + k] = product(w->t.radiating + 3 * m * (m + i), w->group, 3 * m);
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
void advance_modes(Work *w)
{
    const int n_state = 2 * w->c->modes, n_rows = w->c->ports + w->c->slopes + w->c->dashpots;
    advance_own(w->c->modes, w->t.own, w->state);
    for (int q = 0; q < n_rows; q++)
        if (w->loads[q] != 0) add_scaled(w->state, w->loads[q], w->t.response + q * n_state, n_state);
    advance_radiating(w);
}

/* Apply impulses on ports and slopes, N s. */
void apply_impulses(Work *w, const double *impulses)
{
    const int n_modes = w->c->modes, n_cue = w->c->ports + w->c->slopes;
    for (int q = 0; q < n_cue; q++)
        for (int k = 0; k < n_modes; k++) w->state[k] += impulses[q] * w->c->rows[q * n_modes + k];
}

/* Impulse on the tip's lateral port, N s, that imposes mean velocities on it over equal steps, m/s, after a
   first impulse. The velocities are relative to a ball of an inverse mass, 1/kg, that the impulse moves, too. */
EXPORTED double imposed_velocity_impulse(Work *w, const StepTables *tables, int steps, const double *means,
                                         double ball_inverse_mass, double first_impulse)
{
    const int n_cue = w->c->ports + w->c->slopes, n_state = 2 * w->c->modes;
    const double *mean_velocity = tables->means + W_PORT * n_state;
    const double per_force =
        tables->mean_per_load[W_PORT * n_cue + W_PORT] + ball_inverse_mass * tables->h / 2;
    double loads[CUE_VELOCITIES] = {[W_PORT] = first_impulse};
    double impulse = first_impulse;
    w->t = *tables;
    apply_impulses(w, loads);
    for (int n = 0; n < steps; n++) {
        double without_force = product(mean_velocity, w->state, n_state) + ball_inverse_mass * impulse;
        loads[W_PORT] = (means[n] - without_force) / per_force;
        load_modes(w, loads);
        advance_modes(w);
        impulse += tables->h * loads[W_PORT];
    }
    return impulse;
}
