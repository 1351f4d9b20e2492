// `plumb bench scenes`: writes the scenes of `plumb bench dynamics` to files, to run, chart and
// map.
#include "tests/bench/benches.h"

#include "app/files/output_file.h"
#include "engine/scene/scene_file.h"
#include "tests/bench/bench_scenes.h"
#include "tests/bench/only.h"

#include <iostream>

namespace plumb {

namespace {

void expect_at_most(SceneDesc &scene, const char *quantity, double bound, double seconds,
                    const char *source) {
    ExpectDesc &expect = scene.expects.emplace_back();
    expect.name = expect.quantity = quantity;
    expect.reduce = "max";
    expect.to = seconds;
    expect.relation = ExpectDesc::Relation::at_most;
    expect.value = bound;
    expect.source = source;
}

} // namespace

ExitCode bench_scene_files(const EngineBenchOptions &options) {
    const std::vector<BenchScene> scenes = chosen(bench_scenes(), options.only);
    create_folder(options.out_dir);
    for (const BenchScene &one : scenes) {
        SceneDesc scene = one.make(options.size);
        scene.title = one.name;
        expect_at_most(scene, "penetration", 0.1, one.seconds,
                       "bodies are rigid; 10 cm would be seen");
        if (!scene.joints.empty())
            expect_at_most(scene, "joint_drift", 0.05, one.seconds,
                           "joints do not come apart; 5 cm would be seen");
        OutputFile file(options.out_dir / (one.name + ".toml"));
        file.stream() << write_scene(scene);
        file.finish();
        std::cout << file.path().string() << '\n';
    }
    return ExitCode::fine;
}

} // namespace plumb
