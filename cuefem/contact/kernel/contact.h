/* One contact of ball and tip (handbook: The contact).

   Between the forces of the contact, cue and ball move linearly. Over a step the forces are polynomials through Q nodes,
   and the answer of the cue's modes to them is known exactly. What is left are the forces at the nodes, which a law
   ties to the velocities of the contact v, to their integrals x, and to the forces themselves: g(F, v, x) = 0.

   The cue is read and pushed through ports: the velocities of its tip along and across it, and its turning. The ball's
   velocities are ports too. A matrix C turns the ports' velocities y into those of the contact, v = C y, and the
   contact's forces into loads on the ports, C' F, so that no energy is made on the way. C changes as the contact rolls.

   The blow's thrust along the cue bends it further where it is bent: the geometric stiffness. With slopes s_a, of rows
   over the modes with the weights c_a, the tip goes back along the cue by sum of c_a s_a^2/2, so that its port along the
   cue reads sum of c_a s_a s_a' less, and a load L on that port loads each row by -c_a s_a L.

   Python fills a Contact and reads it when the contact is over; it keeps a Cue for all strikes with it. */
#ifndef CUEFEM_CONTACT_H
#define CUEFEM_CONTACT_H

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#if defined(_WIN32)
#define EXPORTED __declspec(dllexport)
#else
#define EXPORTED __attribute__((visibility("default")))
#endif

/* A copy of a function for processors with AVX2, chosen when the library is loaded, where that is possible. */
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define FAST __attribute__((target_clones("arch=skylake-avx512", "avx2", "default")))
#else
#define FAST
#endif

enum {
    Q = 14,            /* nodes of a step, its end among them */
    WITH = Q + 1,      /* its start and its nodes */
    TERMS = 112,       /* of the series of a mode's response */
    LOOKS = 3 * Q + 3, /* places where a guard is looked at */
    POINTS = Q + 2,    /* Gauss points of an integral over a step */
    LEVELS = 72,       /* a step lasts 2^(LONGEST_POWER - level) s */
    LONGEST_POWER = 6,
    PORTS = 3, /* of the cue, at most */
    SPEEDS = 6,        /* of the ball, at most */
    ALL_PORTS = PORTS + SPEEDS,
    FORCES = 6, /* of a contact, at most */
    SLOPES = 32 /* of a bent cue, at most */
};
enum { STICK = 0, SLIP = 1, SLIP_BACK = -1, BLOW = 2, APART_GRIP = 3 };
enum { LOAD, UNLOAD, RIGID, FREE };
enum { RIGID_PATCH, SPRING_PATCH, RINGED_PATCH };
enum { POWER_CURVE, LEATHER_CURVE };
enum { HELD, SLIDES, LIFTED };
enum { NONE, COMPRESSED, APART, RELOADED, GRIPPED, SLIPPED, SLIPPED_BACK, TOUCHED, LATE_FLIGHT,
       LIFTED_OFF, LANDED, STOPPED, SLID };
enum { ENDED, LATE, CROWDED, STUCK, TOO_DEEP, TURNED_TOO_FAR, BENT_TOO_FAR, NO_MEMORY };

static inline double larger(double a, double b)
{
    return a > b ? a : b;
}

/* Add to Q numbers a matrix of Q rows times a vector, times a number. */
static inline void add_product(int columns, const double *matrix, const double *vector, double by, double *to)
{
    double sum[Q] = {0};
    for (int j = 0; j < columns; j++)
        for (int i = 0; i < Q; i++) sum[i] += matrix[j * Q + i] * vector[j];
    for (int i = 0; i < Q; i++) to[i] += by * sum[i];
}

/* The tables of a step's rule, as `cuefem.contact.rule` makes them. Polynomials of forces go through the nodes, those of
   velocities through the start too. Matrices stand by columns, here and everywhere: [j][i] leads from j to i. */
typedef struct {
    double nodes[Q];
    double sums[WITH][Q];       /* velocities -> their integrals up to each node */
    double force_sums[Q][Q];    /* forces -> likewise */
    double waves[WITH][WITH];   /* velocities -> Legendre's coefficients */
    double force_waves[Q][Q];   /* forces -> likewise */
    double first[Q];            /* forces -> that at the start */
    double slopes[Q][WITH];     /* forces -> their rates at the start and the nodes, per step */
    double convolved[TERMS][Q][Q]; /* integral over [0, c_i] of P_t(2 (c_i - s) - 1) l_j(s) ds */
    double shortened[Q][Q][Q];  /* forces -> Legendre's coefficients over [0, c_i] */
    double looks[LOOKS], look[WITH][LOOKS];
    double gauss[POINTS], weights[POINTS];
} Rule;

