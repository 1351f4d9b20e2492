#include "app/render/renderer.h"

#include <algorithm>
#include <array>
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
#include "app/render/mesh.h"
#include "app/render/palette.h"
#include "app/render/shader_program.h"
#include "app/render/shadow_fit.h"
#include "engine/core/check.h"

namespace plumb {

namespace {

constexpr int shadow_map_size = 2048;
constexpr GLuint frame_binding = 0;
// Texture units.
constexpr GLuint shadow_unit = 1;
constexpr GLuint depth_unit = 2;
constexpr GLuint occlusion_unit = 3;

constexpr float outline_width = 3; // pixels

// The uniform block `Frame` of frame.glsl, std140. Positions in shaders are relative to the
// camera's target, which keeps them small however far the scene is from the origin.
struct FrameBlock {
    glm::mat4 projection;
    glm::mat4 view;
    glm::mat4 shadow;
    glm::vec4 eye;      // xyz; w: the camera's distance
    glm::vec4 to_light; // xyz unit; w: intensity
    glm::vec4 viewport; // width, height, tan of half the field of view across and up
    glm::vec4 light; // ambient; shadow texel in metres; shadow texel in texture units; shadows on
    glm::vec4 range; // near, far; edges on; metres to a pixel at unit depth
};

struct Instance {
    glm::vec3 position; // relative to the camera's target
    float end;          // a capsule's or cylinder's half height
    glm::vec4 rotation; // x, y, z, w
    glm::vec3 scale;
    float kind;
    glm::vec3 colour; // linear
    float highlight;
};

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

enum MeshName : std::size_t {
    box,
    sphere_0,
    sphere_1,
    sphere_2,
    sphere_3,
    capsule_0,
    capsule_1,
    capsule_2,
    cylinder_0,
    cylinder_1,
    cylinder_2,
    mesh_count
};

// Radii on the screen, in pixels, from which the finer meshes are drawn: there the outline is off
// by less than a third of a pixel.
constexpr std::array<float, 3> sphere_steps{9, 36, 140};
constexpr std::array<float, 2> capsule_steps{12, 60};

float linear_from_srgb(float s) {
    s = std::clamp(s, 0.0f, 1.0f);
    return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
}

glm::vec3 linear_from_srgb(const glm::vec3 &s) {
    return {linear_from_srgb(s.x), linear_from_srgb(s.y), linear_from_srgb(s.z)};
}

bool finite(const glm::vec3 &v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool finite(const DrawShape &shape) {
    const glm::quat &q = shape.rotation;
    return finite(shape.position) && finite(shape.size) && finite(glm::vec3(q.x, q.y, q.z)) &&
           std::isfinite(q.w);
}

// Their meshes have two ends, which are moved apart.
bool has_ends(DrawKind kind) {
    return kind == DrawKind::capsule || kind == DrawKind::cylinder;
}

glm::vec3 scale_of(const DrawShape &shape) {
    return shape.kind == DrawKind::box ? shape.size : glm::vec3(shape.size.x);
}

MeshName mesh_for(const DrawShape &shape, float pixels) {
    const auto step = [&](const auto &steps) {
        return static_cast<std::size_t>(std::upper_bound(steps.begin(), steps.end(), pixels) -
                                        steps.begin());
    };
    switch (shape.kind) {
    case DrawKind::sphere:
        return static_cast<MeshName>(sphere_0 + step(sphere_steps));
    case DrawKind::box:
        return box;
    case DrawKind::capsule:
        return static_cast<MeshName>(capsule_0 + step(capsule_steps));
    case DrawKind::cylinder:
        return static_cast<MeshName>(cylinder_0 + step(capsule_steps));
    }
    PLUMB_CHECK(false, "unknown kind of shape " << static_cast<int>(shape.kind));
}

const void *byte_offset(std::size_t bytes) {
    return reinterpret_cast<const void *>(bytes);
}

// What a vertex attribute reads: one for each instance, or for each vertex.
void attribute(GLuint index, GLint components, std::size_t stride, std::size_t offset,
               GLuint divisor) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, components, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                          byte_offset(offset));
    glVertexAttribDivisor(index, divisor);
}

template <class T> void upload(GLuint buffer, const std::vector<T> &values) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(values.size() * sizeof(T)), values.data(),
                 GL_STREAM_DRAW);
}

