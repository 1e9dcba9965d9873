/* Partial slip of a leather patch, annulus by annulus (Cattaneo; Mindlin and Deresiewicz; Jaeger's
   superposition).

   While the indentation grows from x to x + dx and the surfaces shift by d(delta), the tractions of a
   sticking punch of that size are superposed. The tangential force is the sum over annuli, each strained by
   the shift since its first contact; the normal force is a sum over the same annuli. An annulus between two
   edges of the indentation has the stiffness k and the normal force N of the law between them. Its force f is
   a return mapping onto |f| <= mu N:

       f -> clip(f min(k after/k before, 1) + k d(delta), +-mu N),

   k being its mean over the step while it grows, and k after while it shrinks.
   Leather that dissipates tangential strain energy has the slope k/e^2 while |f| decreases, with the surface
   restitution e: of the work f d(delta) it stores the part e^2, in all f^2 e^2/2k. */
#include "contact.h"

/* Stiffness, N/m, with which the annulus between the edges `inner` and `outer` answers the shift of a step.
   What has left contact bears no force of its strain in this step either: an annulus that shrinks has the
   stiffness of the step's end, so that its force vanishes with it. One that grows has its mean over the
   indentations of the step: it grows between the edges and is constant beyond. The mean of the step's ends is
   inaccurate if the step crosses many annuli, as the first one does. */
static inline double step_stiffness(double inner, double outer, double from, double to, double k_from,
                                    double k_to)
{
    if (k_from == k_to || from >= to) return k_to;
    double begins = larger(from, inner), ends = larger(begins, fmin(to, outer));
    return ((k_from + k_to) / 2 * (ends - begins) + k_to * (to - ends)) / (to - from);
}

/* One annulus in this step. */
typedef struct {
    double k_before, k_after, k; /* its stiffness, N/m: at both ends of the step, and for its shift */
    double normal, normal_slope; /* its normal force, N, and the slope of that by the indentation, N/m */
} Annulus;

static Edge edge_at(const Input *in, double virtual)
{
    NormalForce normal = loading_curve(in, virtual);
    return (Edge){.indentation = virtual,
                  .force = normal.force,
                  .slope = normal.slope,
                  .stiffness = tangential_stiffness(in, virtual)};
}

/* Edges evenly spaced in the root of the indentation; the last annulus has what lies beyond its edge, too. */
void find_edges(const Input *in, Edge edges[ANNULI + 1])
{
    for (int r = 0; r < ANNULI; r++) {
        double root = (double)r / ANNULI;
        edges[r] = edge_at(in, in->annuli_end * root * root);
    }
    edges[ANNULI].indentation = HUGE_VAL;
}

/* The annulus between two edges, in a step from one indentation to another. */
static inline Annulus annulus(const Edge *inner, const Edge *outer, const Edge *from, const Edge *to)
{
    const Edge *end_before = from->indentation > outer->indentation ? outer : from;
    const Edge *end = to->indentation > outer->indentation ? outer : to;
    double beyond_inner = to->indentation - inner->indentation;
    double beyond_end = to->indentation - end->indentation;
    Annulus a;
    a.k_before = from->indentation > inner->indentation ? end_before->stiffness - inner->stiffness : 0;
    a.k_after = end->stiffness - inner->stiffness;
    a.k = step_stiffness(inner->indentation, outer->indentation, from->indentation, to->indentation,
                         a.k_before, a.k_after);
    a.normal = end->force + end->slope * beyond_end - (inner->force + inner->slope * beyond_inner);
    a.normal_slope = end->slope - inner->slope;
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
    return growth > 0 && k > 0 ? growth * (1 - e2) / (2 * k) : 0;
}

/* Forces of the annuli, N, at the virtual indentation of the step, m, after a shift, m, since the middle of
   the last step. Returns their sum; by_shift, by_virtual: its derivatives by the two, N/m. */
FAST static double shift_annuli(const Input *in, const State *s, Work *w, double shift, double *by_shift,
                                double *by_virtual)
{
    const double virtual = w->normal.virtual, e2 = in->surface_restitution * in->surface_restitution,
                 mu = in->friction;
    const Edge from = edge_at(in, s->virtual_mid), to = edge_at(in, virtual);
    double sum = 0;
    *by_shift = 0;
    *by_virtual = 0;
    w->annuli_loss = 0;
    for (int r = 0; r < ANNULI; r++) {
        if (virtual <= w->edges[r].indentation) {
            w->annulus_force[r] = 0;
            continue;
        }
        Annulus a = annulus(&w->edges[r], &w->edges[r + 1], &from, &to);
        double old = s->annulus_force[r] * (a.k_before > a.k_after ? a.k_after / a.k_before : 1);
        double bound = mu * larger(a.normal, 0);
        double tangent;
        double f = trial_force(old, a.k * shift, a.k, e2, &tangent);
        if (fabs(f) < bound) {
            *by_shift += tangent;
        } else {
            f = copysign(bound, f);
            *by_virtual += copysign(mu * a.normal_slope, f);
        }
        w->annuli_loss += strain_loss(old, f, a.k, e2);
        w->annulus_force[r] = f;
        sum += f;
    }
    return sum;
}

static void stick(const Input *in, double h, const State *s, Work *w, Equations *e)
{
    const double half = h / 2;
    double by_shift, by_virtual;
    double shift = s->shift - half * w->u[T];
    e->g[T] = w->F[T] - shift_annuli(in, s, w, shift - s->shift_mid, &by_shift, &by_virtual);
    by_virtual /= w->normal.scale;
    e->J[T][T] = 1 + half * (by_shift * w->W[T][T] + by_virtual * w->W[N][T]);
    e->J[T][N] = half * (by_shift * w->W[T][N] + by_virtual * w->W[N][N]);
}

static void update(const Input *in, State *s, const Work *w)
{
    memcpy(s->annulus_force, w->annulus_force, sizeof s->annulus_force);
    s->shear_loss += w->annuli_loss;
    s->virtual_mid = w->normal.virtual;
}

static void release(const Input *in, State *s, const Work *w) { s->virtual_mid = 0; }

static int friction_state(const Input *in, const State *s, const Work *w)
{
    if (fabs(w->F[T]) < in->friction * w->F[N] * (1 - 1e-6)) return STICK;
    if (w->F[T] == 0) return s->friction_state;
    return w->F[T] > 0 ? SLIP : SLIP_BACK;
}

const Patch partial_slip = {.slips_in_parts = true,
                            .stick = stick,
                            .update = update,
                            .release = release,
                            .friction_state = friction_state};
