/* A linear phase of a contact: what linear.c follows. */
#ifndef CUEFEM_LINEAR_H
#define CUEFEM_LINEAR_H

#include "kernel.h"

enum { TERMS = 28, MOST_GUARDS = 8 };
enum { FOUND = 0, MORE = 1, LATE = 2, NOT_FINITE = 3, REFUSED = 4 };

/* size: of the state, whose first `turning` entries turn with those from `at` on. rows: (outputs + pushed, size), what is
   read and then what pushes. pushes: (pushed, size). weights: (guards, outputs); constants: (guards,). cells_a_block: how
   many cells are followed between two looks at the time, after a first one alone. */
struct flow {
    int size, turning, at, outputs, pushed, guards, cells_a_block, terms;
    double step;
    const double *omega, *rows, *pushes, *weights, *constants;
};

/* Where a phase is: the state is beside it. start: of the block, s; cell: in the block; block: its number. At the end:
   guard, and the fraction of the last cell at which it fell. */
struct place {
    double start, fraction;
    int cell, block, guard, written;
};

EXPORTED ptrdiff_t cuefem_march_room(int size, int outputs, int pushed);
EXPORTED int cuefem_march(const struct flow *flow, double *z, struct place *place, double limit, int most,
                          double *coefficients, double *room);
int cuefem_stride(const struct flow *flow, double *z, struct place *place, double limit, int most, double *coefficients,
                  double *lengths, double *room);

#endif
