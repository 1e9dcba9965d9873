/* One contact of ball and tip by fixed time steps (handbook: The contact).

   Between the contact's forces, cue and ball move linearly. Over a step of length h the forces are constant,
   and every mode of the cue answers them exactly (modal propagation). The normal force follows the
   force-indentation law at mid-step. Coulomb friction is a return mapping, as in plasticity: trial stick,
   then |F_t| is projected onto mu F_n. Second order in h. One shortened step ends at separation or touch;
   changes between stick and slip or loading and unloading are not located. J. J. Moreau, Unilateral contact
   and dry friction in finite freedom dynamics (1988); M. Jean, The non-smooth contact dynamics method,
   Comput. Methods Appl. Mech. Engrg. 177 (1999) 235.

   A mode of angular frequency omega is its velocity v and a = omega q, its displacement in the same unit. The
   cue has ports (axial and lateral velocity of its tip, rotation rate) and the slopes of the bent shaft; the
   ball has its velocities. With y all these velocities, the contact's velocities are v = C y and its forces F
   load them by C' F, so that energy is conserved. There are two velocities: v is that at the end of a step, u
   its mean over the step. Both are of the ball against the tip, so that v_n > 0 while the two part. A dashpot is
   one more port of the cue, whose force opposes its mean velocity over the step.

   An impact of infinite friction is a step of zero length, whose forces and loads are impulses, N s.

   Python fills an Input and a State and calls contact_steps, with StepTables of the length State.next_step,
   until the status is no longer RUNNING. Each step leaves a record, a Step.

   Arguments stand in this order: in, t (constant: of the contact, of the step's length), s (what one step
   leaves to the next), w (the step under way, written anew by each step). What a function does not change is
   const.
 */
#ifndef CUEFEM_CONTACT_H
#define CUEFEM_CONTACT_H

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#if defined(_WIN32)
#define EXPORTED __declspec(dllexport)
#else
#define EXPORTED __attribute__((visibility("default")))
#endif

/* Function versions for AVX2 and AVX-512, selected at load time, where the platform supports it. */
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GLIBC__) && defined(__GNUC__) &&              \
    !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define FAST __attribute__((target_clones("arch=skylake-avx512", "avx2", "default")))
#else
#define FAST
#endif

/* Largest numbers of ports, slopes, velocities (of the cue, of the ball, both), forces and annuli. */
enum {
    PORTS = 3,
    SLOPES = 32,
    CUE_VELOCITIES = PORTS + SLOPES,
    BALL_VELOCITIES = 6,
    VELOCITIES = CUE_VELOCITIES + BALL_VELOCITIES,
    FORCES = 6,
    ANNULI = 120
};
/* Ports of the cue: axial and lateral velocity of the tip; the third is the rotation rate of its section or,
   of a raised cue, the velocity out of the plane of the first two. */
enum { AXIAL_PORT, LATERAL_PORT, THIRD_PORT };
/* Of the velocities of the ball, (t, n) of its centre come first; then, of a level cue, R times its spin. */
enum { BALL_SPIN = 2 };
/* Components of the contact's forces F and velocities v. At the tip: tangential, normal, out of the plane; at
   the ball's point on the table: upwards, lateral, forwards. A level cue has the first two, a raised one (the
   effect Elevation) all six. */
enum { T, N, P, UP, LATERAL, FORWARD };
enum { STICK = 0, SLIP = 1, SLIP_BACK = -1, IMPACT = 2, SEPARATED = 3 }; /* friction states */
enum { LOADING, UNLOADING, FREE };                                       /* normal phases */
enum { RIGID_PATCH, SPRING_PATCH, PARTIAL_SLIP }; /* tangential compliance of the tip */
enum { POWER_LAW, LEATHER_LAW };
enum { RUNNING, ENDED, TIME_LIMIT, INDENTATION_OUT_OF_RANGE, SLOPE_OUT_OF_RANGE, UNSOLVED };

/* Record of a step. */
typedef struct {
    double time, length;           /* at the end of the step; of the step, s */
    double friction_state, phase;  /* of the step */
    double angle;                  /* rolled by the end of the step, rad */
    double damping_loss, radiated; /* up to the end of the step, J; as in State */
    double F[FORCES];              /* over the step, N; of an impact N s */
    double v[FORCES];              /* of the contact at the end of the step, m/s */
    double ball[BALL_VELOCITIES];  /* velocities of the ball at the end of the step, m/s */
} Step;

