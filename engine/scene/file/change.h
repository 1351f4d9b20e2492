// Scene files with some numbers changed, as in a parameter map.
#pragma once

#include "engine/scene/scene_file.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

// One number of a scene file, by its path: the word in double brackets, the name and the keys,
// joined by dots: "body.ball.velocity.x", "material.steel.friction", "body.box.repeat.count",
// "world.seed". Elements of an array of three numbers are x, y and z, those of any other their
// index from 0.
struct ChangedNumber {
    std::string path;
    double value = 0;
};

// Like parse_scene, with these numbers replacing those in the text; a plain number may also be one
// that the text leaves at its default. Throws std::invalid_argument, saying what would be right,
// for a path that names no number. A number replaces the other way to give the same, if the text
// has that: stiffness a spring's frequency, mass a body's density. Expectations of copies of a
// repeated body that do not exist with these numbers are dropped. An invalid value is an error of
// the result, just as in the file; whole values count as integers.
SceneFileResult parse_scene(std::string_view text, const std::string &path,
                            const std::vector<std::string> &known_methods,
                            std::span<const ChangedNumber> changed);

// The paths of all numbers that the text gives under this key: "stiffness" may yield
// "spring.left.stiffness" and "spring.right.stiffness", "velocity" "body.ball.velocity.x". Of an
// array of three numbers it yields the nonzero ones, or all three if all are zero. Excludes the
// camera. Empty when the text is not TOML.
std::vector<std::string> number_paths(std::string_view text, std::string_view key);

// The paths of all numbers that the text gives and that decide what happens: not the camera's, nor
// colours, expectations, settings, and what a saved scene keeps. Of an array of three numbers as
// above.
std::vector<std::string> number_paths(std::string_view text);

// The paths of a list's tables: "spring" may yield "spring.left" and "spring.right". Those without
// a name have their index from 0. Empty when the text is not TOML.
std::vector<std::string> table_paths(std::string_view text, std::string_view list);

// A scene file's text; empty, with load_scene's message, when it cannot be read.
std::optional<std::string> read_scene_text(const std::filesystem::path &path,
                                           std::vector<SceneMessage> &messages);

} // namespace plumb
