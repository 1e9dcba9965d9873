/* A contact of a raised cue over a table (cuefem.contact.raised): the equations of cuefem.contact.elevation. */
#include "dop853.h"

#include <string.h>

/* Rows: the tip's velocities against the ball, and the ball's lowest point's. */
enum { T, N, P, UP, ASIDE, AHEAD, ROWS };
enum { NONE, LIFTED, SLIDES, HELD };

/* Where the parts of a state stand, and the numbers of `Raised`. rows: (ROWS, size); gram: (ROWS, ROWS), their products.
   ways: of the directions in which tip and ball slide. at_rest: a speed, m/s, below which a direction is kept. */
struct raised {
    int size, turning, at, depth, rubbed, damped, gone, height, scraped, tip_way, ball_way, dampers, lossy;
    double friction, table_friction, clock, speed, at_rest, force, rounding, relative, longest_step;
    struct power_law law;
    const double *omega, *rows, *gram, *damping, *absolute;
};

/* table: how it holds the ball. deepest: at the last peak, m. */
struct raised_hold {
    int slips, loading, table;
    double deepest;
};

struct work {
    const struct raised *raised;
    const struct raised_hold *hold;
    double *free;
};

/* Velocities of the rows, and the forces on them; falling: how these change without forces. */
struct seen {
    double velocities[ROWS], falling[ROWS], forces[ROWS];
};

INLINE double dot(const double *one, const double *other, int count)
{
    double total = 0;
    for (int i = 0; i < count; i++)
        total += one[i] * other[i];
    return total;
}

/* Solve a small system in its place: elimination with the greatest pivot of each column. */
static void solve(double (*matrix)[ROWS], double *right, int count)
{
    for (int c = 0; c < count; c++) {
        int best = c;
        for (int r = c + 1; r < count; r++)
            if (fabs(matrix[r][c]) > fabs(matrix[best][c]))
                best = r;
        for (int k = 0; k < count; k++) {
            double kept = matrix[c][k];
            matrix[c][k] = matrix[best][k], matrix[best][k] = kept;
        }
        double kept = right[c];
        right[c] = right[best], right[best] = kept;
        for (int r = c + 1; r < count; r++) {
            double by = matrix[r][c] / matrix[c][c];
            for (int k = c; k < count; k++)
                matrix[r][k] -= by * matrix[c][k];
            right[r] -= by * right[c];
        }
    }
    for (int r = count - 1; r >= 0; r--) {
        for (int k = r + 1; k < count; k++)
            right[r] -= matrix[r][k] * right[k];
        right[r] /= matrix[r][r];
    }
}

/* The rate of a state without forces at the contact, and what is seen there. */
FAST static void look(const struct work *work, const double *z, struct seen *seen)
{
    const struct raised *s = work->raised;
    const struct raised_hold *hold = work->hold;
    double *restrict free = work->free;
    int size = s->size, keep[ROWS], count = 0;
    memset(free, 0, sizeof(double) * size);
    for (int i = 0; i < s->turning; i++)
        free[i] = s->omega[i] * z[s->at + i];
    for (int i = 0; i < s->turning; i++)
        free[s->at + i] = -s->omega[i] * z[i];
    for (int d = 0; d < s->dampers; d++) {
        const double *damper = s->damping + (size_t)d * size;
        double strength = dot(damper, z, size);
        for (int i = 0; i < size; i++)
            free[i] -= strength * damper[i];
    }
    for (int r = 0; r < ROWS; r++) {
        seen->velocities[r] = dot(s->rows + (size_t)r * size, z, size);
        seen->falling[r] = dot(s->rows + (size_t)r * size, free, size);
        seen->forces[r] = 0;
    }
    double *forces = seen->forces, F_n = law_force(&s->law, hold->loading, hold->deepest, z[s->depth]);
    forces[N] = F_n;
    if (hold->slips) {
        forces[T] = -s->friction * F_n * cos(z[s->tip_way]);
        forces[P] = -s->friction * F_n * sin(z[s->tip_way]);
    } else
        keep[count++] = T, keep[count++] = P;
    if (hold->table == SLIDES || hold->table == HELD)
        keep[count++] = UP;
    if (hold->table == HELD)
        keep[count++] = ASIDE, keep[count++] = AHEAD;
    if (!count)
        return;
    double push[ROWS][ROWS] = {{0}}, matrix[ROWS][ROWS], right[ROWS]; /* push: of each force kept */
    for (int k = 0; k < count; k++)
        push[k][keep[k]] = 1;
    if (hold->table == SLIDES) { /* the table's push upwards brings friction */
        push[count - 1][ASIDE] = -s->table_friction * cos(z[s->ball_way]);
        push[count - 1][AHEAD] = -s->table_friction * sin(z[s->ball_way]);
    }
    for (int i = 0; i < count; i++) {
        const double *row = s->gram + keep[i] * ROWS;
        right[i] = seen->falling[keep[i]] + dot(row, forces, ROWS);
        for (int k = 0; k < count; k++)
            matrix[i][k] = dot(row, push[k], ROWS);
    }
    solve(matrix, right, count);
    for (int k = 0; k < count; k++)
        for (int r = 0; r < ROWS; r++)
            forces[r] -= push[k][r] * right[k];
}

