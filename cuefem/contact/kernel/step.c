/* Time stepping of a contact from first touch to separation, and through the window for a second hit. */
#include "contact.h"

/* Largest slope of the tip, rad: beyond it the shortening w'^2/2 of the second-order theory is inaccurate. */
static const double SLOPE_LIMIT = 0.25;
/* A tip of restitution e unloads 1/e times as fast as it loads: below this one, steps are shortened by e over
 * it. */
static const double MIN_STEP_RESTITUTION = 0.5;
static const double ENDLESS = 1e12; /* infinite friction */

static void read_modes(Work *w)
{
    const int Q = w->c->ports + w->c->slopes, wide = 2 * w->c->modes;
    for (int q = 0; q < Q; q++) {
        w->rates[q] = 0;
        for (int i = 0; i < wide; i++) w->rates[q] += w->rows[q * wide + i] * w->state[i];
    }
}

EXPORTED void contact_free(Work *w)
{
    if (w) free(w->t.propagator), free(w->rows), free(w);
}

/* A contact at its first touch; NULL if memory runs out. */
EXPORTED Work *contact_new(Contact *c)
{
    const int K = c->modes, Q = c->ports + c->slopes, wide = 2 * K;
    Work *w = calloc(1, sizeof *w);
    if (!w || !(w->rows = malloc((size_t)(2 * Q + 1) * wide * sizeof(double)))) return contact_free(w), NULL;
    w->c = c, w->drives = w->rows + Q * wide, w->state = w->drives + Q * wide;
    for (int k = 0; k < K; k++) {
        w->state[k] = c->xi[2 * k], w->state[K + k] = c->xi[2 * k + 1];
        for (int q = 0; q < Q; q++) {
            const double *row = c->rows + 2 * (q * K + k), *drive = c->drives + 2 * (q * K + k);
            w->rows[q * wide + k] = row[0], w->rows[q * wide + K + k] = -row[1];
            w->drives[q * wide + k] = drive[0], w->drives[q * wide + K + k] = drive[1];
        }
    }
    memcpy(w->ball, c->ball, c->speeds * sizeof(double));
    w->until = HUGE_VAL, w->max_time = c->max_time;
    read_modes(w);
    if (!tabulate(w, c->step)) return contact_free(w), NULL;
    return w;
}

/* Separation: the strain energy of the patch is lost, and the state is stored as the final one so far. */
static void separate(Work *w, double shift)
{
    Contact *c = w->c;
    if (c->patch == SPRING_PATCH && c->steps > c->steps_in_contact) {
        double F = w->side ? w->F[T] : (shift - w->origin) / c->compliance;
        c->shear_loss += c->compliance * F * F / 2;
    }
    c->steps_in_contact = c->steps, w->max_time = c->max_time + c->time;
    w->phase = FREE, w->last = 0, w->held = 0, w->virtual_mid = 0, w->origin = w->shift_mid = shift;
    memset(w->annulus_force, 0, sizeof w->annulus_force), memset(w->F, 0, sizeof w->F);
    for (int k = 0; k < c->modes; k++) c->xi[2 * k] = w->state[k], c->xi[2 * k + 1] = w->state[c->modes + k];
    memcpy(c->ball, w->ball, c->speeds * sizeof(double));
    if (!isfinite(w->until)) w->until = c->time + c->window;
}

static int set_step(Work *w, double h) { return w->t.h == h || tabulate(w, h); }

/* Normal phase of the next step; v_n: velocity of separation at the end of this one. */
static void next_phase(Work *w, double v_n)
{
    Contact *c = w->c;
    double soft = c->restitution < MIN_STEP_RESTITUTION ? c->step * c->restitution / MIN_STEP_RESTITUTION
                                                        : c->step,
           h = w->t.h;
    if (w->phase == LOADING && v_n > 0) {
        c->max_depth = larger(c->max_depth, c->depth), w->phase = UNLOADING, h = soft;
    } else if (w->phase == UNLOADING && (w->last || c->depth <= residual_depth(c)))
        separate(w, w->shift), h = c->step;
    else if (w->phase == UNLOADING && c->depth > c->max_depth)
        w->phase = LOADING, h = c->step;
    else if (w->phase == FREE && (w->last || c->depth > residual_depth(c)))
        w->phase = UNLOADING, w->last = 0, h = soft;
    if (!set_step(w, h)) c->status = NO_MEMORY;
}

/* Friction state of the contact, at a mean tangential velocity u. */
static int friction_state_of(const Work *w, double u)
{
    const Contact *c = w->c;
    if (c->friction == 0 && c->forces == 2) return u < 0 ? SLIP : u > 0 ? SLIP_BACK : STICK;
    int stops =
        !w->side && !w->held && c->patch == RIGID_PATCH; /* stick begins within the step: counted as slip */
    if (c->patch != PARTIAL_SLIP)
        return !stops || w->rest[T] == 0 ? w->side : w->rest[T] < 0 ? SLIP : SLIP_BACK;
    if (fabs(w->F[T]) < c->friction * w->F[N] * (1 - 1e-6)) return STICK;
    return w->F[T] > 0 ? SLIP : w->F[T] < 0 ? SLIP_BACK : c->friction_state;
}

