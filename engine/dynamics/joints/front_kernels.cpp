// The work on dense fronts. Compiled once for each instruction set, by including itself. Each
// number comes of the same operations in the same order at any width.
#include "engine/dynamics/joints/fronts.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/dynamics/joints/front_kernels.cpp"
// As for the other kernels.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#include <hwy/foreach_target.h>
// After foreach_target.h, which must choose the target first.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace plumb::inline PLUMB_PRECISION {
namespace kernels::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
template <typename Number> using Tag = hn::CappedTag<Number, front_lanes>;

// Where a vector begins that has the row.
template <typename Number> HWY_INLINE std::size_t whole(std::size_t row) {
    const std::size_t lanes = hn::Lanes(Tag<Number>());
    return row / lanes * lanes;
}

// Three columns at a time.
template <typename Number> struct Three {
    Number *x, *y, *z;
    Three(const FrontColumns<Number> &columns, std::size_t column)
        : x(columns.at(0, column)), y(x + columns.stride), z(y + columns.stride) {}
};

// Takes the product of three columns, `then` of K and `now` of L, from three others. Their rows
// begin `skipped` rows further down. The first row that counts is `first`.
template <typename Number>
HWY_INLINE void take(const Three<Number> &then, const Three<Number> &now, std::size_t first,
                     const FrontColumns<Number> &from, std::size_t column, std::size_t skipped) {
    const Tag<Number> tag;
    const Three<Number> to(from, column);
    const auto x_x = hn::Set(tag, now.x[first]), x_y = hn::Set(tag, now.y[first]),
               x_z = hn::Set(tag, now.z[first]);
    const auto y_x = hn::Set(tag, now.x[first + 1]), y_y = hn::Set(tag, now.y[first + 1]),
               y_z = hn::Set(tag, now.z[first + 1]);
    const auto z_x = hn::Set(tag, now.x[first + 2]), z_y = hn::Set(tag, now.y[first + 2]),
               z_z = hn::Set(tag, now.z[first + 2]);
    for (std::size_t row = whole<Number>(first - skipped); row < from.size; row += hn::Lanes(tag)) {
        const auto a = hn::LoadU(tag, then.x + skipped + row);
        const auto b = hn::LoadU(tag, then.y + skipped + row);
        const auto c = hn::LoadU(tag, then.z + skipped + row);
        const auto less = [&](const Number *at, auto by_a, auto by_b, auto by_c) {
            return hn::Sub(
                hn::Sub(hn::Sub(hn::LoadU(tag, at + row), hn::Mul(a, by_a)), hn::Mul(b, by_b)),
                hn::Mul(c, by_c));
        };
        hn::StoreU(less(to.x, x_x, x_y, x_z), tag, to.x + row);
        hn::StoreU(less(to.y, y_x, y_y, y_z), tag, to.y + row);
        hn::StoreU(less(to.z, z_x, z_y, z_z), tag, to.z + row);
    }
}

template <typename Number>
HWY_INLINE void eliminate_impl(const FrontMatrix<Number> &front, std::size_t block,
                               const Number *inverse, Number *pivots) {
    const Tag<Number> tag;
    const std::size_t next = 3 * block + 3;
    const Three<Number> now(front.panel, 3 * block);
    const Three<Number> then(
        FrontColumns<Number>{pivots, front.panel.size, front.panel.stride + front_lanes}, 0);
    for (Number *const column : {now.x, now.y, now.z})
        for (std::size_t row = next / front_lanes * front_lanes; row < next; ++row)
            column[row] = Number(0);
    for (std::size_t row = whole<Number>(next); row < front.panel.size; row += hn::Lanes(tag)) {
        const auto a = hn::LoadU(tag, now.x + row);
        const auto b = hn::LoadU(tag, now.y + row);
        const auto c = hn::LoadU(tag, now.z + row);
        hn::StoreU(a, tag, then.x + row);
        hn::StoreU(b, tag, then.y + row);
        hn::StoreU(c, tag, then.z + row);
        const auto product = [&](const Number *column) { // it is symmetric
            return hn::Add(
                hn::Add(hn::Mul(a, hn::Set(tag, column[0])), hn::Mul(b, hn::Set(tag, column[1]))),
                hn::Mul(c, hn::Set(tag, column[2])));
        };
        hn::StoreU(product(inverse), tag, now.x + row);
        hn::StoreU(product(inverse + 3), tag, now.y + row);
        hn::StoreU(product(inverse + 6), tag, now.z + row);
    }
    for (std::size_t column = next; column < front.own; column += 3)
        take(then, now, column, front.panel, column, 0);
    for (std::size_t column = 0; column < front.rest.size; column += 3)
        take(then, now, front.own + column, front.rest, column, front.own);
}

