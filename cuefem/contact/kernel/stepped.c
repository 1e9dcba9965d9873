/* Steps of a contact that is not linear (cuefem.contact.stepped, `_way`): the equations of cuefem.contact.nonlinear,
   stepped by scipy's DOP853 as scipy.integrate does it, step by step, with its tables. Only a power law that gives
   something back, on domes and on a patch that is rigid or on a spring; Python steps anything else. */
#include "kernel.h"

#include <string.h>

enum { ENDED = 0, FULL = 1, LATE = 2, STUCK = 3, REFUSED = 4 };
enum { STAGES = 12, EXTENDED = 16, POWERS = 7, LOOKS = 4 };
static const double SAFETY = 0.9, LEAST = 0.2, MOST = 10, ORDER = 8;

/* The tables of DOP853, rows of EXTENDED numbers in the matrices. */
struct tables {
    int stages, extended, powers;
    const double *a, *b, *e3, *e5, *d;
};

/* Where the parts of a state stand, and the numbers of `Stepped`. shear: -1 on a rigid patch. turns: whether the normal
   does; levers: (u, w) of the first touch, m. amplitude: along and across the cue; absolute: tolerances. */
struct stepped {
    int size, turning, at, first, modes, ball_t, ball_n, spin, depth, angle, rubbed, damped, gone, shear, dampers, lossy;
    int turns;
    double phi, root_mass, friction, clock, dome, reach, lever_u, lever_w, stiffness, exponent, restitution, compliance;
    double unit, speed, force, rounding, relative, longest_step;
    const double *omega, *c_t, *c_n, *damping, *along, *across, *rotation, *absolute;
};

/* side: 1 or -1 of a slip, 0 in stick. deepest: at the last peak, m; near: by which a touch overlaps, m. */
struct hold {
    int apart, side, loading;
    double deepest, near;
};

/* Where the stepping is, in units of the clock. step: the next one, or 0 at the start. event: by its number. */
struct way {
    double time, step, end;
    int written, event;
};

/* v_t and v_n, the forces, N, and (V_D - V_C) . t. */
struct seen {
    double v_t, v_n, F_t, F_n, passing;
};

/* What the steps work in. */
struct work {
    double *rows_t, *rows_n, *free, *trial, *fresh, *stages;
};

static double load_of(const struct stepped *s, double x)
{
    return s->stiffness * copysign(pow(fabs(x), s->exponent), x);
}

static double squared(const struct stepped *s)
{
    return s->restitution * s->restitution;
}

static double rest(const struct stepped *s, double deepest)
{
    return (1 - squared(s)) * deepest;
}

/* The tip's force, and its stiffness. */
static double pressing(const struct stepped *s, const struct hold *hold, double depth)
{
    return load_of(s, hold->loading ? depth : (depth - rest(s, hold->deepest)) / squared(s));
}

static double slope(const struct stepped *s, const struct hold *hold, double depth)
{
    double by = hold->loading ? 1 : squared(s), x = hold->loading ? depth : (depth - rest(s, hold->deepest)) / by;
    return s->stiffness * s->exponent * pow(fabs(x), s->exponent - 1) / by;
}

INLINE double dot(const double *one, const double *other, int count)
{
    double total = 0;
    for (int i = 0; i < count; i++)
        total += one[i] * other[i];
    return total;
}

/* The rows where the contact has turned to. */
static void turn(const struct stepped *s, const struct work *work, const double *z)
{
    double turned = z[s->angle], phi = s->phi + turned, sine = sin(phi), cosine = cos(phi);
    double by_u = -s->dome * sine - s->lever_u, by_w = s->dome * (1 - cosine) - s->lever_w;
    for (int i = 0; i < s->modes; i++) {
        double u = s->along[i] + s->rotation[i] * by_u, w = s->across[i] + s->rotation[i] * by_w;
        work->rows_t[s->first + i] = -(sine * u + cosine * w);
        work->rows_n[s->first + i] = sine * w - cosine * u;
    }
    work->rows_t[s->ball_t] = work->rows_n[s->ball_n] = s->root_mass * cos(turned);
    work->rows_t[s->ball_n] = s->root_mass * sin(turned);
    work->rows_n[s->ball_t] = -s->root_mass * sin(turned);
}

