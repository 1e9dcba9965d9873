/* One time step: its forces, and the motion of cue, ball and contact under them (handbook: One step).

   Begin with take_step, below; contact.h explains F, u, v and C. The forces come from level.c, or raised.c
   for a cue raised over a table: the law of the tip (laws.c) and friction (patch_*.c), solved together. */
#include "contact.h"

static const double MIN_FRACTION = 1e-6; /* of a step, to its event */

/* The forces of the step, 0 in free flight. Returns whether they were found. */
static bool find_forces(Contact *c)
{
    if (!touches(c->s)) return true;
    return is_raised(c->in) ? raised_forces(c) : level_forces(c);
}

/* Repeat a step whose forces were not found at half of its length. Newton's method may alternate where a
   sticking tip hardly touches: there the tangential stiffness of leather is like a root of the indentation. */
static void halve(Contact *c)
{
    State *s = c->s;
    s->next_step = c->tables.h / 2;
    s->ends_at_event = false;
    if (s->next_step < MIN_FRACTION * c->in->step) s->status = UNSOLVED;
}

/* Sign of the indentation's change at which a step ends: at a touch 1, at a separation -1; 0 for no event. */
static int event_sign(int phase)
{
    if (phase == FREE) return 1;
    return phase == UNLOADING ? -1 : 0;
}

/* Ball and tip separate or touch where the indentation passes the residual one. If that happens within the
   step, set the length of a step that ends there, which replaces this one, and return true. */
static bool shorten_to_event(Contact *c)
{
    State *s = c->s;
    const double h = c->tables.h;
    const int event = event_sign(s->phase);
    double excess = s->indentation - residual_indentation(c->in, s);
    double excess_at_end = excess - h * c->u[N];
    bool passes = event * excess < 0 && event * excess_at_end > 0;
    if (s->ends_at_event || !passes) return false;
    s->ends_at_event = true;
    s->next_step = h * larger(excess / (h * c->u[N]), MIN_FRACTION);
    return true;
}

/* The work that each force dissipates: its impulse by the mean velocity, with the opposite sign. */
static void add_work(Contact *c)
{
    for (int f = 0; f < c->in->forces; f++) c->s->work[f] -= c->tables.load_time * c->F[f] * c->u[f];
}

/* The loads C' F on ports, slopes and ball. */
static void find_loads(Contact *c)
{
    const Input *in = c->in;
    const int n_cue = in->ports + in->slopes;
    memset(c->loads, 0, n_cue * sizeof(double));
    memset(c->ball_loads, 0, sizeof c->ball_loads);
    for (int f = 0; f < in->forces; f++) {
        for (int p = 0; p < n_cue; p++) c->loads[p] += c->C[f][p] * c->F[f];
        for (int b = 0; b < in->speeds; b++) c->ball_loads[b] += c->C[f][n_cue + b] * c->F[f];
    }
    c->axial_force = -c->loads[U_PORT];
}

static void advance_cue(Contact *c)
{
    const Input *in = c->in;
    State *s = c->s;
    load_modes(c);
    advance_modes(c);
    if (c->tables.h > 0) add_losses(c);
    for (int p = 0; p < in->ports + in->slopes; p++) {
        s->port_velocities[p] = c->end_free[p];
        s->mean_velocities[p] = c->mean_free[p];
        for (int f = 0; f < in->forces; f++) {
            s->port_velocities[p] += c->end_per_force[f][p] * c->F[f];
            s->mean_velocities[p] += c->mean_per_force[f][p] * c->F[f];
        }
    }
    for (int a = 0; a < in->slopes; a++) s->slopes[a] += c->tables.h * s->mean_velocities[in->ports + a];
}

static void advance_ball(Contact *c)
{
    const Input *in = c->in;
    State *s = c->s;
    const double spin = s->ball[BALL_SPIN];
    for (int b = 0; b < in->speeds; b++)
        s->ball[b] += c->tables.load_time * in->inverse_masses[b] * c->ball_loads[b];
    c->mean_spin = (spin + s->ball[BALL_SPIN]) / 2;
    s->height = larger(0, s->height + c->tables.h * c->u[UP]);
}

/* Rolling and slip move the contact over ball and dome; beyond the dome's rim over the ball alone. The third
   port of a cue that rolls on a dome is the rotation of its end section. */
static void roll(Contact *c)
{
    const Input *in = c->in;
    State *s = c->s;
    double dome = fabs(in->phi + s->angle) < in->rim ? in->dome : 0;
    double section_rotation = in->ports > THIRD_PORT ? s->mean_velocities[THIRD_PORT] : 0;
    s->rolling_rate = (c->mean_spin - c->u[T] + dome * section_rotation) / (in->radius + dome);
    s->angle += c->tables.h * s->rolling_rate;
}

/* The tip's state at the middle of the step, from its shift at the beginning; then shift and indentation at
   the end. */
static void advance_tip(Contact *c)
{
    update_tip(c);
    c->s->shift -= c->tables.h * c->u[T];
    c->s->indentation -= c->tables.h * c->u[N];
}

static void record(const Contact *c, Step *row)
{
    const State *s = c->s;
    *row = (Step){.time = s->time,
                  .length = c->tables.h,
                  .friction_state = s->friction_state,
                  .phase = s->phase,
                  .angle = s->angle,
                  .damping_loss = s->damping_loss,
                  .radiated = s->radiated};
    memcpy(row->F, c->F, sizeof row->F);
    memcpy(row->v, c->v, sizeof row->v);
    memcpy(row->ball, s->ball, sizeof row->ball);
}

/* Take one step and return true; false if it must be repeated with the length s->next_step. The phase of the
   next step follows in run.c, from phases.c. */
bool take_step(Contact *c, Step *row)
{
    free_motion(c);
    contact_matrices(c);
    bool found = find_forces(c);
    if (!found) {
        halve(c);
        return false;
    }
    velocities(c);
    if (shorten_to_event(c)) return false;
    add_work(c);
    find_loads(c);
    advance_cue(c);
    advance_ball(c);
    if (c->in->rolling) roll(c);
    advance_tip(c);
    memcpy(c->s->former_F, c->s->last_F, sizeof c->F);
    memcpy(c->s->last_F, c->F, sizeof c->F);
    c->s->time += c->tables.h;
    record(c, row);
    return true;
}

/* Whether ball and tip separate; the impulses are then scaled so that they do so at e times the approach
   speed. */
static bool bounces(Contact *c)
{
    double gain = 0; /* of the normal velocity, m/s */
    for (int f = 0; f < c->in->forces; f++) gain += c->V[N][f] * c->F[f];
    if (c->v_free[N] + gain <= 0) return false;
    double scale = fmin(1, (1 + c->in->restitution) * fabs(c->v_free[N] / gain));
    for (int f = 0; f < c->in->forces; f++) c->F[f] *= scale;
    return true;
}

/* Impact of infinite friction at the first touch: an impulse stops the tip's tangential velocity and the
   ball's velocity into the table, with friction there. Return true if tip and ball stay in contact. */
bool take_impact(Contact *c, Step *row)
{
    State *s = c->s;
    free_motion(c);
    contact_matrices(c);
    bool solved = is_raised(c->in) ? raised_impulses(c) : level_impulses(c);
    if (!solved) s->status = UNSOLVED;
    bool parts = bounces(c);
    velocities(c);
    add_work(c);
    find_loads(c);
    advance_cue(c);
    advance_ball(c);
    s->friction_state = IMPACT;
    s->tip_stuck = true;
    s->on_table = true;
    s->table_stuck = c->table_stuck;
    record(c, row);
    memset(c->F, 0, sizeof c->F);
    return !parts;
}
