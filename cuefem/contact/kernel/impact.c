/* Impact of infinite friction at the first touch: an impulse stops the tip's tangential velocity and the
   ball's velocity into the table, with friction there. */
#include "contact.h"

/* Inverse mass between two forces of the contact, 1/kg. */
static double inverse_mass(const Work *w, int f, int g)
{
    const Contact *c = w->c;
    const int n_cue = c->ports + c->slopes;
    double sum = 0;
    for (int b = 0; b < c->speeds; b++)
        sum += w->C[f][n_cue + b] * c->inverse_masses[b] * w->C[g][n_cue + b];
    for (int p = 0; p < n_cue; p++)
        for (int q = 0; q < n_cue; q++) sum += w->C[f][p] * c->mobility[p * n_cue + q] * w->C[g][q];
    return sum;
}

/* The equations of contact_matrices for impulses: V = W, 1/kg, u = v, before the impact. */
static void impact_matrices(Work *w)
{
    const Contact *c = w->c;
    const int n_cue = c->ports + c->slopes;
    contact_kinematics(w, c->angle, w->slopes, w->C);
    for (int f = 0; f < c->forces; f++) {
        w->v[f] = 0;
        w->u_stick[f] = 0;
        for (int p = 0; p < n_cue; p++) w->v[f] += w->C[f][p] * w->port_velocities[p];
        for (int b = 0; b < c->speeds; b++) w->v[f] += w->C[f][n_cue + b] * w->ball[b];
        w->u[f] = w->v[f];
        for (int g = 0; g < c->forces; g++) {
            w->V[f][g] = inverse_mass(w, f, g);
            w->W[f][g] = w->V[f][g];
        }
    }
}

/* The impulses F, N s. Returns whether they converged. */
static int impulses(Work *w)
{
    if (w->c->forces > 2) return raised_impulses(w);
    w->F[T] = -w->v[T] / w->V[T][T];
    return 1;
}

/* Whether ball and tip separate; the impulses are then scaled so that they do so at e times the approach
   speed. */
static int separates(Work *w)
{
    const Contact *c = w->c;
    double gain = 0; /* of the normal velocity, m/s */
    for (int f = 0; f < c->forces; f++) gain += w->V[N][f] * w->F[f];
    if (w->v[N] + gain <= 0) return 0;
    double scale = fmin(1, (1 + c->restitution) * fabs(w->v[N] / gain));
    for (int f = 0; f < c->forces; f++) w->F[f] *= scale;
    return 1;
}

/* Apply the impulses to cue and ball; v: velocities of the contact after it. */
static void apply(Work *w, const double *v)
{
    Contact *c = w->c;
    const int n_cue = c->ports + c->slopes;
    double loads[VELOCITIES] = {0};
    for (int f = 0; f < c->forces; f++) {
        c->work[f] -= w->F[f] * (w->v[f] + v[f]) / 2;
        for (int p = 0; p < n_cue + c->speeds; p++) loads[p] += w->C[f][p] * w->F[f];
    }
    apply_impulses(w, loads);
    for (int b = 0; b < c->speeds; b++) w->ball[b] += c->inverse_masses[b] * loads[n_cue + b];
}

/* Returns 1 if tip and ball stay in contact. */
int impact(Work *w, Step *row)
{
    double unused[FORCES];
    impact_matrices(w);
    if (!impulses(w)) w->c->status = UNSOLVED;
    int parts = separates(w);
    velocities(w, row->v, unused);
    apply(w, row->v);
    memcpy(row->F, w->F, sizeof row->F);
    memset(w->F, 0, sizeof w->F);
    w->tip_stuck = 1;
    w->on_table = 1;
    return !parts;
}
