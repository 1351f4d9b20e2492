// Repeats one body: the placement of its copies.
#pragma once

#include "engine/core/random.h"

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace plumb {

// All layouts use world axes, relative to the body's own position; lengths in metres. Counts are at
// least 1.

// count.x * count.y * count.z copies, centred on the position in x and z, growing up from it in y.
struct GridRepeat {
    glm::ivec3 count{1};
    glm::dvec3 spacing{1};
};

// A stack from the position up, each copy turned by `turn` (rad) about +y relative to the one
// below.
struct StackRepeat {
    int count = 1;
    double spacing = 1;
    double turn = 0;
};

// The position plus i * step.
struct LineRepeat {
    int count = 1;
    glm::dvec3 step{1, 0, 0};
};

// Rows of base, base - 1, ..., 1 copies, the lowest centred on the position: a wall along x.
// Square: layers of base^2, (base - 1)^2, ..., 1 copies, as far apart in z as in x.
struct PyramidRepeat {
    int base = 1;
    glm::dvec2 spacing{1}; // sideways, up
    bool square = false;
};

// A circle about the vertical through the position, the first copy towards +z, then towards +x.
// Facing: each is turned about +y by its angle on the circle, so that all face outwards with the
// same side.
struct RingRepeat {
    int count = 1;
    double radius = 1;
    bool facing = false;
};

// Uniform in a box about the position, no two centres closer than min_distance.
struct ScatterRepeat {
    int count = 1;
    glm::dvec3 half_extents{1};
    double min_distance = 0;
    bool random_rotation = false; // uniform over all rotations
};

using Repeat =
    std::variant<GridRepeat, StackRepeat, LineRepeat, PyramidRepeat, RingRepeat, ScatterRepeat>;

// How many copies; exact for any counts in int's range, saturating at 2^63.
std::size_t repeat_count(const Repeat &repeat);

// Where one copy stands. Its rotation, velocity and angular velocity are the body's, turned.
struct Placement {
    glm::dvec3 position{0};
    glm::dquat turn{1, 0, 0, 0};
};

// The copies in numbering order: bottom to top, then by z, then by x; along; around. A scatter
// draws from `random`; it gives up and returns fewer when a copy finds no free place in
// `scatter_attempts` draws. Every other kind returns repeat_count() copies.
inline constexpr int scatter_attempts = 1000;
std::vector<Placement> placements(const Repeat &repeat, const glm::dvec3 &position, Random &random);

} // namespace plumb
