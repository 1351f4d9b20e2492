// Scene files with some of their numbers changed: what a map goes through.
#pragma once

#include "engine/scene/scene_file.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

// One number of a scene file, by its path: what stands in double brackets, the name, the keys, all
// joined by dots: "body.ball.velocity.x", "material.steel.friction", "body.box.repeat.count",
// "world.seed". Of an array of three numbers x, y and z, of any other the index from 0.
struct ChangedNumber {
    std::string path;
    double value = 0;
};

// As parse_scene, with these numbers in place of those of the text; a plain number may also be one
// that the text leaves to its default. Throws std::invalid_argument, saying what would be right,
// for a path that names no number. What is expected of one of a repeated body's copies that are not
// there with these numbers is left out. A value that is out of place is an error of the result, as
// if it stood in the file; whole numbers are taken for such.
SceneFileResult parse_scene(std::string_view text, const std::string &path,
                            const std::vector<std::string> &known_methods,
                            std::span<const ChangedNumber> changed);

// The paths of all numbers that the text gives under this key: "stiffness" may stand for
// "spring.left.stiffness" and "spring.right.stiffness", "velocity" for "body.ball.velocity.x": of
// three numbers in brackets those that are not zero, or all three. None of the camera's. Empty when
// the text is not TOML.
std::vector<std::string> number_paths(std::string_view text, std::string_view key);

// A scene file's text; empty, with the message of load_scene, when it cannot be read.
std::optional<std::string> read_scene_text(const std::filesystem::path &path,
                                           std::vector<SceneMessage> &messages);

} // namespace plumb
