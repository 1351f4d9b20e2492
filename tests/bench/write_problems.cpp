// `plumb bench problems`: writes the problems of `plumb bench truth` to files, to run.
#include "tests/bench/benches.h"

#include "app/files/output_file.h"
#include "engine/scene/scene_file.h"
#include "tests/bench/only.h"
#include "tests/bench/truth.h"

#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>

namespace plumb {

namespace {

// The scene that a problem gives to every engine. Of those it repeats, at other phases of the step
// or turned otherwise, the first.
SceneDesc scene_of(const Problem &problem) {
    std::optional<SceneDesc> scene;
    const EngineKind only_looks{"none", 1, [&](const EngineScene &given) {
                                    scene = given.desc;
                                    return std::unique_ptr<Engine>();
                                }};
    try {
        (void)problem.error(only_looks);
    } catch (const CannotRun &) { // as it is no engine
    }
    return scene.value();
}

} // namespace

ExitCode bench_problem_files(const EngineBenchOptions &options) {
    const std::vector<Problem> problems = chosen(all_problems(), options.only);
    create_folder(options.out_dir);
    for (const Problem &problem : problems) {
        SceneDesc scene = scene_of(problem);
        scene.title = problem.name;
        char aim[32];
        std::snprintf(aim, sizeof aim, "%g", problem.aim);
        scene.description = "Error of " + problem.what + ": at most " + aim +
                            (problem.unit.empty() ? "" : " ") + problem.unit + ".";
        scene.world.settings.give(&StepSettings::sleep_after, 0.0); // as in the table
        OutputFile file(options.out_dir / (problem.name + ".toml"));
        file.stream() << write_scene(scene);
        file.finish();
        std::cout << file.path().string() << '\n';
    }
    return ExitCode::fine;
}

} // namespace plumb
