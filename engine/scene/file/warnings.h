// Warnings about things that are valid in a scene but probably unintended.
#pragma once

#include "engine/scene/scene_file.h"

#include <cstddef>
#include <vector>

namespace plumb {

struct FilePosition {
    std::size_t line = 0;
    std::size_t column = 0;
};

// Positions in the file, in scene order.
struct ScenePositions {
    FilePosition dt;
    std::vector<FilePosition> bodies;
    std::vector<FilePosition> joints;
    std::vector<FilePosition> particles;
    std::vector<FilePosition> springs;
    std::vector<FilePosition> cloths;
};

// For a scene without errors:
// - two bodies, at least one dynamic, overlap at the start by more than 1 % of the smaller width
//   (unless a joint keeps them from colliding);
// - two dynamic bodies that touch or are joined differ more than a hundredfold in mass;
// - a ball joint's anchors are apart by more than 10 % of the smaller body's width;
// - a joint or spring does nothing because neither end is dynamic;
// - a spring is too stiff for an explicit method's step;
// - a body is so far from the origin that float cannot resolve its motion;
// - dt is too long: see the messages for the formulas.
// At most ten of a kind are listed; the last says how many more there are.
std::vector<SceneMessage> scene_warnings(const SceneDesc &scene, const ScenePositions &positions);

} // namespace plumb
