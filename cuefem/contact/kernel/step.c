/* One step: what its forces make of cue and ball, the forces that the law asks for by Newton's method, and its length. */
#include "contact.h"

/* The level of a step that is about as long as the contact's clock. */
int clock_level(const Contact *c)
{
    return LONGEST_POWER - (int)floor(log2(c->clock));
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
    Factor mine, *by = &mine;
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
int longest_step(Work *w)
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