/* The rate of a state without forces at the contact, and what is seen there. */
FAST static struct seen look(const struct stepped *s, const struct hold *hold, const struct work *work, const double *z)
{
    double *restrict rate = work->free;
    int size = s->size;
    memset(rate, 0, sizeof(double) * size);
    for (int i = 0; i < s->turning; i++)
        rate[i] = s->omega[i] * z[s->at + i];
    for (int i = 0; i < s->turning; i++)
        rate[s->at + i] = -s->omega[i] * z[i];
    for (int d = 0; d < s->dampers; d++) {
        const double *damper = s->damping + (size_t)d * size;
        double strength = dot(damper, z, size);
        for (int i = 0; i < size; i++)
            rate[i] -= strength * damper[i];
    }
    if (s->turns)
        turn(s, work, z);
    const double *c_t = work->rows_t, *c_n = work->rows_n;
    struct seen seen = {.v_t = dot(c_t, z, size), .v_n = dot(c_n, z, size)};
    if (s->turns)
        seen.passing = c_t[s->spin] * z[s->spin] - seen.v_t + s->dome * dot(s->rotation, z + s->first, s->modes);
    if (hold->apart)
        return seen;
    seen.F_n = pressing(s, hold, z[s->depth]);
    if (hold->side)
        seen.F_t = hold->side * s->friction * seen.F_n;
    else if (s->shear >= 0)
        seen.F_t = z[s->shear] / s->unit;
    else { /* v_t is kept at zero */
        double falls = dot(c_t, rate, size) + (s->turns ? seen.passing / s->reach * seen.v_n : 0);
        seen.F_t = -(falls + dot(c_t, c_n, size) * seen.F_n) / dot(c_t, c_t, size);
    }
    return seen;
}

/* The rate of change of a state, per clock. */
FAST static void change(const struct stepped *s, const struct hold *hold, const struct work *work, const double *z,
                        double *restrict rate)
{
    struct seen seen = look(s, hold, work, z);
    const double *restrict c_t = work->rows_t, *restrict c_n = work->rows_n, *restrict free = work->free;
    for (int i = 0; i < s->size; i++)
        rate[i] = free[i] + c_t[i] * seen.F_t + c_n[i] * seen.F_n;
    if (!hold->apart) {
        rate[s->rubbed] = -seen.F_t * seen.v_t;
        if (!hold->side && s->shear >= 0)
            rate[s->shear] = -s->unit * seen.v_t / s->compliance;
    }
    rate[s->depth] = -seen.v_n;
    if (s->turns)
        rate[s->angle] = seen.passing / s->reach;
    for (int d = 0; d < s->dampers; d++) {
        double speed = dot(s->damping + (size_t)d * s->size, z, s->size);
        rate[d < s->lossy ? s->damped : s->gone] += speed * speed;
    }
    for (int i = 0; i < s->size; i++)
        rate[i] *= s->clock;
}

/* What ends the phase: values of the order of 1, which fall through zero; how many there are. In the order of
   `Stepped._ends`. */
static int ends_of(const struct stepped *s, const struct hold *hold, const struct work *work, const double *z, double *ends)
{
    struct seen seen = look(s, hold, work, z);
    double depth = s->speed * s->clock;
    int count = 0;
    if (hold->apart) {
        ends[count++] = (rest(s, hold->deepest) - z[s->depth] + hold->near) / depth;
        return count;
    }
    if (hold->loading)
        ends[count++] = -seen.v_n / s->speed;
    else {
        ends[count++] = (z[s->depth] - rest(s, hold->deepest)) / depth;
        ends[count++] = (hold->deepest - z[s->depth]) / depth;
    }
    if (hold->side) {
        double rise = s->shear < 0 ? 0 : -slope(s, hold, z[s->depth]) * seen.v_n;
        ends[count++] = -hold->side * (seen.v_t + s->compliance * hold->side * s->friction * rise) / s->speed;
    } else if (s->friction < HUGE_VAL)
        for (int way = 1; way >= -1; way -= 2)
            ends[count++] = (s->friction * seen.F_n - way * seen.F_t) / s->force + s->rounding;
    return count;
}

