/* Systems  (1 - g A) x = b  with one real matrix A and several complex numbers g, which change more often than A does.
 *
 * A is brought to Hessenberg form once, A = T H T^-1, by eliminations with exchanges of rows and columns; what is to be
 * done for new g then grows with the square of the size, not with its cube. All g are treated at once, one in each lane of
 * vectors, which are those of gcc and clang: wider or narrower than the machine's as they may be.
 *
 * Sources: W. H. Enright, ACM Trans. Math. Softw. 4 (1978) 127, for the idea; J. H. Wilkinson, The Algebraic Eigenvalue
 * Problem (1965), section 6.8, for the reduction.
 */
#include <limits.h>
#include <math.h>
#include <string.h>

enum { LANES = 4, ROWS = 2 * LANES }; /* columns of matrices are padded to a multiple of ROWS */

typedef double lanes __attribute__((vector_size(LANES * sizeof(double)), aligned(sizeof(double))));
/* All bits of a lane, or none. */
typedef long long choice __attribute__((vector_size(LANES * sizeof(long long)), aligned(sizeof(long long))));

/* Rows of a column, or what a number is made of. */
typedef double strip __attribute__((vector_size(ROWS * sizeof(double)), aligned(sizeof(double))));

/* A complex number in each lane. */
typedef struct number {
    lanes re, im;
} number;

/* order: which row of A is which of T's; lower: T's unit lower triangle, by rows; H by columns; upper: the triangles that H
 * is eliminated to, by columns one after the other, with one over the diagonal; factor, exchanged: how. */
typedef struct shifted {
    int size, width; /* of A; of the columns of H and the rows of `lower` */
    int *order;
    double *H, *lower, *y; /* y: room for a column */
    number *upper, *factor, *row;
    choice *exchanged;
} shifted;

static int padded_rows(int n)
{
    return (n + ROWS - 1) / ROWS * ROWS;
}

/* Exchanges count numbers that lie so far apart. */
static void exchange(int count, int apart, double *x, double *y)
{
    for (int i = 0; i < count * apart; i += apart) {
        const double swap = x[i];
        x[i] = y[i];
        y[i] = swap;
    }
}

/* One elimination, from both sides: from column m on less multiples y of row m for the rows below it, and then all columns
 * times y added to column m. In one pass, for a strip of rows at a time; two sums, since each waits for its last addition. */
static inline void eliminate(int width, int m, int size, double *A, const double *y)
{
    strip *to = (strip *)(A + m * width);
    const double corner = A[m * width + m];
    int top = 0;
    for (; top + ROWS <= m; top += ROWS, ++to) { /* rows above: columns only */
        const double *column = A + (m + 1) * width + top;
        strip sum = *to, more = {0.0};
        int j = m + 1;
        for (; j + 1 < size; j += 2, column += 2 * width) {
            sum += y[j] * *(const strip *)column;
            more += y[j + 1] * *(const strip *)(column + width);
        }
        if (j < size)
            sum += y[j] * *(const strip *)column;
        *to = sum + more;
    }
    for (; top < width; top += ROWS, ++to) {
        const strip own = *(const strip *)(y + top);
        strip sum = *to - corner * own, more = 0.0 * own;
        int j = m + 1;
        for (; j + 1 < size; j += 2) {
            double *column = A + j * width, *next = column + width;
            strip *a = (strip *)(column + top), *b = (strip *)(next + top);
            *a -= column[m] * own;
            *b -= next[m] * own;
            sum += y[j] * *a;
            more += y[j + 1] * *b;
        }
        if (j < size) {
            strip *a = (strip *)(A + j * width + top);
            *a -= A[j * width + m] * own;
            sum += y[j] * *a;
        }
        *to = sum + more;
    }
}

/* The Hessenberg form of what stands in H. */
static void reduce(shifted *s)
{
    const int n = s->size, w = s->width;
    double *H = s->H, *y = s->y;
    for (int i = 0; i < n; ++i)
        s->order[i] = i;
    memset(s->lower, 0, (size_t)n * w * sizeof *s->lower);
    for (int m = 1; m + 1 < n; ++m) {
        double *column = H + (m - 1) * w;
        int best = m;
        for (int i = m + 1; i < n; ++i)
            best = fabs(column[i]) > fabs(column[best]) ? i : best;
        if (best != m) {
            const int swap = s->order[m];
            s->order[m] = s->order[best];
            s->order[best] = swap;
            exchange(n - m + 1, w, column + m, column + best);
            exchange(n, 1, H + m * w, H + best * w);
            exchange(m, 1, s->lower + m * w, s->lower + best * w);
        }
        if (column[m] == 0.0)
            continue;
        const double one = 1.0 / column[m];
        memset(y, 0, w * sizeof *y);
        for (int i = m + 1; i < n; ++i) {
            y[i] = s->lower[i * w + m] = one * column[i];
            column[i] = 0.0;
        }
        eliminate(w, m, n, H, y);
    }
}

