// The six degrees of freedom of one body in an energy that is minimised body by body (Chen, Liu,
// Yang, Yuksel 2024, "Vertex Block Descent").
#pragma once

#include "engine/math/types.h"

#include <array>

namespace plumb::inline PLUMB_PRECISION {

// A quadratic model of the energy about a body's pose: its second derivative and the forces, first
// along the world's axes, then about them.
class RigidBlock {
  public:
    // Inertia over the square of the substep (kg/s^2, N m), and the force and torque that it makes
    // where the body is.
    RigidBlock(const Vec3 &mass, const Mat3 &inertia, const Vec3 &force, const Vec3 &torque);

    // A row whose place changes by dot(linear, way) + dot(angular, turn): it pushes with `force`
    // along itself, less by `stiffness` for each unit of way.
    void add_row(const Vec3 &linear, const Vec3 &angular, Real stiffness, Real force);
    // Only the stiffness, against turns about the world's axes.
    void add_turn_stiffness(const Vec3 &stiffness);
    // Nothing moves along (0 to 2) or about (3 to 5) that axis of the world.
    void lock(std::size_t axis);

    struct Step {
        Vec3 way{Real(0)};  // m
        Vec3 turn{Real(0)}; // rad, world
    };
    // To where the model is least. No step when the second derivative is not positive definite, as
    // without inertia.
    Step solve() const;

  private:
    // The lower triangle.
    std::array<std::array<Real, 6>, 6> stiffness_{};
    std::array<Real, 6> force_{};
};

// The sum of |f| times the lengths of the columns of a point's second derivative by a turn, for a
// force f at the end of an arm: what stands for it on the diagonal (Giles, Diaz, Yuksel 2025,
// "Augmented Vertex Block Descent", sec. 3.5), N m.
Vec3 turn_stiffness(const Vec3 &force, const Vec3 &arm);

} // namespace plumb::inline PLUMB_PRECISION
