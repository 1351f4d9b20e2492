#include "app/render/framebuffer.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

#include <glad/gl.h>

#include "engine/core/check.h"

namespace plumb {

namespace {

void check_complete(glm::ivec2 size) {
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE)
        throw std::runtime_error("the OpenGL driver refuses a framebuffer of " +
                                 std::to_string(size.x) + " x " + std::to_string(size.y) +
                                 " pixels (status " + std::to_string(status) + ")");
}

} // namespace

Framebuffer::Framebuffer(glm::ivec2 size, int samples) : size_(size), samples_(samples) {
    PLUMB_CHECK(samples >= 1, "a framebuffer needs at least one sample, got " << samples);
    try {
        create();
    } catch (...) {
        destroy();
        throw;
    }
}

Framebuffer::~Framebuffer() {
    destroy();
}

Framebuffer::Framebuffer(Framebuffer &&other) noexcept
    : size_(other.size_), samples_(other.samples_), draw_(std::exchange(other.draw_, 0)),
      resolved_(std::exchange(other.resolved_, 0)), texture_(std::exchange(other.texture_, 0)),
      colour_buffer_(std::exchange(other.colour_buffer_, 0)),
      depth_buffer_(std::exchange(other.depth_buffer_, 0)) {}

Framebuffer &Framebuffer::operator=(Framebuffer &&other) noexcept {
    std::swap(size_, other.size_);
    std::swap(samples_, other.samples_);
    std::swap(draw_, other.draw_);
    std::swap(resolved_, other.resolved_);
    std::swap(texture_, other.texture_);
    std::swap(colour_buffer_, other.colour_buffer_);
    std::swap(depth_buffer_, other.depth_buffer_);
    return *this;
}

void Framebuffer::create() {
    GLint largest = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
    if (size_.x < 1 || size_.y < 1 || size_.x > largest || size_.y > largest)
        throw std::runtime_error("a framebuffer of " + std::to_string(size_.x) + " x " +
                                 std::to_string(size_.y) + " pixels: each side must be 1 to " +
                                 std::to_string(largest));
    GLint most_samples = 1;
    glGetIntegerv(GL_MAX_SAMPLES, &most_samples);
    samples_ = std::min(samples_, std::max(most_samples, 1));

    glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, size_.x, size_.y, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glGenFramebuffers(1, &resolved_);
    glBindFramebuffer(GL_FRAMEBUFFER, resolved_);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);

    glGenRenderbuffers(1, &depth_buffer_);
    glBindRenderbuffer(GL_RENDERBUFFER, depth_buffer_);
    if (samples_ > 1) {
        check_complete(size_);
        glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples_, GL_DEPTH24_STENCIL8, size_.x,
                                         size_.y);
        glGenRenderbuffers(1, &colour_buffer_);
        glBindRenderbuffer(GL_RENDERBUFFER, colour_buffer_);
        glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples_, GL_SRGB8_ALPHA8, size_.x,
                                         size_.y);
        glGenFramebuffers(1, &draw_);
        glBindFramebuffer(GL_FRAMEBUFFER, draw_);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                                  colour_buffer_);
    } else {
        glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, size_.x, size_.y);
        draw_ = resolved_;
    }
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER,
                              depth_buffer_);
    check_complete(size_);
}

void Framebuffer::destroy() {
    // glad's pointers are null until a context is loaded; until then there is nothing to delete.
    if (resolved_ == 0 && texture_ == 0)
        return;
    if (draw_ != resolved_)
        glDeleteFramebuffers(1, &draw_);
    glDeleteFramebuffers(1, &resolved_);
    glDeleteTextures(1, &texture_);
    glDeleteRenderbuffers(1, &colour_buffer_);
    glDeleteRenderbuffers(1, &depth_buffer_);
    draw_ = resolved_ = texture_ = colour_buffer_ = depth_buffer_ = 0;
}

void Framebuffer::resize(glm::ivec2 size) {
    if (size == size_)
        return;
    Framebuffer changed(size, samples_);
    *this = std::move(changed);
}

void Framebuffer::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, draw_);
    glViewport(0, 0, size_.x, size_.y);
}

void Framebuffer::bind_resolved() const {
    glBindFramebuffer(GL_FRAMEBUFFER, resolved_);
    glViewport(0, 0, size_.x, size_.y);
}

void Framebuffer::resolve() const {
    if (draw_ == resolved_)
        return;
    // With sRGB on, samples are averaged in linear light.
    glEnable(GL_FRAMEBUFFER_SRGB);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, draw_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_);
    glBlitFramebuffer(0, 0, size_.x, size_.y, 0, 0, size_.x, size_.y, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
    glDisable(GL_FRAMEBUFFER_SRGB);
}

Image Framebuffer::read() const {
    const std::size_t width = static_cast<std::size_t>(size_.x);
    const std::size_t height = static_cast<std::size_t>(size_.y);
    std::vector<std::uint8_t> raw(4 * width * height);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved_);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(0, 0, size_.x, size_.y, GL_RGBA, GL_UNSIGNED_BYTE, raw.data());
    Image image;
    image.width = size_.x;
    image.height = size_.y;
    image.pixels.resize(3 * width * height);
    for (std::size_t y = 0; y < height; ++y) {
        const std::uint8_t *from = raw.data() + 4 * width * (height - 1 - y);
        std::uint8_t *to = image.pixels.data() + 3 * width * y;
        for (std::size_t x = 0; x < width; ++x)
            for (std::size_t c = 0; c < 3; ++c)
                to[3 * x + c] = from[4 * x + c];
    }
    return image;
}

void Framebuffer::blit_to_window(glm::ivec2 window_framebuffer_size) const {
    // With sRGB off, bytes are copied unchanged.
    glDisable(GL_FRAMEBUFFER_SRGB);
    glDisable(GL_SCISSOR_TEST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glBlitFramebuffer(0, 0, size_.x, size_.y, 0, 0, window_framebuffer_size.x,
                      window_framebuffer_size.y, GL_COLOR_BUFFER_BIT,
                      window_framebuffer_size == size_ ? GL_NEAREST : GL_LINEAR);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, window_framebuffer_size.x, window_framebuffer_size.y);
}

} // namespace plumb
