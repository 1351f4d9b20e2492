// Every scene that moves runs at tuned settings: it meets what it expects with the margin and from
// other starts, and the next cheaper point does not.
#include "app/lab/tune/starts.h"
#include "app/lab/tune/trial.h"

#include "engine/scene/scene_file.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include <gtest/gtest.h>

namespace plumb {
namespace {

namespace fs = std::filesystem;

// All others run at what `plumb tune` found: a new scene, too, or it says why not here.
const std::map<std::string, std::string> &not_tuned() {
    static const std::string cloth = "cloth", particles = "springs between many particles";
    static const std::map<std::string, std::string> why{
        {"book_cloth", cloth},
        {"cloth_over_sphere", cloth},
        {"flag", cloth},
        {"hammock", cloth},
        {"hanging_cloth", cloth},
        {"trampoline", cloth},
        {"catenary", particles},
        {"soft_rope", particles},
        {"two_masses",
         "springs that are pushed together buckle when begun a hair beside their line"},
        {"heavy_chain", "with the four substeps that it needs, its links come visibly apart"},
        {"struck_before_wall", "the three substeps that hold it miss at other speeds and steps"}};
    return why;
}

// The start other than the scene's own from which it is run. Of heaps, where chance plays in, the
// first from which what is cheaper misses.
int other_start(const std::string &scene) {
    static const std::map<std::string, int> starts{{"666", 5}, {"kapla", 6}};
    const auto found = starts.find(scene);
    return found != starts.end() ? found->second : 1;
}

std::vector<fs::path> tuned_scenes() {
    std::vector<fs::path> files;
    for (const fs::directory_entry &file :
         fs::recursive_directory_iterator(fs::path(PLUMB_SOURCE_DIR) / "scenes"))
        if (file.path().extension() == ".toml" && has_world(load_scene(file.path()).scene) &&
            !not_tuned().contains(file.path().stem().string()))
            files.push_back(file.path());
    std::ranges::sort(files);
    return files;
}

class TunedScene : public testing::TestWithParam<fs::path> {
  protected:
    void SetUp() override {
        std::vector<SceneMessage> messages;
        const SceneText text{GetParam(), read_scene_text(GetParam(), messages).value()};
        const std::vector<SceneDesc> all = starts_of(text, other_start(GetParam().stem().string()));
        scene_starts = {all.front(), all.back()};
        own_settings = resolve_run(scene_starts.front(), {}).settings;
    }

    // With the margin, from both starts or until one misses.
    [[nodiscard]] TunedRun run(const RunOptions &options) const {
        return Trial(scene_starts, TuneOptions{}).run(options, {});
    }

    void expect_missed_or_more_work(const RunOptions &options, double work) const {
        const TunedRun other = run(options);
        EXPECT_TRUE(other.verdict != TuneVerdict::met || other.work > work / same_cost)
            << other.resolved.settings.substeps << " substeps, at most "
            << other.resolved.settings.max_substeps << ", " << other.resolved.settings.iterations
            << " iterations: " << other.worst << ": " << other.error;
    }

    std::vector<SceneDesc> scene_starts;
    StepSettings own_settings;
};

TEST_P(TunedScene, MeetsWhatItExpectsWithAMarginAndTheNextCheaperDoesNot) {
    const TunedRun own = run({});
    EXPECT_EQ(own.verdict, TuneVerdict::met) << own.worst << ": " << own.error;
    if (own_settings.substeps > 1) {
        RunOptions fewer;
        fewer.settings.give(&StepSettings::substeps, own_settings.substeps - 1);
        expect_missed_or_more_work(fewer, own.work);
    }
    if (own_settings.iterations > 1) {
        RunOptions fewer;
        fewer.settings.give(&StepSettings::iterations, own_settings.iterations - 1);
        expect_missed_or_more_work(fewer, own.work);
    }
}

INSTANTIATE_TEST_SUITE_P(All, TunedScene, testing::ValuesIn(tuned_scenes()),
                         [](const auto &scene) { return scene.param.stem().string(); });

TEST(TunedScenes, OfThoseThatAreNotEachIsThere) {
    for (const auto &[name, why] : not_tuned()) {
        bool found = false;
        for (const fs::directory_entry &file :
             fs::recursive_directory_iterator(fs::path(PLUMB_SOURCE_DIR) / "scenes"))
            found = found || file.path().filename() == name + ".toml";
        EXPECT_TRUE(found) << name;
    }
}

} // namespace
} // namespace plumb
