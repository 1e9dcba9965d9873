/* The phases of a contact: the tip loads, it unloads, or it is free after a separation.

   Handbook: The strike: F = k d loading, (k/e^2)(d - (1 - e^2) D) unloading; Low restitution: h e/0.5. */
#include "contact.h"

/* A tip of restitution e unloads 1/e times as fast as it loads. Below this restitution, unloading steps are
   shortened by the factor e / MIN_STEP_RESTITUTION. */
static const double MIN_STEP_RESTITUTION = 0.5;

static double unloading_step(const Input *in)
{
    if (in->restitution >= MIN_STEP_RESTITUTION) return in->step;
    return in->step * in->restitution / MIN_STEP_RESTITUTION;
}

static void begin(Contact *c, int phase, double step)
{
    c->s->phase = phase;
    c->s->next_step = step;
}

static int is_indented(const Contact *c) { return c->s->indentation > residual(c); }

/* In contact: */

static int contact_forces(Contact *c) { return c->cue->forces(c); }

static void keep_contact(Contact *c, double u)
{
    State *s = c->s;
    s->shift_mid = s->shift - c->t.h / 2 * u;
    c->patch->keep(c, s->shift_mid);
    s->virtual_mid = c->normal.virtual;
    s->friction_state = c->cue->friction_state(c, u);
    s->tip_stuck = !c->slip;
}

static int contact_status(const State *s) { return s->time > s->deadline ? TIME_LIMIT : RUNNING; }

static int no_event(double excess, double excess_at_end)
{
    (void)excess;
    (void)excess_at_end;
    return 0;
}

static int separates(double excess, double excess_at_end)
{
    (void)excess;
    return excess_at_end < 0;
}

static void after_loading(Contact *c, double v_n)
{
    State *s = c->s;
    if (v_n > 0) {
        s->max_indentation = larger(s->max_indentation, s->indentation);
        begin(c, UNLOADING, unloading_step(c->in));
    }
}

static void after_unloading(Contact *c, double v_n)
{
    const State *s = c->s;
    (void)v_n;
    if (s->ends_at_event || !is_indented(c)) {
        separate(c);
        begin(c, FREE, c->in->step);
    } else if (s->indentation > s->max_indentation) {
        begin(c, LOADING, c->in->step);
    }
}

/* In free flight: */

static NormalForce no_force(const Contact *c, double indentation)
{
    (void)c;
    return (NormalForce){.virtual = indentation, .scale = 1};
}

static int no_forces(Contact *c)
{
    (void)c;
    return 1;
}

static int touches(double excess, double excess_at_end) { return excess < 0 && excess_at_end > 0; }

/* A spring patch will be unstrained at touch. */
static void keep_flight(Contact *c, double u)
{
    State *s = c->s;
    s->friction_state = SEPARATED;
    s->shift_mid = s->shift - c->t.h * u;
    s->origin = s->shift_mid;
}

/* Below the maximum indentation a second contact follows the unloading curve, beyond it the loading curve. */
static void after_flight(Contact *c, double v_n)
{
    (void)v_n;
    if (c->s->ends_at_event || is_indented(c)) {
        c->s->ends_at_event = 0;
        begin(c, UNLOADING, unloading_step(c->in));
    }
}

static int flight_status(const State *s) { return s->time >= s->window_end ? ENDED : RUNNING; }

const Phase phases[] = {
    [LOADING] = {.curve = loading_curve,
                 .forces = contact_forces,
                 .has_event = no_event,
                 .keep = keep_contact,
                 .next = after_loading,
                 .status = contact_status,
                 .touches = 1},
    [UNLOADING] = {.curve = unloading_curve,
                   .forces = contact_forces,
                   .has_event = separates,
                   .keep = keep_contact,
                   .next = after_unloading,
                   .status = contact_status,
                   .touches = 1},
    [FREE] = {.curve = no_force,
              .forces = no_forces,
              .has_event = touches,
              .keep = keep_flight,
              .next = after_flight,
              .status = flight_status,
              .touches = 0},
};

/* Separation: the tip forgets its strain, and the modes are kept for Python. */
void separate(Contact *c)
{
    State *s = c->s;
    if (s->steps > s->steps_to_last_separation) c->patch->release(c, s->shift);
    s->steps_to_last_separation = s->steps;
    s->deadline = c->in->max_time + s->time;
    s->ends_at_event = 0;
    s->tip_stuck = 0;
    s->virtual_mid = 0;
    s->origin = s->shift;
    s->shift_mid = s->shift;
    memset(s->annulus_force, 0, sizeof s->annulus_force);
    memset(c->F, 0, sizeof c->F);
    memset(c->last_F, 0, sizeof c->last_F);
    memcpy(s->separated_modes, s->modes, 2 * c->in->modes * sizeof(double));
    if (!isfinite(s->window_end)) s->window_end = s->time + c->in->window;
}
