#include "engine/math/predicates.h"

#include <algorithm>
#include <array>

namespace plumb::inline PLUMB_PRECISION {

namespace exact {

namespace {

// A real number as the exact sum of nonzero doubles with non-overlapping bits, smallest first, so
// the last one has the sign of the sum. N is the maximum count.
template <std::size_t N> struct Expansion {
    std::array<double, N> parts; // uninitialised beyond count
    std::size_t count = 0;

    Expansion() = default;
    // The sum of a rounded value and its error.
    Expansion(double value, double error) requires(N == 2) {
        add(error);
        add(value);
    }
    // From an expansion with spare capacity.
    template <std::size_t M>
    explicit Expansion(const Expansion<M> &other) requires(M > N) : count(other.count) {
        std::copy_n(other.parts.begin(), count, parts.begin());
    }
    void add(double part) {
        if (part != 0.0)
            parts[count++] = part;
    }
    // The sum as one double, off by at most two roundings (Shewchuk 1997, section 2.8).
    double rounded() const {
        double total = 0.0;
        for (std::size_t i = 0; i < count; ++i)
            total += parts[i];
        return total;
    }
    int sign() const { return count == 0 ? 0 : (parts[count - 1] > 0.0 ? 1 : -1); }
};

// The part of a + b lost in rounding to `sum` (Knuth 1969; Shewchuk 1997, theorem 7).
double error_of_sum(double a, double b, double sum) {
    const double b_virtual = sum - a;
    const double a_virtual = sum - b_virtual;
    return (a - a_virtual) + (b - b_virtual);
}

// The same when |a| >= |b| (Dekker 1971; Shewchuk 1997, theorem 6).
double error_of_ordered_sum(double a, double b, double sum) {
    return b - (sum - a);
}

// Two halves of 26 bits (Dekker 1971; Shewchuk 1997, theorem 17).
struct Halves {
    double high;
    double low;

