/* What an expert writes for one relaxing rod and nothing else: straight at rest, uniform diagonal stiffness and friction,
 * clamped on the left, free on the right. Strains at the midpoints of equal cells, velocities at the nodes between them
 * (second order), RODAS4 in time with step control, the exact block-tridiagonal Jacobian, and a block elimination that
 * works from both ends to the middle: two independent chains keep the processor busy where one would wait for itself.
 * No pivoting: the matrix is that of a diffusion, up to a diagonal scaling and the stress. No sines: strains close it.
 *
 * DEGREE is the number of strains: 3 in the plane, 6 in space. The state is [DEGREE][cells], cells even, 4 or more.
 *
 * Source: E. Hairer and G. Wanner, Solving Ordinary Differential Equations II (1996), sections IV.7 and VI.4, and their code
 * RODAS, whose coefficients these are.
 */
#define _POSIX_C_SOURCE 200112L /* posix_memalign */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#define D DEGREE
#define INDEPENDENT _Pragma("GCC ivdep")
#if D == 3
#define LD 3
#else
#define LD 8 /* rows of matrices are padded: two vectors of four */
#endif
enum { STAGES = 6, SUMS = 8 };

typedef double matrix[D][LD];

/* Of one cell: (coupling to the outer neighbour)(its pivot)^-1, pivot^-1, pivot^-1 (coupling to the inner one). */
typedef struct factors {
    matrix outer, pivot, inner;
} factors;

typedef struct couplings {
    matrix left, own, right;
} couplings;

typedef struct rod {
    size_t cells;
    double h, stiffness[D], mobility[D];
    double *stress, *pull, *v; /* v [D][cells + 1] */
    couplings *jacobian;
    factors *lu;
    double across[D][LD];      /* where the two eliminations meet */
} rod;

static const double GAMMA = 0.25;
static const double A[STAGES][STAGES] = {
    {0.0},
    {1.544},
    {0.9466785280815826, 0.2557011698983284},
    {3.314825187068521, 2.896124015972201, 0.9986419139977817},
    {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950},
    {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950, 1.0},
};
static const double C[STAGES][STAGES] = {
    {0.0},
    {-5.6688},
    {-2.430093356833875, -0.2063599157091915},
    {-0.1073529058151375, -9.594562251023355, -20.47028614809616},
    {7.496443313967647, -10.24680431464352, -33.99990352819905, 11.70890893206160},
    {8.083246795921522, -7.981132988064893, -31.52159432874371, 16.31930543123136, -6.058818238834054},
};

