/* A tip with a tangential spring, which slips as a whole. */
#include "contact.h"

/* F_t = (shift at mid-step - origin) / compliance. */
static void stick(const Input *in, double h, const State *s, Work *w, Equations *e)
{
    const double half = h / 2, compliance = in->compliance;
    double shift = s->shift - half * w->u[T];
    e->g[T] = w->F[T] - (shift - s->origin) / compliance;
    e->J[T][T] = 1 + half * w->W[T][T] / compliance;
    e->J[T][N] = half * w->W[T][N] / compliance;
}

/* Slip moves the shift at which the spring is unstrained. */
static void update(const Input *in, State *s, const Work *w)
{
    if (w->slip) s->origin = s->shift_mid - in->compliance * w->F[T];
}

static void release(const Input *in, State *s, const Work *w)
{
    const double compliance = in->compliance;
    double F = w->slip ? w->F[T] : (s->shift - s->origin) / compliance;
    s->shear_loss += compliance * F * F / 2;
}

static int friction_state(const Input *in, const State *s, const Work *w) { return w->slip; }

const Patch spring_patch = {.stick = stick,
                            .update = update,
                            .release = release,
                            .friction_state = friction_state};
