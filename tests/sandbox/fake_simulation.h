// A world simple enough to know by heart, for testing the code around a world: points in free fall.
#pragma once

#include "app/sandbox/session/session.h"
#include "engine/core/hash.h"
#include "engine/dynamics/method_info.h"

#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace plumb {

class FakeSimulation final : public Simulation {
  public:
    std::optional<std::uint64_t> throws_at;   // the step from this count on throws
    std::optional<std::uint64_t> diverges_at; // the step from this count on gives NaN
    std::vector<Command> commands;            // in order
    double advance_time = 0;                  // s, reported by each step
    void set_save_bytes(std::size_t bytes) { state_.bytes = bytes; }

    explicit FakeSimulation(const SceneDesc &scene) {
        scene.world.settings.apply_to(settings_);
        for (const BodyDesc &body : scene.bodies)
            insert(body);
    }

    using Simulation::read;
    using Simulation::save;
    using Simulation::step;
    void step(StepTimes *times) override {
        if (throws_at == state_.steps)
            throw std::runtime_error("as told");
        for (std::size_t i = 0; i < state_.bodies.size(); ++i) {
            if (infos_[i].kind != BodyKind::dynamic)
                continue;
            state_.bodies[i].velocity += settings_.gravity * settings_.dt;
            state_.bodies[i].position += state_.bodies[i].velocity * settings_.dt;
        }
        if (diverges_at == state_.steps) {
            state_.bodies.back().position.y = std::numeric_limits<double>::quiet_NaN();
            report_.finite = false;
        }
        ++state_.steps;
        if (times)
            times->advance += advance_time;
    }
    std::uint64_t step_count() const override { return state_.steps; }
    double time() const override { return static_cast<double>(state_.steps) * settings_.dt; }
    const StepReport &report() const override { return report_; }
    double energy() const override { return static_cast<double>(step_count()); }
    Measures measure() const override { return {}; }
    std::uint64_t hash() const override {
        StateHash hash;
        hash.add(state_.steps);
        for (const BodyState &body : state_.bodies) {
            for (int i = 0; i < 3; ++i) {
                hash.add(body.position[i]);
                hash.add(body.velocity[i]);
            }
        }
        return hash.value();
    }

    const MethodInfo &method() const override { return method_infos().front(); }
    const StepSettings &settings() const override { return settings_; }
    Precision precision() const override { return Precision::f64; }
    void apply(const Command &command) override {
        commands.push_back(command);
        if (const auto *changed = std::get_if<SetSettings>(&command)) {
            StepSettings settings = settings_;
            changed->settings.apply_to(settings);
            if (!(settings.dt > 0))
                throw std::invalid_argument("dt must be positive");
            settings_ = settings;
        } else if (const auto *added = std::get_if<AddBody>(&command)) {
            insert(added->body);
        } else if (const auto *removed = std::get_if<RemoveBody>(&command)) {
            infos_.at(find_body(removed->body).value()).alive = false;
        }
    }

    struct State final : Saved {
        std::size_t bytes = 0; // reported size of a save
        std::size_t bytes_beside(const Saved *) const override { return bytes; }
        std::uint64_t steps = 0;
        std::vector<BodyState> bodies;
    };
    std::unique_ptr<Saved> save(std::unique_ptr<Saved>, const Saved *) const override {
        return std::make_unique<State>(state_);
    }
    void restore(const Saved &saved) override {
        state_ = dynamic_cast<const State &>(saved);
        infos_.resize(state_.bodies.size());
        report_.finite = true;
    }
    SceneDesc describe() const override { return {}; }

    std::size_t body_count() const override { return state_.bodies.size(); }
    const BodyInfo &body_info(std::size_t body) const override { return infos_.at(body); }
    std::optional<std::size_t> find_body(std::string_view name) const override {
        for (std::size_t i = 0; i < infos_.size(); ++i)
            if (infos_[i].name == name)
                return i;
        return {};
    }
    const std::string &joint_name(std::size_t) const override { return infos_.front().name; }
    void read(Frame &into, const FrameParts &) const override {
        into = {};
        into.step_count = state_.steps;
        into.time = time();
        into.bodies = state_.bodies;
    }

    // Spheres only.
    std::optional<Pick> pick(const glm::dvec3 &origin, const glm::dvec3 &direction) const override {
        std::optional<Pick> nearest;
        const double a = glm::dot(direction, direction);
        for (std::size_t i = 0; i < infos_.size(); ++i) {
            const auto *sphere = std::get_if<SphereDesc>(&infos_[i].colliders.front().shape);
            if (!sphere)
                continue;
            const glm::dvec3 to = state_.bodies[i].position - origin;
            const double b = glm::dot(to, direction);
            const double root = b * b - a * (glm::dot(to, to) - sphere->radius * sphere->radius);
            const double t = root >= 0 ? (b - std::sqrt(root)) / a : -1;
            if (t >= 0 && (!nearest || t < nearest->t))
                nearest = Pick{i, t, origin + direction * t, {}};
        }
        return nearest;
    }

  private:
    void insert(const BodyDesc &body) {
        BodyInfo info;
        info.alive = true;
        info.name = body.name;
        info.kind = body.kind;
        info.colliders = body.colliders;
        info.mass = 1;
        infos_.push_back(info);
        state_.bodies.push_back(
            {body.position, body.orientation, body.velocity, body.angular_velocity});
    }

    StepSettings settings_;
    StepReport report_;
    State state_;
    std::vector<BodyInfo> infos_;
};

inline Session::Make make_fake() {
    return
        [](const SceneDesc &scene, const RunOptions &, TaskPool *) -> std::unique_ptr<Simulation> {
            if (scene.name == "impossible")
                throw std::invalid_argument("no method can run it");
            return std::make_unique<FakeSimulation>(scene);
        };
}

// A weightless ball of radius 1 at the origin, and one beside it.
inline SceneDesc two_balls() {
    SceneDesc scene;
    scene.name = "two_balls";
    scene.world.settings.give(&StepSettings::gravity, glm::dvec3(0));
    for (const double x : {0.0, 5.0}) {
        BodyDesc ball;
        ball.name = x == 0.0 ? "left" : "right";
        ball.colliders.emplace_back().shape = SphereDesc{1};
        ball.position = {x, 0, 0};
        ball.velocity = {0, 0.25, 0};
        scene.bodies.push_back(ball);
    }
    scene.camera.target = glm::dvec3(0);
    scene.camera.yaw = 0;
    scene.camera.pitch = 0;
    return scene;
}

} // namespace plumb
