/* One time step: its forces, and the motion of cue, ball and contact under them (handbook: One step). */
#include "contact.h"

static const double MIN_FRACTION = 1e-6; /* of a step, to its event */

/* A step under way. */
typedef struct {
    double v[FORCES], u[FORCES];  /* velocities of the contact at its end, and on average */
    double loads[VELOCITIES];     /* on ports, slopes and ball, N */
    double section_rotation_rate; /* mean, of the cue's end section, rad/s */
    double spin;                  /* R times the ball's mean spin, m/s */
} Motion;

/* If ball and tip separate or touch within the step, prepare a shorter step that ends there and return 1. */
static int ends_early(Contact *c, double u_n)
{
    State *s = c->s;
    const double h = c->t.h;
    double excess = s->indentation - residual(c), excess_at_end = excess - h * u_n;
    if (s->ends_at_event || !phase_of(c)->has_event(excess, excess_at_end)) return 0;
    s->ends_at_event = 1;
    s->next_step = h * larger(excess / (h * u_n), MIN_FRACTION);
    return 1;
}

/* The work that the forces lose, and the loads on cue and ball. */
static void load(Contact *c, Motion *m)
{
    const Input *in = c->in;
    const int n_velocities = in->ports + in->slopes + in->speeds;
    for (int f = 0; f < in->forces; f++) {
        c->s->work[f] -= c->t.h * c->F[f] * m->u[f];
        for (int p = 0; p < n_velocities; p++) m->loads[p] += c->C[f][p] * c->F[f];
    }
    c->axial_force = -m->loads[U_PORT];
}

static void advance_cue(Contact *c, Motion *m)
{
    const Input *in = c->in;
    State *s = c->s;
    const int n_cue = in->ports + in->slopes;
    load_modes(c, m->loads);
    add_losses(c);
    advance_modes(c);
    for (int p = 0; p < n_cue; p++) {
        double end = c->end_free[p], mean = c->mean_free[p];
        for (int f = 0; f < in->forces; f++) {
            end += c->end_per_force[f][p] * c->F[f];
            mean += c->mean_per_force[f][p] * c->F[f];
        }
        if (p == THIRD_PORT && in->ports > THIRD_PORT)
            m->section_rotation_rate = mean; /* used in rolling alone */
        if (p >= in->ports) s->slopes[p - in->ports] += c->t.h * mean;
        s->port_velocities[p] = end;
    }
}

static void advance_ball(Contact *c, Motion *m)
{
    const Input *in = c->in;
    const double *loads = m->loads + in->ports + in->slopes;
    double *ball = c->s->ball;
    double spin = ball[2];
    for (int b = 0; b < in->speeds; b++) ball[b] += c->t.h * in->inverse_masses[b] * loads[b];
    m->spin = (spin + ball[2]) / 2;
    c->s->height = larger(0, c->s->height + c->t.h * m->u[UP]);
}

/* Rolling and slip move the contact over ball and dome; beyond the dome's rim over the ball alone. */
static void roll(Contact *c, const Motion *m)
{
    const Input *in = c->in;
    State *s = c->s;
    double dome = fabs(in->phi + s->angle) < in->rim ? in->dome : 0;
    s->rolling_rate = (m->spin - m->u[T] + dome * m->section_rotation_rate) / (in->radius + dome);
    s->angle += c->t.h * s->rolling_rate;
}

static void advance_tip(Contact *c, const Motion *m)
{
    phase_of(c)->keep(c, m->u[T]);
    c->s->shift -= c->t.h * m->u[T];
    c->s->indentation -= c->t.h * m->u[N];
}

static void record(const Contact *c, const Motion *m, Step *row)
{
    const State *s = c->s;
    *row = (Step){.time = s->time,
                  .length = c->t.h,
                  .friction_state = s->friction_state,
                  .phase = s->phase,
                  .angle = s->angle,
                  .damping_loss = s->damping_loss,
                  .radiated = s->radiated};
    memcpy(row->F, c->F, sizeof row->F);
    memcpy(row->v, m->v, c->in->forces * sizeof(double));
    memcpy(row->ball, s->ball, sizeof row->ball);
}

/* Take one step and return 1; return 0 if it must be repeated with a shorter length. The forces are those of
   the law (laws.c) and of friction (patch_*.c), solved together by level.c or raised.c. */
int take_step(Contact *c, Step *row)
{
    Motion m = {0};
    free_motion(c);
    contact_matrices(c);
    int solved = phase_of(c)->forces(c);
    if (!solved) c->s->status = UNSOLVED;
    velocities(c, m.v, m.u);
    if (ends_early(c, m.u[N])) return 0;
    load(c, &m);
    advance_cue(c, &m);
    advance_ball(c, &m);
    if (c->in->rolling) roll(c, &m);
    advance_tip(c, &m);
    c->s->time += c->t.h;
    record(c, &m, row);
    return 1;
}
