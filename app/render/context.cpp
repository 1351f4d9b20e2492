#include "app/render/context.h"

#include <glad/gl.h>

namespace plumb {

GlChoice gl_choice_from_name(const std::string &name) {
    if (name == "auto")
        return GlChoice::automatic;
    if (name == "window")
        return GlChoice::window;
    if (name == "osmesa")
        return GlChoice::osmesa;
    throw std::invalid_argument("unknown OpenGL context '" + name +
                                "'; known: auto, window, osmesa");
}

void GlContext::read_strings() {
    const auto text = [](GLenum name) {
        const GLubyte *string = glGetString(name);
        return std::string(string ? reinterpret_cast<const char *>(string) : "unknown");
    };
    renderer_ = text(GL_RENDERER);
    version_ = text(GL_VERSION);
}

bool GlContext::is_software() const {
    // Mesa's, Google's and Microsoft's.
    for (const char *name : {"llvmpipe", "softpipe", "swrast", "SWR", "Software Rasterizer",
                             "SwiftShader", "GDI Generic", "Basic Render"})
        if (renderer_.find(name) != std::string::npos)
            return true;
    return false;
}

ContextResult create_context(const ContextRequest &request) {
    const bool automatic = request.choice == GlChoice::automatic;
    const bool try_window =
        request.choice == GlChoice::window || (automatic && !request.off_screen);
    const bool try_osmesa = request.choice == GlChoice::osmesa || automatic;
    std::string attempts;
    std::string why_no_window;
    if (try_window) {
        try {
            return {create_window_context(request), {}};
        } catch (const ContextError &error) {
            why_no_window = error.what();
            attempts += "\n  window: " + why_no_window;
        }
    }
    if (try_osmesa) {
        try {
            return {create_osmesa_context(), why_no_window};
        } catch (const ContextError &error) {
            attempts += std::string("\n  osmesa: ") + error.what();
        }
    }
    throw ContextError("no OpenGL 3.3 context could be created:" + attempts);
}

} // namespace plumb
