#include "app/hash.h"

#include "app/lab/interrupt.h"
#include "app/lab/progress.h"
#include "app/lab/run/load_scenes.h"
#include "engine/core/check.h"
#include "engine/scene/recording.h"

#include <memory>
#include <ostream>
#include <stdexcept>

namespace plumb {

ExitCode hash_scenes(const HashCommand &command, std::ostream &out, std::ostream &err) {
    const LoadedScenes loaded = load_scenes(command.scenes, err);
    ExitCode code = loaded.all_fine ? ExitCode::fine : ExitCode::bad_input;
    const InterruptGuard interrupt;
    ProgressLine line(err);
    for (const SceneDesc &scene : loaded.scenes) {
        line.show(0, scene.name);
        std::unique_ptr<Simulation> simulation;
        try {
            simulation = Simulation::create(scene, command.run, command.tasks);
        } catch (const std::invalid_argument &error) {
            line.clear();
            err << scene.name << ": " << error.what() << '\n';
            code = worse(code, ExitCode::bad_input);
            continue;
        }
        for (std::uint64_t step = 0;
             simulation->has_world() && step < command.steps && simulation->report().finite;
             ++step) {
            try {
                simulation->step();
            } catch (const CheckFailure &failure) {
                line.clear();
                err << scene.name << ": failed in step " << simulation->step_count() + 1 << ": "
                    << failure.what() << '\n';
                code = worse(code, ExitCode::diverged);
                break;
            }
            if (InterruptGuard::requested()) {
                line.clear();
                err << "interrupted in " << scene.name << ", step " << simulation->step_count()
                    << '\n';
                return code;
            }
            line.show(static_cast<double>(step + 1) / static_cast<double>(command.steps),
                      scene.name);
        }
        line.clear();
        out << hash_text(simulation->hash()) << "  " << scene.name << "  step "
            << simulation->step_count() << std::endl;
        if (!simulation->report().finite) {
            err << scene.name << ": diverged at step " << simulation->step_count() << '\n';
            code = worse(code, ExitCode::diverged);
        }
    }
    return code;
}

} // namespace plumb
