// Writing truths into scene files.
#include "engine/scene/file/truths.h"

#include <array>
#include <stdexcept>

#include <gtest/gtest.h>

namespace plumb {
namespace {

// With a comment beside the changed value, and keys in no order.
std::string fall(const std::string &equals, const std::string &estimate) {
    return "[[body]]\nname = \"ball\"\nshape = \"sphere\"\nradius = 1\n"
           "[[expect]]\nname = \"other\"\nquantity = \"energy\"\nto = 1\nequals = 7\ntolerance = "
           "1\nsource = \"x\"\n"
           "[[expect]] # where it falls\n  estimate= " +
           estimate +
           "# rough\nname = \"way\"\nquantity = \"displacement\"\nbody = \"ball\"\nequals = " +
           equals + " # m\nto = 1\ntolerance = 0.1\nsource = \"by refinement\"";
}

std::string complaint(const std::string &text, const WrittenTruth &truth) {
    try {
        (void)with_truths(text, "scene.toml", std::array{truth});
    } catch (const std::invalid_argument &error) {
        return error.what();
    }
    return "";
}

TEST(SceneFileTruths, AreReplacedWhereTheyStandAndNothingElse) {
    const WrittenTruth truth{"way", {4.905}, 2.5e-5};
    EXPECT_EQ(with_truths(fall("5", "0 "), "scene.toml", std::array{truth}),
              fall("4.905", "2.5e-05 "));
    EXPECT_EQ(with_truths(fall("5", "0 "), "scene.toml", {}), fall("5", "0 "));
}

std::string way(const std::string &equals) {
    return "[[body]]\nname = \"ball\"\nshape = \"sphere\"\nradius = 1\n"
           "[[expect]]\nname = \"way\"\nreduce = \"max\"\nquantity = \"displacement\"\n"
           "body = \"ball\"\nequals = " +
           equals + "\nestimate = 0 # rough\nto = 1\ntolerance = 0.1\nsource = \"by refinement\"\n";
}

// However many lines the old and the new array take.
TEST(SceneFileTruths, CurvesTakeThePlaceOfCurves) {
    const WrittenTruth eleven{"way", {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10.5}, 0};
    const std::string written = "[\n    0, 1, 2, 3, 4, 5, 6, 7, 8, 9,\n    10.5,\n]";
    for (const std::string before :
         {"[0, 0, 0, 0]", "[0,0,0,0\n]", "[ # ] none\n  0,\n0, # ]\n  0, 0 ]", "[\n 0, 0, 0, 0\n]"})
        EXPECT_EQ(with_truths(way(before + " # m"), "scene.toml", std::array{eleven}),
                  way(written + " # m"))
            << before;
    const WrittenTruth four{"way", {1, 2, 3, 4}, 0};
    EXPECT_EQ(with_truths(way(written), "scene.toml", std::array{four}),
              way("[\n    1, 2, 3, 4,\n]"));
    // Line endings are the file's own.
    EXPECT_EQ(
        with_truths("title = \"x\"\r\n" + way("[0, 0, 0, 0]"), "scene.toml", std::array{four}),
        "title = \"x\"\r\n" + way("[\r\n    1, 2, 3, 4,\r\n]"));
}

TEST(SceneFileTruths, WhatCannotBeWrittenIsRefused) {
    EXPECT_EQ(complaint(fall("5", "0 "), {"weg", {5}, 0}), "there is no [[expect]] \"weg\"");
    EXPECT_EQ(complaint(fall("5", "0 "), {"other", {5}, 0}),
              "[[expect]] \"other\" has no estimate");
    const std::string layout =
        "write [[expect]] as a table, with each key and its value on a line of its own";
    EXPECT_EQ(complaint(fall("5", "0 "), {"way", {5}, 0.01}),
              layout); // not a tenth of the tolerance
    EXPECT_EQ(complaint("expect = [{ name = \"e\", quantity = \"energy\", to = 1, equals = 1, "
                        "tolerance = 1, estimate = 0, source = \"x\" }]\n",
                        {"e", {2}, 0}),
              layout);
    EXPECT_EQ(complaint("[[expect]]", {"e", {2}, 0}), "the scene has errors");
}

} // namespace
} // namespace plumb