extern EXPORTED Rule rule;

/* What forces over a step of one length make of the modes. */
typedef struct {
    double step;
    double *turns;   /* (modes, 2, Q), real and imaginary: exp(rate c_i step) */
    double *moments; /* (modes, 2, Q): integrals over the step of exp(rate (step - s)) P_t, over the step */
    double *answer;  /* (reads, ports, Q, Q): from loads at the nodes to readings there */
    double *bending; /* (channels, Q, Q): what loads at the nodes make of each channel of the slopes */
} Response;

/* The modes of a cue; rates, readings and drives are complex: xi' = rates xi + drives' load, y = Re(readings xi). */
typedef struct {
    int modes, ports, slopes, reads; /* rows of readings: ports, slopes, those whose squares are the power of dampers */
    double *rates, *readings, *drives; /* (modes,), (reads, modes), (ports + slopes, modes) */
    /* Loads on the slopes reach the readings through real channels, one of a coordinate that nothing damps, else four:
       with the reading r and the drive d, Re(r m d) = r' d' m' - r" d" m' - r' d" m" - r" d' m". */
    int channels, *channel_of; /* twice the coordinate, and one more where it is the imaginary part m" that counts */
    double *channel_drives, *channel_readings; /* (channels, slopes), (reads, channels) */
    double inverse_mass[PORTS + SLOPES][PORTS + SLOPES];
    Response *responses[LEVELS];
} Cue;

typedef struct {
    int grip, press, table;
} Hold;

/* A step that was solved: values at its start and its nodes. */
typedef struct {
    int level;
    double step;
    double F[FORCES][WITH], v[FORCES][WITH], x[FORCES][WITH], depth[WITH], angle[WITH];
    double loads[ALL_PORTS][Q], slope_loads[SLOPES][Q], slopes[SLOPES][WITH];
    double *damped; /* (dampers, WITH): what reads them */
} Step;

typedef struct {
    /* what Python gives */
    Cue *cue;
    const double *facing;     /* (forces, ports + ball): C at the first touch */
    const double *ball_gives; /* (ball,): the inverse masses of the ball's velocities */
    const double *force_terms, *give_terms; /* of leather's law */
    const double *lever_terms; /* (2, levers): Chebyshev terms of how the levers' (u, w) change with the angle */
    const double *ring_edges, *ring_forces, *ring_slopes, *ring_stiffness; /* (rings + 1,) */
    double *xi;               /* (modes,) complex */
    double *ball;             /* (ball,): its velocities */
    double *ring_shear;       /* (rings,): the force along the surface that each ring bears */
    const double *slope_weights; /* (slopes,): c_a of a bent cue */
    double *slopes;              /* (slopes,): s_a */
    int forces, speeds, turns, curve, patch, lossy, terms, levers, rings, recording;
    int plane; /* slopes in a plane of bending; the last of them is the rotation of the tip */
    double restitution, friction, table_friction, stiffness, exponent, most, compliance, first_ratio,
        surface_restitution;
    double phi, dome, rim, radius, lever_t, lever_n, lever_reach;
    double speed, across, clock, impulse, tolerance, longest, window, most_phases, most_steps; /* across: part of the speed
                                                                                                   along the surface */
    /* what it gets */
    double time, depth, angle, shear, deepest, peak, height;
    double friction_loss, shear_loss, table_loss, damping_loss, radiated;
    double thrust, steepest; /* where the tip has turned furthest, N and rad */
    int status, parted, grip, press, steps, tried, rounds, phase_count, record_count, row;
    double *phases;  /* (phase_count, 4 + 2 speeds): grip, press, start, end, the ball's velocities then */
    double *records; /* (record_count, row): see records.c */
} Contact;

/* What goes on in a contact: the step in hand, the matrix C, and what is known of a hold. */
typedef struct Work Work;
typedef struct { /* g = 0, and how it changes with F, v and x of the same node */
    double g[FORCES][Q], on_F[FORCES][FORCES][Q], on_v[FORCES][FORCES][Q], on_x[FORCES][FORCES][Q];
} Residual;
typedef struct {
    int event;
    double values[WITH], past;
} Guard;

