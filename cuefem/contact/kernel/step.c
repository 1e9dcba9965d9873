/* One time step: its forces, and the motion of cue, ball and contact under them (handbook: One step).

   Begin with take_step, below; contact.h explains F, u, v and C. The forces come from level.c, or raised.c
   for a cue raised over a table: the law of the tip (laws.c) and friction (patch_*.c), solved together. */
#include "contact.h"

static const double MIN_FRACTION = 1e-6; /* of a step, to its event */

/* The forces of the step, 0 in free flight. Returns whether they were found. */
static bool find_forces(const Input *in, double h, const State *s, Work *w)
{
    if (touches(s)) return is_raised(in) ? raised_forces(in, h, s, w) : level_forces(in, h, s, w);
    memset(w->F, 0, sizeof w->F);
    return true;
}

/* Repeat a step whose forces were not found at half of its length. Newton's method may alternate where a
   sticking tip hardly touches: there the tangential stiffness of leather is like a root of the indentation.
 */
static void halve(const Input *in, double h, State *s)
{
    s->next_step = h / 2;
    s->ends_at_event = false;
    if (s->next_step < MIN_FRACTION * in->step) s->status = UNSOLVED;
}

/* Sign of the indentation's change at which a step ends: at a touch 1, at a separation -1; 0 for no event. */
static int event_sign(int phase)
{
    if (phase == FREE) return 1;
    return phase == UNLOADING ? -1 : 0;
}

/* Ball and tip separate or touch where the indentation passes the residual one. If that happens within the
   step, set the length of a step that ends there, which replaces this one, and return true. */
static bool shorten_to_event(const Input *in, double h, State *s, const Work *w)
{
    const int event = event_sign(s->phase);
    double excess = s->indentation - residual_indentation(in, s);
    double excess_at_end = excess - h * w->u[N];
    bool passes = event * excess < 0 && event * excess_at_end > 0;
    if (s->ends_at_event || !passes) return false;
    s->ends_at_event = true;
    s->next_step = h * larger(excess / (h * w->u[N]), MIN_FRACTION);
    return true;
}

/* The work that each force dissipates: its impulse by the mean velocity, with the opposite sign. */
static void add_work(const Input *in, const StepTables *t, State *s, const Work *w)
{
    for (int f = 0; f < in->forces; f++) s->work[f] -= t->load_time * w->F[f] * w->u[f];
}

/* The loads C' F on ports, slopes and ball. */
static void find_loads(const Input *in, Work *w)
{
    const int n_cue = in->ports + in->slopes;
    memset(w->loads, 0, n_cue * sizeof(double));
    memset(w->ball_loads, 0, sizeof w->ball_loads);
    for (int f = 0; f < in->forces; f++) {
        for (int p = 0; p < n_cue; p++) w->loads[p] += w->C[f][p] * w->F[f];
        for (int b = 0; b < in->speeds; b++) w->ball_loads[b] += w->C[f][n_cue + b] * w->F[f];
    }
    w->axial_force = -w->loads[AXIAL_PORT];
}

static void advance_cue(const Input *in, const StepTables *t, State *s, Work *w)
{
    load_modes(in, t, s, w);
    advance_modes(in, t, s, w);
    if (t->h > 0) add_losses(in, t, s, w);
    for (int p = 0; p < in->ports + in->slopes; p++) {
        s->mean_velocities[p] = w->mean_free[p];
        for (int f = 0; f < in->forces; f++) s->mean_velocities[p] += w->mean_per_force[f][p] * w->F[f];
    }
    for (int a = 0; a < in->slopes; a++) s->slopes[a] += t->h * s->mean_velocities[in->ports + a];
}

static void advance_ball(const Input *in, const StepTables *t, State *s, Work *w)
{
    const double spin = s->ball[BALL_SPIN];
    for (int b = 0; b < in->speeds; b++)
        s->ball[b] += t->load_time * in->inverse_masses[b] * w->ball_loads[b];
    w->mean_spin = (spin + s->ball[BALL_SPIN]) / 2;
    s->height = larger(0, s->height + t->h * w->u[UP]);
}

