/* Force-indentation laws of the tip.

   Unloading from the maximum indentation D follows the loading curve at the virtual indentation (d - d0)/e^2
   with the residual indentation d0 = (1 - e^2) D, so that a part e^2 of the work is returned. */
#include "contact.h"

double power_law(const Input *in, double indentation, double *slope)
{
    double power = in->exponent == 1 ? indentation : pow(indentation, in->exponent);
    double force = in->stiffness * power;
    *slope = in->exponent * force / indentation;
    return force;
}

/* Leather: the root of the indentation cubed, times a series in the root (Horner's scheme). */
double leather_law(const Input *in, double indentation, double *slope)
{
    double root = sqrt(indentation), force = 0, derivative = 0;
    for (int i = in->terms - 1; i >= 0; i--) {
        force = force * root + in->force_terms[i];
        derivative = derivative * root + (i + 3) * in->force_terms[i];
    }
    *slope = derivative * (root / 2);
    return force * (indentation * root);
}

NormalForce loading_curve(const Contact *c, double indentation)
{
    NormalForce normal = {.virtual = indentation, .scale = 1};
    if (indentation > 0) normal.force = c->law(c->in, indentation, &normal.slope);
    return normal;
}

/* Beyond D the tip loads again. */
NormalForce unloading_curve(const Contact *c, double indentation)
{
    if (indentation > c->s->max_indentation) return loading_curve(c, indentation);
    const double scale = c->in->restitution * c->in->restitution;
    NormalForce normal = loading_curve(c, (indentation - residual_indentation(c)) / scale);
    normal.slope /= scale;
    normal.scale = scale;
    return normal;
}

/* Residual indentation d0, m, where the unloading force vanishes. */
double residual_indentation(const Contact *c)
{
    return (1 - c->in->restitution * c->in->restitution) * c->s->max_indentation;
}

/* Tangential stiffness of a leather patch, N/m, at a virtual indentation, m. */
double tangential_stiffness(const Input *in, double virtual)
{
    double root = sqrt(larger(virtual, 0)), compliance = 0;
    for (int i = in->terms - 1; i >= 0; i--) compliance = compliance * root + in->compliance_terms[i];
    return root / compliance;
}
