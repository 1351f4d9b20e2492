#include "app/render/renderer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <glad/gl.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/mat4x4.hpp>

#include "app/render/culling.h"
#include "app/render/frame_block.h"
#include "app/render/marks.h"
#include "app/render/occlusion.h"
#include "app/render/palette.h"
#include "app/render/shader_program.h"
#include "app/render/shadow_fit.h"
#include "app/render/shadow_map.h"
#include "app/render/shape_meshes.h"
#include "engine/core/check.h"

namespace plumb {

namespace {

constexpr float outline_width = 3; // pixels

bool has_finite_pose(const DrawShape &shape) {
    const glm::quat &q = shape.rotation;
    return finite(shape.position) && finite(shape.size) && finite(glm::vec3(q.x, q.y, q.z)) &&
           std::isfinite(q.w);
}

// A mesh's bounding box, for code that needs its extent.
DrawShape box_around(const DrawMesh &mesh) {
    glm::vec3 low(std::numeric_limits<float>::max());
    glm::vec3 high(std::numeric_limits<float>::lowest());
    for (const glm::vec3 &corner : *mesh.corners) {
        low = glm::min(low, corner);
        high = glm::max(high, corner);
    }
    DrawShape box;
    box.kind = DrawKind::box;
    box.position = mesh.position + mesh.rotation * (0.5f * (low + high));
    box.rotation = mesh.rotation;
    box.size = 0.5f * (high - low);
    return box;
}

// Makes the scene fail the depth test there; what remains is roughly the backdrop's colour.
void hide(std::span<const PixelRect> rects, glm::ivec2 size) {
    constexpr float grey = 0.75f;
    glClearColor(grey, grey, grey, 1);
    glClear(GL_COLOR_BUFFER_BIT); // clearing it all is cheaper than parts
    glClearDepth(0);
    glEnable(GL_SCISSOR_TEST);
    for (const PixelRect &rect : rects) {
        glScissor(rect.min.x, size.y - rect.min.y - rect.size.y, std::max(rect.size.x, 0),
                  std::max(rect.size.y, 0));
        glClear(GL_DEPTH_BUFFER_BIT);
    }
    glDisable(GL_SCISSOR_TEST);
    glClearDepth(1);
}

} // namespace

struct Renderer::Parts {
    ShaderProgram shape_program;
    ShaderProgram outline_program;
    ShaderProgram plane_program;
    ShaderProgram backdrop_program;
    ShapeMeshes meshes;
    ShadowMap shadow_map;
    Occlusion occlusion;
    Marks marks;
    Culling culling;
    GLuint empty_array = 0;
    GLuint frame_buffer = 0;

    Quality quality;

    Parts(const std::filesystem::path &dir, Quality wanted)
        : shape_program(frame_program(dir, "shape.vert", "shape.frag", definition(wanted))),
          outline_program(frame_program(dir, "outline.vert", "outline.frag")),
          plane_program(frame_program(dir, "plane.vert", "plane.frag", definition(wanted))),
          backdrop_program(frame_program(dir, "screen.vert", "backdrop.frag")),
          shadow_map(dir, wanted == Quality::full), occlusion(dir), marks(dir), quality(wanted) {
        glGenVertexArrays(1, &empty_array);
        glGenBuffers(1, &frame_buffer);
        glBindBuffer(GL_UNIFORM_BUFFER, frame_buffer);
        glBufferData(GL_UNIFORM_BUFFER, sizeof(FrameBlock), nullptr, GL_STREAM_DRAW);
    }
    ~Parts() {
        glDeleteBuffers(1, &frame_buffer);
        glDeleteVertexArrays(1, &empty_array);
    }
    Parts(const Parts &) = delete;
    Parts &operator=(const Parts &) = delete;

    static const char *definition(Quality quality) {
        return quality == Quality::full ? "" : "#define HARD_SHADOWS";
    }

    void keep_in_view(std::vector<DrawShape> &shapes, const Camera &camera, float aspect) {
        culling.update(shapes);
        const std::span<const std::uint8_t> in_view =
            culling.in_view(frustum_of(camera.projection(aspect) * camera.view()));
        std::size_t kept = 0;
        for (std::size_t i = 0; i < shapes.size(); ++i)
            if (in_view[i] != 0)
                shapes[kept++] = shapes[i];
        shapes.resize(kept);
    }

