// Scene files with errors, and the messages they must give.
#pragma once

#include "engine/scene/scene_file.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumb::scene_file_errors {

// A file with errors: each place that a message must point to has an '@' before it, and the
// messages are in file order.
struct SceneFileError {
    std::string name;
    std::string marked;
    std::vector<std::string> messages; // "what; suggestion"
};

struct Marked {
    std::string text;
    std::vector<std::pair<std::size_t, std::size_t>> places; // line, column
};

inline Marked take_marks(const std::string &marked) {
    Marked result;
    std::size_t line = 1;
    std::size_t column = 1;
    for (const char c : marked) {
        if (c == '@') {
            result.places.emplace_back(line, column);
            continue;
        }
        result.text += c;
        // Columns count characters, not bytes: 10xxxxxx bytes continue one.
        if (c == '\n')
            ++line, column = 1;
        else if ((static_cast<unsigned char>(c) & 0xC0U) != 0x80U)
            ++column;
    }
    return result;
}

inline void expect_messages(const SceneFileError &error) {
    const Marked marked = take_marks(error.marked);
    const SceneFileResult result = parse_scene(marked.text, "s.toml", {"soft_step", "pgs"});
    EXPECT_FALSE(result.ok());
    std::vector<std::string> expected;
    for (std::size_t i = 0; i < error.messages.size(); ++i) {
        const auto [line, column] = marked.places.at(std::min(i, marked.places.size() - 1));
        expected.push_back("s.toml:" + std::to_string(line) + ":" + std::to_string(column) +
                           ": error: " + error.messages[i]);
    }
    std::vector<std::string> actual;
    for (const SceneMessage &message : result.messages)
        actual.push_back(format_message("s.toml", message));
    EXPECT_EQ(actual, expected) << marked.text;
}

inline const std::string ball = "[[body]]\nname = \"ball\"\nshape = \"sphere\"\nradius = 1\n";
inline const std::string two = "[[body]]\nname = \"a\"\nshape = \"sphere\"\nradius = 1\n"
                               "[[body]]\nname = \"b\"\nshape = \"sphere\"\nradius = 1\n"
                               "position = [5, 0, 0]\n";
inline const std::string chain = "[[body]]\nname = \"link\"\nshape = \"sphere\"\nradius = 0.1\n"
                                 "repeat = { kind = \"line\", count = 4, step = [1, 0, 0] }\n";
inline const std::string joint = "[[joint]]\nname = \"j\"\ntype = \"ball\"\nbody_a = \"a\"\n"
                                 "body_b = \"b\"\n";
inline const std::string expect =
    "[[expect]]\nname = \"e\"\nquantity = \"energy\"\nsource = \"by hand\"\n";

} // namespace plumb::scene_file_errors
