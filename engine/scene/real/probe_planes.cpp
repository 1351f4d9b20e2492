// Plane probes.
#include "engine/scene/real/probe_asking.h"

#include "engine/core/check.h"
#include "engine/geometry/hull_queries.h"
#include "engine/geometry/plane.h"

#include <array>

namespace plumb::inline PLUMB_PRECISION {

namespace {

const Plane &plane_of(const Asking &ask, std::size_t index) {
    const auto *plane = std::get_if<Plane>(&ask.shapes[index].shape);
    PLUMB_CHECK(plane, "expected a plane, got " << shape_name(ask.probe.shapes[index].shape));
    return *plane;
}

} // namespace

void answer_classify(Asking &ask) {
    const Plane &plane = plane_of(ask, 0);
    ask.draw(0, ProbeTone::axis);
    std::array<std::size_t, 3> sides{};
    double last = 0;
    for (std::size_t s = 1; s < ask.shapes.size(); ++s) {
        const PlaneTest test = std::visit(
            [&](const auto &shape) -> PlaneTest {
                if constexpr (requires { classify(plane, shape); })
                    return classify(plane, shape);
                else
                    PLUMB_CHECK(false, "this kind of shape cannot be classified");
            },
            ask.shapes[s].shape);
        constexpr std::array tones{ProbeTone::no, ProbeTone::partly, ProbeTone::yes};
        constexpr std::array words{"behind ", "across", "in front "};
        const auto side = static_cast<std::size_t>(test.side);
        ++sides[side];
        ask.draw(s, tones[side]);
        last = static_cast<double>(test.distance);
        const ProbeShapeDesc &desc = ask.probe.shapes[s];
        // At the middle of its points, for shapes placed by them.
        const glm::dvec3 at = std::visit(
            [&](const auto &shape) {
                glm::dvec3 middle = desc.position;
                if constexpr (requires { shape.points.size(); })
                    for (const glm::dvec3 &point : shape.points)
                        middle += point / static_cast<double>(shape.points.size());
                return middle;
            },
            desc.shape);
        ask.answer.labels.push_back(
            {at, words[side] + (test.side == PlaneSide::across ? "" : short_number(last))});
    }
    ask.count("in_front", sides[2]);
    ask.count("across", sides[1]);
    ask.count("behind", sides[0]);
    ask.number("distance", last);
}

void answer_planes(Asking &ask) {
    for (std::size_t s = 0; s < ask.shapes.size(); ++s)
        ask.draw(s, ProbeTone::plain);
    const auto draw_line = [&](const std::optional<Line> &line, bool is_answer) {
        if (!line)
            return;
        // Draws the part nearest the planes' mean position.
        glm::dvec3 middle{0};
        for (const ProbeShapeDesc &shape : ask.probe.shapes)
            middle += shape.position / static_cast<double>(ask.probe.shapes.size());
        const glm::dvec3 along = wide(line->direction);
        const glm::dvec3 from = wide(line->point);
        const glm::dvec3 foot = from + glm::dot(middle - from, along) * along;
        ask.answer.lines.push_back({foot - 3.0 * along, foot + 3.0 * along,
                                    is_answer ? ProbeTone::result : ProbeTone::axis, false, true});
    };
    if (ask.shapes.size() == 2) {
        const std::optional<Line> line = intersection(plane_of(ask, 0), plane_of(ask, 1));
        draw_line(line, true);
        ask.flag("meet", line.has_value());
        if (line)
            ask.vector(wide(line->point));
        return;
    }
    for (std::size_t i = 0; i < 3; ++i)
        draw_line(intersection(plane_of(ask, i), plane_of(ask, (i + 1) % 3)), false);
    const std::optional<Vec3> point =
        intersection(plane_of(ask, 0), plane_of(ask, 1), plane_of(ask, 2));
    ask.flag("meet", point.has_value());
    if (!point)
        return;
    ask.answer.points.push_back({wide(*point), ProbeTone::result});
    ask.vector(wide(*point));
}

} // namespace plumb::inline PLUMB_PRECISION
