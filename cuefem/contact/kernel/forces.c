/* The forces of a step: force-indentation law at mid-step, friction as a return mapping. */
#include "contact.h"

enum { ROUNDS = 40, SWEEPS = 1000, HALVINGS = 60 };
static const double CLOSE = 1e-12,
                    NEAR = 1e-7; /* relative change of the forces at convergence; largest accepted */

/* C at mid-step; with it the contact's velocities without forces at the end (v) and on average over the step
   (u), and their change per force (V, W). rest: mean velocity of a sticking point: 0, or half of the initial
   velocity where it slipped before and comes to rest. */
void contact_matrices(Work *w)
{
    const Contact *c = w->c;
    const int Q = c->ports + c->slopes, n = c->forces, B = c->speeds;
    const double h = w->t.h;
    double bent[SLOPES], end[FORCES][READS], mean[FORCES][READS];
    for (int a = 0; a < c->slopes; a++) bent[a] = w->slopes[a] + h / 2 * w->rates[c->ports + a];
    contact_kinematics(w, c->angle + h / 2 * w->rolling_rate, bent, w->C);
    for (int f = 0; f < n; f++) {
        const double *C = w->C[f];
        w->v[f] = w->u[f] = 0;
        for (int b = 0; b < B; b++) w->v[f] += C[Q + b] * w->ball[b];
        w->u[f] = w->v[f], w->rest[f] = w->v[f] / 2;
        for (int q = 0; q < Q; q++) {
            w->v[f] += C[q] * w->end_free[q], w->u[f] += C[q] * w->mean_free[q];
            w->rest[f] += C[q] * w->rates[q] / 2;
        }
        if (f == UP ? w->up_held : f > UP ? w->table_held : w->held) w->rest[f] = 0;
        for (int q = 0; q < Q; q++) {
            end[f][q] = mean[f][q] = 0;
            for (int p = 0; p < Q; p++)
                end[f][q] += C[p] * w->t.end[p][q], mean[f][q] += C[p] * w->t.mean[p][q];
        }
    }
    for (int f = 0; f < n; f++)
        for (int g = 0; g < n; g++) {
            double ball = 0, ends = 0, means = 0;
            for (int b = 0; b < B; b++) ball += h * w->C[f][Q + b] * c->inverse_masses[b] * w->C[g][Q + b];
            for (int q = 0; q < Q; q++) ends += end[f][q] * w->C[g][q], means += mean[f][q] * w->C[g][q];
            w->V[f][g] = ends + ball, w->W[f][g] = means + ball / 2;
        }
}

/* Velocities of the contact at the end of the step and on average over it, under the forces F. */
void velocities(const Work *w, double *end, double *mean)
{
    for (int f = 0; f < w->c->forces; f++) {
        end[f] = w->v[f], mean[f] = w->u[f];
        for (int g = 0; g < w->c->forces; g++)
            end[f] += w->V[f][g] * w->F[g], mean[f] += w->W[f][g] * w->F[g];
    }
}

/* Newton's method for (F_t, F_n); side: direction of slip, or STICK. Returns whether it converged. */
static int newton(Work *w, int side)
{
    const Contact *c = w->c;
    const double half = w->t.h / 2;
    double v[FORCES], u[FORCES], off = 0, size = 0;
    for (int round = 0; round < ROUNDS; round++) {
        double slope, stuck, slid, g[2], J[2][2];
        velocities(w, v, u);
        double force = tip_force(c, w->phase, c->depth - half * u[N], &slope, &w->virtual_now),
               shift = w->shift - half * u[T];
        g[N] = w->F[N] - force, J[N][T] = slope * half * w->W[N][T], J[N][N] = 1 + slope * half * w->W[N][N];
        if (c->patch == PARTIAL_SLIP) {
            g[T] = w->F[T] - shift_annuli(w, w->virtual_now, shift - w->shift_mid, &stuck, &slid);
            slid /= w->virtual_now < c->max_depth ? unloading_scale(c, w->phase) : 1;
            for (int f = 0; f < 2; f++) J[T][f] = (f == T) + half * (stuck * w->W[T][f] + slid * w->W[N][f]);
        } else if (side)
            g[T] = w->F[T] - side * c->friction * w->F[N], J[T][T] = 1, J[T][N] = -side * c->friction;
        else if (c->patch == SPRING_PATCH) {
            g[T] = w->F[T] - (shift - w->origin) / c->compliance;
            for (int f = 0; f < 2; f++) J[T][f] = (f == T) + half * w->W[T][f] / c->compliance;
        } else {
            g[T] = u[T] - w->rest[T];
            for (int f = 0; f < 2; f++) J[T][f] = w->W[T][f];
        }
        double det = J[0][0] * J[1][1] - J[0][1] * J[1][0];
        double by[2] = {(J[1][1] * g[0] - J[0][1] * g[1]) / det, (J[0][0] * g[1] - J[1][0] * g[0]) / det};
        w->F[0] -= by[0], w->F[1] -= by[1];
        off = fabs(by[0]) + fabs(by[1]), size = fabs(w->F[0]) + fabs(w->F[1]) + 1e-9;
        if (off <= CLOSE * size) return 1;
    }
    return off <= NEAR * size;
}

