/* One time step: its forces, and the motion of cue, ball and contact under them. */
#include "contact.h"

/* A tip of restitution e unloads 1/e times as fast as it loads. Below this restitution, unloading steps are
   shortened by the factor e / MIN_STEP_RESTITUTION. */
static const double MIN_STEP_RESTITUTION = 0.5;
static const double MIN_FRACTION = 1e-6; /* of a step, to its event */

/* A step under way. */
typedef struct {
    double v[FORCES], u[FORCES]; /* velocities of the contact at its end, and on average */
    double loads[VELOCITIES];    /* on ports, slopes and ball, N */
    double section_rotation_rate; /* mean, of the cue's end section, rad/s */
    double spin;                  /* R times the ball's mean spin, m/s */
} Motion;

/* If ball and tip separate or touch within the step, prepare a shorter step that ends there and return 1. */
static int ends_early(Work *w, double u_n)
{
    Contact *c = w->c;
    const double h = w->t.h;
    double excess = c->indentation - residual(c), excess_at_end = excess - h * u_n;
    int separates = w->phase == UNLOADING && excess_at_end < 0;
    int touches = w->phase == FREE && excess < 0 && excess_at_end > 0;
    if (w->ends_at_event || !(separates || touches)) return 0;
    w->ends_at_event = 1;
    c->next_step = h * larger(excess / (h * u_n), MIN_FRACTION);
    return 1;
}

/* The work that the forces lose, and the loads on cue and ball. */
static void load(Work *w, Motion *m)
{
    Contact *c = w->c;
    const int n_velocities = c->ports + c->slopes + c->speeds;
    for (int f = 0; f < c->forces; f++) {
        c->work[f] -= w->t.h * w->F[f] * m->u[f];
        for (int p = 0; p < n_velocities; p++) m->loads[p] += w->C[f][p] * w->F[f];
    }
    w->axial_force = -m->loads[U_PORT];
}

static void advance_cue(Work *w, Motion *m)
{
    const Contact *c = w->c;
    const int n_cue = c->ports + c->slopes;
    load_modes(w, m->loads);
    add_losses(w);
    advance_modes(w);
    for (int p = 0; p < n_cue; p++) {
        double end = w->end_free[p], mean = w->mean_free[p];
        for (int q = 0; q < n_cue; q++) {
            end += w->t.end_per_load[p * n_cue + q] * m->loads[q];
            mean += w->t.mean_per_load[p * n_cue + q] * m->loads[q];
        }
        if (p == THIRD_PORT && c->ports > THIRD_PORT) m->section_rotation_rate = mean; /* used in rolling alone */
        if (p >= c->ports) w->slopes[p - c->ports] += w->t.h * mean;
        w->port_velocities[p] = end;
    }
}

static void advance_ball(Work *w, Motion *m)
{
    const Contact *c = w->c;
    const double *loads = m->loads + c->ports + c->slopes;
    double spin = w->ball[2];
    for (int b = 0; b < c->speeds; b++) w->ball[b] += w->t.h * c->inverse_masses[b] * loads[b];
    m->spin = (spin + w->ball[2]) / 2;
}

/* Rolling and slip move the contact over ball and dome; beyond the dome's rim over the ball alone. */
static void roll(Work *w, const Motion *m)
{
    Contact *c = w->c;
    double dome = fabs(c->phi + c->angle) < c->rim ? c->dome : 0;
    w->rolling_rate = (m->spin - m->u[T] + dome * m->section_rotation_rate) / (c->radius + dome);
    c->angle += w->t.h * w->rolling_rate;
}

/* Friction state of the step, at a mean tangential velocity u. */
static int friction_state_of(const Work *w, double u)
{
    const Contact *c = w->c;
    if (c->friction > 0 || c->forces > 2) return w->patch->friction_state(w);
    if (u == 0) return STICK; /* no friction force: by the velocity */
    return u < 0 ? SLIP : SLIP_BACK;
}

