#include "app/command_options.h"

#include "engine/dynamics/method_info.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <system_error>

namespace plumb {

namespace {

constexpr std::uint64_t most_steps = 1'000'000'000;

// A repeatable option whose values are parsed as settings, `prefix` + value.
void add_setting(CLI::App &command, CommonOptions &common, const std::string &option,
                 const std::string &prefix, const std::string &about, const std::string &type) {
    command
        .add_option_function<std::vector<std::string>>(
            option,
            [&common, option, prefix](const std::vector<std::string> &texts) {
                for (const std::string &text : texts)
                    try {
                        common.settings.give(parse_setting(prefix + text));
                    } catch (const std::invalid_argument &error) {
                        throw CLI::ValidationError(option, error.what());
                    }
            },
            about)
        ->allow_extra_args(false)
        ->type_name(type);
}

} // namespace

std::string method_names() {
    std::string names;
    for (const MethodInfo &info : method_infos())
        names += (names.empty() ? "" : ", ") + std::string(info.name);
    return names;
}

CLI::Validator positive() {
    return {[](const std::string &text) {
                double value = 0;
                return CLI::detail::lexical_cast(text, value) && value > 0
                           ? std::string()
                           : "must be a positive number, got " + text;
            },
            "POSITIVE"};
}

std::vector<std::string> parse_list(const std::string &text) {
    std::vector<std::string> items;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        if (end == begin)
            throw std::invalid_argument("'" + text + "' has an empty item");
        items.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return items;
}

std::vector<std::uint64_t> parse_steps(const std::string &text) {
    std::vector<std::uint64_t> steps;
    for (const std::string &item : parse_list(text)) {
        std::uint64_t step = 0;
        const char *end = item.data() + item.size();
        const auto read = std::from_chars(item.data(), end, step);
        if (read.ec != std::errc{} || read.ptr != end || step > most_steps)
            throw std::invalid_argument("--at: '" + item +
                                        "' must be a whole number of steps up to 1000000000, as "
                                        "in 0,60,240");
        steps.push_back(step);
    }
    return steps;
}

// For step counts. On its own, CLI11 reads -1 as the largest unsigned number.
CLI::Range step_range() {
    return {0, static_cast<int>(most_steps)};
}

void add_scenes(CLI::App &command, CommonOptions &common) {
    command
        .add_option(
            "SCENE", common.scenes,
            "Scene files, names of scenes or groups from `plumb list`, or folders (all scenes "
            "in them)")
        ->required();
}

void add_threads(CLI::App &command, CommonOptions &common) {
    command
        .add_option("--threads", common.threads, "Number of threads; results do not depend on it")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
}

void add_run_options(CLI::App &command, CommonOptions &common, bool chart) {
    if (!chart)
        command.add_option("--method", common.method,
                           "Method, instead of the scene's: " + method_names());
    add_setting(command, common, "--set", "",
                "A setting from `plumb list --settings`, such as substeps=8, dt=1/120 or "
                "gravity=0,-3,0; may be repeated",
                "NAME=VALUE");
    for (const char *name : {"dt", "substeps", "iterations"})
        add_setting(command, common, std::string("--") + name, std::string(name) + "=",
                    "Short for --set " + std::string(name) + "=VALUE", "VALUE");
    command.add_option("--precision", common.precision, "float or double")
        ->check(CLI::IsMember({"float", "double"}));
    if (!chart) // charts are timed on one thread
        add_threads(command, common);
}

void add_gl(CLI::App &command, CommonOptions &common) {
    command
        .add_option("--gl", common.gl,
                    "Where to draw: window, osmesa (in memory), or auto (osmesa, unless `run` can "
                    "open a window)")
        ->check(CLI::IsMember({"auto", "window", "osmesa"}))
        ->capture_default_str();
}

void add_out(CLI::App &command, CommonOptions &common, const std::string &by_default) {
    common.out = by_default;
    command.add_option("--out", common.out, "Output folder")->capture_default_str();
}

} // namespace plumb
