/* Steps of the contact of a whole tip (cuefem.contact.leather, `_leg`) with the exact turns of all modes
   (cuefem.contact.response). Numbers that choose steps are handed over; equations stand in those modules.

   Forces at the contact reach the cue in three ways: they push its tip along and across the axis, and turn it. The
   response of a step is that of those three to each other, which is the cue's alone; how a contact mixes them, and what
   the ball does, is added (`struct touch`). So strikes of one cue share their responses. */
#include "rings.h"

#include <string.h>

/* Nodes of a step; Gauss points between two of them; Gauss points of a part of a step, and of
   one in which no mode turns by more than SLOW; terms of the guess; rows on which
   forces act: t and n of the first touch, the ball's spin, the tip's turning; ways in which the tip moves. */
enum { NODES = 18, POINTS = 12, MANY = 54, FEW = 27, TAYLOR = 4, ROWS = 4, ALL = ROWS * NODES, WAYS = 3, WIDE = WAYS * NODES };
#define SLOW 20.0 /* rad: degree 2 FEW has then all of a turn's series beside that of a step's polynomials */
enum { T, N, SPIN, ROTATION };
enum { V_T, V_N, F_T, F_N, DEPTH, ANGLE, MOTIONS };
enum { ENDED = 0, FULL = 1, LATE = 2, NEEDS = 3, STUCK = 4, TOO_DEEP = 5, REFUSED = 6, CROWDED = 7 };
enum { PHASE, LEG, STEP }; /* what a blow goes on with */
enum { TOUCH, COMPRESSED, APART, RELOADED, TURNED, GRIPPED, SLIPPED, SLIPPED_BACK, NO_EVENT };
enum { HALVINGS = 40, TOGETHER = 4 }; /* of a table; loops side by side */

/* `Rule`: between, weights (NODES - 1, POINTS); values (NODES - 1, POINTS, NODES); integral, waves (NODES, NODES); slopes
   (TAYLOR, NODES); many, few: Gauss points on (-1, 1). */
struct rule {
    int power, nodes, points, many_points, few_points, terms;
    const double *times, *integral, *waves, *between, *values, *weights, *slopes, *many, *many_weights, *few, *few_weights;
};

/* `FreeMotion`: complex numbers as (real, imaginary). readings: (WAYS + dampers, modes); drives: (modes, WAYS).
   fastest: the greatest size of a rate. */
struct free_motion {
    int modes, dampers;
    double fastest;
    const double *rates, *readings, *drives;
};

/* `Response`; planes of real and imaginary parts. answer: (WAYS + dampers) NODES by WIDE; last: (NODES, 2 modes), what
   forces make of the coordinates at the end; turned: (NODES, 2 modes), their own turns. */
struct response {
    double step;
    double *answer, *last, *turned;
};

/* How the rows read the tip's ways, (ROWS, WAYS), and what else they read: `ball` times the coordinate `at`. */
struct touch {
    double ways[ROWS * WAYS], ball[ROWS];
    int at[ROWS];
};

/* `LeatherLaw`; steady: the constant stiffness along the surface, or zero. */
struct law {
    int force_terms, give_terms;
    const double *force, *give;
    double restitution, most, steady, first_ratio;
};

/* Numbers of cuefem.contact.leather. */
struct bounds {
    double tolerance, settled, wild, opened, past, rounding;
    int rounds, longest, shortest, crossing, most_steps;
};

/* side: 1 or -1 of a slip, 0 in stick. */
struct hold {
    int side, loading, grows, apart;
};

struct contact {
    double friction, size, impulse, dome, reach, clock, speed;
};

/* What changes from step to step. series: (TAYLOR, ROWS), in units of series_step, or its first row alone where that is
   zero. needed: the rule of the response that is missing. */
struct course {
    double time, depth, angle, shear, leaving, deepest, series_step, series[TAYLOR * ROWS];
    int halvings, steps, written, event, needed;
};

struct leg {
    const struct rule *rules;
    const struct free_motion *free;
    const struct response *responses; /* (rules, HALVINGS); step is zero where it is missing */
    const struct law *law;
    const struct bounds *bounds;
    const struct contact *contact;
    struct course *course;
    double *coordinates; /* (2, modes): planes */
    double *losses;      /* worked, wasted, rubbed, and one a damper */
    double *room;
    const struct rings *rings; /* or none: the patch holds or slides as a whole */
    double *held_by;           /* what each of them holds */
    const struct touch *touch;
};

/* A contact from a touch on: how it holds now, what to go on with, and phases that are written. before: energy that the
   spring along the surface held at the start of the leg; start, first, impulse_t, impulse_n: of the phase. */
struct blow {
    struct hold hold;
    int stage, phases, first;
    double before, start, impulse_t, impulse_n, rubbed, sheared, peak;
};

/* A phase that was gone through: first of its steps and how many; impulse (t, n) on the ball in it, N s. */
struct phase {
    int side, loading, first, steps;
    double start, end, impulse_t, impulse_n;
};

/* ---- the law ---- */

struct forces {
    double F, k;
};

static struct forces law_at(const struct law *law, double virtual)
{
    double y = virtual > 0 ? sqrt(virtual) : 0, force = 0, give = 0;
    for (int j = law->force_terms - 1; j >= 0; j--)
        force = force * y + law->force[j];
    for (int j = law->give_terms - 1; j >= 0; j--)
        give = give * y + law->give[j];
    struct forces found = {force * y * y * y, law->steady > 0 ? law->steady : y / give};
    return found;
}

