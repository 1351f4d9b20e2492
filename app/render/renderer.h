// Draws a DrawList into a Framebuffer: the same for a window and for a snapshot.
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "app/render/draw_list.h"
#include "app/render/framebuffer.h"

namespace plumb {

// In pixels, from the top left.
struct PixelRect {
    glm::ivec2 min{0};
    glm::ivec2 size{0};
};

class Renderer {
  public:
    // Loads the GLSL files of `shader_dir`; a GL context must be current, here and in every call.
    // Without a GPU each pixel costs: `plain` draws hard shadows, no occlusion, and nothing of the
    // scene where it is covered. Throws std::runtime_error with file and line when a shader is
    // missing or does not compile.
    enum class Quality { full, plain };
    explicit Renderer(const std::filesystem::path &shader_dir, Quality quality = Quality::full);
    ~Renderer();
    Renderer(Renderer &&) noexcept;
    Renderer &operator=(Renderer &&) noexcept;

    // Draws everything anew and resolves. An empty list gives the background. The same list gives
    // the same pixels. Shapes with a pose that is not finite are left out. `covered` is what panels
    // will hide.
    void draw(const DrawList &list, Framebuffer &target, std::span<const PixelRect> covered = {});

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

// Draws into a framebuffer of its own, and reads it back.
[[nodiscard]] Image render_image(Renderer &renderer, const DrawList &list, glm::ivec2 size,
                                 int samples = 1);

} // namespace plumb
