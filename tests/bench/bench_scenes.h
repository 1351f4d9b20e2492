// The scenes of `plumb bench dynamics`: what engines are usually timed on, in code because the
// largest would be files of 30 MB.
#pragma once

#include "engine/scene/scene_desc.h"

#include <functional>
#include <string>
#include <vector>

namespace plumb {

struct BenchScene {
    std::string name;
    double seconds = 0;  // of the world, that it is run
    bool stands = false; // how far its top went says something
    // About `size` times as many bodies as in full, at least a few.
    std::function<SceneDesc(double size)> make;
};

[[nodiscard]] std::vector<BenchScene> bench_scenes();

} // namespace plumb
