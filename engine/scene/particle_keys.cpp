#include "engine/scene/particle_keys.h"

#include <array>

namespace plumb {

namespace {

using scene_file::moderate;
using scene_file::not_negative;
using scene_file::positive;

constexpr std::monostate by_hand{};
constexpr std::string_view needed = "**needed**";

constexpr std::array all_attractor_keys{
    ParticleKey<AttractorDesc>{"name", by_hand, moderate, "", needed},
    ParticleKey<AttractorDesc>{"position", &AttractorDesc::position, moderate, "`[x, y, z]`",
                               "the origin"},
    ParticleKey<AttractorDesc>{"gravitational_parameter", &AttractorDesc::gravitational_parameter,
                               positive,
                               "m³/s², positive: the gravitational constant times its mass", "1"},
    ParticleKey<AttractorDesc>{"radius", &AttractorDesc::radius, positive,
                               "m, positive: of the ball it is drawn as", "0.1"},
};

constexpr std::array all_particle_keys{
    ParticleKey<ParticleDesc>{"name", by_hand, moderate,
                              "not `\"world\"`, and no body's or cloth's", needed},
    ParticleKey<ParticleDesc>{"position", &ParticleDesc::position, moderate, "`[x, y, z]`",
                              "the origin"},
    ParticleKey<ParticleDesc>{"velocity", &ParticleDesc::velocity, moderate,
                              "m/s; not for a pinned particle", "0"},
    ParticleKey<ParticleDesc>{"mass", &ParticleDesc::mass, positive, "kg, positive", "1"},
    ParticleKey<ParticleDesc>{"radius", &ParticleDesc::radius, positive,
                              "m, positive: it collides with bodies as a ball of this radius",
                              "0.02"},
    ParticleKey<ParticleDesc>{"pinned", &ParticleDesc::pinned, moderate,
                              "true: it never moves, whatever pulls on it", "false"},
    ParticleKey<ParticleDesc>{"material", by_hand, moderate,
                              "name of a material, for friction and restitution",
                              "one with the defaults above"},
    ParticleKey<ParticleDesc>{"color", by_hand, moderate, "overrides the material's", ""},
};

constexpr std::array all_spring_keys{
    ParticleKey<SpringDesc>{"name", by_hand, moderate, "", needed},
    ParticleKey<SpringDesc>{
        "a", by_hand, moderate,
        "what it is attached to: the name of a particle, a cloth's particle or a body",
        "`\"world\"`", "`b`"},
    ParticleKey<SpringDesc>{"anchor_a", by_hand, moderate,
                            "attachment point on a body or the world, in world coordinates at the "
                            "start; not for particles",
                            "the body's position; for the world **needed**", "`anchor_b`"},
    ParticleKey<SpringDesc>{"anchor_a_local", by_hand, moderate,
                            "alternatively, in the body's frame", "", "`anchor_b_local`"},
    ParticleKey<SpringDesc>{"rest_length", by_hand, positive, "m, positive",
                            "the distance between its ends at the start"},
    ParticleKey<SpringDesc>{
        "stiffness", by_hand, positive,
        "N/m, positive; or Hz, positive: the natural frequency of its two ends alone", needed,
        "*or* `frequency`"},
    ParticleKey<SpringDesc>{"damping", by_hand, not_negative,
                            "N s/m; or a ratio: at 1 or more it settles without oscillating", "0",
                            "*or* `damping_ratio`"},
    ParticleKey<SpringDesc>{"tear_strain", &SpringDesc::tear_strain, not_negative,
                            "it tears when longer than (1 + `tear_strain`) `rest_length`",
                            "0: never"},
    ParticleKey<SpringDesc>{"torn", &SpringDesc::torn, moderate,
                            "whether it is torn; for saved scenes", "false"},
};

constexpr std::array all_cloth_keys{
    ParticleKey<ClothDesc>{"name", by_hand, moderate,
                           "not `\"world\"`, and no body's or particle's", needed},
    ParticleKey<ClothDesc>{"position", &ClothDesc::position, moderate, "of its frame, `[x, y, z]`",
                           "the origin"},
    ParticleKey<ClothDesc>{"rotation", by_hand, moderate, "as for a body", "none"},
    ParticleKey<ClothDesc>{
        "cells", by_hand, moderate,
        "`[nx, nz]`, each a whole number from 1 to 1000: a grid of (nx + 1) (nz + 1) particles in "
        "the xz plane of its frame, centred",
        "`[10, 10]`"},
    ParticleKey<ClothDesc>{"size", by_hand, positive, "`[x, z]` m, positive: of the grid",
                           "`[1, 1]`"},
    ParticleKey<ClothDesc>{"file", by_hand, moderate,
                           "instead of a grid, the vertices and edges of a Wavefront OBJ file "
                           "beside the scene, times `scale`",
                           "", "`scale` (1)"},
    ParticleKey<ClothDesc>{"mass", &ClothDesc::mass, positive,
                           "kg, positive: in total, shared evenly by its particles", "1"},
    ParticleKey<ClothDesc>{"radius", &ClothDesc::radius, positive,
                           "m, positive: its particles collide with bodies as balls of this radius",
                           "0.01"},
    ParticleKey<ClothDesc>{
        "stretch", &ClothDesc::stretch, not_negative,
        "N/m, of the springs along the sides of its cells, or with a `file` along its edges",
        "1000"},
    ParticleKey<ClothDesc>{"shear", &ClothDesc::shear, not_negative,
                           "N/m, of those along both diagonals of each cell; not with a `file`",
                           "500"},
    ParticleKey<ClothDesc>{"bend", &ClothDesc::bend, not_negative,
                           "N/m, of those from each particle to the next but one; with a `file`, "
                           "across each edge between two triangles",
                           "10"},
    ParticleKey<ClothDesc>{"damping", &ClothDesc::damping, not_negative,
                           "N s/m, of each of these springs", "0.1"},
    ParticleKey<ClothDesc>{"tear_strain", &ClothDesc::tear_strain, not_negative,
                           "as for a spring, for each of them", "0: never"},
    ParticleKey<ClothDesc>{
        "pins", by_hand, moderate,
        "which particles never move: `\"corners\"`, `\"edge\"` (the row of lowest z), `\"border\"` "
        "(all four edges), or an array of `[i, j]`, the i-th along x of the j-th row along z, from "
        "0; with a `file`, an array of vertex indices, from 0",
        "none"},
    ParticleKey<ClothDesc>{"material", by_hand, moderate,
                           "name of a material, for friction and restitution",
                           "one with the defaults above"},
    ParticleKey<ClothDesc>{"color", by_hand, moderate, "overrides the material's", ""},
    ParticleKey<ClothDesc>{"positions", by_hand, moderate,
                           "of all its particles, and its torn springs by number; for saved scenes",
                           "", "`velocities`, `torn`"},
};

template <typename Desc>
std::string reference(std::string_view kind, std::span<const ParticleKey<Desc>> keys) {
    std::string text =
        "| key of `[[" + std::string(kind) + "]]` | value | default |\n|---|---|---|\n";
    for (const ParticleKey<Desc> &key : keys) {
        const std::string also(key.also);
        text += "| `" + std::string(key.name) + "`" +
                (also.empty()          ? ""
                 : also.front() == '`' ? ", " + also
                                       : " " + also) +
                " | " + std::string(key.about) + " | " + std::string(key.by_default) + " |\n";
    }
    return text;
}

} // namespace

std::span<const ParticleKey<AttractorDesc>> attractor_keys() {
    return all_attractor_keys;
}
std::span<const ParticleKey<ParticleDesc>> particle_keys() {
    return all_particle_keys;
}
std::span<const ParticleKey<SpringDesc>> spring_keys() {
    return all_spring_keys;
}
std::span<const ParticleKey<ClothDesc>> cloth_keys() {
    return all_cloth_keys;
}

std::string attractor_reference() {
    return reference("attractor", attractor_keys());
}
std::string particle_reference() {
    return reference("particle", particle_keys());
}
std::string spring_reference() {
    return reference("spring", spring_keys());
}
std::string cloth_reference() {
    return reference("cloth", cloth_keys());
}

} // namespace plumb