/* dF over the virtual compression y^2, and dk_t over it times 2 y^2. */
static struct forces law_slopes(const struct law *law, double virtual)
{
    double y = virtual > 0 ? sqrt(virtual) : 0, force = 0, give = 0;
    for (int j = law->force_terms - 1; j >= 0; j--)
        force = force * y + (3 + j) * law->force[j];
    for (int j = law->give_terms - 1; j >= 0; j--)
        give = give * y + (1 + j) * law->give[j];
    double k = law_at(law, virtual).k;
    struct forces found = {force * y / 2, law->steady > 0 ? 0 : y > 0 ? 2 * k - k * k * give / y : 0};
    return found;
}

static double rest(const struct law *law, double deepest)
{
    return (1 - law->restitution * law->restitution) * deepest;
}

static double virtual_of(const struct leg *leg, const struct hold *hold, double depth)
{
    const struct law *law = leg->law;
    if (hold->loading)
        return depth;
    return (depth - rest(law, leg->course->deepest)) / (law->restitution * law->restitution);
}

/* By how much less the compression changes than the virtual one. */
static double scale_of(const struct leg *leg, const struct hold *hold)
{
    return hold->loading ? 1 : leg->law->restitution * leg->law->restitution;
}

/* Velocity at which the patch slides on the ball in slip. */
static double slides(const struct leg *leg, const struct hold *hold, double v_t, double v_n, double depth)
{
    double virtual = virtual_of(leg, hold, depth);
    if (leg->rings) /* the innermost ring does */
        return v_t - hold->side * leg->contact->friction * leg->rings->first_gain * v_n / scale_of(leg, hold);
    struct forces at = law_at(leg->law, virtual), slope = law_slopes(leg->law, virtual);
    double part = at.k > 0 ? slope.F / at.k : 1 / leg->law->first_ratio;
    if (!hold->grows && virtual > 0 && at.k > 0)
        part -= at.F * slope.k / (2 * virtual * at.k * at.k);
    return v_t - hold->side * leg->contact->friction * part * v_n / scale_of(leg, hold);
}

/* Power that the spring along the surface loses because its stiffness changes. */
static double wasted(const struct leg *leg, const struct hold *hold, double v_n, double force, double depth)
{
    double virtual = virtual_of(leg, hold, depth), k = law_at(leg->law, virtual).k;
    if (!(virtual > 0 && k > 0))
        return 0;
    double rise = (hold->grows ? -v_n : v_n) / scale_of(leg, hold);
    return law_slopes(leg->law, virtual).k * rise * force * force / (4 * virtual * k * k);
}

/* ---- polynomials over a step ---- */

static double place_of(const struct rule *rule, double part)
{
    return rule->power == 1 ? part : sqrt(part);
}

/* The Lagrange polynomials at a part of the step's time. */
FAST static void polynomials(const struct rule *rule, double part, double *restrict found)
{
    double x = 2 * place_of(rule, part) - 1, before = 1, now = x;
    for (int i = 0; i < NODES; i++)
        found[i] = rule->waves[i] + x * rule->waves[NODES + i];
    for (int k = 2; k < NODES; k++) {
        double next = ((2 * k - 1) * x * now - (k - 1) * before) / k;
        for (int i = 0; i < NODES; i++)
            found[i] += next * rule->waves[k * NODES + i];
        before = now, now = next;
    }
}

INLINE double dot(const double *one, const double *other, int count)
{
    double total = 0;
    for (int i = 0; i < count; i++)
        total += one[i] * other[i];
    return total;
}

/* Products of the rows of a matrix with a vector, four at a time, which keeps four sums going side by side. */
INLINE void products(const double *restrict rows, int count, int width, const double *restrict vector,
                     double *restrict found, int apart)
{
    int r = 0;
    for (; r + TOGETHER <= count; r += TOGETHER) {
        const double *restrict row = rows + (size_t)r * width;
        double sums[TOGETHER] = {0};
        for (int i = 0; i < width; i++) {
            sums[0] += row[i] * vector[i];
            sums[1] += row[width + i] * vector[i];
            sums[2] += row[2 * width + i] * vector[i];
            sums[3] += row[3 * width + i] * vector[i];
        }
        for (int q = 0; q < TOGETHER; q++)
            found[(size_t)(r + q) * apart] = sums[q];
    }
    for (; r < count; r++)
        found[(size_t)r * apart] = dot(rows + (size_t)r * width, vector, width);
}

struct wave {
    const struct rule *rule;
    double terms[NODES];
};

/* A polynomial over a step at a part of its time: Clenshaw's sum. */
static double wave_at(const void *of, double part)
{
    const struct wave *wave = of;
    double x = 2 * place_of(wave->rule, part) - 1, after = 0, total = 0;
    for (int k = NODES - 1; k >= 0; k--) {
        double now = wave->terms[k] + (2 * k + 1) / (k + 1.0) * x * total - (k + 1) / (k + 2.0) * after;
        after = total, total = now;
    }
    return total;
}

/* Times and weights of Gauss points up to a part of the step's time, and the Lagrange polynomials there, which the
   weights are multiplied into. */
static void weighted(const struct rule *rule, double part, int count, double *times, double (*values)[NODES])
{
    double half = place_of(rule, part) / 2;
    const double *points = count == FEW ? rule->few : rule->many;
    const double *weights = count == FEW ? rule->few_weights : rule->many_weights;
    for (int p = 0; p < count; p++) {
        double place = half * (1 + points[p]);
        times[p] = rule->power == 1 ? place : place * place;
        double weight = half * weights[p] * (rule->power == 1 ? 1 : 2 * place);
        polynomials(rule, times[p], values[p]);
        for (int i = 0; i < NODES; i++)
            values[p][i] *= weight;
    }
}

/* ---- the response ---- */

