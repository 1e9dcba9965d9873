/* A tip without tangential compliance. */
#include "contact.h"

/* The tip has the mean velocity of a sticking point. */
static void stick(const Input *in, double h, const State *s, Work *w, Equations *e)
{
    e->g[T] = w->u[T] - w->u_stick[T];
    e->J[T][T] = w->W[T][T];
    e->J[T][N] = w->W[T][N];
}

/* A tip that comes to rest within the step has slipped in a part of it: counted as slip. */
static int friction_state(const Input *in, const State *s, const Work *w)
{
    bool stops = !w->slip && !s->tip_stuck;
    if (!stops || w->u_stick[T] == 0) return w->slip;
    return w->u_stick[T] < 0 ? SLIP : SLIP_BACK;
}

static void nothing(const Input *in, State *s, const Work *w) {}

const Patch rigid_patch = {.stick = stick,
                           .update = nothing,
                           .release = nothing,
                           .friction_state = friction_state};
