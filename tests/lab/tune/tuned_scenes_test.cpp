// Scenes that run at tuned settings meet what they expect with the margin and from other starts,
// and what is cheaper by one substep does not.
#include "app/lab/tune/tune.h"

#include "engine/scene/file/change.h"
#include "engine/scene/scene_file.h"

#include <sstream>

#include <gtest/gtest.h>

namespace plumb {
namespace {

class TunedScene : public testing::TestWithParam<const char *> {
  protected:
    // The scene with its own settings but so many substeps fewer.
    static TunedRun run_with_fewer(int fewer) {
        std::vector<SceneMessage> messages;
        const std::string path = PLUMB_SOURCE_DIR "/scenes/" + std::string(GetParam());
        const SceneText text{path, read_scene_text(path, messages).value()};
        const StepSettings own = resolve_run(parse_scene(text.text, path).scene, {}).settings;
        EXPECT_EQ(own.max_substeps, 1) << "what is tuned takes just so many";
        TuneOptions options;
        options.methods = {"soft_step"};
        options.starts = 1;
        options.repeats = 1;
        options.base.precision = Precision::single;
        options.base.settings.give(&StepSettings::dt, own.dt);
        options.base.settings.give(&StepSettings::iterations, own.iterations);
        options.base.settings.give(&StepSettings::max_substeps, own.max_substeps);
        options.base.settings.give(&StepSettings::substeps, own.substeps - fewer);
        return tune_scene(text, options).runs.at(0);
    }
};

TEST_P(TunedScene, MeetsWhatItExpectsWithAMarginAndWithOneSubstepLessDoesNot) {
    const TunedRun own = run_with_fewer(0);
    EXPECT_EQ(own.verdict, TuneVerdict::met) << own.worst << ": " << own.error;
    if (own.resolved.settings.substeps > 1) {
        const TunedRun cheaper = run_with_fewer(1);
        EXPECT_EQ(cheaper.verdict, TuneVerdict::missed) << cheaper.worst << ": " << cheaper.error;
    }
}

INSTANTIATE_TEST_SUITE_P(All, TunedScene,
                         testing::Values("contact/seams.toml", "contact/slope_holds.toml",
                                         "joints/door.toml"),
                         [](const auto &scene) {
                             std::string name = scene.param;
                             std::erase_if(name, [](char c) { return c == '/' || c == '.'; });
                             return name;
                         });

} // namespace
} // namespace plumb