static double size_of(const struct stepped *s, const double *values, const double *scale)
{
    double total = 0;
    for (int i = 0; i < s->size; i++)
        total += (values[i] / scale[i]) * (values[i] / scale[i]);
    return sqrt(total / s->size);
}

/* Sum of the first stages, weighted. */
FAST static void weighted(const double *stages, const double *weights, int count, int size, double by,
                          double *restrict found)
{
    memset(found, 0, sizeof(double) * size);
    for (int k = 0; k < count; k++)
        if (weights[k] != 0)
            for (int i = 0; i < size; i++)
                found[i] += weights[k] * stages[(size_t)k * size + i];
    for (int i = 0; i < size; i++)
        found[i] *= by;
}

/* A state and the weighted stages after it. */
static void onward(const struct stepped *s, const struct work *work, const double *z, const double *weights, int count,
                   double step, double *found)
{
    weighted(work->stages, weights, count, s->size, step, found);
    for (int i = 0; i < s->size; i++)
        found[i] += z[i];
}

/* `select_initial_step` of scipy; the rate at z is the first stage. */
static double first_step(const struct stepped *s, const struct hold *hold, const struct work *work, const double *z,
                         double span)
{
    double *scale = work->fresh, *rate = work->stages, *other = work->stages + s->size;
    for (int i = 0; i < s->size; i++)
        scale[i] = s->absolute[i] + fabs(z[i]) * s->relative;
    double size = size_of(s, z, scale), grows = size_of(s, rate, scale);
    double step = fmin(size < 1e-5 || grows < 1e-5 ? 1e-6 : 0.01 * size / grows, span);
    for (int i = 0; i < s->size; i++)
        work->trial[i] = z[i] + step * rate[i];
    change(s, hold, work, work->trial, other);
    for (int i = 0; i < s->size; i++)
        other[i] -= rate[i];
    double bends = size_of(s, other, scale) / step, best;
    if (grows <= 1e-15 && bends <= 1e-15)
        best = fmax(1e-6, step * 1e-3);
    else
        best = pow(0.01 / fmax(grows, bends), 1 / ORDER);
    return fmin(fmin(100 * step, best), fmin(span, s->longest_step));
}

/* The error of a step over its tolerance. */
static double error_of(const struct stepped *s, const struct tables *tables, const struct work *work, const double *z,
                       double step)
{
    double fifth = 0, third = 0;
    for (int i = 0; i < s->size; i++) {
        double five = 0, three = 0, scale = s->absolute[i] + fmax(fabs(z[i]), fabs(work->fresh[i])) * s->relative;
        for (int k = 0; k <= STAGES; k++) {
            five += tables->e5[k] * work->stages[(size_t)k * s->size + i];
            three += tables->e3[k] * work->stages[(size_t)k * s->size + i];
        }
        fifth += five / scale * (five / scale);
        third += three / scale * (three / scale);
    }
    if (fifth == 0 && third == 0)
        return 0;
    return fabs(step) * fifth / sqrt((fifth + 0.01 * third) * s->size);
}

/* A step of one end: its interpolant, and the end that is looked at. */
struct course {
    const struct stepped *stepped;
    const struct hold *hold;
    const struct work *work;
    const double *z, *terms;
    double *state;
    int end;
};

static double end_at(const void *of, double part)
{
    const struct course *course = of;
    const struct stepped *s = course->stepped;
    double ends[LOOKS];
    for (int i = 0; i < s->size; i++) {
        double value = 0;
        for (int k = POWERS - 1; k >= 0; k--)
            value = (value + course->terms[(size_t)k * s->size + i]) * ((POWERS - 1 - k) % 2 ? 1 - part : part);
        course->state[i] = value + course->z[i];
    }
    ends_of(s, course->hold, course->work, course->state, ends);
    return ends[course->end];
}

EXPORTED ptrdiff_t cuefem_steps_room(int size)
{
    return (ptrdiff_t)size * (5 + EXTENDED);
}