template <typename Number>
HWY_INLINE void add_numbers(const Number *from, std::size_t count, Number *to) {
    const Tag<Number> tag;
    const std::size_t lanes = hn::Lanes(tag);
    std::size_t i = 0;
    for (; i + lanes <= count; i += lanes)
        hn::StoreU(hn::Add(hn::LoadU(tag, to + i), hn::LoadU(tag, from + i)), tag, to + i);
    for (; i < count; ++i)
        to[i] += from[i];
}

template <typename Number>
HWY_INLINE void add_impl(const FrontColumns<Number> &rest, std::span<const FrontRun> runs,
                         const FrontMatrix<Number> &parent) {
    for (std::size_t k = 0; k < runs.size(); ++k) {
        const std::size_t count = std::size_t{3} * runs[k].count;
        for (std::size_t j = 0; j < count; ++j) {
            const std::size_t from = std::size_t{3} * runs[k].from + j;
            const std::size_t to = std::size_t{3} * runs[k].to + j;
            const std::size_t skipped = to < parent.own ? 0 : parent.own;
            Number *const column =
                to < parent.own ? parent.panel.at(0, to) : parent.rest.at(0, to - parent.own);
            add_numbers(rest.at(from, from), count - j, column + (to - skipped));
            for (const FrontRun &run : runs.subspan(k + 1))
                add_numbers(rest.at(std::size_t{3} * run.from, from), std::size_t{3} * run.count,
                            column + (std::size_t{3} * run.to - skipped));
        }
    }
}

template <typename Number>
HWY_INLINE void substitute_impl(const FrontColumns<Number> &panel, std::size_t own, Number *sides) {
    const Tag<Number> tag;
    for (std::size_t column = 0; column < own; column += 3) {
        const Three<Number> l(panel, column);
        const auto x = hn::Set(tag, sides[column]), y = hn::Set(tag, sides[column + 1]),
                   z = hn::Set(tag, sides[column + 2]);
        for (std::size_t row = whole<Number>(column + 3); row < panel.size; row += hn::Lanes(tag)) {
            const auto side = hn::LoadU(tag, sides + row);
            hn::StoreU(hn::Sub(hn::Sub(hn::Sub(side, hn::Mul(hn::LoadU(tag, l.x + row), x)),
                                       hn::Mul(hn::LoadU(tag, l.y + row), y)),
                               hn::Mul(hn::LoadU(tag, l.z + row), z)),
                       tag, sides + row);
        }
    }
}

// Sums of eight, whatever the width.
template <typename Number> struct EightSums {
    static constexpr std::size_t lanes = hn::MaxLanes(Tag<Number>());
    static constexpr std::size_t parts = front_lanes / lanes;
    hn::Vec<Tag<Number>> sums[parts]; // NOLINT(modernize-avoid-c-arrays)
    HWY_INLINE EightSums() {
        for (auto &sum : sums)
            sum = hn::Zero(Tag<Number>());
    }
    HWY_INLINE Number total() const {
        HWY_ALIGN Number all[front_lanes]; // NOLINT(modernize-avoid-c-arrays)
        for (std::size_t k = 0; k < parts; ++k)
            hn::StoreU(sums[k], Tag<Number>(), all + k * lanes);
        Number total = Number(0);
        for (const Number one : all)
            total += one;
        return total;
    }
};

