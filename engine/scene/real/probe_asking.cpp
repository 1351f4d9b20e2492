#include "engine/scene/real/probe_asking.h"

#include "engine/core/random.h"

#include <array>
#include <cstdio>

namespace plumb::inline PLUMB_PRECISION {

namespace {

ProbeShapeDesc box_desc(const Aabb &box) {
    ProbeShapeDesc desc;
    desc.shape = AabbDesc{0.5 * wide(box.max - box.min)};
    desc.position = 0.5 * wide(box.min + box.max);
    return desc;
}

} // namespace

Asking::Asking(const ProbeDesc &asked) : probe(asked), flat(is_flat(asked)) {
    for (const ProbeShapeDesc &shape : asked.shapes)
        shapes.push_back(make_shape(shape));
}

void Asking::count(std::string_view name, std::size_t value) {
    answer.values.push_back({name, static_cast<double>(value), ProbeValue::Form::count});
}

void Asking::flag(std::string_view name, bool value) {
    answer.values.push_back({name, value ? 1.0 : 0.0, ProbeValue::Form::flag});
}

void Asking::vector(const glm::dvec3 &v) {
    number("x", v.x);
    number("y", v.y);
    number("z", v.z);
}

void Asking::normal(const glm::dvec3 &v) {
    number("normal_x", v.x);
    number("normal_y", v.y);
    number("normal_z", v.z);
}

void Asking::draw(std::size_t shape, ProbeTone tone) {
    draw_shape(answer, probe.shapes[shape], shapes[shape], tone, shape);
}

void Asking::label(const glm::dvec3 &at, double value) {
    answer.labels.push_back({at, short_number(value)});
}

std::string short_number(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.3g", value);
    return text.data();
}

std::vector<glm::dvec3> scattered_points(const ProbeScatterDesc &scatter) {
    Random random(scatter.seed);
    std::vector<glm::dvec3> points;
    for (int i = 0; i < scatter.count; ++i) {
        glm::dvec3 point = scatter.center;
        for (int axis = 0; axis < 3; ++axis)
            point[axis] += random.next_in(-1, 1) * scatter.half_extents[axis];
        points.push_back(point);
    }
    return points;
}

std::vector<Aabb> scattered_boxes(const ProbeScatterDesc &scatter) {
    Random random(scatter.seed + 1);
    std::vector<Aabb> boxes;
    for (const glm::dvec3 &point : scattered_points(scatter)) {
        glm::dvec3 half{0};
        for (int axis = 0; axis < 3; ++axis)
            if (scatter.half_extents[axis] > 0)
                half[axis] = scatter.size * random.next_in(0.25, 1);
        boxes.push_back({Vec3{point - half}, Vec3{point + half}});
    }
    return boxes;
}

void draw_item(Asking &ask, const Aabb &box, ProbeTone tone) {
    if (ask.flat) {
        const Rectangle item{Vec2{box.min}, Vec2{box.max}};
        draw_shape(ask.answer, box_desc(box), {item, nullptr}, tone, 0);
        ask.answer.surfaces.back().is_opaque = true;
    } else {
        const ProbeShapeDesc placed = box_desc(box);
        ask.answer.solids.push_back({BoxDesc{std::get<AabbDesc>(placed.shape).half_extents},
                                     placed.position, placed.orientation, tone, 0, true});
    }
}

} // namespace plumb::inline PLUMB_PRECISION
