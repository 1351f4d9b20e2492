// An in-memory context and a renderer, for tests that look at pixels.
#pragma once

#include <filesystem>
#include <memory>

#include <gtest/gtest.h>

#include "app/render/context.h"
#include "app/render/renderer.h"

namespace plumb {

inline std::filesystem::path shader_dir() {
    return std::filesystem::path(PLUMB_SOURCE_DIR) / "shaders";
}

class OffScreen : public testing::Test {
  protected:
    std::unique_ptr<GlContext> context = create_osmesa_context();
    Renderer renderer{shader_dir()};
};

// Without effects that change the colour of visible pixels.
inline DrawList plain_list() {
    DrawList list;
    list.view.shadows = false;
    list.view.occlusion = false;
    list.view.edges = false;
    return list;
}

} // namespace plumb
