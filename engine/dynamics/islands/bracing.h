// Braced islands: joints and contacts hold their dynamic bodies together in a loop, such as a box
// between two jaws, so that they may be under load without any from outside (self-stress). If
// contacts and joints acted on their two bodies at places that move apart as the island turns, or
// as its joints drift, those loads would be couples: a ball between jaws would spin ever faster, a
// box would stop turning. In a braced island both ends are where the other is.
#pragma once

#include "engine/math/types.h"

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

// How far apart ends may be to meet, as a share of their arms, squared; less the further they are:
// long arms would throw the bodies about.
inline constexpr Real contacts_meet_within = Real(0.25);
inline constexpr Real joints_meet_within = Real(0.0025); // beyond that it may be torn

// What must be added to arm a and taken from arm b (m) for both to end midway between their ends,
// which are `apart` (m).
inline Vec3 half_way(const Vec3 &apart, const Vec3 &arm_a, const Vec3 &arm_b, Real within) {
    const Real squared = glm::dot(apart, apart);
    const Real most = within * (glm::dot(arm_a, arm_a) + glm::dot(arm_b, arm_b));
    return (squared > most ? Real(0.5) * most / squared : Real(0.5)) * apart;
}

} // namespace plumb::inline PLUMB_PRECISION
