// Overlap probes: whether shapes have a common point, and along which axis two boxes are separated.
#include "engine/scene/real/probe_asking.h"

#include "engine/core/check.h"
#include "engine/geometry/gjk.h"
#include "engine/geometry/height_field.h"
#include "engine/geometry/overlap.h"
#include "engine/geometry/overlap_2d.h"
#include "engine/geometry/sat.h"
#include "engine/geometry/triangle_overlap.h"
#include "engine/space/mesh_tree.h"

#include <array>

namespace plumb::inline PLUMB_PRECISION {

namespace {

template <typename A, typename B> std::optional<bool> common(const A &a, const B &b) {
    if constexpr (requires { overlaps(a, b); })
        return overlaps(a, b);
    else if constexpr (requires { overlaps(b, a); })
        return overlaps(b, a);
    else
        return std::nullopt;
}

void draw_axis(ProbeAnswer &answer, const glm::dvec3 &a, const glm::dvec3 &b,
               const glm::dvec3 &normal, double separation, const std::string &text) {
    // Draws the separation of the shapes' projections on the axis, about the middle.
    const glm::dvec3 middle = 0.5 * (a + b);
    answer.lines.push_back({middle - 2.5 * normal, middle + 2.5 * normal, ProbeTone::axis});
    answer.lines.push_back({middle - 0.5 * separation * normal, middle + 0.5 * separation * normal,
                            ProbeTone::result, separation > 0, true});
    answer.labels.push_back({middle + 2.5 * normal, text});
}

} // namespace

void answer_overlap(Asking &ask) {
    const std::size_t count = ask.shapes.size();
    std::vector<bool> touched(count, false);
    std::size_t pairs = 0;
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = i + 1; j < count; ++j) {
            const std::optional<bool> found =
                std::visit([](const auto &a, const auto &b) { return common(a, b); },
                           ask.shapes[i].shape, ask.shapes[j].shape);
            PLUMB_CHECK(found.has_value(), "there is no overlap test of "
                                               << shape_name(ask.probe.shapes[i].shape) << " with "
                                               << shape_name(ask.probe.shapes[j].shape));
            if (*found) {
                touched[i] = touched[j] = true;
                ++pairs;
            }
        }
    for (std::size_t i = 0; i < count; ++i)
        ask.draw(i, touched[i] ? ProbeTone::yes : ProbeTone::plain);
    ask.flag("overlap", pairs > 0);
    ask.count("pairs", pairs);
    if (count != 2)
        return;
    const glm::dvec3 &at_a = ask.probe.shapes[0].position;
    const glm::dvec3 &at_b = ask.probe.shapes[1].position;
    const AskedShape &a = ask.shapes[0].shape;
    const AskedShape &b = ask.shapes[1].shape;
    constexpr std::array names{"a face of A", "a face of B", "two edges"};
    if (const auto *box_a = std::get_if<Box>(&a), *box_b = std::get_if<Box>(&b); box_a && box_b) {
        const SatResult sat = separating_axis(*box_a, *box_b);
        ask.number("separation", sat.separation);
        draw_axis(ask.answer, at_a, at_b, wide(sat.normal), static_cast<double>(sat.separation),
                  std::string("axis of ") + names[static_cast<std::size_t>(sat.axis)]);
    }
    const auto *flat_a = std::get_if<OrientedRectangle>(&a);
    const auto *flat_b = std::get_if<OrientedRectangle>(&b);
    if (flat_a && flat_b) {
        const SatResult2 sat = separating_axis(*flat_a, *flat_b);
        ask.number("separation", sat.separation);
        draw_axis(ask.answer, at_a, at_b, wide(sat.normal), static_cast<double>(sat.separation),
                  sat.axis < 2 ? "axis of A" : "axis of B");
    }
}

} // namespace plumb::inline PLUMB_PRECISION
