/* Radau IIA collocation with an odd number of stages, for small dense systems with or without constraints:
 *
 *     mask y' = f(t, y),    mask 1 for what moves, 0 for what a constraint f_i = 0 fixes (index 1, linear in it).
 *
 * Order 2 s - 1, L-stable, and B-stable: what contracts, contracts in every step however long. The last entries may be
 * quadratures, which nothing depends on; they are integrated by the same formula and cost no linear algebra.
 *
 * Each step solves for the values at all stages by Newton's method, whose matrix falls apart into a real and (s - 1) / 2
 * complex ones of the size of the system; shifted.c, which comes before this file, solves with them. Constraints are
 * eliminated once for a Jacobian, not for every step size. The Jacobian is that of the middle of the step, where the last
 * step leads.
 *
 * Source: E. Hairer and G. Wanner, Solving Ordinary Differential Equations II (1996), section IV.8; for the embedded
 * formula and the choice of steps too.
 */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_STAGES = 7, PAIRS = (MOST_STAGES - 1) / 2 };
enum { REACHED = 0, PAUSED = 1, STANDSTILL = -1, DIVERGED = -2, NOT_FINITE = -3, SINGULAR = -4, NO_ROOM = -5 };
enum { PAST, MIDDLE, NOW }; /* a step before this one; where the middle of this one is foreseen; its start */
enum { MOST_FAILURES = 60, BREATH = 50 }; /* tries of one step; steps between two looks at the world outside */

/* A Jacobian serves on as long as Newton's method with it leaves less than this of an error in each round: a new one
 * costs a few rounds, and is needed soon, for steps grow. */
static const double RENEW = 0.03;

/* What Newton's method should leave of an error in each round, and the power of the step with which that grows (measured
 * on the examples): steps grow no further, else it fails before the error test does. */
static const double CONTRACTION = 0.15, CONTRACTION_POWER = 2.5;

/* How many times as long a step may be as the last one, if that is to foretell it: further ahead polynomials lead
 * astray. Nor does it if its error was more than one over this of what it changed (of steps as long): it was too rough. */
static const double FORESEEN = 2.5, SMOOTH = 10.0;

/* Of the step that the error foretells this much is taken; not less after many rounds of Newton's method, for which steps
 * are shortened by its contraction. */
static const double SAFETY = 0.9;

/* A first step may change the state by this share of it, times what the order of the method makes of the tolerance. */
static const double FIRST = 0.2;

/* Share of the error test that is left to Newton's method, or the root of the tolerance in these units if that is less. So
 * little costs two rounds more a step, and makes the error that of the collocation, which is far below what the embedded
 * formula tells: three decades for the same steps (measured on the examples), and as regular as the tolerance. */
static const double NEWTON = 3e-5, NEWTON_ROOT = 1e-3;

/* Newton's changes of what constraints fix count so much less than those of what moves. They follow from those: no error of
 * theirs is handed on to the next step; and of stresses, what matters is how fast they make a rod move. */
static const double FIXED = 1e-2;

/* Of a first change of Newton's method this much counts as still to come, however well it worked in the last step. */
static const double UNSEEN = 0.1;

/* The method: abscissae; weights; those of the embedded formula less them, as they act on the stages' displacements; and
 * its inverse, split by eigenvalues: value, row that picks its part, column that puts it back (first the real one, then
 * one of each complex pair). The real one leaves room for a second system with the same matrix, which is that of the error:
 * its row has an imaginary part, which picks that from the stages' rates. */
typedef struct method {
    int stages;
    double node[MOST_STAGES], weight[MOST_STAGES][MOST_STAGES], error[MOST_STAGES];
    double value[PAIRS + 1][2], row[PAIRS + 1][MOST_STAGES][2], column[PAIRS + 1][MOST_STAGES][2];
} method;

/* How far an integration came: states that are done, the time, counts; and why it ended: REACHED and so on. */
typedef struct progress {
    int code, done;
    long steps, rates, jacobians;
    double t;
} progress;

typedef int (*rate_of)(void *data, double t, const double *y, double *rate);
/* Of so many states side by side, up to as many as a strip holds. */
typedef int (*rates_of)(void *data, int count, const double *t, const double *y, double *rate);
typedef const double *(*jacobian_of)(void *data, double t, const double *y);

