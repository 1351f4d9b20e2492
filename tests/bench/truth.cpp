#include "tests/bench/truth.h"

#include "app/lab/interrupt.h"

#include <algorithm>
#include <cmath>

namespace plumb {

Trial::Trial(const EngineKind &kind, SceneDesc desc)
    : scene_(std::move(desc)), measures_(scene_), engine_(kind.create(scene_)) {
    if (!engine_)
        throw CannotRun(kind.name);
    states_ = engine_->states();
}

void Trial::go(double seconds, const std::function<void()> &each) {
    const auto steps = static_cast<std::size_t>(std::lround(seconds / scene_.dt()));
    for (std::size_t step = 0; step < steps; ++step) {
        if (InterruptGuard::requested())
            throw Interrupted("interrupted");
        engine_->step();
        ++steps_;
        states_ = engine_->states();
        if (!is_finite(states_) || !std::isfinite(energy()))
            throw Diverged("after " + std::to_string(time()) + " s");
        each();
    }
}

double Trial::worst(double seconds, const std::function<double()> &measure) {
    double most = 0;
    go(seconds, [&] { most = std::max(most, measure()); });
    return most;
}

double Trial::energy() const {
    double energy = 0;
    for (std::size_t i = 0; i < states_.size(); ++i) {
        const auto &[mass, inertia] = scene_.masses[i];
        const BodyState &state = states_[i];
        const glm::dvec3 spin = glm::conjugate(state.orientation) * state.angular_velocity;
        energy += 0.5 * mass * glm::dot(state.velocity, state.velocity) +
                  0.5 * glm::dot(inertia, spin * spin) -
                  mass * glm::dot(scene_.gravity(), state.position);
    }
    return energy;
}

glm::dvec3 Trial::angular_momentum() const {
    glm::dvec3 sum(0);
    for (std::size_t i = 0; i < states_.size(); ++i) {
        const auto &[mass, inertia] = scene_.masses[i];
        const BodyState &state = states_[i];
        const glm::dvec3 spin = glm::conjugate(state.orientation) * state.angular_velocity;
        sum += mass * glm::cross(state.position, state.velocity) +
               state.orientation * (inertia * spin);
    }
    return sum;
}

std::vector<Problem> all_problems() {
    std::vector<Problem> problems;
    for (auto more : {motion_problems(), contact_problems(), joint_problems(), standing_problems(),
                      fast_problems()})
        problems.insert(problems.end(), more.begin(), more.end());
    return problems;
}

} // namespace plumb
