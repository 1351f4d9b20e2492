// Probes of vectors, frames and matrices.
#include "engine/scene/real/probe_asking.h"

#include "engine/core/check.h"
#include "engine/math/matrices.h"
#include "engine/math/rigid.h"
#include "engine/math/vectors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace plumb::inline PLUMB_PRECISION {

namespace {

constexpr double in_degrees = 180 / std::numbers::pi;

// The label is at the head, or in the middle of a thin arrow.
void arrow(ProbeAnswer &answer, const Vec3 &from, const Vec3 &vector, ProbeTone tone,
           const std::string &name, bool is_thick = true) {
    if (vector == Vec3{Real(0)})
        return;
    answer.lines.push_back({wide(from), wide(from + vector), tone, true, is_thick});
    if (!name.empty())
        answer.labels.push_back({wide(from + (is_thick ? Real(1) : Real(0.5)) * vector), name});
}

// Shows a matrix row by row, as values and as labels starting at `at`.
void show_entries(Asking &ask, const std::string &name, std::size_t first, const Mat3 &entries,
                  const glm::dvec3 &at) {
    constexpr double column_width = 0.62;
    constexpr double row_height = 0.4;
    ask.answer.labels.push_back({at, name});
    const std::vector<std::string_view> &names = probe_question(ProbeQuestion::matrix).values;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
            // Adding 0 turns minus zero into zero.
            const double entry = static_cast<double>(entries[column][row]) + 0.0;
            ask.answer.values.push_back({names[first + static_cast<std::size_t>(3 * row + column)],
                                         entry, ProbeValue::Form::entry});
            ask.label(at + glm::dvec3(column_width * column, -row_height * (row + 1), 0), entry);
        }
}

} // namespace

void answer_vectors(Asking &ask) {
    const Vec3 at{ask.probe.points[0]};
    const Vec3 a = Vec3{ask.probe.points[1]} - at;
    const Vec3 b = Vec3{ask.probe.points[2]} - at;
    const Vec3 along = projection<3>(a, b);
    const Vec3 off = rejection(a, b);
    const Vec3 mirrored = reflection<3>(a, b);
    const Vec3 across = accurate_cross(a, b);
    arrow(ask.answer, at, a, ProbeTone::query, "a");
    arrow(ask.answer, at, b, ProbeTone::axis, "b");
    arrow(ask.answer, at, along, ProbeTone::result, "projection", false);
    arrow(ask.answer, at + along, off, ProbeTone::yes, "rejection", false);
    arrow(ask.answer, at, mirrored, ProbeTone::normal, "reflection", false);
    const Real size = glm::length(across);
    if (size > Real(0))
        arrow(ask.answer, at, across / std::sqrt(size), ProbeTone::no, "a x b");
    ask.answer.lines.push_back({wide(at + a), wide(at + mirrored), ProbeTone::faint});
    ask.number("dot", glm::dot(a, b));
    ask.number("angle_deg", angle_between(a, b) * in_degrees);
    ask.number("projection", glm::length(along));
    ask.number("rejection", glm::length(off));
    ask.number("cross", size);
    // Reflection preserves length.
    ask.number("reflection_error", glm::length(mirrored) - glm::length(a));
}

void answer_basis(Asking &ask) {
    const Vec3 at{ask.probe.points[0]};
    Mat3 given{Real(0)};
    for (int i = 0; i < 3; ++i) {
        given[i] = Vec3{ask.probe.points[static_cast<std::size_t>(i) + 1]} - at;
        arrow(ask.answer, at, given[i], ProbeTone::query, std::to_string(i + 1), false);
    }
    ask.number("determinant", glm::determinant(given));
    const std::optional<Mat3> made = orthonormalized(given);
    ask.flag("independent", made.has_value());
    if (!made)
        return;
    constexpr std::array tones{ProbeTone::result, ProbeTone::yes, ProbeTone::normal};
    for (int i = 0; i < 3; ++i)
        arrow(ask.answer, at, Real(1.5) * (*made)[i], tones[static_cast<std::size_t>(i)],
              std::to_string(i + 1) + "'");
    ask.number("orthonormal_determinant", glm::determinant(*made));
}

