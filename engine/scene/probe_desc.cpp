#include "engine/scene/probe_desc.h"

#include "engine/scene/shape_kinds.h"

#include <algorithm>

#include <glm/geometric.hpp>

namespace plumb {

namespace {

// Visits the probe's movable points in handle order. `visit` gets the current position and a
// function that moves it, which must not be called for a const probe.
template <typename Probe, typename Visit> void for_each_handle(Probe &probe, Visit &&visit) {
    for (auto &point : probe.points)
        visit(point, [&](const auto &place) { point = place; });
    for (auto &placed : probe.shapes)
        std::visit(
            [&](auto &shape) {
                if constexpr (requires { shape.points.front(); }) {
                    for (auto &point : shape.points)
                        visit(point, [&](const auto &place) { point = place; });
                } else if (probe.question != ProbeQuestion::models || placed.parent.empty()) {
                    visit(placed.position, [&](const auto &place) { placed.position = place; });
                }
            },
            placed.shape);
    if (probe.question == ProbeQuestion::cast)
        visit(probe.shapes.front().position + probe.motion, [&](const auto &place) {
            if (place != probe.shapes.front().position)
                probe.motion = place - probe.shapes.front().position;
        });
    if (probe.ray) {
        auto &ray = *probe.ray; // a ray moves as a whole by its origin, a segment by either end
        visit(ray.origin, [&](const auto &place) { ray.origin = place; });
        if (ray.end)
            visit(*ray.end, [&](const auto &place) { ray.end = place; });
        else
            visit(ray.origin + ray.direction, [&](const auto &place) {
                if (place != ray.origin)
                    ray.direction = place - ray.origin;
            });
    }
    if (probe.camera) {
        auto &camera = *probe.camera;
        visit(camera.eye, [&](const auto &place) {
            if (place != camera.target)
                camera.eye = place;
        });
        visit(camera.target, [&](const auto &place) {
            if (place != camera.eye)
                camera.target = place;
        });
    }
}

} // namespace

const std::vector<ProbeQuestionInfo> &probe_questions() {
    using enum ProbeQuestion;
    constexpr std::size_t many = max_probe_shapes;
    constexpr std::size_t cloud = max_probe_points;
    static const std::vector<ProbeQuestionInfo> all{
        {vectors,
         "vectors",
         "two vectors: their angle, projection, rejection, reflection and products",
         {0, 0},
         {3, 3},
         {},
         {"dot", "angle_deg", "projection", "rejection", "cross", "reflection_error"}},
        {basis,
         "basis",
         "three directions made orthonormal, keeping the first",
         {0, 0},
         {4, 4},
         {},
         {"determinant", "orthonormal_determinant", "independent"}},
        {transform,
         "transform",
         "a point through a transform and back, and the matrix decomposed",
         {1, 1},
         {1, 1},
         {"scale"},
         {"x", "y", "z", "determinant", "there_and_back", "yaw_deg", "pitch_deg", "roll_deg",
          "scale_x", "scale_y", "scale_z"}},
        {matrix,
         "matrix",
         "a matrix given by its columns: its determinant, minors, cofactors, adjugate and inverse",
         {0, 0},
         {4, 4},
         {},
         {"determinant",
          "invertible", // and by row and column
          "minor_11",    "minor_12",    "minor_13",    "minor_21",    "minor_22",    "minor_23",
          "minor_31",    "minor_32",    "minor_33",    "cofactor_11", "cofactor_12", "cofactor_13",
          "cofactor_21", "cofactor_22", "cofactor_23", "cofactor_31", "cofactor_32", "cofactor_33",
          "adjugate_11", "adjugate_12", "adjugate_13", "adjugate_21", "adjugate_22", "adjugate_23",
          "adjugate_31", "adjugate_32", "adjugate_33", "inverse_11",  "inverse_12",  "inverse_13",
          "inverse_21",  "inverse_22",  "inverse_23",  "inverse_31",  "inverse_32",  "inverse_33"}},
        {contains,
         "contains",
         "which points lie in any of the shapes",
         {1, many},
         {1, cloud},
         {},
         {"inside"}},
        {closest,
         "closest",
         "the point of each shape that is closest to each point",
         {1, many},
         {1, cloud},
         {},
         {"distance", "x", "y", "z"}},
        {overlap,
         "overlap",
         "which shapes have a point in common",
         {2, many},
         {0, 0},
         {},
         {"overlap", "pairs", "separation"}},
        {classify,
         "classify",
         "whether shapes lie in front of a plane, behind it or across it",
         {2, many},
         {0, 0},
         {},
         {"in_front", "behind", "across", "distance"}},
        {planes,
         "planes",
         "the line where two planes meet, or the point where three do",
         {2, 3},
         {0, 0},
         {},
         {"meet", "x", "y", "z"}},
        {raycast,
         "raycast",
         "where a ray enters and leaves shapes, and what it hits first",
         {1, many},
         {0, 0},
         {"ray", "segment"},
         {"hit", "t", "t_exit", "hits", "starts_inside", "x", "y", "z", "normal_x", "normal_y",
          "normal_z"}},
        {distance,
         "distance",
         "how far apart two convex shapes are, and their closest points",
         {2, 2},
         {0, 0},
         {},
         {"distance", "overlap", "iterations"}},
        {penetration,
         "penetration",
         "how far one convex shape must move out of another",
         {2, 2},
         {0, 0},
         {},
         {"depth", "overlap", "normal_x", "normal_y", "normal_z"}},
        {collide,
         "collide",
         "the contact points of two shapes",
         {2, 2},
         {0, 0},
         {"margin"},
         {"points", "depth", "normal_x", "normal_y", "normal_z"}},
        {cast,
         "cast",
         "how far a shape can move before it touches another",
         {2, 2},
         {0, 0},
         {"motion"},
         {"hit", "t", "normal_x", "normal_y", "normal_z"}},
        {enclose,
         "enclose",
         "the smallest circle and the smallest rectangle around points",
         {0, 0},
         {0, cloud},
         {"scatter"},
         {"radius", "x", "y", "width", "height"}},
        {tree,
         "tree",
         "what a tree of boxes finds, and how it divides space",
         {0, 1},
         {0, 1},
         {"ray", "segment", "scatter", "tree", "level"},
         {"found", "items", "nodes", "tested", "depth", "hit", "t", "distance"}},
        {models,
         "models",
         "models attached to their parents, and what a ray and a ball hit",
         {1, many},
         {0, 1},
         {"ray", "segment", "margin"},
         {"hit", "t", "models", "found"}},
        {frustum,
         "frustum",
         "which shapes and points are in a camera's frustum",
         {0, many},
         {0, cloud},
         {"camera"},
         {"inside", "across", "outside"}},
        {cull,
         "cull",
         "what an octree finds in a camera's frustum",
         {0, 0},
         {0, 0},
         {"camera", "scatter"},
         {"seen", "culled", "tested", "items"}},
        {pick,
         "pick",
         "the ray through a pixel of a camera's picture, and what it hits",
         {1, many},
         {0, 0},
         {"camera"},
         {"hit", "shape", "distance", "x", "y", "z", "pixel_x", "pixel_y"}},
    };
    return all;
}

bool ProbeQuestionInfo::does_take(std::string_view key) const {
    return std::ranges::find(takes, key) != takes.end();
}

const ProbeQuestionInfo &probe_question(ProbeQuestion question) {
    return probe_questions()[static_cast<std::size_t>(question)];
}

std::string_view shape_name(const ProbeShape &shape) {
    return std::visit(
        []<typename Shape>(const Shape &) { return scene_file::Kind<Shape>::info.name; }, shape);
}

bool is_flat(const ProbeShape &shape) {
    return std::visit(
        []<typename Shape>(const Shape &) { return scene_file::Kind<Shape>::info.is_flat; }, shape);
}

bool is_flat(const ProbeDesc &probe) {
    return probe.question == ProbeQuestion::enclose ||
           (probe.tree && *probe.tree == ProbeTree::quadtree) ||
           std::ranges::any_of(probe.shapes,
                               [](const ProbeShapeDesc &shape) { return is_flat(shape.shape); });
}

std::vector<glm::dvec3> probe_handles(const ProbeDesc &probe) {
    std::vector<glm::dvec3> handles;
    for_each_handle(probe,
                    [&](const glm::dvec3 &place, const auto &) { handles.push_back(place); });
    return handles;
}

void move_probe_handle(ProbeDesc &probe, std::size_t handle, const glm::dvec3 &place) {
    std::size_t index = 0;
    const glm::dvec3 to = is_flat(probe) ? glm::dvec3(place.x, place.y, 0) : place;
    for_each_handle(probe, [&](const glm::dvec3 &, const auto &move) {
        if (index++ == handle)
            move(to);
    });
}

} // namespace plumb
