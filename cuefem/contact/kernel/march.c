/* A contact from touch to parting: the phases that its steps make up, and what is taken with each. */
#include "contact.h"

/* Go to a part of a step. */
static int take(Work *w, const Step *s, double part)
{
    Contact *c = w->c;
    Cue *cue = c->cue;
    double span = part * s->step, waves[PORTS + SLOPES][Q];
    if (!record(w, s, part)) return NO_MEMORY;
    for (int d = 0; d < dampers_of(cue); d++) {
        const double *speed = s->damped + d * WITH;
        *(d < c->lossy ? &c->damping_loss : &c->radiated) += work_of(speed, speed, s->step, part);
    }
    w->law->taken(w, s, part);
    if (c->turns) c->angle = value_at(s->angle, part);
    for (int b = 0; b < c->speeds; b++) {
        double of_ball[Q];
        waves_over(s->loads[PORTS + b], part, of_ball);
        c->ball[b] += span * c->ball_gives[b] * of_ball[0]; /* the first coefficient is the mean */
    }
    for (int p = 0; p < cue->ports; p++) waves_over(s->loads[p], part, waves[p]);
    for (int a = 0; a < cue->slopes; a++) waves_over(s->slope_loads[a], part, waves[cue->ports + a]);
    advance_modes(cue, c->xi, part == 1 ? response_of(cue, s->level) : NULL, span, waves);
    for (int f = 0; f < c->forces; f++)
        memcpy(w->last_F[f], s->F[f] + 1, sizeof w->last_F[f]);
    memcpy(w->last_angle, s->angle + 1, sizeof w->last_angle);
    c->time += span, c->steps++;
    w->known = 1, w->last_part = part, w->last_step = s->step;
    if (c->curve == LEATHER_CURVE && c->depth > c->most) return TOO_DEEP;
    if (c->levers && fabs(c->angle) > c->lever_reach) return TURNED_TOO_FAR;
    if (take_slopes(c, s, part)) return BENT_TOO_FAR;
    return ENDED;
}

/* How a ringed patch goes on: sliding as a whole, one way or the other, or not. */
static int ringed_grip(const Work *w, const Step *s)
{
    const Contact *c = w->c;
    double F_n, slope;
    curve_at(c, virtual_depth(c, w->hold.press, c->depth), &F_n, &slope, NULL);
    if (c->friction == 0) return s->v[0][Q] == 0 ? STICK : s->v[0][Q] < 0 ? SLIP : SLIP_BACK;
    if (F_n < 1e-6 * c->impulse / c->clock) return w->hold.grip; /* as ball and tip part nothing tells */
    if (fabs(c->shear) < c->friction * F_n * (1 - 1e-9)) return STICK;
    return c->shear > 0 ? SLIP : SLIP_BACK;
}

/* March through one phase, up to a time at most; the event that ended it, or minus a status. */
static int follow(Work *w, double until)
{
    Contact *c = w->c;
    double start = c->time, before[SPEEDS];
    int fresh = 1;
    Guard ends[8];
    w->law->begin(w);
    memcpy(before, c->ball, sizeof before);
    for (;;) {
        if (w->hold.press == FREE ? c->time >= until : c->time > until) return w->hold.press == FREE ? LATE_FLIGHT : -LATE;
        if (c->steps > c->most_steps) return -CROWDED;
        int status = longest_step(w), event = NONE;
        if (status) return -status;
        double first = 1, apart = 2;
        int guards = w->law->guards(w, &w->step, ends);
        for (int i = 0; i < guards; i++) {
            double at = first_fall(ends[i].values, ends[i].past);
            if (at < first || (at == first && !event)) first = at, event = ends[i].event;
            if (ends[i].event == APART) apart = at;
        }
        int nearer = clock_level(c) + 14;
        if (c->forces > 2 && event && event != APART && apart <= 1 && w->step.level < nearer) {
            w->level = w->step.level + 1; /* past the parting friction's bound is no polynomial: come nearer first */
            continue;
        }
        if (event && event != APART && w->hold.press == UNLOAD) { /* where all forces vanish the other ends mean nothing */
            double left = value_at(w->step.depth, first) - rest_of(c);
            int leaves = value_at(w->step.v[1], first) > 0;
            if (leaves && left < (w->linear ? 1e-11 : c->forces == 2 ? 1e-7 : 1e-5) * c->deepest)
                first = apart <= 1 ? apart : first, event = APART;
        }
        if (first > 0) {
            double here = c->time, ball[SPEEDS];
            memcpy(ball, c->ball, sizeof ball);
            status = take(w, &w->step, first);
            if (c->patch == RINGED_PATCH && w->hold.press != FREE) {
                int grip = ringed_grip(w, &w->step);
                if (fresh) w->hold.grip = grip;
                else if (grip != w->hold.grip) { /* the phase of the other grip ended where this step began */
                    double now = c->time, gone[SPEEDS];
                    memcpy(gone, c->ball, sizeof gone), memcpy(c->ball, ball, sizeof ball), c->time = here;
                    end_phase(w, w->hold, start, before);
                    memcpy(c->ball, gone, sizeof gone), c->time = now;
                    memcpy(before, ball, sizeof before), start = here, w->hold.grip = grip;
                }
                fresh = 0;
            }
        }
        if (status) return -status;
        if (event) {
            if (c->time > start) end_phase(w, w->hold, start, before);
            return event;
        }
    }
}

