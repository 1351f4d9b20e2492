// A running scene as a draw list.
#pragma once

#include "app/render/draw_list.h"
#include "app/sandbox/draw/pose_blend.h"
#include "app/sandbox/session/session.h"
#include "engine/scene/simulation.h"

#include <optional>
#include <vector>

namespace plumb {

// What is drawn besides the bodies.
struct WorldDrawOptions {
    bool contacts = false; // points with normals and normal forces; also impacts
    bool joints = false;   // anchors, and whatever connects them
    bool bounds = false;   // the bodies' AABBs
    bool velocities = false;
    bool wireframe = false;
    bool shadows = true;
    bool grid = true;
    std::optional<std::size_t> selected;
    std::optional<std::size_t> hovered;
    std::optional<std::size_t> selected_particle;
    std::optional<std::size_t> hovered_particle;
    std::optional<GrabView> grab;
    std::vector<SeenImpact> impacts; // drawn with the contacts
};

// The camera that the scene asks for.
[[nodiscard]] Camera camera_of(const CameraDesc &camera);

// `poses` and `particles` are the ones to show, one per body and particle, or empty for the current
// ones. Contacts and joints are those of the last step, moved along with the bodies shown;
// velocities are those of the last step.
[[nodiscard]] DrawList draw_world(const Simulation &simulation, const Camera &camera,
                                  const WorldDrawOptions &options = {},
                                  const std::vector<BodyState> &poses = {},
                                  const std::vector<ParticleState> &particles = {});

// Draws the moving parts of another simulation, translucent and pale, on top of the list.
void add_ghost(DrawList &list, const Simulation &simulation, const std::vector<BodyState> &poses,
               const std::vector<ParticleState> &particles);

// A sphere around one body; without one, around everything that can move (particles and cloth too),
// else around everything but planes. Half a metre at the origin if there is nothing.
struct Around {
    glm::vec3 centre{0};
    float radius = 0.5f;
};
[[nodiscard]] Around around(const Simulation &simulation, std::optional<std::size_t> body = {});

} // namespace plumb
