#include "tests/bench/engine.h"

#include <algorithm>

namespace plumb {

EngineScene::EngineScene(SceneDesc scene) : desc(std::move(scene)) {
    const auto simulation = Simulation::create(desc, {}, nullptr);
    dt_ = simulation->settings().dt;
    gravity_ = simulation->settings().gravity;
    for (std::size_t body = 0; body < desc.bodies.size(); ++body) {
        const BodyInfo &info = simulation->body_info(body);
        masses.push_back({info.mass, info.inertia});
        indices_[info.name] = body;
    }
}

const MaterialDesc &EngineScene::material(const BodyDesc &body) const {
    static const MaterialDesc by_default;
    const auto named = std::ranges::find(desc.materials, body.material, &MaterialDesc::name);
    return named == desc.materials.end() ? by_default : *named;
}

std::size_t EngineScene::body(const std::string &name) const {
    return indices_.at(name);
}

} // namespace plumb
