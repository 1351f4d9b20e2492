#include "app/render/shadow_map.h"

#include <array>
#include <optional>

#include <glad/gl.h>

#include "app/render/culling.h"
#include "app/render/frame_block.h"

namespace plumb {

ShadowMap::ShadowMap(const std::filesystem::path &shader_dir, bool soft)
    : program_(frame_program(shader_dir, "shadow.vert", "shadow.frag")), size_(soft ? 2048 : 1024) {
    glGenTextures(1, &texture_);
    glActiveTexture(GL_TEXTURE0 + shadow_unit);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, size_, size_, 0, GL_DEPTH_COMPONENT,
                 GL_UNSIGNED_INT, nullptr);
    // Outside the map everything is lit. (Without a GPU its empty border is clamped, which is
    // cheaper.)
    const std::array<float, 4> lit{1, 1, 1, 1};
    const GLint filter = soft ? GL_LINEAR : GL_NEAREST;
    const GLint wrap = soft ? GL_CLAMP_TO_BORDER : GL_CLAMP_TO_EDGE;
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap);
    glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, lit.data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    glGenFramebuffers(1, &target_);
    glBindFramebuffer(GL_FRAMEBUFFER, target_);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, texture_, 0);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
}

ShadowMap::~ShadowMap() {
    glDeleteFramebuffers(1, &target_);
    glDeleteTextures(1, &texture_);
}

void ShadowMap::bind() const {
    glActiveTexture(GL_TEXTURE0 + shadow_unit);
    glBindTexture(GL_TEXTURE_2D, texture_);
}

void ShadowMap::draw(const std::vector<DrawShape> &shapes,
                     const std::vector<const TriangleBatch *> &flat, const glm::vec3 &origin,
                     const ShadowFit &fit, const ShapeMeshes &meshes) const {
    glBindFramebuffer(GL_FRAMEBUFFER, target_);
    glViewport(0, 0, size_, size_);
    glClear(GL_DEPTH_BUFFER_BIT);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(2.0f, 4.0f);
    // Shapes nearer to the light than the map's near end still cast shadows.
    glEnable(GL_DEPTH_CLAMP);
    program_.use();
    meshes.draw(shape_batch(shapes, origin, [&](const DrawShape &shape) {
        const glm::vec3 at = shape.position - origin;
        const glm::vec4 centre = fit.texture_from_relative * glm::vec4(at, 1);
        const float metres = bounding_radius(shape);
        const float radius = metres / (fit.texel * static_cast<float>(size_));
        const bool outside = centre.x < -radius || centre.x > 1 + radius || centre.y < -radius ||
                             centre.y > 1 + radius;
        // A quarter of the texels is enough: shadow edges are soft.
        return outside ? std::nullopt : std::optional<float>(0.25f * shape.size.x / fit.texel);
    }));
    glDisable(GL_CULL_FACE);
    for (const TriangleBatch *batch : flat)
        meshes.draw(*batch);
    glEnable(GL_CULL_FACE);
    glDisable(GL_DEPTH_CLAMP);
    glDisable(GL_POLYGON_OFFSET_FILL);
}

} // namespace plumb
