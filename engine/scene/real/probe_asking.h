// A probe that is being answered: its shapes, and what is found so far.
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
    std::optional<double> t_exit; // of solids
    glm::dvec3 point{0};
    glm::dvec3 normal{0};
    bool starts_inside = false;
};
std::optional<RayFound> ray_into(const AskedShape &shape, const ProbeRayDesc &ray);

// The places of a scatter, and the boxes that stand there.
std::vector<glm::dvec3> scattered_points(const ProbeScatterDesc &scatter);
std::vector<Aabb> scattered_boxes(const ProbeScatterDesc &scatter);

// Crowds: trees, models, frustums.
void answer_tree(Asking &ask);
void answer_models(Asking &ask);
void answer_frustum(Asking &ask);
void answer_cull(Asking &ask);
void answer_pick(Asking &ask);

} // namespace plumb::inline PLUMB_PRECISION
