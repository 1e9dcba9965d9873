/* Time stepping of a contact from first touch to separation, and through the window for a second hit. */
#include "contact.h"

/* Largest slope of the cue's end, rad: there the shortening w'^2/2 exceeds the exact 1 - cos w' by 0.5 %. */
static const double SLOPE_LIMIT = 0.25;
/* A tip of restitution e unloads 1/e times as fast as it loads. Below this restitution, unloading steps are
   shortened by the factor e / MIN_STEP_RESTITUTION. */
static const double MIN_STEP_RESTITUTION = 0.5;
static const double INFINITE_FRICTION = 1e12; /* as in step_records.py */

static void update_port_velocities(Work *w)
{
    const int n_modes = w->c->modes, n_cue = w->c->ports + w->c->slopes;
    for (int q = 0; q < n_cue; q++) {
        w->port_velocities[q] = 0;
        for (int k = 0; k < n_modes; k++) w->port_velocities[q] += w->c->rows[q * n_modes + k] * w->state[k];
    }
}

EXPORTED void contact_free(Work *w)
{
    if (w) free(w->state), free(w);
}

/* A contact at its first touch; NULL if memory runs out. */
EXPORTED Work *contact_new(Contact *c)
{
    const size_t n_modes = c->modes, n_loads = c->ports + c->slopes + c->dashpots;
    Work *w = calloc(1, sizeof *w);
    if (!w || !(w->state = malloc((2 * n_modes + n_loads + 3 * c->radiating) * sizeof(double))))
        return contact_free(w), NULL;
    w->c = c;
    w->loads = w->state + 2 * n_modes;
    w->group = w->loads + n_loads;
    memcpy(w->state, c->state, 2 * n_modes * sizeof(double));
    memcpy(w->ball, c->ball, c->speeds * sizeof(double));
    c->next_step = c->step;
    w->window_end = HUGE_VAL, w->deadline = c->max_time;
    update_port_velocities(w);
    return w;
}

/* Separation: a spring patch loses its strain energy; modal state and ball velocities are copied to the
   Contact. */
static void separate(Work *w, double shift)
{
    Contact *c = w->c;
    if (c->patch == SPRING_PATCH && c->steps > c->steps_to_last_separation) {
        double F = w->slip ? w->F[T] : (shift - w->origin) / c->compliance;
        c->shear_loss += c->compliance * F * F / 2;
    }
    c->steps_to_last_separation = c->steps, w->deadline = c->max_time + c->time;
    w->phase = FREE, w->ends_at_event = 0, w->tip_stuck = 0, w->virtual_mid = 0,
    w->origin = w->shift_mid = shift;
    memset(w->annulus_force, 0, sizeof w->annulus_force), memset(w->F, 0, sizeof w->F);
    memcpy(c->state, w->state, 2 * c->modes * sizeof(double));
    memcpy(c->ball, w->ball, c->speeds * sizeof(double));
    c->damping_loss = w->damping_loss;
    c->radiated = w->radiated;
    if (!isfinite(w->window_end)) w->window_end = c->time + c->window;
}

/* Normal phase and length of the next step; v_n: normal velocity of the contact at the end of this one.
   Handbook: The strike: F = k d loading, (k/e^2)(d - (1 - e^2) D) unloading; Low restitution: h e/0.5. */
static void next_phase(Work *w, double v_n)
{
    Contact *c = w->c;
    double unloading_step = c->restitution < MIN_STEP_RESTITUTION
                                ? c->step * c->restitution / MIN_STEP_RESTITUTION
                                : c->step,
           h = w->t.h;
    if (w->phase == LOADING && v_n > 0) {
        c->max_indentation = larger(c->max_indentation, c->indentation);
        w->phase = UNLOADING, h = unloading_step;
    } else if (w->phase == UNLOADING && (w->ends_at_event || c->indentation <= residual(c)))
        separate(w, w->shift), h = c->step;
    else if (w->phase == UNLOADING && c->indentation > c->max_indentation)
        w->phase = LOADING, h = c->step;
    else if (w->phase == FREE && (w->ends_at_event || c->indentation > residual(c)))
        /* below max_indentation a second contact follows the unloading curve, beyond it the loading curve */
        w->phase = UNLOADING, w->ends_at_event = 0, h = unloading_step;
    c->next_step = h;
}

