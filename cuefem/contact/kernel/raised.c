/* The contact of a cue raised over a table (handbook: Effects): six velocities and six forces.

   T, N and P stand for the tip's: along the surface in the plane of the cue and the ball's centre, along the normal, and
   across that plane; UP, ASIDE and AHEAD for those of the ball's lowest point on the table. The friction of either
   point has a direction in its plane, against the velocity; the table holds the ball, lets it slide, or has let it go. */
#include "contact.h"

enum { T, N, P, UP, ASIDE, AHEAD };
static const int PLANES[2][3] = {{T, P, N}, {ASIDE, AHEAD, UP}}; /* two directions of friction, and what presses */
/* A point that slides more slowly than this part of the stroke's speed keeps its direction. */
static const double REST = 1e-8;
/* By this part of the contact's force friction's bound may be passed: as ball and tip part, all forces end in rounding. */
static const double ROUNDING = 1e-9;

static double friction_of(const Contact *c, int i)
{
    return i ? c->table_friction : c->friction;
}

static int slips(const Work *w, int i)
{
    return i ? w->hold.table == SLIDES : w->hold.grip != STICK;
}

/* The velocities that the hold keeps at zero. */
static int held_by(Hold hold, int *to)
{
    int count = 0;
    if (hold.grip == STICK) to[count++] = T, to[count++] = P;
    if (hold.table != LIFTED) to[count++] = UP;
    if (hold.table == HELD) to[count++] = ASIDE, to[count++] = AHEAD;
    return count;
}

static void point(double *way, double x, double y)
{
    double size = hypot(x, y);
    if (size > 0) way[0] = x / size, way[1] = y / size;
}

/* What is left to friction's bound; where friction is great, in units of what presses, whose rounding it would magnify. */
static double margin(double mu, double pressing, double x, double y)
{
    return mu > 1 ? pressing - hypot(x, y) / mu : mu * pressing - hypot(x, y);
}

static void residual(Work *w, const Step *s, Residual *r)
{
    const Contact *c = w->c;
    int press = w->hold.press;
    clear(r, FORCES);
    for (int i = 0; i < Q; i++) {
        double F, slope;
        curve_at(c, virtual_depth(c, press, s->depth[i + 1]), &F, &slope, NULL);
        r->g[N][i] = s->F[N][i + 1] - F, r->on_F[N][N][i] = 1, r->on_x[N][N][i] = slope / give_of(c, press);
        if (w->hold.table == LIFTED)
            for (int f = UP; f <= AHEAD; f++) r->g[f][i] = s->F[f][i + 1], r->on_F[f][f][i] = 1;
        else r->g[UP][i] = s->v[UP][i + 1], r->on_v[UP][UP][i] = 1;
        for (int k = 0; k < 2; k++) {
            int a = PLANES[k][0], b = PLANES[k][1], n = PLANES[k][2];
            double mu = friction_of(c, k);
            if (k && w->hold.table == LIFTED) continue;
            if (!slips(w, k)) {
                r->g[a][i] = s->v[a][i + 1], r->g[b][i] = s->v[b][i + 1];
                r->on_v[a][a][i] = r->on_v[b][b][i] = 1;
                continue;
            }
            r->on_F[a][a][i] = r->on_F[b][b][i] = 1;
            r->g[a][i] = s->F[a][i + 1], r->g[b][i] = s->F[b][i + 1];
            if (mu == 0) continue;
            /* against the velocity; past a stop, where it turns back, along it, so that all is smooth there */
            const double *way = w->way[k];
            double x = s->v[a][i + 1] - REST * c->speed * way[0], y = s->v[b][i + 1] - REST * c->speed * way[1];
            double speed = hypot(x, y) + 1e-30, side = (x * way[0] + y * way[1] > 0 ? -1 : 1) * mu / speed;
            double per = s->F[n][i + 1] * side;
            r->g[a][i] += per * x, r->g[b][i] += per * y;
            r->on_F[a][n][i] = side * x, r->on_F[b][n][i] = side * y;
            x /= speed, y /= speed;
            r->on_v[a][a][i] = per * y * y, r->on_v[b][b][i] = per * x * x;
            r->on_v[a][b][i] = r->on_v[b][a][i] = -per * x * y;
        }
    }
}