    void draw_planes(const DrawList &list) const {
        plane_program.use();
        glBindVertexArray(empty_array);
        const glm::vec3 eye = list.camera.eye();
        for (const DrawPlane &plane : list.planes) {
            const glm::dquat rotation(plane.rotation);
            const glm::dvec3 normal = rotation * glm::dvec3(0, 1, 0);
            const glm::dvec3 position(plane.position);
            if (!finite(plane.position) || !finite(glm::vec3(normal)) ||
                glm::dot(normal, glm::dvec3(eye) - position) <= 0)
                continue;
            // The plane's x and z axes, and the camera target's place along them: grid lines repeat
            // every ten metres, so only the remainder matters.
            const glm::dvec3 x = rotation * glm::dvec3(1, 0, 0);
            const glm::dvec3 z = rotation * glm::dvec3(0, 0, 1);
            const glm::dvec3 to_target = glm::dvec3(list.camera.target) - position;
            const auto set = [&](const char *name, const glm::dvec3 &v, double w) {
                glUniform4f(plane_program.uniform(name), static_cast<float>(v.x),
                            static_cast<float>(v.y), static_cast<float>(v.z),
                            static_cast<float>(w));
            };
            set("axis_x", x, std::remainder(glm::dot(to_target, x), 10.0));
            set("axis_z", z, std::remainder(glm::dot(to_target, z), 10.0));
            set("normal", normal, glm::dot(to_target, normal));
            glUniform1f(plane_program.uniform("grid"), list.view.grid ? 1.0f : 0.0f);
            glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
        }
    }

