#include "app/sandbox/ui_snapshot.h"

#include "app/render/context.h"
#include "app/sandbox/panels/layout.h"
#include "app/sandbox/panels/theme.h"
#include "app/sandbox/panels/widgets.h"
#include "app/sandbox/session/scene_catalog.h"
#include "engine/scene/scene_file.h"
#include "tests/sandbox/fake_simulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string_view>

#include <gtest/gtest.h>
#include <imgui/imgui.h>
#include <imgui/imgui_internal.h> // how far a list is scrolled

namespace plumb {
namespace {

const std::filesystem::path source(PLUMB_SOURCE_DIR);

bool windows_overlap(const Rect &a, const Rect &b) {
    return a.min.x < b.max().x && b.min.x < a.max().x && a.min.y < b.max().y && b.min.y < a.max().y;
}

// The colours in a rectangle, and the number of pixels much brighter than the panel: text.
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

// The draw data once windows have settled on their sizes.
const ImDrawData &settled(Ui &ui, Sandbox &sandbox, glm::vec2 window = {1280, 800}) {
    const ImDrawData *data = nullptr;
    for (int frame = 0; frame < 4; ++frame) {
        ui.fill_input(window, 1.0f / 60);
        ui.begin_frame();
        PanelContext panels = sandbox.panel_context(ui.fonts());
        data = &ui.draw(panels);
    }
    return *data;
}

// One frame with the pointer there and its button up or down.
void point(Ui &ui, Sandbox &sandbox, ImVec2 mouse, bool down) {
    ui.fill_input({1280, 800}, 1.0f / 60);
    ImGui::GetIO().MousePos = mouse;
    ImGui::GetIO().MouseDown[0] = down;
    ui.begin_frame();
    PanelContext panels = sandbox.panel_context(ui.fonts());
    static_cast<void>(ui.draw(panels));
    sandbox.take(panels);
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
    // GL objects are destroyed before their context.
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
                ui_snapshot(sandbox, *renderer, source / "shaders", {size}, &panels);
            ASSERT_EQ(panels.size(), busy ? 8u : 6u);
            for (std::size_t i = 0; i < panels.size(); ++i) {
                const Rect &rect = panels[i].rect;
                EXPECT_GE(rect.min.x, 0) << panels[i].name;
                EXPECT_GE(rect.min.y, 0) << panels[i].name;
                EXPECT_LE(rect.max().x, static_cast<float>(size.x)) << panels[i].name;
                EXPECT_LE(rect.max().y, static_cast<float>(size.y)) << panels[i].name;
                for (std::size_t j = i + 1; j < panels.size(); ++j)
                    EXPECT_FALSE(windows_overlap(rect, panels[j].rect))
                        << panels[i].name << " and " << panels[j].name;
                // Text is antialiased: many shades, some of them bright.
                const Look seen = look(image, rect);
                EXPECT_GT(seen.colours.size(), 20u) << panels[i].name;
                EXPECT_GT(seen.bright, 50u) << panels[i].name;
            }
        }
    }
}

// Each expectation's verdict is shown in its own colour, green or red, as soon as it is known and
// not before.
TEST_F(UiTest, ThePanelSaysWhatIsMetAndWhatIsMissed) {
    struct Coloured {
        std::size_t green = 0, red = 0;
    };
    const auto verdicts = [&](Sandbox &sandbox) {
        std::vector<Ui::Panel> panels;
        const Image image =
            ui_snapshot(sandbox, *renderer, source / "shaders", {{1280, 800}, 1, 1}, &panels);
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
        return ui_snapshot(sandbox, *renderer, source / "shaders", {});
    };
    EXPECT_EQ(picture(), picture());
}

TEST_F(UiTest, HiddenPanelsLeaveTheSceneAlone) {
    Sandbox sandbox(Session(), scenes);
    ASSERT_TRUE(sandbox.open(scenes[2].path));
    sandbox.perform(Action::toggle_panels);
    sandbox.clock().set_paused(true);
    std::vector<Ui::Panel> panels;
    const Image with = ui_snapshot(sandbox, *renderer, source / "shaders", {{640, 480}}, &panels);
    EXPECT_TRUE(panels.empty());
    EXPECT_EQ(with, render_image(*renderer, sandbox.draw_list(), {640, 480}));
}

