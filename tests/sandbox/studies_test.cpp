#include "app/sandbox/studies/studies.h"

#include "app/render/context.h"
#include "app/sandbox/panels/ui.h"
#include "app/sandbox/sandbox.h"
#include "engine/scene/scene_file.h"
#include "tests/sandbox/hurry.h"

#include <algorithm>
#include <filesystem>

#include <unistd.h>

#include <gtest/gtest.h>
#include <imgui/imgui.h>

namespace plumb {
namespace {

const std::filesystem::path scenes = std::filesystem::path(PLUMB_SOURCE_DIR) / "scenes";

// A run is the same with or without a chart being made beside it.
TEST(Studies, AChartIsMadeBesideThePlayAndDoesNotTouchIt) {
    const auto hash = [](bool charts) {
        Session session;
        EXPECT_TRUE(session.open(scenes / "joints/pendulum.toml"));
        ChartStudy study;
        if (charts)
            start_chart(study, session, "substeps=1,4");
        for (int i = 0; i < 300; ++i)
            EXPECT_TRUE(session.step());
        if (charts) {
            EXPECT_TRUE(wait_for(study));
            const auto chart = study.result();
            EXPECT_EQ(study.failure(), "");
            EXPECT_TRUE(chart && chart->runs.size() == chart->planned && chart->planned >= 4);
        }
        return session.simulation()->hash();
    };
    EXPECT_EQ(hash(true), hash(false));
}

TEST(Studies, MistakesAreToldAtOnce) {
    Session session;
    ASSERT_TRUE(session.open(scenes / "free/free_fall.toml"));
    ChartStudy chart;
    EXPECT_THROW(start_chart(chart, session, "substeps"), std::invalid_argument);
    EXPECT_THROW(start_chart(chart, session, "substeps=1 substeps=2"), std::invalid_argument);
    MapStudy map;
    EXPECT_THROW(start_map(map, session, "dt", "substeps=1,2"), std::invalid_argument);
    EXPECT_THROW(start_map(map, session, "dt=1/60,1/30", "dt=1/60,1/30"), std::invalid_argument);
    start_map(map, session, "dt=1/60,1/30", "body.nobody.mass=1,2"); // only the scene can tell
    ASSERT_TRUE(wait_for(map));
    EXPECT_NE(map.failure(), "");
}

TEST(Studies, AMapIsMadeAndItsCellsCanBeChosen) {
    Session session;
    ASSERT_TRUE(session.open(scenes / "free/free_fall.toml"));
    const std::string body = session.scene().bodies.back().name;
    MapStudy study;
    start_map(study, session, "dt=1/120,1/30", "body." + body + ".position.y=50,60");
    ASSERT_TRUE(wait_for(study));
    ASSERT_EQ(study.failure(), "");
    const auto found = study.result();
    ASSERT_TRUE(found);
    const StabilityMap *map = &found->map;
    ASSERT_EQ(map->methods.size(), 1u);
    EXPECT_EQ(map->methods[0].method, &session.simulation()->method());
    EXPECT_TRUE(std::ranges::all_of(map->methods[0].cells,
                                    [](const auto &cell) { return cell.has_value(); }));
    const RunChoice choice = choice_of(*found, 1.0 / 30, 60);
    EXPECT_EQ(choice.settings.dt, 1.0 / 30);
    ASSERT_TRUE(choice.scene);
    EXPECT_EQ(choice.scene->bodies.back().position.y, 60);
    Sandbox sandbox{Session()};
    ASSERT_TRUE(sandbox.open(scenes / "free/free_fall.toml"));
    PanelContext context = sandbox.panel_context(Fonts{});
    context.run = choice;
    sandbox.take(context);
    EXPECT_EQ(sandbox.session().simulation()->settings().dt, 1.0 / 30);
    EXPECT_EQ(sandbox.session().present_bodies().back().position.y, 60);
}

// Several numbers of the file, or one under another name.
TEST(Studies, ACellOverANameAppliesTheNumbersItStandsFor) {
    Session session;
    ASSERT_TRUE(session.open(scenes / "contact/struck_before_wall.toml"));
    MapStudy study;
    start_map(study, session, "mass_ratio=1,50", "distance=0.3,0.6");
    ASSERT_TRUE(wait_for(study));
    ASSERT_EQ(study.failure(), "");
    const RunChoice choice = choice_of(*study.result(), 50, 0.3);
    ASSERT_TRUE(choice.scene);
    EXPECT_EQ(choice.scene->bodies.back().mass, 50); // the other one's is 1
    EXPECT_NEAR(choice.scene->bodies.back().position.x, -0.205 - 0.3, 1e-12);
}

// Studies show and use the running scene, whatever happened to its file.
TEST(Studies, AreOfTheSceneThatRuns) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("plumb-running-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    std::filesystem::copy_file(scenes / "free/free_fall.toml", folder / "fall.toml");
    Sandbox sandbox{Session()};
    ASSERT_TRUE(sandbox.open(folder / "fall.toml"));
    Session &session = sandbox.session();
    const std::string body = session.scene().bodies.back().name;
    const auto map_of = [&](const std::string &y) {
        MapStudy study;
        start_map(study, session, "dt=1/60,1/30", y);
        EXPECT_TRUE(wait_for(study));
        EXPECT_EQ(study.failure(), "");
        return *study.result();
    };
    const auto click = [&](const RunChoice &choice) {
        PanelContext context = sandbox.panel_context(Fonts{});
        context.run = choice;
        sandbox.take(context);
    };
    const MethodStudy heights = map_of("body." + body + ".position.y=50,60");
    click(choice_of(heights, 1.0 / 60, 60));
    EXPECT_EQ(session.scene().bodies.back().position.y, 60);
    std::filesystem::resize_file(folder / "fall.toml", 0); // while it runs
    EXPECT_NE(session.scene_text().text, "");
    const MethodStudy weights = map_of("body." + body + ".gravity_scale=1,2");
    EXPECT_EQ(weights.map.scene.bodies.back().position.y, 60); // as clicked before
    click(choice_of(weights, 1.0 / 60, 2));
    EXPECT_EQ(session.scene().bodies.back().position.y, 60);
    EXPECT_EQ(session.scene().bodies.back().gravity_scale, 2);
    click(choice_of(heights, 1.0 / 60, 50)); // in the earlier map
    EXPECT_EQ(session.scene().bodies.back().position.y, 50);
    std::filesystem::remove_all(folder);
}

TEST(Studies, OfAnotherSceneAreForgottenAndEnd) {
    Sandbox sandbox{Session()};
    ASSERT_TRUE(sandbox.open(scenes / "stacking/pyramid.toml"));
    PanelContext context = sandbox.panel_context(Fonts{});
    start_chart(context.chart, sandbox.session(), "substeps=200,400");
    start_map(context.map, sandbox.session(), "dt=1/60,1/30", "substeps=200,400");
    sandbox.view().sweep_mistake = sandbox.view().map_mistake = "of the old scene";
    ASSERT_TRUE(sandbox.open(scenes / "free/free_fall.toml"));
    EXPECT_FALSE(context.chart.running());
    EXPECT_FALSE(context.map.running());
    EXPECT_EQ(context.chart.result(), nullptr);
    EXPECT_EQ(context.map.result(), nullptr);
    EXPECT_EQ(sandbox.view().sweep_mistake, "");
    EXPECT_EQ(sandbox.view().map_mistake, "");
}

// An applied choice is recorded and replays to the same states.
TEST(Studies, AClickOnAPointIsARecordedCommand) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("plumb-studies-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    Sandbox sandbox{Session()};
    sandbox.session().record();
    ASSERT_TRUE(sandbox.open(scenes / "stacking/ten_box_stack.toml"));
    for (int i = 0; i < 5; ++i)
        ASSERT_TRUE(sandbox.session().step());
    ChartRun run;
    run.resolved.method = find_method_info("sequential_impulses");
    run.resolved.settings = sandbox.session().simulation()->settings();
    run.resolved.settings.iterations = 13;
    PanelContext context = sandbox.panel_context(Fonts{});
    context.run = choice_of(run);
    sandbox.take(context);
    EXPECT_EQ(sandbox.session().simulation()->method().name, "sequential_impulses");
    EXPECT_EQ(sandbox.session().simulation()->settings().iterations, 13);
    for (int i = 0; i < 5; ++i)
        ASSERT_TRUE(sandbox.session().step());
    const std::uint64_t hash = sandbox.session().simulation()->hash();
    OutputFile file(folder / "run.toml");
    sandbox.session().write_recording(file);

    Session again;
    ASSERT_TRUE(again.open_recording(folder / "run.toml"));
    while (again.step()) {
    }
    EXPECT_EQ(again.replay_outcome(), ExitCode::fine);
    EXPECT_EQ(again.simulation()->hash(), hash);
    std::filesystem::remove_all(folder);
}

// As a user does it: the tab, the button, then a point.
TEST(Studies, InTheLabAPointIsFoundAndClicked) {
    Sandbox sandbox{Session()};
    ASSERT_TRUE(sandbox.open(scenes / "free/free_fall.toml"));
    sandbox.clock().set_paused(true);
    sandbox.perform(Action::toggle_lab);
    sandbox.view().sweeps = "substeps=1,2";
    Ui ui;
    ImGui::GetIO().Fonts->Build();
    bool is_asked = false;
    const auto frame = [&](ImVec2 mouse, bool down) {
        ui.fill_input({1280, 800}, 1.0f / 60);
        ImGui::GetIO().MousePos = mouse;
        ImGui::GetIO().MouseDown[0] = down;
        ui.begin_frame();
        PanelContext panels = sandbox.panel_context(ui.fonts());
        static_cast<void>(ui.draw(panels));
        is_asked = panels.run.has_value();
        sandbox.take(panels);
    };
    const auto lab = [&] {
        return std::ranges::find(ui.panels(), PanelId::lab, &Ui::Panel::id)->rect;
    };
    const auto click = [&](ImVec2 at) {
        frame(at, false);
        frame(at, true);
        const bool asked = is_asked;
        frame(at, false);
        return asked;
    };
    for (int settled = 0; settled < 4; ++settled)
        frame({640, 200}, false);
    click({lab().min.x + 110, lab().min.y + 22});
    for (int settled = 0; settled < 4; ++settled)
        frame({640, 200}, false);
    bool started = false;
    PanelContext before = sandbox.panel_context(ui.fonts());
    for (float x = lab().min.x + 20; x < lab().max().x && !started; x += 20) {
        click({x, lab().min.y + 56});
        started = before.chart.running() || before.chart.result();
    }
    ASSERT_TRUE(started);
    ASSERT_TRUE(wait_for(before.chart));
    for (int settled = 0; settled < 4; ++settled)
        frame({640, 200}, false);
    bool chosen = false;
    for (float y = lab().min.y + 90; y < lab().max().y && !chosen; y += 8)
        for (float x = lab().min.x + 40; x < lab().max().x && !chosen; x += 8)
            chosen = click({x, y});
    EXPECT_TRUE(chosen);
    EXPECT_TRUE(sandbox.session().messages().empty());
}

} // namespace
} // namespace plumb
