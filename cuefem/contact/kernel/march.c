/* A contact from touch to parting: steps, their forces by Newton's method, and the phases that they make up. */
#include "contact.h"

struct Factor {
    double matrix[FORCES * Q * FORCES * Q], scale[FORCES * Q];
    int pivots[FORCES * Q];
};

/* How far the contact has moved on a dome that is tied to the cue's end, (u, w); it goes no further than the rim. */
static void on_dome(const Contact *c, double angle, double *u, double *w)
{
    double from = fmin(c->phi, c->rim), to = larger(-c->rim, fmin(c->phi + angle, c->rim));
    *u += c->dome * (sin(from) - sin(to)), *w += c->dome * (cos(from) - cos(to));
}

/* The radius of what the ball rolls on: of the dome, or of nothing on its rim. */
static double rolls_on(const Contact *c, double angle)
{
    return fabs(c->phi + angle) < c->rim ? c->dome : 0;
}

/* The level of a step that is about as long as the contact's clock. */
int clock_level(const Contact *c)
{
    return LONGEST_POWER - (int)floor(log2(c->clock));
}

/* The matrix C where the contact has rolled through an angle: it sees the first touch's directions turned back by it. */
void facing_at(const Contact *c, double angle, double C[FORCES][ALL_PORTS])
{
    memset(C, 0, sizeof(double[FORCES][ALL_PORTS]));
    if (!c->turns) {
        int wide = c->cue->ports + c->speeds;
        for (int f = 0; f < c->forces; f++)
            for (int p = 0; p < wide; p++)
                C[f][p < c->cue->ports ? p : p - c->cue->ports + PORTS] = c->facing[f * wide + p];
        return;
    }
    double s = sin(c->phi + angle), k = cos(c->phi + angle), sa = sin(angle), ca = cos(angle), du = 0, dw = 0;
    if (c->levers) { /* Clenshaw's sum of Chebyshev's polynomials */
        double x = 2 * angle / c->lever_reach, u1 = 0, u2 = 0, w1 = 0, w2 = 0;
        for (int t = c->levers - 1; t > 0; t--) {
            double u = x * u1 - u2 + c->lever_terms[t], w = x * w1 - w2 + c->lever_terms[c->levers + t];
            u2 = u1, u1 = u, w2 = w1, w1 = w;
        }
        du = x / 2 * u1 - u2 + c->lever_terms[0], dw = x / 2 * w1 - w2 + c->lever_terms[c->levers];
    }
    on_dome(c, angle, &du, &dw);
    C[0][0] = -s, C[0][1] = -k, C[1][0] = -k, C[1][1] = s;
    if (c->cue->ports > 2) {
        C[0][2] = -(ca * c->lever_t + sa * c->lever_n + s * du + k * dw);
        C[1][2] = -(ca * c->lever_n - sa * c->lever_t + k * du - s * dw);
    }
    C[0][PORTS] = ca, C[0][PORTS + 1] = sa, C[0][PORTS + 2] = 1;
    C[1][PORTS] = -sa, C[1][PORTS + 1] = ca;
}

/* What the ports read now. */
static void ports_now(const Contact *c, double *y)
{
    const Cue *cue = c->cue;
    for (int p = 0; p < cue->ports; p++) {
        const double *row = cue->readings + 2 * p * cue->modes;
        double sum = 0;
        for (int k = 0; k < cue->modes; k++) sum += row[2 * k] * c->xi[2 * k] - row[2 * k + 1] * c->xi[2 * k + 1];
        y[p] = sum;
    }
    for (int b = 0; b < c->speeds; b++) y[PORTS + b] = c->ball[b];
}

void velocities_now(Work *w, double *v)
{
    double y[ALL_PORTS] = {0};
    ports_now(w->c, y);
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
    ports_now(c, y);
    for (int p = 0; p < cue->ports; p++)
        for (int k = 0; k < cue->modes; k++) {
            const double *row = cue->readings + 2 * (p * cue->modes + k), *by = cue->rates + 2 * k, *x = c->xi + 2 * k;
            double re = by[0] * x[0] - by[1] * x[1], im = by[0] * x[1] + by[1] * x[0];
            rate[p] += row[0] * re - row[1] * im;
        }
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
    for (int f = 0; f < c->forces; f++)
        for (int g = 0; g < c->forces; g++) {
            double sum = 0;
            for (int a = 0; a < c->cue->ports; a++)
                for (int b = 0; b < c->cue->ports; b++)
                    sum += w->C[0][f][a] * c->cue->inverse_mass[a][b] * w->C[0][g][b];
            for (int b = 0; b < c->speeds; b++) sum += w->C[0][f][PORTS + b] * c->ball_gives[b] * w->C[0][g][PORTS + b];
            B[f][g] = sum;
        }
}

