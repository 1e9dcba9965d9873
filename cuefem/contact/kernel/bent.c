/* The thrust on a bent cue (contact.h): its slopes, the loads on them, and what they take from the tip's way. */
#include "contact.h"

/* The tip turns this far at most, rad: beyond that w'^2/2 is no measure of how the cue shortens. */
static const double STEEPEST = 0.25;

/* The rows of readings behind those of the ports and the slopes. */
int dampers_of(const Cue *cue)
{
    return cue->reads - cue->ports - cue->slopes;
}

/* How far the tip goes back along the cue for each unit by which a slope changes. */
static double leg(const Contact *c, int a, double slope)
{
    return c->slope_weights[a] * slope;
}

/* Take from a velocity along the cue what the bending takes, at slopes that change at these rates. */
static void shorten(const Contact *c, const double *slopes, const double *rates, double *along)
{
    for (int a = 0; a < c->cue->slopes; a++) *along -= leg(c, a, slopes[a]) * rates[a];
}

/* The readings and, where it is asked for, their rates now: y of the ports and the slopes, in this order. */
void shorten_now(const Contact *c, double *y, double *rate)
{
    const int ports = c->cue->ports;
    if (rate) {
        shorten(c, c->slopes, rate + ports, rate);
        shorten(c, y + ports, y + ports, rate); /* the slopes change at these rates themselves */
    }
    shorten(c, c->slopes, y + ports, y);
}

/* Impulses or loads on the slopes of one along the cue. */
void load_slopes(const Contact *c, double along, double *to)
{
    for (int a = 0; a < c->cue->slopes; a++) to[a] = -leg(c, a, c->slopes[a]) * along;
}

/* The ports' velocities per unit of impulse, as the cue is bent now. */
void gives_now(const Contact *c, double gives[PORTS][PORTS])
{
    const Cue *cue = c->cue;
    const int ports = cue->ports;
    for (int a = 0; a < ports; a++) memcpy(gives[a], cue->inverse_mass[a], ports * sizeof(double));
    for (int a = 0; a < cue->slopes; a++) {
        double by = leg(c, a, c->slopes[a]);
        for (int p = 1; p < ports; p++) gives[0][p] -= by * cue->inverse_mass[ports + a][p];
        gives[0][0] -= 2 * by * cue->inverse_mass[ports + a][0];
        for (int b = 0; b < cue->slopes; b++)
            gives[0][0] += by * leg(c, b, c->slopes[b]) * cue->inverse_mass[ports + a][ports + b];
    }
    for (int p = 1; p < ports; p++) gives[p][0] = gives[0][p];
}

/* Add to readings at the nodes, from row first on, what loads on the slopes make of them. */
FAST void add_bending(const Contact *c, const Response *r, const Step *s, int first, int last, double (*y)[WITH])
{
    const Cue *cue = c->cue;
    double moved[cue->channels][Q];
    memset(moved, 0, sizeof moved);
    for (int k = 0; k < cue->channels; k++) {
        double driven[Q] = {0};
        add_product(cue->slopes, s->slope_loads[0], cue->channel_drives + k * cue->slopes, 1, driven);
        add_product(Q, r->bending + k * Q * Q, driven, 1, moved[k]);
    }
    for (int a = first; a < last; a++)
        add_product(cue->channels, moved[0], cue->channel_readings + a * cue->channels, 1, y[a - first] + 1);
}

/* A step whose slopes are those of before: the loads on them, from those on the ports; the readings y of ports and slopes
   with them; and the slopes that follow. By how much these change the tip's velocity, in units of the stroke's speed. */
FAST double bend_step(const Contact *c, const Response *r, Step *s, double (*y)[WITH])
{
    const Cue *cue = c->cue;
    const int ports = cue->ports;
    double changed = 0;
    for (int a = 0; a < cue->slopes; a++)
        for (int i = 0; i < Q; i++) s->slope_loads[a][i] = -leg(c, a, s->slopes[a][i + 1]) * s->loads[0][i];
    add_bending(c, r, s, 0, ports + cue->slopes, y);
    for (int a = 0; a < cue->slopes; a++) {
        double *rate = y[ports + a], slopes[WITH];
        for (int i = 0; i < WITH; i++) slopes[i] = c->slopes[a];
        add_product(WITH, rule.sums[0], rate, r->step, slopes + 1);
        for (int i = 1; i < WITH; i++) changed = larger(changed, fabs(leg(c, a, slopes[i] - s->slopes[a][i]) * rate[i]));
        memcpy(s->slopes[a], slopes, sizeof slopes);
        for (int i = 0; i < WITH; i++) y[0][i] -= leg(c, a, s->slopes[a][i]) * rate[i];
    }
    return changed / c->speed;
}

/* The slopes of a step before anything is known of it: those at its start. */
void begin_slopes(const Contact *c, Step *s)
{
    for (int a = 0; a < c->cue->slopes; a++)
        for (int i = 0; i < WITH; i++) s->slopes[a][i] = c->slopes[a];
}

/* Go to a part of a step; whether the cue is bent too far then. */
int take_slopes(Contact *c, const Step *s, double part)
{
    for (int a = 0; a < c->cue->slopes; a++) {
        c->slopes[a] = value_at(s->slopes[a], part);
        if ((a + 1) % c->plane == 0 && fabs(c->slopes[a]) > c->steepest)
            c->steepest = fabs(c->slopes[a]), c->thrust = -s->loads[0][Q - 1];
    }
    return c->steepest > STEEPEST;
}
