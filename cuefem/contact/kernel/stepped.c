/* A contact with a power law or a turning normal (cuefem.contact.stepped): the equations of cuefem.contact.nonlinear. Only
   a tip that gives something back, on domes and on a patch that is rigid or on a spring; Python steps anything else. */
#include "dop853.h"

#include <string.h>

/* Where the parts of a state stand, and the numbers of `Stepped`. shear: -1 on a rigid patch. turns: whether the normal
   does; levers: (u, w) of the first touch, m. amplitude: along and across the cue; absolute: tolerances. */
struct stepped {
    int size, turning, at, first, modes, ball_t, ball_n, spin, depth, angle, rubbed, damped, gone, shear, dampers, lossy;
    int turns;
    double phi, root_mass, friction, clock, dome, reach, lever_u, lever_w, compliance;
    double unit, speed, force, rounding, relative, longest_step;
    struct power_law law;
    const double *omega, *c_t, *c_n, *damping, *along, *across, *rotation, *absolute;
};

/* side: 1 or -1 of a slip, 0 in stick. deepest: at the last peak, m; near: by which a touch overlaps, m. */
struct hold {
    int apart, side, loading;
    double deepest, near;
};

/* v_t and v_n, the forces, N, and (V_D - V_C) . t. */
struct seen {
    double v_t, v_n, F_t, F_n, passing;
};

/* A phase of it, and what is worked in. */
struct work {
    const struct stepped *stepped;
    const struct hold *hold;
    double *rows_t, *rows_n, *free;
};

INLINE double dot(const double *one, const double *other, int count)
{
    double total = 0;
    for (int i = 0; i < count; i++)
        total += one[i] * other[i];
    return total;
}

/* The rows where the contact has turned to. */
static void turn(const struct work *work, const double *z)
{
    const struct stepped *s = work->stepped;
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
FAST static struct seen look(const struct work *work, const double *z)
{
    const struct stepped *s = work->stepped;
    const struct hold *hold = work->hold;
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
        turn(work, z);
    const double *c_t = work->rows_t, *c_n = work->rows_n;
    struct seen seen = {.v_t = dot(c_t, z, size), .v_n = dot(c_n, z, size)};
    if (s->turns)
        seen.passing = c_t[s->spin] * z[s->spin] - seen.v_t + s->dome * dot(s->rotation, z + s->first, s->modes);
    if (hold->apart)
        return seen;
    seen.F_n = law_force(&s->law, hold->loading, hold->deepest, z[s->depth]);
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
FAST static void change(const void *of, const double *z, double *restrict rate)
{
    const struct work *work = of;
    const struct stepped *s = work->stepped;
    const struct hold *hold = work->hold;
    struct seen seen = look(work, z);
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
static int ends_of(const void *of, const double *z, double *ends)
{
    const struct work *work = of;
    const struct stepped *s = work->stepped;
    const struct hold *hold = work->hold;
    struct seen seen = look(work, z);
    double depth = s->speed * s->clock;
    int count = 0;
    if (hold->apart) {
        ends[count++] = (law_rest(&s->law, hold->deepest) - z[s->depth] + hold->near) / depth;
        return count;
    }
    if (hold->loading)
        ends[count++] = -seen.v_n / s->speed;
    else {
        ends[count++] = (z[s->depth] - law_rest(&s->law, hold->deepest)) / depth;
        ends[count++] = (hold->deepest - z[s->depth]) / depth;
    }
    if (hold->side) {
        double rise = s->shear < 0 ? 0 : -law_slope(&s->law, hold->loading, hold->deepest, z[s->depth]) * seen.v_n;
        ends[count++] = -hold->side * (seen.v_t + s->compliance * hold->side * s->friction * rise) / s->speed;
    } else if (s->friction < HUGE_VAL)
        for (int way = 1; way >= -1; way -= 2)
            ends[count++] = (s->friction * seen.F_n - way * seen.F_t) / s->force + s->rounding;
    return count;
}

/* Doubles that `cuefem_stepped` works in. */
EXPORTED ptrdiff_t cuefem_stepped_room(int size)
{
    return 3 * (ptrdiff_t)size + dop853_room(size);
}

/* Step through a phase: see `dop853`. */
EXPORTED int cuefem_stepped(const struct stepped *s, const struct hold *hold, const struct tables *tables, double until,
                            int ends, double *z, struct way *way, int most, double *times, double *olds, double *terms,
                            double *room)
{
    int size = s->size;
    struct work work = {s, hold, room, room + size, room + 2 * (size_t)size};
    struct motion motion = {size, s->relative, s->longest_step, s->absolute, &work, change, ends_of};
    memcpy(work.rows_t, s->c_t, sizeof(double) * size);
    memcpy(work.rows_n, s->c_n, sizeof(double) * size);
    return dop853(&motion, tables, until, ends, z, way, most, times, olds, terms, room + 3 * (size_t)size);
}
