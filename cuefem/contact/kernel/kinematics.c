/* Kinematics of the contact, and the equations of a step: its velocities as functions of its forces. */
#include "contact.h"

/* C of the contact (t, n) after it has rolled by an angle, rad, over ball and dome. */
static void rolled_kinematics(const Input *in, double angle, double C[FORCES][VELOCITIES])
{
    const int n_cue = in->ports + in->slopes;
    double at = in->phi + angle, s = sin(at), cs = cos(at), sa = sin(angle), ca = cos(angle);
    /* angle of the dome at the contact, at the first touch and now; beyond the rim that of its edge */
    double first = fmin(in->phi, in->rim), now = copysign(fmin(fabs(at), in->rim), at);
    /* change of the contact's displacement (u, w) per unit rotation of the end section, m */
    double du = in->dome * (sin(first) - sin(now)), dw = in->dome * (cos(first) - cos(now));
    C[T][AXIAL_PORT] = -s;
    C[T][LATERAL_PORT] = -cs;
    C[N][AXIAL_PORT] = -cs;
    C[N][LATERAL_PORT] = s;
    if (in->ports > THIRD_PORT) {
        C[T][THIRD_PORT] = -(ca * in->arm_t + sa * in->arm_n + s * du + cs * dw);
        C[N][THIRD_PORT] = -(ca * in->arm_n - sa * in->arm_t + cs * du - s * dw);
    }
    C[T][n_cue] = ca;
    C[T][n_cue + 1] = sa;
    C[N][n_cue] = -sa;
    C[N][n_cue + 1] = ca;
}

/* C at mid-step, where the contact has rolled on by half of the step's angle. Bending shortens the cue by the
   sum of weight slope^2/2 (second-order theory), so that the tip's axial velocity is reduced by the sum of
   weight slope slope'. The slopes move on as over the last step: the velocity at its end would move a mode
   that swings through within a step by many of its amplitudes. */
static void kinematics_at_middle(const Input *in, double h, const State *s, Work *w)
{
    const int ports = in->ports, n_cue = ports + in->slopes, n_velocities = ports + in->speeds;
    const double half = h / 2;
    for (int a = 0; a < in->slopes; a++)
        w->shortening[a] = in->slope_weights[a] * (s->slopes[a] + half * s->mean_velocities[ports + a]);
    for (int f = 0; f < in->forces; f++) {
        memcpy(w->C[f], in->kinematics + f * n_velocities, ports * sizeof(double));
        memcpy(w->C[f] + n_cue, in->kinematics + f * n_velocities + ports, in->speeds * sizeof(double));
    }
    if (in->rolling) rolled_kinematics(in, s->angle + half * s->rolling_rate, w->C);
    for (int f = 0; f < in->forces; f++)
        for (int a = 0; a < in->slopes; a++) w->C[f][ports + a] = -w->C[f][AXIAL_PORT] * w->shortening[a];
}

/* Whether the point of a force stuck in the last step. */
static bool stuck(const State *s, int f)
{
    if (f == UP) return s->on_table;
    if (f > UP) return s->table_stuck;
    return s->tip_stuck;
}

/* Velocity of a port or slope at the beginning of the step, between its means over the last step and over this
   one under the last forces. That of the modes then would be none of a mode that swings through within a step. */
static double initial_velocity(const Input *in, const State *s, const Work *w, int port)
{
    double mean = w->mean_free[port];
    for (int f = 0; f < in->forces; f++) mean += w->mean_per_force[f][port] * s->last_F[f];
    return (s->mean_velocities[port] + mean) / 2;
}

/* v_free, u_free and u_stick, m/s. A point that stuck before keeps the mean velocity 0; one that slipped and
   comes to rest has half of its initial velocity. */
static void free_velocities(const Input *in, const State *s, Work *w)
{
    const int n_cue = in->ports + in->slopes;
    for (int f = 0; f < in->forces; f++) {
        const double *C = w->C[f];
        double ball = 0;
        for (int b = 0; b < in->speeds; b++) ball += C[n_cue + b] * s->ball[b];
        w->v_free[f] = ball;
        w->u_free[f] = ball;
        w->u_stick[f] = ball / 2;
        for (int q = 0; q < n_cue; q++) {
            w->v_free[f] += C[q] * w->end_free[q];
            w->u_free[f] += C[q] * w->mean_free[q];
            w->u_stick[f] += C[q] * initial_velocity(in, s, w, q) / 2;
        }
        if (stuck(s, f)) w->u_stick[f] = 0;
    }
}

/* Velocities of ports and slopes per force f of the contact, by a table of them per load. All slopes have the
   same share of the loads of every force: bending shortens the cue along its axis alone. */
FAST static void per_force(const Input *in, const Work *w, const double *table,
                           double result[FORCES][CUE_VELOCITIES])
{
    const int ports = in->ports, n_cue = ports + in->slopes;
    for (int p = 0; p < n_cue; p++) {
        const double *per_load = table + p * n_cue;
        double per_shortening = 0;
        for (int q = ports; q < n_cue; q++) per_shortening += per_load[q] * w->shortening[q - ports];
        for (int f = 0; f < in->forces; f++) {
            double sum = -w->C[f][AXIAL_PORT] * per_shortening;
            for (int q = 0; q < ports; q++) sum += per_load[q] * w->C[f][q];
            result[f][p] = sum;
        }
    }
}

/* Change of the contact's velocities per force, (m/s)/N: V at the end of the step, W on average over it.
   Handbook: The contact, Ports and the matrix C: v = C y, loads = C' F. */
static void velocities_per_force(const Input *in, const StepTables *t, Work *w)
{
    const int n_cue = in->ports + in->slopes;
    per_force(in, w, t->end_per_load, w->end_per_force);
    per_force(in, w, t->mean_per_load, w->mean_per_force);
    for (int f = 0; f < in->forces; f++)
        for (int g = 0; g < in->forces; g++) {
            double ball = 0, ends = 0, means = 0;
            for (int b = 0; b < in->speeds; b++)
                ball += t->load_time * w->C[f][n_cue + b] * in->inverse_masses[b] * w->C[g][n_cue + b];
            for (int p = 0; p < n_cue; p++) {
                ends += w->C[f][p] * w->end_per_force[g][p];
                means += w->C[f][p] * w->mean_per_force[g][p];
            }
            w->V[f][g] = ends + ball;
            w->W[f][g] = means + ball / 2;
        }
}

/* The linear equations of a step: v = v_free + V F and u = u_free + W F. */
void contact_matrices(const Input *in, const StepTables *t, const State *s, Work *w)
{
    kinematics_at_middle(in, t->h, s, w);
    velocities_per_force(in, t, w);
    free_velocities(in, s, w);
}

/* The contact's velocities v and u under the forces F. */
void velocities(const Input *in, Work *w)
{
    for (int f = 0; f < in->forces; f++) {
        w->v[f] = w->v_free[f];
        w->u[f] = w->u_free[f];
        for (int g = 0; g < in->forces; g++) {
            w->v[f] += w->V[f][g] * w->F[g];
            w->u[f] += w->W[f][g] * w->F[g];
        }
    }
}