template <typename Number>
HWY_INLINE void substitute_back_impl(const FrontColumns<Number> &panel, std::size_t own,
                                     Number *sides) {
    const Tag<Number> tag;
    using Sums = EightSums<Number>;
    for (std::size_t next = own; next > 0; next -= 3) {
        const Three<Number> l(panel, next - 3);
        Sums x, y, z;
        for (std::size_t row = next / front_lanes * front_lanes; row < panel.size;
             row += front_lanes)
            for (std::size_t k = 0; k < Sums::parts; ++k) {
                const std::size_t at = row + k * Sums::lanes;
                const auto side = hn::LoadU(tag, sides + at);
                x.sums[k] = hn::Add(x.sums[k], hn::Mul(hn::LoadU(tag, l.x + at), side));
                y.sums[k] = hn::Add(y.sums[k], hn::Mul(hn::LoadU(tag, l.y + at), side));
                z.sums[k] = hn::Add(z.sums[k], hn::Mul(hn::LoadU(tag, l.z + at), side));
            }
        sides[next - 3] -= x.total();
        sides[next - 2] -= y.total();
        sides[next - 1] -= z.total();
    }
}

} // namespace

void eliminate_floats(const FrontMatrix<float> &front, std::size_t block, const float *inverse,
                      float *pivots) {
    eliminate_impl(front, block, inverse, pivots);
}
void eliminate_doubles(const FrontMatrix<double> &front, std::size_t block, const double *inverse,
                       double *pivots) {
    eliminate_impl(front, block, inverse, pivots);
}
void add_floats(const FrontColumns<float> &rest, std::span<const FrontRun> runs,
                const FrontMatrix<float> &parent) {
    add_impl(rest, runs, parent);
}
void add_doubles(const FrontColumns<double> &rest, std::span<const FrontRun> runs,
                 const FrontMatrix<double> &parent) {
    add_impl(rest, runs, parent);
}
void substitute_floats(const FrontColumns<float> &panel, std::size_t own, float *sides) {
    substitute_impl(panel, own, sides);
}
void substitute_doubles(const FrontColumns<double> &panel, std::size_t own, double *sides) {
    substitute_impl(panel, own, sides);
}
void substitute_back_floats(const FrontColumns<float> &panel, std::size_t own, float *sides) {
    substitute_back_impl(panel, own, sides);
}
void substitute_back_doubles(const FrontColumns<double> &panel, std::size_t own, double *sides) {
    substitute_back_impl(panel, own, sides);
}

} // namespace kernels::HWY_NAMESPACE
} // namespace plumb::inline PLUMB_PRECISION
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plumb::inline PLUMB_PRECISION {
namespace kernels {

HWY_EXPORT(eliminate_floats);
HWY_EXPORT(eliminate_doubles);
HWY_EXPORT(add_floats);
HWY_EXPORT(add_doubles);
HWY_EXPORT(substitute_floats);
HWY_EXPORT(substitute_doubles);
HWY_EXPORT(substitute_back_floats);
HWY_EXPORT(substitute_back_doubles);

void eliminate(const FrontMatrix<float> &front, std::size_t block, const float *inverse,
               float *pivots) {
    HWY_DYNAMIC_DISPATCH(eliminate_floats)(front, block, inverse, pivots);
}
void eliminate(const FrontMatrix<double> &front, std::size_t block, const double *inverse,
               double *pivots) {
    HWY_DYNAMIC_DISPATCH(eliminate_doubles)(front, block, inverse, pivots);
}
void add(const FrontColumns<float> &rest, std::span<const FrontRun> runs,
         const FrontMatrix<float> &parent) {
    HWY_DYNAMIC_DISPATCH(add_floats)(rest, runs, parent);
}
void add(const FrontColumns<double> &rest, std::span<const FrontRun> runs,
         const FrontMatrix<double> &parent) {
    HWY_DYNAMIC_DISPATCH(add_doubles)(rest, runs, parent);
}
void substitute(const FrontColumns<float> &panel, std::size_t own, float *sides) {
    HWY_DYNAMIC_DISPATCH(substitute_floats)(panel, own, sides);
}
void substitute(const FrontColumns<double> &panel, std::size_t own, double *sides) {
    HWY_DYNAMIC_DISPATCH(substitute_doubles)(panel, own, sides);
}
void substitute_back(const FrontColumns<float> &panel, std::size_t own, float *sides) {
    HWY_DYNAMIC_DISPATCH(substitute_back_floats)(panel, own, sides);
}
void substitute_back(const FrontColumns<double> &panel, std::size_t own, double *sides) {
    HWY_DYNAMIC_DISPATCH(substitute_back_doubles)(panel, own, sides);
}

} // namespace kernels
} // namespace plumb::inline PLUMB_PRECISION
#endif
