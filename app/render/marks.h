// Lines and points over the picture, of constant width at any distance.
#pragma once

#include <filesystem>

#include "app/render/draw_list.h"
#include "app/render/shader_program.h"

namespace plumb {

class Marks {
  public:
    explicit Marks(const std::filesystem::path &shader_dir);
    ~Marks();
    Marks(const Marks &) = delete;
    Marks &operator=(const Marks &) = delete;

    // Draws them faintly where something hides them, in full elsewhere.
    void draw(const DrawList &list) const;

  private:
    ShaderProgram line_program_;
    ShaderProgram point_program_;
    unsigned instances_ = 0;
    unsigned line_array_ = 0;
    unsigned point_array_ = 0;
};

} // namespace plumb
