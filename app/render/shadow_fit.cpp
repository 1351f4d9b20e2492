#include "app/render/shadow_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/core/check.h"

namespace plumb {

namespace {

// How far into the view shadows are drawn, in camera distances from the eye.
constexpr double reach = 6;
// A shape that reaches this many camera distances from its centre is a floor or a wall: the map
// does not grow for it unless there is nothing else.
constexpr float wide = 0.8f;

struct Interval {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
    void add(double x, double r) {
        low = std::min(low, x - r);
        high = std::max(high, x + r);
    }
};

} // namespace

float half_extent_along(const DrawShape &shape, const glm::vec3 &direction) {
    switch (shape.kind) {
    case DrawKind::sphere:
        return shape.size.x;
    case DrawKind::box: {
        const glm::vec3 local = glm::abs(glm::conjugate(shape.rotation) * direction);
        return glm::dot(local, shape.size);
    }
    case DrawKind::capsule: {
        const glm::vec3 axis = shape.rotation * glm::vec3(0, 1, 0);
        return shape.size.x + shape.size.y * std::abs(glm::dot(axis, direction));
    }
    case DrawKind::cylinder: {
        const float along = std::abs(glm::dot(shape.rotation * glm::vec3(0, 1, 0), direction));
        const float across = std::sqrt(std::max(0.0f, 1 - along * along));
        return shape.size.x * across + shape.size.y * along;
    }
    }
    PLUMB_CHECK(false, "unknown kind of shape " << static_cast<int>(shape.kind));
}

std::optional<ShadowFit> fit_shadow(std::span<const DrawShape> shapes, const Camera &camera,
                                    float aspect, const glm::vec3 &light_direction,
                                    const glm::vec3 &origin, int map_size) {
    PLUMB_CHECK(glm::dot(light_direction, light_direction) > 0, "the light has no direction");
    // The light's frame: z against the light, x horizontal unless the light is vertical.
    const glm::vec3 z = -glm::normalize(light_direction);
    const glm::vec3 reference = std::abs(z.y) < 0.99f ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1);
    const glm::vec3 x = glm::normalize(glm::cross(reference, z));
    const glm::vec3 y = glm::cross(z, x);
    const std::array<glm::vec3, 3> axes{x, y, z};

    std::array<Interval, 3> content;
    const auto add_shapes = [&](bool also_wide) {
        for (const DrawShape &shape : shapes) {
            std::array<float, 3> half{};
            for (std::size_t i = 0; i < 3; ++i)
                half[i] = half_extent_along(shape, axes[i]);
            if (!also_wide && std::max(half[0], half[1]) > wide * camera.distance)
                continue;
            for (std::size_t i = 0; i < 3; ++i)
                content[i].add(glm::dot(glm::dvec3(axes[i]), glm::dvec3(shape.position)),
                               static_cast<double>(half[i]));
        }
    };
    add_shapes(false);
    if (content[0].high < content[0].low)
        add_shapes(true);

    // The eye and the far corners of the part of the view that shows shadows.
    const double depth = reach * static_cast<double>(camera.distance);
    // For a view centred on the target that contains this one.
    const glm::dvec2 widest = 1.0 + glm::abs(glm::dvec2(camera.centre));
    const double height = depth * static_cast<double>(camera.half_height());
    const double half_height = height * widest.y;
    const double half_width = height * static_cast<double>(aspect) * widest.x;
    std::array<Interval, 2> seen;
    for (std::size_t i = 0; i < 2; ++i) {
        const glm::dvec3 axis(axes[i]);
        const double eye = glm::dot(axis, glm::dvec3(camera.eye()));
        const double centre = eye + depth * glm::dot(axis, glm::dvec3(camera.forward()));
        const double spread = half_width * std::abs(glm::dot(axis, glm::dvec3(camera.right()))) +
                              half_height * std::abs(glm::dot(axis, glm::dvec3(camera.up())));
        seen[i].add(eye, 0);
        seen[i].add(centre, spread);
    }

    std::array<double, 2> middle{};
    double side = 0;
    for (std::size_t i = 0; i < 2; ++i) {
        const double low = std::max(content[i].low, seen[i].low);
        const double high = std::min(content[i].high, seen[i].high);
        if (!(low < high))
            return std::nullopt;
        middle[i] = 0.5 * (low + high);
        side = std::max(side, high - low);
    }
    // Room for the filter at the border; eight steps per doubling.
    side = std::exp2(std::ceil(8 * std::log2(1.03 * side)) / 8);
    const double texel = side / map_size;
    for (double &m : middle)
        m = texel * std::round(m / texel);

    const double top = content[2].high + 0.01 * side;
    // Points below the lowest caster are compared at the map's far end. An outlier far below is
    // dropped before depth becomes coarse.
    const double bottom = std::max(content[2].low, top - 64 * side) - 0.01 * side;
    const auto row = [&](const glm::vec3 &axis, double at_zero, double length) {
        const glm::dvec3 a(axis);
        return glm::dvec4(a / length, (glm::dot(a, glm::dvec3(origin)) - at_zero) / length);
    };
    const glm::dvec4 u = row(x, middle[0] - 0.5 * side, side);
    const glm::dvec4 v = row(y, middle[1] - 0.5 * side, side);
    const glm::dvec4 w = row(-z, -top, top - bottom);
    ShadowFit fit;
    for (int c = 0; c < 4; ++c)
        fit.texture_from_relative[c] = glm::vec4(glm::dvec4(u[c], v[c], w[c], c == 3 ? 1.0 : 0.0));
    fit.texel = static_cast<float>(texel);
    return fit;
}

} // namespace plumb