/* The speed at which a point slides against its friction. */
static void along(const Work *w, const Step *s, int k, double *to)
{
    int a = PLANES[k][0], b = PLANES[k][1], n = PLANES[k][2];
    for (int i = 0; i < WITH; i++) {
        double way[2] = {w->way[k][0], w->way[k][1]}, sign = s->F[n][i] < 0 ? -1 : 1;
        int tells = hypot(s->F[a][i], s->F[b][i]) > 1e-9 * w->c->impulse / w->c->clock; /* less is rounding */
        if (i && tells) point(way, sign * s->F[a][i], sign * s->F[b][i]);
        to[i] = -(s->v[a][i] * way[0] + s->v[b][i] * way[1]);
    }
}

static int guards(Work *w, const Step *s, Guard *to)
{
    const Contact *c = w->c;
    int count = 0;
    double size = c->impulse / c->clock, speed = c->speed, way = speed * c->clock, values[WITH];
    double tiny = ROUNDING * size, near = 1e-11;
    if (w->hold.press == LOAD) GUARD(COMPRESSED, near * speed, -s->v[N][i]);
    else {
        GUARD(APART, near * way, s->depth[i] - rest_of(c));
        GUARD(RELOADED, near * way, c->deepest - s->depth[i]);
    }
    if (slips(w, 0)) {
        along(w, s, 0, values);
        if (c->friction > 0) GUARD(GRIPPED, near * speed, values[i]);
    } else if (isfinite(c->friction))
        GUARD(SLIPPED, 0, margin(c->friction, s->F[N][i], s->F[T][i], s->F[P][i]) + tiny);
    if (w->hold.table == LIFTED) {
        GUARD(LANDED, near * way, c->height + s->x[UP][i]);
        return count;
    }
    GUARD(LIFTED_OFF, 0, s->F[UP][i] + tiny);
    if (w->hold.table == SLIDES) {
        along(w, s, 1, values);
        if (c->table_friction > 0) GUARD(STOPPED, near * speed, values[i]);
    } else GUARD(SLID, 0, margin(c->table_friction, s->F[UP][i], s->F[ASIDE][i], s->F[AHEAD][i]) + tiny);
    return count;
}

/* The forces of a hold now; at the first touch, where there are none yet, those of a slight compression. */
static int forces_now(Work *w, Hold hold, double *F)
{
    return forces_held(w, hold, F, w->c->depth > 0 ? 0 : Q);
}

/* How the table holds the ball: it slides on if its lowest point moves and nothing jams; else it is held, slides away, or
   is let go. */
static void rest_on_table(Work *w)
{
    const Contact *c = w->c;
    double F[FORCES], v[FORCES], slack = ROUNDING * c->impulse / c->clock;
    velocities_now(w, v);
    if (hypot(v[ASIDE], v[AHEAD]) > 1e-6 * c->speed) {
        w->hold.table = SLIDES;
        point(w->way[1], -v[ASIDE], -v[AHEAD]);
        if (forces_now(w, w->hold, F) && F[UP] >= -slack) return;
    }
    w->hold.table = HELD;
    if (!forces_now(w, w->hold, F)) return;
    if (margin(c->table_friction, F[UP], F[ASIDE], F[AHEAD]) < -slack) {
        w->hold.table = SLIDES;
        point(w->way[1], F[ASIDE], F[AHEAD]);
        if (!forces_now(w, w->hold, F)) return;
    }
    if (F[UP] < -slack) w->hold.table = LIFTED;
}

static double settle(Work *w, Hold hold)
{
    int held[FORCES], count = held_by(hold, held);
    return blow(w, held, count);
}