/* One touch, from a press on; whether ball and tip parted. */
static int touch(Work *w, int press, double until)
{
    Contact *c = w->c;
    int goes_on = w->law->first_grip(w, press);
    w->hold.grip = c->grip, w->hold.press = press;
    for (int events = 0; goes_on; events++) {
        if (c->phase_count + 1 >= c->most_phases || events >= c->most_phases) c->status = CROWDED;
        else {
            int event = follow(w, until);
            if (event < 0) c->status = -event;
            else goes_on = w->law->next(w, event);
        }
        c->grip = w->hold.grip, c->press = w->hold.press;
        if (c->status) return 0;
    }
    return 1;
}

/* The first step: where a force grows from nothing with a root of the compression, a very short one. */
static int first_level(const Contact *c)
{
    int smooth = c->curve == POWER_CURVE && c->exponent == 1;
    int halvings = smooth ? 2 : c->patch == SPRING_PATCH ? 30 : 12;
    return clock_level(c) + halvings;
}

/* Ball and tip apart: whether they touch again by a time. What the patch held is lost. */
static int fly(Work *w, double until)
{
    Contact *c = w->c;
    Contact before = *c;
    size_t modes = 2 * c->cue->modes * sizeof *c->xi;
    double *xi = malloc(modes + 1), ball[SPEEDS], slopes[SLOPES];
    if (!xi) return 0;
    memcpy(xi, c->xi, modes), memcpy(ball, c->ball, sizeof ball);
    if (c->cue->slopes) memcpy(slopes, c->slopes, c->cue->slopes * sizeof *slopes);
    w->hold = (Hold){APART_GRIP, FREE, HELD}, w->known = 0;
    w->level = 1 + clock_level(c);
    int event = follow(w, until);
    int touched = event == TOUCHED && c->time <= until;
    if (!touched) { /* the flight is not part of the contact */
        c->time = before.time, c->depth = before.depth, c->angle = before.angle;
        c->damping_loss = before.damping_loss, c->radiated = before.radiated;
        c->record_count = before.record_count, c->phase_count = before.phase_count;
        memcpy(c->xi, xi, modes), memcpy(c->ball, ball, sizeof ball);
        if (c->cue->slopes) memcpy(c->slopes, slopes, c->cue->slopes * sizeof *slopes);
        if (event < 0) c->status = -event;
    } else {
        c->depth = rest_of(c);
        w->level = first_level(c);
        w->known = 0;
    }
    free(xi);
    return touched;
}

EXPORTED void contact_free(Contact *c)
{
    free(c->phases), free(c->records);
    c->phases = c->records = NULL;
}

/* The whole contact, and what comes after it within its window. */
EXPORTED void contact_run(Contact *c)
{
    Work *w = calloc(1, sizeof *w);
    if (!w) {
        c->status = NO_MEMORY;
        return;
    }
    w->c = c, w->law = c->forces == 2 ? &planar : &raised;
    w->linear = !c->turns && !c->cue->slopes && c->curve == POWER_CURVE && c->exponent == 1 && c->forces == 2;
    w->level = first_level(c);
    int dampers = dampers_of(c->cue);
    w->step.damped = malloc((dampers + 1) * WITH * sizeof(double));
    double start = c->time, longest = c->longest;
    facing_at(c, c->angle, w->C[0]);
    if (!w->step.damped) c->status = NO_MEMORY;
    int parted = !c->status && touch(w, LOAD, longest);
    double until = c->time + c->window;
    while (parted && c->window > 0 && c->time < until && fly(w, until)) {
        longest += c->time - start, start = c->time;
        parted = touch(w, UNLOAD, longest);
    }
    w->hold.press = FREE;
    if (!c->status && c->forces == 2) w->law->begin(w); /* what the patch still holds is lost */
    for (int i = 0; i < LEVELS; i++) {
        free(w->V[i]);
        for (int j = 0; j < 16; j++) free(w->factors[i][j]);
    }
    free(w->step.damped), free(w);
}
