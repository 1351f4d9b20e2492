#include "app/render/marks.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <glad/gl.h>

#include "app/render/frame_block.h"
#include "app/render/palette.h"
#include "app/render/vertex_input.h"

namespace plumb {

namespace {

struct LineInstance {
    glm::vec3 a;
    float width;
    glm::vec3 b;
    float unused;
    glm::vec3 colour; // linear
};

struct PointInstance {
    glm::vec3 position;
    float radius;
    glm::vec3 colour; // linear
};

} // namespace

Marks::Marks(const std::filesystem::path &shader_dir)
    : line_program_(frame_program(shader_dir, "line.vert", "line.frag")),
      point_program_(frame_program(shader_dir, "point.vert", "point.frag")) {
    glGenBuffers(1, &instances_);
    glGenVertexArrays(1, &line_array_);
    glGenVertexArrays(1, &point_array_);
}

Marks::~Marks() {
    glDeleteBuffers(1, &instances_);
    const std::array arrays{line_array_, point_array_};
    glDeleteVertexArrays(static_cast<GLsizei>(arrays.size()), arrays.data());
}

void Marks::draw(const DrawList &list) const {
    const glm::vec3 origin = list.camera.target;
    std::vector<LineInstance> lines;
    lines.reserve(list.lines.size() + list.points.size());
    const auto add = [&](const glm::vec3 &a, const glm::vec3 &b, const glm::vec3 &colour,
                         float width) {
        if (finite(a) && finite(b))
            lines.push_back({a - origin, width, b - origin, 0, linear_from_srgb(colour)});
    };
    for (const DrawLine &line : list.lines)
        add(line.a, line.b, line.colour, line.width);
    std::vector<PointInstance> points;
    points.reserve(list.points.size());
    for (const DrawPoint &point : list.points) {
        if (point.normal != glm::vec3(0))
            add(point.position, point.position + point.normal, point.colour, 0.5f * point.radius);
        if (finite(point.position))
            points.push_back(
                {point.position - origin, point.radius, linear_from_srgb(point.colour)});
    }
    if (lines.empty() && points.empty())
        return;
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    struct Pass {
        GLenum test;
        float opacity;
    };
    for (const Pass &pass : {Pass{GL_GREATER, 0.28f}, Pass{GL_LEQUAL, 1.0f}}) {
        glDepthFunc(pass.test);
        if (!lines.empty()) {
            line_program_.use();
            glUniform1f(line_program_.uniform("opacity"), pass.opacity);
            glBindVertexArray(line_array_);
            upload(instances_, std::as_bytes(std::span(lines)));
            attribute(0, 4, sizeof(LineInstance), offsetof(LineInstance, a), 1);
            attribute(1, 4, sizeof(LineInstance), offsetof(LineInstance, b), 1);
            attribute(2, 3, sizeof(LineInstance), offsetof(LineInstance, colour), 1);
            glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(lines.size()));
        }
        if (!points.empty()) {
            point_program_.use();
            glUniform1f(point_program_.uniform("opacity"), pass.opacity);
            glBindVertexArray(point_array_);
            upload(instances_, std::as_bytes(std::span(points)));
            attribute(0, 4, sizeof(PointInstance), offsetof(PointInstance, position), 1);
            attribute(1, 3, sizeof(PointInstance), offsetof(PointInstance, colour), 1);
            glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(points.size()));
        }
    }
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

} // namespace plumb