static void advance_tip(Work *w, const Motion *m)
{
    Contact *c = w->c;
    const double h = w->t.h;
    if (w->phase == FREE) {
        c->friction_state = SEPARATED;
        w->shift_mid = w->shift - h * m->u[T];
        w->origin = w->shift_mid; /* unstrained at touch */
    } else {
        w->shift_mid = w->shift - h / 2 * m->u[T];
        w->patch->keep(w, w->shift_mid);
        w->virtual_mid = w->virtual_now;
        c->friction_state = friction_state_of(w, m->u[T]);
        w->tip_stuck = !w->slip;
    }
    w->shift -= h * m->u[T];
    c->indentation -= h * m->u[N];
    if (c->forces > 2) c->height = larger(0, c->height + h * m->u[UP]);
}

static void record(const Work *w, const Motion *m, Step *row)
{
    const Contact *c = w->c;
    *row = (Step){.time = c->time,
                  .length = w->t.h,
                  .friction_state = c->friction_state,
                  .phase = w->phase,
                  .angle = c->angle};
    memcpy(row->F, w->F, sizeof row->F);
    memcpy(row->v, m->v, c->forces * sizeof(double));
}

/* Take one step and return 1; return 0 if it must be shorter. */
int take_step(Work *w, Step *row)
{
    Motion m = {0};
    free_motion(w);
    contact_matrices(w);
    int solved = w->phase == FREE || w->solve_forces(w);
    if (!solved) w->c->status = UNSOLVED;
    velocities(w, m.v, m.u);
    if (ends_early(w, m.u[N])) return 0;
    load(w, &m);
    advance_cue(w, &m);
    advance_ball(w, &m);
    if (w->c->rolling) roll(w, &m);
    advance_tip(w, &m);
    w->c->time += w->t.h;
    record(w, &m, row);
    return 1;
}

/* Separation: the tip forgets its strain; modal state, ball and losses are copied to the Contact. */
void separate(Work *w)
{
    Contact *c = w->c;
    if (c->steps > c->steps_to_last_separation) w->patch->release(w, w->shift);
    c->steps_to_last_separation = c->steps;
    w->deadline = c->max_time + c->time;
    w->phase = FREE;
    w->ends_at_event = 0;
    w->tip_stuck = 0;
    w->virtual_mid = 0;
    w->origin = w->shift;
    w->shift_mid = w->shift;
    memset(w->annulus_force, 0, sizeof w->annulus_force);
    memset(w->F, 0, sizeof w->F);
    memcpy(c->state, w->state, 2 * c->modes * sizeof(double));
    memcpy(c->ball, w->ball, c->speeds * sizeof(double));
    c->damping_loss = w->damping_loss;
    c->radiated = w->radiated;
    if (!isfinite(w->window_end)) w->window_end = c->time + c->window;
}

static double unloading_step(const Contact *c)
{
    if (c->restitution >= MIN_STEP_RESTITUTION) return c->step;
    return c->step * c->restitution / MIN_STEP_RESTITUTION;
}

/* Normal phase and length of the next step; v_n: normal velocity of the contact at the end of this one.
   Handbook: The strike: F = k d loading, (k/e^2)(d - (1 - e^2) D) unloading; Low restitution: h e/0.5. */
void next_phase(Work *w, double v_n)
{
    Contact *c = w->c;
    int indented = c->indentation > residual(c);
    c->next_step = w->t.h;
    if (w->phase == LOADING && v_n > 0) {
        c->max_indentation = larger(c->max_indentation, c->indentation);
        w->phase = UNLOADING;
        c->next_step = unloading_step(c);
    } else if (w->phase == UNLOADING && (w->ends_at_event || !indented)) {
        separate(w);
        c->next_step = c->step;
    } else if (w->phase == UNLOADING && c->indentation > c->max_indentation) {
        w->phase = LOADING;
        c->next_step = c->step;
    } else if (w->phase == FREE && (w->ends_at_event || indented)) {
        /* below max_indentation a second contact follows the unloading curve, beyond it the loading curve */
        w->phase = UNLOADING;
        w->ends_at_event = 0;
        c->next_step = unloading_step(c);
    }
}