/* Impulses of the contact's forces, all at once. */
void push(Work *w, const double *impulses)
{
    Contact *c = w->c;
    const Cue *cue = c->cue;
    for (int p = 0; p < ALL_PORTS; p++) {
        double load = 0;
        for (int f = 0; f < c->forces; f++) load += w->C[0][f][p] * impulses[f];
        w->blows[p] += load;
        if (p >= PORTS) {
            if (p - PORTS < c->speeds) c->ball[p - PORTS] += c->ball_gives[p - PORTS] * load;
        } else if (p < cue->ports)
            for (int k = 0; k < 2 * cue->modes; k++) c->xi[k] += cue->drives[2 * p * cue->modes + k] * load;
    }
}

/* LU factors of a matrix with scaled rows and pivots; 0 if it has none. */
FAST static int factor(int n, struct Factor *to)
{
    double *A = to->matrix;
    for (int i = 0; i < n; i++) {
        double big = 1e-300;
        for (int j = 0; j < n; j++) big = larger(big, fabs(A[i * n + j]));
        to->scale[i] = 1 / big;
        for (int j = 0; j < n; j++) A[i * n + j] *= to->scale[i];
    }
    for (int k = 0; k < n; k++) {
        int q = k;
        for (int i = k + 1; i < n; i++)
            if (fabs(A[i * n + k]) > fabs(A[q * n + k])) q = i;
        to->pivots[k] = q;
        if (!(fabs(A[q * n + k]) > 0)) return 0;
        if (q != k)
            for (int j = 0; j < n; j++) {
                double t = A[k * n + j];
                A[k * n + j] = A[q * n + j], A[q * n + j] = t;
            }
        double by = 1 / A[k * n + k];
        for (int i = k + 1; i < n; i++) {
            double f = A[i * n + k] *= by;
            if (f == 0) continue;
            for (int j = k + 1; j < n; j++) A[i * n + j] -= f * A[k * n + j];
        }
    }
    return 1;
}

FAST static void solve_factored(int n, const struct Factor *by, double *b)
{
    const double *A = by->matrix;
    for (int i = 0; i < n; i++) b[i] *= by->scale[i];
    for (int k = 0; k < n; k++) {
        double t = b[k];
        b[k] = b[by->pivots[k]], b[by->pivots[k]] = t;
    }
    for (int i = 1; i < n; i++) {
        double sum = b[i];
        for (int j = 0; j < i; j++) sum -= A[i * n + j] * b[j];
        b[i] = sum;
    }
    for (int i = n - 1; i >= 0; i--) {
        double sum = b[i];
        for (int j = i + 1; j < n; j++) sum -= A[i * n + j] * b[j];
        b[i] = sum / A[i * n + i];
    }
}

/* Take away what is left of the velocities that a hold keeps at zero; the energy that this takes. */
double blow(Work *w, const int *held, int count)
{
    if (!count) return 0;
    double v[FORCES], after[FORCES], B[FORCES][FORCES], P[FORCES] = {0}, x[FORCES], energy = 0;
    struct Factor few;
    velocities_now(w, v);
    contact_gives(w, B);
    for (int i = 0; i < count; i++) {
        x[i] = -v[held[i]];
        for (int j = 0; j < count; j++) few.matrix[i * count + j] = B[held[i]][held[j]];
    }
    if (!factor(count, &few)) return 0;
    solve_factored(count, &few, x);
    for (int i = 0; i < count; i++) P[held[i]] = x[i];
    push(w, P);
    velocities_now(w, after);
    for (int i = 0; i < count; i++) energy -= x[i] * (v[held[i]] + after[held[i]]) / 2;
    return energy;
}