void answer_transform(Asking &ask) {
    const ProbeShapeDesc &shape = ask.probe.shapes.front();
    const auto *box = std::get_if<BoxDesc>(&shape.shape);
    PLUMB_CHECK(box, "a transform is shown on a box, not a " << shape_name(shape.shape));
    const ScaledTransform made{Vec3{shape.position}, Quat{shape.orientation},
                               Vec3{ask.probe.scale}};
    const Mat4 matrix = to_matrix(made);
    const Vec3 local{ask.probe.points.front()};
    const auto through = [](const Mat4 &m, const Vec3 &p) { return Vec3{m * Vec4{p, Real(1)}}; };
    const Vec3 world = through(matrix, local);
    // The shape's frame, and the images of its corners.
    constexpr std::array tones{ProbeTone::result, ProbeTone::yes, ProbeTone::normal};
    constexpr std::array names{"x", "y", "z"};
    for (int i = 0; i < 3; ++i) {
        Vec3 axis{Real(0)};
        axis[i] = Real(1);
        const auto index = static_cast<std::size_t>(i);
        arrow(ask.answer, Vec3{Real(0)}, axis, tones[index], "", false);
        arrow(ask.answer, made.position, through(matrix, axis) - made.position, tones[index],
              names[index]);
    }
    const Vec3 half{box->half_extents};
    const std::size_t first = ask.answer.lines.size();
    draw_edges(ask.answer, {-half, half}, ProbeTone::edge);
    for (std::size_t i = first, end = ask.answer.lines.size(); i < end; ++i) {
        ProbeLine line = ask.answer.lines[i];
        line.a = wide(through(matrix, Vec3{line.a}));
        line.b = wide(through(matrix, Vec3{line.b}));
        line.tone = ProbeTone::axis;
        ask.answer.lines.push_back(line);
    }
    ask.answer.points.push_back({wide(local), ProbeTone::query});
    ask.answer.points.push_back({wide(world), ProbeTone::axis});
    ask.answer.lines.push_back({wide(local), wide(world), ProbeTone::faint, true});
    ask.vector(wide(world));
    ask.number("determinant", glm::determinant(Mat3{matrix}));
    if (const std::optional<Mat4> back = try_inverse(matrix))
        ask.number("there_and_back", glm::distance(through(*back, world), local));
    if (const std::optional<ScaledTransform> parts = decompose(matrix)) {
        const EulerAngles angles = euler_angles(parts->rotation);
        ask.number("yaw_deg", angles.yaw * in_degrees);
        ask.number("pitch_deg", angles.pitch * in_degrees);
        ask.number("roll_deg", angles.roll * in_degrees);
        ask.number("scale_x", parts->scale.x);
        ask.number("scale_y", parts->scale.y);
        ask.number("scale_z", parts->scale.z);
    }
}

void answer_matrix(Asking &ask) {
    const Vec3 at{ask.probe.points[0]};
    Mat3 given{Real(0)};
    constexpr std::array tones{ProbeTone::result, ProbeTone::yes, ProbeTone::normal};
    for (std::size_t i = 0; i < 3; ++i) {
        const int column = static_cast<int>(i);
        given[column] = Vec3{ask.probe.points[i + 1]} - at;
        arrow(ask.answer, at, given[column], tones[i], std::to_string(i + 1));
    }
    // The image of the unit cube; its volume is the determinant's magnitude.
    const std::size_t first = ask.answer.lines.size();
    draw_edges(ask.answer, {Vec3{Real(0)}, Vec3{Real(1)}}, ProbeTone::edge);
    double right = ask.probe.points[0].x;
    for (std::size_t i = first; i < ask.answer.lines.size(); ++i) {
        ProbeLine &line = ask.answer.lines[i];
        line.a = wide(at + given * Vec3{line.a});
        line.b = wide(at + given * Vec3{line.b});
        right = std::max({right, line.a.x, line.b.x});
    }
    const std::optional<Mat3> inverse = try_inverse(given);
    ask.number("determinant", glm::determinant(given));
    ask.flag("invertible", inverse.has_value());
    // The tables are in a row to the right of the picture.
    const auto table_at = [&](int table) {
        return glm::dvec3(right + 0.5 + 2.3 * table, ask.probe.points[0].y + 1.2,
                          ask.probe.points[0].z);
    };
    show_entries(ask, "minors", 2, minors(given), table_at(0));
    show_entries(ask, "cofactors", 11, cofactors(given), table_at(1));
    show_entries(ask, "adjugate", 20, adjugate(given), table_at(2));
    if (inverse)
        show_entries(ask, "inverse", 29, *inverse, table_at(3));
    else
        ask.answer.labels.push_back({table_at(3), "singular: no inverse"});
}

} // namespace plumb::inline PLUMB_PRECISION
