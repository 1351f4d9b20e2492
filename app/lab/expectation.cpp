#include "app/lab/expectation.h"

#include "app/lab/cpu_clock.h"
#include "app/lab/quantity_probe.h"
#include "engine/core/check.h"
#include "engine/scene/expect.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

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

// A course of one quantity, sampled after each step.
struct Course {
    std::vector<double> times;
    std::vector<double> values;
};

// The part of a course in [from, to], with the edges interpolated where no sample lies on them.
// `slack` (s) is how near a sample must lie to count as on the edge.
Course window(const Course &course, double from, double to, double slack) {
    Course part;
    const auto interpolate = [&](std::size_t next, double time) {
        const double fraction =
            (time - course.times[next - 1]) / (course.times[next] - course.times[next - 1]);
        part.times.push_back(time);
        part.values.push_back(course.values[next - 1] +
                              fraction * (course.values[next] - course.values[next - 1]));
    };
    for (std::size_t i = 0; i < course.times.size(); ++i) {
        const double time = course.times[i];
        if (i > 0 && course.times[i - 1] < from - slack && time > from + slack)
            interpolate(i, from);
        if (time >= from - slack && time <= to + slack) {
            part.times.push_back(time);
            part.values.push_back(course.values[i]);
        }
        if (i > 0 && course.times[i - 1] < to - slack && time > to + slack && to > from)
            interpolate(i, to);
    }
    return part;
}

// Remembers where all bodies were, to say where things went wrong.
class LastPositions {
  public:
    void note(const Simulation &simulation) {
        positions_.resize(simulation.body_count());
        for (std::size_t i = 0; i < positions_.size(); ++i)
            if (simulation.body_info(i).alive)
                positions_[i] = simulation.body_state(i).position;
    }

    [[nodiscard]] Divergence diverged(const Simulation &simulation, std::uint64_t step,
                                      std::string message) const {
        Divergence divergence = find_divergence(simulation, step);
        divergence.message = std::move(message);
        const auto body = simulation.find_body(divergence.body);
        if (!divergence.body.empty() && body && *body < positions_.size())
            divergence.last_position = positions_[*body];
        return divergence;
    }

  private:
    std::vector<glm::dvec3> positions_;
};

} // namespace

ExpectOutcome judge(const ExpectDesc &desc, double measured) {
    ExpectOutcome outcome;
    outcome.desc = desc;
    const QuantityInfo *quantity = find_quantity(desc.quantity);
    outcome.unit = desc.reduce == "period"      ? "s"
                   : desc.reduce == "crossings" ? "1"
                   : quantity != nullptr        ? std::string(quantity->unit)
                                                : "1";
    outcome.judged = true;
    outcome.measured = measured;
    switch (desc.relation) {
    case ExpectDesc::Relation::equals:
        outcome.error = std::abs(measured - desc.value);
        outcome.limit = desc.tolerance;
        break;
    case ExpectDesc::Relation::at_most:
        if (desc.value > 0) {
            outcome.error = std::max(measured, 0.0);
            outcome.limit = desc.value;
        } else {
            outcome.error = std::max(measured - desc.value, 0.0);
        }
        break;
    case ExpectDesc::Relation::at_least:
        outcome.error = std::max(desc.value - measured, 0.0);
        break;
    }
    if (std::isnan(measured))
        outcome.error = std::numeric_limits<double>::infinity();
    outcome.passed = outcome.error <= outcome.limit && std::isfinite(measured);
    return outcome;
}

