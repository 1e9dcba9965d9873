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
static inline double mean_stiffness(double in, double out, double from, double to, double k_from, double k_to)
{
    if (k_from == k_to || from == to) return k_to;
    double low = fmin(from, to), high = larger(from, to), top = from > to ? k_from : k_to;
    double begins = larger(low, in), ends = larger(begins, fmin(high, out));
    return ((k_from + k_to) / 2 * (ends - begins) + top * (high - ends)) / (high - low);
}

/* The patch at a virtual indentation, m, which was `before` at the middle of the last step. */
typedef struct {
    double before, virtual, stiffness_before, stiffness; /* of the whole patch, N/m */
    double force, slope;                                 /* of the normal force, N, N/m */
} Growth;

/* One annulus in this step. */
typedef struct {
    double k_before, k_after, k; /* its stiffness, N/m: at both ends of the step, and on average */
    double normal, normal_slope; /* its normal force, N, and the slope of that by the indentation, N/m */
} Annulus;

static Growth growth_to(const Work *w, double virtual)
{
    Growth g = {.before = w->virtual_mid, .virtual = virtual};
    double unused;
    g.force = tip_force(w, LOADING, virtual, &g.slope, &unused);
    g.stiffness = tangential_stiffness(w->c, virtual);
    g.stiffness_before = tangential_stiffness(w->c, g.before);
    return g;
}

/* Annulus r, between two edges of the indentation; the last one grows on. */
static inline Annulus annulus(const Contact *c, int r, const Growth *g)
{
    const double *F = c->annulus_forces, *S = c->annulus_slopes, *K = c->annulus_stiffness;
    double in = c->annulus_edges[r], out = r + 1 < c->annuli ? c->annulus_edges[r + 1] : HUGE_VAL;
    int covered = g->virtual > out;
    double outer = covered ? F[r + 1] + S[r + 1] * (g->virtual - out) : g->force;
    Annulus a;
    a.k_after = (covered ? K[r + 1] : g->stiffness) - K[r];
    a.k_before = g->before <= in ? 0 : (g->before > out ? K[r + 1] : g->stiffness_before) - K[r];
    a.k = mean_stiffness(in, out, g->before, g->virtual, a.k_before, a.k_after);
    a.normal = outer - (F[r] + S[r] * (g->virtual - in));
    a.normal_slope = (covered ? S[r + 1] : g->slope) - S[r];
    return a;
}

/* Force of a sticking annulus, N, after a change, N, of its force by the shift; e2: square of the surface
   restitution. tangent: derivative by the shift, N/m. */
static inline double trial_force(double old, double change, double k, double e2, double *tangent)
{
    *tangent = k;
    if (e2 == 1 || old * change >= 0) return old + change;
    if (fabs(change) >= e2 * fabs(old)) return change + e2 * old;
    *tangent = k / e2;
    return old + change / e2;
}

/* Strain energy that the leather loses while |f| increases, J. */
static inline double strain_loss(double old, double f, double k, double e2)
{
    double growth = f * f - (old * f > 0 ? old * old : 0);
    return e2 < 1 && growth > 0 && k > 0 ? growth * (1 - e2) / (2 * k) : 0;
}

/* Forces of the annuli, N, at a virtual indentation, m, after a shift, m, since the middle of the last step.
   Returns their sum; by_shift, by_virtual: its derivatives by the two, N/m. */
FAST static double shift_annuli(Work *w, double virtual, double shift, double *by_shift, double *by_virtual)
{
    const Contact *c = w->c;
    const double e2 = c->surface_restitution * c->surface_restitution, mu = c->friction;
    const Growth g = growth_to(w, virtual);
    double sum = 0;
    *by_shift = 0;
    *by_virtual = 0;
    w->annuli_loss = 0;
    for (int r = 0; r < c->annuli; r++) {
        if (virtual <= c->annulus_edges[r]) {
            w->annulus_force_now[r] = 0;
            continue;
        }
        Annulus a = annulus(c, r, &g);
        double old = w->annulus_force[r] * (a.k_before > a.k_after ? a.k_after / a.k_before : 1);
        double tangent, f = trial_force(old, a.k * shift, a.k, e2, &tangent), bound = mu * larger(a.normal, 0);
        if (fabs(f) < bound) {
            *by_shift += tangent;
        } else {
            f = copysign(bound, f);
            *by_virtual += copysign(mu * a.normal_slope, f);
        }
        w->annuli_loss += strain_loss(old, f, a.k, e2);
        w->annulus_force_now[r] = f;
        sum += f;
    }
    return sum;
}

static void stick(Work *w, const double *u, Equations *e)
{
    const double half = w->t.h / 2;
    double by_shift, by_virtual, shift = w->shift - half * u[T];
    e->g[T] = w->F[T] - shift_annuli(w, w->virtual_now, shift - w->shift_mid, &by_shift, &by_virtual);
    if (w->virtual_now < w->c->max_indentation) by_virtual /= unloading_scale(w->c, w->phase);
    e->J[T][T] = 1 + half * (by_shift * w->W[T][T] + by_virtual * w->W[N][T]);
    e->J[T][N] = half * (by_shift * w->W[T][N] + by_virtual * w->W[N][N]);
}

static void keep(Work *w, double middle)
{
    (void)middle;
    memcpy(w->annulus_force, w->annulus_force_now, sizeof w->annulus_force);
    w->c->shear_loss += w->annuli_loss;
}

static void release(Work *w, double shift) { (void)w, (void)shift; }

static int friction_state(const Work *w)
{
    const Contact *c = w->c;
    if (fabs(w->F[T]) < c->friction * w->F[N] * (1 - 1e-6)) return STICK;
    if (w->F[T] == 0) return c->friction_state;
    return w->F[T] > 0 ? SLIP : SLIP_BACK;
}

const Patch partial_slip = {1, stick, keep, release, friction_state};
