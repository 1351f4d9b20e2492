#include "app/lab/run/expectation_watch.h"

#include "engine/core/check.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace plumb {

namespace {

// The expectations' quantities, without duplicates.
std::vector<QuantityName> quantities_of(const std::vector<ExpectDesc> &expects) {
    std::vector<QuantityName> names;
    for (const ExpectDesc &expect : expects) {
        const QuantityName name{expect.quantity, expect.body};
        if (std::find(names.begin(), names.end(), name) == names.end())
            names.push_back(name);
    }
    return names;
}

std::vector<QuantityName> joined(std::vector<QuantityName> names,
                                 const std::vector<QuantityName> &more) {
    names.insert(names.end(), more.begin(), more.end());
    return names;
}

struct Samples {
    std::vector<double> times, values;
};

// The part of a course in [from, to], interpolated at an edge that has no sample.
Samples window(std::span<const double> times, std::span<const double> values, double from,
               double to, double slack) {
    Samples part;
    const auto interpolate = [&](std::size_t next, double time) {
        const double fraction = (time - times[next - 1]) / (times[next] - times[next - 1]);
        part.times.push_back(time);
        part.values.push_back(values[next - 1] + fraction * (values[next] - values[next - 1]));
    };
    for (std::size_t i = 0; i < times.size(); ++i) {
        const double time = times[i];
        if (i > 0 && times[i - 1] < from - slack && time > from + slack)
            interpolate(i, from);
        if (time >= from - slack && time <= to + slack) {
            part.times.push_back(time);
            part.values.push_back(values[i]);
        }
        if (i > 0 && times[i - 1] < to - slack && time > to + slack && to > from)
            interpolate(i, to);
    }
    return part;
}

// Distance of a course from the expected curve, at each sample in its window.
Samples distances(std::span<const double> times, std::span<const double> values,
                  const ExpectDesc &expect, double slack) {
    Samples part;
    for (std::size_t i = 0; i < times.size(); ++i)
        if (times[i] >= expect.from - slack && times[i] <= expect.to + slack) {
            part.times.push_back(times[i]);
            part.values.push_back(
                std::abs(values[i] - curve_at(expect.curve, expect.from, expect.to, times[i])));
        }
    return part;
}

// Whether an outcome missed so far will stay missed, whatever happens next.
bool beyond_hope(const ExpectOutcome &so_far, const ReductionInfo &reduction) {
    const ExpectDesc &desc = so_far.desc;
    const bool moving_level = reduction.uses_level && !desc.level;
    const bool too_much = so_far.measured > desc.value;
    return so_far.verdict == Verdict::missed && !moving_level &&
           ((reduction.only_rises && too_much && desc.relation != ExpectDesc::Relation::at_least) ||
            (reduction.only_falls && so_far.measured < desc.value &&
             desc.relation != ExpectDesc::Relation::at_most));
}

} // namespace

ExpectationWatch::ExpectationWatch(const Simulation &simulation, std::vector<ExpectDesc> expects,
                                   const std::vector<QuantityName> &also)
    : probe_(simulation, joined(quantities_of(expects), also)),
      first_step_(simulation.step_count()) {
    const std::vector<QuantityName> names = quantities_of(expects);
    courses_.resize(names.size());
    also_now_.resize(also.size());
    for (ExpectDesc &expect : expects) {
        const auto course =
            std::find(names.begin(), names.end(), QuantityName{expect.quantity, expect.body});
        const ReductionInfo *reduction = find_reduction(expect.reduce);
        if (reduction == nullptr)
            throw std::invalid_argument("there is no reduction \"" + expect.reduce + '"');
        end_ = std::max(end_, expect.to);
        const QuantityInfo *quantity = find_quantity(expect.quantity); // the probe found it, too
        expects_.push_back({std::move(expect), quantity, reduction,
                            static_cast<std::size_t>(course - names.begin())});
    }
    sample(simulation);
}

void ExpectationWatch::sample(const Simulation &simulation) {
    // A millionth of a step: more than time's round-off, too little to matter.
    slack_ = 1e-6 * simulation.settings().dt;
    const bool over = !times_.empty() && times_.back() >= end_ - slack_;
    if (over && also_now_.empty())
        return;
    const std::vector<double> values = probe_.sample(simulation);
    std::copy(values.begin() + static_cast<std::ptrdiff_t>(courses_.size()), values.end(),
              also_now_.begin());
    if (over)
        return;
    times_.push_back(simulation.time());
    for (std::size_t i = 0; i < courses_.size(); ++i)
        courses_[i].push_back(values[i]);
}

void ExpectationWatch::go_back(const Simulation &simulation) {
    PLUMB_CHECK(simulation.step_count() >= first_step_, "step " << simulation.step_count()
                                                                << " lies before the run's first, "
                                                                << first_step_);
    const std::size_t kept = std::min<std::size_t>(
        times_.size(), static_cast<std::size_t>(simulation.step_count() - first_step_) + 1);
    times_.resize(kept);
    for (std::vector<double> &course : courses_)
        course.resize(kept);
}

bool ExpectationWatch::unseen(const Followed &expect) const {
    const double start = times_.front();
    // For "last" only the end of the window counts.
    const double begin =
        expect.reduction->reduction == Reduction::last ? expect.desc.to : expect.desc.from;
    return begin < start - slack_ || (expect.quantity->since_start && start > slack_);
}

double ExpectationWatch::measured(const Followed &expect, std::size_t samples) const {
    const std::span<const double> times(times_.data(), samples);
    const std::span<const double> values(courses_[expect.course].data(), samples);
    const bool last = expect.reduction->reduction == Reduction::last;
    const double from = last ? std::min(expect.desc.to, times.back()) : expect.desc.from;
    const Samples part = expect.desc.curve.empty()
                             ? window(times, values, from, expect.desc.to, slack_)
                             : distances(times, values, expect.desc, slack_);
    return plumb::reduce(part.times, part.values, expect.reduction->reduction, expect.desc.level);
}

ExpectOutcome ExpectationWatch::outcome(std::size_t expectation, std::size_t samples) const {
    const Followed &expect = expects_.at(expectation);
    const bool late = unseen(expect);
    ExpectOutcome outcome = judge(expect.desc, late ? std::numeric_limits<double>::quiet_NaN()
                                                    : measured(expect, samples));
    if (late)
        outcome.verdict = Verdict::unseen;
    else if (times_[samples - 1] < expect.desc.to - slack_ &&
             !beyond_hope(outcome, *expect.reduction))
        outcome.verdict = Verdict::pending;
    return outcome;
}

std::optional<double> ExpectationWatch::missed_since(std::size_t expectation) const {
    const auto is_missed = [&](std::size_t samples) {
        return outcome(expectation, samples).verdict == Verdict::missed;
    };
    if (!is_missed(times_.size()))
        return {};
    // Once missed it stays missed, so bisect for the smallest number of samples.
    std::size_t not_yet = 0;
    std::size_t missed = times_.size();
    while (missed - not_yet > 1) {
        const std::size_t middle = not_yet + (missed - not_yet) / 2;
        (is_missed(middle) ? missed : not_yet) = middle;
    }
    return times_[missed - 1];
}

} // namespace plumb
