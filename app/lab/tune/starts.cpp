#include "app/lab/tune/starts.h"

#include "engine/core/random.h"
#include "engine/scene/file/change.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace plumb {

namespace {

void shift(BodyDesc &body, Random &random) {
    const glm::dvec3 &p = body.position;
    const double size =
        std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z), smallest_width(body)});
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
        SceneFileResult result = parse_scene(text.text, text.path.string(), {}, changed);
        return result.ok() ? std::move(result.scene) : scene;
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
    }
    return starts;
}

} // namespace plumb
