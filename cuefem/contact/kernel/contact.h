/* One contact of ball and tip by fixed time steps (handbook: The contact).

   Between the contact's forces, cue and ball move linearly. Over a step of length h the forces are constant,
   and every mode of the cue answers them exactly (modal propagation). The normal force follows the
   force-indentation law at mid-step. Coulomb friction is a return mapping, as in plasticity: trial stick,
   then |F_t| is projected onto mu F_n. Second order in h; no event is located. J. J. Moreau, Unilateral
   contact and dry friction in finite freedom dynamics (1988); M. Jean, The non-smooth contact dynamics
   method, Comput. Methods Appl. Mech. Engrg. 177 (1999) 235.

   A mode is one complex coordinate xi with xi' = rate xi + drive . loads. The cue has ports (axial and
   lateral velocity of its tip, rotation rate) and the slopes of the bent shaft; the ball has its velocities.
   With y all these velocities, the contact's velocities are v = C y and its forces F load them by C' F, so
   that energy is conserved.

   Python fills a Contact, calls contact_steps until the status is no longer RUNNING, and reads the results.
 */
#ifndef CUEFEM_CONTACT_H
#define CUEFEM_CONTACT_H

#include <complex.h>
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

enum {
    PORTS = 3,
    SLOPES = 32,
    READS = PORTS + SLOPES,
    SPEEDS = 6,
    WIDE = READS + SPEEDS,
    FORCES = 6,
    ANNULI = 256
};
enum {
    T,
    N,
    P,
    UP,
    LATERAL,
    FORWARD
}; /* at the tip: tangential, normal, out of the plane; at the ball's point on the table: the rest */
enum { STICK = 0, SLIP = 1, SLIP_BACK = -1, IMPACT = 2, SEPARATED = 3 };
enum { LOADING, UNLOADING, FREE };
enum { RIGID_PATCH, SPRING_PATCH, PARTIAL_SLIP };
enum { POWER_LAW, LEATHER_LAW };
enum { RUNNING, ENDED, LATE, INDENTATION_OUT_OF_RANGE, SLOPE_OUT_OF_RANGE, UNSOLVED, NO_MEMORY };

/* One step, or an impact: a step of zero length whose F is an impulse, N s. */
typedef struct {
    double time, length, friction_state, phase, angle; /* at the end of the step */
    double F[FORCES], v[FORCES],
        ball[SPEEDS]; /* F: over the step. v, ball: at its end, of the contact and of the ball */
} Step;

typedef struct {
    int modes, ports, slopes, forces, speeds, planes, rolling, law, terms, patch, annuli;
    const double *rates, *rows, *drives; /* complex: (modes,), and (ports + slopes, modes) twice */
    const double *kinematics,
        *inverse_masses;         /* C of the first touch, (forces, ports + speeds); of the ball */
    const double *slope_weights; /* (slopes,): weight of each slope in the tip's axial shortening */
    const double *force_terms, *compliance_terms; /* leather: series in the square root of the indentation */
    const double *annulus_edges, *annulus_forces, *annulus_slopes,
        *annulus_stiffness; /* (annuli + 1,), at the indentations annulus_edges */
    double *xi, *ball;      /* before the first touch, and after the last separation */
    double restitution, friction, table_friction, stiffness, exponent, depth_limit, compliance,
        surface_restitution;
    double phi, dome, rim, radius, arm_t, arm_n, step, max_time, window;
    double time, depth, max_depth, angle, height, shear_loss, axial_force, max_slope,
        work[FORCES]; /* work: dissipated by each force */
    int status, friction_state, steps,
        steps_in_contact; /* steps_in_contact: number up to the last separation */
} Contact;

/* Modal propagation over a step of one length: rows of 2 modes, first the real, then the imaginary parts. */
typedef struct {
    double h, *propagator, *ends, *means, *push, end[READS][READS], mean[READS][READS];
} Tables;

typedef struct {
    Contact *c;
    Tables t;
    double *rows, *drives, *state;
    double ball[SPEEDS], rates[READS],
        slopes[SLOPES]; /* rates: velocities of ports and slopes now; slopes: those of the bent shaft */
    double C[FORCES][WIDE], v[FORCES], u[FORCES], rest[FORCES], V[FORCES][FORCES],
        W[FORCES][FORCES]; /* contact_matrices */
    double end_free[READS], mean_free[READS], F[FORCES];
    double rolling_rate, shift, shift_mid, origin, virtual_mid, virtual_now, lost, annulus_force[ANNULI],
        annulus_force_now[ANNULI];
    double until, max_time;
    int phase, side, held, up_held, table_held, last;
} Work;

static inline double larger(double a, double b) { return a > b ? a : b; }

/* modes.c */
int tabulate(Work *w, double h);
void free_motion(Work *w);
void advance_modes(Work *w, const double *loads);
void apply_impulses(Work *w, const double *impulses);
double mobility(const Work *w, int p, int q);

/* laws.c */
double tip_force(const Contact *c, int phase, double depth, double *slope, double *virtual);
double residual_depth(const Contact *c);
double unloading_scale(const Contact *c, int phase);
double tangential_stiffness(const Contact *c, double depth);
void contact_kinematics(const Work *w, double angle, const double *slopes, double C[FORCES][WIDE]);

/* partial_slip.c */
double shift_annuli(Work *w, double depth, double shift, double *stuck, double *slid);

/* forces.c */
void contact_matrices(Work *w);
void velocities(const Work *w, double *end, double *mean);
int level_forces(Work *w);
int raised_forces(Work *w);
int impact(Work *w, Step *row);

#endif