// What shaders take flat triangles for, beside the kinds of shapes.
constexpr float mesh_kind = 4;

// All meshes that are glass, or all that are not: their triangles one after the other.
struct MeshBatch {
    std::vector<MeshVertex> vertices; // relative to the camera's target
    struct Part {
        GLint first = 0;
        GLsizei count = 0;
        glm::vec3 colour{0}; // linear
    };
    std::vector<Part> parts;
};

MeshBatch mesh_batch(const std::vector<DrawMesh> &meshes, const glm::vec3 &origin, bool glass) {
    MeshBatch batch;
    for (const DrawMesh &mesh : meshes) {
        if (mesh.glass != glass)
            continue;
        const std::size_t first = batch.vertices.size();
        for (std::size_t i = 0; i + 2 < mesh.corners.size(); i += 3) {
            const std::array corners{mesh.corners[i], mesh.corners[i + 1], mesh.corners[i + 2]};
            const glm::vec3 across = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
            const float twice_area = glm::length(across);
            if (!(twice_area > 0) || !std::isfinite(twice_area))
                continue;
            for (const glm::vec3 &corner : corners)
                batch.vertices.push_back({corner - origin, across / twice_area, 0});
        }
        const std::size_t count = batch.vertices.size() - first;
        if (count > 0)
            batch.parts.push_back({static_cast<GLint>(first), static_cast<GLsizei>(count),
                                   linear_from_srgb(mesh.colour)});
    }
    return batch;
}

// The box around a mesh, for whoever asks how far things reach.
DrawShape box_around(const DrawMesh &mesh) {
    glm::vec3 low(std::numeric_limits<float>::max());
    glm::vec3 high(std::numeric_limits<float>::lowest());
    for (const glm::vec3 &corner : mesh.corners) {
        low = glm::min(low, corner);
        high = glm::max(high, corner);
    }
    DrawShape box;
    box.kind = DrawKind::box;
    box.position = 0.5f * (low + high);
    box.size = 0.5f * (high - low);
    return box;
}

// The shapes of one pass, sorted by mesh.
struct Batch {
    std::vector<Instance> instances;
    std::array<std::size_t, mesh_count + 1> first{};
};

} // namespace

struct Renderer::Parts {
    ShaderProgram shape_program;
    ShaderProgram shadow_program;
    ShaderProgram outline_program;
    ShaderProgram plane_program;
    ShaderProgram backdrop_program;
    ShaderProgram line_program;
    ShaderProgram point_program;
    ShaderProgram occlusion_program;
    ShaderProgram smooth_program;
    ShaderProgram apply_program;

    struct MeshRange {
        std::size_t first_index = 0; // in bytes
        GLsizei index_count = 0;
        GLint first_vertex = 0;
    };
    std::array<MeshRange, mesh_count> meshes;
    GLuint mesh_vertices = 0;
    GLuint mesh_indices = 0;
    GLuint instances = 0;
    GLuint shape_array = 0;
    GLuint mesh_array = 0;
    GLuint mesh_stream = 0;
    GLuint line_array = 0;
    GLuint point_array = 0;
    GLuint empty_array = 0;
    GLuint frame_buffer = 0;
    GLuint shadow_texture = 0;
    GLuint shadow_target = 0;
    // Occlusion: a copy of the scene's depth at full size; two pictures of half the size.
    glm::ivec2 occlusion_size{0}; // of the scene
    GLuint depth_texture = 0;
    GLuint depth_target = 0;
    std::array<GLuint, 2> occlusion_textures{};
    std::array<GLuint, 2> occlusion_targets{};
    Culling culling;