/* exp(rate time) of every mode: planes of real and imaginary parts. */
static void turns(const struct free_motion *free, double time, double *restrict found)
{
    int modes = free->modes;
    for (int k = 0; k < modes; k++) {
        double decay = free->rates[2 * k], angle = free->rates[2 * k + 1] * time;
        double by = decay != 0 ? exp(decay * time) : 1;
        found[k] = by * cos(angle);
        found[modes + k] = by * sin(angle);
    }
}

/* Doubles that `cuefem_leather_respond` keeps in a response, and needs to work in. */
EXPORTED ptrdiff_t cuefem_leather_kept(int modes, int dampers)
{
    ptrdiff_t rows = (WAYS + dampers) * (ptrdiff_t)NODES;
    return rows * WIDE + 2 * NODES * (ptrdiff_t)2 * modes;
}

EXPORTED ptrdiff_t cuefem_leather_room(int modes, int dampers)
{
    ptrdiff_t respond = (POINTS * (NODES / 2 + 1) + NODES + 1) * (ptrdiff_t)2 * modes +
                        (WAYS + dampers) * (ptrdiff_t)WAYS * 2 * modes;
    ptrdiff_t leg = (WAYS + 2 * dampers) * (ptrdiff_t)NODES + (1 + WAYS) * (ptrdiff_t)2 * modes;
    return respond > leg ? respond : leg;
}

static void lay_out(struct response *response, int modes, int dampers, double *kept)
{
    ptrdiff_t rows = (WAYS + dampers) * (ptrdiff_t)NODES;
    response->answer = kept;
    response->last = response->answer + rows * WIDE;
    response->turned = response->last + (ptrdiff_t)NODES * 2 * modes;
}

/* The response of a free motion over a step: `Response.of`. kept: the memory it lives in from now on. */
FAST EXPORTED int cuefem_leather_respond(const struct free_motion *free, const struct rule *rule, double step,
                                         struct response *response, double *kept, double *room)
{
    int modes = free->modes, dampers = free->dampers, wide = 2 * modes, rows = WAYS + dampers;
    if (rule->nodes != NODES || rule->points != POINTS || rule->many_points != MANY || rule->few_points != FEW || rule->terms != TAYLOR)
        return REFUSED;
    lay_out(response, modes, dampers, kept);
    response->step = step;
    double *onward = room, *driven = onward + (size_t)POINTS * (NODES / 2 + 1) * wide;
    double *hop = driven + (size_t)NODES * wide, *pairs = hop + wide;
    for (int r = 0; r < rows; r++)
        for (int m = 0; m < WAYS; m++)
            for (int k = 0; k < modes; k++) {
                const double *read = free->readings + 2 * ((size_t)r * modes + k);
                const double *drive = free->drives + 2 * ((size_t)k * WAYS + m);
                double *pair = pairs + (size_t)(r * WAYS + m) * wide;
                pair[k] = read[0] * drive[0] - read[1] * drive[1];
                pair[modes + k] = -(read[0] * drive[1] + read[1] * drive[0]); /* so that a scalar product is the real part */
            }
    memset(driven, 0, sizeof(double) * NODES * wide);
    memset(response->answer, 0, sizeof(double) * WIDE * rows * NODES);
    for (int i = 0; i < NODES; i++) {
        if (i) {
            int gap = i - 1, mirrored = rule->power == 1 && gap > (NODES - 2) / 2; /* the nodes lie evenly */
            double *own = onward + (size_t)(mirrored ? NODES - 2 - gap : rule->power == 1 ? gap : 0) * POINTS * wide;
            for (int p = 0; p < POINTS && !mirrored; p++)
                turns(free, (rule->times[i] - rule->between[gap * POINTS + p]) * step, own + (size_t)p * wide);
            turns(free, (rule->times[i] - rule->times[gap]) * step, hop);
            for (int j = 0; j < NODES; j++) {
                double *real = driven + (size_t)j * wide, *imaginary = real + modes;
                for (int k = 0; k < modes; k++) {
                    double before = real[k];
                    real[k] = before * hop[k] - imaginary[k] * hop[modes + k];
                    imaginary[k] = before * hop[modes + k] + imaginary[k] * hop[k];
                }
                for (int p = 0; p < POINTS; p += TOGETHER) {
                    const double *restrict turn = own + (size_t)p * wide;
                    double weights[TOGETHER];
                    for (int q = 0; q < TOGETHER; q++)
                        weights[q] = step * rule->weights[gap * POINTS + p + q] *
                                     rule->values[(gap * POINTS + p + q) * NODES + j];
                    for (int k = 0; k < wide; k++)
                        real[k] += weights[0] * turn[k] + weights[1] * turn[k + wide] + weights[2] * turn[k + 2 * wide] +
                                   weights[3] * turn[k + 3 * wide];
                }
            }
        }
        turns(free, rule->times[i] * step, response->turned + (size_t)i * wide);
        for (int r = 0; r < rows; r++) {
            double *answer = response->answer + (size_t)(r * NODES + i) * WIDE;
            for (int j = 0; j < NODES && i; j++)
                products(pairs + (size_t)r * WAYS * wide, WAYS, wide, driven + (size_t)j * wide, answer + j, NODES);
        }
    }
    memcpy(response->last, driven, sizeof(double) * NODES * wide);
    return ENDED;
}

/* ---- a step ---- */

/* A step that was solved: loads on the rows at the nodes (ROWS, NODES), and what moves there; pushes: what the loads are
   along the tip's ways (WAYS, NODES). */
struct solved {
    double loads[ALL], motion[MOTIONS][NODES], pushes[WIDE];
};

