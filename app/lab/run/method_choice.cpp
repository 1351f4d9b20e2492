#include "app/lab/run/method_choice.h"

#include "engine/scene/simulation.h"

#include <algorithm>
#include <utility>

namespace plumb {

namespace {

// "does not support joints" -> "do not support joints".
std::string of_several(std::string_view reason) {
    constexpr std::string_view one = "does ", several = "do ";
    return std::string(reason.starts_with(one) ? several : "") +
           std::string(reason.substr(reason.starts_with(one) ? one.size() : 0));
}

} // namespace

std::vector<std::string> grouped_reasons(const std::vector<std::string> &left_out) {
    std::vector<std::pair<std::string_view, std::vector<std::string_view>>> groups;
    for (const std::string &each : left_out) {
        const std::size_t space = std::min(each.find(' '), each.size() - 1);
        const std::string_view name = std::string_view(each).substr(0, space);
        const std::string_view reason = std::string_view(each).substr(space + 1);
        const auto group = std::ranges::find(groups, reason, &decltype(groups)::value_type::first);
        if (group == groups.end())
            groups.push_back({reason, {name}});
        else
            group->second.push_back(name);
    }
    std::vector<std::string> texts;
    for (const auto &[reason, names] : groups) {
        std::string text(names.front());
        for (std::size_t i = 1; i < names.size(); ++i)
            text.append(i + 1 < names.size() ? ", " : " and ").append(names[i]);
        texts.push_back(text + " " + (names.size() > 1 ? of_several(reason) : std::string(reason)));
    }
    return texts;
}

std::string why_no_method(const std::vector<std::string> &left_out) {
    std::string text = "no method can run this scene";
    const char *separator = ": ";
    for (const std::string &reason : grouped_reasons(left_out)) {
        text += separator + reason;
        separator = "; ";
    }
    return text;
}

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