/* Stick where friction can hold the tip, else the way it starts to slip. */
static int grip_at_rest(Work *w, int press)
{
    Contact *c = w->c;
    Hold hold = {STICK, press, w->hold.table};
    double F[FORCES];
    c->friction_loss += settle(w, hold);
    if (!forces_now(w, hold, F)) return STICK;
    if (margin(c->friction, F[N], F[T], F[P]) >= -ROUNDING * c->impulse / c->clock) return STICK;
    point(w->way[0], F[T], F[P]);
    return SLIP;
}

static int first_grip(Work *w, int press)
{
    Contact *c = w->c;
    double v[FORCES];
    velocities_now(w, v);
    w->hold = (Hold){SLIP, press, HELD};
    if (hypot(v[T], v[P]) == 0 && c->friction == 0) { /* nothing pulls at the tip, so the table is asked first */
        rest_on_table(w);
        c->grip = w->hold.grip = grip_at_rest(w, press);
        return 1;
    }
    if (hypot(v[T], v[P]) == 0) w->hold.grip = grip_at_rest(w, press);
    else if (isfinite(c->friction)) point(w->way[0], -v[T], -v[P]);
    else {
        const int held[3] = {T, P, UP};
        c->friction_loss += blow(w, held, 3);
        w->hold.grip = STICK;
    }
    rest_on_table(w);
    c->grip = w->hold.grip;
    return 1;
}

static void begin(Work *w)
{
    w->c->friction_loss += settle(w, w->hold);
}

static void taken(Work *w, const Step *s, double part)
{
    Contact *c = w->c;
    double work[FORCES];
    for (int f = 0; f < FORCES; f++) work[f] = work_of(s->F[f], s->v[f], s->step, part);
    c->friction_loss -= work[T] + work[P], c->table_loss -= work[UP] + work[ASIDE] + work[AHEAD];
    if (w->hold.table == LIFTED) c->height += value_at(s->x[UP], part);
    for (int k = 0; k < 2; k++) {
        int a = PLANES[k][0], b = PLANES[k][1], n = PLANES[k][2];
        double sign = value_at(s->F[n], part) < 0 ? -1 : 1;
        double x = value_at(s->F[a], part), y = value_at(s->F[b], part);
        if (slips(w, k) && hypot(x, y) > 1e-9 * c->impulse / c->clock) point(w->way[k], sign * x, sign * y);
    }
    c->depth = value_at(s->depth, part);
}

static int next(Work *w, int event)
{
    Contact *c = w->c;
    double F[FORCES], v[FORCES];
    if (event == SLIPPED || event == SLID || event == LANDED) /* friction turns at once: a long step would not see it */
        w->level = clock_level(c) + 20;
    if (event == APART) return 0;
    if (event == COMPRESSED) {
        c->deepest = c->depth, w->hold.press = UNLOAD;
        curve_at(c, c->depth, &c->peak, F, NULL);
    } else if (event == RELOADED) w->hold.press = LOAD;
    else if (event == GRIPPED) w->hold.grip = grip_at_rest(w, w->hold.press);
    else if (event == SLIPPED) {
        if (forces_now(w, w->hold, F)) point(w->way[0], F[T], F[P]);
        w->hold.grip = SLIP;
    } else if (event == LIFTED_OFF) w->hold.table = LIFTED;
    else if (event == SLID) {
        if (forces_now(w, w->hold, F)) point(w->way[1], F[ASIDE], F[AHEAD]);
        w->hold.table = SLIDES;
    } else if (event == LANDED) {
        w->hold.table = SLIDES, c->height = 0;
        c->table_loss += settle(w, w->hold);
        velocities_now(w, v);
        point(w->way[1], -v[ASIDE], -v[AHEAD]);
    } else {
        w->hold.table = HELD;
        c->table_loss += settle(w, w->hold);
        rest_on_table(w);
    }
    return 1;
}

const Law raised = {first_grip, begin, begin, residual, guards, taken, next};