typedef struct radau {
    method m;
    int size, moving, fixed; /* entries of the state; of those that move, and that constraints fix */
    void *data;
    rate_of rate;
    rates_of stage_rates;
    jacobian_of jacobian;
    double rtol;
    long steps, rates, jacobians;
    double t, end, h;          /* now; where to stop; the step to try */
    double last_h, last_error; /* of the step that led here, 0 where there is none */
    double share;              /* of Newton's last change that is still to come, as far as is known */
    double roughness;          /* the error of the last step over what it changed */
    double contraction;        /* of Newton's method in the last step, 0 where round-off hides it */
    int finite;                /* whether the last rate was */
    int of;                    /* where the Jacobian is from: PAST, MIDDLE or NOW */
    int factored;              /* whether the factors fit it and h */
    void *memory;              /* of all arrays */
    int *moves, *fixes;        /* which entries move, and which are fixed by constraints; quadratures are the last ones */
    int inner, *inner_rows;    /* of the matrix of the constraints: its size, padded, see BLOCK; the order in its factors */
    shifted linear;            /* what is left when they are eliminated */
    number g, *x;              /* the step over the method's eigenvalues; right-hand sides and solutions of their systems */
    number *parts;             /* displacements of what moves; and, beside the real one, less what the slope says of the error */
    number row[MOST_STAGES];   /* the same as in the method: row[s] for all parts; the others for all stages */
    strip column[PAIRS + 1][2], weight[MOST_STAGES], node, error_weight;
    strip *gap, *closing, *made; /* of constraints and of what moves, for all stages: see `newton` */
    double *y, *slope, *atol, *scale; /* the state, its rate, tolerances, one over what an error may be */
    strip *Z, *last_Z, *F, *change; /* [size] of all stages: displacements, now and in the last step; rates; Newton's change */
    strip *at;                      /* [size] states at the stages */
    double *trial, *error;
    double *coupling, *answers, *bound;               /* of the Jacobian, see `condense` */
    double *asking;                                   /* of linear systems, see `condense` */
    double *room;                                     /* to factor in */
} radau;

/* The step over the method's eigenvalues. */
static number shares(const radau *r)
{
    number g = {{0.0}, {0.0}};
    for (int k = 0; k <= r->m.stages / 2; ++k) {
        const double *v = r->m.value[k], size = v[0] * v[0] + v[1] * v[1];
        g.re[k] = r->h * v[0] / size;
        g.im[k] = -r->h * v[1] / size;
    }
    return g;
}

/* y -= f x */
static inline void subtract(int n, double f, const double *restrict x, double *restrict y)
{
    for (int j = 0; j < n; ++j)
        y[j] -= f * x[j];
}

/* Matrices of constraints are stored by columns, and padded by ones on the diagonal to a multiple of BLOCK: no loop has a
 * remainder.
 *
 * Factors are those by blocks. With A = [[P, Q], [R, T]], P of the size of a block, the inverse of P takes its place and
 * -R / P that of R; then the same with T - R / P Q. A solution then waits once for a block, not once for a column. Rows
 * are exchanged where a pivot is less than a tenth of the largest entry below it, as if columns went one by one. */
enum { BLOCK = 4 };

static int padded(int n)
{
    return (n + BLOCK - 1) / BLOCK * BLOCK;
}

/* The row from k on whose entry of a column is to be the pivot, -1 if all are zero or not finite. */
static inline int pivot_of(int k, int n, const double *column)
{
    double lane[BLOCK] = {0.0}, most = 0.0;
    for (int i = k / BLOCK * BLOCK; i < n; i += BLOCK) /* in lanes, since a single one would wait for every comparison */
        for (int l = 0; l < BLOCK; ++l) {
            const double size = i + l < k ? 0.0 : fabs(column[i + l]);
            lane[l] = size > lane[l] ? size : lane[l];
        }
    for (int l = 0; l < BLOCK; ++l)
        most = lane[l] > most ? lane[l] : most;
    for (int i = k; i < n && most > 0.0; ++i)
        if (fabs(column[i]) >= (i == k ? 0.1 : 1.0) * most)
            return i;
    return -1;
}

/* Rows i and k of A [columns][n]. */
static void exchange_rows(int n, int columns, double *A, int *order, int i, int k)
{
    const int swap = order[i];
    order[i] = order[k];
    order[k] = swap;
    for (int j = 0; j < columns; ++j, A += n) {
        const double entry = A[i];
        A[i] = A[k];
        A[k] = entry;
    }
}

/* y += A x for BLOCK columns of A that lie so far apart. */
static inline void add_block(int n, int apart, const double *restrict A, const double *x, double *restrict y)
{
    const double *restrict a = A, *restrict b = a + apart, *restrict c = b + apart, *restrict d = c + apart;
    const double f = x[0], g = x[1], h = x[2], k = x[3];
    for (int i = 0; i < n; ++i)
        y[i] = y[i] + f * a[i] + g * b[i] + h * c[i] + k * d[i];
}

/* Factors A [n][n] in place; order [n]: of its rows; own [n]: room. Returns 1 if it is singular. */
static int factor(int n, double *restrict A, int *order, double *restrict own)
{
    for (int i = 0; i < n; ++i)
        order[i] = i;
    for (int first = 0; first < n; first += BLOCK) {
        const int rows = n - first;
        double *block = A + first * n + first;
        for (int k = 0; k < BLOCK; ++k) { /* by Gauss and Jordan */
            double *column = block + k * n;
            const int best = pivot_of(first + k, n, column - first);
            if (best < 0)
                return 1;
            if (best != first + k)
                exchange_rows(n, n, A, order, first + k, best);
            memcpy(own, column, rows * sizeof *own);
            const double f = 1.0 / own[k];
            own[k] = 0.0;
            for (int j = 0; j < BLOCK; ++j) {
                double *restrict y = block + j * n;
                const double x = j == k ? 0.0 : f * y[k];
                for (int i = 0; i < rows && j != k; ++i)
                    y[i] -= x * own[i];
                y[k] = x;
            }
            for (int i = 0; i < rows; ++i)
                column[i] = -f * own[i];
            column[k] = f;
        }
        for (int j = first + BLOCK; j < n; ++j)
            add_block(rows - BLOCK, n, block + BLOCK, A + j * n + first, A + j * n + first + BLOCK);
    }
    return 0;
}