TEST_F(UiTest, WithoutASceneThereIsStillAProgram) {
    Sandbox sandbox{Session()};
    EXPECT_FALSE(sandbox.open(std::filesystem::path("/no/such.toml")));
    std::vector<Ui::Panel> panels;
    const Image image = ui_snapshot(sandbox, *renderer, source / "shaders", {}, &panels);
    EXPECT_EQ(panels.size(), 3u); // no world panels, but the message that says why
    EXPECT_FALSE(image.empty());
}

// A click at a place in the list, as ImGui sees it.
TEST_F(UiTest, AClickInTheListOpensAScene) {
    Sandbox sandbox(Session(), scenes);
    ASSERT_TRUE(sandbox.open(scenes[0].path));
    Ui ui;
    ImGui::GetIO().Fonts->Build();
    const auto frame = [&](ImVec2 mouse, bool down) { point(ui, sandbox, mouse, down); };
    const ImVec2 outside(640, 400);
    for (int settled = 0; settled < 4; ++settled)
        frame(outside, false);
    EXPECT_FALSE(ui.over_panel());
    ASSERT_EQ(ui.panels().front().id, PanelId::scenes);
    const Rect list = ui.panels().front().rect;
    // Down the middle of the list, below the title that would close it, until it hits the second
    // scene.
    for (float y = list.min.y + 34; y < list.max().y - 50; y += 6) {
        const ImVec2 at(list.min.x + list.size.x / 2, y);
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

TEST_F(UiTest, AfterASearchTheOpenSceneIsInSightAgain) {
    Sandbox sandbox(Session(), find_scenes(source / "scenes"));
    ASSERT_TRUE(sandbox.open(scenes[2].path)); // near the end of the list
    Ui ui;
    ImGui::GetIO().Fonts->Build();
    const auto list_begins = [&](const char *search) {
        sandbox.view().search = search;
        static_cast<void>(settled(ui, sandbox));
        for (const ImGuiWindow *window : ImGui::GetCurrentContext()->Windows)
            if (std::string_view(window->Name).starts_with("scenes/list"))
                return window->Scroll.y;
        return -1.0f;
    };
    const float scrolled = list_begins("");
    EXPECT_GT(scrolled, 100);
    EXPECT_EQ(list_begins("pendulum"), 0);
    EXPECT_EQ(list_begins(""), scrolled);
}

TEST_F(UiTest, EscClosesAListThatIsOpen) {
    Sandbox sandbox(Session(), scenes);
    ASSERT_TRUE(sandbox.open(scenes[1].path));
    Ui ui;
    ImGui::GetIO().Fonts->Build();
    const auto frame = [&](ImVec2 mouse, bool down) { point(ui, sandbox, mouse, down); };
    const auto is_open = [] { return ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup); };
    for (int settled = 0; settled < 4; ++settled)
        frame({640, 400}, false);
    EXPECT_FALSE(ui.close_list());
    ASSERT_EQ(ui.panels()[1].id, PanelId::settings);
    const Rect settings = ui.panels()[1].rect;
    for (float y = settings.min.y + 30; y < settings.max().y && !is_open(); y += 6) {
        const ImVec2 at(settings.min.x + settings.size.x / 2, y); // on the method, or on the step
        frame(at, false);
        frame(at, true);
        frame(at, false);
    }
    ASSERT_TRUE(is_open());
    EXPECT_TRUE(ui.close_list());
    EXPECT_FALSE(is_open());
    frame({640, 400}, false);
    EXPECT_FALSE(ui.close_list());
}

std::vector<Rect> without_those_that_come_and_go(const std::vector<Ui::Panel> &panels) {
    std::vector<Rect> rects;
    for (const Ui::Panel &panel : panels)
        if (panel.id != PanelId::messages && panel.id != PanelId::help)
            rects.push_back(panel.rect);
    return rects;
}

bool covers(const Rect &rect, const glm::vec3 &pixel) {
    return pixel.x > rect.min.x && pixel.x < rect.max().x && pixel.y > rect.min.y &&
           pixel.y < rect.max().y;
}

// No panel covers what the scene's own camera shows in a 16:9 picture.
TEST_F(UiTest, NoPanelLiesOverWhatASceneShows) {
    for (const SceneEntry &entry : find_scenes(source / "scenes")) {
        Sandbox sandbox(Session(), scenes);
        ASSERT_TRUE(sandbox.open(entry.path));
        std::vector<glm::vec3> places;
        DrawList list = sandbox.draw_list();
        for (const DrawShape &shape : list.shapes)
            places.push_back(shape.position);
        for (const DrawLine &line : list.lines)
            places.insert(places.end(), {line.a, line.b});
        for (const DrawPoint &point : list.points)
            places.push_back(point.position);
        const Camera own = list.camera;
        const glm::vec2 window(1280, 800);
        std::vector<Ui::Panel> panels;
        static_cast<void>(ui_snapshot(sandbox, *renderer, source / "shaders", {}, &panels));
        for (const glm::vec3 &place : places) {
            const glm::vec3 in_own = own.project(place, {1600, 900});
            if (!(in_own.z < 1 && in_own.x > 0 && in_own.x < 1600 && in_own.y > 0 &&
                  in_own.y < 900))
                continue;
            const glm::vec3 seen = sandbox.view().camera.project(place, window);
            for (const Ui::Panel &panel : panels)
                ASSERT_FALSE(covers(panel.rect, seen)) << entry.name << ": " << panel.name;
        }
    }
}

TEST_F(UiTest, AWorldThatIsNotThereHasNoPanels) {
    Sandbox sandbox(Session(), scenes);
    ASSERT_TRUE(sandbox.open(source / "scenes/geometry/vectors.toml"));
    std::vector<Ui::Panel> panels;
    static_cast<void>(ui_snapshot(sandbox, *renderer, source / "shaders", {}, &panels));
    ASSERT_EQ(panels.size(), 3u);
    EXPECT_EQ(panels[0].id, PanelId::scenes);
    EXPECT_EQ(panels[1].id, PanelId::view);
    EXPECT_EQ(panels[2].id, PanelId::details);
}

TEST_F(UiTest, PanelsAreAsHighAsTheirContentsAndCloseToTheirTitles) {
    Sandbox sandbox(Session(), scenes);
    ASSERT_TRUE(sandbox.open(scenes[2].path));
    std::vector<Ui::Panel> open;
    static_cast<void>(ui_snapshot(sandbox, *renderer, source / "shaders", {{1280, 1200}}, &open));
    float bottom = 0; // these have room to spare: three scenes are a short list
    for (const Ui::Panel &panel : open)
        if (panel.id != PanelId::transport)
            bottom = std::max(bottom, panel.rect.max().y);
    EXPECT_LT(bottom, 1100);
    const float share = sandbox.view().camera.share;
    sandbox.view().opened.fill(false);
    std::vector<Ui::Panel> closed;
    static_cast<void>(ui_snapshot(sandbox, *renderer, source / "shaders", {{1280, 1200}}, &closed));
    ASSERT_EQ(closed.size(), open.size());
    for (const Ui::Panel &panel : closed)
        EXPECT_LT(panel.rect.size.y, 60) << panel.name;
    EXPECT_GT(sandbox.view().camera.share, 1.3f * share);
}

// In a window of the minimum size the panels are closed; opened one by one, each still finds room.
TEST_F(UiTest, ASmallWindowIsUsable) {
    Sandbox sandbox(Session(), scenes);
    ASSERT_TRUE(sandbox.open(scenes[1].path));
    const glm::ivec2 size(smallest_window);
    for (std::size_t opened = 0; opened <= panel_count; ++opened) {
        std::vector<Ui::Panel> panels;
        static_cast<void>(ui_snapshot(sandbox, *renderer, source / "shaders", {size}, &panels));
        ASSERT_EQ(panels.size(), 6u);
        EXPECT_TRUE(opened > 0 || sandbox.view().camera.share > 0.4f);
        const std::vector<Rect> rects = without_those_that_come_and_go(panels);
        for (std::size_t i = 0; i < rects.size(); ++i) {
            EXPECT_LE(rects[i].max().x, smallest_window.x) << panels[i].name;
            EXPECT_LE(rects[i].max().y, smallest_window.y) << panels[i].name;
            for (std::size_t j = i + 1; j < rects.size(); ++j)
                EXPECT_FALSE(windows_overlap(rects[i], rects[j]))
                    << panels[i].name << " and " << panels[j].name;
        }
        if (opened < panel_count)
            sandbox.view().opened[opened] = true;
    }
}

TEST_F(UiTest, LargerPanelsAreLarger) {
    Sandbox sandbox(Session(), scenes);
    ASSERT_TRUE(sandbox.open(scenes[2].path));
    const auto height = [&](glm::ivec2 size, float scale) {
        std::vector<Ui::Panel> panels;
        static_cast<void>(
            ui_snapshot(sandbox, *renderer, source / "shaders", {size, 1, scale}, &panels));
        EXPECT_EQ(panels[1].id, PanelId::settings);
        return panels[1].rect.size.y;
    };
    EXPECT_NEAR(height({2560, 1600}, 2), 2 * height({1280, 800}, 1), 8);
}

TEST_F(UiTest, PanelsThatAreOpenStayOpenAsTheTextGrows) {
    Sandbox sandbox(Session(), scenes);
    ASSERT_TRUE(sandbox.open(scenes[2].path));
    const auto is_open = [&](float scale) {
        static_cast<void>(
            ui_snapshot(sandbox, *renderer, source / "shaders", {{1280, 800}, 1, scale}));
        return sandbox.view().is_open(PanelId::settings);
    };
    EXPECT_FALSE(is_open(2)); // nobody has opened any
    EXPECT_TRUE(is_open(1));
    EXPECT_TRUE(is_open(2));
}

// In all windows, or only in the named one and the areas that scroll in it.
double area_of(const ImDrawData &data, const Colour &colour, const char *window = nullptr) {
    const ImU32 wanted = ImGui::ColorConvertFloat4ToU32(colour) & ~IM_COL32_A_MASK;
    double area = 0;
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList &list = *data.CmdLists[i];
        if (window && !std::string_view(list._OwnerName).starts_with(window))
            continue;
        for (int k = 0; k + 2 < list.IdxBuffer.Size; k += 3) {
            const ImDrawVert &a = list.VtxBuffer[list.IdxBuffer[k]];
            const ImDrawVert &b = list.VtxBuffer[list.IdxBuffer[k + 1]];
            const ImDrawVert &c = list.VtxBuffer[list.IdxBuffer[k + 2]];
            if ((a.col & ~IM_COL32_A_MASK) != wanted)
                continue;
            area += std::abs((b.pos.x - a.pos.x) * (c.pos.y - a.pos.y) -
                             (b.pos.y - a.pos.y) * (c.pos.x - a.pos.x)) /
                    2;
        }
    }
    return area;
}