/* Loads on the rows, (ROWS, NODES), along the tip's ways. */
INLINE void pushes_of(const struct touch *touch, const double *restrict loads, double *restrict found)
{
    for (int b = 0; b < WAYS; b++)
        for (int i = 0; i < NODES; i++) {
            double total = 0;
            for (int r = 0; r < ROWS; r++)
                total += touch->ways[r * WAYS + b] * loads[r * NODES + i];
            found[b * NODES + i] = total;
        }
}

/* What the rows read of the tip's ways at the nodes, beside what `plus` has. */
INLINE void rows_of(const struct touch *touch, const double *restrict ways, const double *restrict plus,
                    double *restrict found)
{
    for (int r = 0; r < ROWS; r++)
        for (int i = 0; i < NODES; i++) {
            double total = plus[r * NODES + i];
            for (int b = 0; b < WAYS; b++)
                total += touch->ways[r * WAYS + b] * ways[b * NODES + i];
            found[r * NODES + i] = total;
        }
}

FAST static void times_matrix(const double *restrict matrix, const double *restrict vector, int rows,
                              const double *restrict plus, double *restrict found)
{
    products(matrix, rows, WIDE, vector, found, 1);
    for (int r = 0; r < rows; r++)
        found[r] += plus[r];
}

static void guess(const struct leg *leg, const struct rule *rule, double step, double *loads)
{
    const struct course *course = leg->course;
    for (int i = 0; i < NODES; i++) {
        double time = course->series_step > 0 ? rule->times[i] * (step / course->series_step) : 0, power = 1;
        for (int m = 0; m < ROWS; m++)
            loads[m * NODES + i] = 0;
        for (int j = 0; j < (course->series_step > 0 ? TAYLOR : 1); j++, power *= time)
            for (int m = 0; m < ROWS; m++)
                loads[m * NODES + i] += power * course->series[j * ROWS + m];
    }
}

/* The rings at a compression. */
static void rings_of(const struct leg *leg, const struct hold *hold, double depth, struct ringed *found)
{
    double virtual = virtual_of(leg, hold, depth);
    struct forces at = law_at(leg->law, virtual);
    rings_at(leg->rings, virtual, at.F, at.k, found);
}

/* What the rings hold at a part of a step, from its start on; F_t at its nodes, as far as they are before it. sums: from
   values at the nodes to their integral up to the part, over the step's time. */
static double hold_on(const struct leg *leg, const struct hold *hold, const struct rule *rule, double step,
                      double (*motion)[NODES], double part, const double *sums, double depth, double *held)
{
    struct ringed rings[2];
    int now = 0;
    double before = 0, moved, total = 0;
    rings_of(leg, hold, motion[DEPTH][0], rings);
    for (int i = 1; i < NODES && rule->times[i] < part * (1 - 1e-12); i++) {
        now = 1 - now;
        rings_of(leg, hold, motion[DEPTH][i], rings + now);
        moved = step * dot(rule->integral + i * NODES, motion[V_T], NODES);
        total = rings_hold(leg->rings, rings + 1 - now, rings + now, before - moved, held);
        motion[F_T][i] = total;
        before = moved;
    }
    rings_of(leg, hold, depth, rings + 1 - now);
    return rings_hold(leg->rings, rings + now, rings + 1 - now, before - step * dot(sums, motion[V_T], NODES), held);
}

/* Take the rings to the end of a step; the force along the surface there. */
static double rings_go(const struct leg *leg, const struct hold *hold, const struct rule *rule, double step,
                       const struct solved *solved, double part, const double *sums, double depth)
{
    if (hold->side) {
        struct ringed at;
        rings_of(leg, hold, depth, &at);
        return rings_slide(leg->rings, &at, hold->side, leg->held_by);
    }
    double motion[MOTIONS][NODES];
    memcpy(motion, solved->motion, sizeof motion);
    return hold_on(leg, hold, rule, step, motion, part, sums, depth, leg->held_by);
}

/* F_t at the nodes of a step in which some rings hold. */
static void held_at(const struct leg *leg, const struct hold *hold, const struct rule *rule, double step,
                    double (*motion)[NODES])
{
    double held[MOST_RINGS], first = 0;
    memcpy(held, leg->held_by, sizeof(double) * leg->rings->count);
    for (int r = 0; r < leg->rings->count; r++)
        first += held[r];
    motion[F_T][0] = first;
    motion[F_T][NODES - 1] = hold_on(leg, hold, rule, step, motion, 1, rule->integral + (NODES - 1) * NODES,
                                     motion[DEPTH][NODES - 1], held);
}

/* (F_t, F_n) at the nodes, of v_t and the compression there. */
FAST static void forces_at(const struct leg *leg, const struct hold *hold, const double *integral, double step,
                      double (*motion)[NODES])
{
    const struct law *law = leg->law;
    double k[NODES], shifted[NODES], root[NODES], force[NODES] = {0}, give[NODES] = {0};
    for (int i = 0; i < NODES; i++) { /* `law_at`, side by side */
        double virtual = virtual_of(leg, hold, motion[DEPTH][i]);
        root[i] = sqrt(virtual > 0 ? virtual : 0);
    }
    for (int j = law->force_terms - 1; j >= 0; j--)
        for (int i = 0; i < NODES; i++)
            force[i] = force[i] * root[i] + law->force[j];
    for (int j = law->give_terms - 1; j >= 0; j--)
        for (int i = 0; i < NODES; i++)
            give[i] = give[i] * root[i] + law->give[j];
    for (int i = 0; i < NODES; i++) {
        motion[F_N][i] = force[i] * root[i] * root[i] * root[i];
        k[i] = law->steady > 0 ? law->steady : root[i] / give[i];
        shifted[i] = hold->grows ? k[i] * motion[V_T][i] : motion[V_T][i];
    }
    double held = leg->course->shear;
    for (int i = 0; i < NODES; i++) {
        double moved = step * dot(integral + i * NODES, shifted, NODES);
        if (hold->side)
            motion[F_T][i] = hold->side * leg->contact->friction * motion[F_N][i];
        else if (hold->grows)
            motion[F_T][i] = held - moved;
        else
            motion[F_T][i] = k[i] * ((held != 0 ? held / k[0] : 0) - moved);
    }
}

