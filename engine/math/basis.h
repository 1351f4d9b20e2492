// An orthonormal basis around a direction.
#pragma once

#include "engine/math/types.h"

#include <glm/geometric.hpp>
#include <limits>

namespace plumb::inline PLUMB_PRECISION {

struct TangentBasis {
    Vec3 t1{Real(0)};
    Vec3 t2{Real(0)};
};

// Two unit vectors perpendicular to the unit vector n and to each other, with t1 x t2 = n.
//
// The Householder reflection that maps a fixed direction p to -n maps its companions u and v to the
// basis (Hughes, Moeller 1999, "Building an Orthonormal Basis from a Unit Vector", with the single
// pole moved from an axis to -p, a direction no contact on a floor or wall has). Continuous
// everywhere else, so friction impulses stored in this basis stay valid when a normal jitters. At n
// == -p, or within rounding of it: v and u.
inline TangentBasis tangent_basis(const Vec3 &n) {
    const Vec3 p{Real(0.48), Real(0.6), Real(0.64)};
    const Vec3 u{Real(-0.8), Real(0), Real(0.6)};
    const Vec3 v{Real(0.36), Real(-0.8), Real(0.48)};
    // In terms of w alone (n . u = w . u) the result is a reflection however w is rounded; with 1 +
    // n . p it would lose orthogonality by epsilon / |w|^2 near the pole.
    const Vec3 w = n + p;
    const Real squared = glm::dot(w, w);
    if (squared <= std::numeric_limits<Real>::epsilon())
        return {v, u};
    const Vec3 scaled = (Real(2) / squared) * w;
    return {u - glm::dot(w, u) * scaled, v - glm::dot(w, v) * scaled};
}

} // namespace plumb::inline PLUMB_PRECISION
