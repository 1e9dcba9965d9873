/* A whole contact with linear laws in one call: its phases one after the other, as cuefem.contact.phases, .linear and
   .patch say. Only the usual ones: a tip that gives something back, and does not ring. Python goes through anything else
   phase by phase, and through every contact that is given up here. */
#include "linear.h"

#include <string.h>

enum { LOAD, UNLOAD };
enum { APART, RELOADED, COMPRESSED, GRIPPED, SLIPPED, SLIPPED_BACK };
enum { V_T, V_N, F_N, F_T, SLIDE };
enum { MOST_PUSHED = 5 };

/* spring, shear: where the tip's force stands in the state, and the patch's, or -1 on a rigid patch. unit: of that state
   per newton. slack: by which |F_t| may pass mu F_n, N. */
struct plain {
    int size, turning, at, spring, shear, ball_t, ball_n, dampers, most_phases, most_cells;
    double root, restitution, friction, compliance, unit, fastest, slack, longest, reach;
    const double *omega, *c_t, *c_n, *damping; /* (turning,), (size,), (size,), (dampers, size) */
};

/* A phase that was gone through: side 1, 0, -1; first of its cells and how many; impulse (t, n) on the ball in it, N s;
   rate: a bound on the motion, 1/s. */
struct phase {
    int side, press, first, cells;
    double start, end, rate, impulse_t, impulse_n;
};

/* time, s; peak, N; what was rubbed off, J. damped: (dampers,) J, stands apart. */
struct outcome {
    double time, peak, rubbed;
    int phases, cells;
};

static double product(const double *one, const double *other, int count)
{
    double total = 0;
    for (int i = 0; i < count; i++)
        total += one[i] * other[i];
    return total;
}

static void add(double *to, double by, const double *what, int count)
{
    for (int i = 0; i < count; i++)
        to[i] += by * what[i];
}

/* The row that reads the rate of change, without forces, of what a row reads. */
static void free_slope(const struct plain *plain, const double *row, double *found)
{
    memset(found, 0, sizeof(double) * plain->size);
    for (int i = 0; i < plain->turning; i++) {
        found[i] = -plain->omega[i] * row[plain->at + i];
        found[plain->at + i] = plain->omega[i] * row[i];
    }
    for (int d = 0; d < plain->dampers; d++) {
        const double *damper = plain->damping + (size_t)d * plain->size;
        add(found, -product(row, damper, plain->size), damper, plain->size);
    }
}

static double root_of(const struct plain *plain, int press)
{
    return press == UNLOAD ? plain->root / plain->restitution : plain->root;
}

/* The row that reads F_t in stick on a rigid patch, which keeps v_t at zero. */
static void holding(const struct plain *plain, double root, double *row)
{
    double square = product(plain->c_t, plain->c_t, plain->size);
    free_slope(plain, plain->c_t, row);
    row[plain->spring] += product(plain->c_t, plain->c_n, plain->size) * root;
    for (int i = 0; i < plain->size; i++)
        row[i] /= -square;
}

/* Take out of a vector what lies along another one of unit length. */
static void project(double *vector, const double *held, int size)
{
    add(vector, -product(vector, held, size), held, size);
}