/* Iterate the forces of a step; whether they settle. own: what is read at the nodes without them. */
FAST static int settle(const struct leg *leg, const struct hold *hold, const struct rule *rule,
                  const struct response *response, const double *own, struct solved *found)
{
    const struct contact *contact = leg->contact;
    const struct bounds *bounds = leg->bounds;
    const struct touch *touch = leg->touch;
    double y[ALL], ways[WIDE], alone[ALL], zero[WIDE] = {0}, cosine[NODES], sine[NODES], lever_t[NODES], lever_n[NODES], before_t[NODES] = {0}, before_n[NODES] = {0};
    double step = response->step, *loads = found->loads, dome = contact->dome;
    double most = hold->apart ? bounds->settled * bounds->settled : pow(bounds->settled * contact->size, 2);
    double(*motion)[NODES] = found->motion;
    guess(leg, rule, step, loads);
    for (int r = 0; r < ROWS; r++)
        for (int i = 0; i < NODES; i++)
            y[r * NODES + i] = touch->ball[r] * leg->coordinates[touch->at[r]];
    rows_of(touch, own, y, alone);
    for (int i = 0; i < NODES; i++)
        motion[ANGLE][i] = leg->course->angle;
    for (int round = -1; round < bounds->rounds; round++) {
        for (int i = 0; i < NODES; i++) { /* the directions where the contact has turned to */
            cosine[i] = cos(motion[ANGLE][i]);
            sine[i] = sin(motion[ANGLE][i]);
            lever_t[i] = dome * (cosine[i] - 1);
            lever_n[i] = -dome * sine[i];
        }
        if (round >= 0) {
            double off = 0, values_t, values_n;
            for (int i = 0; i < NODES; i++) {
                values_t = hold->apart ? motion[ANGLE][i] : motion[F_T][i];
                values_n = hold->apart ? 0 : motion[F_N][i];
                off += (values_t - before_t[i]) * (values_t - before_t[i]) + (values_n - before_n[i]) * (values_n - before_n[i]);
                before_t[i] = values_t;
                before_n[i] = values_n;
                if (hold->apart) {
                    loads[T * NODES + i] = loads[N * NODES + i] = loads[SPIN * NODES + i] = loads[ROTATION * NODES + i] = 0;
                    motion[F_T][i] = motion[F_N][i] = 0;
                } else { /* F_t + i F_n, turned back to the directions of the first touch */
                    loads[T * NODES + i] = values_t * cosine[i] - values_n * sine[i];
                    loads[N * NODES + i] = values_t * sine[i] + values_n * cosine[i];
                    loads[SPIN * NODES + i] = values_t;
                    loads[ROTATION * NODES + i] = values_t * lever_t[i] + values_n * lever_n[i];
                }
            }
            if (off > bounds->wild * contact->size * contact->size)
                return 0;
            if (off <= most) {
                pushes_of(touch, loads, found->pushes);
                return 1;
            }
            if (round == bounds->rounds - 1)
                return 0;
        }
        pushes_of(touch, loads, found->pushes);
        times_matrix(response->answer, found->pushes, WIDE, zero, ways);
        rows_of(touch, ways, alone, y);
        for (int r = 0; r < ROTATION; r++) /* the ball is only pushed */
            for (int i = 1; i < NODES; i++)
                y[r * NODES + i] += touch->ball[r] * touch->ball[r] * step *
                                    dot(rule->integral + i * NODES, loads + r * NODES, NODES);
        double across[NODES];
        for (int i = 0; i < NODES; i++) { /* (t + i n) exp(-i angle) + lever turning */
            double turning = y[ROTATION * NODES + i];
            across[i] = y[T * NODES + i] * cosine[i] + y[N * NODES + i] * sine[i] + lever_t[i] * turning;
            motion[V_N][i] = y[N * NODES + i] * cosine[i] - y[T * NODES + i] * sine[i] + lever_n[i] * turning;
            motion[V_T][i] = across[i] + y[SPIN * NODES + i];
            across[i] += dome * turning;
        }
        for (int i = 0; i < NODES; i++) {
            motion[DEPTH][i] = leg->course->depth - step * dot(rule->integral + i * NODES, motion[V_N], NODES);
            if (contact->reach < HUGE_VAL)
                motion[ANGLE][i] =
                    leg->course->angle - step * dot(rule->integral + i * NODES, across, NODES) / contact->reach;
        }
        if (!hold->apart)
            forces_at(leg, hold, rule->integral, step, motion);
        if (leg->rings && !hold->apart && !hold->side)
            held_at(leg, hold, rule, step, motion);
    }
    return 0;
}

/* No step past the parting, where forces fall with a root of time, but for the last. */
static void shorten(const struct leg *leg, const struct hold *hold)
{
    struct course *course = leg->course;
    const struct bounds *bounds = leg->bounds;
    if (hold->apart || hold->loading || hold->grows || course->leaving <= 0)
        return;
    double left = (course->depth - rest(leg->law, course->deepest)) / course->leaving / leg->contact->clock;
    if (left < ldexp(1, -bounds->longest)) {
        int least = left < ldexp(1, -bounds->crossing) ? bounds->crossing : (int)ceil(-log2(0.85 * left));
        if (least > course->halvings)
            course->halvings = least;
    }
}