/* Step from the state z up to the first end, or to `until` in units of the clock. ends: whether any is looked for. times:
   (most + 1,); olds: (most, size), the states at their starts; terms: (most, POWERS, size), of their interpolants; the two
   only where ends are looked for. ENDED: way->end tells when, in the last step, whose start z is left at. FULL: call
   again. LATE: at `until`. STUCK: no step is short enough. */
EXPORTED int cuefem_steps(const struct stepped *s, const struct hold *hold, const struct tables *tables, double until,
                          int ends, double *z, struct way *way, int most, double *times, double *olds, double *terms,
                          double *room)
{
    if (tables->stages != STAGES || tables->extended != EXTENDED || tables->powers != POWERS)
        return REFUSED;
    int size = s->size, count = 0;
    struct work work = {.rows_t = room, .rows_n = room + size, .free = room + 2 * size, .trial = room + 3 * size};
    work.fresh = room + 4 * size, work.stages = room + 5 * size;
    memcpy(work.rows_t, s->c_t, sizeof(double) * size);
    memcpy(work.rows_n, s->c_n, sizeof(double) * size);
#define STAGE(k) (work.stages + (size_t)(k) * size)
    double before[LOOKS], after[LOOKS];
    change(s, hold, &work, z, STAGE(0));
    if (way->step == 0)
        way->step = first_step(s, hold, &work, z, until - way->time);
    if (ends)
        count = ends_of(s, hold, &work, z, before);
    for (way->written = 0; way->time < until;) {
        if (way->written == most)
            return FULL;
        double shortest = 10 * (nextafter(way->time, HUGE_VAL) - way->time);
        double length = fmax(fmin(way->step, s->longest_step), shortest), step, next;
        for (int rejected = 0;; rejected = 1) {
            if (!(length >= shortest))
                return STUCK;
            next = fmin(way->time + length, until);
            step = length = next - way->time;
            for (int k = 1; k < STAGES; k++) {
                onward(s, &work, z, tables->a + k * EXTENDED, k, step, work.trial);
                change(s, hold, &work, work.trial, STAGE(k));
            }
            onward(s, &work, z, tables->b, STAGES, step, work.fresh);
            change(s, hold, &work, work.fresh, STAGE(STAGES));
            double error = error_of(s, tables, &work, z, step);
            if (error < 1) {
                double by = error == 0 ? MOST : fmin(MOST, SAFETY * pow(error, -1 / ORDER));
                way->step = length * (rejected ? fmin(1, by) : by);
                break;
            }
            length *= fmax(LEAST, SAFETY * pow(error, -1 / ORDER));
        }
        if (ends) {
            double *own = terms + (size_t)way->written * POWERS * size, *old = olds + (size_t)way->written * size;
            for (int k = STAGES + 1; k < EXTENDED; k++) {
                onward(s, &work, z, tables->a + k * EXTENDED, k, step, work.trial);
                change(s, hold, &work, work.trial, STAGE(k));
            }
            memcpy(old, z, sizeof(double) * size);
            for (int i = 0; i < size; i++) {
                double moved = work.fresh[i] - z[i], start = step * STAGE(0)[i], end = step * STAGE(STAGES)[i];
                own[i] = moved;
                own[size + i] = start - moved;
                own[2 * size + i] = 2 * moved - (end + start);
            }
            for (int k = 3; k < POWERS; k++)
                weighted(work.stages, tables->d + (k - 3) * EXTENDED, EXTENDED, size, step, own + (size_t)k * size);
            times[way->written++] = way->time;
            times[way->written] = next;
            ends_of(s, hold, &work, work.fresh, after);
            way->event = -1;
            for (int e = 0; e < count; e++)
                if (before[e] >= 0 && after[e] <= 0) {
                    struct course course = {s, hold, &work, old, own, work.trial, e};
                    double part = zero_of(end_at, &course, 0, 1), at = way->time + part * step;
                    if (way->event < 0 || at < way->end)
                        way->event = e, way->end = at;
                }
            if (way->event >= 0)
                return ENDED;
            memcpy(before, after, sizeof before);
        }
        memcpy(z, work.fresh, sizeof(double) * size);
        memcpy(STAGE(0), STAGE(STAGES), sizeof(double) * size);
        way->time = next;
    }
    return LATE;
}
