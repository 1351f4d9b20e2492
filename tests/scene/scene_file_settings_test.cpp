// Writing changed settings into scene files.
#include "engine/scene/file/settings.h"

#include "engine/scene/file/change.h"
#include "engine/scene/scene_file.h"

#include <filesystem>
#include <sstream>
#include <stdexcept>

#include <gtest/gtest.h>

namespace plumb {
namespace {

constexpr const char *ball = R"(
[[body]] # the only one
name = "ball"
shape = "sphere"
radius = 0.5
)";

ResolvedRun run_of(const std::string &text, const RunOptions &options) {
    return resolve_run(parse_scene(text, "scene.toml").scene, options);
}

std::string written(const std::string &text, const RunOptions &options) {
    return with_run(text, "scene.toml", run_of(text, options));
}

RunOptions with(const std::vector<std::string> &settings, const std::string &method = "",
                std::optional<Precision> precision = {}) {
    RunOptions options;
    options.method = method;
    options.precision = precision;
    for (const std::string &setting : settings)
        options.settings.give(parse_setting(setting));
    return options;
}

std::string complaint(const std::string &text, const RunOptions &options) {
    try {
        (void)written(text, options);
    } catch (const std::invalid_argument &error) {
        return error.what();
    }
    return "";
}

TEST(SceneFileSettings, AValueIsReplacedWhereItStands) {
    const std::string text = std::string("# top\n[world]\n  dt= '1/60'  # a frame\nsubsteps = 8 # "
                                         "many\nseed = 3\n") +
                             ball;
    EXPECT_EQ(written(text, with({"substeps=2", "dt=1/30"})),
              std::string("# top\n[world]\n  dt= \"1/30\"  # a frame\nsubsteps = 2 # many\nseed = "
                          "3\n") +
                  ball);
}

TEST(SceneFileSettings, WhatIsNotThereIsAddedToTheWorld) {
    const std::string text = std::string("[world]\ndt = \"1/60\"\n\n# a camera\n[camera]\ndistance "
                                         "= 3\n") +
                             ball;
    EXPECT_EQ(written(text, with({"max_substeps=1", "substeps=1"}, "", Precision::f64)),
              std::string("[world]\ndt = \"1/60\"\nsubsteps = 1\nmax_substeps = 1\nprecision = "
                          "\"double\"\n\n# a camera\n[camera]\ndistance = 3\n") +
                  ball);
}

TEST(SceneFileSettings, AWorldIsAddedBeforeTheFirstTableAndItsComment) {
    EXPECT_EQ(written("title = \"x\"\n\n# about the ball\n[[body]]\nshape = \"sphere\"\nname = "
                      "\"b\"\nradius = 1",
                      with({"substeps=1"})),
              "title = \"x\"\n\n[world]\nsubsteps = 1\n\n# about the ball\n[[body]]\nshape = "
              "\"sphere\"\nname = \"b\"\nradius = 1");
}

TEST(SceneFileSettings, WhatIsWrittenAlreadyIsLeftAlone) {
    for (const auto &file :
         std::filesystem::recursive_directory_iterator(PLUMB_SOURCE_DIR "/scenes")) {
        if (file.path().extension() != ".toml")
            continue;
        std::vector<SceneMessage> messages;
        const std::string text = read_scene_text(file.path(), messages).value();
        const SceneDesc scene = parse_scene(text, file.path().string()).scene;
        EXPECT_EQ(with_run(text, file.path().string(), resolve_run(scene, {})), text)
            << file.path();
        const ResolvedRun other = resolve_run(
            scene, with({"substeps=77", "dt=1/77", "iterations=7"}, "tgs_soft", Precision::f64));
        const SceneDesc changed =
            parse_scene(with_run(text, file.path().string(), other), file.path().string()).scene;
        EXPECT_EQ(changed.world.method, "tgs_soft") << file.path();
        EXPECT_EQ(resolve_run(changed, {}).settings.substeps, 77) << file.path();
    }
}

TEST(SceneFileSettings, WithAnotherMethodTheOldOneKeepsItsSettings) {
    const std::string text = std::string("[world]\nsubsteps = 8 # of its own\ndt = 0.01\n\n# needs "
                                         "more\n[methods.tgs_soft]\nsubsteps = 32\n\n[methods."
                                         "rk4]\nsubsteps = 2\n") +
                             ball;
    const std::string changed = written(text, with({"substeps=16"}, "tgs_soft"));
    EXPECT_EQ(changed, std::string("[world]\ndt = 0.01\nmethod = \"tgs_soft\"\nsubsteps = "
                                   "16\n\n[methods.soft_step]\nsubsteps = 8 # of its "
                                   "own\n\n[methods.rk4]\nsubsteps = 2\n") +
                           ball);
    EXPECT_EQ(run_of(changed, with({}, "soft_step")).settings.substeps, 8);
    EXPECT_EQ(run_of(changed, with({}, "rk4")).settings.substeps, 2);
    EXPECT_EQ(run_of(changed, {}).settings.substeps, 16);
}

// Comments on settings go with them, both inside their table and above it.
TEST(SceneFileSettings, CommentsOfWhatIsRemovedGoToo) {
    const std::string text = "# all of it\n[world]\ndt = 0.01\n\n# needs more,\n# since it is "
                             "soft\n[methods.tgs_soft]\n# at least\nsubsteps = 32\n" +
                             std::string("\n# the ball\n") + ball;
    EXPECT_EQ(written(text, with({"substeps=16"}, "tgs_soft")),
              "# all of it\n[world]\ndt = 0.01\nmethod = \"tgs_soft\"\nsubsteps = 16\n\n# the "
              "ball\n" +
                  std::string(ball));
}

TEST(SceneFileSettings, LinesKeepTheirEnds) {
    EXPECT_EQ(written("[world]\r\nseed = 2\r\n\r\n[[body]]\r\nname = \"b\"\r\nshape = "
                      "\"sphere\"\r\nradius = 1\r\n",
                      with({"substeps=2"})),
              "[world]\r\nseed = 2\r\nsubsteps = 2\r\n\r\n[[body]]\r\nname = \"b\"\r\nshape = "
              "\"sphere\"\r\nradius = 1\r\n");
    EXPECT_EQ(written(ball + std::string("[world]\nseed = 2"), with({"substeps=2"})),
              ball + std::string("[world]\nseed = 2\nsubsteps = 2\n"));
}

TEST(SceneFileSettings, AnEndWithoutALineEndStays) {
    const std::string text = ball + std::string("[world]\nsubsteps = 4");
    EXPECT_EQ(written(text, {}), text);
    EXPECT_EQ(written(text, with({"substeps=2"})), ball + std::string("[world]\nsubsteps = 2"));
}

TEST(SceneFileSettings, ALayoutThatItCannotChangeIsRefused) {
    for (const char *world : {"world = { dt = 0.01, substeps = 8 }\n", "world.substeps = 8\n",
                              "world = { substeps = 8, precision = \"float\" }\n"})
        EXPECT_NE(
            complaint(std::string(world) + ball, with({"substeps=2"})).find("on a line of its own"),
            std::string::npos)
            << world;
    EXPECT_NE(complaint(std::string("description = \"\"\"\n[world]\nsubsteps = 3\n\"\"\"\nworld = "
                                    "{ substeps = 8 }\n") +
                            ball,
                        with({"substeps=2"}))
                  .find("on a line of its own"),
              std::string::npos);
}

} // namespace
} // namespace plumb
