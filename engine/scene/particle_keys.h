// The keys of [[attractor]], [[particle]], [[spring]] and [[cloth]] in scene files. The reader, the
// writer and the reference in scenes/README.md come from these tables.
#pragma once

#include "engine/scene/file/bounds.h"
#include "engine/scene/particle_desc.h"

#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace plumb {

template <typename Desc> struct ParticleKey {
    using Member = std::variant<std::monostate, bool Desc::*, double Desc::*, glm::dvec3 Desc::*>;
    std::string_view name;
    // The member it sets; none: read and written by hand.
    Member member;
    scene_file::Bounds bounds; // for numbers
    std::string_view about;
    std::string_view by_default;
    std::string_view also{}; // alternative keys for the same thing: "or `frequency`"
};

std::span<const ParticleKey<AttractorDesc>> attractor_keys();
std::span<const ParticleKey<ParticleDesc>> particle_keys();
std::span<const ParticleKey<SpringDesc>> spring_keys();
std::span<const ParticleKey<ClothDesc>> cloth_keys();

// The keys of each as Markdown tables for scenes/README.md.
std::string attractor_reference();
std::string particle_reference();
std::string spring_reference();
std::string cloth_reference();

} // namespace plumb
