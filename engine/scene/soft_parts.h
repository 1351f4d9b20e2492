// All particles and springs of a scene, cloth expanded, in the world's order: single particles,
// then those of each cloth; the same for springs.
#pragma once

#include "engine/scene/scene_desc.h"

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

// A cloth's ranges among all particles and springs.
struct ClothInfo {
    std::string name;
    std::size_t first_particle = 0, particle_count = 0;
    std::size_t first_spring = 0, spring_count = 0;
    struct Triangle {
        std::array<std::uint32_t, 3> corners{}; // particles of the world
        std::array<std::uint32_t, 3> sides{}; // springs of the world; a torn one opens the triangle
    };
    std::vector<Triangle> triangles;
    std::optional<glm::vec3> colour; // cloth's or material's
};

struct ParticleInfo {
    ParticleState start;
    double mass = 0; // kg
    double radius = 0;
    bool pinned = false;
    std::string material;
    std::optional<std::size_t> cloth; // it belongs to
    std::optional<glm::vec3> colour;  // particle's or material's
};

struct SpringEndInfo {
    enum class Kind { world, particle, body };
    Kind kind = Kind::world;
    std::size_t index = 0;      // of the particle or body
    glm::dvec3 anchor_local{0}; // in the body's frame, or in the world
};

struct SpringInfo {
    SpringEndInfo a, b;
    double rest_length = 0; // m
    double stiffness = 0;   // N/m
    double damping = 0;     // N s/m
    double tear_strain = 0; // 0: never
    bool torn = false;      // at the start
    std::optional<std::size_t> cloth;
};

// The end's current position.
glm::dvec3 place_of(const SpringEndInfo &end, const std::vector<BodyState> &bodies,
                    const std::vector<ParticleState> &particles);

class SoftParts {
  public:
    SoftParts() = default; // nothing soft
    // Bodies keep their index in the scene. Throws std::invalid_argument for a spring end that
    // names nothing in the scene, which cannot happen for a scene that was read.
    explicit SoftParts(const SceneDesc &scene);

    bool empty() const { return particles.empty() && springs.empty(); }

    // "bob"; for a cloth's particles see cloth.h.
    std::string particle_name(std::size_t particle) const;
    std::optional<std::size_t> find_particle(std::string_view name) const;
    // Mass of everything that may pull at it (kg): its whole cloth, or all particles without one.
    double mass_around(std::size_t particle) const;
    bool has_name(std::string_view name) const;        // a particle or a cloth
    std::string spring_name(std::size_t spring) const; // the cloth's name for its springs
    std::optional<std::size_t> find_spring(std::string_view name) const; // not cloth springs

    std::vector<ParticleInfo> particles;
    std::vector<SpringInfo> springs;
    std::vector<ClothInfo> cloths;

  private:
    void add(const SceneDesc &scene, const ClothDesc &cloth);

    using Indices = std::map<std::string, std::size_t, std::less<>>;
    std::vector<ClothDesc> descs_;                           // of the cloths
    std::vector<std::string> particle_names_, spring_names_; // without cloth
    Indices particles_by_name_, springs_by_name_, cloths_by_name_;
};

} // namespace plumb
