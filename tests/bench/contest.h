// The same questions put to several libraries.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace plumb {

struct Entrant {
    std::string name;
    // Answers the whole batch; returns how many answers were yes, so that it can be seen whether
    // all were asked the same.
    std::function<std::uint64_t()> answer_all;
};

struct Contest {
    std::string name;
    std::size_t batch = 0;
    Entrant ours;
    std::vector<Entrant> others;
    double aim = 0; // how many times faster than each other we mean to be; 0: no aim
};

// What they borrow lives as long as the program.
[[nodiscard]] std::vector<Contest> ray_contests();   // one ray, one shape
[[nodiscard]] std::vector<Contest> pair_contests();  // two shapes
[[nodiscard]] std::vector<Contest> batch_contests(); // one against many
// Rays against meshes of up to so many triangles.
[[nodiscard]] std::vector<Contest> mesh_contests(std::size_t largest);

} // namespace plumb