/* What the cue's rows read at the nodes if nothing loads it: its own motion. */
FAST static void own_motion(const Contact *c, const Response *r, double (*own)[WITH])
{
    const Cue *cue = c->cue;
    int K = cue->modes;
    double *turned = malloc(2 * K * sizeof *turned);
    if (!turned) return;
    for (int i = 0; i < WITH; i++) {
        const double *turn = r->turns + 2 * (i - 1) * K, *x = c->xi;
        for (int k = 0; k < K; k++) {
            double tr = i ? turn[2 * k] : 1, ti = i ? turn[2 * k + 1] : 0;
            turned[2 * k] = tr * x[2 * k] - ti * x[2 * k + 1];
            turned[2 * k + 1] = -(tr * x[2 * k + 1] + ti * x[2 * k]);
        }
        for (int a = 0; a < cue->reads; a++) {
            const double *row = cue->readings + 2 * a * K;
            double sum = 0;
            for (int k = 0; k < 2 * K; k++) sum += row[k] * turned[k];
            own[a][i] = sum;
        }
    }
    free(turned);
}

/* What the cue's rows read once loads act. */
FAST static void loaded(const Cue *cue, const Response *r, const double (*own)[WITH], const double (*loads)[Q],
                        int first, int last, double (*y)[WITH])
{
    int wide = cue->ports * Q;
    const double *load = (const double *)loads;
    for (int a = first; a < last; a++) {
        y[a - first][0] = own[a][0];
        for (int i = 0; i < Q; i++) {
            const double *row = r->answer + (a * Q + i) * wide;
            double sum = own[a][i + 1];
            for (int j = 0; j < wide; j++) sum += row[j] * load[j];
            y[a - first][i + 1] = sum;
        }
    }
}

/* The contact's own answer V: from its forces at the nodes to its velocities there, and behind it to their integrals. */
FAST static void answer_of(const Work *w, const Response *r, double *V)
{
    const Contact *c = w->c;
    int n = c->forces, ports = c->cue->ports;
    double *sums = V + n * n * Q * Q;
    memset(V, 0, 2 * n * n * Q * Q * sizeof *V);
    for (int f = 0; f < n; f++)
        for (int g = 0; g < n; g++) {
            double *to = V + (f * n + g) * Q * Q, *sum = sums + (f * n + g) * Q * Q, ball = 0;
            for (int a = 0; a < ports; a++)
                for (int b = 0; b < ports; b++) {
                    double by = w->C[0][f][a] * w->C[0][g][b];
                    if (by == 0) continue;
                    for (int i = 0; i < Q; i++) {
                        const double *from = r->answer + ((a * Q + i) * ports + b) * Q;
                        for (int j = 0; j < Q; j++) to[i * Q + j] += by * from[j];
                    }
                }
            for (int b = 0; b < c->speeds; b++)
                ball += w->C[0][f][PORTS + b] * c->ball_gives[b] * w->C[0][g][PORTS + b];
            for (int i = 0; i < Q; i++)
                for (int j = 0; j < Q; j++) to[i * Q + j] += ball * r->step * rule.force_sums[i][j];
            for (int i = 0; i < Q; i++)
                for (int l = 0; l < Q; l++) {
                    double by = r->step * rule.sums[i][l + 1];
                    for (int j = 0; j < Q; j++) sum[i * Q + j] += by * to[l * Q + j];
                }
        }
}

/* J = on_F + on_v V + on_x (integrals of V). */
FAST static void jacobian(int n, const Residual *r, const double *V, double *J)
{
    int wide = n * Q;
    const double *sums = V + n * n * Q * Q;
    memset(J, 0, wide * wide * sizeof *J);
    for (int f = 0; f < n; f++)
        for (int i = 0; i < Q; i++) {
            double *row = J + (f * Q + i) * wide;
            for (int g = 0; g < n; g++) {
                double by_v = r->on_v[f][g][i], by_x = r->on_x[f][g][i];
                row[g * Q + i] += r->on_F[f][g][i];
                if (by_v == 0 && by_x == 0) continue;
                for (int b = 0; b < n; b++) {
                    const double *from = V + ((g * n + b) * Q + i) * Q, *sum = sums + ((g * n + b) * Q + i) * Q;
                    for (int j = 0; j < Q; j++) row[b * Q + j] += by_v * from[j] + by_x * sum[j];
                }
            }
        }
}

/* The forces of the step before, gone on with: what Newton's method begins with. */
static void guess(const Work *w, double step, double F[FORCES][Q])
{
    int n = w->c->forces;
    memset(F, 0, sizeof(double[FORCES][Q]));
    if (!w->known || w->linear) return;
    double waves[FORCES][Q];
    for (int f = 0; f < n; f++)
        for (int t = 0; t < Q; t++) {
            waves[f][t] = 0;
            for (int j = 0; j < Q; j++) waves[f][t] += rule.force_waves[t][j] * w->last_F[f][j];
        }
    for (int i = 0; i < Q; i++) {
        double at = fmin(w->last_part + rule.nodes[i] * step / w->last_step, w->last_part < 1 ? 1 : 1.2);
        for (int f = 0; f < n; f++) F[f][i] = legendre(waves[f], Q, at);
    }
}