    explicit Parts(const std::filesystem::path &dir)
        : shape_program(dir, "shape.vert", "shape.frag"),
          shadow_program(dir, "shadow.vert", "shadow.frag"),
          outline_program(dir, "outline.vert", "outline.frag"),
          plane_program(dir, "plane.vert", "plane.frag"),
          backdrop_program(dir, "screen.vert", "backdrop.frag"),
          line_program(dir, "line.vert", "line.frag"),
          point_program(dir, "point.vert", "point.frag"),
          occlusion_program(dir, "screen.vert", "occlusion.frag"),
          smooth_program(dir, "screen.vert", "occlusion_smooth.frag"),
          apply_program(dir, "screen.vert", "occlusion_apply.frag") {
        for (const ShaderProgram *program :
             {&shape_program, &shadow_program, &outline_program, &plane_program, &backdrop_program,
              &line_program, &point_program, &occlusion_program, &smooth_program, &apply_program}) {
            program->bind_block("Frame", frame_binding);
            program->bind_sampler("shadow_map", static_cast<int>(shadow_unit));
            program->bind_sampler("depth_map", static_cast<int>(depth_unit));
            program->bind_sampler("occlusion_map", static_cast<int>(occlusion_unit));
        }
        make_meshes();
        glGenBuffers(1, &instances);
        glGenBuffers(1, &mesh_stream);
        glGenBuffers(1, &frame_buffer);
        glGenVertexArrays(1, &mesh_array);
        glGenVertexArrays(1, &line_array);
        glGenVertexArrays(1, &point_array);
        glGenVertexArrays(1, &empty_array);
        glBindBuffer(GL_UNIFORM_BUFFER, frame_buffer);
        glBufferData(GL_UNIFORM_BUFFER, sizeof(FrameBlock), nullptr, GL_STREAM_DRAW);
        make_shadow_map();
    }

    ~Parts() {
        const std::array buffers{mesh_vertices, mesh_indices, instances, mesh_stream, frame_buffer};
        glDeleteBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
        const std::array arrays{shape_array, mesh_array, line_array, point_array, empty_array};
        glDeleteVertexArrays(static_cast<GLsizei>(arrays.size()), arrays.data());
        glDeleteFramebuffers(1, &shadow_target);
        glDeleteTextures(1, &shadow_texture);
        delete_occlusion();
    }
    Parts(const Parts &) = delete;
    Parts &operator=(const Parts &) = delete;