/* What ends a leg: values of the order of 1 that fall through zero; how many there are. */
static int ends_of(const struct leg *leg, const struct hold *hold, double near, double (*motion)[NODES],
                   double (*ends)[NODES], int *names)
{
    const struct contact *contact = leg->contact;
    double speed = contact->speed, depth = contact->speed * contact->clock, at_rest = rest(leg->law, leg->course->deepest);
    int count = 0;
    if (hold->apart)
        names[count++] = TOUCH;
    else {
        if (hold->loading)
            names[count++] = COMPRESSED;
        else {
            names[count++] = APART;
            names[count++] = RELOADED;
            names[count++] = TURNED;
        }
        if (hold->side)
            names[count++] = GRIPPED;
        else if (contact->friction < HUGE_VAL) {
            names[count++] = SLIPPED;
            names[count++] = SLIPPED_BACK;
        }
    }
    for (int e = 0; e < count; e++)
        for (int i = 0; i < NODES; i++) {
            double v_t = motion[V_T][i], v_n = motion[V_N][i], deep = motion[DEPTH][i], value = 0;
            double bound = contact->friction * motion[F_N][i];
            switch (names[e]) {
            case TOUCH: value = (at_rest + near - deep) / depth; break;
            case COMPRESSED: value = -v_n / speed; break;
            case APART: value = (deep - at_rest) / depth; break;
            case RELOADED: value = (leg->course->deepest - deep) / depth; break;
            case TURNED: value = (hold->grows ? -v_n : v_n) / speed; break;
            case GRIPPED: value = -hold->side * slides(leg, hold, v_t, v_n, deep) / speed; break;
            case SLIPPED: value = (bound - motion[F_T][i]) / contact->size + leg->bounds->rounding; break;
            default: value = (bound + motion[F_T][i]) / contact->size + leg->bounds->rounding; break;
            }
            ends[e][i] = value;
        }
    return count;
}

/* The first end in a step, and the part of the step at which it is. */
static int crossing(const struct leg *leg, const struct hold *hold, const struct rule *rule, double near,
                    double (*motion)[NODES], double *part)
{
    double ends[NO_EVENT][NODES], until = HUGE_VAL, past = -leg->bounds->past;
    int names[NO_EVENT], count = ends_of(leg, hold, near, motion, ends, names), event = NO_EVENT;
    *part = 1;
    for (int e = 0; e < count; e++) {
        int i = 0;
        while (i < NODES && !(ends[e][i] < past && rule->times[i] <= until))
            i++;
        if (i == NODES)
            continue;
        double at = 0;
        if (i) {
            struct wave wave = {.rule = rule};
            for (int k = 0; k < NODES; k++)
                wave.terms[k] = dot(rule->waves + k * NODES, ends[e], NODES);
            at = first_fall(wave_at, &wave, rule->times[i - 1], rule->times[i]);
        }
        if (event == NO_EVENT || at < *part)
            event = names[e], *part = at;
        if (names[e] == APART) /* behind it the others mean nothing */
            until = at;
    }
    return event;
}

/* Add up what a step loses. */
static void lose(const struct leg *leg, const struct hold *hold, const struct solved *step, double length,
                 const double *sums, const double *damped)
{
    double *losses = leg->losses;
    const double(*motion)[NODES] = step->motion;
    for (int d = 0; d < leg->free->dampers; d++)
        for (int i = 0; i < NODES; i++)
            losses[3 + d] += length * sums[i] * damped[d * NODES + i] * damped[d * NODES + i];
    if (hold->apart)
        return;
    for (int i = 0; i < NODES; i++) {
        double weight = length * sums[i], v_n = motion[V_N][i], force = motion[F_T][i], depth = motion[DEPTH][i];
        losses[0] += weight * force * motion[V_T][i];
        if (hold->side || hold->grows)
            losses[1] += weight * wasted(leg, hold, v_n, force, depth);
        if (hold->side)
            losses[2] += weight * force * slides(leg, hold, motion[V_T][i], v_n, depth);
    }
}

/* The coordinates after a part of a step. sums: from values at the nodes to their integral up to there, over the step's
   time. times, values: of Gauss points up to there, where it is not the whole. */
FAST static void go_on(const struct leg *leg, const struct response *response, const struct solved *step, double part,
                       int points, const double *times, double (*values)[NODES], const double *sums)
{
    const struct free_motion *free = leg->free;
    const struct touch *touch = leg->touch;
    int modes = free->modes, wide = 2 * modes, whole = part == 1;
    double *xi = leg->coordinates, *turn = leg->room, *driven = turn + wide;
    memset(driven, 0, sizeof(double) * WAYS * wide);
    for (int p = 0; p < (whole ? NODES : points); p++) {
        const double *restrict onward = whole ? response->last + (size_t)p * wide : turn;
        double pushes[WAYS];
        for (int b = 0; b < WAYS; b++)
            pushes[b] = whole ? step->pushes[b * NODES + p]
                              : response->step * dot(step->pushes + b * NODES, values[p], NODES);
        if (!whole)
            turns(free, response->step * (part - times[p]), turn);
        for (int k = 0; k < wide; k++) {
            driven[k] += pushes[0] * onward[k];
            driven[wide + k] += pushes[1] * onward[k];
            driven[2 * wide + k] += pushes[2] * onward[k];
        }
    }
    if (whole)
        memcpy(turn, response->turned + (size_t)(NODES - 1) * wide, sizeof(double) * wide);
    else
        turns(free, response->step * part, turn);
    for (int k = 0; k < modes; k++) {
        const double *drive = free->drives + 2 * (size_t)k * WAYS;
        double real = turn[k] * xi[k] - turn[modes + k] * xi[modes + k];
        double imaginary = turn[k] * xi[modes + k] + turn[modes + k] * xi[k];
        for (int b = 0; b < WAYS; b++) {
            const double *by = driven + (size_t)b * wide;
            real += drive[2 * b] * by[k] - drive[2 * b + 1] * by[modes + k];
            imaginary += drive[2 * b] * by[modes + k] + drive[2 * b + 1] * by[k];
        }
        xi[k] = real;
        xi[modes + k] = imaginary;
    }
    for (int r = 0; r < ROTATION; r++)
        xi[touch->at[r]] += touch->ball[r] * response->step * dot(sums, step->loads + r * NODES, NODES);
}