/* Friction state of the step, at a mean tangential velocity u. */
static int friction_state_of(const Work *w, double u)
{
    const Contact *c = w->c;
    if (c->friction == 0 && c->forces == 2) /* no friction force: by the velocity */
        return u < 0 ? SLIP : u > 0 ? SLIP_BACK : STICK;
    /* a rigid patch that comes to rest within the step has slipped in a part of it: counted as slip */
    int stops = !w->slip && !w->tip_stuck && c->patch == RIGID_PATCH;
    if (c->patch != PARTIAL_SLIP)
        return !stops || w->u_stick[T] == 0 ? w->slip : w->u_stick[T] < 0 ? SLIP : SLIP_BACK;
    if (fabs(w->F[T]) < c->friction * w->F[N] * (1 - 1e-6)) return STICK;
    return w->F[T] > 0 ? SLIP : w->F[T] < 0 ? SLIP_BACK : c->friction_state;
}

/* Take one step and return 1. If ball and tip separate or touch before its end, prepare a shorter step that
   ends there and return 0. */
static int take_step(Work *w, Step *row)
{
    Contact *c = w->c;
    const int n_cue = c->ports + c->slopes;
    const double h = w->t.h;
    double loads[VELOCITIES] = {0}, v[FORCES], u[FORCES], section_rotation_rate = 0, spin = w->ball[2];
    free_motion(w);
    contact_matrices(w);
    if (w->phase != FREE && !(c->forces == 2 ? level_forces(w) : raised_forces(w))) c->status = UNSOLVED;
    velocities(w, v, u);
    double excess = c->indentation - residual(c), excess_at_end = excess - h * u[N];
    int crosses_zero =
        w->phase == UNLOADING ? excess_at_end < 0 : w->phase == FREE && excess < 0 && excess_at_end > 0;
    if (crosses_zero && !w->ends_at_event) {
        w->ends_at_event = 1;
        c->next_step = h * larger(excess / (h * u[N]), 1e-6);
        return 0;
    }
    for (int f = 0; f < c->forces; f++) {
        c->work[f] -= h * w->F[f] * u[f];
        for (int p = 0; p < n_cue + c->speeds; p++) loads[p] += w->C[f][p] * w->F[f];
    }
    w->axial_force = -loads[0];
    load_modes(w, loads);
    add_losses(w);
    advance_modes(w);
    for (int p = 0; p < n_cue; p++) {
        double end = w->end_free[p], mean = w->mean_free[p];
        for (int q = 0; q < n_cue; q++)
            end += w->t.end_per_load[p * n_cue + q] * loads[q],
                mean += w->t.mean_per_load[p * n_cue + q] * loads[q];
        /* port 2: rotation rate of the end section; of a raised cue, without rolling, out-of-plane velocity
         */
        if (p == 2 && c->ports > 2) section_rotation_rate = mean;
        if (p >= c->ports) w->slopes[p - c->ports] += h * mean;
        w->port_velocities[p] = end;
    }
    for (int b = 0; b < c->speeds; b++) w->ball[b] += h * c->inverse_masses[b] * loads[n_cue + b];
    if (c->rolling) {
        /* rolling and slip move the contact over ball and dome; beyond the dome's rim over the ball alone */
        double dome = fabs(c->phi + c->angle) < c->rim ? c->dome : 0;
        w->rolling_rate =
            ((spin + w->ball[2]) / 2 - u[T] + dome * section_rotation_rate) / (c->radius + dome);
        c->angle += h * w->rolling_rate;
    }
    double middle = w->shift - h / 2 * u[T];
    if (w->phase != FREE) {
        if (w->slip && c->patch == SPRING_PATCH) w->origin = middle - c->compliance * w->F[T];
        if (c->patch == PARTIAL_SLIP)
            memcpy(w->annulus_force, w->annulus_force_now, sizeof w->annulus_force),
                c->shear_loss += w->annuli_loss;
        w->virtual_mid = w->virtual_now;
        c->friction_state = friction_state_of(w, u[T]), w->tip_stuck = !w->slip;
    } else
        c->friction_state = SEPARATED, middle = w->origin = w->shift - h * u[T]; /* unstrained at touch */
    w->shift -= h * u[T], w->shift_mid = middle, c->indentation -= h * u[N], c->time += h;
    if (c->forces > 2) c->height = larger(0, c->height + h * u[UP]);
    *row = (Step){.time = c->time,
                  .length = h,
                  .friction_state = c->friction_state,
                  .phase = w->phase,
                  .angle = c->angle};
    memcpy(row->F, w->F, sizeof row->F), memcpy(row->v, v, c->forces * sizeof(double));
    return 1;
}

