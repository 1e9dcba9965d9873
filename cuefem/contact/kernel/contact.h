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
   load them by C' F, so that energy is conserved. A dashpot is one more port of the cue, whose force opposes
   its mean velocity over the step.

   Python fills a Contact and calls contact_steps, with StepTables of the length Contact.next_step, until the
   status is no longer RUNNING.
 */
#ifndef CUEFEM_CONTACT_H
#define CUEFEM_CONTACT_H

#include <math.h>
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
    ANNULI = 256
};
/* Ports of the cue: axial and lateral velocity of the tip; the third is the rotation rate of its section or,
   of a raised cue, the velocity out of the plane of the first two. */
enum { U_PORT, W_PORT, THIRD_PORT };
/* Components of the contact's forces F and velocities v. At the tip: tangential, normal, out of the plane; at
   the ball's point on the table: upwards, lateral, forwards. A level cue has the first two, a raised one (the
   effect Elevation) all six. */
enum { T, N, P, UP, LATERAL, FORWARD };
enum { STICK = 0, SLIP = 1, SLIP_BACK = -1, IMPACT = 2, SEPARATED = 3 }; /* friction states */
enum { LOADING, UNLOADING, FREE };                                       /* normal phases */
enum { RIGID_PATCH, SPRING_PATCH, PARTIAL_SLIP }; /* tangential compliance of the tip */
enum { POWER_LAW, LEATHER_LAW };
enum { RUNNING, ENDED, TIME_LIMIT, INDENTATION_OUT_OF_RANGE, SLOPE_OUT_OF_RANGE, UNSOLVED };

/* One step, or an impact: a step of zero length whose F is an impulse, N s. */
typedef struct {
    double time, length;          /* at the end of the step; of the step, s */
    double friction_state, phase; /* of the step */
    double angle;                 /* rolled by the end of the step, rad */
    double F[FORCES];             /* over the step, N */
    double v[FORCES];             /* of the contact at the end of the step, m/s */
    double ball[BALL_VELOCITIES]; /* velocities of the ball at the end of the step, m/s */
} Step;

/* Input and results of a contact; lengths of arrays are given by the first line. */
typedef struct {
    int modes, ports, slopes, forces, speeds; /* speeds: velocities of the ball */
    int planes;                               /* planes in which the cue bends, 1 or 2 */
    int rolling;                              /* whether the contact rolls over ball and dome */
    int law, terms, patch, annuli;            /* terms: of the leather law's series */
    int dashpots, radiating;        /* numbers of dashpots, and of modes that radiate */
    int structural_loss;            /* whether modes have loss factors */
    const int *radiating_modes;     /* indices of the modes that radiate, (radiating,) */
    const double *omega;            /* (modes,), rad/s */
    const double *rows;             /* (ports + slopes + dashpots, modes), 1/sqrt(kg): velocities are rows v */
    const double *mobility;         /* of ports and slopes, 1/kg */
    const double *kinematics;       /* C at the first touch, (forces, ports + speeds) */
    const double *inverse_masses;   /* of the ball's velocities, (speeds,), 1/kg */
    const double *slope_weights;    /* of each slope in the tip's axial shortening, (slopes,) */
    const double *force_terms;      /* leather: F = d^(3/2) times a series in the root of the indentation d */
    const double *compliance_terms; /* tangential compliance: such a series over the root of d */
    const double *annulus_edges;    /* indentations at which the annuli begin, (annuli + 1,), m */
    const double *annulus_forces;   /* F at the edges, N */
    const double *annulus_slopes;   /* dF/dd at the edges, N/m */
    const double *annulus_stiffness; /* tangential stiffness at the edges, N/m */
    double *state, *ball; /* of the modes, v and a, (2, modes), and of the ball: before the first touch; after
                             the last separation */
    double restitution, friction;    /* of the tip */
    double table_friction;
    double stiffness, exponent;    /* power law F = stiffness d^exponent */
    double indentation_limit;      /* largest indentation of the leather law, m */
    double compliance;             /* of a spring patch, m/N */
    double surface_restitution;    /* its square: recovered part of an annulus's strain energy */
    double phi, dome, rim;         /* angle of the first touch, rad; radius of the dome, m; its end, rad */
    double radius;                 /* of the ball, m */
    double arm_t, arm_n;           /* moment arms of (t, n) about the end section at the first touch, m */
    double step, max_time, window; /* step; longest contact; time followed after the first separation, s */
    double next_step;              /* length of the next step, s */
    double time, indentation, max_indentation; /* s; indentation and its maximum, m */
    double angle;                  /* rolled, rad */
    double height;                 /* of the ball above the table, m */
    double shear_loss;             /* dissipated strain energy of the patch, J */
    double damping_loss, radiated; /* by dashpots and loss factors; by waves, up to the last separation, J */
    double axial_force;            /* on the cue at its largest slope, N */
    double max_slope;              /* of the cue's end, rad */
    double work[FORCES];           /* dissipated by each force, J */
    int status, friction_state, steps, steps_to_last_separation;
} Contact;

