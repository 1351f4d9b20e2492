// The renderer's input: a flat list of values. Poses in metres, colours in sRGB 0..1.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "app/render/camera.h"

namespace plumb {

inline bool finite(const glm::vec3 &v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

enum class DrawKind : std::uint8_t { sphere, box, capsule, cylinder };

struct DrawShape {
    DrawKind kind = DrawKind::sphere;
    glm::vec3 position{0};
    glm::quat rotation{1, 0, 0, 0}; // unit
    // sphere: x is the radius. box: half extents. capsule and cylinder: x is the radius, y the half
    // height of the cylinder, along the shape's y axis. The other components are not read.
    glm::vec3 size{0.5f};
    glm::vec3 colour{0.7f};
    bool selected = false;    // a ring in the accent colour, even when hidden
    bool highlighted = false; // brightened: under the pointer
    bool glass = false;       // things behind or inside show through
};

// Triangles, three corners each, in their own frame.
using Corners = std::vector<glm::vec3>;

// Visible from both sides. The renderer caches what it makes of the corners as long as they live,
// so they must not change, and lists that show the same corners share them.
struct DrawMesh {
    std::shared_ptr<const Corners> corners; // never null
    // Unit, one per corner, on the triangle's front side, for smooth shading. Cached and shared
    // like the corners. Null: flat shading.
    std::shared_ptr<const Corners> normals{};
    glm::vec3 position{0};
    glm::quat rotation{1, 0, 0, 0}; // unit
    glm::vec3 colour{0.7f};
    bool highlighted = false;
    bool glass = false;
};

// The solid half-space y <= 0 of its own frame, seen from above; its top carries the grid.
struct DrawPlane {
    glm::vec3 position{0};
    glm::quat rotation{1, 0, 0, 0}; // unit
};

struct DrawLine {
    glm::vec3 a{0};
    glm::vec3 b{0}; // a line of no length becomes a dot as wide as the line
    glm::vec3 colour{0.2f};
    float width = 2; // pixels
};

// A marker of fixed screen size, with a stalk along its normal.
struct DrawPoint {
    glm::vec3 position{0};
    glm::vec3 normal{0}; // the stalk as a vector in metres; zero: none
    glm::vec3 colour{0.8f, 0.2f, 0.2f};
    float radius = 4; // pixels
};

// A face pointing straight up shows its colour times ambient + intensity * cos(angle to the light):
// with an ambient of 1 and an intensity of 0, exactly its colour.
struct Light {
    glm::vec3 direction{0.45f, -1.0f, -0.55f}; // direction of travel; any nonzero length
    float intensity = 0.70f;                   // of the direct light
    float ambient = 0.50f;                     // of the ambient light
};

struct ViewOptions {
    bool wireframe = false;
    bool grid = true;
    bool shadows = true;
    bool occlusion = true; // darkens creases and contacts
    bool edges = true;     // softened, lined box edges, and shaded quarters on round shapes
};

struct DrawList {
    std::vector<DrawShape> shapes;
    std::vector<DrawMesh> meshes;
    std::vector<DrawPlane> planes;
    std::vector<DrawLine> lines;
    std::vector<DrawPoint> points;
    Camera camera;
    Light light;
    ViewOptions view;
};

} // namespace plumb
