/* The modes of a cue: how they turn by themselves, and what loads at its tip make of them.

   With y = rate step/2 and Legendre's polynomials P_t over the step, the moments of a mode

       m_t = integral over [0, 1] of exp(2 y (1 - s)) P_t(2 s - 1) ds

   are modified spherical Bessel functions of y, with the recurrence m_(t-1) - m_(t+1) = (2 t + 1) m_t / y. A load with
   the coefficients f_t moves the mode by step drive sum of m_t f_t. */
#include "contact.h"

/* exp(r + i m). */
static void turn_of(double r, double m, double *re, double *im)
{
    double size = r == 0 ? 1 : exp(r);
    *re = size * cos(m), *im = size * sin(m);
}

/* The first n moments at y = yr + i yi. */
static void moments_of(double yr, double yi, int n, double *re, double *im)
{
    double size = hypot(yr, yi);
    memset(re, 0, n * sizeof *re), memset(im, 0, n * sizeof *im);
    if (size < 1e-9) {
        re[0] = 1 + yr, im[0] = yi;
        if (n > 1) re[1] = -yr / 3, im[1] = -yi / 3;
        return;
    }
    double br = yr / (size * size), bi = -yi / (size * size); /* 1/y */
    if (size > 200 && size > n + 4) { /* upwards from the first two, which is stable for a large y */
        double er, ei;
        turn_of(2 * yr, 2 * yi, &er, &ei);
        double ar = (br * (er - 1) - bi * ei) / 2, ai = (bi * (er - 1) + br * ei) / 2;
        double gr = -(br * (er + 1) - bi * ei) / 2 + ar * br - ai * bi;
        double gi = -(bi * (er + 1) + br * ei) / 2 + ar * bi + ai * br;
        re[0] = ar, im[0] = ai;
        for (int t = 1; t < n; t++) {
            re[t] = gr, im[t] = gi;
            double w = 2 * t + 1, nr = ar + w * (br * gr - bi * gi), ni = ai + w * (br * gi + bi * gr);
            ar = gr, ai = gi, gr = nr, gi = ni;
        }
        return;
    }
    /* downwards from where they are nothing, and scaled by the sum of (2 t + 1) m_t, which is 1 */
    int top = size < 0.5 ? 6 + (int)(18 / -log10(size)) : (int)larger(n + 14, size + 20 + 9 * cbrt(size));
    double gr = size < 0.5 ? 1e-120 : 1e-150, gi = 0, ar = 0, ai = 0, sr = 0, si = 0;
    for (int t = top; t >= 0; t--) {
        double w = 2 * t + 1;
        if (t < n) re[t] = gr, im[t] = gi;
        sr += w * gr, si += w * gi;
        double nr = ar - w * (br * gr - bi * gi), ni = ai - w * (br * gi + bi * gr);
        ar = gr, ai = gi, gr = nr, gi = ni;
    }
    double by = 1 / (sr * sr + si * si);
    sr *= by, si *= -by;
    for (int t = 0; t < n && t <= top; t++) {
        double r = re[t] * sr - im[t] * si;
        im[t] = re[t] * si + im[t] * sr, re[t] = r;
    }
}

static void free_response(Response *r)
{
    if (r) free(r->turns), free(r->moments), free(r->answer), free(r->bending), free(r);
}

/* The part of the answer of modes that turn slowly: terms of their moments, summed over the modes, times one table. */
FAST static void add_series(const Cue *cue, const double *kappa, int count, Response *r)
{
    for (int t = 0; t < count; t++)
        for (int pair = 0; pair < cue->reads * cue->ports; pair++) {
            double f = r->step * (2 * t + 1) * (t % 2 ? -1 : 1) * kappa[pair * count + t];
            double *to = r->answer + pair * Q * Q;
            const double *from = rule.convolved[t][0];
            if (f == 0) continue;
            for (int i = 0; i < Q * Q; i++) to[i] += f * from[i];
        }
}

