/* The forces of a level cue: the force-indentation law at mid-step, friction as a return mapping. */
#include "contact.h"

/* Relative change of the forces in Newton's last iteration. It leaves an error of its square where the
   equations are smooth; where an annulus begins to slip in this iteration, one of its own size. */
static const double NEWTON_REL_TOL = 1e-9;

/* Row N: F_n = law(indentation d at mid-step). Handbook: The contact. With d = d_begin - h/2 u_n and u = u_free
   + W F, a force F changes d by -h/2 W_n F: hence the factors of the law's slope in J. */
static void normal_equation(const Input *in, double h, const State *s, Work *w, Equations *e)
{
    const double half = h / 2;
    w->normal = normal_force(in, s, s->indentation - half * w->u[N]);
    e->g[N] = w->F[N] - w->normal.force;
    e->J[N][T] = w->normal.slope * half * w->W[N][T];
    e->J[N][N] = 1 + w->normal.slope * half * w->W[N][N];
}

/* Row T of a tip that slips in a direction: F_t = mu F_n. */
static void slip_equation(const Input *in, const Work *w, Equations *e)
{
    e->g[T] = w->F[T] - w->slip * in->friction * w->F[N];
    e->J[T][T] = 1;
    e->J[T][N] = -w->slip * in->friction;
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
static bool newton(const Input *in, double h, const State *s, Work *w)
{
    for (int i = 0; i < MAX_ITERATIONS; i++) {
        Equations e;
        velocities(in, w);
        normal_equation(in, h, s, w, &e);
        if (w->slip)
            slip_equation(in, w, &e);
        else
            patch_of(in)->stick(in, h, s, w, &e);
        double change = correct(w, &e);
        double scale = fabs(w->F[T]) + fabs(w->F[N]) + MIN_FORCE;
        if (change <= NEWTON_REL_TOL * scale) return true;
    }
    return false;
}

/* Begin the iteration where the forces of the last two steps lead. */
static void extrapolate(const Input *in, const State *s, Work *w)
{
    for (int f = 0; f < in->forces; f++) w->F[f] = 2 * s->last_F[f] - s->former_F[f];
}

/* Trial stick, and slip if |F_t| of the trial exceeds mu F_n. */
bool level_forces(const Input *in, double h, const State *s, Work *w)
{
    const double mu = in->friction;
    const bool in_parts = patch_of(in)->slips_in_parts;
    w->slip = mu == 0 && !in_parts ? SLIP : STICK;
    extrapolate(in, s, w);
    if (!newton(in, h, s, w)) return false;
    if (in_parts || w->slip) return true;
    if (fabs(w->F[T]) <= mu * w->F[N] * (1 + REL_TOL)) return true;
    w->slip = w->F[T] > 0 ? SLIP : SLIP_BACK;
    return newton(in, h, s, w);
}

/* The impulse that stops the tangential motion. */
bool level_impulses(const Input *in, const State *s, Work *w)
{
    w->slip = STICK;
    return newton(in, 0, s, w);
}
