/* Force-indentation law of the tip, and the kinematics of the contact.

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

/* Normal force, N, its slope dF/dd, N/m, and the virtual indentation, m. Beyond D the tip loads again. */
double tip_force(const Contact *c, int phase, double indentation, double *slope, double *virtual)
{
    int on_loading_curve = phase == LOADING || indentation > c->max_indentation;
    double d = on_loading_curve ? indentation : (indentation - residual(c)) / unloading_scale(c, phase),
           F = 0, dF = 0;
    *virtual = d;
    if (d > 0 && c->law == POWER_LAW)
        F = c->stiffness * (c->exponent == 1 ? d : pow(d, c->exponent)), dF = c->exponent * F / d;
    else if (d > 0) {
        double y = sqrt(d);
        for (int i = c->terms - 1; i >= 0; i--)
            F = F * y + c->force_terms[i], dF = dF * y + (i + 3) * c->force_terms[i];
        F *= d * y, dF *= y / 2;
    }
    *slope = on_loading_curve ? dF : dF / unloading_scale(c, phase);
    return F;
}

/* Tangential stiffness of a leather patch, N/m, at a virtual indentation, m. */
double tangential_stiffness(const Contact *c, double virtual)
{
    double y = sqrt(larger(virtual, 0)), compliance = 0;
    for (int i = c->terms - 1; i >= 0; i--) compliance = compliance * y + c->compliance_terms[i];
    return y / compliance;
}

/* C after the contact has rolled by an angle, rad, over ball and dome, on a shaft bent by slopes. Bending
   shortens the cue by the sum of weight slope^2/2 (second-order theory), so that the tip's axial velocity is
   reduced by the sum of weight slope slope'. */
void contact_kinematics(const Work *w, double angle, const double *slopes, double C[FORCES][VELOCITIES])
{
    const Contact *c = w->c;
    const int ports = c->ports, n_cue = ports + c->slopes, n_velocities = ports + c->speeds;
    for (int f = 0; f < c->forces; f++) {
        memcpy(C[f], c->kinematics + f * n_velocities, ports * sizeof(double));
        memcpy(C[f] + n_cue, c->kinematics + f * n_velocities + ports, c->speeds * sizeof(double));
    }
    if (c->rolling) {
        double at = c->phi + angle, s = sin(at), cs = cos(at), sa = sin(angle), ca = cos(angle);
        /* angle of the dome at the contact, at the first touch and now; beyond the rim that of its edge */
        double first = fmin(c->phi, c->rim), now = copysign(fmin(fabs(at), c->rim), at);
        /* change of the contact's displacement (u, w) per unit rotation of the end section, m */
        double du = c->dome * (sin(first) - sin(now)), dw = c->dome * (cos(first) - cos(now));
        C[T][0] = -s, C[T][1] = -cs, C[N][0] = -cs, C[N][1] = s;
        if (ports > 2) {
            C[T][2] = -(ca * c->arm_t + sa * c->arm_n + s * du + cs * dw);
            C[N][2] = -(ca * c->arm_n - sa * c->arm_t + cs * du - s * dw);
        }
        C[T][n_cue] = ca, C[T][n_cue + 1] = sa, C[N][n_cue] = -sa, C[N][n_cue + 1] = ca;
    }
    for (int f = 0; f < c->forces; f++)
        for (int a = 0; a < c->slopes; a++) C[f][ports + a] = -C[f][0] * c->slope_weights[a] * slopes[a];
}