    // A ring around selected shapes that shows through whatever hides them: the pixels a slightly
    // larger copy covers and the shapes themselves do not.
    void draw_outlines(const ShapeBatch &batch) const {
        outline_program.use();
        const glm::vec3 colour = linear_from_srgb(colours::selected);
        const auto draw = [&](float width) {
            glUniform4f(outline_program.uniform("accent"), colour.r, colour.g, colour.b, width);
            meshes.draw(batch);
        };
        glDisable(GL_DEPTH_TEST);
        glEnable(GL_STENCIL_TEST);
        glStencilFunc(GL_ALWAYS, 1, 0xff);
        glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
        glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        draw(0);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        glStencilFunc(GL_EQUAL, 0, 0xff);
        draw(outline_width);
        glDisable(GL_STENCIL_TEST);
        glEnable(GL_DEPTH_TEST);
    }
};

Renderer::Renderer(const std::filesystem::path &shader_dir, Quality quality)
    : parts_(std::make_unique<Parts>(shader_dir, quality)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer &&) noexcept = default;
Renderer &Renderer::operator=(Renderer &&) noexcept = default;

void Renderer::draw(const DrawList &list, Framebuffer &target, std::span<const PixelRect> covered) {
    Parts &parts = *parts_;
    const Camera &camera = list.camera;
    const glm::vec2 size(target.size());
    const float aspect = size.x / size.y;
    PLUMB_CHECK(finite(camera.target) && camera.distance > 0 && std::isfinite(camera.distance) &&
                    camera.fov > 0 && camera.fov < glm::pi<float>(),
                "the camera cannot see: distance " << camera.distance << ", fov " << camera.fov);
    PLUMB_CHECK(finite(list.light.direction) && list.light.direction != glm::vec3(0),
                "the light has no direction");

    std::vector<DrawShape> shapes;
    std::vector<DrawShape> glass;
    for (const DrawShape &shape : list.shapes)
        if (has_finite_pose(shape))
            (shape.glass ? glass : shapes).push_back(shape);
    const TriangleBatch triangles = triangle_batch(list.meshes, camera.target, false);
    const TriangleBatch glass_triangles = triangle_batch(list.meshes, camera.target, true);
    const bool any_solid = !shapes.empty() || !triangles.parts.empty();
    const bool any_glass = !glass.empty() || !glass_triangles.parts.empty();

    std::optional<ShadowFit> shadow;
    std::vector<DrawShape> casters;
    if (list.view.shadows && list.light.intensity > 0 && (any_solid || any_glass)) {
        casters = shapes;
        casters.insert(casters.end(), glass.begin(), glass.end());
        std::vector<DrawShape> reaching = casters;
        for (const DrawMesh &mesh : list.meshes)
            if (const DrawShape box = box_around(mesh); has_finite_pose(box))
                reaching.push_back(box);
        shadow = fit_shadow(reaching, camera, aspect, list.light.direction, camera.target,
                            parts.shadow_map.size());
    }
    // Shapes out of view cast shadows but need no sorting or further tests.
    if (shapes.size() >= least_shapes_to_cull)
        parts.keep_in_view(shapes, camera, aspect);

    // Front to back, so hidden pixels are not shaded.
    const glm::vec3 forward = camera.forward();
    std::stable_sort(shapes.begin(), shapes.end(), [&](const DrawShape &a, const DrawShape &b) {
        return glm::dot(a.position - camera.target, forward) <
               glm::dot(b.position - camera.target, forward);
    });

    // Things behind glass are visible: back to front.
    std::stable_sort(glass.begin(), glass.end(), [&](const DrawShape &a, const DrawShape &b) {
        return glm::dot(a.position - camera.target, forward) >
               glm::dot(b.position - camera.target, forward);
    });

    Camera relative = camera;
    relative.target = glm::vec3(0);
    const float tangent = camera.half_height();
    FrameBlock frame{};
    frame.projection = relative.projection(aspect);
    frame.view = relative.view();
    frame.shadow = shadow ? shadow->texture_from_relative : glm::mat4(1);
    frame.eye = glm::vec4(relative.eye(), camera.distance);
    frame.to_light = glm::vec4(-glm::normalize(list.light.direction), list.light.intensity);
    frame.viewport = {size, tangent * aspect, tangent};
    frame.centre = {camera.centre, 0, 0};
    frame.light = {list.light.ambient, shadow ? shadow->texel : 0.0f,
                   1.0f / static_cast<float>(parts.shadow_map.size()), shadow ? 1.0f : 0.0f};
    frame.range = {relative.near_plane(), relative.far_plane(), list.view.edges ? 1.0f : 0.0f,
                   2 * tangent / size.y};
    glBindBuffer(GL_UNIFORM_BUFFER, parts.frame_buffer);
    glBufferData(GL_UNIFORM_BUFFER, sizeof(frame), &frame, GL_STREAM_DRAW);
    glBindBufferBase(GL_UNIFORM_BUFFER, frame_binding, parts.frame_buffer);
    parts.shadow_map.bind();

    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_TRUE);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_BACK);
    if (shadow)
        parts.shadow_map.draw(casters, {&triangles, &glass_triangles}, camera.target, *shadow,
                              parts.meshes);

    target.bind();
    glEnable(GL_FRAMEBUFFER_SRGB);
    glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT); // the backdrop overwrites the colour
    if (parts.quality == Quality::plain && !covered.empty())
        hide(covered, target.size());
    // A shape's radius in pixels, or none when it is out of view.
    const glm::vec3 eye = camera.eye();
    const glm::vec2 widest = 1.0f + glm::abs(camera.centre);
    const float cos_x = 1 / std::hypot(1.0f, tangent * aspect * widest.x);
    const float cos_y = 1 / std::hypot(1.0f, tangent * widest.y);
    const auto pixels_of = [&](const DrawShape &shape) -> std::optional<float> {
        const glm::vec3 d = shape.position - eye;
        const float depth = glm::dot(d, forward);
        const float radius = bounding_radius(shape);
        const float x =
            std::abs(glm::dot(d, camera.right()) + camera.centre.x * depth * tangent * aspect);
        const float y = std::abs(glm::dot(d, camera.up()) + camera.centre.y * depth * tangent);
        // Outside a side of the view by more than the radius.
        if (depth < -radius || (x - depth * tangent * aspect) * cos_x > radius ||
            (y - depth * tangent) * cos_y > radius)
            return std::nullopt;
        const float nearest = std::max(depth - radius, relative.near_plane());
        const float pixels = 0.5f * size.y * shape.size.x / (tangent * nearest);
        // A fine wireframe would only be a blur.
        return list.view.wireframe ? std::min(pixels, 2 * least_sphere_step) : pixels;
    };
    parts.shape_program.use();
    glPolygonMode(GL_FRONT_AND_BACK, list.view.wireframe ? GL_LINE : GL_FILL);
    glUniform1f(parts.shape_program.uniform("glass"), 0);
    parts.meshes.draw(shape_batch(shapes, camera.target, pixels_of));
    glDisable(GL_CULL_FACE);
    parts.meshes.draw(triangles);
    glEnable(GL_CULL_FACE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);

    parts.draw_planes(list);
    glDisable(GL_CULL_FACE);
    draw_screen(parts.backdrop_program, parts.empty_array);
    if (list.view.occlusion && parts.quality == Quality::full && !list.view.wireframe && any_solid)
        parts.occlusion.draw(target);

    if (any_glass) {
        glEnable(GL_BLEND);
        glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
        glDepthMask(GL_FALSE);
        parts.shape_program.use();
        glUniform1f(parts.shape_program.uniform("glass"), 1);
        glPolygonMode(GL_FRONT_AND_BACK, list.view.wireframe ? GL_LINE : GL_FILL);
        parts.meshes.draw(glass_triangles);
        glEnable(GL_CULL_FACE);
        parts.meshes.draw(shape_batch(glass, camera.target, pixels_of));
        glDisable(GL_CULL_FACE);
        glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
        glDepthMask(GL_TRUE);
        glDisable(GL_BLEND);
    }

    const auto selected = [&](const DrawShape &shape) {
        return shape.selected ? pixels_of(shape) : std::nullopt;
    };
    shapes.insert(shapes.end(), glass.begin(), glass.end());
    const ShapeBatch outlined = shape_batch(shapes, camera.target, selected);
    if (!outlined.instances.empty())
        parts.draw_outlines(outlined);
    parts.marks.draw(list);
    parts.meshes.forget_unused();

    glDisable(GL_FRAMEBUFFER_SRGB);
    glDisable(GL_DEPTH_TEST);
    glBindVertexArray(0);
    target.resolve();
}

Image render_image(Renderer &renderer, const DrawList &list, glm::ivec2 size, int samples) {
    Framebuffer target(size, samples);
    renderer.draw(list, target);
    return target.read();
}

} // namespace plumb
