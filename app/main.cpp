// The command line.
#include "app/command_options.h"
#include "app/files/output_file.h"
#include "app/hash.h"
#include "app/lab/chart.h"
#include "app/lab/check.h"
#include "app/lab/csv.h"
#include "app/lab/interrupt.h"
#include "app/lab/map/stability_map.h"
#include "app/lab/measure.h"
#include "app/lab/query_chart.h"
#include "app/lab/run_text.h"
#include "app/lab/sweep.h"
#include "app/lab/tune/tune.h"
#include "app/list.h"
#include "app/render/compare_images.h"
#include "app/render/png.h"
#include "app/replay.h"
#include "app/sandbox/run_sandbox.h"
#include "app/snapshot.h"
#include "engine/scene/recording.h"
#include "engine/scene/scene_file_spelling.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cerrno>
#include <iostream>
#include <map>
#include <new>
#include <stdexcept>
#include <system_error>
#include <thread>

#include <unistd.h>

namespace plumb {

namespace {

constexpr const char *default_scene = "wrecking_ball";
// Where the default scene looks best as a picture: the ball is in the wall.
constexpr std::uint64_t default_scene_step = 125;

constexpr const char *exit_codes = "Exit codes:\n"
                                   "  0  fine\n"
                                   "  1  outside a tolerance, or pictures or a replay differ; "
                                   "nothing meets what is tuned\n"
                                   "  2  a bad scene or argument\n"
                                   "  3  the world diverged\n"
                                   "  4  no GL context\n"
                                   "  5  output could not be written, or memory ran out\n"
                                   "130  interrupted by Ctrl-C (143: by SIGTERM); what was done "
                                   "is kept\n";

int code_of(ExitCode code) {
    return static_cast<int>(code);
}

struct RunArguments {
    std::optional<int> frames, samples;
    std::optional<float> ui_scale;
    std::filesystem::path screenshot, record;
};

int run(const CommonOptions &common, const RunArguments &arguments) {
    TaskPool tasks(common.threads);
    SandboxOptions options;
    options.scenes = common.catalogue;
    options.initial_scene = common.scenes.empty()
                                ? resolve_scene(default_scene, common.catalogue)
                                : resolve_scene(common.scenes.front(), common.catalogue);
    options.gl = gl_choice_from_name(common.gl);
    if (!common.size.empty())
        options.size = parse_size(common.size);
    options.shader_dir = common.shader_dir();
    options.out_dir = common.out;
    options.run = common.run();
    options.tasks = &tasks;
    options.max_frames = arguments.frames;
    options.screenshot = arguments.screenshot;
    options.record = arguments.record;
    options.samples = arguments.samples;
    options.ui_scale = arguments.ui_scale;
    const SandboxResult result = run_sandbox(options);
    if (result.why_no_window.empty())
        return result.exit_code;

    if (!arguments.record.empty())
        throw ContextError("no window: " + result.why_no_window +
                           "; with --frames N the run is recorded without one");
    std::cerr << "plumb: no window: " << result.why_no_window
              << "\nplumb: drawing the scene off screen instead\n";
    SnapshotCommand snapshot;
    snapshot.scenes = {options.initial_scene};
    snapshot.run = options.run;
    snapshot.at = {common.scenes.empty() ? default_scene_step : 0};
    snapshot.size = common.size.empty() ? glm::ivec2{1280, 720} : options.size;
    snapshot.out_dir = common.out;
    snapshot.shader_dir = common.shader_dir();
    snapshot.numbered = false;
    snapshot.gl = GlChoice::osmesa;
    snapshot.samples = arguments.samples.value_or(snapshot.samples);
    snapshot.tasks = &tasks;
    return code_of(make_snapshots(snapshot, std::cout, std::cerr));
}

// In a window if there is one to be had, else without. What is wrong with the file is said by the
// latter.
int replay_or_play(const CommonOptions &common, ReplayCommand command, bool no_window) {
    TaskPool tasks(common.threads);
    command.tasks = &tasks;
    if (!no_window && load_recording(command.recording).ok()) {
        SandboxOptions options;
        options.scenes = common.catalogue;
        options.recording = command.recording;
        options.shader_dir = common.shader_dir();
        options.out_dir = common.out;
        options.tasks = &tasks;
        const SandboxResult result = run_sandbox(options);
        if (result.why_no_window.empty())
            return result.exit_code;
    }
    return code_of(replay(command, std::cout, std::cerr));
}

struct SnapshotArguments {
    std::string at;
    std::uint64_t every = 0, steps = 0;
    bool panels = false;
    int samples = 4;
    float ui_scale = 1;
};

int snapshot(const CommonOptions &common, const SnapshotArguments &arguments) {
    TaskPool tasks(common.threads);
    SnapshotCommand command;
    command.scenes = common.scene_paths();
    command.run = common.run();
    if (!arguments.at.empty())
        command.at = parse_steps(arguments.at);
    if (arguments.every > 0)
        for (std::uint64_t step = 0; step <= arguments.steps; step += arguments.every)
            command.at.push_back(step);
    if (command.at.empty())
        command.at.push_back(arguments.steps);
    std::ranges::sort(command.at);
    command.at.erase(std::unique(command.at.begin(), command.at.end()), command.at.end());
    if (!common.size.empty())
        command.size = parse_size(common.size);
    command.out_dir = common.out;
    command.shader_dir = common.shader_dir();
    command.panels = arguments.panels;
    command.catalogue = common.catalogue;
    command.samples = arguments.samples;
    command.ui_scale = arguments.ui_scale;
    command.gl = gl_choice_from_name(common.gl);
    command.tasks = &tasks;
    return code_of(make_snapshots(command, std::cout, std::cerr));
}

int compare(const std::filesystem::path &a_path, const std::filesystem::path &b_path, int tolerance,
            const std::filesystem::path &difference_path) {
    const Image a = read_png(a_path);
    const Image b = read_png(b_path);
    const ImageDifference difference = compare_images(a, b);
    if (!difference.same_size) {
        std::cout << "different sizes: " << a.width << "x" << a.height << " and " << b.width << "x"
                  << b.height << '\n';
        return code_of(ExitCode::outside_tolerance);
    }
    std::cout << "largest difference of a channel  " << difference.max_difference << " of 255\n"
              << "mean difference                  " << difference.mean_difference << " of 255\n"
              << "pixels more than 2 off           " << 100 * difference.fraction_beyond << " %\n"
              << "FLIP, mean                       " << difference.flip_mean << '\n'
              << "FLIP, 95th percentile            " << difference.flip_percentile << '\n';
    if (!difference_path.empty()) {
        write_png(difference_path, difference.picture);
        std::cout << difference_path.string() << '\n';
    }
    return code_of(difference.max_difference <= tolerance ? ExitCode::fine
                                                          : ExitCode::outside_tolerance);
}

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
};

// Each thing to time has options of its own: the others would be passed over in silence.
void refuse_options_of_others(const CLI::App &bench_command, const std::string &what) {
    const std::map<std::string, std::string> reader{{"--rounds", "geometry"},
                                                    {"--seconds", "dynamics"},
                                                    {"--size", "dynamics"},
                                                    {"--threads", "dynamics"}};
    for (const CLI::Option *option : bench_command.get_options()) {
        const auto only_for = reader.find(option->get_name());
        if (option->count() > 0 && ((only_for != reader.end() && only_for->second != what) ||
                                    (option->get_name() == "--only" && what == "geometry")))
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
                                       std::to_string(common.threads)};
    if (!arguments.only.empty())
        for (std::string &name : parse_list(arguments.only))
            passed_on.push_back(std::move(name));
    std::vector<char *> pointers;
    for (std::string &argument : passed_on)
        pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    execv(program.c_str(), pointers.data());
    std::cerr << "plumb: cannot run " << program.string() << ": "
              << std::generic_category().message(errno) << '\n';
    return code_of(ExitCode::bad_input);
}

// The command as it was typed, for a chart's footer.
std::string command_text(int argc, char **argv) {
    std::string text = "plumb";
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        const bool plain = !argument.empty() && argument.find_first_of(" \t") == std::string::npos;
        text += plain ? " " + argument : " \"" + argument + '"';
    }
    return text;
}

