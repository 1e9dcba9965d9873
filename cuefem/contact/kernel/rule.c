/* Polynomials over a step: their values, and where a guard first falls through zero. */
#include "contact.h"

EXPORTED Rule rule;
EXPORTED const size_t contact_size = sizeof(Contact);
EXPORTED const size_t rule_size = sizeof(Rule);

/* The sum of Legendre's polynomials over [0, 1] with these coefficients, at a part of the step; by (t + 1) P_(t+1) =
   (2 t + 1) x P_t - t P_(t-1). */
double legendre(const double *waves, int count, double part)
{
    static const double BY[WITH + 1] = {1, 1, 1. / 2, 1. / 3, 1. / 4, 1. / 5, 1. / 6, 1. / 7, 1. / 8,
                                        1. / 9, 1. / 10, 1. / 11, 1. / 12, 1. / 13, 1. / 14, 1. / 15};
    double x = 2 * part - 1, before = 1, here = x, sum = waves[0];
    for (int t = 1; t < count; t++) {
        sum += waves[t] * here;
        double next = ((2 * t + 1) * x * here - t * before) * BY[t + 1];
        before = here, here = next;
    }
    return sum;
}

FAST void to_waves(const double *values, double *waves)
{
    double sum[WITH] = {0};
    for (int j = 0; j < WITH; j++)
        for (int t = 0; t < WITH; t++) sum[t] += rule.waves[j][t] * values[j];
    memcpy(waves, sum, sizeof sum);
}

double value_at(const double *values, double part)
{
    double waves[WITH];
    if (part == 1) return values[Q];
    to_waves(values, waves);
    return legendre(waves, WITH, part);
}

/* The zero between a and b, where the polynomial has opposite signs: Illinois' method with bisections between. */
static double zero_of(const double *waves, double a, double b)
{
    double f_a = legendre(waves, WITH, a), f_b = legendre(waves, WITH, b);
    double best = fabs(f_a) < fabs(f_b) ? a : b, least = fmin(fabs(f_a), fabs(f_b));
    int side = 0;
    for (int i = 0; i < 90 && b - a > 4e-16 && least > 0; i++) {
        double x = i % 8 == 7 ? (a + b) / 2 : b - f_b * (b - a) / (f_b - f_a);
        if (!(x > a && x < b)) x = (a + b) / 2;
        double f = legendre(waves, WITH, x);
        if (fabs(f) < least) least = fabs(f), best = x;
        else if (i > 12 && b - a < 1e-13) break;
        if ((f > 0) == (f_a > 0)) {
            a = x, f_a = f;
            if (side == -1) f_b /= 2;
            side = -1;
        } else {
            b = x, f_b = f;
            if (side == 1) f_a /= 2;
            side = 1;
        }
    }
    return best;
}

/* Where a dip between two looks is lowest, by golden sections. */
static double lowest(const double *waves, double a, double b)
{
    static const double GOLDEN = 0.6180339887498949;
    double x = b - GOLDEN * (b - a), y = a + GOLDEN * (b - a), f = legendre(waves, WITH, x), g = legendre(waves, WITH, y);
    while (b - a > 1e-10)
        if (f < g) b = y, y = x, g = f, x = b - GOLDEN * (b - a), f = legendre(waves, WITH, x);
        else a = x, x = y, f = g, y = a + GOLDEN * (b - a), g = legendre(waves, WITH, y);
    return a;
}

/* The part of the step where the values at its start and nodes first fall through zero and below -past; 2 if nowhere. */
FAST double first_fall(const double *values, double past)
{
    double low = values[0], high = values[0], y[LOOKS] = {0}, waves[WITH];
    for (int i = 1; i < WITH; i++) low = fmin(low, values[i]), high = larger(high, values[i]);
    if (low > 0.3 * high) return 2;
    double size = larger(fabs(low), fabs(high)) + 1e-300;
    int first = 1;
    for (int j = 0; j < WITH; j++)
        for (int i = 0; i < LOOKS; i++) y[i] += rule.look[j][i] * values[j];
    while (first < LOOKS && y[first] >= -past) first++;
    to_waves(values, waves);
    for (int i = 1; i + 1 < LOOKS && i < first; i++) {
        if (!(y[i] > 0 && y[i] < y[i - 1] && (i + 1 == first || y[i] < y[i + 1]) && y[i] < 0.05 * size)) continue;
        double at = lowest(waves, rule.looks[i - 1], rule.looks[i + 1]);
        if (legendre(waves, WITH, at) < -larger(1e-13 * size, past)) return zero_of(waves, rule.looks[i - 1], at);
    }
    if (first == LOOKS) return 2;
    if (first > 1 || y[0] > 1e-9 * size) return zero_of(waves, rule.looks[first - 1], rule.looks[first]);
    double x = rule.looks[1]; /* zero at the start by its nature: it may rise before it falls */
    for (int k = 1; k < 30; k++) {
        x /= 2;
        if (legendre(waves, WITH, x) > 1e-13 * size) return zero_of(waves, x, rule.looks[1]);
    }
    return 0;
}

/* Legendre's polynomials at the Gauss points of a part of the step. */
static void polynomials_over(double part, double P[WITH][POINTS])
{
    for (int q = 0; q < POINTS; q++) P[0][q] = 1, P[1][q] = 2 * part * rule.gauss[q] - 1;
    for (int t = 1; t < Q; t++)
        for (int q = 0; q < POINTS; q++)
            P[t + 1][q] = ((2 * t + 1) * P[1][q] * P[t][q] - t * P[t - 1][q]) / (t + 1);
}

/* The work of a force over a part of a step. */
FAST double work_of(const double *force, const double *velocity, double span, double part)
{
    double of_force[WITH], of_velocity[WITH], P[WITH][POINTS], F[POINTS] = {0}, v[POINTS] = {0}, sum = 0;
    to_waves(force, of_force), to_waves(velocity, of_velocity);
    polynomials_over(part, P);
    for (int t = 0; t < WITH; t++)
        for (int q = 0; q < POINTS; q++) F[q] += of_force[t] * P[t][q], v[q] += of_velocity[t] * P[t][q];
    for (int q = 0; q < POINTS; q++) sum += rule.weights[q] * F[q] * v[q];
    return sum * span * part;
}

/* Legendre's coefficients over a part of the step of forces at its nodes. */
FAST void waves_over(const double *forces, double part, double *waves)
{
    double whole[Q] = {0}, P[WITH][POINTS], values[POINTS] = {0};
    add_product(Q, rule.force_waves[0], forces, 1, whole);
    if (part == 1) {
        memcpy(waves, whole, sizeof whole);
        return;
    }
    polynomials_over(part, P);
    for (int t = 0; t < Q; t++)
        for (int q = 0; q < POINTS; q++) values[q] += whole[t] * P[t][q];
    polynomials_over(1, P);
    for (int t = 0; t < Q; t++) {
        waves[t] = 0;
        for (int q = 0; q < POINTS; q++) waves[t] += (2 * t + 1) * P[t][q] * rule.weights[q] * values[q];
    }
}
