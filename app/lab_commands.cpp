// Commands that judge, measure, chart, map, tune and time.
#include "app/commands.h"

#include "app/lab/chart/chart.h"
#include "app/lab/csv.h"
#include "app/lab/engines/other_engines.h"
#include "app/lab/map/stability_map.h"
#include "app/lab/queries/query_chart.h"
#include "app/lab/run/check.h"
#include "app/lab/run/measure.h"
#include "app/lab/run/reference.h"
#include "app/lab/run/run_text.h"
#include "app/lab/run/sweep.h"
#include "app/lab/tune/plainer.h"
#include "app/lab/tune/tune.h"

#include <cerrno>
#include <iostream>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <system_error>

#include <unistd.h>

namespace plumb {

namespace {

// A chart of geometric queries steps no world, so it would pass over them in silence.
void refuse_options_of_scenes(const CLI::App &chart_command) {
    for (const CLI::Option *option : chart_command.get_options())
        if (option->count() > 0 && option->get_name() != "SCENE" &&
            option->get_name() != "--repeats" && option->get_name() != "--out")
            throw std::invalid_argument("chart geometry takes --repeats and --out, but no " +
                                        option->get_name());
}

struct BenchArguments {
    std::string what;
    int rounds = 5;
    double seconds = 0; // 0: each scene's own
    double size = 1;
    std::string only;
    int threads = 2; // of Plumb, beside one
};

// Each thing to time has options of its own: the others would be passed over in silence.
void refuse_options_of_others(const CLI::App &bench_command, const std::string &what) {
    const std::map<std::string, std::set<std::string>> readers{
        {"--rounds", {"geometry"}},
        {"--only", {"dynamics", "scenes", "truth"}},
        {"--seconds", {"dynamics"}},
        {"--size", {"dynamics", "scenes"}},
        {"--threads", {"dynamics"}}};
    for (const CLI::Option *option : bench_command.get_options()) {
        const auto read_by = readers.find(option->get_name());
        if (option->count() > 0 && read_by != readers.end() && !read_by->second.contains(what))
            throw std::invalid_argument("bench " + what + " takes no " + option->get_name());
    }
}

// The other libraries are linked into a program of its own beside this one, which few people need.
int bench(const BenchArguments &arguments, const CommonOptions &common) {
    const std::filesystem::path program =
        std::filesystem::read_symlink("/proc/self/exe").parent_path() / "plumb-bench";
    if (!std::filesystem::exists(program)) {
        std::cerr << "plumb: there is no " << program.string()
                  << "; `./plumb bench " + arguments.what +
                         "` in the source folder installs the libraries "
                         "to compare with, and builds it\n";
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

struct MeasureArguments {
    std::uint64_t steps = 600;
    std::filesystem::path csv;
};

struct ChartArguments {
    ChartCommand command;
    std::vector<std::string> sweeps;
    std::string methods, engines, budget, shard;
};

// "2/4"
Shard parse_shard(const std::string &text) {
    Shard shard;
    char slash = 0;
    std::istringstream in(text);
    if (!(in >> shard.n >> slash >> shard.of) || slash != '/' || !in.eof() || shard.n < 1 ||
        shard.n > shard.of)
        throw std::invalid_argument("--shard: '" + text +
                                    "' is no shard; write 2/4 for the second of four");
    return shard;
}

struct MapArguments {
    MapCommand command;
    std::string x, y, methods;
};

struct TuneArguments {
    TuneCommand command;
    std::string methods, budget;
};

} // namespace

void add_check(CommandLine &line) {
    const auto all_methods = std::make_shared<bool>(false);
    CLI::App *check_command = line.app.add_subcommand(
        "check", "Runs scenes and holds them to what they expect of themselves");
    add_scenes(*check_command, line.common);
    add_run_options(*check_command, line.common);
    check_command->add_flag("--all-methods", *all_methods, "Every method that can run the scene");
    check_command->callback([=, &line] {
        TaskPool tasks(line.common.threads);
        CheckCommand command;
        command.scenes = line.common.scene_paths();
        command.run = line.common.run();
        if (*all_methods)
            for (const MethodInfo &info : method_infos())
                command.methods.emplace_back(info.name);
        command.tasks = &tasks;
        line.result = code_of(check_scenes(command, std::cout, std::cerr));
    });
}

void add_measure(CommandLine &line) {
    const auto arguments = std::make_shared<MeasureArguments>();
    CLI::App *measure_command = line.app.add_subcommand(
        "measure", "Runs a scene and writes energies, momenta, errors and times, step by step");
    measure_command
        ->add_option("SCENE", line.common.scenes, "A scene file, or a name from `plumb list`")
        ->required()
        ->expected(1);
    measure_command->add_option("--steps", arguments->steps, "How far to run")
        ->check(step_range())
        ->capture_default_str();
    measure_command->add_option("--csv", arguments->csv,
                                "Where to write the table (standard output)");
    add_run_options(*measure_command, line.common);
    measure_command->callback([=, &line] {
        TaskPool tasks(line.common.threads);
        MeasureCommand command;
        command.scene = line.common.scene_paths().front();
        command.run = line.common.run();
        command.steps = arguments->steps;
        command.out = arguments->csv;
        command.tasks = &tasks;
        line.result = code_of(measure_scene(command, std::cout, std::cerr));
    });
}

void add_chart(CommandLine &line) {
    const auto arguments = std::make_shared<ChartArguments>();
    CLI::App *chart_command = line.app.add_subcommand(
        "chart",
        "Charts each method's cost against its error, as CSV, PNG and SVG: of scenes, or of "
        "geometric queries (`plumb chart geometry`, with --repeats and --out alone)");
    add_scenes(*chart_command, line.common);
    chart_command->add_option("--methods", arguments->methods, "Of " + method_names() + " (all)")
        ->type_name("METHOD,...");
    chart_command
        ->add_option("--sweep", arguments->sweeps,
                     "What to go through, any setting from `plumb list --settings`: substeps=1..16 "
                     "(the default), iterations=1,2,8, dt=1/240..1/30; also precision=float,double "
                     "and threads=1,2 (then by the clock on the wall); may be given several times")
        ->allow_extra_args(false);
    chart_command->add_option(
        "--expect", arguments->command.options.expect,
        "Name of one expectation to chart, in its own unit (the worst of all, "
        "each in units of its tolerance)");
    chart_command
        ->add_option("--repeats", arguments->command.options.repeats, "Timings of each run")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    chart_command
        ->add_option(
            "--with", arguments->engines,
            "Other engines beside the methods, judged by the same measures: bullet, ode (in a "
            "build with PLUMB_BENCH=ON)")
        ->type_name("ENGINE,...");
    chart_command
        ->add_option("--budget", arguments->budget,
                     "What a frame of 1/60 s may cost, drawn as a line (all of it, 60 Hz)")
        ->type_name("1ms");
    chart_command->add_flag("--convergence", arguments->command.options.convergence,
                            "Error against dt with fitted orders, nothing timed: dt=1/960..1/30 "
                            "unless --sweep has another, one substep, and double");
    chart_command->add_flag(
        "--one-step", arguments->command.options.one_step,
        "For motion that is chaotic: the error of one step (of a frame of 60 Hz, if that is longer)"
        " from states of one accurate run in double, the same for every method");
    chart_command
        ->add_option("--seed", arguments->command.options.seed,
                     "Of the order in which each round of timings goes")
        ->capture_default_str();
    chart_command
        ->add_option("--shard", arguments->shard,
                     "Runs the I-th of N parts of a chart, for `plumb merge`: no pictures")
        ->type_name("I/N");
    add_out(*chart_command, line.common, "out");
    add_run_options(*chart_command, line.common, true);
    chart_command->callback([=, &line] {
        if (line.common.scenes == std::vector<std::string>{"geometry"}) {
            refuse_options_of_scenes(*chart_command);
            QueryChartCommand command;
            command.options.repeats = arguments->command.options.repeats;
            command.out_dir = line.common.out;
            command.shader_dir = line.common.shader_dir();
            command.command = line.text;
            line.result = code_of(chart_geometry(command, std::cout, std::cerr));
            return;
        }
        for (const std::string &sweep : arguments->sweeps)
            add_sweep(arguments->command.options, sweep);
        if (!arguments->engines.empty())
            arguments->command.options.engines = find_other_engines(parse_list(arguments->engines));
        if (!arguments->budget.empty())
            arguments->command.options.budget = parse_budget(arguments->budget);
        if (!arguments->shard.empty())
            arguments->command.options.shard = parse_shard(arguments->shard);
        if (!arguments->methods.empty())
            arguments->command.options.methods = parse_list(arguments->methods);
        arguments->command.scenes = line.common.scene_paths();
        arguments->command.options.base = line.common.run();
        arguments->command.out_dir = line.common.out;
        arguments->command.shader_dir = line.common.shader_dir();
        arguments->command.command = line.text;
        line.result = code_of(chart_scenes(arguments->command, std::cout, std::cerr));
    });
}

void add_merge(CommandLine &line) {
    const auto command = std::make_shared<MergeCommand>();
    CLI::App *merge_command = line.app.add_subcommand(
        "merge", "Makes one chart of the tables that `plumb chart --shard` wrote");
    merge_command->add_option("CSV", command->tables, "All of them, in any order")->required();
    merge_command->add_option("--scene", command->scene,
                              "The scene's file, where it is not one of `plumb list`");
    add_out(*merge_command, line.common, "out");
    merge_command->callback([=, &line] {
        command->find_scene = [&line](const std::string &name) {
            return resolve_scene(name, line.common.catalogue);
        };
        command->out_dir = line.common.out;
        command->shader_dir = line.common.shader_dir();
        command->command = line.text;
        line.result = code_of(merge_charts(*command, std::cout, std::cerr));
    });
}

void add_map(CommandLine &line) {
    const auto arguments = std::make_shared<MapArguments>();
    CLI::App *map_command = line.app.add_subcommand(
        "map", "Maps where each method holds a scene and why it fails, over two numbers: a grid of "
               "runs, with the limit between held and failed found by bisection along x");
    map_command
        ->add_option("SCENE", line.common.scenes, "A scene file, or a name from `plumb list`")
        ->required()
        ->expected(1);
    const std::string axis_about =
        "a setting from `plumb list --settings`, or a number of the scene file by its path, such "
        "as body.ball.velocity.x, material.steel.friction or body.box.repeat.count; N values (10) "
        "in equal steps, or in equal ratios with log, as in dt=1/480..1/30:9log; or a list, "
        "substeps=1,2,4";
    map_command->add_option("--x", arguments->x, "What goes to the right: " + axis_about)
        ->required()
        ->type_name("NAME=FROM..TO[:N][log]");
    map_command->add_option("--y", arguments->y, "What goes up, in the same way")
        ->required()
        ->type_name("NAME=FROM..TO[:N][log]");
    map_command->add_option("--methods", arguments->methods, "Of " + method_names() + " (all)")
        ->type_name("METHOD,...");
    map_command->add_option("--image", arguments->command.image,
                            "Where to draw the map: a PNG, or an SVG if its name ends so");
    map_command->add_option("--csv", arguments->command.csv,
                            "Where to write every cell and limit, as a table");
    map_command
        ->add_option("--seconds", arguments->command.options.duration,
                     "How long each run of a scene that expects nothing of itself lasts (5)")
        ->check(positive());
    add_run_options(*map_command, line.common, true);
    add_threads(*map_command, line.common);
    map_command->callback([=, &line] {
        TaskPool tasks(line.common.threads);
        arguments->command.scene = line.common.scene_paths().front();
        arguments->command.x = parse_map_axis(arguments->x);
        arguments->command.y = parse_map_axis(arguments->y);
        if (!arguments->methods.empty())
            arguments->command.options.methods = parse_list(arguments->methods);
        arguments->command.options.base = line.common.run();
        arguments->command.options.tasks = &tasks;
        arguments->command.shader_dir = line.common.shader_dir();
        arguments->command.command = line.text;
        line.result = code_of(map_scene(arguments->command, std::cout, std::cerr));
    });
}

void add_tune(CommandLine &line) {
    const auto arguments = std::make_shared<TuneArguments>();
    CLI::App *tune_command = line.app.add_subcommand(
        "tune",
        "Finds the cheapest method, precision, dt, substeps and iterations with which a scene "
        "meets all that it expects of itself, with a margin and from several starts, and what its "
        "model can then do without: " +
            model_parts_text() +
            ". What is given by --methods, --precision, --set and the like stays as it is given");
    tune_command
        ->add_option("SCENE", line.common.scenes, "A scene file, or a name from `plumb list`")
        ->required()
        ->expected(1);
    tune_command->add_option("--methods", arguments->methods, "Of " + method_names() + " (all)")
        ->type_name("METHOD,...");
    tune_command
        ->add_option(
            "--tolerance", arguments->command.options.tolerance,
            "The share of each tolerance that may be used: the rest is the margin (lower bounds "
            "have none)")
        ->check(CLI::Range(0.01, 1.0))
        ->capture_default_str();
    tune_command
        ->add_option("--starts", arguments->command.options.starts,
                     "How often each is run beside the scene as it stands: with bodies shifted by "
                     "up to a millionth, and another seed for what the file scatters")
        ->check(CLI::Range(0, 100))
        ->capture_default_str();
    tune_command
        ->add_option("--budget", arguments->budget,
                     "The most CPU time that a frame of 1/60 s may cost; when the cheapest costs "
                     "more, the exit code is 1")
        ->type_name("1ms");
    tune_command
        ->add_option("--repeats", arguments->command.options.repeats,
                     "Timings of each that may be the cheapest, in turns")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    tune_command->add_flag("--explain", arguments->command.explain,
                           "Prints what was tried, what each cost and what it missed");
    tune_command->add_flag("--write", arguments->command.write,
                           "Writes the settings that were chosen, sleep among them, into the "
                           "scene's file, and leaves all else in it as it is: what bodies can do "
                           "without is only said");
    add_run_options(*tune_command, line.common, true);
    tune_command->callback([=, &line] {
        arguments->command.scene = line.common.scene_paths().front();
        if (!arguments->methods.empty())
            arguments->command.options.methods = parse_list(arguments->methods);
        if (!arguments->budget.empty())
            arguments->command.options.budget = parse_budget(arguments->budget);
        arguments->command.options.base = line.common.run();
        line.result = code_of(tune_scene(arguments->command, std::cout, std::cerr));
    });
}

void add_reference(CommandLine &line) {
    const auto command = std::make_shared<ReferenceCommand>();
    CLI::App *reference_command = line.app.add_subcommand(
        "reference",
        "Finds what a scene's truths are by refinement: of a run in double whose dt is halved "
        "until that changes each by less than a tenth of its tolerance");
    reference_command
        ->add_option("SCENE", line.common.scenes, "A scene file, or a name from `plumb list`")
        ->required()
        ->expected(1);
    reference_command->add_flag(
        "--write", command->write,
        "Writes those that have an `estimate` into the scene's file, with their estimates, and "
        "leaves all else in it as it is");
    reference_command->callback([=, &line] {
        command->scene = line.common.scene_paths().front();
        line.result = code_of(refine_scene(*command, std::cout, std::cerr));
    });
}

void add_bench(CommandLine &line) {
    const auto arguments = std::make_shared<BenchArguments>();
    CLI::App *bench_command = line.app.add_subcommand(
        "bench", "Compares the engine with other libraries (run it as ./plumb bench WHAT)");
    bench_command
        ->add_option("WHAT", arguments->what,
                     "geometry: what queries cost; dynamics: what steps of the same scenes cost in "
                     "several engines, and how wrong they are; scenes: writes these as files, to "
                     "run, chart and map; truth: what each engine makes of small problems whose "
                     "answer is known, beside the aim")
        ->required()
        ->check(CLI::IsMember({"geometry", "dynamics", "scenes", "truth"}));
    bench_command
        ->add_option("--rounds", arguments->rounds, "geometry: of timings; their median counts")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    bench_command
        ->add_option(
            "--only", arguments->only,
            "dynamics, scenes, truth: the scenes or problems of that name, else those whose names "
            "begin so (all)")
        ->type_name("NAME,...");
    bench_command
        ->add_option("--seconds", arguments->seconds,
                     "dynamics: how long a scene is run at most, in its own time (0.25 to 5, by "
                     "scene)")
        ->check(positive());
    bench_command
        ->add_option("--size", arguments->size,
                     "dynamics, scenes: 0.1 for about a tenth of the bodies")
        ->check(CLI::Range(0.0001, 10.0))
        ->capture_default_str();
    bench_command
        ->add_option("--threads", arguments->threads, "dynamics: of Plumb, beside one; 1: only one")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
    add_out(*bench_command, line.common, "out");
    bench_command->callback([=, &line] {
        refuse_options_of_others(*bench_command, arguments->what);
        line.result = bench(*arguments, line.common);
    });
}

} // namespace plumb
