/* A tip without tangential compliance. */
#include "contact.h"

/* The tip has the mean velocity of a sticking point. */
static void stick(Work *w, const double *u, Equations *e)
{
    e->g[T] = u[T] - w->u_stick[T];
    e->J[T][T] = w->W[T][T];
    e->J[T][N] = w->W[T][N];
}

static void keep(Work *w, double middle) { (void)w, (void)middle; }

static void release(Work *w, double shift) { (void)w, (void)shift; }

/* A tip that comes to rest within the step has slipped in a part of it: counted as slip. */
static int friction_state(const Work *w)
{
    int stops = !w->slip && !w->tip_stuck;
    if (!stops || w->u_stick[T] == 0) return w->slip;
    return w->u_stick[T] < 0 ? SLIP : SLIP_BACK;
}

const Patch rigid_patch = {0, stick, keep, release, friction_state};
