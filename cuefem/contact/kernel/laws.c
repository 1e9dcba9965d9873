/* Force-indentation laws of the tip.

   Unloading from the maximum indentation D follows the loading curve at the virtual indentation (d - d0)/e^2
   with the residual indentation d0 = (1 - e^2) D, so that a part e^2 of the work is returned. */
#include "contact.h"

/* Normal force of a loading tip, N, and its slope, N/m, at an indentation > 0, m. */
static double power_law(const Input *in, double indentation, double *slope)
{
    double power = in->exponent == 1 ? indentation : pow(indentation, in->exponent);
    double force = in->stiffness * power;
    *slope = in->exponent * force / indentation;
    return force;
}

/* Leather: the root of the indentation cubed, times a series in the root (Horner's scheme). */
static double leather_law(const Input *in, double indentation, double *slope)
{
    double root = sqrt(indentation), force = 0, derivative = 0;
    for (int i = in->terms - 1; i >= 0; i--) {
        force = force * root + in->force_terms[i];
        derivative = derivative * root + (i + 3) * in->force_terms[i];
    }
    *slope = derivative * (root / 2);
    return force * (indentation * root);
}

NormalForce loading_curve(const Input *in, double indentation)
{
    NormalForce normal = {.virtual = indentation, .scale = 1};
    if (indentation <= 0) return normal;
    normal.force = in->law == LEATHER_LAW ? leather_law(in, indentation, &normal.slope)
                                          : power_law(in, indentation, &normal.slope);
    return normal;
}

/* Residual indentation d0, m, where the unloading force vanishes; 0 during the first loading. */
double residual_indentation(const Input *in, const State *s)
{
    return (1 - in->restitution * in->restitution) * s->max_indentation;
}

/* The tip loads beyond the largest indentation so far, and unloads below it. */
NormalForce normal_force(const Input *in, const State *s, double indentation)
{
    if (s->phase == LOADING || indentation > s->max_indentation) return loading_curve(in, indentation);
    const double scale = in->restitution * in->restitution;
    NormalForce normal = loading_curve(in, (indentation - residual_indentation(in, s)) / scale);
    normal.slope /= scale;
    normal.scale = scale;
    return normal;
}

/* Tangential stiffness of a leather patch, N/m, at a virtual indentation, m. */
double tangential_stiffness(const Input *in, double virtual)
{
    double root = sqrt(larger(virtual, 0)), compliance = 0;
    for (int i = in->terms - 1; i >= 0; i--) compliance = compliance * root + in->compliance_terms[i];
    return root / compliance;
}
