#include "app/render/shape_meshes.h"

#include <algorithm>
#include <cmath>

#include <glad/gl.h>

#include <glm/geometric.hpp>

#include "app/render/palette.h"
#include "app/render/vertex_input.h"
#include "engine/core/check.h"

namespace plumb {

namespace {

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
static_assert(mesh_count == shape_mesh_count);

// Screen radii, in pixels, from which the finer meshes are used: there the outline is off by less
// than a third of a pixel.
constexpr std::array<float, 3> sphere_steps{least_sphere_step, 36, 140};
constexpr std::array<float, 2> capsule_steps{12, 60};

// The shaders' kind for flat triangles, besides the shape kinds.
constexpr float mesh_kind = 4;

// Whether the mesh has two ends that are moved apart.
bool has_ends(DrawKind kind) {
    return kind == DrawKind::capsule || kind == DrawKind::cylinder;
}

glm::vec3 scale_of(const DrawShape &shape) {
    return shape.kind == DrawKind::box ? shape.size : glm::vec3(shape.size.x);
}

} // namespace

std::size_t mesh_for(const DrawShape &shape, float pixels) {
    const auto step = [&](const auto &steps) {
        return static_cast<std::size_t>(std::upper_bound(steps.begin(), steps.end(), pixels) -
                                        steps.begin());
    };
    switch (shape.kind) {
    case DrawKind::sphere:
        return sphere_0 + step(sphere_steps);
    case DrawKind::box:
        return box;
    case DrawKind::capsule:
        return capsule_0 + step(capsule_steps);
    case DrawKind::cylinder:
        return cylinder_0 + step(capsule_steps);
    }
    PLUMB_CHECK(false, "unknown kind of shape " << static_cast<int>(shape.kind));
}

ShapeInstance instance_of(const DrawShape &shape, const glm::vec3 &origin) {
    const glm::quat &q = shape.rotation;
    return {shape.position - origin,        has_ends(shape.kind) ? shape.size.y : 0,
            {q.x, q.y, q.z, q.w},           scale_of(shape),
            static_cast<float>(shape.kind), linear_from_srgb(shape.colour),
            shape.highlighted ? 1.0f : 0.0f};
}

TriangleBatch triangle_batch(const std::vector<DrawMesh> &meshes, const glm::vec3 &origin,
                             bool glass) {
    TriangleBatch batch;
    for (const DrawMesh &mesh : meshes)
        if (mesh.glass == glass && finite(mesh.position))
            batch.parts.push_back({mesh.corners, mesh.normals, mesh.position - origin,
                                   mesh.rotation, linear_from_srgb(mesh.colour),
                                   mesh.highlighted ? 1.0f : 0.0f});
    return batch;
}

ShapeMeshes::ShapeMeshes() {
    const std::array<Mesh, mesh_count> made{
        box_mesh(),        sphere_mesh(1),      sphere_mesh(2),      sphere_mesh(3),
        sphere_mesh(4),    capsule_mesh(12, 3), capsule_mesh(28, 7), capsule_mesh(64, 16),
        cylinder_mesh(12), cylinder_mesh(28),   cylinder_mesh(64)};
    std::vector<MeshVertex> vertices;
    std::vector<std::uint16_t> indices;
    for (std::size_t i = 0; i < mesh_count; ++i) {
        meshes_[i] = {indices.size() * sizeof(std::uint16_t),
                      static_cast<GLsizei>(made[i].indices.size()),
                      static_cast<GLint>(vertices.size())};
        vertices.insert(vertices.end(), made[i].vertices.begin(), made[i].vertices.end());
        indices.insert(indices.end(), made[i].indices.begin(), made[i].indices.end());
    }
    glGenVertexArrays(1, &shape_array_);
    glGenBuffers(1, &vertices_);
    glGenBuffers(1, &indices_);
    glBindVertexArray(shape_array_);
    upload(vertices_, std::as_bytes(std::span(vertices)));
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint16_t)), indices.data(),
                 GL_STATIC_DRAW);
    attribute(0, 3, sizeof(MeshVertex), offsetof(MeshVertex, position), 0);
    attribute(1, 3, sizeof(MeshVertex), offsetof(MeshVertex, normal), 0);
    attribute(2, 1, sizeof(MeshVertex), offsetof(MeshVertex, end), 0);
    glGenBuffers(1, &instances_);
    glGenVertexArrays(1, &triangle_array_);
}