// A narrow panel shows as much of every letter as a wide one.
TEST_F(UiTest, NoNumberIsCutInANarrowWindow) {
    const auto text_in = [&](const char *panel, ImVec2 window) {
        Sandbox sandbox(Session(), scenes);
        EXPECT_TRUE(sandbox.open(scenes[2].path));
        sandbox.view().selected = 4;
        sandbox.view().diagnostics = false;
        for (const PanelId opened : {PanelId::settings, PanelId::view, PanelId::details})
            sandbox.view().opened[opened] = true;
        Ui ui;
        ImGui::GetIO().Fonts->Build();
        const ImDrawData &data = settled(ui, sandbox, {window.x, window.y});
        return area_of(data, theme::text, panel);
    };
    for (const char *panel : {"settings", "view", "details"}) {
        const double whole = text_in(panel, {1280, 900});
        EXPECT_GT(whole, 500);
        EXPECT_NEAR(text_in(panel, {1000, 900}), whole, 1e-3 * whole) << panel;
        EXPECT_NEAR(text_in(panel, {640, 900}), whole, 1e-3 * whole) << panel;
    }
}

// Each curve has its own colour and its full length; what was stepped back over is gone.
TEST_F(UiTest, TheLabPlotsWhatWasChosen) {
    const auto plotted = [&](int steps, int back, glm::vec2 size) {
        Sandbox sandbox(Session(), scenes);
        EXPECT_TRUE(sandbox.open(scenes[1].path)); // a pendulum
        sandbox.perform(Action::toggle_lab);
        EXPECT_TRUE(sandbox.session().plot({"position.y", "bob"}));
        EXPECT_TRUE(sandbox.session().plot({"energy", ""}));
        sandbox.view().plot_seconds = 10;
        for (int i = 0; i < steps; ++i)
            EXPECT_TRUE(sandbox.session().step());
        for (int i = 0; i < back; ++i)
            EXPECT_TRUE(sandbox.session().step_back());
        Ui ui;
        ImGui::GetIO().Fonts->Build();
        const ImDrawData &data = settled(ui, sandbox, size);
        const auto lab = std::ranges::find(ui.panels(), PanelId::lab, &Ui::Panel::id);
        EXPECT_NE(lab, ui.panels().end());
        for (const Ui::Panel &panel : ui.panels())
            EXPECT_TRUE(panel.id == PanelId::lab || !windows_overlap(lab->rect, panel.rect))
                << panel.name;
        // Minus its swatch in the legend.
        return std::array{area_of(data, {0.42f, 0.68f, 0.90f, 1}, "lab") - 90,
                          area_of(data, {0.90f, 0.64f, 0.42f, 1}, "lab") - 90};
    };
    for (const glm::vec2 size : {glm::vec2(1280, 800), smallest_window}) {
        const auto begun = plotted(0, 0, size), run = plotted(400, 0, size),
                   back = plotted(400, 400, size);
        for (const std::size_t curve : {0u, 1u}) {
            EXPECT_LT(begun[curve], 100);
            EXPECT_GT(run[curve], begun[curve] + 500);
            EXPECT_EQ(back[curve], begun[curve]);
        }
    }
}

