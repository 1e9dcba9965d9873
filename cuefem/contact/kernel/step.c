/* One step: what its forces make of cue and ball, the forces that the law asks for by Newton's method, and its length. */
#include "contact.h"

/* The level of a step that is about as long as the contact's clock. */
int clock_level(const Contact *c)
{
    return LONGEST_POWER - (int)floor(log2(c->clock));
}

/* What the cue's rows read at the start and the nodes if nothing loads it: its own motion. */
FAST static void own_motion(const Contact *c, const Response *r, double (*own)[WITH])
{
    const Cue *cue = c->cue;
    for (int a = 0; a < cue->reads; a++) {
        const double *row = cue->readings + 2 * a * cue->modes, *x = c->xi;
        double now = 0, later[Q] = {0};
        for (int k = 0; k < cue->modes; k++, row += 2, x += 2) {
            const double *turn = r->turns + 2 * Q * k;
            double re = row[0] * x[0] - row[1] * x[1], im = row[0] * x[1] + row[1] * x[0];
            now += re;
            for (int i = 0; i < Q; i++) later[i] += turn[i] * re - turn[Q + i] * im;
        }
        own[a][0] = now, memcpy(own[a] + 1, later, sizeof later);
    }
}

/* What the cue's rows from the first to the last read once loads act; without any, loads is NULL. */
FAST static void loaded(const Cue *cue, const Response *r, const double (*own)[WITH], const double (*loads)[Q],
                        int first, int last, double (*y)[WITH])
{
    for (int a = first; a < last; a++) {
        memcpy(y[a - first], own[a], sizeof own[a]);
        if (loads) add_product(cue->ports * Q, r->answer + a * cue->ports * Q * Q, *loads, 1, y[a - first] + 1);
    }
}

/* The contact's own answer V: from its forces at the nodes to its velocities there, and behind it to their integrals. */
FAST static void answer_of(const Work *w, const Response *r, double *V)
{
    const Contact *c = w->c;
    int n = c->forces, ports = c->cue->ports;
    const double *sums_of_ball = rule.force_sums[0];
    memset(V, 0, 2 * n * n * Q * Q * sizeof *V);
    for (int f = 0; f < n; f++)
        for (int g = 0; g < n; g++) {
            double *to = V + (f * n + g) * Q * Q, *sum = to + n * n * Q * Q, ball = 0;
            for (int a = 0; a < ports; a++)
                for (int b = 0; b < ports; b++) {
                    const double *from = r->answer + (a * ports + b) * Q * Q;
                    double by = w->C[0][f][a] * w->C[0][g][b];
                    for (int i = 0; by != 0 && i < Q * Q; i++) to[i] += by * from[i];
                }
            for (int b = 0; b < c->speeds; b++)
                ball += w->C[0][f][PORTS + b] * c->ball_gives[b] * w->C[0][g][PORTS + b];
            for (int i = 0; i < Q * Q; i++) to[i] += ball * r->step * sums_of_ball[i];
            for (int j = 0; j < Q; j++) add_product(Q, rule.sums[1], to + j * Q, r->step, sum + j * Q);
        }
}

/* J = on_F + on_v V + on_x (integrals of V). */
FAST static void jacobian(int n, const Residual *r, const double *V, double *J)
{
    int wide = n * Q;
    const double *sums = V + n * n * Q * Q;
    memset(J, 0, wide * wide * sizeof *J);
    for (int f = 0; f < n; f++)
        for (int g = 0; g < n; g++) {
            const double *by_F = r->on_F[f][g], *by_v = r->on_v[f][g], *by_x = r->on_x[f][g];
            int moves = 0;
            for (int i = 0; i < Q; i++) J[(g * Q + i) * wide + f * Q + i] += by_F[i], moves |= by_v[i] != 0 || by_x[i] != 0;
            for (int b = 0; moves && b < n; b++)
                for (int j = 0; j < Q; j++) {
                    double *to = J + (b * Q + j) * wide + f * Q;
                    const double *v = V + ((g * n + b) * Q + j) * Q, *x = sums + ((g * n + b) * Q + j) * Q;
                    for (int i = 0; i < Q; i++) to[i] += by_v[i] * v[i] + by_x[i] * x[i];
                }
        }
}