/* Level cue: trial stick, and slip where the trial exceeds mu F_n. */
int level_forces(Work *w)
{
    const Contact *c = w->c;
    w->side = c->friction == 0 && c->patch != PARTIAL_SLIP ? SLIP : STICK;
    if (!newton(w, w->side)) return 0;
    if (c->patch == PARTIAL_SLIP || w->side ||
        fabs(w->F[T]) <= c->friction * larger(w->F[N], 0) * (1 + CLOSE))
        return 1;
    w->side = w->F[T] > 0 ? SLIP : SLIP_BACK;
    return newton(w, w->side);
}

/* Friction in the plane of two forces a and b, |F| <= bound: whether the point sticks. A slipping force
   opposes the mean velocity, found by projected-gradient steps on the disc of the bound. */
static int plane_friction(Work *w, int a, int b, double bound)
{
    const double (*W)[FORCES] = w->W;
    double *F = w->F, u[2] = {w->u[a], w->u[b]}, det = W[a][a] * W[b][b] - W[a][b] * W[b][a];
    for (int f = 0; f < w->c->forces; f++) u[0] += W[a][f] * F[f], u[1] += W[b][f] * F[f];
    double x = u[0] - w->rest[a], y = u[1] - w->rest[b];
    double p = F[a] - (W[b][b] * x - W[a][b] * y) / det, q = F[b] - (W[a][a] * y - W[b][a] * x) / det;
    double size = hypot(p, q), rho = 1 / larger(W[a][a], W[b][b]);
    int sticks = size <= bound * (1 + CLOSE);
    if (!sticks) p *= bound / size, q *= bound / size;
    for (int i = 0; i < ROUNDS && !sticks; i++) {
        double to_p = p - rho * (u[0] + W[a][a] * (p - F[a]) + W[a][b] * (q - F[b]));
        double to_q = q - rho * (u[1] + W[b][a] * (p - F[a]) + W[b][b] * (q - F[b])),
               reach = hypot(to_p, to_q), off;
        if (reach > bound) to_p *= bound / reach, to_q *= bound / reach;
        off = fabs(to_p - p) + fabs(to_q - q), p = to_p, q = to_q;
        if (off < CLOSE * bound) break;
    }
    F[a] = p, F[b] = q;
    return sticks;
}

/* Raised cue over a table that never pulls: block Gauss-Seidel over the contact points until the forces
   converge; or the impulses of its impact, which stops the tip along the ball and the ball into the table.
   bound: of the tip's friction; mu F_n where it is negative. */