/* dy/dt; the velocities stay in r->v */
static void rate(const rod *r, const double *restrict y, double *restrict dy)
{
    const size_t n = r->cells, N = n + 1;
    const double h = r->h, half = 0.5 * h, scale = 1.0 / h, *k = r->stiffness;
    double *restrict s = r->stress, *restrict p = r->pull;
#if D == 3
    const double k1 = k[0], k2 = k[1], k3 = k[2];
    INDEPENDENT
    for (size_t i = 0; i < n; ++i) {
        const double h1 = y[i], h2 = y[n + i], bend = y[2 * n + i];
        const double f1 = k1 * (h1 - 1.0), f2 = k2 * h2;
        s[i] = f1;
        s[n + i] = f2;
        s[2 * n + i] = k3 * bend;
        p[i] = bend * f2;
        p[n + i] = -bend * f1;
        p[2 * n + i] = h2 * f1 - h1 * f2;
    }
#else
    const double k1 = k[0], k2 = k[1], k3 = k[2], k4 = k[3], k5 = k[4], k6 = k[5];
    INDEPENDENT
    for (size_t i = 0; i < n; ++i) {
        const double h1 = y[i], h2 = y[n + i], h3 = y[2 * n + i];
        const double p1 = y[3 * n + i], p2 = y[4 * n + i], p3 = y[5 * n + i];
        const double f1 = k1 * (h1 - 1.0), f2 = k2 * h2, f3 = k3 * h3, m1 = k4 * p1, m2 = k5 * p2, m3 = k6 * p3;
        s[i] = f1;
        s[n + i] = f2;
        s[2 * n + i] = f3;
        s[3 * n + i] = m1;
        s[4 * n + i] = m2;
        s[5 * n + i] = m3;
        p[i] = p3 * f2 - p2 * f3;
        p[n + i] = p1 * f3 - p3 * f1;
        p[2 * n + i] = p2 * f1 - p1 * f2;
        p[3 * n + i] = p3 * m2 - p2 * m3 + h3 * f2 - h2 * f3;
        p[4 * n + i] = p1 * m3 - p3 * m1 + h1 * f3 - h3 * f1;
        p[5 * n + i] = p2 * m1 - p1 * m2 + h2 * f1 - h1 * f2;
    }
#endif
    for (int c = 0; c < D; ++c) {
        double *restrict v = r->v + c * N;
        const double *restrict a = s + c * n, *restrict b = p + c * n;
        const double m = r->mobility[c] * scale;
        v[0] = 0.0;
        INDEPENDENT
        for (size_t i = 1; i < n; ++i)
            v[i] = m * (a[i] - a[i - 1] - half * (b[i] + b[i - 1]));
        v[n] = 2.0 * m * (-a[n - 1] - half * b[n - 1]);
    }
    const double *restrict v = r->v;
#define SLOPE(c) scale * (v[c * N + i + 1] - v[c * N + i])
#define VALUE(c) (0.5 * (v[c * N + i + 1] + v[c * N + i]))
    INDEPENDENT
    for (size_t i = 0; i < n; ++i) {
#if D == 3
        const double h1 = y[i], h2 = y[n + i], bend = y[2 * n + i];
        const double w1 = VALUE(0), w2 = VALUE(1), w3 = VALUE(2);
        dy[i] = SLOPE(0) + h2 * w3 - bend * w2;
        dy[n + i] = SLOPE(1) + bend * w1 - h1 * w3;
        dy[2 * n + i] = SLOPE(2);
#else
        const double h1 = y[i], h2 = y[n + i], h3 = y[2 * n + i];
        const double p1 = y[3 * n + i], p2 = y[4 * n + i], p3 = y[5 * n + i];
        const double w1 = VALUE(0), w2 = VALUE(1), w3 = VALUE(2), o1 = VALUE(3), o2 = VALUE(4), o3 = VALUE(5);
        dy[i] = SLOPE(0) + h2 * o3 - h3 * o2 + p2 * w3 - p3 * w2;
        dy[n + i] = SLOPE(1) + h3 * o1 - h1 * o3 + p3 * w1 - p1 * w3;
        dy[2 * n + i] = SLOPE(2) + h1 * o2 - h2 * o1 + p1 * w2 - p2 * w1;
        dy[3 * n + i] = SLOPE(3) + p2 * o3 - p3 * o2;
        dy[4 * n + i] = SLOPE(4) + p3 * o1 - p1 * o3;
        dy[5 * n + i] = SLOPE(5) + p1 * o2 - p2 * o1;
#endif
    }
}

/* out = ad_E X, column by column */
static inline void ad(const double *restrict e, const matrix X, matrix out)
{
#if D == 3
    for (int j = 0; j < LD; ++j) {
        out[0][j] = e[1] * X[2][j] - e[2] * X[1][j];
        out[1][j] = e[2] * X[0][j] - e[0] * X[2][j];
        out[2][j] = 0.0;
    }
#else
    for (int j = 0; j < LD; ++j) {
        out[0][j] = e[4] * X[2][j] - e[5] * X[1][j] + e[1] * X[5][j] - e[2] * X[4][j];
        out[1][j] = e[5] * X[0][j] - e[3] * X[2][j] + e[2] * X[3][j] - e[0] * X[5][j];
        out[2][j] = e[3] * X[1][j] - e[4] * X[0][j] + e[0] * X[4][j] - e[1] * X[3][j];
        out[3][j] = e[4] * X[5][j] - e[5] * X[4][j];
        out[4][j] = e[5] * X[3][j] - e[3] * X[5][j];
        out[5][j] = e[3] * X[4][j] - e[4] * X[3][j];
    }
#endif
}

/* M += f ad_w */
static inline void add_ad(double f, const double *w, matrix M)
{
#if D == 3
    M[0][1] -= f * w[2];
    M[0][2] += f * w[1];
    M[1][0] += f * w[2];
    M[1][2] -= f * w[0];
#else
    for (int b = 0; b < 2; ++b) {
        M[3 * b][3 * b + 1] -= f * w[5];
        M[3 * b][3 * b + 2] += f * w[4];
        M[3 * b + 1][3 * b] += f * w[5];
        M[3 * b + 1][3 * b + 2] -= f * w[3];
        M[3 * b + 2][3 * b] -= f * w[4];
        M[3 * b + 2][3 * b + 1] += f * w[3];
    }
    M[0][4] -= f * w[2];
    M[0][5] += f * w[1];
    M[1][3] += f * w[2];
    M[1][5] -= f * w[0];
    M[2][3] -= f * w[1];
    M[2][4] += f * w[0];
#endif
}

