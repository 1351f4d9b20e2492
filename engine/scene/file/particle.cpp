#include "engine/scene/file/particle.h"

#include "engine/scene/cloth.h"
#include "engine/scene/file/number.h"
#include "engine/scene/file/spelling.h"
#include "engine/scene/scene_limits.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace plumb::scene_file {

namespace {

// One end of a spring, at the start.
struct SpringEnd {
    std::string name; // empty: the world
    glm::dvec3 anchor_local{0};
    glm::dvec3 place{0};
    double inv_mass = 0; // 1/kg; 0 if it never moves
};

// Finds a cloth's particle if the name starts with a cloth's. Reports one that the cloth lacks.
bool find_cloth_particle(const Reading &reading, const Table &table, std::string_view key,
                         const std::string &name, std::optional<SpringEnd> &end) {
    const std::size_t bracket = name.rfind('[');
    const auto cloth = reading.cloths_by_name.find(name.substr(0, bracket));
    if (cloth == reading.cloths_by_name.end())
        return false;
    const ClothDesc &desc = reading.scene.cloths[cloth->second];
    const std::optional<std::uint32_t> particle =
        bracket == std::string::npos ? std::nullopt : find_particle(desc, name.substr(bracket));
    if (!particle) {
        table.error(
            key,
            bracket == std::string::npos
                ? "the cloth " + in_quotes(name) + " has many particles"
                : "the cloth " + in_quotes(desc.name) + " has no particle " + name.substr(bracket),
            "name one of " + in_quotes(particle_name(desc, 0)) + " to " +
                in_quotes(
                    particle_name(desc, static_cast<std::uint32_t>(particle_count(desc) - 1))));
        return true;
    }
    end = SpringEnd{name, glm::dvec3(0), start_of(desc, *particle).position,
                    std::ranges::binary_search(desc.pins, *particle)
                        ? 0
                        : static_cast<double>(particle_count(desc)) / desc.mass};
    return true;
}

// Empty, with an error reported, when the name is unknown.
std::optional<SpringEnd> find_end(Reading &reading, const Table &table, std::string_view key) {
    if (is_world(table, key))
        return SpringEnd{};
    const std::optional<std::string> name = table.string(key);
    if (!name)
        return std::nullopt;
    const SceneDesc &scene = reading.scene;
    if (const auto found = reading.particles_by_name.find(*name);
        found != reading.particles_by_name.end()) {
        const ParticleDesc &particle = scene.particles[found->second];
        return SpringEnd{*name, glm::dvec3(0), particle.position,
                         particle.pinned ? 0 : 1 / particle.mass};
    }
    std::optional<SpringEnd> end;
    const bool is_body = reading.bodies_by_name.contains(*name) || reading.groups.contains(*name);
    if (!is_body && find_cloth_particle(reading, table, key, *name, end))
        return end;
    if (!is_body && (!scene.particles.empty() || !scene.cloths.empty())) {
        table.error(key, "there is no particle or body " + in_quotes(*name),
                    ++reading.missing_bodies > 100 ? ""
                    : scene.particles.empty()      ? reading.cloths.suggestion(*name)
                                                   : reading.particles.suggestion(*name));
        return std::nullopt;
    }
    const std::optional<std::size_t> index = find_body(reading, table, key);
    if (!index)
        return std::nullopt;
    const BodyDesc &body = scene.bodies[*index];
    return SpringEnd{*name, glm::dvec3(0), body.position,
                     body.kind == BodyKind::dynamic ? 1 / mass_of(scene, body) : 0};
}

void read_anchor(const Reading &reading, const Table &table, const std::string &key,
                 SpringEnd &end) {
    const std::string local_key = key + "_local";
    const auto body = reading.bodies_by_name.find(end.name);
    const bool is_body =
        !reading.particles_by_name.contains(end.name) && body != reading.bodies_by_name.end();
    if (!end.name.empty() && !is_body) {
        for (const std::string &each : {key, local_key})
            if (table.has(each))
                table.error(each, "a particle has no " + each, "it is pulled at its centre");
        return;
    }
    const std::string_view chosen = table.one_of(
        {key, local_key}, end.name.empty(), key + " = [x, y, z] is a point in world coordinates");
    const std::optional<glm::dvec3> point =
        chosen.empty() ? std::nullopt : table.vector(chosen, moderate);
    if (!point)
        return;
    if (!is_body) {
        end.anchor_local = end.place = *point;
        return;
    }
    const BodyDesc &desc = reading.scene.bodies[body->second];
    const bool is_local = chosen == local_key;
    end.anchor_local =
        is_local ? *point : glm::conjugate(desc.orientation) * (*point - desc.position);
    end.place = is_local ? desc.position + desc.orientation * *point : *point;
}

// Reduced mass of the ends alone on the spring (kg), immovable ends being infinitely heavy;
// infinite when neither moves.
double reduced_mass(const SpringEnd &a, const SpringEnd &b) {
    return 1 / (a.inv_mass + b.inv_mass);
}

void read_rest_length(const Table &table, const SpringEnd &a, const SpringEnd &b,
                      SpringDesc &spring) {
    if (table.has("rest_length")) {
        spring.rest_length = table.number("rest_length", positive).value_or(spring.rest_length);
        return;
    }
    const double length = glm::distance(a.place, b.place);
    if (length >= positive.min && length <= positive.max)
        spring.rest_length = length;
    else
        table.error("rest_length",
                    "the ends of " + table.title() + " are " + shortest(length) +
                        " m apart, which cannot be its rest length",
                    "give it a rest_length: " + std::string(positive.text));
}

void read_pull(const Table &table, double mass, SpringDesc &spring) {
    const std::string_view how =
        table.one_of({"stiffness", "frequency"}, true, "how stiff is it, in N/m or Hz?");
    if (how == "stiffness") {
        spring.stiffness = table.number(how, positive).value_or(spring.stiffness);
    } else if (how == "frequency") {
        const double omega = 2 * std::numbers::pi * table.number(how, positive).value_or(1);
        spring.stiffness = mass * omega * omega;
    }
    const std::string_view brake = table.one_of({"damping", "damping_ratio"}, false, "");
    if (brake == "damping")
        spring.damping = table.number(brake, not_negative).value_or(0);
    else if (brake == "damping_ratio")
        spring.damping =
            2 * table.number(brake, not_negative).value_or(0) * std::sqrt(spring.stiffness * mass);
    if (!std::isfinite(mass))
        return; // already reported
    for (const auto &[key, value, bounds] : {std::tuple(how, spring.stiffness, positive),
                                             std::tuple(brake, spring.damping, not_negative)})
        if ((key == "frequency" || key == "damping_ratio") &&
            !(value >= bounds.min && value <= bounds.max))
            table.error(key,
                        std::string(key) + " gives a " +
                            (key == "frequency" ? "stiffness" : "damping") + " of " +
                            shortest(value),
                        "it must be " + std::string(bounds.text));
}

} // namespace