/* What is constant during a contact; lengths of arrays are given by the first line. */
typedef struct {
    int modes, ports, slopes, forces, speeds; /* speeds: velocities of the ball */
    int planes;                               /* planes in which the cue bends, 1 or 2 */
    bool rolling;                             /* whether the contact rolls over ball and dome */
    int law, terms, patch;                    /* terms: of the leather law's series */
    int dashpots, radiating;                  /* numbers of dashpots, and of modes that radiate */
    bool structural_loss;                     /* whether modes have loss factors */
    bool begins_with_impact;      /* whether an impulse stops the tangential motion at the first touch */
    const int *radiating_modes;   /* indices of the modes that radiate, (radiating,) */
    const double *omega;          /* (modes,), rad/s */
    const double *rows;           /* (ports + slopes + dashpots, modes), 1/sqrt(kg): velocities are rows v */
    const double *kinematics;     /* C at the first touch, (forces, ports + speeds) */
    const double *inverse_masses; /* of the ball's velocities, (speeds,), 1/kg */
    const double *slope_weights;  /* of each slope in the tip's axial shortening, (slopes,) */
    const double *force_terms;    /* leather: F = d^(3/2) times a series in the root of the indentation d */
    const double *compliance_terms; /* tangential compliance: such a series over the root of d */
    double restitution, friction;   /* of the tip */
    double table_friction;
    double stiffness, exponent;  /* power law F = stiffness d^exponent */
    double indentation_limit;    /* largest indentation of the law, m */
    double compliance;           /* of a spring patch, m/N */
    double annuli_end;           /* indentation that the annuli divide, m */
    double surface_restitution;  /* its square: recovered part of an annulus's strain energy */
    double phi, dome, rim;       /* angle of the first touch, rad; radius of the dome, m; its end, rad */
    double radius;               /* of the ball, m */
    double arm_t, arm_n;         /* moment arms of (t, n) about the end section at the first touch, m */
    double step, unloading_step; /* length of a step; of one while the tip unloads, s */
    double max_time, window;     /* longest contact; time followed after the first separation, s */
    double bounce_speed;         /* a ball that is slower along n, m/s, has been left by a bounce */
    double bounce_window;        /* time followed after a bounce, s */
} Input;

/* What one step leaves to the next. Python fills the first four; the rest begins as zero. */
typedef struct {
    double *modes;                          /* v and a, (2, modes) */
    double *separated_modes;                /* the same after the last separation */
    double ball[BALL_VELOCITIES];           /* velocities, m/s */
    double mean_velocities[CUE_VELOCITIES]; /* of ports and slopes over the last step */
    int status, steps, steps_to_last_separation;
    int phase, friction_state;
    double time, next_step;      /* s; length of the next step, s */
    double deadline, window_end; /* of this contact; of the window after separation, s */
    bool ends_at_event;          /* whether the next step was shortened to end at separation or touch */
    double indentation, max_indentation; /* m */
    double angle, rolling_rate;          /* rolled, rad; rad/s */
    double height;                       /* of the ball above the table, m */
    double slopes[SLOPES];
    double max_slope, axial_force; /* largest slope of the cue's end, rad; the force on the cue then, N */
    bool tip_stuck;                /* in the last step */
    bool on_table, table_stuck;    /* in the last step: the table presses the ball; its lowest point sticks */
    double last_F[FORCES], former_F[FORCES]; /* of the last step in contact and the one before it, N */
    double virtual_mid;           /* virtual indentation of leather at the middle of the last step, m */
    double shift, shift_mid;      /* of the tip along t against the ball, m; at the middle of the last step */
    double origin;                /* shift at which a spring patch is unstrained, m */
    double annulus_force[ANNULI]; /* at the middle of the last step, N */
    double work[FORCES];          /* dissipated by each force so far, J */
    double shear_loss;            /* dissipated strain energy of the patch so far, J */
    double damping_loss, radiated; /* by dashpots and loss factors, and by waves, so far, J */
} State;

/* What the modes do in a step of one length (shapes: declarations.py). */
typedef struct {
    double h;                   /* s */
    double load_time;           /* impulse per load, s: h; 1 in an impact, whose loads are impulses */
    const double *own;          /* of each mode by itself: v per v, a per v, a per a */
    const double *ends, *means; /* from the state to the velocities of ports and slopes */
    const double *end_per_load, *mean_per_load; /* velocities per load on ports and slopes */
    const double *response;                     /* change of the state per load */
    const double *dashpots;                     /* forces of the dashpots from the state and the loads */
    const double *radiating;                    /* modes that radiate, from their state and loads */
} StepTables;

/* Normal force of the tip at an indentation: force, N, and slope, N/m. An unloading tip has the force of the
   loading curve at a smaller, virtual indentation, m; scale: change of the indentation per change of that. */
typedef struct {
    double force, slope, virtual, scale;
} NormalForce;

/* An edge between two annuli of leather: a virtual indentation, m, and there the normal force, N, its slope
   and the tangential stiffness, N/m. */
typedef struct {
    double indentation, force, slope, stiffness;
} Edge;

/* Two equations g = 0 for the forces (F_t, F_n) of a level contact, and their derivatives. */
typedef struct {
    double g[2], J[2][2];
} Equations;

