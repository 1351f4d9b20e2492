#include "app/render/imgui_renderer.h"

#include <imgui/imgui.h>

#include "app/render/fonts.h"
#include "tests/render/off_screen.h"

namespace plumb {
namespace {

class Painting : public OffScreen {
  protected:
    Painting() {
        ImGui::CreateContext();
        ImGui::GetIO().IniFilename = nullptr;
        font = load_font(*ImGui::GetIO().Fonts, 16);
        imgui = std::make_unique<ImguiRenderer>(shader_dir());
    }
    ~Painting() override {
        imgui.reset();
        ImGui::DestroyContext();
    }

    ImFont *font = nullptr;
    std::unique_ptr<ImguiRenderer> imgui;
};

constexpr glm::vec3 grey{0.6f, 0.6f, 0.6f};
const glm::u8vec3 grey_bytes{153, 153, 153};

TEST_F(Painting, AnEmptyPictureIsItsBackground) {
    EXPECT_EQ(paint_image(*imgui, {30, 20}, grey, [](ImDrawList &) {}), Image(30, 20, grey_bytes));
}

TEST_F(Painting, ARectangleCoversItsPixelsInItsColour) {
    const Image image = paint_image(*imgui, {40, 30}, grey, [](ImDrawList &list) {
        list.Flags = 0; // no soft edges
        list.AddRectFilled({5, 10}, {15, 25}, IM_COL32(10, 200, 90, 255));
        list.AddRectFilled({20, 10}, {30, 25}, IM_COL32(255, 255, 255, 128));
    });
    for (int y = 0; y < 30; ++y) {
        for (int x = 0; x < 40; ++x) {
            const bool row = y >= 10 && y < 25;
            if (row && x >= 5 && x < 15)
                EXPECT_EQ(image.at(x, y), glm::u8vec3(10, 200, 90));
            else if (row && x >= 20 && x < 30) // blended in sRGB: 153 + (255 - 153) * 128 / 255
                EXPECT_NEAR(image.at(x, y).x, 204, 1);
            else
                EXPECT_EQ(image.at(x, y), grey_bytes);
        }
    }
}

TEST_F(Painting, ClipsToRectangles) {
    const Image image = paint_image(*imgui, {40, 30}, grey, [](ImDrawList &list) {
        list.PushClipRect({8, 3}, {20, 12});
        list.AddRectFilled({0, 0}, {40, 30}, IM_COL32(0, 0, 0, 255));
        list.PopClipRect();
    });
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x)
            EXPECT_EQ(image.at(x, y).x, x >= 8 && x < 20 && y >= 3 && y < 12 ? 0 : 153);
}

TEST_F(Painting, DrawsMoreVerticesThanSixteenBitsCount) {
    const Image image = paint_image(*imgui, {200, 150}, grey, [](ImDrawList &list) {
        list.Flags = ImDrawListFlags_AllowVtxOffset;
        for (int y = 0; y < 150; ++y)
            for (int x = 0; x < 200; ++x)
                list.AddRectFilled({static_cast<float>(x), static_cast<float>(y)},
                                   {static_cast<float>(x + 1), static_cast<float>(y + 1)},
                                   IM_COL32(x, y, 77, 255));
    });
    for (int y = 0; y < 150; ++y)
        for (int x = 0; x < 200; ++x)
            EXPECT_EQ(image.at(x, y), glm::u8vec3(x, y, 77));
}

TEST_F(Painting, TextLeavesInkWhereItStands) {
    ASSERT_TRUE(font->IsLoaded());
    const Image image = paint_image(*imgui, {100, 40}, {1, 1, 1}, [](ImDrawList &list) {
        list.AddText({10, 10}, IM_COL32(0, 0, 0, 255), "H");
    });
    int dark = 0;
    for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 100; ++x) {
            if (image.at(x, y).x > 128)
                continue;
            ++dark;
            EXPECT_TRUE(x >= 10 && x < 26 && y >= 10 && y < 26) << x << ", " << y;
        }
    }
    EXPECT_GT(dark, 15);
}

TEST_F(Painting, PanelsLieOverTheScene) {
    DrawList list = plain_list();
    Framebuffer target({64, 48}, 4);
    renderer.draw(list, target);
    const Image scene = target.read();
    ImGui::GetIO().DisplaySize = {64, 48};
    ImGui::NewFrame();
    ImGui::GetBackgroundDrawList()->AddRectFilled({0, 0}, {32, 48}, IM_COL32(1, 2, 3, 255));
    ImGui::Render();
    imgui->draw(*ImGui::GetDrawData(), target);
    const Image both = target.read();
    EXPECT_EQ(both.at(10, 20), glm::u8vec3(1, 2, 3));
    EXPECT_EQ(both.at(50, 20), scene.at(50, 20));
    // The next scene is drawn as if there had been no panel.
    renderer.draw(list, target);
    EXPECT_EQ(target.read(), scene);
}

TEST(Fonts, AMissingFileGivesTheBuiltInFont) {
    ImFontAtlas atlas;
    ImFont *font = load_font(atlas, 27, "/nowhere/none.ttf");
    ASSERT_NE(font, nullptr);
    EXPECT_TRUE(atlas.Build());
    EXPECT_EQ(font->FontSize, 26);
}

} // namespace
} // namespace plumb
