// The shapes and triangles of a pass, batched for the GPU, and the meshes they are drawn with.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "app/render/draw_list.h"
#include "app/render/mesh.h"

namespace plumb {

inline constexpr std::size_t shape_mesh_count = 11;

// Which mesh to use for a shape whose radius on the target is `pixels`.
std::size_t mesh_for(const DrawShape &shape, float pixels);
// Below this radius, in pixels, shapes are drawn with the coarsest mesh.
inline constexpr float least_sphere_step = 9;

struct ShapeInstance {
    glm::vec3 position; // relative to the camera's target
    float end;          // a capsule's or cylinder's half height
    glm::vec4 rotation; // x, y, z, w
    glm::vec3 scale;
    float kind;
    glm::vec3 colour; // linear
    float highlight;
};
ShapeInstance instance_of(const DrawShape &shape, const glm::vec3 &origin);

// The shapes of one pass sorted by mesh, and where each mesh's shapes begin.
struct ShapeBatch {
    std::vector<ShapeInstance> instances;
    std::array<std::size_t, shape_mesh_count + 1> first{};
};

// Sorts shapes by mesh; `pixels_of` gives the radius on the target in pixels, or none to skip a
// shape.
template <class PixelsOf>
ShapeBatch shape_batch(std::span<const DrawShape> shapes, const glm::vec3 &origin,
                       const PixelsOf &pixels_of) {
    constexpr std::uint8_t left_out = 255;
    std::vector<std::uint8_t> meshes(shapes.size(), left_out);
    ShapeBatch batch;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        const std::optional<float> pixels = pixels_of(shapes[i]);
        if (!pixels)
            continue;
        meshes[i] = static_cast<std::uint8_t>(mesh_for(shapes[i], *pixels));
        ++batch.first[meshes[i] + std::size_t{1}];
    }
    for (std::size_t mesh = 0; mesh < shape_mesh_count; ++mesh)
        batch.first[mesh + 1] += batch.first[mesh];
    batch.instances.resize(batch.first[shape_mesh_count]);
    std::array<std::size_t, shape_mesh_count + 1> next = batch.first;
    for (std::size_t i = 0; i < shapes.size(); ++i)
        if (meshes[i] != left_out)
            batch.instances[next[meshes[i]]++] = instance_of(shapes[i], origin);
    return batch;
}

// All glass meshes, or all others.
struct TriangleBatch {
    struct Part {
        std::shared_ptr<const Corners> corners, normals;
        glm::vec3 position{0}; // relative to the camera's target
        glm::quat rotation{1, 0, 0, 0};
        glm::vec3 colour{0}; // linear
        float highlight = 0;
    };
    std::vector<Part> parts;
};
TriangleBatch triangle_batch(const std::vector<DrawMesh> &meshes, const glm::vec3 &origin,
                             bool glass);

class ShapeMeshes {
  public:
    ShapeMeshes();
    ~ShapeMeshes();
    ShapeMeshes(const ShapeMeshes &) = delete;
    ShapeMeshes &operator=(const ShapeMeshes &) = delete;

    // The program must be in use. It reads the same attributes for both; for triangles, the
    // instance attributes are constant.
    void draw(const ShapeBatch &batch) const;
    void draw(const TriangleBatch &batch) const;

    // Once a frame: frees what was kept for corners that no longer exist.
    void forget_unused();

  private:
    struct Triangles {
        std::weak_ptr<const Corners> corners;
        unsigned buffer = 0;
        int count = 0; // of vertices
    };
    const Triangles &triangles_of(const TriangleBatch::Part &part) const;

    struct Range {
        std::size_t first_index = 0; // in bytes
        int index_count = 0;
        int first_vertex = 0;
    };
    std::array<Range, shape_mesh_count> meshes_;
    unsigned vertices_ = 0;
    unsigned indices_ = 0;
    unsigned instances_ = 0;
    unsigned shape_array_ = 0;
    unsigned triangle_array_ = 0;
    mutable std::map<const Corners *, Triangles> triangles_; // kept from frame to frame
};

} // namespace plumb
