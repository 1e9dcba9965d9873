/* A contact from first touch to separation, and through the window for a second hit: what Python calls. */
#include "contact.h"

/* Largest slope of the cue's end, rad: there the shortening w'^2/2 exceeds the exact 1 - cos w' by 0.5 %. */
static const double SLOPE_LIMIT = 0.25;
static const double INFINITE_FRICTION = 1e12; /* as in step_records.py */

static void update_port_velocities(Work *w)
{
    const int n_modes = w->c->modes, n_cue = w->c->ports + w->c->slopes;
    for (int q = 0; q < n_cue; q++) {
        w->port_velocities[q] = 0;
        for (int k = 0; k < n_modes; k++)
            w->port_velocities[q] += w->c->rows[q * n_modes + k] * w->state[k];
    }
}

EXPORTED void contact_free(Work *w)
{
    if (!w) return;
    free(w->state);
    free(w);
}

static void choose_variants(Work *w)
{
    static const Patch *const patches[] = {&rigid_patch, &spring_patch, &partial_slip};
    const Contact *c = w->c;
    w->patch = patches[c->patch];
    w->law = c->law == LEATHER_LAW ? leather_law : power_law;
    w->solve_forces = c->forces == 2 ? level_forces : raised_forces;
}

/* A contact at its first touch; NULL if memory runs out. */
EXPORTED Work *contact_new(Contact *c)
{
    const size_t n_state = 2 * (size_t)c->modes;
    const size_t n_loads = c->ports + c->slopes + c->dashpots;
    Work *w = calloc(1, sizeof *w);
    if (!w) return NULL;
    w->state = malloc((n_state + n_loads + 3 * c->radiating) * sizeof(double));
    if (!w->state) {
        free(w);
        return NULL;
    }
    w->loads = w->state + n_state;
    w->group = w->loads + n_loads;
    w->c = c;
    c->next_step = c->step;
    w->window_end = HUGE_VAL;
    w->deadline = c->max_time;
    memcpy(w->state, c->state, n_state * sizeof(double));
    if (c->speeds) memcpy(w->ball, c->ball, c->speeds * sizeof(double));
    choose_variants(w);
    update_port_velocities(w);
    return w;
}

/* Of a cue in contact: one in free flight turns without being bent. The last slope of each plane is that of the
   cue's end. */
static void update_max_slope(Work *w)
{
    Contact *c = w->c;
    if (w->phase == FREE) return;
    const int per_plane = c->slopes / c->planes;
    for (int a = per_plane; a && a <= c->slopes; a += per_plane) {
        double slope = fabs(w->slopes[a - 1]);
        if (slope > c->max_slope) {
            c->max_slope = slope;
            c->axial_force = w->axial_force;
        }
    }
}

static int is_finite(const Work *w)
{
    double sum = w->c->indentation + w->c->time; /* NaN or infinite if any of its terms is */
    for (int f = 0; f < w->c->forces; f++) sum += w->F[f];
    return isfinite(sum);
}

/* Status after a step: RUNNING, ENDED, or why the contact cannot continue. */
static int status_of(const Work *w)
{
    const Contact *c = w->c;
    if (!is_finite(w)) return UNSOLVED;
    if (c->law == LEATHER_LAW && c->indentation > c->indentation_limit) return INDENTATION_OUT_OF_RANGE;
    if (c->max_slope > SLOPE_LIMIT) return SLOPE_OUT_OF_RANGE;
    if (w->phase == FREE) return c->time >= w->window_end ? ENDED : RUNNING;
    return c->time > w->deadline ? TIME_LIMIT : RUNNING;
}

/* First touch of a rigid patch with infinite friction: an impulse stops the tangential motion. */
static int begins_with_impact(const Work *w)
{
    const Contact *c = w->c;
    return c->steps == 0 && c->friction >= INFINITE_FRICTION && w->patch == &rigid_patch && c->phi > 0;
}

static void take_impact(Work *w, Step *row)
{
    Contact *c = w->c;
    *row = (Step){.friction_state = IMPACT};
    int stays = impact(w, row);
    update_port_velocities(w);
    c->steps++;
    if (stays || c->status != RUNNING) return;
    separate(w);
    c->status = ENDED;
}

/* Return whether a step was taken. */
static int advance(Work *w, Step *row)
{
    Contact *c = w->c;
    if (begins_with_impact(w)) {
        take_impact(w, row);
        return 1;
    }
    if (!take_step(w, row)) return 0;
    c->steps++;
    next_phase(w, row->v[N]);
    update_max_slope(w);
    if (c->status == RUNNING) c->status = status_of(w);
    return 1;
}

/* Take up to max_steps steps of the tables' length and return their number; call again, with tables of the
   length Contact.next_step, while the status is RUNNING. rows: (max_steps,), a record of each step. states: NULL, or
   (max_steps, 2, modes), the state of the modes after each step. */
EXPORTED int contact_steps(Work *w, const StepTables *tables, int max_steps, Step *rows, double *states)
{
    Contact *c = w->c;
    const size_t n_state = 2 * (size_t)c->modes;
    int count = 0;
    w->t = *tables;
    while (count < max_steps && c->status == RUNNING && c->next_step == w->t.h) {
        if (!advance(w, rows + count)) continue;
        memcpy(rows[count].ball, w->ball, sizeof w->ball);
        if (states) memcpy(states + n_state * count, w->state, n_state * sizeof(double));
        count++;
    }
    return count;
}

EXPORTED const size_t contact_size = sizeof(Contact), step_size = sizeof(Step), tables_size = sizeof(StepTables);
