/* A tip with a tangential spring, which slips as a whole. */
#include "contact.h"

/* F_t = (shift at mid-step - origin) / compliance. */
static void stick(Contact *c, const double *u, Equations *e)
{
    const double half = c->t.h / 2, compliance = c->in->compliance;
    double shift = c->s->shift - half * u[T];
    e->g[T] = c->F[T] - (shift - c->s->origin) / compliance;
    e->J[T][T] = 1 + half * c->W[T][T] / compliance;
    e->J[T][N] = half * c->W[T][N] / compliance;
}

/* Slip moves the shift at which the spring is unstrained. */
static void keep(Contact *c, double middle)
{
    if (c->slip) c->s->origin = middle - c->in->compliance * c->F[T];
}

static void release(Contact *c, double shift)
{
    const double compliance = c->in->compliance;
    double F = c->slip ? c->F[T] : (shift - c->s->origin) / compliance;
    c->s->shear_loss += compliance * F * F / 2;
}

static int friction_state(const Contact *c) { return c->slip; }

const Patch spring_patch = {
    .slips_in_parts = 0, .stick = stick, .keep = keep, .release = release, .friction_state = friction_state};
