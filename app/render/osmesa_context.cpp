#include "app/render/context.h"

#include <array>

// glad's declarations must come before Mesa's own.
#include <glad/gl.h>

#include <GL/osmesa.h>

namespace plumb {

namespace {

class OsmesaContext final : public GlContext {
  public:
    OsmesaContext() {
        // Everything is drawn into a Framebuffer; the context's own buffer is a formality.
        // Forward-compatible contexts are refused, so we do not ask for one.
        static constexpr std::array<int, 13> attributes{OSMESA_FORMAT,
                                                        OSMESA_RGBA,
                                                        OSMESA_DEPTH_BITS,
                                                        0,
                                                        OSMESA_PROFILE,
                                                        OSMESA_CORE_PROFILE,
                                                        OSMESA_CONTEXT_MAJOR_VERSION,
                                                        3,
                                                        OSMESA_CONTEXT_MINOR_VERSION,
                                                        3,
                                                        0,
                                                        0,
                                                        0};
        context_ = OSMesaCreateContextAttribs(attributes.data(), nullptr);
        if (!context_)
            throw ContextError("OSMesa cannot create an OpenGL 3.3 core context");
        try {
            make_current();
            if (gladLoadGL(reinterpret_cast<GLADloadfunc>(OSMesaGetProcAddress)) == 0)
                throw ContextError("OSMesa's OpenGL functions could not be loaded");
        } catch (...) {
            OSMesaDestroyContext(context_);
            throw;
        }
        read_strings();
    }

    ~OsmesaContext() override { OSMesaDestroyContext(context_); }

    OsmesaContext(const OsmesaContext &) = delete;
    OsmesaContext &operator=(const OsmesaContext &) = delete;

    void make_current() override {
        if (OSMesaMakeCurrent(context_, buffer_.data(), GL_UNSIGNED_BYTE, side, side) == GL_FALSE)
            throw ContextError("OSMesa's context could not be made current");
    }
    [[nodiscard]] Window *window() override { return nullptr; }
    [[nodiscard]] const char *kind() const override { return "osmesa"; }

  private:
    static constexpr int side = 16; // pixels
    OSMesaContext context_ = nullptr;
    std::array<unsigned char, 4 * side * side> buffer_{};
};

} // namespace

std::unique_ptr<GlContext> create_osmesa_context() {
    return std::make_unique<OsmesaContext>();
}

} // namespace plumb
