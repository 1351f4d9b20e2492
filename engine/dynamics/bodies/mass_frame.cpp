#include "engine/dynamics/bodies/mass_frame.h"

#include "engine/core/check.h"
#include "engine/dynamics/bodies/solid.h"
#include "engine/geometry/mass.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

struct Sum {
    double mass = 0;
    glm::dvec3 center{0}; // times the mass, until it is divided
    glm::dmat3 inertia{0.0};
};

// The moment of a mass at `r` from the point that it turns about.
glm::dmat3 point_inertia(double mass, const glm::dvec3 &r) {
    return mass * (glm::dmat3(glm::dot(r, r)) - glm::outerProduct(r, r));
}

double density_of(const ColliderDef &collider) {
    return collider.density > Real(0) ? static_cast<double>(collider.density) : 1000.0;
}

Sum sum_of(const std::vector<ColliderDef> &colliders) {
    Sum sum;
    std::vector<MassProperties> parts;
    for (const ColliderDef &collider : colliders) {
        PLUMB_CHECK(!collider.surface, "a mesh or height field cannot be dynamic");
        parts.push_back(collider.sensor ? MassProperties{} : mass_properties(collider.shape));
        const double mass = density_of(collider) * static_cast<double>(parts.back().volume);
        sum.mass += mass;
        sum.center += mass * glm::dvec3(parts.back().center);
    }
    if (!(sum.mass > 0))
        return sum;
    sum.center /= sum.mass;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const double density = density_of(colliders[i]);
        sum.inertia += density * glm::dmat3(parts[i].inertia) +
                       point_inertia(density * static_cast<double>(parts[i].volume),
                                     glm::dvec3(parts[i].center) - sum.center);
    }
    return sum;
}

bool is_diagonal(const glm::dmat3 &m) {
    return m[1][0] == 0 && m[2][0] == 0 && m[2][1] == 0;
}

// The shape's own axes are principal: nothing to sum, and the closed form's digits.
bool is_plain(const BodyDef &def) {
    if (def.colliders.size() != 1 || def.center_of_mass || def.inertia ||
        def.colliders.front().sensor)
        return false;
    return has_principal_frame(def.colliders.front().shape);
}

} // namespace

MassFrame mass_frame(const BodyDef &def) {
    if (def.mass)
        PLUMB_CHECK(std::isfinite(*def.mass) && *def.mass > Real(0),
                    "mass must be positive, got " << *def.mass);
    for (const ColliderDef &collider : def.colliders) {
        PLUMB_CHECK(!collider.surface, "a mesh or height field cannot be dynamic");
        PLUMB_CHECK(!std::holds_alternative<HalfSpace>(collider.shape),
                    "a half-space cannot be dynamic");
    }
    MassFrame result;
    if (is_plain(def)) {
        const ColliderDef &only = def.colliders.front();
        result.mass =
            def.mass ? *def.mass : static_cast<Real>(density_of(only)) * volume(only.shape);
        result.inertia = principal_inertia(only.shape, result.mass);
    } else {
        Sum sum = sum_of(def.colliders);
        const double mass = def.mass ? static_cast<double>(*def.mass) : sum.mass;
        PLUMB_CHECK(mass > 0 && std::isfinite(mass),
                    "a dynamic body needs a mass, got " << mass << " kg from its colliders");
        if (sum.mass > 0)
            sum.inertia *= mass / sum.mass;
        if (def.center_of_mass) {
            const glm::dvec3 moved = glm::dvec3(*def.center_of_mass) - sum.center;
            sum.inertia += point_inertia(mass, moved);
            sum.center = glm::dvec3(*def.center_of_mass);
        }
        if (def.inertia) {
            sum.inertia = glm::dmat3(0.0);
            for (int i = 0; i < 3; ++i)
                sum.inertia[i][i] = static_cast<double>((*def.inertia)[i]);
        }
        result.mass = static_cast<Real>(mass);
        result.frame.position = Vec3(sum.center);
        if (is_diagonal(sum.inertia)) {
            result.inertia =
                Vec3(static_cast<Real>(sum.inertia[0][0]), static_cast<Real>(sum.inertia[1][1]),
                     static_cast<Real>(sum.inertia[2][2]));
        } else {
            const PrincipalFrame principal = principal_frame(Mat3(sum.inertia));
            result.inertia = principal.moments;
            result.frame.rotation = principal.rotation;
        }
    }
    PLUMB_CHECK(std::isfinite(result.mass) && result.mass > Real(0),
                "mass must be positive, got " << result.mass);
    PLUMB_CHECK(is_finite(Real(1) / result.inertia) && is_finite(result.inertia) &&
                    result.inertia.x > Real(0) && result.inertia.y > Real(0) &&
                    result.inertia.z > Real(0),
                "a dynamic body needs positive, finite moments of inertia, got "
                    << result.inertia.x << ", " << result.inertia.y << ", " << result.inertia.z);
    return result;
}

} // namespace plumb::inline PLUMB_PRECISION
