// What is allowed in a scene, but hardly meant.
#pragma once

#include "engine/scene/scene_file.h"

#include <cstddef>
#include <vector>

namespace plumb {

struct FilePosition {
    std::size_t line = 0;
    std::size_t column = 0;
};

// Where things stand in the file, in the order of the scene.
struct ScenePositions {
    FilePosition dt;
    std::vector<FilePosition> bodies;
    std::vector<FilePosition> joints;
    std::vector<FilePosition> particles;
    std::vector<FilePosition> springs;
    std::vector<FilePosition> cloths;
};

// Of a scene without errors:
// - two bodies, one of them dynamic, overlap at the start by more than 1 % of the smaller one's
// width
//   (unless a joint keeps them from colliding);
// - two dynamic bodies that touch or are joined differ more than a hundredfold in mass;
// - the anchors of a ball joint are apart by more than 10 % of the smaller body's width;
// - a joint or a spring moves nothing, as neither of its ends is dynamic;
// - a spring is too stiff for an explicit method's step;
// - a body is so far away that float cannot follow it;
// - dt is too long: see the messages for the formulas.
// No more than ten of a kind are listed, the last of them saying how many more there are.
std::vector<SceneMessage> scene_warnings(const SceneDesc &scene, const ScenePositions &positions);

} // namespace plumb
