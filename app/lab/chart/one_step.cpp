#include "app/lab/chart/one_step.h"

#include "app/lab/run/accurate_run.h"
#include "app/lab/run/judged_run.h"
#include "app/lab/run/run_text.h"
#include "app/lab/run/sweep.h"
#include "engine/core/check.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <glm/geometric.hpp>

namespace plumb {

namespace {

constexpr double shortest_frame = 1.0 / 60; // s
// Collision detection runs once per step, so for impacts the steps matter, not the substeps.
constexpr int steps_a_frame = 64, substeps_a_step = 4;
constexpr std::size_t gone_along = 16; // uncounted frames per stretch, at most
// All frames of the accurate run are states if there are at most `most_frames`; otherwise that
// many, in `stretch_count` stretches.
constexpr std::size_t most_frames = 600, stretch_count = 10;

SceneDesc without_memory(SceneDesc scene) {
    scene.contacts.clear();
    scene.expects.clear();
    scene.probes.clear();
    scene.step_count = 0;
    for (BodyDesc &body : scene.bodies)
        body.pace = {};
    for (JointDesc &joint : scene.joints) {
        joint.impulses.fill(0);
        joint.penalties.fill(0);
    }
    return scene;
}

// Sets poses, velocities and broken or torn parts; the solver's memory stays.
void put_state(SceneDesc &scene, const Frame &frame, const SoftParts &soft) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        BodyDesc &body = scene.bodies[i];
        const BodyState &state = frame.bodies[i];
        body.mass_pose.reset();
        body.position = state.position;
        body.orientation = state.orientation;
        body.velocity = state.velocity;
        body.angular_velocity = state.angular_velocity;
    }
    for (const JointView &joint : frame.joints)
        scene.joints[joint.joint].broken = joint.broken;
    for (std::size_t i = 0; i < scene.particles.size(); ++i) {
        scene.particles[i].position = frame.particles[i].position;
        scene.particles[i].velocity = frame.particles[i].velocity;
    }
    for (std::size_t i = 0; i < scene.springs.size(); ++i)
        scene.springs[i].torn = frame.torn[i] != 0;
    for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
        const ClothInfo &info = soft.cloths[c];
        ClothDesc &cloth = scene.cloths[c];
        const auto first =
            frame.particles.begin() + static_cast<std::ptrdiff_t>(info.first_particle);
        cloth.particles.assign(first, first + static_cast<std::ptrdiff_t>(info.particle_count));
        cloth.torn.clear();
        for (std::uint32_t i = 0; i < info.spring_count; ++i)
            if (frame.torn[info.first_spring + i] != 0)
                cloth.torn.push_back(i);
    }
}

double angle_between(const glm::dquat &a, const glm::dquat &b) {
    const glm::dquat turn = glm::conjugate(a) * b;
    return 2 * std::atan2(glm::length(glm::dvec3(turn.x, turn.y, turn.z)), std::abs(turn.w));
}

} // namespace

OneStepStates::OneStepStates(const SceneDesc &scene, const OneStepOptions &options)
    : start_(without_memory(scene)), stop_(options.stop) {
    const double dt = resolve_run(scene, options.base).settings.dt;
    frame_ = dt * std::max(1.0, std::ceil(shortest_frame / dt - 1e-6));
    const RunOptions run =
        accurate_run(scene, options.base, frame_ / steps_a_frame, substeps_a_step);
    accurate_ = resolve_run(scene, run);
    follow(scene, run, options);
    if (interrupted_)
        return;
    const RunOptions finer =
        accurate_run(scene, options.base, frame_ / (2 * steps_a_frame), substeps_a_step);
    own_error_ =
        error_of([&](const SceneDesc &state) { return Simulation::create(state, finer, nullptr); });
    interrupted_ = stopped();
    if (!own_error_.failure.empty() && !interrupted_)
        throw std::invalid_argument("the accurate run at half its step: " + own_error_.failure);
}

std::size_t OneStepStates::instants() const {
    std::size_t count = 0;
    for (const Stretch &stretch : stretches_)
        count += stretch.steps - stretch.uncounted;
    return count;
}

void OneStepStates::lay_out_stretches(std::size_t frames) {
    const bool all = frames <= most_frames;
    stretches_.resize(all ? 1 : stretch_count);
    for (std::size_t i = 0; i < stretches_.size(); ++i) {
        Stretch &stretch = stretches_[i];
        stretch.steps = all ? frames : most_frames / stretch_count;
        stretch.uncounted = std::min(gone_along, stretch.steps / 2);
        if (!all)
            stretch.first = i * (frames - stretch.steps) / (stretch_count - 1);
    }
}

