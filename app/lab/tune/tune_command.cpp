#include "app/lab/tune/tune.h"

#include "app/lab/interrupt.h"
#include "engine/scene/file/change.h"
#include "engine/scene/file/settings.h"
#include "engine/scene/given_settings.h"
#include "engine/scene/scene_file.h"

#include <stdexcept>
#include <utility>
#include <vector>

namespace plumb {

namespace {

ExitCode write(const SceneText &scene, const Tuning &tuning, std::ostream &out, std::ostream &err) {
    const std::filesystem::path &path = scene.path;
    const TunedRun &chosen = tuning.plainest();
    std::string text;
    try {
        text = with_run(scene.text, path.string(), chosen.resolved);
    } catch (const std::invalid_argument &error) {
        throw std::invalid_argument(path.string() + ": the settings cannot be written to it; " +
                                    error.what());
    }
    if (text == scene.text) {
        out << "  Nothing to write: the file already has these settings.\n";
        return ExitCode::fine;
    }
    write_back(scene, text, err);
    const ResolvedRun before = resolve_run(parse_scene(scene.text, path.string()).scene, {});
    if (chosen.resolved.settings.dt != before.settings.dt)
        err << "dt holds for every method: `plumb check --all-methods` tells whether the others "
               "still meet the scene\n";
    return ExitCode::fine;
}

} // namespace

double parse_budget(const std::string &text) {
    constexpr double frames = 60; // per second
    for (const auto &[unit, seconds] : {std::pair{"us", 1e-6}, {"ms", 1e-3}, {"s", 1.0}})
        if (text.ends_with(unit))
            try {
                const std::string number = text.substr(0, text.size() - std::string(unit).size());
                if (const double value = parse_number(number); value > 0)
                    return value * seconds * frames;
                break;
            } catch (const std::invalid_argument &) {
                break;
            }
    throw std::invalid_argument("--budget: '" + text +
                                "' must be a positive time with its unit (s, ms or us), as in 1ms");
}

ExitCode tune_scene(const TuneCommand &command, std::ostream &out, std::ostream &err) {
    const std::optional<SceneText> scene = read_scene(command.scene, err);
    if (!scene)
        return ExitCode::bad_input;
    if (command.write && !std::filesystem::is_regular_file(scene->path))
        throw std::invalid_argument(scene->path.string() + " is not a file that can be written to");
    if (command.write && command.options.base.settings.has(*find_setting("gravity")))
        throw std::invalid_argument("--write keeps the scene's gravity: settings tuned for another "
                                    "cannot be written to it");
    const InterruptGuard interrupt;
    ProgressLine line(err);
    TuneOptions options = command.options;
    options.stop = InterruptGuard::requested;
    options.progress = [&](double fraction, const std::string &what) { line.show(fraction, what); };
    const Tuning tuning = tune_scene(*scene, options);
    line.clear();
    print(out, tuning, command.explain);
    out << std::flush;
    if (tuning.interrupted) {
        err << "interrupted after " << tuning.runs.size() << " settings; nothing was written\n";
        return ExitCode::fine; // main reports the interruption
    }
    if (!tuning.found())
        return ExitCode::outside_tolerance;
    return command.write ? write(*scene, tuning, out, err) : ExitCode::fine;
}

} // namespace plumb
