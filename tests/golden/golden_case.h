// What the golden pictures show and how each is drawn.
#pragma once

#include "app/render/draw_list.h"
#include "app/render/image.h"
#include "app/sandbox/draw/world_draw.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

namespace plumb::golden {

struct Case {
    std::string name;  // file name stem
    std::string scene; // below scenes/, without ".toml"
    // Early: over a long run builds and solvers diverge for reasons that are no fault of theirs.
    std::uint64_t step = 0;
    WorldDrawOptions debug;
    bool panels = false; // with the sandbox's panels around it
    glm::ivec2 size{400, 250};
};

const std::vector<Case> &cases();
std::ostream &operator<<(std::ostream &out, const Case &golden); // its name

// What decides the pixels besides the state. llvmpipe compiles shaders for the CPU it finds, so its
// name and version alone are not enough.
struct Rasterizer {
    std::string renderer; // GL_RENDERER
    std::string version;  // GL_VERSION
    std::string cpu;      // the CPU's instruction sets that change results
    friend bool operator==(const Rasterizer &, const Rasterizer &) = default;
};

struct Rendering {
    std::uint64_t state_hash = 0;
    Rasterizer rasterizer;
    Image picture;
    Image background; // the same view with only the planes in it
};

// Draws off screen, without multisampling. `without` leaves out one body, counted among those drawn
// as shapes; not for a case with panels.
Rendering render(const Case &golden, std::optional<std::size_t> without = {});
// How many bodies, or probe shapes, are drawn as shapes.
std::size_t shape_count(const Case &golden);

} // namespace plumb::golden