/* The step under way, from its free motion to its forces and velocities. */
typedef struct {
    double end_free[CUE_VELOCITIES], mean_free[CUE_VELOCITIES]; /* of ports and slopes without loads */
    double C[FORCES][VELOCITIES];                               /* v = C y, at mid-step */
    double shortening[SLOPES];                    /* of the cue per slope, m: columns of C over -C_u */
    double end_per_force[FORCES][CUE_VELOCITIES]; /* of ports and slopes, per force of the contact */
    double mean_per_force[FORCES][CUE_VELOCITIES];
    double v_free[FORCES], u_free[FORCES];       /* v and u without forces */
    double u_stick[FORCES];                      /* u of a point that sticks */
    double V[FORCES][FORCES], W[FORCES][FORCES]; /* matrices of v = v_free + V F and u = u_free + W F */
    double F[FORCES], v[FORCES], u[FORCES];      /* the step's forces, N, and velocities */
    bool on_table, table_stuck;                  /* of a raised cue, as in State */
    int slip;                     /* direction of a patch that slips as a whole; STICK of annuli, too */
    NormalForce normal;           /* of a level cue, at mid-step */
    const Edge *edges;            /* of the annuli, (ANNULI + 1,): the same for all steps */
    double annulus_force[ANNULI]; /* at mid-step, N; State has that of the last step */
    double annuli_loss;           /* dissipated in the step, J */
    double axial_force;           /* on the cue, N */
    double mean_spin;             /* of the ball, times its radius, m/s */
    double ball_loads[BALL_VELOCITIES];
    double *loads;     /* on ports, slopes and dashpots */
    double *radiating; /* state and loads of the modes that radiate */
    double *before;    /* state of the modes before the step */
} Work;

/* A tip by its tangential compliance (patch_*.c). */
typedef struct {
    bool slips_in_parts; /* the patch itself limits its force to mu F_n */
    /* row T of the equations of a sticking tip */
    void (*stick)(const Input *in, double h, const State *s, Work *w, Equations *e);
    void (*update)(const Input *in, State *s, const Work *w);  /* after a step in contact */
    void (*release)(const Input *in, State *s, const Work *w); /* loss of strain energy at separation */
    int (*friction_state)(const Input *in, const State *s, const Work *w); /* of the step */
} Patch;

extern const Patch rigid_patch, spring_patch, partial_slip;

static inline const Patch *patch_of(const Input *in)
{
    static const Patch *const patches[] = {
        [RIGID_PATCH] = &rigid_patch, [SPRING_PATCH] = &spring_patch, [PARTIAL_SLIP] = &partial_slip};
    return patches[in->patch];
}

enum { MAX_ITERATIONS = 40 };
/* Relative change of the forces per iteration at convergence, and the largest accepted after the last one. */
static const double REL_TOL = 1e-12, REL_TOL_ACCEPTED = 1e-7;
static const double MIN_FORCE = 1e-9; /* N, least scale of the relative change */

static inline double larger(double a, double b) { return a > b ? a : b; }
static inline bool touches(const State *s) { return s->phase != FREE; }
static inline bool is_raised(const Input *in) { return in->forces == FORCES; }

/* modes.c */
double product(const double *a, const double *b, int count);
void free_motion(const Input *in, const StepTables *t, const State *s, Work *w);
void load_modes(const Input *in, const StepTables *t, const State *s, Work *w);
void advance_modes(const Input *in, const StepTables *t, State *s, Work *w);
void add_losses(const Input *in, const StepTables *t, State *s, const Work *w);

/* laws.c */
NormalForce normal_force(const Input *in, const State *s, double indentation);
NormalForce loading_curve(const Input *in, double indentation);
double residual_indentation(const Input *in, const State *s);
double tangential_stiffness(const Input *in, double virtual);

/* kinematics.c */
void contact_matrices(const Input *in, const StepTables *t, const State *s, Work *w);
void velocities(const Input *in, Work *w);

/* level.c, raised.c: the forces of a step, the impulses of an impact. They return whether they were found. */
bool level_forces(const Input *in, double h, const State *s, Work *w);
bool level_impulses(const Input *in, const State *s, Work *w);
bool raised_forces(const Input *in, double h, const State *s, Work *w);
bool raised_impulses(const Input *in, const State *s, Work *w);

/* patch_partial_slip.c */
void find_edges(const Input *in, Edge edges[ANNULI + 1]);

/* phases.c */
double full_step(const Input *in, const State *s);
void update_tip(const Input *in, double h, State *s, const Work *w);
void next_phase(const Input *in, State *s, const Work *w);
void separate(const Input *in, State *s, const Work *w);

/* step.c */
bool take_step(const Input *in, const StepTables *t, State *s, Work *w, Step *row);
bool take_impact(const Input *in, const StepTables *t, State *s, Work *w, Step *row);

#endif