/* What the modes do in a step of one length (modal_response.py, where the shapes are). */
typedef struct {
    double h;                                     /* s */
    const double *own;                            /* of each mode by itself: v per v, a per v, a per a */
    const double *ends, *means;                   /* from the state to the velocities of ports and slopes */
    const double *end_per_load, *mean_per_load;   /* velocities per load on ports and slopes */
    const double *response;                       /* change of the state per load */
    const double *dashpots;                       /* forces of the dashpots from the state and the loads */
    const double *loss;                           /* energy lost by each mode */
    const double *radiating;                      /* modes that radiate, from their state and loads */
    const double *radiated, *dissipated;          /* their losses, quadratic forms in state and loads */
} StepTables;

typedef struct Work Work;

/* Normal force of a loading tip, N, and its slope, N/m, at an indentation > 0, m. */
typedef double Law(const Contact *c, double indentation, double *slope);

/* Two equations g = 0 for the forces (F_t, F_n) of a level contact, and their derivatives. */
typedef struct {
    double g[2], J[2][2];
} Equations;

/* A tip by its tangential compliance (patch_*.c). */
typedef struct {
    int slips_in_parts; /* the patch itself limits its force to mu F_n */
    void (*stick)(Work *w, const double *u, Equations *e); /* row T of the equations, where the tip sticks */
    void (*keep)(Work *w, double middle);  /* state after a step in contact; middle: shift in its middle, m */
    void (*release)(Work *w, double shift); /* loss of strain energy at separation */
    int (*friction_state)(const Work *w);   /* of the last step */
} Patch;

extern const Patch rigid_patch, spring_patch, partial_slip;

/* State of a contact, and the equations of the step under way. */
struct Work {
    Contact *c;
    StepTables t;
    Law *law;                 /* the variants of this contact, chosen by contact_new */
    const Patch *patch;
    int (*solve_forces)(Work *w); /* returns whether the forces converged */
    double *state;                 /* of the modes */
    double *loads;                 /* on ports, slopes and dashpots */
    double *group;                 /* state and loads of the modes that radiate */
    double damping_loss, radiated; /* so far, J */
    double ball[BALL_VELOCITIES];
    double port_velocities[CUE_VELOCITIES]; /* of ports and slopes */
    double slopes[SLOPES];
    double C[FORCES][VELOCITIES], v[FORCES], u[FORCES], u_stick[FORCES]; /* contact_matrices */
    double V[FORCES][FORCES], W[FORCES][FORCES];
    double end_free[CUE_VELOCITIES], mean_free[CUE_VELOCITIES]; /* of ports and slopes without loads */
    double F[FORCES];
    double axial_force;           /* on the cue, N */
    double rolling_rate;          /* rad/s */
    double shift, shift_mid;      /* of the tip along t against the ball, m; at the middle of the last step */
    double origin;                /* shift at which a spring patch is unstrained, m */
    double virtual_mid;           /* virtual indentation at the middle of the last step, m; see laws.c */
    double annulus_force[ANNULI]; /* at the middle of the last step, N */
    double virtual_now, annulus_force_now[ANNULI], annuli_loss; /* the same in this step; dissipated, J */
    double window_end, deadline; /* of the window after separation; of this contact, s */
    int phase, slip;             /* slip: its direction, or STICK; a PARTIAL_SLIP patch keeps STICK */
    int tip_stuck, on_table,
        table_stuck;   /* in the last step: tip sticks; table presses the ball; it sticks */
    int on_table_now, table_sticks_now; /* in this step */
    int ends_at_event; /* whether the step was shortened to end at separation or touch */
};

enum { MAX_ITERATIONS = 40 };
/* Relative change of the forces per iteration at convergence, and the largest accepted after the last one. */
static const double REL_TOL = 1e-12, REL_TOL_ACCEPTED = 1e-7;
static const double MIN_FORCE = 1e-9; /* N, least scale of the relative change */

static inline double larger(double a, double b) { return a > b ? a : b; }

/* modes.c */
void free_motion(Work *w);
void load_modes(Work *w, const double *cue_loads);
void add_losses(Work *w);
void advance_modes(Work *w);
void apply_impulses(Work *w, const double *impulses);

/* laws.c */
double power_law(const Contact *c, double indentation, double *slope);
double leather_law(const Contact *c, double indentation, double *slope);
double tip_force(const Work *w, int phase, double indentation, double *slope, double *virtual);
double residual(const Contact *c);
double unloading_scale(const Contact *c, int phase);
double tangential_stiffness(const Contact *c, double virtual);

/* kinematics.c */
void contact_kinematics(const Work *w, double angle, const double *slopes, double C[FORCES][VELOCITIES]);
void contact_matrices(Work *w);
void velocities(const Work *w, double *end, double *mean);

/* level.c, raised.c, impact.c */
int level_forces(Work *w);
int raised_forces(Work *w);
int raised_impulses(Work *w);
int impact(Work *w, Step *row);

/* step.c */
int take_step(Work *w, Step *row);
void next_phase(Work *w, double v_n);
void separate(Work *w);

#endif