/* What the tip's ways and the dampers read at the nodes without forces: (rows, NODES). */
FAST static void unforced(const struct leg *leg, const struct response *response, double *found)
{
    const struct free_motion *free = leg->free;
    int modes = free->modes;
    const double *xi = leg->coordinates;
    double *read = leg->room;
    for (int r = 0; r < WAYS + free->dampers; r++) {
        for (int k = 0; k < modes; k++) {
            const double *by = free->readings + 2 * ((size_t)r * modes + k);
            read[k] = by[0] * xi[k] - by[1] * xi[modes + k];
            read[modes + k] = -(by[0] * xi[modes + k] + by[1] * xi[k]); /* so that a scalar product is the real part */
        }
        products(response->turned, NODES, 2 * modes, read, found + r * NODES, 1);
    }
}

/* Doubles of the record of a step: start, part, length, halvings, rule; coordinates at its start; loads; motion. */
EXPORTED ptrdiff_t cuefem_leather_record(int modes)
{
    return 5 + 2 * (ptrdiff_t)modes + ALL + MOTIONS * NODES;
}

/* Step on to the first end of a leg, or to `until`. records: (most, record). ENDED: course->event tells by what. FULL: all
   records are used. LATE: past `until`. NEEDS: a response of course->halvings by the rule course->needed. STUCK: no step
   holds the tolerance, or too many were taken. TOO_DEEP: course->depth is further than the law is known. */
FAST EXPORTED int cuefem_leather_leg(const struct leg *leg, const struct hold *hold, double until, double near, int most,
                                double *records)
{
    const struct bounds *bounds = leg->bounds;
    struct course *course = leg->course;
    int modes = leg->free->modes, dampers = leg->free->dampers, rows = WAYS + dampers;
    double *own = leg->room + (1 + WAYS) * (size_t)2 * modes, *damped = own + (size_t)rows * NODES;
    double fastest = leg->free->fastest;
    if (bounds->shortest >= HALVINGS || (leg->rings && leg->rings->count > MOST_RINGS))
        return REFUSED;
    for (;;) {
        if (!(course->time < until))
            return LATE;
        if (course->steps > bounds->most_steps)
            return STUCK;
        if (course->written == most)
            return FULL;
        int opens = !hold->apart && hold->grows && virtual_of(leg, hold, course->depth) < bounds->opened * leg->law->most;
        const struct rule *rule = leg->rules + opens;
        shorten(leg, hold);
        struct solved step;
        const struct response *response;
        for (;;) {
            if (course->halvings > bounds->shortest)
                return STUCK;
            response = leg->responses + (size_t)opens * HALVINGS + course->halvings;
            if (!(response->step > 0)) {
                course->needed = opens;
                return NEEDS;
            }
            unforced(leg, response, own);
            if (!settle(leg, hold, rule, response, own, &step)) {
                course->halvings += 2;
                continue;
            }
            double last = 0;
            for (int m = 0; m < ROTATION; m++)
                for (int k = NODES - 2; k < NODES; k++)
                    last = fmax(last, fabs(dot(rule->waves + k * NODES, step.loads + m * NODES, NODES)));
            double error = last * response->step / (bounds->tolerance * leg->contact->impulse);
            if (error > 1) {
                course->halvings += error > 1e3 ? 2 : 1;
                continue;
            }
            if (error < 1e-3 && course->halvings > bounds->longest)
                course->halvings--;
            break;
        }
        double part, length = response->step;
        int event = crossing(leg, hold, rule, near, step.motion, &part);
        if (part > 0) {
            double times[MANY], values[MANY][NODES], at[NODES] = {0}, sums[NODES] = {0};
            int points = rule->power * fastest * part * length <= SLOW ? FEW : MANY;
            if (part == 1) {
                at[NODES - 1] = 1;
                memcpy(sums, rule->integral + (NODES - 1) * NODES, sizeof sums);
            } else {
                polynomials(rule, part, at);
                weighted(rule, part, points, times, values);
                for (int p = 0; p < points; p++)
                    for (int i = 0; i < NODES; i++)
                        sums[i] += values[p][i];
            }
            double depth = dot(at, step.motion[DEPTH], NODES);
            if (depth > leg->law->most) {
                course->depth = depth;
                return TOO_DEEP;
            }
            double *record = records + (size_t)course->written * cuefem_leather_record(modes);
            double head[5] = {course->time, part, length, (response - leg->responses) % HALVINGS, opens};
            memcpy(record, head, sizeof head);
            for (int k = 0; k < modes; k++) {
                record[5 + 2 * k] = leg->coordinates[k];
                record[6 + 2 * k] = leg->coordinates[modes + k];
            }
            memcpy(record + 5 + 2 * modes, step.loads, sizeof step.loads);
            memcpy(record + 5 + 2 * modes + ALL, step.motion, sizeof step.motion);
            times_matrix(response->answer + (size_t)WIDE * WIDE, step.pushes, dampers * NODES, own + WIDE, damped);
            lose(leg, hold, &step, length, sums, damped);
            go_on(leg, response, &step, part, points, times, values, sums);
            course->time += part * length;
            course->depth = depth;
            course->angle = dot(at, step.motion[ANGLE], NODES);
            course->shear = dot(at, step.motion[F_T], NODES);
            course->leaving = dot(at, step.motion[V_N], NODES);
            if (leg->rings && !hold->apart)
                course->shear = rings_go(leg, hold, rule, length, &step, part, sums, depth);
            if (hold->side)
                course->shear = hold->side * leg->contact->friction * law_at(leg->law, virtual_of(leg, hold, depth)).F;
            course->series_step = 0;
            for (int m = 0; m < ROWS; m++)
                course->series[m] = dot(at, step.loads + m * NODES, NODES);
            if (part == 1 && rule->power == 1) {
                course->series_step = length;
                for (int j = 0; j < TAYLOR; j++)
                    for (int m = 0; m < ROWS; m++)
                        course->series[j * ROWS + m] = dot(rule->slopes + j * NODES, step.loads + m * NODES, NODES);
            }
            course->written++;
            course->steps++;
        }
        if (event != NO_EVENT) {
            course->event = event;
            return ENDED;
        }
    }
}

