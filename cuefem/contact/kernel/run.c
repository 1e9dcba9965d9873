/* A contact from first touch to separation, and through the window for a second hit: what Python calls. */
#include "contact.h"

/* Largest slope of the cue's end, rad: there the shortening w'^2/2 exceeds the exact 1 - cos w' by 0.5 %. */
static const double SLOPE_LIMIT = 0.25;

/* The digest of the sources that the library was built from. It is not constant, so that it stands behind all
   code: a file that holds it has not been cut short (kernel/__init__.py). */
EXPORTED char sources_digest[] = SOURCES_DIGEST;

EXPORTED const size_t structure_sizes[] = {sizeof(Input), sizeof(State), sizeof(Step), sizeof(StepTables)};

static void choose_variants(Contact *c)
{
    static const Patch *const patches[] = {
        [RIGID_PATCH] = &rigid_patch, [SPRING_PATCH] = &spring_patch, [PARTIAL_SLIP] = &partial_slip};
    c->patch = patches[c->in->patch];
}

/* A contact at its first touch; NULL if memory runs out. Input and state must outlive it. */
EXPORTED Contact *contact_new(const Input *in, State *s)
{
    const size_t n_loads = in->ports + in->slopes + in->dashpots, n_radiating = 3 * in->radiating;
    Contact *c = calloc(1, sizeof *c + (n_loads + n_radiating + 2 * in->modes) * sizeof(double));
    if (!c) return NULL;
    c->radiating = c->loads + n_loads;
    c->before = c->radiating + n_radiating;
    c->in = in;
    c->s = s;
    s->next_step = in->begins_with_impact ? 0 : in->step;
    s->window_end = HUGE_VAL;
    s->deadline = in->max_time;
    choose_variants(c);
    c->patch->begin(c);
    return c;
}

EXPORTED void contact_free(Contact *c) { free(c); }

/* Of a cue in contact: one in free flight turns without being bent. The last slope of each plane is that of
   the cue's end. */
static void update_max_slope(Contact *c)
{
    State *s = c->s;
    if (!touches(s)) return;
    const int per_plane = c->in->slopes / c->in->planes;
    for (int a = per_plane; a && a <= c->in->slopes; a += per_plane) {
        double slope = fabs(s->slopes[a - 1]);
        if (slope > s->max_slope) {
            s->max_slope = slope;
            s->axial_force = c->axial_force;
        }
    }
}

static bool is_finite(const Contact *c)
{
    double sum = c->s->indentation + c->s->time; /* NaN or infinite if any of its terms is */
    for (int f = 0; f < c->in->forces; f++) sum += c->F[f];
    return isfinite(sum);
}

/* Status after a step: RUNNING, ENDED, or why the contact cannot continue. */
static int status_of(const Contact *c)
{
    const State *s = c->s;
    if (!is_finite(c)) return UNSOLVED;
    if (s->indentation > c->in->indentation_limit) return INDENTATION_OUT_OF_RANGE;
    if (s->max_slope > SLOPE_LIMIT) return SLOPE_OUT_OF_RANGE;
    if (touches(s)) return s->time > s->deadline ? TIME_LIMIT : RUNNING;
    return s->time >= s->window_end ? ENDED : RUNNING;
}

static void begin_with_impact(Contact *c, Step *row)
{
    State *s = c->s;
    bool stays = take_impact(c, row);
    s->steps++;
    s->next_step = c->in->step;
    if (stays || s->status != RUNNING) return;
    separate(c);
    s->status = ENDED;
}

/* Whether a step was taken. */
static bool advance(Contact *c, Step *row)
{
    State *s = c->s;
    if (c->tables.h == 0) {
        begin_with_impact(c, row);
        return true;
    }
    if (!take_step(c, row)) return false;
    s->steps++;
    s->next_step = fmin(2 * c->tables.h, full_step(c->in, s)); /* a step that was halved grows again */
    next_phase(c);
    update_max_slope(c);
    if (s->status == RUNNING) s->status = status_of(c);
    return true;
}

/* Take up to max_steps steps of the tables' length and return their number; call again, with tables of the
   length State.next_step, while the status is RUNNING. rows: (max_steps,), a record of each step. modes:
   NULL, or (max_steps, 2, modes), the state of the modes after each step. */
EXPORTED int contact_steps(Contact *c, const StepTables *tables, int max_steps, Step *rows, double *modes)
{
    const State *s = c->s;
    const size_t n_state = 2 * (size_t)c->in->modes;
    int count = 0;
    c->tables = *tables;
    while (count < max_steps && s->status == RUNNING && s->next_step == c->tables.h) {
        if (!advance(c, rows + count)) continue;
        if (modes) memcpy(modes + n_state * count, s->modes, n_state * sizeof(double));
        count++;
    }
    return count;
}