/* Rate at which the direction of a point that slides turns. */
static double turns(const struct raised *s, const double *velocities, const double *rates, double way, int a, int b)
{
    double x = cos(way), y = sin(way), aside = x * rates[b] - y * rates[a], speed = x * velocities[a] + y * velocities[b];
    return aside * speed / (speed * speed + s->at_rest * s->at_rest);
}

/* The rate of change of a state, per clock. */
FAST static void change(const void *of, const double *z, double *restrict rate)
{
    const struct work *work = of;
    const struct raised *s = work->raised;
    struct seen seen;
    look(work, z, &seen);
    memcpy(rate, work->free, sizeof(double) * s->size);
    double powers[ROWS], rates[ROWS];
    for (int r = 0; r < ROWS; r++) {
        const double *row = s->rows + (size_t)r * s->size;
        for (int i = 0; i < s->size; i++)
            rate[i] += seen.forces[r] * row[i];
        powers[r] = -seen.forces[r] * seen.velocities[r];
        rates[r] = seen.falling[r] + dot(s->gram + r * ROWS, seen.forces, ROWS);
    }
    rate[s->depth] = -seen.velocities[N];
    rate[s->height] = seen.velocities[UP];
    rate[s->rubbed] = powers[T] + powers[P];
    rate[s->scraped] = powers[UP] + powers[ASIDE] + powers[AHEAD];
    if (work->hold->slips)
        rate[s->tip_way] = turns(s, seen.velocities, rates, z[s->tip_way], T, P);
    if (work->hold->table == SLIDES)
        rate[s->ball_way] = turns(s, seen.velocities, rates, z[s->ball_way], ASIDE, AHEAD);
    for (int d = 0; d < s->dampers; d++) {
        double speed = dot(s->damping + (size_t)d * s->size, z, s->size);
        rate[d < s->lossy ? s->damped : s->gone] += speed * speed;
    }
    for (int i = 0; i < s->size; i++)
        rate[i] *= s->clock;
}

/* What ends the phase, in the order of `Raised._ends`; how many there are. */
static int ends_of(const void *of, const double *z, double *ends)
{
    const struct work *work = of;
    const struct raised *s = work->raised;
    const struct raised_hold *hold = work->hold;
    struct seen seen;
    look(work, z, &seen);
    const double *v = seen.velocities, *forces = seen.forces;
    double depth = s->speed * s->clock;
    int count = 0;
    if (hold->loading)
        ends[count++] = -v[N] / s->speed;
    else {
        ends[count++] = (z[s->depth] - law_rest(&s->law, hold->deepest)) / depth;
        ends[count++] = (hold->deepest - z[s->depth]) / depth;
    }
    if (hold->slips)
        ends[count++] = (cos(z[s->tip_way]) * v[T] + sin(z[s->tip_way]) * v[P]) / s->speed;
    else if (s->friction < HUGE_VAL)
        ends[count++] = (s->friction * forces[N] - hypot(forces[T], forces[P])) / s->force + s->rounding;
    if (hold->table == LIFTED) {
        ends[count++] = z[s->height] / depth;
        return count;
    }
    ends[count++] = forces[UP] / s->force + s->rounding;
    if (hold->table == SLIDES)
        ends[count++] = (cos(z[s->ball_way]) * v[ASIDE] + sin(z[s->ball_way]) * v[AHEAD]) / s->speed;
    else
        ends[count++] = (s->table_friction * forces[UP] - hypot(forces[ASIDE], forces[AHEAD])) / s->force + s->rounding;
    return count;
}

/* Doubles that `cuefem_raised` works in. */
EXPORTED ptrdiff_t cuefem_raised_room(int size)
{
    return size + dop853_room(size);
}

/* Step through a phase: see `dop853`. */
EXPORTED int cuefem_raised(const struct raised *s, const struct raised_hold *hold, const struct tables *tables, double until,
                           int ends, double *z, struct way *way, int most, double *times, double *olds, double *terms,
                           double *room)
{
    struct work work = {s, hold, room};
    struct motion motion = {s->size, s->relative, s->longest_step, s->absolute, &work, change, ends_of};
    return dop853(&motion, tables, until, ends, z, way, most, times, olds, terms, room + s->size);
}
