// Mutated files: the reader never crashes, and each message points into the file.
#include "engine/scene/scene_file.h"
#include "tests/trials.h"

#include "engine/core/random.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace plumb {
namespace {

const std::string valid = R"(title = "A bit of everything"
description = """
Two
lines."""

[world]
gravity = [0, -9.81, 0]
dt = "1/60"
method = "soft_step"
substeps = 4
iterations = 2
precision = "float"
seed = 7

[methods.pgs]
iterations = 50

[camera]
target = [0, 1, 0]
distance = 10
yaw_deg = 30
pitch_deg = 20
fov_deg = 45

[[material]]
name = "steel"
density = 7800
friction = 0.4
restitution = 0.1
color = "#8899aa"

[[body]]
name = "ground"
shape = "plane"

[[body]]
name = "crate"
kind = "dynamic"
shape = "box"
half_extents = [0.5, 0.5, 0.5]
material = "steel"
position = [0, 0.5, 0]
rotation_deg = [0, 30, 0]
repeat = { kind = "stack", count = 3, turn_deg = 10 }

[[body]]
name = "ball"
shape = "sphere"
radius = 0.25
mass = 3
position = [4, 0.25, 0]
axis = [0, 1, 0]
angle_deg = 12.5
velocity = [-1, 0, 0]
angular_velocity_deg = [0, 0, 90]
color = [1, 0.5, 0]

[[body]]
name = "link"
shape = "capsule"
half_height = 0.1
radius = 0.05
density = 500
position = [-4, 3, 0]
orientation = [1, 0, 0, 0]
repeat = { kind = "line", count = 5, step = [0, -0.4, 0] }

[[body]]
name = "dust"
shape = "sphere"
radius = 0.02
position = [0, 8, 0]
repeat = { kind = "scatter", count = 20, half_extents = [2, 0.5, 2], min_distance = 0.1, random_rotation = true }

[[joint]]
name = "pin"
type = "ball"
chain = "link"

[[joint]]
name = "hang"
type = "distance"
body_b = "link_0"
anchor_a = [-4, 4, 0]
anchor_b_local = [0, 0.1, 0]
length = 0.9

[[particle]]
name = "bob"
position = [7, 2, 0]
mass = 0.5
radius = 0.05
pinned = false
material = "steel"

[[cloth]]
name = "sheet"
cells = [3, 2]
size = [1, 0.5]
position = [9, 2, 0]
rotation_deg = [90, 0, 0]
stretch = 500
shear = 50
tear_strain = 0.5
pins = [[0, 0], [3, 0]]

[[spring]]
name = "string"
a = "bob"
anchor_b = [7, 3, 0]
rest_length = 0.9
stiffness = 50
damping_ratio = 0.1

[[spring]]
name = "line"
a = "sheet[3,2]"
b = "ball"
anchor_b_local = [0, 0.25, 0]
frequency = 2
torn = true

[[expect]]
name = "ball slows down"
quantity = "velocity.x"
body = "ball"
reduce = "max_abs"
from = 0.5
to = 2
at_most = 1
source = "friction takes energy"

[[expect]]
name = "energy"
quantity = "energy_error"
to = 2
equals = 0
tolerance = 0.5
estimate = 0.01
source = "conserved but for friction"

[[expect]]
name = "ball's way"
quantity = "position.x"
body = "ball"
reduce = "mean"
to = 2
equals = [0, 0.5,
    0.75, 1]
tolerance = 1
source = "by eye"

[state]
step = 12
[[state.contact]]
body_a = "ground"
body_b = "crate_0"
features = [1, 2]
impulses = [[1.5, 0, 0], [1.25, 0.5, -0.5]]
)";

void expect_positions_inside(const std::string &text, const SceneFileResult &result) {
    std::vector<std::size_t> lengths{0}; // in bytes, so no fewer than characters
    for (const char c : text)
        if (c == '\n')
            lengths.push_back(0);
        else
            ++lengths.back();
    for (const SceneMessage &message : result.messages) {
        ASSERT_GE(message.line, 1U) << message.what;
        ASSERT_LE(message.line, lengths.size()) << message.what << "\n" << text;
        ASSERT_GE(message.column, 1U) << message.what;
        // One past the end, or on the newline: something is missing there.
        ASSERT_LE(message.column, lengths[message.line - 1] + 1) << message.what << "\n" << text;
        ASSERT_FALSE(message.what.empty());
    }
}