/* Solves A x = b for as many b as `sides`, so far apart; together, since each by itself waits for its blocks. */
static void solve(int n, const double *A, const int *order, int sides, int apart, const double *b, double *x)
{
    for (int s = 0; s < sides; ++s)
        for (int i = 0; i < n; ++i)
            x[s * apart + i] = b[s * apart + order[i]];
    for (int first = 0; first + BLOCK < n; first += BLOCK)
        for (int s = 0; s < sides; ++s) {
            double *own = x + s * apart + first;
            add_block(n - first - BLOCK, n, A + first * n + first + BLOCK, own, own + BLOCK);
        }
    for (int first = n - BLOCK; first >= 0; first -= BLOCK)
        for (int s = 0; s < sides; ++s) {
            double *own = x + s * apart + first, y[BLOCK] = {0.0};
            add_block(BLOCK, n, A + first * n + first, own, y);
            for (int l = 0; l < BLOCK; ++l) {
                own[l] = y[l];
                y[l] = -y[l];
            }
            add_block(first, n, A + first * n, y, x + s * apart);
        }
}

/* The sum of all entries of a strip. */
static double total_of(strip x)
{
    double total = 0.0;
    for (int l = 0; l < ROWS; ++l)
        total += x[l];
    return total;
}

/* The sum of squares, in lanes, since a single sum would wait for every addition. */
static double squares(int n, const double *restrict x, const double *restrict scale)
{
    double lane[8] = {0.0}, total = 0.0;
    int i = 0;
    for (; i + 8 <= n; i += 8)
        for (int k = 0; k < 8; ++k)
            lane[k] += (x[i + k] * scale[i + k]) * (x[i + k] * scale[i + k]);
    for (; i < n; ++i)
        total += (x[i] * scale[i]) * (x[i] * scale[i]);
    for (int k = 0; k < 8; ++k)
        total += lane[k];
    return total;
}

/* y += A x for A [columns][rows], four columns at a time: y is then read and written a quarter as often. */
static void multiply(int rows, int columns, const double *A, const double *x, double *restrict y)
{
    int j = 0;
    for (; j + 4 <= columns; j += 4) {
        const double *restrict a = A + (size_t)j * rows, *restrict b = a + rows, *restrict c = b + rows;
        const double *restrict d = c + rows;
        const double f = x[j], g = x[j + 1], h = x[j + 2], k = x[j + 3];
        for (int i = 0; i < rows; ++i)
            y[i] += f * a[i] + g * b[i] + h * c[i] + k * d[i];
    }
    for (; j < columns; ++j)
        subtract(rows, -x[j], A + (size_t)j * rows, y);
}

/* The Jacobian by rows. That of the middle of the step is nearer to those of its stages than that of its start. */
static const double *linearise(radau *r, int where)
{
    const int middle = r->m.stages / 2;
    r->jacobians += 1;
    r->factored = 0;
    r->of = where;
    if (where == NOW)
        return r->jacobian(r->data, r->t, r->y);
    for (int i = 0; i < r->size; ++i)
        r->trial[i] = r->y[i] + r->Z[i][middle];
    return r->jacobian(r->data, r->t + r->m.node[middle] * r->h, r->trial);
}

/* Factors N, how constraints change with what they fix. Returns 1 if they do not fix it. */
static int factor_bound(radau *r, const double *J)
{
    const int n = r->size, a = r->fixed, v = r->inner, *fixes = r->fixes;
    if (v > a)
        memset(r->bound, 0, (size_t)v * v * sizeof *r->bound);
    for (int j = 0; j < a; ++j)
        for (int i = 0; i < a; ++i)
            r->bound[j * v + i] = J[(size_t)fixes[i] * n + fixes[j]];
    for (int i = a; i < v; ++i)
        r->bound[i * v + i] = 1.0;
    return factor(v, r->bound, r->inner_rows, r->room);
}

/* What the Jacobian says of what moves, once the constraints are solved for. With J = [[M, C], [K, N]], K and N of the
 * constraints: answers = -N \ K, schur = M - C N \ K. Returns 1 if they cannot be. */
static int condense(radau *r, int where)
{
    const int n = r->size, d = r->moving, a = r->fixed, v = r->inner, w = r->linear.width;
    const int *moves = r->moves, *fixes = r->fixes;
    const double *J = linearise(r, where);
    double *schur = r->linear.H;
    for (int i = 0; i < d; ++i) {
        const double *row = J + (size_t)moves[i] * n;
        for (int j = 0; j < d; ++j)
            schur[j * w + i] = row[moves[j]];
        for (int j = 0; j < a; ++j)
            r->coupling[j * d + i] = row[fixes[j]];
    }
    if (a && factor_bound(r, J))
        return 1;
    for (int i = 0; i < a; ++i)
        for (int j = 0; j < d; ++j)
            r->asking[j * v + i] = -J[(size_t)fixes[i] * n + moves[j]];
    solve(v, r->bound, r->inner_rows, d, v, r->asking, r->answers);
    for (int j = 0; j < d && a; ++j)
        multiply(d, a, r->coupling, r->answers + j * v, schur + j * w);
    reduce(&r->linear);
    return 0;
}

