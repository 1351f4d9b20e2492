// Screen-space ambient occlusion: darkens creases and contacts.
#pragma once

#include <array>
#include <filesystem>

#include <glm/vec2.hpp>

#include "app/render/framebuffer.h"
#include "app/render/shader_program.h"

namespace plumb {

class Occlusion {
  public:
    explicit Occlusion(const std::filesystem::path &shader_dir);
    ~Occlusion();
    Occlusion(const Occlusion &) = delete;
    Occlusion &operator=(const Occlusion &) = delete;

    // Reads the target's depth, and darkens its colours.
    void draw(const Framebuffer &target);

  private:
    void resize(glm::ivec2 size);
    void delete_targets();

    ShaderProgram occlusion_program_;
    ShaderProgram smooth_program_;
    ShaderProgram apply_program_;
    // A copy of the scene's depth at full size; two pictures at half size.
    glm::ivec2 size_{0}; // of the scene
    unsigned depth_texture_ = 0;
    unsigned depth_target_ = 0;
    std::array<unsigned, 2> textures_{};
    std::array<unsigned, 2> targets_{};
    unsigned array_ = 0; // without attributes
};

} // namespace plumb
