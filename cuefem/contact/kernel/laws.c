/* The contact in the plane of the cue and the ball's centre: forces 0 along the surface (t) and 1 along the normal (n).

   The tip's force F_n follows a curve over its compression d = - integral of v_n; on the way back from the deepest point
   D that curve's compression is scaled by e^2, from the rest (1 - e^2) D on (the virtual compression). For e = 0 the tip
   is rigid there: v_n = 0. Along the surface the contact slips, F_t = side mu F_n, or it sticks: v_t = 0; or the patch
   hangs on a spring, F_t = -integral of v_t / c; or on rings (rings.c), each of which holds or slides. */
#include "contact.h"

static void residual(Work *w, const Step *s, Residual *r)
{
    const Contact *c = w->c;
    int press = w->hold.press;
    double give = give_of(c, press), mu = c->friction;
    clear(r, 2);
    for (int i = 1; i < WITH; i++) {
        double F, slope;
        if (press != RIGID) curve_at(c, virtual_depth(c, press, s->depth[i]), &F, &slope, NULL);
        if (press == RIGID) r->g[1][i - 1] = s->v[1][i], r->on_v[1][1][i - 1] = 1;
        else {
            r->g[1][i - 1] = s->F[1][i] - F;
            r->on_F[1][1][i - 1] = 1, r->on_x[1][1][i - 1] = slope / give;
        }
    }
    if (c->patch == RINGED_PATCH) {
        rings_at_nodes(w, s, r);
        return;
    }
    for (int i = 0; i < Q; i++) {
        double F = s->F[0][i + 1], x = s->x[0][i + 1];
        if (w->hold.grip != STICK) {
            r->g[0][i] = F - w->hold.grip * mu * s->F[1][i + 1];
            r->on_F[0][0][i] = 1, r->on_F[0][1][i] = -w->hold.grip * mu;
        } else if (c->patch == RIGID_PATCH) r->g[0][i] = s->v[0][i + 1], r->on_v[0][0][i] = 1;
        else {
            r->g[0][i] = F - c->shear + x / c->compliance;
            r->on_F[0][0][i] = 1, r->on_x[0][0][i] = 1 / c->compliance;
        }
    }
}

/* The velocity at which a patch slides on the ball in slip, at the start of a step and its nodes. */
static void sliding(const Work *w, const Step *s, double *to)
{
    const Contact *c = w->c;
    int press = w->hold.press;
    double side = w->hold.grip * c->friction;
    for (int i = 0; i < WITH; i++) {
        to[i] = s->v[0][i];
        if (c->patch == RIGID_PATCH) continue;
        if (press == RIGID) { /* F_n follows the motion */
            double rate = 0;
            for (int j = 0; j < Q; j++) rate += rule.slopes[j][i] * s->F[0][j + 1];
            to[i] += c->compliance * rate / s->step;
            continue;
        }
        double F, slope;
        curve_at(c, virtual_depth(c, press, s->depth[i]), &F, &slope, NULL);
        to[i] -= side * c->compliance * slope * s->v[1][i] / give_of(c, press);
    }
}

/* Energy that the patch holds. */
static double stored(const Contact *c, int press)
{
    if (c->patch == SPRING_PATCH) return c->compliance * c->shear * c->shear / 2;
    if (c->patch == RINGED_PATCH) return rings_store(c, press, c->depth);
    return 0;
}