/* Update max_slope; return the status after a step: RUNNING, ENDED, or why the contact cannot continue. */
static int update_status(Work *w)
{
    Contact *c = w->c;
    /* of a cue in contact: one in free flight turns without being bent. The last slope of each plane is its end's */
    const int per_plane = w->phase == FREE ? 0 : c->slopes / c->planes;
    for (int a = per_plane; a && a <= c->slopes; a += per_plane) {
        double slope = fabs(w->slopes[a - 1]);
        if (slope > c->max_slope) c->max_slope = slope, c->axial_force = w->axial_force;
    }
    double sum = c->indentation + c->time; /* NaN or infinite if any of its terms is */
    for (int f = 0; f < c->forces; f++) sum += w->F[f];
    if (!isfinite(sum)) return UNSOLVED;
    if (c->law == LEATHER_LAW && c->indentation > c->indentation_limit) return INDENTATION_OUT_OF_RANGE;
    if (c->max_slope > SLOPE_LIMIT) return SLOPE_OUT_OF_RANGE;
    if (w->phase == FREE) return c->time >= w->window_end ? ENDED : RUNNING;
    return c->time > w->deadline ? TIME_LIMIT : RUNNING;
}

/* Take up to max_steps steps of the tables' length and return their number. Call again while the status is
   RUNNING, with tables of the length Contact.next_step. rows: (max_steps,), a record of each step. states:
   NULL, or (max_steps, 2, modes), the state of the modes after each step. */
EXPORTED int contact_steps(Work *w, const StepTables *tables, int max_steps, Step *rows, double *states)
{
    Contact *c = w->c;
    int count = 0;
    w->t = *tables;
    while (count < max_steps && c->status == RUNNING && c->next_step == w->t.h) {
        /* first touch of a rigid patch with infinite friction: an impulse stops the tangential motion */
        if (!c->steps && c->friction >= INFINITE_FRICTION && c->patch == RIGID_PATCH && c->phi > 0) {
            rows[count] = (Step){.friction_state = IMPACT};
            int stays = impact(w, rows + count);
            update_port_velocities(w);
            c->steps++;
            if (!stays && c->status == RUNNING) separate(w, w->shift), c->status = ENDED;
        } else if (take_step(w, rows + count)) {
            c->steps++;
            next_phase(w, rows[count].v[N]);
            if (c->status == RUNNING) c->status = update_status(w);
        } else
            continue;
        memcpy(rows[count].ball, w->ball, sizeof w->ball);
        if (states) memcpy(states + (size_t)2 * c->modes * count, w->state, 2 * c->modes * sizeof(double));
        count++;
    }
    return count;
}

EXPORTED const size_t contact_size = sizeof(Contact), step_size = sizeof(Step),
                      tables_size = sizeof(StepTables);