/* What was known at the nodes of the step before, gone on with at the nodes of one of another length: past its end with
   its first terms alone, which do not run away. */
static void go_on(const Work *w, const double *nodes, double step, double *to)
{
    double waves[Q] = {0};
    int inside = w->last_part < 1;
    add_product(Q, rule.force_waves[0], nodes, 1, waves);
    for (int i = 0; i < Q; i++) {
        double at = w->last_part + rule.nodes[i] * step / w->last_step;
        to[i] = legendre(waves, inside ? Q : 5, fmin(at, inside ? 1 : 3));
    }
}

/* What moves in a step with these forces: loads, velocities, their integrals, the compression and the angle; by how
   much the angle changed. Without forces F is NULL. */
FAST static double move(Work *w, const Response *r, const double (*own)[WITH], const double (*F)[Q], Step *s)
{
    const Contact *c = w->c;
    int n = c->forces, ports = c->cue->ports, all = PORTS + c->speeds, turns = c->turns;
    int slopes = c->cue->slopes;
    double of_cue[PORTS + SLOPES][WITH], y[ALL_PORTS][WITH], changed = 0;
    for (int p = 0; p < all; p = p == ports - 1 ? PORTS : p + 1) {
        memset(s->loads[p], 0, sizeof s->loads[p]);
        for (int f = 0; f < n && F; f++)
            for (int i = 0; i < Q; i++) s->loads[p][i] += w->C[turns ? i + 1 : 0][f][p] * F[f][i];
    }
    loaded(c->cue, r, own, F ? (const double(*)[Q])s->loads : NULL, 0, ports + slopes, of_cue);
    if (slopes) changed = bend_step(c, r, s, of_cue);
    memcpy(y, of_cue, ports * sizeof *y);
    for (int b = 0; b < c->speeds; b++) {
        for (int i = 0; i < WITH; i++) y[PORTS + b][i] = c->ball[b];
        if (F) add_product(Q, rule.force_sums[0], s->loads[PORTS + b], r->step * c->ball_gives[b], y[PORTS + b] + 1);
    }
    for (int f = 0; f < n; f++) {
        memset(s->v[f], 0, sizeof s->v[f]), memset(s->x[f], 0, sizeof s->x[f]);
        for (int p = 0; p < all; p = p == ports - 1 ? PORTS : p + 1)
            for (int i = 0; i < WITH; i++) s->v[f][i] += w->C[turns ? i : 0][f][p] * y[p][i];
        add_product(WITH, rule.sums[0], s->v[f], r->step, s->x[f] + 1);
    }
    for (int i = 0; i < WITH; i++) s->depth[i] = c->depth - s->x[1][i];
    if (!turns) return changed;
    double rate[WITH], angle[WITH];
    for (int i = 0; i < WITH; i++) {
        double dome = rolls_on(c, s->angle[i]);
        rate[i] = -(s->v[0][i] - y[PORTS + 2][i] - (ports > 2 ? dome * y[2][i] : 0)) / (c->radius + dome);
        angle[i] = c->angle;
    }
    add_product(WITH, rule.sums[0], rate, r->step, angle + 1);
    for (int i = 1; i < WITH; i++) {
        changed = larger(changed, fabs(angle[i] - s->angle[i]));
        s->angle[i] = angle[i];
        facing_at(c, s->angle[i], w->C[i]);
    }
    return changed;
}