// Like a selected body, it comes to the front and its quantities are offered.
TEST_F(UiTest, AParticleThatIsSelectedIsShown) {
    Sandbox sandbox(Session(), scenes);
    ASSERT_TRUE(sandbox.open(source / "scenes/cloth/flag.toml"));
    sandbox.perform(Action::toggle_lab);
    Ui ui;
    ImGui::GetIO().Fonts->Build();
    const auto headings = [&] { // the scene has some, a particle has none
        const ImDrawData &data = settled(ui, sandbox);
        return area_of(data, theme::accent, "details");
    };
    const double of_scene = headings();
    EXPECT_GT(of_scene, 0);
    sandbox.view().selected_particle = 7;
    EXPECT_EQ(headings(), 0);
    EXPECT_EQ(sandbox.view().plot_of,
              sandbox.session().simulation()->soft_parts().particle_name(7));
    sandbox.view().selected_particle.reset();
    EXPECT_EQ(headings(), of_scene);
}

// In a scene that has them, each in a row of its own.
TEST_F(UiTest, ParticlesAndSpringsAreCounted) {
    const auto height = [&](const std::filesystem::path &scene) {
        Sandbox sandbox(Session(), scenes);
        EXPECT_TRUE(sandbox.open(scene));
        EXPECT_TRUE(sandbox.session().step());
        std::vector<Ui::Panel> panels;
        static_cast<void>(
            ui_snapshot(sandbox, *renderer, source / "shaders", {{1280, 1600}, 1, 1}, &panels));
        const auto found = std::ranges::find(panels, PanelId::diagnostics, &Ui::Panel::id);
        EXPECT_NE(found, panels.end());
        return found->rect.size.y;
    };
    const float row = 16 + 4; // text and spacing
    EXPECT_NEAR(height(source / "scenes/cloth/flag.toml"), height(scenes[0].path) + 3 * row, 2);
}

