#include "app/sandbox/session/scene_catalog.h"

#include "engine/scene/file/spelling.h"
#include "engine/scene/scene_file.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <tuple>

namespace plumb {

namespace {

namespace fs = std::filesystem;

// Reads only the title line: listing scenes need not parse them all.
std::string read_title(const fs::path &path) {
    constexpr std::size_t head_bytes = 1U << 16U; // the title must be within these
    std::string head(head_bytes, '\0');
    std::ifstream whole(path, std::ios::binary);
    whole.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(whole.gcount()));
    std::istringstream file(head);
    for (std::string line; std::getline(file, line) && !line.starts_with('[');)
        if (line.starts_with("title")) {
            const std::size_t begin = line.find('"');
            const std::size_t end = line.rfind('"');
            if (begin != std::string::npos && end > begin)
                return line.substr(begin + 1, end - begin - 1);
        }
    return path.stem().string();
}

// An explicitly named folder has no fallback.
fs::path data_dir_from_environment(const fs::path &dir) {
    std::error_code error;
    if (!fs::is_directory(dir / "shaders", error) || !fs::is_directory(dir / "scenes", error))
        throw std::runtime_error("PLUMB_DATA is " + dir.string() +
                                 ", which has no shaders and scenes folders");
    return dir;
}

} // namespace

fs::path find_data_dir() {
    std::vector<fs::path> places;
    if (const char *from_environment = std::getenv("PLUMB_DATA"))
        return data_dir_from_environment(from_environment);
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    if (!error)
        places.push_back(program.parent_path().parent_path() / "share" / "plumb");
    places.emplace_back(PLUMB_SOURCE_DATA);
    for (const fs::path &place : places)
        if (fs::is_directory(place / "shaders", error) && fs::is_directory(place / "scenes", error))
            return place;
    std::string text = "no folder with shaders and scenes; looked in";
    for (const fs::path &place : places)
        text += " " + place.string();
    throw std::runtime_error(text + "; set PLUMB_DATA to use another");
}

std::vector<SceneEntry> find_scenes(const fs::path &scene_dir) {
    std::vector<SceneEntry> scenes;
    for (const fs::directory_entry &file : fs::recursive_directory_iterator(scene_dir)) {
        if (!file.is_regular_file() || file.path().extension() != ".toml")
            continue;
        SceneEntry entry;
        entry.path = file.path();
        entry.subject = fs::relative(file.path().parent_path(), scene_dir).generic_string();
        entry.name = file.path().stem().string();
        entry.title = read_title(file.path());
        scenes.push_back(std::move(entry));
    }
    std::ranges::sort(scenes, [](const SceneEntry &a, const SceneEntry &b) {
        return std::tie(a.subject, a.name) < std::tie(b.subject, b.name);
    });
    return scenes;
}

fs::path resolve_scene(const std::string &name, const std::vector<SceneEntry> &scenes) {
    std::error_code error;
    // A bare name means a scene, even if the working directory has a file of that name.
    fs::path path(name);
    const bool is_path = path.has_parent_path() || path.has_extension();
    if (is_path && fs::exists(path, error))
        return path;
    for (const SceneEntry &entry : scenes)
        if (name == entry.name || name == entry.subject + "/" + entry.name)
            return entry.path;
    if (fs::exists(path, error))
        return path;
    for (const SceneEntry &entry : scenes)
        if (name == entry.subject)
            return entry.path.parent_path();
    std::vector<std::string_view> names;
    for (const SceneEntry &entry : scenes) {
        names.emplace_back(entry.name);
        if (!is_path && std::ranges::find(names, entry.subject) == names.end())
            names.emplace_back(entry.subject);
    }
    if (is_path) {
        const std::string stem = path.stem().string();
        const std::string_view near = nearest_word(stem, names);
        throw std::invalid_argument("there is no file '" + name + "'" +
                                    (near.empty()
                                         ? "; `plumb list` names the scenes"
                                         : "; did you mean the scene " + std::string(near) + "?"));
    }
    throw std::invalid_argument("there is no file or scene '" + name + "'; " +
                                did_you_mean(name, names));
}

} // namespace plumb
