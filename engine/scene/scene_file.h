// Scene files: TOML in and out. The format is described in scenes/README.md.
#pragma once

#include "engine/scene/scene_desc.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

// One message about a scene file. Lines and columns count from 1.
struct SceneMessage {
    enum class Severity { error, warning };
    Severity severity = Severity::error;
    std::size_t line = 0;
    std::size_t column = 0;
    std::string what;       // what is wrong
    std::string suggestion; // what would be right; may be empty
};

// A larger file is refused. Of more mistakes than this, the first are listed and the rest counted.
inline constexpr std::size_t max_scene_file_bytes = 64U << 20U;
inline constexpr std::size_t max_listed_mistakes = 50;

struct SceneFileResult {
    SceneDesc scene;                    // complete only when ok()
    std::vector<SceneMessage> messages; // in the order of the file
    bool ok() const;                    // no message is an error
};

// `path` is not read: it appears in messages, its stem names the scene, and files that the scene
// uses (meshes of probes) are looked up beside it. Reports all errors of the file together (see
// max_listed_mistakes); warnings only if there are no errors. A TOML syntax error hides everything
// after it. Method names must be among `known_methods` (empty: not checked).
SceneFileResult parse_scene(std::string_view text, const std::string &path,
                            const std::vector<std::string> &known_methods = {});

// A file that cannot be read or is too large gives one error at line 0; pipes and devices are read
// only up to the size limit. A scene without a body or a probe is an error too, as there is nothing
// to run; parse_scene accepts one.
SceneFileResult load_scene(const std::filesystem::path &path,
                           const std::vector<std::string> &known_methods = {});

// "path:line:column: error: what; what would be right"
std::string format_message(const std::string &path, const SceneMessage &message);

// The text of a scene file that parses back to the same values, bit for bit, except `name` (the
// file's stem) and the expects' `line`. Repeated bodies and joints are written one by one. `scene`
// must be one that parse_scene accepts: any other gives a file with errors. Files used by the scene
// are written by name only.
std::string write_scene(const SceneDesc &scene);

} // namespace plumb