/* What moves in a step with these forces: loads, velocities, their integrals, the compression and the angle; by how
   much the angle changed. */
FAST static double move(Work *w, const Response *r, const double (*own)[WITH], const double F[FORCES][Q], Step *s)
{
    const Contact *c = w->c;
    int n = c->forces, ports = c->cue->ports;
    double y[ALL_PORTS][WITH], changed = 0;
    for (int p = 0; p < ports; p++)
        for (int i = 0; i < Q; i++) {
            s->loads[p][i] = 0;
            for (int f = 0; f < n; f++) s->loads[p][i] += w->C[c->turns ? i + 1 : 0][f][p] * F[f][i];
        }
    for (int b = 0; b < c->speeds; b++)
        for (int i = 0; i < Q; i++) {
            s->loads[PORTS + b][i] = 0;
            for (int f = 0; f < n; f++) s->loads[PORTS + b][i] += w->C[c->turns ? i + 1 : 0][f][PORTS + b] * F[f][i];
        }
    loaded(c->cue, r, own, (const double(*)[Q])s->loads, 0, ports, y);
    for (int b = 0; b < c->speeds; b++) {
        double *speed = y[PORTS + b], by = r->step * c->ball_gives[b];
        speed[0] = c->ball[b];
        for (int i = 0; i < Q; i++) {
            double sum = 0;
            for (int j = 0; j < Q; j++) sum += rule.force_sums[i][j] * s->loads[PORTS + b][j];
            speed[i + 1] = c->ball[b] + by * sum;
        }
    }
    for (int f = 0; f < n; f++) {
        for (int i = 0; i < WITH; i++) {
            const double *row = w->C[c->turns ? i : 0][f];
            double sum = 0;
            for (int p = 0; p < ports; p++) sum += row[p] * y[p][i];
            for (int b = 0; b < c->speeds; b++) sum += row[PORTS + b] * y[PORTS + b][i];
            s->v[f][i] = sum;
        }
        s->x[f][0] = 0;
        for (int i = 0; i < Q; i++) {
            double sum = 0;
            for (int j = 0; j < WITH; j++) sum += rule.sums[i][j] * s->v[f][j];
            s->x[f][i + 1] = r->step * sum;
        }
    }
    for (int i = 0; i < WITH; i++) s->depth[i] = c->depth - s->x[1][i];
    if (!c->turns) return 0;
    double rate[WITH];
    for (int i = 0; i < WITH; i++) {
        double dome = rolls_on(c, s->angle[i]);
        rate[i] = -(s->v[0][i] - y[PORTS + 2][i] - (ports > 2 ? dome * y[2][i] : 0)) / (c->radius + dome);
    }
    for (int i = 0; i < Q; i++) {
        double sum = 0;
        for (int j = 0; j < WITH; j++) sum += rule.sums[i][j] * rate[j];
        sum = c->angle + r->step * sum;
        changed = larger(changed, fabs(sum - s->angle[i + 1]));
        s->angle[i + 1] = sum;
    }
    for (int i = 1; i < WITH; i++) facing_at(c, s->angle[i], w->C[i]);
    return changed;
}

