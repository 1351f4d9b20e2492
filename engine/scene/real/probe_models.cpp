// Model probes: meshes in the frames of other meshes.
#include "engine/scene/real/probe_asking.h"

#include "engine/core/check.h"
#include "engine/space/model_scene.h"

#include <algorithm>
#include <map>

namespace plumb::inline PLUMB_PRECISION {

void answer_models(Asking &ask) {
    // Meshes in their own frames; the models place them.
    std::vector<MeshTree> meshes;
    for (const ProbeShapeDesc &shape : ask.probe.shapes) {
        PLUMB_CHECK(std::holds_alternative<MeshDesc>(shape.shape),
                    "a model must be a mesh, got " << shape_name(shape.shape));
        ProbeShapeDesc local = shape;
        local.position = glm::dvec3(0);
        local.orientation = glm::dquat(1, 0, 0, 0);
        meshes.push_back(std::get<MeshTree>(make_shape(local).shape));
    }
    ModelScene scene;
    std::map<std::string, ModelScene::Model> model_of;
    std::vector<ModelScene::Model> models;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const ProbeShapeDesc &shape = ask.probe.shapes[i];
        const auto parent = model_of.find(shape.parent);
        const Placement local{Vec3{shape.position}, unit(Quat{shape.orientation}), Real(1)};
        models.push_back(scene.add(&meshes[i], local,
                                   parent == model_of.end() ? ModelScene::none : parent->second));
        if (!shape.name.empty())
            model_of[shape.name] = models.back();
    }
    const std::optional<ModelScene::Hit> hit = scene.raycast(ray_of(*ask.probe.ray));
    std::vector<ModelScene::Model> touched;
    if (!ask.probe.points.empty()) {
        const glm::dvec3 &at = ask.probe.points.front();
        touched = scene.overlapping(Sphere{Vec3{at}, static_cast<Real>(ask.probe.margin)});
        ask.answer.solids.push_back(
            {SphereDesc{ask.probe.margin}, at, {1, 0, 0, 0}, ProbeTone::query, 0});
        ask.count("found", touched.size());
    }
    for (std::size_t i = 0; i < models.size(); ++i) {
        const Placement &world = scene.world(models[i]);
        ProbeShapeDesc placed = ask.probe.shapes[i];
        placed.position = wide(world.position);
        placed.orientation = glm::dquat{world.rotation};
        const bool is_hit = hit && hit->model == models[i];
        const bool is_touched = std::ranges::find(touched, models[i]) != touched.end();
        draw_shape(ask.answer, placed, make_shape(placed),
                   is_hit       ? ProbeTone::yes
                   : is_touched ? ProbeTone::partly
                                : ProbeTone::plain,
                   i);
        draw_edges(ask.answer, scene.bounds(models[i]), ProbeTone::faint);
        const ModelScene::Model parent = scene.parent(models[i]);
        if (parent != ModelScene::none)
            ask.answer.lines.push_back({wide(scene.world(parent).position), wide(world.position),
                                        ProbeTone::axis, true, true});
        ask.answer.labels.push_back({placed.position, placed.name});
    }
    ask.count("models", scene.size());
    show_hit(ask, hit);
}

} // namespace plumb::inline PLUMB_PRECISION