static inline number times(number a, number b)
{
    return (number){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

/* a - b c */
static inline number less(number a, number b, number c)
{
    return (number){a.re - b.re * c.re + b.im * c.im, a.im - b.re * c.im - b.im * c.re};
}

static inline lanes magnitude(lanes x)
{
    return (lanes)((choice)x & LLONG_MAX);
}

static inline void exchange_lanes(choice where, lanes *x, lanes *y)
{
    const choice differs = ((choice)*x ^ (choice)*y) & where;
    *x = (lanes)((choice)*x ^ differs);
    *y = (lanes)((choice)*y ^ differs);
}

static inline void exchange_numbers(choice where, number *x, number *y)
{
    exchange_lanes(where, &x->re, &y->re);
    exchange_lanes(where, &x->im, &y->im);
}

/* Factors 1 - g H. Returns 1 if a lane is singular. */
static int shift(shifted *s, number g)
{
    const int n = s->size, w = s->width;
    const number zero = {{0.0}, {0.0}};
    number *row = s->row;
    lanes bad = zero.re;
    for (int j = 0; j < n; ++j)
        row[j] = (number){(j == 0) - g.re * s->H[j * w], -g.im * s->H[j * w]};
    for (int k = 0; k < n; ++k) {
        const double *H = s->H + k + 1; /* the next row */
        number pivot = row[k], below = k + 1 < n ? (number){-g.re * H[k * w], -g.im * H[k * w]} : zero;
        const lanes least = magnitude(pivot.re) + magnitude(pivot.im);
        const choice where = (choice)(magnitude(below.re) + magnitude(below.im) > least);
        exchange_numbers(where, &pivot, &below);
        const lanes size = 1.0 / (pivot.re * pivot.re + pivot.im * pivot.im);
        const number one = {size * pivot.re, -size * pivot.im}, f = times(below, one);
        bad += size - size; /* 0, or NaN */
        number *at = s->upper + k * (k + 1) / 2 + k;
        *at = one;
        s->factor[k] = f;
        s->exchanged[k] = where;
        for (int j = k + 1; j < n; ++j) {
            number a = row[j], b = {(j == k + 1) - g.re * H[j * w], -g.im * H[j * w]};
            exchange_numbers(where, &a, &b);
            at += j;
            *at = a;
            row[j] = less(b, f, a);
        }
    }
    double all = 0.0;
    for (int l = 0; l < LANES; ++l)
        all += bad[l];
    return all != 0.0;
}

/* Four rows of the strictly lower triangle, left of column `end`, times f x, added to y. At once, since each waits for its
 * last addition; real and imaginary parts of all lanes make one strip. */
static inline void add_rows(int w, const double *restrict row, int end, double f, const strip *restrict x, strip *y)
{
    strip a = y[0], b = y[1], c = y[2], d = y[3];
    for (int j = 1; j < end; ++j) {
        const strip g = f * x[j];
        a += row[j] * g;
        b += row[w + j] * g;
        c += row[2 * w + j] * g;
        d += row[3 * w + j] * g;
    }
    y[0] = a;
    y[1] = b;
    y[2] = c;
    y[3] = d;
}

/* The same of row i by itself, from column `begin` on. */
static inline void add_row(const double *restrict row, int begin, int i, double f, strip *x)
{
    strip sum = x[i];
    for (int j = begin; j < i; ++j)
        sum += f * row[j] * x[j];
    x[i] = sum;
}

/* x becomes T^-1 x. */
static void untwist(int n, int w, const double *lower, strip *x)
{
    int i = 0;
    for (; i + 4 <= n; i += 4) {
        add_rows(w, lower + i * w, i, -1.0, x, x + i);
        for (int k = 0; k < 4; ++k)
            add_row(lower + (i + k) * w, i > 0 ? i : 1, i + k, -1.0, x);
    }
    for (; i < n; ++i)
        add_row(lower + i * w, 1, i, -1.0, x);
}

/* x becomes T x. */
static void twist(int n, int w, const double *lower, strip *x)
{
    int i = n;
    for (; i % 4; --i)
        add_row(lower + (i - 1) * w, 1, i - 1, 1.0, x);
    for (; i > 0; i -= 4) {
        for (int k = 3; k >= 0; --k)
            add_row(lower + (i - 4 + k) * w, i > 4 ? i - 4 : 1, i - 4 + k, 1.0, x);
        add_rows(w, lower + (i - 4) * w, i - 4, 1.0, x, x + i - 4);
    }
}

/* x, in the order of T, becomes the solution. */
static void solve_shifted(const shifted *s, number *restrict x)
{
    const int n = s->size, w = s->width;
    untwist(n, w, s->lower, (strip *)x);
    for (int k = 0; k + 1 < n; ++k) {
        exchange_numbers(s->exchanged[k], x + k, x + k + 1);
        x[k + 1] = less(x[k + 1], s->factor[k], x[k]);
    }
    int j = n - 1;
    for (; j > 0; j -= 2) { /* two columns at once: x is then read and written half as often */
        const number *restrict a = s->upper + j * (j + 1) / 2, *restrict b = a - j;
        const number f = x[j] = times(x[j], a[j]), g = x[j - 1] = times(less(x[j - 1], a[j - 1], f), b[j - 1]);
        for (int i = j - 2; i >= 0; --i) /* what is waited for first */
            x[i] = less(less(x[i], a[i], f), b[i], g);
    }
    if (j == 0)
        x[0] = times(x[0], s->upper[0]);
    twist(n, w, s->lower, (strip *)x);
}
