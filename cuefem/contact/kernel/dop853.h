/* Stepping of z' = f(z) by DOP853, as scipy.integrate does it: what dop853.c steps. */
#ifndef CUEFEM_DOP853_H
#define CUEFEM_DOP853_H

#include "kernel.h"

enum { ENDED = 0, FULL = 1, LATE = 2, STUCK = 3, REFUSED = 4 };
enum { LOOKS = 6 }; /* ends of a phase at most */

/* The tables of DOP853, rows of EXTENDED numbers in the matrices. */
struct tables {
    int stages, extended, powers;
    const double *a, *b, *e3, *e5, *d;
};

/* Where the stepping is, in units of the clock. step: the next one, or 0 at the start. event: by its number. */
struct way {
    double time, step, end;
    int written, event;
};

/* What moves. change: the rate of a state, per clock. ends: what ends the phase, values of the order of 1, which fall
   through zero; how many there are. absolute: (size,) tolerances. */
struct motion {
    int size;
    double relative, longest_step;
    const double *absolute;
    const void *of;
    void (*change)(const void *of, const double *z, double *rate);
    int (*ends)(const void *of, const double *z, double *ends);
};

/* Doubles that `dop853` works in. */
ptrdiff_t dop853_room(int size);

/* Step from the state z up to the first end, or to `until` in units of the clock. ends: whether any is looked for. times:
   (most + 1,); olds: (most, size), the states at their starts; terms: (most, POWERS, size), of their interpolants; the two
   only where ends are looked for. ENDED: way->end tells when, in the last step, whose start z is left at. FULL: call
   again. LATE: at `until`. STUCK: no step is short enough. */
int dop853(const struct motion *motion, const struct tables *tables, double until, int ends, double *z, struct way *way,
           int most, double *times, double *olds, double *terms, double *room);

/* The power law of a tip; loading, or on the way back from the deepest compression. */
struct power_law {
    double stiffness, exponent, restitution;
};

double law_rest(const struct power_law *law, double deepest);
double law_force(const struct power_law *law, int loading, double deepest, double depth);
double law_slope(const struct power_law *law, int loading, double deepest, double depth);

#endif