    void make_meshes() {
        const std::array<Mesh, mesh_count> made{
            box_mesh(),        sphere_mesh(1),      sphere_mesh(2),      sphere_mesh(3),
            sphere_mesh(4),    capsule_mesh(12, 3), capsule_mesh(28, 7), capsule_mesh(64, 16),
            cylinder_mesh(12), cylinder_mesh(28),   cylinder_mesh(64)};
        std::vector<MeshVertex> vertices;
        std::vector<std::uint16_t> indices;
        for (std::size_t i = 0; i < mesh_count; ++i) {
            meshes[i] = {indices.size() * sizeof(std::uint16_t),
                         static_cast<GLsizei>(made[i].indices.size()),
                         static_cast<GLint>(vertices.size())};
            vertices.insert(vertices.end(), made[i].vertices.begin(), made[i].vertices.end());
            indices.insert(indices.end(), made[i].indices.begin(), made[i].indices.end());
        }
        glGenVertexArrays(1, &shape_array);
        glGenBuffers(1, &mesh_vertices);
        glGenBuffers(1, &mesh_indices);
        glBindVertexArray(shape_array);
        upload(mesh_vertices, vertices);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh_indices);
        glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                     static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint16_t)),
                     indices.data(), GL_STATIC_DRAW);
        attribute(0, 3, sizeof(MeshVertex), offsetof(MeshVertex, position), 0);
        attribute(1, 3, sizeof(MeshVertex), offsetof(MeshVertex, normal), 0);
        attribute(2, 1, sizeof(MeshVertex), offsetof(MeshVertex, end), 0);
    }

    void make_shadow_map() {
        glGenTextures(1, &shadow_texture);
        glActiveTexture(GL_TEXTURE0 + shadow_unit);
        glBindTexture(GL_TEXTURE_2D, shadow_texture);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, shadow_map_size, shadow_map_size, 0,
                     GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, nullptr);
        // Linear filtering of comparisons; outside the map everything is lit.
        const std::array<float, 4> lit{1, 1, 1, 1};
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
        glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, lit.data());
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
        glGenFramebuffers(1, &shadow_target);
        glBindFramebuffer(GL_FRAMEBUFFER, shadow_target);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, shadow_texture,
                               0);
        glDrawBuffer(GL_NONE);
        glReadBuffer(GL_NONE);
    }

    void delete_occlusion() {
        glDeleteFramebuffers(1, &depth_target);
        glDeleteTextures(1, &depth_texture);
        glDeleteFramebuffers(2, occlusion_targets.data());
        glDeleteTextures(2, occlusion_textures.data());
    }

    void size_occlusion(glm::ivec2 size) {
        if (size == occlusion_size)
            return;
        delete_occlusion();
        occlusion_size = size;
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
        // The format of a Framebuffer's own depth, as a copy needs.
        make(depth_texture, depth_target, GL_DEPTH_STENCIL_ATTACHMENT, GL_DEPTH24_STENCIL8, size,
             GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8);
        glDrawBuffer(GL_NONE);
        glReadBuffer(GL_NONE);
        // Occlusion, and the depth in metres that it belongs to.
        for (std::size_t i = 0; i < 2; ++i)
            make(occlusion_textures[i], occlusion_targets[i], GL_COLOR_ATTACHMENT0, GL_RG32F,
                 (size + 1) / 2, GL_RG, GL_FLOAT);
    }

    // Sorts shapes by mesh; `pixels_of` gives the radius on the target in pixels, or none to leave
    // a shape out.
    template <class PixelsOf>
    static Batch make_batch(const std::vector<DrawShape> &shapes, const glm::vec3 &origin,
                            const PixelsOf &pixels_of) {
        constexpr std::uint8_t left_out = 255;
        std::vector<std::uint8_t> names(shapes.size(), left_out);
        Batch batch;
        for (std::size_t i = 0; i < shapes.size(); ++i) {
            const std::optional<float> pixels = pixels_of(shapes[i]);
            if (!pixels)
                continue;
            names[i] = static_cast<std::uint8_t>(mesh_for(shapes[i], *pixels));
            ++batch.first[names[i] + std::size_t{1}];
        }
        for (std::size_t name = 0; name < mesh_count; ++name)
            batch.first[name + 1] += batch.first[name];
        batch.instances.resize(batch.first[mesh_count]);
        std::array<std::size_t, mesh_count + 1> next = batch.first;
        for (std::size_t i = 0; i < shapes.size(); ++i) {
            if (names[i] == left_out)
                continue;
            const DrawShape &shape = shapes[i];
            const glm::quat &q = shape.rotation;
            batch.instances[next[names[i]]++] = {
                shape.position - origin,        has_ends(shape.kind) ? shape.size.y : 0,
                {q.x, q.y, q.z, q.w},           scale_of(shape),
                static_cast<float>(shape.kind), linear_from_srgb(shape.colour),
                shape.highlighted ? 1.0f : 0.0f};
        }
        return batch;
    }

    void draw_batch(const Batch &batch) const {
        if (batch.instances.empty())
            return;
        glBindVertexArray(shape_array);
        upload(instances, batch.instances);
        for (std::size_t name = 0; name < mesh_count; ++name) {
            const std::size_t count = batch.first[name + 1] - batch.first[name];
            if (count == 0)
                continue;
            // GL 3.3 has no first instance: the attributes are pointed there.
            const std::size_t base = batch.first[name] * sizeof(Instance);
            attribute(3, 4, sizeof(Instance), base + offsetof(Instance, position), 1);
            attribute(4, 4, sizeof(Instance), base + offsetof(Instance, rotation), 1);
            attribute(5, 4, sizeof(Instance), base + offsetof(Instance, scale), 1);
            attribute(6, 4, sizeof(Instance), base + offsetof(Instance, colour), 1);
            glDrawElementsInstancedBaseVertex(
                GL_TRIANGLES, meshes[name].index_count, GL_UNSIGNED_SHORT,
                byte_offset(meshes[name].first_index), static_cast<GLsizei>(count),
                meshes[name].first_vertex);
        }
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

    // The program in use reads the same attributes as for shapes: those of an instance are
    // constant.
    void draw_meshes(const MeshBatch &batch) const {
        if (batch.parts.empty())
            return;
        glBindVertexArray(mesh_array);
        upload(mesh_stream, batch.vertices);
        attribute(0, 3, sizeof(MeshVertex), offsetof(MeshVertex, position), 0);
        attribute(1, 3, sizeof(MeshVertex), offsetof(MeshVertex, normal), 0);
        attribute(2, 1, sizeof(MeshVertex), offsetof(MeshVertex, end), 0);
        glVertexAttrib4f(3, 0, 0, 0, 0);
        glVertexAttrib4f(4, 0, 0, 0, 1);
        glVertexAttrib4f(5, 1, 1, 1, mesh_kind);
        for (const MeshBatch::Part &part : batch.parts) {
            glVertexAttrib4f(6, part.colour.r, part.colour.g, part.colour.b, 0);
            glDrawArrays(GL_TRIANGLES, part.first, part.count);
        }
    }

    void draw_screen(const ShaderProgram &program) const {
        program.use();
        glBindVertexArray(empty_array);
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }

    void draw_shadows(const std::vector<DrawShape> &shapes,
                      const std::array<const MeshBatch *, 2> &flat_triangles, const DrawList &list,
                      const ShadowFit &fit) const {
        glBindFramebuffer(GL_FRAMEBUFFER, shadow_target);
        glViewport(0, 0, shadow_map_size, shadow_map_size);
        glClear(GL_DEPTH_BUFFER_BIT);
        glEnable(GL_POLYGON_OFFSET_FILL);
        glPolygonOffset(2.0f, 4.0f);
        // What is nearer to the light than the map's near end still throws its shadow.
        glEnable(GL_DEPTH_CLAMP);
        shadow_program.use();
        draw_batch(make_batch(shapes, list.camera.target, [&](const DrawShape &shape) {
            const glm::vec3 at = shape.position - list.camera.target;
            const glm::vec4 centre = fit.texture_from_relative * glm::vec4(at, 1);
            const float metres = bounding_radius(shape);
            const float radius = metres / (fit.texel * static_cast<float>(shadow_map_size));
            const bool outside = centre.x < -radius || centre.x > 1 + radius ||
                                 centre.y < -radius || centre.y > 1 + radius;
            // A quarter of the texels: a shadow's edge is soft.
            return outside ? std::nullopt : std::optional<float>(0.25f * shape.size.x / fit.texel);
        }));
        glDisable(GL_CULL_FACE);
        for (const MeshBatch *batch : flat_triangles)
            draw_meshes(*batch);
        glEnable(GL_CULL_FACE);
        glDisable(GL_DEPTH_CLAMP);
        glDisable(GL_POLYGON_OFFSET_FILL);
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
            // The plane's own x and z, and where the camera's target stands on them: the grid's
            // lines repeat every ten metres, so only the rest matters.
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

    void draw_occlusion(const Framebuffer &target) {
        const glm::ivec2 size = target.size();
        size_occlusion(size);
        glBindFramebuffer(GL_READ_FRAMEBUFFER, target.draw_name());
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, depth_target);
        glBlitFramebuffer(0, 0, size.x, size.y, 0, 0, size.x, size.y, GL_DEPTH_BUFFER_BIT,
                          GL_NEAREST);
        glDisable(GL_DEPTH_TEST);
        const glm::ivec2 half = (size + 1) / 2;
        glViewport(0, 0, half.x, half.y);
        glActiveTexture(GL_TEXTURE0 + depth_unit);
        glBindTexture(GL_TEXTURE_2D, depth_texture);
        glActiveTexture(GL_TEXTURE0 + occlusion_unit);
        glBindFramebuffer(GL_FRAMEBUFFER, occlusion_targets[0]);
        draw_screen(occlusion_program);
        glBindTexture(GL_TEXTURE_2D, occlusion_textures[0]);
        glBindFramebuffer(GL_FRAMEBUFFER, occlusion_targets[1]);
        draw_screen(smooth_program);
        glBindTexture(GL_TEXTURE_2D, occlusion_textures[1]);
        target.bind();
        glEnable(GL_BLEND);
        glBlendFunc(GL_ZERO, GL_SRC_COLOR); // what is there, times what comes
        draw_screen(apply_program);
        glDisable(GL_BLEND);
        glEnable(GL_DEPTH_TEST);
    }

    // A ring around the picture of what is selected, seen through whatever hides it: where a
    // slightly larger copy covers and the shapes themselves do not.
    void draw_outlines(const Batch &batch) const {
        outline_program.use();
        const glm::vec3 colour = linear_from_srgb(colours::selected);
        const auto draw = [&](float width) {
            glUniform4f(outline_program.uniform("accent"), colour.r, colour.g, colour.b, width);
            draw_batch(batch);
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

    // Lines and points, once faintly where something hides them, once in full.
    void draw_marks(const DrawList &list) const {
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
                add(point.position, point.position + point.normal, point.colour,
                    0.5f * point.radius);
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
                line_program.use();
                glUniform1f(line_program.uniform("opacity"), pass.opacity);
                glBindVertexArray(line_array);
                upload(instances, lines);
                attribute(0, 4, sizeof(LineInstance), offsetof(LineInstance, a), 1);
                attribute(1, 4, sizeof(LineInstance), offsetof(LineInstance, b), 1);
                attribute(2, 3, sizeof(LineInstance), offsetof(LineInstance, colour), 1);
                glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(lines.size()));
            }
            if (!points.empty()) {
                point_program.use();
                glUniform1f(point_program.uniform("opacity"), pass.opacity);
                glBindVertexArray(point_array);
                upload(instances, points);
                attribute(0, 4, sizeof(PointInstance), offsetof(PointInstance, position), 1);
                attribute(1, 3, sizeof(PointInstance), offsetof(PointInstance, colour), 1);
                glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(points.size()));
            }
        }
        glDepthFunc(GL_LEQUAL);
        glDepthMask(GL_TRUE);
        glDisable(GL_BLEND);
    }
};