std::string read_end_name(Reading &reading, const Table &table, const std::string &kind,
                          Names &names) {
    const std::string name = read_name(reading.report, table, kind, names).value_or("");
    const auto refuse_if = [&](bool is_taken, const char *by) {
        if (is_taken)
            table.error(
                "name", std::string("a ") + by + " is already named " + in_quotes(name),
                "springs and expectations refer to bodies, particles and cloths by name alone");
    };
    refuse_if(reading.bodies_by_name.contains(name), "body");
    refuse_if(kind != "particle" && reading.particles_by_name.contains(name), "particle");
    return name;
}

bool is_particle(const Reading &reading, const std::string &name) {
    if (reading.particles_by_name.contains(name) || reading.bodies_by_name.contains(name))
        return !reading.bodies_by_name.contains(name);
    const std::size_t bracket = name.rfind('[');
    const auto cloth = reading.cloths_by_name.find(name.substr(0, bracket));
    return bracket != std::string::npos && cloth != reading.cloths_by_name.end() &&
           find_particle(reading.scene.cloths[cloth->second], name.substr(bracket));
}

void read_particle(Reading &reading, const toml::table &source) {
    static const std::vector<std::string_view> keys = key_names(particle_keys());
    const Table table(reading.report, source, title_of("particle", source), keys);
    ParticleDesc particle;
    particle.name = read_end_name(reading, table, "particle", reading.particles);
    read_members(table, particle_keys(), particle);
    particle.material = read_material_name(reading, table);
    particle.colour = table.colour("color");
    if (particle.pinned && particle.velocity != glm::dvec3(0))
        reading.report.error(table.key_position("velocity"), "a pinned particle has no velocity",
                             "it never moves");
    if (!has_room_for(reading, 1, max_scene_particles, reading.particle_count, "particles",
                      table.position()))
        return;
    ++reading.particle_count;
    reading.particles_by_name.try_emplace(particle.name, reading.scene.particles.size());
    reading.scene.particles.push_back(std::move(particle));
    reading.positions.particles.push_back(table.position());
}

