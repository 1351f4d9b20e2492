// Points that attract everything that forces move, by Newton's law of gravitation, on top of the
// uniform gravity.
#pragma once

#include "engine/math/types.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace plumb::inline PLUMB_PRECISION {

struct StepContext;

struct Attractor {
    Vec3 position{Real(0)};                 // world
    Real gravitational_parameter = Real(1); // G M (m^3/s^2)
};

// The acceleration at x: the sum of -mu r / |r|^3 (Landau, Lifshitz 1976, "Mechanics", sec. 15). An
// attractor exactly at x adds nothing.
inline Vec3 attraction(std::span<const Attractor> attractors, const Vec3 &x) {
    Vec3 sum{Real(0)};
    for (const Attractor &attractor : attractors) {
        const Vec3 r = x - attractor.position;
        const Real squared = glm::dot(r, r);
        if (squared > Real(0))
            sum -= (attractor.gravitational_parameter / (squared * std::sqrt(squared))) * r;
    }
    return sum;
}

// The potential at x: the sum of -mu / |r| (J/kg), 0 far away. An attractor exactly at x adds
// nothing.
inline double attraction_potential(std::span<const Attractor> attractors, const glm::dvec3 &x) {
    double sum = 0;
    for (const Attractor &attractor : attractors) {
        const double distance = glm::length(x - glm::dvec3{attractor.position});
        if (distance > 0)
            sum -= static_cast<double>(attractor.gravitational_parameter) / distance;
    }
    return sum;
}

// The gradient of the acceleration at x: for each attractor -mu / |r|^3 across the line to it and
// twice that with the opposite sign along the line, where it is capped at `most` (1/s^2).
inline glm::dmat3 attraction_gradient(std::span<const Attractor> attractors, const glm::dvec3 &x,
                                      double most) {
    glm::dmat3 sum{0};
    for (const Attractor &attractor : attractors) {
        const glm::dvec3 r = x - glm::dvec3{attractor.position};
        const double distance = glm::length(r);
        if (!(distance > 0))
            continue;
        const glm::dvec3 n = r / distance;
        const double rate = static_cast<double>(attractor.gravitational_parameter) /
                            (distance * distance * distance);
        const glm::dmat3 along = glm::outerProduct(n, n);
        sum += std::min(2 * rate, most) * along - rate * (glm::dmat3{1} - along);
    }
    return sum;
}

// v += h a, for the moving bodies and for the particles, at their present positions. Without
// attractors these do nothing and count no pass.
void attract_bodies(StepContext &context, Real h);
void attract_particles(StepContext &context, Real h);

} // namespace plumb::inline PLUMB_PRECISION