/* A new Jacobian: of the middle of the step if that is wanted and can be, else of its start. */
static int renew(radau *r, int where)
{
    return !(where == MIDDLE && r->last_h > 0.0 && !condense(r, MIDDLE)) && condense(r, NOW);
}

/* The rate, and whether all of it is finite. */
static int evaluate(radau *r, double t, const double *y, double *rate)
{
    const int n = r->size;
    double lane[8] = {0.0}, all = 0.0;
    r->rates += 1;
    r->rate(r->data, t, y, rate);
    int i = 0;
    for (; i + 8 <= n; i += 8)
        for (int k = 0; k < 8; ++k)
            lane[k] += rate[i + k] - rate[i + k]; /* 0, or NaN */
    for (; i < n; ++i)
        all += rate[i] - rate[i];
    for (int k = 0; k < 8; ++k)
        all += lane[k];
    r->finite = all == 0.0;
    return r->finite;
}

/* Rates of all stages, and whether they are finite. Strips have room for more stages: there stands the state at the end
 * of the step as it would be if nothing moved, and what comes of it goes nowhere. */
static int evaluate_stages(radau *r)
{
    const int n = r->size, S = r->m.stages;
    const strip t = r->t + r->h * r->node;
    strip all = {0.0};
    r->rates += S;
    for (int i = 0; i < n; ++i)
        r->at[i] = r->y[i] + r->Z[i];
    r->stage_rates(r->data, S, (const double *)&t, (const double *)r->at, (double *)r->F);
    for (int i = 0; i < n; ++i)
        all += r->F[i] - r->F[i]; /* 0, or NaN */
    double sum = 0.0;
    for (int s = 0; s < S; ++s)
        sum += all[s];
    r->finite = sum == 0.0;
    return r->finite;
}

/* y += A x for all stages, A [columns][apart] of so many rows; four at once, since each waits for its last addition. */
static void add_stages(int rows, int columns, int apart, const double *restrict A, const strip *restrict x,
                       strip *restrict y)
{
    int i = 0;
    for (; i + 4 <= rows; i += 4) {
        strip a = y[i], b = y[i + 1], c = y[i + 2], d = y[i + 3];
        for (int j = 0; j < columns; ++j) {
            const double *f = A + j * apart + i;
            a += f[0] * x[j];
            b += f[1] * x[j];
            c += f[2] * x[j];
            d += f[3] * x[j];
        }
        y[i] = a;
        y[i + 1] = b;
        y[i + 2] = c;
        y[i + 3] = d;
    }
    for (; i < rows; ++i)
        for (int j = 0; j < columns; ++j)
            y[i] += A[j * apart + i] * x[j];
}

/* `solve` for all stages. */
static void solve_all(int n, const double *restrict A, const int *order, const strip *restrict b, strip *restrict x)
{
    for (int i = 0; i < n; ++i)
        x[i] = b[order[i]];
    for (int first = 0; first + BLOCK < n; first += BLOCK) {
        const int next = first + BLOCK;
        add_stages(n - next, BLOCK, n, A + first * n + next, x + first, x + next);
    }
    for (int first = n - BLOCK; first >= 0; first -= BLOCK) {
        strip y[BLOCK] = {{0.0}};
        add_stages(BLOCK, BLOCK, n, A + first * n + first, x + first, y);
        for (int l = 0; l < BLOCK; ++l) {
            x[first + l] = y[l];
            y[l] = -y[l];
        }
        add_stages(first, BLOCK, n, A + first * n, y, x);
    }
}

/* What the method's rows pick from the stages. */
static inline number parts_of(const radau *r, const int S, const strip *stages)
{
    const double *own = (const double *)stages;
    number sum = {{0.0}, {0.0}};
    for (int s = 0; s < S; ++s) {
        sum.re += own[s] * r->row[s].re;
        sum.im += own[s] * r->row[s].im;
    }
    return sum;
}

/* Lanes of pairs. */
static const lanes PAIRED = {0.0, 1.0, 1.0, 1.0};

/* Takes displacements apart, before the first round. */
static void take_apart(radau *r)
{
    for (int i = 0; i < r->moving; ++i) {
        const int from = r->moves[r->linear.order[i]];
        r->parts[i] = parts_of(r, r->m.stages, r->Z + from);
        r->parts[i].im[0] = -r->g.re[0] * r->slope[from];
    }
}

