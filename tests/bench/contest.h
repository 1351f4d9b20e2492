// The same queries in several libraries.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace plumb {

struct Entrant {
    std::string name;
    // Answers the whole batch; returns the number of yes answers, to show that all libraries were
    // asked the same.
    std::function<std::uint64_t()> answer_all;
};

struct Contest {
    std::string name;
    std::size_t batch = 0;
    Entrant ours;
    std::vector<Entrant> others;
    double aim = 0; // target speedup over each of the others; 0: none
};

// The inputs that contests refer to live as long as the program.
[[nodiscard]] std::vector<Contest> ray_contests();   // one ray, one shape
[[nodiscard]] std::vector<Contest> pair_contests();  // two shapes
[[nodiscard]] std::vector<Contest> batch_contests(); // one against many
// Rays against meshes of up to `largest` triangles.
[[nodiscard]] std::vector<Contest> mesh_contests(std::size_t largest);

} // namespace plumb