/* What a load at the nodes makes of one mode there, real and imaginary: by the series, or by moments up to each node. */
FAST static void answer_of_mode(const Cue *cue, int k, double h, double to[2][Q * Q])
{
    double yr = cue->rates[2 * k] * h / 2, yi = cue->rates[2 * k + 1] * h / 2, size = hypot(yr, yi);
    double re[TERMS], im[TERMS];
    memset(to, 0, 2 * sizeof to[0]);
    if (size < TERMS - 42) {
        int count = (int)larger(size + 14 + 6 * cbrt(size), Q + 4);
        moments_of(yr, yi, count, re, im);
        for (int t = 0; t < count; t++) {
            double f = h * (2 * t + 1) * (t % 2 ? -1 : 1), fr = f * re[t], fi = f * im[t];
            const double *from = rule.convolved[t][0];
            for (int j = 0; j < Q * Q; j++) to[0][j] += fr * from[j], to[1][j] += fi * from[j];
        }
        return;
    }
    for (int i = 0; i < Q; i++) {
        double c = rule.nodes[i];
        moments_of(yr * c, yi * c, Q, re, im);
        for (int t = 0; t < Q; t++)
            for (int j = 0; j < Q; j++) {
                to[0][j * Q + i] += h * c * re[t] * rule.shortened[i][t][j];
                to[1][j * Q + i] += h * c * im[t] * rule.shortened[i][t][j];
            }
    }
}

/* The part of one mode that turns too fast for the series of all. */
FAST static void add_fast(const Cue *cue, int k, Response *r)
{
    double of_mode[2][Q * Q];
    answer_of_mode(cue, k, r->step, of_mode);
    for (int a = 0; a < cue->reads; a++)
        for (int b = 0; b < cue->ports; b++) {
            const double *y = cue->readings + 2 * (a * cue->modes + k), *d = cue->drives + 2 * (b * cue->modes + k);
            double pr = y[0] * d[0] - y[1] * d[1], pi = y[0] * d[1] + y[1] * d[0];
            double *to = r->answer + (a * cue->ports + b) * Q * Q;
            if (pr == 0 && pi == 0) continue;
            for (int j = 0; j < Q * Q; j++) to[j] += pr * of_mode[0][j] - pi * of_mode[1][j];
        }
}

/* What loads at the nodes make of each channel of the slopes, at the nodes. */
static int add_channels(const Cue *cue, Response *r)
{
    int n = cue->channels;
    double of_mode[2][Q * Q];
    if (!n) return 1;
    if (!(r->bending = malloc(Q * Q * n * sizeof(double)))) return 0;
    for (int b = 0; b < n; b++) {
        int k = cue->channel_of[b] / 2;
        if (b == 0 || k != cue->channel_of[b - 1] / 2) answer_of_mode(cue, k, r->step, of_mode);
        memcpy(r->bending + b * Q * Q, of_mode[cue->channel_of[b] % 2], sizeof of_mode[0]);
    }
    return 1;
}