/* What a change of a cell's strain does to the velocity of its left node, and of its right one. */
static inline void feed(const rod *r, const double *e, double left, double right, matrix to_left, matrix to_right)
{
    const double *k = r->stiffness, half = 0.5 * r->h;
    matrix P = {{0.0}};
#if D == 3
    const double f1 = k[0] * (e[0] - 1.0), f2 = k[1] * e[1];
    P[0][1] = e[2] * k[1];
    P[0][2] = f2;
    P[1][0] = -e[2] * k[0];
    P[1][2] = -f1;
    P[2][0] = e[1] * k[0] - f2;
    P[2][1] = f1 - e[0] * k[1];
#else
    const double F[3] = {k[0] * (e[0] - 1.0), k[1] * e[1], k[2] * e[2]};
    const double M[3] = {k[3] * e[3], k[4] * e[4], k[5] * e[5]};
    for (int i = 0; i < 3; ++i) { /* F x Pi, then M x Pi + F x h */
        const int j = (i + 1) % 3, l = (i + 2) % 3;
        P[i][j] = e[3 + l] * k[j];
        P[i][l] = -e[3 + j] * k[l];
        P[i][3 + j] = -F[l];
        P[i][3 + l] = F[j];
        P[3 + i][j] = e[l] * k[j] - F[l];
        P[3 + i][l] = F[j] - e[j] * k[l];
        P[3 + i][3 + j] = e[3 + l] * k[3 + j] - M[l];
        P[3 + i][3 + l] = M[j] - e[3 + j] * k[3 + l];
    }
#endif
    for (int i = 0; i < D; ++i) {
        const double a = left * r->mobility[i], b = right * r->mobility[i];
        for (int j = 0; j < LD; ++j) {
            to_left[i][j] = -a * half * P[i][j];
            to_right[i][j] = -b * half * P[i][j];
        }
        to_left[i][i] += a * k[i];
        to_right[i][i] -= b * k[i];
    }
}

/* After `rate` at y. */
static void linearise(rod *r, const double *restrict y)
{
    const size_t n = r->cells, N = n + 1;
    const double one = 1.0 / r->h;
    double e[D], next[D] = {0.0};
    matrix before = {{0.0}}, to_left, to_right, next_left = {{0.0}}, next_right = {{0.0}}, turned;
    for (int c = 0; c < D; ++c)
        e[c] = y[c * n];
    feed(r, e, 0.0, n == 1 ? 2.0 * one : one, to_left, to_right);
    for (size_t i = 0; i < n; ++i) {
        couplings *restrict J = r->jacobian + i;
        if (i + 1 < n) {
            for (int c = 0; c < D; ++c)
                next[c] = y[c * n + i + 1];
            feed(r, next, one, i + 2 < n ? one : 2.0 * one, next_left, next_right);
        } else
            for (int a = 0; a < D; ++a)
                for (int b = 0; b < LD; ++b)
                    next_left[a][b] = 0.0;
        double w[D];
        for (int c = 0; c < D; ++c)
            w[c] = r->v[c * N + i] + r->v[c * N + i + 1];
        matrix sum;
        for (int a = 0; a < D; ++a)
            for (int b = 0; b < LD; ++b)
                sum[a][b] = to_left[a][b] + to_right[a][b];
        ad(e, sum, turned);
        for (int a = 0; a < D; ++a)
            for (int b = 0; b < LD; ++b)
                J->own[a][b] = one * (to_right[a][b] - to_left[a][b]) + 0.5 * turned[a][b];
        add_ad(-0.5, w, J->own);
        ad(e, before, turned);
        for (int a = 0; a < D; ++a)
            for (int b = 0; b < LD; ++b)
                J->left[a][b] = 0.5 * turned[a][b] - one * before[a][b];
        ad(e, next_left, turned);
        for (int a = 0; a < D; ++a)
            for (int b = 0; b < LD; ++b)
                J->right[a][b] = 0.5 * turned[a][b] + one * next_left[a][b];
        for (int a = 0; a < D; ++a) {
            e[a] = next[a];
            for (int b = 0; b < LD; ++b) {
                before[a][b] = to_right[a][b];
                to_left[a][b] = next_left[a][b];
                to_right[a][b] = next_right[a][b];
            }
        }
    }
}

