#include "app/lab/run/load_scenes.h"

#include "app/lab/progress.h"
#include "engine/dynamics/method_info.h"
#include "engine/scene/scene_file.h"

#include <algorithm>
#include <string>

namespace plumb {

LoadedScenes load_scenes(const std::vector<std::filesystem::path> &paths, std::ostream &err) {
    namespace fs = std::filesystem;
    std::vector<std::string> methods;
    for (const MethodInfo &method : method_infos())
        methods.emplace_back(method.name);

    std::vector<fs::path> files;
    for (const fs::path &path : paths) {
        std::error_code error;
        if (!fs::is_directory(path, error)) {
            files.push_back(path);
            continue;
        }
        std::vector<fs::path> below;
        for (auto entry = fs::recursive_directory_iterator(path, error);
             !error && entry != fs::recursive_directory_iterator(); entry.increment(error))
            if (entry->path().extension() == ".toml" && entry->is_regular_file(error))
                below.push_back(entry->path());
        std::sort(below.begin(), below.end());
        files.insert(files.end(), below.begin(), below.end());
    }

    LoadedScenes loaded;
    if (files.empty()) {
        err << "plumb: no scene files (*.toml) in";
        for (const fs::path &path : paths)
            err << ' ' << path.string();
        err << '\n';
        loaded.all_fine = false;
    }
    ProgressLine line(err);
    for (const fs::path &file : files) {
        line.show(0, "reading " + file.string());
        SceneFileResult result = load_scene(file, methods);
        line.clear();
        for (const SceneMessage &message : result.messages)
            err << format_message(file.string(), message) << '\n';
        if (result.ok())
            loaded.scenes.push_back(std::move(result.scene));
        else
            loaded.all_fine = false;
    }
    return loaded;
}

} // namespace plumb
