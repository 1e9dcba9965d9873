/* A patch that slips ring by ring: what rings.c knows of it. */
#ifndef CUEFEM_RINGS_H
#define CUEFEM_RINGS_H

#include "kernel.h"

enum { MOST_RINGS = 256 };

/* `RingForces`: edges, and at each the force, the stiffness and the slope of the law, (count + 1,) each. */
struct rings {
    int count;
    double friction, first_gain;
    const double *edges, *force_to, *stiffness_to, *slope_to;
};

/* The rings at one virtual compression: stiffness along the surface and normal force of each. */
struct ringed {
    double stiffness[MOST_RINGS], force[MOST_RINGS];
};

/* force and stiffness: of the law there. */
void rings_at(const struct rings *rings, double depth, double force, double stiffness, struct ringed *found);

/* What the rings hold goes on from one place to another, between which the surfaces shift; the sum of it. */
double rings_hold(const struct rings *rings, const struct ringed *before, const struct ringed *after, double shift,
                  double *held);

/* What they hold where all of them slide; the sum of it. */
double rings_slide(const struct rings *rings, const struct ringed *at, int side, double *held);

#endif