FAST static Response *make_response(const Cue *cue, int level)
{
    int K = cue->modes, ports = cue->ports;
    Response *r = calloc(1, sizeof *r);
    if (!r) return NULL;
    double h = r->step = ldexp(1, LONGEST_POWER - level), fastest = 0;
    for (int k = 0; k < K; k++) fastest = larger(fastest, hypot(cue->rates[2 * k], cue->rates[2 * k + 1]) * h / 2);
    int count = (int)fmin(TERMS, larger(fastest + 14 + 6 * cbrt(fastest), Q + 4));
    double bound = count < TERMS ? HUGE_VAL : TERMS - 42;
    r->turns = malloc(sizeof(double) * 2 * Q * K), r->moments = malloc(sizeof(double) * 2 * Q * K);
    r->answer = calloc((size_t)cue->reads * Q * ports * Q, sizeof(double));
    double *kappa = calloc((size_t)cue->reads * ports * count, sizeof(double));
    if (!r->turns || !r->moments || !r->answer || !kappa) {
        free(kappa), free_response(r);
        return NULL;
    }
    for (int k = 0; k < K; k++) {
        double yr = cue->rates[2 * k] * h / 2, yi = cue->rates[2 * k + 1] * h / 2, re[TERMS], im[TERMS];
        int slow = hypot(yr, yi) < bound;
        moments_of(yr, yi, slow ? count : Q, re, im);
        double *moments = r->moments + 2 * Q * k, *turns = r->turns + 2 * Q * k;
        memcpy(moments, re, Q * sizeof *re), memcpy(moments + Q, im, Q * sizeof *im);
        for (int i = 0; i < Q; i++) turn_of(2 * yr * rule.nodes[i], 2 * yi * rule.nodes[i], turns + i, turns + Q + i);
        if (!slow) {
            add_fast(cue, k, r);
            continue;
        }
        for (int a = 0; a < cue->reads; a++)
            for (int b = 0; b < ports; b++) {
                const double *y = cue->readings + 2 * (a * K + k), *d = cue->drives + 2 * (b * K + k);
                double pr = y[0] * d[0] - y[1] * d[1], pi = y[0] * d[1] + y[1] * d[0];
                double *to = kappa + (a * ports + b) * count;
                if (pi != 0)
                    for (int t = 0; t < count; t++) to[t] += pr * re[t] - pi * im[t];
                else if (pr != 0)
                    for (int t = 0; t < count; t++) to[t] += pr * re[t];
            }
    }
    add_series(cue, kappa, count, r);
    free(kappa);
    if (!add_channels(cue, r)) {
        free_response(r);
        return NULL;
    }
    return r;
}

/* The response over a step of 2^(LONGEST_POWER - level) s; threads may share a cue. */
Response *response_of(Cue *cue, int level)
{
    Response *known = __atomic_load_n(&cue->responses[level], __ATOMIC_ACQUIRE), *none = NULL;
    if (known) return known;
    Response *made = make_response(cue, level);
    if (!made) return NULL;
    if (__atomic_compare_exchange_n(&cue->responses[level], &none, made, 0, __ATOMIC_ACQ_REL, __ATOMIC_ACQUIRE))
        return made;
    free_response(made);
    return none;
}

/* Move the coordinates on by a time whose loads have these coefficients; whole: the response, if it is its whole step. */
FAST void advance_modes(const Cue *cue, double *xi, const Response *whole, double time, const double (*waves)[Q])
{
    int K = cue->modes;
    for (int k = 0; k < K; k++) {
        double own[2 * Q], tr, ti, sr = 0, si = 0, xr = xi[2 * k], xm = xi[2 * k + 1];
        const double *re = own, *im = own + Q;
        if (whole) {
            const double *turns = whole->turns + 2 * Q * k;
            tr = turns[Q - 1], ti = turns[2 * Q - 1];
            re = whole->moments + 2 * Q * k, im = re + Q;
        } else {
            double yr = cue->rates[2 * k] * time / 2, yi = cue->rates[2 * k + 1] * time / 2;
            turn_of(2 * yr, 2 * yi, &tr, &ti);
            moments_of(yr, yi, Q, own, own + Q);
        }
        for (int b = 0; waves && b < cue->ports + cue->slopes; b++) {
            double dr = cue->drives[2 * (b * K + k)], di = cue->drives[2 * (b * K + k) + 1], fr = 0, fi = 0;
            if (dr == 0 && di == 0) continue;
            for (int t = 0; t < Q; t++) fr += re[t] * waves[b][t], fi += im[t] * waves[b][t];
            sr += dr * fr - di * fi, si += dr * fi + di * fr;
        }
        xi[2 * k] = tr * xr - ti * xm + time * sr, xi[2 * k + 1] = tr * xm + ti * xr + time * si;
    }
}

/* The coordinates at times from now on, (count, modes) complex, if nothing loads the cue but these coefficients. */
EXPORTED void cue_follow(const Cue *cue, const double *xi, const double (*waves)[Q], const double *times, int count,
                         double *to)
{
    for (int i = 0; i < count; i++) {
        memcpy(to + 2 * i * cue->modes, xi, 2 * cue->modes * sizeof(double));
        advance_modes(cue, to + 2 * i * cue->modes, NULL, times[i], waves ? waves + i * (cue->ports + cue->slopes) : NULL);
    }
}

