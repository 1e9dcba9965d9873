/* Force-indentation laws of the tip.

   Unloading from the maximum indentation D follows the loading curve at the virtual indentation (d - d0)/e^2
   with the residual indentation d0 = (1 - e^2) D, so that a part e^2 of the work is returned. */
#include "contact.h"

/* Indentation per virtual indentation: e^2 during unloading. */
double unloading_scale(const Contact *c, int phase)
{
    return phase == LOADING ? 1 : c->restitution * c->restitution;
}

/* Residual indentation d0, m, where the unloading force vanishes. */
double residual(const Contact *c) { return (1 - c->restitution * c->restitution) * c->max_indentation; }

double power_law(const Contact *c, double indentation, double *slope)
{
    double power = c->exponent == 1 ? indentation : pow(indentation, c->exponent);
    double force = c->stiffness * power;
    *slope = c->exponent * force / indentation;
    return force;
}

/* Leather: the root of the indentation cubed, times a series in the root (Horner's scheme). */
double leather_law(const Contact *c, double indentation, double *slope)
{
    double root = sqrt(indentation), force = 0, derivative = 0;
    for (int i = c->terms - 1; i >= 0; i--) {
        force = force * root + c->force_terms[i];
        derivative = derivative * root + (i + 3) * c->force_terms[i];
    }
    *slope = derivative * (root / 2);
    return force * (indentation * root);
}

/* Normal force, N, its slope dF/dd, N/m, and the virtual indentation, m. Beyond D the tip loads again. */
double tip_force(const Work *w, int phase, double indentation, double *slope, double *virtual)
{
    const Contact *c = w->c;
    int on_loading_curve = phase == LOADING || indentation > c->max_indentation;
    double force = 0;
    *slope = 0;
    *virtual = indentation;
    if (!on_loading_curve) *virtual = (indentation - residual(c)) / unloading_scale(c, phase);
    if (*virtual > 0) force = w->law(c, *virtual, slope);
    if (!on_loading_curve) *slope /= unloading_scale(c, phase);
    return force;
}

/* Tangential stiffness of a leather patch, N/m, at a virtual indentation, m. */
double tangential_stiffness(const Contact *c, double virtual)
{
    double root = sqrt(larger(virtual, 0)), compliance = 0;
    for (int i = c->terms - 1; i >= 0; i--) compliance = compliance * root + c->compliance_terms[i];
    return root / compliance;
}
