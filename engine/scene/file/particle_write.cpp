#include "engine/scene/file/text.h"
#include "engine/scene/particle_keys.h"

#include <algorithm>

namespace plumb::scene_file {

namespace {

std::string line(std::string_view key, const std::string &value) {
    return std::string(key) + " = " + value + "\n";
}

// The lines of all keys that have a member and a non-default value.
template <typename Desc>
std::string member_lines(std::span<const ParticleKey<Desc>> keys, const Desc &desc) {
    const Desc plain;
    std::string text;
    for (const ParticleKey<Desc> &key : keys) {
        const auto write = [&](auto member) {
            if constexpr (std::is_same_v<decltype(member), bool Desc::*>) {
                if (desc.*member)
                    text += line(key.name, "true");
            } else if constexpr (std::is_same_v<decltype(member), double Desc::*>) {
                if (!same_bits(desc.*member, plain.*member))
                    text += line(key.name, shortest(desc.*member));
            } else if constexpr (std::is_same_v<decltype(member), glm::dvec3 Desc::*>) {
                if (!same_bits(desc.*member, plain.*member))
                    text += line(key.name, array3(desc.*member));
            }
        };
        std::visit(write, key.member);
    }
    return text;
}

template <typename Desc> std::string look_lines(const Desc &desc) {
    return (desc.material.empty() ? "" : line("material", string(desc.material))) +
           (desc.colour ? line("color", array3(*desc.colour)) : "");
}

// In square brackets, ten to a line.
template <typename Values, typename Text>
std::string list(const Values &values, const Text &text_of) {
    std::string text = "[";
    std::size_t count = 0;
    for (const auto &value : values)
        text += (count++ == 0 ? "" : count % 10 == 1 ? ",\n    " : ", ") + text_of(value);
    return text + "]";
}

std::string end_lines(std::string_view key, const std::string &name, const glm::dvec3 &anchor,
                      bool has_anchor) {
    return line(key, string(name.empty() ? "world" : name)) +
           (has_anchor ? line("anchor_" + std::string(key) + (name.empty() ? "" : "_local"),
                              array3(anchor))
                       : "");
}

} // namespace

std::string attractor_text(const AttractorDesc &attractor) {
    return line("name", string(attractor.name)) + member_lines(attractor_keys(), attractor);
}

std::string particle_text(const ParticleDesc &particle) {
    return line("name", string(particle.name)) + member_lines(particle_keys(), particle) +
           look_lines(particle);
}

std::string spring_text(const SpringDesc &spring) {
    const auto has_anchor = [](const std::string &name, const glm::dvec3 &anchor) {
        return name.empty() || !same_bits(anchor, {0, 0, 0});
    };
    return line("name", string(spring.name)) +
           end_lines("a", spring.a, spring.anchor_a_local,
                     has_anchor(spring.a, spring.anchor_a_local)) +
           end_lines("b", spring.b, spring.anchor_b_local,
                     has_anchor(spring.b, spring.anchor_b_local)) +
           line("rest_length", shortest(spring.rest_length)) +
           line("stiffness", shortest(spring.stiffness)) +
           (same_bits(spring.damping, 0) ? "" : line("damping", shortest(spring.damping))) +
           member_lines(spring_keys(), spring);
}

std::string cloth_text(const ClothDesc &cloth) {
    std::string text = line("name", string(cloth.name));
    if (cloth.mesh)
        text += line("file", string(cloth.file.name)) + line("scale", shortest(cloth.file.scale));
    else
        text += line("cells", "[" + std::to_string(cloth.cells[0]) + ", " +
                                  std::to_string(cloth.cells[1]) + "]") +
                line("size", "[" + shortest(cloth.size.x) + ", " + shortest(cloth.size.y) + "]");
    text += member_lines(cloth_keys(), cloth);
    const glm::dquat &q = cloth.orientation;
    if (!same_bits(q.w, 1) || !same_bits({q.x, q.y, q.z}, {0, 0, 0}))
        text += line("orientation", rotation(q));
    text += look_lines(cloth);
    const auto columns = static_cast<std::uint32_t>(cloth.cells[0] + 1);
    if (!cloth.pins.empty())
        text += line("pins", list(cloth.pins, [&](std::uint32_t pin) {
                         return cloth.mesh ? std::to_string(pin)
                                           : "[" + std::to_string(pin % columns) + ", " +
                                                 std::to_string(pin / columns) + "]";
                     }));
    if (!cloth.particles.empty()) {
        text += line("positions", list(cloth.particles, [](const ParticleState &particle) {
                         return array3(particle.position);
                     }));
        text += line("velocities", list(cloth.particles, [](const ParticleState &particle) {
                         return array3(particle.velocity);
                     }));
    }
    if (!cloth.torn.empty())
        text += line("torn",
                     list(cloth.torn, [](std::uint32_t spring) { return std::to_string(spring); }));
    return text;
}

} // namespace plumb::scene_file
