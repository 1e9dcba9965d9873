/* Impact of infinite friction at the first touch: an impulse stops the tip's tangential velocity and the
   ball's velocity into the table, with friction there. */
#include "contact.h"

/* Inverse mass between two forces of the contact, 1/kg. */
static double inverse_mass(const Contact *c, int f, int g)
{
    const Input *in = c->in;
    const int n_cue = in->ports + in->slopes;
    double sum = 0;
    for (int b = 0; b < in->speeds; b++)
        sum += c->C[f][n_cue + b] * in->inverse_masses[b] * c->C[g][n_cue + b];
    for (int p = 0; p < n_cue; p++)
        for (int q = 0; q < n_cue; q++) sum += c->C[f][p] * in->mobility[p * n_cue + q] * c->C[g][q];
    return sum;
}

/* The equations of contact_matrices for impulses: V = W, 1/kg; v_free = u_free, before the impact. */
static void impact_matrices(Contact *c)
{
    const Input *in = c->in;
    const State *s = c->s;
    const int n_cue = in->ports + in->slopes;
    contact_kinematics(c, s->angle, s->slopes);
    for (int f = 0; f < in->forces; f++) {
        c->v_free[f] = 0;
        c->u_stick[f] = 0;
        for (int p = 0; p < n_cue; p++) c->v_free[f] += c->C[f][p] * s->port_velocities[p];
        for (int b = 0; b < in->speeds; b++) c->v_free[f] += c->C[f][n_cue + b] * s->ball[b];
        c->u_free[f] = c->v_free[f];
        for (int g = 0; g < in->forces; g++) {
            c->V[f][g] = inverse_mass(c, f, g);
            c->W[f][g] = c->V[f][g];
        }
    }
}

/* Whether ball and tip separate; the impulses are then scaled so that they do so at e times the approach
   speed. */
static int separates(Contact *c)
{
    const Input *in = c->in;
    double gain = 0; /* of the normal velocity, m/s */
    for (int f = 0; f < in->forces; f++) gain += c->V[N][f] * c->F[f];
    if (c->v_free[N] + gain <= 0) return 0;
    double scale = fmin(1, (1 + in->restitution) * fabs(c->v_free[N] / gain));
    for (int f = 0; f < in->forces; f++) c->F[f] *= scale;
    return 1;
}

/* Apply the impulses to cue and ball; v: velocities of the contact after it. */
static void apply(Contact *c, const double *v)
{
    const Input *in = c->in;
    State *s = c->s;
    const int n_cue = in->ports + in->slopes;
    double loads[VELOCITIES] = {0};
    for (int f = 0; f < in->forces; f++) {
        s->work[f] -= c->F[f] * (c->v_free[f] + v[f]) / 2;
        for (int p = 0; p < n_cue + in->speeds; p++) loads[p] += c->C[f][p] * c->F[f];
    }
    apply_impulses(c, loads);
    for (int b = 0; b < in->speeds; b++) s->ball[b] += in->inverse_masses[b] * loads[n_cue + b];
}

/* Take the impact; return 1 if tip and ball stay in contact. */
int impact(Contact *c, Step *row)
{
    State *s = c->s;
    double unused[FORCES];
    *row = (Step){.friction_state = IMPACT};
    impact_matrices(c);
    int solved = c->cue->impulses(c);
    if (!solved) s->status = UNSOLVED;
    int parts = separates(c);
    velocities(c, row->v, unused);
    apply(c, row->v);
    update_port_velocities(c);
    memcpy(row->F, c->F, sizeof row->F);
    memcpy(row->ball, s->ball, sizeof row->ball);
    memset(c->F, 0, sizeof c->F);
    s->tip_stuck = 1;
    s->on_table = 1;
    return !parts;
}
