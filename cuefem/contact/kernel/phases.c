/* The phases of a contact: the tip loads, it unloads, or it is free after a separation.

   Handbook: The strike: F = k d loading, (k/e^2)(d - (1 - e^2) D) unloading; Low restitution: h e/0.5. */
#include "contact.h"

/* Length of a step in the phase, s, unless an event or forces that are not found shorten it. */
double full_step(const Input *in, const State *s)
{
    return s->phase == UNLOADING ? in->unloading_step : in->step;
}

static void enter(const Input *in, State *s, int phase)
{
    s->phase = phase;
    s->next_step = full_step(in, s);
}

static bool is_indented(const Input *in, const State *s)
{
    return s->indentation > residual_indentation(in, s);
}

/* Without friction a level cue has no force to tell: by the velocity. */
static int friction_state(const Input *in, const State *s, const Work *w)
{
    if (is_raised(in) || in->friction > 0) return patch_of(in)->friction_state(in, s, w);
    if (w->u[T] == 0) return STICK;
    return w->u[T] < 0 ? SLIP : SLIP_BACK;
}

/* The tip's state after a step in free flight: a spring patch will be unstrained at touch. */
static void update_flight(State *s, double shift_mid)
{
    s->friction_state = SEPARATED;
    s->shift_mid = shift_mid;
    s->origin = shift_mid;
}

/* The tip's state after a step. */
void update_tip(const Input *in, double h, State *s, const Work *w)
{
    if (!touches(s)) {
        update_flight(s, s->shift - h * w->u[T]);
        return;
    }
    s->shift_mid = s->shift - h / 2 * w->u[T];
    patch_of(in)->update(in, s, w);
    s->friction_state = friction_state(in, s, w);
    s->tip_stuck = !w->slip;
    s->on_table = w->on_table;
    s->table_stuck = w->table_stuck;
}

static void after_loading(const Input *in, State *s, const Work *w)
{
    if (w->v[N] <= 0) return;
    s->max_indentation = larger(s->max_indentation, s->indentation);
    enter(in, s, UNLOADING);
}

static void after_unloading(const Input *in, State *s, const Work *w)
{
    if (s->ends_at_event || !is_indented(in, s)) {
        separate(in, s, w);
    } else if (s->indentation > s->max_indentation) {
        enter(in, s, LOADING);
    }
}

/* Below the maximum indentation a second contact follows the unloading curve, beyond it the loading curve. */
static void after_flight(const Input *in, State *s)
{
    if (!s->ends_at_event && !is_indented(in, s)) return;
    s->ends_at_event = false;
    enter(in, s, UNLOADING);
}

/* Phase and length of the next step. */
void next_phase(const Input *in, State *s, const Work *w)
{
    if (s->phase == LOADING)
        after_loading(in, s, w);
    else if (s->phase == UNLOADING)
        after_unloading(in, s, w);
    else
        after_flight(in, s);
}

/* Time followed after the first separation, s. A tip that bounces has hardly moved the ball, and hits it again. */
static double window(const Input *in, const State *s)
{
    bool bounces = s->ball[N] < in->bounce_speed;
    return bounces ? larger(in->window, in->bounce_window) : in->window;
}

/* Separation: the tip forgets its strain, and the modes are kept for Python. */
void separate(const Input *in, State *s, const Work *w)
{
    patch_of(in)->release(in, s, w);
    s->steps_to_last_separation = s->steps;
    s->deadline = in->max_time + s->time;
    s->ends_at_event = false;
    s->tip_stuck = false;
    s->origin = s->shift;
    s->shift_mid = s->shift;
    memset(s->annulus_force, 0, sizeof s->annulus_force);
    memset(s->last_F, 0, sizeof s->last_F);
    memset(s->former_F, 0, sizeof s->former_F);
    memcpy(s->separated_modes, s->modes, 2 * in->modes * sizeof(double));
    if (!isfinite(s->window_end)) s->window_end = s->time + window(in, s);
    enter(in, s, FREE);
}