static inline void multiply(double f, const matrix X, const matrix Y, matrix out)
{
    for (int i = 0; i < D; ++i) {
        double row[LD] = {0.0};
        for (int k = 0; k < D; ++k)
            for (int j = 0; j < LD; ++j)
                row[j] += X[i][k] * Y[k][j];
        for (int j = 0; j < LD; ++j)
            out[i][j] = f * row[j];
    }
}

static inline void invert(const matrix S, matrix out)
{
#if D == 3
    const double a = S[0][0], b = S[0][1], c = S[0][2], d = S[1][0], e = S[1][1], f = S[1][2];
    const double g = S[2][0], h = S[2][1], i = S[2][2];
    const double A0 = e * i - f * h, A1 = f * g - d * i, A2 = d * h - e * g;
    const double one = 1.0 / (a * A0 + b * A1 + c * A2);
    out[0][0] = one * A0;
    out[0][1] = one * (c * h - b * i);
    out[0][2] = one * (b * f - c * e);
    out[1][0] = one * A1;
    out[1][1] = one * (a * i - c * g);
    out[1][2] = one * (c * d - a * f);
    out[2][0] = one * A2;
    out[2][1] = one * (b * g - a * h);
    out[2][2] = one * (a * e - b * d);
#else
    matrix M;
    for (int i = 0; i < D; ++i)
        for (int j = 0; j < LD; ++j)
            M[i][j] = S[i][j];
    for (int k = 0; k < D; ++k) { /* Gauss-Jordan in place */
        const double one = 1.0 / M[k][k];
        M[k][k] = 1.0;
        for (int j = 0; j < LD; ++j)
            M[k][j] *= one;
        for (int i = 0; i < D; ++i) {
            if (i == k)
                continue;
            const double f = M[i][k];
            M[i][k] = 0.0;
            for (int j = 0; j < LD; ++j)
                M[i][j] -= f * M[k][j];
        }
    }
    for (int i = 0; i < D; ++i)
        for (int j = 0; j < LD; ++j)
            out[i][j] = M[i][j];
#endif
}

/* pivot of a cell: shift - own - outer (coupling of the outer neighbour to this cell) */
static inline void eliminate(double shift, const matrix own, const matrix outer, const matrix inner,
                             const factors *restrict last, const matrix back, factors *restrict f)
{
    matrix S;
    multiply(-1.0, outer, last->pivot, f->outer);
    multiply(1.0, f->outer, back, S);
    for (int i = 0; i < D; ++i) {
        for (int j = 0; j < LD; ++j)
            S[i][j] -= own[i][j];
        S[i][i] += shift;
    }
    invert(S, f->pivot);
    multiply(-1.0, f->pivot, inner, f->inner);
}

static inline void begin(double shift, const matrix own, const matrix inner, factors *restrict f)
{
    matrix S;
    for (int i = 0; i < D; ++i) {
        for (int j = 0; j < LD; ++j)
            S[i][j] = -own[i][j];
        S[i][i] += shift;
    }
    invert(S, f->pivot);
    multiply(-1.0, f->pivot, inner, f->inner);
}

/* Factors shift - jacobian. */
static void factor(rod *r, double shift)
{
    const size_t n = r->cells, m = n / 2;
    const couplings *J = r->jacobian;
    factors *f = r->lu;
    begin(shift, J[0].own, J[0].right, f);
    begin(shift, J[n - 1].own, J[n - 1].left, f + n - 1);
    for (size_t i = 1, j = n - 2; j > m; ++i, --j) {
        eliminate(shift, J[i].own, J[i].left, J[i].right, f + i - 1, J[i - 1].right, f + i);
        eliminate(shift, J[j].own, J[j].right, J[j].left, f + j + 1, J[j + 1].left, f + j);
    }
    eliminate(shift, J[m - 1].own, J[m - 1].left, J[m - 1].right, f + m - 2, J[m - 2].right, f + m - 1);
    /* both neighbours of cell m are done */
    matrix own, off;
    multiply(-1.0, J[m].left, f[m - 1].pivot, r->across);
    multiply(1.0, r->across, J[m - 1].right, off);
    for (int i = 0; i < D; ++i)
        for (int j = 0; j < LD; ++j)
            own[i][j] = J[m].own[i][j] - off[i][j];
    eliminate(shift, own, J[m].right, J[m].left, f + m + 1, J[m + 1].left, f + m);
}

