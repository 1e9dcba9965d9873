/* A patch of leather that holds and slides ring by ring (Cattaneo, Mindlin and Deresiewicz; Jaeger's superposition).

   Where the patch grows from the compression x to x + dx while the surfaces shift by d(delta), the tractions of a stuck
   punch of that size are added: the force along the surface is a sum over rings, each strained by what the surfaces have
   shifted since it touched. So is the normal force. A ring between two edges of the compression has the stiffness k and
   the normal force N of the law between them; it bears f, |f| <= mu N:

       f -> clip(f min(k after/k before, 1) + k d(delta), +-mu N).

   The contact slides as a whole where all rings do; nothing else tells that it does. */
#include "contact.h"

typedef struct {
    int count; /* rings that touch; the last of them in part */
    double F, k, slope, depth;
} Patch;

static Patch patch_at(const Contact *c, int press, double depth)
{
    Patch p = {0, 0, 0, 0, virtual_depth(c, press, depth)};
    double dk;
    curve_at(c, p.depth, &p.F, &p.slope, &p.k, &dk);
    int low = 0, high = c->rings; /* the first edge that is not below the compression */
    while (low < high) {
        int middle = (low + high) / 2;
        if (c->ring_edges[middle] < p.depth) low = middle + 1;
        else high = middle;
    }
    p.count = low < c->rings ? low : c->rings; /* the last ring has all that lies beyond */
    return p;
}

/* Stiffness, normal force and its slope of ring r. */
static void ring_of(const Contact *c, const Patch *p, int r, double *k, double *N, double *slope)
{
    const double *F = c->ring_forces, *S = c->ring_slopes, *K = c->ring_stiffness, *edge = c->ring_edges;
    double inner = F[r] + S[r] * (p->depth - edge[r]);
    if (r + 1 < p->count) {
        *k = K[r + 1] - K[r], *slope = S[r + 1] - S[r];
        *N = F[r + 1] + S[r + 1] * (p->depth - edge[r + 1]) - inner;
    } else *k = p->k - K[r], *slope = p->slope - S[r], *N = p->F - inner;
}

/* What a ring bears after a shift. */
static inline double borne(double f, double k, double shift, double bound)
{
    double bears = f + k * shift;
    bears = bears > bound ? bound : bears;
    return bears < -bound ? -bound : bears;
}

/* Take the rings from one state of the patch to the next; what they bear then, and how it changes. */
static double walk(const Contact *c, const Patch *from, const Patch *to, double shift, double *restrict f,
                        double *stuck, double *slid)
{
    const double *restrict F = c->ring_forces, *restrict S = c->ring_slopes, *restrict K = c->ring_stiffness;
    const double *restrict edge = c->ring_edges;
    int whole = (to->count < from->count ? to->count : from->count) - 1, r = 0; /* rings that touch in full all the way */
    double mu = c->friction, depth = to->depth, sum = 0, stiff = 0, slides = 0;
    for (; r < whole; r++) {
        double k = K[r + 1] - K[r], slope = S[r + 1] - S[r];
        double bound = mu * (F[r + 1] - F[r] + S[r + 1] * (depth - edge[r + 1]) - S[r] * (depth - edge[r]));
        double bears = borne(f[r], k, shift, bound);
        stiff += fabs(bears) < bound ? k : 0, slides += bears >= bound ? slope : 0, slides -= bears <= -bound ? slope : 0;
        f[r] = bears, sum += bears;
    }
    for (; r < to->count; r++) {
        double k, N, slope, k_before = 0, unused;
        ring_of(c, to, r, &k, &N, &slope);
        if (r < from->count) ring_of(c, from, r, &k_before, &unused, &unused);
        double bound = mu * N, left = k_before > k ? k / k_before : 1;
        double bears = borne(f[r] * left, (k + k_before) / 2, shift, bound);
        stiff += fabs(bears) < bound ? k : 0, slides += fabs(bears) < bound ? 0 : copysign(slope, bears);
        f[r] = bears, sum += bears;
    }
    for (; r < from->count; r++) f[r] = 0;
    *stuck = stiff, *slid = slides == 0 ? 0 : mu * slides;
    return sum;
}

void rings_at_nodes(Work *w, const Step *s, Residual *r)
{
    const Contact *c = w->c;
    int press = w->hold.press;
    double f[c->rings], before = 0, stuck, slid, give = give_of(c, press);
    memcpy(f, c->ring_shear, c->rings * sizeof *f);
    Patch from = patch_at(c, press, s->depth[0]);
    for (int i = 1; i < WITH; i++) {
        Patch to = patch_at(c, press, s->depth[i]);
        r->g[0][i - 1] = s->F[0][i] - walk(c, &from, &to, before - s->x[0][i], f, &stuck, &slid);
        r->on_F[0][0][i - 1] = 1, r->on_x[0][0][i - 1] = stuck, r->on_x[0][1][i - 1] = slid / give;
        before = s->x[0][i], from = to;
    }
}

void rings_take(Work *w, const Step *s, double part)
{
    Contact *c = w->c;
    int press = w->hold.press;
    double before = 0, stuck, slid, sum = 0;
    Patch from = patch_at(c, press, s->depth[0]);
    for (int i = 1; i < WITH && rule.nodes[i - 1] < part * (1 - 1e-12); i++) {
        Patch to = patch_at(c, press, s->depth[i]);
        sum = walk(c, &from, &to, before - s->x[0][i], c->ring_shear, &stuck, &slid);
        before = s->x[0][i], from = to;
    }
    Patch to = patch_at(c, press, value_at(s->depth, part));
    sum = walk(c, &from, &to, before - value_at(s->x[0], part), c->ring_shear, &stuck, &slid);
    c->shear = sum;
}

double rings_store(const Contact *c, int press, double depth)
{
    double sum = 0, k, N, slope;
    Patch p = patch_at(c, press, depth);
    for (int r = 0; r < p.count; r++) {
        ring_of(c, &p, r, &k, &N, &slope);
        if (k > 0) sum += c->ring_shear[r] * c->ring_shear[r] / (2 * k);
    }
    return sum;
}
