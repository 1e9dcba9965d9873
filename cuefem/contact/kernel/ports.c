/* The matrix C and what goes through it: what the contact's velocities are now, and what impulses of its forces do. */
#include "contact.h"

/* Sine and cosine of phi + angle; those of phi are C's at the first touch. */
static void sine_of(const Contact *c, double angle, double *s, double *k)
{
    double sa = sin(angle), ca = cos(angle);
    *s = -c->facing[0] * ca - c->facing[1] * sa, *k = -c->facing[1] * ca + c->facing[0] * sa;
}

/* How far the contact has moved on a dome that is tied to the cue's end, (u, w), from the first touch to where the angle's
   sine and cosine are s and k; it goes no further than the rim. */
static void on_dome(const Contact *c, double angle, double s, double k, double *u, double *w)
{
    double from_s = -c->facing[0], from_k = -c->facing[1], at = c->phi + angle;
    if (c->phi > c->rim) sine_of(c, c->rim - c->phi, &from_s, &from_k);
    if (fabs(at) > c->rim) sine_of(c, copysign(c->rim, at) - c->phi, &s, &k);
    *u += c->dome * (from_s - s), *w += c->dome * (from_k - k);
}

/* The radius of what the ball rolls on: of the dome, or of nothing on its rim. */
double rolls_on(const Contact *c, double angle)
{
    return fabs(c->phi + angle) < c->rim ? c->dome : 0;
}

/* The matrix C where the contact has rolled through an angle: it sees the first touch's directions turned back by it. What
   is not set here is zero from the beginning. */
void facing_at(const Contact *c, double angle, double C[FORCES][ALL_PORTS])
{
    if (!c->turns) {
        int wide = c->cue->ports + c->speeds;
        for (int f = 0; f < c->forces; f++)
            for (int p = 0; p < wide; p++)
                C[f][p < c->cue->ports ? p : p - c->cue->ports + PORTS] = c->facing[f * wide + p];
        return;
    }
    double s, k, sa = sin(angle), ca = cos(angle), du = 0, dw = 0;
    sine_of(c, angle, &s, &k);
    if (c->levers) { /* Clenshaw's sum of Chebyshev's polynomials */
        double x = 2 * angle / c->lever_reach, u1 = 0, u2 = 0, w1 = 0, w2 = 0;
        for (int t = c->levers - 1; t > 0; t--) {
            double u = x * u1 - u2 + c->lever_terms[t], w = x * w1 - w2 + c->lever_terms[c->levers + t];
            u2 = u1, u1 = u, w2 = w1, w1 = w;
        }
        du = x / 2 * u1 - u2 + c->lever_terms[0], dw = x / 2 * w1 - w2 + c->lever_terms[c->levers];
    }
    on_dome(c, angle, s, k, &du, &dw);
    C[0][0] = -s, C[0][1] = -k, C[1][0] = -k, C[1][1] = s;
    if (c->cue->ports > 2) {
        C[0][2] = -(ca * c->lever_t + sa * c->lever_n + s * du + k * dw);
        C[1][2] = -(ca * c->lever_n - sa * c->lever_t + k * du - s * dw);
    }
    C[0][PORTS] = ca, C[0][PORTS + 1] = sa, C[0][PORTS + 2] = 1;
    C[1][PORTS] = -sa, C[1][PORTS + 1] = ca;
}

/* What the ports read now, and how fast that changes if nothing loads the cue. */
static void ports_now(const Contact *c, double *y, double *rate)
{
    const Cue *cue = c->cue;
    double of_cue[PORTS + SLOPES], its_rate[PORTS + SLOPES];
    for (int p = 0; p < cue->ports + cue->slopes; p++) {
        const double *row = cue->readings + 2 * p * cue->modes;
        double sum = 0, change = 0;
        for (int k = 0; k < cue->modes; k++) {
            const double *by = cue->rates + 2 * k, *x = c->xi + 2 * k, *of = row + 2 * k;
            sum += of[0] * x[0] - of[1] * x[1];
            if (rate) change += of[0] * (by[0] * x[0] - by[1] * x[1]) - of[1] * (by[0] * x[1] + by[1] * x[0]);
        }
        of_cue[p] = sum, its_rate[p] = change;
    }
    shorten_now(c, of_cue, rate ? its_rate : NULL);
    memcpy(y, of_cue, cue->ports * sizeof *y);
    if (rate) memcpy(rate, its_rate, cue->ports * sizeof *rate);
    for (int b = 0; b < c->speeds; b++) y[PORTS + b] = c->ball[b];
}

