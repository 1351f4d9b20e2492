// The six degrees of freedom of one body in an energy minimised body by body (Chen, Liu, Yang,
// Yuksel 2024, "Vertex Block Descent").
#pragma once

#include "engine/math/types.h"

#include <array>

namespace plumb::inline PLUMB_PRECISION {

// A quadratic model of the energy about a body's pose: its second derivative and the forces, first
// along the world axes, then about them.
class RigidBlock {
  public:
    // Mass and inertia over h^2 (kg/s^2, N m), and the inertial force and torque at the body's
    // current pose.
    RigidBlock(const Vec3 &mass, const Mat3 &inertia, const Vec3 &force, const Vec3 &torque);

    // A row whose position changes by dot(linear, way) + dot(angular, turn): it pushes along itself
    // with `force`, less `stiffness` per unit of that change.
    void add_row(const Vec3 &linear, const Vec3 &angular, Real stiffness, Real force);
    // Stiffness alone, against turns about the world axes.
    void add_turn_stiffness(const Vec3 &stiffness);
    // Blocks motion along (0 to 2) or about (3 to 5) that world axis.
    void lock(std::size_t axis);

    struct Step {
        Vec3 way{Real(0)};  // m
        Vec3 turn{Real(0)}; // rad, world
    };
    // The step to the model's minimum. No step if the second derivative is not positive definite,
    // e.g. without inertia.
    Step solve() const;

  private:
    // The lower triangle.
    std::array<std::array<Real, 6>, 6> stiffness_{};
    std::array<Real, 6> force_{};
};

// For a force at the end of an arm, the column lengths of the matrix of force times the point's
// second derivative by a turn. They stand in for that matrix as a diagonal (Giles, Diaz, Yuksel
// 2025, "Augmented Vertex Block Descent", sec. 3.5), N m.
Vec3 turn_stiffness(const Vec3 &force, const Vec3 &arm);

} // namespace plumb::inline PLUMB_PRECISION
