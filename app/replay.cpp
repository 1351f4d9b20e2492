#include "app/replay.h"

#include "app/lab/interrupt.h"
#include "app/lab/progress.h"
#include "engine/core/check.h"
#include "engine/scene/recording.h"

#include <ostream>
#include <stdexcept>

namespace plumb {

ExitCode replay(const ReplayCommand &command, std::ostream &out, std::ostream &err) {
    const std::string path = command.recording.string();
    const RecordingResult read = load_recording(command.recording);
    for (const SceneMessage &message : read.messages)
        err << format_message(path, message) << '\n';
    if (!read.ok())
        return ExitCode::bad_input;
    const Recording &recording = read.recording;

    const InterruptGuard interrupt;
    ProgressLine line(err);
    Replay replay(recording);
    try {
        const auto simulation = Simulation::create(recording.scene, {}, command.tasks);
        for (;; simulation->step()) {
            if (!replay.obey(*simulation)) {
                line.clear();
                err << path << ": " << replay.difference(*simulation) << '\n';
                return ExitCode::outside_tolerance;
            }
            if (replay.is_at_end(*simulation))
                break;
            if (InterruptGuard::requested()) {
                line.clear();
                err << "interrupted in step " << simulation->step_count() << '\n';
                return ExitCode::fine;
            }
            line.show(static_cast<double>(simulation->step_count() - recording.first_step()) /
                          static_cast<double>(recording.hashes.size()),
                      recording.scene.name);
        }
        line.clear();
        out << hash_text(simulation->hash()) << "  " << recording.scene.name << "  step "
            << simulation->step_count() << std::endl;
        return ExitCode::fine;
    } catch (const CommandFailure &failure) {
        line.clear();
        err << path << ':' << failure.line << ": error: " << failure.what() << '\n';
    } catch (const std::invalid_argument &failure) {
        line.clear();
        err << path << ": " << failure.what() << '\n';
    } catch (const CheckFailure &failure) {
        line.clear();
        err << path << ": a step failed: " << failure.what() << '\n';
        return ExitCode::diverged;
    }
    return ExitCode::bad_input;
}

} // namespace plumb
