/* The forces of a step: force-indentation law at mid-step, friction as a return mapping. */
#include "contact.h"

enum { MAX_ITERATIONS = 40, MAX_SWEEPS = 1000, MAX_BISECTIONS = 60 };
/* Relative change of the forces per iteration. Gauss-Seidel sweeps converge slowly and need a wider one. */
static const double REL_TOL = 1e-12, REL_TOL_SWEEPS = 1e-11; /* at convergence */
static const double REL_TOL_ACCEPTED = 1e-7;                 /* largest accepted after the last iteration */
static const double MIN_FORCE = 1e-9;                        /* N, least scale of the relative change */

/* C at mid-step; with it the contact's velocities without forces at the end of the step (v) and on average
   over it (u), m/s, and their change per force (V, W), (m/s)/N; in impact() per impulse, 1/kg. u_stick: mean
   velocity of a sticking point, m/s: 0, or half of the initial velocity where it slipped before and comes to
   rest. Handbook: The contact, Ports and the matrix C: v = C y, loads = C' F. */
void contact_matrices(Work *w)
{
    const Contact *c = w->c;
    const int n_cue = c->ports + c->slopes, n = c->forces, n_ball = c->speeds;
    const double h = w->t.h;
    double bent[SLOPES], end[FORCES][CUE_VELOCITIES], mean[FORCES][CUE_VELOCITIES];
    for (int a = 0; a < c->slopes; a++) bent[a] = w->slopes[a] + h / 2 * w->port_velocities[c->ports + a];
    contact_kinematics(w, c->angle + h / 2 * w->rolling_rate, bent, w->C);
    for (int f = 0; f < n; f++) {
        const double *C = w->C[f];
        w->v[f] = w->u[f] = 0;
        for (int b = 0; b < n_ball; b++) w->v[f] += C[n_cue + b] * w->ball[b];
        w->u[f] = w->v[f], w->u_stick[f] = w->v[f] / 2;
        for (int q = 0; q < n_cue; q++) {
            w->v[f] += C[q] * w->end_free[q], w->u[f] += C[q] * w->mean_free[q];
            w->u_stick[f] += C[q] * w->port_velocities[q] / 2;
        }
        if (f == UP ? w->on_table : f > UP ? w->table_stuck : w->tip_stuck) w->u_stick[f] = 0;
        for (int q = 0; q < n_cue; q++) {
            end[f][q] = mean[f][q] = 0;
            for (int p = 0; p < n_cue; p++)
                end[f][q] += C[p] * w->t.end_per_load[p * n_cue + q],
                    mean[f][q] += C[p] * w->t.mean_per_load[p * n_cue + q];
        }
    }
    for (int f = 0; f < n; f++)
        for (int g = 0; g < n; g++) {
            double ball = 0, ends = 0, means = 0;
            for (int b = 0; b < n_ball; b++)
                ball += h * w->C[f][n_cue + b] * c->inverse_masses[b] * w->C[g][n_cue + b];
            for (int q = 0; q < n_cue; q++) ends += end[f][q] * w->C[g][q], means += mean[f][q] * w->C[g][q];
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

/* Newton's method for (F_t, F_n); slip: its direction, or STICK; unused with PARTIAL_SLIP, whose annuli slip
   one by one. Returns whether it converged. Handbook: The contact: F_n = law(d - h v_n/2), return mapping. */
static int newton(Work *w, int slip)
{
    const Contact *c = w->c;
    const double half = w->t.h / 2;
    double v[FORCES], u[FORCES], change = 0, scale = 0;
    for (int i = 0; i < MAX_ITERATIONS; i++) {
        double slope, by_shift, by_virtual, g[2], J[2][2];
        velocities(w, v, u);
        double force = tip_force(c, w->phase, c->indentation - half * u[N], &slope, &w->virtual_now),
               shift = w->shift - half * u[T];
        g[N] = w->F[N] - force, J[N][T] = slope * half * w->W[N][T], J[N][N] = 1 + slope * half * w->W[N][N];
        if (c->patch == PARTIAL_SLIP) {
            g[T] = w->F[T] - shift_annuli(w, w->virtual_now, shift - w->shift_mid, &by_shift, &by_virtual);
            by_virtual /= w->virtual_now < c->max_indentation ? unloading_scale(c, w->phase) : 1;
            for (int f = 0; f < 2; f++)
                J[T][f] = (f == T) + half * (by_shift * w->W[T][f] + by_virtual * w->W[N][f]);
        } else if (slip)
            g[T] = w->F[T] - slip * c->friction * w->F[N], J[T][T] = 1, J[T][N] = -slip * c->friction;
        else if (c->patch == SPRING_PATCH) {
            g[T] = w->F[T] - (shift - w->origin) / c->compliance;
            for (int f = 0; f < 2; f++) J[T][f] = (f == T) + half * w->W[T][f] / c->compliance;
        } else {
            g[T] = u[T] - w->u_stick[T];
            for (int f = 0; f < 2; f++) J[T][f] = w->W[T][f];
        }
        double det = J[0][0] * J[1][1] - J[0][1] * J[1][0];
        double correction[2] = {(J[1][1] * g[0] - J[0][1] * g[1]) / det,
                                (J[0][0] * g[1] - J[1][0] * g[0]) / det};
        w->F[0] -= correction[0], w->F[1] -= correction[1];
        change = fabs(correction[0]) + fabs(correction[1]);
        scale = fabs(w->F[0]) + fabs(w->F[1]) + MIN_FORCE;
        if (change <= REL_TOL * scale) return 1;
    }
    return change <= REL_TOL_ACCEPTED * scale;
}

/* Forces of a level cue: trial stick, and slip if |F_t| of the trial exceeds mu F_n. Returns whether they
   converged. */
int level_forces(Work *w)
{
    const Contact *c = w->c;
    w->slip = c->friction == 0 && c->patch != PARTIAL_SLIP ? SLIP : STICK;
    if (!newton(w, w->slip)) return 0;
    if (c->patch == PARTIAL_SLIP || w->slip ||
        fabs(w->F[T]) <= c->friction * larger(w->F[N], 0) * (1 + REL_TOL))
        return 1;
    w->slip = w->F[T] > 0 ? SLIP : SLIP_BACK;
    return newton(w, w->slip);
}

/* Solve F[a], F[b] in place, hypot(F[a], F[b]) <= bound; return 1 if the point sticks. The friction force of
   a slipping point opposes its mean velocity; it is found by projected-gradient steps on the disc of the
   bound. */
static int plane_friction(Work *w, int a, int b, double bound)
{
    const double (*W)[FORCES] = w->W;
    double *F = w->F, u[2] = {w->u[a], w->u[b]}, det = W[a][a] * W[b][b] - W[a][b] * W[b][a];
    for (int f = 0; f < w->c->forces; f++) u[0] += W[a][f] * F[f], u[1] += W[b][f] * F[f];
    double x = u[0] - w->u_stick[a], y = u[1] - w->u_stick[b];
    double p = F[a] - (W[b][b] * x - W[a][b] * y) / det, q = F[b] - (W[a][a] * y - W[b][a] * x) / det;
    double stick = hypot(p, q), rho = 1 / larger(W[a][a], W[b][b]);
    int sticks = stick <= bound * (1 + REL_TOL);
    if (!sticks) p *= bound / stick, q *= bound / stick;
    for (int i = 0; i < MAX_ITERATIONS && !sticks; i++) {
        double to_p = p - rho * (u[0] + W[a][a] * (p - F[a]) + W[a][b] * (q - F[b]));
        double to_q = q - rho * (u[1] + W[b][a] * (p - F[a]) + W[b][b] * (q - F[b])),
               next = hypot(to_p, to_q), change;
        if (next > bound) to_p *= bound / next, to_q *= bound / next;
        change = fabs(to_p - p) + fabs(to_q - q), p = to_p, q = to_q;
        if (change < REL_TOL * bound) break;
    }
    F[a] = p, F[b] = q;
    return sticks;
}

/* Forces of a raised cue over a unilateral table contact: block Gauss-Seidel over the normal force, the tip's
   friction, and the table's normal force and friction. is_impact: solve for the impulses of impact(), at no
   normal force. bound: of the tip's friction, N; mu F_n if it is negative. Returns whether they converged. */
static int solve_gauss_seidel(Work *w, int is_impact, double bound)
{
    const Contact *c = w->c;
    double *F = w->F, half = w->t.h / 2, change = 1, scale = 1;
    int tip_sticks = 0, table_sticks = 0;
    for (int sweep = 0; sweep < MAX_SWEEPS && change > REL_TOL_SWEEPS * scale; sweep++) {
        double before[FORCES];
        memcpy(before, F, sizeof before);
        for (int i = 0; i < MAX_ITERATIONS && !is_impact; i++) {
            double u = w->u[N], slope, unused;
            for (int f = 0; f < FORCES; f++) u += w->W[N][f] * F[f];
            double correction = (F[N] - tip_force(c, w->phase, c->indentation - half * u, &slope, &unused)) /
                                (1 + slope * half * w->W[N][N]);
            F[N] -= correction;
            if (fabs(correction) <= REL_TOL * fabs(F[N])) break;
        }
        tip_sticks = plane_friction(w, T, P, bound < 0 ? c->friction * larger(F[N], 0) : bound);
        double u = w->u[UP] - w->W[UP][UP] * F[UP]; /* without the table */
        for (int f = 0; f < FORCES; f++) u += w->W[UP][f] * F[f];
        int leaves = c->height > 0 && c->height + w->t.h * u > 0;
        F[UP] = leaves ? 0 : larger(0, (w->u_stick[UP] - u) / w->W[UP][UP]);
        table_sticks = plane_friction(w, LATERAL, FORWARD, c->table_friction * F[UP]);
        change = 0, scale = MIN_FORCE;
        for (int f = 0; f < FORCES; f++)
            change = larger(change, fabs(F[f] - before[f])), scale = larger(scale, fabs(F[f]));
    }
    w->slip = tip_sticks ? STICK : SLIP, w->on_table = F[UP] > 0, w->table_stuck = table_sticks && F[UP] > 0;
    return change <= REL_TOL_ACCEPTED * scale;
}

/* Forces of a raised cue. Strong friction may support so much that F_n vanishes, and with it mu F_n: the
   iteration then alternates. The bound mu F_n lies between 0 and the friction force of stick, and is found by
   bisection. Returns whether the forces converged. */
int raised_forces(Work *w)
{
    if (solve_gauss_seidel(w, 0, -1)) return 1;
    int solved = solve_gauss_seidel(w, 0, HUGE_VAL);
    double low = 0, high = hypot(w->F[T], w->F[P]);
    for (int i = 0; i < MAX_BISECTIONS && solved; i++) {
        double bound = (low + high) / 2;
        solved = solve_gauss_seidel(w, 0, bound);
        if (w->c->friction * w->F[N] > bound)
            low = bound;
        else
            high = bound;
    }
    return solved;
}

/* Impact of infinite friction at the first touch. An impulse stops the tip's tangential velocity and the
   ball's velocity into the table, with friction there. Returns 1 if tip and ball stay in contact; if they
   separate, the impulse is scaled so that they do so at e times the approach speed. */
int impact(Work *w, Step *row)
{
    Contact *c = w->c;
    const int n_cue = c->ports + c->slopes, n_velocities = n_cue + c->speeds;
    double loads[VELOCITIES] = {0}, *F = w->F;
    contact_kinematics(w, c->angle, w->slopes, w->C);
    for (int f = 0; f < c->forces; f++) {
        w->v[f] = w->u_stick[f] = 0;
        for (int p = 0; p < n_velocities; p++)
            w->v[f] += w->C[f][p] * (p < n_cue ? w->port_velocities[p] : w->ball[p - n_cue]);
        for (int g = 0; g < c->forces; g++) {
            double sum = 0;
            for (int b = 0; b < c->speeds; b++)
                sum += w->C[f][n_cue + b] * c->inverse_masses[b] * w->C[g][n_cue + b];
            for (int p = 0; p < n_cue; p++)
                for (int q = 0; q < n_cue; q++) sum += w->C[f][p] * c->mobility[p * n_cue + q] * w->C[g][q];
            w->V[f][g] = w->W[f][g] = sum;
        }
        w->u[f] = w->v[f];
    }
    if (c->forces == 2)
        F[T] = -w->v[T] / w->V[T][T];
    else if (!solve_gauss_seidel(w, 1, HUGE_VAL))
        c->status = UNSOLVED;
    double gain = 0, unused[FORCES]; /* gain: of the normal velocity, m/s */
    for (int f = 0; f < c->forces; f++) gain += w->V[N][f] * F[f];
    int separates = w->v[N] + gain > 0;
    for (int f = 0; f < c->forces && separates; f++)
        F[f] *= fmin(1, (1 + c->restitution) * fabs(w->v[N] / gain));
    velocities(w, row->v, unused);
    for (int f = 0; f < c->forces; f++) {
        c->work[f] -= F[f] * (w->v[f] + row->v[f]) / 2;
        for (int p = 0; p < n_velocities; p++) loads[p] += w->C[f][p] * F[f];
    }
    memcpy(row->F, F, sizeof row->F), memset(F, 0, sizeof w->F);
    apply_impulses(w, loads);
    for (int b = 0; b < c->speeds; b++) w->ball[b] += c->inverse_masses[b] * loads[n_cue + b];
    w->tip_stuck = w->on_table = 1;
    return !separates;
}
