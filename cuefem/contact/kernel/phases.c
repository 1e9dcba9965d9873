/* The phases of a contact: the tip loads, it unloads, or it is free after a separation.

   Handbook: The strike: F = k d loading, (k/e^2)(d - (1 - e^2) D) unloading; Low restitution: h e/0.5. */
#include "contact.h"

/* A tip of restitution e unloads 1/e times as fast as it loads. Below this restitution, unloading steps are
   shortened by the factor e / MIN_STEP_RESTITUTION. */
static const double MIN_STEP_RESTITUTION = 0.5;

/* Length of a step in the phase, s, unless an event or forces that are not found shorten it. */
double full_step(const Contact *c)
{
    const Input *in = c->in;
    return c->s->phase == UNLOADING ? in->step * fmin(1, in->restitution / MIN_STEP_RESTITUTION) : in->step;
}

static void begin(Contact *c, int phase)
{
    c->s->phase = phase;
    c->s->next_step = full_step(c);
}

static bool is_indented(const Contact *c) { return c->s->indentation > residual_indentation(c); }

/* In contact: */

static void update_contact(Contact *c)
{
    State *s = c->s;
    s->shift_mid = s->shift - c->tables.h / 2 * c->u[T];
    c->patch->update(c);
    s->friction_state = c->cue->friction_state(c);
    s->tip_stuck = !c->slip;
    s->on_table = c->on_table;
    s->table_stuck = c->table_stuck;
}

static int contact_status(const State *s) { return s->time > s->deadline ? TIME_LIMIT : RUNNING; }

static void after_loading(Contact *c)
{
    State *s = c->s;
    if (c->v[N] > 0) {
        s->max_indentation = larger(s->max_indentation, s->indentation);
        begin(c, UNLOADING);
    }
}

static void after_unloading(Contact *c)
{
    const State *s = c->s;
    if (s->ends_at_event || !is_indented(c)) {
        separate(c);
        begin(c, FREE);
    } else if (s->indentation > s->max_indentation) {
        begin(c, LOADING);
    }
}

/* In free flight: */

/* A spring patch will be unstrained at touch. */
static void update_flight(Contact *c)
{
    State *s = c->s;
    s->friction_state = SEPARATED;
    s->shift_mid = s->shift - c->tables.h * c->u[T];
    s->origin = s->shift_mid;
}

/* Below the maximum indentation a second contact follows the unloading curve, beyond it the loading curve. */
static void after_flight(Contact *c)
{
    if (c->s->ends_at_event || is_indented(c)) {
        c->s->ends_at_event = false;
        begin(c, UNLOADING);
    }
}

static int flight_status(const State *s) { return s->time >= s->window_end ? ENDED : RUNNING; }

const Phase phases[] = {
    [LOADING] = {.touches = true,
                 .event = 0,
                 .curve = loading_curve,
                 .update = update_contact,
                 .next = after_loading,
                 .status = contact_status},
    [UNLOADING] = {.touches = true,
                   .event = -1,
                   .curve = unloading_curve,
                   .update = update_contact,
                   .next = after_unloading,
                   .status = contact_status},
    [FREE] = {.touches = false,
              .event = 1,
              .curve = NULL,
              .update = update_flight,
              .next = after_flight,
              .status = flight_status},
};

/* Separation: the tip forgets its strain, and the modes are kept for Python. */
void separate(Contact *c)
{
    State *s = c->s;
    c->patch->release(c);
    s->steps_to_last_separation = s->steps;
    s->deadline = c->in->max_time + s->time;
    s->ends_at_event = false;
    s->tip_stuck = false;
    s->origin = s->shift;
    s->shift_mid = s->shift;
    memset(s->annulus_force, 0, sizeof s->annulus_force);
    memset(c->F, 0, sizeof c->F);
    memset(c->last_F, 0, sizeof c->last_F);
    memcpy(s->separated_modes, s->modes, 2 * c->in->modes * sizeof(double));
    if (!isfinite(s->window_end)) s->window_end = s->time + c->in->window;
}
