// Joints as they persist in the world.
#pragma once

#include "engine/dynamics/body.h"

namespace plumb::inline PLUMB_PRECISION {

struct JointId {
    std::uint32_t index = UINT32_MAX;
    std::uint32_t generation = 0;
    friend auto operator<=>(const JointId &, const JointId &) = default;
};

struct JointDef {
    JointType type = JointType::ball;
    BodyId a; // a default BodyId is the world itself; its anchor is in world coordinates
    BodyId b;
    Vec3 anchor_a_local{Real(0)};
    Vec3 anchor_b_local{Real(0)};
    Real length = Real(0); // m, > 0; distance joints only
    bool collide_connected = false;
    Vec3 impulse{Real(0)}; // what the last step's solver remembers (N s); x alone for distance
};

struct Joint {
    static constexpr std::uint32_t world = UINT32_MAX;
    JointType type = JointType::ball;
    std::uint32_t a = world; // index of the body
    std::uint32_t b = world;
    Vec3 anchor_a_local{Real(0)};
    Vec3 anchor_b_local{Real(0)};
    Real length = Real(0);
    bool collide_connected = false;
    Vec3 impulse{Real(0)};
    std::uint32_t generation = 0;
    bool alive = false;
};

} // namespace plumb::inline PLUMB_PRECISION
