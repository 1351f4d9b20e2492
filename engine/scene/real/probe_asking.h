// A probe being answered: its shapes and the answer so far.
#pragma once

#include "engine/core/precision.h"
#include "engine/scene/real/probe_shapes.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

struct Asking {
    const ProbeDesc &probe;
    bool flat; // in the xy plane
    std::vector<MadeShape> shapes;
    ProbeAnswer answer;

    explicit Asking(const ProbeDesc &asked);

    template <typename Number> void number(std::string_view name, Number value) {
        answer.values.push_back({name, static_cast<double>(value), ProbeValue::Form::number});
    }
    void count(std::string_view name, std::size_t value);
    void flag(std::string_view name, bool value);
    void vector(const glm::dvec3 &v); // x, y, z
    void normal(const glm::dvec3 &v); // normal_x, normal_y, normal_z

    void draw(std::size_t shape, ProbeTone tone);
    void label(const glm::dvec3 &at, double value);
};

std::string short_number(double value); // three digits

// Where a ray or segment meets a shape.
struct RayFound {
    double t = 0;
    std::optional<double> t_exit; // for solids
    glm::dvec3 point{0};
    glm::dvec3 normal{0};
    bool starts_inside = false;
};
std::optional<RayFound> ray_into(const AskedShape &shape, const ProbeRayDesc &ray);

Ray ray_of(const ProbeRayDesc &ray);
// Draws the ray to slightly beyond its hit, or its full length.
void draw_ray(Asking &ask, const ProbeRayDesc &ray, std::optional<double> hit_t);

// Reports the probe ray's hit on triangles.
template <typename Hit> void show_hit(Asking &ask, const std::optional<Hit> &hit) {
    ask.flag("hit", hit.has_value());
    draw_ray(ask, *ask.probe.ray, hit ? std::optional<double>(hit->t) : std::nullopt);
    if (!hit)
        return;
    ask.number("t", hit->t);
    ask.answer.points.push_back({wide(hit->point), ProbeTone::result, wide(hit->normal)});
}

// A scatter's points, and the boxes at them.
std::vector<glm::dvec3> scattered_points(const ProbeScatterDesc &scatter);
std::vector<Aabb> scattered_boxes(const ProbeScatterDesc &scatter);
void draw_item(Asking &ask, const Aabb &box, ProbeTone tone); // one of those boxes

// The questions, one file per subject.
// probe_vectors.cpp
void answer_vectors(Asking &ask);
void answer_basis(Asking &ask);
void answer_transform(Asking &ask);
void answer_matrix(Asking &ask);
// probe_points.cpp
void answer_contains(Asking &ask);
void answer_closest(Asking &ask);
void answer_enclose(Asking &ask);
// probe_planes.cpp
void answer_classify(Asking &ask);
void answer_planes(Asking &ask);
// probe_rays.cpp
void answer_raycast(Asking &ask);
// probe_overlaps.cpp
void answer_overlap(Asking &ask);
// probe_convex.cpp
void answer_distance(Asking &ask);
void answer_penetration(Asking &ask);
void answer_collide(Asking &ask);
void answer_cast(Asking &ask);
// probe_trees.cpp
void answer_tree(Asking &ask);
// probe_models.cpp
void answer_models(Asking &ask);
// probe_cameras.cpp
void answer_frustum(Asking &ask);
void answer_cull(Asking &ask);
void answer_pick(Asking &ask);

} // namespace plumb::inline PLUMB_PRECISION
