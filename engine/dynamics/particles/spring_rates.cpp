// How fast springs make their loads swing, and how fast they damp them.
#include "engine/dynamics/method.h"
#include "engine/dynamics/particles/spring_constraint.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

void find_spring_rates(const Model &model, std::span<const SolverBody> bodies,
                       std::span<const ParticleMotion> particles,
                       std::span<const std::uint8_t> torn, std::vector<Mat3> &stiffness,
                       std::vector<Vec2> &rates) {
    stiffness.assign(particles.size(), Mat3{Real(0)});
    rates.assign(bodies.size() + particles.size(), Vec2{Real(0)});
    for (std::size_t i = 0; i < model.springs.size(); ++i) {
        if (torn[i] != 0)
            continue;
        const Spring &spring = model.springs[i];
        const SpringPoint a = spring_point(spring.a, bodies, particles);
        const SpringPoint b = spring_point(spring.b, bodies, particles);
        const Vec3 line = b.position - a.position;
        const Real length = glm::length(line);
        // The spring's stiffness along its line, the geometric stiffness of its tension across it.
        const Real across =
            length > spring.rest_length ? Real(1) - spring.rest_length / length : Real(0);
        const Vec3 axis = length > Real(0) ? line / length : Vec3{Real(0)};
        for (const auto &[end, arm] : {std::pair{&spring.a, a.arm}, std::pair{&spring.b, b.arm}}) {
            if (end->kind == SpringEnd::Kind::particle) {
                const Real along = length > Real(0) ? Real(1) - across : Real(0);
                stiffness[end->index] += spring.stiffness * (across * Mat3{Real(1)} +
                                                             along * glm::outerProduct(axis, axis));
                rates[bodies.size() + end->index].y +=
                    spring.damping * model.particles[end->index].inv_mass;
            } else if (end->kind == SpringEnd::Kind::body) {
                const SolverBody &body = bodies[end->index];
                const Mat3 &inverse = body.inv_inertia;
                const Vec3 turn = glm::cross(arm, axis);
                const Real along = body.inv_mass_along(axis) + glm::dot(inverse * turn, turn);
                const Real least = inverse[0][0] + inverse[1][1] + inverse[2][2];
                const Real any = body.inv_mass.x + glm::dot(arm, arm) * least;
                rates[end->index] +=
                    Vec2{spring.stiffness * (along + across * any), spring.damping * along};
            }
        }
    }
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const Mat3 &k = stiffness[p];
        Real most = Real(0);
        for (int row = 0; row < 3; ++row)
            most = std::max(most, std::abs(k[row].x) + std::abs(k[row].y) + std::abs(k[row].z));
        rates[bodies.size() + p].x = most * model.particles[p].inv_mass;
    }
}

} // namespace plumb::inline PLUMB_PRECISION