void OneStepStates::follow(const SceneDesc &scene, const RunOptions &run,
                           const OneStepOptions &options) {
    const double slack = 1e-6;
    const auto frames = static_cast<std::size_t>(options.duration / frame_ + slack);
    if (frames == 0)
        throw std::invalid_argument("it ends before its first frame of " + format_dt(frame_));
    lay_out_stretches(frames);

    const std::unique_ptr<Simulation> simulation = Simulation::create(scene, run, nullptr);
    soft_ = simulation->soft_parts();
    const SceneDesc described = simulation->describe();
    bool any_moves =
        std::ranges::any_of(soft_.particles, [](const ParticleInfo &info) { return !info.pinned; });
    for (std::size_t i = 0; i < simulation->body_count(); ++i) {
        bodies_.push_back(simulation->body_info(i));
        any_moves = any_moves || bodies_.back().kind == BodyKind::dynamic;
        const BodyDesc &body = described.bodies[i];
        const glm::dvec3 centre = body.mass_pose ? body.mass_pose->position : body.position;
        mass_centres_.push_back(glm::conjugate(body.orientation) * (centre - body.position));
    }
    if (!any_moves)
        throw std::invalid_argument("nothing in it is moved by forces, so no step has an error");
    const std::size_t end = stretches_.back().first + stretches_.back().steps;
    for (std::size_t k = 0; k <= end; ++k) {
        for (int step = 0; step < steps_a_frame && k > 0; ++step) {
            std::string why;
            try {
                simulation->step();
            } catch (const CheckFailure &failure) {
                why = failure.what();
            }
            if (!why.empty() || !simulation->report().finite) {
                Divergence divergence = find_divergence(*simulation, simulation->step_count());
                divergence.message = why;
                throw std::invalid_argument("the accurate run, " + run_text(accurate_) + ": " +
                                            describe(divergence));
            }
        }
        Frame frame;
        simulation->read(frame, {.joints = true});
        for (Stretch &stretch : stretches_)
            if (k >= stretch.first && k <= stretch.first + stretch.steps)
                stretch.frames.push_back(frame);
        if (options.progress)
            options.progress(static_cast<double>(k) / static_cast<double>(end));
        if (stopped()) {
            interrupted_ = true;
            return;
        }
    }
}

template <typename Add>
void OneStepStates::add_squares(const Frame &frame, const Frame &truth, const Add &add) const {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const BodyInfo &info = bodies_[i];
        if (info.kind != BodyKind::dynamic)
            continue;
        const BodyState &a = frame.bodies[i], &b = truth.bodies[i];
        const glm::dvec3 apart = a.position + a.orientation * mass_centres_[i] - b.position -
                                 b.orientation * mass_centres_[i];
        const double gyration =
            (info.inertia.x + info.inertia.y + info.inertia.z) / (2 * info.mass);
        const double angle = angle_between(a.orientation, b.orientation);
        add(glm::dot(apart, apart) + gyration * angle * angle);
    }
    for (std::size_t i = 0; i < soft_.particles.size(); ++i)
        if (!soft_.particles[i].pinned) {
            const glm::dvec3 apart = frame.particles[i].position - truth.particles[i].position;
            add(glm::dot(apart, apart));
        }
}

OneStepError OneStepStates::error_of(const Make &make) const {
    OneStepError error;
    double sum = 0;
    std::size_t count = 0;
    const auto add_square = [&](double square) {
        sum += square;
        ++count;
        error.worst = std::max(error.worst, std::sqrt(square));
    };
    Frame frame;
    for (const Stretch &stretch : stretches_) {
        SceneDesc scene = start_;
        for (std::size_t i = 0; i < stretch.steps; ++i) {
            if (stopped()) {
                error.failure = "interrupted";
                return error;
            }
            put_state(scene, stretch.frames[i], soft_);
            const std::shared_ptr<Simulation> simulation = make(scene);
            const double dt = simulation->settings().dt;
            const auto steps = std::lround(frame_ / dt);
            if (std::abs(static_cast<double>(steps) * dt - frame_) > 1e-6 * frame_) {
                error.failure = "steps of " + format_dt(dt) + " do not add up to the frame of " +
                                format_dt(frame_);
                return error;
            }
            try {
                for (long step = 0; step < steps; ++step)
                    simulation->step();
            } catch (const CheckFailure &failure) {
                error.failure = failure.what();
            }
            if (error.failure.empty() && !simulation->report().finite)
                error.failure = "not finite";
            if (!error.failure.empty()) {
                error.failure += ", a step after " + with_unit(stretch.frames[i].time, "s");
                return error;
            }
            scene = simulation->describe();
            if (i < stretch.uncounted)
                continue;
            simulation->read(frame, {});
            add_squares(frame, stretch.frames[i + 1], add_square);
        }
    }
    error.rms = std::sqrt(sum / static_cast<double>(count));
    return error;
}

} // namespace plumb
