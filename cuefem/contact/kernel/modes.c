/* Propagation of the modes over a step under constant loads, by the tables of its length. */
#include "contact.h"

FAST static double product(const double *a, const double *b, int count)
{
    double sum = 0;
    for (int i = 0; i < count; i++) sum += a[i] * b[i];
    return sum;
}

/* Velocities of ports and slopes without loads, m/s, at the end of the step and on average over it. */
FAST void free_motion(Contact *c)
{
    const int n_cue = c->in->ports + c->in->slopes, n_state = 2 * c->in->modes;
    const double *state = c->s->modes;
    for (int q = 0; q < n_cue; q++) {
        const double *ends = c->tables.ends + q * n_state, *means = c->tables.means + q * n_state;
        double end = 0, mean = 0;
        for (int i = 0; i < n_state; i++) {
            end += ends[i] * state[i];
            mean += means[i] * state[i];
        }
        c->end_free[q] = end;
        c->mean_free[q] = mean;
    }
}

/* The forces of the dashpots, which follow from the loads on ports and slopes. */
static void load_dashpots(Contact *c)
{
    const int n_cue = c->in->ports + c->in->slopes, n_state = 2 * c->in->modes;
    for (int d = 0; d < c->in->dashpots; d++) {
        const double *row = c->tables.dashpots + d * (n_state + n_cue);
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
        c->radiating[i] = c->s->modes[k];
        c->radiating[m + i] = c->s->modes[n_modes + k];
        c->radiating[2 * m + i] = modal_load(c, k);
    }
}

/* Load the modes for the step, by the loads on ports and slopes. */
void load_modes(Contact *c)
{
    load_dashpots(c);
    gather_radiating(c);
}

/* Energy that damping takes from a mode in the step: the work of its load, less the increase of its energy. */
static double energy_lost(const Contact *c, int k)
{
    const int n_modes = c->in->modes;
    const double *v = c->s->modes, *a = v + n_modes, *v_before = c->before, *a_before = c->before + n_modes;
    double increase = (v[k] * v[k] - v_before[k] * v_before[k] + a[k] * a[k] - a_before[k] * a_before[k]) / 2;
    return modal_load(c, k) * (a[k] - a_before[k]) / c->in->omega[k] - increase;
}

/* Add the energies that dashpots and loss factors dissipate in the step, and what leaves the modes that radiate.
   The row of a dashpot includes the root of its constant. */
void add_losses(Contact *c)
{
    const int n_cue = c->in->ports + c->in->slopes;
    double radiated = 0;
    for (int i = 0; i < c->in->radiating; i++) radiated += energy_lost(c, c->in->radiating_modes[i]);
    for (int d = 0; d < c->in->dashpots; d++)
        c->s->damping_loss += c->tables.h * c->loads[n_cue + d] * c->loads[n_cue + d];
    c->s->radiated += radiated;
    if (!c->in->structural_loss) return;
    c->s->damping_loss -= radiated;
    for (int k = 0; k < c->in->modes; k++)
        if (c->in->omega[k] > 0) c->s->damping_loss += energy_lost(c, k);
}

static void advance_radiating(Contact *c)
{
    const int n_modes = c->in->modes, m = c->in->radiating;
    for (int i = 0; i < m; i++) {
        int k = c->in->radiating_modes[i];
        c->s->modes[k] = product(c->tables.radiating + 3 * m * i, c->radiating, 3 * m);
        c->s->modes[n_modes + k] = product(c->tables.radiating + 3 * m * (m + i), c->radiating, 3 * m);
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
    memcpy(c->before, c->s->modes, n_state * sizeof(double));
    advance_own(c->in->modes, c->tables.own, c->s->modes);
    for (int q = 0; q < n_rows; q++)
        if (c->loads[q] != 0) add_scaled(c->s->modes, c->loads[q], c->tables.response + q * n_state, n_state);
    advance_radiating(c);
}

/* Impulse on the tip's lateral port, N s, that imposes mean velocities on it over equal steps, m/s, after a
   first impulse, which the modes have taken. The velocities are relative to a ball of an inverse mass, 1/kg,
   that the impulse moves, too. */
EXPORTED double imposed_velocity_impulse(Contact *c, const StepTables *tables, int steps, const double *means,
                                         double ball_inverse_mass, double first_impulse)
{
    const int n_cue = c->in->ports + c->in->slopes, n_state = 2 * c->in->modes;
    const double *mean_velocity = tables->means + W_PORT * n_state;
    const double per_force =
        tables->mean_per_load[W_PORT * n_cue + W_PORT] + ball_inverse_mass * tables->h / 2;
    double impulse = first_impulse;
    c->tables = *tables;
    for (int n = 0; n < steps; n++) {
        double without_force = product(mean_velocity, c->s->modes, n_state) + ball_inverse_mass * impulse;
        c->loads[W_PORT] = (means[n] - without_force) / per_force;
        load_modes(c);
        advance_modes(c);
        impulse += tables->h * c->loads[W_PORT];
    }
    return impulse;
}