#define LOAD(x, i) { for (int c = 0; c < D; ++c) x[c] = b[c * n + (i)]; }

/* x -= M last */
static inline void off(const matrix M, const double *last, double *x)
{
    for (int i = 0; i < D; ++i) {
        double sum = x[i];
        for (int j = 0; j < D; ++j)
            sum -= M[i][j] * last[j];
        x[i] = sum;
    }
}

static inline void times(const matrix M, const double *x, double *out)
{
    for (int i = 0; i < D; ++i) {
        double sum = M[i][0] * x[0];
        for (int j = 1; j < D; ++j)
            sum += M[i][j] * x[j];
        out[i] = sum;
    }
}

/* b becomes the solution */
static void solve(const rod *r, double *restrict b)
{
    const size_t n = r->cells, m = n / 2;
    const factors *restrict f = r->lu;
    double p[D], q[D], x[D], z[D];
    LOAD(p, 0)
    LOAD(q, n - 1)
    for (size_t i = 1, j = n - 2; i < m; ++i, --j) {
        LOAD(x, i)
        LOAD(z, j)
        off(f[i].outer, p, x);
        off(f[j].outer, q, z);
        for (int c = 0; c < D; ++c) {
            b[c * n + i] = p[c] = x[c];
            b[c * n + j] = q[c] = z[c];
        }
    }
    off(r->across, p, q);
    times(f[m].pivot, q, z);
    times(f[m - 1].pivot, p, x);
    off(f[m - 1].inner, z, x);
    for (int c = 0; c < D; ++c) {
        b[c * n + m] = q[c] = z[c];
        b[c * n + m - 1] = p[c] = x[c];
    }
    for (size_t i = m - 1, j = m + 1; i-- > 0; ++j) {
        double a[D];
        LOAD(a, i)
        times(f[i].pivot, a, x);
        LOAD(a, j)
        times(f[j].pivot, a, z);
        off(f[i].inner, p, x);
        off(f[j].inner, q, z);
        for (int c = 0; c < D; ++c) {
            b[c * n + i] = p[c] = x[c];
            b[c * n + j] = q[c] = z[c];
        }
    }
}

/* root mean square of e over atol + rtol |y| */
static double norm(size_t size, const double *restrict e, const double *restrict y, double rtol, double atol)
{
    double sums[SUMS] = {0.0}, sum = 0.0;
    size_t i = 0;
    for (; i + SUMS <= size; i += SUMS)
        for (int j = 0; j < SUMS; ++j) {
            const double x = e[i + j] / (atol + rtol * fabs(y[i + j]));
            sums[j] += x * x;
        }
    for (; i < size; ++i) {
        const double x = e[i] / (atol + rtol * fabs(y[i]));
        sum += x * x;
    }
    for (int j = 0; j < SUMS; ++j)
        sum += sums[j];
    return sqrt(sum / (double)size);
}

/* y + A_0 u_0 + ... of stage s */
#define STAGE(s, TERMS)                                      \
    INDEPENDENT                                              \
    for (size_t i = 0; i < size; ++i)                        \
        trial[i] = y[i] + (TERMS);                           \
    rate(r, trial, u[s]);
#define RIGHT(s, TERMS)                                      \
    INDEPENDENT                                              \
    for (size_t i = 0; i < size; ++i)                        \
        u[s][i] += TERMS;                                    \
    solve(r, u[s]);