/* Rolling and slip move the contact over ball and dome; beyond the dome's rim over the ball alone. The third
   port of a cue that rolls on a dome is the rotation of its end section. */
static void roll(const Input *in, double h, State *s, const Work *w)
{
    double dome = fabs(in->phi + s->angle) < in->rim ? in->dome : 0;
    double section_rotation = in->ports > THIRD_PORT ? s->mean_velocities[THIRD_PORT] : 0;
    s->rolling_rate = (w->mean_spin - w->u[T] + dome * section_rotation) / (in->radius + dome);
    s->angle += h * s->rolling_rate;
}

/* The tip's state at the middle of the step, from its shift at the beginning; then shift and indentation at
   the end. */
static void advance_tip(const Input *in, double h, State *s, const Work *w)
{
    update_tip(in, h, s, w);
    s->shift -= h * w->u[T];
    s->indentation -= h * w->u[N];
}

static void record(double h, const State *s, const Work *w, Step *row)
{
    *row = (Step){.time = s->time,
                  .length = h,
                  .friction_state = s->friction_state,
                  .phase = s->phase,
                  .angle = s->angle,
                  .damping_loss = s->damping_loss,
                  .radiated = s->radiated};
    memcpy(row->F, w->F, sizeof row->F);
    memcpy(row->v, w->v, sizeof row->v);
    memcpy(row->ball, s->ball, sizeof row->ball);
}

/* Take one step and return true; false if it must be repeated with the length s->next_step: half of this one,
   as no forces were found, or up to the separation or touch within it. The phase of the next step follows in
   run.c, from phases.c. */
bool take_step(const Input *in, const StepTables *t, State *s, Work *w, Step *row)
{
    free_motion(in, t, s, w);
    contact_matrices(in, t, s, w);
    bool found = find_forces(in, t->h, s, w);
    if (!found) {
        halve(in, t->h, s);
        return false;
    }
    velocities(in, w);
    if (shorten_to_event(in, t->h, s, w)) return false;
    add_work(in, t, s, w);
    find_loads(in, w);
    advance_cue(in, t, s, w);
    advance_ball(in, t, s, w);
    if (in->rolling) roll(in, t->h, s, w);
    advance_tip(in, t->h, s, w);
    memcpy(s->former_F, s->last_F, sizeof w->F);
    memcpy(s->last_F, w->F, sizeof w->F);
    s->time += t->h;
    record(t->h, s, w, row);
    return true;
}

/* Whether ball and tip separate; the impulses are then scaled so that they do so at e times the approach
   speed. */
static bool bounces(const Input *in, Work *w)
{
    double gain = 0; /* of the normal velocity, m/s */
    for (int f = 0; f < in->forces; f++) gain += w->V[N][f] * w->F[f];
    if (w->v_free[N] + gain <= 0) return false;
    double scale = fmin(1, (1 + in->restitution) * fabs(w->v_free[N] / gain));
    for (int f = 0; f < in->forces; f++) w->F[f] *= scale;
    return true;
}

/* Impact of infinite friction at the first touch: an impulse stops the tip's tangential velocity and the
   ball's velocity into the table, with friction there. Return true if tip and ball stay in contact. */
bool take_impact(const Input *in, const StepTables *t, State *s, Work *w, Step *row)
{
    free_motion(in, t, s, w);
    contact_matrices(in, t, s, w);
    bool solved = is_raised(in) ? raised_impulses(in, s, w) : level_impulses(in, s, w);
    if (!solved) s->status = UNSOLVED;
    bool parts = bounces(in, w);
    velocities(in, w);
    add_work(in, t, s, w);
    find_loads(in, w);
    advance_cue(in, t, s, w);
    advance_ball(in, t, s, w);
    s->friction_state = IMPACT;
    s->tip_stuck = true;
    s->on_table = true;
    s->table_stuck = w->table_stuck;
    record(t->h, s, w, row);
    return !parts;
}