    explicit Halves(double a) {
        constexpr double splitter = 0x1p27 + 1.0;
        const double c = splitter * a;
        high = c - (c - a);
        low = a - high;
    }
};

// The part of a * b lost in rounding to `product` (Shewchuk 1997, theorem 18).
double error_of_product(double a, double b, double product) {
    const Halves x(a), y(b);
    const double rest = product - x.high * y.high - x.low * y.high - x.high * y.low;
    return x.low * y.low - rest;
}

Expansion<2> difference(double a, double b) {
    const double value = a - b;
    return {value, error_of_sum(a, -b, value)};
}

Expansion<2> product(double a, double b) {
    const double value = a * b;
    return {value, error_of_product(a, b, value)};
}

// Fast expansion sum with zero elimination (Shewchuk 1997, section 2.4, figure 9).
template <std::size_t M, std::size_t N>
Expansion<M + N> sum(const Expansion<M> &e, const Expansion<N> &f) {
    Expansion<M + N> h;
    std::size_t i = 0, j = 0;
    const auto next = [&] {
        const bool from_e =
            j == f.count || (i < e.count && std::abs(e.parts[i]) < std::abs(f.parts[j]));
        return from_e ? e.parts[i++] : f.parts[j++];
    };
    const std::size_t total = e.count + f.count;
    if (total == 0)
        return h;
    double q = next();
    for (std::size_t k = 1; k < total; ++k) {
        const double part = next();
        const double value = part + q;
        h.add(k == 1 ? error_of_ordered_sum(part, q, value) : error_of_sum(q, part, value));
        q = value;
    }
    h.add(q);
    return h;
}

// Scale expansion with zero elimination (Shewchuk 1997, section 2.5, figure 13).
template <std::size_t N> Expansion<2 * N> scaled(const Expansion<N> &e, double b) {
    Expansion<2 * N> h;
    if (e.count == 0)
        return h;
    double q = e.parts[0] * b;
    h.add(error_of_product(e.parts[0], b, q));
    for (std::size_t i = 1; i < e.count; ++i) {
        const double value = e.parts[i] * b;
        const double error = error_of_product(e.parts[i], b, value);
        const double low = q + error;
        h.add(error_of_sum(q, error, low));
        q = value + low;
        h.add(error_of_ordered_sum(value, low, q));
    }
    h.add(q);
    return h;
}

template <std::size_t N> Expansion<4 * N> product(const Expansion<N> &e, const Expansion<2> &f) {
    if (f.count < 2)
        return sum(scaled(e, f.count == 0 ? 0.0 : f.parts[0]), Expansion<2 * N>());
    return sum(scaled(e, f.parts[0]), scaled(e, f.parts[1]));
}

template <std::size_t N> Expansion<2 * N * N> squared(const Expansion<N> &e) {
    Expansion<2 * N * N> total;
    for (std::size_t i = 0; i < e.count; ++i)
        total = Expansion<2 * N * N>(sum(total, scaled(e, e.parts[i])));
    return total;
}

template <std::size_t N> Expansion<N> negated(Expansion<N> e) {
    for (std::size_t i = 0; i < e.count; ++i)
        e.parts[i] = -e.parts[i];
    return e;
}

// a d - b c.
Expansion<16> minor_of(const Expansion<2> &a, const Expansion<2> &b, const Expansion<2> &c,
                       const Expansion<2> &d) {
    return sum(product(a, d), negated(product(b, c)));
}

} // namespace

// Each vector component is passed as a pair of numbers: the first minus the second.

int cross_sign(const double (&u)[2][2], const double (&v)[2][2]) {
    return minor_of(difference(u[0][0], u[0][1]), difference(u[1][0], u[1][1]),
                    difference(v[0][0], v[0][1]), difference(v[1][0], v[1][1]))
        .sign();
}

int triple_sign(const double (&u)[3][2], const double (&v)[3][2], const double (&w)[3][2]) {
    std::array<Expansion<2>, 3> a, b, c;
    for (std::size_t i = 0; i < 3; ++i) {
        a[i] = difference(u[i][0], u[i][1]);
        b[i] = difference(v[i][0], v[i][1]);
        c[i] = difference(w[i][0], w[i][1]);
    }
    const auto x = product(minor_of(b[1], b[2], c[1], c[2]), a[0]);
    const auto y = product(minor_of(b[2], b[0], c[2], c[0]), a[1]);
    const auto z = product(minor_of(b[0], b[1], c[0], c[1]), a[2]);
    return sum(sum(x, y), z).sign();
}

int plane_sign(const double (&normal)[3], double offset, const double (&point)[3]) {
    return sum(sum(product(normal[0], point[0]), product(normal[1], point[1])),
               sum(product(normal[2], point[2]), Expansion<2>(-offset, 0.0)))
        .sign();
}

int product_difference_sign(double a, double b, double c, double d) {
    return sum(product(a, b), negated(product(c, d))).sign();
}

int dot_sign(const double (&u)[3][2], const double (&v)[3][2]) {
    const auto part = [&](std::size_t i) {
        return product(difference(u[i][0], u[i][1]), difference(v[i][0], v[i][1]));
    };
    return sum(sum(part(0), part(1)), part(2)).sign();
}

int ball_sign(double radius, const double (&m)[3][2]) {
    const auto part = [&](std::size_t i) { return squared(difference(m[i][0], m[i][1])); };
    return sum(product(radius, radius), negated(sum(sum(part(0), part(1)), part(2)))).sign();
}

int line_ball_sign(double radius, const double (&m)[3][2], const double (&d)[3][2]) {
    std::array<Expansion<2>, 3> a, b;
    for (std::size_t i = 0; i < 3; ++i) {
        a[i] = difference(m[i][0], m[i][1]);
        b[i] = difference(d[i][0], d[i][1]);
    }
    const auto reach =
        product(sum(sum(squared(b[0]), squared(b[1])), squared(b[2])), product(radius, radius));
    const auto moment_squared = [&](std::size_t i, std::size_t j) {
        return squared(minor_of(a[i], a[j], b[i], b[j]));
    };
    const auto away = sum(sum(moment_squared(1, 2), moment_squared(2, 0)), moment_squared(0, 1));
    return sum(reach, negated(away)).sign();
}

glm::dvec3 cross(const double (&u)[3][2], const double (&v)[3][2]) {
    std::array<Expansion<2>, 3> a, b;
    for (std::size_t i = 0; i < 3; ++i) {
        a[i] = difference(u[i][0], u[i][1]);
        b[i] = difference(v[i][0], v[i][1]);
    }
    return {minor_of(a[1], a[2], b[1], b[2]).rounded(), minor_of(a[2], a[0], b[2], b[0]).rounded(),
            minor_of(a[0], a[1], b[0], b[1]).rounded()};
}

} // namespace exact

} // namespace plumb::inline PLUMB_PRECISION
