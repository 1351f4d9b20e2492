#include "app/lab/run/measure.h"

#include "app/files/output_file.h"
#include "app/lab/csv.h"
#include "app/lab/interrupt.h"
#include "app/lab/progress.h"
#include "app/lab/run/load_scenes.h"
#include "app/lab/run/run_text.h"
#include "engine/core/check.h"
#include "engine/scene/expect.h"
#include "engine/scene/probe.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

namespace plumb {

namespace {

void write_header(CsvWriter &csv) {
    for (const char *name : {"step",
                             "time_s",
                             "kinetic_energy_J",
                             "potential_energy_J",
                             "energy_J",
                             "energy_change_J",
                             "energy_error",
                             "momentum_x_kg_m_s",
                             "momentum_y_kg_m_s",
                             "momentum_z_kg_m_s",
                             "angular_momentum_x_kg_m2_s",
                             "angular_momentum_y_kg_m2_s",
                             "angular_momentum_z_kg_m2_s",
                             "max_penetration_m",
                             "mean_penetration_m",
                             "max_joint_drift_m",
                             "mean_joint_drift_m",
                             "moving_bodies",
                             "pairs",
                             "contacts",
                             "contact_points",
                             "joints",
                             "springs",
                             "particle_contacts",
                             "impacts",
                             "unresolved_impacts",
                             "find_pairs_wall_s",
                             "collide_wall_s",
                             "advance_wall_s",
                             "finish_wall_s",
                             "step_wall_s",
                             "finite"})
        csv.cell(name);
    csv.end_row();
}

void write_row(CsvWriter &csv, std::uint64_t step, const Measures &m, double change, double error,
               const StepReport &r, const StepTimes &times) {
    csv.cell(step)
        .cell(m.time)
        .cell(m.kinetic_energy)
        .cell(m.potential_energy)
        .cell(m.energy())
        .cell(change)
        .cell(error)
        .cell(m.linear_momentum.x)
        .cell(m.linear_momentum.y)
        .cell(m.linear_momentum.z)
        .cell(m.angular_momentum.x)
        .cell(m.angular_momentum.y)
        .cell(m.angular_momentum.z)
        .cell(m.max_penetration)
        .cell(m.mean_penetration)
        .cell(m.max_joint_drift)
        .cell(m.mean_joint_drift);
    for (const std::uint32_t count :
         {r.moving_bodies, r.pairs, r.contacts, r.contact_points, r.joints, r.springs,
          r.particle_contacts, r.impacts, r.unresolved_impacts})
        csv.cell(static_cast<std::uint64_t>(count));
    csv.cell(times.find_pairs)
        .cell(times.collide)
        .cell(times.advance)
        .cell(times.finish)
        .cell(times.total())
        .cell(r.finite);
    csv.end_row();
}

} // namespace

MeasureSummary measure_run(Simulation &simulation, const MeasureOptions &options,
                           std::ostream &csv_out) {
    CsvWriter csv(csv_out);
    write_header(csv);
    MeasureSummary summary;
    const Measures start = simulation.measure();
    const double scale = start.kinetic_energy + std::abs(start.potential_energy);
    const double start_time = simulation.time();
    summary.start_energy = summary.end_energy = start.energy();
    const auto note = [&](const Measures &now) {
        const double change = now.energy() - start.energy();
        summary.end_energy = now.energy();
        summary.max_energy_change = std::max(summary.max_energy_change, std::abs(change));
        summary.max_energy_error =
            std::max(summary.max_energy_error, std::abs(relative_change(change, scale)));
        if (now.max_penetration > summary.max_penetration) {
            summary.max_penetration = now.max_penetration;
            summary.max_penetration_time = now.time;
        }
        if (now.max_joint_drift > summary.max_joint_drift) {
            summary.max_joint_drift = now.max_joint_drift;
            summary.max_joint_drift_time = now.time;
        }
        return change;
    };
    note(start);
    write_row(csv, simulation.step_count(), start, 0, 0, StepReport{}, StepTimes{});

    for (; summary.steps < options.steps; ++summary.steps) {
        if (options.stop && options.stop()) {
            summary.stopped = true;
            break;
        }
        StepTimes times;
        try {
            simulation.step(&times);
        } catch (const CheckFailure &failure) {
            summary.divergence = Divergence{simulation.step_count() + 1, simulation.time(), "",
                                            std::nullopt, failure.what()};
            break;
        }
        const StepReport &report = simulation.report();
        summary.find_pairs += times.find_pairs;
        summary.collide += times.collide;
        summary.advance += times.advance;
        summary.finish += times.finish;
        summary.most_contacts = std::max(summary.most_contacts, report.contacts);
        summary.most_particle_contacts =
            std::max(summary.most_particle_contacts, report.particle_contacts);
        summary.impacts += report.impacts;
        summary.unresolved_impacts += report.unresolved_impacts;
        // A world that is not finite cannot be measured: its geometry makes no sense.
        Measures now;
        if (report.finite) {
            now = simulation.measure();
        } else {
            const double nan = std::numeric_limits<double>::quiet_NaN();
            now.time = simulation.time();
            now.kinetic_energy = now.potential_energy = nan;
            now.linear_momentum = now.angular_momentum = glm::dvec3(nan);
            now.max_penetration = now.mean_penetration = nan;
            now.max_joint_drift = now.mean_joint_drift = nan;
        }
        const double change = note(now);
        write_row(csv, simulation.step_count(), now, change, relative_change(change, scale), report,
                  times);
        if (!report.finite) {
            ++summary.steps;
            summary.divergence = find_divergence(simulation, simulation.step_count());
            break;
        }
        if (options.progress)
            options.progress(static_cast<double>(summary.steps + 1) /
                             static_cast<double>(options.steps));
    }
    summary.simulated = simulation.time() - start_time;
    return summary;
}

void measure_probes(std::span<const ProbeDesc> probes, Precision precision, std::ostream &csv_out) {
    CsvWriter csv(csv_out);
    csv.cell("probe").cell("value").cell("is");
    csv.end_row();
    for (const ProbeDesc &probe : probes)
        for (const ProbeValue &value : answer(probe, precision).values) {
            csv.cell(probe.name).cell(std::string(value.name)).cell(value.value);
            csv.end_row();
        }
}

void print(std::ostream &out, const MeasureSummary &s) {
    char line[256];
    std::snprintf(line, sizeof line, "%llu steps, %.6g s simulated\n",
                  static_cast<unsigned long long>(s.steps), s.simulated);
    out << line;
    std::snprintf(line, sizeof line,
                  "energy            %.6g J to %.6g J, at most %.3g J off (%.3g relative)\n",
                  s.start_energy, s.end_energy, s.max_energy_change, s.max_energy_error);
    out << line;
    std::snprintf(line, sizeof line, "max penetration   %.4g m at %.4g s\n", s.max_penetration,
                  s.max_penetration_time);
    out << line;
    std::snprintf(line, sizeof line, "max joint drift   %.4g m at %.4g s\n", s.max_joint_drift,
                  s.max_joint_drift_time);
    out << line;
    std::snprintf(line, sizeof line, "contacts          at most %u", s.most_contacts);
    out << line;
    if (s.most_particle_contacts > 0) {
        std::snprintf(line, sizeof line, " of bodies, %u of particles", s.most_particle_contacts);
        out << line;
    }
    std::snprintf(line, sizeof line, "; %llu impacts, %llu unresolved\n",
                  static_cast<unsigned long long>(s.impacts),
                  static_cast<unsigned long long>(s.unresolved_impacts));
    out << line;
    const double total = s.find_pairs + s.collide + s.advance + s.finish;
    if (total > 0 && s.steps > 0) {
        std::snprintf(line, sizeof line,
                      "wall time/step    %.4g ms: find pairs %.0f %%, collide %.0f %%, advance "
                      "%.0f %%, finish %.0f %%; %.4g times real time\n",
                      1e3 * total / static_cast<double>(s.steps), 100 * s.find_pairs / total,
                      100 * s.collide / total, 100 * s.advance / total, 100 * s.finish / total,
                      s.simulated / total);
        out << line;
    }
    if (s.divergence)
        out << "DIVERGED: " << describe(*s.divergence) << '\n';
}

ExitCode measure_scene(const MeasureCommand &command, std::ostream &out, std::ostream &err) {
    const LoadedScenes loaded = load_scenes({command.scene}, err);
    if (!loaded.all_fine)
        return ExitCode::bad_input;
    if (loaded.scenes.size() != 1) {
        err << command.scene.string() << ": give one scene\n";
        return ExitCode::bad_input;
    }
    const SceneDesc &scene = loaded.scenes.front();
    try {
        const ResolvedRun resolved = resolve_run(scene, command.run);
        if (!has_world(scene)) {
            std::optional<OutputFile> file;
            if (!command.out.empty())
                file.emplace(command.out);
            measure_probes(scene.probes, resolved.precision, file ? file->stream() : out);
            if (file)
                file->finish();
            (file ? out : err) << scene.name
                               << ": only probes, no world to step; wrote their values\n";
            return ExitCode::fine;
        }
        const InterruptGuard interrupt;
        ProgressLine line(err);
        line.show(0, scene.name);
        const auto simulation = Simulation::create(scene, command.run, command.tasks);
        MeasureOptions options;
        options.steps = command.steps;
        options.stop = InterruptGuard::requested;
        options.progress = [&](double fraction) { line.show(fraction, scene.name); };
        std::optional<OutputFile> file;
        if (!command.out.empty())
            file.emplace(command.out);
        const MeasureSummary summary =
            measure_run(*simulation, options, file ? file->stream() : out);
        line.clear();
        std::filesystem::path partial;
        if (file && summary.stopped)
            partial = file->keep_partial();
        else if (file)
            file->finish();
        std::ostream &text = file ? out : err;
        text << scene.name << "  [" << run_text(resolved) << "]\n";
        print(text, summary);
        if (summary.stopped)
            text << "interrupted" << (file ? "; rows so far: " + partial.string() : std::string())
                 << '\n';
        return summary.divergence ? ExitCode::diverged : ExitCode::fine;
    } catch (const std::invalid_argument &error) {
        err << scene.name << ": " << error.what() << '\n';
    }
    return ExitCode::bad_input;
}

} // namespace plumb
