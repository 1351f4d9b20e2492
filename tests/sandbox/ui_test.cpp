#include "app/sandbox/ui_snapshot.h"

#include "app/render/context.h"
#include "app/sandbox/layout.h"
#include "engine/scene/scene_file.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>

#include <gtest/gtest.h>
#include <imgui/imgui.h>

namespace plumb {
namespace {

const std::filesystem::path source(PLUMB_SOURCE_DIR);

bool overlap(const Rect &a, const Rect &b) {
    return a.min.x < b.max().x && b.min.x < a.max().x && a.min.y < b.max().y && b.min.y < a.max().y;
}

// Colours within a rectangle, and the number of pixels that are far brighter than the panel: text.
struct Look {
    std::set<std::uint32_t> colours;
    std::size_t bright = 0;
};
Look look(const Image &image, const Rect &rect) {
    Look look;
    for (int y = static_cast<int>(rect.min.y); y < static_cast<int>(rect.max().y); ++y) {
        for (int x = static_cast<int>(rect.min.x); x < static_cast<int>(rect.max().x); ++x) {
            const glm::u8vec3 c = image.at(x, y);
            look.colours.insert(static_cast<std::uint32_t>(c.r << 16 | c.g << 8 | c.b));
            look.bright += std::max({c.r, c.g, c.b}) > 130 ? 1 : 0;
        }
    }
    return look;
}

class UiTest : public testing::Test {
  protected:
    UiTest() {
        ContextRequest request;
        request.off_screen = true;
        request.choice = GlChoice::osmesa;
        context = create_context(request).context;
        renderer = std::make_unique<Renderer>(source / "shaders");
        for (const char *name : {"free/free_fall", "joints/pendulum", "stacking/ten_box_stack"}) {
            SceneEntry entry;
            entry.path = source / "scenes" / (std::string(name) + ".toml");
            entry.subject = entry.path.parent_path().filename().string();
            entry.name = entry.path.stem().string();
            scenes.push_back(entry);
        }
    }
    // Objects of GL go before their context.
    std::unique_ptr<GlContext> context;
    std::unique_ptr<Renderer> renderer;
    std::vector<SceneEntry> scenes;
};

TEST_F(UiTest, PanelsAreDrawnAndNothingOverlaps) {
    for (const glm::ivec2 size : {glm::ivec2(1280, 800), glm::ivec2(1024, 768)}) {
        for (const bool busy : {false, true}) {
            Sandbox sandbox(Session(), scenes);
            ASSERT_TRUE(sandbox.open(scenes[2].path));
            for (int i = 0; i < 20; ++i)
                sandbox.session().step();
            if (busy) {
                sandbox.view().selected = 1;
                sandbox.view().help = true;
                for (int i = 0; i < 30; ++i)
                    sandbox.session().messages().error("a.toml:" + std::to_string(i) +
                                                       ": error: this is wrong");
            }
            std::vector<Ui::Panel> panels;
            const Image image =
                ui_snapshot(sandbox, *renderer, source / "shaders", size, 1, &panels);
            ASSERT_EQ(panels.size(), busy ? 8u : 6u);
            for (std::size_t i = 0; i < panels.size(); ++i) {
                const Rect &rect = panels[i].rect;
                EXPECT_GE(rect.min.x, 0) << panels[i].name;
                EXPECT_GE(rect.min.y, 0) << panels[i].name;
                EXPECT_LE(rect.max().x, static_cast<float>(size.x)) << panels[i].name;
                EXPECT_LE(rect.max().y, static_cast<float>(size.y)) << panels[i].name;
                for (std::size_t j = i + 1; j < panels.size(); ++j)
                    EXPECT_FALSE(overlap(rect, panels[j].rect))
                        << panels[i].name << " and " << panels[j].name;
                // Text is anti-aliased: many shades, and some of them bright.
                const Look seen = look(image, rect);
                EXPECT_GT(seen.colours.size(), 20u) << panels[i].name;
                EXPECT_GT(seen.bright, 50u) << panels[i].name;
            }
        }
    }
}

// Whether what a scene expects holds is said in the verdict's own colour, green or red, as soon as
// it is known and only then.
TEST_F(UiTest, ThePanelSaysWhatIsMetAndWhatIsMissed) {
    struct Coloured {
        std::size_t green = 0, red = 0;
    };
    const auto verdicts = [&](Sandbox &sandbox) {
        std::vector<Ui::Panel> panels;
        const Image image =
            ui_snapshot(sandbox, *renderer, source / "shaders", {1280, 800}, 1, &panels);
        const auto details = std::ranges::find(panels, std::string("details"), &Ui::Panel::name);
        EXPECT_NE(details, panels.end());
        Coloured seen;
        const glm::ivec2 min(details->rect.min), max(details->rect.max());
        for (int y = min.y; y < max.y; ++y)
            for (int x = min.x; x < max.x; ++x) {
                const glm::ivec3 c(image.at(x, y));
                seen.green += c.g - c.r > 35 && c.g - c.b > 20 ? 1 : 0;
                seen.red += c.r - c.g > 50 ? 1 : 0;
            }
        return seen;
    };
    SceneDesc scene = load_scene(scenes[0].path).scene; // free fall, 2 s
    for (const bool right : {true, false}) {
        if (!right)
            scene.expects.at(0).value += 1;
        Sandbox sandbox{Session()};
        ASSERT_TRUE(sandbox.open(scene));
        for (int i = 0; i < 119; ++i)
            sandbox.session().step();
        Coloured seen = verdicts(sandbox);
        EXPECT_EQ(seen.green + seen.red, 0U) << "pending";
        sandbox.session().step();
        seen = verdicts(sandbox);
        EXPECT_GT(right ? seen.green : seen.red, 10U);
        EXPECT_EQ(right ? seen.red : seen.green, 0U);
        sandbox.session().step_back();
        seen = verdicts(sandbox);
        EXPECT_EQ(seen.green + seen.red, 0U) << "pending again";
    }
}

TEST_F(UiTest, TheSameStateGivesTheSamePicture) {
    const auto picture = [&] {
        Sandbox sandbox(Session(), scenes);
        EXPECT_TRUE(sandbox.open(scenes[2].path));
        for (int i = 0; i < 10; ++i)
            sandbox.session().step(); // each with its own wall time
        return ui_snapshot(sandbox, *renderer, source / "shaders", {1280, 800});
    };
    EXPECT_EQ(picture(), picture());
}

TEST_F(UiTest, HiddenPanelsLeaveTheSceneAlone) {
    Sandbox sandbox(Session(), scenes);
    ASSERT_TRUE(sandbox.open(scenes[2].path));
    sandbox.perform(Action::toggle_panels);
    sandbox.clock().set_paused(true);
    std::vector<Ui::Panel> panels;
    const Image with = ui_snapshot(sandbox, *renderer, source / "shaders", {640, 480}, 1, &panels);
    EXPECT_TRUE(panels.empty());
    EXPECT_EQ(with, render_image(*renderer, sandbox.draw_list(), {640, 480}));
}

TEST_F(UiTest, WithoutASceneThereIsStillAProgram) {
    Sandbox sandbox{Session()};
    EXPECT_FALSE(sandbox.open(std::filesystem::path("/no/such.toml")));
    std::vector<Ui::Panel> panels;
    const Image image =
        ui_snapshot(sandbox, *renderer, source / "shaders", {1280, 800}, 1, &panels);
    EXPECT_EQ(panels.size(), 7u); // with the message that says why
    EXPECT_FALSE(image.empty());
}

// A click at a place of the list, as ImGui sees it.
TEST_F(UiTest, AClickInTheListOpensAScene) {
    Sandbox sandbox(Session(), scenes);
    ASSERT_TRUE(sandbox.open(scenes[0].path));
    Ui ui;
    ImGui::GetIO().Fonts->Build();
    const auto frame = [&](ImVec2 mouse, bool down) {
        ui.fill_input({1280, 800}, 1.0f / 60);
        ImGui::GetIO().MousePos = mouse;
        ImGui::GetIO().MouseDown[0] = down;
        ui.begin_frame();
        PanelContext panels = sandbox.panel_context(ui.fonts());
        static_cast<void>(ui.draw(panels));
        sandbox.take(panels);
    };
    const Layout layout = lay_out({1280, 800}, 1, {});
    const ImVec2 outside(640, 400);
    frame(outside, false);
    EXPECT_FALSE(ui.over_panel());
    // Down the middle of the list until the second scene is met.
    for (float y = layout.scenes.min.y; y < layout.scenes.max().y - 50; y += 6) {
        const ImVec2 at(layout.scenes.min.x + layout.scenes.size.x / 2, y);
        frame(at, false);
        frame(at, true);
        frame(at, false);
        if (sandbox.session().path() == scenes[1].path)
            break;
    }
    EXPECT_EQ(sandbox.session().path(), scenes[1].path);
    EXPECT_TRUE(ui.over_panel());
    EXPECT_TRUE(sandbox.session().messages().empty());
}

} // namespace
} // namespace plumb
