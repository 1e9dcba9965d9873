/* Force-indentation law of the tip, and the kinematics of the contact.

   Unloading from the maximum indentation D follows the loading curve at the virtual indentation (d - d0)/e^2
   with the residual indentation d0 = (1 - e^2) D, so that a part e^2 of the work is returned. */
#include "contact.h"

double unloading_scale(const Contact *c, int phase)
{
    return phase == LOADING ? 1 : c->restitution * c->restitution;
}

/* Residual indentation d0, where the unloading force vanishes. */
double residual_depth(const Contact *c) { return (1 - c->restitution * c->restitution) * c->max_depth; }

/* Normal force, its slope dF/dd and the virtual indentation; beyond D the tip loads again. */
double tip_force(const Contact *c, int phase, double depth, double *slope, double *virtual)
{
    int loads = phase == LOADING || depth > c->max_depth;
    double d = loads ? depth : (depth - residual_depth(c)) / unloading_scale(c, phase), F = 0, rise = 0;
    *virtual = d;
    if (d > 0 && c->law == POWER_LAW)
        F = c->stiffness * (c->exponent == 1 ? d : pow(d, c->exponent)), rise = c->exponent * F / d;
    else if (d > 0) {
        double y = sqrt(d);
        for (int i = c->terms - 1; i >= 0; i--)
            F = F * y + c->force_terms[i], rise = rise * y + (i + 3) * c->force_terms[i];
        F *= d * y, rise *= y / 2;
    }
    *slope = loads ? rise : rise / unloading_scale(c, phase);
    return F;
}

/* Tangential stiffness of a leather patch, N/m, at a virtual indentation. */
double tangential_stiffness(const Contact *c, double depth)
{
    double y = sqrt(larger(depth, 0)), compliance = 0;
    for (int i = c->terms - 1; i >= 0; i--) compliance = compliance * y + c->compliance_terms[i];
    return y / compliance;
}

/* C after the contact has rolled by an angle over ball and dome, with the shaft bent by slopes. Bending
   shortens the cue by the sum of weight slope^2/2 (second-order theory), so that the axial port loses weight
   slope slope'. */
void contact_kinematics(const Work *w, double angle, const double *slopes, double C[FORCES][WIDE])
{
    const Contact *c = w->c;
    const int ports = c->ports, Q = ports + c->slopes, wide = ports + c->speeds;
    for (int f = 0; f < c->forces; f++) {
        memcpy(C[f], c->kinematics + f * wide, ports * sizeof(double));
        memcpy(C[f] + Q, c->kinematics + f * wide + ports, c->speeds * sizeof(double));
    }
    if (c->rolling) {
        double at = c->phi + angle, s = sin(at), cs = cos(at), sa = sin(angle), ca = cos(angle);
        double from = fmin(c->phi, c->rim),
               to = copysign(fmin(fabs(at), c->rim), at); /* beyond the rim the edge is in contact */
        double along = c->dome * (sin(from) - sin(to)), across = c->dome * (cos(from) - cos(to));
        C[T][0] = -s, C[T][1] = -cs, C[N][0] = -cs, C[N][1] = s;
        if (ports > 2) {
            C[T][2] = -(ca * c->arm_t + sa * c->arm_n + s * along + cs * across);
            C[N][2] = -(ca * c->arm_n - sa * c->arm_t + cs * along - s * across);
        }
        C[T][Q] = ca, C[T][Q + 1] = sa, C[N][Q] = -sa, C[N][Q + 1] = ca;
    }
    for (int f = 0; f < c->forces; f++)
        for (int a = 0; a < c->slopes; a++) C[f][ports + a] = -C[f][0] * c->slope_weights[a] * slopes[a];
}
