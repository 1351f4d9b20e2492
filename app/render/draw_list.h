// What the renderer sees: a flat list of values. Poses in metres, colours in sRGB 0..1.
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
    bool selected = false;    // a ring in the accent colour, also when hidden
    bool highlighted = false; // brightened: what the pointer is over
    bool glass = false;       // what is behind or inside shows through
};

// Triangles, each three corners, in a frame of their own.
using Corners = std::vector<glm::vec3>;

// Seen from both sides. The renderer keeps what it made of the corners as long as they live: they
// are not changed, and lists that show the same share them.
struct DrawMesh {
    std::shared_ptr<const Corners> corners; // never null
    // Unit, one for each corner, on the side of the triangle's front: it looks smooth. Kept and
    // shared as the corners are. Null: the triangles look flat.
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
    glm::vec3 b{0}; // a line of no length is drawn as a dot as wide as the line
    glm::vec3 colour{0.2f};
    float width = 2; // pixels
};

// A marker with a fixed size on the screen, and a stalk along its normal.
struct DrawPoint {
    glm::vec3 position{0};
    glm::vec3 normal{0}; // the stalk as a vector in metres; zero: none
    glm::vec3 colour{0.8f, 0.2f, 0.2f};
    float radius = 4; // pixels
};

// A face turned straight up shows its colour times ambient + intensity * cos(angle to the light):
// with an ambient of 1 and an intensity of 0, exactly its colour.
struct Light {
    glm::vec3 direction{0.45f, -1.0f, -0.55f}; // the way the light goes; any length but zero
    float intensity = 0.70f;                   // of the direct light
    float ambient = 0.50f;                     // of the light from all around
};

struct ViewOptions {
    bool wireframe = false;
    bool grid = true;
    bool shadows = true;
    bool occlusion = true; // darkens creases and contacts
    bool edges = true;     // softened, lined edges on boxes, and quarters on what is round
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
