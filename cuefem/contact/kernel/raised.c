/* The forces of a raised cue, over a unilateral table contact: block Gauss-Seidel over the normal force, the
   tip's friction, and the table's normal force and friction. */
#include "contact.h"

enum { MAX_SWEEPS = 1000, MAX_BISECTIONS = 60 };
static const double REL_TOL_SWEEPS = 1e-11; /* sweeps converge slowly */

/* Mean velocity of the contact along a force's direction, under all forces, m/s. */
static double mean_velocity(const Contact *c, int a)
{
    double u = c->u_free[a];
    for (int f = 0; f < c->in->forces; f++) u += c->W[a][f] * c->F[f];
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
static void slide(const Contact *c, int a, int b, double u_a, double u_b, double bound, double *p, double *q)
{
    const double (*W)[FORCES] = c->W, *F = c->F;
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
static bool plane_friction(Contact *c, int a, int b, double bound)
{
    const double (*W)[FORCES] = c->W;
    double *F = c->F, det = W[a][a] * W[b][b] - W[a][b] * W[b][a];
    double u_a = mean_velocity(c, a), u_b = mean_velocity(c, b);
    double x = u_a - c->u_stick[a], y = u_b - c->u_stick[b];
    double p = F[a] - (W[b][b] * x - W[a][b] * y) / det;
    double q = F[b] - (W[a][a] * y - W[b][a] * x) / det;
    bool sticks = hypot(p, q) <= bound * (1 + REL_TOL);
    if (!sticks) {
        scale_to(bound, &p, &q);
        slide(c, a, b, u_a, u_b, bound, &p, &q);
    }
    F[a] = p;
    F[b] = q;
    return sticks;
}

/* Newton's method for F_n, the other forces held. Returns whether it converged. */
static bool tip_force(Contact *c)
{
    const double half = c->tables.h / 2;
    double correction = 0;
    for (int i = 0; i < MAX_ITERATIONS; i++) {
        NormalForce normal = normal_force(c->in, c->s, c->s->indentation - half * mean_velocity(c, N));
        correction = (c->F[N] - normal.force) / (1 + normal.slope * half * c->W[N][N]);
        c->F[N] -= correction;
        if (fabs(correction) <= REL_TOL * fabs(c->F[N])) return true;
    }
    return fabs(correction) <= REL_TOL_ACCEPTED * (fabs(c->F[N]) + MIN_FORCE);
}

/* The table's normal force: it pushes the ball unless that rises. */
static void table_force(Contact *c)
{
    const double height = c->s->height;
    double u = c->u_free[UP] - c->W[UP][UP] * c->F[UP]; /* without the table */
    for (int f = 0; f < c->in->forces; f++) u += c->W[UP][f] * c->F[f];
    bool leaves = height > 0 && height + c->tables.h * u > 0;
    c->F[UP] = leaves ? 0 : larger(0, (c->u_stick[UP] - u) / c->W[UP][UP]);
}

/* One sweep over all forces; friction of the tip is at most mu F_n, N, and a constant, N, more. Returns whether
   the normal force was found. */
static bool sweep(Contact *c, double mu, double more)
{
    bool found = tip_force(c);
    c->slip = plane_friction(c, T, P, mu * larger(c->F[N], 0) + more) ? STICK : SLIP;
    table_force(c);
    bool sticks = plane_friction(c, LATERAL, FORWARD, c->in->table_friction * c->F[UP]);
    c->on_table = c->F[UP] > 0;
    c->table_stuck = sticks && c->on_table;
    return found;
}

/* Sweeps until the forces stay. Returns whether they converged. */
static bool solve(Contact *c, double mu, double more)
{
    double change = 1, scale = 1;
    bool found = false;
    for (int n = 0; n < MAX_SWEEPS && change > REL_TOL_SWEEPS * scale; n++) {
        double before[FORCES];
        memcpy(before, c->F, sizeof before);
        found = sweep(c, mu, more);
        change = 0;
        scale = MIN_FORCE;
        for (int f = 0; f < FORCES; f++) {
            change = larger(change, fabs(c->F[f] - before[f]));
            scale = larger(scale, fabs(c->F[f]));
        }
    }
    return found && change <= REL_TOL_ACCEPTED * scale;
}

/* Strong friction may support so much that F_n vanishes, and with it mu F_n: the iteration then alternates.
   The bound mu F_n lies between 0 and the friction force of stick, and is found by bisection. */
bool raised_forces(Contact *c)
{
    if (solve(c, c->in->friction, 0)) return true;
    bool solved = solve(c, 0, HUGE_VAL);
    double low = 0, high = hypot(c->F[T], c->F[P]);
    for (int i = 0; i < MAX_BISECTIONS && solved; i++) {
        double bound = (low + high) / 2;
        solved = solve(c, 0, bound);
        if (c->in->friction * c->F[N] > bound)
            low = bound;
        else
            high = bound;
    }
    return solved;
}

bool raised_impulses(Contact *c) { return solve(c, 0, HUGE_VAL); }
