/* A linear phase of a contact, cell by cell, up to the first sign change of a guard (cuefem.contact.flow, `march`).

   A state moves as oscillators that a few rows push: x' = omega y, y' = -omega x, and for each push z' += push (row z).
   A term of its Taylor series costs as much as the state is long, where a dense matrix costs the square of that. */
#include "linear.h"

#include <string.h>

enum { PLACES = 16 };
/* A guard that dips below zero between two samples counts if the dip is this deep, relative to its size. */
static const double DEEP = 1e-13;
/* The last term of a cell's series is this part of its state at most, the one before it FALLS as much; no cell is more
   than WIDEST times as long as the one before. */
static const double LEFT_OUT = 1e-16, FALLS = 8, WIDEST = 4;
static const double PLACE[PLACES] = {0,      0.15 / 3, 0.35 / 3, 0.6 / 3,  0.8 / 3,  1.0 / 3,  1.15 / 3, 1.35 / 3,
                                     1.6 / 3, 1.8 / 3,  2.0 / 3,  2.15 / 3, 2.35 / 3, 2.6 / 3, 2.8 / 3, 1.0};

/* The part of a row that is not zero, and the earlier row that it equals, or -1. */
struct extent {
    int from, to, same;
};

struct polynomial {
    const double *terms;
};

static double value(const void *of, double x)
{
    const double *terms = ((const struct polynomial *)of)->terms;
    double total = 0;
    for (int j = TERMS - 1; j >= 0; j--)
        total = total * x + terms[j];
    return total;
}

static double slope(const void *of, double x)
{
    const double *terms = ((const struct polynomial *)of)->terms;
    double total = 0;
    for (int j = TERMS - 1; j > 0; j--)
        total = total * x + j * terms[j];
    return total;
}

static double size_of(const double *terms)
{
    double most = 0;
    for (int j = 0; j < TERMS; j++)
        most = fmax(most, fabs(terms[j]));
    return most;
}

static int all_finite(const double *terms, int count)
{
    int all = 1;
    for (int j = 0; j < count; j++)
        all &= isfinite(terms[j]) != 0;
    return all;
}

/* The first root of a guard between two places; or 2 if there is none. dips: it is not negative at the second one. */
static double root(const double *terms, double low, double high)
{
    struct polynomial of = {terms};
    if (value(&of, high) < 0)
        return first_fall(value, &of, low, high);
    double lowest = zero_of(slope, &of, low, high);
    return value(&of, lowest) < -DEEP * size_of(terms) ? first_fall(value, &of, low, lowest) : 2;
}

/* Whether a guard cannot come near zero in a cell, since its later terms together are less than its first. */
static int stays(const double *terms)
{
    double rest = 0;
    for (int j = 1; j < TERMS; j++)
        rest += fabs(terms[j]);
    return terms[0] > rest;
}

/* The guard that first turns negative in a cell, and where; -1 if none does. */
FAST static int first_sign_change(double (*values)[TERMS], int guards, double *fraction)
{
    double at[MOST_GUARDS][PLACES], falls[MOST_GUARDS][PLACES];
    int still = 1;
    for (int g = 0; g < guards; g++)
        still &= stays(values[g]);
    if (still)
        return -1;
    for (int g = 0; g < guards; g++)
        for (int p = 0; p < PLACES; p++) {
            at[g][p] = values[g][TERMS - 1];
            falls[g][p] = 0;
        }
    for (int j = TERMS - 2; j >= 0; j--)
        for (int g = 0; g < guards; g++)
            for (int p = 0; p < PLACES; p++) {
                falls[g][p] = falls[g][p] * PLACE[p] + at[g][p];
                at[g][p] = at[g][p] * PLACE[p] + values[g][j];
            }
    for (int gap = 0; gap + 1 < PLACES; gap++) {
        double best = 2;
        int guard = -1;
        for (int g = 0; g < guards; g++) {
            double fall = falls[g][gap], rise = falls[g][gap + 1], before = at[g][gap], after = at[g][gap + 1];
            int suspect = after < 0;
            if (!suspect && fall < 0 && rise > 0 && before > 0) {
                double meet = before * rise - after * fall + (PLACE[gap + 1] - PLACE[gap]) * fall * rise;
                suspect = meet < -DEEP * size_of(values[g]) * (rise - fall);
            }
            if (suspect) {
                double found = root(values[g], PLACE[gap], PLACE[gap + 1]);
                if (found < best)
                    best = found, guard = g;
            }
        }
        if (guard >= 0) {
            *fraction = best;
            return guard;
        }
    }
    return -1;
}

/* Vectors are padded with zeros to whole lanes, so that the loops below have no remainders. */
enum { LANES = 8 };

static int padded(int size)
{
    return (size + LANES - 1) / LANES * LANES;
}