/* Solve a step of 2^(LONGEST_POWER - level) s in the hold of w; 0 if Newton's method does not settle. */
int solve_step(Work *w, int level, Step *s)
{
    Contact *c = w->c;
    Response *r = response_of(c->cue, level);
    int n = c->forces, wide = n * Q, dampers = c->cue->reads - c->cue->ports;
    if (!r) return 0;
    double size = c->impulse / c->clock, F[FORCES][Q], before = HUGE_VAL, own[c->cue->reads][WITH];
    struct Factor mine, *by = &mine;
    s->level = level, s->step = r->step;
    own_motion(c, r, own);
    for (int i = 0; i < WITH; i++) s->angle[i] = c->angle;
    facing_at(c, c->angle, w->C[0]);
    if (c->turns)
        for (int i = 1; i < WITH; i++) memcpy(w->C[i], w->C[0], sizeof w->C[0]);
    guess(w, r->step, F);
    int settled = 0, slow = 0;
    double last = HUGE_VAL;
    for (int round = 0; round < 30; round++) {
        c->rounds++;
        double turned = move(w, r, (const double(*)[WITH])own, (const double(*)[Q])F, s);
        for (int f = 0; f < n; f++)
            for (int i = 0; i < WITH; i++) {
                double sum = 0;
                if (i) sum = F[f][i - 1];
                else
                    for (int j = 0; j < Q; j++) sum += rule.extend[0][j] * F[f][j];
                s->F[f][i] = sum;
            }
        settled = w->hold.press == FREE ? turned < 1e-14 : round && (w->linear || before < 0.1 * c->tolerance);
        if (settled) break;
        if (w->hold.press == FREE) continue;
        w->law->residual(w, s, &w->residual);
        int known = w->linear && w->factors[level][w->hold.grip + 1 + 3 * w->hold.press] != NULL;
        if (known) by = w->factors[level][w->hold.grip + 1 + 3 * w->hold.press];
        else if (round == 0 || slow) { /* the matrix of a round before does as long as it brings the forces nearer */
            if (!w->V[level]) { /* where the contact first used this step: turned on a little it still leads there */
                if (!(w->V[level] = malloc(2 * n * n * Q * Q * sizeof(double)))) break;
                answer_of(w, r, w->V[level]);
            }
            const double *V = w->V[level];
            if (w->linear) {
                by = malloc(sizeof *by);
                if (!by) break;
            }
            jacobian(n, &w->residual, V, by->matrix);
            int good = factor(wide, by);
            if (w->linear) w->factors[level][w->hold.grip + 1 + 3 * w->hold.press] = by;
            if (!good) break;
        }
        double g[FORCES * Q], off = turned * size;
        memcpy(g, w->residual.g, wide * sizeof *g);
        solve_factored(wide, by, g);
        for (int f = 0; f < n; f++)
            for (int i = 0; i < Q; i++) F[f][i] -= g[f * Q + i], off = larger(off, fabs(g[f * Q + i]));
        off /= size;
        if (!(off < 1e9)) break;
        slow = round && off > 0.1 * last;
        last = off;
        before = (off < 1e-9 || off * r->step < 1e-13 * c->clock) && off > 0.5 * before ? 0 : off; /* rounding is left */
    }
    if (c->depth == 0 && c->time == 0) /* the first touch has no force yet */
        for (int f = 0; f < n; f++) s->F[f][0] = 0;
    if (settled && dampers)
        loaded(c->cue, r, (const double(*)[WITH])own, (const double(*)[Q])s->loads, c->cue->ports, c->cue->reads,
               (double(*)[WITH])s->damped);
    return settled;
}

/* The forces that a hold would ask for now: those at a node of a very short step. */
int forces_held(Work *w, Hold hold, double *F, int node)
{
    static const int SHORT = 12;
    Hold here = w->hold;
    int level = clock_level(w->c) + SHORT, known = w->known;
    w->hold = hold;
    int settled = solve_step(w, level < LEVELS ? level : LEVELS - 1, &w->step);
    w->hold = here, w->known = known;
    for (int f = 0; f < w->c->forces; f++) F[f] = settled ? w->step.F[f][node] : 0;
    return settled;
}

/* What is left out of a step: the last terms of its loads and velocities, in units of what is allowed. */
static double error_of(const Work *w, const Step *s)
{
    const Contact *c = w->c;
    double of_load = 0, of_speed = 0;
    static const int ALONG[ALL_PORTS] = {1, 0, 0, 0, 1, 0, 0, 0, 0}; /* ports that feel the blow itself */
    for (int p = 0; p < PORTS + c->speeds; p++) {
        if (p >= c->cue->ports && p < PORTS) continue;
        double scale = c->forces == 2 && !ALONG[p] ? c->across : 1;
        for (int t = Q - 2; t < Q; t++) {
            double sum = 0;
            for (int j = 0; j < Q; j++) sum += rule.force_waves[t][j] * s->loads[p][j];
            of_load = larger(of_load, fabs(sum) / scale);
        }
    }
    for (int f = 0; f < c->forces; f++)
        for (int t = Q - 1; t <= Q; t++) {
            double sum = 0;
            for (int j = 0; j < WITH; j++) sum += rule.waves[t][j] * s->v[f][j];
            of_speed = larger(of_speed, fabs(sum) / (c->forces == 2 && !f ? c->across : 1));
        }
    return larger(of_load * s->step / c->impulse, of_speed / (10 * c->speed)) / c->tolerance;
}

