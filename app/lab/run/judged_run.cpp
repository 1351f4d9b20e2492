#include "app/lab/run/judged_run.h"

#include "app/lab/clocks.h"
#include "app/lab/run/expectation_watch.h"
#include "engine/core/check.h"
#include "engine/scene/probe.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>

namespace plumb {

namespace {

bool finite(const glm::dvec3 &v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool finite(const BodyState &state) {
    const glm::dquat &q = state.orientation;
    return finite(state.position) && finite(state.velocity) && finite(state.angular_velocity) &&
           std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z) && std::isfinite(q.w);
}

// Remembers the last positions, to say where a run diverged.
class LastPositions {
  public:
    void note(const Simulation &simulation) { simulation.read(frame_, {}); }

    [[nodiscard]] Divergence diverged(const Simulation &simulation, std::uint64_t step,
                                      std::string message) const {
        Divergence divergence = find_divergence(simulation, step, &frame_);
        divergence.message = std::move(message);
        return divergence;
    }

  private:
    Frame frame_;
};

// The bodies and particles that a scene's own expectations are about.
std::vector<std::string> fallers_of(const SceneDesc &scene) {
    std::vector<std::string> names;
    for (const ExpectDesc &expect : scene.expects) {
        const QuantityInfo *quantity = find_quantity(expect.quantity);
        if (quantity != nullptr && quantity->needs_body() &&
            std::ranges::find(names, expect.body) == names.end())
            names.push_back(expect.body);
    }
    return names;
}

ExpectDesc expect_of(const ProbeDesc &probe, const ProbeExpectDesc &expect) {
    ExpectDesc desc;
    desc.name = probe.name + ", " + expect.value;
    desc.value = expect.is;
    desc.tolerance = probe.tolerance;
    desc.source = probe.source;
    return desc;
}

} // namespace

Divergence find_divergence(const Simulation &simulation, std::uint64_t step, const Frame *before) {
    Divergence divergence;
    divergence.step = step;
    divergence.time = simulation.time();
    const Frame frame = simulation.read();
    for (std::size_t i = 0; i < frame.bodies.size(); ++i)
        if (simulation.body_info(i).alive && !finite(frame.bodies[i])) {
            divergence.body = simulation.body_info(i).name;
            if (before != nullptr && i < before->bodies.size())
                divergence.last_position = before->bodies[i].position;
            return divergence;
        }
    for (std::size_t i = 0; i < frame.particles.size(); ++i)
        if (!finite(frame.particles[i].position) || !finite(frame.particles[i].velocity)) {
            divergence.body = simulation.soft_parts().particle_name(i);
            divergence.is_particle = true;
            if (before != nullptr && i < before->particles.size())
                divergence.last_position = before->particles[i].position;
            return divergence;
        }
    return divergence;
}

std::string describe(const Divergence &divergence) {
    char text[256];
    std::snprintf(text, sizeof text, "not finite after step %llu (%.4g s)",
                  static_cast<unsigned long long>(divergence.step), divergence.time);
    std::string all = text;
    if (!divergence.message.empty()) {
        std::snprintf(text, sizeof text, "failed in step %llu (%.4g s)",
                      static_cast<unsigned long long>(divergence.step), divergence.time);
        all = text;
    }
    if (!divergence.body.empty())
        all += (divergence.is_particle ? ": particle \"" : ": body \"") + divergence.body + "\"";
    if (divergence.last_position) {
        const glm::dvec3 &p = *divergence.last_position;
        std::snprintf(text, sizeof text, ", last at (%.4g, %.4g, %.4g)", p.x, p.y, p.z);
        all += text;
    }
    if (!divergence.message.empty())
        all += ": " + divergence.message;
    return all;
}

bool JudgedRun::all_met() const {
    return !divergence && !stopped &&
           std::all_of(outcomes.begin(), outcomes.end(), [](const ExpectOutcome &outcome) {
               return outcome.verdict == Verdict::met || outcome.verdict == Verdict::unseen;
           });
}

bool JudgedRun::any_judged() const {
    return std::any_of(outcomes.begin(), outcomes.end(),
                       [](const ExpectOutcome &outcome) { return outcome.judged(); });
}

double run_end(const SceneDesc &scene, double duration) {
    double end = 0;
    for (const ExpectDesc &expect : scene.expects)
        end = std::max(end, expect.to);
    return scene.expects.empty() ? duration : end;
}

JudgedRun judge_run(Simulation &simulation, const SceneDesc &scene, const JudgeOptions &options) {
    JudgedRun run;
    std::vector<QuantityName> followed;
    if (options.follow_errors)
        for (const char *quantity : {"penetration", "joint_drift", "energy", "energy_error",
                                     "kinetic_energy", "potential_energy"})
            followed.push_back({quantity, ""});
    const std::vector<std::string> fallers =
        options.follow_errors ? fallers_of(scene) : std::vector<std::string>();
    const std::size_t first_height = followed.size();
    for (const std::string &name : fallers)
        followed.push_back({"position.y", name});
    ExpectationWatch watch(simulation, scene.expects, followed);
    double start_energy = 0, energy_scale = 0;  // J
    std::vector<double> start_heights, heights; // of the fallers
    const auto follow = [&](bool first) {
        if (!options.follow_errors)
            return;
        const std::span<const double> now = watch.also_now();
        if (first) {
            start_energy = now[2];
            energy_scale = now[4] + std::abs(now[5]);
        }
        run.max_penetration = std::max(run.max_penetration, now[0]);
        run.max_joint_drift = std::max(run.max_joint_drift, now[1]);
        run.max_energy_change = std::max(run.max_energy_change, std::abs(now[2] - start_energy));
        run.max_energy_error = std::max(run.max_energy_error, std::abs(now[3]));
        const double scale = std::max(energy_scale, now[4]);
        if (scale > 0)
            run.max_energy_gain = std::max(run.max_energy_gain, (now[2] - start_energy) / scale);
        run.end_penetration = now[0];
        run.end_joint_drift = now[1];
        heights.assign(now.begin() + static_cast<std::ptrdiff_t>(first_height), now.end());
        if (first)
            start_heights = heights;
    };

    const double end = run_end(scene, options.duration);
    const double start = simulation.time();
    constexpr int looks = 32; // per run, to see whether to give up
    double next_look = options.give_up ? start + (end - start) / looks : end;
    const auto any_missed = [&] {
        for (std::size_t i = 0; i < watch.size(); ++i)
            if (watch.outcome(i).verdict == Verdict::missed)
                return true;
        return false;
    };
    const auto now = [&] { return options.wall_clock ? wall_time() : thread_cpu_time(); };
    LastPositions last_positions;
    std::size_t called = 0;
    follow(true);
    while (true) {
        // A millionth of a step: more than time's round-off, too little to matter.
        const double slack = 1e-6 * simulation.settings().dt;
        if (simulation.time() >= end - slack)
            break;
        if (options.stop && options.stop()) {
            run.stopped = true;
            break;
        }
        for (; called < options.times_called.size() &&
               simulation.time() >= options.times_called[called] - slack;
             ++called)
            options.at_time(run.step_time);
        last_positions.note(simulation);
        const std::uint64_t step = simulation.step_count();
        try {
            const double before = now();
            simulation.step();
            const double took = now() - before;
            run.step_time += took;
            run.worst_step_time = std::max(run.worst_step_time, took);
        } catch (const CheckFailure &failure) {
            run.divergence = last_positions.diverged(simulation, step + 1, failure.what());
            break;
        }
        ++run.steps;
        run.body_passes += simulation.report().body_passes;
        run.constraint_passes += simulation.report().constraint_passes;
        run.unresolved_impacts += simulation.report().unresolved_impacts;
        run.had_contacts = run.had_contacts || simulation.report().contacts > 0;
        if (!simulation.report().finite) {
            run.divergence = last_positions.diverged(simulation, step + 1, "");
            break;
        }
        watch.sample(simulation);
        follow(false);
        if (options.progress)
            options.progress((simulation.time() - start) / std::max(end - start, 1e-300));
        if (simulation.time() >= next_look && next_look < end) {
            if (any_missed())
                break;
            next_look = simulation.time() + (end - start) / looks;
        }
    }
    run.time = simulation.time();
    if (options.follow_errors)
        for (const ExpectDesc &expect : scene.expects) {
            const auto faller = std::ranges::find(fallers, expect.body);
            const auto i = static_cast<std::size_t>(faller - fallers.begin());
            run.drops.push_back(faller == fallers.end() ? 0 : start_heights[i] - heights[i]);
        }

    for (std::size_t i = 0; i < watch.size(); ++i)
        run.outcomes.push_back(watch.outcome(i));
    if (options.keep_courses) {
        run.times.assign(watch.times().begin(), watch.times().end());
        for (std::size_t i = 0; i < watch.size(); ++i)
            run.courses.emplace_back(watch.course(i).begin(), watch.course(i).end());
    }
    return run;
}

std::vector<ExpectDesc> everything_expected(const SceneDesc &scene) {
    std::vector<ExpectDesc> expects = scene.expects;
    for (const ProbeDesc &probe : scene.probes)
        for (const ProbeExpectDesc &expect : probe.expects)
            expects.push_back(expect_of(probe, expect));
    return expects;
}

void judge_probes(const SceneDesc &scene, Precision precision,
                  std::vector<ExpectOutcome> &outcomes) {
    for (const ProbeDesc &probe : scene.probes) {
        const ProbeAnswer found = answer(probe, precision);
        for (const ProbeExpectDesc &expect : probe.expects)
            outcomes.push_back(judge(expect_of(probe, expect), found.value(expect.value)));
    }
}

} // namespace plumb
