/* A patch of leather that holds and slides ring by ring (Cattaneo, Mindlin and Deresiewicz; Jaeger's superposition).

   Where the patch grows from the compression x to x + dx while the surfaces shift by d(delta), the tractions of a stuck
   punch of that size are added: the force along the surface is a sum over rings, each strained by what the surfaces have
   shifted since it touched. So is the normal force. A ring between two edges of the compression has the stiffness k and
   the normal force N of the law between them; it bears f, |f| <= mu N:

       f -> clip(f min(k after/k before, 1) + k d(delta), +-mu N).

   Leather that keeps a part of the work has the slope k/e^2 while |f| falls, e the restitution along the surface: of the
   work f d(delta) that strains a ring it stores e^2, f^2 e^2/2k in all, and keeps the rest.

   The contact slides as a whole where all rings do; nothing else tells that it does. */
#include "contact.h"

typedef struct {
    int count; /* rings that touch; the last of them in part */
    double F, k, slope, depth;
} Patch;

static Patch patch_at(const Contact *c, int press, double depth)
{
    Patch p = {0, 0, 0, 0, virtual_depth(c, press, depth)};
    curve_at(c, p.depth, &p.F, &p.slope, &p.k);
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
    } else *k = larger(p->k - K[r], 0), *slope = p->slope - S[r], *N = p->F - inner;
    *N = larger(*N, 0); /* less just past an edge, of rounding, and where a tip in touch as a whole no longer stiffens */
}

typedef struct {
    double sum, stuck, slid, lost; /* force, how it changes with the shift and the depth, and what the leather keeps, J */
} Borne;

/* Shift a ring that bears f: its slope is k while |f| grows and k/e^2 while it falls. */
static inline double shifted(double f, double by, double e2)
{
    if (e2 == 1) return f + by;
    double falls = fabs(by) < e2 * fabs(f) ? f + by / e2 : by + e2 * f;
    return f * by < 0 ? falls : f + by;
}

static inline double bounded(double f, double bound)
{
    f = f > bound ? bound : f;
    return f < -bound ? -bound : f;
}

/* What a ring bears after the shift, and what it adds to the rest; written out so that it becomes vector instructions. */
#define ADD_RING                                                                             \
    double bears = bounded(shifted(was, k * shift, e2), bound), stays = was * bears > 0;     \
    double steep = e2 < 1 && stays * was * shift < 0 ? k / e2 : k;                   \
    double grown = bears * bears - stays * was * was;                                        \
    sum += bears, stuck += fabs(bears) < bound ? steep : 0;                                  \
    slid += bears >= bound ? slope : 0, slid -= bears <= -bound ? slope : 0;                 \
    if (e2 < 1) lost += (grown > 0 ? grown : 0) * (1 - e2) / (2 * (k > 0 ? k : HUGE_VAL));   \
    f[r] = bears;

/* Take the rings from one state of the patch to the next. */
static inline Borne walk_with(double e2, const Contact *c, const Patch *from, const Patch *to, double shift,
                              double *restrict f)
{
    const double *restrict F = c->ring_forces, *restrict S = c->ring_slopes, *restrict K = c->ring_stiffness;
    const double *restrict edge = c->ring_edges;
    int whole = (to->count < from->count ? to->count : from->count) - 1, r = 0; /* rings that touch in full all the way */
    double mu = c->friction, depth = to->depth;
    double sum = 0, stuck = 0, slid = 0, lost = 0;
    for (; r < whole; r++) {
        double k = K[r + 1] - K[r], slope = S[r + 1] - S[r], was = f[r];
        double bound = mu * larger(F[r + 1] - F[r] + S[r + 1] * (depth - edge[r + 1]) - S[r] * (depth - edge[r]), 0);
        ADD_RING
    }
    for (; r < to->count; r++) {
        double k_now, N, slope, k_before = 0, unused;
        ring_of(c, to, r, &k_now, &N, &slope);
        if (r < from->count) ring_of(c, from, r, &k_before, &unused, &unused);
        double was = f[r] * (k_before > k_now ? k_now / k_before : 1), k = (k_now + k_before) / 2, bound = mu * N;
        ADD_RING
    }
    for (; r < from->count; r++) f[r] = 0;
    return (Borne){sum, stuck, slid == 0 ? 0 : mu * slid, lost};
}
#undef ADD_RING

/* Leather that gives back all needs no more than a sum and its bounds. */
static Borne walk(const Contact *c, const Patch *from, const Patch *to, double shift, double *f)
{
    double e = c->surface_restitution;
    return e == 1 ? walk_with(1, c, from, to, shift, f) : walk_with(e * e, c, from, to, shift, f);
}

void rings_at_nodes(Work *w, const Step *s, Residual *r)
{
    const Contact *c = w->c;
    int press = w->hold.press;
    double f[c->rings], before = 0, give = give_of(c, press);
    memcpy(f, c->ring_shear, c->rings * sizeof *f);
    Patch from = patch_at(c, press, s->depth[0]);
    for (int i = 1; i < WITH; i++) {
        Patch to = patch_at(c, press, s->depth[i]);
        Borne all = walk(c, &from, &to, before - s->x[0][i], f);
        r->g[0][i - 1] = s->F[0][i] - all.sum;
        r->on_F[0][0][i - 1] = 1, r->on_x[0][0][i - 1] = all.stuck, r->on_x[0][1][i - 1] = all.slid / give;
        before = s->x[0][i], from = to;
    }
}

double rings_take(Work *w, const Step *s, double part)
{
    Contact *c = w->c;
    int press = w->hold.press;
    double before = 0, lost = 0;
    Patch from = patch_at(c, press, s->depth[0]);
    for (int i = 1; i < WITH && rule.nodes[i - 1] < part * (1 - 1e-12); i++) {
        Patch to = patch_at(c, press, s->depth[i]);
        lost += walk(c, &from, &to, before - s->x[0][i], c->ring_shear).lost;
        before = s->x[0][i], from = to;
    }
    Patch to = patch_at(c, press, value_at(s->depth, part));
    Borne all = walk(c, &from, &to, before - value_at(s->x[0], part), c->ring_shear);
    c->shear = all.sum;
    return lost + all.lost;
}

double rings_store(const Contact *c, int press, double depth)
{
    double sum = 0, k, N, slope;
    Patch p = patch_at(c, press, depth);
    for (int r = 0; r < p.count; r++) {
        ring_of(c, &p, r, &k, &N, &slope);
        if (k > 0) sum += c->ring_shear[r] * c->ring_shear[r] / (2 * k);
    }
    return c->surface_restitution * c->surface_restitution * sum;
}
