// Which methods can run a scene.
#pragma once

#include "engine/dynamics/method_info.h"
#include "engine/scene/scene_desc.h"

#include <string>
#include <vector>

namespace plumb {

// The named methods, each once, or all methods if `names` is empty; those that cannot run the scene
// are left out, with the reasons in `left_out`. Throws std::invalid_argument for an unknown name.
[[nodiscard]] std::vector<const MethodInfo *> methods_for(const SceneDesc &scene,
                                                          const std::vector<std::string> &names,
                                                          std::vector<std::string> &left_out);

// For display: methods with the same reason share one sentence.
[[nodiscard]] std::vector<std::string> grouped_reasons(const std::vector<std::string> &left_out);

// "no method can run this scene: a and c do not support joints; ..."
[[nodiscard]] std::string why_no_method(const std::vector<std::string> &left_out);

} // namespace plumb
