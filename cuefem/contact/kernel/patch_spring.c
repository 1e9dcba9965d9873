/* A tip with a tangential spring, which slips as a whole. */
#include "contact.h"

/* F_t = (shift at mid-step - origin) / compliance. */
static void stick(Contact *c, Equations *e)
{
    const double half = c->tables.h / 2, compliance = c->in->compliance;
    double shift = c->s->shift - half * c->u[T];
    e->g[T] = c->F[T] - (shift - c->s->origin) / compliance;
    e->J[T][T] = 1 + half * c->W[T][T] / compliance;
    e->J[T][N] = half * c->W[T][N] / compliance;
}

/* Slip moves the shift at which the spring is unstrained. */
static void update(Contact *c)
{
    if (c->slip) c->s->origin = c->s->shift_mid - c->in->compliance * c->F[T];
}

static void release(Contact *c)
{
    const double compliance = c->in->compliance;
    double F = c->slip ? c->F[T] : (c->s->shift - c->s->origin) / compliance;
    c->s->shear_loss += compliance * F * F / 2;
}

static int friction_state(const Contact *c) { return c->slip; }

const Patch spring_patch = {.slips_in_parts = false,
                            .begin = nothing,
                            .stick = stick,
                            .update = update,
                            .release = release,
                            .friction_state = friction_state};
