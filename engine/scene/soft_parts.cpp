#include "engine/scene/soft_parts.h"

#include "engine/scene/cloth.h"

#include <algorithm>
#include <stdexcept>

namespace plumb {

namespace {

std::optional<glm::vec3> colour_of(const SceneDesc &scene, const std::optional<glm::vec3> &own,
                                   const std::string &material) {
    const auto found = std::ranges::find(scene.materials, material, &MaterialDesc::name);
    return own || found == scene.materials.end() ? own : found->colour;
}

} // namespace

glm::dvec3 place_of(const SpringEndInfo &end, const std::vector<BodyState> &bodies,
                    const std::vector<ParticleState> &particles) {
    switch (end.kind) {
    case SpringEndInfo::Kind::world:
        break;
    case SpringEndInfo::Kind::particle:
        return particles.at(end.index).position;
    case SpringEndInfo::Kind::body: {
        const BodyState &body = bodies.at(end.index);
        return body.position + body.orientation * end.anchor_local;
    }
    }
    return end.anchor_local;
}

SoftParts::SoftParts(const SceneDesc &scene) {
    for (const ParticleDesc &particle : scene.particles) {
        particles_by_name_[particle.name] = particles.size();
        particle_names_.push_back(particle.name);
        particles.push_back({{particle.position, particle.velocity},
                             particle.mass,
                             particle.radius,
                             particle.pinned,
                             particle.material,
                             std::nullopt,
                             colour_of(scene, particle.colour, particle.material)});
    }
    springs.resize(scene.springs.size());
    for (const ClothDesc &cloth : scene.cloths)
        add(scene, cloth);
    if (scene.springs.empty())
        return;
    std::map<std::string_view, std::size_t> bodies;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
        bodies[scene.bodies[i].name] = i;
    const auto end_of = [&](const std::string &name, const glm::dvec3 &anchor) -> SpringEndInfo {
        using Kind = SpringEndInfo::Kind;
        if (name.empty())
            return {Kind::world, 0, anchor};
        if (const auto body = bodies.find(name); body != bodies.end())
            return {Kind::body, body->second, anchor};
        if (const auto particle = find_particle(name))
            return {Kind::particle, *particle, glm::dvec3(0)};
        throw std::invalid_argument("there is no particle or body \"" + name + '"');
    };
    for (std::size_t i = 0; i < scene.springs.size(); ++i) {
        const SpringDesc &desc = scene.springs[i];
        springs_by_name_[desc.name] = i;
        spring_names_.push_back(desc.name);
        springs[i] = {end_of(desc.a, desc.anchor_a_local),
                      end_of(desc.b, desc.anchor_b_local),
                      desc.rest_length,
                      desc.stiffness,
                      desc.damping,
                      desc.tear_strain,
                      desc.torn,
                      std::nullopt};
    }
}

void SoftParts::add(const SceneDesc &scene, const ClothDesc &cloth) {
    const ClothParts parts = cloth_parts(cloth);
    const std::size_t index = cloths.size();
    ClothInfo info;
    info.name = cloth.name;
    info.first_particle = particles.size();
    info.particle_count = parts.places.size();
    info.first_spring = springs.size();
    info.spring_count = parts.springs.size();
    info.colour = colour_of(scene, cloth.colour, cloth.material);
    for (std::size_t i = 0; i < parts.places.size(); ++i) {
        ParticleInfo particle;
        particle.start = start_of(cloth, static_cast<std::uint32_t>(i));
        particle.mass = cloth.mass / static_cast<double>(parts.places.size());
        particle.radius = cloth.radius;
        particle.pinned = std::ranges::binary_search(cloth.pins, i);
        particle.material = cloth.material;
        particle.cloth = index;
        particle.colour = info.colour;
        particles.push_back(particle);
    }
    using Kind = SpringEndInfo::Kind;
    for (const ClothSpring &spring : parts.springs)
        springs.push_back({{Kind::particle, info.first_particle + spring.a, glm::dvec3(0)},
                           {Kind::particle, info.first_particle + spring.b, glm::dvec3(0)},
                           spring.rest_length,
                           stiffness_of(cloth, spring.kind),
                           cloth.damping,
                           cloth.tear_strain,
                           false,
                           index});
    for (const std::uint32_t torn : cloth.torn)
        springs.at(info.first_spring + torn).torn = true;
    for (const ClothTriangle &triangle : parts.triangles) {
        ClothInfo::Triangle &made = info.triangles.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            made.corners[k] = static_cast<std::uint32_t>(info.first_particle) + triangle.corners[k];
            made.sides[k] = static_cast<std::uint32_t>(info.first_spring) + triangle.sides[k];
        }
    }
    cloths_by_name_[cloth.name] = index;
    descs_.push_back(cloth);
    descs_.back().particles.clear();
    cloths.push_back(std::move(info));
}

std::string SoftParts::particle_name(std::size_t particle) const {
    const std::optional<std::size_t> cloth = particles.at(particle).cloth;
    return cloth
               ? plumb::particle_name(descs_[*cloth], static_cast<std::uint32_t>(
                                                          particle - cloths[*cloth].first_particle))
               : particle_names_[particle];
}

std::optional<std::size_t> SoftParts::find_particle(std::string_view name) const {
    if (const auto own = particles_by_name_.find(name); own != particles_by_name_.end())
        return own->second;
    const std::size_t bracket = name.rfind('[');
    if (bracket == std::string_view::npos)
        return std::nullopt;
    const auto cloth = cloths_by_name_.find(name.substr(0, bracket));
    if (cloth == cloths_by_name_.end())
        return std::nullopt;
    const std::optional<std::uint32_t> found =
        plumb::find_particle(descs_[cloth->second], name.substr(bracket));
    return found ? std::optional(cloths[cloth->second].first_particle + *found) : std::nullopt;
}

double SoftParts::mass_around(std::size_t particle) const {
    double mass = 0;
    for (const ParticleInfo &other : particles)
        if (other.cloth == particles.at(particle).cloth)
            mass += other.mass;
    return mass;
}

bool SoftParts::has_name(std::string_view name) const {
    return particles_by_name_.contains(name) || cloths_by_name_.contains(name);
}

std::string SoftParts::spring_name(std::size_t spring) const {
    const std::optional<std::size_t> cloth = springs.at(spring).cloth;
    return cloth ? cloths[*cloth].name : spring_names_[spring];
}

std::optional<std::size_t> SoftParts::find_spring(std::string_view name) const {
    const auto found = springs_by_name_.find(name);
    return found == springs_by_name_.end() ? std::nullopt : std::optional(found->second);
}

} // namespace plumb