/* The six stages of a step of length h from y, whose rate is u[0]: trial is then the new state, u[5] the error. */
static void step(rod *r, size_t size, double h, const double *restrict y, double *restrict trial,
                 double *restrict u[STAGES])
{
    const double one = 1.0 / h;
    const double *restrict a = u[0], *restrict b = u[1], *restrict c = u[2], *restrict d = u[3], *restrict e = u[4];
    double k[STAGES][STAGES];
    for (int i = 0; i < STAGES; ++i)
        for (int j = 0; j < i; ++j)
            k[i][j] = one * C[i][j];
    solve(r, u[0]);
    STAGE(1, A[1][0] * a[i])
    RIGHT(1, k[1][0] * a[i])
    STAGE(2, A[2][0] * a[i] + A[2][1] * b[i])
    RIGHT(2, k[2][0] * a[i] + k[2][1] * b[i])
    STAGE(3, A[3][0] * a[i] + A[3][1] * b[i] + A[3][2] * c[i])
    RIGHT(3, k[3][0] * a[i] + k[3][1] * b[i] + k[3][2] * c[i])
    STAGE(4, A[4][0] * a[i] + A[4][1] * b[i] + A[4][2] * c[i] + A[4][3] * d[i])
    RIGHT(4, k[4][0] * a[i] + k[4][1] * b[i] + k[4][2] * c[i] + k[4][3] * d[i])
    INDEPENDENT
    for (size_t i = 0; i < size; ++i)
        trial[i] += e[i];
    rate(r, trial, u[5]);
    RIGHT(5, k[5][0] * a[i] + k[5][1] * b[i] + k[5][2] * c[i] + k[5][3] * d[i] + k[5][4] * e[i])
    const double *restrict last = u[5];
    INDEPENDENT
    for (size_t i = 0; i < size; ++i)
        trial[i] += last[i];
}

static void *aligned(size_t bytes)
{
    void *made = NULL;
    return posix_memalign(&made, 64, bytes) ? NULL : made;
}

/* Integrates y over a time; atol like rtol. counts: steps, rejected ones. Returns 0, or 1 if it gives up. */
int relax(int cells, double length, const double *stiffness, const double *friction, double *y, double until,
          double rtol, double first, long *counts)
{
    const size_t n = (size_t)cells, size = D * n;
    rod r = {.cells = n, .h = length / cells};
    for (int c = 0; c < D; ++c) {
        r.stiffness[c] = stiffness[c];
        r.mobility[c] = 1.0 / friction[c];
    }
    double *numbers = aligned(sizeof(double) * ((STAGES + 5) * size + D * (n + 1)));
    r.jacobian = aligned(n * sizeof(couplings));
    r.lu = aligned(n * sizeof(factors));
    if (!numbers || !r.jacobian || !r.lu)
        return 1;
    double *at = numbers, *u[STAGES];
    for (int i = 0; i < STAGES; ++i, at += size)
        u[i] = at;
    double *now = at, *trial = now + size, *slope = trial + size;
    r.stress = slope + size;
    r.pull = r.stress + size;
    r.v = r.pull + size;
    for (size_t i = 0; i < size; ++i)
        now[i] = y[i];
    double t = 0.0, h = first, last_h = 0.0, last_error = 1.0;
    int failed = 0, rejected = 0;
    counts[0] = counts[1] = 0;
    rate(&r, now, slope);
    linearise(&r, now);
    while (t < until) {
        if (t + h >= until)
            h = until - t;
        if (counts[0] + counts[1] > 1000000 || h < 1e-14 * until) {
            failed = 1;
            break;
        }
        for (size_t i = 0; i < size; ++i)
            u[0][i] = slope[i];
        factor(&r, 1.0 / (GAMMA * h));
        step(&r, size, h, now, trial, u);
        double error = norm(size, u[5], now, rtol, rtol);
        if (!(error < 1e12))
            error = 1e12;
        /* as in the book: the plain rule, and with the last error when steps are accepted */
        double change = pow(error, 0.25) / 0.9;
        change = change < 1.0 / 6.0 ? 1.0 / 6.0 : change > 5.0 ? 5.0 : change;
        if (error <= 1.0) {
            counts[0]++;
            t += h;
            if (counts[0] > 1) {
                double foreseen = last_h / h * pow(error * error / last_error, 0.25) / 0.9;
                foreseen = foreseen < 1.0 / 6.0 ? 1.0 / 6.0 : foreseen > 5.0 ? 5.0 : foreseen;
                change = foreseen > change ? foreseen : change;
            }
            last_h = h;
            last_error = error > 0.01 ? error : 0.01;
            double *swap = now;
            now = trial;
            trial = swap;
            if (t >= until)
                break;
            rate(&r, now, slope);
            linearise(&r, now);
            h = rejected && change < 1.0 ? h : h / change;
            rejected = 0;
        } else {
            counts[1]++;
            rejected = 1;
            h /= change;
        }
    }
    for (size_t i = 0; i < size; ++i)
        y[i] = now[i];
    free(numbers);
    free(r.jacobian);
    free(r.lu);
    return failed;
}
