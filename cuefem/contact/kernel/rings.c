/* The forces of a tip of leather whose patch slips ring by ring (cuefem.contact.ringed_patch). */
#include "rings.h"

FAST void rings_at(const struct rings *rings, double depth, double force, double stiffness, struct ringed *found)
{
    double k_before = 0, N_before = 0;
    for (int r = 0; r <= rings->count; r++) {
        int inside = rings->edges[r] < depth;
        double k = inside ? rings->stiffness_to[r] : stiffness;
        double N = inside ? rings->slope_to[r] * (depth - rings->edges[r]) + rings->force_to[r] : force;
        if (r)
            found->stiffness[r - 1] = k - k_before, found->force[r - 1] = N - N_before;
        k_before = k, N_before = N;
    }
}

FAST double rings_hold(const struct rings *rings, const struct ringed *before, const struct ringed *after, double shift,
                       double *held)
{
    double total = 0;
    for (int r = 0; r < rings->count; r++) {
        double old = before->stiffness[r], now = after->stiffness[r], left = old > 0 ? now / old : 1;
        double bound = rings->friction < HUGE_VAL ? rings->friction * after->force[r] : HUGE_VAL;
        double found = held[r] * (left < 1 ? left : 1) + (now + old) / 2 * shift;
        found = found < -bound ? -bound : found; /* in the order of numpy's clip */
        held[r] = found > bound ? bound : found;
        total += held[r];
    }
    return total;
}

double rings_slide(const struct rings *rings, const struct ringed *at, int side, double *held)
{
    double total = 0;
    for (int r = 0; r < rings->count; r++)
        total += held[r] = side * rings->friction * at->force[r];
    return total;
}
