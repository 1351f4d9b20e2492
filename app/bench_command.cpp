// The command that times the engine against other libraries.
#include "app/commands.h"

#include "app/lab/csv.h"

#include <cerrno>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <unistd.h>

namespace plumb {

namespace {

struct BenchArguments {
    std::string what;
    int rounds = 5;
    double seconds = 0; // 0: use each scene's own
    double size = 1;
    std::string only;
    int threads = 2; // Plumb is timed with this many, and with one
};

// Each benchmark has its own options: the others would be silently ignored.
void refuse_options_of_others(const CLI::App &bench_command, const std::string &what) {
    const std::map<std::string, std::set<std::string>> readers{
        {"--rounds", {"geometry"}},
        {"--only", {"dynamics", "scenes", "truth", "problems"}},
        {"--seconds", {"dynamics"}},
        {"--size", {"dynamics", "scenes"}},
        {"--threads", {"dynamics"}}};
    for (const CLI::Option *option : bench_command.get_options()) {
        const auto read_by = readers.find(option->get_name());
        if (option->count() > 0 && read_by != readers.end() && !read_by->second.contains(what))
            throw std::invalid_argument("bench " + what + " takes no " + option->get_name());
    }
}

// The other libraries are linked into a separate program beside this one, which few people need.
int bench(const BenchArguments &arguments, const CommonOptions &common) {
    const std::filesystem::path program =
        std::filesystem::read_symlink("/proc/self/exe").parent_path() / "plumb-bench";
    if (!std::filesystem::exists(program)) {
        std::cerr << "plumb: there is no " << program.string()
                  << "; `./plumb bench " + arguments.what +
                         "` in the source folder installs the libraries to compare with and "
                         "builds it\n";
        return code_of(ExitCode::bad_input);
    }
    std::vector<std::string> passed_on{program.string(),
                                       arguments.what,
                                       std::to_string(arguments.rounds),
                                       common.out.string(),
                                       common.shader_dir().string(),
                                       exact_number(arguments.seconds),
                                       exact_number(arguments.size),
                                       std::to_string(arguments.threads)};
    if (!arguments.only.empty())
        for (std::string &name : parse_list(arguments.only))
            passed_on.push_back(std::move(name));
    std::vector<char *> pointers;
    pointers.reserve(passed_on.size() + 1);
    for (std::string &argument : passed_on)
        pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    execv(program.c_str(), pointers.data());
    std::cerr << "plumb: cannot run " << program.string() << ": "
              << std::generic_category().message(errno) << '\n';
    return code_of(ExitCode::bad_input);
}

} // namespace

void add_bench(CommandLine &line) {
    const auto arguments = std::make_shared<BenchArguments>();
    CLI::App *bench_command = line.app.add_subcommand(
        "bench", "Compares the engine with other libraries (run it as ./plumb bench WHAT)");
    bench_command
        ->add_option("WHAT", arguments->what,
                     "geometry: cost of queries; dynamics: cost and error of a step of the same "
                     "scenes in several engines; scenes: writes those scenes as files, to run, "
                     "chart and map; truth: what each engine reaches in small problems with known "
                     "answers, beside the aim; problems: writes those as scene files, to run")
        ->required()
        ->check(CLI::IsMember({"geometry", "dynamics", "scenes", "truth", "problems"}));
    bench_command
        ->add_option("--rounds", arguments->rounds,
                     "geometry: rounds of timings; the median counts")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    bench_command
        ->add_option("--only", arguments->only,
                     "dynamics, scenes, truth, problems: the scenes or problems of that name, else "
                     "those whose names start with it (all)")
        ->type_name("NAME,...");
    bench_command
        ->add_option("--seconds", arguments->seconds,
                     "dynamics: most simulated seconds per scene (0.25 to 5, depending on the "
                     "scene)")
        ->check(positive());
    bench_command
        ->add_option("--size", arguments->size,
                     "dynamics, scenes: 0.1 for about a tenth of the bodies")
        ->check(CLI::Range(0.0001, 10.0))
        ->capture_default_str();
    bench_command
        ->add_option("--threads", arguments->threads,
                     "dynamics: Plumb's threads, timed beside one; 1: one only")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
    add_out(*bench_command, line.common, "out");
    bench_command->callback([=, &line] {
        refuse_options_of_others(*bench_command, arguments->what);
        line.result = bench(*arguments, line.common);
    });
}

} // namespace plumb
