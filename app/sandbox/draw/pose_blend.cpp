#include "app/sandbox/draw/pose_blend.h"

#include <algorithm>
#include <cstddef>

namespace plumb {

std::vector<BodyState> blend(const std::vector<BodyState> &previous,
                             const std::vector<BodyState> &present, double alpha) {
    std::vector<BodyState> blended = present;
    if (alpha >= 1)
        return blended;
    const std::size_t common = std::min(previous.size(), present.size());
    for (std::size_t body = 0; body < common; ++body) {
        const BodyState &from = previous[body];
        const BodyState &to = present[body];
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

std::vector<ParticleState> blend(const std::vector<ParticleState> &previous,
                                 const std::vector<ParticleState> &present, double alpha) {
    std::vector<ParticleState> blended = present;
    if (alpha >= 1)
        return blended;
    const std::size_t common = std::min(previous.size(), present.size());
    for (std::size_t i = 0; i < common; ++i)
        blended[i].position = alpha <= 0
                                  ? previous[i].position
                                  : glm::mix(previous[i].position, present[i].position, alpha);
    return blended;
}

} // namespace plumb
