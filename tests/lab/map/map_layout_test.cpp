#include "app/lab/map/map_layout.h"

#include "engine/core/random.h"

#include <gtest/gtest.h>

namespace plumb {
namespace {

glm::vec2 size_of_text(std::string_view text, float font_size) {
    return {0.5f * font_size * static_cast<float>(text.size()), font_size};
}

StabilityMap any_map(Random &random, std::size_t methods) {
    StabilityMap map;
    map.scene.title = std::string(random.next_index(200), 'w');
    const std::uint32_t expects = random.next_index(30);
    for (std::uint32_t i = 0; i < expects; ++i)
        map.scene.expects.emplace_back().name =
            std::string(1 + random.next_index(40), 'e') + std::to_string(i);
    map.x.name = "body.ball.velocity.x";
    map.y.name = "gravity.y";
    for (MapAxis *axis : {&map.x, &map.y})
        for (std::size_t i = 0, count = 2 + random.next_index(63); i < count; ++i)
            axis->values.push_back(static_cast<double>(i) + 1e-5 * random.next_in(0, 1));
    for (std::size_t m = 0; m < methods; ++m) {
        MethodMap of_method{&method_infos()[m % method_infos().size()], {}, {}};
        for (std::size_t i = 0; i < map.x.values.size() * map.y.values.size(); ++i) {
            MapRun run;
            run.failing.failing = static_cast<Failing>(
                random.next_index(static_cast<std::uint32_t>(failings().size())));
            if (expects > 0)
                run.failing.what = map.scene.expects[random.next_index(expects)].name;
            of_method.cells.emplace_back(run);
        }
        of_method.limits.push_back({map.y.values[0], map.x.values[0], map.x.values[1], true, {}});
        map.methods.push_back(std::move(of_method));
    }
    return map;
}

TEST(MapLayout, NoTextMeetsAnotherOrLeavesThePicture) {
    Random random(7);
    for (int trial = 0; trial < 60; ++trial) {
        const StabilityMap map = any_map(random, 1 + random.next_index(6));
        const MapLayout layout = lay_out(
            map, {}, {"plumb map a --x b=1..2", std::string(300, 'f') + " and more"}, size_of_text);
        std::vector<MapText> texts{layout.title, layout.subtitle, layout.x_title, layout.y_title};
        for (const MapPanel &panel : layout.panels) {
            texts.push_back(panel.title);
            texts.insert(texts.end(), panel.x_labels.begin(), panel.x_labels.end());
            texts.insert(texts.end(), panel.y_labels.begin(), panel.y_labels.end());
            ASSERT_GT(panel.plot.max.x - panel.plot.min.x, 100);
            ASSERT_GT(panel.plot.max.y - panel.plot.min.y, 60);
            ASSERT_GE(panel.x_labels.size(), 1U);
            for (const MapCellBox &cell : panel.cells)
                if (cell.mark) {
                    ASSERT_TRUE(cell.box.contains(cell.mark->box));
                    for (const glm::vec2 &limit : panel.limits)
                        ASSERT_FALSE(
                            cell.mark->box.overlaps({limit - limit_radius, limit + limit_radius}));
                }
        }
        for (const MapLegendEntry &entry : layout.legend) {
            texts.push_back(entry.text);
            texts.push_back({entry.letter, entry.sample});
        }
        texts.insert(texts.end(), layout.footer.begin(), layout.footer.end());
        for (std::size_t i = 0; i < texts.size(); ++i) {
            ASSERT_TRUE((PixelBox{{0, 0}, layout.size}).contains(texts[i].box)) << texts[i].text;
            for (const MapPanel &panel : layout.panels)
                ASSERT_FALSE(texts[i].box.overlaps(panel.plot)) << texts[i].text;
            for (std::size_t j = 0; j < i; ++j)
                ASSERT_FALSE(texts[i].box.overlaps(texts[j].box))
                    << texts[i].text << " and " << texts[j].text;
        }
    }
}

TEST(MapLayout, PutsTheFirstCellAtTheLowerLeft) {
    Random random(1);
    StabilityMap map = any_map(random, 1);
    map.x.values = {1, 2};
    map.y.values = {10, 20, 30};
    map.methods[0].cells.assign(6, MapRun{});
    map.methods[0].cells[0]->failing.failing = Failing::drift;
    map.methods[0].limits = {{20, 1, 2, true, {}}};
    const MapLayout layout = lay_out(map, {}, {}, size_of_text);
    const MapPanel &panel = layout.panels[0];
    ASSERT_EQ(panel.cells.size(), 6U);
    EXPECT_EQ(panel.cells[0].failing, Failing::drift);
    EXPECT_EQ(panel.cells[0].box.min.x, panel.plot.min.x);
    EXPECT_NEAR(panel.cells[0].box.max.y, panel.plot.max.y, 1e-3);
    // Between the two columns, in the middle row.
    const glm::vec2 middle = 0.5f * (panel.plot.min + panel.plot.max);
    EXPECT_NEAR(panel.limits[0].x, middle.x, 1e-3);
    EXPECT_NEAR(panel.limits[0].y, middle.y, 1e-3);
}

} // namespace
} // namespace plumb
