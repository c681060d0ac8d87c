/* What one would write by hand for one rod: straight at rest, diagonal stiffness and friction, clamped on the left,
 * free on the right, uniform elements, no loads and no energies. The scheme is that of the generated kernels:
 * twist at Gauss-Lobatto nodes, turn and stress at Gauss points, DEGREE known to the compiler. State [D][points].
 */
#include <stddef.h>

#ifndef DEGREE
#error "compile with -DDEGREE=p"
#endif
#define P DEGREE
#define INDEPENDENT _Pragma("GCC ivdep")

typedef struct hand {
    int elements;
    double half;              /* half the length of an element */
    double stiffness[6], mobility[6];
    const double *values, *slopes; /* [P+1][P] */
    const double *pull, *push;     /* [P][P+1], with the Gauss weights */
    const double *share;           /* [nodes] one over the lumped mass */
    double *work;                  /* 4 D (points + 2) numbers */
} hand;

#if DEGREE == 1
/* force[n] = difference of the stress over node n, minus the mean of the pull times the element length */
static void gather(const hand *h, size_t Q, const double *restrict s, const double *restrict p, double *restrict f)
{
    const double half = h->half;
    f[0] = s[0] - half * p[0];
    INDEPENDENT
    for (size_t n = 1; n < Q; ++n)
        f[n] = s[n] - s[n - 1] - half * (p[n] + p[n - 1]);
    f[Q] = -s[Q - 1] - half * p[Q - 1];
}
#else
static void gather(const hand *h, size_t Q, const double *restrict s, const double *restrict p, double *restrict f)
{
    double last = 0.0;
    for (size_t e = 0; e < Q / P; ++e, s += P, p += P, f += P) {
        double g[P + 1] = {0.0};
        for (int q = 0; q < P; ++q) {
            const double a = s[q], b = h->half * p[q];
            for (int n = 0; n <= P; ++n)
                g[n] -= h->push[q * (P + 1) + n] * a + h->pull[q * (P + 1) + n] * b;
        }
        for (int n = 0; n < P; ++n)
            f[n] = g[n];
        f[0] += last;
        last = g[P];
    }
    *f = last;
}
#endif

/* slope and value of a nodal field at the points of element e */
static inline void spread(const hand *h, const double *restrict v, double *restrict slope, double *restrict value)
{
    double a[P] = {0.0}, b[P] = {0.0};
    for (int n = 0; n <= P; ++n)
        for (int q = 0; q < P; ++q) {
            a[q] += h->slopes[n * P + q] * v[n];
            b[q] += h->values[n * P + q] * v[n];
        }
    for (int q = 0; q < P; ++q) {
        slope[q] = a[q] / h->half;
        value[q] = b[q];
    }
}

void hand_planar(const hand *h, const double *restrict y, double *restrict dy)
{
    const size_t Q = (size_t)h->elements * P, N = Q + 1;
    const double k1 = h->stiffness[0], k2 = h->stiffness[1], k3 = h->stiffness[2];
    double *restrict s = h->work, *restrict p = s + 3 * Q, *restrict v = p + 3 * Q;
    INDEPENDENT
    for (size_t i = 0; i < Q; ++i) {
        const double h1 = y[i], h2 = y[Q + i], bend = y[2 * Q + i];
        const double f1 = k1 * (h1 - 1.0), f2 = k2 * h2;
        s[i] = f1;
        s[Q + i] = f2;
        s[2 * Q + i] = k3 * bend;
        p[i] = bend * f2;
        p[Q + i] = -bend * f1;
        p[2 * Q + i] = h2 * f1 - h1 * f2;
    }
    for (int c = 0; c < 3; ++c) {
        double *restrict out = v + c * N;
        const double m = h->mobility[c];
        const double *restrict share = h->share;
        gather(h, Q, s + c * Q, p + c * Q, out);
        INDEPENDENT
        for (size_t n = 0; n < N; ++n)
            out[n] *= m * share[n];
        out[0] = 0.0;
    }
#if DEGREE == 1
    const double scale = 0.5 / h->half;
    INDEPENDENT
    for (size_t i = 0; i < Q; ++i) {
        const double a1 = v[i], a2 = v[N + i], a3 = v[2 * N + i], b1 = v[i + 1], b2 = v[N + i + 1], b3 = v[2 * N + i + 1];
        const double w1 = 0.5 * (a1 + b1), w2 = 0.5 * (a2 + b2), w3 = 0.5 * (a3 + b3);
        const double h1 = y[i], h2 = y[Q + i], bend = y[2 * Q + i];
        dy[i] = scale * (b1 - a1) + h2 * w3 - bend * w2;
        dy[Q + i] = scale * (b2 - a2) + bend * w1 - h1 * w3;
        dy[2 * Q + i] = scale * (b3 - a3);
    }
#else
    for (size_t e = 0; e < (size_t)h->elements; ++e) {
        double slope[3][P], w[3][P];
        for (int c = 0; c < 3; ++c)
            spread(h, v + c * N + e * P, slope[c], w[c]);
        for (int q = 0; q < P; ++q) {
            const size_t i = e * P + q;
            const double h1 = y[i], h2 = y[Q + i], bend = y[2 * Q + i];
            dy[i] = slope[0][q] + h2 * w[2][q] - bend * w[1][q];
            dy[Q + i] = slope[1][q] + bend * w[0][q] - h1 * w[2][q];
            dy[2 * Q + i] = slope[2][q];
        }
    }
#endif
}

