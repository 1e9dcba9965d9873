/* A tip with a tangential spring, which slips as a whole. */
#include "contact.h"

/* F_t = (shift at mid-step - origin) / compliance. */
static void stick(Work *w, const double *u, Equations *e)
{
    const double half = w->t.h / 2, compliance = w->c->compliance;
    double shift = w->shift - half * u[T];
    e->g[T] = w->F[T] - (shift - w->origin) / compliance;
    e->J[T][T] = 1 + half * w->W[T][T] / compliance;
    e->J[T][N] = half * w->W[T][N] / compliance;
}

/* Slip moves the shift at which the spring is unstrained. */
static void keep(Work *w, double middle)
{
    if (w->slip) w->origin = middle - w->c->compliance * w->F[T];
}

static void release(Work *w, double shift)
{
    Contact *c = w->c;
    double F = w->slip ? w->F[T] : (shift - w->origin) / c->compliance;
    c->shear_loss += c->compliance * F * F / 2;
}

static int friction_state(const Work *w) { return w->slip; }

const Patch spring_patch = {0, stick, keep, release, friction_state};