/* Steps that are shorter by so many halvings feel what rounding left of a velocity that is held. */
enum { SETTLES = 8 };

/* The longest step that holds the tolerance; ENDED, or why there is none. */
static int longest_step(Work *w)
{
    Contact *c = w->c;
    int longest = clock_level(c), rough = c->patch == RINGED_PATCH;
    while (w->level < LEVELS) {
        c->tried++;
        if (w->level > longest + SETTLES && w->hold.press != FREE) w->law->settle(w);
        int found = solve_step(w, w->level, &w->step);
        double error = found ? error_of(w, &w->step) : HUGE_VAL;
        if (error <= 1 || (found && rough && w->level >= longest + 11)) {
            /* of a very short step rounding is most of the error */
            if ((error < 1e-5 || (error < 0.1 && w->level > longest + 12)) && w->level > longest) w->level--;
            return ENDED;
        }
        w->level += error > 1e5 ? 2 : 1;
    }
    return STUCK;
}

/* A row of the records: time, step, part, grip, press; F and v at the start and the nodes, compression and angle; loads on all
   ports at the nodes; and the blows on the ports before the step. */
static int record(Work *w, const Step *s, double part)
{
    Contact *c = w->c;
    if (!c->recording) return 1;
    int ports = PORTS + c->speeds;
    c->row = 5 + 2 * c->forces * WITH + 2 * WITH + ports * Q + ports;
    if ((c->record_count & (c->record_count - 1)) == 0) { /* room for twice as many at every power of two */
        size_t room = c->record_count ? 2 * (size_t)c->record_count : 64;
        if (c->record_count == 0 || c->record_count >= 64) {
            double *more = realloc(c->records, room * c->row * sizeof *more);
            if (!more) return 0;
            c->records = more;
        }
    }
    double *to = c->records + (size_t)c->record_count++ * c->row;
    *to++ = c->time, *to++ = s->step, *to++ = part, *to++ = w->hold.grip, *to++ = w->hold.press;
    for (int f = 0; f < c->forces; f++) memcpy(to, s->F[f], sizeof s->F[f]), to += WITH;
    for (int f = 0; f < c->forces; f++) memcpy(to, s->v[f], sizeof s->v[f]), to += WITH;
    memcpy(to, s->depth, sizeof s->depth), to += WITH;
    memcpy(to, s->angle, sizeof s->angle), to += WITH;
    memcpy(to, s->loads, ports * sizeof s->loads[0]), to += ports * Q;
    memcpy(to, w->blows, ports * sizeof *to);
    memset(w->blows, 0, sizeof w->blows);
    return 1;
}

/* Legendre's coefficients over a part of the step of the loads at its nodes. */
static void loads_over(const Step *s, int port, double part, double *waves)
{
    double whole[Q];
    for (int t = 0; t < Q; t++) {
        whole[t] = 0;
        for (int j = 0; j < Q; j++) whole[t] += rule.force_waves[t][j] * s->loads[port][j];
    }
    if (part == 1) {
        memcpy(waves, whole, sizeof whole);
        return;
    }
    memset(waves, 0, sizeof whole);
    for (int q = 0; q < POINTS; q++) {
        double value = legendre(whole, Q, part * rule.gauss[q]) * rule.weights[q];
        double x = 2 * rule.gauss[q] - 1, before = 0, here = 1;
        for (int t = 0; t < Q; t++) {
            waves[t] += (2 * t + 1) * value * here;
            double later = ((2 * t + 1) * x * here - t * before) / (t + 1);
            before = here, here = later;
        }
    }
}

/* Go to a part of a step. */
static int take(Work *w, const Step *s, double part)
{
    Contact *c = w->c;
    Cue *cue = c->cue;
    double span = part * s->step, waves[PORTS][Q];
    if (!record(w, s, part)) return NO_MEMORY;
    for (int d = 0; d < cue->reads - cue->ports; d++) {
        double of[WITH], sum = 0;
        to_waves(s->damped + d * WITH, of);
        for (int q = 0; q < POINTS; q++) {
            double speed = legendre(of, WITH, part * rule.gauss[q]);
            sum += rule.weights[q] * speed * speed;
        }
        *(d < c->lossy ? &c->damping_loss : &c->radiated) += span * sum;
    }
    w->law->taken(w, s, part);
    if (c->turns) c->angle = value_at(s->angle, part);
    for (int b = 0; b < c->speeds; b++) {
        double of_ball[Q];
        loads_over(s, PORTS + b, part, of_ball);
        c->ball[b] += span * c->ball_gives[b] * of_ball[0]; /* the first coefficient is the mean */
    }
    for (int p = 0; p < cue->ports; p++) loads_over(s, p, part, waves[p]);
    advance_modes(cue, c->xi, part == 1 ? response_of(cue, s->level) : NULL, span, waves);
    for (int f = 0; f < c->forces; f++)
        for (int i = 0; i < Q; i++) w->last_F[f][i] = s->F[f][i + 1];
    c->time += span, c->steps++;
    w->known = 1, w->last_part = part, w->last_step = s->step;
    if (c->curve == LEATHER_CURVE && c->depth > c->most) return TOO_DEEP;
    if (c->levers && fabs(c->angle) > c->lever_reach) return TURNED_TOO_FAR;
    return ENDED;
}