Renderer::Renderer(const std::filesystem::path &shader_dir)
    : parts_(std::make_unique<Parts>(shader_dir)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer &&) noexcept = default;
Renderer &Renderer::operator=(Renderer &&) noexcept = default;

void Renderer::draw(const DrawList &list, Framebuffer &target) {
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
        if (finite(shape))
            (shape.glass ? glass : shapes).push_back(shape);
    const MeshBatch meshes = mesh_batch(list.meshes, camera.target, false);
    const MeshBatch glass_meshes = mesh_batch(list.meshes, camera.target, true);
    const bool any_solid = !shapes.empty() || !meshes.parts.empty();
    const bool any_glass = !glass.empty() || !glass_meshes.parts.empty();

    std::optional<ShadowFit> shadow;
    std::vector<DrawShape> casters;
    if (list.view.shadows && list.light.intensity > 0 && (any_solid || any_glass)) {
        casters = shapes;
        casters.insert(casters.end(), glass.begin(), glass.end());
        std::vector<DrawShape> reaching = casters;
        for (const DrawMesh &mesh : list.meshes)
            if (const DrawShape box = box_around(mesh); finite(box))
                reaching.push_back(box);
        shadow = fit_shadow(reaching, camera, aspect, list.light.direction, camera.target,
                            shadow_map_size);
    }
    // What is out of view throws shadows, but need not be sorted or looked at again.
    if (shapes.size() >= least_shapes_to_cull)
        parts.keep_in_view(shapes, camera, aspect);

    // Near before far, so that what is hidden is not shaded.
    const glm::vec3 forward = camera.forward();
    std::stable_sort(shapes.begin(), shapes.end(), [&](const DrawShape &a, const DrawShape &b) {
        return glm::dot(a.position - camera.target, forward) <
               glm::dot(b.position - camera.target, forward);
    });

    // What is hidden by glass is seen: far before near.
    std::stable_sort(glass.begin(), glass.end(), [&](const DrawShape &a, const DrawShape &b) {
        return glm::dot(a.position - camera.target, forward) >
               glm::dot(b.position - camera.target, forward);
    });

    Camera relative = camera;
    relative.target = glm::vec3(0);
    const float tangent = std::tan(0.5f * camera.fov);
    FrameBlock frame{};
    frame.projection = relative.projection(aspect);
    frame.view = relative.view();
    frame.shadow = shadow ? shadow->texture_from_relative : glm::mat4(1);
    frame.eye = glm::vec4(relative.eye(), camera.distance);
    frame.to_light = glm::vec4(-glm::normalize(list.light.direction), list.light.intensity);
    frame.viewport = {size, tangent * aspect, tangent};
    frame.light = {list.light.ambient, shadow ? shadow->texel : 0.0f,
                   1.0f / static_cast<float>(shadow_map_size), shadow ? 1.0f : 0.0f};
    frame.range = {relative.near_plane(), relative.far_plane(), list.view.edges ? 1.0f : 0.0f,
                   2 * tangent / size.y};
    glBindBuffer(GL_UNIFORM_BUFFER, parts.frame_buffer);
    glBufferData(GL_UNIFORM_BUFFER, sizeof(frame), &frame, GL_STREAM_DRAW);
    glBindBufferBase(GL_UNIFORM_BUFFER, frame_binding, parts.frame_buffer);
    glActiveTexture(GL_TEXTURE0 + shadow_unit);
    glBindTexture(GL_TEXTURE_2D, parts.shadow_texture);

    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_TRUE);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_BACK);
    if (shadow)
        parts.draw_shadows(casters, {&meshes, &glass_meshes}, list, *shadow);

    target.bind();
    glEnable(GL_FRAMEBUFFER_SRGB);
    glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT); // the backdrop covers what colour is left
    // In view, and how large.
    const glm::vec3 eye = camera.eye();
    const float cos_x = 1 / std::hypot(1.0f, tangent * aspect);
    const float cos_y = 1 / std::hypot(1.0f, tangent);
    const auto pixels_of = [&](const DrawShape &shape) -> std::optional<float> {
        const glm::vec3 d = shape.position - eye;
        const float depth = glm::dot(d, forward);
        const float radius = bounding_radius(shape);
        const float x = std::abs(glm::dot(d, camera.right()));
        const float y = std::abs(glm::dot(d, camera.up()));
        // Beyond a side of the view by more than the radius.
        if (depth < -radius || (x - depth * tangent * aspect) * cos_x > radius ||
            (y - depth * tangent) * cos_y > radius)
            return std::nullopt;
        const float nearest = std::max(depth - radius, relative.near_plane());
        const float pixels = 0.5f * size.y * shape.size.x / (tangent * nearest);
        // A fine net of wires would only be a blur.
        return list.view.wireframe ? std::min(pixels, 2 * sphere_steps[0]) : pixels;
    };
    parts.shape_program.use();
    glPolygonMode(GL_FRONT_AND_BACK, list.view.wireframe ? GL_LINE : GL_FILL);
    glUniform1f(parts.shape_program.uniform("glass"), 0);
    parts.draw_batch(Parts::make_batch(shapes, camera.target, pixels_of));
    glDisable(GL_CULL_FACE);
    parts.draw_meshes(meshes);
    glEnable(GL_CULL_FACE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);

    parts.draw_planes(list);
    glDisable(GL_CULL_FACE);
    parts.draw_screen(parts.backdrop_program);
    if (list.view.occlusion && !list.view.wireframe && any_solid)
        parts.draw_occlusion(target);

    if (any_glass) {
        glEnable(GL_BLEND);
        glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
        glDepthMask(GL_FALSE);
        parts.shape_program.use();
        glUniform1f(parts.shape_program.uniform("glass"), 1);
        glPolygonMode(GL_FRONT_AND_BACK, list.view.wireframe ? GL_LINE : GL_FILL);
        parts.draw_meshes(glass_meshes);
        glEnable(GL_CULL_FACE);
        parts.draw_batch(Parts::make_batch(glass, camera.target, pixels_of));
        glDisable(GL_CULL_FACE);
        glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
        glDepthMask(GL_TRUE);
        glDisable(GL_BLEND);
    }

    const auto selected = [&](const DrawShape &shape) {
        return shape.selected ? pixels_of(shape) : std::nullopt;
    };
    shapes.insert(shapes.end(), glass.begin(), glass.end());
    const Batch outlined = Parts::make_batch(shapes, camera.target, selected);
    if (!outlined.instances.empty())
        parts.draw_outlines(outlined);
    parts.draw_marks(list);

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
