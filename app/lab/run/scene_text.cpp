#include "app/lab/run/scene_text.h"

#include "app/files/output_file.h"
#include "app/lab/progress.h"
#include "engine/dynamics/method_info.h"

#include <stdexcept>
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

void write_back(const SceneText &scene, const std::string &text, std::ostream &err) {
    const std::filesystem::path &path = scene.path;
    std::vector<SceneMessage> messages;
    if (!std::filesystem::is_regular_file(path))
        throw std::invalid_argument(path.string() + " is not a file that can be written to");
    if (read_scene_text(path, messages) != scene.text)
        throw std::invalid_argument(path.string() +
                                    " was changed in the meantime, and is left alone");
    OutputFile file(path);
    file.stream() << text;
    file.finish();
    err << "wrote " << path.string() << '\n';
}

} // namespace plumb