/* Write down a phase that ends now. */
void end_phase(Work *w, Hold hold, double start, const double *ball_before)
{
    Contact *c = w->c;
    int row = 4 + 2 * c->speeds;
    if (c->phase_count >= c->most_phases) return;
    if ((c->phase_count & (c->phase_count - 1)) == 0) {
        double *more = realloc(c->phases, (c->phase_count ? 2 * (size_t)c->phase_count : 1) * row * sizeof *more);
        if (!more) return;
        c->phases = more;
    }
    double *to = c->phases + (size_t)c->phase_count++ * row;
    to[0] = hold.grip, to[1] = hold.press, to[2] = start, to[3] = c->time;
    memcpy(to + 4, ball_before, c->speeds * sizeof *to), memcpy(to + 4 + c->speeds, c->ball, c->speeds * sizeof *to);
}

/* How a ringed patch goes on: sliding as a whole, one way or the other, or not. */
static int ringed_grip(const Work *w, const Step *s)
{
    const Contact *c = w->c;
    double F_n, slope;
    curve_at(c, virtual_depth(c, w->hold.press, c->depth), &F_n, &slope, NULL, NULL);
    if (c->friction == 0) return s->v[0][Q] == 0 ? STICK : s->v[0][Q] < 0 ? SLIP : SLIP_BACK;
    if (F_n < 1e-6 * c->impulse / c->clock) return w->hold.grip; /* as ball and tip part nothing tells */
    if (fabs(c->shear) < c->friction * F_n * (1 - 1e-9)) return STICK;
    return c->shear > 0 ? SLIP : SLIP_BACK;
}

/* March through one phase, up to a time at most; the event that ended it, or minus a status. */
static int follow(Work *w, double until)
{
    Contact *c = w->c;
    double start = c->time, before[SPEEDS];
    int fresh = 1;
    Guard ends[8];
    w->law->begin(w);
    memcpy(before, c->ball, sizeof before);
    for (;;) {
        if (w->hold.press == FREE ? c->time >= until : c->time > until) return w->hold.press == FREE ? LATE_FLIGHT : -LATE;
        if (c->steps > c->most_steps) return -CROWDED;
        int status = longest_step(w), event = NONE;
        if (status) return -status;
        double first = 1, apart = 2;
        int guards = w->law->guards(w, &w->step, ends);
        for (int i = 0; i < guards; i++) {
            double at = first_fall(ends[i].values, ends[i].past);
            if (at < first || (at == first && !event)) first = at, event = ends[i].event;
            if (ends[i].event == APART) apart = at;
        }
        int nearer = clock_level(c) + 14;
        if (c->forces > 2 && event && event != APART && apart <= 1 && w->step.level < nearer) {
            w->level = w->step.level + 1; /* past the parting friction's bound is no polynomial: come nearer first */
            continue;
        }
        if (event && event != APART && w->hold.press == UNLOAD) { /* where all forces vanish the other ends mean nothing */
            double left = value_at(w->step.depth, first) - rest_of(c);
            int leaves = value_at(w->step.v[1], first) > 0;
            if (leaves && left < (w->linear ? 1e-11 : c->forces == 2 ? 1e-7 : 1e-5) * c->deepest)
                first = apart <= 1 ? apart : first, event = APART;
        }
        if (first > 0) {
            double here = c->time, ball[SPEEDS];
            memcpy(ball, c->ball, sizeof ball);
            status = take(w, &w->step, first);
            if (c->patch == RINGED_PATCH && w->hold.press != FREE) {
                int grip = ringed_grip(w, &w->step);
                if (fresh) w->hold.grip = grip;
                else if (grip != w->hold.grip) { /* the phase of the other grip ended where this step began */
                    double now = c->time, gone[SPEEDS];
                    memcpy(gone, c->ball, sizeof gone), memcpy(c->ball, ball, sizeof ball), c->time = here;
                    end_phase(w, w->hold, start, before);
                    memcpy(c->ball, gone, sizeof gone), c->time = now;
                    memcpy(before, ball, sizeof before), start = here, w->hold.grip = grip;
                }
                fresh = 0;
            }
        }
        if (status) return -status;
        if (event == TURNED) {
            w->grows = !w->grows;
            continue;
        }
        if (event) {
            if (c->time > start) end_phase(w, w->hold, start, before);
            return event;
        }
    }
}

