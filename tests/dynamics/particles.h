// Helpers shared by the particle and spring tests.
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

// n by n particles in a level square with a pinned edge, and springs between neighbours.
struct NetOf {
    int n = 2;
    double side = 1;
    V middle{0};
    double mass = 1; // total
    double stiffness = 0;
    double damping = 0;
};
inline void add_net(World &world, const NetOf &net) {
    const int n = net.n;
    const double cell = net.side / (n - 1);
    const auto first = std::uint32_t(world.state().particles.size());
    const auto at = [&](int i, int j) { return of_particle(first + std::uint32_t(i * n + j)); };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            world.add_particle(
                particle_at(net.middle + V{i * cell - net.side / 2, 0, j * cell - net.side / 2},
                            net.mass / (n * n), i % (n - 1) == 0 || j % (n - 1) == 0));
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (const auto &[to_i, to_j] : {std::pair{i + 1, j}, std::pair{i, j + 1}})
                if (to_i < n && to_j < n)
                    world.add_spring(
                        spring(at(i, j), at(to_i, to_j), cell, net.stiffness, net.damping));
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
