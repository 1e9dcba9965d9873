/* Kinematics of the contact, and the equations of a step: its velocities as functions of its forces. */
#include "contact.h"

/* C of the contact (t, n) after it has rolled by an angle, rad, over ball and dome. */
static void rolled_kinematics(const Contact *c, double angle, double C[FORCES][VELOCITIES])
{
    const int n_cue = c->ports + c->slopes;
    double at = c->phi + angle, s = sin(at), cs = cos(at), sa = sin(angle), ca = cos(angle);
    /* angle of the dome at the contact, at the first touch and now; beyond the rim that of its edge */
    double first = fmin(c->phi, c->rim), now = copysign(fmin(fabs(at), c->rim), at);
    /* change of the contact's displacement (u, w) per unit rotation of the end section, m */
    double du = c->dome * (sin(first) - sin(now)), dw = c->dome * (cos(first) - cos(now));
    C[T][U_PORT] = -s;
    C[T][W_PORT] = -cs;
    C[N][U_PORT] = -cs;
    C[N][W_PORT] = s;
    if (c->ports > 2) {
        C[T][THIRD_PORT] = -(ca * c->arm_t + sa * c->arm_n + s * du + cs * dw);
        C[N][THIRD_PORT] = -(ca * c->arm_n - sa * c->arm_t + cs * du - s * dw);
    }
    C[T][n_cue] = ca;
    C[T][n_cue + 1] = sa;
    C[N][n_cue] = -sa;
    C[N][n_cue + 1] = ca;
}

/* C after the contact has rolled by an angle, rad, on a shaft bent by slopes. Bending shortens the cue by the
   sum of weight slope^2/2 (second-order theory), so that the tip's axial velocity is reduced by the sum of
   weight slope slope'. */
void contact_kinematics(const Work *w, double angle, const double *slopes, double C[FORCES][VELOCITIES])
{
    const Contact *c = w->c;
    const int ports = c->ports, n_cue = ports + c->slopes, n_velocities = ports + c->speeds;
    for (int f = 0; f < c->forces; f++) {
        memcpy(C[f], c->kinematics + f * n_velocities, ports * sizeof(double));
        memcpy(C[f] + n_cue, c->kinematics + f * n_velocities + ports, c->speeds * sizeof(double));
    }
    if (c->rolling) rolled_kinematics(c, angle, C);
    for (int f = 0; f < c->forces; f++)
        for (int a = 0; a < c->slopes; a++) C[f][ports + a] = -C[f][U_PORT] * c->slope_weights[a] * slopes[a];
}

/* C at mid-step. */
static void kinematics_at_middle(Work *w)
{
    const Contact *c = w->c;
    double half = w->t.h / 2, bent[SLOPES];
    for (int a = 0; a < c->slopes; a++) bent[a] = w->slopes[a] + half * w->port_velocities[c->ports + a];
    contact_kinematics(w, c->angle + half * w->rolling_rate, bent, w->C);
}

/* Whether the point of a force stuck in the last step. */
static int stuck(const Work *w, int f)
{
    if (f == UP) return w->on_table;
    if (f > UP) return w->table_stuck;
    return w->tip_stuck;
}

/* Velocities of the contact without forces, m/s: v at the end of the step, u on average over it. u_stick:
   mean velocity of a sticking point: 0, or half of the initial velocity where it slipped before and comes to
   rest. */
static void free_velocities(Work *w)
{
    const Contact *c = w->c;
    const int n_cue = c->ports + c->slopes;
    for (int f = 0; f < c->forces; f++) {
        const double *C = w->C[f];
        double ball = 0;
        for (int b = 0; b < c->speeds; b++) ball += C[n_cue + b] * w->ball[b];
        w->v[f] = ball;
        w->u[f] = ball;
        w->u_stick[f] = ball / 2;
        for (int q = 0; q < n_cue; q++) {
            w->v[f] += C[q] * w->end_free[q];
            w->u[f] += C[q] * w->mean_free[q];
            w->u_stick[f] += C[q] * w->port_velocities[q] / 2;
        }
        if (stuck(w, f)) w->u_stick[f] = 0;
    }
}

/* Velocities of the cue's ports and slopes per force f of the contact: a row of C times a table. */
static void per_force(const Work *w, int f, const double *table, double *row)
{
    const int n_cue = w->c->ports + w->c->slopes;
    for (int q = 0; q < n_cue; q++) {
        row[q] = 0;
        for (int p = 0; p < n_cue; p++) row[q] += w->C[f][p] * table[p * n_cue + q];
    }
}

/* Change of the contact's velocities per force, (m/s)/N: V at the end of the step, W on average over it.
   Handbook: The contact, Ports and the matrix C: v = C y, loads = C' F. */
static void velocities_per_force(Work *w)
{
    const Contact *c = w->c;
    const int n_cue = c->ports + c->slopes;
    for (int f = 0; f < c->forces; f++) {
        double end[CUE_VELOCITIES], mean[CUE_VELOCITIES];
        per_force(w, f, w->t.end_per_load, end);
        per_force(w, f, w->t.mean_per_load, mean);
        for (int g = 0; g < c->forces; g++) {
            double ball = 0, ends = 0, means = 0;
            for (int b = 0; b < c->speeds; b++)
                ball += w->t.h * w->C[f][n_cue + b] * c->inverse_masses[b] * w->C[g][n_cue + b];
            for (int q = 0; q < n_cue; q++) {
                ends += end[q] * w->C[g][q];
                means += mean[q] * w->C[g][q];
            }
            w->V[f][g] = ends + ball;
            w->W[f][g] = means + ball / 2;
        }
    }
}

/* The linear equations of a step: C, v, u, u_stick, V and W. */
void contact_matrices(Work *w)
{
    kinematics_at_middle(w);
    free_velocities(w);
    velocities_per_force(w);
}

/* Velocities of the contact at the end of the step and on average over it, under the forces F. */
void velocities(const Work *w, double *end, double *mean)
{
    for (int f = 0; f < w->c->forces; f++) {
        end[f] = w->v[f];
        mean[f] = w->u[f];
        for (int g = 0; g < w->c->forces; g++) {
            end[f] += w->V[f][g] * w->F[g];
            mean[f] += w->W[f][g] * w->F[g];
        }
    }
}
