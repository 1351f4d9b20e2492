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
    // What it is the value of; none: it is read and written by hand.
    Member member;
    scene_file::Bounds bounds; // of a number
    std::string_view about;
    std::string_view by_default;
    std::string_view also{}; // other keys that say the same in their own way: "or `frequency`"
};

std::span<const ParticleKey<AttractorDesc>> attractor_keys();
std::span<const ParticleKey<ParticleDesc>> particle_keys();
std::span<const ParticleKey<SpringDesc>> spring_keys();
std::span<const ParticleKey<ClothDesc>> cloth_keys();

// As tables in Markdown: what scenes/README.md says of the keys of each.
std::string attractor_reference();
std::string particle_reference();
std::string spring_reference();
std::string cloth_reference();

} // namespace plumb