Divergence find_divergence(const Simulation &simulation, std::uint64_t step) {
    Divergence divergence;
    divergence.step = step;
    divergence.time = simulation.time();
    for (std::size_t i = 0; i < simulation.body_count(); ++i)
        if (simulation.body_info(i).alive && !finite(simulation.body_state(i))) {
            divergence.body = simulation.body_info(i).name;
            break;
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
        all += ": body \"" + divergence.body + "\"";
    if (divergence.last_position) {
        const glm::dvec3 &p = *divergence.last_position;
        std::snprintf(text, sizeof text, ", last at (%.4g, %.4g, %.4g)", p.x, p.y, p.z);
        all += text;
    }
    if (!divergence.message.empty())
        all += ": " + divergence.message;
    return all;
}

bool JudgedRun::all_passed() const {
    return !divergence && !stopped &&
           std::all_of(outcomes.begin(), outcomes.end(),
                       [](const ExpectOutcome &outcome) { return outcome.passed; });
}

double run_end(const SceneDesc &scene, double duration) {
    double end = 0;
    for (const ExpectDesc &expect : scene.expects)
        end = std::max(end, expect.to);
    return scene.expects.empty() ? duration : end;
}

JudgedRun judge_run(Simulation &simulation, const SceneDesc &scene, const JudgeOptions &options) {
    JudgedRun run;
    // Several expectations may share a quantity: it is followed once.
    std::vector<QuantityName> names;
    std::vector<std::size_t> course_of;
    for (const ExpectDesc &expect : scene.expects) {
        const QuantityInfo *info = find_quantity(expect.quantity);
        const QuantityName name{expect.quantity,
                                info != nullptr && info->needs_body ? expect.body : std::string()};
        const auto found = std::find(names.begin(), names.end(), name);
        course_of.push_back(static_cast<std::size_t>(found - names.begin()));
        if (found == names.end())
            names.push_back(name);
        ExpectOutcome outcome = judge(expect, std::numeric_limits<double>::quiet_NaN());
        outcome.judged = false;
        run.outcomes.push_back(std::move(outcome));
    }
    // Followed besides: these three, at the end of the list.
    const std::size_t extra = names.size();
    if (options.follow_errors)
        for (const char *quantity : {"penetration", "joint_drift", "energy", "energy_error"})
            names.push_back({quantity, ""});

    const QuantityProbe probe(simulation, names);
    std::vector<Course> courses(extra);
    double start_energy = 0;
    const auto sample = [&](bool first) {
        const std::vector<double> values = probe.sample(simulation);
        for (std::size_t i = 0; i < extra; ++i) {
            courses[i].times.push_back(simulation.time());
            courses[i].values.push_back(values[i]);
        }
        if (!options.follow_errors)
            return;
        if (first)
            start_energy = values[extra + 2];
        run.max_penetration = std::max(run.max_penetration, values[extra]);
        run.max_joint_drift = std::max(run.max_joint_drift, values[extra + 1]);
        run.max_energy_change =
            std::max(run.max_energy_change, std::abs(values[extra + 2] - start_energy));
        run.max_energy_error = std::max(run.max_energy_error, std::abs(values[extra + 3]));
    };

    const double end = run_end(scene, options.duration);
    const double start = simulation.time();
    LastPositions last_positions;
    bool at_time_due = static_cast<bool>(options.at_time);
    sample(true);
    while (true) {
        // A millionth of a step: more than time can be off by rounding, less than anything shows.
        const double slack = 1e-6 * simulation.settings().dt;
        if (simulation.time() >= end - slack)
            break;
        if (options.stop && options.stop()) {
            run.stopped = true;
            break;
        }
        if (at_time_due && simulation.time() >= options.at_time_seconds - slack) {
            options.at_time();
            at_time_due = false;
        }
        last_positions.note(simulation);
        const std::uint64_t step = simulation.step_count();
        try {
            const double before = thread_cpu_time();
            simulation.step();
            run.step_cpu_time += thread_cpu_time() - before;
        } catch (const CheckFailure &failure) {
            run.divergence = last_positions.diverged(simulation, step + 1, failure.what());
            break;
        }
        ++run.steps;
        run.unresolved_impacts += simulation.report().unresolved_impacts;
        run.had_contacts = run.had_contacts || simulation.report().contacts > 0;
        if (!simulation.report().finite) {
            run.divergence = last_positions.diverged(simulation, step + 1, "");
            break;
        }
        sample(false);
        if (options.progress)
            options.progress((simulation.time() - start) / std::max(end - start, 1e-300));
    }
    run.time = simulation.time();

    for (std::size_t i = 0; i < scene.expects.size(); ++i) {
        const ExpectDesc &expect = scene.expects[i];
        const double slack = 1e-6 * simulation.settings().dt;
        // A window that ended before the trouble is judged all the same.
        if (courses[course_of[i]].times.back() < expect.to - slack)
            continue;
        const ReductionInfo *reduction = find_reduction(expect.reduce);
        PLUMB_CHECK(reduction != nullptr, "there is no reduction \"" << expect.reduce << '"');
        const Course part = window(courses[course_of[i]], expect.from, expect.to, slack);
        run.outcomes[i] =
            judge(expect, reduce(part.times, part.values, reduction->reduction, expect.level));
    }
    return run;
}

} // namespace plumb
