/* The forces of a raised cue, over a unilateral table contact: block Gauss-Seidel over the normal force, the
   tip's friction, and the table's normal force and friction. */
#include "contact.h"

enum { MAX_SWEEPS = 1000, MAX_BISECTIONS = 60 };
static const double REL_TOL_SWEEPS = 1e-11; /* sweeps converge slowly */

/* Mean velocity of the contact along a force's direction, under all forces, m/s. */
static double mean_velocity(const Work *w, int a)
{
    double u = w->u_free[a];
    for (int f = 0; f < FORCES; f++) u += w->W[a][f] * w->F[f];
    return u;
}

static void scale_to(double bound, double *p, double *q)
{
    double size = hypot(*p, *q);
    if (size > bound) {
        *p *= bound / size;
        *q *= bound / size;
    }
}

/* The friction force (p, q) of a slipping point opposes its mean velocity: projected-gradient steps on the
   disc of the bound. u_a, u_b: mean velocities at the present forces F. */
static void slide(const Work *w, int a, int b, double u_a, double u_b, double bound, double *p, double *q)
{
    const double (*W)[FORCES] = w->W, *F = w->F;
    const double rho = 1 / larger(W[a][a], W[b][b]);
    for (int i = 0; i < MAX_ITERATIONS; i++) {
        double to_p = *p - rho * (u_a + W[a][a] * (*p - F[a]) + W[a][b] * (*q - F[b]));
        double to_q = *q - rho * (u_b + W[b][a] * (*p - F[a]) + W[b][b] * (*q - F[b]));
        scale_to(bound, &to_p, &to_q);
        double change = fabs(to_p - *p) + fabs(to_q - *q);
        *p = to_p;
        *q = to_q;
        if (change < REL_TOL * bound) return;
    }
}

/* Solve F[a], F[b] in place, hypot(F[a], F[b]) <= bound; return whether the point sticks. */
static bool plane_friction(Work *w, int a, int b, double bound)
{
    const double (*W)[FORCES] = w->W;
    double *F = w->F, det = W[a][a] * W[b][b] - W[a][b] * W[b][a];
    double u_a = mean_velocity(w, a), u_b = mean_velocity(w, b);
    double x = u_a - w->u_stick[a], y = u_b - w->u_stick[b];
    double p = F[a] - (W[b][b] * x - W[a][b] * y) / det;
    double q = F[b] - (W[a][a] * y - W[b][a] * x) / det;
    bool sticks = hypot(p, q) <= bound * (1 + REL_TOL);
    if (!sticks) {
        scale_to(bound, &p, &q);
        slide(w, a, b, u_a, u_b, bound, &p, &q);
    }
    F[a] = p;
    F[b] = q;
    return sticks;
}

/* Newton's method for F_n, the other forces held. Returns whether it converged. */
static bool tip_force(const Input *in, double h, const State *s, Work *w)
{
    const double half = h / 2;
    double correction = 0;
    for (int i = 0; i < MAX_ITERATIONS; i++) {
        NormalForce normal = normal_force(in, s, s->indentation - half * mean_velocity(w, N));
        correction = (w->F[N] - normal.force) / (1 + normal.slope * half * w->W[N][N]);
        w->F[N] -= correction;
        if (fabs(correction) <= REL_TOL * fabs(w->F[N])) return true;
    }
    return fabs(correction) <= REL_TOL_ACCEPTED * (fabs(w->F[N]) + MIN_FORCE);
}

/* The table's normal force: it pushes the ball unless that rises. */
static void table_force(double h, const State *s, Work *w)
{
    const double height = s->height;
    double u = w->u_free[UP] - w->W[UP][UP] * w->F[UP]; /* without the table */
    for (int f = 0; f < FORCES; f++) u += w->W[UP][f] * w->F[f];
    bool leaves = height > 0 && height + h * u > 0;
    w->F[UP] = leaves ? 0 : larger(0, (w->u_stick[UP] - u) / w->W[UP][UP]);
}

/* One sweep over all forces; friction of the tip is at most mu F_n, N, and a constant, N, more. Returns
   whether the normal force was found. */
static bool sweep(const Input *in, double h, const State *s, Work *w, double mu, double more)
{
    bool found = tip_force(in, h, s, w);
    w->slip = plane_friction(w, T, P, mu * larger(w->F[N], 0) + more) ? STICK : SLIP;
    table_force(h, s, w);
    bool sticks = plane_friction(w, LATERAL, FORWARD, in->table_friction * w->F[UP]);
    w->on_table = w->F[UP] > 0;
    w->table_stuck = sticks && w->on_table;
    return found;
}

/* Sweeps until the forces stay. Returns whether they converged. */
static bool solve(const Input *in, double h, const State *s, Work *w, double mu, double more)
{
    double change = 1, scale = 1;
    bool found = false;
    for (int n = 0; n < MAX_SWEEPS && change > REL_TOL_SWEEPS * scale; n++) {
        double before[FORCES];
        memcpy(before, w->F, sizeof before);
        found = sweep(in, h, s, w, mu, more);
        change = 0;
        scale = MIN_FORCE;
        for (int f = 0; f < FORCES; f++) {
            change = larger(change, fabs(w->F[f] - before[f]));
            scale = larger(scale, fabs(w->F[f]));
        }
    }
    return found && change <= REL_TOL_ACCEPTED * scale;
}

/* Strong friction may support so much that F_n vanishes, and with it mu F_n: the iteration then alternates.
   The bound mu F_n lies between 0 and the friction force of stick, and is found by bisection. */
bool raised_forces(const Input *in, double h, const State *s, Work *w)
{
    memcpy(w->F, s->last_F, sizeof w->F);
    if (solve(in, h, s, w, in->friction, 0)) return true;
    bool solved = solve(in, h, s, w, 0, HUGE_VAL);
    double low = 0, high = hypot(w->F[T], w->F[P]);
    for (int i = 0; i < MAX_BISECTIONS && solved; i++) {
        double bound = (low + high) / 2;
        solved = solve(in, h, s, w, 0, bound);
        if (in->friction * w->F[N] > bound)
            low = bound;
        else
            high = bound;
    }
    return solved;
}

bool raised_impulses(const Input *in, const State *s, Work *w) { return solve(in, 0, s, w, 0, HUGE_VAL); }