static int guards(Work *w, const Step *s, Guard *to)
{
    const Contact *c = w->c;
    int count = 0, press = w->hold.press, grip = w->hold.grip;
    double size = c->impulse / c->clock, speed = c->speed, near = w->linear ? 0 : 1e-10, slides[WITH];
    double way = near * speed * c->clock, force = near * size;
    if (c->curve == POWER_CURVE && !w->linear) /* forces are known to what a step may leave out of them */
        force = larger(10 * force, 20 * c->tolerance * c->impulse / s->step);
    if (press == FREE) {
        GUARD(TOUCHED, 0, rest_of(c) + 1e-10 * speed * c->clock - s->depth[i]);
        return count;
    }
    if (press == LOAD) GUARD(COMPRESSED, near * speed, -s->v[1][i]);
    else if (press == RIGID) {
        GUARD(APART, force, s->F[1][i]);
        GUARD(RELOADED, force, c->peak - s->F[1][i]);
    } else {
        GUARD(APART, way, s->depth[i] - rest_of(c));
        GUARD(RELOADED, way, c->deepest - s->depth[i]);
    }
    if (c->patch == RINGED_PATCH) return count;
    if (grip != STICK) {
        sliding(w, s, slides);
        GUARD(GRIPPED, near * speed * c->across, -grip * slides[i]);
    } else if (isfinite(c->friction)) {
        GUARD(SLIPPED, force, c->friction * s->F[1][i] - s->F[0][i] + 1e-12 * size);
        GUARD(SLIPPED_BACK, force, c->friction * s->F[1][i] + s->F[0][i] + 1e-12 * size);
    }
    return count;
}

/* The patch grips from a touch on if its spring's force grows more slowly than friction's bound. A rigid one slips,
   unless friction is endless, which begins with a blow, or nothing moves along the surface. */
static int first_grip(Work *w, int press)
{
    Contact *c = w->c;
    double v[FORCES], ratio = c->first_ratio * give_of(c, press);
    velocities_now(w, v);
    c->parted = 0, c->grip = STICK;
    if (v[0] == 0 || c->patch == RINGED_PATCH) return 1;
    int side = v[0] < 0 ? SLIP : SLIP_BACK;
    if (c->patch != RIGID_PATCH) {
        if (isfinite(c->friction) && fabs(ratio * v[0]) > -c->friction * v[1]) c->grip = side;
        return 1;
    }
    if (isfinite(c->friction)) {
        c->grip = side;
        return 1;
    }
    double before[SPEEDS], B[FORCES][FORCES], P = 0, after[FORCES];
    memcpy(before, c->ball, c->speeds * sizeof *before);
    contact_gives(w, B);
    P = -v[0] / B[0][0];
    if (v[1] + B[1][0] * P > 0) { /* the limit of great friction: the blow alone throws the two apart */
        P = copysign(fmin(fabs(P), (1 + c->restitution) * fabs(v[1] / B[1][0])), P);
        c->parted = 1;
    }
    push(w, (double[FORCES]){P});
    velocities_now(w, after);
    c->friction_loss -= P * (v[0] + after[0]) / 2;
    end_phase(w, (Hold){BLOW, LOAD, 0}, c->time, before);
    return !c->parted;
}

/* Take away what rounding left of the velocities that a hold keeps at zero, or the march sticks. */
static void settle(Work *w, Hold hold)
{
    int held[2], count = 0;
    if (hold.grip == STICK && w->c->patch == RIGID_PATCH) held[count++] = 0;
    if (hold.press == RIGID) held[count++] = 1;
    blow(w, held, count);
}

/* A patch that begins to slide has friction's force, wherever its spring was before; one that is let go has none. */
static void begin(Work *w)
{
    Contact *c = w->c;
    if (w->hold.press == FREE) {
        c->shear_loss += stored(c, UNLOAD), c->shear = 0;
        if (c->rings) memset(c->ring_shear, 0, c->rings * sizeof *c->ring_shear);
        return;
    }
    settle(w, w->hold);
    if (w->hold.grip == STICK || c->patch != SPRING_PATCH) return;
    double before = stored(c, w->hold.press), F[FORCES];
    if (w->hold.press == RIGID) {
        if (!forces_held(w, w->hold, F, 0)) return;
    } else F[1] = pressing(c, w->hold.press, c->depth);
    c->shear = w->hold.grip * c->friction * F[1];
    c->friction_loss += before - stored(c, w->hold.press);
}

