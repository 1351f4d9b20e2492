// The scene's depth as the light sees it.
#pragma once

#include <filesystem>
#include <vector>

#include "app/render/draw_list.h"
#include "app/render/shader_program.h"
#include "app/render/shadow_fit.h"
#include "app/render/shape_meshes.h"

namespace plumb {

class ShadowMap {
  public:
    // `soft`: a fetch interpolates the four nearest texels, and there are four times as many.
    ShadowMap(const std::filesystem::path &shader_dir, bool soft);
    ~ShadowMap();
    ShadowMap(const ShadowMap &) = delete;
    ShadowMap &operator=(const ShadowMap &) = delete;

    [[nodiscard]] int size() const { return size_; } // texels per side

    // Binds the map for the frame's shaders.
    void bind() const;

    // The triangles and the fit are relative to `origin`.
    void draw(const std::vector<DrawShape> &shapes, const std::vector<const TriangleBatch *> &flat,
              const glm::vec3 &origin, const ShadowFit &fit, const ShapeMeshes &meshes) const;

  private:
    ShaderProgram program_;
    int size_;
    unsigned texture_ = 0;
    unsigned target_ = 0;
};

} // namespace plumb
