/* Zeros of a function of one number: the same steps as `zero` and `first_fall` of cuefem.contact.flow. */
#include "kernel.h"

/* A bisection of any interval of doubles ends long before; only a function that is not a number goes on. */
enum { MOST_STEPS = 5000 };

double zero_of(function f, const void *of, double low, double high)
{
    double a = low, b = high, at_a = f(of, a), at_b = f(of, b), part = 0.5;
    if (at_a == 0 || at_b == 0)
        return at_a == 0 ? a : b;
    for (int step = 0; step < MOST_STEPS; step++) {
        double x = a + part * (b - a), at_x = f(of, x);
        double c = a, at_c = at_a; /* the place before, at the far side of x or behind it */
        if ((at_x > 0) != (at_a > 0)) {
            c = b, at_c = at_b;
            b = a, at_b = at_a;
        }
        a = x, at_a = at_x;
        double best = fabs(at_a) < fabs(at_b) ? a : b;
        if (at_a == 0 || a == b)
            return best;
        double least = (1e-15 + 2e-15 * fabs(best)) / fabs(b - a);
        if (least > 0.5)
            return best;
        double xi = (a - b) / (c - b), phi = (at_a - at_b) / (at_c - at_b);
        part = 0.5;
        if (phi * phi < xi && (1 - phi) * (1 - phi) < 1 - xi) {
            part = at_a / (at_b - at_a) * at_c / (at_b - at_c);
            part += (c - a) / (b - a) * at_a / (at_c - at_a) * at_b / (at_c - at_b);
        }
        part = fmin(1 - least, fmax(least, part));
    }
    return a;
}

double first_fall(function falling, const void *of, double low, double high)
{
    if (falling(of, low) > 0)
        return zero_of(falling, of, low, high);
    /* zero at the start of a phase by its nature: it may still rise before it falls */
    double place = high;
    for (int k = 1; k < 40; k++) {
        place *= 0.5;
        if (falling(of, place) > 0)
            return zero_of(falling, of, place, high);
    }
    return low;
}
