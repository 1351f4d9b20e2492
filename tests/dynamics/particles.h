// What tests of particles and springs share.
#pragma once

#include "tests/dynamics/worlds.h"

namespace plumb::inline PLUMB_PRECISION {
namespace trial {

inline ParticleDef particle_at(const V &position, double mass = 1, bool pinned = false) {
    ParticleDef def;
    def.position = narrow(position);
    def.mass = Real(mass);
    def.pinned = pinned;
    return def;
}
inline ParticleDef moving_particle(const V &position, const V &velocity, double mass = 1) {
    ParticleDef def = particle_at(position, mass);
    def.velocity = narrow(velocity);
    return def;
}

inline SpringEnd of_particle(std::uint32_t index) {
    return {SpringEnd::Kind::particle, index, Vec3{Real(0)}};
}
inline SpringEnd of_body(BodyId id, const V &anchor) {
    return {SpringEnd::Kind::body, id.index, narrow(anchor)};
}
inline SpringEnd of_world(const V &point) {
    return {SpringEnd::Kind::world, 0, narrow(point)};
}
inline SpringDef spring(const SpringEnd &a, const SpringEnd &b, double rest_length,
                        double stiffness, double damping = 0) {
    SpringDef def;
    def.a = a;
    def.b = b;
    def.rest_length = Real(rest_length);
    def.stiffness = Real(stiffness);
    def.damping = Real(damping);
    return def;
}

inline V particle_position(const World &world, std::uint32_t index) {
    return wide(world.state().particles[index].position);
}
inline V particle_velocity(const World &world, std::uint32_t index) {
    return wide(world.state().particles[index].velocity);
}

inline std::vector<std::string> spring_methods() {
    std::vector<std::string> names;
    for (const Method &method : methods())
        if (method.info.springs)
            names.emplace_back(method.info.name);
    return names;
}
inline std::vector<std::string> particle_contact_methods() {
    std::vector<std::string> names;
    for (const Method &method : methods())
        if (method.info.springs && method.info.contacts)
            names.emplace_back(method.info.name);
    return names;
}

} // namespace trial
} // namespace plumb::inline PLUMB_PRECISION