/* Copy rows with their padding, and note what of each is not zero; a row that another one equals is read once. */
static void look_over(const struct flow *flow, struct extent *extents, double *copies)
{
    int size = flow->size, wide = padded(size), count = flow->outputs + flow->pushed;
    for (int k = 0; k < count + flow->pushed; k++) {
        const double *row = k < count ? flow->rows + (size_t)k * size : flow->pushes + (size_t)(k - count) * size;
        double *copy = copies + (size_t)k * wide;
        memset(copy, 0, sizeof(double) * wide);
        memcpy(copy, row, sizeof(double) * size);
        struct extent own = {0, wide, -1};
        while (own.from < wide && copy[own.from] == 0)
            own.from++;
        while (own.to > own.from && copy[own.to - 1] == 0)
            own.to--;
        own.from = own.from / LANES * LANES;
        own.to = padded(own.to);
        for (int other = 0; k < count && other < k && own.same < 0; other++)
            if (!memcmp(copy, copies + (size_t)other * wide, sizeof(double) * size))
                own.same = other;
        extents[k] = own;
    }
}

/* The Taylor series of a state over a cell, and of every row: (TERMS, padded size), (TERMS, rows). copies: the rows and
   then the pushes, padded. */
FAST static void expand(const struct flow *flow, const struct extent *extents, const double *restrict copies,
                        double *restrict series, double *restrict read)
{
    int wide = padded(flow->size), turning = flow->turning, at = flow->at, count = flow->outputs + flow->pushed;
    const double *restrict omega = flow->omega;
    for (int j = 0; j < TERMS; j++) {
        const double *restrict z = series + (size_t)j * wide;
        double *restrict now = read + (size_t)j * count;
        for (int k = 0; k < count; k++) {
            if (extents[k].same >= 0) {
                now[k] = now[extents[k].same];
                continue;
            }
            const double *restrict row = copies + (size_t)k * wide;
            double lanes[LANES] = {0}, total = 0;
            for (int i = extents[k].from; i < extents[k].to; i += LANES)
                for (int l = 0; l < LANES; l++)
                    lanes[l] += row[i + l] * z[i + l];
            for (int l = 0; l < LANES; l++)
                total += lanes[l];
            now[k] = total;
        }
        if (j == TERMS - 1)
            return;
        double *restrict next = series + (size_t)(j + 1) * wide, by = flow->step / (j + 1);
        memset(next, 0, sizeof(double) * wide);
        for (int i = 0; i < turning; i++)
            next[i] = by * omega[i] * z[at + i];
        for (int i = 0; i < turning; i++)
            next[at + i] = -by * omega[i] * z[i];
        for (int k = 0; k < flow->pushed; k++) {
            const double *restrict push = copies + (size_t)(count + k) * wide;
            double strength = by * now[flow->outputs + k];
            if (strength != 0)
                for (int i = extents[count + k].from; i < extents[count + k].to; i += LANES)
                    for (int l = 0; l < LANES; l++)
                        next[i + l] += strength * push[i + l];
        }
    }
}

/* The state after a fraction of a cell, padded. */
FAST static void advance(int wide, const double *restrict series, double fraction, double *restrict z)
{
    memcpy(z, series + (size_t)(TERMS - 1) * wide, sizeof(double) * wide);
    for (int j = TERMS - 2; j >= 0; j--) {
        const double *restrict term = series + (size_t)j * wide;
        for (int i = 0; i < wide; i += LANES)
            for (int l = 0; l < LANES; l++)
                z[i + l] = z[i + l] * fraction + term[i + l];
    }
}

/* Doubles that `cuefem_march` needs to work in. */
EXPORTED ptrdiff_t cuefem_march_room(int size, int outputs, int pushed)
{
    ptrdiff_t wide = padded(size), count = outputs + pushed, all = count + pushed;
    ptrdiff_t extents = all * (ptrdiff_t)(sizeof(struct extent) / sizeof(double) + 1);
    return (TERMS + 1 + all) * wide + TERMS * count + extents;
}

/* Where the parts of the memory lie that a flow is followed in. */
struct work {
    int wide;
    double *series, *now, *copies, *read;
    struct extent *extents;
};

static struct work begin(const struct flow *flow, const double *z, double *room)
{
    int count = flow->outputs + flow->pushed;
    struct work work = {.wide = padded(flow->size), .series = room};
    work.now = work.series + (size_t)TERMS * work.wide;
    work.copies = work.now + work.wide;
    work.read = work.copies + (size_t)(count + flow->pushed) * work.wide;
    work.extents = (struct extent *)(work.read + (size_t)TERMS * count);
    look_over(flow, work.extents, work.copies);
    memset(work.now, 0, sizeof(double) * work.wide);
    memcpy(work.now, z, sizeof(double) * flow->size);
    return work;
}

/* The Taylor coefficients of the outputs over a cell of `by` times the flow's step; the guards' are `values`. Whether all
   of these are finite. */
