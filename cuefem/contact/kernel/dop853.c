/* Stepping by DOP853 (Hairer, Norsett and Wanner) as scipy.integrate does it, step by step, with scipy's tables: the same
   steps but for rounding. And the tip's power law (cuefem.effects.law), which all that is stepped so presses. */
#include "dop853.h"

#include <string.h>

enum { STAGES = 12, EXTENDED = 16, POWERS = 7 };
static const double SAFETY = 0.9, LEAST = 0.2, MOST = 10, ORDER = 8;

/* What the steps work in. */
struct work {
    double *trial, *fresh, *stages;
};

static double size_of(const struct motion *s, const double *values, const double *scale)
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
static void onward(const struct motion *s, const struct work *work, const double *z, const double *weights, int count,
                   double step, double *found)
{
    weighted(work->stages, weights, count, s->size, step, found);
    for (int i = 0; i < s->size; i++)
        found[i] += z[i];
}

/* `select_initial_step` of scipy; the rate at z is the first stage. */
static double first_step(const struct motion *s, const struct work *work, const double *z,
                         double span)
{
    double *scale = work->fresh, *rate = work->stages, *other = work->stages + s->size;
    for (int i = 0; i < s->size; i++)
        scale[i] = s->absolute[i] + fabs(z[i]) * s->relative;
    double size = size_of(s, z, scale), grows = size_of(s, rate, scale);
    double step = fmin(size < 1e-5 || grows < 1e-5 ? 1e-6 : 0.01 * size / grows, span);
    for (int i = 0; i < s->size; i++)
        work->trial[i] = z[i] + step * rate[i];
    s->change(s->of, work->trial, other);
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
static double error_of(const struct motion *s, const struct tables *tables, const struct work *work, const double *z,
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
    const struct motion *motion;
    const double *z, *terms;
    double *state;
    int end;
};

static double end_at(const void *of, double part)
{
    const struct course *course = of;
    const struct motion *s = course->motion;
    double ends[LOOKS];
    for (int i = 0; i < s->size; i++) {
        double value = 0;
        for (int k = POWERS - 1; k >= 0; k--)
            value = (value + course->terms[(size_t)k * s->size + i]) * ((POWERS - 1 - k) % 2 ? 1 - part : part);
        course->state[i] = value + course->z[i];
    }
    s->ends(s->of, course->state, ends);
    return ends[course->end];
}

ptrdiff_t dop853_room(int size)
{
    return (ptrdiff_t)size * (2 + EXTENDED);
}

int dop853(const struct motion *s, const struct tables *tables, double until, int ends, double *z, struct way *way, int most,
           double *times, double *olds, double *terms, double *room)
{
    if (tables->stages != STAGES || tables->extended != EXTENDED || tables->powers != POWERS)
        return REFUSED;
    int size = s->size, count = 0;
    struct work work = {.trial = room, .fresh = room + size, .stages = room + 2 * size};
#define STAGE(k) (work.stages + (size_t)(k) * size)
    double before[LOOKS], after[LOOKS];
    s->change(s->of, z, STAGE(0));
    if (way->step == 0)
        way->step = first_step(s, &work, z, until - way->time);
    if (ends)
        count = s->ends(s->of, z, before);
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
                s->change(s->of, work.trial, STAGE(k));
            }
            onward(s, &work, z, tables->b, STAGES, step, work.fresh);
            s->change(s->of, work.fresh, STAGE(STAGES));
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
                s->change(s->of, work.trial, STAGE(k));
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
            s->ends(s->of, work.fresh, after);
            way->event = -1;
            for (int e = 0; e < count; e++)
                if (before[e] >= 0 && after[e] <= 0) {
                    struct course course = {s, old, own, work.trial, e};
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

static double squared(const struct power_law *law)
{
    return law->restitution * law->restitution;
}

double law_rest(const struct power_law *law, double deepest)
{
    return (1 - squared(law)) * deepest;
}

static double virtual_of(const struct power_law *law, int loading, double deepest, double depth)
{
    return loading ? depth : (depth - law_rest(law, deepest)) / squared(law);
}

double law_force(const struct power_law *law, int loading, double deepest, double depth)
{
    double x = virtual_of(law, loading, deepest, depth);
    return law->stiffness * copysign(pow(fabs(x), law->exponent), x);
}

double law_slope(const struct power_law *law, int loading, double deepest, double depth)
{
    double x = virtual_of(law, loading, deepest, depth);
    return law->stiffness * law->exponent * pow(fabs(x), law->exponent - 1) / (loading ? 1 : squared(law));
}
