// Everything is drawn here first: colour (sRGB) and depth of a given size.
#pragma once

#include <glm/vec2.hpp>

#include "app/render/image.h"

namespace plumb {

class Framebuffer {
  public:
    // `samples` is 1 for no multisampling (golden pictures), 4 for smooth edges; it is clamped to
    // the driver's limit. Throws std::runtime_error if the driver refuses the size.
    explicit Framebuffer(glm::ivec2 size, int samples = 1);
    ~Framebuffer();
    Framebuffer(Framebuffer &&other) noexcept;
    Framebuffer &operator=(Framebuffer &&other) noexcept;
    Framebuffer(const Framebuffer &) = delete;
    Framebuffer &operator=(const Framebuffer &) = delete;

    [[nodiscard]] glm::ivec2 size() const { return size_; }
    [[nodiscard]] int samples() const { return samples_; }
    void resize(glm::ivec2 size); // contents are lost; a no-op if the size is the same

    // Binds for drawing the scene and sets the viewport.
    void bind() const;
    // Resolves multisampled drawing into the plain picture. Renderer::draw ends with this.
    void resolve() const;
    // Binds the plain picture for drawing over it (panels, text) and sets the viewport.
    void bind_resolved() const;

    // The plain picture, top row first.
    [[nodiscard]] Image read() const;
    // Copies the plain picture to the window's own buffer, which must be current; scales if the
    // sizes differ.
    void blit_to_window(glm::ivec2 window_framebuffer_size) const;
    // The GL name of what bind() binds, to copy its depth from.
    [[nodiscard]] unsigned draw_name() const { return draw_; }

  private:
    void create();
    void destroy();

    glm::ivec2 size_{0};
    int samples_ = 1;
    unsigned draw_ = 0; // multisampled, or the same as resolved_
    unsigned resolved_ = 0;
    unsigned texture_ = 0;
    unsigned colour_buffer_ = 0; // multisampled
    unsigned depth_buffer_ = 0;
};

} // namespace plumb