/* Of the first forces alone: most contacts have few. */
static inline void clear(Residual *r, int forces)
{
    memset(r->g, 0, forces * sizeof r->g[0]), memset(r->on_F, 0, forces * sizeof r->on_F[0]);
    memset(r->on_v, 0, forces * sizeof r->on_v[0]), memset(r->on_x, 0, forces * sizeof r->on_x[0]);
}

#define GUARD(name, slack, expression)                                   \
    do {                                                                 \
        to[count].event = name, to[count].past = slack;                  \
        for (int i = 0; i < WITH; i++) to[count].values[i] = expression; \
        count++;                                                         \
    } while (0)

typedef struct { /* of a matrix with scaled rows: its triangles and the order of its rows */
    double matrix[FORCES * Q * FORCES * Q], scale[FORCES * Q];
    int pivots[FORCES * Q];
} Factor;

/* A law of the contact: which forces it asks for, what ends a phase, and what follows. */
typedef struct {
    int (*first_grip)(Work *, int press);
    void (*begin)(Work *);
    void (*settle)(Work *); /* take away what rounding left of the velocities that the hold keeps at zero */
    void (*residual)(Work *, const Step *, Residual *);
    int (*guards)(Work *, const Step *, Guard *);
    void (*taken)(Work *, const Step *, double part);
    int (*next)(Work *, int event); /* whether the contact goes on, in the hold that it sets */
} Law;

struct Work {
    Contact *c;
    const Law *law;
    Hold hold;
    double C[WITH][FORCES][ALL_PORTS];
    int level, linear, known; /* known: whether a step was taken, whose forces the next one may begin with */
    double last_part, last_step, last_F[FORCES][Q], last_angle[Q];
    double blows[ALL_PORTS + SLOPES]; /* impulses on ports and slopes since the last record */
    double *V[LEVELS], V_angle[LEVELS]; /* answers of the contact to its forces, as it faced at an angle */
    Factor *factors[LEVELS][16];
    Step step;
    Residual residual;
    double way[2][2]; /* of a raised cue: the directions of its two frictions */
};

/* Each file below calls those above it alone. */

/* rule.c */
double legendre(const double *waves, int count, double part);
void to_waves(const double *values, double *waves);
double value_at(const double *values, double part);
double first_fall(const double *values, double past);
double work_of(const double *force, const double *velocity, double span, double part);
void waves_over(const double *forces, double part, double *waves);

/* matrix.c */
int factor(int n, Factor *to);
void solve_factored(int n, const Factor *by, double *b);

/* modes.c */
Response *response_of(Cue *cue, int level);
void advance_modes(const Cue *cue, double *xi, const Response *whole, double time, const double (*waves)[Q]);

/* bent.c */
int dampers_of(const Cue *cue);
void shorten_now(const Contact *c, double *y, double *rate);
void load_slopes(const Contact *c, double along, double *to);
void gives_now(const Contact *c, double gives[PORTS][PORTS]);
void add_bending(const Contact *c, const Response *r, const Step *s, int first, int last, double (*y)[WITH]);
double bend_step(const Contact *c, const Response *r, Step *s, double (*y)[WITH]);
void begin_slopes(const Contact *c, Step *s);
int take_slopes(Contact *c, const Step *s, double part);

/* normal.c */
void curve_at(const Contact *c, double depth, double *F, double *slope, double *k);
double virtual_depth(const Contact *c, int press, double depth);
double give_of(const Contact *c, int press);
double rest_of(const Contact *c);
double pressing(const Contact *c, int press, double depth);

/* ports.c */
void facing_at(const Contact *c, double angle, double C[FORCES][ALL_PORTS]);
double rolls_on(const Contact *c, double angle);
void velocities_now(Work *w, double *v);
void accelerations_now(Work *w, double *a);
void contact_gives(const Work *w, double B[FORCES][FORCES]);
void push(Work *w, const double *impulses);
double blow(Work *w, const int *held, int count);

/* step.c */
int clock_level(const Contact *c);
int solve_step(Work *w, int level, Step *s);
int forces_held(Work *w, Hold hold, double *F, int node);
int longest_step(Work *w);

/* records.c */
int record(Work *w, const Step *s, double part);
void end_phase(Work *w, Hold hold, double start, const double *ball_before);

/* rings.c */
void rings_at_nodes(Work *w, const Step *s, Residual *r);
double rings_take(Work *w, const Step *s, double part);
double rings_store(const Contact *c, int press, double depth);

/* laws.c */
extern const Law planar;

/* raised.c */
extern const Law raised;

#endif
