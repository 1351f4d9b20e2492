// The scenes of `plumb bench dynamics`: the usual engine benchmarks, in code because the largest
// would be 30 MB files.
#pragma once

#include "engine/scene/scene_desc.h"

#include <functional>
#include <string>
#include <vector>

namespace plumb {

struct BenchScene {
    std::string name;
    double seconds = 0;  // simulated time
    bool stands = false; // how far its top moved is meaningful
    // With about `size` times the full number of bodies, but at least a few.
    std::function<SceneDesc(double size)> make;
};

[[nodiscard]] std::vector<BenchScene> bench_scenes();

} // namespace plumb
