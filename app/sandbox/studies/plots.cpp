#include "app/sandbox/studies/plots.h"

#include "app/lab/csv.h"

#include <algorithm>
#include <iterator>

namespace plumb {

void Plots::probe_anew(const Simulation &simulation) {
    std::erase_if(curves_, [&](const PlotCurve &curve) {
        const std::vector<const QuantityInfo *> there = quantities_of(simulation, curve.name.body);
        return std::find(there.begin(), there.end(), curve.quantity) == there.end();
    });
    std::vector<QuantityName> names;
    for (const PlotCurve &curve : curves_)
        names.push_back(curve.name);
    probe_.emplace(simulation, names, start_);
}

void Plots::start(const Simulation &simulation) {
    start_ = run_start(simulation);
    for (PlotCurve &curve : curves_)
        curve.samples.clear();
    probe_anew(simulation);
    sample(simulation);
}

void Plots::sample(const Simulation &simulation) {
    if (curves_.empty())
        return;
    const std::vector<double> values = probe_->sample(simulation);
    for (std::size_t i = 0; i < curves_.size(); ++i) {
        std::deque<PlotSample> &samples = curves_[i].samples;
        samples.push_back({simulation.step_count(), simulation.time(), values[i]});
        if (samples.size() > most_samples)
            samples.pop_front();
    }
}

void Plots::go_back(const Simulation &simulation) {
    for (PlotCurve &curve : curves_)
        while (!curve.samples.empty() && curve.samples.back().step > simulation.step_count())
            curve.samples.pop_back();
    probe_anew(simulation); // a body may not have existed yet
}

void Plots::add(const Simulation &simulation, const QuantityName &name) {
    if (std::ranges::find(curves_, name, &PlotCurve::name) != curves_.end())
        return;
    const double now = QuantityProbe(simulation, {name}, start_).sample(simulation).front();
    curves_.push_back(
        {name, find_quantity(name.quantity), {{simulation.step_count(), simulation.time(), now}}});
    probe_anew(simulation);
}

void Plots::remove(const Simulation &simulation, std::size_t curve) {
    curves_.erase(curves_.begin() + static_cast<std::ptrdiff_t>(curve));
    probe_anew(simulation);
}

std::optional<std::uint64_t> Plots::first_step() const {
    std::optional<std::uint64_t> first;
    for (const PlotCurve &curve : curves_)
        if (!curve.samples.empty())
            first =
                std::min(first.value_or(curve.samples.front().step), curve.samples.front().step);
    return first;
}

void Plots::write_csv(std::ostream &out) const {
    CsvWriter csv(out);
    csv.cell("step").cell("time (s)");
    std::vector<std::uint64_t> steps;
    for (const PlotCurve &curve : curves_) {
        const std::string_view unit = curve.quantity->unit;
        csv.cell(title_of(curve.name) + (unit == "1" ? "" : " (" + std::string(unit) + ")"));
        for (const PlotSample &sample : curve.samples)
            steps.push_back(sample.step);
    }
    csv.end_row();
    std::ranges::sort(steps);
    steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
    std::vector<std::size_t> next(curves_.size(), 0);
    for (const std::uint64_t step : steps) {
        std::vector<const PlotSample *> row(curves_.size(), nullptr);
        const PlotSample *any = nullptr;
        for (std::size_t i = 0; i < curves_.size(); ++i) {
            const std::deque<PlotSample> &samples = curves_[i].samples;
            if (next[i] < samples.size() && samples[next[i]].step == step)
                any = row[i] = &samples[next[i]++];
        }
        csv.cell(step).cell(any->time);
        for (const PlotSample *sample : row)
            sample != nullptr ? csv.cell(sample->value) : csv.cell("");
        csv.end_row();
    }
}

std::vector<const QuantityInfo *> quantities_of(const Simulation &simulation,
                                                const std::string &name) {
    const SoftParts &soft = simulation.soft_parts();
    const bool is_scene = name.empty();
    const bool is_body = !is_scene && simulation.find_body(name).has_value();
    const bool is_particle = !is_scene && soft.find_particle(name).has_value();
    const bool is_spring = !is_scene && soft.find_spring(name).has_value();
    const std::optional<std::size_t> joint = is_scene ? std::nullopt : simulation.find_joint(name);
    std::vector<const QuantityInfo *> found;
    for (const QuantityInfo &info : quantities())
        if (info.needs_spring()  ? is_spring
            : info.needs_joint() ? joint && has_quantity(simulation.joint(*joint)->type, info)
            : info.needs_body()  ? is_body || (is_particle && info.of_particles)
                                 : is_scene)
            found.push_back(&info);
    return found;
}

std::vector<std::string> plot_subjects(const Simulation &simulation) {
    const SoftParts &soft = simulation.soft_parts();
    std::vector<std::string> names;
    const auto add = [&](std::string name) {
        if (!name.empty())
            names.push_back(std::move(name));
    };
    for (std::size_t i = 0; i < simulation.body_count(); ++i)
        if (simulation.body_info(i).alive && simulation.body_info(i).kind != BodyKind::static_body)
            add(simulation.body_info(i).name);
    for (std::size_t i = 0; i < soft.particles.size(); ++i)
        add(soft.particle_name(i));
    for (std::size_t i = 0; i < soft.springs.size(); ++i)
        if (!soft.springs[i].cloth)
            add(soft.spring_name(i));
    for (std::size_t i = 0; i < simulation.joint_count(); ++i)
        if (const JointDesc *joint = simulation.joint(i))
            add(joint->name);
    return names;
}

std::string title_of(const QuantityName &name) {
    return name.body.empty() ? name.quantity : name.quantity + " of " + name.body;
}

} // namespace plumb