void velocities_now(Work *w, double *v)
{
    double y[ALL_PORTS] = {0};
    ports_now(w->c, y, NULL);
    facing_at(w->c, w->c->angle, w->C[0]);
    for (int f = 0; f < w->c->forces; f++) {
        v[f] = 0;
        for (int p = 0; p < ALL_PORTS; p++) v[f] += w->C[0][f][p] * y[p];
    }
}

/* How fast the contact's velocities change if it has no forces: dn/d angle = -t, and the line of centres turns. */
void accelerations_now(Work *w, double *a)
{
    const Contact *c = w->c;
    const Cue *cue = c->cue;
    double v[FORCES], y[ALL_PORTS] = {0}, rate[PORTS] = {0};
    velocities_now(w, v);
    ports_now(c, y, rate);
    for (int f = 0; f < c->forces; f++) {
        a[f] = 0;
        for (int p = 0; p < cue->ports; p++) a[f] += w->C[0][f][p] * rate[p];
    }
    if (!c->turns) return;
    double dome = rolls_on(c, c->angle), reach = c->radius + dome;
    double turning = -(v[0] - y[PORTS + 2] - (cue->ports > 2 ? dome * y[2] : 0)) / reach;
    a[0] += turning * v[1], a[1] += turning * turning * reach;
}

/* The contact's velocities per unit of impulse, where it faces now. */
void contact_gives(const Work *w, double B[FORCES][FORCES])
{
    const Contact *c = w->c;
    double gives[PORTS][PORTS];
    gives_now(c, gives);
    for (int f = 0; f < c->forces; f++)
        for (int g = 0; g < c->forces; g++) {
            double sum = 0;
            for (int a = 0; a < c->cue->ports; a++)
                for (int b = 0; b < c->cue->ports; b++) sum += w->C[0][f][a] * gives[a][b] * w->C[0][g][b];
            for (int b = 0; b < c->speeds; b++) sum += w->C[0][f][PORTS + b] * c->ball_gives[b] * w->C[0][g][PORTS + b];
            B[f][g] = sum;
        }
}

/* Impulses of the contact's forces, all at once. */
void push(Work *w, const double *impulses)
{
    Contact *c = w->c;
    const Cue *cue = c->cue;
    double loads[ALL_PORTS + SLOPES];
    for (int p = 0; p < ALL_PORTS; p++) {
        loads[p] = 0;
        for (int f = 0; f < c->forces; f++) loads[p] += w->C[0][f][p] * impulses[f];
    }
    load_slopes(c, loads[0], loads + ALL_PORTS);
    for (int p = 0; p < ALL_PORTS + cue->slopes; p++) w->blows[p] += loads[p];
    for (int b = 0; b < c->speeds; b++) c->ball[b] += c->ball_gives[b] * loads[PORTS + b];
    for (int p = 0; p < cue->ports + cue->slopes; p++) {
        double load = loads[p < cue->ports ? p : ALL_PORTS + p - cue->ports];
        for (int k = 0; k < 2 * cue->modes; k++) c->xi[k] += cue->drives[2 * p * cue->modes + k] * load;
    }
}

/* Take away what is left of the velocities that a hold keeps at zero; the energy that this takes. */
double blow(Work *w, const int *held, int count)
{
    if (!count) return 0;
    double v[FORCES], after[FORCES], B[FORCES][FORCES], P[FORCES] = {0}, x[FORCES], energy = 0;
    Factor few;
    velocities_now(w, v);
    contact_gives(w, B);
    for (int i = 0; i < count; i++) {
        x[i] = -v[held[i]];
        for (int j = 0; j < count; j++) few.matrix[j * count + i] = B[held[i]][held[j]];
    }
    if (!factor(count, &few)) return 0;
    solve_factored(count, &few, x);
    for (int i = 0; i < count; i++) P[held[i]] = x[i];
    push(w, P);
    velocities_now(w, after);
    for (int i = 0; i < count; i++) energy -= x[i] * (v[held[i]] + after[held[i]]) / 2;
    return energy;
}