/* Newton's change of all stages into `change`, from rates F at displacements Z. */
static inline void newton_of(radau *r, const int S)
{
    const int n = r->size, d = r->moving, a = r->fixed, v = r->inner, *order = r->linear.order;
    const int *moves = r->moves, *fixes = r->fixes;
    const strip *restrict F = r->F;
    const number g = r->g;
    strip *restrict change = r->change;
    strip *restrict made = r->made, *restrict closing = r->closing;
    number *restrict x = r->x;
    for (int i = 0; i < d; ++i)
        made[i] = F[moves[i]];
    if (a) { /* the constraints are solved for: what moves then does so by itself */
        for (int i = 0; i < a; ++i)
            r->gap[i] = -F[fixes[i]];
        solve_all(v, r->bound, r->inner_rows, r->gap, closing);
        add_stages(d, a, d, r->coupling, closing, made);
    }
    for (int i = 0; i < d; ++i) { /* by parts, each in its lane */
        const number f = times(g, parts_of(r, S, made + order[i]));
        x[i] = (number){f.re - r->parts[i].re, f.im - r->parts[i].im};
    }
    solve_shifted(&r->linear, x);
    for (int i = 0; i < d; ++i) {
        strip sum = {0.0};
        r->parts[i].re += x[i].re;
        r->parts[i].im += PAIRED * x[i].im;
        for (int k = 0; k <= S / 2; ++k)
            sum += x[i].re[k] * r->column[k][0] - x[i].im[k] * r->column[k][1];
        change[moves[order[i]]] = made[order[i]] = sum;
    }
    add_stages(a, d, v, r->answers, made, closing);
    for (int i = 0; i < a; ++i)
        change[fixes[i]] = closing[i];
    for (int i = d + a; i < n; ++i)
        change[i] = (strip){0.0};
}

/* The same by numbers of stages known to the compiler. */
static void newton(radau *r)
{
    switch (r->m.stages) {
    case 3: newton_of(r, 3); break;
    case 5: newton_of(r, 5); break;
    default: newton_of(r, r->m.stages); break;
    }
}

/* Weights of the displacements of the stages at a fraction of the step (beyond 1: what lies ahead). */
static void interpolate(const method *m, double fraction, double *weight)
{
    for (int s = 0; s < m->stages; ++s) {
        double w = fraction / m->node[s];
        for (int k = 0; k < m->stages; ++k)
            if (k != s)
                w *= (fraction - m->node[k]) / (m->node[s] - m->node[k]);
        weight[s] = w;
    }
}

/* Displacements to begin Newton's method with: where the last step leads, none if that is unknown. */
static void predict(radau *r)
{
    const int n = r->size, S = r->m.stages;
    const double longer = r->h / r->last_h;
    memset(r->Z, 0, n * sizeof *r->Z);
    if (r->last_h == 0.0 || longer > FORESEEN || SMOOTH * r->roughness * pow(longer, S + 1) > 1.0)
        return;
    strip share[MOST_STAGES]; /* share[k][s]: how much of stage k of the last step is in stage s of this one */
    memset(share, 0, sizeof share);
    for (int s = 0; s < S; ++s) {
        double weight[MOST_STAGES];
        interpolate(&r->m, 1.0 + r->m.node[s] * longer, weight);
        weight[S - 1] -= 1.0;
        for (int k = 0; k < S; ++k)
            share[k][s] = weight[k];
    }
    for (int i = 0; i < n; ++i) {
        const double *last = (const double *)(r->last_Z + i);
        strip sum = {0.0};
        for (int k = 0; k < S; ++k)
            sum += last[k] * share[k];
        r->Z[i] = sum;
    }
}

/* Displacements of quadratures at all stages, from their rates. */
static void sum_quadratures(radau *r)
{
    for (int i = r->moving + r->fixed; i < r->size; ++i) {
        const double *rates = (const double *)(r->F + i);
        strip sum = {0.0};
        for (int k = 0; k < r->m.stages; ++k)
            sum += rates[k] * r->weight[k];
        r->Z[i] = r->h * sum;
    }
}

/* Root mean square of Newton's change of all stages, in units of what an error may be; quadratures are not in it. */
static double change_norm(const radau *r)
{
    const int n = r->moving + r->fixed;
    strip one = {0.0}, other = one; /* two, since each waits for its last addition */
    int i = 0;
    for (; i + 2 <= n; i += 2) {
        const strip x = r->scale[i] * r->change[i], y = r->scale[i + 1] * r->change[i + 1];
        one += x * x;
        other += y * y;
    }
    if (i < n)
        one += (r->scale[i] * r->change[i]) * (r->scale[i] * r->change[i]);
    return sqrt(total_of(one + other) / (r->m.stages * n));
}

/* Solves for the stages. Returns whether it did; if not, `shrink` is how much shorter to try. */
static int solve_stages(radau *r, double *shrink)
{
    const int n = r->moving + r->fixed, most = 7 + 2 * (r->m.stages - 3);
    const double floor = fmin(0.3, 100.0 * DBL_EPSILON / r->rtol), enough = fmax(floor, fmin(NEWTON, NEWTON_ROOT * sqrt(r->rtol)));
    double before = 0.0, theta = 0.0, contraction = 0.0, share = fmax(UNSEEN, pow(r->share, 0.8));
    *shrink = 0.5;
    take_apart(r);
    for (int round = 1; round <= most; ++round) {
        if (!evaluate_stages(r))
            return 0;
        newton(r);
        const double size = change_norm(r);
        if (!(size - size == 0.0))
            return 0;
        if (round > 1) {
            theta = round == 2 ? size / before : sqrt(size / before * theta);
            if (theta >= 0.99 && size > floor)
                return 0;
            share = theta < 0.99 ? theta / (1.0 - theta) : 1.0; /* the latter: round-off */
            contraction = size > floor ? theta : contraction;
            const double missed = share * size * pow(theta, most - 1 - round) / enough;
            if (missed > 1.0) {
                *shrink = 0.8 * pow(fmin(20.0, fmax(1e-4, missed)), -1.0 / (3 + most - round));
                return 0;
            }
        }
        for (int i = 0; i < n; ++i)
            r->Z[i] += r->change[i];
        if (share * size <= enough) {
            r->share = share;
            r->contraction = contraction;
            return evaluate_stages(r); /* the rates of what was found: of quadratures, and of the next start */
        }
        before = fmax(size, DBL_MIN);
    }
    return 0;
}

