// Draws Dear ImGui's draw data with our own GL loader, so panels and charts work in a window and
// off screen.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "app/render/framebuffer.h"
#include "app/render/image.h"

struct ImDrawData;
struct ImDrawList;

namespace plumb {

// Replaces ImGui's own OpenGL back end. Use:
//   ImGui::CreateContext(); load_font(...); ImguiRenderer renderer(shader_dir);
//   each frame: ImGui::NewFrame() ... ImGui::Render(); renderer.draw(*ImGui::GetDrawData());
// An ImTextureID is a GL texture name. Colours are sRGB and blended as they are, as in ImGui's own
// back ends.
class ImguiRenderer {
  public:
    // A GL context and an ImGui context must be current; uploads that context's font atlas.
    explicit ImguiRenderer(const std::filesystem::path &shader_dir);
    ~ImguiRenderer();
    ImguiRenderer(ImguiRenderer &&) noexcept;
    ImguiRenderer &operator=(ImguiRenderer &&) noexcept;

    // Call again after fonts have been added or rebuilt.
    void upload_fonts();

    // Draws over the bound framebuffer: the window's own.
    void draw(const ImDrawData &data);
    // Draws over the plain picture of a framebuffer.
    void draw(const ImDrawData &data, Framebuffer &target);

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

// An off-screen picture of ImGui's shapes and text alone (a chart): runs one frame in the current
// ImGui context, passes its draw list to `paint` (coordinates in pixels, origin top left), and
// reads the result back. Must not be called between ImGui::NewFrame and ImGui::Render.
[[nodiscard]] Image paint_image(ImguiRenderer &renderer, glm::ivec2 size, glm::vec3 background,
                                const std::function<void(ImDrawList &)> &paint);

} // namespace plumb
