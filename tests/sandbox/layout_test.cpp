#include "app/sandbox/panels/layout.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/core/random.h"

#include <gtest/gtest.h>

namespace plumb {
namespace {

bool overlap(const Rect &a, const Rect &b) {
    return a.min.x < b.max().x && b.min.x < a.max().x && a.min.y < b.max().y && b.min.y < a.max().y;
}

void expect_apart_and_inside(const PerPanel<Rect> &rects, glm::vec2 window) {
    for (std::size_t i = 0; i < panel_count; ++i) {
        const Rect &a = rects[i];
        if (!(a.size.y > 0))
            continue;
        EXPECT_GE(a.min.x, 0) << i;
        EXPECT_GE(a.min.y, 0) << i;
        EXPECT_LE(a.max().x, window.x) << i;
        EXPECT_LE(a.max().y, window.y) << i;
        for (std::size_t j = i + 1; j < panel_count; ++j)
            EXPECT_FALSE(rects[j].size.y > 0 && overlap(a, rects[j]))
                << i << " and " << j << " at " << window.x << " x " << window.y;
    }
}

TEST(Layout, NothingOverlapsAndAllIsInside) {
    Random random(3);
    for (const glm::vec2 window :
         {smallest_window, glm::vec2(800, 500), glm::vec2(860, 600), glm::vec2(1024, 768),
          glm::vec2(1280, 800), glm::vec2(1920, 1080), glm::vec2(3840, 2160)}) {
        for (int i = 0; i < 200; ++i) {
            PerPanel<float> wished{};
            for (float &height : wished)
                height = i == 0                     ? 1e6f
                         : random.next_in(0, 4) < 1 ? 0
                                                    : static_cast<float>(random.next_in(20, 900));
            if (!is_roomy(window, 1))
                wished[PanelId::help] = 0; // it opens alone there
            expect_apart_and_inside(lay_out(window, 1, wished), window);
            if (HasFailure())
                return;
        }
    }
}

TEST(Layout, NoScaleThatIsAskedForPutsPanelsOutOfReach) {
    EXPECT_EQ(scale_that_fits(2, {2560, 1600}), 2.0f);
    EXPECT_EQ(scale_that_fits(3, {1280, 800}), 2.0f);
    EXPECT_EQ(scale_that_fits(3, smallest_window), 1.0f);
    EXPECT_EQ(scale_that_fits(0.5f, {320, 200}), 0.5f);
    Random random(4);
    for (int i = 0; i < 2000; ++i) {
        const glm::vec2 window(std::round(random.next_in(640, 3840)),
                               std::round(random.next_in(400, 2160)));
        const float scale = scale_that_fits(static_cast<float>(random.next_in(0.5, 4)), window);
        PerPanel<float> wished{};
        for (float &height : wished)
            height = scale * static_cast<float>(random.next_in(40, 900));
        if (!is_roomy(window, scale))
            wished[PanelId::help] = 0;
        expect_apart_and_inside(lay_out(window, scale, wished), window);
        ASSERT_FALSE(HasFailure()) << "at a scale of " << scale;
    }
}

TEST(Layout, APanelIsAsHighAsItsContentsWhileThereIsRoom) {
    PerPanel<float> wished{};
    wished[PanelId::scenes] = 2000;
    wished[PanelId::settings] = 220;
    wished[PanelId::view] = 34;
    wished[PanelId::details] = 150;
    const PerPanel<Rect> rects = lay_out({1280, 800}, 1, wished);
    EXPECT_EQ(rects[PanelId::settings].size.y, 220);
    EXPECT_EQ(rects[PanelId::view].size.y, 34);
    EXPECT_EQ(rects[PanelId::details].size.y, 150);
    EXPECT_EQ(rects[PanelId::view].max().y, 792); // the list gets the rest
    EXPECT_EQ(rects[PanelId::diagnostics].size.y, 0);
}

TEST(Layout, InASmallWindowTheHelpStandsAlone) {
    EXPECT_FALSE(is_roomy(smallest_window, 1));
    EXPECT_FALSE(is_roomy({1280, 800}, 2)); // a screen of twice the pixel density
    PerPanel<float> wished{};
    wished[PanelId::help] = 500;
    const Rect help = lay_out(smallest_window, 1, wished)[PanelId::help];
    EXPECT_GT(help.size.x, 600);
    EXPECT_LE(help.max().y, smallest_window.y);
}

TEST(Layout, InASmallWindowTheLabStandsAboveTheBar) {
    PerPanel<float> wished{};
    wished[PanelId::lab] = 500;
    wished[PanelId::transport] = 90;
    wished[PanelId::messages] = 60;
    const PerPanel<Rect> rects = lay_out(smallest_window, 1, wished);
    expect_apart_and_inside(rects, smallest_window);
    EXPECT_GT(rects[PanelId::lab].size.x, 600);
    EXPECT_GT(rects[PanelId::lab].size.y, 180);
}

TEST(Layout, InANarrowWindowTheColumnsEndAboveTheLab) {
    PerPanel<float> wished{};
    wished[PanelId::scenes] = wished[PanelId::details] = wished[PanelId::lab] = 500;
    wished[PanelId::transport] = 90;
    const PerPanel<Rect> rects = lay_out(smallest_window, 1, wished);
    expect_apart_and_inside(rects, smallest_window);
    EXPECT_GT(rects[PanelId::lab].size.y, 180);
    EXPECT_GT(rects[PanelId::scenes].size.y, 80);
    EXPECT_LT(rects[PanelId::scenes].max().y, rects[PanelId::lab].min.y);
}

TEST(Layout, TheLabLeavesTheSceneHalfOfTheMiddle) {
    PerPanel<float> wished{};
    wished[PanelId::scenes] = wished[PanelId::details] = wished[PanelId::lab] = 2000;
    wished[PanelId::transport] = 90;
    const PerPanel<Rect> rects = lay_out({1280, 800}, 1, wished);
    EXPECT_GT(rects[PanelId::lab].min.y, 330);
    EXPECT_GT(rects[PanelId::lab].size.y, 330);
    EXPECT_LT(rects[PanelId::lab].max().y, rects[PanelId::transport].min.y);
    wished[PanelId::lab] = 100;
    EXPECT_EQ(lay_out({1280, 800}, 1, wished)[PanelId::lab].min, rects[PanelId::lab].min);
}

TEST(FreePart, IsTheLargestThatNothingCovers) {
    const glm::vec2 window(1000, 800);
    EXPECT_EQ(free_part(window, {}, 1).size, window);
    const std::vector<Rect> columns{{{8, 8}, {200, 780}}, {{780, 8}, {212, 500}}};
    const Rect between = free_part(window, columns, 1);
    EXPECT_EQ(between.min, glm::vec2(208, 0));
    EXPECT_EQ(between.size, glm::vec2(572, 800));
    // Collapsed to their titles, they leave the space below free.
    const std::vector<Rect> titles{{{8, 8}, {200, 34}}, {{780, 8}, {212, 34}}};
    const Rect below = free_part(window, titles, 16.0f / 9);
    EXPECT_EQ(below.min, glm::vec2(0, 42));
    EXPECT_EQ(below.size, glm::vec2(1000, 758));
    // Almost nothing is left: the panels lie over the scene.
    const std::vector<Rect> all{{{0, 0}, {950, 800}}};
    EXPECT_EQ(free_part(window, all, 1).size, window);
}

// Brute force: no uncovered rectangle of a coarse grid holds a larger picture.
TEST(FreePart, NoFreeRectangleHoldsALargerPicture) {
    Random random(11);
    const glm::vec2 window(400, 300);
    for (int i = 0; i < 30; ++i) {
        std::vector<Rect> taken;
        for (int k = 0; k < 4; ++k)
            taken.push_back({{static_cast<float>(random.next_in(0, 300)),
                              static_cast<float>(random.next_in(0, 200))},
                             {static_cast<float>(random.next_in(10, 100)),
                              static_cast<float>(random.next_in(10, 100))}});
        const auto height = [](const Rect &rect) {
            return std::min(rect.size.y, rect.size.x / 1.25f);
        };
        const auto is_free = [&](const Rect &rect) {
            return std::ranges::none_of(taken,
                                        [&](const Rect &other) { return overlap(rect, other); });
        };
        const Rect found = free_part(window, taken, 1.25f);
        for (float x = 0; x < window.x; x += 20)
            for (float y = 0; y < window.y; y += 20)
                for (float right = x + 20; right <= window.x; right += 20)
                    for (float bottom = y + 20; bottom <= window.y; bottom += 20) {
                        const Rect rect{{x, y}, {right - x, bottom - y}};
                        EXPECT_TRUE(!is_free(rect) || height(rect) <= height(found) + 1e-3f);
                    }
        EXPECT_TRUE(found.size == window || is_free(found));
    }
}

} // namespace
} // namespace plumb