/* One step; 0 where ball and tip separate or touch before its end, with a shorter step prepared. */
static int take_step(Work *w, Step *row)
{
    Contact *c = w->c;
    const int Q = c->ports + c->slopes;
    const double h = w->t.h;
    double loads[WIDE] = {0}, v[FORCES], u[FORCES], turned = 0, spin = w->ball[2];
    free_motion(w);
    contact_matrices(w);
    if (w->phase != FREE && !(c->forces == 2 ? level_forces(w) : raised_forces(w))) c->status = UNSOLVED;
    velocities(w, v, u);
    double left = c->depth - residual_depth(c), then = left - h * u[N];
    int crosses = w->phase == UNLOADING ? then < 0 : w->phase == FREE && left < 0 && then > 0;
    if (crosses && w->last != 1) {
        w->last = 1;
        if (!tabulate(w, h * larger(left / (h * u[N]), 1e-6))) c->status = NO_MEMORY;
        return 0;
    }
    for (int f = 0; f < c->forces; f++) {
        c->work[f] -= h * w->F[f] * u[f];
        for (int p = 0; p < Q + c->speeds; p++) loads[p] += w->C[f][p] * w->F[f];
    }
    advance_modes(w, loads);
    for (int p = 0; p < Q; p++) {
        double end = w->end_free[p], mean = w->mean_free[p];
        for (int q = 0; q < Q; q++) end += w->t.end[p][q] * loads[q], mean += w->t.mean[p][q] * loads[q];
        if (p == 2 && c->ports > 2) turned = mean; /* rotation of the tip's section, or out of the plane */
        if (p >= c->ports) w->slopes[p - c->ports] += h * mean;
        w->rates[p] = end;
    }
    for (int b = 0; b < c->speeds; b++) w->ball[b] += h * c->inverse_masses[b] * loads[Q + b];
    if (c->rolling) { /* rolling and slip move the contact over ball and dome; on the rim over the ball alone
                       */
        double dome = fabs(c->phi + c->angle) < c->rim ? c->dome : 0;
        w->rolling_rate = ((spin + w->ball[2]) / 2 - u[T] + dome * turned) / (c->radius + dome);
        c->angle += h * w->rolling_rate;
    }
    double middle = w->shift - h / 2 * u[T];
    if (w->phase != FREE) {
        if (w->side && c->patch == SPRING_PATCH) w->origin = middle - c->compliance * w->F[T];
        if (c->patch == PARTIAL_SLIP)
            memcpy(w->annulus_force, w->annulus_force_now, sizeof w->annulus_force), c->shear_loss += w->lost;
        w->virtual_mid = w->virtual_now;
        c->friction_state = friction_state_of(w, u[T]), w->held = !w->side;
    } else
        c->friction_state = SEPARATED,
        middle = w->origin = w->shift - h * u[T]; /* a patch is unstrained at touch */
    w->shift -= h * u[T], w->shift_mid = middle, c->depth -= h * u[N], c->time += h;
    if (c->forces > 2) c->height = larger(0, c->height + h * u[UP]);
    *row = (Step){.time = c->time,
                  .length = h,
                  .friction_state = c->friction_state,
                  .phase = w->phase,
                  .angle = c->angle};
    memcpy(row->F, w->F, sizeof row->F), memcpy(row->v, v, c->forces * sizeof(double));
    return 1;
}

/* Status after a step: RUNNING, ENDED, or the reason why the contact cannot continue. */
static int failure_status(Work *w)
{
    Contact *c = w->c;
    for (int a = c->slopes / c->planes; a && a <= c->slopes;
         a += c->slopes / c->planes) { /* the tip's slope is the last */
        double turned = fabs(w->slopes[a - 1]);
        if (turned > c->max_slope) c->max_slope = turned, c->axial_force = w->F[N];
    }
    double together = c->depth + c->time;
    for (int f = 0; f < c->forces; f++) together += w->F[f];
    if (!isfinite(together)) return UNSOLVED;
    if (c->law == LEATHER_LAW && c->depth > c->depth_limit) return INDENTATION_OUT_OF_RANGE;
    if (c->max_slope > SLOPE_LIMIT) return SLOPE_OUT_OF_RANGE;
    if (w->phase == FREE) return c->time >= w->until ? ENDED : RUNNING;
    return c->time > w->max_time ? LATE : RUNNING;
}

/* Take up to `most` steps, each with a record and the modal coordinates after it (course may be NULL).
   Returns their number. The status stays RUNNING until the contact has ended. */
EXPORTED int contact_steps(Work *w, int most, Step *rows, double *course)
{
    Contact *c = w->c;
    int done = 0;
    while (done < most && c->status == RUNNING) {
        if (!c->steps && c->friction >= ENDLESS && c->patch == RIGID_PATCH && c->phi > 0) {
            rows[done] = (Step){.friction_state = IMPACT};
            int stays = impact(w, rows + done);
            read_modes(w);
            c->steps++;
            if (!stays && c->status == RUNNING) separate(w, w->shift), c->status = ENDED;
        } else if (take_step(w, rows + done)) {
            c->steps++;
            next_phase(w, rows[done].v[N]);
            if (c->status == RUNNING) c->status = failure_status(w);
        } else
            continue;
        memcpy(rows[done].ball, w->ball, sizeof w->ball);
        if (course) memcpy(course + (size_t)2 * c->modes * done, w->state, 2 * c->modes * sizeof(double));
        done++;
    }
    return done;
}

EXPORTED const size_t contact_size = sizeof(Contact), step_size = sizeof(Step);