/* The size of errors [size] of a step in units of what they may be; those of what constraints fix are not in it. */
static double error_norm(const radau *r)
{
    return sqrt(squares(r->size, r->error, r->scale) / (r->size - r->fixed));
}

/* Errors before their linear systems are solved: the embedded formula less the method. `rate` is that at the start. */
static double differs(const radau *r, int i, const double *rate)
{
    return r->g.re[0] * rate[i] + total_of(r->error_weight * r->Z[i]);
}

/* The error of the step in units of what it may be. Of what moves it was solved for in the last round: what that changed is
 * far below an error. Where it is too large it is looked at once more, from the rate at a state that is off by it: the first
 * look exaggerates where the problem is stiff. */
static double estimate(radau *r)
{
    const int d = r->moving, *order = r->linear.order;
    double *rate = (double *)r->change; /* room that is free */
    memset(r->error, 0, r->size * sizeof *r->error);
    for (int i = 0; i < d; ++i)
        r->error[r->moves[order[i]]] = r->x[i].im[0];
    for (int i = d + r->fixed; i < r->size; ++i)
        r->error[i] = differs(r, i, r->slope);
    const double error = error_norm(r);
    for (int i = 0; i < r->size; ++i)
        r->trial[i] = r->y[i] + r->error[i];
    if (!(error >= 1.0) || !evaluate(r, r->t, r->trial, rate))
        return error;
    for (int i = 0; i < d; ++i)
        r->x[i] = (number){{differs(r, r->moves[order[i]], rate)}, {0.0}};
    solve_shifted(&r->linear, r->x);
    for (int i = 0; i < d; ++i)
        r->error[r->moves[order[i]]] = r->x[i].re[0];
    for (int i = d + r->fixed; i < r->size; ++i)
        r->error[i] = differs(r, i, rate);
    return error_norm(r);
}

static void change_step(radau *r, double h)
{
    r->factored = r->factored && h == r->h;
    r->h = h;
}

/* Units of errors: what one may be. */
static void rescale(radau *r)
{
    for (int i = 0; i < r->size; ++i)
        r->scale[i] = 1.0 / (r->atol[i] + r->rtol * fabs(r->y[i]));
    for (int i = 0; i < r->fixed; ++i)
        r->scale[r->fixes[i]] *= FIXED;
}

/* Takes up the stages as the step they are. */
static void accept(radau *r, double error)
{
    const int n = r->size, S = r->m.stages, m = r->moving + r->fixed;
    strip *swap = r->last_Z;
    double moved = 0.0;
    for (int i = 0; i < m; ++i) {
        const double x = r->scale[i] * r->Z[i][S - 1];
        moved += x * x;
    }
    r->roughness = error / fmax(DBL_MIN, sqrt(moved / m));
    for (int i = 0; i < n; ++i) {
        r->y[i] += r->Z[i][S - 1];
        r->slope[i] = r->F[i][S - 1];
    }
    r->last_Z = r->Z;
    r->Z = swap;
    r->last_h = r->h;
    r->last_error = fmax(1e-2, error);
    r->of = PAST;
    rescale(r);
}

/* One step that is accepted, however many are tried. */
static int step(radau *r)
{
    const double power = -1.0 / (r->m.stages + 1);
    int trouble = STANDSTILL; /* what made the step shorter */
    int doubt = r->contraction > RENEW ? MIDDLE : PAST; /* a Jacobian from before that will not do */
    for (int failures = 0; failures < MOST_FAILURES; ++failures) {
        const double left = r->end - r->t;
        const int last = r->h >= left;
        if (last)
            change_step(r, left);
        else if (2.0 * r->h > left)
            change_step(r, 0.5 * left); /* two steps alike, not a long and a tiny one */
        if (!(r->h > 8.0 * DBL_EPSILON * fabs(r->t)) || !(r->h > DBL_MIN))
            return trouble;
        predict(r);
        if (doubt > r->of && renew(r, doubt))
            return SINGULAR;
        r->g = shares(r);
        if (!r->factored && shift(&r->linear, r->g)) {
            doubt = NOW; /* what was foreseen may be far off */
            change_step(r, 0.5 * r->h);
            continue;
        }
        r->factored = 1;
        r->steps += 1;
        double shrink;
        if (!solve_stages(r, &shrink)) {
            trouble = r->finite ? DIVERGED : NOT_FINITE;
            doubt = NOW;
            change_step(r, shrink * r->h);
            continue;
        }
        sum_quadratures(r);
        const double error = estimate(r);
        double factor_h = fmin(8.0, fmax(0.2, SAFETY * pow(fmax(error, 1e-10), power)));
        if (!(error < 1.0)) {
            trouble = STANDSTILL;
            doubt = doubt > MIDDLE ? doubt : MIDDLE;
            change_step(r, (r->last_h > 0.0 ? factor_h : 0.1) * r->h);
            continue;
        }
        if (r->last_h > 0.0) /* what the last two steps foretell, if less: errors stay more regular */
            factor_h = fmin(factor_h, fmax(0.2, SAFETY * r->h / r->last_h * pow(error * error / r->last_error, power)));
        if (r->contraction > 0.0)
            factor_h = fmin(factor_h, fmax(1.0, pow(CONTRACTION / r->contraction, 1.0 / CONTRACTION_POWER)));
        if (failures)
            factor_h = fmin(1.0, factor_h);
        r->t = last ? r->end : r->t + r->h;
        accept(r, error);
        if (r->contraction > RENEW || factor_h < 1.0 || factor_h > 1.2) /* else what is factored serves on */
            change_step(r, factor_h * r->h);
        return REACHED;
    }
    return trouble;
}

