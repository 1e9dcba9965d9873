/* The forces of a level contact: the force-indentation law at mid-step, friction as a return mapping. */
#include "contact.h"

/* Row N: F_n = law(indentation at mid-step). Handbook: The contact. */
static void normal_equation(Work *w, const double *u, Equations *e)
{
    const double half = w->t.h / 2;
    double slope, force = tip_force(w, w->phase, w->c->indentation - half * u[N], &slope, &w->virtual_now);
    e->g[N] = w->F[N] - force;
    e->J[N][T] = slope * half * w->W[N][T];
    e->J[N][N] = 1 + slope * half * w->W[N][N];
}

/* Row T of a tip that slips in a direction: F_t = mu F_n. */
static void slip_equation(const Work *w, Equations *e)
{
    e->g[T] = w->F[T] - w->slip * w->c->friction * w->F[N];
    e->J[T][T] = 1;
    e->J[T][N] = -w->slip * w->c->friction;
}

/* Subtract the solution of J x = g from (F_t, F_n); return the size of this change, N. */
static double correct(Work *w, const Equations *e)
{
    const double (*J)[2] = e->J, *g = e->g;
    double det = J[0][0] * J[1][1] - J[0][1] * J[1][0];
    double change_t = (J[1][1] * g[0] - J[0][1] * g[1]) / det;
    double change_n = (J[0][0] * g[1] - J[1][0] * g[0]) / det;
    w->F[T] -= change_t;
    w->F[N] -= change_n;
    return fabs(change_t) + fabs(change_n);
}

/* Newton's method for (F_t, F_n) in the state w->slip. Returns whether it converged. */
static int newton(Work *w)
{
    double v[FORCES], u[FORCES], change = 0, scale = 0;
    for (int i = 0; i < MAX_ITERATIONS; i++) {
        Equations e;
        velocities(w, v, u);
        normal_equation(w, u, &e);
        if (w->slip)
            slip_equation(w, &e);
        else
            w->patch->stick(w, u, &e);
        change = correct(w, &e);
        scale = fabs(w->F[T]) + fabs(w->F[N]) + MIN_FORCE;
        if (change <= REL_TOL * scale) return 1;
    }
    return change <= REL_TOL_ACCEPTED * scale;
}

/* Trial stick, and slip if |F_t| of the trial exceeds mu F_n. Returns whether the forces converged. */
int level_forces(Work *w)
{
    const double mu = w->c->friction;
    const int in_parts = w->patch->slips_in_parts;
    w->slip = mu == 0 && !in_parts ? SLIP : STICK;
    if (!newton(w)) return 0;
    if (in_parts || w->slip) return 1;
    if (fabs(w->F[T]) <= mu * larger(w->F[N], 0) * (1 + REL_TOL)) return 1;
    w->slip = w->F[T] > 0 ? SLIP : SLIP_BACK;
    return newton(w);
}
