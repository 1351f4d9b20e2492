#include "app/render/occlusion.h"

#include <cstddef>

#include <glad/gl.h>

#include "app/render/frame_block.h"

namespace plumb {

Occlusion::Occlusion(const std::filesystem::path &shader_dir)
    : occlusion_program_(frame_program(shader_dir, "screen.vert", "occlusion.frag")),
      smooth_program_(frame_program(shader_dir, "screen.vert", "occlusion_smooth.frag")),
      apply_program_(frame_program(shader_dir, "screen.vert", "occlusion_apply.frag")) {
    glGenVertexArrays(1, &array_);
}

Occlusion::~Occlusion() {
    delete_targets();
    glDeleteVertexArrays(1, &array_);
}

void Occlusion::delete_targets() {
    glDeleteFramebuffers(1, &depth_target_);
    glDeleteTextures(1, &depth_texture_);
    glDeleteFramebuffers(2, targets_.data());
    glDeleteTextures(2, textures_.data());
}

void Occlusion::resize(glm::ivec2 size) {
    if (size == size_)
        return;
    delete_targets();
    size_ = size;
    const auto make = [](GLuint &texture, GLuint &target, GLenum attachment, GLint internal,
                         glm::ivec2 extent, GLenum format, GLenum type) {
        glGenTextures(1, &texture);
        glActiveTexture(GL_TEXTURE0 + depth_unit);
        glBindTexture(GL_TEXTURE_2D, texture);
        glTexImage2D(GL_TEXTURE_2D, 0, internal, extent.x, extent.y, 0, format, type, nullptr);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
        glGenFramebuffers(1, &target);
        glBindFramebuffer(GL_FRAMEBUFFER, target);
        glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture, 0);
    };
    // The same format as a Framebuffer's depth, as the copy requires.
    make(depth_texture_, depth_target_, GL_DEPTH_STENCIL_ATTACHMENT, GL_DEPTH24_STENCIL8, size,
         GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
    // Occlusion, and its depth in metres.
    for (std::size_t i = 0; i < 2; ++i)
        make(textures_[i], targets_[i], GL_COLOR_ATTACHMENT0, GL_RG32F, (size + 1) / 2, GL_RG,
             GL_FLOAT);
}

void Occlusion::draw(const Framebuffer &target) {
    const glm::ivec2 size = target.size();
    resize(size);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target.draw_name());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, depth_target_);
    glBlitFramebuffer(0, 0, size.x, size.y, 0, 0, size.x, size.y, GL_DEPTH_BUFFER_BIT, GL_NEAREST);
    glDisable(GL_DEPTH_TEST);
    const glm::ivec2 half = (size + 1) / 2;
    glViewport(0, 0, half.x, half.y);
    glActiveTexture(GL_TEXTURE0 + depth_unit);
    glBindTexture(GL_TEXTURE_2D, depth_texture_);
    glActiveTexture(GL_TEXTURE0 + occlusion_unit);
    glBindFramebuffer(GL_FRAMEBUFFER, targets_[0]);
    draw_screen(occlusion_program_, array_);
    glBindTexture(GL_TEXTURE_2D, textures_[0]);
    glBindFramebuffer(GL_FRAMEBUFFER, targets_[1]);
    draw_screen(smooth_program_, array_);
    glBindTexture(GL_TEXTURE_2D, textures_[1]);
    target.bind();
    glEnable(GL_BLEND);
    glBlendFunc(GL_ZERO, GL_SRC_COLOR); // destination times source
    draw_screen(apply_program_, array_);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
}

} // namespace plumb
