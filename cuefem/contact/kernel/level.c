/* The forces of a level cue: the force-indentation law at mid-step, friction as a return mapping. */
#include "contact.h"

/* Relative change of the forces in Newton's last iteration. It leaves an error of its square where the
   equations are smooth; where an annulus begins to slip in this iteration, one of its own size. */
static const double NEWTON_REL_TOL = 1e-9;

/* Row N: F_n = law(indentation at mid-step). Handbook: The contact. */
static void normal_equation(Contact *c, Equations *e)
{
    const double half = c->tables.h / 2;
    c->normal = normal_force(c->in, c->s, c->s->indentation - half * c->u[N]);
    e->g[N] = c->F[N] - c->normal.force;
    e->J[N][T] = c->normal.slope * half * c->W[N][T];
    e->J[N][N] = 1 + c->normal.slope * half * c->W[N][N];
}

/* Row T of a tip that slips in a direction: F_t = mu F_n. */
static void slip_equation(const Contact *c, Equations *e)
{
    e->g[T] = c->F[T] - c->slip * c->in->friction * c->F[N];
    e->J[T][T] = 1;
    e->J[T][N] = -c->slip * c->in->friction;
}

/* Subtract the solution of J x = g from (F_t, F_n); return the size of this change, N. */
static double correct(Contact *c, const Equations *e)
{
    const double (*J)[2] = e->J, *g = e->g;
    double det = J[0][0] * J[1][1] - J[0][1] * J[1][0];
    double change_t = (J[1][1] * g[0] - J[0][1] * g[1]) / det;
    double change_n = (J[0][0] * g[1] - J[1][0] * g[0]) / det;
    c->F[T] -= change_t;
    c->F[N] -= change_n;
    return fabs(change_t) + fabs(change_n);
}

/* Newton's method for (F_t, F_n) in the state c->slip. Returns whether it converged. */
static bool newton(Contact *c)
{
    for (int i = 0; i < MAX_ITERATIONS; i++) {
        Equations e;
        velocities(c);
        normal_equation(c, &e);
        if (c->slip)
            slip_equation(c, &e);
        else
            c->patch->stick(c, &e);
        double change = correct(c, &e);
        double scale = fabs(c->F[T]) + fabs(c->F[N]) + MIN_FORCE;
        if (change <= NEWTON_REL_TOL * scale) return true;
    }
    return false;
}

/* Begin the iteration where the forces of the last two steps lead. */
static void extrapolate(Contact *c)
{
    for (int f = 0; f < c->in->forces; f++) c->F[f] = 2 * c->s->last_F[f] - c->s->former_F[f];
}

/* Trial stick, and slip if |F_t| of the trial exceeds mu F_n. */
bool level_forces(Contact *c)
{
    const double mu = c->in->friction;
    const bool in_parts = c->patch->slips_in_parts;
    c->slip = mu == 0 && !in_parts ? SLIP : STICK;
    extrapolate(c);
    if (!newton(c)) return false;
    if (in_parts || c->slip) return true;
    if (fabs(c->F[T]) <= mu * c->F[N] * (1 + REL_TOL)) return true;
    c->slip = c->F[T] > 0 ? SLIP : SLIP_BACK;
    return newton(c);
}

/* The impulse that stops the tangential motion. */
bool level_impulses(Contact *c)
{
    c->slip = STICK;
    return newton(c);
}