static int look(const struct flow *flow, const struct work *work, double by, double *own, double (*values)[TERMS])
{
    int outputs = flow->outputs, count = outputs + flow->pushed, finite = 1;
    double power = 1;
    for (int j = 0; j < TERMS; j++, power *= by)
        for (int k = 0; k < outputs; k++)
            own[k * TERMS + j] = power * work->read[(size_t)j * count + k];
    for (int g = 0; g < flow->guards; g++) {
        memset(values[g], 0, sizeof values[g]);
        for (int k = 0; k < outputs; k++) {
            double weight = flow->weights[g * outputs + k];
            if (weight != 0)
                for (int j = 0; j < TERMS; j++)
                    values[g][j] += weight * own[k * TERMS + j];
        }
        values[g][0] += flow->constants[g];
        finite &= all_finite(values[g], TERMS);
    }
    return finite;
}

/* Cut a cell at a fraction of it. */
static void cut(int outputs, double fraction, double *own)
{
    double power = 1;
    for (int j = 0; j < TERMS; j++, power *= fraction)
        for (int k = 0; k < outputs; k++)
            own[k * TERMS + j] *= power;
}

/* Follow a flow from the state z for at most `most` cells. coefficients: (most, outputs, TERMS), of the cells gone
   through, the last of them cut at the sign change. FOUND: a guard fell. MORE: all cells are used; call again. LATE: past
   the limit, s. NOT_FINITE: something overflowed. */
EXPORTED int cuefem_march(const struct flow *flow, double *z, struct place *place, double limit, int most,
                          double *coefficients, double *room)
{
    if (flow->terms != TERMS || flow->guards < 1 || flow->guards > MOST_GUARDS)
        return REFUSED;
    struct work work = begin(flow, z, room);
    double values[MOST_GUARDS][TERMS];
    for (place->written = 0; place->written < most;) {
        int cells = place->block ? flow->cells_a_block : 1;
        if (place->cell == cells) {
            place->start += cells * flow->step;
            place->cell = 0;
            place->block = 1;
        }
        if (place->cell == 0 && place->start >= limit)
            return LATE;
        memcpy(work.series, work.now, sizeof(double) * work.wide);
        expand(flow, work.extents, work.copies, work.series, work.read);
        double *own = coefficients + (size_t)place->written * flow->outputs * TERMS;
        if (!look(flow, &work, 1, own, values))
            return NOT_FINITE;
        place->written++;
        place->guard = first_sign_change(values, flow->guards, &place->fraction);
        if (place->guard >= 0) {
            cut(flow->outputs, place->fraction, own);
            advance(work.wide, work.series, place->fraction, work.now);
            memcpy(z, work.now, sizeof(double) * flow->size);
            return all_finite(z, flow->size) ? FOUND : NOT_FINITE;
        }
        advance(work.wide, work.series, 1, work.now);
        if (!all_finite(work.now, flow->size))
            return NOT_FINITE;
        place->cell++;
    }
    memcpy(z, work.now, sizeof(double) * flow->size);
    return MORE;
}

/* How much longer than the step that a series was made for its cell may be, so that what it leaves out is lost in the
   rounding of the state: the last two terms tell. */
static double stretch(int wide, const double *series)
{
    double first = 0, last = 0, before = 0;
    const double *one = series + (size_t)(TERMS - 1) * wide, *other = one - wide;
    for (int i = 0; i < wide; i++) {
        first += series[i] * series[i];
        last += one[i] * one[i];
        before += other[i] * other[i];
    }
    double most = LEFT_OUT * LEFT_OUT * first, by = WIDEST;
    if (last > 0)
        by = fmin(by, pow(most / last, 0.5 / (TERMS - 1)));
    if (before > 0)
        by = fmin(by, pow(FALLS * FALLS * most / before, 0.5 / (TERMS - 2)));
    return by;
}

/* As `cuefem_march`, but in cells as long as the motion allows, the first of about flow->step. lengths: (most,), s. */
int cuefem_stride(const struct flow *flow, double *z, struct place *place, double limit, int most, double *coefficients,
                  double *lengths, double *room)
{
    struct work work = begin(flow, z, room);
    struct flow own_flow = *flow;
    double values[MOST_GUARDS][TERMS];
    for (place->written = 0; place->written < most;) {
        if (place->start >= limit)
            return LATE;
        memcpy(work.series, work.now, sizeof(double) * work.wide);
        expand(&own_flow, work.extents, work.copies, work.series, work.read);
        double by = stretch(work.wide, work.series), length = by * own_flow.step;
        double *own = coefficients + (size_t)place->written * flow->outputs * TERMS;
        if (!(by > 0) || !look(flow, &work, by, own, values))
            return NOT_FINITE;
        place->guard = first_sign_change(values, flow->guards, &place->fraction);
        if (place->guard >= 0) {
            cut(flow->outputs, place->fraction, own);
            advance(work.wide, work.series, place->fraction * by, work.now);
            memcpy(z, work.now, sizeof(double) * flow->size);
            lengths[place->written] = place->fraction * length;
            place->written += lengths[place->written] > 0;
            place->start += place->fraction * length;
            return all_finite(z, flow->size) ? FOUND : NOT_FINITE;
        }
        advance(work.wide, work.series, by, work.now);
        if (!all_finite(work.now, flow->size))
            return NOT_FINITE;
        lengths[place->written++] = length;
        place->start += length;
        own_flow.step = length;
    }
    return MORE;
}
