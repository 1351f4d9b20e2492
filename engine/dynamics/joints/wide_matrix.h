// 3-vectors and 3 x 3 matrices whose columns are padded to four numbers, which are computed at
// once. Each number comes of the same operations in the same order as in GLM, so the bits are the
// same.
#pragma once

#include "engine/math/types.h"

#include <cstring>

namespace plumb::inline PLUMB_PRECISION {

template <typename Number> class WideVector {
  public:
    // Four numbers in GCC and Clang, in as many registers as the machine needs.
    using Lanes [[gnu::vector_size(4 * sizeof(Number))]] = Number;
    using Narrow = glm::vec<3, Number, glm::defaultp>;

    WideVector() = default; // 0
    explicit WideVector(const Lanes &lanes) : lanes_(lanes) {}
    explicit WideVector(const Narrow &v) : lanes_{v.x, v.y, v.z, Number(0)} {}
    template <typename Other>
    explicit WideVector(const WideVector<Other> &v) : WideVector(Narrow(v.narrow())) {}
    // Of a vector that is followed by another number of the same object: a single load.
    static WideVector followed(const Narrow &v) {
        Lanes lanes;
        std::memcpy(&lanes, &v, sizeof(lanes));
        return WideVector(lanes);
    }

    Narrow narrow() const { return {lanes_[0], lanes_[1], lanes_[2]}; }
    const Lanes &lanes() const { return lanes_; }
    Number operator[](int i) const { return lanes_[i]; }

    WideVector operator-() const { return WideVector(-lanes_); }
    WideVector &operator+=(const WideVector &b) {
        lanes_ += b.lanes_;
        return *this;
    }
    WideVector &operator-=(const WideVector &b) {
        lanes_ -= b.lanes_;
        return *this;
    }
    friend WideVector operator+(const WideVector &a, const WideVector &b) {
        return WideVector(a.lanes_ + b.lanes_);
    }
    friend WideVector operator-(const WideVector &a, const WideVector &b) {
        return WideVector(a.lanes_ - b.lanes_);
    }
    friend WideVector operator*(const WideVector &a, const WideVector &b) {
        return WideVector(a.lanes_ * b.lanes_);
    }
    friend WideVector operator*(Number s, const WideVector &a) { return WideVector(s * a.lanes_); }
    friend Number dot(const WideVector &a, const WideVector &b) {
        const Lanes product = a.lanes_ * b.lanes_;
        return product[0] + product[1] + product[2];
    }
    friend WideVector cross(const WideVector &a, const WideVector &b) {
        return (a * b.rolled() - a.rolled() * b).rolled();
    }

  private:
    WideVector rolled() const { // y, z, x
        return WideVector(__builtin_shufflevector(lanes_, lanes_, 1, 2, 0, 3));
    }

    Lanes lanes_ = {};
};

template <typename Number> class WideMatrix {
  public:
    using Column = WideVector<Number>;
    using Narrow = glm::mat<3, 3, Number, glm::defaultp>;

    WideMatrix() = default; // 0
    WideMatrix(const Column &x, const Column &y, const Column &z) : columns_{x, y, z} {}
    explicit WideMatrix(const Narrow &m) : columns_{Column(m[0]), Column(m[1]), Column(m[2])} {}
    template <typename Other>
    explicit WideMatrix(const WideMatrix<Other> &m)
        : columns_{Column(m[0]), Column(m[1]), Column(m[2])} {}
    // As for vectors.
    static WideMatrix followed(const Narrow &m) {
        return {Column::followed(m[0]), Column::followed(m[1]), Column::followed(m[2])};
    }

    Narrow narrow() const {
        return {columns_[0].narrow(), columns_[1].narrow(), columns_[2].narrow()};
    }
    Column &operator[](int i) { return columns_[i]; }
    const Column &operator[](int i) const { return columns_[i]; }

    WideMatrix operator-() const { return {-columns_[0], -columns_[1], -columns_[2]}; }
    WideMatrix &operator+=(const WideMatrix &b) {
        for (int i = 0; i < 3; ++i)
            columns_[i] += b.columns_[i];
        return *this;
    }
    void add_diagonal(const typename Column::Narrow &d) {
        constexpr Number zero(0);
        columns_[0] += Column(typename Column::Narrow{d.x, zero, zero});
        columns_[1] += Column(typename Column::Narrow{zero, d.y, zero});
        columns_[2] += Column(typename Column::Narrow{zero, zero, d.z});
    }
    // Adds a b.
    void add_product(const WideMatrix &a, const WideMatrix &b) {
        for (int i = 0; i < 3; ++i)
            columns_[i] += a * b.columns_[i];
    }
    friend Column operator*(const WideMatrix &m, const Column &v) {
        return v[0] * m.columns_[0] + v[1] * m.columns_[1] + v[2] * m.columns_[2];
    }
    WideMatrix transposed() const {
        const auto &a = columns_[0].lanes();
        const auto &b = columns_[1].lanes();
        const auto &c = columns_[2].lanes();
        const typename Column::Lanes xy = __builtin_shufflevector(a, b, 0, 4, 1, 5);
        const typename Column::Lanes z = __builtin_shufflevector(a, b, 2, 6, 3, 7);
        return {Column(__builtin_shufflevector(xy, c, 0, 1, 4, 7)),
                Column(__builtin_shufflevector(xy, c, 2, 3, 5, 7)),
                Column(__builtin_shufflevector(z, c, 0, 1, 6, 7))};
    }
    // The transpose times v.
    Column transposed_times(const Column &v) const {
        const WideMatrix rows =
            WideMatrix{columns_[0] * v, columns_[1] * v, columns_[2] * v}.transposed();
        return rows.columns_[0] + rows.columns_[1] + rows.columns_[2];
    }

  private:
    Column columns_[3];
};

using WideVec3 = WideVector<Real>;
using WideMat3 = WideMatrix<Real>;

} // namespace plumb::inline PLUMB_PRECISION