/* Solve a step of 2^(LONGEST_POWER - level) s in the hold of w; 0 if Newton's method does not settle. */
int solve_step(Work *w, int level, Step *s)
{
    Contact *c = w->c;
    Response *r = response_of(c->cue, level);
    int n = c->forces, wide = n * Q, dampers = dampers_of(c->cue);
    if (!r) return 0;
    double size = c->impulse / c->clock, F[FORCES][Q], left = HUGE_VAL, own[c->cue->reads][WITH];
    Factor mine, *by = &mine;
    s->level = level, s->step = r->step;
    own_motion(c, r, own);
    memset(F, 0, sizeof F);
    for (int f = 0; f < n && w->known && !w->linear; f++) go_on(w, w->last_F[f], r->step, F[f]);
    for (int i = 0; i < WITH; i++) s->angle[i] = c->angle;
    if (c->turns && w->known) go_on(w, w->last_angle, r->step, s->angle + 1);
    begin_slopes(c, s);
    facing_at(c, c->angle, w->C[0]);
    for (int i = 1; i < WITH && c->turns; i++) facing_at(c, s->angle[i], w->C[i]);
    int settled = 0, slow = 0;
    double last = HUGE_VAL;
    for (int round = 0; round < 30; round++) {
        c->rounds++;
        int pushed = round || !w->linear; /* what is linear begins without forces */
        double turned = move(w, r, (const double(*)[WITH])own, pushed ? (const double(*)[Q])F : NULL, s);
        for (int f = 0; f < n; f++) {
            memcpy(s->F[f] + 1, F[f], sizeof F[f]), s->F[f][0] = 0;
            for (int j = 0; j < Q; j++) s->F[f][0] += rule.first[j] * F[f][j];
        }
        settled = w->hold.press == FREE ? turned < 1e-14 : round && (w->linear || left < 0.01 * c->tolerance);
        if (settled) break;
        if (w->hold.press == FREE) continue;
        w->law->residual(w, s, &w->residual);
        int known = w->linear && w->factors[level][w->hold.grip + 1 + 3 * w->hold.press] != NULL;
        if (known) by = w->factors[level][w->hold.grip + 1 + 3 * w->hold.press];
        else if (round == 0 || slow) { /* the matrix of a round before does as long as it brings the forces nearer */
            /* V from where the contact used this step before: turned on a little it still leads there */
            int stale = !w->V[level] || (c->turns && (slow || fabs(c->angle - w->V_angle[level]) > 0.02));
            if (!w->V[level] && !(w->V[level] = malloc(2 * n * n * Q * Q * sizeof(double)))) break;
            if (stale) answer_of(w, r, w->V[level]), w->V_angle[level] = c->angle;
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
        double rate = round ? off / last : 1;
        slow = rate > 0.1 && round, last = off;
        left = (off < 1e-9 || off * r->step < 1e-13 * c->clock) && off > 0.5 * left ? 0 : off; /* rounding is left */
        /* with one matrix each round leaves about this part of the one before; kinks make more of a step's error */
        if (c->patch == RINGED_PATCH && rate < 0.5) left *= 2 * rate;
    }
    if (c->depth == 0 && c->time == 0) /* the first touch has no force yet */
        for (int f = 0; f < n; f++) s->F[f][0] = 0;
    if (settled && dampers) {
        int first = c->cue->reads - dampers;
        double(*damped)[WITH] = (double(*)[WITH])s->damped;
        loaded(c->cue, r, (const double(*)[WITH])own, (const double(*)[Q])s->loads, first, c->cue->reads, damped);
        if (c->cue->slopes) add_bending(c, r, s, first, c->cue->reads, damped);
    }
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
        if (ALONG[p] && c->patch == RINGED_PATCH) scale = 0.1; /* no kinks, and most of the energy */
        for (int t = Q - 2; t < Q; t++) {
            double sum = 0;
            for (int j = 0; j < Q; j++) sum += rule.force_waves[j][t] * s->loads[p][j];
            of_load = larger(of_load, fabs(sum) / scale);
        }
    }
    for (int f = 0; f < c->forces; f++)
        for (int t = Q - 1; t <= Q; t++) {
            double sum = 0;
            for (int j = 0; j < WITH; j++) sum += rule.waves[j][t] * s->v[f][j];
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
            /* twice the step makes 16,000 times the error; of a very short step rounding is most of it */
            if ((error < (rough ? 1e-5 : 5e-5) || (error < 0.1 && w->level > longest + 12)) && w->level > longest) w->level--;
            return ENDED;
        }
        w->level += error > 1e5 ? 2 : 1;
    }
    return STUCK;
}
