/* A tip without tangential compliance. */
#include "contact.h"

/* The tip has the mean velocity of a sticking point. */
static void stick(Contact *c, Equations *e)
{
    e->g[T] = c->u[T] - c->u_stick[T];
    e->J[T][T] = c->W[T][T];
    e->J[T][N] = c->W[T][N];
}

/* A tip that comes to rest within the step has slipped in a part of it: counted as slip. */
static int friction_state(const Contact *c)
{
    bool stops = !c->slip && !c->s->tip_stuck;
    if (!stops || c->u_stick[T] == 0) return c->slip;
    return c->u_stick[T] < 0 ? SLIP : SLIP_BACK;
}

const Patch rigid_patch = {.slips_in_parts = false,
                           .begin = nothing,
                           .stick = stick,
                           .update = nothing,
                           .release = nothing,
                           .friction_state = friction_state};