/* Rows, pushes and guards of a phase, in the memory that `flow` points to; names: of its guards. */
static void set_up(const struct plain *plain, int side, int press, double peak, struct flow *flow, int *names)
{
    int size = plain->size, springy = plain->shear >= 0, outputs = 4 + springy + plain->dampers, k = 0;
    double *rows = (double *)flow->rows, *pushes = (double *)flow->pushes, *drives = rows + (size_t)outputs * size;
    double root = root_of(plain, press), mu = plain->friction;
    double norm_t = sqrt(product(plain->c_t, plain->c_t, size)), norm_n = sqrt(product(plain->c_n, plain->c_n, size));
    double rate = plain->fastest + root * norm_n;
    memset(rows, 0, sizeof(double) * (outputs + MOST_PUSHED + plain->dampers) * size);
    memset(pushes, 0, sizeof(double) * (MOST_PUSHED + plain->dampers) * size);
#define ROW(i) (rows + (size_t)(i) * size)
#define DRIVE(i) (drives + (size_t)(i) * size)
#define PUSH(i) (pushes + (size_t)(i) * size)
    memcpy(ROW(V_T), plain->c_t, sizeof(double) * size);
    memcpy(ROW(V_N), plain->c_n, sizeof(double) * size);
    ROW(F_N)[plain->spring] = root;
    memcpy(PUSH(0), plain->c_n, sizeof(double) * size); /* the tip's force pushes, */
    DRIVE(0)[plain->spring] = root;
    PUSH(1)[plain->spring] = -root; /* and v_n winds it up */
    memcpy(DRIVE(1), plain->c_n, sizeof(double) * size);
    k = 2;
    if (side) {
        add(PUSH(0), side * mu, plain->c_t, size);
        ROW(F_T)[plain->spring] = side * mu * root;
        if (springy) { /* the spring follows friction */
            memcpy(ROW(SLIDE), plain->c_t, sizeof(double) * size);
            add(ROW(SLIDE), -plain->compliance * side * mu * root * root, plain->c_n, size);
        }
        rate += root * mu * norm_t;
    } else if (springy) {
        ROW(F_T)[plain->shear] = 1 / plain->unit;
        memcpy(PUSH(k), plain->c_t, sizeof(double) * size);
        DRIVE(k++)[plain->shear] = 1 / plain->unit;
        PUSH(k)[plain->shear] = -1 / plain->unit;
        memcpy(DRIVE(k++), plain->c_t, sizeof(double) * size);
        rate += norm_t / plain->unit;
    } else { /* forces along c_t keep v_t at zero: every term is projected by itself, twice */
        double *held = PUSH(k), *of_held = DRIVE(k);
        holding(plain, root, ROW(F_T));
        for (int i = 0; i < size; i++)
            held[i] = plain->c_t[i] / norm_t;
        for (int twice = 0; twice < 2; twice++)
            for (int j = 0; j < k; j++) {
                project(PUSH(j), held, size);
                project(DRIVE(j), held, size);
            }
        free_slope(plain, held, of_held);
        project(of_held, held, size);
        for (int i = 0; i < size; i++)
            held[i] = -held[i];
        k++;
    }
    for (int d = 0; d < plain->dampers; d++, k++) {
        const double *damper = plain->damping + (size_t)d * size;
        memcpy(ROW(4 + springy + d), damper, sizeof(double) * size);
        memcpy(DRIVE(k), damper, sizeof(double) * size);
        add(PUSH(k), -1, damper, size);
    }
    double *weights = (double *)flow->weights, *constants = (double *)flow->constants;
    int g = 0;
    memset(weights, 0, sizeof(double) * MOST_GUARDS * outputs);
    memset(constants, 0, sizeof(double) * MOST_GUARDS);
#define WEIGHT(g, output) weights[(g) * outputs + (output)]
    if (press == LOAD) {
        WEIGHT(g, V_N) = -1;
        names[g++] = COMPRESSED;
    } else {
        WEIGHT(g, F_N) = 1;
        names[g++] = APART;
        WEIGHT(g, F_N) = -1;
        constants[g] = peak;
        names[g++] = RELOADED;
    }
    if (side) {
        WEIGHT(g, springy ? SLIDE : V_T) = -side;
        names[g++] = GRIPPED;
    } else if (mu < HUGE_VAL)
        for (int way = 1; way >= -1; way -= 2) {
            WEIGHT(g, F_N) = mu;
            WEIGHT(g, F_T) = -way;
            constants[g] = plain->slack;
            names[g++] = way > 0 ? SLIPPED : SLIPPED_BACK;
        }
    flow->size = size, flow->turning = plain->turning, flow->at = plain->at, flow->outputs = outputs, flow->pushed = k;
    flow->guards = g, flow->terms = TERMS;
    flow->step = plain->reach / rate;
    flow->omega = plain->omega;
}

/* Integral of the product of two outputs over a cell. */
FAST static double integral(const double *one, const double *other, double (*moments)[TERMS])
{
    double total = 0;
    for (int i = 0; i < TERMS; i++) {
        double inner = 0;
        for (int j = 0; j < TERMS; j++)
            inner += moments[i][j] * other[j];
        total += one[i] * inner;
    }
    return total;
}

/* Add up what a phase loses. */
static void lose(const struct plain *plain, const struct phase *phase, const double *coefficients,
                 const double *lengths, int outputs, double (*moments)[TERMS], struct outcome *outcome, double *damped)
{
    int first = outputs - plain->dampers, slide = plain->shear >= 0 ? SLIDE : V_T;
    for (int c = 0; c < phase->cells; c++) {
        const double *own = coefficients + (size_t)(phase->first + c) * outputs * TERMS;
        double length = lengths[phase->first + c];
        if (phase->side)
            outcome->rubbed -= length * integral(own + F_T * TERMS, own + slide * TERMS, moments);
        for (int d = 0; d < plain->dampers; d++)
            damped[d] += length * integral(own + (first + d) * TERMS, own + (first + d) * TERMS, moments);
    }
}

