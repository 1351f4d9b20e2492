// Answers to probes, as plain values: to be drawn, printed and compared.
#pragma once

#include "engine/scene/scene_desc.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <glm/vec3.hpp>

namespace plumb {

// The meaning of a mark; the app has a colour for each.
enum class ProbeTone {
    plain,  // a queried shape, in a colour of its own
    query,  // the query itself: a ray, a point
    yes,    // hit, inside, overlapping, seen
    partly, // across
    no,     // missed, outside, culled
    result, // the points found
    normal,
    axis,
    edge,  // of a shape
    faint, // tree nodes, guide lines
};

struct ProbeValue {
    // entry: of a matrix; the three of a row are consecutive.
    enum class Form { number, count, flag, entry };
    std::string_view name; // one of the question's values
    double value = 0;
    Form form = Form::number;
};

using SolidDesc = std::variant<SphereDesc, BoxDesc, CapsuleDesc, CylinderDesc>;
struct ProbeSolid {
    SolidDesc shape;
    glm::dvec3 position{0};
    glm::dquat orientation{1, 0, 0, 0};
    ProbeTone tone = ProbeTone::plain;
    std::size_t number = 0; // tells plain ones apart
    bool is_opaque = false;
};
// Triangles, three corners each, counter-clockwise from the front.
struct ProbeSurface {
    std::vector<glm::dvec3> corners;
    ProbeTone tone = ProbeTone::plain;
    std::size_t number = 0;
    bool is_opaque = false; // else things behind it show through
};
struct ProbeLine {
    glm::dvec3 a{0}, b{0};
    ProbeTone tone = ProbeTone::query;
    bool is_arrow = false; // with its head at b
    bool is_thick = false;
};
struct ProbePoint {
    glm::dvec3 position{0};
    ProbeTone tone = ProbeTone::result;
    glm::dvec3 normal{0}; // unit, or zero: none
    bool is_small = false;
};
struct ProbeLabel {
    glm::dvec3 position{0};
    std::string text;
};

struct ProbeAnswer {
    std::vector<ProbeValue> values;
    std::string refusal; // why there is no answer; empty when there is
    std::vector<ProbeSolid> solids;
    std::vector<ProbeSurface> surfaces;
    std::vector<ProbeLine> lines;
    std::vector<ProbePoint> points;
    std::vector<ProbeLabel> labels;

    // NaN when there is none of that name, such as the t of a ray that hits nothing.
    [[nodiscard]] double value(std::string_view name) const;
};

// Computes the answer in the given precision; the same probe gives the same bits. A query that the
// geometry rejects (a zero direction, say) yields a refusal.
ProbeAnswer answer(const ProbeDesc &probe, Precision precision);

// Hashes the numbers of all answers, bit for bit.
std::uint64_t hash_of_answers(std::span<const ProbeDesc> probes, Precision precision);

} // namespace plumb
