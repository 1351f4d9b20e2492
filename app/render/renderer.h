// Draws a DrawList into a Framebuffer, the same way for a window and a snapshot.
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
    // Loads the GLSL files from `shader_dir`; a GL context must be current, here and in every call.
    // Without a GPU every pixel is expensive: `plain` draws hard shadows, no occlusion, and no
    // scene where it is covered. Throws std::runtime_error with file and line if a shader is
    // missing or does not compile.
    enum class Quality { full, plain };
    explicit Renderer(const std::filesystem::path &shader_dir, Quality quality = Quality::full);
    ~Renderer();
    Renderer(Renderer &&) noexcept;
    Renderer &operator=(Renderer &&) noexcept;

    // Draws everything and resolves. An empty list gives the background. The same list gives the
    // same pixels. Shapes with a non-finite pose are skipped. `covered` is what panels will hide.
    void draw(const DrawList &list, Framebuffer &target, std::span<const PixelRect> covered = {});

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

// Draws into its own framebuffer and reads it back.
[[nodiscard]] Image render_image(Renderer &renderer, const DrawList &list, glm::ivec2 size,
                                 int samples = 1);

} // namespace plumb
