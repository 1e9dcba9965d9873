/* The forces of a raised contact, over a unilateral table contact: block Gauss-Seidel over the normal force, the
   tip's friction, and the table's normal force and friction. */
#include "contact.h"

enum { MAX_SWEEPS = 1000, MAX_BISECTIONS = 60 };
static const double REL_TOL_SWEEPS = 1e-11; /* sweeps converge slowly */
static const double MU_TIMES_NORMAL = -1;   /* a bound of the tip's friction that follows the normal force */

/* Mean velocity of the contact along a force's direction, under all forces, m/s. */
static double mean_velocity(const Work *w, int a)
{
    double u = w->u[a];
    for (int f = 0; f < w->c->forces; f++) u += w->W[a][f] * w->F[f];
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

/* Solve F[a], F[b] in place, hypot(F[a], F[b]) <= bound; return 1 if the point sticks. */
static int plane_friction(Work *w, int a, int b, double bound)
{
    const double (*W)[FORCES] = w->W;
    double *F = w->F, det = W[a][a] * W[b][b] - W[a][b] * W[b][a];
    double u_a = mean_velocity(w, a), u_b = mean_velocity(w, b);
    double x = u_a - w->u_stick[a], y = u_b - w->u_stick[b];
    double p = F[a] - (W[b][b] * x - W[a][b] * y) / det;
    double q = F[b] - (W[a][a] * y - W[b][a] * x) / det;
    int sticks = hypot(p, q) <= bound * (1 + REL_TOL);
    if (!sticks) {
        scale_to(bound, &p, &q);
        slide(w, a, b, u_a, u_b, bound, &p, &q);
    }
    F[a] = p;
    F[b] = q;
    return sticks;
}

/* Newton's method for F_n, the other forces held. */
static void normal_force(Work *w)
{
    const double half = w->t.h / 2;
    for (int i = 0; i < MAX_ITERATIONS; i++) {
        double slope, unused, indentation = w->c->indentation - half * mean_velocity(w, N);
        double excess = w->F[N] - tip_force(w, w->phase, indentation, &slope, &unused);
        double correction = excess / (1 + slope * half * w->W[N][N]);
        w->F[N] -= correction;
        if (fabs(correction) <= REL_TOL * fabs(w->F[N])) return;
    }
}

/* The table's normal force: it pushes the ball unless that rises. */
static void table_force(Work *w)
{
    const Contact *c = w->c;
    double u = w->u[UP] - w->W[UP][UP] * w->F[UP]; /* without the table */
    for (int f = 0; f < c->forces; f++) u += w->W[UP][f] * w->F[f];
    int leaves = c->height > 0 && c->height + w->t.h * u > 0;
    w->F[UP] = leaves ? 0 : larger(0, (w->u_stick[UP] - u) / w->W[UP][UP]);
}

/* One sweep; bound: of the tip's friction, N. */
static void sweep(Work *w, int is_impact, double bound)
{
    if (!is_impact) normal_force(w);
    if (bound == MU_TIMES_NORMAL) bound = w->c->friction * larger(w->F[N], 0);
    w->slip = plane_friction(w, T, P, bound) ? STICK : SLIP;
    table_force(w);
    int sticks = plane_friction(w, LATERAL, FORWARD, w->c->table_friction * w->F[UP]);
    w->on_table_now = w->F[UP] > 0;
    w->table_sticks_now = sticks && w->on_table_now;
}

/* Sweeps until the forces stay. Returns whether they converged. */
static int solve_gauss_seidel(Work *w, int is_impact, double bound)
{
    double change = 1, scale = 1;
    for (int n = 0; n < MAX_SWEEPS && change > REL_TOL_SWEEPS * scale; n++) {
        double before[FORCES];
        memcpy(before, w->F, sizeof before);
        sweep(w, is_impact, bound);
        change = 0;
        scale = MIN_FORCE;
        for (int f = 0; f < FORCES; f++) {
            change = larger(change, fabs(w->F[f] - before[f]));
            scale = larger(scale, fabs(w->F[f]));
        }
    }
    w->on_table = w->on_table_now;
    w->table_stuck = w->table_sticks_now;
    return change <= REL_TOL_ACCEPTED * scale;
}

/* Strong friction may support so much that F_n vanishes, and with it mu F_n: the iteration then alternates.
   The bound mu F_n lies between 0 and the friction force of stick, and is found by bisection. Returns whether
   the forces converged. */
int raised_forces(Work *w)
{
    if (solve_gauss_seidel(w, 0, MU_TIMES_NORMAL)) return 1;
    int solved = solve_gauss_seidel(w, 0, HUGE_VAL);
    double low = 0, high = hypot(w->F[T], w->F[P]);
    for (int i = 0; i < MAX_BISECTIONS && solved; i++) {
        double bound = (low + high) / 2;
        solved = solve_gauss_seidel(w, 0, bound);
        if (w->c->friction * w->F[N] > bound)
            low = bound;
        else
            high = bound;
    }
    return solved;
}

/* The impulses of impact(), without a normal one. */
int raised_impulses(Work *w) { return solve_gauss_seidel(w, 1, HUGE_VAL); }
