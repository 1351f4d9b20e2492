#include "app/render/imgui_renderer.h"

#include <cstddef>
#include <cstdint>
#include <utility>

#include <glad/gl.h>
#include <imgui/imgui.h>

#include "app/render/shader_program.h"
#include "app/render/vertex_input.h"
#include "engine/core/check.h"

namespace plumb {

namespace {

void *texture_id(GLuint name) {
    return reinterpret_cast<void *>(static_cast<std::uintptr_t>(name));
}

} // namespace

struct ImguiRenderer::Parts {
    ShaderProgram program;
    GLuint array = 0;
    GLuint vertices = 0;
    GLuint indices = 0;
    GLuint font_texture = 0;

    explicit Parts(const std::filesystem::path &dir) : program(dir, "imgui.vert", "imgui.frag") {
        glGenVertexArrays(1, &array);
        glGenBuffers(1, &vertices);
        glGenBuffers(1, &indices);
        glGenTextures(1, &font_texture);
        program.bind_sampler("picture", 0);
        glBindVertexArray(array);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices);
        for (GLuint i = 0; i < 3; ++i)
            glEnableVertexAttribArray(i);
    }
    ~Parts() {
        glDeleteTextures(1, &font_texture);
        glDeleteBuffers(1, &indices);
        glDeleteBuffers(1, &vertices);
        glDeleteVertexArrays(1, &array);
    }
    Parts(const Parts &) = delete;
    Parts &operator=(const Parts &) = delete;

    // Sets everything a frame or callback may have changed. The attributes are set to each
    // command's own vertices when it is drawn, which supports VtxOffset.
    void set_state(const ImDrawData &data) const {
        glEnable(GL_BLEND);
        glBlendEquation(GL_FUNC_ADD);
        glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
        glDisable(GL_CULL_FACE);
        glDisable(GL_DEPTH_TEST);
        glDisable(GL_FRAMEBUFFER_SRGB);
        glEnable(GL_SCISSOR_TEST);
        glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
        glActiveTexture(GL_TEXTURE0);
        program.use();
        glUniform4f(program.uniform("display"), data.DisplayPos.x, data.DisplayPos.y,
                    data.DisplaySize.x, data.DisplaySize.y);
        glBindVertexArray(array);
        glBindBuffer(GL_ARRAY_BUFFER, vertices);
    }
};

ImguiRenderer::ImguiRenderer(const std::filesystem::path &shader_dir)
    : parts_(std::make_unique<Parts>(shader_dir)) {
    PLUMB_CHECK(ImGui::GetCurrentContext() != nullptr, "ImGui has no context");
    ImGuiIO &io = ImGui::GetIO();
    io.BackendRendererName = "plumb";
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    upload_fonts();
}

ImguiRenderer::~ImguiRenderer() = default;
ImguiRenderer::ImguiRenderer(ImguiRenderer &&) noexcept = default;
ImguiRenderer &ImguiRenderer::operator=(ImguiRenderer &&) noexcept = default;

void ImguiRenderer::upload_fonts() {
    ImFontAtlas &atlas = *ImGui::GetIO().Fonts;
    unsigned char *pixels = nullptr;
    int width = 0;
    int height = 0;
    atlas.GetTexDataAsRGBA32(&pixels, &width, &height);
    glBindTexture(GL_TEXTURE_2D, parts_->font_texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    atlas.SetTexID(texture_id(parts_->font_texture));
}

void ImguiRenderer::draw(const ImDrawData &data) {
    const ImVec2 scale = data.FramebufferScale;
    const float width = data.DisplaySize.x * scale.x;
    const float height = data.DisplaySize.y * scale.y;
    if (width <= 0 || height <= 0)
        return;
    glViewport(0, 0, static_cast<GLsizei>(width), static_cast<GLsizei>(height));
    parts_->set_state(data);
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList &list = *data.CmdLists[i];
        glBufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data,
                     GL_STREAM_DRAW);
        glBufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data,
                     GL_STREAM_DRAW);
        for (const ImDrawCmd &command : list.CmdBuffer) {
            if (command.UserCallback == ImDrawCallback_ResetRenderState) {
                parts_->set_state(data);
                continue;
            }
            if (command.UserCallback) {
                command.UserCallback(&list, &command);
                continue;
            }
            const float left = (command.ClipRect.x - data.DisplayPos.x) * scale.x;
            const float top = (command.ClipRect.y - data.DisplayPos.y) * scale.y;
            const float right = (command.ClipRect.z - data.DisplayPos.x) * scale.x;
            const float bottom = (command.ClipRect.w - data.DisplayPos.y) * scale.y;
            if (right <= left || bottom <= top)
                continue;
            glScissor(static_cast<GLint>(left), static_cast<GLint>(height - bottom),
                      static_cast<GLsizei>(right - left), static_cast<GLsizei>(bottom - top));
            glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(
                                             reinterpret_cast<std::uintptr_t>(command.GetTexID())));
            const std::size_t first = command.VtxOffset * sizeof(ImDrawVert);
            glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, sizeof(ImDrawVert),
                                  byte_offset(first + offsetof(ImDrawVert, pos)));
            glVertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, sizeof(ImDrawVert),
                                  byte_offset(first + offsetof(ImDrawVert, uv)));
            glVertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(ImDrawVert),
                                  byte_offset(first + offsetof(ImDrawVert, col)));
            glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount),
                           sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT,
                           byte_offset(command.IdxOffset * sizeof(ImDrawIdx)));
        }
    }
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
    glBindVertexArray(0);
}

void ImguiRenderer::draw(const ImDrawData &data, Framebuffer &target) {
    target.bind_resolved();
    draw(data);
}

Image paint_image(ImguiRenderer &renderer, glm::ivec2 size, glm::vec3 background,
                  const std::function<void(ImDrawList &)> &paint) {
    PLUMB_CHECK(ImGui::GetCurrentContext() != nullptr, "ImGui has no context");
    Framebuffer target(size);
    target.bind_resolved();
    glDisable(GL_FRAMEBUFFER_SRGB);
    glClearColor(background.r, background.g, background.b, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGuiIO &io = ImGui::GetIO();
    // Charts are made between a window's frames, so its settings are restored below.
    const ImVec2 display_size = std::exchange(
        io.DisplaySize, ImVec2(static_cast<float>(size.x), static_cast<float>(size.y)));
    const ImVec2 scale = std::exchange(io.DisplayFramebufferScale, ImVec2(1, 1));
    ImGui::NewFrame();
    paint(*ImGui::GetBackgroundDrawList());
    ImGui::Render();
    renderer.draw(*ImGui::GetDrawData(), target);
    io.DisplaySize = display_size;
    io.DisplayFramebufferScale = scale;
    return target.read();
}

} // namespace plumb
