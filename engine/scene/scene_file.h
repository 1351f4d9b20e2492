// Scene files: TOML in and out. The format is described in scenes/README.md.
#pragma once

#include "engine/scene/scene_desc.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

// One thing to say about a scene file. Lines and columns count from 1.
struct SceneMessage {
    enum class Severity { error, warning };
    Severity severity = Severity::error;
    std::size_t line = 0;
    std::size_t column = 0;
    std::string what;       // what is wrong
    std::string suggestion; // what would be right; may be empty
};

// Stated limits: a larger file is refused; of one with more mistakes the first are listed, and how
// many more there are.
inline constexpr std::size_t max_scene_file_bytes = 64U << 20U;
inline constexpr std::size_t max_listed_mistakes = 50;

struct SceneFileResult {
    SceneDesc scene;                    // complete only when ok()
    std::vector<SceneMessage> messages; // in the order of the file
    bool ok() const;                    // no message is an error
};

// `path` stands in messages, its stem names the scene, and the files that a scene names (meshes of
// probes) are looked for beside it; it is not read itself. Reports every error of the file at
// once (see max_listed_mistakes); warnings only when there is no error. A syntax error of TOML
// hides what comes after it. Method names must be among `known_methods` (empty: not checked).
SceneFileResult parse_scene(std::string_view text, const std::string &path,
                            const std::vector<std::string> &known_methods = {});

// A file that cannot be read or is too large is one error message at line 0, and a pipe or a device
// is read no further than a file may be long. One without a body or a probe is an error too, for
// there is nothing to run, while parse_scene takes the text of such a scene.
SceneFileResult load_scene(const std::filesystem::path &path,
                           const std::vector<std::string> &known_methods = {});

// "path:line:column: error: what; what would be right"
std::string format_message(const std::string &path, const SceneMessage &message);

// The scene as a file that parses to the same values, bit for bit, but for `name` (the file's stem)
// and the expects' `line`. Repeated bodies and joints come out one by one. `scene` must be one that
// parse_scene accepts: the text of any other is a file with errors. Of files that the scene names,
// the names are written.
std::string write_scene(const SceneDesc &scene);

} // namespace plumb
