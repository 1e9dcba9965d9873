/* Partial slip of a leather patch, annulus by annulus (Cattaneo; Mindlin and Deresiewicz; Jaeger's
   superposition).

   While the indentation grows from x to x + dx and the surfaces shift by d(delta), the tractions of a
   sticking punch of that size are superposed. The tangential force is the sum over annuli, each strained by
   the shift since its first contact; the normal force is a sum over the same annuli. An annulus between two
   edges of the indentation has the stiffness k and the normal force N of the law between them. Its force f is
   a return mapping onto |f| <= mu N:

       f -> clip(f min(k after/k before, 1) + k d(delta), +-mu N).

   Leather that dissipates tangential strain energy has the slope k/e^2 while |f| decreases, with the surface
   restitution e: of the work f d(delta) it stores the part e^2, in all f^2 e^2/2k. */
#include "contact.h"

/* Mean stiffness, N/m, of the annulus between the edges `in` and `out` over the indentations of a step: it
   grows between the edges and is constant beyond. The mean of the step's ends is inaccurate if the step
   crosses many annuli, as the first one does. */
static double mean_stiffness(double in, double out, double from, double to, double k_from, double k_to)
{
    if (k_from == k_to || from == to) return k_to;
    double low = fmin(from, to), high = larger(from, to), top = from > to ? k_from : k_to;
    double begins = larger(low, in), ends = larger(begins, fmin(high, out));
    return ((k_from + k_to) / 2 * (ends - begins) + top * (high - ends)) / (high - low);
}

/* Forces of the annuli, N, at a virtual indentation, m, after a shift, m, since the middle of the last step.
   Returns their sum; by_shift, by_virtual: its derivatives by the two, N/m. */
FAST double shift_annuli(Work *w, double virtual, double shift, double *by_shift, double *by_virtual)
{
    const Contact *c = w->c;
    const double *edge = c->annulus_edges, *F = c->annulus_forces, *S = c->annulus_slopes,
                 *K = c->annulus_stiffness, *last = w->annulus_force;
    double *force_now = w->annulus_force_now, e2 = c->surface_restitution * c->surface_restitution,
           mu = c->friction, before = w->virtual_mid;
    double unused, slope, force = tip_force(c, LOADING, virtual, &slope, &unused), sum = 0, loss = 0;
    double K_now = tangential_stiffness(c, virtual), K_before = tangential_stiffness(c, before);
    *by_shift = *by_virtual = 0;
    for (int r = 0; r < c->annuli; r++) {
        double in = edge[r], out = r + 1 < c->annuli ? edge[r + 1] : HUGE_VAL; /* the last annulus grows on */
        if (virtual <= in) {
            force_now[r] = 0;
            continue;
        }
        int covered = virtual > out;
        double k_after = (covered ? K[r + 1] : K_now) - K[r], inner = F[r] + S[r] * (virtual - in);
        double k_before = before <= in ? 0 : (before > out ? K[r + 1] : K_before) - K[r];
        double normal = (covered ? F[r + 1] + S[r + 1] * (virtual - out) : force) - inner,
               k = mean_stiffness(in, out, before, virtual, k_before, k_after);
        double bound = mu * larger(normal, 0), old = last[r] * (k_before > k_after ? k_after / k_before : 1);
        double change = k * shift, tangent = k, f = old + change;
        if (e2 < 1 && old * change < 0) {
            int keeps_sign = fabs(change) < e2 * fabs(old);
            f = keeps_sign ? old + change / e2 : change + e2 * old, tangent = keeps_sign ? k / e2 : k;
        }
        if (fabs(f) < bound)
            *by_shift += tangent;
        else
            f = copysign(bound, f), *by_virtual += copysign(mu * ((covered ? S[r + 1] : slope) - S[r]), f);
        double growth = f * f - (old * f > 0 ? old * old : 0); /* of f^2 while |f| increases */
        if (e2 < 1 && growth > 0 && k > 0) loss += growth * (1 - e2) / (2 * k);
        force_now[r] = f, sum += f;
    }
    w->annuli_loss = loss;
    return sum;
}
