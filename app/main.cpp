// The command line.
#include "app/commands.h"
#include "app/files/output_file.h"
#include "app/lab/interrupt.h"
#include "app/render/context.h"
#include "engine/scene/file/spelling.h"

#include <algorithm>
#include <functional>
#include <iostream>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace plumb {

namespace {

constexpr const char *exit_codes = "Exit codes:\n"
                                   "  0  success\n"
                                   "  1  out of tolerance; pictures or a replay differ; or no "
                                   "settings meet the scene\n"
                                   "  2  bad scene or argument\n"
                                   "  3  the world diverged\n"
                                   "  4  no GL context\n"
                                   "  5  output could not be written, or out of memory\n"
                                   "130  interrupted by Ctrl-C (143: by SIGTERM); finished work "
                                   "is kept\n";

// The command as typed, for a chart's footer.
std::string command_text(int argc, char **argv) {
    std::string text = "plumb";
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        const bool plain = !argument.empty() && argument.find_first_of(" \t") == std::string::npos;
        text += plain ? " " + argument : " \"" + argument + '"';
    }
    return text;
}

// Reports an option the command does not have (its value may have been parsed as a scene). Empty if
// there is none.
std::string why_unknown(const CLI::App &app, std::span<char *> arguments) {
    const CLI::App &command = app.get_subcommands().empty() ? app : *app.get_subcommands().front();
    const std::string called = (&command == &app ? "" : "plumb ") + command.get_name();
    std::vector<std::string> names;
    for (const CLI::Option *option : command.get_options())
        for (const std::string &name : option->get_lnames())
            names.push_back("--" + name);
    const std::vector<std::string_view> candidates(names.begin(), names.end());
    for (const std::string_view argument : arguments) {
        const std::string_view name = argument.substr(0, argument.find('='));
        if (!name.starts_with("--") || name == "--" ||
            std::ranges::find(candidates, name) != candidates.end())
            continue;
        const std::string_view near = nearest_word(name, candidates);
        return called + " has no option " + std::string(name) + "; " +
               (near.empty() ? "see " + called + " --help"
                             : "did you mean " + std::string(near) + "?");
    }
    return {};
}

int main_with_errors(int argc, char **argv) {
    CLI::App app(
        "Plumb: a physics sandbox that measures what each method costs and how accurate it is.");
    app.name("plumb");
    app.footer(exit_codes);
    app.require_subcommand(0, 1);
    app.set_version_flag("--version", PLUMB_VERSION);
    CommonOptions common;
    int result = 0;

    CommandLine line{app, common, result, command_text(argc, argv)};
    const std::function<int()> open_sandbox = add_run(line);
    add_replay(line);
    add_snapshot(line);
    add_check(line);
    add_hash(line);
    add_list(line);
    add_measure(line);
    add_chart(line);
    add_merge(line);
    add_map(line);
    add_tune(line);
    add_reference(line);
    add_bench(line);
    add_compare(line);

    for (CLI::App *command : app.get_subcommands({}))
        command->footer(exit_codes);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError &error) {
        if (error.get_exit_code() == 0) // --help
            return app.exit(error);
        // Report a misspelt command first: its other errors follow from it.
        if (app.get_subcommands().empty() && argc > 1 && argv[1][0] != '-') {
            std::vector<std::string> names;
            for (const CLI::App *command : app.get_subcommands({}))
                names.push_back(command->get_name());
            const std::vector<std::string_view> candidates(names.begin(), names.end());
            const auto scene = std::ranges::find(common.catalogue, argv[1], &SceneEntry::name);
            std::cerr << "plumb: unknown command '" << argv[1] << "'; "
                      << (scene != common.catalogue.end()
                              ? "to open the scene: plumb run " + scene->name
                              : did_you_mean(argv[1], candidates))
                      << '\n';
            return code_of(ExitCode::bad_input);
        }
        const std::span arguments(argv, static_cast<std::size_t>(argc));
        if (const std::string why = why_unknown(app, arguments.subspan(1)); !why.empty())
            std::cerr << "plumb: " << why << '\n';
        else
            std::cerr << "plumb: " << error.what() << "; see plumb"
                      << (app.get_subcommands().empty()
                              ? ""
                              : " " + app.get_subcommands().front()->get_name())
                      << " --help\n";
        return code_of(ExitCode::bad_input);
    }
    if (app.get_subcommands().empty())
        result = open_sandbox();
    return result;
}

// Returns what `work` returns. If it throws, prints why and returns the matching exit code.
template <typename Work> int reported(const Work &work) {
    ExitCode code = ExitCode::bad_input;
    std::string what;
    try {
        return work();
    } catch (const ContextError &error) {
        what = error.what();
        code = ExitCode::no_gl_context;
    } catch (const std::system_error &error) {
        what = error.what();
        code = ExitCode::no_room;
    } catch (const std::bad_alloc &) {
        what = "out of memory; scenes/README.md lists the limits of a scene";
        code = ExitCode::no_room;
    } catch (const std::exception &error) {
        what = error.what();
    }
    std::cerr << "plumb: " << what << '\n';
    return code_of(code);
}

} // namespace

} // namespace plumb

int main(int argc, char **argv) {
    plumb::StandardOutput standard_output;
    const int code = plumb::reported([&] { return plumb::main_with_errors(argc, argv); });
    const int end = plumb::reported([&] {
        standard_output.finish();
        return 0;
    });
    if (plumb::InterruptGuard::requested())
        return plumb::InterruptGuard::exit_code();
    return code != 0 ? code : end;
}