// A number stays on one line with its unit and tolerance, and words wrap whole.
TEST_F(UiTest, TextIsBrokenAtSpacesAlone) {
    Ui ui;
    ImGui::GetIO().Fonts->Build();
    ui.fill_input({1280, 800}, 1.0f / 60);
    ui.begin_frame();
    ImGui::Begin("text");
    const auto lines = [](const std::string &text, const std::string &as_wide_as) {
        wrapped(text, ImGui::CalcTextSize(as_wide_as.c_str()).x);
        return std::lround(ImGui::GetItemRectSize().y / ImGui::GetTextLineHeight());
    };
    EXPECT_EQ(lines("found 2.153", "found 2.153"), 1);
    EXPECT_EQ(lines("found 2.153", "found 2.1"), 2);
    EXPECT_EQ(lines("a b " + unbroken("1 ± 2 m"), "a b 1 ± 2"), 2);
    EXPECT_EQ(lines("a b 1 ± 2 m", "a b 1 ± 2"), 2);
    EXPECT_EQ(lines(unbroken("1 ± 2 m"), "1 ± 2"), 2); // does not fit on one line
    EXPECT_EQ(lines("one\ntwo", "one two"), 2);
    ImGui::End();
    ImGui::EndFrame();
}

// Each pixel column covers several samples; the line does not show which way they go.
TEST_F(UiTest, ACurveThatFallsIsDrawnAsOneThatRises) {
    const auto area = [&](double gravity) {
        SceneDesc scene;
        scene.name = "ball";
        scene.world.settings.give(&StepSettings::gravity, glm::dvec3(0, gravity, 0));
        BodyDesc &ball = scene.bodies.emplace_back();
        ball.name = "ball";
        ball.colliders.emplace_back().shape = SphereDesc{0.5};
        Sandbox sandbox{Session()};
        EXPECT_TRUE(sandbox.open(scene));
        sandbox.perform(Action::toggle_lab);
        EXPECT_TRUE(sandbox.session().plot({"velocity.y", "ball"}));
        for (int i = 0; i < 3000; ++i)
            EXPECT_TRUE(sandbox.session().step());
        Ui ui;
        ImGui::GetIO().Fonts->Build();
        const ImDrawData &data = settled(ui, sandbox);
        return area_of(data, {0.42f, 0.68f, 0.90f, 1}, "lab");
    };
    const double rises = area(1);
    EXPECT_GT(rises, 1500);
    EXPECT_NEAR(area(-1), rises, 0.01 * rises);
}

// A phase that takes no time does not show in the step-time graph, only as a legend swatch below.
TEST_F(UiTest, APhaseWithoutTimeLeavesNoTraceInTheGraph) {
    Sandbox sandbox(Session({}, nullptr, make_fake()));
    ASSERT_TRUE(sandbox.open(two_balls()));
    auto &fake = dynamic_cast<FakeSimulation &>(*sandbox.session().simulation());
    for (int i = 0; i < 240; ++i) {
        fake.advance_time = i % 7 == 0 ? 1e-3 : 1e-4;
        ASSERT_TRUE(sandbox.session().step());
    }
    Ui ui;
    ImGui::GetIO().Fonts->Build();
    const ImDrawData &data = settled(ui, sandbox);
    EXPECT_GT(area_of(data, {0.50f, 0.76f, 0.58f, 1}), 500); // advance
    EXPECT_LT(area_of(data, {0.72f, 0.62f, 0.86f, 1}), 130); // finish
}

} // namespace
} // namespace plumb