static int solve_in_turns(Work *w, int strikes, double bound)
{
    const Contact *c = w->c;
    double *F = w->F, half = w->t.h / 2, off = 1, size = 1;
    int sticks = 0, rests = 0;
    for (int sweep = 0; sweep < SWEEPS && off > 1e-11 * size; sweep++) {
        double before[FORCES];
        memcpy(before, F, sizeof before);
        for (int i = 0; i < ROUNDS && !strikes; i++) {
            double u = w->u[N], slope, unused;
            for (int f = 0; f < FORCES; f++) u += w->W[N][f] * F[f];
            double by = (F[N] - tip_force(c, w->phase, c->depth - half * u, &slope, &unused)) /
                        (1 + slope * half * w->W[N][N]);
            F[N] -= by;
            if (fabs(by) <= CLOSE * fabs(F[N])) break;
        }
        sticks = plane_friction(w, T, P, bound < 0 ? c->friction * larger(F[N], 0) : bound);
        double u = w->u[UP] - w->W[UP][UP] * F[UP]; /* without the table */
        for (int f = 0; f < FORCES; f++) u += w->W[UP][f] * F[f];
        F[UP] = c->height > 0 && c->height + w->t.h * u > 0 ? 0 : larger(0, (w->rest[UP] - u) / w->W[UP][UP]);
        rests = plane_friction(w, LATERAL, FORWARD, c->table_friction * F[UP]);
        off = 0, size = 1e-9;
        for (int f = 0; f < FORCES; f++)
            off = larger(off, fabs(F[f] - before[f])), size = larger(size, fabs(F[f]));
    }
    w->side = sticks ? STICK : SLIP, w->up_held = F[UP] > 0, w->table_held = rests && F[UP] > 0;
    return off <= NEAR * size;
}

/* Raised cue. Strong friction may hold so much that F_n vanishes, and with it mu F_n: the iteration then
   alternates. The bound mu F_n lies between 0 and the force of full stick, and is found by bisection. */
int raised_forces(Work *w)
{
    if (solve_in_turns(w, 0, -1)) return 1;
    int solved = solve_in_turns(w, 0, HUGE_VAL);
    double low = 0, high = hypot(w->F[T], w->F[P]);
    for (int i = 0; i < HALVINGS && solved; i++) {
        double bound = (low + high) / 2;
        solved = solve_in_turns(w, 0, bound);
        if (w->c->friction * w->F[N] > bound)
            low = bound;
        else
            high = bound;
    }
    return solved;
}

/* Impact of infinite friction at the first touch: an impulse stops the tip's velocity along the ball, and the
   ball's into the table, where it rubs. Returns whether they stay in contact; if the impulse alone separates
   them, it ends at e times their approach velocity. */
int impact(Work *w, Step *row)
{
    Contact *c = w->c;
    const int Q = c->ports + c->slopes, wide = Q + c->speeds;
    double loads[WIDE] = {0}, *F = w->F;
    contact_kinematics(w, c->angle, w->slopes, w->C);
    for (int f = 0; f < c->forces; f++) {
        w->v[f] = w->rest[f] = 0;
        for (int p = 0; p < wide; p++) w->v[f] += w->C[f][p] * (p < Q ? w->rates[p] : w->ball[p - Q]);
        for (int g = 0; g < c->forces; g++) {
            double sum = 0;
            for (int b = 0; b < c->speeds; b++) sum += w->C[f][Q + b] * c->inverse_masses[b] * w->C[g][Q + b];
            for (int p = 0; p < Q; p++)
                for (int q = 0; q < Q; q++) sum += w->C[f][p] * mobility(w, p, q) * w->C[g][q];
            w->V[f][g] = w->W[f][g] = sum;
        }
        w->u[f] = w->v[f];
    }
    if (c->forces == 2)
        F[T] = -w->v[T] / w->V[T][T];
    else if (!solve_in_turns(w, 1, HUGE_VAL))
        c->status = UNSOLVED;
    double turned = 0, unused[FORCES];
    for (int f = 0; f < c->forces; f++) turned += w->V[N][f] * F[f];
    int parts = w->v[N] + turned > 0;
    for (int f = 0; f < c->forces && parts; f++)
        F[f] *= fmin(1, (1 + c->restitution) * fabs(w->v[N] / turned));
    velocities(w, row->v, unused);
    for (int f = 0; f < c->forces; f++) {
        c->work[f] -= F[f] * (w->v[f] + row->v[f]) / 2;
        for (int p = 0; p < wide; p++) loads[p] += w->C[f][p] * F[f];
    }
    memcpy(row->F, F, sizeof row->F), memset(F, 0, sizeof w->F);
    apply_impulses(w, loads);
    for (int b = 0; b < c->speeds; b++) w->ball[b] += c->inverse_masses[b] * loads[Q + b];
    w->held = w->up_held = 1;
    return !parts;
}
