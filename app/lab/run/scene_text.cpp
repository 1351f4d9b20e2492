#include "app/lab/run/scene_text.h"

#include "app/lab/progress.h"
#include "engine/dynamics/method_info.h"

#include <utility>

namespace plumb {

std::optional<SceneText> read_scene(const std::filesystem::path &path, std::ostream &err) {
    ProgressLine line(err);
    line.show(0, "reading " + path.string());
    SceneFileResult result;
    std::optional<std::string> text = read_scene_text(path, result.messages);
    if (text) {
        std::vector<std::string> methods;
        for (const MethodInfo &method : method_infos())
            methods.emplace_back(method.name);
        result = parse_scene(*text, path.string(), methods);
    }
    line.clear();
    for (const SceneMessage &message : result.messages)
        err << format_message(path.string(), message) << '\n';
    if (!text || !result.ok())
        return std::nullopt;
    return SceneText{path, std::move(*text)};
}

} // namespace plumb
