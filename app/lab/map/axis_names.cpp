#include "app/lab/map/axis_names.h"

#include "engine/scene/file/change.h"
#include "engine/scene/file/spelling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

namespace plumb {

namespace {

constexpr std::array all_names{
    AxisName{"stiffness", "of the one spring (N/m, even if the file gives its frequency), else of "
                          "the one cloth (its stretch, N/m) or soft joint (its frequency, Hz)"},
    AxisName{"damping", "of the one spring (N s/m), else of the one cloth (N s/m), soft joint (its "
                        "damping_ratio) or body (its linear_damping, 1/s)"},
    AxisName{"friction", "of the one material"},
    AxisName{"mass_ratio", "the mass of the heaviest moving body or particle, over that of the "
                           "lightest, whose mass stays"},
    AxisName{"height", "how many bodies the one stack, row or pyramid has upwards, else the y "
                       "position (m) of the highest moving body or particle that nothing holds"},
    AxisName{"speed", "of the fastest body or particle at the start (m/s), in the direction in "
                      "which it moves"},
    AxisName{"distance", "from the fastest body or particle at the start to the nearest other "
                         "body, particle or attractor, centre to centre (m): it starts elsewhere "
                         "on the line between them"},
};

// All that an answer is made of.
struct Asked {
    const MapAxis &axis;
    std::string_view text;
    const SceneDesc &scene;
};

// "body.a.mass, body.b.mass, ..."
std::string listed(const std::vector<std::string> &paths, std::size_t most) {
    std::string all;
    for (std::size_t i = 0; i < std::min(paths.size(), most); ++i)
        all += (i > 0 ? ", " : "") + paths[i];
    if (paths.size() > most)
        all += ", and " + std::to_string(paths.size() - most) + " more";
    return all;
}

[[noreturn]] void refuse_name(const Asked &asked, const std::string &why) {
    constexpr std::size_t most = 24;
    const std::vector<std::string> numbers = number_paths(asked.text);
    throw std::invalid_argument(
        "axis \"" + asked.axis.name + "\": " + why +
        (numbers.empty() ? "" : ". The numbers of this scene are " + listed(numbers, most)));
}

[[noreturn]] void refuse_choice(const Asked &asked, const std::vector<std::string> &paths) {
    constexpr std::size_t most = 8;
    throw std::invalid_argument("axis \"" + asked.axis.name + "\": this scene has " +
                                std::to_string(paths.size()) + "; give one of " +
                                listed(paths, most));
}

MapAxis at_path(const Asked &asked, const std::string &path) {
    MapAxis axis = asked.axis;
    axis.name = path;
    return axis;
}

// The only path of these; nullopt if there are none.
std::optional<MapAxis> only_of(const Asked &asked, const std::vector<std::string> &paths) {
    if (paths.empty())
        return std::nullopt;
    if (paths.size() > 1)
        refuse_choice(asked, paths);
    return at_path(asked, paths.front());
}

// Where a key stands in a file: "[[spring]]", "stiffness".
struct KeyPlace {
    std::string_view list, key;
    std::string_view other_way; // another key that gives the same number; may be empty
};

// The paths of that key in those of the list's tables that give it, one way or another.
std::vector<std::string> given_in(const Asked &asked, const KeyPlace &place) {
    std::vector<std::string> given = number_paths(asked.text, place.key);
    if (!place.other_way.empty())
        for (std::string &path : number_paths(asked.text, place.other_way))
            given.push_back(std::move(path));
    std::vector<std::string> paths;
    for (const std::string &table : table_paths(asked.text, place.list))
        if (std::ranges::any_of(std::array{place.key, place.other_way}, [&](std::string_view key) {
                return !key.empty() &&
                       std::ranges::find(given, table + "." + std::string(key)) != given.end();
            }))
            paths.push_back(table + "." + std::string(place.key));
    return paths;
}

// In the first of these lists that gives the number; else in the first that could.
MapAxis in_first(const Asked &asked, std::span<const KeyPlace> places, std::size_t with_default,
                 const std::string &why_none) {
    for (const KeyPlace &place : places)
        if (std::optional<MapAxis> found = only_of(asked, given_in(asked, place)))
            return *found;
    for (const KeyPlace &place : places.first(with_default)) {
        std::vector<std::string> paths = table_paths(asked.text, place.list);
        for (std::string &path : paths)
            path.append(".").append(place.key);
        if (std::optional<MapAxis> found = only_of(asked, paths))
            return *found;
    }
    refuse_name(asked, why_none);
}

// A body or particle that a table of the file describes, with all of its copies.
struct Movable {
    std::string path; // "body.ball"
    double mass = 0;
    glm::dvec3 position{0}, velocity{0}; // of the first copy
    bool repeated = false, held = false; // by a joint or a spring
};

bool is_held(const SceneDesc &scene, const std::string &name) {
    return std::ranges::any_of(scene.joints,
                               [&](const JointDesc &joint) {
                                   return joint.body_a == name || joint.body_b == name;
                               }) ||
           std::ranges::any_of(scene.springs, [&](const SpringDesc &spring) {
               return spring.a == name || spring.b == name;
           });
}

// All that may move.
std::vector<Movable> movables(const Asked &asked) {
    std::vector<Movable> found;
    const auto named = [](const std::string &path) { return path.substr(path.find('.') + 1); };
    for (const std::string &path : table_paths(asked.text, "body")) {
        const std::string name = named(path), first = name + "_0";
        const auto body = std::ranges::find_if(asked.scene.bodies, [&](const BodyDesc &each) {
            return each.name == name || each.name == first;
        });
        if (body != asked.scene.bodies.end() && body->kind != BodyKind::static_body)
            found.push_back({path,
                             body->kind == BodyKind::dynamic ? mass_of(asked.scene, *body) : 0,
                             body->position, body->velocity, body->name != name,
                             is_held(asked.scene, body->name)});
    }
    for (const std::string &path : table_paths(asked.text, "particle")) {
        const auto particle =
            std::ranges::find(asked.scene.particles, named(path), &ParticleDesc::name);
        if (particle != asked.scene.particles.end() && !particle->pinned)
            found.push_back({path, particle->mass, particle->position, particle->velocity, false,
                             is_held(asked.scene, particle->name)});
    }
    return found;
}

// The one with the largest value, of those where it is finite; refuses if several have it, with
// the paths of that key. Null if none has a finite one.
template <typename Value>
const Movable *most_of(const Asked &asked, const std::vector<Movable> &all, const Value &value,
                       const std::string &key) {
    constexpr double alike = 1e-6; // relative
    const Movable *most = nullptr;
    for (const Movable &each : all)
        if (std::isfinite(value(each)) && (most == nullptr || value(each) > value(*most)))
            most = &each;
    std::vector<std::string> paths;
    for (const Movable &each : all)
        if (most != nullptr && std::isfinite(value(each)) &&
            value(*most) - value(each) <= alike * std::abs(value(*most)))
            paths.push_back(each.path + key);
    if (paths.size() > 1)
        refuse_choice(asked, paths);
    return most;
}

constexpr double no_value = -HUGE_VAL;

MapAxis along_mass_ratio(const Asked &asked) {
    std::vector<Movable> all = movables(asked);
    std::erase_if(all, [](const Movable &each) { return !(each.mass > 0); });
    if (all.size() < 2)
        refuse_name(asked,
                    "this scene has no two bodies or particles to compare, unless as copies");
    const Movable *heaviest = most_of(
        asked, all, [](const Movable &each) { return each.mass; }, ".mass");
    const double lightest = std::ranges::min(all, {}, &Movable::mass).mass;
    MapAxis axis = asked.axis;
    axis.numbers = {{heaviest->path + ".mass", lightest, 0}};
    return axis;
}

// The counts of those repeats that pile their copies up.
std::vector<std::string> piles(const Asked &asked) {
    std::vector<std::string> paths;
    const std::vector<std::string> counts = number_paths(asked.text, "count"),
                                   bases = number_paths(asked.text, "base");
    const auto has = [](const std::vector<std::string> &all, const std::string &path) {
        return std::ranges::find(all, path) != all.end();
    };
    for (const std::string &body : table_paths(asked.text, "body")) {
        const std::string name = body.substr(body.find('.') + 1), repeat = body + ".repeat.";
        const auto copy = [&](const char *number) {
            return std::ranges::find(asked.scene.bodies, name + number, &BodyDesc::name);
        };
        const auto first = copy("_0"), second = copy("_1");
        const bool is_column =
            first != asked.scene.bodies.end() && second != asked.scene.bodies.end() &&
            first->position.x == second->position.x && first->position.z == second->position.z &&
            first->position.y < second->position.y;
        if (has(bases, repeat + "base"))
            paths.push_back(repeat + "base");
        else if (has(counts, repeat + "count") && is_column)
            paths.push_back(repeat + "count");
        else if (has(counts, repeat + "count.y") && first != asked.scene.bodies.end() &&
                 std::ranges::any_of(asked.scene.bodies, [&](const BodyDesc &each) {
                     return each.name.starts_with(name + "_") &&
                            each.position.y > first->position.y;
                 }))
            paths.push_back(repeat + "count.y");
    }
    return paths;
}

MapAxis along_height(const Asked &asked) {
    if (std::optional<MapAxis> pile = only_of(asked, piles(asked)))
        return *pile;
    const std::vector<Movable> all = movables(asked);
    const Movable *highest = most_of(
        asked, all, [](const Movable &each) { return each.held ? no_value : each.position.y; },
        ".position.y");
    if (highest == nullptr)
        refuse_name(asked, "this scene has neither a stack nor anything that moves freely");
    return at_path(asked, highest->path + ".position.y");
}

constexpr std::string_view components = "xyz";

std::string component_path(const Movable &mover, const char *key, int i) {
    return mover.path + key + components[static_cast<std::size_t>(i)];
}

// At the start.
Movable fastest_of(const Asked &asked) {
    const std::vector<Movable> all = movables(asked);
    const auto speed = [](const Movable &each) {
        const double length = glm::length(each.velocity);
        return length > 0 ? length : no_value;
    };
    const Movable *found = most_of(asked, all, speed, ".velocity");
    if (found == nullptr)
        refuse_name(asked, "nothing in this scene moves at the start, so none is the fastest");
    return *found;
}

MapAxis along_speed(const Asked &asked) {
    const Movable fastest = fastest_of(asked);
    const glm::dvec3 direction = fastest.velocity / glm::length(fastest.velocity);
    MapAxis axis = asked.axis;
    for (int i = 0; i < 3; ++i) {
        if (direction[i] == 1)
            return at_path(asked, component_path(fastest, ".velocity.", i));
        if (direction[i] != 0)
            axis.numbers.push_back({component_path(fastest, ".velocity.", i), direction[i], 0});
    }
    return axis;
}

MapAxis along_distance(const Asked &asked) {
    const Movable mover = fastest_of(asked);
    if (mover.repeated)
        refuse_name(asked, mover.path + " has copies, each at its own distance");
    const std::string own = mover.path.substr(mover.path.find('.') + 1);
    std::vector<glm::dvec3> others;
    for (const BodyDesc &body : asked.scene.bodies)
        if (body.name != own && !has_plane(body))
            others.push_back(body.position);
    for (const ParticleDesc &particle : asked.scene.particles)
        if (particle.name != own)
            others.push_back(particle.position);
    for (const AttractorDesc &attractor : asked.scene.attractors)
        others.push_back(attractor.position);
    if (others.empty())
        refuse_name(asked, "there is nothing else in this scene for " + mover.path +
                               " to be at a distance from");
    const auto how_far = [&](const glm::dvec3 &other) {
        return glm::distance(other, mover.position);
    };
    const glm::dvec3 nearest = std::ranges::min(others, {}, how_far);
    constexpr double alike = 1e-6; // relative
    if (std::ranges::count_if(others, [&](const glm::dvec3 &other) {
            return how_far(other) <= (1 + alike) * how_far(nearest);
        }) > 1)
        refuse_name(asked, mover.path + " is as far from several things");
    if (!(how_far(nearest) > 0))
        refuse_name(asked, mover.path + " starts at the centre of what is nearest to it");
    const glm::dvec3 direction = glm::normalize(mover.position - nearest);
    MapAxis axis = asked.axis;
    for (int i = 0; i < 3; ++i)
        if (direction[i] != 0)
            axis.numbers.push_back(
                {component_path(mover, ".position.", i), direction[i], nearest[i]});
    return axis;
}

// For a word that is neither a setting, nor a name above, nor a key of the scene.
std::string why_unknown(const Asked &asked) {
    std::vector<std::string> words;
    for (const SettingNumber number : setting_numbers())
        words.push_back(setting_name(number));
    for (const AxisName &each : all_names)
        words.emplace_back(each.name);
    for (const std::string &path : number_paths(asked.text))
        words.push_back(path.substr(path.rfind('.') + 1));
    const std::vector<std::string_view> candidates(words.begin(), words.end());
    const std::string_view nearest = nearest_word(asked.axis.name, candidates);
    std::string why = "there is no such setting, and no such number in this scene";
    if (!nearest.empty())
        why.append("; did you mean \"").append(nearest).append("\"?");
    return why;
}

} // namespace

std::span<const AxisName> axis_names() {
    return all_names;
}

MapAxis named_axis(MapAxis axis, std::string_view scene_text, const SceneDesc &scene) {
    if (axis.setting || axis.name.find('.') != std::string::npos)
        return axis;
    const Asked asked{axis, scene_text, scene};
    static constexpr std::array stiffnesses{KeyPlace{"spring", "stiffness", "frequency"},
                                            KeyPlace{"cloth", "stretch", ""},
                                            KeyPlace{"joint", "frequency", ""}};
    static constexpr std::array dampings{
        KeyPlace{"spring", "damping", "damping_ratio"}, KeyPlace{"cloth", "damping", ""},
        KeyPlace{"joint", "damping_ratio", ""}, KeyPlace{"body", "linear_damping", ""}};
    static constexpr std::array frictions{KeyPlace{"material", "friction", ""}};
    if (axis.name == "stiffness")
        return in_first(asked, stiffnesses, 2, "this scene has no spring, cloth or soft joint");
    if (axis.name == "damping")
        return in_first(asked, dampings, 2,
                        "this scene has no spring or cloth, and gives no damping of a joint or "
                        "body");
    if (axis.name == "friction")
        return in_first(asked, frictions, 1,
                        "this scene has no material; add a [[material]] to change its friction");
    if (axis.name == "mass_ratio")
        return along_mass_ratio(asked);
    if (axis.name == "height")
        return along_height(asked);
    if (axis.name == "speed")
        return along_speed(asked);
    if (axis.name == "distance")
        return along_distance(asked);
    if (std::optional<MapAxis> found = only_of(asked, number_paths(scene_text, axis.name)))
        return *found;
    refuse_name(asked, why_unknown(asked));
}

} // namespace plumb