/* So many bytes of a room, in whole cache lines; NULL where they are only counted. */
static void *part_of(char *room, size_t *used, size_t bytes)
{
    void *part = room ? room + *used : NULL;
    *used += (bytes + 63) / 64 * 64;
    return part;
}

/* Lays the arrays of an integration out in a room, or counts its bytes. */
static size_t lay_out(radau *r, char *room)
{
    const size_t n = r->size, d = r->moving, a = r->fixed, v = r->inner, w = r->linear.width;
    shifted *s = &r->linear;
    size_t used = 0;
    struct { double **array; size_t count; } numbers[] = {
        {&r->y, n}, {&r->slope, n}, {&r->atol, n}, {&r->scale, n}, {&r->trial, n}, {&r->error, n},
        {&r->coupling, d * a}, {&r->answers, v * (d + 1)}, {&r->asking, v * (d + 1)}, {&r->bound, v * v},
        {&r->room, v},
        {&s->H, w * d}, {&s->lower, w * d}, {&s->y, w},
    };
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; ++i)
        *numbers[i].array = part_of(room, &used, numbers[i].count * sizeof(double));
    strip **strips[] = {&r->Z, &r->last_Z, &r->F, &r->change, &r->at};
    for (size_t i = 0; i < sizeof strips / sizeof *strips; ++i)
        *strips[i] = part_of(room, &used, n * sizeof(strip));
    r->gap = part_of(room, &used, v * sizeof *r->gap);
    r->closing = part_of(room, &used, v * sizeof *r->closing);
    if (room)
        memset(room, 0, used); /* what pads matrices and right-hand sides */
    r->made = part_of(room, &used, d * sizeof *r->made);
    r->x = part_of(room, &used, d * sizeof *r->x);
    r->parts = part_of(room, &used, d * sizeof *r->parts);
    s->upper = part_of(room, &used, d * (d + 1) / 2 * sizeof *s->upper);
    s->factor = part_of(room, &used, d * sizeof *s->factor);
    s->row = part_of(room, &used, d * sizeof *s->row);
    s->exchanged = part_of(room, &used, d * sizeof *s->exchanged);
    s->order = part_of(room, &used, d * sizeof *s->order);
    r->moves = part_of(room, &used, d * sizeof *r->moves);
    r->fixes = part_of(room, &used, a * sizeof *r->fixes);
    r->inner_rows = part_of(room, &used, v * sizeof *r->inner_rows);
    return used;
}

void radau_free(radau *r)
{
    free(r->memory);
    free(r);
}

/* An integration about to begin at t with the state y, or NULL if memory does not suffice. constrained [size]: 1 for
 * entries that constraints fix; quadratures: how many of the last entries nothing depends on. */
static radau *radau_new(const method *m, int size, int quadratures, const double *constrained, void *data, rate_of rate,
                        rates_of stage_rates, jacobian_of jacobian, double t, const double *y, double rtol, const double *atol)
{
    radau *r = calloc(1, sizeof *r);
    if (!r)
        return NULL;
    r->m = *m;
    r->size = size;
    for (int i = 0; i < size - quadratures; ++i)
        r->fixed += constrained[i] != 0.0;
    r->moving = r->linear.size = size - quadratures - r->fixed;
    r->linear.width = padded_rows(r->moving);
    r->inner = padded(r->fixed);
    r->memory = malloc(lay_out(r, NULL) + 63);
    if (!r->memory) {
        radau_free(r);
        return NULL;
    }
    lay_out(r, (char *)r->memory + 63 - ((uintptr_t)r->memory + 63) % 64);
    for (int k = 0; k <= m->stages / 2; ++k)
        for (int s = 0; s < m->stages; ++s) {
            r->row[s].re[k] = m->row[k][s][0];
            r->row[s].im[k] = m->row[k][s][1];
            r->column[k][0][s] = m->column[k][s][0];
            r->column[k][1][s] = m->column[k][s][1];
        }
    r->node += 1.0;
    for (int s = 0; s < m->stages; ++s) {
        r->node[s] = m->node[s];
        r->error_weight[s] = m->error[s];
        for (int k = 0; k < m->stages; ++k)
            r->weight[k][s] = m->weight[s][k];
    }
    for (int i = 0, moving = 0, fixed = 0; i < size - quadratures; ++i)
        *(constrained[i] != 0.0 ? r->fixes + fixed++ : r->moves + moving++) = i;
    memcpy(r->y, y, size * sizeof *y);
    memcpy(r->atol, atol, size * sizeof *atol);
    r->data = data;
    r->rate = rate;
    r->stage_rates = stage_rates;
    r->jacobian = jacobian;
    r->rtol = rtol;
    r->t = t;
    r->share = r->contraction = 1.0;
    return r;
}