#define SPATIAL_RATES(S, W)                                                                   \
    dy[i] = S(0) + h3 * W(4) * -1.0 + h2 * W(5) + p2 * W(2) - p3 * W(1);                      \
    dy[Q + i] = S(1) + h3 * W(3) - h1 * W(5) + p3 * W(0) - p1 * W(2);                         \
    dy[2 * Q + i] = S(2) + h1 * W(4) - h2 * W(3) + p1 * W(1) - p2 * W(0);                     \
    dy[3 * Q + i] = S(3) + p2 * W(5) - p3 * W(4);                                             \
    dy[4 * Q + i] = S(4) + p3 * W(3) - p1 * W(5);                                             \
    dy[5 * Q + i] = S(5) + p1 * W(4) - p2 * W(3);

void hand_spatial(const hand *h, const double *restrict y, double *restrict dy)
{
    const size_t Q = (size_t)h->elements * P, N = Q + 1;
    const double *k = h->stiffness;
    const double k1 = k[0], k2 = k[1], k3 = k[2], k4 = k[3], k5 = k[4], k6 = k[5];
    double *restrict s = h->work, *restrict p = s + 6 * Q, *restrict v = p + 6 * Q;
    INDEPENDENT
    for (size_t i = 0; i < Q; ++i) {
        const double h1 = y[i], h2 = y[Q + i], h3 = y[2 * Q + i];
        const double p1 = y[3 * Q + i], p2 = y[4 * Q + i], p3 = y[5 * Q + i];
        const double f1 = k1 * (h1 - 1.0), f2 = k2 * h2, f3 = k3 * h3, m1 = k4 * p1, m2 = k5 * p2, m3 = k6 * p3;
        s[i] = f1;
        s[Q + i] = f2;
        s[2 * Q + i] = f3;
        s[3 * Q + i] = m1;
        s[4 * Q + i] = m2;
        s[5 * Q + i] = m3;
        p[i] = p3 * f2 - p2 * f3; /* minus the cross products of the balance law */
        p[Q + i] = p1 * f3 - p3 * f1;
        p[2 * Q + i] = p2 * f1 - p1 * f2;
        p[3 * Q + i] = p3 * m2 - p2 * m3 + h3 * f2 - h2 * f3;
        p[4 * Q + i] = p1 * m3 - p3 * m1 + h1 * f3 - h3 * f1;
        p[5 * Q + i] = p2 * m1 - p1 * m2 + h2 * f1 - h1 * f2;
    }
    for (int c = 0; c < 6; ++c) {
        double *restrict out = v + c * N;
        const double m = h->mobility[c];
        const double *restrict share = h->share;
        gather(h, Q, s + c * Q, p + c * Q, out);
        INDEPENDENT
        for (size_t n = 0; n < N; ++n)
            out[n] *= m * share[n];
        out[0] = 0.0;
    }
#if DEGREE == 1
    const double scale = 0.5 / h->half;
#define SLOPE(c) scale * (v[c * N + i + 1] - v[c * N + i])
#define VALUE(c) (0.5 * (v[c * N + i + 1] + v[c * N + i]))
    INDEPENDENT
    for (size_t i = 0; i < Q; ++i) {
        const double h1 = y[i], h2 = y[Q + i], h3 = y[2 * Q + i];
        const double p1 = y[3 * Q + i], p2 = y[4 * Q + i], p3 = y[5 * Q + i];
        SPATIAL_RATES(SLOPE, VALUE)
    }
#else
#define SLOPE(c) slope[c][q]
#define VALUE(c) w[c][q]
    for (size_t e = 0; e < (size_t)h->elements; ++e) {
        double slope[6][P], w[6][P];
        for (int c = 0; c < 6; ++c)
            spread(h, v + c * N + e * P, slope[c], w[c]);
        for (int q = 0; q < P; ++q) {
            const size_t i = e * P + q;
            const double h1 = y[i], h2 = y[Q + i], h3 = y[2 * Q + i];
            const double p1 = y[3 * Q + i], p2 = y[4 * Q + i], p3 = y[5 * Q + i];
            SPATIAL_RATES(SLOPE, VALUE)
        }
    }
#endif
}
