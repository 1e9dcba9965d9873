/* Propagation of the modes over a step under constant loads, by the tables of its length. */
#include "contact.h"

FAST static double product(const double *a, const double *b, int count)
{
    double sum = 0;
    for (int i = 0; i < count; i++) sum += a[i] * b[i];
    return sum;
}

/* Velocities of ports and slopes at the present state of the modes. */
void update_port_velocities(Contact *c)
{
    const int n_modes = c->in->modes, n_cue = c->in->ports + c->in->slopes;
    for (int q = 0; q < n_cue; q++)
        c->s->port_velocities[q] = product(c->in->rows + q * n_modes, c->s->modes, n_modes);
}

/* Velocities of ports and slopes without loads, m/s, at the end of the step and on average over it. */
FAST void free_motion(Contact *c)
{
    const int n_cue = c->in->ports + c->in->slopes, n_state = 2 * c->in->modes;
    const double *state = c->s->modes;
    for (int q = 0; q < n_cue; q++) {
        const double *ends = c->t.ends + q * n_state, *means = c->t.means + q * n_state;
        double end = 0, mean = 0;
        for (int i = 0; i < n_state; i++) {
            end += ends[i] * state[i];
            mean += means[i] * state[i];
        }
        c->end_free[q] = end;
        c->mean_free[q] = mean;
    }
}

/* Loads on ports and slopes, and behind them the forces of the dashpots, which follow from them. */
static void load_rows(Contact *c, const double *cue_loads)
{
    const int n_cue = c->in->ports + c->in->slopes, n_state = 2 * c->in->modes;
    memcpy(c->loads, cue_loads, n_cue * sizeof(double));
    for (int d = 0; d < c->in->dashpots; d++) {
        const double *row = c->t.dashpots + d * (n_state + n_cue);
        c->loads[n_cue + d] = product(row, c->s->modes, n_state) + product(row + n_state, c->loads, n_cue);
    }
}

/* Sum of the loads on one mode. */
static double modal_load(const Contact *c, int mode)
{
    const int n_rows = c->in->ports + c->in->slopes + c->in->dashpots;
    double sum = 0;
    for (int q = 0; q < n_rows; q++) sum += c->loads[q] * c->in->rows[q * c->in->modes + mode];
    return sum;
}

/* State and loads of the modes that radiate, which all of them change together. */
static void gather_radiating(Contact *c)
{
    const int n_modes = c->in->modes, m = c->in->radiating;
    for (int i = 0; i < m; i++) {
        int k = c->in->radiating_modes[i];
        c->group[i] = c->s->modes[k];
        c->group[m + i] = c->s->modes[n_modes + k];
        c->group[2 * m + i] = modal_load(c, k);
    }
}

/* Load the modes for the step: loads on ports and slopes, and the dashpots' forces. */
void load_modes(Contact *c, const double *cue_loads)
{
    load_rows(c, cue_loads);
    gather_radiating(c);
}

static double quadratic_form(const double *matrix, const double *x, int count)
{
    double sum = 0;
    for (int i = 0; i < count; i++) sum += x[i] * product(matrix + i * count, x, count);
    return sum;
}

/* Energy lost in the step by the loss factor of each mode, a quadratic form in v and g = load - omega a. */
static double structural_loss(const Contact *c)
{
    const int n_modes = c->in->modes;
    const double *v = c->s->modes, *a = v + n_modes;
    const double *per_vv = c->t.loss, *per_vg = per_vv + n_modes, *per_gg = per_vg + n_modes;
    double sum = 0;
    for (int k = 0; k < n_modes; k++) {
        double g = modal_load(c, k) - c->in->omega[k] * a[k];
        sum += (per_vv[k] * v[k] + per_vg[k] * g) * v[k] + per_gg[k] * g * g;
    }
    return sum;
}

/* Add the energies that dashpots and loss factors dissipate in the step, and that waves radiate. The row of a
   dashpot includes the root of its constant. */
void add_losses(Contact *c)
{
    const int n_cue = c->in->ports + c->in->slopes, n_group = 3 * c->in->radiating;
    for (int d = 0; d < c->in->dashpots; d++)
        c->s->damping_loss += c->t.h * c->loads[n_cue + d] * c->loads[n_cue + d];
    c->s->radiated += quadratic_form(c->t.radiated, c->group, n_group);
    if (!c->in->structural_loss) return;
    c->s->damping_loss += structural_loss(c) + quadratic_form(c->t.dissipated, c->group, n_group);
}

static void advance_radiating(Contact *c)
{
    const int n_modes = c->in->modes, m = c->in->radiating;
    for (int i = 0; i < m; i++) {
        int k = c->in->radiating_modes[i];
        c->s->modes[k] = product(c->t.radiating + 3 * m * i, c->group, 3 * m);
        c->s->modes[n_modes + k] = product(c->t.radiating + 3 * m * (m + i), c->group, 3 * m);
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
void advance_modes(Contact *c)
{
    const int n_state = 2 * c->in->modes, n_rows = c->in->ports + c->in->slopes + c->in->dashpots;
    advance_own(c->in->modes, c->t.own, c->s->modes);
    for (int q = 0; q < n_rows; q++)
        if (c->loads[q] != 0) add_scaled(c->s->modes, c->loads[q], c->t.response + q * n_state, n_state);
    advance_radiating(c);
}

/* Apply impulses on ports and slopes, N s. */
void apply_impulses(Contact *c, const double *impulses)
{
    const int n_modes = c->in->modes, n_cue = c->in->ports + c->in->slopes;
    for (int q = 0; q < n_cue; q++)
        for (int k = 0; k < n_modes; k++) c->s->modes[k] += impulses[q] * c->in->rows[q * n_modes + k];
}

/* Impulse on the tip's lateral port, N s, that imposes mean velocities on it over equal steps, m/s, after a
   first impulse. The velocities are relative to a ball of an inverse mass, 1/kg, that the impulse moves,
   too. */
EXPORTED double imposed_velocity_impulse(Contact *c, const StepTables *tables, int steps, const double *means,
                                         double ball_inverse_mass, double first_impulse)
{
    const int n_cue = c->in->ports + c->in->slopes, n_state = 2 * c->in->modes;
    const double *mean_velocity = tables->means + W_PORT * n_state;
    const double per_force =
        tables->mean_per_load[W_PORT * n_cue + W_PORT] + ball_inverse_mass * tables->h / 2;
    double loads[CUE_VELOCITIES] = {[W_PORT] = first_impulse};
    double impulse = first_impulse;
    c->t = *tables;
    apply_impulses(c, loads);
    for (int n = 0; n < steps; n++) {
        double without_force = product(mean_velocity, c->s->modes, n_state) + ball_inverse_mass * impulse;
        loads[W_PORT] = (means[n] - without_force) / per_force;
        load_modes(c, loads);
        advance_modes(c);
        impulse += tables->h * loads[W_PORT];
    }
    return impulse;
}