/* One touch, from a press on; whether ball and tip parted. */
static int touch(Work *w, int press, double until)
{
    Contact *c = w->c;
    int goes_on = w->law->first_grip(w, press);
    w->hold.grip = c->grip, w->hold.press = press;
    for (int events = 0; goes_on; events++) {
        if (c->phase_count + 1 >= c->most_phases || events >= c->most_phases) c->status = CROWDED;
        else {
            int event = follow(w, until);
            if (event < 0) c->status = -event;
            else goes_on = w->law->next(w, event);
        }
        c->grip = w->hold.grip, c->press = w->hold.press;
        if (c->status) return 0;
    }
    return 1;
}

/* The first step: where a force grows from nothing with a root of the compression, a very short one. */
static int first_level(const Contact *c)
{
    int smooth = c->curve == POWER_CURVE && c->exponent == 1;
    int halvings = smooth ? 2 : c->patch == SPRING_PATCH ? 30 : 12;
    return clock_level(c) + halvings;
}

/* Ball and tip apart: whether they touch again by a time. What the patch held is lost. */
static int fly(Work *w, double until)
{
    Contact *c = w->c;
    Contact before = *c;
    size_t modes = 2 * c->cue->modes * sizeof *c->xi;
    double *xi = malloc(modes + 1), ball[SPEEDS];
    if (!xi) return 0;
    memcpy(xi, c->xi, modes), memcpy(ball, c->ball, sizeof ball);
    w->hold = (Hold){APART_GRIP, FREE, HELD}, w->known = 0;
    w->level = 1 + clock_level(c);
    int event = follow(w, until);
    int touched = event == TOUCHED && c->time <= until;
    if (!touched) { /* the flight is not part of the contact */
        c->time = before.time, c->depth = before.depth, c->angle = before.angle;
        c->damping_loss = before.damping_loss, c->radiated = before.radiated;
        c->record_count = before.record_count, c->phase_count = before.phase_count;
        memcpy(c->xi, xi, modes), memcpy(c->ball, ball, sizeof ball);
        if (event < 0) c->status = -event;
    } else {
        c->depth = rest_of(c);
        w->level = first_level(c);
        w->grows = 1, w->known = 0;
    }
    free(xi);
    return touched;
}

EXPORTED void contact_free(Contact *c)
{
    free(c->phases), free(c->records);
    c->phases = c->records = NULL;
}

/* The whole contact, and what comes after it within its window. */
EXPORTED void contact_run(Contact *c)
{
    Work *w = calloc(1, sizeof *w);
    if (!w) {
        c->status = NO_MEMORY;
        return;
    }
    w->c = c, w->law = c->forces == 2 ? &planar : &raised;
    w->linear = !c->turns && c->curve == POWER_CURVE && c->exponent == 1 && c->forces == 2;
    w->grows = 1;
    w->level = first_level(c);
    int dampers = c->cue->reads - c->cue->ports;
    w->step.damped = malloc((dampers + 1) * WITH * sizeof(double));
    double start = c->time, longest = c->longest;
    facing_at(c, c->angle, w->C[0]);
    if (!w->step.damped) c->status = NO_MEMORY;
    int parted = !c->status && touch(w, LOAD, longest);
    double until = c->time + c->window;
    while (parted && c->window > 0 && c->time < until && fly(w, until)) {
        longest += c->time - start, start = c->time;
        parted = touch(w, UNLOAD, longest);
    }
    w->hold.press = FREE;
    if (!c->status && c->forces == 2) w->law->begin(w); /* what the patch still holds is lost */
    for (int i = 0; i < LEVELS; i++) {
        free(w->V[i]);
        for (int j = 0; j < 16; j++) free(w->factors[i][j]);
    }
    free(w->step.damped), free(w);
}