EXPORTED void cue_free(Cue *cue)
{
    if (!cue) return;
    for (int i = 0; i < LEVELS; i++) free_response(cue->responses[i]);
    free(cue->rates), free(cue->readings), free(cue->drives);
    free(cue->channel_of), free(cue->channel_drives), free(cue->channel_readings), free(cue);
}

/* The channels from the slopes to the readings; 0 if there is no memory. */
static int open_channels(Cue *cue)
{
    static const int DRIVE[4] = {0, 1, 1, 0}, READ[4] = {0, 1, 0, 1}, MOTION[4] = {0, 0, 1, 1}; /* re or im */
    const int K = cue->modes, slopes = cue->slopes;
    if (!slopes) return 1;
    cue->channel_of = malloc(4 * K * sizeof(int));
    int *quarter = malloc(4 * K * sizeof(int));
    if (!cue->channel_of || !quarter) {
        free(quarter);
        return 0;
    }
    for (int k = 0; k < K; k++) {
        double of_real = 0, of_imaginary = 0;
        for (int a = 0; a < slopes; a++) {
            const double *y = cue->readings + 2 * ((cue->ports + a) * K + k), *d = cue->drives + (y - cue->readings);
            of_real = larger(of_real, fabs(y[0])), of_imaginary = larger(of_imaginary, larger(fabs(y[1]), fabs(d[1])));
        }
        for (int q = 0; q < (of_imaginary > 0 ? 4 : of_real > 0); q++)
            quarter[cue->channels] = q, cue->channel_of[cue->channels++] = 2 * k + MOTION[q];
    }
    const int n = cue->channels;
    cue->channel_drives = malloc((slopes * n + 1) * sizeof(double));
    cue->channel_readings = malloc((cue->reads * n + 1) * sizeof(double));
    for (int b = 0; cue->channel_drives && cue->channel_readings && b < n; b++) {
        const int k = cue->channel_of[b] / 2, q = quarter[b];
        for (int a = 0; a < slopes; a++)
            cue->channel_drives[b * slopes + a] = cue->drives[2 * ((cue->ports + a) * K + k) + DRIVE[q]];
        for (int a = 0; a < cue->reads; a++)
            cue->channel_readings[a * n + b] = (q ? -1 : 1) * cue->readings[2 * (a * K + k) + READ[q]];
    }
    free(quarter);
    return cue->channel_drives && cue->channel_readings;
}

/* A copy of what is given, all complex: rates (modes,), readings (reads, modes), drives (ports + slopes, modes). */
EXPORTED Cue *cue_new(int modes, int ports, int slopes, int reads, const double *rates, const double *readings,
                      const double *drives)
{
    Cue *cue = calloc(1, sizeof *cue);
    if (!cue) return NULL;
    size_t row = 2 * (size_t)modes * sizeof(double);
    int pushed = ports + slopes;
    cue->modes = modes, cue->ports = ports, cue->slopes = slopes, cue->reads = reads;
    cue->rates = malloc(row), cue->readings = malloc(reads * row), cue->drives = malloc(pushed * row);
    if (!cue->rates || !cue->readings || !cue->drives) {
        cue_free(cue);
        return NULL;
    }
    memcpy(cue->rates, rates, row), memcpy(cue->readings, readings, reads * row);
    memcpy(cue->drives, drives, pushed * row);
    if (!open_channels(cue)) {
        cue_free(cue);
        return NULL;
    }
    for (int a = 0; a < pushed; a++)
        for (int b = 0; b < pushed; b++)
            for (int k = 0; k < modes; k++) {
                const double *y = readings + 2 * (a * modes + k), *d = drives + 2 * (b * modes + k);
                cue->inverse_mass[a][b] += y[0] * d[0] - y[1] * d[1];
            }
    return cue;
}
