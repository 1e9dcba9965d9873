/* Partial slip of a leather patch, annulus by annulus (Cattaneo; Mindlin and Deresiewicz; Jaeger's
   superposition).

   While the indentation grows from x to x + dx and the surfaces shift by d(delta), the tractions of a
   sticking punch of that size are superposed. The tangential force is the sum over annuli, each strained by
   the shift since it first touched; the normal force is a sum over the same annuli. An annulus between two
   edges of the indentation has the stiffness k and the normal force N of the law between them. Its force f is
   a return mapping onto |f| <= mu N:

       f -> clip(f min(k after/k before, 1) + k d(delta), +-mu N).

   Leather that dissipates energy along its surface has the slope k/e^2 while |f| decreases, e the surface
   restitution: of the work f d(delta) it stores e^2, in all f^2 e^2/2k. */
#include "contact.h"

/* Mean stiffness of an annulus over the indentations of a step: it grows from one edge of the annulus to the
   other and is constant beyond. The mean of both ends fails where a step crosses many annuli, as the first
   one does. */
static double mean_stiffness(double in, double out, double from, double to, double k_from, double k_to)
{
    if (k_from == k_to || from == to) return k_to;
    double low = fmin(from, to), high = larger(from, to), top = from > to ? k_from : k_to;
    double begins = larger(low, in), ends = larger(begins, fmin(high, out));
    return ((k_from + k_to) / 2 * (ends - begins) + top * (high - ends)) / (high - low);
}

/* Update the annuli from the middle of the last step to a virtual indentation, after a shift. Returns their
   force; stuck and slid: its derivatives by the shift and by the virtual indentation. */
FAST double shift_annuli(Work *w, double depth, double shift, double *stuck, double *slid)
{
    const Contact *c = w->c;
    const double *edge = c->annulus_edges, *F = c->annulus_forces, *S = c->annulus_slopes,
                 *K = c->annulus_stiffness, *was = w->annulus_force;
    double *now = w->annulus_force_now, e2 = c->surface_restitution * c->surface_restitution,
           mu = c->friction, before = w->virtual_mid;
    double unused, rise, force = tip_force(c, LOADING, depth, &rise, &unused), sum = 0, holds = 0, slides = 0,
                         lost = 0;
    double K_now = tangential_stiffness(c, depth), K_before = tangential_stiffness(c, before);
    for (int r = 0; r < c->annuli; r++) {
        double in = edge[r],
               out = r + 1 < c->annuli ? edge[r + 1] : HUGE_VAL; /* the last annulus holds all beyond */
        if (depth <= in) {
            now[r] = 0;
            continue;
        }
        int whole = depth > out;
        double k_after = (whole ? K[r + 1] : K_now) - K[r], inner = F[r] + S[r] * (depth - in);
        double k_before = before <= in ? 0 : (before > out ? K[r + 1] : K_before) - K[r];
        double normal = (whole ? F[r + 1] + S[r + 1] * (depth - out) : force) - inner,
               k = mean_stiffness(in, out, before, depth, k_before, k_after);
        double bound = mu * larger(normal, 0), old = was[r] * (k_before > k_after ? k_after / k_before : 1);
        double by = k * shift, steep = k, f = old + by;
        if (e2 < 1 && old * by < 0) {
            int falls = fabs(by) < e2 * fabs(old);
            f = falls ? old + by / e2 : by + e2 * old, steep = falls ? k / e2 : k;
        }
        if (fabs(f) < bound)
            holds += steep;
        else
            f = copysign(bound, f), slides += copysign(mu * ((whole ? S[r + 1] : rise) - S[r]), f);
        double grown = f * f - (old * f > 0 ? old * old : 0);
        if (e2 < 1 && grown > 0 && k > 0) lost += grown * (1 - e2) / (2 * k);
        now[r] = f, sum += f;
    }
    w->lost = lost, *stuck = holds, *slid = slides;
    return sum;
}
