#include "app/sandbox/draw/probe_draw.h"

#include "app/render/palette.h"
#include "app/sandbox/draw/shape_draw.h"
#include "engine/core/check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb {

namespace {

glm::vec3 colour_of(ProbeTone tone, std::size_t number) {
    switch (tone) {
    case ProbeTone::plain: {
        // The palette without its greens: green means yes.
        constexpr std::array<std::size_t, 6> plain{0, 1, 5, 4, 7, 3};
        return palette_colour(plain[number % plain.size()]);
    }
    case ProbeTone::query:
        return colours::ink;
    case ProbeTone::yes:
        return colours::probe_yes;
    case ProbeTone::partly:
        return colours::probe_partly;
    case ProbeTone::no:
        return colours::probe_no;
    case ProbeTone::result:
        return colours::contact;
    case ProbeTone::normal:
        return colours::joint;
    case ProbeTone::axis:
        return colours::probe_axis;
    case ProbeTone::edge:
        return colours::probe_edge;
    case ProbeTone::faint:
        return colours::probe_faint;
    }
    PLUMB_CHECK(false, "unknown tone " << static_cast<int>(tone));
}

ShapeDesc shape_of(const ProbeSolid &solid) {
    return std::visit([](const auto &shape) { return ShapeDesc(shape); }, solid.shape);
}

float width_of(const ProbeLine &line) {
    if (line.is_thick)
        return 4;
    return line.tone == ProbeTone::faint ? 1.0f : line.tone == ProbeTone::edge ? 1.5f : 2.0f;
}

void add_line(DrawList &list, const ProbeLine &line) {
    const glm::vec3 colour = colour_of(line.tone, 0);
    const float width = width_of(line);
    const auto add = [&](const glm::dvec3 &a, const glm::dvec3 &b) {
        list.lines.push_back({glm::vec3(a), glm::vec3(b), colour, width});
    };
    add(line.a, line.b);
    const double length = glm::distance(line.a, line.b);
    if (!line.is_arrow || !(length > 0))
        return;
    // A head of four barbs, seen from any side.
    const glm::dvec3 along = (line.b - line.a) / length;
    const glm::dvec3 other = std::abs(along.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 side = glm::normalize(glm::cross(along, other));
    const glm::dvec3 up = glm::cross(side, along);
    const double size = std::min(0.2 * length, 0.25);
    for (const glm::dvec3 &barb : {side, -side, up, -up})
        add(line.b, line.b - size * along + 0.45 * size * barb);
}

// Length of a normal's stalk, m.
constexpr double stalk = 0.6;

void add_answer(DrawList &list, const ProbeAnswer &answer) {
    for (const ProbeSolid &solid : answer.solids) {
        ShapeStyle style;
        style.colour = colour_of(solid.tone, solid.number);
        style.glass = !solid.is_opaque;
        draw_shape(list, shape_of(solid), solid.position, solid.orientation, style);
    }
    for (const ProbeSurface &surface : answer.surfaces) {
        DrawMesh mesh;
        mesh.corners =
            std::make_shared<const Corners>(surface.corners.begin(), surface.corners.end());
        mesh.colour = colour_of(surface.tone, surface.number);
        mesh.glass = !surface.is_opaque;
        list.meshes.push_back(std::move(mesh));
    }
    for (const ProbeLine &line : answer.lines)
        add_line(list, line);
    for (const ProbePoint &point : answer.points)
        draw_point(list, point);
}

template <typename Visit> void for_each_place(const ProbeAnswer &answer, Visit &&visit) {
    for (const ProbeSolid &solid : answer.solids) {
        const double far = reach(shape_of(solid));
        visit(solid.position - far);
        visit(solid.position + far);
    }
    for (const ProbeSurface &surface : answer.surfaces)
        for (const glm::dvec3 &corner : surface.corners)
            visit(corner);
    for (const ProbeLine &line : answer.lines) {
        visit(line.a);
        visit(line.b);
    }
    for (const ProbePoint &point : answer.points)
        visit(point.position);
}

} // namespace

void draw_point(DrawList &list, const ProbePoint &point) {
    if (point.normal != glm::dvec3(0))
        add_line(list, {point.position, point.position + stalk * point.normal, ProbeTone::normal,
                        true, false});
    DrawPoint drawn;
    drawn.position = glm::vec3(point.position);
    drawn.colour = colour_of(point.tone, 0);
    drawn.radius = point.is_small ? 2.5f : 5.0f;
    list.points.push_back(drawn);
}

void draw_probes(DrawList &list, std::span<const ProbeDesc> probes,
                 std::span<const ProbeAnswer> answers, const std::optional<ProbeHandle> &hovered,
                 bool floor) {
    const auto add_handle = [&](const glm::dvec3 &place, const glm::vec3 &colour, float radius) {
        list.points.push_back({glm::vec3(place), glm::vec3(0), colour, radius});
    };
    bool all_flat = true;
    // Answer points go on top of the handles: they say more.
    for (std::size_t p = 0; p < probes.size(); ++p) {
        for (const glm::dvec3 &handle : probe_handles(probes[p]))
            add_handle(handle, colours::probe_handle, 4);
        add_answer(list, answers[p]);
        all_flat = all_flat && is_flat(probes[p]);
    }
    if (hovered && hovered->probe < probes.size())
        add_handle(probe_handles(probes[hovered->probe])[hovered->handle], colours::selected, 8);
    if (!floor || all_flat)
        return;
    DrawPlane level;
    for (const ProbeAnswer &answer : answers)
        for_each_place(answer, [&](const glm::dvec3 &place) {
            level.position.y = std::min(level.position.y, static_cast<float>(place.y));
        });
    list.planes.push_back(level);
}

std::optional<ProbeHandle> handle_at(std::span<const ProbeDesc> probes, const Camera &camera,
                                     const glm::vec2 &pixel, const glm::vec2 &viewport) {
    std::optional<ProbeHandle> nearest;
    float least = handle_reach;
    for (std::size_t p = 0; p < probes.size(); ++p) {
        const std::vector<glm::dvec3> handles = probe_handles(probes[p]);
        for (std::size_t h = 0; h < handles.size(); ++h) {
            const glm::vec3 seen = camera.project(glm::vec3(handles[h]), viewport);
            const float away = glm::distance(glm::vec2(seen), pixel);
            if (seen.z <= 1 && away <= least) {
                least = away;
                nearest = ProbeHandle{p, h};
            }
        }
    }
    return nearest;
}

Around around(std::span<const ProbeAnswer> answers) {
    glm::dvec3 low(std::numeric_limits<double>::max());
    glm::dvec3 high(std::numeric_limits<double>::lowest());
    for (const ProbeAnswer &answer : answers)
        for_each_place(answer, [&](const glm::dvec3 &place) {
            low = glm::min(low, place);
            high = glm::max(high, place);
        });
    if (!(low.x <= high.x))
        return {};
    return {glm::vec3(0.5 * (low + high)), static_cast<float>(0.5 * glm::length(high - low))};
}

} // namespace plumb
