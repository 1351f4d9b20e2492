#include "app/sandbox/layout.h"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumb {
namespace {

bool overlap(const Rect &a, const Rect &b) {
    return a.min.x < b.max().x && b.min.x < a.max().x && a.min.y < b.max().y && b.min.y < a.max().y;
}

TEST(Layout, NothingOverlapsAndAllIsInside) {
    for (const glm::vec2 window : {smallest_window, glm::vec2(1024, 768), glm::vec2(1280, 800),
                                   glm::vec2(1920, 1080), glm::vec2(3840, 2160)}) {
        for (const float messages : {0.0f, 60.0f, 5000.0f}) {
            for (const bool diagnostics : {true, false}) {
                LayoutWishes wishes;
                wishes.diagnostics = diagnostics;
                wishes.messages_height = messages;
                const Layout layout = lay_out(window, 1, wishes);
                std::vector<std::pair<std::string, Rect>> all{
                    {"scenes", layout.scenes},      {"settings", layout.settings},
                    {"view", layout.view},          {"details", layout.details},
                    {"messages", layout.messages},  {"help", layout.help},
                    {"transport", layout.transport}};
                if (diagnostics)
                    all.emplace_back("diagnostics", layout.diagnostics);
                for (std::size_t i = 0; i < all.size(); ++i) {
                    const Rect &a = all[i].second;
                    EXPECT_GE(a.min.x, 0) << all[i].first;
                    EXPECT_GE(a.min.y, 0) << all[i].first;
                    EXPECT_LE(a.max().x, window.x) << all[i].first;
                    EXPECT_LE(a.max().y, window.y) << all[i].first;
                    for (std::size_t j = i + 1; j < all.size(); ++j)
                        EXPECT_FALSE(overlap(a, all[j].second))
                            << all[i].first << " and " << all[j].first << " at " << window.x
                            << " x " << window.y;
                }
            }
        }
    }
}

} // namespace
} // namespace plumb