/* Doubles that `cuefem_contact` needs to work in. */
EXPORTED ptrdiff_t cuefem_contact_room(int size, int outputs, int dampers)
{
    ptrdiff_t pushed = MOST_PUSHED + dampers;
    return (outputs + 2 * pushed + 1) * (ptrdiff_t)size + MOST_GUARDS * ((ptrdiff_t)outputs + 1) +
           cuefem_march_room(size, outputs, (int)pushed);
}

/* Run a contact from its first grip to its end. z: the state. starts: (most_phases, size), the state as each phase starts.
   coefficients: (most_cells, outputs, TERMS); lengths: (most_cells,), s. FOUND: it has ended. MORE: it takes more phases or cells than there is room
   for. Otherwise as `cuefem_march`; what it was given is then as good as lost. */
EXPORTED int cuefem_contact(const struct plain *plain, int side, int press, double *z, struct outcome *outcome,
                            struct phase *phases, double *starts, double *coefficients, double *lengths,
                            double *damped, double *room)
{
    int size = plain->size, springy = plain->shear >= 0, outputs = 4 + springy + plain->dampers, names[MOST_GUARDS];
    int pushed = MOST_PUSHED + plain->dampers;
    double *rows = room, *pushes = rows + (size_t)(outputs + pushed) * size, *weights = pushes + (size_t)pushed * size;
    double *constants = weights + MOST_GUARDS * outputs, *row = constants + MOST_GUARDS, *rest = row + size;
    struct flow flow = {.rows = rows, .pushes = pushes, .weights = weights, .constants = constants};
    double moments[TERMS][TERMS];
    for (int i = 0; i < TERMS; i++)
        for (int j = 0; j < TERMS; j++)
            moments[i][j] = 1.0 / (i + j + 1);
    for (;;) {
        if (outcome->phases == plain->most_phases || outcome->cells >= plain->most_cells)
            return MORE;
        double root = root_of(plain, press);
        if (springy && side) { /* a sliding patch's spring follows friction */
            double force = side * plain->friction * root * z[plain->spring], held = z[plain->shear] / plain->unit;
            outcome->rubbed += plain->compliance * (held * held - force * force) / 2;
            z[plain->shear] = plain->unit * force;
        }
        set_up(plain, side, press, outcome->peak, &flow, names);
        struct phase *phase = phases + outcome->phases;
        memcpy(starts + (size_t)outcome->phases * size, z, sizeof(double) * size);
        struct place place = {.start = outcome->time, .guard = -1};
        double before_t = z[plain->ball_t], before_n = z[plain->ball_n];
        int status = cuefem_stride(&flow, z, &place, plain->longest, plain->most_cells - outcome->cells,
                                   coefficients + (size_t)outcome->cells * outputs * TERMS, lengths + outcome->cells,
                                   rest);
        if (status != FOUND)
            return status;
        phase->side = side, phase->press = press, phase->first = outcome->cells, phase->cells = place.written;
        phase->start = outcome->time, phase->end = outcome->time = place.start, phase->rate = plain->reach / flow.step;
        outcome->phases++;
        outcome->cells += place.written;
        lose(plain, phase, coefficients, lengths, outputs, moments, outcome, damped);
        if (springy && side)
            z[plain->shear] = plain->unit * side * plain->friction * root * z[plain->spring];
        else if (!springy && !side)
            add(z, -product(plain->c_t, z, size) / product(plain->c_t, plain->c_t, size), plain->c_t, size);
        phase->impulse_t = (z[plain->ball_t] - before_t) / plain->c_t[plain->ball_t];
        phase->impulse_n = (z[plain->ball_n] - before_n) / plain->c_n[plain->ball_n];
        switch (names[place.guard]) {
        case APART: return FOUND;
        case COMPRESSED:
            outcome->peak = root * z[plain->spring];
            z[plain->spring] *= plain->restitution;
            press = UNLOAD;
            break;
        case RELOADED:
            z[plain->spring] /= plain->restitution;
            press = LOAD;
            break;
        case GRIPPED:
            side = 0;
            if (!springy) { /* stick where friction can hold the contact */
                holding(plain, root, row);
                double force = product(row, z, size), normal = root * z[plain->spring];
                if (!(fabs(force) <= plain->friction * normal + plain->slack))
                    side = force > 0 ? 1 : -1;
            }
            break;
        case SLIPPED: side = 1; break;
        default: side = -1;
        }
    }
}
