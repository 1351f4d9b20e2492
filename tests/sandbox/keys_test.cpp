#include "app/sandbox/keys.h"

#include <algorithm>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace plumb {
namespace {

TEST(Keys, EveryActionHasOneRowAndAKey) {
    // `quit` is the last enumerator.
    for (int i = 0; i <= static_cast<int>(Action::quit); ++i) {
        const auto rows =
            std::ranges::count(actions(), static_cast<Action>(i), &ActionInfo::action);
        EXPECT_EQ(rows, 1) << "action " << i;
    }
    for (const ActionInfo &row : actions()) {
        EXPECT_FALSE(row.title.empty());
        EXPECT_FALSE(row.about.empty()) << row.title;
        EXPECT_FALSE(row.chords.empty()) << row.title;
    }
}

TEST(Keys, NoChordStandsForTwoActionsAndEachFindsItsOwn) {
    std::set<std::string> seen;
    for (const ActionInfo &row : actions()) {
        for (const Chord &chord : row.chords) {
            EXPECT_TRUE(seen.insert(name(chord)).second) << name(chord);
            const ActionInfo *found = find_action(chord);
            ASSERT_NE(found, nullptr) << name(chord);
            EXPECT_EQ(found->action, row.action) << name(chord);
        }
    }
    EXPECT_EQ(find_action({'z', false, false}), nullptr);
    EXPECT_EQ(find_action({'p', true, true}), nullptr);
}

// The keys people know from other programs.
TEST(Keys, AreTheKnownOnes) {
    using namespace special_key;
    const auto expect = [](Chord chord, Action action) {
        const ActionInfo *found = find_action(chord);
        ASSERT_NE(found, nullptr) << name(chord);
        EXPECT_EQ(found->action, action) << name(chord);
    };
    for (const auto &[key, action] :
         std::initializer_list<std::pair<char32_t, Action>>{{'p', Action::pause},
                                                            {' ', Action::pause},
                                                            {'.', Action::step},
                                                            {right, Action::step},
                                                            {',', Action::step_back},
                                                            {left, Action::step_back},
                                                            {'r', Action::restart},
                                                            {backspace, Action::restart},
                                                            {'[', Action::previous_scene},
                                                            {']', Action::next_scene},
                                                            {tab, Action::toggle_panels},
                                                            {'m', Action::toggle_diagnostics},
                                                            {'l', Action::toggle_lab},
                                                            {'g', Action::toggle_ghost},
                                                            {f1, Action::toggle_help},
                                                            {'?', Action::toggle_help},
                                                            {escape, Action::dismiss},
                                                            {'f', Action::frame},
                                                            {special_key::home, Action::home},
                                                            {'-', Action::slower},
                                                            {'=', Action::faster},
                                                            {'c', Action::toggle_contacts},
                                                            {'j', Action::toggle_joints},
                                                            {'w', Action::toggle_wireframe},
                                                            {'b', Action::toggle_bounds},
                                                            {'v', Action::toggle_velocities},
                                                            {'<', Action::previous_method},
                                                            {'>', Action::next_method}})
        expect({key, false, false}, action);
    expect({right, false, true}, Action::step_5);
    expect({left, false, true}, Action::step_back_5);
    expect({'l', true, false}, Action::reload);
    expect({'o', true, false}, Action::find_scene);
    expect({'p', true, false}, Action::screenshot);
    expect({'q', true, false}, Action::quit);
}

TEST(Keys, TheMarkdownListsEveryActionAndGesture) {
    const std::string text = keys_as_markdown();
    for (const ActionInfo &row : actions()) {
        EXPECT_NE(text.find("| " + std::string(row.title) + " |"), std::string::npos) << row.title;
        for (const Chord &chord : row.chords)
            EXPECT_NE(text.find("`" + name(chord) + "`"), std::string::npos) << name(chord);
    }
    for (const MouseInfo &row : mouse_gestures())
        EXPECT_NE(text.find("| " + std::string(row.gesture) + " |"), std::string::npos);
    // Two header lines, then one line per row.
    EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(text, '\n')),
              2 + actions().size() + mouse_gestures().size());
}

TEST(Keys, NamesAreForPeople) {
    using namespace special_key;
    EXPECT_EQ(name({'l', true, false}), "Ctrl+L");
    EXPECT_EQ(name({right, false, true}), "Shift+Right");
    EXPECT_EQ(name({' ', false, false}), "Space");
    EXPECT_EQ(name({'?', false, false}), "?");
}

} // namespace
} // namespace plumb