/* ---- a whole contact ---- */

/* Energy that the spring along the surface holds now. */
static double stored(const struct leg *leg, const struct hold *hold)
{
    double depth = leg->course->depth, held = leg->course->shear, total = 0;
    if (leg->rings) {
        struct ringed at;
        rings_of(leg, hold, depth, &at);
        for (int r = 0; r < leg->rings->count; r++)
            total += at.stiffness[r] > 0 ? leg->held_by[r] * leg->held_by[r] / (2 * at.stiffness[r]) : 0;
        return total;
    }
    double k = law_at(leg->law, virtual_of(leg, hold, depth)).k;
    return k != 0 ? held * held / (2 * k) : 0;
}

/* What a leg lost along the surface: `Leather._lose`. */
static void account(const struct leg *leg, struct blow *blow)
{
    const struct hold *hold = &blow->hold;
    double missing = blow->before - stored(leg, hold) - leg->losses[0];
    if (leg->rings) { /* what is missing is all that was lost */
        *(leg->contact->friction < HUGE_VAL ? &blow->rubbed : &blow->sheared) += missing;
    } else if (!hold->side && !hold->grows) {
        blow->sheared += missing;
    } else {
        blow->sheared += leg->losses[1];
        blow->rubbed -= leg->losses[2];
    }
}

static double impulse(const struct leg *leg, int row)
{
    return leg->coordinates[leg->touch->at[row]] / leg->touch->ball[row];
}

/* Begin a phase: `Leather.follow`. */
static void begin(const struct leg *leg, struct blow *blow)
{
    struct course *course = leg->course;
    struct hold *hold = &blow->hold;
    hold->grows = hold->grows || hold->loading;
    if (hold->side) { /* F_t on friction's bound, which the stick before went past by rounding */
        double held = stored(leg, hold);
        course->shear = hold->side * leg->contact->friction * law_at(leg->law, virtual_of(leg, hold, course->depth)).F;
        blow->sheared += held - stored(leg, hold);
    }
    blow->start = course->time;
    blow->first = course->steps;
    blow->impulse_t = impulse(leg, T);
    blow->impulse_n = impulse(leg, N);
}

/* What follows an event: `cuefem.contact.phases.next_phase`; whether anything does. */
static int follows(const struct leg *leg, struct blow *blow)
{
    struct course *course = leg->course;
    struct hold *hold = &blow->hold;
    switch (course->event) {
    case APART: return 0;
    case COMPRESSED:
        course->deepest = course->depth;
        blow->peak = law_at(leg->law, course->depth).F;
        hold->grows = hold->loading = 0;
        break;
    case RELOADED: hold->loading = 1; break;
    case GRIPPED: hold->side = 0; break;
    case SLIPPED: hold->side = 1; break;
    default: hold->side = -1; break;
    }
    return 1;
}

/* Go through all phases of a contact: `cuefem.contact.phases.run`. phases: room for so many as `most_phases`. ENDED: the
   ball has left. CROWDED: all phases are used. Anything else is what `cuefem_leather_leg` says. */
EXPORTED int cuefem_leather_blow(const struct leg *leg, struct blow *blow, double until, int most, double *records,
                                 int most_phases, struct phase *phases)
{
    struct course *course = leg->course;
    if (leg->rings && leg->rings->count > MOST_RINGS)
        return REFUSED;
    for (;;) {
        if (blow->stage == PHASE) {
            if (blow->phases == most_phases)
                return CROWDED;
            begin(leg, blow);
            blow->stage = LEG;
        }
        if (blow->stage == LEG) {
            blow->before = stored(leg, &blow->hold);
            memset(leg->losses, 0, 3 * sizeof(double));
            blow->stage = STEP;
        }
        int status = cuefem_leather_leg(leg, &blow->hold, until, 0, most, records);
        if (status != ENDED && status != LATE)
            return status;
        account(leg, blow);
        if (status == LATE)
            return LATE;
        blow->stage = LEG;
        if (course->event == TURNED) {
            blow->hold.grows = !blow->hold.grows;
            continue;
        }
        struct phase gone = {blow->hold.side,
                             blow->hold.loading,
                             blow->first,
                             course->steps - blow->first,
                             blow->start,
                             course->time,
                             impulse(leg, T) - blow->impulse_t,
                             impulse(leg, N) - blow->impulse_n};
        phases[blow->phases++] = gone;
        blow->stage = PHASE;
        if (!follows(leg, blow))
            return ENDED;
    }
}
