#include "app/lab/tune/starts.h"

#include "engine/core/random.h"
#include "engine/scene/cloth.h"
#include "engine/scene/file/change.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace plumb {

namespace {

double size_of(const glm::dvec3 &p, double width) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z), width});
}

void shift(glm::dvec3 &position, double width, Random &random) {
    const double size = size_of(position, width);
    for (int axis = 0; axis < 3; ++axis)
        position[axis] += random.next_in(-1, 1) * start_shift * size;
}

void shift(ClothDesc &cloth, Random &random) {
    const auto count = static_cast<std::uint32_t>(particle_count(cloth));
    if (cloth.particles.empty())
        for (std::uint32_t i = 0; i < count; ++i)
            cloth.particles.push_back(start_of(cloth, i));
    for (std::uint32_t i = 0; i < count; ++i)
        if (!std::ranges::binary_search(cloth.pins, i))
            shift(cloth.particles[i].position, 2 * cloth.radius, random);
}

void shift(BodyDesc &body, Random &random) {
    const double size = size_of(body.position, smallest_width(body));
    for (int axis = 0; axis < 3; ++axis) {
        const double by = random.next_in(-1, 1) * start_shift * size;
        if (body.locked[static_cast<std::size_t>(axis)])
            continue;
        body.position[axis] += by;
        if (body.mass_pose)
            body.mass_pose->position[axis] += by;
    }
}

SceneDesc with_seed(const SceneText &text, const SceneDesc &scene, std::uint64_t seed) {
    try {
        std::vector<ChangedNumber> changed = text.changed;
        changed.push_back({"world.seed", static_cast<double>(seed)});
        const SceneFileResult result = parse_scene(text.text, text.path.string(), {}, changed);
        return result.ok() ? result.scene : scene;
    } catch (const std::invalid_argument &) { // it has no [world]
        return scene;
    }
}

} // namespace

std::vector<SceneDesc> starts_of(const SceneText &text, int others) {
    const SceneDesc scene = parse_scene(text.text, text.path.string(), {}, text.changed).scene;
    std::vector<SceneDesc> starts{scene};
    for (int i = 1; i <= others; ++i) {
        const auto number = static_cast<std::uint64_t>(i);
        const std::uint64_t seed = number + (number >= scene.world.seed ? 1 : 0);
        SceneDesc &start = starts.emplace_back(with_seed(text, scene, seed));
        Random random(seed);
        for (BodyDesc &body : start.bodies)
            if (body.kind == BodyKind::dynamic)
                shift(body, random);
        for (ParticleDesc &particle : start.particles)
            if (!particle.pinned)
                shift(particle.position, 2 * particle.radius, random);
        for (ClothDesc &cloth : start.cloths)
            shift(cloth, random);
    }
    return starts;
}

} // namespace plumb