void read_attractor(Reading &reading, const toml::table &source) {
    static const std::vector<std::string_view> keys = key_names(attractor_keys());
    const Table table(reading.report, source, title_of("attractor", source), keys);
    AttractorDesc attractor;
    attractor.name = read_name(reading.report, table, "attractor", reading.attractors).value_or("");
    read_members(table, attractor_keys(), attractor);
    if (has_room_for(reading, 1, max_scene_attractors, reading.scene.attractors.size(),
                     "attractors", table.position()))
        reading.scene.attractors.push_back(std::move(attractor));
}

void read_spring(Reading &reading, const toml::table &source) {
    static const std::vector<std::string_view> keys = [] {
        std::vector<std::string_view> all = key_names(spring_keys());
        all.insert(all.end(), {"b", "anchor_b", "anchor_b_local", "frequency", "damping_ratio"});
        return all;
    }();
    const Table table(reading.report, source, title_of("spring", source), keys);
    SpringDesc spring;
    spring.name = read_name(reading.report, table, "spring", reading.springs).value_or("");
    read_members(table, spring_keys(), spring);
    const bool only_world = is_world(table, "a") && is_world(table, "b");
    std::optional<SpringEnd> a = find_end(reading, table, "a");
    std::optional<SpringEnd> b = find_end(reading, table, "b");
    if (only_world)
        reading.report.error(table.position(), table.title() + " joins the world to itself",
                             "give a or b the name of a particle or a body");
    else if (a && b && a->name == b->name)
        table.error("b", table.title() + " joins " + in_quotes(a->name) + " to itself",
                    "a and b must differ");
    else if (a && b) {
        const std::size_t errors = reading.report.error_count();
        read_anchor(reading, table, "anchor_a", *a);
        read_anchor(reading, table, "anchor_b", *b);
        const double mass = reduced_mass(*a, *b);
        for (const std::string_view key : {"frequency", "damping_ratio"})
            if (table.has(key) && !std::isfinite(mass))
                table.error(key,
                            "neither end of " + table.title() + " moves, so it has no " +
                                std::string(key),
                            "give its stiffness and damping");
        read_pull(table, mass, spring);
        if (reading.report.error_count() == errors)
            read_rest_length(table, *a, *b, spring);
        spring.a = a->name;
        spring.b = b->name;
        spring.anchor_a_local = a->anchor_local;
        spring.anchor_b_local = b->anchor_local;
    }
    if (!has_room_for(reading, 1, max_scene_springs, reading.spring_count, "springs",
                      table.position()))
        return;
    ++reading.spring_count;
    reading.scene.springs.push_back(std::move(spring));
    reading.positions.springs.push_back(table.position());
}

} // namespace plumb::scene_file
