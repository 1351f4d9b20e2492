// Commands that check, measure, map and tune.
#include "app/commands.h"

#include "app/lab/map/axis_names.h"
#include "app/lab/map/stability_map.h"
#include "app/lab/run/check.h"
#include "app/lab/run/measure.h"
#include "app/lab/run/reference.h"
#include "app/lab/tune/plainer.h"
#include "app/lab/tune/tune.h"

#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

namespace plumb {

namespace {

// Any name without an extension may be a pipe or a device.
CLI::Validator png_or_svg() {
    return {[](const std::string &text) {
                const std::string kind = std::filesystem::path(text).extension().string();
                return kind.empty() || kind == ".png" || kind == ".svg"
                           ? std::string()
                           : "must end in .png or .svg, got " + text;
            },
            ""};
}

struct MeasureArguments {
    std::uint64_t steps = 600;
    std::filesystem::path csv;
};

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
    CLI::App *check_command =
        line.app.add_subcommand("check", "Runs scenes and checks their expectations");
    add_scenes(*check_command, line.common);
    add_run_options(*check_command, line.common);
    check_command->add_flag("--all-methods", *all_methods,
                            "Checks every method that can run the scene");
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
    measure_command->add_option("--steps", arguments->steps, "Steps to run")
        ->check(step_range())
        ->capture_default_str();
    measure_command->add_option("--csv", arguments->csv, "CSV file to write (standard output)");
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

void add_map(CommandLine &line) {
    const auto arguments = std::make_shared<MapArguments>();
    CLI::App *map_command = line.app.add_subcommand(
        "map", "Maps where each method holds a scene and why it fails, over two parameters: a grid "
               "of runs, with the limits between held and failed found by bisection along x. Over "
               "gravity or a number of the scene file, only what the scene expects whatever that "
               "number is counts: laws, and what an accurate run meets at both ends and in the "
               "middle; the map says what does not");
    map_command
        ->add_option("SCENE", line.common.scenes, "A scene file, or a name from `plumb list`")
        ->required()
        ->expected(1);
    const std::string axis_about =
        "a setting from `plumb list --settings`, or the path of a number in the scene file, such "
        "as body.ball.velocity.x, material.steel.friction or body.box.repeat.count; its key alone "
        "(radius) will do if the file has it only once (of velocity = [0, 5, 0], the component "
        "that is not 0), or one of the names below. N values (10) in equal steps, or in equal "
        "ratios with log: "
        "dt=1/480..1/30:9log; or a list: substeps=1,2,4";
    map_command->add_option("--x", arguments->x, "The x axis: " + axis_about)
        ->required()
        ->type_name("NAME=FROM..TO[:N][log]");
    map_command->add_option("--y", arguments->y, "The y axis, in the same form")
        ->required()
        ->type_name("NAME=FROM..TO[:N][log]");
    map_command->add_option("--methods", arguments->methods, "Methods (all): " + method_names())
        ->type_name("METHOD,...");
    map_command
        ->add_option("--image", arguments->command.image,
                     "Picture of the map to write: a PNG, or an SVG if named *.svg")
        ->check(png_or_svg());
    map_command->add_option("--csv", arguments->command.csv,
                            "CSV file to write, with every cell and limit");
    map_command
        ->add_option("--seconds", arguments->command.options.duration,
                     "Simulated seconds per run of a scene without expectations (5)")
        ->check(positive());
    add_run_options(*map_command, line.common, true);
    add_threads(*map_command, line.common);
    map_command->footer([] {
        std::string names = "Names of numbers that most scenes have, for --x and --y:\n";
        for (const AxisName &each : axis_names())
            names.append("  ").append(each.name).append(": ").append(each.meaning).append("\n");
        return names;
    });
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
        "meets all its expectations, with a margin and from several starts, and then what its "
        "model can do without: " +
            model_parts_text() + ". Anything given by --methods, --set and the like stays fixed");
    tune_command
        ->add_option("SCENE", line.common.scenes, "A scene file, or a name from `plumb list`")
        ->required()
        ->expected(1);
    tune_command->add_option("--methods", arguments->methods, "Methods (all): " + method_names())
        ->type_name("METHOD,...");
    tune_command
        ->add_option(
            "--tolerance", arguments->command.options.tolerance,
            "Fraction of each tolerance that may be used; the rest is the margin (lower bounds "
            "have none)")
        ->check(CLI::Range(0.01, 1.0))
        ->capture_default_str();
    tune_command
        ->add_option("--starts", arguments->command.options.starts,
                     "Further runs of each candidate, beside the scene as it stands: with bodies "
                     "shifted by up to a millionth, and another seed for what the file scatters")
        ->check(CLI::Range(0, 100))
        ->capture_default_str();
    tune_command
        ->add_option("--budget", arguments->budget,
                     "Most CPU time that a frame of 1/60 s may cost; exit code 1 if the cheapest "
                     "costs more")
        ->type_name("1ms");
    tune_command
        ->add_option("--repeats", arguments->command.options.repeats,
                     "Timings of each candidate for the cheapest, interleaved")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    tune_command->add_flag("--explain", arguments->command.explain,
                           "Prints what was tried, what it cost and what it missed");
    tune_command->add_flag("--write", arguments->command.write,
                           "Writes the chosen settings, including sleep, into the scene's file and "
                           "leaves the rest of it alone; what bodies can do without is only "
                           "reported");
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
        "Computes a scene's true values by refinement: runs it in double and halves dt until each "
        "changes by less than a tenth of its tolerance");
    reference_command
        ->add_option("SCENE", line.common.scenes, "A scene file, or a name from `plumb list`")
        ->required()
        ->expected(1);
    reference_command->add_flag(
        "--write", command->write,
        "Writes those that have an `estimate` into the scene's file, with their estimates, and "
        "leaves the rest of it alone");
    reference_command->callback([=, &line] {
        command->scene = line.common.scene_paths().front();
        line.result = code_of(refine_scene(*command, std::cout, std::cerr));
    });
}

} // namespace plumb
