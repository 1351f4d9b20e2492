#include "app/lab/run/method_choice.h"

#include "engine/scene/simulation.h"

#include <algorithm>
#include <utility>

namespace plumb {

std::vector<const MethodInfo *> methods_for(const SceneDesc &scene,
                                            const std::vector<std::string> &names,
                                            std::vector<std::string> &left_out) {
    std::vector<const MethodInfo *> methods;
    if (names.empty())
        for (const MethodInfo &method : method_infos())
            methods.push_back(&method);
    for (const std::string &name : names) {
        RunOptions named;
        named.method = name;
        const MethodInfo *method = resolve_run(scene, named).method;
        if (std::ranges::find(methods, method) == methods.end())
            methods.push_back(method);
    }
    std::erase_if(methods, [&](const MethodInfo *method) {
        std::string why = why_not(*method, scene);
        const bool cannot = !why.empty();
        if (cannot)
            left_out.push_back(std::move(why));
        return cannot;
    });
    return methods;
}

} // namespace plumb