/* Go to a part of the step: the compression, the spring's force, and what was lost along the surface. */
static void taken(Work *w, const Step *s, double part)
{
    Contact *c = w->c;
    int press = w->hold.press, grip = w->hold.grip;
    if (press == FREE) {
        c->depth = value_at(s->depth, part);
        return;
    }
    int holds = grip == STICK && c->patch == RIGID_PATCH; /* nothing moves along the surface */
    double work = holds ? 0 : work_of(s->F[0], s->v[0], s->step, part);
    double before = stored(c, press);
    double lost = 0; /* to the leather */
    if (c->patch == RINGED_PATCH) lost = rings_take(w, s, part);
    else c->shear = value_at(s->F[0], part);
    c->depth = value_at(s->depth, part);
    double missing = before - work - stored(c, press);
    if (c->patch == RINGED_PATCH && !isfinite(c->friction)) c->shear_loss += missing;
    else if (grip != STICK || c->patch == RINGED_PATCH) c->friction_loss += missing - lost, c->shear_loss += lost;
}

/* Whether a growing tip force drives ball and tip apart, which a rigid tip needs. */
static int pressed_together(Work *w, int grip)
{
    double B[FORCES][FORCES];
    contact_gives(w, B);
    return grip == STICK || B[1][1] + grip * w->c->friction * B[1][0] > 0;
}

/* The force along the normal that keeps v_n at zero now. */
static double rigid_force(Work *w, int grip)
{
    const Contact *c = w->c;
    double a[FORCES], B[FORCES][FORCES];
    accelerations_now(w, a);
    contact_gives(w, B);
    if (grip != STICK) return -a[1] / (B[1][1] + grip * c->friction * B[1][0]);
    if (c->patch != RIGID_PATCH) return -(a[1] + B[1][0] * c->shear) / B[1][1];
    return (a[0] * B[1][0] - a[1] * B[0][0]) / (B[0][0] * B[1][1] - B[0][1] * B[1][0]);
}

/* Stick where friction can hold the contact, else the way it starts to slip. */
static int grip_at_rest(Work *w, int press)
{
    const Contact *c = w->c;
    double F[FORCES];
    if (c->patch != RIGID_PATCH || !isfinite(c->friction)) return STICK;
    settle(w, (Hold){STICK, press, 0});
    if (!forces_held(w, (Hold){STICK, press, 0}, F, 0)) return STICK;
    if (fabs(F[0]) <= c->friction * F[1] + 1e-12 * c->impulse / c->clock) return STICK;
    return F[0] > 0 ? SLIP : SLIP_BACK;
}

static int next(Work *w, int event)
{
    Contact *c = w->c;
    int grip = w->hold.grip, press = w->hold.press;
    if (event == APART) return 0;
    if (event == COMPRESSED) {
        c->deepest = c->depth;
        c->peak = pressing(c, LOAD, c->depth);
        if (c->restitution > 0) w->hold.press = UNLOAD;
        else { /* past the peak a tip of e = 0 pushes on only as far as the cue presses against the ball */
            w->hold.press = RIGID;
            settle(w, w->hold);
            return pressed_together(w, grip) && rigid_force(w, grip) > 1e-13 * c->impulse / c->clock;
        }
        return 1;
    }
    if (event == RELOADED) {
        w->hold.press = LOAD;
        return 1;
    }
    w->hold.grip = event == GRIPPED ? grip_at_rest(w, press) : event == SLIPPED ? SLIP : SLIP_BACK;
    /* Slip against a rigid tip in a jam has no stable force: as slip sets in, the tip's force is below what would keep
       v_n at zero, so it falls, ever faster, to nothing: the ball leaves. */
    return press != RIGID || pressed_together(w, w->hold.grip);
}

static void settle_now(Work *w)
{
    settle(w, w->hold);
}

const Law planar = {first_grip, begin, settle_now, residual, guards, taken, next};