int main_with_errors(int argc, char **argv) {
    CLI::App app(
        "Plumb: a physics sandbox that charts what a method costs against how true it is.");
    app.name("plumb");
    app.footer(exit_codes);
    app.require_subcommand(0, 1);
    app.set_version_flag("--version", PLUMB_VERSION);
    CommonOptions common;
    int result = 0;

    CLI::App *run_command = app.add_subcommand(
        "run", "Opens the sandbox (the default). Without a display: draws the scene to a PNG");
    run_command->add_option("SCENE", common.scenes, "A scene file, or a name from `plumb list`")
        ->expected(0, 1);
    add_run_options(*run_command, common);
    add_gl(*run_command, common);
    add_out(*run_command, common, "out");
    run_command->add_option("--size", common.size, "Of the window: WIDTHxHEIGHT (1280x800)");
    RunArguments window;
    run_command
        ->add_option("--samples", window.samples,
                     "Of multisampling; 1: none (4, or 1 where there is no GPU)")
        ->check(CLI::Range(1, 16));
    add_ui_scale(*run_command, window.ui_scale, "the monitor's");
    run_command->add_option("--frames", window.frames, "Ends after so many frames")
        ->check(positive());
    run_command->add_option("--screenshot", window.screenshot,
                            "Where to write the last frame, a PNG");
    run_command->add_option("--record", window.record,
                            "Where to write the run at its end, with all that was done to it, for "
                            "`plumb replay`");
    run_command->callback([&] { result = run(common, window); });

    ReplayCommand replayed;
    CLI::App *replay_command = app.add_subcommand(
        "replay",
        "Runs a recording again in the sandbox, or where there is no display without it, and says "
        "whether and where it differs");
    replay_command->add_option("FILE", replayed.recording, "From `plumb run --record FILE`")
        ->required();
    bool no_window = false;
    replay_command->add_flag("--no-window", no_window,
                             "Without the sandbox: as fast as it goes, and prints the last hash");
    add_out(*replay_command, common, "out");
    add_threads(*replay_command, common);
    replay_command->callback([&] { result = replay_or_play(common, replayed, no_window); });

    SnapshotArguments pictures;
    CLI::App *snapshot_command =
        app.add_subcommand("snapshot", "Draws scenes at given steps to numbered PNG files");
    add_scenes(*snapshot_command, common);
    auto *at = snapshot_command->add_option("--at", pictures.at, "Steps to draw: 0,60,240")
                   ->type_name("STEP,...");
    auto *every =
        snapshot_command->add_option("--every", pictures.every, "Draws every so many steps, from 0")
            ->check(positive())
            ->excludes(at);
    auto *steps =
        snapshot_command
            ->add_option("--steps", pictures.steps, "How far to run; alone: draws that step")
            ->check(step_range());
    every->needs(steps);
    snapshot_command->add_option("--size", common.size, "WIDTHxHEIGHT (1280x720)");
    add_out(*snapshot_command, common, "out");
    snapshot_command->add_flag("--ui", pictures.panels, "With the sandbox's panels");
    snapshot_command->add_option("--samples", pictures.samples, "Of multisampling; 1: none")
        ->check(CLI::Range(1, 16))
        ->capture_default_str();
    add_ui_scale(*snapshot_command, pictures.ui_scale, "1");
    add_run_options(*snapshot_command, common);
    add_gl(*snapshot_command, common);
    snapshot_command->callback([&] { result = snapshot(common, pictures); });

    bool all_methods = false;
    CLI::App *check_command =
        app.add_subcommand("check", "Runs scenes and holds them to what they expect of themselves");
    add_scenes(*check_command, common);
    add_run_options(*check_command, common);
    check_command->add_flag("--all-methods", all_methods, "Every method that can run the scene");
    check_command->callback([&] {
        TaskPool tasks(common.threads);
        CheckCommand command;
        command.scenes = common.scene_paths();
        command.run = common.run();
        if (all_methods)
            for (const MethodInfo &info : method_infos())
                command.methods.emplace_back(info.name);
        command.tasks = &tasks;
        result = code_of(check_scenes(command, std::cout, std::cerr));
    });

    std::uint64_t hash_steps = 0;
    CLI::App *hash_command =
        app.add_subcommand("hash", "Prints a hash of the state: the same state, the same hash");
    add_scenes(*hash_command, common);
    hash_command->add_option("--steps", hash_steps, "How far to run first")
        ->check(step_range())
        ->required();
    add_run_options(*hash_command, common);
    hash_command->callback([&] {
        TaskPool tasks(common.threads);
        HashCommand command;
        command.scenes = common.scene_paths();
        command.run = common.run();
        command.steps = hash_steps;
        command.tasks = &tasks;
        result = code_of(hash_scenes(command, std::cout, std::cerr));
    });

    bool json = false, keys = false, methods = false, settings = false;
    CLI::App *list_command = app.add_subcommand("list", "Lists the scenes");
    list_command->add_flag("--json", json, "For programs");
    auto *list_keys = list_command->add_flag("--keys", keys, "Keys and mouse instead, as a table");
    auto *list_settings =
        list_command->add_flag("--settings", settings, "Settings instead, as a table");
    list_command->add_flag("--methods", methods, "Methods instead")
        ->excludes(list_keys)
        ->excludes(list_settings);
    list_settings->excludes(list_keys);
    list_command->callback([&] {
        list(keys       ? Listed::keys
             : methods  ? Listed::methods
             : settings ? Listed::settings
                        : Listed::scenes,
             json, common.catalogue, std::cout);
    });

    std::uint64_t measure_steps = 600;
    std::filesystem::path csv;
    CLI::App *measure_command = app.add_subcommand(
        "measure", "Runs a scene and writes energies, momenta, errors and times, step by step");
    measure_command->add_option("SCENE", common.scenes, "A scene file, or a name from `plumb list`")
        ->required()
        ->expected(1);
    measure_command->add_option("--steps", measure_steps, "How far to run")
        ->check(step_range())
        ->capture_default_str();
    measure_command->add_option("--csv", csv, "Where to write the table (standard output)");
    add_run_options(*measure_command, common);
    measure_command->callback([&] {
        TaskPool tasks(common.threads);
        MeasureCommand command;
        command.scene = common.scene_paths().front();
        command.run = common.run();
        command.steps = measure_steps;
        command.out = csv;
        command.tasks = &tasks;
        result = code_of(measure_scene(command, std::cout, std::cerr));
    });

    ChartCommand chart;
    std::vector<std::string> sweeps;
    CLI::App *chart_command = app.add_subcommand(
        "chart", "Charts each method's cost against its error, as CSV and PNG: of scenes, or of "
                 "geometric queries (`plumb chart geometry`, with --repeats and --out alone)");
    add_scenes(*chart_command, common);
    std::string chart_methods;
    chart_command->add_option("--methods", chart_methods, "Of " + method_names() + " (all)")
        ->type_name("METHOD,...");
    chart_command
        ->add_option("--sweep", sweeps,
                     "What to go through, any setting from `plumb list --settings`: substeps=1..16 "
                     "(the default), iterations=1,2,8, dt=1/240..1/30; may be given several times")
        ->allow_extra_args(false);
    chart_command->add_option(
        "--expect", chart.options.expect,
        "Name of one expectation to chart, in its own unit (the worst of all, "
        "each in units of its tolerance)");
    chart_command->add_option("--repeats", chart.options.repeats, "Timings of each run")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    add_out(*chart_command, common, "out");
    add_run_options(*chart_command, common, true);
    chart_command->callback([&] {
        if (common.scenes == std::vector<std::string>{"geometry"}) {
            refuse_options_of_scenes(*chart_command);
            QueryChartCommand command;
            command.options.repeats = chart.options.repeats;
            command.out_dir = common.out;
            command.shader_dir = common.shader_dir();
            command.command = command_text(argc, argv);
            result = code_of(chart_geometry(command, std::cout, std::cerr));
            return;
        }
        for (const std::string &sweep : sweeps)
            chart.options.sweep.push_back(parse_sweep(sweep));
        if (!chart_methods.empty())
            chart.options.methods = parse_list(chart_methods);
        chart.scenes = common.scene_paths();
        chart.options.base = common.run();
        chart.out_dir = common.out;
        chart.shader_dir = common.shader_dir();
        chart.command = command_text(argc, argv);
        result = code_of(chart_scenes(chart, std::cout, std::cerr));
    });

    MapCommand map;
    std::string x_axis, y_axis, map_methods;
    CLI::App *map_command = app.add_subcommand(
        "map", "Maps where each method holds a scene and why it fails, over two numbers: a grid of "
               "runs, with the limit between held and failed found by bisection along x");
    map_command->add_option("SCENE", common.scenes, "A scene file, or a name from `plumb list`")
        ->required()
        ->expected(1);
    const std::string axis_about =
        "a setting from `plumb list --settings`, or a number of the scene file by its path, such "
        "as body.ball.velocity.x, material.steel.friction or body.box.repeat.count; N values (10) "
        "in equal steps, or in equal ratios with log, as in dt=1/480..1/30:9log; or a list, "
        "substeps=1,2,4";
    map_command->add_option("--x", x_axis, "What goes to the right: " + axis_about)
        ->required()
        ->type_name("NAME=FROM..TO[:N][log]");
    map_command->add_option("--y", y_axis, "What goes up, in the same way")
        ->required()
        ->type_name("NAME=FROM..TO[:N][log]");
    map_command->add_option("--methods", map_methods, "Of " + method_names() + " (all)")
        ->type_name("METHOD,...");
    map_command->add_option("--image", map.image, "Where to draw the map, a PNG");
    map_command->add_option("--csv", map.csv, "Where to write every cell and limit, as a table");
    map_command
        ->add_option("--seconds", map.options.duration,
                     "How long each run of a scene that expects nothing of itself lasts (5)")
        ->check(positive());
    add_run_options(*map_command, common, true);
    add_threads(*map_command, common);
    map_command->callback([&] {
        TaskPool tasks(common.threads);
        map.scene = common.scene_paths().front();
        map.x = parse_map_axis(x_axis);
        map.y = parse_map_axis(y_axis);
        if (!map_methods.empty())
            map.options.methods = parse_list(map_methods);
        map.options.base = common.run();
        map.options.tasks = &tasks;
        map.shader_dir = common.shader_dir();
        map.command = command_text(argc, argv);
        result = code_of(map_scene(map, std::cout, std::cerr));
    });

    TuneCommand tuned;
    std::string tune_methods, budget;
    CLI::App *tune_command = app.add_subcommand(
        "tune",
        "Finds the cheapest method, precision, dt, substeps and iterations with which a scene "
        "meets all that it expects of itself, with a margin and from several starts. What is given "
        "by --methods, --precision, --set and the like stays as it is given");
    tune_command->add_option("SCENE", common.scenes, "A scene file, or a name from `plumb list`")
        ->required()
        ->expected(1);
    tune_command->add_option("--methods", tune_methods, "Of " + method_names() + " (all)")
        ->type_name("METHOD,...");
    tune_command
        ->add_option(
            "--tolerance", tuned.options.tolerance,
            "The share of each tolerance that may be used: the rest is the margin (lower bounds "
            "have none)")
        ->check(CLI::Range(0.01, 1.0))
        ->capture_default_str();
    tune_command
        ->add_option("--starts", tuned.options.starts,
                     "How often each is run beside the scene as it stands: with bodies shifted by "
                     "up to a millionth, and another seed for what the file scatters")
        ->check(CLI::Range(0, 100))
        ->capture_default_str();
    tune_command
        ->add_option("--budget", budget,
                     "The most CPU time that a frame of 1/60 s may cost; when the cheapest costs "
                     "more, the exit code is 1")
        ->type_name("1ms");
    tune_command
        ->add_option("--repeats", tuned.options.repeats,
                     "Timings of each that may be the cheapest, in turns")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    tune_command->add_flag("--explain", tuned.explain,
                           "Prints what was tried, what each cost and what it missed");
    tune_command->add_flag("--write", tuned.write,
                           "Writes what was chosen into the scene's file, and leaves all else in "
                           "it as it is");
    add_run_options(*tune_command, common, true);
    tune_command->callback([&] {
        tuned.scene = common.scene_paths().front();
        if (!tune_methods.empty())
            tuned.options.methods = parse_list(tune_methods);
        if (!budget.empty())
            tuned.options.budget = parse_budget(budget);
        tuned.options.base = common.run();
        result = code_of(tune_scene(tuned, std::cout, std::cerr));
    });

    BenchArguments bench_arguments;
    int bench_threads = 2;
    CLI::App *bench_command = app.add_subcommand(
        "bench", "Compares the engine with other libraries (run it as ./plumb bench WHAT)");
    bench_command
        ->add_option("WHAT", bench_arguments.what,
                     "geometry: what queries cost; dynamics: what steps of the same scenes cost in "
                     "several engines, and how wrong they are; truth: what each engine makes of "
                     "small problems whose answer is known, beside the aim")
        ->required()
        ->check(CLI::IsMember({"geometry", "dynamics", "truth"}));
    bench_command
        ->add_option("--rounds", bench_arguments.rounds,
                     "geometry: of timings; their median counts")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    bench_command
        ->add_option("--only", bench_arguments.only,
                     "dynamics, truth: the scenes or problems whose names begin so (all)")
        ->type_name("NAME,...");
    bench_command
        ->add_option("--seconds", bench_arguments.seconds,
                     "dynamics: how long a scene is run at most, in its own time (0.25 to 5, by "
                     "scene)")
        ->check(positive());
    bench_command
        ->add_option("--size", bench_arguments.size,
                     "dynamics: of the scenes: 0.1 for about a tenth of the bodies")
        ->check(CLI::Range(0.0001, 10.0))
        ->capture_default_str();
    bench_command
        ->add_option("--threads", bench_threads, "dynamics: of Plumb, beside one; 1: only one")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
    add_out(*bench_command, common, "out");
    bench_command->callback([&] {
        refuse_options_of_others(*bench_command, bench_arguments.what);
        common.threads = bench_threads;
        result = bench(bench_arguments, common);
    });

    std::filesystem::path picture_a, picture_b, difference;
    int tolerance = 0;
    CLI::App *compare_command = app.add_subcommand("compare", "Compares two PNG files");
    compare_command->add_option("A", picture_a)->required();
    compare_command->add_option("B", picture_b)->required();
    compare_command
        ->add_option("--tolerance", tolerance, "Largest difference of a channel that passes")
        ->check(CLI::Range(0, 255))
        ->capture_default_str();
    compare_command->add_option("--difference", difference,
                                "Where to write a picture of the difference");
    compare_command->callback(
        [&] { result = compare(picture_a, picture_b, tolerance, difference); });

    for (CLI::App *command : app.get_subcommands({}))
        command->footer(exit_codes);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ExtrasError &error) {
        // A misspelt command comes before anything that it could explain.
        if (app.get_subcommands().empty() && argc > 1 && argv[1][0] != '-') {
            std::vector<std::string> names;
            for (const CLI::App *command : app.get_subcommands({}))
                names.push_back(command->get_name());
            const std::vector<std::string_view> candidates(names.begin(), names.end());
            const auto scene = std::ranges::find(common.catalogue, argv[1], &SceneEntry::name);
            std::cerr << "plumb: there is no command '" << argv[1] << "'; "
                      << (scene != common.catalogue.end()
                              ? "to open the scene: plumb run " + scene->name
                              : did_you_mean(argv[1], candidates))
                      << '\n';
            return code_of(ExitCode::bad_input);
        }
        app.exit(error);
        return code_of(ExitCode::bad_input);
    } catch (const CLI::ParseError &error) {
        return app.exit(error) == 0 ? 0 : code_of(ExitCode::bad_input);
    }
    if (app.get_subcommands().empty())
        result = run(common, window);
    return result;
}

// What `work` returns, or the exit code of what kept it from doing so, which is said.
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
        code = exit_code(error);
    } catch (const std::bad_alloc &) {
        what = "out of memory; scenes/README.md says what a scene may ask for";
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
