#include "engine/dynamics/methods/parts/rigid_block.h"

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

RigidBlock::RigidBlock(const Vec3 &mass, const Mat3 &inertia, const Vec3 &force,
                       const Vec3 &torque) {
    for (std::size_t i = 0; i < 3; ++i) {
        const int axis = static_cast<int>(i);
        stiffness_[i][i] = mass[axis];
        for (std::size_t j = 0; j <= i; ++j)
            stiffness_[i + 3][j + 3] = inertia[static_cast<int>(j)][axis];
        force_[i] = force[axis];
        force_[i + 3] = torque[axis];
    }
}

void RigidBlock::add_row(const Vec3 &linear, const Vec3 &angular, Real stiffness, Real force) {
    const std::array<Real, 6> row{linear.x, linear.y, linear.z, angular.x, angular.y, angular.z};
    for (std::size_t i = 0; i < 6; ++i) {
        force_[i] += force * row[i];
        const Real scaled = stiffness * row[i];
        for (std::size_t j = 0; j <= i; ++j)
            stiffness_[i][j] += scaled * row[j];
    }
}

void RigidBlock::add_turn_stiffness(const Vec3 &stiffness) {
    for (std::size_t i = 0; i < 3; ++i)
        stiffness_[i + 3][i + 3] += stiffness[static_cast<int>(i)];
}

void RigidBlock::lock(std::size_t axis) {
    for (std::size_t i = 0; i < 6; ++i)
        (i < axis ? stiffness_[axis][i] : stiffness_[i][axis]) = Real(0);
    stiffness_[axis][axis] = Real(1);
    force_[axis] = Real(0);
}

// L D L^T (Golub and Van Loan 2013, "Matrix Computations", alg. 4.1.1).
RigidBlock::Step RigidBlock::solve() const {
    std::array<std::array<Real, 6>, 6> lower = stiffness_;
    std::array<Real, 6> x = force_;
    for (std::size_t j = 0; j < 6; ++j) {
        for (std::size_t k = 0; k < j; ++k)
            lower[j][j] -= lower[j][k] * lower[j][k] * lower[k][k];
        if (!(lower[j][j] > Real(0)))
            return {};
        for (std::size_t i = j + 1; i < 6; ++i) {
            for (std::size_t k = 0; k < j; ++k)
                lower[i][j] -= lower[i][k] * lower[j][k] * lower[k][k];
            lower[i][j] /= lower[j][j];
        }
    }
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t k = 0; k < i; ++k)
            x[i] -= lower[i][k] * x[k];
    for (std::size_t i = 6; i-- > 0;) {
        x[i] /= lower[i][i];
        for (std::size_t k = i + 1; k < 6; ++k)
            x[i] -= lower[k][i] * x[k];
    }
    return {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
}

// The second derivative of the point R r along e by a turn is (e r^T + r e^T) / 2 - (e r) 1.
Vec3 turn_stiffness(const Vec3 &force, const Vec3 &arm) {
    const Real along = glm::dot(force, arm);
    Vec3 lengths{Real(0)};
    for (int j = 0; j < 3; ++j) {
        Vec3 column = Real(0.5) * (arm[j] * force + force[j] * arm);
        column[j] -= along;
        lengths[j] = glm::length(column);
    }
    return lengths;
}

} // namespace plumb::inline PLUMB_PRECISION
