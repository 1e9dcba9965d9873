/* What is written down of a contact: its steps and its phases. */
#include "contact.h"

/* One more of these rows; NULL if there is no memory. Their room doubles at every power of two. */
static double *next_row(double **rows, int *count, int wide)
{
    if ((*count & (*count - 1)) == 0) {
        double *more = realloc(*rows, (*count ? 2 * (size_t)*count : 1) * wide * sizeof *more);
        if (!more) return NULL;
        *rows = more;
    }
    return *rows + (size_t)(*count)++ * wide;
}

/* A row of the records: time, step, part, grip, press; F and v at the start and the nodes, compression and angle; loads on all
   ports and slopes at the nodes; and the blows on these before the step. */
int record(Work *w, const Step *s, double part)
{
    Contact *c = w->c;
    if (!c->recording) return 1;
    int ports = PORTS + c->speeds, slopes = c->cue->slopes;
    c->row = 5 + 2 * c->forces * WITH + 2 * WITH + (ports + slopes) * (Q + 1);
    double *to = next_row(&c->records, &c->record_count, c->row);
    if (!to) return 0;
    *to++ = c->time, *to++ = s->step, *to++ = part, *to++ = w->hold.grip, *to++ = w->hold.press;
    for (int f = 0; f < c->forces; f++) memcpy(to, s->F[f], sizeof s->F[f]), to += WITH;
    for (int f = 0; f < c->forces; f++) memcpy(to, s->v[f], sizeof s->v[f]), to += WITH;
    memcpy(to, s->depth, sizeof s->depth), to += WITH;
    memcpy(to, s->angle, sizeof s->angle), to += WITH;
    memcpy(to, s->loads, ports * sizeof s->loads[0]), to += ports * Q;
    memcpy(to, s->slope_loads, slopes * sizeof s->slope_loads[0]), to += slopes * Q;
    memcpy(to, w->blows, ports * sizeof *to), to += ports;
    memcpy(to, w->blows + ALL_PORTS, slopes * sizeof *to);
    memset(w->blows, 0, sizeof w->blows);
    return 1;
}

/* Write down a phase that ends now. */
void end_phase(Work *w, Hold hold, double start, const double *ball_before)
{
    Contact *c = w->c;
    if (c->phase_count >= c->most_phases) return;
    double *to = next_row(&c->phases, &c->phase_count, 4 + 2 * c->speeds);
    if (!to) return;
    to[0] = hold.grip, to[1] = hold.press, to[2] = start, to[3] = c->time;
    memcpy(to + 4, ball_before, c->speeds * sizeof *to), memcpy(to + 4 + c->speeds, c->ball, c->speeds * sizeof *to);
}
