/* The force along the normal: the tip's curve, and the way back along it (laws.c). */
#include "contact.h"

/* Force and slope at a virtual compression, and the stiffness along the surface where it is asked for. */
void curve_at(const Contact *c, double depth, double *F, double *slope, double *k)
{
    if (c->curve == POWER_CURVE) {
        if (c->exponent == 1) {
            *F = c->stiffness * depth, *slope = c->stiffness;
            return;
        }
        double size = fabs(depth) + 1e-300, power = pow(size, c->exponent - 1);
        *F = copysign(c->stiffness * power * size, depth), *slope = c->stiffness * c->exponent * power;
        return;
    }
    /* F = y^3 (f_0 + f_1 y + ...), y/k = g_0 + g_1 y + ..., y the root of the compression */
    double y = sqrt(larger(depth, 0)), f = 0, df = 0, g = 0;
    for (int i = c->terms - 1; i >= 0; i--) {
        f = f * y + c->force_terms[i], df = df * y + (i + 3) * c->force_terms[i];
        g = g * y + c->give_terms[i];
    }
    *F = y * y * y * f, *slope = y * df / 2;
    if (k) *k = y / g;
}

/* By how much less the compression changes than the virtual one. */
double give_of(const Contact *c, int press)
{
    return press == LOAD ? 1 : c->restitution * c->restitution;
}

double virtual_depth(const Contact *c, int press, double depth)
{
    double e2 = c->restitution * c->restitution;
    return press == LOAD ? depth : (depth - (1 - e2) * c->deepest) / e2;
}

/* The compression at which a tip that was pressed to the deepest point has lost its force. */
double rest_of(const Contact *c)
{
    return (1 - c->restitution * c->restitution) * c->deepest;
}

/* The tip's force at a compression. */
double pressing(const Contact *c, int press, double depth)
{
    double F, slope;
    curve_at(c, virtual_depth(c, press, depth), &F, &slope, NULL);
    return F;
}
