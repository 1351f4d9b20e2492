// The light beside the run, after what a user does.
#include "app/sandbox/session/run_light.h"

#include "app/sandbox/sandbox.h"
#include "engine/scene/scene_file.h"

#include <filesystem>
#include <memory>
#include <string>

#include <gtest/gtest.h>

namespace plumb {
namespace {

const std::filesystem::path lit_scenes = PLUMB_SOURCE_DIR "/scenes";

void click_on(Sandbox &sandbox, const RunChoice &choice) {
    PanelContext context = sandbox.panel_context(Fonts{});
    context.run = choice;
    sandbox.take(context);
}

void step_on(Sandbox &sandbox, int steps) {
    for (int i = 0; i < steps; ++i)
        ASSERT_TRUE(sandbox.session().step());
}

std::string all_said(const Sandbox &sandbox) {
    std::string said;
    for (const RunLight &light : lights_of(sandbox.session()))
        said += (light.is_red ? "red: " : "amber: ") + light.text + "\n";
    return said;
}

// A map of two steps: with the shorter one it held, with the longer one it did not, and one cell
// was not run.
MethodStudy map_of_steps(const Session &session) {
    MethodStudy study;
    study.settings = session.simulation()->settings();
    study.text = session.scene_text();
    study.map.scene = session.scene();
    study.map.x = parse_map_axis("dt=1/120,1/30");
    study.map.y = parse_map_axis("substeps=2,4");
    MethodMap &of_method = study.map.methods.emplace_back();
    of_method.method = &session.simulation()->method();
    of_method.cells = {MapRun{}, MapRun{{Failing::missed, "energy"}}, std::nullopt,
                       MapRun{{Failing::energy_grew, ""}}};
    return study;
}

TEST(RunLight, TurnsAmberAtOnceWhereAMapCellThatFailedIsApplied) {
    Sandbox sandbox{Session()};
    ASSERT_TRUE(sandbox.open(lit_scenes / "joints/pendulum.toml"));
    step_on(sandbox, 30);
    EXPECT_EQ(all_said(sandbox), "");
    const MethodStudy study = map_of_steps(sandbox.session());
    click_on(sandbox, choice_of(study, 1.0 / 30, 2));
    EXPECT_EQ(all_said(sandbox),
              "amber: With these settings the scene failed in the lab: missed (energy).\n");
    step_on(sandbox, 1);
    EXPECT_NE(all_said(sandbox), "");
    click_on(sandbox, choice_of(study, 1.0 / 30, 4));
    EXPECT_NE(all_said(sandbox).find("failed in the lab: energy grew."), std::string::npos);
    // It is no better for having begun anew.
    ASSERT_TRUE(sandbox.session().restart());
    EXPECT_NE(all_said(sandbox), "");
    step_on(sandbox, 1);
    EXPECT_NE(all_said(sandbox), "");
    // A cell that held is known to; so is the run as the file has it.
    click_on(sandbox, choice_of(study, 1.0 / 120, 2));
    step_on(sandbox, 1);
    EXPECT_EQ(all_said(sandbox), "");
    ASSERT_TRUE(sandbox.session().restart_as_written());
    EXPECT_EQ(all_said(sandbox), "");
}

TEST(RunLight, IsInDoubtOfSettingsThatTheRunDidNotStartWith) {
    Sandbox sandbox{Session()};
    Session &session = sandbox.session();
    ASSERT_TRUE(sandbox.open(lit_scenes / "joints/pendulum.toml"));
    const std::string doubt = "amber: Not known to hold with these settings, which are not those "
                              "the run started with.\n";
    const StepSettings own = session.simulation()->settings();
    StepSettings other = own;
    other.dt = own.dt / 2;
    // At the very start the whole run is theirs.
    ASSERT_TRUE(session.set_settings(other));
    EXPECT_EQ(all_said(sandbox), "");
    step_on(sandbox, 2);
    EXPECT_EQ(all_said(sandbox), "");
    ASSERT_TRUE(session.set_settings(own));
    EXPECT_EQ(all_said(sandbox), doubt);
    ASSERT_TRUE(session.set_settings(other));
    EXPECT_EQ(all_said(sandbox), "") << "as it started";
    ASSERT_TRUE(session.set_method("xpbd"));
    EXPECT_EQ(all_said(sandbox), doubt);
    // A cell that was not run says nothing.
    click_on(sandbox, choice_of(map_of_steps(session), 1.0 / 120, 4));
    EXPECT_EQ(all_said(sandbox), doubt);
    // Back at its start the run is theirs, and stays so.
    while (session.step_back()) {
    }
    EXPECT_EQ(all_said(sandbox), "");
    step_on(sandbox, 2);
    EXPECT_EQ(all_said(sandbox), "");
    ASSERT_TRUE(session.restart());
    EXPECT_EQ(all_said(sandbox), "");
}

TEST(RunLight, FollowsThePointOfAChartThatIsApplied) {
    Sandbox sandbox{Session()};
    ASSERT_TRUE(sandbox.open(lit_scenes / "joints/pendulum.toml"));
    step_on(sandbox, 5);
    ChartRun run;
    run.resolved.method = &sandbox.session().simulation()->method();
    run.resolved.settings = sandbox.session().simulation()->settings();
    run.resolved.settings.dt *= 2;
    run.run.outcomes.emplace_back().desc.name = "period";
    run.worst = 0;
    const auto applied = [&](ChartStatus status) {
        run.status = status;
        click_on(sandbox, choice_of(run));
        return all_said(sandbox);
    };
    EXPECT_NE(applied(ChartStatus::outside).find("it misses \"period\"."), std::string::npos);
    EXPECT_EQ(applied(ChartStatus::fine), "");
    EXPECT_NE(applied(ChartStatus::diverged).find("it diverged."), std::string::npos);
    // Other settings are not those that were noted; another scene is not that scene.
    StepSettings other = run.resolved.settings;
    other.dt *= 2;
    ASSERT_TRUE(sandbox.session().set_settings(other));
    EXPECT_NE(all_said(sandbox).find("Not known to hold"), std::string::npos);
    ASSERT_TRUE(sandbox.open(lit_scenes / "free/free_fall.toml"));
    EXPECT_EQ(all_said(sandbox), "");
}

// The gravest comes first.
TEST(RunLight, IsRedWhereTheRunHasFailedWhateverElse) {
    RunOptions options;
    options.method = "explicit_euler";
    options.settings.give(&StepSettings::dt, 1.0 / 15);
    options.settings.give(&StepSettings::substeps, 1);
    Sandbox sandbox{Session(options)};
    ASSERT_TRUE(sandbox.open(lit_scenes / "springs/spring_limit.toml"));
    while (lights_of(sandbox.session()).empty())
        step_on(sandbox, 1);
    sandbox.session().note_outcome("energy grew");
    const std::vector<RunLight> lights = lights_of(sandbox.session());
    ASSERT_EQ(lights.size(), 2U);
    EXPECT_TRUE(lights[0].is_red);
    EXPECT_EQ(lights[0].text, sandbox.session().trouble()->text);
    EXPECT_FALSE(lights[1].is_red);
}

} // namespace
} // namespace plumb
