// Shared by the tables of particles, springs and cloth. Not for users of the engine.
#pragma once

#include "engine/scene/file/reading.h"
#include "engine/scene/particle_keys.h"

namespace plumb::scene_file {

template <typename Desc>
std::vector<std::string_view> key_names(std::span<const ParticleKey<Desc>> keys) {
    std::vector<std::string_view> names;
    for (const ParticleKey<Desc> &key : keys)
        names.push_back(key.name);
    return names;
}

// Reads all keys that have a member.
template <typename Desc>
void read_members(const Table &table, std::span<const ParticleKey<Desc>> keys, Desc &desc) {
    for (const ParticleKey<Desc> &key : keys) {
        const auto read = [&](auto member) {
            if constexpr (std::is_same_v<decltype(member), bool Desc::*>)
                desc.*member = table.boolean(key.name).value_or(desc.*member);
            else if constexpr (std::is_same_v<decltype(member), double Desc::*>)
                desc.*member = table.number(key.name, key.bounds).value_or(desc.*member);
            else if constexpr (std::is_same_v<decltype(member), glm::dvec3 Desc::*>)
                desc.*member = table.vector(key.name, key.bounds).value_or(desc.*member);
        };
        std::visit(read, key.member);
    }
}

// The table's own name, which must be unique among bodies, particles and cloths, since a spring's
// ends may name any of them.
std::string read_end_name(Reading &reading, const Table &table, const std::string &kind,
                          Names &names);

// Whether the name is that of a particle, cloth particles included.
bool is_particle(const Reading &reading, const std::string &name);

} // namespace plumb::scene_file