ShapeMeshes::~ShapeMeshes() {
    for (const auto &[corners, kept] : triangles_)
        glDeleteBuffers(1, &kept.buffer);
    const std::array buffers{vertices_, indices_, instances_};
    glDeleteBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
    const std::array arrays{shape_array_, triangle_array_};
    glDeleteVertexArrays(static_cast<GLsizei>(arrays.size()), arrays.data());
}

void ShapeMeshes::draw(const ShapeBatch &batch) const {
    if (batch.instances.empty())
        return;
    glBindVertexArray(shape_array_);
    upload(instances_, std::as_bytes(std::span(batch.instances)));
    for (std::size_t mesh = 0; mesh < mesh_count; ++mesh) {
        const std::size_t count = batch.first[mesh + 1] - batch.first[mesh];
        if (count == 0)
            continue;
        // GL 3.3 has no base instance, so offset the attributes.
        const std::size_t base = batch.first[mesh] * sizeof(ShapeInstance);
        attribute(3, 4, sizeof(ShapeInstance), base + offsetof(ShapeInstance, position), 1);
        attribute(4, 4, sizeof(ShapeInstance), base + offsetof(ShapeInstance, rotation), 1);
        attribute(5, 4, sizeof(ShapeInstance), base + offsetof(ShapeInstance, scale), 1);
        attribute(6, 4, sizeof(ShapeInstance), base + offsetof(ShapeInstance, colour), 1);
        glDrawElementsInstancedBaseVertex(GL_TRIANGLES, meshes_[mesh].index_count,
                                          GL_UNSIGNED_SHORT, byte_offset(meshes_[mesh].first_index),
                                          static_cast<GLsizei>(count), meshes_[mesh].first_vertex);
    }
}

const ShapeMeshes::Triangles &ShapeMeshes::triangles_of(const TriangleBatch::Part &part) const {
    const std::shared_ptr<const Corners> &corners = part.corners;
    PLUMB_CHECK(!part.normals || part.normals->size() == corners->size(),
                part.normals->size() << " normals for " << corners->size() << " corners");
    Triangles &kept = triangles_[corners.get()];
    if (kept.corners.lock() == corners)
        return kept;
    if (kept.buffer == 0) // else reuse the buffer of old corners at this address
        glGenBuffers(1, &kept.buffer);
    std::vector<MeshVertex> vertices;
    for (std::size_t i = 0; i + 2 < corners->size(); i += 3) {
        const std::array three{(*corners)[i], (*corners)[i + 1], (*corners)[i + 2]};
        const glm::vec3 across = glm::cross(three[1] - three[0], three[2] - three[0]);
        const float twice_area = glm::length(across);
        if (!(twice_area > 0) || !std::isfinite(twice_area))
            continue;
        for (std::size_t k = 0; k < three.size(); ++k)
            vertices.push_back(
                {three[k], part.normals ? (*part.normals)[i + k] : across / twice_area, 0});
    }
    upload(kept.buffer, std::as_bytes(std::span(vertices)));
    kept.corners = corners;
    kept.count = static_cast<int>(vertices.size());
    return kept;
}

void ShapeMeshes::forget_unused() {
    for (auto kept = triangles_.begin(); kept != triangles_.end();)
        if (kept->second.corners.expired()) {
            glDeleteBuffers(1, &kept->second.buffer);
            kept = triangles_.erase(kept);
        } else {
            ++kept;
        }
}

void ShapeMeshes::draw(const TriangleBatch &batch) const {
    glBindVertexArray(triangle_array_);
    glVertexAttrib4f(5, 1, 1, 1, mesh_kind);
    for (const TriangleBatch::Part &part : batch.parts) {
        const Triangles &triangles = triangles_of(part);
        if (triangles.count == 0)
            continue;
        glBindBuffer(GL_ARRAY_BUFFER, triangles.buffer);
        attribute(0, 3, sizeof(MeshVertex), offsetof(MeshVertex, position), 0);
        attribute(1, 3, sizeof(MeshVertex), offsetof(MeshVertex, normal), 0);
        attribute(2, 1, sizeof(MeshVertex), offsetof(MeshVertex, end), 0);
        glVertexAttrib4f(3, part.position.x, part.position.y, part.position.z, 0);
        const glm::quat &q = part.rotation;
        glVertexAttrib4f(4, q.x, q.y, q.z, q.w);
        glVertexAttrib4f(6, part.colour.r, part.colour.g, part.colour.b, part.highlight);
        glDrawArrays(GL_TRIANGLES, 0, triangles.count);
    }
}

} // namespace plumb
