// Which methods run a scene.
#pragma once

#include "engine/dynamics/method_info.h"
#include "engine/scene/scene_desc.h"

#include <string>
#include <vector>

namespace plumb {

// Those of these names, each once, or all of them without names; less those that cannot run the
// scene, of which `left_out` gets why. Throws std::invalid_argument for a name that is unknown.
[[nodiscard]] std::vector<const MethodInfo *> methods_for(const SceneDesc &scene,
                                                          const std::vector<std::string> &names,
                                                          std::vector<std::string> &left_out);

// For people: methods with the same reason in one sentence.
[[nodiscard]] std::vector<std::string> grouped_reasons(const std::vector<std::string> &left_out);

// "no method can run this scene: a and c do not support joints; ..."
[[nodiscard]] std::string why_no_method(const std::vector<std::string> &left_out);

} // namespace plumb
