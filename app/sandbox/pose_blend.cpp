#include "app/sandbox/pose_blend.h"

#include <algorithm>
#include <cstddef>

namespace plumb {

std::vector<Pose> poses_of(const Simulation &simulation) {
    std::vector<Pose> poses(simulation.body_count());
    for (std::size_t body = 0; body < poses.size(); ++body) {
        const BodyState state = simulation.body_state(body);
        poses[body] = {state.position, state.orientation};
    }
    return poses;
}

std::vector<Pose> blend(const std::vector<Pose> &previous, const std::vector<Pose> &present,
                        double alpha) {
    std::vector<Pose> blended = present;
    if (alpha >= 1)
        return blended;
    const std::size_t common = std::min(previous.size(), present.size());
    for (std::size_t body = 0; body < common; ++body) {
        const Pose &from = previous[body];
        const Pose &to = present[body];
        if (alpha <= 0) {
            blended[body] = from;
            continue;
        }
        blended[body].position = glm::mix(from.position, to.position, alpha);
        const double side = glm::dot(from.orientation, to.orientation) < 0 ? -1.0 : 1.0;
        const glm::dquat sum = from.orientation * (1 - alpha) + to.orientation * (side * alpha);
        blended[body].orientation = glm::normalize(sum);
    }
    return blended;
}

} // namespace plumb