TEST(Mutations, TheFileItselfIsValid) {
    const SceneFileResult result = parse_scene(valid, "s.toml", {"soft_step", "pgs"});
    for (const SceneMessage &message : result.messages)
        ADD_FAILURE() << format_message("s.toml", message);
    EXPECT_EQ(result.scene.bodies.size(), 1U + 3U + 1U + 5U + 20U);
    EXPECT_EQ(result.scene.joints.size(), 4U + 1U);
}

TEST(Mutations, BytesChangedRemovedAndAdded) {
    Random random(11);
    constexpr std::string_view alphabet = "0123456789.-+e[]{}=\"'#,_ \n\taxyz\\\x80\xff";
    int failed = 0;
    const int rounds = std::max(1000, trials(4000));
    for (int round = 0; round < rounds; ++round) {
        std::string text = valid;
        for (std::uint32_t n = 1 + random.next_index(3); n > 0; --n) {
            const std::size_t at = random.next_index(static_cast<std::uint32_t>(text.size()));
            const char c = alphabet[random.next_index(static_cast<std::uint32_t>(alphabet.size()))];
            switch (random.next_index(3)) {
            case 0:
                text[at] = c;
                break;
            case 1:
                text.erase(at, 1);
                break;
            default:
                text.insert(at, 1, c);
            }
        }
        const SceneFileResult result = parse_scene(text, "s.toml", {"soft_step", "pgs"});
        expect_positions_inside(text, result);
        if (HasFatalFailure())
            return;
        failed += !result.ok();
        // An accepted scene can be written and reads back.
        if (result.ok()) {
            ASSERT_TRUE(parse_scene(write_scene(result.scene), "s.toml").ok()) << text;
        }
    }
    EXPECT_GT(failed, rounds / 4); // mutations do cause errors
}

TEST(Mutations, LinesSwappedRemovedAndDoubled) {
    Random random(12);
    std::vector<std::string> lines{""};
    for (const char c : valid) {
        lines.back() += c;
        if (c == '\n')
            lines.emplace_back();
    }
    const int rounds = std::max(1000, trials(4000));
    for (int round = 0; round < rounds; ++round) {
        std::vector<std::string> mutated = lines;
        for (std::uint32_t n = 1 + random.next_index(4); n > 0; --n) {
            const auto count = static_cast<std::uint32_t>(mutated.size());
            const std::uint32_t a = random.next_index(count);
            const std::uint32_t b = random.next_index(count);
            if (const std::uint32_t what = random.next_index(3); what == 0)
                std::swap(mutated[a], mutated[b]);
            else if (what == 1)
                mutated[a].clear();
            else
                mutated[a] = mutated[b];
        }
        std::string text;
        for (const std::string &line : mutated)
            text += line;
        const SceneFileResult result = parse_scene(text, "s.toml", {"soft_step", "pgs"});
        expect_positions_inside(text, result);
        if (HasFatalFailure())
            return;
        if (result.ok()) {
            ASSERT_TRUE(parse_scene(write_scene(result.scene), "s.toml").ok()) << text;
        }
    }
}

TEST(Mutations, ValuesOfAnotherType) {
    // Each value in turn, replaced by one of each type.
    const std::vector<std::string> values{
        "1",  "-1",  "0.5", "nan",      "1e300",     "true",     "\"x\"",
        "[]", "[1]", "{}",  "[[1], 2]", "{ a = 1 }", "07:32:00", "-9223372036854775808"};
    for (std::size_t at = valid.find(" = "); at != std::string::npos;
         at = valid.find(" = ", at + 1)) {
        const std::size_t start = at + 3;
        std::size_t end = valid.find('\n', start);
        if (valid.compare(start, 3, "\"\"\"") == 0)
            end = valid.find("\"\"\"", start + 3) + 3;
        for (const std::string &value : values) {
            std::string text = valid;
            text.replace(start, end - start, value);
            expect_positions_inside(text, parse_scene(text, "s.toml", {"soft_step", "pgs"}));
            if (HasFatalFailure())
                return;
        }
    }
}

TEST(Mutations, CutAnywhere) {
    for (std::size_t length = 0; length < valid.size(); ++length) {
        const std::string text = valid.substr(0, length);
        expect_positions_inside(text, parse_scene(text, "s.toml"));
        if (HasFatalFailure())
            return;
    }
}

TEST(Mutations, DeepNestingIsRefused) {
    const std::string text = "title = " + std::string(100'000, '[');
    const SceneFileResult result = parse_scene(text, "s.toml");
    EXPECT_FALSE(result.ok());
    expect_positions_inside(text, result);
}

} // namespace
} // namespace plumb