/* A first step so short that the rate alone changes little by it. */
static double first_step(const radau *r)
{
    const double span = r->end - r->t, share = FIRST * pow(r->rtol, 1.0 / (r->m.stages + 1));
    double size = 0.0, speed = 0.0;
    for (int k = 0; k < r->moving; ++k) {
        const int i = r->moves[k];
        size += r->y[i] * r->y[i] * r->scale[i] * r->scale[i];
        speed += r->slope[i] * r->slope[i] * r->scale[i] * r->scale[i];
    }
    return speed * span * span > 1e-10 * size ? fmin(span, share * sqrt(fmax(size, 1e-10) / speed)) : 1e-3 * span;
}

/* Entries that constraints fix, made to fulfil them at the start: a linear system, since each constraint is linear in them.
 * Returns 1 if it has no solution. */
static int settle(radau *r)
{
    const int failed = factor_bound(r, linearise(r, NOW));
    r->of = PAST; /* its other parts change with what is solved for here */
    for (int i = 0; i < r->fixed; ++i)
        r->asking[i] = r->slope[r->fixes[i]];
    solve(r->inner, r->bound, r->inner_rows, 1, r->inner, r->asking, r->answers);
    for (int i = 0; i < r->fixed; ++i)
        r->y[r->fixes[i]] -= r->answers[i];
    return failed;
}

/* The state at the start, as the constraints have it, into out [size]. Returns a number below zero where there is none. */
static int begin(radau *r, double *out)
{
    if (!evaluate(r, r->t, r->y, r->slope))
        return NOT_FINITE;
    if (r->fixed && settle(r))
        return SINGULAR;
    if (r->fixed && !evaluate(r, r->t, r->y, r->slope))
        return SINGULAR;
    rescale(r);
    memcpy(out, r->y, r->size * sizeof *out);
    return REACHED;
}

/* The state at an instant of the last step, into out [size]. */
static void show(radau *r, double t, double *out)
{
    const int n = r->size, S = r->m.stages;
    memcpy(out, r->y, n * sizeof *out);
    if (r->t > t) {
        double weight[MOST_STAGES];
        interpolate(&r->m, 1.0 + (t - r->t) / r->last_h, weight);
        weight[S - 1] -= 1.0;
        for (int i = 0; i < n; ++i)
            for (int s = 0; s < S; ++s)
                out[i] += weight[s] * r->last_Z[i][s];
    }
}

/* Goes on through `times` [count], never beyond the last of them; states there, between two steps if need be, into the rows
 * of `states` [count][size] from *done on, which is increased. Returns PAUSED before that if many steps were taken, and a
 * number below zero where it cannot go on. */
static int advance(radau *r, const double *times, int count, double *states, int *done)
{
    r->end = times[count - 1];
    if (r->h == 0.0)
        r->h = first_step(r);
    for (int taken = 0; *done < count; ++taken) {
        for (; *done < count && r->t >= times[*done]; ++*done)
            show(r, times[*done], states + (size_t)*done * r->size);
        if (*done == count)
            break;
        if (taken == BREATH)
            return PAUSED;
        const int code = step(r);
        if (code != REACHED)
            return code;
    }
    return REACHED;
}

/* Goes on as `radau_start` says. */
void radau_go(radau *r, const double *times, int count, double *states, progress *p)
{
    p->code = p->done ? REACHED : begin(r, states);
    if (p->code == REACHED) {
        p->done += !p->done;
        p->code = advance(r, times, count, states, &p->done);
    }
    p->t = r->t;
    p->steps = r->steps;
    p->rates = r->rates;
    p->jacobians = r->jacobians;
}

/* Integrates from `start` at times[0] through `times` [count], never beyond the last of them; states there, the first one as the
 * constraints have it, into `states` [count][size]. Says in p how far it came and why it ended. Where it paused, having taken
 * many steps, it returns what `radau_go` goes on with and `radau_free` gives back, else NULL. */
radau *radau_start(const method *m, int size, int quadratures, const double *constrained, void *data, rate_of rate,
                   rates_of stage_rates, jacobian_of jacobian, double rtol, const double *atol, const double *start, const double *times, int count,
                   double *states, progress *p)
{
    radau *r = radau_new(m, size, quadratures, constrained, data, rate, stage_rates, jacobian, times[0], start, rtol, atol);
    if (!r) {
        p->code = NO_ROOM;
        return NULL;
    }
    radau_go(r, times, count, states, p);
    if (p->code == PAUSED)
        return r;
    radau_free(r);
    return NULL;
}
