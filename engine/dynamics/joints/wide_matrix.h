// A 3 x 3 matrix whose columns are padded to four numbers, which are computed at once.
#pragma once

#include "engine/math/types.h"

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

// Each number comes of the same operations in the same order as in Mat3, so the bits are the same.
class WideMat3 {
  public:
    WideMat3() = default; // 0
    explicit WideMat3(const Mat3 &m) {
        for (int i = 0; i < 3; ++i)
            columns_[i] = Column{m[i].x, m[i].y, m[i].z, Real(0)};
    }

    Mat3 narrow() const { return {narrow(0), narrow(1), narrow(2)}; }

    // Adds a b.
    void add_product(const WideMat3 &a, const Mat3 &b) {
        for (int i = 0; i < 3; ++i)
            columns_[i] +=
                a.columns_[0] * b[i][0] + a.columns_[1] * b[i][1] + a.columns_[2] * b[i][2];
    }
    friend Vec3 operator*(const WideMat3 &m, const Vec3 &v) {
        const Column sum = m.columns_[0] * v.x + m.columns_[1] * v.y + m.columns_[2] * v.z;
        return {sum[0], sum[1], sum[2]};
    }
    // The transpose of m times v.
    friend Vec3 operator*(const Vec3 &v, const WideMat3 &m) {
        return {glm::dot(m.narrow(0), v), glm::dot(m.narrow(1), v), glm::dot(m.narrow(2), v)};
    }

  private:
    // Four numbers in GCC and Clang, in as many registers as the machine needs.
    using Column [[gnu::vector_size(4 * sizeof(Real))]] = Real;

    Vec3 narrow(int i) const { return {columns_[i][0], columns_[i][1], columns_[i][2]}; }

    Column columns_[3] = {};
};

} // namespace plumb::inline PLUMB_PRECISION
