/* A contact from first touch to separation, and through the window for a second hit: what Python calls. */
#include "contact.h"

/* Largest slope of the cue's end, rad: there the shortening w'^2/2 exceeds the exact 1 - cos w' by 0.5 %. */
static const double SLOPE_LIMIT = 0.25;

/* The digest of the sources that the library was built from. It is not constant, so that it stands behind all
   code: a file that holds it has not been cut short (kernel/__init__.py). */
EXPORTED char sources_digest[] = SOURCES_DIGEST;

EXPORTED const size_t structure_sizes[] = {sizeof(Input), sizeof(State), sizeof(Step), sizeof(StepTables)};

/* A contact, for Python: its input and state, and the step under way. */
typedef struct {
    const Input *in;
    State *s;
    Work w;
    Edge edges[ANNULI + 1];
    double arrays[]; /* of Work */
} Contact;

/* A contact at its first touch; NULL if memory runs out. Input and state must outlive it. */
EXPORTED Contact *contact_new(const Input *in, State *s)
{
    const size_t n_loads = in->ports + in->slopes + in->dashpots, n_radiating = 3 * in->radiating;
    Contact *c = calloc(1, sizeof *c + (n_loads + n_radiating + 2 * in->modes) * sizeof(double));
    if (!c) return NULL;
    c->in = in;
    c->s = s;
    c->w.edges = c->edges;
    c->w.loads = c->arrays;
    c->w.radiating = c->w.loads + n_loads;
    c->w.before = c->w.radiating + n_radiating;
    if (in->patch == PARTIAL_SLIP) find_edges(in, c->edges);
    s->next_step = in->begins_with_impact ? 0 : in->step;
    s->window_end = HUGE_VAL;
    s->deadline = in->max_time;
    return c;
}

EXPORTED void contact_free(Contact *c) { free(c); }

/* Of a cue in contact: one in free flight turns without being bent. The last slope of each plane is that of
   the cue's end. */
static void update_max_slope(const Input *in, State *s, double axial_force)
{
    if (!touches(s)) return;
    const int per_plane = in->slopes / in->planes;
    for (int a = per_plane; a && a <= in->slopes; a += per_plane) {
        double slope = fabs(s->slopes[a - 1]);
        if (slope > s->max_slope) {
            s->max_slope = slope;
            s->axial_force = axial_force;
        }
    }
}

static bool is_finite(const Input *in, const State *s, const Work *w)
{
    double sum = s->indentation + s->time; /* NaN or infinite if any of its terms is */
    for (int f = 0; f < in->forces; f++) sum += w->F[f];
    return isfinite(sum);
}

/* Status after a step: RUNNING, ENDED, or why the contact cannot continue. */
static int status_of(const Input *in, const State *s, const Work *w)
{
    if (!is_finite(in, s, w)) return UNSOLVED;
    if (s->indentation > in->indentation_limit) return INDENTATION_OUT_OF_RANGE;
    if (s->max_slope > SLOPE_LIMIT) return SLOPE_OUT_OF_RANGE;
    if (touches(s)) return s->time > s->deadline ? TIME_LIMIT : RUNNING;
    return s->time >= s->window_end ? ENDED : RUNNING;
}

static void begin_with_impact(const Input *in, const StepTables *t, State *s, Work *w, Step *row)
{
    bool stays = take_impact(in, t, s, w, row);
    s->steps++;
    s->next_step = in->step;
    if (!stays) separate(in, s, w);
}

/* Whether a step was taken. */
static bool advance(const Input *in, const StepTables *t, State *s, Work *w, Step *row)
{
    if (t->h == 0) {
        begin_with_impact(in, t, s, w, row);
        return true;
    }
    if (!take_step(in, t, s, w, row)) return false;
    s->steps++;
    s->next_step = fmin(2 * t->h, full_step(in, s)); /* a step that was halved grows again */
    next_phase(in, s, w);
    update_max_slope(in, s, w->axial_force);
    if (s->status == RUNNING) s->status = status_of(in, s, w);
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
    while (count < max_steps && s->status == RUNNING && s->next_step == tables->h) {
        if (!advance(c->in, tables, c->s, &c->w, rows + count)) continue;
        if (modes) memcpy(modes + n_state * count, s->modes, n_state * sizeof(double));
        count++;
    }
    return count;
}

/* Impulse on the tip's lateral port, N s, that imposes mean velocities on it over equal steps, m/s, after a
   first impulse, which the modes have taken. The velocities are relative to a ball of an inverse mass, 1/kg,
   that the impulse moves, too. */
EXPORTED double imposed_velocity_impulse(Contact *c, const StepTables *tables, int steps, const double *means,
                                         double ball_inverse_mass, double first_impulse)
{
    const int n_cue = c->in->ports + c->in->slopes, n_state = 2 * c->in->modes;
    const double *mean_velocity = tables->means + LATERAL_PORT * n_state;
    const double per_force =
        tables->mean_per_load[LATERAL_PORT * n_cue + LATERAL_PORT] + ball_inverse_mass * tables->h / 2;
    double impulse = first_impulse;
    for (int n = 0; n < steps; n++) {
        double without_force = product(mean_velocity, c->s->modes, n_state) + ball_inverse_mass * impulse;
        c->w.loads[LATERAL_PORT] = (means[n] - without_force) / per_force;
        load_modes(c->in, tables, c->s, &c->w);
        advance_modes(c->in, tables, c->s, &c->w);
        impulse += tables->h * c->w.loads[LATERAL_PORT];
    }
    return impulse;
}
